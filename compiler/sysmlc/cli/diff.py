"""``sysmlc diff``: what changed between two models."""

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from sysmlc.cli import options

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from sysmlc.cli.session import Settings
    from sysmlc.diagnostics import Place
    from sysmlc.driver import Compilation
    from sysmlc.ir.compare import Change


@click.command(
    "diff",
    short_help="Compare two models element by element.",
    epilog="""\b
Examples:
  sysmlc diff old/plant.aml plant.aml
  sysmlc diff old.uml new.uml --format markdown   # for a review
  sysmlc diff old.uml new.uml --ignore id         # when the ids were given anew""",
)
@click.argument("old", type=click.Path(path_type=Path), metavar="OLD")
@click.argument("new", type=click.Path(path_type=Path), metavar="NEW")
@click.option(
    "--ignore",
    callback=options.names,
    metavar="A,B",
    help="What makes no difference: names of attributes; with 'id' equal ids mean nothing.",
)
@click.option("--format", "form", type=click.Choice(("text", "markdown", "json")), default="text")
@options.reading
@click.pass_context
def command(
    ctx: click.Context,
    /,
    old: Path,
    new: Path,
    ignore: tuple[str, ...],
    form: str,
    **given: Any,  # noqa: ANN401 - the fields of Settings
) -> None:
    """Compare OLD and NEW (files or folders, of any format) as they are written.

    Places in files, ids that were given anew and the order of elements make no difference.
    Overlays count when both models have one.
    Exit code 0 when they are equal, 1 when they differ, 2 when one cannot be read.
    """
    from sysmlc.cli import session
    from sysmlc.ir.compare import compare

    settings = session.Settings(**given)
    made = [_read(path, settings) for path in (old, new)]
    unread = [one for one in made if _is_unread(one)]
    if unread:
        session.show([found for one in unread for found in session.findings(one)], settings)
        ctx.exit(2)
    _check(ignore, made)
    _refine(made)
    changes = compare(made[0].graph, made[1].graph, ignore)
    click.echo(_text(changes, form, made), nl=False, color=True)
    ctx.exit(1 if changes else 0)


def _read(path: Path, settings: "Settings") -> "Compilation":
    from sysmlc.cli import session

    return session.read_unit((path,), session.load_config([path], settings), settings)


def _is_unread(made: "Compilation") -> bool:
    """Whether an input gave nothing at all; what is wrong inside a file is no hindrance."""
    read = {element.source.partition("!")[0] for element in made.graph}
    return not made.is_complete and not (made.inputs and all(i.path in read for i in made.inputs))


def _check(ignore: tuple[str, ...], made: "list[Compilation]") -> None:
    """Refuse words that make no difference in any model: most likely they are misspelt."""
    from sysmlc.ir.compare.ignoring import words
    from sysmlc.suggest import did_you_mean

    known = words(one.graph for one in made) if ignore else ()
    for word in ignore:
        if word not in known:
            hint = did_you_mean(word, known)
            found = hint if hint.startswith("did") else "it is no attribute of these models"
            raise click.BadParameter(f"'{word}': {found}", param_hint="'--ignore'")


def _refine(made: "list[Compilation]") -> None:
    """Add what overlays say, when both models have one: else the overlay were the difference."""
    from sysmlc.diagnostics import Sink
    from sysmlc.overlay import Refinement
    from sysmlc.passes.overlay import Overlay

    if all(one.graph.derived(Refinement) for one in made):
        for one in made:
            Overlay().run(one.graph, Sink())


def _text(changes: "list[Change]", form: str, made: "list[Compilation]") -> str:
    from sysmlc.cli import diff_forms
    from sysmlc.cli.session import has_color

    if form == "json":
        return diff_forms.json_text(changes, *(_places(changes, made, i) for i in (0, 1)))
    if form == "markdown":
        return diff_forms.markdown(changes)
    return diff_forms.text(changes, color=has_color(sys.stdout))


def _places(
    changes: "Iterable[Change]", made: "list[Compilation]", side: int
) -> "Mapping[Place, Place]":
    """Lines and columns of what changed, in the old model or in the new one."""
    from sysmlc.diagnostics import Place
    from sysmlc.driver.places import Locator

    refs = (change.new if side else change.old for change in changes)
    places = {Place(ref.file, ref.ordinal) for ref in refs if ref is not None and ref.file}
    return Locator(made[side].sources)(places)
