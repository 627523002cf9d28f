"""Constraints of attributes: bounds and lists of values as expressions, the rest as text."""

import json
import re

from sysmlc.frontends.caex import fitting
from sysmlc.frontends.caex.context import Context
from sysmlc.frontends.caex.document import Document, Node
from sysmlc.frontends.caex.libraries import mark
from sysmlc.ir import Edge, Element, Kind

_PLAIN = re.compile(r"[^\W\d]\w*$")
_BOUNDS = {"RequiredMinValue": ">=", "RequiredValue": "==", "RequiredMaxValue": "<="}


def lower(context: Context, attribute: Element, node: Node, document: Document) -> None:
    """Add the constraints of an attribute (IEC 62424: ordinal, nominal, unknown scale)."""
    for child in node.of("Constraint"):
        data_type = node.attributes.get("AttributeDataType", "")
        body, language = _body(context, child, attribute.name, data_type)
        made = context.add(
            Kind.CONSTRAINT,
            child,
            document,
            attribute.owner,
            id=context.free(f"{attribute.id}/{child.name or 'Constraint'}", child),
            body=body,
            language=language,
        )
        context.graph.connect(Edge.REFERENCES, made.id, attribute.id)
        mark(child)


def _body(context: Context, node: Node, name: str, data_type: str) -> tuple[str, str]:
    subject = name if _PLAIN.match(name) else f"'{name}'"
    for scale in node.children:
        if scale.tag == "OrdinalScaledType":
            found = [(tag, text) for tag in _BOUNDS for text in scale.all_texts(tag)]
            parts = [
                f"{subject} {_BOUNDS[tag]} {_literal(context, node, text, data_type)}"
                for tag, text in found
            ]
            return " && ".join(parts), "sysmlc"
        if scale.tag == "NominalScaledType":
            texts = scale.all_texts("RequiredValue")
            values = [_literal(context, node, text, data_type) for text in texts]
            return " || ".join(f"{subject} == {value}" for value in values), "sysmlc"
        if scale.tag == "UnknownType":
            return " ".join(scale.all_texts("Requirements")).strip(), ""
    return "", ""


def _literal(context: Context, node: Node, text: str, data_type: str) -> str:
    value = fitting.value(context, node, text, data_type, None)
    if isinstance(value, str):
        value = _number(text)
    return json.dumps(value, ensure_ascii=False)


def _number(text: str) -> float | int | str:
    """Bounds are texts in CAEX 3.0, also where the attribute says nothing of its type."""
    for form in (int, float):
        try:
            return form(text.strip())
        except ValueError:
            continue
    return text
