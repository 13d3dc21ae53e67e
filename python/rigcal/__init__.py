"""Calibrates models of servo-hydraulic rigs from recorded runs: the rigcal command as Python objects with arrays.

    import rigcal

    campaign = rigcal.load("demo/campaign.toml")
    fit = campaign.fit()
    print(fit.parameter("mass").value, fit.verdict)
    fit.write("demo")

All values are in SI units, given at the end of a name (`time_s`) or in `unit`. Results are bitwise identical to those
of the command. See docs/python.md.
"""

from rigcal._rigcal import (
    Aspect,
    Assessment,
    AveragedEstimate,
    BootstrapSpread,
    BudgetLine,
    Campaign,
    Channel,
    Check,
    Condition,
    Fit,
    FittedParameter,
    Iteration,
    LimitCheck,
    Page,
    Parameter,
    Pieces,
    PosteriorSpread,
    Profile,
    ProfileEnd,
    Reason,
    Record,
    Repeat,
    Result,
    ScoredChannel,
    ScoredCondition,
    Simulation,
    Start,
    UncertaintyBudget,
    __revision__,
    __version__,
    batch,
    compare,
    init,
    load,
)
from rigcal.errors import InputError, Interrupted, NoResultError, RigcalError, UsageError, WriteError

__all__ = [
    "Aspect",
    "Assessment",
    "AveragedEstimate",
    "BootstrapSpread",
    "BudgetLine",
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
    "Page",
    "Parameter",
    "Pieces",
    "PosteriorSpread",
    "Profile",
    "ProfileEnd",
    "Reason",
    "Record",
    "Repeat",
    "Result",
    "RigcalError",
    "ScoredChannel",
    "ScoredCondition",
    "Simulation",
    "Start",
    "UncertaintyBudget",
    "UsageError",
    "WriteError",
    "__revision__",
    "__version__",
    "batch",
    "compare",
    "init",
    "load",
]
