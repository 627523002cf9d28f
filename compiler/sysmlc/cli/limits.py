"""The time and memory limit of a command: options, configuration, enforcement.

The operating system enforces both limits in the process that supervisor.py forks for a command. A
timer sends SIGALRM, which ends the process. Allocations beyond the memory limit fail, so that
Python raises MemoryError.
"""

import os
import signal
import sys
import time
from contextlib import suppress
from mmap import mmap

import click

from sysmlc.cli.supervisor import write_time_limit

DEFAULT_SECONDS = 300.0
DEFAULT_GIBIBYTES = 8.0
_GIBIBYTE = 1 << 30
_OWN_MEMORY = 256 << 20
"""Bytes that the interpreter and the libraries take in any command; the limit comes on top."""
_HIGHEST = 1_000_000_000
_SHORTEST = 0.001
"""A timer of 0 s would be no timer."""


class Limits:
    """The limits of the command that this process runs; 0 is no limit."""

    def __init__(self) -> None:
        self.seconds = DEFAULT_SECONDS
        self.gibibytes = DEFAULT_GIBIBYTES
        self._start = time.monotonic()
        self._shared: mmap | None = None

    def enforce(self, shared: mmap) -> None:
        """Enforce limits in this process from now on; *shared* is read by the parent process."""
        self._shared = shared
        # A parent process may have left SIGALRM ignored or blocked.
        signal.signal(signal.SIGALRM, signal.SIG_DFL)
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGALRM})
        self.set_seconds(self.seconds)

    def set_seconds(self, seconds: float) -> None:
        """Set the time limit, counted from the start of the command."""
        self.seconds = seconds
        if self._shared is None:
            return
        elapsed = time.monotonic() - self._start
        write_time_limit(self._shared, seconds)
        signal.setitimer(signal.ITIMER_REAL, max(seconds - elapsed, _SHORTEST) if seconds else 0)

    def set_gibibytes(self, gibibytes: float) -> None:
        """Set the memory limit."""
        self.gibibytes = gibibytes
        if self._shared is not None:
            size = int(gibibytes * _GIBIBYTE) + _OWN_MEMORY if gibibytes else None
            _set_memory_limit(size)

    def lower(self, seconds: float, gibibytes: float) -> None:
        """Lower the limits to those of a configuration, which cannot raise them; 0 is no limit."""
        if seconds and (not self.seconds or seconds < self.seconds):
            self.set_seconds(seconds)
        if gibibytes and (not self.gibibytes or gibibytes < self.gibibytes):
            self.set_gibibytes(gibibytes)

    def stop_timer(self) -> None:
        """End the time limit: from now on the command waits for its user."""
        if self._shared is not None:
            signal.setitimer(signal.ITIMER_REAL, 0)

    def release_memory(self) -> None:
        """End the memory limit, so that a diagnostic about it can be printed."""
        if self._shared is not None:
            _set_memory_limit(None)


LIMITS = Limits()
"""Limits concern the whole process, hence one object for it."""


def list_missing_limits() -> list[str]:
    """Return the options of the limits that this system does not enforce.

    Only Linux counts all memory that a process allocates; Windows has no fork.
    """
    has_limit = {"--time-limit": hasattr(os, "fork"), "--memory-limit": sys.platform == "linux"}
    return [option for option, is_enforced in has_limit.items() if not is_enforced]


def _set_memory_limit(size: int | None) -> None:
    """Limit the data of this process to *size* bytes (None: to what the system allows)."""
    if "--memory-limit" in list_missing_limits():
        return
    import resource

    _, hard = resource.getrlimit(resource.RLIMIT_DATA)
    highest = resource.RLIM_INFINITY
    is_lower = size is not None and (hard == highest or size < hard)
    with suppress(OSError, ValueError):
        resource.setrlimit(resource.RLIMIT_DATA, (size if is_lower and size else hard, hard))


def add_limit_options(command: click.Command) -> None:
    """Give *command*, or all commands of a group, ``--time-limit`` and ``--memory-limit``."""
    if isinstance(command, click.Group):
        for subcommand in command.commands.values():
            add_limit_options(subcommand)
    elif not any(parameter.name == "time_limit" for parameter in command.params):
        command.params += [_time_limit_option(), _memory_limit_option()]


def check_amount(_ctx: click.Context, _param: click.Parameter, value: float) -> float:
    """Return *value*, seconds or GiB, if it is a finite number from 0 on; 0 is no limit."""
    if not 0 <= value <= _HIGHEST:
        raise click.BadParameter(f"{value} is not from 0 to {_HIGHEST:,}")
    return value


def _time_limit_option() -> click.Option:
    def set_limit(ctx: click.Context, parameter: click.Parameter, value: float) -> None:
        LIMITS.set_seconds(check_amount(ctx, parameter, value))

    return click.Option(
        ["--time-limit"],
        type=float,
        callback=set_limit,
        expose_value=False,
        default=DEFAULT_SECONDS,
        show_default=True,
        metavar="S",
        help="End the command with exit code 2 after S seconds; 0 is no limit.",
    )


def _memory_limit_option() -> click.Option:
    def set_limit(ctx: click.Context, parameter: click.Parameter, value: float) -> None:
        LIMITS.set_gibibytes(check_amount(ctx, parameter, value))

    return click.Option(
        ["--memory-limit"],
        type=float,
        callback=set_limit,
        expose_value=False,
        default=DEFAULT_GIBIBYTES,
        show_default=True,
        metavar="GIB",
        help="End the command with exit code 2 when it needs more memory; 0 is no limit.",
    )
