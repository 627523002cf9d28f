"""What is bound to each other can be the same (KerML 8.3.4.5.2)."""

from collections.abc import Iterator

from sysmlc.diagnostics import Severity, rule
from sysmlc.language.checks.found import Found, name_of
from sysmlc.language.metaclasses import kinds_of
from sysmlc.language.names import Model
from sysmlc.language.names.positional_redefinition import find_own_features
from sysmlc.language.tree import Node

UNLIKE = rule(
    "SM283",
    "bound-unlike",
    Severity.WARNING,
    "'{one}' is bound to '{other}', and no value can be both: {types}",
    help="bind features of types that conform",
)


def check(model: Model, node: Node) -> Iterator[Found]:
    """Report a binding of features of which the types have nothing in common."""
    bound = [one for end in find_own_features(node, "end") for one in _referenced(end)]
    if len(bound) != 2:
        return
    first, second = (model.types(one) for one in bound)
    if first and second and not any(_conform(model, a, b) for a in first for b in second):
        types = " and ".join(f"'{name_of(model, one[0])}'" for one in (first, second))
        one, other = (name_of(model, feature) for feature in bound)
        yield Found(UNLIKE, node.start, {"one": one, "other": other, "types": types})


def _referenced(end: Node) -> list[Node]:
    references = [one.reference for one in end.relations if one.kind == "ReferenceSubsetting"]
    return [one.target for one in references if one.target is not None]


def _conform(model: Model, one: Node, other: Node) -> bool:
    return model.specializes(one, other) or model.specializes(other, one)


CHECKS = ((kinds_of("BindingConnector"), check),)
