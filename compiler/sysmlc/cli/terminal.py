"""Standard output and standard error: escape text of models, handle closed and full streams."""

import io
import os
import sys
from contextlib import suppress
from typing import TYPE_CHECKING, NoReturn, TextIO, cast

import click

from sysmlc.support.escapes import escape_invisible

if TYPE_CHECKING:
    from typing_extensions import Buffer

_FAILED = 2
_NAMES = ("standard output", "standard error")


def echo(line: str, *, err: bool = False) -> None:
    """Print a line that may quote models or file names.

    Invisible characters are printed as escapes. That holds for line ends, too: a name must not
    start a line of its own, which a continuous integration service may read as a command.
    """
    click.echo(escape_invisible(line), err=err)


def echo_text(text: str, *, err: bool = False, nl: bool = True) -> None:
    """Print text of several lines; escape invisible characters except tabs and line ends.

    The caller ensures that names in the text have no line ends.
    """
    click.echo(escape_invisible(text, "\n\t"), err=err, nl=nl)


class _RecordingStream(io.RawIOBase):
    """A raw standard stream that records its first fault.

    The text and buffer layers above it discard the text after a fault, without a record of it.
    """

    def __init__(self, raw: io.RawIOBase) -> None:
        self._raw = raw
        self.problem: OSError | None = None

    def write(self, data: "Buffer") -> int | None:
        try:
            return self._raw.write(data)
        except OSError as problem:
            self.problem = self.problem or problem
            raise

    def writable(self) -> bool:
        return True

    def fileno(self) -> int:
        return self._raw.fileno()

    def isatty(self) -> bool:
        return self._raw.isatty()


_streams: list[tuple[str, TextIO, _RecordingStream]] = []
"""The standard streams of the process; empty if a test calls a command directly."""


def open_streams() -> None:
    """Prepare standard output and standard error; end with exit code 2 if one is closed.

    Otherwise a file that is opened later would get the file descriptor of the closed stream, and
    diagnostics would be written into that file.
    """
    if sys.stdout is None or sys.stderr is None:
        name = _NAMES[0] if sys.stdout is None else _NAMES[1]
        _write_last_words(f"{name} is closed; redirect it to {os.devnull} to discard it")
        os._exit(_FAILED)
    sys.stdout = _record(_NAMES[0], sys.stdout)
    sys.stderr = _record(_NAMES[1], sys.stderr)


def _record(name: str, stream: TextIO) -> TextIO:
    # With 'python -u' there is no buffer around the raw stream.
    raw = _RecordingStream(
        getattr(stream.buffer, "raw", None) or cast("io.RawIOBase", stream.buffer)
    )
    wrapper = io.TextIOWrapper(
        io.BufferedWriter(raw),
        encoding=stream.encoding,
        # A character that the encoding of the terminal lacks must not end the command.
        errors="backslashreplace",
        line_buffering=stream.line_buffering,  # type: ignore[arg-type]
    )
    _streams.append((name, wrapper, raw))
    return wrapper


def leave(code: int) -> NoReturn:
    """End the process with *code*, or with 2 if a standard stream did not take all text.

    Python's own exit would first free all objects, which takes a fortieth of a compilation, and it
    would print a report of its own about a broken stream.
    """
    problems = find_stream_problems()
    for name, problem in problems.items():
        # A reader that has ended, as in '| head', is no news to the user.
        if not isinstance(problem, BrokenPipeError):
            _write_last_words(f"cannot write to {name}: {problem.strerror}")
    os._exit(_FAILED if problems else code)


def find_stream_problems() -> dict[str, OSError]:
    """Flush the standard streams; return the first fault of each broken stream."""
    for _, stream, _ in _streams:
        with suppress(OSError):
            stream.flush()
    return {name: raw.problem for name, _, raw in _streams if raw.problem is not None}


def _write_last_words(message: str) -> None:
    """Write to the file descriptor of standard error; ignore faults."""
    with suppress(OSError):
        os.write(2, f"sysmlc: {message}\n".encode(errors="backslashreplace"))
