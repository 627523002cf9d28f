"""What is wrong with an input as a file, before anyone knows what it means."""

from enum import StrEnum


class Fault(StrEnum):
    """Why an input cannot be read."""

    MALFORMED = "malformed"
    """The content is damaged or of the wrong form: the model is bad, exit code 1."""
    REFUSED = "refused"
    """It asks for what safe reading never does (a DOCTYPE, a path out of the archive): exit 1."""
    LIMIT = "limit"
    """It is larger or deeper than the limits: exit code 2."""
    MISSING = "missing"
    """It cannot be opened: exit code 2."""
    CHANGING = "changing"
    """Another program is writing it: exit code 2."""


class SourceError(Exception):
    """An input that cannot be read; ``offset`` is the place in its bytes, -1 when unknown."""

    def __init__(
        self, message: str, file: str, offset: int = -1, fault: Fault = Fault.MALFORMED
    ) -> None:
        super().__init__(message)
        self.message = message
        self.file = file
        self.offset = offset
        self.fault = fault

    @property
    def exit_code(self) -> int:
        """1 when the model is wrong, 2 when we could not do our work."""
        return 2 if self.fault in (Fault.LIMIT, Fault.MISSING, Fault.CHANGING) else 1
