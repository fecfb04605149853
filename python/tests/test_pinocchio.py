"""pinocchio (`pip install pin`) loads what a calibration writes, and finds the tips where we do."""

from __future__ import annotations

import pathlib
from typing import Any

import numpy as np
import pytest

import rodcal

pinocchio = pytest.importorskip("pinocchio", reason="pip install pin")
#: Of tips, mm: 1e-9 m.
CLOSE = 1e-6


def _tips_mm(urdf: str, q: np.ndarray[Any, np.dtype[np.float64]]) -> np.ndarray[Any, np.dtype[np.float64]]:
    model = pinocchio.buildModelFromXML(urdf)
    data, tip = model.createData(), model.getFrameId("tip_link")

    def at(angles: np.ndarray[Any, np.dtype[np.float64]]) -> Any:
        pinocchio.framesForwardKinematics(model, data, angles)
        return data.oMf[tip].translation.copy() * 1e3

    return np.array([at(angles) for angles in np.radians(q)])


def test_a_calibrated_urdf_and_its_corrections(tmp_path: pathlib.Path) -> None:
    simulation = rodcal.simulate("rods/5.toml", "robots/six-axis.urdf", poses=8, validation=10)
    result = rodcal.calibrate(simulation.campaign())
    urdf = result.files["calibrated.urdf"].decode()
    q = np.random.default_rng(1).uniform(-170, 170, (50, 6))
    bare = rodcal.Robot.from_text(urdf)
    assert np.abs(_tips_mm(urdf, q) - rodcal.predict(bare, q).tips_mm).max() < CLOSE

    # gears: added to what the joints tell, straight between the rows
    angles = np.arange(-180, 181, 5)
    errors = {2: 200 * np.sin(np.radians(angles)), 4: 150 * np.cos(3 * np.radians(angles))}
    rows = [f"{j},{a},{e!r}" for j, own in errors.items() for a, e in zip(angles.tolist(), own.tolist())]
    (tmp_path / "calibrated.urdf").write_text(urdf)
    (tmp_path / "corrections.csv").write_text("\n".join(["joint,angle_deg,correction_urad", *rows]) + "\n")
    robot = rodcal.Robot.read(tmp_path / "calibrated.urdf", corrections=tmp_path / "corrections.csv")
    turned = q.copy()
    for joint, own in errors.items():
        turned[:, joint - 1] += np.degrees(np.interp(q[:, joint - 1], angles, own) * 1e-6)
    assert np.abs(_tips_mm(urdf, turned) - rodcal.predict(robot, q).tips_mm).max() < CLOSE
    assert np.abs(_tips_mm(urdf, q) - rodcal.predict(robot, q).tips_mm).max() > 0.01
