"""Progress of a compilation, shown on terminals if the compilation takes over a second."""

import sys
import time
from collections.abc import Callable
from typing import TYPE_CHECKING

import click

from sysmlc.cli import terminal
from sysmlc.driver import Observer
from sysmlc.support.counts import count

if TYPE_CHECKING:
    from sysmlc.ir import Graph

_DELAY = 1.0
"""Seconds before the bar appears."""
_BAR_WIDTH = 24


class Progress(Observer):
    """Draws a bar on standard error; prints the graphs of ``--print-after`` and tracebacks."""

    def __init__(
        self,
        verbose: bool = False,
        print_after: tuple[str, ...] = (),
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._verbose = verbose
        self._print_after = print_after
        self._clock = clock
        self._start = clock()
        self._on_terminal = sys.stderr.isatty()
        self._drawn = False

    def step(self, description: str, number: int, total: int) -> None:
        """Draw the bar; with ``-v``, print the step instead."""
        passed = self._clock() - self._start
        if self._verbose:
            terminal.echo(f"{passed:7.2f} s  {description}", err=True)
        elif self._on_terminal and passed > _DELAY:
            filled = _BAR_WIDTH * number // max(total, 1)
            bar = "#" * filled + "-" * (_BAR_WIDTH - filled)
            click.echo(f"\r[{bar}] {description:<30}", nl=False, err=True)
            self._drawn = True

    def note(self, description: str) -> None:
        """Show a step whose share of the work is unknown."""
        passed = self._clock() - self._start
        if self._on_terminal and passed > _DELAY:
            click.echo(f"\r{passed:7.0f} s  {description:<50}", nl=False, err=True)
            self._drawn = True

    def after(self, step: str, graph: "Graph") -> None:
        """Print the graph after the passes of ``--print-after``; with ``-v`` name the library."""
        if step == "read" and self._verbose:
            self._show_libraries(graph)
        if step in self._print_after:
            from sysmlc.ir.text import print_text

            self.clear()
            terminal.echo_text(f"// after {step}\n{print_text(graph)}", nl=False)

    def _show_libraries(self, graph: "Graph") -> None:
        from sysmlc.language.names import Model

        for model in graph.derived(Model):
            library = model.library
            text = f"SysML v2 library: {library.label}, {count(len(library.paths()), 'file')}"
            click.echo(f"{'':9} {text}", err=True)

    def fault(self, where: str, trace: str) -> None:
        """With ``-v``, print the traceback of an internal fault."""
        if self._verbose:
            terminal.echo_text(f"{where}:\n{trace}", err=True, nl=False)

    def clear(self) -> None:
        """Remove the bar before other text is printed."""
        if self._drawn:
            # Return to the start of the line and erase it (ECMA-48, EL).
            click.echo("\r\x1b[K", nl=False, err=True)
            self._drawn = False
