"""What SysML's stereotypes say of their elements besides a role: attributes and edges, by table.

SysML 1.6 (formal/19-11-01), the stereotype tables of clauses 7 to 11; docs/ir.md has the result.
"""

from collections.abc import Callable, Iterator, Mapping

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind
from sysmlc.ir.query import bounds, generals
from sysmlc.passes.classify.vocabulary import mangled

_Handler = Callable[[Graph, Element, Element], None]
"""Takes the graph, the application and an element that it is applied to."""


def give_tags(graph: Graph, known: Mapping[str, tuple[str, ...]]) -> None:
    """Set attributes and edges; ``known`` maps ids of applications to SysML stereotypes."""
    for id, names in known.items():
        handlers = [one for name in names for one in HANDLERS.get(name, ())]
        for subject in _subjects(graph, graph[id]) if handlers else ():
            for handler in handlers:
                handler(graph, graph[id], subject)


def _subjects(graph: Graph, application: Element) -> list[Element]:
    """What it is applied to; an event's application speaks of the triggers that name it."""
    folded = application.attrs.get("on") in ("change-event", "generalization")
    return graph.targets(application, Edge.REFERENCES if folded else Edge.SUBJECT)


# -- reading tags ------------------------------------------------------------------------------


def value(application: Element, name: str) -> AttrValue:
    """A tag of one application; tools differ in the case of its name."""
    exact = application.attrs.get(f"tag.{name}")
    if exact is not None:
        return exact
    wanted = f"tag.{name.lower()}"
    return next((v for key, v in application.attrs.items() if key.lower() == wanted), None)


def elements(graph: Graph, application: Element, name: str) -> list[Element]:
    """Elements that a tag leads to; a stereotype's instance stands for what it is applied to.

    Papyrus writes the id of the application where a tag is typed by a stereotype.
    """
    found = (graph.get(text) for text in _texts(value(application, name)))
    return [real for one in found if one is not None for real in _real(graph, one)]


def _texts(given: AttrValue) -> Iterator[str]:
    if isinstance(given, tuple):
        for one in given:
            yield from _texts(one)
    elif isinstance(given, str):
        yield given


def _real(graph: Graph, element: Element) -> list[Element]:
    if element.kind is Kind.APPLICATION:
        return graph.targets(element, Edge.SUBJECT)
    return [element]


def _shown(graph: Graph, given: AttrValue) -> AttrValue:
    """The value, or the name of the element that it is the id of."""
    named = graph.get(given) if isinstance(given, str) else None
    return named.name if named is not None and named.name else given


# -- handlers ----------------------------------------------------------------------------------


def _attribute(attribute: str, tag_name: str) -> _Handler:
    def give(graph: Graph, application: Element, subject: Element) -> None:
        found = _shown(graph, value(application, tag_name))
        if found not in (None, ""):
            graph.set(subject, **{attribute: found})

    return give


def _flag(attribute: str, tag_name: str) -> _Handler:
    def give(graph: Graph, application: Element, subject: Element) -> None:
        if value(application, tag_name) in ("true", True):
            graph.set(subject, **{attribute: True})

    return give


def _constant(attribute: str, given: AttrValue) -> _Handler:
    def give(graph: Graph, _application: Element, subject: Element) -> None:
        graph.set(subject, **{attribute: given})

    return give


def _edge(edge: Edge, *tag_names: str) -> _Handler:
    def give(graph: Graph, application: Element, subject: Element) -> None:
        for tag_name in tag_names:
            for target in elements(graph, application, tag_name):
                if target is not subject:
                    graph.connect(edge, subject, target)

    return give


def _ids(attribute: str, tag_name: str) -> _Handler:
    def give(graph: Graph, application: Element, subject: Element) -> None:
        found = tuple(one.id for one in elements(graph, application, tag_name))
        if found:
            graph.set(subject, **{attribute: found})

    return give


def _allocated_from(graph: Graph, application: Element, subject: Element) -> None:
    for source in elements(graph, application, "allocatedFrom"):
        if source is not subject:
            graph.connect(Edge.ALLOCATED_TO, source, subject)


def _bound(graph: Graph, application: Element, subject: Element) -> None:
    """A bound reference is bound to the last property of its path (clause 8.3.2.4)."""
    path = elements(graph, application, "bindingPath")
    if not path:
        ends = elements(graph, application, "boundEnd")
        path = [role for end in ends for role in graph.targets(end, Edge.ROLE)]
    if path and path[-1] is not subject:
        graph.connect(Edge.BINDS, subject, path[-1])


def _conform(graph: Graph, application: Element, subject: Element) -> None:
    """A view that conforms by generalization (clause 7.3.2.1) realises what it specialises.

    It is the role of its generals that tells which of several generalizations is meant.
    """
    if application.attrs.get("on") == "generalization":
        for general in graph.targets(subject, Edge.SPECIALIZES):
            if general.role == "viewpoint" or general.attrs.get("external"):
                graph.connect(Edge.REALIZES, subject, general)


def _path_multiplicity(graph: Graph, application: Element, subject: Element) -> None:
    # Clause 8.3.2.10: without bounds none is given for the path.
    lower, upper = value(application, "lower"), value(application, "upper")
    if lower is not None or upper is not None:
        text = f"{'0' if lower is None else lower}..{'*' if upper in (None, '-1') else upper}"
        graph.set(subject, path_multiplicity=text)


def _distribution(graph: Graph, application: Element, subject: Element) -> None:
    """``Normal(mean=5, standardDeviation=1)``: the distribution and its parameters."""
    name = str(application.attrs.get("stereotype", ""))
    given = [
        f"{key.removeprefix('tag.')}={value}"
        for key, value in application.attrs.items()
        if key.startswith("tag.")
    ]
    graph.set(subject, distribution=f"{name}({', '.join(given)})" if given else name)


def _path(graph: Graph, application: Element, subject: Element) -> None:
    # A front end reads the paths of connector ends, part with port included.
    if subject.kind is not Kind.CONNECTOR_END:
        _edge(Edge.PATH, "propertyPath", "onNestedPort")(graph, application, subject)


HANDLERS: dict[str, tuple[_Handler, ...]] = {
    "AdjunctProperty": (_edge(Edge.REFERENCES, "principal"),),
    "Allocated": (_edge(Edge.ALLOCATED_TO, "allocatedTo"), _allocated_from),
    "Block": (_flag("encapsulated", "isEncapsulated"),),
    "BoundReference": (_bound,),
    "ChangeStructuralFeatureEvent": (_edge(Edge.REFERENCES, "structuralFeature"),),
    "ConnectorProperty": (_edge(Edge.REFERENCES, "connector"),),
    "Conform": (_conform,),
    "Continuous": (_constant("rate", "continuous"),),
    "DirectedFeature": (_attribute("feature_direction", "featureDirection"),),
    "DirectedRelationshipPropertyPath": (
        _ids("source_context", "sourceContext"),
        _ids("source_path", "sourcePropertyPath"),
        _ids("target_context", "targetContext"),
        _ids("target_path", "targetPropertyPath"),
    ),
    "Discrete": (_constant("rate", "discrete"),),
    "DistributedProperty": (_distribution,),
    "ElementGroup": (
        _attribute("criterion", "criterion"),
        _edge(Edge.REFERENCES, "member", "orderedMember"),
    ),
    "ElementPropertyPath": (_path,),
    "EndPathMultiplicity": (_path_multiplicity,),
    "FlowPort": (_flag("conjugated", "isConjugated"),),
    "NoBuffer": (_constant("no_buffer", True),),
    "Overwrite": (_constant("overwrite", True),),
    "ParticipantProperty": (_edge(Edge.REFERENCES, "end"),),
    "Probability": (_attribute("probability", "probability"),),
    "PropertySpecificType": (_constant("property_specific", True),),
    "Rate": (_attribute("rate", "rate"),),
    "View": (_edge(Edge.REALIZES, "viewpoint"),),
    "_InterfaceBlock": (_edge(Edge.REFERENCES, "original"),),
    "ConjugatedInterfaceBlock": (_edge(Edge.REFERENCES, "original"),),
}
"""By stereotype; one that specialises it has the same meaning, in the order of the lineage."""


def optional_with_value(graph: Graph, known: Mapping[str, tuple[str, ...]]) -> Iterator[Element]:
    """Parameters that are «optional» although their multiplicity asks for a value."""
    for id in (id for id, names in known.items() if "Optional" in names):
        for parameter in graph.targets(graph[id], Edge.SUBJECT):
            limits = bounds(parameter.attrs.get("multiplicity"))
            if parameter.kind is Kind.PARAMETER and limits is not None and limits[0] > 0:
                yield parameter


UNDEFINED_TAG = rule(
    "SM156",
    "undefined-tag",
    Severity.WARNING,
    "tag '{tag}' of stereotype '{stereotype}' on '{element}'{others} is none that its profile "
    "defines",
    help="apply the profile again in the modelling tool, or correct the name of the tag",
)

_TAG = "tag."


def check_tags(graph: Graph, sink: Sink) -> None:
    """Report tags of applications whose stereotypes, general ones included, are in the unit."""
    known: dict[str, frozenset[str] | None] = {}
    found: dict[tuple[str, str], list[Element]] = {}
    for application in graph.of_kind(Kind.APPLICATION):
        stereotype = graph.target(application, Edge.INSTANCE_OF)
        if stereotype is None:
            continue
        if stereotype.id not in known:
            known[stereotype.id] = _properties(graph, stereotype)
        for tag in _undefined(application, known[stereotype.id]):
            found.setdefault((stereotype.id, tag), []).append(application)
    for (_, tag), applications in found.items():
        _report(graph, sink, tag, applications)


def _properties(graph: Graph, stereotype: Element) -> frozenset[str] | None:
    """Names of its properties as XML shows them; None when some of them cannot be known."""
    family = [stereotype, *generals(graph, stereotype)]
    if any(one.attrs.get("external") or one.attrs.get("library") for one in family):
        return None
    owned = (part for one in family for part in graph.owned(one) if part.kind is Kind.PROPERTY)
    return frozenset(mangled(part.name).lower() for part in owned)


def _undefined(application: Element, known: frozenset[str] | None) -> Iterator[str]:
    if known is not None:
        tags = (name.removeprefix(_TAG) for name in application.attrs if name.startswith(_TAG))
        yield from (tag for tag in tags if mangled(tag).lower() not in known)


def _report(graph: Graph, sink: Sink, tag: str, applications: list[Element]) -> None:
    first, others = applications[0], len(applications) - 1
    subject = graph.subject(first)
    sink.report(
        UNDEFINED_TAG,
        subject,
        tag=tag,
        stereotype=first.name,
        element=graph.qualified_name(graph.target(first, Edge.SUBJECT) or first),
        others=f" and {others} more" if others else "",
    )
