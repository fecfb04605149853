"""The part of the package that is written in Rust; use what `rodcal` exports."""

import os
from collections.abc import Callable, Iterable
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "__version__",
    "Answer",
    "Predicted",
    "Rod",
    "Readings",
    "Robot",
    "Campaign",
    "visible",
    "read_text",
    "compliance",
    "rig_fit",
    "diagnose_rig",
    "calibrate",
    "compare",
    "diagnose_calibration",
    "predict",
    "simulate",
    "design_rod",
    "design_poses",
    "design_rig",
    "forecast",
    "design_parts",
    "design_part",
    "compare_part",
    "folds",
    "calibrate_part",
]

__version__: str

_Tell = Callable[[int, int | None], object] | None
_Path = str | os.PathLike[str]
_Design = str | tuple[str, str | None]

@final
class Answer:
    @staticmethod
    def restored(report: bytes, json: bytes, files: list[tuple[str, bytes]], status: int) -> Answer: ...
    def to_dict(self) -> dict[str, Any]: ...
    def html(self) -> str: ...
    def text(self, columns: int) -> str: ...
    def write(self, directory: _Path, is_forced: bool) -> None: ...
    @property
    def title(self) -> str: ...
    @property
    def headline(self) -> str: ...
    @property
    def warnings(self) -> list[str]: ...
    @property
    def status(self) -> int: ...
    @property
    def files(self) -> dict[str, bytes]: ...

@final
class Predicted:
    @property
    def tips_mm(self) -> NDArray[np.float64]: ...
    @property
    def sd_mm(self) -> NDArray[np.float64] | None: ...
    @property
    def ratios(self) -> NDArray[np.float64] | None: ...
    def parts(self) -> tuple[NDArray[np.float64], tuple[float, float, float], bool]: ...
    @staticmethod
    def restored(
        robot: Robot, joints: NDArray[np.float64], tool: tuple[float, float, float], aligned: bool
    ) -> Predicted: ...
    def answer(self) -> Answer: ...

@final
class Rod:
    @staticmethod
    def read(path: _Path) -> Rod: ...
    @staticmethod
    def from_text(file: str, text: str) -> Rod: ...
    @property
    def name(self) -> str: ...
    @property
    def length_m(self) -> float: ...
    @property
    def mass_kg(self) -> float: ...
    @property
    def tip_m(self) -> list[float]: ...
    @property
    def text(self) -> str: ...
    @property
    def path(self) -> str | None: ...
    @property
    def warnings(self) -> list[str]: ...
    def to_toml(self) -> str: ...

@final
class Readings:
    @staticmethod
    def read(path: _Path) -> Readings: ...
    @staticmethod
    def from_text(file: str, text: str) -> Readings: ...
    def __len__(self) -> int: ...
    @property
    def file(self) -> str: ...
    @property
    def warnings(self) -> list[str]: ...
    @property
    def text(self) -> str: ...

@final
class Robot:
    @staticmethod
    def from_text(
        file: str,
        text: str,
        base_link: str | None,
        tip_link: str | None,
        effects: tuple[str, str] | None,
        corrections: tuple[str, str] | None,
    ) -> Robot: ...
    @staticmethod
    def named(name: str) -> Robot: ...
    @property
    def name(self) -> str: ...
    @property
    def file(self) -> str: ...
    @property
    def text(self) -> str: ...
    @property
    def beside(self) -> str | None: ...
    @property
    def links(self) -> tuple[str | None, str | None]: ...
    @property
    def texts(
        self,
    ) -> tuple[str, str, str | None, str | None, tuple[str, str] | None, tuple[str, str] | None]: ...
    @property
    def columns(self) -> list[str]: ...

@final
class Campaign:
    @staticmethod
    def read(path: _Path, is_plan: bool) -> Campaign: ...
    @staticmethod
    def from_texts(file: str, text: str, texts: dict[str, str], is_plan: bool) -> Campaign: ...
    @property
    def file(self) -> str: ...
    @property
    def links(self) -> tuple[str | None, str | None]: ...
    @property
    def robot(self) -> str: ...
    @property
    def rod(self) -> str | None: ...
    @property
    def columns(self) -> list[str]: ...
    @property
    def mode(self) -> str: ...
    @property
    def pose_names(self) -> list[str]: ...
    @property
    def poses(self) -> int: ...
    @property
    def validation_poses(self) -> int: ...
    @property
    def has_points(self) -> bool: ...
    @property
    def texts(self) -> tuple[str, str, dict[str, str], bool]: ...
    @property
    def warnings(self) -> list[str]: ...

def visible(text: str) -> str: ...
def read_text(path: _Path) -> str: ...
def compliance(
    rod: Rod,
    mode: str,
    theory: str | None,
    elements: int,
    contact_force_n: float | None,
    load_station_mm: float | None,
    read_station_mm: float | None,
    damping_percent: float | None,
) -> Answer: ...
def rig_fit(
    rod: Rod | None, readings: Readings, theory: str, elements: int, robust: str, progress: _Tell
) -> Answer: ...
def diagnose_rig(rod: Rod | None, readings: Readings, apply: bool, progress: _Tell) -> Answer: ...
def calibrate(
    campaign: Campaign,
    mode: str | None,
    robust: str,
    prune: bool,
    folds: int | None,
    held_out: list[tuple[int, list[float]]] | None,
    progress: _Tell,
) -> tuple[Answer, dict[str, NDArray[np.float64]]]: ...
def compare(
    campaign: Campaign,
    robust: str,
    draws: int,
    seed: int,
    drawn: list[list[float] | None] | None,
    progress: _Tell,
) -> Answer: ...
def diagnose_calibration(campaign: Campaign, mode: str | None, apply: bool, progress: _Tell) -> Answer: ...
def predict(
    robot: Robot,
    joints: NDArray[np.float64],
    tool_mm: list[float] | None,
    aligned: bool,
    progress: _Tell,
) -> Predicted: ...
def simulate(
    robot: Robot,
    rod: Rod,
    seed: int,
    poses: int,
    validation: int,
    r_rod: float,
    planned: tuple[str, str] | None,
    directory: _Path | None,
    is_forced: bool,
    progress: _Tell,
) -> tuple[dict[str, Any], dict[str, bytes]]: ...
def design_rod(
    design: _Design,
    base: Rod | None,
    samples: int | None,
    refine: int | None,
    refine_goal: str | None,
    seed: int,
    campaign: Campaign | None,
    count: int | None,
    parts: Iterable[tuple[int, int, str]] | None,
    progress: _Tell,
) -> Answer: ...
def design_poses(
    campaign: Campaign,
    count: int,
    criterion: str,
    candidates: tuple[str, str] | None,
    generate: int,
    limits: dict[str, Any],
    mode: str | None,
    expected: dict[str, Any],
    seed: int,
    progress: _Tell,
) -> Answer: ...
def design_rig(
    rod: Rod,
    between: list[str],
    r_rod_width_percent: float | None,
    odds: float,
    max_load_n: float,
    noise_um: float,
    at_tip: bool,
) -> Answer: ...
def forecast(
    campaign: Campaign,
    rods: list[Rod],
    count: int | None,
    expected: dict[str, Any],
    seed: int,
    progress: _Tell,
) -> Answer: ...
def design_parts(
    design: _Design, samples: int | None, seed: int
) -> tuple[str, str | None, int, int]: ...
def design_part(design: _Design, samples: int | None, seed: int, first: int, last: int) -> str: ...
def compare_part(
    campaign: Campaign, robust: str, draws: int, seed: int, first: int, last: int
) -> list[list[float] | None]: ...
def folds(campaign: Campaign, folds: int) -> int: ...
def calibrate_part(
    campaign: Campaign, mode: str | None, robust: str, prune: bool, folds: int, first: int, last: int
) -> list[tuple[int, list[float]]]: ...
