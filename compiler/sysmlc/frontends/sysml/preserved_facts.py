"""Facts of a model in another notation that metadata preserves: ``name=value``, ``edge->element``.

The back end ``sysml`` writes such facts as strings where no construct of SysML v2 expresses them.
"""

import re
from collections.abc import Mapping

from sysmlc.frontends.sysml import nodes
from sysmlc.frontends.sysml.elements import NodeElements
from sysmlc.frontends.sysml.implied_nodes import ensure_control_node, ensure_parameter_node
from sysmlc.frontends.sysml.library_edges import LibraryEdges
from sysmlc.frontends.sysml.lowering import Lowering
from sysmlc.frontends.sysml.trees import Trees
from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind, list_items
from sysmlc.language.tree import Node
from sysmlc.support.escapes import parse_json

_FACT = re.compile(
    r'(?:(node|region|trigger|start|done)\.)?("(?:[^"\\]|\\.)*"|[^="]*?)(=>|=|->)(.*)', re.DOTALL
)
"""Part of the element, key, operator and text; ``=>`` leads to an element outside of the model."""
_NAME_SEGMENT = re.compile(r"'((?:[^'\\]|\\.)*)'|([^:']+)")
_ESCAPED = re.compile(r"\\(.)", re.DOTALL)
_ESCAPES = {"n": "\n", "t": "\t", "r": "\r", "b": "\b", "f": "\f"}
_EDGES = {edge.value: edge for edge in Edge}
_EXTERNAL_KINDS = {Edge.APPLIES: Kind.PROFILE}
"""Kinds of the external targets of edges; other edges lead to classes."""
_PART_PATH = re.compile(r"(.*)\.(node|trigger|start|done)", re.DOTALL)
"""Path to a part of an element: the qualified name of the element, and the word for the part."""
_LIST = "[]"
"""End of the key of an attribute whose value is a list of elements: one fact for each."""
_REFERENCE = '{"->": '
"""Start of an element in the JSON of a list that also has other values."""
_ATTEMPTS = 3
"""How often a fact waits for a part of its element."""


def restore_facts(lowering: Lowering, facts: Mapping[str, AttrValue], element: Element) -> None:
    """Apply the facts in ``attributes`` to an element, once all its edges exist."""
    attributes = facts.get("attributes")
    if not isinstance(attributes, tuple):
        attributes = () if attributes is None else (attributes,)
    for attribute in attributes:
        _defer_fact(lowering, element, str(attribute), _ATTEMPTS)


def _defer_fact(lowering: Lowering, element: Element, fact: str, attempts: int) -> None:
    lowering.queue.defer_until_edges(lambda: _restore_fact(lowering, element, fact, attempts))


def _restore_fact(lowering: Lowering, element: Element, fact: str, attempts: int) -> None:
    """Apply one fact; a start or an end of a behaviour exists only when a flow has needed it."""
    match = _FACT.fullmatch(fact)
    if match is None or element.id not in lowering.graph:
        return
    part, name, operator, text = match.groups()
    holder = (
        element if part is None else _find_part(lowering.graph, lowering.elements, element, part)
    )
    key = str(parse_fact_value(name)) if name.startswith('"') else name
    if holder is None and attempts:
        _defer_fact(lowering, element, fact, attempts - 1)
        return
    if holder is None and part == "node" and element.kind is Kind.PARAMETER:
        # No flow has needed the node of the parameter.
        holder = ensure_parameter_node(lowering, element)
    if holder is None and part == "region":
        # The region is empty.
        holder = lowering.add_implied_child(element, Kind.REGION, "")
    if holder is None:
        return
    if key == "name":
        lowering.graph.rename(holder, str(parse_fact_value(text)))
    elif operator == "=":
        lowering.graph.set(holder, **{key: _parse_value_with_elements(lowering, text)})
    elif operator == "=>":
        _connect_external(lowering.library, holder, key, text)
    else:
        _connect(lowering, holder, key, text)


def _connect_external(library: LibraryEdges, holder: Element, key: str, name: str) -> None:
    edge = _EDGES.get(key)
    if edge is not None:
        kind = _EXTERNAL_KINDS.get(edge, Kind.CLASS)
        library.connect(edge, holder, name, kind)


def _connect(lowering: Lowering, holder: Element, key: str, name: str) -> None:
    """Add an edge, or an attribute whose value is the id of an element, or a list of ids."""
    target = _find_element(lowering, name)
    if target is None:
        return
    edge = _EDGES.get(key)
    if edge is not None:
        lowering.graph.connect(edge, holder, target)
    elif key.endswith(_LIST):
        key = key.removesuffix(_LIST)
        lowering.graph.set(holder, **{key: (*list_items(holder.attrs.get(key)), target.id)})
    else:
        lowering.graph.set(holder, **{key: target.id})


def _find_element(lowering: Lowering, path: str) -> Element | None:
    """Return the element with a qualified name, or its part if the path ends with a part."""
    match = _PART_PATH.fullmatch(path)
    name, word = (path, "") if match is None else match.groups()
    element = lowering.elements.find(_find_node(lowering.trees, name))
    if element is None or not word:
        return element
    if word == "node" and element.kind is Kind.PARAMETER:
        return ensure_parameter_node(lowering, element)
    if word in ("start", "done"):
        return ensure_control_node(lowering, element, word)
    return _find_part(lowering.graph, lowering.elements, element, word)


def _find_node(trees: Trees, qualified_name: str) -> Node | None:
    """Return the node with a qualified name from the root."""
    members = [member for root in trees.roots for member in root.members]
    node: Node | None = None
    for segment in _NAME_SEGMENT.finditer(qualified_name):
        quoted, plain = segment.groups()
        name = plain
        if quoted is not None:
            name = _ESCAPED.sub(lambda match: _ESCAPES.get(match[1], match[1]), quoted)
        node = next((member for member in members if nodes.name_of(member) == name), None)
        if node is None:
            return None
        members = node.members
    return node


def _parse_value_with_elements(lowering: Lowering, text: str) -> AttrValue:
    """Return the value of a fact, in which an object ``{"->": name}`` stands for an element."""
    if _REFERENCE not in text:
        return parse_fact_value(text)

    def find_id(reference: dict[str, object]) -> str | None:
        element = _find_element(lowering, str(reference.get("->")))
        return None if element is None else element.id

    try:
        return _freeze(parse_json(text, find_id))
    except (ValueError, RecursionError):
        return text


def parse_fact_value(text: str) -> AttrValue:
    """Return the JSON value of a text, or the text itself if it is no JSON."""
    try:
        return _freeze(parse_json(text))
    except (ValueError, RecursionError):
        return text


def _freeze(value: object) -> AttrValue:
    """Return lists as tuples; None for a JSON value that an attribute cannot have."""
    if isinstance(value, list):
        return tuple(_freeze(item) for item in value)
    return value if isinstance(value, str | int | float | bool) else None


def _find_part(graph: Graph, elements: NodeElements, element: Element, word: str) -> Element | None:
    """Return the part of an element that the prefix of a fact names, if it exists."""
    if word == "node":
        for node in graph.sources(element, Edge.REFERENCES):
            if node.kind is Kind.ACTIVITY_PARAMETER:
                return node
        return None
    members = graph.owned(element)
    if word == "trigger":
        return next((member for member in members if member.kind is Kind.TRIGGER), None)
    regions = [member for member in members if member.kind is Kind.REGION]
    region = regions[0] if len(regions) == 1 else None
    if word == "region":
        return region
    return elements.starts_and_ends.get(((region or element).id, word))
