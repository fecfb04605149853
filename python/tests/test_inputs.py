"""What is built in memory is what is read from files."""

from __future__ import annotations

import csv
import pathlib
import pickle
import sys
from typing import Any

import numpy as np
import pandas
import pytest

import rodcal

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

TX90 = "campaigns/tx90-5/campaign.toml"


def _columns(path: str) -> dict[str, list[str]]:
    lines = [line for line in pathlib.Path(path).read_text().splitlines() if not line.startswith("#")]
    rows = list(csv.DictReader(lines))
    return {key: [row[key] for row in rows] for key in rows[0]}


def _numbers(cells: list[str]) -> np.ndarray[Any, np.dtype[np.float64]]:
    return np.array([float(cell) if cell else np.nan for cell in cells])


def _dict() -> dict[str, Any]:
    pipe = {"material": "steel", "outer_diameter_mm": 32.0, "inner_diameter_mm": np.float64(30.0)}
    return {
        "name": "a \"quoted\" name, µ",
        "geometry": {"l1_mm": 150, "l2_mm": 525.0},
        "material": {"steel": {"youngs_modulus_gpa": 193.0, "poisson_ratio": 0.29, "density_kg_m3": 7930.0}},
        "pipe1": pipe,
        "pipe2": pipe,
        "tip": {"mass_g": 60.0},
        "joint": [{"name": "sleeve", "station_mm": 140.0, "bending_urad_per_nm": 2.0}],
    }


def test_a_rod_from_a_dict_comes_back_from_its_file(tmp_path: pathlib.Path) -> None:
    rod = rodcal.Rod(_dict())
    (tmp_path / "rod.toml").write_text(rod.to_toml())
    again = rodcal.Rod.read(tmp_path / "rod.toml")
    assert again.name == rod.name == _dict()["name"]
    one, other = (rodcal.compliance(rod) for rod in (rod, again))
    assert np.array_equal(one.cf_um_per_n, other.cf_um_per_n) and one.c_rod_um == other.c_rod_um


def test_readings_from_columns_are_those_of_the_file() -> None:
    columns = _columns("stiffness_data/2.csv")
    offsets = np.stack([_numbers(columns[name]) for name in ("dy_um", "dz_um")], axis=1)
    blank = np.full(len(offsets), np.nan)
    load = {key: _numbers(columns[key]) for key in columns if key.startswith("load_")}
    text = {key: columns[key] for key in columns if key in ("axis", "trial", "phase")}
    tables: list[Any] = [
        {**text, **load, "dy_um": offsets[:, 0], "dz_um": offsets[:, 1]},
        {**text, **load, "dxyz_um": np.column_stack([blank, offsets])},
        pandas.DataFrame({**text, **load, "dy_um": offsets[:, 0], "dz_um": offsets[:, 1]}),
    ]
    of_file = rodcal.rig_fit("rods/2.toml", "stiffness_data/2.csv")
    for table in tables:
        fit = rodcal.rig_fit("rods/2.toml", table)
        assert fit.to_dict()["slopes"] == of_file.to_dict()["slopes"]
        assert fit.r_rod == of_file.r_rod


def test_the_header_of_readings_is_a_dict() -> None:
    table = {"axis": ["y"] * 4, "load_n": [2, 4, 2, 4], "dy_um": [10.0, 20.1, 10.1, 20.0]}
    stated = rodcal.diagnose_rig(None, rodcal.Readings(table, header={"noise_um": 1.5}))
    assert stated.noise.stated_um == 1.5
    assert rodcal.diagnose_rig(None, table).noise.stated_um is None
    with pytest.raises(rodcal.InputError, match="noise_um"):
        rodcal.Readings(table, header={"noise_mm": 1.5})


def test_a_campaign_from_arrays_is_that_of_the_files() -> None:
    tables: dict[str, Any] = {}
    for role in ("measurements", "validation"):
        columns = _columns(f"campaigns/tx90-5/{role}.csv")
        q = np.stack([_numbers(columns[f"q{n}_deg"]) for n in range(1, 7)], axis=1)
        xyz = np.stack([_numbers(columns[f"{axis}_mm"]) for axis in "xyz"], axis=1)
        tables[role] = {"pose": columns["pose"], "q_deg": q, "xyz_mm": xyz}
        if "clamp" in columns:
            tables[role]["clamp"] = columns["clamp"]
    keys = _keys()
    campaign = rodcal.Campaign({**keys, **tables})
    assert campaign.poses == 60 and campaign.mode == "meas"
    own, theirs = (rodcal.calibrate(c).to_dict() for c in (campaign, TX90))
    # a table in memory does not say where it comes from
    for answer in (own, theirs):
        answer.pop("measurements_source", None)
    assert own == theirs
    # poses without names are numbered
    del tables["measurements"]["pose"]
    assert rodcal.Campaign({**keys, **tables}).pose_names[0].startswith("1")


def _keys() -> dict[str, Any]:
    """The campaign file's own keys, with objects in place of names."""
    folder = pathlib.Path(TX90).parent
    keys: dict[str, Any] = tomllib.loads(pathlib.Path(TX90).read_text())
    assert keys["robot"].startswith("builtin:")
    keys["robot"] = rodcal.Robot.read(keys["robot"])
    keys["rod"] = rodcal.Rod.read(folder / keys["rod"])
    keys["rig"] = rodcal.Readings.read(folder / keys["rig"])
    return keys


@pytest.mark.parametrize("robot", ["robots/six-axis.urdf", "builtin:tx90"])
def test_the_calibrated_robot_predicts_what_was_calibrated(robot: str) -> None:
    simulation = rodcal.simulate("rods/5.toml", robot, poses=8, validation=10)
    lines = simulation.files["measurements.csv"].decode().splitlines()
    rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
    q = np.array([[float(row[f"q{n}_deg"]) for n in range(1, 7)] for row in rows])
    result = rodcal.calibrate(simulation.campaign())
    assert result.base is not None
    r, p, y = np.radians(result.base.rpy_deg)
    about_x = np.array([[1, 0, 0], [0, np.cos(r), -np.sin(r)], [0, np.sin(r), np.cos(r)]])
    about_y = np.array([[np.cos(p), 0, np.sin(p)], [0, 1, 0], [-np.sin(p), 0, np.cos(p)]])
    about_z = np.array([[np.cos(y), -np.sin(y), 0], [np.sin(y), np.cos(y), 0], [0, 0, 1]])
    predicted = rodcal.predict(result.calibrated(), q).tips_mm
    in_world = predicted @ (about_z @ about_y @ about_x).T + result.base.xyz_mm
    # a prediction is without the rod's weight on the joints: some tenths of a millimetre
    assert np.linalg.norm(in_world - result.tips_mm, axis=1).max() < 0.4


def test_designs_from_dicts_and_poses_from_arrays() -> None:
    space = {
        "geometry": {"l1_mm": [150.0, 200.0], "l2_mm": np.array([400.0, 500.0])},
        "catalogue": {"same_tube": True},
        "objectives": {"minimise": ["c_rod_um", "mass_g"]},
    }
    tubes = {
        "name": ["a", "b"],
        "material": ["steel", "steel"],
        "outer_diameter_mm": [32.0, 40.0],
        "inner_diameter_mm": [30.0, 37.0],
    }
    designs = rodcal.design_rod(space, catalogue=tubes)
    assert designs.evaluated == 8
    assert rodcal.compliance(designs.front[0].rod).c_rod_um == pytest.approx(designs.front[0].c_rod_um, rel=1e-9)
    generated = rodcal.design_poses(TX90, 30, generate=200)
    chosen = rodcal.design_poses(TX90, 20, candidates=generated.joints_deg, at=generated.joints_deg)
    rows = {row.tobytes() for row in generated.joints_deg}
    assert all(row.tobytes() in rows for row in chosen.joints_deg)


def test_no_row_is_lost_and_no_mask() -> None:
    columns = _columns("campaigns/tx90-5/measurements.csv")
    table: dict[str, Any] = {key: cells if key in ("pose", "clamp") else _numbers(cells) for key, cells in columns.items()}
    table["pose"] = ["#0", *table["pose"][1:]]
    keys = {**_keys(), "measurements": table}
    del keys["validation"]
    assert rodcal.Campaign(keys).poses == len(table["pose"])
    masked = np.ma.MaskedArray([1.0, 2.0, 3.0], mask=[False, False, True])
    readings = rodcal.Readings({"axis": ["y", "y", "y"], "load_n": [1.0, 2.0, 3.0], "trial": ["#1", "2", "3"], "dy_um": masked, "dz_um": [0.0] * 3})
    assert len(readings) == 3


def test_results_can_be_pickled() -> None:
    campaign = rodcal.simulate("rods/5.toml", poses=6, validation=10).campaign()
    fitted = rodcal.calibrate(campaign)
    again = pickle.loads(pickle.dumps(fitted))
    assert again.to_dict() == fitted.to_dict() and str(again) == str(fitted)
    assert again.to_html() == fitted.to_html()


def test_predictions_can_be_pickled_and_are_a_frame() -> None:
    made = rodcal.predict("builtin:tx90", [[0, 10, 80, 5, 6, 7], [5, 10, 80, 5, 6, 7]], tool_mm=[10, 0, 200])
    again = pickle.loads(pickle.dumps(made))
    assert (again.tips_mm == made.tips_mm).all() and again.to_dict() == made.to_dict()
    frame = made.to_dataframe()
    assert list(frame.columns[:4]) == ["pose", "x_mm", "y_mm", "z_mm"] and isinstance(frame, pandas.DataFrame)
    assert frame["z_mm"].tolist() == made.tips_mm[:, 2].tolist()
    with pytest.raises(ValueError, match="read-only"):
        made.tips_mm[:] = 0.0


def test_a_diagnosis_of_a_campaign_in_memory_is_applied() -> None:
    table: dict[str, Any] = dict(_columns("campaigns/tx90-5/measurements.csv"))
    table["q4_deg"] = np.deg2rad(_numbers(table["q4_deg"]))
    keys = {**_keys(), "measurements": table}
    del keys["validation"]
    found = rodcal.diagnose_calibration(rodcal.Campaign(keys), apply=True)
    assert any(name.endswith("campaign.toml") for name in found.files), list(found.files)
