"""Recordings of FIGAROH as campaigns, and calibrated robots as offsets for xacro and for PAL's robots.

FIGAROH (https://pypi.org/project/figaroh, 1.0 is what this was written against) keeps what a
calibration is in a YAML file (``tasks: calibration:``) and what was recorded in a CSV: ``x1``, ``y1``,
``z1`` in m for the first marker, and a column for each joint by its name in the URDF, in rad (m of
prismatic joints).
"""

from __future__ import annotations

import csv
import io
import math
import os
import pathlib
import re
import warnings
from collections.abc import Mapping
from typing import Any
from xml.etree import ElementTree
from xml.sax.saxutils import quoteattr

from . import _rodcal
from ._arguments import shown
from ._errors import InputError, NotApplicableError, RodcalWarning
from .inputs import Campaign, PathLike, Robot
from .results import CalibrationResult

__all__ = ["figaroh_campaign", "master_calibration", "origin_offsets", "xacro_offsets"]

#: What an offset is added to: the numbers of a joint's ``<origin xyz rpy>``, m and rad.
AXES = ("dx", "dy", "dz", "droll", "dpitch", "dyaw")


def figaroh_campaign(
    config: PathLike | Mapping[str, Any], urdf: PathLike, *, marker: int = 1, directory: PathLike | None = None
) -> Campaign:
    """The campaign that a FIGAROH configuration describes: `calibrate` and all others take it.

    ``config`` is the YAML file (PyYAML has to be installed) or a dict with its keys; ``directory`` is
    where its data files are seen from: the folder of the file, or the one above, whichever has them.
    Positions of one ``marker`` are taken, orientations are not. Joints of the chain without a column
    are at 0, as FIGAROH has them. ``base_pose`` and ``tool_pose`` are first guesses; validation data are
    predicted with nothing re-fitted.
    """
    folders = [pathlib.Path(".")] if directory is None else [pathlib.Path(directory)]
    name = "<config>"
    if not isinstance(config, Mapping):
        name = os.fspath(config)
        own = pathlib.Path(config).parent
        folders = [own, own.parent] if directory is None else folders
        config = _yaml(pathlib.Path(config))
    task = _table(name, config, "tasks", "calibration")
    if _table(name, task, "eye_hand", optional=True).get("enabled"):
        raise NotApplicableError(f"{name}: a camera's calibration (eye_hand) is not one of a campaign", name)
    markers = _table(name, task, "measurements").get("markers")
    if not isinstance(markers, list) or not 1 <= marker <= len(markers):
        found, expected = f"{len(markers) if isinstance(markers, list) else 'no'} markers", f"marker {marker}"
        raise _wrong(name, "measurements.markers", found, expected)
    seen = markers[marker - 1].get("measurable_dof", [True] * 3) if isinstance(markers[marker - 1], dict) else []
    if not isinstance(seen, list) or any(part is not True for part in seen[:3]) or len(seen) < 3:
        raise _wrong(name, "measurable_dof", shown(seen), "[true, true, true, …]: a marker's position")
    if any(part is True for part in seen[3:]):
        warnings.warn(f"{name}: orientations of the marker are not used", RodcalWarning, stacklevel=2)
    if len(markers) > 1:
        words = f"{name}: marker {marker} of {len(markers)} is taken, the others are not"
        warnings.warn(words, RodcalWarning, stacklevel=2)

    kinematics = _table(name, task, "kinematics")
    text = _rodcal.read_text(urdf)
    tip = kinematics.get("tool_frame")
    if not isinstance(tip, str) or not tip:
        raise _wrong(name, "kinematics.tool_frame", shown(tip), "a link of the URDF")
    base, tip, joints = _chain(os.fspath(urdf), text, kinematics.get("base_frame", "universe"), tip)
    robot = Robot.read(urdf, base_link=base, tip_link=tip)
    active = _table(name, task, "joints", optional=True).get("active_joints") or []
    if not isinstance(active, list) or not all(isinstance(joint, str) for joint in active):
        raise _wrong(name, "joints.active_joints", shown(active), "names of joints in a list")
    unknown = [joint for joint in active if joint not in joints]
    if unknown:
        raise _wrong(name, "joints.active_joints", shown(unknown[0]), f"joints from {base} to {tip}: {', '.join(joints)}")

    keys: dict[str, Any] = {"robot": robot}
    poses = _table(name, task, "measurements", "poses", optional=True)
    at = {key: _pose(name, key, poses.get(key)) for key in ("base_pose", "tool_pose")}
    if at["base_pose"]:
        keys["base"] = at["base_pose"]
    if at["tool_pose"]:
        keys["tool"] = {"xyz_mm": at["tool_pose"]["xyz_mm"]}
    data = _table(name, task, "data")
    for role, key in (("measurements", "source_file"), ("validation", "validation_data_file")):
        file = data.get(key)
        if file:
            path = _found(name, f"data.{key}", file, folders)
            keys[role] = _recorded(path, joints, active, robot.columns, marker)
    if "measurements" not in keys:
        raise _wrong(name, "data.source_file", "missing", "the CSV of the recording")
    if "validation" in keys:
        keys["validation_refit"] = "none"
    return Campaign(keys)


def origin_offsets(result: CalibrationResult, nominal: PathLike) -> dict[str, dict[str, float]]:
    """What the calibration adds to the ``<origin>`` of each joint of the ``nominal`` URDF.

    ``offsets["elbow_joint"]["dyaw"]`` in rad, ``dx`` in m: numbers to be added to xyz and rpy as they
    stand in the file. Joints that keep their origin are left out. What the nominal URDF has no joint
    for (the tip, where ``tip_link`` is what the last joint moves) is in ``files["calibrated.urdf"]``
    alone.
    """
    calibrated = result.files.get("calibrated.urdf")
    if calibrated is None:
        raise NotApplicableError("the robot of this calibration is no URDF: offsets of origins are those of one")
    before, after = (_origins(_xml(name, text)) for name, text in (
        (os.fspath(nominal), _rodcal.read_text(nominal)),
        ("calibrated.urdf", calibrated.decode()),
    ))  # fmt: skip
    offsets: dict[str, dict[str, float]] = {}
    for joint, (axis, numbers) in after.items():
        if joint not in before:
            continue
        if before[joint][0] != axis:
            raise NotApplicableError(f"joint {joint} has another axis: this is not the URDF that was calibrated")
        added = [new - old for new, old in zip(numbers, before[joint][1])]
        added[3:] = [math.remainder(angle, math.tau) for angle in added[3:]]
        if any(added):
            offsets[joint] = dict(zip(AXES, added))
    return offsets


def xacro_offsets(result: CalibrationResult, nominal: PathLike) -> str:
    """The offsets as a file of xacro properties, ``elbow_joint_dyaw`` in rad, ``elbow_joint_dx`` in m.

    Include it, and write ``rpy="${r + elbow_joint_droll} …"`` in the joint's ``<origin>``.
    """
    lines = ['<robot xmlns:xacro="http://www.ros.org/wiki/xacro">']
    known: dict[str, str] = {}
    for joint, offset in origin_offsets(result, nominal).items():
        # what may stand in an expression ${…}
        name = re.sub(r"\W", "_", joint, flags=re.ASCII)
        name = f"_{name}" if name[:1].isdigit() else name
        if known.setdefault(name, joint) != joint:
            raise NotApplicableError(f"joints {known[name]} and {joint} would have the same properties {name}_…")
        for axis, value in offset.items():
            lines.append(f"  <xacro:property name={quoteattr(f'{name}_{axis}')} value={quoteattr(repr(value))}/>")
    return "\n".join([*lines, "</robot>"]) + "\n"


def master_calibration(result: CalibrationResult, nominal: PathLike) -> str:
    """The offsets as the file that PAL's robots read and FIGAROH writes (YAML).

    ``robot_state_publisher: geometric_calibration: arm_1_dyaw: …``; names without ``_joint``.
    """
    lines = ["robot_state_publisher:", "  geometric_calibration:"]
    values: dict[str, float] = {}
    for joint, offset in origin_offsets(result, nominal).items():
        for axis, value in offset.items():
            key = f"{joint.removesuffix('_joint')}_{axis}"
            if key in values:
                raise NotApplicableError(f"two joints would have the same key {key}")
            values[key] = value
    if not values:
        lines[-1] += " {}"
    lines += [f"    {_yaml_text(key)}: {_yaml_number(values[key])}" for key in sorted(values)]
    return "\n".join(lines) + "\n"


# The configuration.


def _yaml(file: pathlib.Path, above: tuple[pathlib.Path, ...] = ()) -> Mapping[str, Any]:
    """A YAML file over the one that it extends."""
    try:
        import yaml  # type: ignore[import-untyped, unused-ignore]
    except ImportError as missing:
        raise ImportError("FIGAROH's files need PyYAML, which is not installed: pip install pyyaml") from missing
    name = str(file)
    if file.resolve() in above or len(above) > 10:
        raise InputError(f"{name}: it extends itself", name)
    try:
        content = yaml.safe_load(_rodcal.read_text(file))
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        line, column = (None, None) if mark is None else (mark.line + 1, mark.column + 1)
        problem = getattr(error, "problem", None) or "no YAML"
        place = name if line is None else f"{name}:{line}:{column}"
        raise InputError(f"{place}: {problem}", name, line, column) from error
    except RecursionError as error:
        raise InputError(f"{name}: it is nested too deep", name) from error
    if not isinstance(content, dict):
        raise InputError(f"{name}: expected FIGAROH's keys, such as tasks", name, expected="FIGAROH's keys")
    extends = content.pop("extends", None)
    if extends is None:
        return content
    if not isinstance(extends, str):
        raise _wrong(name, "extends", shown(extends), "the name of a file")
    places = [file.parent / extends]
    if extends.startswith("templates/"):
        places = [folder / extends for folder in list(file.absolute().parents)[:3]]
    parent = next((place for place in places if place.exists()), places[0])
    return _merged(_yaml(parent, (*above, file.resolve())), content)


def _merged(base: Mapping[str, Any], over: Mapping[str, Any]) -> dict[str, Any]:
    """What stands in ``over``, and what stands in ``base`` alone; lists are replaced."""
    merged = dict(base)
    for key, value in over.items():
        known = merged.get(key)
        both = isinstance(known, dict) and isinstance(value, dict)
        merged[key] = _merged(known, value) if both and known is not None else value
    return merged


def _wrong(name: str, key: str, found: str, expected: str) -> InputError:
    return InputError(f"{name}: {key} is {found}, expected {expected}", name, found=found, expected=expected)


def _table(name: str, config: Mapping[str, Any], *keys: str, optional: bool = False) -> Mapping[str, Any]:
    found: Any = config
    for key in keys:
        found = found.get(key) if isinstance(found, Mapping) else None
    if found is None and optional:
        return {}
    if not isinstance(found, Mapping):
        is_found = "missing" if found is None else shown(found)
        raise _wrong(name, ".".join(keys), is_found, "a table, as FIGAROH's unified configuration has it")
    return found


def _pose(name: str, key: str, pose: Any) -> dict[str, list[float]] | None:
    """``[x, y, z, roll, pitch, yaw]`` in m and rad, in the campaign's units."""
    if pose is None:
        return None
    numbers = [x for x in pose if isinstance(x, (int, float)) and math.isfinite(x)] if isinstance(pose, list) else []
    if len(numbers) != 6 or len(pose) != 6:
        raise _wrong(name, key, shown(pose), "[x, y, z, roll, pitch, yaw] in m and rad")
    return {"xyz_mm": [x * 1e3 for x in numbers[:3]], "rpy_deg": [math.degrees(x) for x in numbers[3:]]}


def _found(name: str, key: str, file: Any, folders: list[pathlib.Path]) -> pathlib.Path:
    if not isinstance(file, str) or "${" in file:
        raise _wrong(name, key, shown(file), "the name of a CSV")
    places = [folder / file for folder in folders]
    return next((place for place in places if place.exists()), places[0])


# The recording.


def _recorded(
    path: pathlib.Path, joints: dict[str, bool], active: list[str], columns: list[str], marker: int
) -> dict[str, list[float]]:
    """Joint values and positions of a CSV as columns of a recording."""
    name = str(path)
    rows = list(csv.reader(io.StringIO(_rodcal.read_text(path))))
    header = [cell.strip() for cell in rows[0]] if rows else []
    wanted = {f"{axis}{marker}": (f"{axis}_mm", 1e3) for axis in "xyz"}
    for (joint, turns), column in zip(joints.items(), columns):
        if joint in header or joint in active:
            wanted[joint] = (column, 180 / math.pi if turns else 1e3)
    place: dict[str, int] = {}
    for column in wanted:
        if header.count(column) != 1:
            found = "no column" if column not in header else "two columns"
            expected = f"one {column!r} in the header"
            raise InputError(f"{name}:1: {found}, expected {expected}", name, 1, None, found, expected)
        place[column] = header.index(column)
    table: dict[str, list[float]] = {key: [] for key, _ in wanted.values()}
    count = 0
    for line, row in enumerate(rows[1:], start=2):
        if not any(cell.strip() for cell in row):
            continue
        count += 1
        for column, (key, unit) in wanted.items():
            cell = row[place[column]] if place[column] < len(row) else ""
            try:
                value = float(cell)
            except ValueError:
                value = math.nan
            if not math.isfinite(value):
                found, expected = f"{cell.strip()!r:.50} as {column}", "a number, m or rad"
                raise InputError(f"{name}:{line}: {found}, expected {expected}", name, line, place[column] + 1, found, expected)
            table[key].append(value * unit)
    still = [column for column in columns if column not in table]
    return table | {column: [0.0] * count for column in still}


# URDFs. What is read here was read by the library before, which refuses what is no URDF.


def _xml(name: str, text: str) -> ElementTree.Element:
    if "<!DOCTYPE" in text or "<!ENTITY" in text:
        raise InputError(f"{name}: a document type, expected a URDF without one", name)
    try:
        return ElementTree.fromstring(text)
    except ElementTree.ParseError as error:
        line, column = error.position
        raise InputError(f"{name}:{line}:{column + 1}: {error}", name, line, column + 1) from error


def _chain(name: str, text: str, base: str, tip: str) -> tuple[str, str, dict[str, bool]]:
    """First and last link, and the joints between that move: true where they turn."""
    root = _xml(name, text)
    by_child = {child.get("link"): joint for joint in root.findall("joint") if (child := joint.find("child")) is not None}
    by_name = {joint.get("name"): link for link, joint in by_child.items()}
    # a frame may be named by the joint that moves it
    links = {link.get("name") for link in root.findall("link")}
    tip = tip if tip in links else by_name.get(tip) or tip
    for key, frame in (("base_frame", base), ("tool_frame", tip)):
        if frame not in links and not (key == "base_frame" and frame == "universe"):
            raise _wrong(name, f"kinematics.{key}", f"{frame!r}, which is not there", "a link of this URDF")
    joints: dict[str, bool] = {}
    link: str | None = tip
    while (base == "universe" or link != base) and link in by_child:
        joint = by_child.pop(link)
        if joint.get("type") != "fixed":
            joints[str(joint.get("name"))] = joint.get("type") != "prismatic"
        parent = joint.find("parent")
        link = None if parent is None else parent.get("link")
    return (link or tip) if base == "universe" else base, tip, dict(reversed(joints.items()))


def _origins(root: ElementTree.Element) -> dict[str, tuple[str, list[float]]]:
    """Axis and origin of each joint as they are written."""
    origins: dict[str, tuple[str, list[float]]] = {}
    for joint in root.findall("joint"):
        origin, axis = joint.find("origin"), joint.find("axis")
        written = {} if origin is None else origin.attrib
        numbers = [float(x) for key in ("xyz", "rpy") for x in written.get(key, "0 0 0").split()]
        origins[str(joint.get("name"))] = ("" if axis is None else axis.get("xyz", ""), numbers)
    return origins


def _yaml_text(text: str) -> str:
    return text if re.fullmatch(r"[A-Za-z_]\w*", text, flags=re.ASCII) else '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'


def _yaml_number(value: float) -> str:
    """YAML 1.1 takes ``1e-05`` for a text."""
    mantissa, _, exponent = repr(value).partition("e")
    if not exponent:
        return mantissa
    return f"{mantissa if '.' in mantissa else mantissa + '.0'}e{exponent}"
