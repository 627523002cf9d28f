"""What is not wholly in the graph, element by element, for ``sysmlc coverage``."""

from collections.abc import Iterator, Sequence

from sysmlc.diagnostics import Rule, Severity, Verdict, rule
from sysmlc.diagnostics.coverage import Loss
from sysmlc.frontends.xmi import rules
from sysmlc.frontends.xmi.context import Context
from sysmlc.frontends.xmi.document import Document

EXTERNAL = rule(
    "SM160",
    "external-element",
    Severity.INFO,
    "{reason}",
    why="The element stands for something in a file that is not part of the compile unit; the "
    "graph knows its kind and its name, but not its content. Only 'sysmlc coverage' lists them, "
    "one by one; 'missing-library' tells of each file once.",
    help="give the other file as a further input",
    wrong='<type xmi:type="uml:Class" href="Other.uml#_pallet"/>',
    right='<type xmi:idref="_pallet"/>',
)


def losses(context: Context, types: Sequence[str]) -> Iterator[Loss]:
    """What is not mapped, in document order; ``types`` has the type of each row.

    What an element contains counts with it as long as the verdict is the same.
    """
    sizes = _sizes(context)
    baseless = frozenset(context.baseless)
    for row, number in sizes.items():
        verdict = context.verdicts[row] or Verdict.UNSUPPORTED
        told, reason = _reason(context, row, verdict, row in baseless)
        yield Loss(
            types[row],
            verdict,
            context.document.ordinals[row],
            number,
            context.gids[row],
            _own_name(context, row),
            told,
            reason,
        )


def _sizes(context: Context) -> dict[int, int]:
    """Rows that begin a loss, with the number of elements of each."""
    document, verdicts = context.document, context.verdicts
    begins: dict[int, int] = {}
    sizes: dict[int, int] = {}
    hidden = _hidden(document)
    for row, verdict in enumerate(verdicts):
        if verdict is Verdict.MAPPED:
            continue
        above = document.parents[row]
        has_reason = row in context.told or row in context.lost
        is_inside = above in begins and verdicts[above] is verdict and not has_reason
        begins[row] = first = begins[above] if is_inside else row
        sizes[first] = sizes.get(first, 0) + 1 + hidden.get(row, 0)
    return sizes


def _hidden(document: Document) -> dict[int, int]:
    """Number of elements inside rows whose content was only counted."""
    if not document.drawn:
        return {}
    total = len(document) + document.drawn.total()
    following = (*document.ordinals[1:], total)
    pairs = enumerate(zip(document.ordinals, following, strict=True))
    return {row: after - at - 1 for row, (at, after) in pairs if after - at > 1}


def _own_name(context: Context, row: int) -> str:
    """The name as written, where the row has no element of its own that is called so."""
    if context.lowered.own[row]:
        return ""
    return context.document.attributes[row].get("name", "")


def _reason(
    context: Context, row: int, verdict: Verdict, is_baseless: bool
) -> tuple[Rule | None, str]:
    if verdict is Verdict.APPROXIMATED and row in context.told:
        return context.told[row]
    if verdict is Verdict.APPROXIMATED:
        return rules.APPROXIMATED, f"read without {context.lost.get(row, 'part of its meaning')}"
    if verdict is Verdict.EXTERNAL:
        return EXTERNAL, f"stands for {_far(context, row)}, which is in no file of the unit"
    if verdict is Verdict.IGNORED_NOTATION:
        return None, "drawing or tool settings"
    if is_baseless:
        return rules.BASELESS, "applied to nothing that is in the model"
    return rules.UNSUPPORTED, "not read"


def _far(context: Context, row: int) -> str:
    """The href of the row or of the first row in it that has one."""
    document = context.document
    rows = range(row, document.ends[row])
    found = (document.attributes[at].get("href", "") for at in rows)
    return next((f"'{href}'" for href in found if href), "another element")
