"""Titles of elements and texts of values in a comparison, also for elements without a name."""

import re

from sysmlc.ir.compare.content import ENDS, NOT_CONTENT
from sysmlc.ir.compare.side import Side
from sysmlc.ir.element import Element
from sysmlc.ir.kinds import Edge, Kind

_WORD_BOUNDARY = re.compile(r"(?<=[a-z0-9])(?=[A-Z])")
_TEXTS = ("guard", "body", "value", "when", "condition")
_LONGEST_TITLE = 60
_NOTHING = "(nothing)"
_STARTS = (Edge.CLIENT, Edge.FLOW_SOURCE)
_PHRASES = {
    Edge.CALLS: "call {}",
    Edge.REPRESENTS: "of {}",
    Edge.INSTANCE_OF: "of {}",
    Edge.TYPED_BY: ": {}",
    Edge.REFERENCES: "of {}",
}


# -- elements ----------------------------------------------------------------------------------


def kind_title(side: Side, element: Element) -> str:
    """Return the role of *element*, or its stereotype, or its kind, in words."""
    details = side.details.get(element.id, ())
    stereotypes = (d.attrs.get("stereotype") for d in details if d.kind is Kind.APPLICATION)
    stereotype = str(next(stereotypes, "") or "")
    return element.role or separate_words(stereotype) or _name_kind(element)


def _name_kind(element: Element) -> str:
    kind = separate_words(element.kind)
    has_subkind = element.kind in (Kind.CONTROL, Kind.PSEUDOSTATE, Kind.ACTION, Kind.FRAGMENT)
    return f"{element.subkind} {kind}" if has_subkind and element.subkind else kind


def title(side: Side, element: Element) -> str:
    """Return the name of *element*, or a description that distinguishes it from its neighbours."""
    if element.kind is Kind.CONNECTOR_END:
        return format_path(side, element)
    return element.name or _describe(side, element) or f"<{element.kind}>"


def qualified_title(side: Side, element: Element) -> str:
    """Return the qualified name of *element*, with titles where names are missing."""
    path = [element, *side.graph.ancestors(element)]
    return "::".join(title(side, part) for part in reversed(path))


def _describe(side: Side, element: Element) -> str:
    ends = format_ends(side, element)
    if ends:
        return ends
    edges = side.edges.get(element.id, {})
    for edge, phrase in _PHRASES.items():
        if edges.get(edge):
            return phrase.format(_list_names(side, edges[edge]))
    texts = (element.attrs.get(name) for name in _TEXTS)
    return next((_shorten(text) for text in texts if isinstance(text, str) and text), "")


def _list_names(side: Side, elements: list[Element]) -> str:
    return ", ".join(_name_in_description(side, element) for element in elements) or _NOTHING


def _name_in_description(side: Side, element: Element) -> str:
    if element.name or element.kind is Kind.CONNECTOR_END:
        return title(side, element)
    # No further description of a nameless element: two of them may describe each other.
    called = side.edges.get(element.id, {}).get(Edge.CALLS, [])
    if called and called[0].name:
        return f"call {called[0].name}"
    return element.subkind or f"<{element.kind}>"


# -- ends of relations -------------------------------------------------------------------------


def path_of_end(side: Side, end: Element) -> list[Element]:
    """Return the parts that lead to the role of a connector end, outermost first, and the role."""
    edges = side.edges.get(end.id, {})
    return [*edges.get(Edge.PATH, ()), *edges.get(Edge.ROLE, ())]


def format_path(side: Side, element: Element) -> str:
    """Return the path of a connector end or of a nested port as ``part.port``."""
    names = (step.name or f"<{step.kind}>" for step in path_of_end(side, element))
    return ".".join(names) or _NOTHING


def format_ends(side: Side, relation: Element) -> str:
    """Return the ends of a connector as ``a -- b``, of a directed relation as ``a -> b``, or ""."""
    if relation.kind is Kind.CONNECTOR:
        return " -- ".join(title(side, end) for end in _connector_ends(side, relation))
    edges = side.edges.get(relation.id, {})
    if edges.keys().isdisjoint(ENDS):
        return ""
    starts = [end for edge in ENDS if edge in _STARTS for end in edges.get(edge, ())]
    targets = [end for edge in ENDS if edge not in _STARTS for end in edges.get(edge, ())]
    return f"{_list_names(side, starts)} -> {_list_names(side, targets)}"


def format_ends_with_owners(side: Side, connector: Element) -> str:
    """Return the ends of a connector with the owner of each role: features may share a name."""
    return " -- ".join(_format_end(side, end) for end in _connector_ends(side, connector))


def _connector_ends(side: Side, connector: Element) -> list[Element]:
    details = side.details.get(connector.id, ())
    return [detail for detail in details if detail.kind is Kind.CONNECTOR_END]


def _format_end(side: Side, end: Element) -> str:
    path = path_of_end(side, end)
    owner = side.graph.owner(path[-1]) if path else None
    suffix = f" of {qualified_title(side, owner)}" if owner is not None else ""
    return format_path(side, end) + suffix


# -- values ------------------------------------------------------------------------------------


def format_value(side: Side, value: object) -> str:
    """Return a value as a text for people."""
    if isinstance(value, Element):
        return title(side, value)
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, tuple):
        return ", ".join(format_value(side, item) for item in value)
    return "" if value is None else _join_lines(str(value))


def format_value_exactly(side: Side, value: object) -> str:
    """Return a value as a text that differs for different values: with types, names in full."""
    if isinstance(value, Element):
        return qualified_title(side, value)
    if isinstance(value, Kind | Edge):
        return separate_words(value)
    if isinstance(value, tuple):
        items = [format_value_exactly(side, item) for item in value if item not in ("", ())]
        return items[0] if len(items) == 1 else f"({', '.join(items)})"
    return repr(value)


def format_stereotype(side: Side, application: Element) -> str:
    """Return the stereotype of an application as ``«Machine»``."""
    return f"«{application.attrs.get('stereotype') or title(side, application)}»"


def format_detail(side: Side, detail: Element) -> str:
    """Return the content of a comment, a trigger, an import ... in one line."""
    if detail.kind is Kind.TRIGGER:
        return _format_trigger(side, detail)
    body = detail.attrs.get("body")
    if isinstance(body, str):
        locale = detail.attrs.get("locale")
        text = _join_lines(body) + (f" (locale {locale})" if locale else "")
        return f"{text}{_describe_subjects(side, detail)}"
    is_import = detail.kind is Kind.IMPORT
    imported = side.edges.get(detail.id, {}).get(Edge.REFERENCES, ()) if is_import else ()
    texts = [qualified_title(side, element) for element in imported] + [
        f"{name.replace('_', ' ')}: {format_value(side, value)}"
        for name, value in sorted(detail.attrs.items())
        if name not in NOT_CONTENT
    ]
    return "; ".join(texts) or title(side, detail)


def _describe_subjects(side: Side, detail: Element) -> str:
    """Return what a comment is about, unless that is only its owner."""
    subjects = side.edges.get(detail.id, {}).get(Edge.REFERENCES, [])
    if detail.kind is not Kind.COMMENT or all(part.id == detail.owner for part in subjects):
        return ""
    return f" (about {_list_names(side, subjects)})"


def _format_trigger(side: Side, trigger: Element) -> str:
    types = side.edges.get(trigger.id, {}).get(Edge.TYPED_BY, ())
    texts = [trigger.subkind, *(title(side, type_) for type_ in types)]
    texts += [format_value(side, trigger.attrs.get(name)) for name in ("when", "condition")]
    return " ".join(text for text in texts if text)


def _join_lines(text: str) -> str:
    return " ".join(text.split()) if "\n" in text else text


def _shorten(text: str) -> str:
    line = " ".join(text.split())
    return line if len(line) <= _LONGEST_TITLE else line[: _LONGEST_TITLE - 3] + "..."


_KIND_WORDS = {
    "Application": "stereotype application",
    "Control": "control node",
    "Fragment": "combined fragment",
    "Structured": "structured action",
}
"""Words for kinds whose own name says too little."""


def spell_kind(kind: str) -> str:
    """Return a kind of elements in the words of modellers: ``object node``."""
    return _KIND_WORDS.get(kind) or separate_words(kind)


def separate_words(name: str) -> str:
    """Return a name in lower case with blanks (``final state``); an acronym is unchanged."""
    return name if name.isupper() else _WORD_BOUNDARY.sub(" ", name).lower()
