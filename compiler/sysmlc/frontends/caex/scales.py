"""Scales of attributes: bounds and lists of values that constraints require (IEC 62424)."""

from collections.abc import Iterable

from sysmlc.diagnostics import Severity, rule
from sysmlc.frontends.caex.document import Document, Node
from sysmlc.frontends.caex.findings import Findings
from sysmlc.frontends.caex.types import Type

OUTSIDE_SCALE = rule(
    "SM491",
    "value-outside-scale",
    Severity.WARNING,
    "the value '{value}' of '{element}' is {fault}, which its constraint '{constraint}' requires",
    help="correct the value or the constraint",
)


def check_scales(
    findings: Findings,
    document: Document,
    node: Node,
    definitions: Iterable[Node],
    type: Type | None,
) -> None:
    """Report the value of an attribute if it is outside a scale.

    The scales are those of *definitions* and of the attribute type with those that it specialises.
    """
    text = (node.child_text("Value") or node.child_text("DefaultValue") or "").strip()
    chain = (general.node for general in type.iter_chain()) if type is not None else ()
    for definition in (*definitions, *chain) if text else ():
        for constraint in definition.iter_children("Constraint"):
            fault = _find_fault(constraint, text)
            if fault:
                facts = {"value": text, "element": node.name, "constraint": constraint.name}
                findings.report(OUTSIDE_SCALE, document, node, fault=fault, **facts)
                return


def _find_fault(constraint: Node, text: str) -> str:
    """Return how a value is outside the scale of a constraint, or an empty text."""
    number = _parse_number(text)
    for scale in constraint.children:
        if scale.tag == "NominalScaledType":
            allowed = [required.strip() for required in scale.child_texts("RequiredValue")]
            numbers = [_parse_number(required) for required in allowed]
            is_listed = text in allowed or (number is not None and number in numbers)
            if allowed and not is_listed:
                return f"none of {', '.join(allowed)}"
        elif scale.tag == "OrdinalScaledType" and number is not None:
            for bound in scale.child_texts("RequiredMinValue"):
                least = _parse_number(bound)
                if least is not None and number < least:
                    return f"not at least {bound.strip()}"
            for bound in scale.child_texts("RequiredMaxValue"):
                largest = _parse_number(bound)
                if largest is not None and number > largest:
                    return f"not at most {bound.strip()}"
    return ""


def _parse_number(text: str) -> float | None:
    try:
        return float(text)
    except ValueError:
        return None
