"""SysML 1.6 as Papyrus has it: the stereotypes that roles need, and the edges that tags imply."""

import json
import re
from collections.abc import Iterator
from functools import cache

from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind, as_items, query
from sysmlc.support import resources

NAMESPACE = "http://www.eclipse.org/papyrus/sysml/1.6/SysML/"
_OTHER_NAMESPACES = re.compile(
    r"https?://www\.omg\.org/spec/SysML/|https?://www\.sparxsystems\.com/profiles/SysML"
)
"""Namespaces of SysML's stereotypes in the files of MagicDraw and Enterprise Architect."""
_NOT_IN_PAPYRUS = frozenset({"Unit", "QuantityKind", "Dimension", "Allocated"})
_CLASSIFIERS = {
    "block": "Block",
    "interface block": "InterfaceBlock",
    "constraint block": "ConstraintBlock",
    "requirement": "Requirement",
    "view": "View",
    "viewpoint": "Viewpoint",
    "stakeholder": "Stakeholder",
}
_BEHAVIOURS = {"test case": "TestCase", "control operator": "ControlOperator"}
_STEREOTYPES: dict[Kind, dict[str, str]] = {
    Kind.CLASS: _CLASSIFIERS,
    Kind.COMPONENT: _CLASSIFIERS,
    Kind.REQUIREMENT: {"requirement": "Requirement"},
    **dict.fromkeys(
        (Kind.ACTIVITY, Kind.STATE_MACHINE, Kind.INTERACTION, Kind.OPERATION, Kind.TEST_CASE),
        _BEHAVIOURS,
    ),
    Kind.DATA_TYPE: {"value type": "ValueType"},
    Kind.ENUMERATION: {"value type": "ValueType"},
    Kind.PROPERTY: {"flow property": "FlowProperty"},
    Kind.FLOW_PROPERTY: {"flow property": "FlowProperty"},
    Kind.PORT: {"full port": "FullPort", "proxy port": "ProxyPort", "flow port": "FlowPort"},
    Kind.CONNECTOR: {"binding connector": "BindingConnector"},
    Kind.ITEM_FLOW: {"item flow": "ItemFlow"},
    Kind.DEPENDENCY: {
        "satisfy": "Satisfy",
        "derive": "DeriveReqt",
        "verify": "Verify",
        "copy": "Copy",
        "refine": "Refine",
        "trace": "Trace",
        "allocate": "Allocate",
        "expose": "Expose",
    },
    Kind.COMMENT: {
        "problem": "Problem",
        "rationale": "Rationale",
        "element group": "ElementGroup",
    },
    Kind.PARTITION: {"allocate partition": "AllocateActivityPartition"},
}
"""The stereotype for a role, by the kind of the element."""
_PORTS = ("full port", "proxy port", "flow port")
_TAGS = {
    Edge.REFERENCES: (
        "principal",
        "original",
        "connector",
        "end",
        "structuralFeature",
        "member",
        "orderedMember",
        "unit",
        "quantityKind",
        "dimension",
    ),
    Edge.ALLOCATED_TO: ("allocatedTo",),
    Edge.PATH: ("propertyPath", "onNestedPort"),
    Edge.REALIZES: ("viewpoint",),
    Edge.BINDS: ("bindingPath", "boundEnd"),
}
"""Tags of SysML's stereotypes from which passes derive edges (docs/ir.md)."""
_DEPENDENCY_ROLES = {
    Edge.SATISFIES: ("satisfy",),
    Edge.DERIVES: ("derive",),
    Edge.VERIFIES: ("verify",),
    Edge.REFINES: ("refine",),
    Edge.TRACES: ("trace", "copy"),
    Edge.ALLOCATED_TO: ("allocate",),
    Edge.REALIZES: ("conform", ""),
    Edge.DEPENDS: ("expose", ""),
    Edge.BINDS: ("",),
}
"""Edges that ``classify`` derives from dependencies, with the roles of these."""


# -- the profile -------------------------------------------------------------------------------


@cache
def read_packages() -> dict[str, str]:
    """Return the package of each stereotype of SysML, by name, as namespaces spell it."""
    elements = json.loads(resources.read_text("metamodels", "libraries.json"))["elements"]
    packages = {}
    for path, entry in elements.items():
        names = path.split("::")
        if names[0] == "SysML" and len(names) == 3 and entry["kind"] == "Stereotype":
            packages[names[2]] = names[1].replace("&", "And")
    return packages


@cache
def read_extended_metaclasses() -> dict[str, tuple[str, ...]]:
    """Return the metaclasses that each stereotype of SysML extends, by name."""
    elements = json.loads(resources.read_text("metamodels", "libraries.json"))["elements"]
    return {
        path.rpartition("::")[2]: tuple(entry.get("extends", ()))
        for path, entry in elements.items()
        if path.startswith("SysML::") and entry["kind"] == "Stereotype"
    }


def is_foreign(namespace: str, name: str) -> bool:
    """Whether a stereotype is another tool's copy of one in Papyrus's SysML profile."""
    is_other = _OTHER_NAMESPACES.match(namespace) is not None
    return is_other and name in read_packages() and name not in _NOT_IN_PAPYRUS


# -- stereotypes for roles ---------------------------------------------------------------------


def iter_applications(graph: Graph, element: Element) -> Iterator[Element]:
    """Yield the stereotype applications on an element, then those on parts of it.

    The graph has no elements for parts such as generalizations; an application on one refers to
    the holder and names the metaclass of the part in ``on``.
    """
    for source in graph.sources(element, Edge.SUBJECT):
        if source.kind is Kind.APPLICATION:
            yield source
    for source in graph.sources(element, Edge.REFERENCES):
        if source.kind is Kind.APPLICATION and "on" in source.attrs:
            yield source


def find_missing_stereotype(graph: Graph, element: Element) -> str:
    """Return the stereotype that the role of an element needs, or the empty string.

    It is empty if an application or the structure of the model gives the element this role.
    """
    stereotypes = _STEREOTYPES.get(element.kind, {})
    needed = stereotypes.get(element.role, "")
    if not needed or element.attrs.get("external") or _is_structural(graph, element):
        return ""
    sufficient = {name for role, name in stereotypes.items() if role == element.role}
    # General stereotypes and those of older versions that give a role, too.
    if element.role == "interface block":
        sufficient.add("FlowSpecification")
    if element.role == "requirement":
        sufficient.add("AbstractRequirement")
    for application in iter_applications(graph, element):
        if not sufficient.isdisjoint(_list_recognised_names(graph, application)):
            return ""
    return needed


def _list_recognised_names(graph: Graph, application: Element) -> tuple[str, ...]:
    """Return the names of the lineage that a reader of the saved model recognises.

    The generals of a stereotype in an external library stand only in that library; those of
    SysML's own stereotypes are known to every reader.
    """
    stereotype = graph.target(application, Edge.INSTANCE_OF)
    is_inside = stereotype is None or not stereotype.attrs.get("external")
    name = str(application.attrs.get("stereotype", ""))
    namespace = str(application.attrs.get("namespace", ""))
    if is_inside or namespace.startswith(NAMESPACE) or is_foreign(namespace, name):
        return list_lineage(application)
    # MagicDraw's own stereotypes (PartProperty) are known, too.
    return list_lineage(application) if "additional_stereotypes" in namespace else (name,)


def list_lineage(application: Element) -> tuple[str, ...]:
    """Return the names of an applied stereotype and its generals, valid as names in XML."""
    return tuple(re.sub(r"\W", "_", name) for name in query.lineage(application))


def _is_structural(graph: Graph, element: Element) -> bool:
    """Whether ``classify`` derives the role from ports or constraint parameters.

    See SysML 1.6, clauses 9.3 and 10.3.
    """
    if element.role == "interface block":
        users = graph.sources(element, Edge.TYPED_BY)
        return any(user.role == "proxy port" for user in users)
    if element.role == "block":
        return any(member.role in _PORTS for member in graph.owned(element))
    if element.role == "binding connector":
        ends = graph.targets(element, Edge.END)
        features = (feature for end in ends for feature in graph.targets(end, Edge.ROLE))
        return any(feature.role == "constraint parameter" for feature in features)
    return False


def list_tags(graph: Graph, element: Element, stereotype: str) -> dict[str, str | list[Element]]:
    """Return the tags by which an application expresses attributes of the element."""
    attrs = element.attrs
    if stereotype == "Requirement":
        texts = {"id": attrs.get("req_id"), "text": attrs.get("text")}
        return {key: str(value) for key, value in texts.items() if value not in (None, "")}
    if stereotype in ("FlowProperty", "FlowPort") and "direction" in attrs:
        return {"direction": str(attrs["direction"])}
    if stereotype == "Block" and attrs.get("encapsulated"):
        return {"isEncapsulated": "true"}
    if stereotype == "ItemFlow":
        item = graph.get(str(attrs.get("item_property", "")))
        return {"itemProperty": [item]} if item is not None else {}
    return _list_measures(graph, element) if stereotype == "ValueType" else {}


def _list_measures(graph: Graph, element: Element) -> dict[str, str | list[Element]]:
    """Return the tags for unit and quantity kind of a value type."""
    tags: dict[str, str | list[Element]] = {}
    if isinstance(element.attrs.get("unit"), str):
        tags["unit"] = str(element.attrs["unit"])
    for target in graph.targets(element, Edge.REFERENCES):
        is_unit = target.kind is Kind.UNIT or target.role == "unit"
        is_kind = target.kind is Kind.QUANTITY_KIND or target.role == "quantity kind"
        if is_unit or is_kind:
            tags["unit" if is_unit else "quantityKind"] = [target]
    return tags


# -- implied edges -----------------------------------------------------------------------------


def is_implied(graph: Graph, source: Element, edge: Edge, target: Element) -> bool:
    """Whether passes derive an edge from a dependency, a tag or a binding connector."""
    if edge in _DEPENDENCY_ROLES and _has_dependency(graph, source, edge, target):
        return True
    if edge is Edge.REFERENCES and _is_measure_reference(source, target):
        return True
    if edge is Edge.ALLOCATED_TO and _is_allocated(graph, source, target):
        return True
    if edge is Edge.BINDS and source.kind is not Kind.TEMPLATE_BINDING:
        return _is_bound(graph, source, target) or _is_tagged(graph, source, edge)
    if edge is Edge.REALIZES and _is_conformance(graph, source, target):
        return True
    return edge in _TAGS and _is_tagged(graph, source, edge, target)


def _has_dependency(graph: Graph, source: Element, edge: Edge, target: Element) -> bool:
    roles = _DEPENDENCY_ROLES[edge]
    allows_any_role = edge in (Edge.DEPENDS, Edge.REALIZES, Edge.BINDS)
    return any(
        target in graph.targets(dependency, Edge.SUPPLIER)
        for dependency in graph.sources(source, Edge.CLIENT)
        if allows_any_role or dependency.role in roles
    )


def _is_tagged(graph: Graph, source: Element, edge: Edge, target: Element | None = None) -> bool:
    """Whether a tag that implies the edge names *target*, or has a value if that is None."""
    for application in iter_applications(graph, source):
        for tag in _TAGS[edge]:
            value = application.attrs.get(f"tag.{tag}")
            if value is None:
                continue
            if target is None or target.id in _iter_named_ids(graph, value):
                return True
            if target.attrs.get("external") and "#" in str(value):
                # The value is an href, and the target the stub for it.
                return True
    return False


def _iter_named_ids(graph: Graph, value: AttrValue) -> Iterator[str]:
    """Yield the ids in a tagged value; for an application, also the ids of its base elements."""
    for id in as_items(value):
        element = graph.get(str(id))
        if element is not None and element.kind is Kind.APPLICATION:
            yield from (base.id for base in graph.targets(element, Edge.SUBJECT))
        yield str(id)


def _is_measure_reference(source: Element, target: Element) -> bool:
    """Whether one end is a unit or quantity kind: slots or type names express the edge."""
    is_measure = source.role in ("unit", "quantity kind") or source.kind is Kind.UNIT
    return is_measure or target.kind in (Kind.UNIT, Kind.QUANTITY_KIND)


def _is_allocated(graph: Graph, source: Element, target: Element) -> bool:
    """Whether a tag of the target or a partition of the source implies an allocation."""
    for application in iter_applications(graph, target):
        value = application.attrs.get("tag.allocatedFrom")
        if value is not None and source.id in _iter_named_ids(graph, value):
            return True
    for partition in graph.targets(source, Edge.IN_PARTITION):
        for outer in (partition, *graph.ancestors(partition)):
            represented = graph.targets(outer, Edge.REPRESENTS)
            if outer.role == "allocate partition" and target in represented:
                return True
    return False


def _is_bound(graph: Graph, source: Element, target: Element) -> bool:
    """Whether a binding connector joins both elements."""
    for end in graph.sources(source, Edge.ROLE):
        connector = graph.owner(end)
        if connector is not None and connector.role == "binding connector":
            ends = graph.targets(connector, Edge.END)
            if any(target in graph.targets(item, Edge.ROLE) for item in ends):
                return True
    return False


def _is_conformance(graph: Graph, source: Element, target: Element) -> bool:
    """Whether a generalization with a stereotype expresses conformance to a viewpoint.

    The stereotype Conform of SysML 1.6 extends Generalization.
    """
    if target not in graph.targets(source, Edge.SPECIALIZES):
        return False
    applications = iter_applications(graph, source)
    return any(application.attrs.get("on") == "generalization" for application in applications)
