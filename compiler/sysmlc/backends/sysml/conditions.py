"""Conditions: expressions over the model, or text that becomes the name of a feature."""

import re

from sysmlc.backends.sysml.book import Book
from sysmlc.backends.sysml.entry import Entry
from sysmlc.backends.sysml.expressions import expression
from sysmlc.backends.sysml.library import UNITS
from sysmlc.backends.sysml.rules import TEXT_AS_NAME
from sysmlc.backends.sysml.words import quoted
from sysmlc.ir import Element

_DURATION = re.compile(r"\s*(\d+(?:\.\d+)?)\s*([a-zµ]*)\s*", re.IGNORECASE)
_TIMES = {
    "": "s",
    "sec": "s",
    "secs": "s",
    "second": "s",
    "seconds": "s",
    "msec": "ms",
    "minute": "min",
    "minutes": "min",
    "hour": "h",
    "hours": "h",
}


def condition(book: Book, scope: Entry | None, element: Element, text: str) -> str:
    """A condition as an expression; text that is none is the name of a Boolean attribute."""
    found = expression(book, scope, text)
    return found if found is not None else _named(book, scope, element, text, "Boolean")


def duration(book: Book, scope: Entry | None, element: Element, text: str) -> str:
    """A duration: a number with a unit of time (seconds when there is none), or an expression."""
    found = _DURATION.fullmatch(text)
    if found is not None:
        unit = _TIMES.get(found[2].lower(), found[2])
        if UNITS.get(unit, ("", ""))[0] == "DurationValue":
            package = "SysMLC::Units" if unit in ("ms", "µs") else "SI"
            return f"{found[1]} [{book.library(scope, f'{package}::{unit}')}]"
    return _quantity(book, scope, element, text, "ISQ::DurationValue")


def instant(book: Book, scope: Entry | None, element: Element, text: str) -> str:
    """A point in time: an expression, or the name of an attribute."""
    return _quantity(book, scope, element, text, "Time::TimeInstantValue")


def _quantity(book: Book, scope: Entry | None, element: Element, text: str, type_: str) -> str:
    found = expression(book, scope, text)
    return found if found is not None else _named(book, scope, element, text, type_)


def _named(book: Book, scope: Entry | None, element: Element, text: str, type_: str) -> str:
    """A feature of the nearest namespace, declared once for each text."""
    shown = " ".join(text.split()) or "undefined"
    book.losses.note(TEXT_AS_NAME, element, text=shown)
    space = scope
    while space is not None and space.parent is not None and space.shape.keyword in _SMALL:
        space = space.parent
    if space is None:
        return quoted(shown)
    full = type_ if "::" in type_ else f"ScalarValues::{type_}"
    return book.declare(space, shown, full)


_SMALL = frozenset({"transition", "succession", "flow", "constraint"})
