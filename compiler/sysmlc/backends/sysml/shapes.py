"""From kinds and roles to the keywords of definitions and usages (SysML v2, 8.2.2)."""

from collections.abc import Callable

from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.query import type_of
from sysmlc.values import dataclass


@dataclass(frozen=True, slots=True)
class Shape:
    """How an element is written: its keyword, and whether it must have a name."""

    keyword: str
    is_named: bool = True

    @property
    def is_definition(self) -> bool:
        """Whether it is a definition, not a usage; packages are neither."""
        return self.keyword.endswith(" def")

    @property
    def is_usage(self) -> bool:
        """Whether it is a usage: a feature that chains can lead to."""
        return not self.is_definition and self.keyword not in _NAMESPACES

    @property
    def plain(self) -> str:
        """The keyword of the usages of a definition."""
        return self.keyword.removesuffix(" def")


_NAMESPACES = frozenset(
    {"package", "library package", "comment", "doc", "dependency", "import", "start"}
)
_DEFINITIONS = {
    Kind.PACKAGE: "package",
    Kind.PROFILE: "package",
    Kind.CLASS: "part def",
    Kind.COMPONENT: "part def",
    Kind.ACTOR: "part def",
    Kind.INTERFACE: "port def",
    Kind.DATA_TYPE: "attribute def",
    Kind.ENUMERATION: "enum def",
    Kind.SIGNAL: "item def",
    Kind.ITEM: "item def",
    Kind.STEREOTYPE: "metadata def",
    Kind.USE_CASE: "use case def",
    Kind.REQUIREMENT: "requirement",
    Kind.TEST_CASE: "verification def",
}
_ROLES = {
    "interface block": "port def",
    "constraint block": "constraint def",
    "requirement": "requirement",
    "value type": "attribute def",
    "view": "view def",
    "viewpoint": "viewpoint def",
    "test case": "verification def",
}
_BEHAVIOURS = {Kind.ACTIVITY: "action", Kind.STATE_MACHINE: "state", Kind.INTERACTION: "occurrence"}
_MEMBERS = {
    Kind.ENUMERATION_LITERAL: Shape("enum"),
    Kind.OPERATION: Shape("action"),
    Kind.RECEPTION: Shape("action"),
    Kind.ACTION: Shape("action"),
    Kind.STRUCTURED: Shape("action"),
    Kind.STATE: Shape("state"),
    Kind.REGION: Shape("state"),
    Kind.CONNECTOR: Shape("connection", is_named=False),
    Kind.ITEM_FLOW: Shape("flow", is_named=False),
    Kind.CONSTRAINT: Shape("constraint", is_named=False),
    Kind.COMMENT: Shape("comment", is_named=False),
    Kind.DEPENDENCY: Shape("dependency", is_named=False),
    Kind.CONTROL_FLOW: Shape("succession", is_named=False),
    Kind.OBJECT_FLOW: Shape("flow", is_named=False),
    Kind.TRANSITION: Shape("transition", is_named=False),
    Kind.LIFELINE: Shape("part"),
    Kind.MESSAGE: Shape("message"),
    Kind.FRAGMENT: Shape("occurrence"),
    Kind.OPERAND: Shape("occurrence"),
    Kind.EXTEND: Shape("dependency", is_named=False),
    Kind.EXTENSION_POINT: Shape("occurrence"),
    Kind.IMPORT: Shape("import", is_named=False),
    Kind.DOCUMENT: Shape("comment", is_named=False),
    Kind.METADATA: Shape("comment", is_named=False),
    Kind.ALIAS: Shape("comment", is_named=False),
    Kind.FACET: Shape("metadata", is_named=False),
    Kind.GROUP: Shape("metadata", is_named=False),
}
_CONTROLS = {"decision": "decide", "merge": "merge", "fork": "fork", "join": "join"}
_USED_BY_KEYWORD = {
    "part def": "part",
    "item def": "item",
    "attribute def": "attribute",
    "enum def": "attribute",
    "constraint def": "constraint",
    "action def": "action",
    "state def": "state",
    "occurrence def": "occurrence",
    "use case def": "use case",
    "action": "action",
    "state": "state",
    "occurrence": "occurrence",
}
"""Keyword of features by that of the definition, or behaviour, that types them; else ``ref``."""
_TYPES = 12
"""Features typed by features: so many decide how the first one is written."""
HOLDERS = (Kind.PACKAGE, Kind.PROFILE)


def shape_of(graph: Graph, element: Element) -> Shape | None:
    """How an element is written as a member of a namespace; None for what is no member."""
    kind = element.kind
    if kind in _DEFINITIONS:
        role = element.role if kind in _BY_ROLE else ""
        return Shape(_ROLES.get(role, _DEFINITIONS[kind]))
    write = _BY_KIND.get(kind)
    return _MEMBERS.get(kind) if write is None else write(graph, element)


_BY_ROLE = (Kind.CLASS, Kind.DATA_TYPE, Kind.COMPONENT, Kind.PACKAGE)


def _property(graph: Graph, element: Element) -> Shape:
    keyword = feature_keyword(graph, element)
    flows = "direction" in element.attrs
    return Shape("item" if flows and keyword == "part" else keyword)


def _port(graph: Graph, element: Element) -> Shape:
    return Shape("part" if is_part_port(graph, element) else "port")


def _control(graph: Graph, element: Element) -> Shape | None:
    """Control nodes; a final node is a member where it ends other flows, or is one of several."""
    if element.subkind == "initial":
        return Shape("start", is_named=False)
    keyword = _CONTROLS.get(element.subkind)
    if keyword is None and element.subkind == "final" and _is_apart(graph, element):
        return Shape("action")
    return Shape(keyword) if keyword else None


def _is_apart(graph: Graph, element: Element) -> bool:
    owner = graph.owner(element)
    beside = [] if owner is None else graph.owned(owner)
    found = [one.subkind for one in beside if one.kind is Kind.CONTROL]
    return "fork" in found or found.count("final") > 1


def _pseudostate(_graph: Graph, element: Element) -> Shape | None:
    return None if element.subkind == "initial" else Shape("state")


def _object_node(graph: Graph, element: Element) -> Shape:
    keyword = feature_keyword(graph, element)
    return Shape(keyword if keyword in ("attribute", "item", "occurrence") else "item")


def behaviour_shape(graph: Graph, element: Element) -> Shape:
    """A behaviour of a package is a definition, one of anything else a usage of its owner.

    Only a usage may speak of the features of its owner without a path to them.
    """
    keyword = _BEHAVIOURS[element.kind]
    if element.role == "test case":
        keyword = "verification"
    owner = graph.owner(element)
    is_definition = owner is None or owner.kind in HOLDERS or owner.kind in _BEHAVIOURS
    return Shape(f"{keyword} def" if is_definition else keyword, is_named=is_definition)


def feature_keyword(graph: Graph, feature: Element) -> str:
    """Keyword of a feature by its type, else by its role."""
    shape = _shape_of_type(graph, feature, type_of(graph, feature))
    if shape is not None:
        return _USED_BY_KEYWORD.get(shape.keyword, "ref")
    role = feature.role
    if role == "part" or feature.attrs.get("aggregation") == "composite":
        return "part"
    is_value = role in ("value", "constraint parameter") or "default" in feature.attrs
    return "attribute" if is_value else "ref"


def _shape_of_type(graph: Graph, element: Element, type_: Element | None) -> Shape | None:
    """How the type of an element is written; None where types lead in a circle, or too far."""
    if type_ is None or type_.kind in _DEFINITIONS:
        return None if type_ is None else shape_of(graph, type_)
    level = [element]
    for _ in range(_TYPES):
        found = (type_ for one in level for type_ in _types(graph, one))
        level = list({one.id: one for one in found if one.kind not in _DEFINITIONS}.values())
        if not level:
            return shape_of(graph, type_)
    return None


def _types(graph: Graph, element: Element) -> list[Element]:
    """What decides how an element is written: its types, or those of its ends."""
    if element.kind is Kind.INSTANCE:
        return graph.targets(element, Edge.INSTANCE_OF)
    ends = graph.targets(element, Edge.END) if element.kind is Kind.ASSOCIATION else [element]
    found = {type_.id: type_ for end in ends if (type_ := type_of(graph, end)) is not None}
    return list(found.values())


def is_part_port(graph: Graph, port: Element) -> bool:
    """Whether a port is written as a part: it is typed by a block, and nothing only flows."""
    if port.role == "flow port":
        return False
    shape = _shape_of_type(graph, port, type_of(graph, port))
    return shape is not None and shape.keyword == "part def"


def _parameter(graph: Graph, element: Element) -> Shape | None:
    if element.kind is Kind.ACTIVITY_PARAMETER and graph.targets(element, Edge.REFERENCES):
        return None
    keyword = feature_keyword(graph, element)
    return Shape("item" if keyword == "part" else keyword)


def _association(graph: Graph, element: Element) -> Shape:
    ends = (type_of(graph, end) for end in graph.targets(element, Edge.END))
    types = {"" if one is None else one.id: one for one in ends}
    shapes = [_shape_of_type(graph, element, one) for one in types.values()]
    joins_ports = bool(shapes) and all(one and one.keyword == "port def" for one in shapes)
    return Shape("interface def" if joins_ports else "connection def", is_named=False)


def _instance(graph: Graph, element: Element) -> Shape:
    if element.role in ("unit", "quantity kind"):
        return Shape("attribute")
    type_ = graph.target(element, Edge.INSTANCE_OF)
    shape = _shape_of_type(graph, element, type_)
    keyword = "part" if shape is None else _USED_BY_KEYWORD.get(shape.keyword, "ref")
    return Shape(keyword, is_named=element.subkind != "part")


_BY_KIND: dict[Kind, Callable[[Graph, Element], Shape | None]] = {
    **dict.fromkeys(_BEHAVIOURS, behaviour_shape),
    Kind.PROPERTY: _property,
    Kind.FLOW_PROPERTY: _property,
    Kind.PARAMETER: _parameter,
    Kind.PIN: _parameter,
    Kind.ACTIVITY_PARAMETER: _parameter,
    Kind.PORT: _port,
    Kind.ASSOCIATION: _association,
    Kind.INSTANCE: _instance,
    Kind.CONTROL: _control,
    Kind.PSEUDOSTATE: _pseudostate,
    Kind.OBJECT_NODE: _object_node,
    Kind.DATA_STORE: _object_node,
}
