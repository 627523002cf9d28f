"""The shape of an element in the text: its keyword, and whether it needs a name.

The kind and the role of an element, and the types of a feature, determine the keyword of the
definition or usage (SysML 2.0, 8.2.2).
"""

from collections.abc import Callable, Iterator

from msgspec import Struct

from sysmlc.backends.sysml.library import list_inherited_names
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.query import type_of
from sysmlc.ir.query.activities import is_joined

_BEHAVIOUR_KEYWORDS = ("action", "state", "verification", "occurrence")
_NAMES_IN_BEHAVIOURS = frozenset({"start", "done", "self", "this", "that"})
_NAMESPACES = frozenset(
    {"package", "library package", "comment", "doc", "dependency", "import", "start"}
)

_CONFORMING = frozenset(
    {
        ("part", "item"),
        ("part", "occurrence"),
        ("item", "occurrence"),
        ("port", "occurrence"),
        ("action", "occurrence"),
        ("state", "action"),
        ("verification", "action"),
        ("enum", "attribute"),
        ("connection", "part"),
        ("interface", "connection"),
        ("interface", "part"),
        ("connection", "occurrence"),
    }
)
"""Pairs of different keywords of which the first may specialise the second."""


class Shape(Struct, frozen=True):
    """The keyword of a member, and whether the text has to name the member."""

    keyword: str
    needs_name: bool = True

    @property
    def is_definition(self) -> bool:
        """Whether the member is a definition, not a usage; packages are neither."""
        return self.keyword.endswith(" def")

    @property
    def is_usage(self) -> bool:
        """Whether the member is a usage: a feature to which feature chains can lead."""
        return not self.is_definition and self.keyword not in _NAMESPACES

    @property
    def usage_keyword(self) -> str:
        """The keyword of a usage, also for the definition of such usages."""
        return self.keyword.removesuffix(" def")

    def may_specialize(self, general: "Shape") -> bool:
        """Whether this definition may specialise *general*, or this usage have it as a type."""
        keywords = (self.usage_keyword, general.usage_keyword)
        return (
            keywords[0] == keywords[1]
            or keywords in _CONFORMING
            or general.is_definition != self.is_definition
        )

    @property
    def library_names(self) -> frozenset[str]:
        """Names that the member inherits from the standard library."""
        return list_inherited_names(self.keyword)

    @property
    def reserved_names(self) -> frozenset[str]:
        """Inherited names with a meaning inside a behaviour, which no member may have."""
        return _NAMES_IN_BEHAVIOURS if self.usage_keyword in _BEHAVIOUR_KEYWORDS else frozenset()


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
_DEFINITIONS_BY_ROLE = {
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
    Kind.CONNECTOR: Shape("connection", needs_name=False),
    Kind.ITEM_FLOW: Shape("flow", needs_name=False),
    Kind.CONSTRAINT: Shape("constraint", needs_name=False),
    Kind.COMMENT: Shape("comment", needs_name=False),
    Kind.DEPENDENCY: Shape("dependency", needs_name=False),
    Kind.CONTROL_FLOW: Shape("succession", needs_name=False),
    Kind.OBJECT_FLOW: Shape("flow", needs_name=False),
    Kind.TRANSITION: Shape("transition", needs_name=False),
    Kind.LIFELINE: Shape("part"),
    Kind.MESSAGE: Shape("message"),
    Kind.FRAGMENT: Shape("occurrence"),
    Kind.OPERAND: Shape("occurrence"),
    Kind.EXTEND: Shape("dependency", needs_name=False),
    Kind.EXTENSION_POINT: Shape("occurrence"),
    Kind.IMPORT: Shape("import", needs_name=False),
    Kind.DOCUMENT: Shape("comment", needs_name=False),
    Kind.METADATA: Shape("comment", needs_name=False),
    Kind.ALIAS: Shape("comment", needs_name=False),
    Kind.FACET: Shape("metadata", needs_name=False),
    Kind.GROUP: Shape("metadata", needs_name=False),
}
_CONTROL_NODES = {"decision": "decide", "merge": "merge", "fork": "fork", "join": "join"}
_FEATURES_BY_TYPE = {
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
"""Keyword of a feature by the keyword of its type; ``ref`` for all other types."""
PACKAGES = (Kind.PACKAGE, Kind.PROFILE)
_MESSAGING = ("send", "broadcast", "accept", "accept-call")
_WITH_ROLE = (Kind.CLASS, Kind.DATA_TYPE, Kind.COMPONENT, Kind.PACKAGE)
"""Kinds whose role may change the keyword."""

_TypeShapes = dict[str, Shape | None]
"""Shapes of types by id, shared by all calls for a graph; None for types that form a cycle."""


def find_shape(graph: Graph, element: Element, type_shapes: _TypeShapes) -> Shape | None:
    """Return the shape of an element; None if the text has no member for it.

    *type_shapes* memoises the shapes of types in this graph.
    """
    kind = element.kind
    if kind in _DEFINITIONS:
        role = element.role if kind in _WITH_ROLE else ""
        return Shape(_DEFINITIONS_BY_ROLE.get(role, _DEFINITIONS[kind]))
    find = _BY_KIND.get(kind)
    return _MEMBERS.get(kind) if find is None else find(graph, element, type_shapes)


def is_part_port(graph: Graph, port: Element) -> bool:
    """Whether a port is written as a part: its type is a block, and it is no flow port."""
    return _is_part_port(graph, port, {})


def is_succession(graph: Graph, flow: Element) -> bool:
    """Whether a flow orders nodes: a control flow, or an object flow of a control node."""
    ends = [graph.target(flow, edge) for edge in (Edge.FLOW_SOURCE, Edge.FLOW_TARGET)]
    has_control_node = any(end is not None and end.kind is Kind.CONTROL for end in ends)
    return flow.kind is Kind.CONTROL_FLOW or (flow.kind is Kind.OBJECT_FLOW and has_control_node)


# -- features ------------------------------------------------------------------------------------


def _find_property_shape(graph: Graph, element: Element, type_shapes: _TypeShapes) -> Shape:
    keyword = _find_feature_keyword(graph, element, type_shapes)
    return Shape("item" if "direction" in element.attrs and keyword == "part" else keyword)


def _find_port_shape(graph: Graph, element: Element, type_shapes: _TypeShapes) -> Shape:
    return Shape("part" if _is_part_port(graph, element, type_shapes) else "port")


def _is_part_port(graph: Graph, port: Element, type_shapes: _TypeShapes) -> bool:
    if port.role == "flow port":
        return False
    shape = _find_type_shape(graph, port, type_of(graph, port), type_shapes)
    return shape is not None and shape.keyword == "part def"


def _find_parameter_shape(graph: Graph, element: Element, type_shapes: _TypeShapes) -> Shape | None:
    """Return the shape of a parameter or pin; None for the node of a parameter, written with it.

    The pins of send and accept actions redefine parameters of the standard library that are no
    attributes (Actions::SendAction, Actions::AcceptAction).
    """
    if element.kind is Kind.ACTIVITY_PARAMETER and graph.targets(element, Edge.REFERENCES):
        return None
    keyword = _find_feature_keyword(graph, element, type_shapes)
    action = graph.owner(element) if keyword == "attribute" and element.kind is Kind.PIN else None
    if action is not None and action.kind is Kind.ACTION and action.subkind in _MESSAGING:
        return Shape("ref")
    return Shape("item" if keyword == "part" else keyword)


def _find_object_node_shape(graph: Graph, element: Element, type_shapes: _TypeShapes) -> Shape:
    keyword = _find_feature_keyword(graph, element, type_shapes)
    return Shape(keyword if keyword in ("attribute", "item", "occurrence") else "item")


def _find_instance_shape(graph: Graph, element: Element, type_shapes: _TypeShapes) -> Shape:
    if element.role in ("unit", "quantity kind"):
        return Shape("attribute")
    type_ = graph.target(element, Edge.INSTANCE_OF)
    shape = _find_type_shape(graph, element, type_, type_shapes)
    keyword = "part" if shape is None else _FEATURES_BY_TYPE.get(shape.keyword, "ref")
    return Shape(keyword, needs_name=element.subkind != "part")


def _find_feature_keyword(graph: Graph, feature: Element, type_shapes: _TypeShapes) -> str:
    """Return the keyword of a feature, derived from its type, else from its role."""
    shape = _find_type_shape(graph, feature, type_of(graph, feature), type_shapes)
    if shape is not None:
        return _FEATURES_BY_TYPE.get(shape.keyword, "ref")
    role = feature.role
    if role == "part" or feature.attrs.get("aggregation") == "composite":
        return "part"
    is_value = role in ("value", "constraint parameter") or "default" in feature.attrs
    return "attribute" if is_value else "ref"


# -- behaviours and associations -----------------------------------------------------------------


def _find_behaviour_shape(graph: Graph, element: Element, _type_shapes: _TypeShapes) -> Shape:
    """Return a definition for a behaviour in a package, a usage for any other behaviour.

    Only a usage may refer to the features of its owner without a path to them.
    """
    keyword = _BEHAVIOURS[element.kind]
    if element.role == "test case":
        keyword = "verification"
    owner = graph.owner(element)
    is_definition = owner is None or owner.kind in PACKAGES or owner.kind in _BEHAVIOURS
    return Shape(f"{keyword} def" if is_definition else keyword, needs_name=is_definition)


def _find_control_node_shape(
    graph: Graph, element: Element, _type_shapes: _TypeShapes
) -> Shape | None:
    """Return the shape of a control node; None for a final node that ``done`` expresses."""
    if element.subkind == "initial":
        return Shape("start", needs_name=False)
    keyword = _CONTROL_NODES.get(element.subkind)
    if keyword is None and element.subkind == "final" and _is_terminating(graph, element):
        return Shape("action")
    return Shape(keyword) if keyword else None


def _is_terminating(graph: Graph, final_node: Element) -> bool:
    """Whether a final node ends concurrent flows, or is not the only end of the behaviour."""
    owner = graph.owner(final_node)
    siblings = [] if owner is None else graph.owned(owner)
    subkinds = [sibling.subkind for sibling in siblings if sibling.kind is Kind.CONTROL]
    has_other_end = subkinds.count("final") > 1 or "flow-final" in subkinds
    has_several_starts = subkinds.count("initial") > 1
    return has_other_end or has_several_starts or not is_joined(graph, final_node)


def _find_pseudostate_shape(
    _graph: Graph, element: Element, _type_shapes: _TypeShapes
) -> Shape | None:
    return None if element.subkind == "initial" else Shape("state")


def _find_association_shape(graph: Graph, element: Element, type_shapes: _TypeShapes) -> Shape:
    """Return an interface definition if all ends are ports, else a connection definition."""
    end_types = (type_of(graph, end) for end in graph.targets(element, Edge.END))
    types = {"" if type_ is None else type_.id: type_ for type_ in end_types}
    shapes = [_find_type_shape(graph, element, type_, type_shapes) for type_ in types.values()]
    joins_ports = bool(shapes) and all(shape and shape.keyword == "port def" for shape in shapes)
    return Shape("interface def" if joins_ports else "connection def", needs_name=False)


# -- shapes of types -----------------------------------------------------------------------------


def _find_type_shape(
    graph: Graph, element: Element, type_: Element | None, type_shapes: _TypeShapes
) -> Shape | None:
    """Return the shape of the type of *element*; None where types form a cycle."""
    if type_ is None or type_.kind in _DEFINITIONS:
        return None if type_ is None else find_shape(graph, type_, type_shapes)
    if type_.id not in type_shapes:
        for dependency in _order_type_dependencies(graph, element, type_shapes):
            type_shapes[dependency.id] = find_shape(graph, dependency, type_shapes)
    return type_shapes.get(type_.id)


def _order_type_dependencies(
    graph: Graph, element: Element, type_shapes: _TypeShapes
) -> list[Element]:
    """Return the elements that determine the shape of *element*, each after its own types.

    This is a topological sort by depth-first search without recursion: types may lead to types
    over thousands of steps. In a cycle, the shapes of all types on the path are set to None.
    """
    ordered: dict[str, Element] = {}
    open_types: dict[str, Iterator[Element]] = {element.id: iter(_list_types(graph, element))}
    path = [element]
    while path:
        type_ = next(open_types[path[-1].id], None)
        if type_ is None:
            finished = path.pop()
            del open_types[finished.id]
            ordered[finished.id] = finished
        elif type_.id in open_types:
            type_shapes.update(dict.fromkeys(list(open_types)[1:]))
            return []
        elif type_.kind not in _DEFINITIONS and not (
            type_.id in ordered or type_.id in type_shapes
        ):
            open_types[type_.id] = iter(_list_types(graph, type_))
            path.append(type_)
    return list(ordered.values())[:-1]


def _list_types(graph: Graph, element: Element) -> list[Element]:
    """Return the types that determine the shape of an element: its own, or those of its ends."""
    if element.kind is Kind.INSTANCE:
        return graph.targets(element, Edge.INSTANCE_OF)
    ends = graph.targets(element, Edge.END) if element.kind is Kind.ASSOCIATION else [element]
    types = {type_.id: type_ for end in ends if (type_ := type_of(graph, end)) is not None}
    return list(types.values())


_BY_KIND: dict[Kind, Callable[[Graph, Element, _TypeShapes], Shape | None]] = {
    **dict.fromkeys(_BEHAVIOURS, _find_behaviour_shape),
    Kind.PROPERTY: _find_property_shape,
    Kind.FLOW_PROPERTY: _find_property_shape,
    Kind.PARAMETER: _find_parameter_shape,
    Kind.PIN: _find_parameter_shape,
    Kind.ACTIVITY_PARAMETER: _find_parameter_shape,
    Kind.PORT: _find_port_shape,
    Kind.ASSOCIATION: _find_association_shape,
    Kind.INSTANCE: _find_instance_shape,
    Kind.CONTROL: _find_control_node_shape,
    Kind.PSEUDOSTATE: _find_pseudostate_shape,
    Kind.OBJECT_NODE: _find_object_node_shape,
    Kind.DATA_STORE: _find_object_node_shape,
}
