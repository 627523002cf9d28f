"""Lowers trees of internal elements: parts of classes, and instances with the values they give."""

from collections.abc import Iterator

from sysmlc.diagnostics import Verdict
from sysmlc.frontends.caex import groups
from sysmlc.frontends.caex.component import Component, ensure_instance, ensure_own_type
from sysmlc.frontends.caex.context import Context
from sysmlc.frontends.caex.document import Document, Node
from sysmlc.frontends.caex.members import lower_members
from sysmlc.frontends.caex.types import Member, Type, make_member
from sysmlc.frontends.caex.vocabulary import Family
from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind

# Access to a member of an enumeration takes twice as long as to a global variable.
_MAPPED = Verdict.MAPPED
_PROPERTY = Kind.PROPERTY
_SYSTEM_UNIT = Family.SYSTEM_UNIT

_REFERENCE_ATTRS: dict[str, AttrValue] = {"role": "reference"}
_PART_ATTRS: dict[str, AttrValue] = {"role": "part", "aggregation": "composite"}


class Components:
    """Lowers all internal elements of a unit, and finds their components by row.

    Iteration yields the components in the order of their lowering: classes before plants.
    """

    def __init__(self, context: Context) -> None:
        self._context = context
        self._all: list[Component] = []
        self._by_row: dict[Document, list[Component | None]] = {}
        self._mirrors: list[Component] = []
        self._groups: list[Component] = []
        """Facets and groups."""

    def __iter__(self) -> Iterator[Component]:
        return iter(self._all)

    def find(self, node: Node) -> Component | None:
        """Return the component of an internal element or class."""
        return self.by_row(node.document)[node.row]

    def by_row(self, document: Document) -> list[Component | None]:
        """Return the component of each row of a file, None for other rows."""
        components = self._by_row.get(document)
        if components is None:
            components = self._by_row[document] = [None] * len(document.tags)
        return components

    def find_part(self, component: Component) -> Element | None:
        """Return the property that represents a component in the class of its parent."""
        element = component.part_element
        if element and element.id == component.part_id:
            return element
        return self._context.graph.get(component.part_id)

    def find_instance(self, component: Component) -> Element | None:
        """Return the Instance that holds the values of a component."""
        element = component.instance_element
        if element and element.id == component.instance_id:
            return element
        return self._context.graph.get(component.instance_id)

    # -- lowering ----------------------------------------------------------------------------------

    def lower_class(self, type: Type) -> None:
        """Lower the internal elements of a class."""
        root = self._add_component(type.document, type.row, None)
        root.own_type, root.declared_type = type, type.base
        self._lower_below(root)

    def lower_hierarchies(self, document: Document) -> None:
        """Lower all instance hierarchies of a file."""
        for node in document.root.iter_children("InstanceHierarchy"):
            self._lower_hierarchy(node, document)

    def _lower_hierarchy(self, node: Node, document: Document) -> None:
        """Add a package with an Instance for each internal element at the top of the hierarchy."""
        package = self._context.add_element(
            Kind.PACKAGE,
            node,
            document,
            None,
            subkind="instance-hierarchy",
            version=node.child_text("Version"),
        )
        for child in node.iter_children("InternalElement"):
            self._lower_root(child, document, package)

    def _lower_root(self, node: Node, document: Document, package: Element) -> None:
        component = self._add_component(document, node.row, None)
        component.instance_id = package.id
        if self._lower_group(component):
            return
        component.declared_type = self._resolve_declared_type(component)
        instance = self._context.add_element(Kind.INSTANCE, node, document, package.id)
        component.instance_id, component.instance_element = instance.id, instance
        self._lower_members(component)
        self._lower_below(component)

    def _add_component(self, document: Document, row: int, parent: Component | None) -> Component:
        component = self.by_row(document)[row] = Component(document, row, parent)
        self._all.append(component)
        return component

    def _lower_group(self, component: Component) -> bool:
        """Lower the internal element if it is a facet or group; return whether it is one.

        A facet or group is no part: it refers to other elements. A group may contain groups.
        """
        kind = groups.find_group_kind(self._context, component)
        if kind is None:
            return False
        groups.lower_group(self._context, component, kind)
        self._groups.append(component)
        document = component.document
        if kind is Kind.GROUP:
            for row in component.child_rows:
                child = Component(document, row, component)
                if groups.find_group_kind(self._context, child) is Kind.GROUP:
                    self._lower_group(self._add_component(document, row, component))
        return True

    def _lower_members(self, component: Component) -> None:
        """Lower the members of a component; one without a class gets a class of its own.

        Members of mirrors wait until all masters exist.
        """
        if component.is_mirror:
            self._mirrors.append(component)
            return
        if component.type is None:
            ensure_own_type(self._context, component)
        lower_members(self._context, component)

    def _lower_below(self, root: Component) -> None:
        # A worklist, because hierarchies may be deeper than the stack of Python.
        worklist = [root]
        while worklist:
            component = worklist.pop()
            if component.child_rows and not component.is_mirror:
                children = [self._lower_child(row, component) for row in component.child_rows]
                component.child_rows = ()
                worklist += [child for child in reversed(children) if child is not None]

    def _lower_child(self, row: int, parent: Component) -> Component | None:
        """Lower an internal element below another; None for a facet or group."""
        component = self._add_component(parent.document, row, parent)
        if component.role_rows and self._lower_group(component):
            return None
        component.declared_type = self._resolve_declared_type(component)
        inherited = None if component.is_mirror else _find_inherited_part(component, parent)
        if inherited is None or _is_of_unrelated_class(component, inherited):
            self._add_part(component, parent)
        else:
            self._match_part(component, inherited)
        self._lower_members(component)
        return component

    def _resolve_declared_type(self, component: Component) -> Type | None:
        """Return the class that an internal element names; note whether it is a mirror instead."""
        context, document = self._context, component.document
        path = document.attributes[component.row].get("RefBaseSystemUnitPath", "").strip()
        if not path:
            return None
        type = context.find_resolved(path, _SYSTEM_UNIT, document)
        if type is not None:
            return type
        component.is_mirror = context.mirrors.is_id_reference(path)
        if component.is_mirror:
            return None
        return context.resolve_type(path, _SYSTEM_UNIT, document, component.node)

    def _match_part(self, component: Component, inherited: Member) -> None:
        """Let an internal element represent a part that the class of its parent has."""
        component.is_inherited = True
        component.part_id = inherited.id
        type, declared = inherited.type, component.declared_type
        if type is not None and not (declared is not None and declared.specializes(type)):
            component.declared_type = type
        component.document.verdicts[component.row] = _MAPPED
        ensure_instance(self._context, component)

    def _add_part(self, component: Component, parent: Component) -> None:
        """Add a property for an internal element to the own class of its parent."""
        document, row = component.document, component.row
        owner = ensure_own_type(self._context, parent)
        attrs = _REFERENCE_ATTRS if component.is_mirror else _PART_ATTRS
        element = self._context.add_row(_PROPERTY, document, row, owner.id, attrs=attrs)
        key = ("InternalElement", component.name)
        inherited = owner.base.find_member(*key) if owner.base else None
        owner.members[key] = make_member((element.id, component.declared_type, document, row))
        component.part_id, component.part_element = element.id, element
        if inherited is not None:
            self._context.graph.connect(Edge.REDEFINES, element.id, inherited.id)

    # -- completion --------------------------------------------------------------------------------

    def complete(self) -> None:
        """Connect what needs all elements: mirrors, content of groups, types of components."""
        for component in self._mirrors:
            self._connect_mirror(component)
        for component in self._groups:
            groups.connect_content(self._context, component)
        groups.report_unknown_facets(self._context.graph, self._context.findings, self._groups)
        self._connect_types()

    def _connect_types(self) -> None:
        """Connect the elements of each component to its type, and store the IDs of interfaces."""
        graph, type_elements = self._context.graph, _TypeElements(self._context.graph)
        for component in self._all:
            type = type_elements[component.own_type or component.declared_type]
            instance = self.find_instance(component) if component.instance_id else None
            has_part = component.part_id and not component.is_inherited
            part = self.find_part(component) if has_part else None
            if type is not None and instance is not None:
                graph.connect(Edge.INSTANCE_OF, instance, type)
            if type is not None and part is not None:
                graph.connect(Edge.TYPED_BY, part, type)
            holder = instance or part
            if component.interface_ids and holder is not None:
                graph.set(holder, interface_ids=tuple(component.interface_ids))
                component.interface_ids.clear()

    def _connect_mirror(self, component: Component) -> None:
        """Connect a mirror to its master, and lower its own members.

        CAEX 3.0 forbids members of mirrors, but files of CAEX 2.15 have them.
        """
        element = self._context.graph[component.instance_id or component.part_id]
        node = component.node
        master = self._context.mirrors.connect_to_master(component.document, node, element)
        original = self.find(master) if master is not None else None
        component.declared_type = original.type if original else None
        if component.type is None and node.has_child("Attribute", "ExternalInterface"):
            ensure_own_type(self._context, component)
        if component.type is not None:
            lower_members(self._context, component)


class _TypeElements(dict[Type | None, Element | None]):
    """Memoised elements of types."""

    def __init__(self, graph: Graph) -> None:
        super().__init__()
        self._graph = graph

    def __missing__(self, type: Type | None) -> Element | None:
        element = self[type] = None if type is None else self._graph.get(type.id)
        return element


def _find_inherited_part(component: Component, parent: Component) -> Member | None:
    """Return the part of the class of *parent* that an internal element of its name repeats.

    An internal element directly in a class does not repeat a part of the base class: it overrides.
    """
    declared = parent.declared_type
    if declared is None:
        return None
    is_class = parent.own_type is not None and parent.row == parent.own_type.row
    if parent.parent is None and is_class and not parent.instance_id:
        return None
    return declared.find_member("InternalElement", component.name)


def _is_of_unrelated_class(component: Component, inherited: Member) -> bool:
    """Whether an internal element names a class that is neither above nor below that of a part."""
    declared, type = component.declared_type, inherited.type
    if declared is None or type is None:
        return False
    return not (declared.specializes(type) or type.specializes(declared))
