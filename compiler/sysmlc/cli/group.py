"""The command ``sysmlc``: run the named command, or ``build`` if none is named."""

import signal
import sys
import warnings
from collections.abc import Callable
from importlib import import_module
from typing import ParamSpec, TextIO, TypeVar

import click

from sysmlc import __version__
from sysmlc.cli import terminal
from sysmlc.cli.limits import LIMITS, add_limit_options
from sysmlc.cli.options import add_color_option
from sysmlc.cli.supervisor import OUT_OF_MEMORY, report_memory_limit
from sysmlc.support.interpreter import describe_error

COMMANDS = (
    "build",
    "check",
    "contracts",
    "coverage",
    "explain",
    "backends",
    "show",
    "diff",
    "format",
    "robots",
    "simulate",
    "synth",
    "watch",
)
"""Command words; each is a module of this package with a click command ``command``."""

_OWN_OPTIONS = frozenset({"--help", "-h", "--version"})
_P = ParamSpec("_P")
_T = TypeVar("_T")


class _Commands(click.Group):
    """Commands that are imported when they are called; ``build`` is the default command."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        if cmd_name not in COMMANDS:
            return None
        command: click.Command = import_module(f"sysmlc.cli.{cmd_name}").command
        add_limit_options(command)
        add_color_option(command)
        return command

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        if args and args[0] not in COMMANDS and args[0] not in _OWN_OPTIONS:
            args = ["build", *args]
        return super().parse_args(ctx, args)

    def invoke(self, ctx: click.Context) -> object:
        """Run the command; exit with code 130 after Ctrl-C.

        Before, Ctrl-C ends the process (``cli.main``): click would report it with exit code 1.
        """
        if signal.getsignal(signal.SIGINT) is signal.SIG_DFL:
            signal.signal(signal.SIGINT, signal.default_int_handler)
        try:
            return super().invoke(ctx)
        except KeyboardInterrupt:
            # 128 + SIGINT, as in shells: neither an error in the model (1) nor a failure (2).
            ctx.exit(130)


@click.group(
    cls=_Commands,
    context_settings={"help_option_names": ["-h", "--help"]},
    epilog="""\b
Examples:
  sysmlc model.uml -o out/         # contracts, recipes and diagrams of a model
  sysmlc check models/             # only the findings, for continuous integration
  sysmlc explain untyped-port      # why a rule exists, a wrong and a right model
  sysmlc watch model.uml -o out/   # again at every save

Exit codes: 0 clean, 1 the model has errors (with --strict also warnings),
2 the work could not be done. A folder named like a command is written ./check.""",
)
@click.version_option(__version__, message="sysmlc %(version)s")
def sysmlc() -> None:
    """Compile models of production systems: SysML in; contracts, recipes, diagrams out.

    Without a command word, MODEL... is compiled as by 'sysmlc build'.
    """


def main() -> None:
    """Run the command line; an internal fault is reported in one sentence, with exit code 2."""
    terminal.open_streams()
    warnings.showwarning = _print_warning
    try:
        run_guarded(sysmlc, prog_name="sysmlc")
    except SystemExit as end:
        # Profilers and coverage tools save their data when the interpreter ends, which
        # ``terminal.leave`` skips.
        is_measured = sys.gettrace() or sys.getprofile()
        if isinstance(end.code, int) and (not is_measured or terminal.find_stream_problems()):
            terminal.leave(end.code)
        raise


def _print_warning(
    message: Warning | str,
    category: type[Warning],
    filename: str,
    lineno: int,
    file: TextIO | None = None,
    line: str | None = None,
) -> None:
    """Print a Python warning, such as one about a plug-in, without its place in our code."""
    terminal.echo(f"sysmlc: warning: {message}", err=True)


def run_guarded(run: Callable[_P, _T], *args: _P.args, **kwargs: _P.kwargs) -> _T:
    """Run a command; report an internal fault in one sentence and exit with code 2."""
    try:
        return run(*args, **kwargs)
    except RecursionError:
        fault = "the model is nested too deeply"
    except MemoryError:
        # The report allocates memory, which would fail again under the limit.
        LIMITS.release_memory()
        report_memory_limit(LIMITS.gibibytes)
        sys.exit(OUT_OF_MEMORY if LIMITS.is_enforced else 2)
    except OSError as problem:
        if not terminal.find_stream_problems():
            name = f" '{problem.filename}'" if problem.filename else ""
            terminal.echo(f"sysmlc: cannot use{name}: {problem.strerror or problem}", err=True)
        sys.exit(2)
    except Exception as problem:
        fault = f"fault of sysmlc: {describe_error(problem)}"
    terminal.echo(f"sysmlc: {fault}", err=True)
    click.echo("Please report it with the command and the model.", err=True)
    sys.exit(2)


__all__ = ["COMMANDS", "main", "sysmlc"]
