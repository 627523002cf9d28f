"""Performances: the token games of activities, each call expanded to a copy of what it calls.

The performance of an activity is a structured node that others start and stop: the state whose do
behaviour it is, the object whose own behaviour it is, or the environment. A call action is a
structured node too, with a copy of the token game of the called activity as its content (fUML
creates an execution for each call). All performances of a component are one token graph.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.logic import formula as f
from sysmlc.logic.activities.action_names import ActionPath, list_enclosing_actions, make_path
from sysmlc.logic.activities.token_graph import TokenGraph
from sysmlc.logic.activities.token_nodes import (
    ACTIVITY_REGION,
    Duration,
    Guard,
    Interruptible,
    NodeKind,
    Store,
    TokenEdge,
    TokenNode,
    Write,
)
from sysmlc.logic.components.machines import PlacedMachine
from sysmlc.logic.components.objects import (
    ComponentError,
    ComponentObject,
    ObjectTree,
    Slot,
    is_value,
)
from sysmlc.logic.composition.structure import find_drawn_activity
from sysmlc.logic.contract import BooleanDomain, Owner, Variable
from sysmlc.logic.formula import Formula, rename_variables
from sysmlc.logic.identifiers import identifier
from sysmlc.logic.machines.machine import Vertex

COPY_SEPARATOR = "\x1e"
"""Separates the id of a copy from the id of an element in it."""


class Caller(Struct, frozen=True):
    """Where an activity is performed: the object, the call action if any, and the names so far."""

    owner: ComponentObject
    names: tuple[str, ...]
    prefix: str = ""
    """Prefix of the variables; empty for the behaviour whose contract the component has."""
    call: Element | None = None
    parent: "Copy | None" = None


@dataclass(slots=True)
class Copy:
    """One copy of an activity in the token graph: its root node, and its names for variables."""

    id: str
    activity: Element
    caller: Caller
    variables: dict[str, str] = field(default_factory=dict)
    """Variables of the component by the names in the activity's own token graph."""
    parameters: dict[str, Variable] = field(default_factory=dict)
    """Variables of the parameters by name."""

    @property
    def root(self) -> str:
        """The node of the performance that contains the copy."""
        return COPY_SEPARATOR.join(self.id.split(COPY_SEPARATOR)[:2])

    def rename_guard(self, guard: Guard | None) -> Guard | None:
        """Return a guard of the activity in the variables of the component."""
        if guard is None or guard.condition is None:
            return guard
        return replace(guard, condition=rename_variables(guard.condition, self.variables))

    def rename_write(self, write: Write, ids: Mapping[str, str]) -> Write:
        """Return a write of the activity in the variables of the component.

        *ids* are the nodes of the copy by those of the activity.
        """
        values = tuple(
            (rename_variables(condition, self.variables), rename_variables(value, self.variables))
            for condition, value in write.values
        )
        return replace(write, node=ids[write.node], values=values)


class PlacedWrite(Struct, frozen=True):
    """A write of a slot by a node of a performance; ``root`` is the id of the performance."""

    slot: Slot
    node: str
    values: tuple[tuple[Formula, Formula], ...]
    origin: str
    root: str


@dataclass(slots=True)
class Root:
    """A performance: its node, when it starts and stops, and whether it runs in the first step."""

    id: str
    start: Formula
    stop: Formula
    first: Formula
    machine: PlacedMachine | None = None
    state: Vertex | None = None
    """The state whose entry, do or exit behaviour it is."""
    after: str = ""
    """The entry behaviour after which it starts, if that takes time."""
    service: str = ""
    """The input with which the environment starts it."""
    role: Edge = Edge.DO
    """Whether it is the entry, do or exit behaviour of its state."""
    over: str = ""
    """The variable that its state uses to remember its end."""


def element_of_copy(node: str) -> str:
    """Return the id of the element of which a node of the token graph is a copy."""
    return node.rpartition(COPY_SEPARATOR)[2]


_UNKNOWN_END = "the check does not know when {} ends, which has steps of its own"


class Performances:
    """Collects the performances of a component as one token graph."""

    def __init__(self, tree: ObjectTree) -> None:
        self._tree = tree
        self._graph: Graph = tree.graph
        self._tokens = {tokens.activity: tokens for tokens in self._graph.derived(TokenGraph)}
        self.nodes: list[TokenNode] = []
        self.edges: list[TokenEdge] = []
        self.interruptibles: list[Interruptible] = []
        self.named_conditions: list[tuple[str, str]] = []
        self.rests: set[str] = set()
        self.inputs: dict[str, Variable] = {}
        self.locals: list[tuple[Store, str]] = []
        """Variables of activities, each with the id of the node that starts them."""
        self.writes: list[PlacedWrite] = []
        self.paths: list[ActionPath] = []
        self.copies: dict[str, Copy] = {}
        self.performed: set[tuple[str, str]] = set()
        """The activities that something in the component performs: paths of objects, and ids."""
        self.aliases: dict[str, str] = {}
        """Nodes by the inputs that would end them if nothing in the model did."""
        self.gaps: dict[str, str] = {}
        self.undescribed: dict[str, str] = {}
        """Why the steps of an action are not described, by the variables of its run and end."""

    def find_tokens(self, activity: Element) -> TokenGraph | None:
        """Return the token game of an activity, its own or that of the activity it is drawn as."""
        own = self._tokens.get(activity.id)
        return own or self._tokens.get(find_drawn_activity(self._graph, activity).id)

    def add(self, activity: Element, caller: Caller, run: str) -> str:
        """Add the performance of an activity and return the id of its node.

        *run* is the variable that is true while the performance runs. The environment ends an
        activity without steps. What has steps, but no token graph, is not described.
        """
        id = self._new_id(activity.id)
        tokens = self.find_tokens(activity)
        label, name = f"action '{activity.name}'", caller.names[-1] if caller.names else ""
        done = None
        kind = NodeKind.ACTION if tokens is None else NodeKind.STRUCTURED
        if tokens is None:
            end = self.name_variable(f"done_{name or 'do'}", caller.prefix)
            self.inputs[end] = Variable(end, Owner.ENVIRONMENT, BooleanDomain(), activity.id)
            done = f.var(end)
            if self.has_steps(activity):
                self.undescribed[run] = self.undescribed[end] = _UNKNOWN_END.format(label)
        self.nodes.append(TokenNode(id, kind, label, activity.id, run=run, done=done))
        self.paths.append(make_path(caller.names, id))
        if tokens is not None:
            self._expand(tokens, activity, caller, id, (activity.id,))
        return id

    def build(
        self, component: str, origin: str, decided: Iterable[Variable], given: Iterable[Variable]
    ) -> TokenGraph:
        """Return the token graph.

        The component decides the features in *decided*, and the environment those in *given*.
        """
        return TokenGraph(
            activity=origin,
            component=component,
            label="the component",
            nodes=tuple(self.nodes),
            edges=tuple(self.edges),
            inputs=(*self.inputs.values(), *given),
            interruptibles=tuple(self.interruptibles),
            rests=frozenset(self.rests),
            named_conditions=tuple(self.named_conditions),
            stores=(
                *(Store(variable, ()) for variable in decided),
                *(store for store, _ in self.locals),
            ),
        )

    # -- names -------------------------------------------------------------------------------------

    def _new_id(self, id: str) -> str:
        return f"{len(self.copies)}.{len(self.nodes)}{COPY_SEPARATOR}{id}"

    def name_variable(self, name: str, prefix: str) -> str:
        """Return a new name for a variable of a behaviour."""
        return self._tree.names.new(f"{prefix}_{name}" if prefix else name)

    # -- copies ------------------------------------------------------------------------------------

    def _expand(
        self,
        tokens: TokenGraph,
        activity: Element,
        caller: Caller,
        root: str,
        around: tuple[str, ...],
    ) -> None:
        copy = Copy(root, activity, caller)
        self.copies[root] = copy
        drawn = find_drawn_activity(self._graph, activity)
        self.performed |= {(caller.owner.path, activity.id), (caller.owner.path, drawn.id)}
        ids = {node.id: f"{root}{COPY_SEPARATOR}{node.id}" for node in tokens.nodes}
        regions = {**ids, ACTIVITY_REGION: root}
        self._name_variables(tokens, copy)
        for node in tokens.nodes:
            self._add_node(node, ids, regions, copy, around)
        rests = tokens.regions() if tokens.rests is None else tokens.rests
        self.rests.update(regions[region] for region in rests)
        for edge in tokens.edges:
            self.edges.append(
                replace(
                    edge,
                    id=f"{root}{COPY_SEPARATOR}{edge.id}",
                    variable=copy.variables[edge.variable],
                    source=ids[edge.source],
                    target=ids[edge.target],
                    region=regions[edge.region],
                    guard=copy.rename_guard(edge.guard),
                    interrupts=f"{root}{COPY_SEPARATOR}{edge.interrupts}" * bool(edge.interrupts),
                    listens=f"{root}{COPY_SEPARATOR}{edge.listens}" * bool(edge.listens),
                )
            )
        for group in tokens.interruptibles:
            self.interruptibles.append(
                replace(
                    group,
                    id=f"{root}{COPY_SEPARATOR}{group.id}",
                    nodes=tuple(ids[node] for node in group.nodes),
                )
            )
        self.named_conditions += [
            (regions.get(id, f"{root}{COPY_SEPARATOR}{id}"), copy.variables[name])
            for id, name in tokens.named_conditions
        ]
        for store in (*tokens.stores, *tokens.shared):
            self._add_store(store, copy, ids)

    def _name_variables(self, tokens: TokenGraph, copy: Copy) -> None:
        prefix, variables = copy.caller.prefix, copy.variables
        for name in (
            *(node.run for node in tokens.workers()),
            *(edge.variable for edge in tokens.edges),
            *(name for _, name in tokens.named_conditions),
        ):
            variables[name] = self.name_variable(name, prefix)
        stored = (store.variable for store in (*tokens.stores, *tokens.shared))
        for variable in (*stored, *tokens.inputs, *tokens.shared_inputs):
            if variable.name not in variables:
                variables[variable.name] = self._find_variable(variable, tokens, copy)

    def _find_variable(self, variable: Variable, tokens: TokenGraph, copy: Copy) -> str:
        """Return the variable of the component for an input or a written variable of an activity.

        A feature has the variable of the object to which it belongs.
        """
        element = self._graph.get(variable.origin)
        is_own = element is not None and copy.activity in self._graph.ancestors(element)
        if element is not None and is_value(element) and variable.name not in tokens.pulses:
            slot = self.find_slot(copy, element, variable.name)
            if slot is not None:
                shared = self._tree.read_slot(slot).variable
                if shared.domain == variable.domain:
                    return shared.name
                reason = f"'{variable.name}' has other values in '{copy.activity.name}'"
                self.gaps[shared.name] = reason
            elif not is_own and self._is_of_object(element):
                self.gaps[variable.name] = f"the owner of '{variable.name}' is unknown"
        name = self.name_variable(variable.name, copy.caller.prefix)
        path = "" if element is None else self._tree.find_unread_name(copy.activity, element)
        if path and variable.name not in tokens.pulses:
            self.gaps[name] = f"the owner of '{path}' is unknown"
        self.inputs[name] = replace(variable, name=name, owner=Owner.ENVIRONMENT)
        if is_own and element is not None and is_value(element):
            copy.parameters[element.name] = self.inputs[name]
        return name

    def find_slot(self, copy: Copy, element: Element, variable: str) -> Slot | None:
        """Return the feature of an object that an activity names, or None for its own attribute.

        An activity that is itself the component is an object, too.
        """
        drawn = find_drawn_activity(self._graph, copy.activity)
        return self._tree.find_slot(copy.caller.owner, element, variable, drawn)

    def _is_of_object(self, feature: Element) -> bool:
        """Whether an object has the feature, and not what an event or a flow brings."""
        owner = self._graph.owner(feature)
        return owner is not None and owner.kind in (Kind.CLASS, Kind.COMPONENT)

    def _add_store(self, store: Store, copy: Copy, ids: Mapping[str, str]) -> None:
        name = copy.variables[store.variable.name]
        element = self._graph.get(store.variable.origin)
        slot: Slot | None = None
        if element is not None:
            slot = self.find_slot(copy, element, store.variable.name)
        if store.follows is not None:
            variable = replace(self.inputs.pop(name), owner=Owner.SYSTEM)
            follows = rename_variables(store.follows, copy.variables)
            self.locals.append((replace(store, variable=variable, follows=follows), copy.id))
            return
        writes = [copy.rename_write(write, ids) for write in store.writes]
        if slot is not None and self._tree.read_slot(slot).variable.name == name:
            for write in writes:
                origin = element_of_copy(write.node)
                self.writes.append(PlacedWrite(slot, write.node, write.values, origin, copy.root))
        elif slot is None and name in self.inputs:
            variable = replace(self.inputs.pop(name), owner=Owner.SYSTEM)
            if element is not None:
                copy.parameters[element.name] = variable
            self.locals.append((Store(variable, tuple(writes), store.first, local=True), copy.id))

    # -- nodes -------------------------------------------------------------------------------------

    def _add_node(
        self,
        node: TokenNode,
        ids: Mapping[str, str],
        regions: Mapping[str, str],
        copy: Copy,
        around: tuple[str, ...],
    ) -> None:
        element = self._graph[node.origin]
        run = copy.variables[node.run] if node.run else ""
        done = None if node.done is None else f.rename_variables(node.done, copy.variables)
        new = replace(node, id=ids[node.id], region=regions[node.region], run=run, done=done)
        is_work = node.kind is NodeKind.ACTION and bool(node.run)
        names = (*copy.caller.names, *list_enclosing_actions(self._graph, element), element.name)
        if run and element.name:
            self.paths.append(make_path(names, new.id))
        if is_work and self._graph.targets(element, Edge.CALLS) and _is_call(element):
            new = self._add_call(new, element, copy, names, around)
        self.nodes.append(new)

    def _add_call(
        self,
        node: TokenNode,
        element: Element,
        copy: Copy,
        names: tuple[str, ...],
        around: tuple[str, ...],
    ) -> TokenNode:
        """Return the node of a call, with a copy of what it calls as its content if possible."""
        called = self._graph.targets(element, Edge.CALLS)
        activity = called[0] if len(called) == 1 else None
        tokens = None if activity is None else self.find_tokens(activity)
        has_steps = any(self.has_steps(behaviour) for behaviour in called)
        owner = copy.caller.owner
        object_ = None if activity is None else self._tree.find_performer(owner, activity)
        reason = ""
        if node.duration is not Duration.TIMED:
            reason = f"'{node.label}' does not wait for its end"
        elif object_ is None and tokens is not None:
            reason = f"the part that performs the call of {node.label} is unknown"
        elif activity is None or tokens is None or object_ is None:
            reason = _UNKNOWN_END.format(node.label)
        elif activity.id in around:
            raise ComponentError(f"'{activity.name}' calls itself")
        if reason:
            if has_steps:
                ends = f.variable_names(node.done) if node.done is not None else ()
                self.undescribed |= dict.fromkeys((node.run, *ends), reason)
            return node
        assert activity is not None
        assert tokens is not None
        assert object_ is not None
        self._drop_end(node)
        if object_.path != owner.path:
            self.paths.append(make_path((*object_.path.split("."), activity.name), node.id))
        elif activity.name != element.name:
            self.paths.append(make_path((*names[:-1], activity.name), node.id))
        prefix = "_".join(
            filter(None, (copy.caller.prefix, identifier(element.name or activity.name)))
        )
        caller = Caller(object_, names, prefix, element, copy)
        self._expand(tokens, activity, caller, node.id, (*around, activity.id))
        return replace(node, kind=NodeKind.STRUCTURED, done=None)

    def _drop_end(self, node: TokenNode) -> None:
        """Remove the input that ends a node, unless something else reads it."""
        for variable in f.variables(node.done) if node.done is not None else ():
            if "done_" in variable.name and variable.name in self.inputs:
                del self.inputs[variable.name]
                self.aliases[variable.name] = node.id

    def has_steps(self, behaviour: Element) -> bool:
        """Whether an activity is drawn with actions."""
        drawn = find_drawn_activity(self._graph, behaviour)
        return any(element.kind is Kind.ACTION for element in self._graph.owned(drawn))


def _is_call(element: Element) -> bool:
    return element.subkind in ("call-behavior", "call-operation", "")
