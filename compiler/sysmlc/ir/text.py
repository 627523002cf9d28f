"""The text form of a graph: printer and parser, for tests and ``--emit ir`` (docs/ir.md).

Each element is one line, indented below its owner. ``->`` lines are the edges that leave it,
``?>`` lines its pending references.
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
from sysmlc.ir.pending import Reference
from sysmlc.support.escapes import HALF_CHARACTER, has_surrogate

_E = TypeVar("_E", bound=StrEnum)
_BARE = re.compile(r"[\w.:/#!+~%-]+")
_BLANK = re.compile(r"\s*")
_DECODER = json.JSONDecoder()


class IrSyntaxError(ValueError):
    """The text is not a graph; the message starts with the line."""


# -- printing ----------------------------------------------------------------------------------


def print_text(graph: Graph) -> str:
    """Return the graph as text, elements without an owner in order of addition."""
    pending = _group_pending(graph)
    lines = [line for root in graph.roots() for line in _element_lines(graph, root, pending)]
    return "".join(f"{line}\n" for line in lines)


def print_element(graph: Graph, element: Element) -> str:
    """Return one element and everything below it as text."""
    lines = _element_lines(graph, element, _group_pending(graph))
    return "".join(f"{line}\n" for line in lines)


def _group_pending(graph: Graph) -> dict[str, list[Reference]]:
    pending: dict[str, list[Reference]] = {}
    for reference in graph.pending:
        pending.setdefault(reference.source, []).append(reference)
    return pending


def _element_lines(
    graph: Graph, root: Element, pending: dict[str, list[Reference]]
) -> Iterator[str]:
    stack = [(root, "")]
    while stack:
        element, indent = stack.pop()
        yield indent + _print_head(element)
        for edge in Edge:
            targets = graph.targets(element, edge)
            if targets and edge is not Edge.OWNS:
                yield f"{indent}  -> {edge} " + " ".join(_quote(t.id) for t in targets)
        for reference in pending.get(element.id, ()):
            yield f"{indent}  ?> {_print_reference(reference)}"
        stack.extend((child, f"{indent}  ") for child in reversed(graph.owned(element)))


def _print_head(element: Element) -> str:
    parts = [element.kind, _quote(element.id)]
    if element.name:
        parts.append(_to_json(element.name))
    parts += [f"{_quote(key)}={_to_json(element.attrs[key])}" for key in sorted(element.attrs)]
    if element.source:
        parts.append(f"@{_quote(element.source)}:{element.ordinal}")
    return " ".join(parts)


def _print_reference(reference: Reference) -> str:
    parts = [reference.edge, _quote(reference.target), reference.kind]
    if reference.name:
        parts.append(_to_json(reference.name))
    return " ".join(parts)


def _quote(text: str) -> str:
    """Return *text* as a word, in quotes if it has other characters than those of ids."""
    return text if _BARE.fullmatch(text) else _to_json(text)


def _to_json(value: AttrValue) -> str:
    return json.dumps(value, ensure_ascii=False)


# -- parsing -----------------------------------------------------------------------------------


def parse_text(text: str) -> Graph:
    """Return the graph that a text describes. Raise IrSyntaxError."""
    return _Parser(text).parse()


@dataclass(slots=True)
class _Parser:
    text: str
    _graph: Graph = field(default_factory=Graph)
    _owners: list[tuple[int, str]] = field(default_factory=list)
    _edges: list[tuple[int, Edge, str, str]] = field(default_factory=list)

    def parse(self) -> Graph:
        for number, line in enumerate(self.text.split("\n"), 1):
            if line.strip() and not line.lstrip().startswith("//"):
                self._read_line(number, line)
        for number, edge, source, target in self._edges:
            _apply_change(number, self._graph.connect, edge, source, target)
        return self._graph

    def _read_line(self, number: int, line: str) -> None:
        indent = len(line) - len(line.lstrip())
        scanner = _Scanner(number, line, indent)
        while self._owners and self._owners[-1][0] >= indent:
            self._owners.pop()
        if line.startswith(("->", "?>"), indent):
            self._read_relation(scanner)
        else:
            self._read_element(scanner, indent)

    def _read_relation(self, scanner: "_Scanner") -> None:
        arrow, edge = scanner.read_word(), scanner.read_enum(Edge)
        if not self._owners:
            scanner.fail("an edge without an element above it")
        source = self._owners[-1][1]
        if arrow == "->":
            while not scanner.is_at_end():
                self._edges.append((scanner.number, edge, source, scanner.read_word()))
        else:
            target, kind = scanner.read_word(), scanner.read_enum(Kind)
            name = "" if scanner.is_at_end() else scanner.read_string()
            self._graph.pending.append(Reference(edge, source, target, kind, name))

    def _read_element(self, scanner: "_Scanner", indent: int) -> None:
        kind, id = scanner.read_enum(Kind), scanner.read_word()
        owner = self._owners[-1][1] if self._owners else None
        element = Element(id, kind, owner=owner)
        if scanner.peek() == '"' and not scanner.is_attribute():
            element.name = scanner.read_string()
        while not scanner.is_at_end():
            _read_attribute(scanner, element)
        _apply_change(scanner.number, self._graph.add, element)
        self._owners.append((indent, id))


def _read_attribute(scanner: "_Scanner", element: Element) -> None:
    if scanner.take("@"):
        element.source = scanner.read_word(until=":")
        scanner.expect(":")
        element.ordinal = int(scanner.read_word())
    else:
        key = scanner.read_word()
        scanner.expect("=")
        element.attrs[key] = _to_attribute(scanner.read_value())


def _to_attribute(value: object) -> AttrValue:
    if isinstance(value, list):
        return tuple(_to_attribute(item) for item in value)
    if value is None or isinstance(value, str | int | float | bool):
        return value
    raise IrSyntaxError(f"{value!r} cannot be an attribute")


def _apply_change(number: int, change: Callable[..., object], *args: object) -> None:
    try:
        change(*args)
    except (KeyError, ValueError) as problem:
        raise IrSyntaxError(f"line {number}: {problem}") from problem


class _Scanner:
    """Scanner of one line: words, strings and JSON values from left to right."""

    def __init__(self, number: int, line: str, position: int) -> None:
        self.number = number
        self._line = line.rstrip()
        self._position = position

    def fail(self, problem: str) -> NoReturn:
        raise IrSyntaxError(f"line {self.number}: {problem}: {self._line[self._position :]!r}")

    def peek(self) -> str:
        self._position = self._skip_blanks()
        return self._line[self._position : self._position + 1]

    def _skip_blanks(self) -> int:
        match = _BLANK.match(self._line, self._position)
        return match.end() if match else self._position

    def is_at_end(self) -> bool:
        return self.peek() == ""

    def take(self, sign: str) -> bool:
        if self.peek() != sign:
            return False
        self._position += 1
        return True

    def expect(self, sign: str) -> None:
        if not self.take(sign):
            self.fail(f"expected {sign}")

    def is_attribute(self) -> bool:
        _, end = self._decode()
        return self._line[end : end + 1] == "="

    def read_word(self, until: str = "") -> str:
        if self.peek() == '"':
            return self.read_string()
        if self._line.startswith(("->", "?>"), self._position):
            self._position += 2
            return self._line[self._position - 2 : self._position]
        match = _BARE.match(self._line, self._position)
        if match is None:
            self.fail("expected a word")
        word = match[0].rpartition(until)[0] if until else match[0]
        self._position += len(word)
        return word

    def read_string(self) -> str:
        value = self.read_value()
        if not isinstance(value, str):
            self.fail("expected a string before this")
        return str(value)

    def read_value(self) -> object:
        self.peek()
        value, self._position = self._decode()
        return value

    def _decode(self) -> tuple[object, int]:
        try:
            value, end = _DECODER.raw_decode(self._line, self._position)
        except ValueError as problem:
            raise IrSyntaxError(f"line {self.number}: {problem}") from problem
        if "\\u" in self._line and has_surrogate(json.dumps(value, ensure_ascii=False)):
            raise IrSyntaxError(f"line {self.number}: {HALF_CHARACTER}")
        return value, end

    def read_enum(self, type_: type[_E]) -> _E:
        word = self.read_word()
        try:
            return type_(word)
        except ValueError:
            raise IrSyntaxError(f"line {self.number}: no {type_.__name__} {word!r}") from None
