"""How metadata writes facts that it keeps: ``name=value``, ``edge->element``, ``edge=>outside``."""

import json

from sysmlc.backends.sysml.book import Book
from sysmlc.backends.sysml.entry import Entry
from sysmlc.backends.sysml.words import quoted
from sysmlc.ir import AttrValue, Edge, Element

_MARKS = ("=", "->", '"')


def attribute(book: Book, key: str, value: AttrValue) -> str | None:
    """An attribute: its value is text as it is, or JSON where it is none or would be taken for it.

    None where it names elements that the text cannot name. The name of an attribute with a mark
    in it is a JSON string.
    """
    name = key if not any(mark in key for mark in _MARKS) else _json(key)
    if isinstance(value, str) and key not in _WORDS and value in book.graph:
        path = _path(book, book.graph[value])
        return None if path is None else f"{name}->{path}"
    if isinstance(value, tuple) and _has_ids(book, value):
        return None
    return f"{name}={_text(value)}"


_WORDS = frozenset({"name", "guard", "body", "default", "value", "visibility", "subkind"})
"""Attributes that never hold ids."""


def relation(book: Book, edge: Edge, target: Element) -> str | None:
    """An edge, by the qualified name of what it leads to in the text or outside of the model."""
    if target.attrs.get("external") and book.plan.entry(target) is None:
        name = str(target.attrs.get("qualified_name") or target.name)
        return f"{edge.value}=>{name}" if name else None
    path = _path(book, target)
    return None if path is None else f"{edge.value}->{path}"


def _path(book: Book, target: Element) -> str | None:
    """The qualified name of a member; None where the text has no names that lead to it."""
    entry = book.plan.entry(target)
    if entry is None or entry.element is not target:
        return None
    way: list[Entry] = [entry, *entry.above]
    if not all(one.name for one in way):
        return None
    for one in way:
        book.plan.show(one)
    return "::".join(quoted(one.name) for one in reversed(way))


def _has_ids(book: Book, value: AttrValue) -> bool:
    if isinstance(value, tuple):
        return any(_has_ids(book, one) for one in value)
    return isinstance(value, str) and value in book.graph


def _text(value: AttrValue) -> str:
    is_plain = isinstance(value, str) and not _is_json(value) and not value.startswith(">")
    return str(value) if is_plain else _json(value)


def _json(value: AttrValue) -> str:
    return json.dumps(value, ensure_ascii=False)


def _is_json(text: str) -> bool:
    try:
        json.loads(text)
    except ValueError:
        return False
    return True
