"""Python and the command line give the same answers: the same dict, to the last digit."""

from __future__ import annotations

import pathlib
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import rodcal

TX90 = "campaigns/tx90-5/campaign.toml"
Command = Callable[[str], dict[str, Any]]

CASES: list[tuple[str, Callable[[], Any]]] = [
    ("compliance rods/5.toml", lambda: rodcal.compliance("rods/5.toml")),
    (
        "compliance rods/5.toml --mode calc --contact-force 3 --load-station 100",
        lambda: rodcal.compliance("rods/5.toml", "calc", contact_force_n=3, load_station_mm=100),
    ),
    (
        "compliance rods/2.toml --theory euler-bernoulli --elements 10",
        lambda: rodcal.compliance("rods/2.toml", theory="euler-bernoulli", elements=10),
    ),
    (
        "rig fit rods/2.toml stiffness_data/2.csv --robust huber",
        lambda: rodcal.rig_fit("rods/2.toml", "stiffness_data/2.csv", robust="huber"),
    ),
    (
        "rig fit linear stiffness_data/nist-load-cell.csv",
        lambda: rodcal.rig_fit(None, "stiffness_data/nist-load-cell.csv"),
    ),
    (
        "diagnose rig rods/2.toml stiffness_data/2.csv",
        lambda: rodcal.diagnose_rig("rods/2.toml", "stiffness_data/2.csv"),
    ),
    (
        "diagnose rig linear stiffness_data/nist-load-cell.csv",
        lambda: rodcal.diagnose_rig(None, "stiffness_data/nist-load-cell.csv"),
    ),
    (f"calibrate {TX90} --folds 3", lambda: rodcal.calibrate(TX90, folds=3)),
    (
        f"calibrate {TX90} --mode fea --robust tukey --prune",
        lambda: rodcal.calibrate(TX90, "fea", robust="tukey", prune=True),
    ),
    (f"compare {TX90} --draws 50 --seed 3", lambda: rodcal.compare(TX90, draws=50, seed=3)),
    (
        f"compare {TX90} --forecast --rods rods/2.toml rods/5.toml --noise-um 12 --volume-mm 300,500,-200,200,100,600",
        lambda: rodcal.forecast(
            TX90, ["rods/2.toml", "rods/5.toml"], noise_um=12, volume_mm=(300, 500, -200, 200, 100, 600)
        ),
    ),
    (f"diagnose calibration {TX90} --mode none", lambda: rodcal.diagnose_calibration(TX90, "none")),
    (
        "design rod examples/design.toml --samples 3000 --base rods/5.toml --seed 4",
        lambda: rodcal.design_rod("examples/design.toml", samples=3000, base="rods/5.toml", seed=4),
    ),
    (
        f"design poses {TX90} --count 20 --criterion d --generate 300 --table-mm none",
        lambda: rodcal.design_poses(TX90, 20, "d", generate=300, table_mm="none"),
    ),
    (
        "design rig rods/2.toml --between joint_compliance,root_compliance",
        lambda: rodcal.design_rig("rods/2.toml", ["joint_compliance", "root_compliance"]),
    ),
]


@pytest.mark.parametrize(("line", "ask"), CASES, ids=[line for line, _ in CASES])
def test_the_dict_is_the_json_of_the_command(line: str, ask: Callable[[], Any], command: Command) -> None:
    answer = ask()
    assert answer.to_dict() == command(line)
    # nobody else's dict is changed by who changes theirs
    answer.to_dict().clear()
    assert answer.to_dict()
    # every attribute of the type is there, and the table has rows
    assert answer.headline and vars(answer)
    html = answer._repr_html_()
    assert html.startswith('<div class="rodcal">') and "<svg" in html or "design rig" in line
    if "findings" not in answer.to_dict() or answer.findings:
        assert len(answer.to_dataframe()) > 0


def test_predictions_and_their_robot(command: Command, tmp_path: pathlib.Path) -> None:
    calibration = rodcal.calibrate(TX90)
    calibration.write(tmp_path / "out")
    q = np.array([[10.0, -20, 95, 5, 30, 0], [50, -70, 30, 58, 66, 34], [0, 0, 90, 0, 0, 0]])
    rows = "".join(f"{n},{','.join(map(repr, row.tolist()))}\n" for n, row in enumerate(q, start=1))
    poses = tmp_path / "poses.csv"
    poses.write_text("pose,q1_deg,q2_deg,q3_deg,q4_deg,q5_deg,q6_deg\n" + rows)
    expected = command(f"predict {tmp_path / 'out' / 'calibrated.toml'} {poses}")

    for robot in (calibration.calibrated(), rodcal.Robot.read(tmp_path / "out" / "calibrated.toml")):
        predicted = rodcal.predict(robot, q)
        assert predicted.to_dict() == expected
        tips = [[pose[f"{axis}_mm"] for axis in "xyz"] for pose in expected["poses"]]
        assert np.array_equal(predicted.tips_mm, tips)
        assert predicted.sd_mm is not None and predicted.sd_mm.shape == (3, 3)
    # so are many, which are looked at in blocks
    many = np.random.default_rng(2).uniform(-90, 90, (9000, 6))
    together, alone = rodcal.predict(robot, many), rodcal.predict(robot, many[8990:])
    for whole, part in [(together.tips_mm, alone.tips_mm), (together.sd_mm, alone.sd_mm), (together.ratios, alone.ratios)]:
        assert whole is not None and part is not None and len(whole) == 9000
        assert np.allclose(whole[8990:], part, rtol=1e-12, atol=0)
    # any strides will do
    assert np.array_equal(rodcal.predict(robot, np.asfortranarray(q)[::-1]).tips_mm, np.array(tips)[::-1])


def test_a_simulation_is_the_files_of_the_command(command: Command, tmp_path: pathlib.Path) -> None:
    options = {"seed": 9, "poses": 6, "validation": 10, "r_rod": 1.05}
    here, there = tmp_path / "here", tmp_path / "there"
    simulation = rodcal.simulate("rods/6.toml", directory=here, **options)  # type: ignore[arg-type]
    line = f"simulate {there} --rod rods/6.toml --seed 9 --poses 6 --validation 10 --r-rod 1.05"
    own, theirs = simulation.to_dict(), command(line)
    assert own.pop("campaign") == str(here / "campaign.toml")
    assert theirs.pop("campaign") == str(there / "campaign.toml")
    assert own == theirs
    for name, content in simulation.files.items():
        assert (here / name).read_bytes() == (there / name).read_bytes() == content
    assert len(simulation.to_dataframe()) == len(simulation.truth)
    of_files = rodcal.calibrate(there / "campaign.toml").to_dict()
    in_memory = rodcal.calibrate(simulation.campaign()).to_dict()
    assert of_files == in_memory


def test_a_report_is_written_whole(tmp_path: pathlib.Path) -> None:
    result = rodcal.compliance("rods/5.toml")
    result.write(tmp_path / "report")
    assert (tmp_path / "report" / "index.html").exists()
    (tmp_path / "report" / "result.json").write_text("mine")
    with pytest.raises(rodcal.FileError, match="changed since"):
        result.write(tmp_path / "report")
    result.write(tmp_path / "report", force=True)
