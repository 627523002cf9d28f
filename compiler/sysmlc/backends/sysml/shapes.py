"""From kinds and roles to the keywords of definitions and usages (SysML v2, 8.2.2)."""

from collections.abc import Callable, Iterator

from msgspec import Struct

from sysmlc.backends.sysml.inherited import inherited
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.query import type_of
from sysmlc.ir.query.activities import is_joined


class Shape(Struct, frozen=True):
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

    @property
    def inherited(self) -> frozenset[str]:
        """Names that it has from the standard library, whatever the element specialises."""
        return inherited(self.keyword)

    @property
    def reserved(self) -> frozenset[str]:
        """Those of them that mean something where a behaviour is written: no member has them."""
        return _IN_BEHAVIOURS if self.plain in _RUNNING else frozenset()


_RUNNING = ("action", "state", "verification", "occurrence")
_IN_BEHAVIOURS = frozenset({"start", "done", "self", "this", "that"})


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
HOLDERS = (Kind.PACKAGE, Kind.PROFILE)


_Known = dict[str, Shape | None]
"""How elements are written that others are typed by, by id: each is looked at once."""


def shape_of(graph: Graph, element: Element, known: _Known) -> Shape | None:
    """How an element is written as a member of a namespace; None for what is no member.

    ``known`` is what was found of types before, in the same graph.
    """
    kind = element.kind
    if kind in _DEFINITIONS:
        role = element.role if kind in _BY_ROLE else ""
        return Shape(_ROLES.get(role, _DEFINITIONS[kind]))
    write = _BY_KIND.get(kind)
    return _MEMBERS.get(kind) if write is None else write(graph, element, known)


_BY_ROLE = (Kind.CLASS, Kind.DATA_TYPE, Kind.COMPONENT, Kind.PACKAGE)


def _property(graph: Graph, element: Element, known: _Known) -> Shape:
    keyword = _keyword(graph, element, known)
    flows = "direction" in element.attrs
    return Shape("item" if flows and keyword == "part" else keyword)


def _port(graph: Graph, element: Element, known: _Known) -> Shape:
    return Shape("part" if _is_part(graph, element, known) else "port")


def _control(graph: Graph, element: Element, _known: _Known) -> Shape | None:
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
    return found.count("final") > 1 or not is_joined(graph, element)


def _pseudostate(_graph: Graph, element: Element, _known: _Known) -> Shape | None:
    return None if element.subkind == "initial" else Shape("state")


def _object_node(graph: Graph, element: Element, known: _Known) -> Shape:
    keyword = _keyword(graph, element, known)
    return Shape(keyword if keyword in ("attribute", "item", "occurrence") else "item")


def _behaviour(graph: Graph, element: Element, _known: _Known) -> Shape:
    """A behaviour of a package is a definition, one of anything else a usage of its owner.

    Only a usage may speak of the features of its owner without a path to them.
    """
    keyword = _BEHAVIOURS[element.kind]
    if element.role == "test case":
        keyword = "verification"
    owner = graph.owner(element)
    is_definition = owner is None or owner.kind in HOLDERS or owner.kind in _BEHAVIOURS
    return Shape(f"{keyword} def" if is_definition else keyword, is_named=is_definition)


def _keyword(graph: Graph, feature: Element, known: _Known) -> str:
    """Keyword of a feature by its type, else by its role."""
    shape = _shape_of_type(graph, feature, type_of(graph, feature), known)
    if shape is not None:
        return _USED_BY_KEYWORD.get(shape.keyword, "ref")
    role = feature.role
    if role == "part" or feature.attrs.get("aggregation") == "composite":
        return "part"
    is_value = role in ("value", "constraint parameter") or "default" in feature.attrs
    return "attribute" if is_value else "ref"


def _shape_of_type(
    graph: Graph, element: Element, type_: Element | None, known: _Known
) -> Shape | None:
    """How the type of an element is written; None where types lead in a circle."""
    if type_ is None or type_.kind in _DEFINITIONS:
        return None if type_ is None else shape_of(graph, type_, known)
    if type_.id not in known:
        for one in _types_of_types(graph, element, known):
            known[one.id] = shape_of(graph, one, known)
    return known.get(type_.id)


def _types_of_types(graph: Graph, element: Element, known: _Known) -> list[Element]:
    """What decides how an element is written and is not known yet, each behind its own types.

    What leads into a circle is known to be nothing then.
    """
    found: dict[str, Element] = {}
    open_: dict[str, Iterator[Element]] = {element.id: iter(_types(graph, element))}
    way = [element]
    while way:
        one = next(open_[way[-1].id], None)
        if one is None:
            done = way.pop()
            del open_[done.id]
            found[done.id] = done
        elif one.id in open_:
            known.update(dict.fromkeys(list(open_)[1:]))
            return []
        elif one.kind not in _DEFINITIONS and not (one.id in found or one.id in known):
            open_[one.id] = iter(_types(graph, one))
            way.append(one)
    return list(found.values())[:-1]


def _types(graph: Graph, element: Element) -> list[Element]:
    """What decides how an element is written: its types, or those of its ends."""
    if element.kind is Kind.INSTANCE:
        return graph.targets(element, Edge.INSTANCE_OF)
    ends = graph.targets(element, Edge.END) if element.kind is Kind.ASSOCIATION else [element]
    found = {type_.id: type_ for end in ends if (type_ := type_of(graph, end)) is not None}
    return list(found.values())


def is_part_port(graph: Graph, port: Element) -> bool:
    """Whether a port is written as a part: it is typed by a block, and nothing only flows."""
    return _is_part(graph, port, {})


def _is_part(graph: Graph, port: Element, known: _Known) -> bool:
    if port.role == "flow port":
        return False
    shape = _shape_of_type(graph, port, type_of(graph, port), known)
    return shape is not None and shape.keyword == "part def"


def _parameter(graph: Graph, element: Element, known: _Known) -> Shape | None:
    if element.kind is Kind.ACTIVITY_PARAMETER and graph.targets(element, Edge.REFERENCES):
        return None
    keyword = _keyword(graph, element, known)
    return Shape("item" if keyword == "part" else keyword)


def _association(graph: Graph, element: Element, known: _Known) -> Shape:
    ends = (type_of(graph, end) for end in graph.targets(element, Edge.END))
    types = {"" if one is None else one.id: one for one in ends}
    shapes = [_shape_of_type(graph, element, one, known) for one in types.values()]
    joins_ports = bool(shapes) and all(one and one.keyword == "port def" for one in shapes)
    return Shape("interface def" if joins_ports else "connection def", is_named=False)


def _instance(graph: Graph, element: Element, known: _Known) -> Shape:
    if element.role in ("unit", "quantity kind"):
        return Shape("attribute")
    type_ = graph.target(element, Edge.INSTANCE_OF)
    shape = _shape_of_type(graph, element, type_, known)
    keyword = "part" if shape is None else _USED_BY_KEYWORD.get(shape.keyword, "ref")
    return Shape(keyword, is_named=element.subkind != "part")


_BY_KIND: dict[Kind, Callable[[Graph, Element, _Known], Shape | None]] = {
    **dict.fromkeys(_BEHAVIOURS, _behaviour),
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
