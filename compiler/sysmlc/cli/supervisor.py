"""The parent process of a command: it reports a command that a limit, or a crash, has ended.

The command runs in a forked child, in which the operating system enforces the limits (limits.py).
Python code cannot do that: while a C library parses or computes, no signal handler and no thread
runs. A signal without a handler ends the child at once, and the parent is left to say why.
"""

import os
import signal
import struct
import sys
from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from mmap import mmap
from types import FrameType
from typing import TYPE_CHECKING, Any, NoReturn

if TYPE_CHECKING:
    from sysmlc.diagnostics import Rule


_SENT_BY_USERS = [
    getattr(signal, name)
    for name in ("SIGINT", "SIGTERM", "SIGHUP", "SIGQUIT")
    if hasattr(signal, name)
]
_FORWARDED = ("SIGINT", "SIGTERM", "SIGHUP", "SIGQUIT", "SIGUSR1", "SIGUSR2")
OUT_OF_MEMORY = 75
"""Exit code of a child that has reported its memory limit; the command exits with 2."""


class SharedState:
    """What a command tells the parent process, and a later child, in memory that they share."""

    _LAYOUT = struct.Struct("d?I")

    def __init__(self) -> None:
        self._memory = mmap(-1, self._LAYOUT.size)

    @property
    def time_limit(self) -> float:
        """Seconds after which the child ends; the parent names them in its report."""
        return float(self._read()[0])

    @time_limit.setter
    def time_limit(self, seconds: float) -> None:
        self._LAYOUT.pack_into(self._memory, 0, seconds, *self._read()[1:])

    @property
    def is_watching(self) -> bool:
        """Whether the child watches files: the command goes on in a new child after a limit.

        It does not if a limit is reached before, which would happen again and again.
        """
        return bool(self._read()[1])

    @property
    def input_digest(self) -> int:
        """The state of the inputs that were compiled last."""
        return int(self._read()[2])

    def start_build(self, input_digest: int) -> None:
        """Note that the command watches files and now compiles them in the state of the digest."""
        self._LAYOUT.pack_into(self._memory, 0, self.time_limit, True, input_digest)

    def start_child(self) -> None:
        """Note that a new child has not yet come to watch files."""
        self._LAYOUT.pack_into(self._memory, 0, self.time_limit, False, self.input_digest)

    def _read(self) -> tuple[Any, ...]:
        return self._LAYOUT.unpack_from(self._memory)


_Handler = Callable[[int, FrameType | None], Any] | int | None
Run = Callable[[SharedState], NoReturn]
"""Runs a command in the child and ends the process."""


def can_supervise() -> bool:
    """Return whether commands can run in a child process.

    A tracer or profiler that was started with this process would not see a child.
    """
    return hasattr(os, "fork") and not (sys.gettrace() or sys.getprofile())


def supervise(run: Run) -> NoReturn:
    """Run a command in a child process and end as it ends; report a limit or a crash (code 2).

    A command that watches files goes on in a new child after a limit or a crash.
    """
    shared = SharedState()
    handlers = _find_forwarded_signals()
    while True:
        shared.start_child()
        child = _fork(run, shared, handlers)
        _forward_signals(handlers, child)
        code = _wait_for(child)
        is_over = code >= 0 and code != OUT_OF_MEMORY
        if is_over or -code in _SENT_BY_USERS:
            _end_as(code)
        _report_end(code, shared)
        if not shared.is_watching:
            os._exit(2)


def _fork(run: Run, shared: SharedState, handlers: Mapping[int, "_Handler"]) -> int:
    """Start a child process that runs the command with the signal *handlers*; return its id."""
    lifeline, held_end = os.pipe()
    parent = os.getpid()
    child = os.fork()
    if child == 0:
        os.close(held_end)
        for number, handler in handlers.items():
            signal.signal(number, handler)
        _end_with_parent(lifeline, parent)
        run(shared)
    os.close(lifeline)
    return child


def _end_with_parent(lifeline: int, parent: int) -> None:
    """Let the system end this process when its parent is killed.

    Only the parent holds the other end of the pipe *lifeline*. The system closes that end with the
    parent and signals the reader; without a handler, SIGIO ends a process on Linux. Elsewhere a
    command whose parent was killed runs to its end.
    """
    import fcntl

    fcntl.fcntl(lifeline, fcntl.F_SETOWN, os.getpid())
    flags = fcntl.fcntl(lifeline, fcntl.F_GETFL)
    fcntl.fcntl(lifeline, fcntl.F_SETFL, flags | getattr(os, "O_ASYNC", 0))
    # The parent may have died before the descriptor was set up; then no signal would follow.
    if os.getppid() != parent:
        os._exit(2)


def _find_forwarded_signals() -> "dict[int, _Handler]":
    """Return the signals that are passed on, with their handlers; ignored ones are not."""
    numbers = [getattr(signal, name) for name in _FORWARDED]
    handlers = {number: signal.getsignal(number) for number in numbers}
    return {
        number: handler for number, handler in handlers.items() if handler is not signal.SIG_IGN
    }


def _forward_signals(numbers: Iterable[int], child: int) -> None:
    """Pass signals on to the child; a key press such as Ctrl-C reaches the child by itself."""

    def forward(number: int, _frame: FrameType | None) -> None:
        if number not in (signal.SIGINT, signal.SIGQUIT) or not _is_in_foreground():
            # The child may have ended a moment ago.
            with suppress(ProcessLookupError):
                os.kill(child, number)

    for number in numbers:
        signal.signal(number, forward)


def _is_in_foreground() -> bool:
    """Return whether this process gets the signals of the keyboard of its terminal."""
    try:
        with open("/dev/tty", "rb", buffering=0) as terminal:  # noqa: PTH123
            return os.tcgetpgrp(terminal.fileno()) == os.getpgrp()
    except OSError:
        return False


def _wait_for(child: int) -> int:
    """Return the exit code of *child*; the negative number of the signal that ended it."""
    _, status = os.waitpid(child, 0)
    return os.waitstatus_to_exitcode(status)


def _end_as(code: int) -> NoReturn:
    """End this process as the child ended: with its exit code, or by the same signal."""
    if code < 0:
        # A shell sees by the signal that Ctrl-C ended the command, and ends a loop around it.
        signal.signal(-code, signal.SIG_DFL)
        os.kill(os.getpid(), -code)
    os._exit(code)


def _report_end(code: int, shared: SharedState) -> None:
    """Report why a child has ended early, unless it has done so itself."""
    if -code == signal.SIGALRM:
        report_time_limit(shared.time_limit)
    elif code < 0:
        report_crash(-code)


# -- reports -----------------------------------------------------------------------------------


def report_time_limit(seconds: float) -> None:
    """Report that the command reached its time limit."""
    from sysmlc.driver import faults

    _report(faults.TIME_LIMIT, seconds=f"{seconds:g}")


def report_memory_limit(gibibytes: float) -> None:
    """Report that the command ran out of memory; *gibibytes* is its limit, 0 if it has none."""
    from sysmlc.driver import faults

    limit = f"{gibibytes:g} GiB of memory are" if gibibytes else "the memory of this machine is"
    _report(faults.MEMORY_LIMIT, limit=limit)


def report_crash(number: int) -> None:
    """Report that a signal has ended the command."""
    from sysmlc.driver import faults

    name = signal.Signals(number).name if number in signal.valid_signals() else str(number)
    _report(faults.CRASH, signal=name)


def _report(rule: "Rule", **facts: str) -> None:
    """Print a diagnostic as text on standard error; standard output may belong to a report."""
    from sysmlc.diagnostics import Sink, Subject
    from sysmlc.diagnostics.renderers import make_report, render

    sink = Sink()
    sink.report(rule, Subject(), notes=(), help="", **facts)
    # The bar of a command that was ended may still stand in the last line of the terminal.
    line_start = "\r\x1b[K" if sys.stderr.isatty() else ""
    with suppress(OSError):
        sys.stderr.write(line_start + render(make_report(sink, ()), "text"))
        sys.stderr.flush()
