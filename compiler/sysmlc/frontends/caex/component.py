"""Components: internal elements and the classes above them, with the elements that hold members.

The members of an internal element that its class lacks belong to a class of its own, and its
values to an Instance. Both are added when the first member or value needs them.
"""

from collections.abc import Sequence

from sysmlc.frontends.caex.context import Context
from sysmlc.frontends.caex.document import Document, Node
from sysmlc.frontends.caex.types import Member, Type
from sysmlc.frontends.caex.vocabulary import ROLE_REFERENCES, Family
from sysmlc.ir import AttrValue, Edge, Element, Kind

# Access to a member of an enumeration takes twice as long as to a global variable.
_INSTANCE = Kind.INSTANCE
_REPRESENTS = Edge.REPRESENTS

_CLASS_ATTRS: dict[str, AttrValue] = {"subkind": "internal-element", "role": "block"}
_PART_ATTRS: dict[str, AttrValue] = {"aggregation": "composite", "role": "part"}
_INSTANCE_ATTRS: dict[str, AttrValue] = {"subkind": "part"}


class Component:
    """An internal element, or the class at the top of a tree of internal elements.

    ``declared_type`` is the class that it refers to, ``own_type`` the class made for the members
    that this class lacks. For a class at the top they are its base class and the class itself.
    """

    __slots__ = (
        "_root",
        "child_rows",
        "declared_type",
        "document",
        "instance_element",
        "instance_id",
        "interface_ids",
        "is_inherited",
        "is_mirror",
        "name",
        "own_type",
        "parent",
        "part_element",
        "part_id",
        "ppr",
        "role_rows",
        "row",
    )

    def __init__(self, document: Document, row: int, parent: "Component | None") -> None:
        self.document = document
        self.row = row
        self.parent = parent
        self.name = document.attributes[row].get("Name", "")
        self.declared_type: Type | None = None
        self.own_type: Type | None = None
        self.part_id = ""
        """Id of the property that represents it in the class of its parent."""
        self.part_element: Element | None = None
        """The property, if it was added for this component."""
        self.instance_id = ""
        """Id of the Instance that holds its values; empty while there are none."""
        self.instance_element: Element | None = None
        self.ppr = ""
        """``product``, ``process``, ``resource`` or empty."""
        self.is_inherited = False
        """Whether it repeats a part that the class of its parent has."""
        self.is_mirror = False
        self.interface_ids: list[tuple[AttrValue, ...]] = []
        """Ids of inherited ports with the IDs that the file gives them here."""
        self._root: Component | None = None if parent is None else parent._root or parent
        self._collect_rows(document.tags, document.ends)

    def _collect_rows(self, tags: list[str], ends: list[int]) -> None:
        """Collect the rows of the internal elements and role references directly below."""
        child_rows: list[int] = []
        self.role_rows: list[int] = []
        row, end = self.row + 1, ends[self.row]
        while row < end:
            if tags[row] == "InternalElement":
                child_rows.append(row)
            elif tags[row] in ROLE_REFERENCES:
                self.role_rows.append(row)
            row = ends[row]
        self.child_rows: Sequence[int] = child_rows

    @property
    def node(self) -> Node:
        """The node of the internal element or class."""
        return self.document.node(self.row)

    @property
    def root(self) -> "Component":
        """The component at the top of its tree."""
        return self if self._root is None else self._root

    @property
    def type(self) -> Type | None:
        """The class whose members the component has."""
        return self.own_type or self.declared_type

    def find_part_path(self, ancestor: "Component") -> list[str] | None:
        """Return the ids of the parts from *ancestor* down to it; None when it is not below."""
        path = []
        component: Component | None = self
        while component is not ancestor:
            if component is None:
                return None
            path.append(component.part_id)
            component = component.parent
        return path[::-1]


# -- the own class ---------------------------------------------------------------------------------


def ensure_own_type(context: Context, component: Component) -> Type:
    """Return the class for members that the declared class lacks; add it if there is none."""
    if component.own_type is not None:
        return component.own_type
    parent = component.parent
    graph, document = context.graph, component.document
    if parent is not None:
        owner: str | None = ensure_own_type(context, parent).id
    else:
        owner = graph[component.instance_id].owner
    base_id = document.ids[component.row] or f"{owner}/{component.name}"
    element = _add_extra_element(
        context, component, f"{base_id}#class", Kind.CLASS, owner, _CLASS_ATTRS
    )
    own_type = Type(element.id, document, component.row, Family.SYSTEM_UNIT)
    own_type.base = component.declared_type
    component.own_type = own_type
    _replace_part_type(component, own_type)
    if component.declared_type is not None:
        graph.connect(Edge.SPECIALIZES, element, component.declared_type.id)
    if component.is_inherited and parent is not None:
        _redefine_part(context, component, parent, element)
    return own_type


def _add_extra_element(
    context: Context,
    component: Component,
    id: str,
    kind: Kind,
    owner: str | None,
    attrs: dict[str, AttrValue],
) -> Element:
    """Add an element that represents an internal element besides the element with its ID."""
    document = component.document
    ordinal = document.ordinals[component.row]
    if id in context.graph:
        id = context.make_unique(id, component.node)
    return context.graph.add(
        Element(id, kind, component.name, owner, ordinal, document.name, {**attrs})
    )


def _redefine_part(
    context: Context, component: Component, parent: Component, own_type: Element
) -> None:
    """Redefine a part of the class of *parent* with the own type of *component*."""
    graph, owner = context.graph, ensure_own_type(context, parent)
    part = _add_extra_element(
        context, component, f"{own_type.id}#part", Kind.PROPERTY, owner.id, _PART_ATTRS
    )
    graph.connect(Edge.TYPED_BY, part, own_type)
    graph.connect(Edge.REDEFINES, part, component.part_id)
    member = Member(part.id, component.own_type, component.document, component.row)
    owner.members["InternalElement", component.name] = member
    if component.instance_id:
        graph.replace_targets(Edge.REPRESENTS, graph[component.instance_id], [part])
    component.part_id = part.id


def _replace_part_type(component: Component, own_type: Type) -> None:
    """Replace the type of the component's part among the members of its parent's own class."""
    owner = component.parent.own_type if component.parent is not None else None
    if owner is None:
        return
    key = ("InternalElement", component.name)
    member = owner.members.get(key)
    if member is not None and member.row == component.row and member.document is component.document:
        owner.members[key] = member._replace(type=own_type)


# -- the instance ----------------------------------------------------------------------------------


def ensure_instance(context: Context, component: Component) -> str:
    """Return the id of the Instance with the values of a component; add it if there is none.

    The Instances of its ancestors are added too. Values of a class at the top of a tree belong to
    the class, whose id is returned.
    """
    parent = component.parent
    if parent is not None and parent.instance_id and not component.instance_id:
        _add_instance(context, component)
        return component.instance_id
    pending = []
    ancestor: Component | None = component
    while ancestor is not None and not ancestor.instance_id and ancestor.parent is not None:
        pending.append(ancestor)
        ancestor = ancestor.parent
    for ancestor in reversed(pending):
        _add_instance(context, ancestor)
    return component.instance_id or ensure_own_type(context, component).id


def _add_instance(context: Context, component: Component) -> None:
    parent = component.parent
    owner = None
    if parent is not None:
        owner = parent.instance_id or ensure_own_type(context, parent).id
    document = component.document
    # The Instance has the ID of the internal element unless the part has it.
    if component.is_inherited:
        id = context.derive_id(document, component.row, owner)
    else:
        id = f"{component.part_id}#values"
    element = _add_extra_element(context, component, id, _INSTANCE, owner, _INSTANCE_ATTRS)
    context.graph.connect(_REPRESENTS, element, component.part_id)
    component.instance_id, component.instance_element = element.id, element
    if component.is_inherited:
        document.element_ids[component.row] = element.id
