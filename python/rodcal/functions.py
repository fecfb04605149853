"""What can be asked: one function for each command, with the command's defaults.

Rods, readings, robots and campaigns may be objects of this package, names of files, or dicts and
tables with the files' keys. Whatever takes long runs without Python's lock and stops at Ctrl-C;
``progress=True`` draws a bar, and a function is called with ``(done, total)``.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Literal, Union

import numpy as np
from numpy.typing import ArrayLike

from . import _rodcal, _text
from ._arguments import maybe_whole, names, numbers, whole
from ._errors import InputError, warn
from ._progress import Progress, Told
from .inputs import (
    Array,
    Campaign,
    PathLike,
    Readings,
    Robot,
    Rod,
    Table,
    as_campaign,
    as_readings,
    as_robot,
    as_rod,
    joint_array,
    joint_table,
)
from .results import (
    CalibrationResult,
    ComparisonResult,
    ComplianceResult,
    DiagnosisResult,
    ForecastResult,
    PoseDesignResult,
    PredictionResult,
    RigDesignResult,
    RigFitResult,
    RodDesignResult,
    SimulationResult,
)

#: A rod, its file, or a dict with the file's keys.
RodLike = Union[Rod, Mapping[str, Any], PathLike]
#: Readings, their file, or a table with its columns.
ReadingsLike = Union[Readings, Table, PathLike]
#: A robot, its file (``"builtin:tx90"`` is one), or a dict with the file's keys.
RobotLike = Union[Robot, Mapping[str, Any], PathLike]
#: A campaign, its file, or a dict with the file's keys.
CampaignLike = Union[Campaign, Mapping[str, Any], PathLike]
#: How the rod's deflection is known; ``None``: meas with rig readings, else fea with a rod, else none.
CompensationMode = Literal["none", "calc", "fea", "meas"]
#: What an outlier counts: as much as all others, less (Huber's weights), or nothing (Tukey's).
Weights = Literal["none", "huber", "tukey"]
#: Slender beams, or beams with shear.
Theory = Literal["euler-bernoulli", "timoshenko"]


def compliance(
    rod: RodLike,
    mode: Literal["fea", "calc"] = "fea",
    *,
    theory: Theory | None = None,
    elements: int = 200,
    contact_force_n: float | None = None,
    load_station_mm: float | None = None,
    read_station_mm: float | None = None,
    damping_percent: float | None = None,
) -> ComplianceResult:
    """How much a rod bends, from its drawing: C^F and C^g of shape (3, 3), and c_rod.

    ``mode`` is the beam model of the rod as built (``"fea"``) or the paper's closed form
    (``"calc"``). ``contact_force_n`` is the size of the force in c_rod (1.97 N, the paper's). With a
    station (arc length from the flange, mm) the answer also has one point under a force at another;
    with ``damping_percent`` (of critical damping) the settling times of the natural frequencies.

    >>> result = compliance("rods/5.toml")
    >>> round(float(result.cf_um_per_n[1, 1]), 2)
    45.61
    >>> round(result.c_rod_um, 1)
    402.0
    """
    answer = _rodcal.compliance(
        as_rod(rod)._native,
        mode,
        theory,
        whole("elements", elements),
        contact_force_n,
        load_station_mm,
        read_station_mm,
        damping_percent,
    )
    warn(answer.warnings)
    return ComplianceResult(answer)


def rig_fit(
    rod: RodLike | None,
    readings: ReadingsLike,
    *,
    theory: Theory = "timoshenko",
    elements: int = 200,
    robust: Weights = "none",
    progress: Progress = False,
) -> RigFitResult:
    """How much a rod really bends, from readings under known loads: lines, r, measured C^F and C^g.

    Without a rod (``None``) there are lines only.

    >>> fit = rig_fit("rods/5.toml", "stiffness_data/5.csv")
    >>> round(fit.r_rod, 3)
    1.015
    >>> [round(slope.um_per_n, 1) for slope in fit.slopes]
    [46.3, 40.4]
    """
    model = None if rod is None else as_rod(rod)._native
    native = as_readings(readings)._native
    elements = whole("elements", elements)
    with Told(progress, "fitting lines") as tell:
        answer = _rodcal.rig_fit(model, native, theory, elements, robust, tell)
    warn(answer.warnings)
    return RigFitResult(answer)


def diagnose_rig(rod: RodLike | None, readings: ReadingsLike, *, apply: bool = False, progress: Progress = False) -> DiagnosisResult:
    """Which physics the model of a rod leaves out; without a rod, what a straight line leaves out.

    With ``apply`` rod and readings with what was found are among ``files``. Rods whose files stand
    beside the rod's are tried too: one of them may have been on the rig.

    >>> found = diagnose_rig("rods/2.toml", "stiffness_data/2.csv")
    >>> found.verdict, found.findings[0].effect, found.findings[0].location
    ('mismatch', 'stiffness_scale', 'rod')
    >>> round(found.findings[0].parameters[0].value, 2)
    0.65
    """
    model = None if rod is None else as_rod(rod)._native
    native = as_readings(readings)._native
    with Told(progress, "diagnosing") as tell:
        answer = _rodcal.diagnose_rig(model, native, apply, tell)
    warn(answer.warnings)
    return DiagnosisResult(answer)


def calibrate(
    campaign: CampaignLike,
    mode: CompensationMode | None = None,
    *,
    robust: Weights = "none",
    prune: bool = False,
    folds: int | None = None,
    progress: Progress = False,
) -> CalibrationResult:
    """How accurate a robot is once its rod's deflection is compensated: kinematic calibration.

    ``prune`` holds numbers that the data do not support at their nominal values; ``folds`` also
    predicts every pose from a calibration without it.

    >>> result = calibrate("campaigns/tx90-5/campaign.toml")
    >>> result.mode, len(result.parameters), result.deviations_um.shape
    ('meas', 32, (60, 3))
    >>> round(result.validation.mean_um, 1)
    46.1
    """
    native = as_campaign(campaign)._native
    folds = maybe_whole("folds", folds)
    with Told(progress, "calibrating") as tell:
        answer, arrays = _rodcal.calibrate(native, mode, robust, prune, folds, None, tell)
    warn(answer.warnings)
    return CalibrationResult(answer, arrays, native)


def compare(
    campaign: CampaignLike,
    *,
    robust: Weights = "none",
    draws: int = 200,
    seed: int = 1,
    progress: Progress = False,
) -> ComparisonResult:
    """Calibrates in every mode of compensation, and tests which differences are significant.

    >>> result = compare("campaigns/tx90-5/campaign.toml", draws=50)
    >>> [mode.mode for mode in result.modes], any(pair.significant for pair in result.differences)
    (['none', 'calc', 'fea', 'meas'], False)
    """
    native = as_campaign(campaign)._native
    draws, seed = whole("draws", draws), whole("seed", seed)
    with Told(progress, "comparing modes") as tell:
        answer = _rodcal.compare(native, robust, draws, seed, None, tell)
    warn(answer.warnings)
    return ComparisonResult(answer)


def diagnose_calibration(
    campaign: CampaignLike,
    mode: CompensationMode | None = None,
    *,
    apply: bool = False,
    progress: Progress = False,
) -> DiagnosisResult:
    """Which physics of robot, rod, fixture or procedure a calibration leaves out.

    With ``apply`` the corrected robot and campaign are among ``files``.

    >>> found = diagnose_calibration("campaigns/tx90-5/campaign.toml")
    >>> found.verdict, round(found.noise_um, 1)
    ('consistent', 16.7)
    """
    native = as_campaign(campaign)._native
    with Told(progress, "diagnosing") as tell:
        answer = _rodcal.diagnose_calibration(native, mode, apply, tell)
    warn(answer.warnings)
    return DiagnosisResult(answer)


def predict(
    robot: RobotLike,
    joints_deg: ArrayLike,
    *,
    tool_mm: Sequence[float] | Array | None = None,
    aligned: bool = False,
    progress: Progress = False,
) -> PredictionResult:
    """Where a robot's tip is at poses of shape (n, joints), in degrees (mm of prismatic joints).

    ``tool_mm`` is the tip in {T}, mm (the one that the robot was calibrated with, else the flange).
    ``aligned`` states the uncertainty that is left after base and tool were aligned to these poses, of
    which there may be as many as a file may hold (a million).
    An array of ``float64`` is read where it is, and not copied.

    >>> link = {"d_mm": 0.0, "alpha_deg": 0.0, "beta_deg": 0.0, "theta_offset_deg": 0.0}
    >>> arm = Robot({"name": "arm", "joint": [{"a_mm": 400.0, **link}, {"a_mm": 300.0, **link}]})
    >>> predict(arm, [[0.0, 90.0]]).tips_mm.round(9).tolist()
    [[400.0, 300.0, 0.0]]
    """
    own = as_robot(robot)
    native = own._native
    joints = joint_array(joints_deg, len(native.columns), "`joints_deg`")
    tool = None if tool_mm is None else numbers("tool_mm", tool_mm, 3)
    with Told(progress, "predicting") as tell:
        return PredictionResult(_rodcal.predict(native, joints, tool, aligned, tell), own)


def simulate(
    rod: RodLike,
    robot: RobotLike = "builtin:tx90",
    *,
    seed: int = 1,
    poses: int = 30,
    validation: int = 100,
    r_rod: float = 1.0,
    planned: PoseDesignResult | Table | PathLike | None = None,
    directory: PathLike | None = None,
    force: bool = False,
    progress: Progress = False,
) -> SimulationResult:
    """Makes a campaign of a robot and a rod that are known exactly.

    ``poses`` on each of five clamps, or ``planned`` ones (a table with clamp and joint columns);
    ``r_rod`` is the compliance of the true rod over that of its model. With ``directory`` the files
    are written too.

    >>> simulation = simulate("rods/5.toml", poses=8, validation=20, seed=3)
    >>> simulation.poses, calibrate(simulation.campaign()).plausible
    (40, True)
    """
    model = as_robot(robot)._native
    table: tuple[str, str] | None = None
    if isinstance(planned, PoseDesignResult):
        table = "<poses>", planned.files["poses.csv"].decode()
    elif planned is not None:
        table = joint_table(planned, model.columns, "<poses>")
    with Told(progress, "simulating poses") as tell:
        data, files = _rodcal.simulate(
            model,
            as_rod(rod)._native,
            whole("seed", seed),
            whole("poses", poses),
            whole("validation", validation),
            r_rod,
            table,
            None if directory is None else os.fspath(directory),
            force,
            tell,
        )
    return SimulationResult(data, files)


def design_rod(
    design: Mapping[str, Any] | PathLike,
    *,
    catalogue: Table | None = None,
    base: RodLike | None = None,
    samples: int | None = None,
    refine: int | None = None,
    refine_goal: str | None = None,
    seed: int = 1,
    campaign: CampaignLike | None = None,
    count: int | None = None,
    progress: Progress = False,
) -> RodDesignResult:
    """The Pareto front of rods: ``design`` is a design file or a dict with its keys.

    ``catalogue`` is a table of tubes in place of a file. ``base`` is a rod to compare with,
    ``samples`` looks at so many combinations only, ``refine`` betters a design of the front (from 1)
    between the grid's values, for one objective or for several by ``refine_goal`` ("c_rod_um=2,mass_g=1");
    with ``campaign`` the designs are ranked for its robot, with ``count``
    poses each.

    >>> result = design_rod({
    ...     "geometry": {"l1_mm": {"from": 150, "to": 450, "step": 50}, "l2_mm": [400, 525]},
    ...     "catalogue": {"file": "builtin"},
    ...     "constraints": {"max_mass_g": 800},
    ...     "objectives": {"minimise": ["c_rod_um", "mass_g"]},
    ... })
    >>> result.front[0].c_rod_um < result.front[-1].c_rod_um, result.evaluated > result.feasible
    (True, True)
    """
    space = space_of(design, catalogue)
    native = None if campaign is None else as_campaign(campaign, plan=True)._native
    other = None if base is None else as_rod(base)._native
    samples, refine = maybe_whole("samples", samples), maybe_whole("refine", refine)
    seed, count = whole("seed", seed), maybe_whole("count", count)
    if count is not None and native is None:
        raise InputError("`count` is poses of a campaign, and there is none", expected="a `campaign`")
    with Told(progress, "looking at rods") as tell:
        answer = _rodcal.design_rod(space, other, samples, refine, refine_goal, seed, native, count, None, tell)
    warn(answer.warnings)
    return RodDesignResult(answer)


def space_of(
    design: Mapping[str, Any] | PathLike, catalogue: Table | None
) -> str | tuple[str, str | None]:
    """A design file's name, or the text of a design with that of its catalogue."""
    if not isinstance(design, Mapping):
        return os.fspath(design)
    tubes = None if catalogue is None else _text.csv_text(catalogue, "<catalogue>")
    own = dict(design)
    if tubes is not None:
        own["catalogue"] = {**own.get("catalogue", {}), "file": "<catalogue>"}
    return _text.toml(own), tubes


def design_poses(
    campaign: CampaignLike,
    count: int,
    criterion: Literal["o1", "o4", "d", "a", "forecast"] = "o1",
    *,
    candidates: ArrayLike | Table | PathLike | None = None,
    generate: int = 3000,
    cone_deg: float = 75.0,
    clear_mm: float = 60.0,
    change_deg: float = 5.0,
    table_mm: float | Literal["none"] | None = None,
    mode: CompensationMode | None = None,
    noise_um: float | None = None,
    repeatability_um: float | None = None,
    instrument_um: float = 0.0,
    at: ArrayLike | Table | PathLike | None = None,
    volume_mm: Sequence[float] | Array | None = None,
    seed: int = 1,
    progress: Progress = False,
) -> PoseDesignResult:
    """The poses that a calibration should measure, ``count`` in all, and how accurate the robot will be.

    ``candidates`` and ``at`` (where the robot will be used) are poses: an array of shape
    (n, joints), a table, or a file; ``volume_mm`` is a box (x0, x1, y0, y1, z0, z1) in {0}.

    >>> plan = design_poses("campaigns/tx90-5/campaign.toml", 20, generate=300)
    >>> plan.joints_deg.shape, plan.value > plan.value_random_median
    ((20, 6), True)
    """
    native = as_campaign(campaign, plan=True)._native
    table = None if candidates is None else joint_table(candidates, native.columns, "<candidates>")
    limits = {
        "cone_deg": cone_deg,
        "clear_mm": clear_mm,
        "change_deg": change_deg,
        "table_mm": None if table_mm == "none" else table_mm,
        "has_table": table_mm != "none",
    }
    expected = _expected(native, noise_um, repeatability_um, instrument_um, at, volume_mm)
    count, generate, seed = whole("count", count), whole("generate", generate), whole("seed", seed)
    with Told(progress, "looking for poses") as tell:
        answer = _rodcal.design_poses(
            native, count, criterion, table, generate, limits, mode, expected, seed, tell
        )
    warn(answer.warnings)
    return PoseDesignResult(answer)


def design_rig(
    rod: RodLike,
    between: Iterable[str] | str = (),
    *,
    r_rod_width_percent: float | None = None,
    odds: float = 20.0,
    max_load_n: float = 10.0,
    noise_um: float = 2.0,
    at_tip: bool = False,
) -> RigDesignResult:
    """What to measure on a rig to distinguish effects, or to know r_rod well enough.

    >>> plan = design_rig("rods/2.toml", ["joint_compliance", "root_compliance"])
    >>> plan.measurements[0]["direction"], plan.minutes > 0
    ('x', True)
    """
    native = as_rod(rod)._native
    answer = _rodcal.design_rig(
        native, names("between", between), r_rod_width_percent, odds, max_load_n, noise_um, at_tip
    )
    warn(answer.warnings)
    return RigDesignResult(answer)


def forecast(
    campaign: CampaignLike,
    rods: Iterable[RodLike] = (),
    *,
    count: int | None = None,
    noise_um: float | None = None,
    repeatability_um: float | None = None,
    instrument_um: float = 0.0,
    at: ArrayLike | Table | PathLike | None = None,
    volume_mm: Sequence[float] | Array | None = None,
    seed: int = 1,
    progress: Progress = False,
) -> ForecastResult:
    """What error to expect of every mode, before anything is recorded: the budget of ``rods``.

    Without ``rods`` it is that of the campaign's own rod; ``count`` poses are chosen by O1 (those of
    the recording).

    >>> result = forecast("campaigns/tx90-5/campaign.toml")
    >>> [round(mode.mean, 1) for mode in result.forecasts[0].modes]
    [28.4, 28.0, 27.8, 27.8]
    """
    native = as_campaign(campaign, plan=True)._native
    expected = _expected(native, noise_um, repeatability_um, instrument_um, at, volume_mm)
    natives = [as_rod(rod)._native for rod in rods]
    count, seed = maybe_whole("count", count), whole("seed", seed)
    with Told(progress, "forecasting") as tell:
        answer = _rodcal.forecast(native, natives, count, expected, seed, tell)
    warn(answer.warnings)
    return ForecastResult(answer)


def _expected(
    campaign: _rodcal.Campaign,
    noise_um: float | None,
    repeatability_um: float | None,
    instrument_um: float,
    at: Any,
    volume_mm: Sequence[float] | Array | None,
) -> dict[str, Any]:
    """What a forecast assumes."""
    return {
        "noise_um": noise_um,
        "repeatability_um": repeatability_um,
        "instrument_um": instrument_um,
        "at": None if at is None else joint_table(at, campaign.columns, "<at>"),
        "volume_mm": None if volume_mm is None else numbers("volume_mm", volume_mm, 6),
    }
