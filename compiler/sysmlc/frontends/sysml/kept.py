"""Facts that metadata keeps of a model in another notation: ``name=value``, ``edge->element``."""

import json
import re
from collections.abc import Mapping
from typing import TYPE_CHECKING

from sysmlc.frontends.sysml import nodes
from sysmlc.ir import AttrValue, Edge, Element, Kind
from sysmlc.language.tree import Node

if TYPE_CHECKING:
    from sysmlc.frontends.sysml.lowering import Lowering

_FACT = re.compile(
    r'(?:(node|region|trigger|start|done)\.)?("(?:[^"\\]|\\.)*"|[^="]*?)(=>|=|->)(.*)', re.DOTALL
)
_STEP = re.compile(r"'((?:[^'\\]|\\.)*)'|([^:']+)")
_ESCAPED = re.compile(r"\\(.)", re.DOTALL)
_ESCAPES = {"n": "\n", "t": "\t", "r": "\r", "b": "\b", "f": "\f"}
_EDGES = {edge.value: edge for edge in Edge}
_KINDS = {Edge.APPLIES: Kind.PROFILE}
"""Kinds of what edges lead to outside of the model; others lead to classes."""


def read(low: "Lowering", facts: Mapping[str, AttrValue], owner: Element) -> None:
    """Give an element the facts that its metadata keeps, when all else of it is known."""
    given = facts.get("attributes")
    for fact in given if isinstance(given, tuple) else () if given is None else (given,):
        low.last(lambda fact=fact: _keep(low, owner, str(fact)))  # type: ignore[misc]


def _keep(low: "Lowering", owner: Element, fact: str, tries: int = 3) -> None:
    """Give one fact; parts of behaviours may have to wait for what leads to them."""
    found = _FACT.fullmatch(fact)
    if found is None or owner.id not in low.graph:
        return
    part, name, mark, text = found.groups()
    holder = owner if part is None else _part(low, owner, part)
    key = str(json.loads(name)) if name.startswith('"') else name
    if holder is None:
        if tries:
            low.last(lambda: _keep(low, owner, fact, tries - 1))
        return
    if key == "name":
        low.graph.rename(holder, str(_value(text)))
    elif mark == "=":
        low.graph.set(holder, **{key: _value(text)})
    else:
        _lead(low, holder, key, mark, text)


def _lead(low: "Lowering", holder: Element, key: str, mark: str, name: str) -> None:
    """An edge, or an attribute that is the id of an element."""
    edge = _EDGES.get(key)
    if mark == "=>":
        if edge is not None:
            low.lead_to(edge, holder, name, _KINDS.get(edge, Kind.CLASS))
        return
    target = low.element(_named(low, name))
    if target is None:
        return
    if edge is not None:
        low.graph.connect(edge, holder, target)
    else:
        low.graph.set(holder, **{key: target.id})


def _named(low: "Lowering", name: str) -> Node | None:
    """The node with a qualified name from the root."""
    beside = [one for root in low.roots for one in root.members]
    found: Node | None = None
    for step in _STEP.finditer(name):
        wanted = _plain(step[1]) if step[1] is not None else step[2]
        found = next((one for one in beside if nodes.name_of(one) == wanted), None)
        if found is None:
            return None
        beside = found.members
    return found


def _plain(text: str) -> str:
    return _ESCAPED.sub(lambda one: _ESCAPES.get(one[1], one[1]), text)


def _value(text: str) -> AttrValue:
    """A value as the metadata has it: JSON, else text."""
    try:
        return _frozen(json.loads(text))
    except ValueError:
        return text


def _frozen(value: object) -> AttrValue:
    if isinstance(value, list):
        return tuple(_frozen(one) for one in value)
    return value if isinstance(value, str | int | float | bool) else None


def _part(low: "Lowering", owner: Element, word: str) -> Element | None:
    """The part of an element that a word stands for, if it was made."""
    graph = low.graph
    if word == "node":
        nodes_ = graph.sources(owner, Edge.REFERENCES)
        return next((one for one in nodes_ if one.kind is Kind.ACTIVITY_PARAMETER), None)
    if word == "trigger":
        return next((one for one in graph.owned(owner) if one.kind is Kind.TRIGGER), None)
    regions = [one for one in graph.owned(owner) if one.kind is Kind.REGION]
    region = regions[0] if len(regions) == 1 else None
    return region if word == "region" else low.end_of(region or owner, word)
