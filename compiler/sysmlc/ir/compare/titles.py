"""How elements and values are called in a comparison, those without a name too."""

import re

from sysmlc.ir.compare.content import ENDS, NOT_CONTENT
from sysmlc.ir.compare.side import Side
from sysmlc.ir.element import Element
from sysmlc.ir.kinds import Edge, Kind

_WORD = re.compile(r"(?<=[a-z0-9])(?=[A-Z])")
_TEXTS = ("guard", "body", "value", "when", "condition")
_MOST = 60


def word(side: Side, element: Element) -> str:
    """What the element is: its role, its stereotype, or its kind."""
    details = side.details.get(element.id, ())
    found = (one.attrs.get("stereotype") for one in details if one.kind is Kind.APPLICATION)
    applied = str(next(found, "") or "")
    return element.role or _spaced(applied) or _kind(element)


def _kind(element: Element) -> str:
    kind = _spaced(element.kind)
    is_telling = element.kind in (Kind.CONTROL, Kind.PSEUDOSTATE, Kind.ACTION, Kind.FRAGMENT)
    return f"{element.subkind} {kind}" if is_telling and element.subkind else kind


def _spaced(name: str) -> str:
    return name if name.isupper() else _WORD.sub(" ", name).lower()


def title(side: Side, element: Element) -> str:
    """The element's name, or what tells it from its neighbours."""
    if element.kind is Kind.CONNECTOR_END:
        return dotted(side, element)
    return element.name or _description(side, element) or f"<{element.kind}>"


def steps(side: Side, end: Element) -> list[Element]:
    """The parts that lead to the role of a connector end, outermost first, and the role."""
    edges = side.out.get(end.id, {})
    return [*edges.get(Edge.PATH, ()), *edges.get(Edge.ROLE, ())]


def dotted(side: Side, element: Element) -> str:
    """``part.port``: the steps to what a connector end or a nested port stands for."""
    names = (step.name or f"<{step.kind}>" for step in steps(side, element))
    return ".".join(names) or "(nothing)"


def _description(side: Side, element: Element) -> str:
    edges = side.out.get(element.id, {})
    ends = relation(side, element)
    if ends:
        return ends
    for edge, phrase in _PHRASES.items():
        if edges.get(edge):
            return phrase.format(_listed(side, edges[edge]))
    texts = (element.attrs.get(name) for name in _TEXTS)
    return next((_short(text) for text in texts if isinstance(text, str) and text), "")


_PHRASES = {
    Edge.CALLS: "call {}",
    Edge.REPRESENTS: "of {}",
    Edge.INSTANCE_OF: "of {}",
    Edge.TYPED_BY: ": {}",
    Edge.REFERENCES: "of {}",
}


def relation(side: Side, element: Element) -> str:
    """``a -> b`` for what leads from one element to another, ``a -- b`` for a connector."""
    edges = side.out.get(element.id, {})
    if element.kind is Kind.CONNECTOR:
        found = [d for d in side.details.get(element.id, ()) if d.kind is Kind.CONNECTOR_END]
        return " -- ".join(title(side, end) for end in found)
    if not any(edge in edges for edge in ENDS):
        return ""
    pairs = [(edges.get(edge, []), _is_start(edge)) for edge in ENDS]
    starts = [one for found, is_start in pairs if is_start for one in found]
    targets = [one for found, is_start in pairs if not is_start for one in found]
    return f"{_listed(side, starts)} -> {_listed(side, targets)}"


def ends_in_full(side: Side, connector: Element) -> str:
    """As ``relation``, with the owner of what each end leads to: features may share a name."""
    ends = [d for d in side.details.get(connector.id, ()) if d.kind is Kind.CONNECTOR_END]
    return " -- ".join(_in_full(side, end) for end in ends)


def _in_full(side: Side, end: Element) -> str:
    owner = side.graph.owner(found[-1]) if (found := steps(side, end)) else None
    return dotted(side, end) + (f" of {whole(side, owner)}" if owner is not None else "")


def _is_start(edge: Edge) -> bool:
    return edge in (Edge.CLIENT, Edge.FLOW_SOURCE)


def _listed(side: Side, elements: list[Element]) -> str:
    return ", ".join(_name(side, one) for one in elements) or "(nothing)"


def _name(side: Side, element: Element) -> str:
    """Name of what another element is described by: its owner's when it has none."""
    if element.name or element.kind is Kind.CONNECTOR_END:
        return title(side, element)
    calls = side.out.get(element.id, {}).get(Edge.CALLS, [])
    if calls and calls[0].name:
        return f"call {calls[0].name}"
    return element.subkind or f"<{element.kind}>"


def whole(side: Side, element: Element) -> str:
    """Qualified name, with titles where names are missing."""
    path = [element, *side.graph.ancestors(element)]
    return "::".join(title(side, part) for part in reversed(path))


def shown(side: Side, value: object) -> str:
    """A value as text."""
    if isinstance(value, Element):
        return title(side, value)
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, tuple):
        return ", ".join(shown(side, part) for part in value)
    return "" if value is None else _single_line(str(value))


def exactly(side: Side, value: object) -> str:
    """A value as text that leaves nothing out: whole names, and which kind of value."""
    if isinstance(value, Element):
        return whole(side, value)
    if isinstance(value, tuple):
        return "(" + ", ".join(exactly(side, part) for part in value) + ")"
    return repr(value)


def stereotype(side: Side, application: Element) -> str:
    """``«Machine»``."""
    return f"«{application.attrs.get('stereotype') or title(side, application)}»"


def told(side: Side, detail: Element) -> str:
    """What a comment, a trigger, an import ... says, in a line."""
    if detail.kind is Kind.TRIGGER:
        return _trigger(side, detail)
    body = detail.attrs.get("body")
    if isinstance(body, str):
        return _single_line(body)
    is_import = detail.kind is Kind.IMPORT
    led = side.out.get(detail.id, {}).get(Edge.REFERENCES, ()) if is_import else ()
    said = [whole(side, one) for one in led] + [
        f"{name.replace('_', ' ')}: {shown(side, value)}"
        for name, value in sorted(detail.attrs.items())
        if name not in NOT_CONTENT
    ]
    return "; ".join(said) or title(side, detail)


def _trigger(side: Side, trigger: Element) -> str:
    said = [title(side, one) for one in side.out.get(trigger.id, {}).get(Edge.TYPED_BY, ())]
    said += [shown(side, trigger.attrs.get(name)) for name in ("when", "condition")]
    return " ".join(part for part in (trigger.subkind, *said) if part)


def _single_line(text: str) -> str:
    return " ".join(text.split()) if "\n" in text else text


def _short(text: str) -> str:
    line = " ".join(text.split())
    return line if len(line) <= _MOST else line[: _MOST - 3] + "..."
