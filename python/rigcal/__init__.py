"""Calibrates models of servo-hydraulic rigs from recorded runs: the command rigcal, as objects with arrays.

    import rigcal

    campaign = rigcal.load("demo/campaign.toml")
    fit = campaign.fit()
    print(fit.parameter("mass").value, fit.verdict)
    fit.write("demo")

Everything is in SI units, named at the end of a name (`time_s`) or in `unit`. Results are the bits that the command
computes. docs/python.md tells more.
"""

from rigcal._rigcal import (
    Aspect,
    Assessment,
    BootstrapSpread,
    Campaign,
    Channel,
    Check,
    Condition,
    Fit,
    FittedParameter,
    Iteration,
    LimitCheck,
    Parameter,
    Pieces,
    PosteriorSpread,
    Profile,
    ProfileEnd,
    Reason,
    Record,
    Repeat,
    ScoredChannel,
    ScoredCondition,
    Simulation,
    Start,
    __revision__,
    __version__,
    load,
)
from rigcal.errors import InputError, Interrupted, NoResultError, RigcalError, UsageError, WriteError

__all__ = [
    "Aspect",
    "Assessment",
    "BootstrapSpread",
    "Campaign",
    "Channel",
    "Check",
    "Condition",
    "Fit",
    "FittedParameter",
    "InputError",
    "Interrupted",
    "Iteration",
    "LimitCheck",
    "NoResultError",
    "Parameter",
    "Pieces",
    "PosteriorSpread",
    "Profile",
    "ProfileEnd",
    "Reason",
    "Record",
    "Repeat",
    "RigcalError",
    "ScoredChannel",
    "ScoredCondition",
    "Simulation",
    "Start",
    "UsageError",
    "WriteError",
    "__revision__",
    "__version__",
    "load",
]
