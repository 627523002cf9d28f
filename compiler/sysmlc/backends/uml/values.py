"""Value specifications (UML 2.5.1 clause 8) for the values and texts of the graph."""

import re
from collections.abc import Mapping

from sysmlc.backends.uml.context import Context
from sysmlc.backends.uml.features import to_class_name
from sysmlc.backends.uml.hrefs import is_external, make_reference
from sysmlc.backends.uml.node import Node
from sysmlc.ir import AttrValue, Element

_INTEGER = re.compile(r"-?(0|[1-9][0-9]*)")
_Texts = tuple[str, ...]


def format_value(value: AttrValue) -> str:
    """Return a value in the lexical form of XMI."""
    if isinstance(value, bool):
        return "true" if value else "false"
    return "" if value is None else str(value)


# -- literals and expressions ------------------------------------------------------------------


def add_literal(
    context: Context, holder: Element, parent: Node, tag: str, value: AttrValue
) -> Node:
    """Add a literal of the value's type; the default of the metaclass is omitted."""
    metaclass, default = _find_literal_metaclass(value)
    literal = context.add_part(holder, parent, tag, metaclass)
    if metaclass != "LiteralNull" and format_value(value) != default:
        literal.attributes["value"] = format_value(value)
    return literal


def _find_literal_metaclass(value: AttrValue) -> tuple[str, str]:
    """Return the metaclass of a literal, and the default of its feature ``value``."""
    if isinstance(value, bool):
        return "LiteralBoolean", "false"
    if isinstance(value, int):
        return "LiteralInteger", "0"
    if isinstance(value, float):
        return "LiteralReal", "0.0"
    if value == "*":
        return "LiteralUnlimitedNatural", ""
    return ("LiteralNull" if value == "null" else "LiteralString"), ""


def add_expression(
    context: Context, holder: Element, parent: Node, tag: str, body: str, language: str = ""
) -> Node:
    """Add an opaque expression with one body."""
    expression = context.add_part(holder, parent, tag, "OpaqueExpression")
    write_bodies(expression, (body,), (language,))
    return expression


def add_text(context: Context, holder: Element, parent: Node, tag: str, value: AttrValue) -> Node:
    """Add a literal if the value is an integer or the text of one, else an opaque expression."""
    text = format_value(value)
    if _INTEGER.fullmatch(text):
        return add_literal(context, holder, parent, tag, int(text))
    return add_expression(context, holder, parent, tag, text)


def add_time(
    context: Context, holder: Element, parent: Node, tag: str, metaclass: str, text: str
) -> Node:
    """Add a time expression or duration with its expression."""
    time = context.add_part(holder, parent, tag, metaclass)
    add_text(context, holder, time, "expr", text)
    return time


def add_instance_value(
    context: Context, holder: Element, parent: Node, tag: str, instance: Element
) -> Node:
    """Add a value that is an instance, or a literal of an enumeration."""
    value = context.add_part(holder, parent, tag, "InstanceValue")
    if is_external(instance):
        value.add(make_reference(context.graph, "instance", instance))
    else:
        value.attributes["instance"] = context.ids[instance.id]
    return value


def write_bodies(node: Node, bodies: _Texts, languages: _Texts) -> None:
    """Add bodies and their languages to the node of an opaque element.

    UML relates both by position, so empty languages at the end are omitted.
    """
    while languages and not languages[-1]:
        languages = languages[:-1]
    for tag, texts in (("language", languages), ("body", bodies)):
        for text in texts:
            node.add(Node(tag, text=text))


def read_bodies(attrs: Mapping[str, AttrValue], prefix: str = "") -> tuple[_Texts, _Texts] | None:
    """Return the bodies and languages of an element that has several, or None.

    The attributes are ``<prefix>bodies`` and ``<prefix>languages``.
    """
    bodies, languages = attrs.get(f"{prefix}bodies"), attrs.get(f"{prefix}languages")
    if not isinstance(bodies, tuple) or not isinstance(languages, tuple):
        return None
    return tuple(map(format_value, bodies)), tuple(map(format_value, languages))


# -- values of elements ------------------------------------------------------------------------


def write_value(context: Context, element: Element, key: str, tag: str) -> None:
    """Write the attribute *key*: an instance, an expression or a literal.

    Further attributes say which: ``<key>_instance``, ``<key>_bodies`` and ``<key>_language``.
    """
    attrs, node = element.attrs, context.find_node(element)
    instance = context.graph.get(str(attrs.get(f"{key}_instance", "")))
    bodies = read_bodies(attrs, f"{key}_")
    if instance is not None and context.is_available(instance):
        value = add_instance_value(context, element, node, tag, instance)
        if is_external(instance) and attrs.get(key):
            value.attributes["name"] = format_value(attrs.get(key))
    elif bodies is not None:
        write_bodies(context.add_part(element, node, tag, "OpaqueExpression"), *bodies)
    elif f"{key}_language" in attrs:
        language = format_value(attrs[f"{key}_language"])
        add_expression(context, element, node, tag, format_value(attrs.get(key)), language)
    else:
        add_literal(context, element, node, tag, attrs.get(key))


def write_guard(context: Context, element: Element) -> None:
    """Write the guard of an activity edge: a literal, or an opaque expression."""
    attrs, node, tag = element.attrs, context.find_node(element), "guard"
    text, bodies = format_value(attrs.get("guard")), read_bodies(attrs, "guard_")
    if bodies is not None:
        write_bodies(context.add_part(element, node, tag, "OpaqueExpression"), *bodies)
    elif attrs.get("guard_literal"):
        add_literal(context, element, node, tag, _parse_literal(text))
    else:
        language = format_value(attrs.get("guard_language"))
        add_expression(context, element, node, tag, text, language)


def _parse_literal(text: str) -> AttrValue:
    """Return the value whose lexical form is exactly *text*, else the text itself."""
    if text in ("true", "false"):
        return text == "true"
    if _INTEGER.fullmatch(text):
        return int(text)
    try:
        return float(text) if repr(float(text)) == text else text
    except ValueError:
        return text


def write_multiplicity(context: Context, element: Element) -> None:
    """Write the bounds of a multiplicity in UML's notation (UML 2.5.1 clause 7.5.4)."""
    lower, dots, upper = format_value(element.attrs.get("multiplicity")).partition("..")
    if not dots:
        lower, upper = ("0", "*") if lower == "*" else (lower, lower)
    node = context.find_node(element)
    add_text(context, element, node, "lowerValue", lower)
    if upper == "*" or upper.isdecimal():
        bound = context.add_part(element, node, "upperValue", "LiteralUnlimitedNatural")
        bound.attributes["value"] = upper
    else:
        add_expression(context, element, node, "upperValue", upper)


def fill_packaged_value(context: Context, element: Element) -> None:
    """Write the content of a value specification that is an element of a package itself."""
    node, attrs = context.find_node(element), element.attrs
    value, language = attrs.get("value"), format_value(attrs.get("value_language"))
    metaclass = to_class_name(element.subkind)
    if metaclass.startswith("Literal"):
        if metaclass != "LiteralNull" and value not in (0, False, "") and value is not None:
            node.attributes["value"] = format_value(value)
    elif metaclass in ("Duration", "TimeExpression"):
        if isinstance(value, str):
            add_expression(context, element, node, "expr", value, language)
        else:
            add_literal(context, element, node, "expr", value)
    elif metaclass.endswith("Interval"):
        # The bounds are parts, as MagicDraw saves them. Papyrus saves references to further
        # elements, which the graph does not have.
        lower, dots, upper = format_value(value).partition("..")
        bound_metaclass = "TimeExpression" if metaclass == "TimeInterval" else "Duration"
        for tag, bound in (("min", lower), ("max", upper if dots else lower)):
            add_time(context, element, node, tag, bound_metaclass, bound)
    elif metaclass in ("Expression", "StringExpression"):
        node.attributes["symbol"] = format_value(value)
    else:
        write_bodies(node, (format_value(value),), (language,))
