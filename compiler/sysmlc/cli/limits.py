"""The time and memory limit of a command: options, configuration, enforcement.

The operating system enforces both limits in the process that supervisor.py forks for a command. A
timer sends SIGALRM, which ends the process. Allocations beyond the memory limit fail, so that
Python raises MemoryError.
"""

import os
import signal
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress

import click

from sysmlc.cli.supervisor import SharedState

DEFAULT_SECONDS = 300.0
# As much as CUDD had by default (decision 41).
DEFAULT_GIBIBYTES = 8.0
_GIBIBYTE = 1 << 30
_OWN_MEMORY = 64 << 20
"""Bytes that interpreter and libraries need in any command: what a limit may be exceeded by."""
_MAX_EXCESS = 5
"""The largest excess is the limit divided by this number, if that is less."""
_MAX_AMOUNT = 1_000_000_000
_MIN_SECONDS = 0.001
"""The shortest timer in seconds: setitimer with 0 would switch the timer off."""


class Limits:
    """The limits of the command that this process runs; 0 is no limit."""

    def __init__(self) -> None:
        self.seconds = DEFAULT_SECONDS
        self.gibibytes = DEFAULT_GIBIBYTES
        self._options = (self.seconds, self.gibibytes)
        self._start = time.monotonic()
        self._is_timed = True
        self._shared: SharedState | None = None

    @property
    def is_enforced(self) -> bool:
        """Whether a parent process enforces the limits and reports that one was reached."""
        return self._shared is not None

    @property
    def memory(self) -> int:
        """The memory limit in bytes; 0 is no limit."""
        return int(self.gibibytes * _GIBIBYTE)

    def enforce(self, shared: SharedState) -> None:
        """Enforce the limits in this process from now on; the parent process reads *shared*."""
        self._shared = shared
        self._start = time.monotonic()
        # A parent process may have left SIGALRM ignored or blocked.
        signal.signal(signal.SIGALRM, signal.SIG_DFL)
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGALRM})
        self._set(*self._options)

    def set_time_option(self, seconds: float) -> None:
        """Set the time limit of the command line, counted from the start of the command."""
        self._options = (seconds, self._options[1])
        self._set(*self._options)

    def set_memory_option(self, gibibytes: float) -> None:
        """Set the memory limit of the command line."""
        self._options = (self._options[0], gibibytes)
        self._set(*self._options)

    def lower(self, seconds: float, gibibytes: float) -> None:
        """Lower the limits to those of a configuration; 0 is no limit.

        A configuration cannot raise the limits of the command line, because it may be untrusted.
        """
        self._set(_lower(self.seconds, seconds), _lower(self.gibibytes, gibibytes))

    def stop_timer(self) -> None:
        """Stop the timer; from now on the command waits for its user."""
        self._is_timed = False
        self._set(self.seconds, self.gibibytes)

    def has_ended_build(self, input_digest: int) -> bool:
        """Whether an earlier child process reached a limit with the same inputs."""
        return self._shared is not None and self._shared.input_digest == input_digest

    @contextmanager
    def limit_build(self, input_digest: int) -> Iterator[None]:
        """Apply the limits to a build of a command that watches files.

        The parent process starts the command again when the build reaches a limit.
        """
        if self._shared is not None:
            self._shared.start_build(input_digest)
        with self.apply_to_block():
            yield

    @contextmanager
    def apply_to_block(self) -> Iterator[None]:
        """Apply the limits to the block, starting from the limits of the command line.

        The block may read the configuration again and lower the limits.
        """
        self._start, self._is_timed = time.monotonic(), True
        self._set(*self._options)
        try:
            yield
        finally:
            self.stop_timer()

    def _set(self, seconds: float, gibibytes: float) -> None:
        self.seconds, self.gibibytes = seconds, gibibytes
        if self._shared is None:
            return
        self._shared.time_limit = seconds
        remaining = max(seconds - (time.monotonic() - self._start), _MIN_SECONDS)
        is_limited = self._is_timed and seconds
        signal.setitimer(signal.ITIMER_REAL, remaining if is_limited else 0)
        own_memory = min(_OWN_MEMORY, self.memory // _MAX_EXCESS)
        _set_memory_limit(self.memory + own_memory if gibibytes else None)

    def release_memory(self) -> None:
        """End the memory limit, so that a diagnostic about it can be printed."""
        if self._shared is not None:
            _set_memory_limit(None)


def _lower(limit: float, other: float) -> float:
    """Return the lower of two limits; 0 is no limit."""
    return min(limit, other) if limit and other else limit or other


LIMITS = Limits()
"""The limits of this process; the operating system has one timer and one limit for each."""


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

    # RLIMIT_AS would count address space that libraries only reserve.
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
        command.params += [
            _make_limit_option(
                "--time-limit",
                DEFAULT_SECONDS,
                "S",
                LIMITS.set_time_option,
                "End the command with exit code 2 after S seconds; 0 is no limit.",
            ),
            _make_limit_option(
                "--memory-limit",
                DEFAULT_GIBIBYTES,
                "GIB",
                LIMITS.set_memory_option,
                "End the command with exit code 2 when it needs more memory; 0 is no limit.",
            ),
        ]


def check_amount(_ctx: click.Context, _param: click.Parameter, value: float) -> float:
    """Return *value*, seconds or GiB, if it is a finite number from 0 on; 0 is no limit."""
    if not 0 <= value <= _MAX_AMOUNT:
        raise click.BadParameter(f"{value} is not from 0 to {_MAX_AMOUNT:,}")
    return value


def _make_limit_option(
    name: str, default: float, unit: str, set_limit: Callable[[float], None], help: str
) -> click.Option:
    """Return an option whose value, an amount in *unit*, is passed to *set_limit*."""

    def check_and_set(ctx: click.Context, parameter: click.Parameter, value: float) -> None:
        set_limit(check_amount(ctx, parameter, value))

    return click.Option(
        [name],
        type=float,
        callback=check_and_set,
        expose_value=False,
        default=default,
        show_default=True,
        metavar=unit,
        help=help,
    )
