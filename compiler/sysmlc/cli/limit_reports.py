"""Diagnostics of commands that a limit or a crash has ended."""

import signal
import sys
from contextlib import suppress
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from sysmlc.diagnostics import Rule


def report_time_limit(seconds: float) -> None:
    """Report that the command reached its time limit."""
    from sysmlc.driver import process_faults

    _report(process_faults.TIME_LIMIT, seconds=f"{seconds:g}")


def report_memory_limit(gibibytes: float) -> None:
    """Report that the command ran out of memory; *gibibytes* is its limit, 0 if it has none."""
    from sysmlc.driver import process_faults

    limit = f"{gibibytes:g} GiB of memory are" if gibibytes else "the memory of this machine is"
    _report(process_faults.MEMORY_LIMIT, limit=limit)


def report_crash(number: int) -> None:
    """Report that a signal has ended the command."""
    from sysmlc.driver import process_faults

    name = signal.Signals(number).name if number in signal.valid_signals() else str(number)
    _report(process_faults.CRASH, signal=name)


def _report(rule: "Rule", **facts: str) -> None:
    """Print a diagnostic as text on standard error; standard output may belong to a report."""
    from sysmlc.diagnostics import Sink, Subject
    from sysmlc.diagnostics.render import make_report, render

    sink = Sink()
    sink.report(rule, Subject(), notes=(), help="", **facts)
    # The bar of a command that was ended may still stand in the last line of the terminal.
    line_start = "\r\x1b[K" if sys.stderr.isatty() else ""
    with suppress(OSError):
        sys.stderr.write(line_start + render(make_report(sink, ()), "text"))
        sys.stderr.flush()
