"""The requirements of a model as their author states them, also those in no contract."""

from collections.abc import Iterable, Iterator, Mapping

from msgspec import Struct

from sysmlc.ir import Graph, Kind, query
from sysmlc.logic.contract import Contract
from sysmlc.logic.requirements.statements import collect_statements, component_of, iter_statements

_NO_SUBJECT = "the requirement has no subject, and no element satisfies it"


class StatedRequirement(Struct, frozen=True):
    """A required constraint: its requirement, the component that has to satisfy it, its text.

    ``reason`` tells why the constraint is in no contract; it is empty if it is in one.
    """

    name: str
    """Qualified name of the requirement."""
    component: str
    constraint: str
    """Id of the constraint."""
    text: str
    reason: str = ""


def list_stated_requirements(
    graph: Graph, contracts: Iterable[Contract], reasons: Mapping[str, str]
) -> Iterator[StatedRequirement]:
    """Yield the required constraints of each subject, then those of requirements without subject.

    *reasons* are messages about constraints, by the id of the constraint.
    """
    origins = {
        conjunct.origin
        for contract in contracts
        for conjunct in (*contract.assumptions, *contract.guarantees)
    }
    listed: set[str] = set()
    for subject, statements in collect_statements(graph):
        for statement in statements:
            constraint = statement.constraint
            listed.add(constraint.id)
            if statement.is_assumed:
                continue
            reason = reasons.get(constraint.id, "the contract of its subject cannot express it")
            yield StatedRequirement(
                graph.qualified_name(statement.requirement),
                component_of(graph, subject),
                constraint.id,
                str(constraint.attrs["body"]).strip(),
                "" if constraint.id in origins else reason,
            )
    for requirement in filter(query.is_requirement, graph.of_kind(Kind.CLASS)):
        for statement in iter_statements(graph, requirement):
            if statement.constraint.id not in listed and not statement.is_assumed:
                listed.add(statement.constraint.id)
                yield StatedRequirement(
                    graph.qualified_name(requirement),
                    "",
                    statement.constraint.id,
                    str(statement.constraint.attrs["body"]).strip(),
                    _NO_SUBJECT,
                )
