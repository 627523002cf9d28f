"""Readable text form of a graph, and the parser for it; used by golden tests and ``--emit ir``.

One element a line, indented below its owner; ``->`` lines are the edges that leave it, ``?>``
lines the references that are not resolved yet. docs/ir.md shows the form.
"""

import json
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from enum import StrEnum
from typing import NoReturn, TypeVar

from sysmlc.ir.element import AttrValue, Element
from sysmlc.ir.graph import Graph
from sysmlc.ir.kinds import Edge, Kind
from sysmlc.ir.reference import Reference

_E = TypeVar("_E", bound=StrEnum)
_BARE = re.compile(r"[\w.:/#!+~%-]+")
_BLANK = re.compile(r"\s*")
_DECODER = json.JSONDecoder()


class IrSyntaxError(ValueError):
    """The text is no graph; the message says the line."""


# -- printing ----------------------------------------------------------------------------------


def print_text(graph: Graph) -> str:
    """The graph as text; elements without an owner in the order of addition."""
    waiting = _waiting(graph)
    lines = [line for root in graph.roots() for line in _element_lines(graph, root, waiting)]
    return "".join(f"{line}\n" for line in lines)


def print_element(graph: Graph, element: Element) -> str:
    """One element and what is below it, as text."""
    return "".join(f"{line}\n" for line in _element_lines(graph, element, _waiting(graph)))


def _waiting(graph: Graph) -> dict[str, list[Reference]]:
    waiting: dict[str, list[Reference]] = {}
    for reference in graph.pending:
        waiting.setdefault(reference.source, []).append(reference)
    return waiting


def _element_lines(
    graph: Graph, root: Element, waiting: dict[str, list[Reference]]
) -> Iterator[str]:
    stack = [(root, "")]
    while stack:
        element, indent = stack.pop()
        yield indent + _head(element)
        for edge in Edge:
            targets = graph.targets(element, edge)
            if targets and edge is not Edge.OWNS:
                yield f"{indent}  -> {edge} " + " ".join(_word(t.id) for t in targets)
        for reference in waiting.get(element.id, ()):
            yield f"{indent}  ?> {_pending(reference)}"
        stack.extend((child, f"{indent}  ") for child in reversed(graph.owned(element)))


def _head(element: Element) -> str:
    parts = [element.kind, _word(element.id)]
    if element.name:
        parts.append(_json(element.name))
    parts += [f"{_word(key)}={_json(element.attrs[key])}" for key in sorted(element.attrs)]
    if element.source:
        parts.append(f"@{_word(element.source)}:{element.ordinal}")
    return " ".join(parts)


def _pending(reference: Reference) -> str:
    parts = [reference.edge, _word(reference.target), reference.kind]
    if reference.name:
        parts.append(_json(reference.name))
    return " ".join(parts)


def _word(text: str) -> str:
    return text if _BARE.fullmatch(text) else _json(text)


def _json(value: AttrValue) -> str:
    return json.dumps(value, ensure_ascii=False)


# -- parsing -----------------------------------------------------------------------------------


def parse_text(text: str) -> Graph:
    """The graph that a text describes. Raises IrSyntaxError."""
    return _Parser(text).graph()


@dataclass(slots=True)
class _Parser:
    text: str
    _graph: Graph = field(default_factory=Graph)
    _owners: list[tuple[int, str]] = field(default_factory=list)
    _links: list[tuple[int, Edge, str, str]] = field(default_factory=list)

    def graph(self) -> Graph:
        for number, line in enumerate(self.text.split("\n"), 1):
            if line.strip() and not line.lstrip().startswith("//"):
                self._line(number, line)
        for number, edge, source, target in self._links:
            _checked(number, self._graph.connect, edge, source, target)
        return self._graph

    def _line(self, number: int, line: str) -> None:
        indent = len(line) - len(line.lstrip())
        scanner = _Scanner(number, line, indent)
        while self._owners and self._owners[-1][0] >= indent:
            self._owners.pop()
        if line.startswith(("->", "?>"), indent):
            self._relation(scanner)
        else:
            self._element(scanner, indent)

    def _relation(self, scanner: "_Scanner") -> None:
        arrow, edge = scanner.word(), scanner.enum(Edge)
        if not self._owners:
            scanner.fail("an edge without an element above it")
        source = self._owners[-1][1]
        if arrow == "->":
            while not scanner.at_end():
                self._links.append((scanner.number, edge, source, scanner.word()))
        else:
            target, kind = scanner.word(), scanner.enum(Kind)
            name = "" if scanner.at_end() else scanner.string()
            self._graph.pending.append(Reference(edge, source, target, kind, name))

    def _element(self, scanner: "_Scanner", indent: int) -> None:
        kind, id = scanner.enum(Kind), scanner.word()
        owner = self._owners[-1][1] if self._owners else None
        element = Element(id, kind, owner=owner)
        if scanner.peek() == '"' and not scanner.is_attribute():
            element.name = scanner.string()
        while not scanner.at_end():
            _detail(scanner, element)
        _checked(scanner.number, self._graph.add, element)
        self._owners.append((indent, id))


def _detail(scanner: "_Scanner", element: Element) -> None:
    if scanner.take("@"):
        element.source = scanner.word(until=":")
        scanner.expect(":")
        element.ordinal = int(scanner.word())
    else:
        key = scanner.word()
        scanner.expect("=")
        element.attrs[key] = _frozen(scanner.value())


def _frozen(value: object) -> AttrValue:
    if isinstance(value, list):
        return tuple(_frozen(item) for item in value)
    if value is None or isinstance(value, str | int | float | bool):
        return value
    raise IrSyntaxError(f"{value!r} cannot be an attribute")


def _checked(number: int, change: Callable[..., object], *args: object) -> None:
    try:
        change(*args)
    except (KeyError, ValueError) as problem:
        raise IrSyntaxError(f"line {number}: {problem}") from problem


class _Scanner:
    """Reads words, strings and JSON values of one line from left to right."""

    def __init__(self, number: int, line: str, at: int) -> None:
        self.number = number
        self._line = line.rstrip()
        self._at = at

    def fail(self, what: str) -> NoReturn:
        raise IrSyntaxError(f"line {self.number}: {what}: {self._line[self._at :]!r}")

    def peek(self) -> str:
        self._at = self._blank_end()
        return self._line[self._at : self._at + 1]

    def _blank_end(self) -> int:
        match = _BLANK.match(self._line, self._at)
        return match.end() if match else self._at

    def at_end(self) -> bool:
        return self.peek() == ""

    def take(self, sign: str) -> bool:
        if self.peek() != sign:
            return False
        self._at += 1
        return True

    def expect(self, sign: str) -> None:
        if not self.take(sign):
            self.fail(f"expected {sign}")

    def is_attribute(self) -> bool:
        _, end = self._decode()
        return self._line[end : end + 1] == "="

    def word(self, until: str = "") -> str:
        if self.peek() == '"':
            return self.string()
        if self._line.startswith(("->", "?>"), self._at):
            self._at += 2
            return self._line[self._at - 2 : self._at]
        match = _BARE.match(self._line, self._at)
        if match is None:
            self.fail("expected a word")
        found = match[0].rpartition(until)[0] if until else match[0]
        self._at += len(found)
        return found

    def string(self) -> str:
        value = self.value()
        if not isinstance(value, str):
            self.fail("expected a string before this")
        return str(value)

    def value(self) -> object:
        self.peek()
        value, self._at = self._decode()
        return value

    def _decode(self) -> tuple[object, int]:
        try:
            return _DECODER.raw_decode(self._line, self._at)
        except ValueError as problem:
            raise IrSyntaxError(f"line {self.number}: {problem}") from problem

    def enum(self, type_: type[_E]) -> _E:
        word = self.word()
        try:
            return type_(word)
        except ValueError:
            raise IrSyntaxError(f"line {self.number}: no {type_.__name__} {word!r}") from None
