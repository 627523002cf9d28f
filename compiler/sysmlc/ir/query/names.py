"""Names of components and nodes, ids in attributes and AutomationML, bounds of multiplicities."""

import re
from collections.abc import Collection, Iterator

from sysmlc.ir.element import AttrValue, Element
from sysmlc.ir.graph import Graph
from sysmlc.ir.kinds import Edge, Kind
from sysmlc.ir.query.classifiers import BEHAVIORS, generals

_GENERATED_NAME = re.compile(
    r"((control|object)? ?flow|edge|(activity)? ?(initial|final)( ?node)?|flow ?final( ?node)?"
    r"|start|end|done)[ _]?\d*",
    re.IGNORECASE,
)


def has_generated_name(element: Element) -> bool:
    """Return whether a flow or control node has no name, or one such as ``ControlFlow3``.

    Papyrus and other tools give such names to new elements; ``end`` says no more than the symbol.
    """
    return not element.name.strip() or bool(_GENERATED_NAME.fullmatch(element.name.strip()))


def component_name(graph: Graph, element: Element) -> str:
    """Return the qualified name of the component that a behaviour or requirement specifies.

    A classifier behaviour specifies its classifier, a requirement its subject. Another behaviour
    is a component ``<Owner>.<behaviour>`` of its own, named by its qualified name if a package owns
    it. Elements without a name get a readable one, because the name becomes the name of a file.
    """
    subject = _find_subject(graph, element) if element.role == "requirement" else None
    component = subject or element
    if component.kind in BEHAVIORS:
        return _behavior_name(graph, component)
    return _readable_name(graph, component)


def _behavior_name(graph: Graph, behavior: Element) -> str:
    owner = graph.owner(behavior)
    if owner is None or owner.kind in (Kind.PACKAGE, Kind.PROFILE):
        return _readable_name(graph, behavior)
    owner_name = component_name(graph, owner)
    # SysML v2 may perform several; the others are components of their own.
    if behavior is graph.target(owner, Edge.CLASSIFIER_BEHAVIOR):
        return owner_name
    roles = (edge for edge in _PARTS_OF_MACHINES if behavior in graph.targets(owner, edge))
    return f"{owner_name}.{behavior.name or next(roles, behavior.kind.lower())}"


_PARTS_OF_MACHINES = (Edge.ENTRY, Edge.DO, Edge.EXIT, Edge.EFFECT)


def _readable_name(graph: Graph, element: Element) -> str:
    """Return the qualified name, with words in place of absent names.

    A region without a name is omitted, and a transition is named by its ends.
    """
    path = [element, *graph.ancestors(element)]
    words = (_find_word(graph, part) for part in reversed(path))
    return "::".join(word for word in words if word)


def _find_word(graph: Graph, element: Element) -> str:
    if element.name or element.kind is Kind.REGION:
        return element.name
    if element.kind is not Kind.TRANSITION:
        return element.kind.lower()
    ends = (graph.target(element, edge) for edge in (Edge.FLOW_SOURCE, Edge.FLOW_TARGET))
    return "_to_".join(end.name or end.subkind or end.kind.lower() for end in ends if end)


def _find_subject(graph: Graph, requirement: Element) -> Element | None:
    return graph.target(requirement, Edge.SUBJECT) or graph.source(requirement, Edge.SATISFIES)


def is_requirement(element: Element) -> bool:
    """Whether *element* is a requirement, in SysML v1 or v2."""
    return element.attrs.get("role") == "requirement" or element.kind is Kind.REQUIREMENT


def requirement_id(graph: Graph, requirement: Element) -> str:
    """Return the id of a requirement, else that of its nearest general; empty if none has one."""
    return _find_stated(graph, requirement, "req_id")


def requirement_text(graph: Graph, requirement: Element) -> str:
    """Return the text of a requirement, else that of its nearest general; empty if none has one."""
    return _find_stated(graph, requirement, "text")


def list_restated(graph: Graph, requirement: Element) -> list[Element]:
    """Return a requirement, and the definitions that it uses without adding text or condition.

    What satisfies or verifies such a definition satisfies or verifies its usage as well.
    """
    members = [requirement]
    for member in members:
        conditions = (part for part in graph.owned(member) if part.kind is Kind.CONSTRAINT)
        if not str(member.attrs.get("text", "")).strip() and not any(conditions):
            definitions = filter(is_requirement, graph.targets(member, Edge.SPECIALIZES))
            members += [definition for definition in definitions if definition not in members]
    return members


def _find_stated(graph: Graph, requirement: Element, attribute: str) -> str:
    family = (requirement, *generals(graph, requirement))
    texts = (str(member.attrs.get(attribute, "")).strip() for member in family)
    return next(filter(None, texts), "")


def ids_in(value: object) -> Iterator[str]:
    """Iterate over the ids in the value of an attribute, nested tuples included (docs/ir.md)."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, tuple):
        for item in value:
            yield from ids_in(item)


def bounds(multiplicity: AttrValue) -> tuple[int, int | None] | None:
    """Return the lower and upper bound of a multiplicity; the upper bound None is unlimited.

    An absent multiplicity means exactly 1. Return None for a text without numbers.
    """
    lower, dots, upper = str("1" if multiplicity is None else multiplicity).partition("..")
    if not dots:
        lower, upper = ("0", "*") if lower == "*" else (lower, lower)
    if not _is_number(lower) or not (upper == "*" or _is_number(upper)):
        return None
    return int(lower), None if upper == "*" else int(upper)


def _is_number(text: str) -> bool:
    return text.isascii() and text.isdecimal()


def spell_for_xml(name: str) -> str:
    """Return a name as modelling tools spell it in XML tags: ``_`` for all but word characters."""
    return _NO_WORD_CHARACTER.sub("_", name)


_NO_WORD_CHARACTER = re.compile(r"\W")

# -- ids of AutomationML ---------------------------------------------------------------------------

CAEX_ID = "caex_id"
"""Attribute with the ID of an object that was read from another language, which has other ids."""
_ADDED_ID = re.compile(r"#(values|class|part|type)(~\d+)?$")
"""Ends of the ids of elements that the front end ``caex`` adds to an object."""

_TYPES = (Kind.CLASS, Kind.DATA_TYPE)
"""Kinds of types that the front end adds; they are no objects of AutomationML."""


def find_caex_id(element: Element, files: Collection[str]) -> str:
    """Return the ID that the object has in its AutomationML file, or the empty string.

    *files* are the names of the sources that are AutomationML.
    """
    if CAEX_ID in element.attrs:
        return str(element.attrs[CAEX_ID])
    if element.source not in files:
        return ""
    id = element.id
    if _ADDED_ID.search(id):
        return "" if element.kind in _TYPES else find_extended_id(element)
    # The front end made such an id: the object has no ID, or not the only one of its kind.
    if id.startswith((f"{element.source}#", f"{element.owner}/")):
        return ""
    return "" if element.owner is None and element.kind is Kind.PACKAGE and "#" in id else id


def find_extended_id(element: Element) -> str:
    """Return the ID of the object to which the front end added an element, or an empty string."""
    id = element.id
    while _ADDED_ID.search(id):
        id = _ADDED_ID.sub("", id)
    return "" if id == element.id or "/" in id or id.startswith(f"{element.source}#") else id
