"""Standard output and standard error: closed, full, and text of models that is printed on them."""

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
    """Print text of several lines, whose names have no line ends; escape as ``echo`` does."""
    click.echo(escape_invisible(text, "\n\t"), err=err, nl=nl)


class _RecordingStream(io.RawIOBase):
    """A standard stream that records the first fault: the layers above drop the text and forget."""

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
"""The standard streams of a process that runs ``sysmlc``; empty where a test calls a command."""


def open_streams() -> None:
    """Prepare standard output and standard error; end with exit code 2 if one is closed.

    Nobody could read the diagnostics, and a file that is opened later would get the number of the
    closed stream, so that messages would be written into it.
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
        errors="backslashreplace",
        line_buffering=stream.line_buffering,  # type: ignore[arg-type]
    )
    _streams.append((name, wrapper, raw))
    return wrapper


def leave(code: int) -> NoReturn:
    """End the process with *code*, or with 2 if a standard stream did not take all text.

    Python's own way out would take the compilation apart first, which costs a fortieth of it, and
    would report a broken stream in lines of its own.
    """
    problems = find_stream_problems()
    for name, problem in problems.items():
        # A reader that has ended, as in '| head', is no news to the user.
        if not isinstance(problem, BrokenPipeError):
            _write_last_words(f"cannot write to {name}: {problem.strerror}")
    os._exit(_FAILED if problems else code)


def find_stream_problems() -> dict[str, OSError]:
    """Write what is still buffered and return the first fault of each broken stream."""
    for _, stream, _ in _streams:
        with suppress(OSError):
            stream.flush()
    return {name: raw.problem for name, _, raw in _streams if raw.problem is not None}


def _write_last_words(message: str) -> None:
    """Write to the descriptor of standard error, as far as it takes anything."""
    with suppress(OSError):
        os.write(2, f"sysmlc: {message}\n".encode(errors="backslashreplace"))
