"""Pass ``classify``: what each element is in SysML, and at which level of a recipe."""

from collections.abc import Iterator
from typing import ClassVar

from msgspec import Struct

from sysmlc.diagnostics import Sink
from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind
from sysmlc.ir.query import CLASSIFIERS, tag
from sysmlc.passes.classify.allocations import add_allocations
from sysmlc.passes.classify.bindings import add_bindings
from sysmlc.passes.classify.constraints import check_constraints
from sysmlc.passes.classify.lineage import (
    Ancestor,
    Profiles,
    known_meanings,
    look_alike,
    meanings,
)
from sysmlc.passes.classify.literals import check_literals
from sysmlc.passes.classify.relations import add_relations
from sysmlc.passes.classify.requirements import check_requirements, give_requirement
from sysmlc.passes.classify.roles import STRUCTURED, by_stereotype, by_structure
from sysmlc.passes.classify.rules import LOOK_ALIKE, OPTIONAL_WITH_VALUE, UNKNOWN_STEREOTYPE
from sysmlc.passes.classify.tags import HANDLERS, check_tags, give_tags, optional_with_value
from sysmlc.passes.classify.units import give_units
from sysmlc.passes.classify.vocabulary import LEVELS, Family, is_role_or_kept, mangled

_Meanings = dict[str, tuple[str, ...]]


class Classify(Struct, frozen=True):
    """Give every stereotype application its lineage and every element its role.

    Assumes resolved references. Guarantees: ``lineage`` on applications, and ``instance-of``
    when the stereotype is in the unit; ``role`` as docs/ir.md lists them (one that a front end
    gave stays unless a stereotype says otherwise); what the tags of SysML's stereotypes say, as
    attributes and edges; ``req_id`` and ``text`` of requirements; ``direction`` of flow
    properties; ``level`` on what a stereotype of the shipped profile, or a general classifier
    with a level, puts there; the edges that dependencies and bindings mean. The kind of an
    element never changes.
    """

    name: ClassVar[str] = "classify"
    after: ClassVar[tuple[str, ...]] = ("resolve", "inherit")

    def run(self, graph: Graph, sink: Sink) -> None:
        """Classify in place; see the class."""
        lineages = _lineages(graph)
        known = _meanings(graph, sink, lineages)
        _give_roles(graph, _by_subject(graph, known))
        give_tags(graph, known)
        give_units(graph, known)
        _check_optional(graph, sink, known)
        _give_levels(graph, lineages)
        _give_values(graph)
        check_literals(graph, sink)
        add_bindings(graph)
        add_allocations(graph)
        add_relations(graph, sink)
        check_tags(graph, sink)
        check_requirements(graph, sink)
        check_constraints(graph, sink)


# -- stereotypes -------------------------------------------------------------------------------


def _lineages(graph: Graph) -> dict[str, tuple[Ancestor, ...]]:
    profiles = Profiles(graph)
    found: dict[str, tuple[Ancestor, ...]] = {}
    for application in graph.of_kind(Kind.APPLICATION):
        stereotype = profiles.stereotype(application)
        if stereotype is not None:
            graph.connect(Edge.INSTANCE_OF, application, stereotype)
        found[application.id] = profiles.lineage(application)
        names = dict.fromkeys(one.name for one in found[application.id])
        graph.set(application, lineage=tuple(names))
    return found


def _meanings(graph: Graph, sink: Sink, lineages: dict[str, tuple[Ancestor, ...]]) -> _Meanings:
    """Names of SysML stereotypes that each application stands for, look-alikes included."""
    found: _Meanings = {}
    doubtful: dict[tuple[str, str], list[Element]] = {}
    for id, lineage in lineages.items():
        application = graph[id]
        alike = look_alike(lineage)
        found[id] = known_meanings(alike) if alike else meanings(lineage)
        if alike or _is_unknown(graph, application, lineage):
            doubtful.setdefault((_full_name(application), alike), []).append(application)
    for (name, alike), applications in doubtful.items():
        _report(graph, sink, name, alike, applications)
    return found


def _by_subject(graph: Graph, known: _Meanings) -> _Meanings:
    found: _Meanings = {}
    for id, names in known.items():
        for subject in graph.targets(graph[id], Edge.SUBJECT):
            found[subject.id] = (*found.get(subject.id, ()), *names)
    return found


def _check_optional(graph: Graph, sink: Sink, known: _Meanings) -> None:
    for parameter in optional_with_value(graph, known):
        name = graph.qualified_name(parameter)
        sink.report(OPTIONAL_WITH_VALUE, graph.subject(parameter), parameter=name)


def _is_unknown(graph: Graph, application: Element, lineage: tuple[Ancestor, ...]) -> bool:
    if graph.target(application, Edge.INSTANCE_OF) is not None:
        return False
    return all(one.family is Family.CUSTOM or _is_unheard(one) for one in lineage)


def _is_unheard(one: Ancestor) -> bool:
    """Whether its namespace is SysML's, which has no such stereotype."""
    name = mangled(one.name)
    return one.family is Family.SYSML and not (name in HANDLERS or is_role_or_kept(name))


def _full_name(application: Element) -> str:
    namespace = application.attrs.get("namespace", "")
    return f"{application.attrs.get('stereotype', '')} ({namespace})"


def _report(graph: Graph, sink: Sink, name: str, alike: str, applications: list[Element]) -> None:
    bases = [one for app in applications for one in graph.targets(app, Edge.SUBJECT)]
    sink.report(
        LOOK_ALIKE if alike else UNKNOWN_STEREOTYPE,
        graph.subject(bases[0] if bases else applications[0]),
        stereotype=name,
        known=alike,
        count=len(applications),
    )


# -- roles and levels --------------------------------------------------------------------------


def _give_roles(graph: Graph, known: _Meanings) -> None:
    for id, names in known.items():
        role = by_stereotype(graph[id], names)
        if role:
            graph.set(graph[id], role=role)
    # Most elements of a large model are of behaviour, to which structure gives no role.
    for element in graph.of_kind(*STRUCTURED):
        if not element.role:
            graph.set(element, role=by_structure(graph, element) or None)


def _give_levels(graph: Graph, lineages: dict[str, tuple[Ancestor, ...]]) -> None:
    found: dict[str, set[str]] = {}
    for id, lineage in lineages.items():
        for subject in graph.targets(graph[id], Edge.SUBJECT):
            found.setdefault(subject.id, set()).update(_levels(lineage))
    for id, levels in found.items():
        # An OPC UA call is often said of a service too: the first of the table is the level.
        level = next((one for one in LEVELS.values() if one in levels), None)
        graph.set(graph[id], level=level or graph[id].attrs.get("level"))
    _inherit_levels(graph)


def _inherit_levels(graph: Graph) -> None:
    """Give classifiers without a level that of the nearest general one, layer by layer."""
    layer = [one for one in graph if "level" in one.attrs]
    while layer:
        below = (sub for one in layer for sub in graph.sources(one, Edge.SPECIALIZES))
        layer = [sub for sub in dict.fromkeys(below) if "level" not in sub.attrs]
        # A layer is looked at as a whole before it changes: the order must not matter.
        for sub, level in [(sub, _level_above(graph, sub)) for sub in layer]:
            graph.set(sub, level=level)


def _level_above(graph: Graph, classifier: Element) -> AttrValue:
    ups = graph.targets(classifier, Edge.SPECIALIZES)
    return next(up.attrs["level"] for up in ups if "level" in up.attrs)


def _levels(lineage: tuple[Ancestor, ...]) -> Iterator[str]:
    for one in lineage:
        if one.family is Family.SYSMLC and one.name in LEVELS:
            yield LEVELS[one.name]


def _give_values(graph: Graph) -> None:
    for element in graph.of_kind(*CLASSIFIERS, Kind.PACKAGE, Kind.OPERATION):
        if element.role == "requirement":
            give_requirement(graph, element)
    for element in graph.of_kind(Kind.PROPERTY, Kind.FLOW_PROPERTY):
        if element.role == "flow property":
            given = element.attrs.get("direction") or tag(graph, element, "direction")
            # SysML 1.6 clause 9.3.2.7: the default direction is inout.
            graph.set(element, direction=given or "inout")
