"""What the tree leaves out because it follows: parameters, results, conjugates (KerML 8.2.5.8)."""

from sysmlc.language.exchange.elements import Element
from sysmlc.language.exchange.relations import NAMING
from sysmlc.language.metaclasses import is_a
from sysmlc.language.tree import Node

_END = "EndFeatureMembership"
_RESULTLESS = {"ConstructorExpression", "AssignmentActionUsage", "TransitionUsage"}


def argument(value: Element) -> Element:
    """The parameter that carries an argument (KerML 1.0, 8.2.5.8.1)."""
    parameter = Element("Feature")
    parameter.attributes["direction"] = "in"
    parameter.own(Element("FeatureValue")).own(value)
    return parameter


def late(value: Element) -> Element:
    """The reference to an expression that is only evaluated when others say so."""
    made = Element("FeatureReferenceExpression")
    made.own(Element("FeatureMembership")).own(value)
    made.own(_result())
    return made


def add_implicit(element: Element, node: Node) -> None:
    """Own what follows for an element of its kind when its node owns nothing like it."""
    if node.kind in NAMING and node.kind not in _RESULTLESS:
        if not any(one.membership == "ReturnParameterMembership" for one in node.members):
            element.own(_result())
    elif node.kind == "PortDefinition":
        element.own(Element("OwningMembership")).own(_conjugate(element))
    elif node.kind == "SuccessionAsUsage" and [one.membership for one in node.members] == [_END]:
        element.own(Element(_END)).own(Element("ReferenceUsage")).attributes["isEnd"] = True
    elif node.facts.get("isIndividual") and is_a(node.kind, "OccurrenceDefinition"):
        element.own(Element("OwningMembership")).own(Element("Multiplicity"))


def _result() -> Element:
    made = Element("ReturnParameterMembership")
    made.own(Element("Feature")).attributes["direction"] = "out"
    return made


def _conjugate(definition: Element) -> Element:
    """The conjugated port definition that every port definition has (SysML 2.0, 8.2.2.12)."""
    made = Element("ConjugatedPortDefinition")
    conjugation = made.own(Element("PortConjugation"))
    conjugation.targets += [("conjugatedType", made), ("originalPortDefinition", definition)]
    return made
