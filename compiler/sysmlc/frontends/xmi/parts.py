"""Parts of a model in files of their own: EMF's contained elements that are written as hrefs."""

from sysmlc.diagnostics import Subject, Verdict
from sysmlc.frontends.xmi import rules
from sysmlc.frontends.xmi.context import Context
from sysmlc.ir import Element


def is_part(context: Context, row: int, feature: str) -> bool:
    """Whether the row stands for an element that its owner holds in another file.

    MagicDraw shows packages of used projects in the same way, always with an extension that
    names them: those are not the model's own.
    """
    document = context.document
    if feature != "packagedElement" and not feature.startswith(("owned", "nested")):
        return False
    return document.ends[row] == row + 1 and "href" in document.attributes[row]


def join(context: Context) -> None:
    """Give the elements that other files hold for this one their owner here."""
    for row in context.parts:
        owner = context.owner(row)
        part = _part(context, row)
        if owner is None:
            continue
        problem = _problem(context, owner, part)
        if part is None or problem:
            _report(context, row, owner, problem)
        else:
            context.graph.move(part, owner)
            context.verdicts[row] = Verdict.MAPPED


def _part(context: Context, row: int) -> Element | None:
    found = context.unit.find(context.lowered, context.document.attributes[row]["href"], True)
    if found is None or not found[0].own[found[1]]:
        return None
    return context.graph[found[0].gids[found[1]]]


def _problem(context: Context, owner: Element, part: Element | None) -> str:
    """Why the part cannot be given to the owner; nothing if it can."""
    if part is None:
        return "which no file of the compile unit has"
    if part.owner is not None:
        return "which belongs to another element"
    is_around = part is owner or part in context.graph.ancestors(owner)
    return "which it is in itself" if is_around else ""


def _report(context: Context, row: int, owner: Element, problem: str) -> None:
    name = context.graph.qualified_name(owner)
    href = context.document.attributes[row]["href"]
    subject = Subject(name, owner.id, context.place(row))
    context.sink.report(rules.MISSING_PART, subject, owner=name, href=href, problem=problem)
