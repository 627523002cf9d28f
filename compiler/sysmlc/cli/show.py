"""``sysmlc show``: print the refined graph, or one element of it."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from sysmlc.cli import options, terminal

if TYPE_CHECKING:
    from sysmlc.ir import Element, Graph


@click.command(
    "show",
    short_help="Print the refined graph, or one element of it.",
    epilog="""\b
Examples:
  sysmlc show plant.uml
  sysmlc show plant.uml --element Plant::Gate
  sysmlc show plant.uml --element Gate     # if only one element has this name""",
)
@options.models(required=True)
@click.option("-e", "--element", metavar="NAME|ID", help="Qualified name, name or id.")
@options.reading
@click.pass_context
def command(
    ctx: click.Context,
    /,
    models: tuple[Path, ...],
    element: str | None,
    **setting_values: Any,  # noqa: ANN401 - the fields of Settings
) -> None:
    """Print the graph of MODEL... after all passes, in the text form of docs/ir.md."""
    from sysmlc.cli import reports, session
    from sysmlc.ir.text import print_text

    settings = session.Settings(**setting_values)
    config = session.load_config(models, settings)
    compilation = session.compile_unit(models, config, settings)
    reports.print_findings(
        reports.list_findings(compilation, only_errors=not settings.verbose), settings
    )
    if compilation.exit_code() < 2:
        text = (
            print_text(compilation.graph)
            if element is None
            else _print_element(compilation.graph, element)
        )
        terminal.echo_text(text, nl=False)
    ctx.exit(reports.exit_code_of(compilation, config, settings))


def _print_element(graph: "Graph", wanted: str) -> str:
    from sysmlc.ir.text import print_element

    element = _find_element(graph, wanted)
    return print_element(graph, element) + _list_incoming(graph, element)


def _find_element(graph: "Graph", wanted: str) -> "Element":
    from sysmlc.cli.session import fail
    from sysmlc.support.suggestions import did_you_mean

    by_id = graph.get(wanted)
    if by_id is not None:
        return by_id
    names = {element.id: graph.qualified_name(element) for element in graph}
    exact = [graph[id] for id, name in names.items() if name == wanted]
    matches = exact or [element for element in graph if element.name == wanted]
    if not matches:
        fail(f"no element '{wanted}'; {did_you_mean(wanted, _list_names(graph, names))}")
    if len(matches) > 1:
        details = [f"{names[e.id]} ({e.kind}, id {e.id})" for e in matches[:20]]
        fail(f"{len(matches)} elements are called '{wanted}', name one:", *details)
    return matches[0]


def _list_names(graph: "Graph", names: dict[str, str]) -> list[str]:
    every = [*names.values(), *(element.name for element in graph if element.name)]
    return every if len(every) < 20_000 else []


def _list_incoming(graph: "Graph", element: "Element") -> str:
    lines = [
        f"  <- {edge} {graph.qualified_name(graph[source])}"
        for edge, source, target in graph.edges()
        if target == element.id
    ]
    return "".join(f"{line}\n" for line in lines)
