"""What FIGAROH keeps is read as a campaign, and what a calibration adds to a URDF is written for xacro and PAL."""

from __future__ import annotations

import pathlib
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest

import rodcal
from rodcal import interoperate

yaml = pytest.importorskip("yaml")

JOINTS = [f"joint_{n}" for n in range(1, 7)]
CONFIG = """
extends: templates/arm.yaml
robot: {name: six-axis}
tasks:
  calibration:
    kinematics: {tool_frame: tool0}
    measurements:
      markers: [{name: ball, measurable_dof: [true, true, true, false, false, false]}]
      poses: {base_pose: [0.1, 0.0, 0.0, 0.0, 0.0, 0.2], tool_pose: [0.0, 0.0, 0.1, 0.0, 0.0, 0.0]}
    data: {source_file: data/recorded.csv, validation_data_file: data/more.csv}
"""


@pytest.fixture
def recorded(tmp_path: pathlib.Path) -> pathlib.Path:
    """A folder as FIGAROH's examples have it, of an arm whose second link is 1 mm longer than its URDF says."""
    urdf = pathlib.Path("robots/six-axis.urdf").read_text()
    urdf = urdf.replace('"tip_link"', '"tool0"')
    (tmp_path / "urdf").mkdir()
    (tmp_path / "urdf" / "arm.urdf").write_text(urdf)
    root = ElementTree.fromstring(urdf)
    longer = next(joint for joint in root.findall("joint") if joint.get("name") == "joint_3")
    origin = longer.find("origin")
    assert origin is not None
    xyz = [float(x) for x in origin.get("xyz", "0 0 0").split()]
    far = max(range(3), key=lambda k: abs(xyz[k]))
    xyz[far] += 1e-3
    origin.set("xyz", " ".join(map(repr, xyz)))
    true = rodcal.Robot.from_text(ElementTree.tostring(root, encoding="unicode"), base_link="base_link", tip_link="tool0")
    (tmp_path / "data").mkdir()
    for file, seed, count in (("recorded", 1, 60), ("more", 2, 20)):
        q = np.random.default_rng(seed).uniform(-100, 100, (count, 6))
        tips = rodcal.predict(true, q, tool_mm=[10.0, 0.0, 120.0]).tips_mm * 1e-3
        turn = np.array([[np.cos(0.2), -np.sin(0.2), 0], [np.sin(0.2), np.cos(0.2), 0], [0, 0, 1]])
        noise = np.random.default_rng(seed + 5).normal(0, 20e-6, (count, 3))
        x = tips @ turn.T + [0.1, 0.02, -0.03] + noise
        # blanks round names and a comma at the end, as FIGAROH's own examples have them
        rows = [",".join(map(repr, [*p.tolist(), *np.radians(row).tolist()])) + "," for p, row in zip(x, q)]
        header = ",".join(f"{name} " for name in ["x1", "y1", "z1", *JOINTS]) + ","
        (tmp_path / "data" / f"{file}.csv").write_text("\n".join([header, *rows]) + "\n")
    (tmp_path / "config").mkdir()
    (tmp_path / "config" / "arm.yaml").write_text(CONFIG)
    (tmp_path / "templates").mkdir()
    more = "tasks: {calibration: {kinematics: {base_frame: universe, tool_frame: none}, eye_hand: {enabled: false}}}"
    (tmp_path / "templates" / "arm.yaml").write_text(more)
    return tmp_path


def test_a_recording_of_figaroh_is_a_campaign(recorded: pathlib.Path) -> None:
    campaign = interoperate.figaroh_campaign(recorded / "config" / "arm.yaml", recorded / "urdf" / "arm.urdf")
    assert (campaign.poses, campaign.validation_poses, campaign.columns[0]) == (60, 20, "q1_deg")
    result = rodcal.calibrate(campaign)
    assert result.validation is not None and result.validation.mean_um < 60
    found = {parameter.name: parameter.value for parameter in result.parameters}
    # the second link, and where the ball is
    assert found["a2"] == pytest.approx(-451, abs=0.03) and found["base_x"] == pytest.approx(100, abs=0.05)
    assert [found["tool_x"], found["tool_z"]] == pytest.approx([10, 120], abs=0.05)

    # what is added to the origins makes the calibrated robot, for who adds it to the file that they have
    nominal = recorded / "urdf" / "arm.urdf"
    offsets = interoperate.origin_offsets(result, nominal)
    root = ElementTree.parse(nominal).getroot()
    for joint in root.findall("joint"):
        origin, added = joint.find("origin"), offsets.get(str(joint.get("name")))
        if added is None:
            continue
        assert origin is not None
        for key, axes in (("xyz", ("dx", "dy", "dz")), ("rpy", ("droll", "dpitch", "dyaw"))):
            old = [float(x) for x in origin.get(key, "0 0 0").split()]
            origin.set(key, " ".join(repr(x + added[axis]) for x, axis in zip(old, axes)))
    ours = rodcal.Robot.from_text(ElementTree.tostring(root, encoding="unicode"), base_link="base_link", tip_link="tool0")
    text = result.files["calibrated.urdf"].decode()
    theirs = rodcal.Robot.from_text(text, base_link="base_link", tip_link="tool0")
    q = np.random.default_rng(4).uniform(-150, 150, (20, 6))
    assert np.abs(rodcal.predict(ours, q).tips_mm - rodcal.predict(theirs, q).tips_mm).max() < 1e-9

    xacro = ElementTree.fromstring(interoperate.xacro_offsets(result, nominal))
    values = {element.get("name"): float(element.get("value", "")) for element in xacro}
    flat = {f"{joint}_{axis}": value for joint, added in offsets.items() for axis, value in added.items()}
    assert values == flat and all(element.tag == "{http://www.ros.org/wiki/xacro}property" for element in xacro)
    pal = yaml.safe_load(interoperate.master_calibration(result, nominal))
    assert pal == {"robot_state_publisher": {"geometric_calibration": flat}}


def test_what_is_not_as_figaroh_has_it_is_refused(recorded: pathlib.Path) -> None:
    config, urdf = recorded / "config" / "arm.yaml", recorded / "urdf" / "arm.urdf"

    def refused(changed: str, expected: str, **more: Any) -> None:
        config.write_text(changed)
        with pytest.raises(rodcal.Error, match=expected):
            interoperate.figaroh_campaign(config, urdf, **more)

    refused("calibration:\n  markers: []\n", "tasks.calibration is missing")
    refused("a: [1", "arm.yaml:1:")
    refused("extends: arm.yaml\n", "extends itself")
    refused("- 1\n", "FIGAROH's keys")
    refused(CONFIG.replace("[true, true, true, f", "[true, true, false, f"), "measurable_dof")
    refused(CONFIG.replace("tool0", "nowhere"), "nowhere")
    refused(CONFIG.replace("0.0, 0.2]", "0.2]"), "base_pose")
    refused(CONFIG.replace("0.0, 0.2]", ".nan, 0.2]"), "base_pose")
    refused(CONFIG, "marker 2", marker=2)
    refused(CONFIG.replace("data/recorded", "data/nothing"), "nothing.csv")
    refused(CONFIG + "    eye_hand: {enabled: true}\n", "eye_hand")
    rows = recorded / "data" / "recorded.csv"
    text = rows.read_text()
    for changed, expected in [
        (text.replace("joint_3", "joint_x"), "joint_3|q3"),
        (text.replace("y1 ", "x1 "), "two columns|one 'x1'"),
        (text.replace(text.splitlines()[4], "nan" + text.splitlines()[4][6:]), "recorded.csv:5: 'nan"),
    ]:
        rows.write_text(changed)
        refused(CONFIG + f"    joints: {{active_joints: [{', '.join(JOINTS)}]}}\n", expected)
    # what the recording leaves out is at 0, unless the configuration says that it moves
    q3 = [line.split(",") for line in text.splitlines()]
    rows.write_text("\n".join(",".join(row[:5] + row[6:]) for row in q3))
    config.write_text(CONFIG.replace(", validation_data_file: data/more.csv", ""))
    assert interoperate.figaroh_campaign(config, urdf).poses == 60


def test_a_robot_that_is_no_urdf_has_no_origins() -> None:
    with pytest.raises(rodcal.NotApplicableError, match="no URDF"):
        interoperate.origin_offsets(rodcal.calibrate("campaigns/tx90-5/campaign.toml"), "robots/six-axis.urdf")
