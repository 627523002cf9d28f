"""The parent process of a command: it reports why its child process ended early.

The command runs in a forked child, in which the operating system enforces the limits (limits.py).
Python code cannot enforce them: while a C library parses or computes, no signal handler and no
thread runs. A signal without a handler ends the child at once, and the parent reports the reason
(decision 41).
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


_USER_SIGNALS = [
    getattr(signal, name)
    for name in ("SIGINT", "SIGTERM", "SIGHUP", "SIGQUIT")
    if hasattr(signal, name)
]
_FORWARDED = ("SIGINT", "SIGTERM", "SIGHUP", "SIGQUIT", "SIGUSR1", "SIGUSR2")
OUT_OF_MEMORY = 75
"""Exit code of a child that has reported its memory limit; the command exits with 2."""


class SharedState:
    """Memory that a command shares with its parent process and with later child processes."""

    # Time limit in seconds, whether the command watches files, digest of the inputs.
    _LAYOUT = struct.Struct("d?I")

    def __init__(self) -> None:
        # Anonymous memory that a forked child shares.
        self._memory = mmap(-1, self._LAYOUT.size)

    @property
    def time_limit(self) -> float:
        """Seconds after which the child ends; the parent prints them in its report."""
        return float(self._read()[0])

    @time_limit.setter
    def time_limit(self, seconds: float) -> None:
        self._LAYOUT.pack_into(self._memory, 0, seconds, *self._read()[1:])

    @property
    def is_watching(self) -> bool:
        """Whether the child watches files, so that a new child replaces it after a limit.

        A child that reaches a limit before it watches is not replaced: a new child would reach the
        limit again.
        """
        return bool(self._read()[1])

    @property
    def input_digest(self) -> int:
        """A digest of the inputs of the last build."""
        return int(self._read()[2])

    def start_build(self, input_digest: int) -> None:
        """Record that the command watches files and starts to build inputs with this digest."""
        self._LAYOUT.pack_into(self._memory, 0, self.time_limit, True, input_digest)

    def start_child(self) -> None:
        """Record that a new child starts and does not watch files yet."""
        self._LAYOUT.pack_into(self._memory, 0, self.time_limit, False, self.input_digest)

    def _read(self) -> tuple[Any, ...]:
        return self._LAYOUT.unpack_from(self._memory)


_Handler = Callable[[int, FrameType | None], Any] | int | None
Run = Callable[[SharedState], NoReturn]
"""Runs a command in the child and ends the process."""


def can_supervise() -> bool:
    """Whether commands can run in a child process.

    They cannot without fork, and under a tracer or profiler, which would not see a child.
    """
    return hasattr(os, "fork") and not (sys.gettrace() or sys.getprofile())


def supervise(run: Run) -> NoReturn:
    """Run a command in a child process and end this process in the same way.

    A limit or a crash is reported, with exit code 2. A command that watches files then continues in
    a new child.
    """
    shared = SharedState()
    handlers = _find_forwarded_signals()
    while True:
        shared.start_child()
        child = _fork(run, shared, handlers)
        _forward_signals(handlers, child)
        code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        is_over = code >= 0 and code != OUT_OF_MEMORY
        if is_over or -code in _USER_SIGNALS:
            _end_as(code)
        _report_end(code, shared)
        if not shared.is_watching:
            os._exit(2)


def _fork(run: Run, shared: SharedState, handlers: Mapping[int, "_Handler"]) -> int:
    """Start a child process that runs the command; return its id.

    *handlers* are the signal handlers from before the supervision.
    """
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
    """Return the signals to forward, with their handlers; ignored signals remain ignored."""
    numbers = [getattr(signal, name) for name in _FORWARDED]
    handlers = {number: signal.getsignal(number) for number in numbers}
    return {
        number: handler for number, handler in handlers.items() if handler is not signal.SIG_IGN
    }


def _forward_signals(numbers: Iterable[int], child: int) -> None:
    """Forward signals to the child, except those that the keyboard sends to both processes."""

    def forward(number: int, _frame: FrameType | None) -> None:
        if number not in (signal.SIGINT, signal.SIGQUIT) or not _is_in_foreground():
            # The child may have ended a moment ago.
            with suppress(ProcessLookupError):
                os.kill(child, number)

    for number in numbers:
        signal.signal(number, forward)


def _is_in_foreground() -> bool:
    """Whether the terminal sends signals of the keyboard to this process."""
    try:
        with open("/dev/tty", "rb", buffering=0) as terminal:  # noqa: PTH123
            return os.tcgetpgrp(terminal.fileno()) == os.getpgrp()
    except OSError:
        return False


def _end_as(code: int) -> NoReturn:
    """End this process as the child ended: with its exit code, or by the same signal."""
    if code < 0:
        # A shell sees by the signal that Ctrl-C ended the command, and ends a loop around it.
        signal.signal(-code, signal.SIG_DFL)
        os.kill(os.getpid(), -code)
    os._exit(code)


def _report_end(code: int, shared: SharedState) -> None:
    """Report why a child ended early; a child reports its memory limit itself."""
    from sysmlc.driver import faults

    if -code == signal.SIGALRM:
        _report(faults.TIME_LIMIT, seconds=f"{shared.time_limit:g}")
    elif code < 0:
        name = signal.Signals(-code).name if -code in signal.valid_signals() else str(-code)
        _report(faults.CRASH, signal=name)


# -- reports -----------------------------------------------------------------------------------


_OWN_GIBIBYTES = 0.06
"""Memory that a command needs without any model."""


def report_memory_limit(gibibytes: float) -> None:
    """Report that the command ran out of memory; *gibibytes* is its limit, 0 if it has none."""
    from sysmlc.driver import faults

    limit = f"{gibibytes:g} GiB of memory are" if gibibytes else "the memory of this machine is"
    is_small = 0 < gibibytes < _OWN_GIBIBYTES
    notes = (f"the interpreter and its libraries need up to {_OWN_GIBIBYTES} GiB",) * is_small
    _report(faults.MEMORY_LIMIT, notes, limit=limit)


def _report(rule: "Rule", notes: tuple[str, ...] = (), **facts: str) -> None:
    """Print a diagnostic as text on standard error; standard output may belong to a report."""
    from sysmlc.diagnostics import Sink, Subject
    from sysmlc.diagnostics.renderers import make_report, render

    sink = Sink()
    sink.report(rule, Subject(), notes=notes, help="", **facts)
    # The bar of a command that was ended may still stand in the last line of the terminal.
    line_start = "\r\x1b[K" if sys.stderr.isatty() else ""
    with suppress(OSError):
        sys.stderr.write(line_start + render(make_report(sink, ()), "text"))
        sys.stderr.flush()
