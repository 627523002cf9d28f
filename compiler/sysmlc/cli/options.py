"""Options that several commands share."""

from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

import click

from sysmlc.cli.limits import check_amount, list_missing_limits
from sysmlc.diagnostics import Severity
from sysmlc.diagnostics.renderers import FORMATS

_F = TypeVar("_F", bound=Callable[..., object])


def split_names(
    _ctx: click.Context, _param: click.Parameter, values: tuple[str, ...]
) -> tuple[str, ...]:
    """Return the names in the values of a repeated option; commas separate the names."""
    return tuple(part.strip() for value in values for part in value.split(",") if part.strip())


def models(required: bool = False) -> Callable[[_F], _F]:
    """The argument MODEL..."""
    return click.argument(
        "models", nargs=-1, required=required, type=click.Path(path_type=Path), metavar="MODEL..."
    )


def add_color_option(command: click.Command) -> None:
    """Give *command*, or all commands of a group, the option ``--color``."""
    if isinstance(command, click.Group):
        for subcommand in command.commands.values():
            add_color_option(subcommand)
    elif not any(parameter.name == "color" for parameter in command.params):
        option = click.Option(
            ["--color"],
            type=click.Choice(["auto", "always", "never"]),
            default="auto",
            show_default=True,
            expose_value=False,
            callback=_set_color,
            help="Colours in texts for people. 'auto' obeys NO_COLOR and FORCE_COLOR, and else"
            " colours what a terminal shows.",
        )
        command.params.append(option)


def _set_color(ctx: click.Context, _param: click.Parameter, value: str) -> None:
    """Set the colour of the context, which ``reports.has_color`` reads; None is ``auto``."""
    ctx.color = {"always": True, "never": False}.get(value)


def folder(help: str) -> Callable[[_F], _F]:
    """The options ``-o``, the folder for files besides the report of a command, and ``--force``."""
    output = click.option(
        "-o",
        "--output",
        type=click.Path(path_type=Path, file_okay=False),
        metavar="DIR",
        help=help,
    )
    return lambda function: output(force(function))


def force(function: _F) -> _F:
    """The option ``--force``."""
    return click.option(
        "--force",
        "is_forced",
        is_flag=True,
        help="Replace files that sysmlc did not write, or that were edited after it wrote them.",
    )(function)


def question_limit(default: float) -> Callable[[_F], _F]:
    """Return the option ``--question-limit``: CPU seconds for each question about contracts."""
    return click.option(
        "--question-limit",
        "seconds",
        type=float,
        callback=check_amount,
        default=default,
        show_default=True,
        metavar="S",
        help="CPU seconds for each question about a contract; 0 is no limit.",
    )


def _note_missing_limits(_ctx: click.Context, _param: click.Parameter, value: bool) -> bool:
    """With the option ``-v`` (*value*), print the limits that this system does not enforce."""
    missing = list_missing_limits()
    if value and missing:
        click.echo(f"note: this system does not enforce {' and '.join(missing)}", err=True)
    return value


def _apply(options: list[Callable[[_F], _F]], function: _F) -> _F:
    # Decorators are applied from the last to the first; ``--help`` lists the options in order.
    for option in reversed(options):
        function = option(function)
    return function


def contract_formats(function: _F) -> _F:
    """Options for reading files of contract formats: ``--from`` and ``--include``."""
    return _apply(
        [
            click.option(
                "--from", "language", default="", metavar="FORM", help="Format of the contracts."
            ),
            click.option(
                "--include",
                multiple=True,
                type=click.Path(path_type=Path, file_okay=False),
                metavar="DIR",
                help="Folder of Spectra files that contracts may import.",
            ),
        ],
        function,
    )


def configuration(function: _F) -> _F:
    """The options ``--config`` and ``--isolated``."""
    return _apply(
        [
            click.option(
                "--config",
                type=click.Path(path_type=Path, dir_okay=False),
                metavar="FILE",
                help="Configuration, instead of the nearest sysmlc.toml.",
            ),
            click.option(
                "--isolated",
                is_flag=True,
                help="Ignore every configuration file, and the templates and limits in it.",
            ),
        ],
        function,
    )


def reading(function: _F) -> _F:
    """Options for reading and refining models."""
    return _apply(
        [
            configuration,
            click.option(
                "--overlay",
                multiple=True,
                type=click.Path(path_type=Path),
                metavar="FILE",
                help="Refine the model by this overlay, in addition to MODEL.overlay.yaml.",
            ),
            click.option(
                "--strict-input", is_flag=True, help="Content that is not supported is an error."
            ),
            click.option(
                "--schema",
                type=click.Path(path_type=Path),
                metavar="DIR",
                help="Validate the inputs against the XML Schemas (*.xsd) in a folder.",
            ),
            click.option(
                "--library",
                default="",
                metavar="PATH",
                help="Folder or .kpar of the SysML v2 library, instead of the installed one.",
            ),
            click.option("--verify-each", is_flag=True, help="Check the graph after each pass."),
            click.option(
                "--print-after",
                multiple=True,
                metavar="PASS",
                help="Print the graph after this pass ('read': before the first one).",
            ),
            click.option(
                "-v",
                "--verbose",
                is_flag=True,
                callback=_note_missing_limits,
                help="Print each step.",
            ),
        ],
        function,
    )


def reporting(function: _F) -> _F:
    """Options for printing findings and for the exit code."""
    return _apply(
        [
            click.option(
                "--format",
                "form",
                type=click.Choice(FORMATS),
                default="text",
                show_default=True,
                help="Form of the findings; json, sarif and github go to standard output.",
            ),
            click.option("--strict", is_flag=True, help="Warnings make the exit code 1 too."),
            click.option(
                "--min-severity",
                type=click.Choice([severity.value for severity in Severity]),
                help="Report nothing below this severity.  [default: each error and warning, and"
                " one line for each rule with infos]",
            ),
            click.option(
                "--select",
                multiple=True,
                callback=split_names,
                metavar="RULE,...",
                help="Report only these rules (code, start of a code, or name), and errors.",
            ),
            click.option(
                "--ignore",
                multiple=True,
                callback=split_names,
                metavar="RULE,...",
                help="Do not report these rules; errors are always reported.",
            ),
            click.option(
                "--max-diagnostics",
                "max_diagnostics",
                type=click.IntRange(min=0),
                metavar="N",
                help="Show at most N findings, the worst first; 0 shows all."
                "  [default: 1000; json and sarif: all]",
            ),
        ],
        function,
    )


def emitting(function: _F) -> _F:
    """Options that select the outputs."""
    return _apply(
        [
            click.option(
                "--emit",
                multiple=True,
                callback=split_names,
                metavar="A,B|+X",
                help="Back ends instead of the default ones; +X adds one. Repeated options add up."
                " See 'sysmlc backends'.",
            ),
            click.option(
                "--diagrams",
                type=click.Choice(["derived", "author", "both"]),
                help="Diagrams derived from the model, those of its authors, or both."
                "  [default: derived]",
            ),
        ],
        function,
    )


def templates(function: _F) -> _F:
    """The option ``--templates``; ``check`` lacks it, because it uses shipped templates only."""
    return click.option(
        "--templates",
        type=click.Path(path_type=Path, file_okay=False),
        metavar="DIR",
        help="Folder with templates that replace the shipped ones of the same name.",
    )(function)


def output_folder(function: _F) -> _F:
    """The option ``-o``."""
    return click.option(
        "-o",
        "--output",
        type=click.Path(path_type=Path, file_okay=False),
        metavar="DIR",
        help="Output folder.  [default: that of the configuration, or out]",
    )(function)


def caching(function: _F) -> _F:
    """The option ``--no-cache``."""
    return click.option(
        "--cache/--no-cache",
        "has_cache",
        default=True,
        help="Reuse results of a run with the same inputs (the default), or compile again.",
    )(function)
