"""Constraints inside behaviours that no contract reads: state invariants, local conditions, times.

A contract without them can promise more than the model does, so that each is reported.
"""

from collections.abc import Iterable, Iterator

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.expressions import list_names
from sysmlc.logic.contract import Contract
from sysmlc.logic.formal_texts import is_formal_constraint

RESTRICTION_NOT_READ = rule(
    "SM488",
    "restriction-not-in-contract",
    Severity.WARNING,
    "the {what} of '{element}' is not in the contract of '{component}'",
    help="state it as a guard, or as a formula or a requirement about the component",
)
_WORDS = {"duration": "duration constraint", "time": "time constraint", "": "constraint"}
_FEATURES = (Kind.PROPERTY, Kind.PIN, Kind.PARAMETER)


def report_unread_restrictions(graph: Graph, contracts: Iterable[Contract], sink: Sink) -> None:
    """Report the constraints of steps and states of the behaviours that have contracts.

    A constraint that nothing asserts restricts nothing (SysML 2.0, 7.20.1). Guards and formulas are
    part of the contract. Constraints of an activity itself belong to its service, and those that
    name a feature of their owner give its range.
    """
    components = {contract.origin: contract.component for contract in contracts}
    for constraint in graph.of_kind(Kind.CONSTRAINT):
        is_asserted = constraint.attrs.get("asserted") is not False
        if (
            not is_asserted
            or graph.sources(constraint, Edge.GUARD)
            or is_formal_constraint(constraint)
        ):
            continue
        for element, component in _find_restricted(graph, constraint, components):
            what = _WORDS.get(constraint.subkind, constraint.subkind)
            name = element.name or graph.qualified_name(element)
            subject = graph.subject(constraint)
            sink.report(RESTRICTION_NOT_READ, subject, what=what, element=name, component=component)
            break


def _find_restricted(
    graph: Graph, constraint: Element, components: dict[str, str]
) -> Iterator[tuple[Element, str]]:
    """Yield the elements of behaviours that the constraint restricts, with their components."""
    owner = graph.owner(constraint)
    for element in [*graph.targets(constraint, Edge.REFERENCES), *([owner] if owner else [])]:
        if element.kind in _FEATURES or _names_feature(graph, constraint, element):
            continue
        if element.kind is Kind.ACTIVITY and element.id in components:
            continue
        for ancestor in (element, *graph.ancestors(element)):
            if ancestor.id in components:
                yield element, components[ancestor.id]


def _names_feature(graph: Graph, constraint: Element, element: Element) -> bool:
    names = set(list_names(str(constraint.attrs.get("body", ""))))
    return any(
        feature.name in names for feature in graph.owned(element) if feature.kind in _FEATURES
    )
