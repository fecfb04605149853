"""Answers: typed objects whose attributes are the keys of the commands' JSON.

Units stand in the names (``um`` is µm, ``urad`` µrad); arrays are ``float64``, NaN where there is
no number.
"""

from __future__ import annotations

import functools
import math
import os
import types
import typing
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Union

import numpy as np

from . import _rodcal
from ._errors import InputError, in_python
from .inputs import Array, Campaign, PathLike, Robot

if TYPE_CHECKING:
    import pandas


class Record:
    """A part of an answer: its keys as attributes."""

    def __init__(self, data: Mapping[str, Any]) -> None:
        for name, kind in _kinds(type(self)).items():
            setattr(self, name, _as(kind, data.get(name), f"{type(self).__name__}.{name}"))

    def __repr__(self) -> str:
        shown = (f"{name}={value!r}" for name, value in vars(self).items() if not name.startswith("_"))
        return f"{type(self).__name__}({', '.join(shown)})"


_KNOWN: dict[type, dict[str, Any]] = {}


def _kinds(record: type) -> dict[str, Any]:
    """The attributes of a record and what they are, by its annotations."""
    if record not in _KNOWN:
        hints = typing.get_type_hints(record)
        _KNOWN[record] = {name: kind for name, kind in hints.items() if not name.startswith("_")}
    return _KNOWN[record]


def _as(kind: Any, value: Any, name: str) -> Any:
    """A value of the JSON as what the attribute's annotation says."""
    origin, arguments = typing.get_origin(kind), typing.get_args(kind)
    if origin in (Union, types.UnionType):
        (inner,) = (argument for argument in arguments if argument is not type(None))
        return None if value is None else _as(inner, value, name)
    if kind is Any:
        return value
    if value is None and kind is float:
        return math.nan
    if value is None:
        raise TypeError(f"the answer has no {name}")
    if kind == Array:
        return _kept(np.array(value, dtype=np.float64))
    if origin is list:
        return [_as(arguments[0], item, name) for item in value]
    if origin is tuple:
        return tuple(value)
    if origin is dict:
        return {key: _as(arguments[1], item, name) for key, item in value.items()}
    if isinstance(kind, type) and issubclass(kind, Record):
        return kind(value)
    return float(value) if kind is float else value


def _kept(array: Array) -> Array:
    """An answer is what it was: whoever wants to change it copies it."""
    array.flags.writeable = False
    return array


class Result(Record):
    """An answer with its report.

    In a notebook it shows the report's overview, pictures and tables.
    """

    _answer: _rodcal.Answer

    def __init__(self, answer: _rodcal.Answer) -> None:
        self._answer = answer
        super().__init__(answer.to_dict())

    @property
    def title(self) -> str:
        """What was done."""
        return in_python(self._answer.title)

    @property
    def headline(self) -> str:
        """The answer in a sentence or two, with numbers and units."""
        return in_python(self._answer.headline)

    @property
    def warnings(self) -> list[str]:
        """What has to be known before it is trusted."""
        return [in_python(warning) for warning in self._answer.warnings]

    @property
    def files(self) -> dict[str, bytes]:
        """Names and contents of what belongs to the answer beside its report: rods, robots, poses."""
        return self._answer.files

    def to_dict(self) -> dict[str, Any]:
        """The JSON that the command prints with ``--json``."""
        return self._answer.to_dict()

    def to_dataframe(self) -> pandas.DataFrame:
        """The answer's main table; needs pandas."""
        return _frame(self._rows())

    def to_html(self) -> str:
        """The report as a piece of a page."""
        return in_python(self._answer.html())

    def to_text(self, columns: int = 100) -> str:
        """The report as the command prints it."""
        return in_python(self._answer.text(columns))

    def write(self, directory: PathLike, *, force: bool = False) -> None:
        """Writes the report into a folder, as ``--out`` does: page, pictures, tables, ``result.json``.

        Files that rodcal did not write, or that were changed since, stay (`FileError`), unless
        ``force``.
        """
        place = os.fspath(directory)
        if not place:
            raise InputError("`directory` is '', expected a folder's name", found="''", expected="a folder's name")
        self._answer.write(place, force)

    def _rows(self) -> list[dict[str, Any]]:
        raise NotImplementedError

    def _repr_html_(self) -> str:
        return self.to_html()

    def __str__(self) -> str:
        return self.to_text()

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {self.headline}>"


def _flat(row: Mapping[str, Any], before: str = "") -> dict[str, Any]:
    flat: dict[str, Any] = {}
    for key, value in row.items():
        if isinstance(value, Mapping):
            flat.update(_flat(value, f"{before}{key}."))
        else:
            flat[f"{before}{key}"] = value
    return flat


def _frame(table: list[dict[str, Any]] | dict[str, Any]) -> pandas.DataFrame:
    """Of rows, or of columns."""
    try:
        import pandas
    except ImportError as missing:
        raise ImportError("to_dataframe needs pandas: pip install pandas") from missing
    return pandas.DataFrame([_flat(row) for row in table] if isinstance(table, list) else table)


class Contribution(Record):
    """What the model is worth up to one of its terms."""

    term: str
    cf_um_per_n: Array
    cg_um_per_g: Array
    c_rod_um: float


class Stations(Record):
    """How one point of a rod moves under a force at another."""

    load_station_mm: float
    read_station_mm: float
    displacement_um_per_n: Array
    rotation_urad_per_n: Array


class ComplianceResult(Result):
    """How much a rod bends: ``cf_um_per_n[m, n]`` is the tip's offset along axis m, µm, per newton
    along axis n of {T}; ``cg_um_per_g`` the same under the rod's own weight, one g along axis n."""

    rod: str
    mode: str
    theory: str | None
    elements: int | None
    cf_um_per_n: Array
    cg_um_per_g: Array
    c_rod_um: float
    contact_force_n: float
    tip_mm: Array
    mass_g: float
    natural_frequencies_hz: Array | None
    settling_times_s: Array | None
    contributions: list[Contribution]
    stations: Stations | None

    def _rows(self) -> list[dict[str, Any]]:
        """Offsets along x, y, z, for each load."""
        both = np.hstack([self.cf_um_per_n, self.cg_um_per_g])
        names = [f"cf_{n}_um_per_n" for n in "xyz"] + [f"cg_{n}_um_per_g" for n in "xyz"]
        return [{"axis": axis, **dict(zip(names, row.tolist()))} for axis, row in zip("xyz", both)]


class LackOfFit(Record):
    """Whether a line explains the scatter between its repeats."""

    f: float | None
    p_value: float | None
    dof_fit: int
    dof_repeats: int


class Slope(Record):
    """A line through readings: µm of ``channel`` per newton along ``axis``."""

    axis: str
    channel: str
    um_per_n: float
    std_error: float | None
    half_width_95: float | None
    dof: int
    intercept_um: float | None
    intercept_std_error_um: float | None
    load_offset_n: float | None
    load_offset_std_error_n: float | None
    friction_n: float | None
    friction_std_error_n: float | None
    n: int
    residual_sd_um: float | None
    noise_um: float | None
    lack_of_fit: LackOfFit | None


class RigFitResult(Result):
    """How much a rod really bends. ``r["22"]`` is the measured compliance along y over the modelled."""

    rod: str | None
    slopes: list[Slope]
    r: dict[str, float | None] | None
    r_std_error: dict[str, float | None] | None
    r_rod: float | None
    r_rod_std_error: float | None
    r_rod_half_width_95: float | None
    cf_um_per_n: Array | None
    cf_std_error_um_per_n: Array | None
    cg_um_per_g: Array | None
    cg_std_error_um_per_g: Array | None
    c_rod_um: float | None

    def _rows(self) -> list[dict[str, Any]]:
        slopes: list[dict[str, Any]] = self.to_dict()["slopes"]
        return slopes


class Parameter(Record):
    """A free parameter of a calibration, in the unit that stands with it."""

    name: str
    value: float
    unit: str
    std_error: float | None
    identifiable: bool
    nominal: float
    correction: float
    supported: bool


class Errors(Record):
    """Distances between tips and what was measured."""

    rms_um: float | None
    mean_um: float
    max_um: float
    median_um: float
    sd_um: float


class Before(Record):
    """How accurate the nominal robot is at the same poses."""

    residual: Errors | None
    validation: Errors | None


class Placement(Record):
    """Where the base stands in {W}."""

    xyz_mm: Array
    rpy_deg: Array


class Calibrated(Record):
    """A calibrated robot."""

    robot: str
    rod: str | None
    mode: str
    converged: bool
    reason: str
    plausible: bool
    poses: int
    parameters: list[Parameter]
    base: Placement | None
    tool_mm: Array
    before: Before | None
    residual: Errors
    noise_um: float
    noise_is_stated: bool
    validation: Errors | None
    cross_validation: Errors | None
    condition: float | None
    observability: dict[str, Any]


class CalibrationResult(Calibrated, Result):
    """A calibrated robot. Beside the keys of the JSON, for each pose in the order of recording, in {W}:

    - ``deviations_um``, shape (n, 3): deflected tip less measured point, µm
    - ``deflections_um``, shape (n, 3): what the rod's deflection added, µm
    - ``tips_mm``, shape (n, 3): the tip, mm
    """

    suspected_mistakes: list[str]
    _arrays: dict[str, Array]
    _links: tuple[str | None, str | None]

    def __init__(self, answer: _rodcal.Answer, arrays: dict[str, Array], campaign: _rodcal.Campaign) -> None:
        Result.__init__(self, answer)
        self._arrays = {name: _kept(array) for name, array in arrays.items()}
        self._links = campaign.links

    @property
    def deviations_um(self) -> Array:
        """Deflected tip less measured point (or socket), in {W}, µm, shape (n, 3)."""
        return self._arrays["deviations_um"]

    @property
    def deflections_um(self) -> Array:
        """What the rod's deflection added to each tip, in {W}, µm, shape (n, 3)."""
        return self._arrays["deflections_um"]

    @property
    def tips_mm(self) -> Array:
        """The tip at each pose, in {W}, mm, shape (n, 3)."""
        return self._arrays["tips_mm"]

    def calibrated(self) -> Robot:
        """The calibrated robot, with its uncertainty and what no URDF can hold, for `predict`."""
        (_, text), *beside = self.files.items()
        effects = next((content.decode() for _, content in beside), None)
        base, tip = self._links
        return Robot.from_text(text.decode(), base_link=base, tip_link=tip, effects=effects)

    def _rows(self) -> list[dict[str, Any]]:
        parameters: list[dict[str, Any]] = self.to_dict()["parameters"]
        return parameters


class Mode(Calibrated):
    """A calibration by one mode of compensation."""

    mean_error_um: float | None
    mean_error_interval_um: tuple[float, float] | None


class Difference(Record):
    """Mean error of ``mode`` less that of ``against``, with its 95 % interval."""

    mode: str
    against: str
    mean_um: float
    lo_um: float
    hi_um: float
    significant: bool


class ComparisonResult(Result):
    """Every mode of compensation, and which differences are significant."""

    modes: list[Mode]
    differences: list[Difference]
    judged_by: str
    draws: int
    verdict: str

    def _rows(self) -> list[dict[str, Any]]:
        def row(mode: Mode) -> dict[str, Any]:
            low, high = mode.mean_error_interval_um or (None, None)
            own = {"mode": mode.mode, "mean_error_um": mode.mean_error_um, "lo_um": low, "hi_um": high}
            return {**own, "residual_rms_um": mode.residual.rms_um, "noise_um": mode.noise_um}

        return [row(mode) for mode in self.modes]


class Interval(Record):
    """A number with its 95 % interval; its unit stands in its name."""

    name: str
    value: float
    lo: float
    hi: float


class Rival(Record):
    """What these recordings cannot tell apart from a finding."""

    effect: str
    location: str
    odds: float | None


class Finding(Record):
    """Physics, an event or a mistake that the model leaves out."""

    effect: str
    location: str
    kind: str
    words: str
    p_value: float | None
    parameters: list[Interval]
    indistinguishable_from: list[str]
    unnamed_rival: str | None
    rivals: list[Rival]
    next_measurement: str | None
    heldout_gain: float | None


class NoiseStatement(Record):
    """The noise that was stated, and the one that is seen."""

    stated_um: float | None
    estimated_um: float | None
    p_value: float | None


class DiagnosisResult(Result):
    """Where recording and model disagree: ``verdict`` is ``"consistent"`` or ``"mismatch"``."""

    verdict: str
    noise_um: float | None
    noise: NoiseStatement
    rms_before_um: float | None
    rms_after_um: float | None
    heldout_before_um: float | None
    heldout_after_um: float | None
    findings: list[Finding]
    unexplained: dict[str, Any] | None
    nominal: list[dict[str, Any]]
    suspects: list[dict[str, Any]]

    @property
    def is_mismatch(self) -> bool:
        """True where the command ends with status 1."""
        return self._answer.status == 1

    def _rows(self) -> list[dict[str, Any]]:
        def rows(finding: Finding) -> list[dict[str, Any]]:
            own = {"effect": finding.effect, "location": finding.location, "kind": finding.kind}
            return [
                {**own, "p_value": finding.p_value, "parameter": p.name, "value": p.value, "lo": p.lo, "hi": p.hi}
                for p in finding.parameters
            ] or [{**own, "p_value": finding.p_value}]

        return [row for finding in self.findings for row in rows(finding)]


class PredictionResult(Result):
    """Tips at poses, in {0}: arrays of shape (n, 3) and (n,). Report and JSON are made when asked for."""

    _predicted: _rodcal.Predicted
    _robot: Robot

    def __init__(self, predicted: _rodcal.Predicted, robot: Robot) -> None:
        self._predicted = predicted
        self._robot = robot

    def __reduce__(self) -> tuple[Any, ...]:
        return _predicted_again, (self._robot, *self._predicted.parts())

    @functools.cached_property
    def _answer(self) -> _rodcal.Answer:  # type: ignore[override]
        return self._predicted.answer()

    @functools.cached_property
    def tips_mm(self) -> Array:
        """The tips in {0}, mm, shape (n, 3)."""
        return _kept(self._predicted.tips_mm)

    @functools.cached_property
    def sd_mm(self) -> Array | None:
        """Standard deviations of their coordinates, mm, shape (n, 3), where the robot knows them."""
        sd = self._predicted.sd_mm
        return None if sd is None else _kept(sd)

    @functools.cached_property
    def ratios(self) -> Array | None:
        """How many times more uncertain than where it was calibrated each pose is, shape (n,)."""
        ratios = self._predicted.ratios
        return None if ratios is None else _kept(ratios)

    def __repr__(self) -> str:
        return f"<PredictionResult: {len(self.tips_mm)} poses>"

    def to_dataframe(self) -> pandas.DataFrame:
        """Pose, tip and standard deviation (mm), ratio: straight from the arrays. Needs pandas."""
        columns: dict[str, Any] = {"pose": np.arange(1, len(self.tips_mm) + 1).astype(str)}
        columns.update((f"{axis}_mm", self.tips_mm[:, k]) for k, axis in enumerate("xyz"))
        if self.sd_mm is not None:
            columns.update((f"sd_{axis}_mm", self.sd_mm[:, k]) for k, axis in enumerate("xyz"))
        if self.ratios is not None:
            columns["ratio"] = self.ratios
        return _frame(columns)


def _predicted_again(robot: Robot, joints: Array, tool: tuple[float, float, float], aligned: bool) -> PredictionResult:
    return PredictionResult(_rodcal.Predicted.restored(robot._native, joints, tool, aligned), robot)


class Design(Record):
    """A rod of the front; ``rod`` has the keys of the rod file, for `Rod`."""

    rod: dict[str, Any]
    c_rod_um: float
    cf_max_um_per_n: float
    cg_max_um_per_g: float
    mass_g: float
    first_frequency_hz: float
    reach_mm: float
    tubes: list[str] | None


class RodDesignResult(Result):
    """The Pareto front, best in the first goal first."""

    evaluated: int
    feasible: int
    front: list[Design]
    infeasible_because: dict[str, int]

    def _rows(self) -> list[dict[str, Any]]:
        hidden = ("rod", "sensitivities", "one_percent_more", "intervals", "indistinguishable_from")
        front = self.to_dict()["front"]
        return [
            {"name": row["rod"]["name"], **{key: value for key, value in row.items() if key not in hidden}}
            for row in front
        ]


class Expected(Record):
    """What error to expect of the calibrated robot, µm."""

    mode: str
    mean: float
    p95: float
    rms: float
    parts: dict[str, float]


class PoseDesignResult(Result):
    """The poses that a calibration should measure; ``poses`` has the columns of the measurements."""

    poses: list[dict[str, Any]]
    criterion: str
    value: float
    value_random_median: float | None
    observability: dict[str, Any]
    forecast_um: Expected | None

    @property
    def joints_deg(self) -> Array:
        """Joint values of the poses, degrees (mm of prismatic joints), shape (n, joints)."""
        columns = [key for key in self.poses[0] if key.startswith("q")] if self.poses else []
        return np.array([[pose[column] for column in columns] for pose in self.poses], dtype=np.float64)

    def _rows(self) -> list[dict[str, Any]]:
        return self.poses


class RigDesignResult(Result):
    """What to measure on a rig; ``files["readings.csv"]`` is to be filled in."""

    rod: str
    measurements: list[dict[str, Any]]
    minutes: float

    def _rows(self) -> list[dict[str, Any]]:
        return self.measurements


class RodForecast(Record):
    """What to expect of a rod, for each mode."""

    rod: str
    c_rod_um: float | None
    poses: int
    recorded_poses: bool
    modes: list[Expected]


class ForecastResult(Result):
    """What to expect of rods and modes before anything is recorded."""

    noise_um: float
    repeatability_um: float
    unseen: str
    forecasts: list[RodForecast]
    best: dict[str, Any] | None
    c_rod_as_proxy: list[dict[str, Any]]

    def _rows(self) -> list[dict[str, Any]]:
        return [
            {"rod": rod["rod"], "poses": rod["poses"], **mode}
            for rod in self.to_dict()["forecasts"]
            for mode in rod["modes"]
        ]


class Truth(Record):
    """A parameter of the robot that was simulated, in the unit that stands with it."""

    name: str
    unit: str
    value: float
    correction: float


class SimulationResult(Record):
    """A simulated campaign and the robot that is behind it; ``files`` are its files."""

    robot: str
    rod: str
    seed: int
    poses: int
    r_rod: float
    tip_mm: Array
    truth: list[Truth]
    _data: dict[str, Any]
    _files: dict[str, bytes]

    def __init__(self, data: dict[str, Any], files: dict[str, bytes]) -> None:
        super().__init__(data)
        self._data, self._files = data, files

    @property
    def files(self) -> dict[str, bytes]:
        """Names and contents of the campaign's files; the campaign is ``campaign.toml``."""
        return self._files

    def campaign(self) -> Campaign:
        """The campaign, for `calibrate` and all others."""
        texts = {name: content.decode() for name, content in self._files.items()}
        text = texts["campaign.toml"]
        return Campaign._of(_rodcal.Campaign.from_texts("<campaign>", text, texts, False))

    def to_dict(self) -> dict[str, Any]:
        """The JSON that the command prints with ``--json``."""
        return self._data

    def to_dataframe(self) -> pandas.DataFrame:
        """The true parameters; needs pandas."""
        return _frame(self._data["truth"])

    def __repr__(self) -> str:
        return f"<SimulationResult: {self.poses} poses of {self.robot} with rod {self.rod}, seed {self.seed}>"
