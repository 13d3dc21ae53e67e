"""What goes wrong, as exceptions. Arguments out of their range are ValueErrors that name the argument."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rigcal._rigcal import Fit

__all__ = ["InputError", "Interrupted", "NoResultError", "RigcalError", "UsageError", "WriteError"]


class RigcalError(Exception):
    """Base of all errors of rigcal; str() is the message of the command."""


class InputError(RigcalError):
    """A campaign, record or result file is wrong: str() gives the place, what was found and what was expected.

    Attributes:
        file: its path; of a key, what the message begins with
        line, column: from 1; None where they are not known
    """

    def __init__(self, message: str, file: str = "", line: int | None = None, column: int | None = None) -> None:
        super().__init__(message, file, line, column)
        self.file = file
        self.line = line
        self.column = column

    def __str__(self) -> str:
        return str(self.args[0])


class UsageError(RigcalError, ValueError):
    """What was asked for does not fit the campaign: an unknown parameter, a value outside its limits."""


class NoResultError(RigcalError):
    """Nothing usable came out of making records; a fit or simulation that fails says so in its status."""


class WriteError(RigcalError):
    """A result file could not be written."""


class Interrupted(KeyboardInterrupt):
    """Ctrl-C ended a fit or validation.

    Attributes:
        fit: the best that was found by then, status "stopped"; it can be written as any other
    """

    def __init__(self, message: str, fit: Fit) -> None:
        super().__init__(message)
        self.fit = fit
