"""``sysmlc diff``: list the differences between two models."""

import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from sysmlc.cli import options

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

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
  sysmlc diff old.uml new.uml --ignore id         # if a tool has renumbered the ids""",
)
@click.argument("old", type=click.Path(path_type=Path), metavar="OLD")
@click.argument("new", type=click.Path(path_type=Path), metavar="NEW")
@click.option(
    "--ignore",
    multiple=True,
    callback=options.split_names,
    metavar="A,B",
    help="Attributes to ignore, by name; with 'id', elements are matched without their ids.",
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
    **setting_values: Any,  # noqa: ANN401 - the fields of Settings
) -> None:
    """Compare OLD and NEW (files or folders, of any format) as they are written.

    Locations in files, renumbered ids and the order of elements are not differences. If the
    folders contain several compile units, units whose first files have the same path are compared.
    Overlays count if both models have one. Exit code 0: the models are equal; 1: they differ; 2:
    one of them cannot be read.
    """
    from sysmlc.cli import reports, session
    from sysmlc.ir import Graph
    from sysmlc.ir.compare import compare
    from sysmlc.ir.compare.content import check_ignored

    settings = session.Settings(**setting_values)
    sides = [_read(path, settings) for path in (old, new)]
    compilations = [compilation for side in sides for compilation in side.values()]
    unread = [compilation for compilation in compilations if _is_unread(compilation)]
    if unread:
        reports.print_findings(
            [finding for compilation in unread for finding in reports.list_findings(compilation)],
            settings,
        )
        ctx.exit(2)
    try:
        check_ignored(ignore, [compilation.graph for compilation in compilations])
    except ValueError as problem:
        raise click.BadParameter(str(problem), param_hint="'--ignore'") from problem
    changes: list[Change] = []
    for pair in _pair_units(*sides):
        _refine(pair)
        before, after = (side.graph if side else Graph() for side in pair)
        changes += compare(before, after, ignore)
    click.echo(_text(changes, form, sides), nl=False, color=True)
    ctx.exit(1 if changes else 0)


def _read(path: Path, settings: "Settings") -> "dict[str, Compilation]":
    """Read the compile units of a model; the key is the path of their first file below *path*."""
    from sysmlc.cli import session
    from sysmlc.cli.units import open_named_units

    units = open_named_units((path,), session.load_config([path], settings), settings)
    return {
        os.path.relpath(unit.opened.root / unit.opened.first_file(), path): session.read_as_written(
            unit, settings
        )
        for unit in units
    }


def _pair_units(
    old: "dict[str, Compilation]", new: "dict[str, Compilation]"
) -> "list[tuple[Compilation | None, Compilation | None]]":
    """Pair the units of both sides; a unit without a counterpart was added or removed."""
    # Two single units are compared whatever their files are called.
    if len(old) == len(new) == 1:
        return list(zip(old.values(), new.values(), strict=True))
    return [(old.get(path), new.get(path)) for path in sorted(old.keys() | new.keys())]


def _is_unread(compilation: "Compilation") -> bool:
    """Whether an input yielded no element; other errors in a file do not prevent a comparison."""
    read = {element.source.partition("!")[0] for element in compilation.graph}
    return not compilation.is_complete and not (
        compilation.inputs and all(i.path in read for i in compilation.inputs)
    )


def _refine(compilations: "Sequence[Compilation | None]") -> None:
    """Apply the overlays if both models have one; otherwise the overlay would be the difference."""
    from sysmlc.diagnostics import Sink
    from sysmlc.overlay import Refinement
    from sysmlc.passes.overlay import Overlay

    graphs = [compilation.graph for compilation in compilations if compilation is not None]
    if len(graphs) == len(compilations) and all(graph.derived(Refinement) for graph in graphs):
        for graph in graphs:
            Overlay().run(graph, Sink())


def _text(changes: "list[Change]", form: str, sides: "list[dict[str, Compilation]]") -> str:
    from sysmlc.cli import diff_forms
    from sysmlc.cli.reports import has_color

    if form == "json":
        return diff_forms.format_json(changes, *(_locate(changes, sides, i) for i in (0, 1)))
    if form == "markdown":
        return diff_forms.format_markdown(changes)
    return diff_forms.format_text(changes, color=has_color(sys.stdout))


def _locate(
    changes: "Iterable[Change]", sides: "list[dict[str, Compilation]]", side: int
) -> "Mapping[Place, Place]":
    """Return the places of the changes with lines and columns; *side* is 0 for the old model."""
    from sysmlc.diagnostics import Place
    from sysmlc.diagnostics.locations import complete_places

    refs = (change.new if side else change.old for change in changes)
    places = {Place(ref.file, ref.ordinal) for ref in refs if ref is not None and ref.file}
    sources = [source for compilation in sides[side].values() for source in compilation.sources]
    return complete_places(sources, places)
