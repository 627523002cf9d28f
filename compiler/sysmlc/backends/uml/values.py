"""Value specifications (UML 2.5.1 clause 8) for what the graph keeps as values and texts."""

import re
from collections.abc import Mapping

from sysmlc.backends.uml.book import Book
from sysmlc.backends.uml.hrefs import is_outside, reference
from sysmlc.backends.uml.names import capital
from sysmlc.backends.uml.node import Node
from sysmlc.ir import AttrValue, Element

_INTEGER = re.compile(r"-?(0|[1-9][0-9]*)")


def shown(value: AttrValue) -> str:
    """A value as XML holds it."""
    if isinstance(value, bool):
        return "true" if value else "false"
    return "" if value is None else str(value)


def literal(book: Book, holder: Element, above: Node, tag: str, value: AttrValue) -> Node:
    """A literal of the value's type; one with the default has no value attribute."""
    metaclass, default = _literal(value)
    made = book.part(holder, above, tag, metaclass)
    if metaclass != "LiteralNull" and shown(value) != default:
        made.attributes["value"] = shown(value)
    return made


def _literal(value: AttrValue) -> tuple[str, str]:
    if isinstance(value, bool):
        return "LiteralBoolean", "false"
    if isinstance(value, int):
        return "LiteralInteger", "0"
    if isinstance(value, float):
        return "LiteralReal", "0.0"
    if value == "*":
        return "LiteralUnlimitedNatural", ""
    return ("LiteralNull" if value == "null" else "LiteralString"), ""


def text(book: Book, holder: Element, above: Node, tag: str, value: AttrValue) -> Node:
    """An opaque expression with the text, or a number when it is one."""
    written = shown(value)
    if _INTEGER.fullmatch(written):
        return literal(book, holder, above, tag, int(written))
    return opaque(book, holder, above, tag, written)


def opaque(
    book: Book, holder: Element, above: Node, tag: str, body: str, language: str = ""
) -> Node:
    """An opaque expression."""
    made = book.part(holder, above, tag, "OpaqueExpression")
    say(made, (body,), (language,))
    return made


def say(node: Node, bodies: tuple[str, ...], languages: tuple[str, ...]) -> None:
    """Give an opaque element its texts and their languages."""
    while languages and not languages[-1]:
        languages = languages[:-1]
    for tag, texts in (("language", languages), ("body", bodies)):
        for one in texts:
            node.add(Node(tag, text=one))


def texts(attrs: Mapping[str, AttrValue], prefix: str = "") -> tuple[tuple[str, ...], ...]:
    """All bodies and languages that an element keeps under ``<prefix>bodies``, or none."""
    bodies, languages = attrs.get(f"{prefix}bodies"), attrs.get(f"{prefix}languages")
    if not isinstance(bodies, tuple) or not isinstance(languages, tuple):
        return ()
    return tuple(map(shown, bodies)), tuple(map(shown, languages))


def value(book: Book, element: Element, key: str, tag: str) -> None:
    """The value under ``key``: an instance, an expression or a literal."""
    attrs, node = element.attrs, book.node(element)
    named = book.graph.get(str(attrs.get(f"{key}_instance", "")))
    several = texts(attrs, f"{key}_")
    if named is not None and (is_outside(named) or named.id in book.nodes):
        _instance(book, element, node, tag, named, attrs.get(key))
    elif several:
        say(book.part(element, node, tag, "OpaqueExpression"), several[0], several[1])
    elif f"{key}_language" in attrs:
        language = shown(attrs[f"{key}_language"])
        opaque(book, element, node, tag, shown(attrs.get(key)), language)
    else:
        literal(book, element, node, tag, attrs.get(key))


def _instance(
    book: Book, holder: Element, above: Node, tag: str, named: Element, name: AttrValue
) -> None:
    made = instance(book, holder, above, tag, named)
    if is_outside(named) and name:
        made.attributes["name"] = shown(name)


def instance(book: Book, holder: Element, above: Node, tag: str, named: Element) -> Node:
    """A value that is an instance, or a literal of an enumeration."""
    made = book.part(holder, above, tag, "InstanceValue")
    if is_outside(named):
        made.add(reference(book.graph, "instance", named))
    else:
        made.attributes["instance"] = book.ids[named.id]
    return made


def guard(book: Book, element: Element, tag: str = "guard") -> None:
    """The guard of an activity edge: text, and whether it was a literal."""
    attrs, node = element.attrs, book.node(element)
    written, several = shown(attrs.get("guard")), texts(attrs, "guard_")
    if several:
        say(book.part(element, node, tag, "OpaqueExpression"), several[0], several[1])
    elif attrs.get("guard_literal"):
        literal(book, element, node, tag, _typed(written))
    else:
        opaque(book, element, node, tag, written, shown(attrs.get("guard_language")))


def _typed(written: str) -> AttrValue:
    if written in ("true", "false"):
        return written == "true"
    if _INTEGER.fullmatch(written):
        return int(written)
    try:
        return float(written) if repr(float(written)) == written else written
    except ValueError:
        return written


def bounds(book: Book, element: Element) -> None:
    """Bounds of a multiplicity in UML's notation; a default bound has no value attribute."""
    written = shown(element.attrs.get("multiplicity"))
    lower, dots, upper = written.partition("..")
    if not dots:
        lower, upper = ("0", "*") if lower == "*" else (lower, lower)
    node = book.node(element)
    text(book, element, node, "lowerValue", lower)
    if upper == "*" or upper.isdecimal():
        top = book.part(element, node, "upperValue", "LiteralUnlimitedNatural")
        top.attributes["value"] = upper
    else:
        opaque(book, element, node, "upperValue", upper)


def timed(book: Book, holder: Element, above: Node, tag: str, metaclass: str, said: str) -> Node:
    """A time expression or duration around what it says."""
    made = book.part(holder, above, tag, metaclass)
    text(book, holder, made, "expr", said)
    return made


def packaged(book: Book, element: Element) -> None:
    """A value that a package owns: the content of its own node."""
    node, attrs = book.node(element), element.attrs
    said, language = attrs.get("value"), shown(attrs.get("value_language"))
    name = capital(element.subkind)
    if name.startswith("Literal"):
        if name != "LiteralNull" and said not in (0, False, "") and said is not None:
            node.attributes["value"] = shown(said)
    elif name in ("Duration", "TimeExpression"):
        if isinstance(said, str):
            opaque(book, element, node, "expr", said, language)
        else:
            literal(book, element, node, "expr", said)
    elif name.endswith("Interval"):
        # MagicDraw keeps the bounds inside; Papyrus keeps them elsewhere, as the graph cannot.
        least, dots, most = shown(said).partition("..")
        inner = "TimeExpression" if name == "TimeInterval" else "Duration"
        for tag, bound in (("min", least), ("max", most if dots else least)):
            timed(book, element, node, tag, inner, bound)
    elif name in ("Expression", "StringExpression"):
        node.attributes["symbol"] = shown(said)
    else:
        say(node, (shown(said),), (language,))
