"""Steps of a behaviour in the order of the text, and the control flows between them."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from sysmlc.frontends.sysml import annotations, nodes, values
from sysmlc.ir import Edge, Element, Kind
from sysmlc.language.metaclasses import is_a
from sysmlc.language.tree import Node, Reference

if TYPE_CHECKING:
    from sysmlc.frontends.sysml.lowering import Lowering

_SUCCESSIONS = frozenset({"SuccessionAsUsage", "Succession"})
_NAMES = """
    ActionUsage PerformActionUsage SendActionUsage AcceptActionUsage AssignmentActionUsage
    IfActionUsage WhileLoopActionUsage ForLoopActionUsage TerminateActionUsage DecisionNode
    MergeNode ForkNode JoinNode CalculationUsage StateUsage ExhibitStateUsage Step Expression
    VerificationCaseUsage AnalysisCaseUsage CaseUsage UseCaseUsage IncludeUseCaseUsage
    ConstraintUsage AssertConstraintUsage EventOccurrenceUsage ItemUsage
"""
_STEPS = frozenset(_NAMES.split())
"""Members at which the next succession without a source may start."""


@dataclass(slots=True)
class _Run:
    """Where the reading of a body is."""

    owner: Element
    ends: list[Element] | None = None
    """Entry and exit, where the steps are those of a block within the behaviour."""
    previous: "Node | Reference | None" = None
    waiting: "list[tuple[Node | Reference | None, Node, str]]" = field(default_factory=list)
    """Successions whose target is the next step: source, node, guard."""


def steps(
    low: "Lowering", found: Iterable[Node], owner: Element, ends: list[Element] | None = None
) -> None:
    """Lower the members of a behaviour with the successions between them.

    Steps of a block that stand in the behaviour around it have the ``ends`` of the block as
    ``start`` and ``done``; they may be added to the list afterwards.
    """
    run = _Run(owner, ends)
    for node in found:
        if node.kind in _SUCCESSIONS:
            _succession(low, node, run)
        elif node.kind == "TransitionUsage":
            _guarded(low, node, run)
        elif node.kind == "Membership" and not node.name and not node.short_name:
            run.previous = nodes.reference(node, "Membership")
            _mention(low, run, run.previous, node)
        else:
            low.lower(node, owner)
            if node.kind in _STEPS and "direction" not in node.attributes:
                _arrive(low, node, run)
            elif run.waiting:
                # A `then` stands before its target, which is no step of the graph.
                low.unsupported(run.waiting.pop()[1])


def _arrive(low: "Lowering", node: Node, run: _Run) -> None:
    for source, flow, _ in run.waiting:
        _flow(low, run, flow, source, node, None)
    run.waiting.clear()
    run.previous = node


def _succession(low: "Lowering", node: Node, run: _Run) -> None:
    """A succession; ends that are not stated are the steps before and behind it."""
    ends = nodes.ends_of(node)
    if len(ends) < 2:
        run.waiting.append((run.previous, node, ""))
        return
    source, target = (_end(end) for end in ends[:2])
    if target is None:
        run.waiting.append((source or run.previous, node, ""))
    else:
        _flow(low, run, node, source or run.previous, target, None)


def _end(end: Node) -> Reference | None:
    return nodes.reference(end, "ReferenceSubsetting", "Subsetting")


def _guarded(low: "Lowering", node: Node, run: _Run) -> None:
    """A succession with a guard, or the one for else."""
    source = nodes.reference(node, "Membership") or run.previous
    inner = next(nodes.members(node, *_SUCCESSIONS), None)
    ends = [] if inner is None else nodes.ends_of(inner)
    target = _end(ends[-1]) if ends else None
    guard = guard_of(node)
    if target is not None:
        _flow(low, run, node, source, target, guard or node)


def guard_of(node: Node) -> Node | None:
    """The condition of a transition."""
    found = [one for one in node.members if one.role == "guard"]
    return found[0] if found else None


def _flow(
    low: "Lowering",
    run: _Run,
    node: Node,
    source: "Node | Reference | None",
    target: "Node | Reference",
    guard: Node | None,
) -> None:
    """A control flow; without a guard of its own a guarded succession is the one for else."""
    if _is_elsewhere(low, source) or _is_elsewhere(low, target):
        low.unsupported(node)
        return
    _mention(low, run, source, node)
    _mention(low, run, target, node)
    is_objects = "ObjectFlow" in annotations.ours(node)
    kind = Kind.OBJECT_FLOW if is_objects else Kind.CONTROL_FLOW
    made = low.add(node, kind, node.name or "", run.owner)
    if guard is node:
        low.set(made, guard="else")
    elif guard is not None:
        low.later(lambda: values.say(low, made, "guard", guard))
    low.lower_texts(node, made)
    low.last(lambda: _join(low, made, (source, target), run))
    if is_objects:
        low.last(lambda: _flow_between_pins(low, node, made))
    if guard is not None:
        low.last(lambda: low.last(lambda: _meet(low, low.graph.target(made, Edge.FLOW_TARGET))))


def _flow_between_pins(low: "Lowering", node: Node, made: Element) -> None:
    """Let an object flow begin and end at pins of the steps that the succession names."""
    for key, edge in (("source", Edge.FLOW_SOURCE), ("target", Edge.FLOW_TARGET)):
        step, name = low.graph.target(made, edge), annotations.said(node, "ObjectFlow", key)
        inside = [] if step is None or not name else low.graph.owned(step)
        pin = next((one for one in inside if one.kind is Kind.PIN and one.name == name), None)
        if step is not None and pin is not None:
            low.graph.disconnect(edge, made, step)
            low.graph.connect(edge, made, pin)


def _meet(low: "Lowering", step: Element | None) -> None:
    """A merge before a step that more than one succession leads to, one of them guarded.

    A guarded succession that is not taken is none (SysML 2.0, 8.4.13.5); the step waits for those
    that are. A step of UML would wait for all (UML 2.5.1, 15.2.3.4).
    """
    if step is None or step.kind not in (Kind.ACTION, Kind.STRUCTURED):
        return
    ways = [
        one for one in low.graph.sources(step, Edge.FLOW_TARGET) if one.kind is Kind.CONTROL_FLOW
    ]
    if len(ways) < 2:
        return
    merge = low.beside(step, Kind.CONTROL, "")
    low.set(merge, subkind="merge")
    for one in ways:
        low.graph.disconnect(Edge.FLOW_TARGET, one, step)
        low.graph.connect(Edge.FLOW_TARGET, one, merge)
    flow = low.beside(step, Kind.CONTROL_FLOW, "")
    low.graph.connect(Edge.FLOW_SOURCE, flow, merge)
    low.graph.connect(Edge.FLOW_TARGET, flow, step)


def _is_elsewhere(low: "Lowering", point: "Node | Reference | None") -> bool:
    """Whether an end is an action of a package, which is no step of any behaviour."""
    if not isinstance(point, Reference) or len(point.chain) > 1 or (target := point.target) is None:
        return False
    owner = target.owner
    is_package = owner is not None and (owner.kind == "Namespace" or is_a(owner.kind, "Package"))
    return is_package and not is_of_library(low, point)


def _mention(low: "Lowering", run: _Run, point: "Node | Reference | None", node: Node) -> None:
    """Make the start or the end of a behaviour where the text first names it."""
    if run.ends is None and isinstance(point, Reference) and _is_own_end(low, point):
        low.control(run.owner, nodes.last_name(point), node)


def _is_own_end(low: "Lowering", point: Reference) -> bool:
    return len(point.chain) == 1 and is_of_library(low, point)


def is_of_library(low: "Lowering", point: Reference) -> bool:
    """Whether an end is the start or the end that every behaviour has."""
    if nodes.last_name(point) not in ("start", "done"):
        return False
    target = point.target
    return target is None or low.document(target) is None


def _join(
    low: "Lowering",
    made: Element,
    points: "tuple[Node | Reference | None, Node | Reference]",
    run: _Run,
) -> None:
    ends = run.ends
    for edge, point in zip((Edge.FLOW_SOURCE, Edge.FLOW_TARGET), points, strict=True):
        if ends and isinstance(point, Reference) and _is_own_end(low, point):
            found: Element | None = ends[nodes.last_name(point) == "done"]
        else:
            found = vertex(low, run.owner, point, is_target=edge is Edge.FLOW_TARGET)
        if found is None:
            low.lead(edge, made, None)
        else:
            low.graph.connect(edge, made, found)


def vertex(
    low: "Lowering", owner: Element, point: "Node | Reference | None", *, is_target: bool
) -> Element | None:
    """The node of the activity that an end of a succession means."""
    if point is None:
        return None
    if isinstance(point, Node):
        return low.point(point, is_target=is_target)
    if is_of_library(low, point):
        before = (point.targets or [])[:-1]
        holder = low.element(before[-1]) if before and len(point.chain) > 1 else owner
        return None if holder is None else low.control(holder, nodes.last_name(point))
    target = point.target
    return None if target is None else low.point(target, is_target=is_target)
