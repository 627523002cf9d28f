"""The parent process of a command: it reports a command that a limit, or a crash, has ended.

The command runs in a forked child, in which the operating system enforces the limits (limits.py).
Python code cannot do that: while a C library parses or computes, no signal handler and no thread
runs. A signal without a handler ends the child at once, and the parent is left to say why.
"""

import os
import signal
import struct
import sys
from collections.abc import Callable
from mmap import mmap
from types import FrameType
from typing import NoReturn

_FORWARDED = ("SIGINT", "SIGTERM", "SIGHUP", "SIGQUIT", "SIGUSR1", "SIGUSR2")
_TIME_LIMIT = struct.Struct("d")

Run = Callable[[mmap], NoReturn]
"""Runs a command in the child and ends the process. The command writes its time limit, in seconds,
to the beginning of the memory that it shares with the parent."""


def can_supervise() -> bool:
    """Return whether commands can run in a child process.

    A tracer or profiler that was started with this process would not see a child.
    """
    return hasattr(os, "fork") and not (sys.gettrace() or sys.getprofile())


def supervise(run: Run) -> NoReturn:
    """Run a command in a child process and end as it ends; report a limit or a crash (code 2)."""
    shared = mmap(-1, _TIME_LIMIT.size)
    lifeline, held_end = os.pipe()
    parent = os.getpid()
    child = os.fork()
    if child == 0:
        os.close(held_end)
        _end_with_parent(lifeline, parent)
        run(shared)
    os.close(lifeline)
    _forward_signals(child)
    _end_as(_wait_for(child), shared)


def write_time_limit(shared: mmap, seconds: float) -> None:
    """Let the parent know the time limit, which it names when the limit is reached."""
    _TIME_LIMIT.pack_into(shared, 0, seconds)


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
    if os.getppid() != parent:
        os._exit(2)


def _forward_signals(child: int) -> None:
    """Pass signals on to the child; a key press such as Ctrl-C reaches the child by itself."""

    def forward(number: int, _frame: FrameType | None) -> None:
        if number not in (signal.SIGINT, signal.SIGQUIT) or not _is_in_foreground():
            os.kill(child, number)

    for name in _FORWARDED:
        number = getattr(signal, name)
        if signal.getsignal(number) is not signal.SIG_IGN:
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


def _end_as(code: int, shared: mmap) -> NoReturn:
    """End this process as the child ended; a signal that the user did not send is a fault."""
    number = -code
    if number == signal.SIGALRM:
        from sysmlc.cli.limit_reports import report_time_limit

        report_time_limit(_TIME_LIMIT.unpack_from(shared)[0])
        code = 2
    elif number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT):
        signal.signal(number, signal.SIG_DFL)
        os.kill(os.getpid(), number)
    elif number > 0:
        from sysmlc.cli.limit_reports import report_crash

        report_crash(number)
        code = 2
    os._exit(code)
