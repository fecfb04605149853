"""rodcal: how much a bent measuring rod bends, how accurate a robot is once that is compensated,
and which physics a model left out.

>>> import rodcal
>>> fit = rodcal.rig_fit("rods/5.toml", "stiffness_data/5.csv")
>>> round(fit.r_rod, 3)
1.015

Inputs are files, or dicts and arrays with the same keys: `Rod`, `Readings`, `Robot`, `Campaign`.
Answers are typed objects with the keys of the commands' JSON as attributes, ``to_dict()``,
``to_dataframe()``, ``write(directory)``, and the report in a notebook. Units stand in the names.
Errors are `Error` with file, line and column; what has to be known is warned of as `RodcalWarning`.
"""

from __future__ import annotations

from . import results
from ._errors import Error, FileError, InputError, NotApplicableError, NumericalError, RodcalWarning
from ._rodcal import __version__
from .functions import (
    calibrate,
    compare,
    compliance,
    design_poses,
    design_rig,
    design_rod,
    diagnose_calibration,
    diagnose_rig,
    forecast,
    predict,
    rig_fit,
    simulate,
)
from .inputs import Campaign, Readings, Robot, Rod

__all__ = [
    "Campaign",
    "Error",
    "FileError",
    "InputError",
    "NotApplicableError",
    "NumericalError",
    "Readings",
    "Robot",
    "Rod",
    "RodcalWarning",
    "__version__",
    "calibrate",
    "compare",
    "compliance",
    "design_poses",
    "design_rig",
    "design_rod",
    "diagnose_calibration",
    "diagnose_rig",
    "forecast",
    "predict",
    "results",
    "rig_fit",
    "simulate",
]
