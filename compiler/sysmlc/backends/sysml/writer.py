"""State shared by the functions that write members, and the order of members."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from sysmlc.backends.sysml.plan import Member, Plan
from sysmlc.backends.sysml.printing import Line
from sysmlc.backends.sysml.references import (
    format_chain,
    format_element_reference,
    format_library_name,
    format_qualified_name,
    format_redefined_name,
    is_path_accessible,
)
from sysmlc.backends.sysml.rules import APPROXIMATED, UNREACHABLE, Losses
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.query import path_to_port

WriteMember = Callable[["Writer", Member], list[Line]]
"""Return the lines of a member: its own, and those that follow it in its namespace."""

_IMPORTS, _COMMENTS, _OTHER_MEMBERS = range(3)
_BEHAVIOUR_ORDER = {
    Kind.IMPORT: 0,
    Kind.COMMENT: 1,
    Kind.PARAMETER: 2,
    Kind.ACTIVITY_PARAMETER: 2,
    Kind.PIN: 2,
    Kind.PROPERTY: 3,
    Kind.OBJECT_NODE: 4,
    Kind.DATA_STORE: 4,
    Kind.OBJECT_FLOW: 7,
}
_INITIAL_NODE = 5
_STEP = 6


@dataclass(slots=True)
class Writer:
    """A text in the making: its plan, its losses, and the elements expressed so far."""

    graph: Graph
    plan: Plan
    losses: Losses
    writers: dict[str, WriteMember] = field(default_factory=dict)
    """Function that writes a member, by the kind of its element."""
    expressed: set[str] = field(default_factory=set)
    """Ids of elements that the text expresses."""
    dropped: dict[str, str] = field(default_factory=dict)
    """The edge without a name in the text, by the id of the element that was dropped for it."""
    collection_loops: set[str] = field(default_factory=set)
    """Ids of expansion regions that are written as loops over a collection."""
    stored_attributes: set[tuple[str, str]] = field(default_factory=set)
    """Id of an element and key of an attribute for each attribute that metadata preserves."""
    stored_edges: set[tuple[Edge, str, str]] = field(default_factory=set)
    """Edges that metadata preserves, with the ids of both ends."""
    public_ids: frozenset[str] = frozenset()
    """Ids of elements that are written as public because the text refers to them."""
    caex_files: frozenset[str] = frozenset()
    """Files in AutomationML: metadata preserves the ids of their elements."""
    condition_names: dict[tuple[Member, str, str], str] = field(default_factory=dict)
    """Names of attributes that stand for texts, by namespace, text and type."""
    insertions: dict[Element, list[Line]] = field(default_factory=dict)
    """Elements in authors' texts with the lines of the members that passes added to them."""
    uses_library: bool = False
    """Whether the text refers to the library ``SysMLC``, so that it is written, too."""

    # -- references ------------------------------------------------------------------------------

    def refer_to(
        self, scope: Member | None, holder: Element, edge: Edge, target: Element
    ) -> str | None:
        """Return the text that names *target* in *scope*; None, with a loss, if none does."""
        text = format_element_reference(self.plan, scope, target)
        if text is None:
            self.record_unreachable(holder, str(edge.value))
        return text

    def refer_to_feature(
        self, scope: Member | None, holder: Element, edge: Edge, feature: Element
    ) -> str | None:
        """Return the text that names a feature; None, with a loss, if no type around has it."""
        member = self.plan.find(feature)
        is_usage = member is not None and member.shape.is_usage
        if member is not None and is_usage and not is_path_accessible(self.plan, scope, member):
            self.record_unreachable(holder, str(edge.value))
            return None
        return self.refer_to(scope, holder, edge, feature)

    def refer_to_port(self, scope: Member | None, holder: Element) -> str:
        """Return the text that names the port of a trigger or action by the path to it.

        The text is empty if there is no port, or, with a loss, if no text names it.
        """
        if "port_path" in holder.attrs:
            return str(holder.attrs["port_path"])
        path = path_to_port(self.graph, holder)
        name = self.refer_to_feature(scope, holder, Edge.ROLE, path[0]) if path else None
        if name is not None and len(path) > 1:
            name = format_chain(self.plan, scope, path)
            if name is None:
                self.record_unreachable(holder, str(Edge.PATH.value))
        return name or ""

    def refer_to_targets(self, scope: Member | None, holder: Element, edge: Edge) -> list[str]:
        """Return the qualified names of the targets of all edges of a kind."""
        return self.refer_to_all(scope, holder, edge, self.graph.targets(holder, edge))

    def refer_to_all(
        self, scope: Member | None, holder: Element, edge: Edge, targets: Sequence[Element]
    ) -> list[str]:
        """Return the qualified names of some targets of the edges of a kind."""
        names = []
        for target in targets:
            member = self.plan.find(target)
            name = None if member is None else format_qualified_name(self.plan, scope, member)
            if name is None:
                self.record_unreachable(holder, str(edge.value))
            else:
                names.append(name)
        return names

    def refer_to_redefined(self, scope: Member | None, target: Element) -> str | None:
        """Return the name of a feature that a member of *scope* redefines."""
        member = self.plan.find(target)
        return None if member is None else format_redefined_name(self.plan, scope, member)

    def refer_to_library(self, scope: Member | None, name: str) -> str:
        """Return the text that names an element of the standard library or of ``SysMLC``."""
        self.uses_library = self.uses_library or name.startswith("SysMLC::")
        return format_library_name(self.plan, scope, name)

    def refer_to_sysmlc(self, scope: Member | None, name: str) -> str:
        """Return the text that names an element of the library ``SysMLC``."""
        return self.refer_to_library(scope, f"SysMLC::{name}")

    # -- losses ----------------------------------------------------------------------------------

    def record_unreachable(self, holder: Element, edge: str) -> None:
        """Record the loss of a reference whose target has no name in the text."""
        self.losses.record(UNREACHABLE, holder, edge=edge, kind=str(holder.kind))

    def record_approximation(self, element: Element, construct: str, replacement: str) -> None:
        """Record that the text replaces a construct of the model by a similar one of SysML v2."""
        self.losses.record(APPROXIMATED, element, construct=construct, replacement=replacement)

    def drop(self, member: Member, edge: str) -> list[Line]:
        """Omit a member because the text cannot name the targets of *edge*. Return no lines.

        Other members may refer to it: ``document`` writes the text again without the member.
        """
        if member.element is not None:
            self.dropped[member.element.id] = edge
        return []

    # -- lines -----------------------------------------------------------------------------------

    def write_members(self, namespace: Member) -> list[Line]:
        """Return the lines of all members of a namespace: those of the model, then added ones."""
        members = _order_members(self.graph, namespace)
        lines = [line for member in members for line in self.write_member(member)]
        return lines + namespace.take_added_lines()

    def write_member(self, member: Member) -> list[Line]:
        """Return the lines of one member; none if another line declares it."""
        if member.is_declared:
            return []
        if member.element is None:
            return self.writers[""](self, member)
        write = self.writers.get(str(member.element.kind))
        if write is None:
            return []
        self.expressed.add(member.element.id)
        return write(self, member)


# -- the order of members ------------------------------------------------------------------------


def _order_members(graph: Graph, namespace: Member) -> list[Member]:
    """Return the members in the order of the text.

    Imports and comments stand first. The members of a behaviour follow one another as they run;
    all others keep the order of the model.
    """
    keyword = namespace.shape.usage_keyword
    if keyword == "state":
        return _order_states(graph, sorted(namespace.members, key=_rank_member))
    if keyword in ("action", "verification"):
        return sorted(namespace.members, key=_rank_action_member)
    return sorted(namespace.members, key=_rank_member)


def _rank_member(member: Member) -> int:
    kind = None if member.element is None else member.element.kind
    if kind is Kind.IMPORT:
        return _IMPORTS
    return _COMMENTS if kind is Kind.COMMENT else _OTHER_MEMBERS


def _rank_action_member(member: Member) -> int:
    if member.shape.keyword == "start":
        return _INITIAL_NODE
    return _STEP if member.element is None else _BEHAVIOUR_ORDER.get(member.element.kind, _STEP)


def _order_states(graph: Graph, members: list[Member]) -> list[Member]:
    """Move each transition behind its source, and initial transitions before the first state."""
    ids = {member.element.id for member in members if member.element is not None}
    by_source: dict[str, list[Member]] = {}
    initial: list[Member] = []
    rest: list[Member] = []
    for member in members:
        if member.element is None or member.element.kind is not Kind.TRANSITION:
            rest.append(member)
            continue
        source = graph.target(member.element, Edge.FLOW_SOURCE)
        if source is not None and source.id in ids:
            by_source.setdefault(source.id, []).append(member)
        else:
            (initial if _is_initial(source) else rest).append(member)
    states = (n for n, member in enumerate(rest) if member.shape.keyword == "state")
    first_state = next(states, len(rest))
    ordered: list[Member] = []
    for member in (*rest[:first_state], *initial, *rest[first_state:]):
        ordered.append(member)
        if member.element is not None:
            ordered += by_source.get(member.element.id, ())
    return ordered


def _is_initial(source: Element | None) -> bool:
    return source is not None and source.kind is Kind.PSEUDOSTATE and source.subkind == "initial"
