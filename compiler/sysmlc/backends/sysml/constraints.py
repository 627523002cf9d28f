"""Constraints: expressions, or texts in other languages."""

from sysmlc.backends.sysml.annotations import write_annotations
from sysmlc.backends.sysml.comments import write_opaque_bodies
from sysmlc.backends.sysml.declarations import list_visibility
from sysmlc.backends.sysml.expressions import format_expression
from sysmlc.backends.sysml.plan import Member
from sysmlc.backends.sysml.printing import Line, quote_name
from sysmlc.backends.sysml.references import format_qualified_name
from sysmlc.backends.sysml.rules import NAME_LEFT_OUT
from sysmlc.backends.sysml.writer import Writer
from sysmlc.ir import Edge, Element, Kind

_KEYWORDS = {
    "precondition": "precondition",
    "postcondition": "postcondition",
    "body": "bodyCondition",
    "invariant": "invariant",
}
"""Keyword of the library ``SysMLC`` by subkind."""


def write_constraint(writer: Writer, member: Member) -> list[Line]:
    """Write a constraint: the result of its constraint definition, else an asserted constraint.

    The guard of a transition, a flow or an operand has no lines of its own.
    """
    element = member.require_element()
    if writer.graph.sources(element, Edge.GUARD):
        if element.name:
            writer.losses.record(NAME_LEFT_OUT, element, construct="a guard")
        return []
    owner = member.parent
    result = _format_result(writer, member, element)
    is_in_definition = owner is not None and owner.shape.keyword == "constraint def"
    if is_in_definition and result and not member.name and _is_only_constraint(writer, element):
        return [Line("", text=[result])]
    keyword = _KEYWORDS.get(element.subkind)
    keywords = [f"#{writer.refer_to_sysmlc(owner, keyword)}"] if keyword else []
    is_asserted = element.attrs.get("asserted") is not False
    words = _list_words(owner, keywords, is_asserted)
    name = quote_name(member.name) if member.name else ""
    words = [*list_visibility(writer, element), *words, "constraint", name]
    body = write_annotations(writer, member) + writer.write_members(member)
    body += [Line("", text=[result])] if result else write_opaque_bodies(writer, element)
    head = " ".join(word for word in words if word)
    constraint = Line(head, body, is_short=len(body) == 1)
    return [constraint, *_write_references(writer, member, element)]


def _list_words(owner: Member | None, keywords: list[str], is_asserted: bool) -> list[str]:
    """Return the words before ``constraint``: ``require`` in a requirement, or else ``assert``."""
    if owner is None or owner.shape.keyword in ("package", "metadata def", "enum def"):
        words = keywords
    elif owner.shape.keyword == "requirement":
        words = ["require", *keywords]
    else:
        words = [*keywords, "assert"] if is_asserted else keywords
    if owner is not None and owner.shape.usage_keyword == "port":
        # A port may own no composite features but ports (SysML 2.0, 8.3.12).
        return ["ref", *words]
    return words


def _format_result(writer: Writer, member: Member, element: Element) -> str | None:
    text = element.attrs.get("body")
    references = writer.graph.targets(element, Edge.REFERENCES)
    if any(target.kind is Kind.DATA_TYPE for target in references):
        # AutomationML refers to the values of an attribute type by the name of the type, which
        # no feature of the text has.
        return None
    return format_expression(writer, member, str(text)) if text else None


def _is_only_constraint(writer: Writer, element: Element) -> bool:
    owner = writer.graph.owner(element)
    siblings = [] if owner is None else writer.graph.owned(owner)
    return sum(sibling.kind is element.kind for sibling in siblings) == 1


def _write_references(writer: Writer, member: Member, element: Element) -> list[Line]:
    """Write a dependency on the constrained elements besides the owner, if there is a name."""
    owner = writer.graph.owner(element)
    targets = [t for t in writer.graph.targets(element, Edge.REFERENCES) if t is not owner]
    if not targets or not member.name:
        return []
    names = []
    for target in targets:
        end = writer.plan.find(target)
        name = None if end is None else format_qualified_name(writer.plan, member.parent, end)
        if name is None:
            writer.record_unreachable(element, "references")
        else:
            names.append(name)
    if not names:
        return []
    keyword = writer.refer_to_sysmlc(member.parent, "constrains")
    source = quote_name(member.name)
    return [Line(f"#{keyword} dependency from {source} to {', '.join(names)}")]
