"""Rods, readings, robots and campaigns: from files, or from dicts and arrays with the same keys."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any, Union

import numpy as np

from . import _rodcal, _text
from ._errors import InputError

#: A file's name.
PathLike = Union[str, "os.PathLike[str]"]
#: A dict of columns, a structured array or a pandas DataFrame.
Table = Any
#: An array of numbers.
Array = np.ndarray[tuple[Any, ...], np.dtype[np.float64]]


class Rod:
    """A measuring rod: pipes, bend, masses, joints.

    ``Rod(data)`` takes a dict with the keys of the rod file (``docs/rod-file.md``), lengths in mm;
    `Rod.read` takes the file.

    >>> pipe = {"material": "steel", "outer_diameter_mm": 32.0, "inner_diameter_mm": 30.0}
    >>> rod = Rod({
    ...     "name": "5#",
    ...     "geometry": {"l1_mm": 150.0, "l2_mm": 525.0},
    ...     "material": {"steel": {"youngs_modulus_gpa": 193.0, "poisson_ratio": 0.29, "density_kg_m3": 7930.0}},
    ...     "pipe1": pipe,
    ...     "pipe2": pipe,
    ...     "tip": {"mass_g": 60.0},
    ... })
    >>> rod.tip_mm.tolist(), round(rod.mass_g, 1)
    ([525.0, 0.0, 150.0], 581.3)
    """

    _native: _rodcal.Rod

    def __init__(self, data: Mapping[str, Any]) -> None:
        self._native = _rodcal.Rod.from_text("<rod>", _text.toml(data))

    @classmethod
    def read(cls, path: PathLike) -> Rod:
        """Reads a rod file (TOML)."""
        return cls._of(_rodcal.Rod.read(os.fspath(path)))

    @classmethod
    def from_toml(cls, text: str) -> Rod:
        """A rod from the text of a rod file."""
        return cls._of(_rodcal.Rod.from_text("<toml>", text))

    @classmethod
    def _of(cls, native: _rodcal.Rod) -> Rod:
        rod = cls.__new__(cls)
        rod._native = native
        return rod

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickled with its text; where it is read again it needs no file."""
        return _rod_of_text, (self._native.path or "<rod>", self._native.text)

    @property
    def name(self) -> str:
        """Its name."""
        return self._native.name

    @property
    def length_mm(self) -> float:
        """Arc length of the centreline from the flange to the ball's centre, mm."""
        return self._native.length_m * 1e3

    @property
    def mass_g(self) -> float:
        """Mass of pipes, ball and all that hangs on them, g."""
        return self._native.mass_kg * 1e3

    @property
    def tip_mm(self) -> Array:
        """Centre of the ball in {T}, mm, shape (3,)."""
        return np.array(self._native.tip_m) * 1e3

    def to_toml(self) -> str:
        """The rod as the text of a rod file."""
        return self._native.to_toml()

    def __repr__(self) -> str:
        return f"<Rod {self.name!r}: {self.length_mm:.1f} mm, {self.mass_g:.1f} g>"


#: What the header of readings may say.
_HEADER = ("driven", "noise_um", "noise_n", "load_scale_percent", "sensor_scale_percent")


class Readings:
    """Readings of a rig: how far the rod's tip moved under each load.

    ``Readings(table)`` takes columns as of the file (``docs/rig.md``): ``axis`` (``"x"``, ``"-z"``),
    ``load_n`` or ``load_kg``, ``dx_um``, ``dy_um``, ``dz_um`` or ``dxyz_um`` of shape (n, 3), NaN
    where nothing was read; `Readings.read` takes the file. What the comment lines of a file say,
    ``header`` says: ``{"noise_um": 1.5}``.

    >>> readings = Readings({"axis": ["y"] * 3, "load_n": [5, 10, 15], "dy_um": [180.0, 405.0, 630.0]})
    >>> len(readings)
    3
    """

    _native: _rodcal.Readings

    def __init__(self, table: Table, *, header: Mapping[str, Any] | None = None) -> None:
        unknown = [key for key in header or {} if key not in _HEADER]
        if unknown:
            found, expected = f"`{unknown[0]}` in the header", f"one of {', '.join(_HEADER)}"
            raise InputError(f"<readings>: {found}, expected {expected}", "<readings>", found=found, expected=expected)
        above = "".join(f"# {line}\n" for line in _text.toml(header or {}).splitlines())
        text = above + _text.csv_text(table, "<readings>")
        self._native = _rodcal.Readings.from_text("<readings>", text)

    @classmethod
    def read(cls, path: PathLike) -> Readings:
        """Reads a file of readings (CSV)."""
        return cls._of(_rodcal.Readings.read(os.fspath(path)))

    @classmethod
    def from_csv(cls, text: str) -> Readings:
        """Readings from the text of a file."""
        return cls._of(_rodcal.Readings.from_text("<readings>", text))

    @classmethod
    def _of(cls, native: _rodcal.Readings) -> Readings:
        readings = cls.__new__(cls)
        readings._native = native
        return readings

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickled with their text; where they are read again they need no file."""
        return _readings_of_text, (self._native.file, self._native.text)

    def __len__(self) -> int:
        return len(self._native)

    def to_csv(self) -> str:
        """The text that they were read from."""
        return self._native.text

    def __repr__(self) -> str:
        return f"<Readings {self._native.file}: {len(self)} rows>"


class Robot:
    """A robot: a chain of joints with links, masses, limits, and how well all of it is known.

    ``Robot(data)`` takes a dict with the keys of the robot file (``docs/robot-file.md``);
    `Robot.read` takes a robot file or a URDF; ``Robot.read("builtin:tx90")`` is one that the package
    carries.

    >>> link = {"d_mm": 0.0, "alpha_deg": 0.0, "beta_deg": 0.0, "theta_offset_deg": 0.0}
    >>> arm = Robot({"name": "arm", "joint": [{"a_mm": 400.0, **link}, {"a_mm": 300.0, **link}]})
    >>> arm.columns
    ['q1_deg', 'q2_deg']
    """

    _native: _rodcal.Robot

    def __init__(self, data: Mapping[str, Any]) -> None:
        self._native = _rodcal.Robot.from_text("<robot>", _text.toml(data), None, None, None, None)

    @classmethod
    def read(
        cls,
        path: PathLike,
        *,
        base_link: str | None = None,
        tip_link: str | None = None,
        effects: PathLike | None = None,
        corrections: PathLike | None = None,
    ) -> Robot:
        """Reads a robot file (TOML) or a URDF, there from ``base_link`` to ``tip_link``.

        ``effects`` (TOML) and ``corrections`` (CSV) are what a calibration writes beside a URDF.
        """
        file = os.fspath(path)
        if file.startswith("builtin:"):
            return cls._of(_rodcal.Robot.named(file))
        more = [None if name is None else os.fspath(name) for name in (effects, corrections)]
        beside, table = [None if name is None else (name, _rodcal.read_text(name)) for name in more]
        text = _rodcal.read_text(file)
        return cls._of(_rodcal.Robot.from_text(file, text, base_link, tip_link, beside, table))

    @classmethod
    def from_text(
        cls,
        text: str,
        *,
        base_link: str | None = None,
        tip_link: str | None = None,
        effects: str | None = None,
    ) -> Robot:
        """A robot from the text of a robot file or of a URDF, with the text of what stands beside it."""
        beside = None if effects is None else ("<effects>", effects)
        return cls._of(_rodcal.Robot.from_text("<text>", text, base_link, tip_link, beside, None))

    @classmethod
    def _of(cls, native: _rodcal.Robot) -> Robot:
        robot = cls.__new__(cls)
        robot._native = native
        return robot

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickled with its texts; where it is read again it needs no file."""
        return _robot_of_texts, self._native.texts

    @property
    def name(self) -> str:
        """Its name."""
        return self._native.name

    @property
    def columns(self) -> list[str]:
        """Its joints' columns in tables: ``q1_deg``, or ``q3_mm`` of a prismatic joint."""
        return self._native.columns

    @property
    def text(self) -> str:
        """The text of its file."""
        return self._native.text

    def __repr__(self) -> str:
        return f"<Robot {self.name!r}: {len(self.columns)} joints>"


class Campaign:
    """A calibration run: a robot, its rod, and what was recorded with it.

    ``Campaign(robot=…, measurements=…, …)`` takes the keys of the campaign file
    (``docs/campaign-file.md``), where ``robot``, ``rod`` and ``rig`` may be objects of this package,
    and ``measurements`` and ``validation`` tables: ``q_deg`` of shape (n, joints) in degrees (mm of
    prismatic joints), ``xyz_mm`` of shape (n, 3), ``clamp`` and the other columns of the files.
    Names are files, seen from the current directory. `Campaign.read` takes a campaign file.

    A planar arm, the first link of which is 1 mm longer than its drawing says:

    >>> import numpy as np
    >>> link = {"d_mm": 0.0, "alpha_deg": 0.0, "beta_deg": 0.0, "theta_offset_deg": 0.0}
    >>> arm = Robot({"name": "arm", "joint": [{"a_mm": 400.0, **link}, {"a_mm": 300.0, **link}]})
    >>> q = np.stack([np.linspace(0, 330, 30), np.linspace(90, -400, 30)], axis=1)
    >>> first, both = np.radians(q[:, 0]), np.radians(q.sum(axis=1))
    >>> x, y = 401 * np.cos(first) + 300 * np.cos(both), 401 * np.sin(first) + 300 * np.sin(both)
    >>> campaign = Campaign(robot=arm, measurements={"q_deg": q, "xyz_mm": np.stack([x, y, 0 * x], axis=1)})
    >>> campaign.poses
    30
    """

    _native: _rodcal.Campaign

    def __init__(self, data: Mapping[str, Any] | None = None, /, *, plan: bool = False, **keys: Any) -> None:
        keys = {**(data or {}), **keys}
        texts: dict[str, str] = {}
        _name_robot(keys, texts)
        rod, rig = keys.get("rod"), keys.get("rig")
        if isinstance(rod, Mapping):
            rod = Rod(rod)
        if isinstance(rod, Rod):
            keys["rod"] = rod._native.path or "<rod>"
            texts[keys["rod"]] = rod._native.text
        if isinstance(rig, Readings):
            keys["rig"] = rig._native.file
            texts[rig._native.file] = rig.to_csv()
        elif rig is not None and not isinstance(rig, (str, os.PathLike)):
            keys["rig"], texts["<readings>"] = "<readings>", _text.csv_text(rig, "<readings>")
        for role in ("measurements", "validation"):
            table = keys.get(role)
            if table is not None and not isinstance(table, (str, os.PathLike)):
                keys[role], texts[f"<{role}>"] = f"<{role}>", _recorded(table, f"<{role}>")
        paths = {key: os.fspath(value) for key, value in keys.items() if isinstance(value, os.PathLike)}
        text = _text.toml({**keys, **paths})
        self._native = _rodcal.Campaign.from_texts("<campaign>", text, texts, plan)

    @classmethod
    def read(cls, path: PathLike, *, plan: bool = False) -> Campaign:
        """Reads a campaign file and all that it names; of a ``plan`` the recordings may be missing."""
        return cls._of(_rodcal.Campaign.read(os.fspath(path), plan))

    @classmethod
    def _of(cls, native: _rodcal.Campaign) -> Campaign:
        campaign = cls.__new__(cls)
        campaign._native = native
        return campaign

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickled with all texts that it was read from; where it is read again it needs no file."""
        return _campaign_of_texts, self._native.texts

    @property
    def file(self) -> str:
        """Its file, ``<campaign>`` where it was built in memory."""
        return self._native.file

    @property
    def robot_name(self) -> str:
        """Name of its robot."""
        return self._native.robot

    @property
    def rod_name(self) -> str | None:
        """Name of its rod, where it has one."""
        return self._native.rod

    @property
    def columns(self) -> list[str]:
        """The columns of its robot's joint values."""
        return self._native.columns

    @property
    def mode(self) -> str:
        """How the rod's deflection is known unless somebody says otherwise."""
        return self._native.mode

    @property
    def poses(self) -> int:
        """Number of recorded poses."""
        return self._native.poses

    @property
    def validation_poses(self) -> int:
        """Number of poses of the validation."""
        return self._native.validation_poses

    @property
    def pose_names(self) -> list[str]:
        """Names of the recorded poses, in the order of recording."""
        return self._native.pose_names

    def __repr__(self) -> str:
        rod = "" if self.rod_name is None else f", rod {self.rod_name}"
        return f"<Campaign {self.file}: {self.robot_name}{rod}, {self.poses} poses>"


# By which inputs are unpickled.


def _rod_of_text(file: str, text: str) -> Rod:
    return Rod._of(_rodcal.Rod.from_text(file, text))


def _readings_of_text(file: str, text: str) -> Readings:
    return Readings._of(_rodcal.Readings.from_text(file, text))


def _robot_of_texts(*texts: Any) -> Robot:
    return Robot._of(_rodcal.Robot.from_text(*texts))


def _campaign_of_texts(file: str, text: str, texts: dict[str, str], plan: bool) -> Campaign:
    return Campaign._of(_rodcal.Campaign.from_texts(file, text, texts, plan))


def _name_robot(keys: dict[str, Any], texts: dict[str, str]) -> None:
    """Puts the name of the robot into the keys, and its text beside the others."""
    robot = keys.get("robot")
    if isinstance(robot, Mapping):
        robot = Robot(robot)
    if not isinstance(robot, Robot):
        return
    native = robot._native
    if native.texts[-1] is not None:
        found, expected = "a robot with a table of corrections", "a robot without: a campaign has no place for one"
        raise InputError(f"`robot` is {found}, expected {expected}", found=found, expected=expected)
    keys["robot"] = native.file
    texts[native.file] = native.text
    for key, link in zip(("base_link", "tip_link"), native.links):
        keys.setdefault(key, link)
    if native.beside is not None:
        keys["effects"], texts["<effects>"] = "<effects>", native.beside


def _recorded(table: Table, name: str) -> str:
    """A recording as CSV; poses without names are numbered."""
    columns = _text.columns_of(table, name)
    if columns and not any(key.lower() == "pose" for key in columns):
        count = len(next(iter(columns.values())))
        columns = {"pose": [str(number) for number in range(1, count + 1)], **columns}
    return _text.csv_of(columns)


def as_rod(rod: Rod | Mapping[str, Any] | PathLike) -> Rod:
    """A rod, whatever it is given as."""
    if isinstance(rod, Rod):
        return rod
    return Rod(rod) if isinstance(rod, Mapping) else Rod.read(rod)


def as_readings(readings: Readings | Table | PathLike) -> Readings:
    """Readings, whatever they are given as."""
    if isinstance(readings, Readings):
        return readings
    return Readings.read(readings) if isinstance(readings, (str, os.PathLike)) else Readings(readings)


def as_robot(robot: Robot | Mapping[str, Any] | PathLike) -> Robot:
    """A robot, whatever it is given as."""
    if isinstance(robot, Robot):
        return robot
    return Robot(robot) if isinstance(robot, Mapping) else Robot.read(robot)


def as_campaign(campaign: Campaign | Mapping[str, Any] | PathLike, plan: bool = False) -> Campaign:
    """A campaign, whatever it is given as."""
    if isinstance(campaign, Campaign):
        return campaign
    if isinstance(campaign, Mapping):
        return Campaign(campaign, plan=plan)
    return Campaign.read(campaign, plan=plan)


def joint_table(joints: Any, columns: list[str], name: str) -> tuple[str, str]:
    """Poses as a named table: an array of shape (n, joints), a table with joint columns, or a file."""
    if isinstance(joints, (str, os.PathLike)):
        return os.fspath(joints), _rodcal.read_text(os.fspath(joints))
    if isinstance(joints, Mapping) or hasattr(joints, "columns") or getattr(getattr(joints, "dtype", None), "names", None):
        return name, _recorded(joints, name)
    array = joint_array(joints, len(columns), name)
    return name, _recorded({column: array[:, k] for k, column in enumerate(columns)}, name)


def joint_array(joints: Any, count: int, name: str) -> Array:
    """Poses as an array of shape (n, joints); one pose may be a row of numbers."""
    if isinstance(joints, np.ma.MaskedArray):
        plain = np.array(joints.data, dtype=np.float64)
        plain[np.ma.getmaskarray(joints)] = np.nan
        joints = plain
    if np.iscomplexobj(joints):
        raise InputError(f"{name} is complex, expected real numbers", found="complex", expected="real numbers")
    array = np.atleast_2d(np.asarray(joints, dtype=np.float64))
    if array.ndim != 2 or array.shape[1] != count:
        found, expected = f"of shape {np.shape(joints)}", f"of shape (n, {count}): a column for each joint"
        raise InputError(f"{name} is {found}, expected {expected}", found=found, expected=expected)
    return array
