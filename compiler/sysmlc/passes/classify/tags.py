"""Tags of SysML's stereotypes: a table of handlers turns them into attributes and edges.

The handlers implement the stereotype tables of SysML 1.6 (formal/19-11-01), clauses 7 to 11;
docs/ir.md lists the results. The module also reports tags that a profile of the unit does not
define, and directions and aggregations that UML and SysML do not define.
"""

from collections.abc import Callable, Iterator, Mapping

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind
from sysmlc.ir.query import FLOW_DIRECTIONS, bounds, generals, tag
from sysmlc.passes.classify.vocabulary import mangle

_Handler = Callable[[Graph, Element, Element], None]
"""A handler gets the graph, the application and the element with the application."""


def apply_tags(graph: Graph, meanings: Mapping[str, tuple[str, ...]]) -> None:
    """Set attributes and edges; *meanings* maps ids of applications to SysML stereotypes."""
    for id, names in meanings.items():
        handlers = [handler for name in names for handler in HANDLERS.get(name, ())]
        if handlers:
            for subject in _find_subjects(graph, graph[id]):
                for handler in handlers:
                    handler(graph, graph[id], subject)


def _find_subjects(graph: Graph, application: Element) -> list[Element]:
    """Return the elements that an application describes: its subjects.

    The graph has no elements for change events and generalizations. Their applications refer to the
    triggers of the event, or to the special classifier.
    """
    folded = application.attrs.get("on") in ("change-event", "generalization")
    return graph.targets(application, Edge.REFERENCES if folded else Edge.SUBJECT)


# -- reading tags ------------------------------------------------------------------------------


def tag_value(application: Element, name: str) -> AttrValue:
    """Return the value of a tag of an application, ignoring the case of the tag's name."""
    exact = application.attrs.get(f"tag.{name}")
    if exact is not None:
        return exact
    lowered = f"tag.{name.lower()}"
    return next((v for key, v in application.attrs.items() if key.lower() == lowered), None)


def tag_elements(graph: Graph, application: Element, name: str) -> list[Element]:
    """Return the elements to which a tag refers; an application is replaced by its subjects.

    Papyrus writes the id of the application if a tag is typed by a stereotype.
    """
    referred = (graph.get(text) for text in _list_texts(tag_value(application, name)))
    return [
        resolved
        for element in referred
        if element is not None
        for resolved in _subjects_or_itself(graph, element)
    ]


def _list_texts(content: AttrValue) -> Iterator[str]:
    if isinstance(content, tuple):
        for item in content:
            yield from _list_texts(item)
    elif isinstance(content, str):
        yield content


def _subjects_or_itself(graph: Graph, element: Element) -> list[Element]:
    if element.kind is Kind.APPLICATION:
        return graph.targets(element, Edge.SUBJECT)
    return [element]


def _name_or_value(graph: Graph, content: AttrValue) -> AttrValue:
    """Return the name of an element if the value is its id, or else the value."""
    element = graph.get(content) if isinstance(content, str) else None
    return element.name if element is not None and element.name else content


# -- handlers ----------------------------------------------------------------------------------


def _set_attribute(attribute: str, tag_name: str) -> _Handler:
    def handle(graph: Graph, application: Element, subject: Element) -> None:
        value = _name_or_value(graph, tag_value(application, tag_name))
        if value not in (None, ""):
            graph.set(subject, **{attribute: value})

    return handle


def _set_flag(attribute: str, tag_name: str) -> _Handler:
    def handle(graph: Graph, application: Element, subject: Element) -> None:
        if tag_value(application, tag_name) in ("true", True):
            graph.set(subject, **{attribute: True})

    return handle


def _set_constant(attribute: str, constant: AttrValue) -> _Handler:
    def handle(graph: Graph, _application: Element, subject: Element) -> None:
        graph.set(subject, **{attribute: constant})

    return handle


def _add_edges(edge: Edge, *tag_names: str) -> _Handler:
    def handle(graph: Graph, application: Element, subject: Element) -> None:
        for tag_name in tag_names:
            for target in tag_elements(graph, application, tag_name):
                if target is not subject:
                    graph.connect(edge, subject, target)

    return handle


def _set_ids(attribute: str, tag_name: str) -> _Handler:
    def handle(graph: Graph, application: Element, subject: Element) -> None:
        ids = tuple(element.id for element in tag_elements(graph, application, tag_name))
        if ids:
            graph.set(subject, **{attribute: ids})

    return handle


def _add_allocations_from(graph: Graph, application: Element, subject: Element) -> None:
    for source in tag_elements(graph, application, "allocatedFrom"):
        if source is not subject:
            graph.connect(Edge.ALLOCATED_TO, source, subject)


def _add_binding(graph: Graph, application: Element, subject: Element) -> None:
    """Bind a bound reference to the last property of its path (clause 8.3.2.4)."""
    bound = tag_elements(graph, application, "bindingPath")
    if not bound:
        ends = tag_elements(graph, application, "boundEnd")
        bound = [role for end in ends for role in graph.targets(end, Edge.ROLE)]
    if bound and bound[-1] is not subject:
        graph.connect(Edge.BINDS, subject, bound[-1])


def _add_conformance(graph: Graph, application: Element, subject: Element) -> None:
    """Add realizations from a view to its viewpoints for a «Conform» generalization (7.3.2.1).

    The graph does not show which of several generalizations has the stereotype, so that generals
    with the role viewpoint, and external ones, are taken.
    """
    if application.attrs.get("on") == "generalization":
        for general in graph.targets(subject, Edge.SPECIALIZES):
            if general.role == "viewpoint" or general.attrs.get("external"):
                graph.connect(Edge.REALIZES, subject, general)


def _set_path_multiplicity(graph: Graph, application: Element, subject: Element) -> None:
    # Clause 8.3.2.10: without bounds none is given for the path.
    lower, upper = tag_value(application, "lower"), tag_value(application, "upper")
    if lower is not None or upper is not None:
        # Tools on the basis of Ecore write an unlimited upper bound as -1.
        text = f"{'0' if lower is None else lower}..{'*' if upper in (None, '-1') else upper}"
        graph.set(subject, path_multiplicity=text)


def _set_distribution(graph: Graph, application: Element, subject: Element) -> None:
    """Set the distribution as text: ``Normal(mean=5, standardDeviation=1)``."""
    name = str(application.attrs.get("stereotype", ""))
    parameters = [
        f"{key.removeprefix('tag.')}={value}"
        for key, value in application.attrs.items()
        if key.startswith("tag.")
    ]
    graph.set(subject, distribution=f"{name}({', '.join(parameters)})" if parameters else name)


def _add_path(graph: Graph, application: Element, subject: Element) -> None:
    # A front end reads the paths of connector ends, part with port included.
    if subject.kind is not Kind.CONNECTOR_END:
        _add_edges(Edge.PATH, "propertyPath", "onNestedPort")(graph, application, subject)


HANDLERS: dict[str, tuple[_Handler, ...]] = {
    "AdjunctProperty": (_add_edges(Edge.REFERENCES, "principal"),),
    "Allocated": (_add_edges(Edge.ALLOCATED_TO, "allocatedTo"), _add_allocations_from),
    "Block": (_set_flag("encapsulated", "isEncapsulated"),),
    "BoundReference": (_add_binding,),
    "ChangeStructuralFeatureEvent": (_add_edges(Edge.REFERENCES, "structuralFeature"),),
    "ConnectorProperty": (_add_edges(Edge.REFERENCES, "connector"),),
    "Conform": (_add_conformance,),
    "Continuous": (_set_constant("rate", "continuous"),),
    "DirectedFeature": (_set_attribute("feature_direction", "featureDirection"),),
    "DirectedRelationshipPropertyPath": (
        _set_ids("source_context", "sourceContext"),
        _set_ids("source_path", "sourcePropertyPath"),
        _set_ids("target_context", "targetContext"),
        _set_ids("target_path", "targetPropertyPath"),
    ),
    "Discrete": (_set_constant("rate", "discrete"),),
    "DistributedProperty": (_set_distribution,),
    "ElementGroup": (
        _set_attribute("criterion", "criterion"),
        _add_edges(Edge.REFERENCES, "member", "orderedMember"),
    ),
    "ElementPropertyPath": (_add_path,),
    "EndPathMultiplicity": (_set_path_multiplicity,),
    "FlowPort": (_set_flag("conjugated", "isConjugated"),),
    "NoBuffer": (_set_constant("no_buffer", True),),
    "Overwrite": (_set_constant("overwrite", True),),
    "ParticipantProperty": (_add_edges(Edge.REFERENCES, "end"),),
    "Probability": (_set_attribute("probability", "probability"),),
    "PropertySpecificType": (_set_constant("property_specific", True),),
    "Rate": (_set_attribute("rate", "rate"),),
    "View": (_add_edges(Edge.REALIZES, "viewpoint"),),
    "_InterfaceBlock": (_add_edges(Edge.REFERENCES, "original"),),
    "ConjugatedInterfaceBlock": (_add_edges(Edge.REFERENCES, "original"),),
}
"""Handlers by stereotype. They also apply to stereotypes that specialise it."""


def find_optional_with_value(
    graph: Graph, meanings: Mapping[str, tuple[str, ...]]
) -> Iterator[Element]:
    """Yield the parameters that are «optional» although their multiplicity requires a value."""
    for id in (id for id, names in meanings.items() if "Optional" in names):
        for parameter in graph.targets(graph[id], Edge.SUBJECT):
            limits = bounds(parameter.attrs.get("multiplicity"))
            if parameter.kind is Kind.PARAMETER and limits is not None and limits[0] > 0:
                yield parameter


UNDEFINED_TAG = rule(
    "SM156",
    "undefined-tag",
    Severity.WARNING,
    "tag '{tag}' of stereotype '{stereotype}' on '{element}'{others} is not defined by its profile",
    help="apply the profile again in the modelling tool, or correct the name of the tag",
)

_TAG = "tag."


def check_tags(graph: Graph, sink: Sink) -> None:
    """Report tags that the applied stereotype does not define, each once per stereotype."""
    defined: dict[str, frozenset[str] | None] = {}
    undefined: dict[tuple[str, str], list[Element]] = {}
    for application in graph.of_kind(Kind.APPLICATION):
        stereotype = graph.target(application, Edge.INSTANCE_OF)
        if stereotype is None:
            continue
        if stereotype.id not in defined:
            defined[stereotype.id] = _list_properties(graph, stereotype)
        for tag_name in _find_undefined(application, defined[stereotype.id]):
            undefined.setdefault((stereotype.id, tag_name), []).append(application)
    for (_, tag_name), applications in undefined.items():
        _report(graph, sink, tag_name, applications)


def _list_properties(graph: Graph, stereotype: Element) -> frozenset[str] | None:
    """Return the names of a stereotype's properties in lower case, or None if some are unknown."""
    family = [stereotype, *generals(graph, stereotype)]
    if any(
        classifier.attrs.get("external") or classifier.attrs.get("library") for classifier in family
    ):
        return None
    owned = (
        feature
        for classifier in family
        for feature in graph.owned(classifier)
        if feature.kind is Kind.PROPERTY
    )
    return frozenset(mangle(feature.name).lower() for feature in owned)


def _find_undefined(application: Element, defined: frozenset[str] | None) -> Iterator[str]:
    if defined is not None:
        tags = (name.removeprefix(_TAG) for name in application.attrs if name.startswith(_TAG))
        yield from (tag for tag in tags if mangle(tag).lower() not in defined)


def _report(graph: Graph, sink: Sink, tag: str, applications: list[Element]) -> None:
    first, further = applications[0], len(applications) - 1
    subject = graph.subject(first)
    sink.report(
        UNDEFINED_TAG,
        subject,
        tag=tag,
        stereotype=first.name,
        element=graph.qualified_name(graph.target(first, Edge.SUBJECT) or first),
        others=f" and {further} more" if further else "",
    )


# -- literals ----------------------------------------------------------------------------------

UNKNOWN_LITERAL = rule(
    "SM220",
    "unknown-literal",
    Severity.WARNING,
    "the {attribute} of '{element}' is '{value}', which is not one of {known}",
    help="choose one of {known} in the modelling tool",
)

_DIRECTED = (Kind.PARAMETER, Kind.PORT, Kind.PROPERTY, Kind.FLOW_PROPERTY)
_LITERALS = {
    "aggregation": ("none", "shared", "composite"),
    "direction": ("in", "inout", "out", "return"),
}


def check_literals(graph: Graph, sink: Sink) -> None:
    """Report and remove values of direction and aggregation that UML and SysML do not define."""
    for element in graph.of_kind(*_DIRECTED):
        attrs = element.attrs
        if attrs:
            for attribute, literals in _LITERALS.items():
                if attribute in attrs and attrs[attribute] not in literals:
                    _report_literal(graph, sink, element, attribute)
                    # SysML 1.6 clause 9.3.2: a flow property without direction has inout.
                    is_flow = element.role == "flow property" and attribute == "direction"
                    graph.set(element, **{attribute: "inout" if is_flow else None})
    for port in graph.of_kind(Kind.PORT):
        if port.role == "flow port":
            _check_flow_port(graph, sink, port)


def _check_flow_port(graph: Graph, sink: Sink, port: Element) -> None:
    """Check the direction of a flow port of SysML 1.1: a tag, which the pass ``ports`` reads."""
    direction = tag(graph, port, "direction")
    if isinstance(direction, str) and direction and direction not in FLOW_DIRECTIONS:
        _report_literal(graph, sink, port, "direction", direction)


def _report_literal(
    graph: Graph, sink: Sink, element: Element, attribute: str, tag_value: str = ""
) -> None:
    sink.report(
        UNKNOWN_LITERAL,
        graph.subject(element),
        attribute=attribute,
        element=graph.qualified_name(element),
        value=tag_value or element.attrs[attribute],
        known=", ".join(FLOW_DIRECTIONS if tag_value else _LITERALS[attribute]),
    )
