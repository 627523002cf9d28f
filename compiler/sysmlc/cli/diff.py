"""``sysmlc diff``: what changed between two models."""

import json
from collections.abc import Callable, Sequence
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from sysmlc.cli import options

if TYPE_CHECKING:
    from sysmlc.ir.diff import Change


@click.command(
    "diff",
    short_help="Compare two models element by element.",
    epilog="""\b
Examples:
  sysmlc diff old/plant.uml plant.uml
  sysmlc diff papyrus.uml cameo.mdzip --ignore id,source,trace
  sysmlc diff old.uml new.uml --format markdown   for a review""",
)
@click.argument("old", type=click.Path(path_type=Path), metavar="OLD")
@click.argument("new", type=click.Path(path_type=Path), metavar="NEW")
@click.option(
    "--ignore",
    callback=options.names,
    metavar="A,B",
    help="What makes no difference: id, source, trace, or names of attributes.",
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
    """Compare the refined graphs of OLD and NEW (files or folders).

    Exit code 0 when they are equal, 1 when they differ, 2 when one cannot be read.
    """
    from sysmlc.cli import session
    from sysmlc.ir.diff import diff

    settings = session.Settings(**given)
    made = [
        session.compile_unit((path,), session.load_config([path], settings.config), settings)
        for path in (old, new)
    ]
    unread = [compilation for compilation in made if not compilation.is_complete]
    if unread:
        session.show([found for one in unread for found in session.findings(one)], settings)
        ctx.exit(2)
    changes = diff(made[0].graph, made[1].graph, ignore)
    click.echo(_FORMS[form](changes), nl=False)
    ctx.exit(1 if changes else 0)


_SIGNS = {"added": "+", "removed": "-"}


def _text(changes: "Sequence[Change]") -> str:
    lines = [
        f"{_SIGNS.get(change.what, '~')} {change.element}: {_phrase(change)}" for change in changes
    ]
    return "".join(f"{line}\n" for line in [*lines, _counts(changes)])


def _markdown(changes: "Sequence[Change]") -> str:
    lines = [f"**{_counts(changes)}**", ""]
    for element, group in groupby(changes, key=lambda change: change.element):
        lines += [f"- `{element}`", *(f"  - {_phrase(change)}" for change in group)]
    return "\n".join(lines).rstrip("\n") + "\n"


def _json(changes: "Sequence[Change]") -> str:
    rows = [{"element": c.element, "what": c.what, "detail": c.detail} for c in changes]
    return json.dumps({"changes": rows}, ensure_ascii=False, indent=1) + "\n"


def _phrase(change: "Change") -> str:
    return f"{change.what} {change.detail}".strip()


def _counts(changes: "Sequence[Change]") -> str:
    if not changes:
        return "no differences"
    numbers = {sign: sum(c.what == sign for c in changes) for sign in ("added", "removed")}
    other = len(changes) - sum(numbers.values())
    return f"{numbers['added']} added, {numbers['removed']} removed, {other} changed"


_FORMS: "dict[str, Callable[[Sequence[Change]], str]]" = {
    "text": _text,
    "markdown": _markdown,
    "json": _json,
}
