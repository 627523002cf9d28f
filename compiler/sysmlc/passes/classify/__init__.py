"""Pass ``classify``: the role of each element in SysML, and its level in a recipe."""

from typing import ClassVar

from msgspec import Struct

from sysmlc.diagnostics import Severity, Sink, Subject, rule
from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind
from sysmlc.ir.query import CLASSIFIERS, tag
from sysmlc.passes.classify.constraints import add_bindings, check_constraints
from sysmlc.passes.classify.lineage import (
    Ancestor,
    Profiles,
    find_look_alike,
    find_meanings,
    meanings_of_sysml,
)
from sysmlc.passes.classify.requirements import check_requirements, complete_requirement
from sysmlc.passes.classify.roles import (
    STRUCTURED,
    add_allocations,
    add_relations,
    role_by_stereotype,
    role_by_structure,
)
from sysmlc.passes.classify.tags import (
    HANDLERS,
    apply_tags,
    check_literals,
    check_tags,
    find_optional_with_value,
)
from sysmlc.passes.classify.units import link_units
from sysmlc.passes.classify.vocabulary import LEVELS, Family, is_known, mangle
from sysmlc.support.counts import list_first

LOOK_ALIKE = rule(
    "SM210",
    "stereotype-by-name",
    Severity.INFO,
    "stereotype {stereotype} is treated as SysML's {known} because of its name (applied: {count})",
    help="give the profile as a further input, and let the stereotype specialise SysML's {known}",
)
UNKNOWN_STEREOTYPE = rule(
    "SM211",
    "unknown-stereotype",
    Severity.INFO,
    "no profile of the compile unit defines {stereotypes} (applied: {count})",
    help="give the file of the profile as a further input",
)
OPTIONAL_WITH_VALUE = rule(
    "SM216",
    "optional-with-value",
    Severity.WARNING,
    "parameter '{parameter}' is «optional», but its multiplicity asks for a value",
    help="give the parameter the multiplicity 0..1, or remove «optional»",
)

_MAX_LISTED = 8
_Meanings = dict[str, tuple[str, ...]]


class Classify(Struct, frozen=True):
    """Set the lineage of every stereotype application and the role of every element.

    Assumes resolved references. Guarantees:

    - ``lineage`` on applications, and ``instance-of`` if the stereotype is in the unit
    - ``role`` as in docs/ir.md; a role from a front end stays unless a stereotype states another
    - attributes and edges for the tags of SysML's stereotypes
    - ``req_id`` and ``text`` of requirements, and ``direction`` of flow properties
    - ``level`` on elements with a stereotype of the shipped profile or a general with a level
    - the edges that dependencies and bindings mean

    The kind of an element never changes.
    """

    name: ClassVar[str] = "classify"
    after: ClassVar[tuple[str, ...]] = ("resolve", "inherit")

    def run(self, graph: Graph, sink: Sink) -> None:
        """Classify in place; see the class."""
        lineages = _find_lineages(graph)
        meanings = _find_meanings(graph, sink, lineages)
        _give_roles(graph, _group_by_subject(graph, meanings))
        apply_tags(graph, meanings)
        link_units(graph, meanings)
        for parameter in find_optional_with_value(graph, meanings):
            name = graph.qualified_name(parameter)
            sink.report(OPTIONAL_WITH_VALUE, graph.subject(parameter), parameter=name)
        _give_levels(graph, lineages)
        _complete_attributes(graph)
        check_literals(graph, sink)
        # After the roles, which decide which connectors and dependencies mean edges.
        add_bindings(graph)
        add_allocations(graph)
        add_relations(graph, sink)
        check_tags(graph, sink)
        check_requirements(graph, sink)
        check_constraints(graph, sink)


# -- stereotypes -------------------------------------------------------------------------------


def _find_lineages(graph: Graph) -> dict[str, tuple[Ancestor, ...]]:
    profiles = Profiles(graph)
    lineages: dict[str, tuple[Ancestor, ...]] = {}
    for application in graph.of_kind(Kind.APPLICATION):
        stereotype = profiles.find_stereotype(application)
        if stereotype is not None:
            graph.connect(Edge.INSTANCE_OF, application, stereotype)
        lineages[application.id] = profiles.lineage(application)
        names = dict.fromkeys(ancestor.name for ancestor in lineages[application.id])
        graph.set(application, lineage=tuple(names))
    return lineages


def _find_meanings(
    graph: Graph, sink: Sink, lineages: dict[str, tuple[Ancestor, ...]]
) -> _Meanings:
    """Return the SysML stereotypes that each application means, and report doubtful applications.

    A custom stereotype may mean a SysML stereotype of the same name.
    """
    meanings: _Meanings = {}
    doubtful: dict[tuple[str, str], list[Element]] = {}
    for id, lineage in lineages.items():
        application = graph[id]
        similar = find_look_alike(lineage)
        meanings[id] = meanings_of_sysml(similar) if similar else find_meanings(lineage)
        if similar or _has_unknown_stereotype(graph, application, lineage):
            doubtful.setdefault((_full_name(application), similar), []).append(application)
    unknown: dict[str, list[Element]] = {}
    for (name, similar), applications in doubtful.items():
        if similar:
            subject, count = _find_subject(graph, applications), len(applications)
            sink.report(LOOK_ALIKE, subject, stereotype=name, known=similar, count=count)
        else:
            namespace = str(applications[0].attrs.get("namespace", ""))
            unknown.setdefault(namespace, []).extend(applications)
    # A missing profile is one fact, however many of its stereotypes the model applies.
    for namespace, applications in unknown.items():
        subject, count = _find_subject(graph, applications), len(applications)
        stereotypes = _list_stereotypes(namespace, applications)
        sink.report(UNKNOWN_STEREOTYPE, subject, stereotypes=stereotypes, count=count)
    return meanings


def _group_by_subject(graph: Graph, meanings: _Meanings) -> _Meanings:
    by_subject: _Meanings = {}
    for id, names in meanings.items():
        for subject in graph.targets(graph[id], Edge.SUBJECT):
            by_subject[subject.id] = (*by_subject.get(subject.id, ()), *names)
    return by_subject


def _has_unknown_stereotype(
    graph: Graph, application: Element, lineage: tuple[Ancestor, ...]
) -> bool:
    if graph.target(application, Edge.INSTANCE_OF) is not None:
        return False
    return all(
        ancestor.family is Family.CUSTOM or _is_missing_in_sysml(ancestor) for ancestor in lineage
    )


def _is_missing_in_sysml(ancestor: Ancestor) -> bool:
    """Whether the stereotype is in the namespace of SysML, but SysML does not define it."""
    name = mangle(ancestor.name)
    return ancestor.family is Family.SYSML and not (name in HANDLERS or is_known(name))


def _full_name(application: Element) -> str:
    namespace = application.attrs.get("namespace", "")
    return f"{application.attrs.get('stereotype', '')} ({namespace})"


def _list_stereotypes(namespace: str, applications: list[Element]) -> str:
    names = list(dict.fromkeys(str(a.attrs.get("stereotype", "")) for a in applications))
    noun = "stereotype" if len(names) == 1 else "the stereotypes"
    return f"{noun} {list_first(names, _MAX_LISTED)} ({namespace})"


def _find_subject(graph: Graph, applications: list[Element]) -> Subject:
    """Return the first element to which one of the stereotypes is applied."""
    bases = (base for a in applications for base in graph.targets(a, Edge.SUBJECT))
    return graph.subject(next(bases, applications[0]))


# -- roles and levels --------------------------------------------------------------------------


def _give_roles(graph: Graph, meanings: _Meanings) -> None:
    for id, names in meanings.items():
        role = role_by_stereotype(graph[id], names)
        if role:
            graph.set(graph[id], role=role)
    # Only these kinds: most elements of a large model belong to behaviours.
    for element in graph.of_kind(*STRUCTURED):
        if not element.role:
            graph.set(element, role=role_by_structure(graph, element) or None)


def _give_levels(graph: Graph, lineages: dict[str, tuple[Ancestor, ...]]) -> None:
    levels_by_subject: dict[str, set[str]] = {}
    for id, lineage in lineages.items():
        for subject in graph.targets(graph[id], Edge.SUBJECT):
            names = (a.name for a in lineage if a.family is Family.SYSMLC and a.name in LEVELS)
            levels_by_subject.setdefault(subject.id, set()).update(LEVELS[name] for name in names)
    for id, levels in levels_by_subject.items():
        # Services often have the stereotype OpcUaCall too; the first level of the table counts.
        level = next((name for name in LEVELS.values() if name in levels), None)
        graph.set(graph[id], level=level or graph[id].attrs.get("level"))
    _inherit_levels(graph)


def _inherit_levels(graph: Graph) -> None:
    """Set the level of classifiers without one to that of their nearest general, breadth first."""
    layer = [element for element in graph if "level" in element.attrs]
    while layer:
        specials = (
            special for element in layer for special in graph.sources(element, Edge.SPECIALIZES)
        )
        layer = [special for special in dict.fromkeys(specials) if "level" not in special.attrs]
        # Compute the whole layer before changing it, so that the order of elements has no effect.
        for special, level in [(special, _level_of_general(graph, special)) for special in layer]:
            graph.set(special, level=level)


def _level_of_general(graph: Graph, classifier: Element) -> AttrValue:
    generals = graph.targets(classifier, Edge.SPECIALIZES)
    return next(general.attrs["level"] for general in generals if "level" in general.attrs)


def _complete_attributes(graph: Graph) -> None:
    for element in graph.of_kind(*CLASSIFIERS, Kind.PACKAGE, Kind.OPERATION):
        if element.role == "requirement":
            complete_requirement(graph, element)
    for element in graph.of_kind(Kind.PROPERTY, Kind.FLOW_PROPERTY):
        if element.role == "flow property":
            direction = element.attrs.get("direction") or tag(graph, element, "direction")
            # SysML 1.6 clause 9.3.2.7: the default direction is inout.
            graph.set(element, direction=direction or "inout")
