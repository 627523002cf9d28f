"""Behaviours as the check of requirements sees them: possible runs, and their gaps.

The contract of a behaviour describes one behaviour alone. Where the model says more about a
variable than the contract does, a run of the contract need not be a run of the model, so that it
refutes no requirement.
"""

from collections.abc import Iterable, Iterator, Mapping

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.logic import formula as f
from sysmlc.logic.activities.derivation import derive_contract
from sysmlc.logic.activities.token_graph import TokenGraph, TokenNode
from sysmlc.logic.contract import Class, Conjunct, Contract, Owner, Source, Variable
from sysmlc.logic.expressions.expression import last_name
from sysmlc.logic.feature_writes import WriterIndex, find_label, iter_writes


class CheckedBehaviour(Struct, frozen=True):
    """A behaviour to check requirements against.

    ``contract`` has the runs of the behaviour. ``repeated`` has those of an activity that starts
    again whenever it ends; None if that makes no difference. A variable in ``gaps`` is restricted
    by the model, but not by the contract; the value is the reason in words. Variables in ``ends``
    are gaps too: they tell when an action ends that may take as long as the environment wants.
    """

    contract: Contract
    repeated: Contract | None = None
    is_called: bool = False
    """Whether other behaviours, not the model itself, decide when the activity starts."""
    gaps: Mapping[str, str] = {}
    ends: frozenset[str] = frozenset()


def list_checked_behaviours(
    graph: Graph, contracts: Iterable[Contract]
) -> Iterator[CheckedBehaviour]:
    """Yield the behaviours of a model whose contracts are among *contracts*."""
    activities = {tokens.activity: tokens for tokens in graph.derived(TokenGraph)}
    writers = WriterIndex(graph)
    for contract in contracts:
        origin = graph.get(contract.origin)
        if origin is None or origin.kind not in query.BEHAVIORS:
            continue
        tokens = activities.get(origin.id)
        gaps = dict(_iter_gaps(graph, writers, origin, contract))
        if tokens is None:
            ends = list(_iter_do_ends(graph, contract))
            yield CheckedBehaviour(contract, gaps=gaps | _texts(ends), ends=_long_ends(ends))
        else:
            ends = list(_iter_call_ends(graph, tokens))
            yield CheckedBehaviour(
                _describe_performance(graph, tokens, contract, is_repeated=False),
                _describe_performance(graph, tokens, contract, is_repeated=True),
                is_called=not _is_own_behaviour(graph, origin),
                gaps=gaps | _texts(ends),
                ends=_long_ends(ends),
            )


def _is_own_behaviour(graph: Graph, activity: Element) -> bool:
    """Whether the activity starts when its owner is created, and only then."""
    owner = graph.owner(activity)
    return owner is not None and activity in graph.targets(owner, Edge.CLASSIFIER_BEHAVIOR)


def _describe_performance(
    graph: Graph, tokens: TokenGraph, contract: Contract, is_repeated: bool
) -> Contract:
    """Return the contract of an activity, performed once or repeatedly; writes take one step.

    The conjuncts of the author are those of *contract*.
    """
    drawn = derive_contract(tokens, is_repeated)
    derived = (
        replace(conjunct, source=Source.DERIVED)
        for conjunct in (*drawn.guarantees, *_iter_write_durations(graph, tokens))
    )
    stated = (conjunct for conjunct in contract.guarantees if not conjunct.is_derived)
    return replace(contract, guarantees=(*derived, *stated))


def _iter_write_durations(graph: Graph, tokens: TokenGraph) -> Iterator[Conjunct]:
    """Yield the fact that an assignment takes one step, for each action that only assigns."""
    for node in tokens.workers():
        if node.done is not None and any(iter_writes(graph, graph[node.origin])):
            ends_at_once = f.implies(f.var(node.run), node.done)
            if not tokens.is_decided_inside(node.done) and not _is_call(graph, node):
                yield Conjunct(ends_at_once, Class.SAFETY, node.origin)


def _is_call(graph: Graph, node: TokenNode) -> bool:
    return bool(graph.targets(graph[node.origin], Edge.CALLS))


# -- gaps ------------------------------------------------------------------------------------------


def _iter_gaps(
    graph: Graph, writers: WriterIndex, behaviour: Element, contract: Contract
) -> Iterator[tuple[str, str]]:
    """Yield the inputs of a behaviour that other behaviours of the model assign."""
    for variable in contract.variables:
        feature = graph.get(variable.origin)
        if variable.owner is Owner.ENVIRONMENT and feature is not None and _is_feature(feature):
            writer = writers.find_other_writer(feature, behaviour)
            if writer is not None:
                yield variable.name, describe_gap(variable, find_label(graph, writer))


def describe_gap(variable: Variable, writer: str) -> str:
    """Return the reason why the contract does not restrict a feature, in words."""
    return f"'{variable.name}' is assigned by '{writer}', which the check does not combine with it"


def _is_feature(element: Element) -> bool:
    return element.kind in (Kind.PROPERTY, Kind.PORT)


class _End(Struct, frozen=True):
    """A variable that tells when a behaviour with steps of its own ends."""

    variable: str
    label: str
    is_long: bool
    """Whether the behaviour may take as long as the environment wants."""


def _texts(ends: Iterable[_End]) -> dict[str, str]:
    return {
        end.variable: f"the check does not know when {end.label} ends, which has steps of its own"
        for end in ends
    }


def _long_ends(ends: Iterable[_End]) -> frozenset[str]:
    return frozenset(end.variable for end in ends if end.is_long)


def _iter_call_ends(graph: Graph, tokens: TokenGraph) -> Iterator[_End]:
    for node in tokens.workers():
        if node.done is not None and _is_call(graph, node):
            called = graph.targets(graph[node.origin], Edge.CALLS)
            is_long = any(_is_long(graph, behaviour) for behaviour in called)
            for variable in f.variables(node.done):
                yield _End(variable.name, node.label, is_long)


def _iter_do_ends(graph: Graph, contract: Contract) -> Iterator[_End]:
    for variable in contract.variables:
        state = graph.get(variable.origin)
        if variable.owner is Owner.ENVIRONMENT and state is not None and state.kind is Kind.STATE:
            for behaviour in graph.targets(state, Edge.DO):
                performed = [*_list_named_activities(graph, behaviour), behaviour]
                composite = [activity for activity in performed if _list_steps(graph, activity)]
                if composite:
                    label = f"'{composite[0].name or state.name}'"
                    is_long = any(_is_long(graph, activity) for activity in composite)
                    yield _End(variable.name, label, is_long)


def _list_named_activities(graph: Graph, behaviour: Element) -> list[Element]:
    """Return the activities that the body of a do behaviour may mean, and those that it calls."""
    name = last_name(str(behaviour.attrs.get("body", "")))
    named = [activity for activity in graph.of_kind(Kind.ACTIVITY) if name == activity.name]
    return [*named, *graph.targets(behaviour, Edge.CALLS)]


def _list_steps(graph: Graph, activity: Element) -> list[Element]:
    return [node for node in graph.owned(activity) if node.kind is Kind.ACTION]


def _is_long(graph: Graph, activity: Element) -> bool:
    """Whether the environment decides when an action of the activity ends."""
    return any(
        not graph.targets(action, Edge.CALLS) and not any(iter_writes(graph, action))
        for action in _list_steps(graph, activity)
    )
