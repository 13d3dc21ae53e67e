"""The exceptions of rigcal. An argument out of range raises a ValueError that names the argument."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rigcal._rigcal import Fit

__all__ = ["InputError", "Interrupted", "NoResultError", "RigcalError", "UsageError", "WriteError"]


class RigcalError(Exception):
    """Base class of all rigcal errors; str() is the message that the command would print."""


class InputError(RigcalError):
    """A campaign, record or result file is invalid: str() gives the place, what was found and what was expected.

    Attributes:
        file: path of the file; for an invalid key, the beginning of the message
        line, column: counted from 1; None if unknown
    """

    def __init__(self, message: str, file: str = "", line: int | None = None, column: int | None = None) -> None:
        super().__init__(message, file, line, column)
        self.file = file
        self.line = line
        self.column = column

    def __str__(self) -> str:
        return str(self.args[0])


class UsageError(RigcalError, ValueError):
    """The request does not fit the campaign: an unknown parameter, or a value outside its limits."""


class NoResultError(RigcalError):
    """No records could be generated. A failed fit or simulation does not raise this; its status says so."""


class WriteError(RigcalError):
    """A result file could not be written."""


class Interrupted(KeyboardInterrupt):
    """Ctrl-C ended a fit or validation.

    Attributes:
        fit: the best fit so far, with status "stopped"; it can be written like any other
    """

    def __init__(self, message: str, fit: Fit) -> None:
        super().__init__(message)
        self.fit = fit
