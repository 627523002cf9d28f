"""Internal elements: parts of classes, and instances with the values that they give."""

from dataclasses import dataclass, field

from sysmlc.backends.aml import attributes, groups, header, interfaces, roles
from sysmlc.backends.aml.attributes import unresolved
from sysmlc.backends.aml.book import Book, File
from sysmlc.backends.aml.families import Family, is_inline
from sysmlc.backends.aml.node import Node
from sysmlc.backends.aml.rules import UNSAID_EDGE
from sysmlc.backends.aml.values import text_of
from sysmlc.ir import Edge, Element, Kind

_REFERENCE = "RefBaseSystemUnitPath"
_PARTS = frozenset({"part", "reference"})


@dataclass(slots=True, eq=False)
class Unit:
    """What one internal element is in the graph: a part, its instance, the class made for it."""

    node: Node
    file: File
    part: Element | None = None
    instance: Element | None = None
    own: Element | None = None
    inside: list["Unit"] = field(default_factory=list)

    @property
    def players(self) -> list[Element]:
        """The elements that it is."""
        return [one for one in (self.own, self.part, self.instance) if one is not None]


def fill_class(book: Book, element: Element, node: Node, file: File) -> None:
    """What a system unit class or role class holds, with all internal elements below."""
    _fill(book, Unit(node, file, own=element))


def fill_hierarchy(book: Book, package: Element, node: Node, file: File) -> None:
    """The internal elements at the top of a hierarchy, with all below."""
    for one in book.graph.owned(package):
        if one.kind is Kind.INSTANCE and is_plant(book, one):
            unit = _unit(book, node, file, None, one)
            _fill(book, unit)
        elif one.kind in groups.ROLES:
            node.add(groups.write(book, one, file))


def has_instances(book: Book, package: Element) -> bool:
    """Whether a package holds instances of blocks."""
    return any(
        one.kind is Kind.INSTANCE and is_plant(book, one) for one in book.graph.owned(package)
    )


def is_plant(book: Book, instance: Element) -> bool:
    """Whether an instance is part of a plant: of a block, or nobody knows of what."""
    if book.ids.is_ours(instance):
        return True
    type_ = book.graph.target(instance, Edge.INSTANCE_OF)
    if type_ is None or instance.role or type_.attrs.get("external"):
        return False
    return book.families.of(type_) is Family.SYSTEM_UNIT


def _fill(book: Book, top: Unit) -> None:
    waiting = [top]
    while waiting:
        unit = waiting.pop()
        _members(book, unit)
        players = [one for one in unit.players if one is not unit.part or unit.own is None]
        roles.write(book, unit.node, unit.file, *dict.fromkeys([*players, *unit.players]))
        if unit.players != [unit.own] and not _is_mirror(book, unit):
            declared = _declared(book, unit)
            if declared is not None:
                roles.inherited(book, unit.node, unit.file, declared)
                book.copies.append((unit.node, declared))
        for type_ in (unit.own, _declared(book, unit)):
            if type_ is not None:
                roles.map_features(book, unit.node, unit.file, type_)
        waiting += reversed(unit.inside)


def _members(book: Book, unit: Unit) -> None:
    """Attributes, interfaces and elements: those of the class made for it, then the instance's."""
    graph = book.graph
    for one in book.owned(unit.own):
        if attributes.is_attribute(book, one):
            unit.node.add(attributes.write(book, one, unit.file))
        elif one.kind is Kind.PORT:
            interfaces.write(book, one, unit.file, unit.node)
        elif _is_part(book, one):
            below = _instance_of_part(book, unit, one)
            unit.inside.append(_unit(book, unit.node, unit.file, one, below))
        elif one.kind in groups.ROLES:
            unit.node.add(groups.write(book, one, unit.file))
    _interface_ids(book, unit)
    for one in [*book.owned(unit.instance), *_values_of_class(book, unit)]:
        if one.kind is Kind.SLOT:
            _slot(book, unit, one)
        elif one.kind is Kind.INSTANCE and one.subkind == "part" and one.id not in book.said:
            unit.inside.append(_unit(book, unit.node, unit.file, None, one))
        elif one.kind is Kind.COMMENT and graph.targets(one, Edge.REFERENCES):
            _description(book, unit, one)


def _is_part(book: Book, one: Element) -> bool:
    if one.kind is not Kind.PROPERTY or one.role not in _PARTS:
        return False
    if one.role == "part":
        return not book.graph.target(one, Edge.TYPED_BY) or _is_unit_type(book, one)
    return book.ids.is_ours(one)


def _is_unit_type(book: Book, part: Element) -> bool:
    type_ = book.graph.target(part, Edge.TYPED_BY)
    if type_ is None or is_inline(type_):
        return True
    place = book.places.get(type_.id)
    return place is None or place.family is Family.SYSTEM_UNIT


def _values_of_class(book: Book, unit: Unit) -> list[Element]:
    """Instances that a class owns for the values of its parts, and slots of its own."""
    if unit.instance is not None or unit.own is None:
        return []
    kinds = (Kind.INSTANCE, Kind.SLOT, Kind.COMMENT)
    return [one for one in book.graph.owned(unit.own) if one.kind in kinds]


def _instance_of_part(book: Book, unit: Unit, part: Element) -> Element | None:
    """The instance that holds the values of a part of this element."""
    owners = {one.id for one in (unit.instance, unit.own) if one is not None}
    found = (i for i in book.graph.sources(part, Edge.REPRESENTS) if i.owner in owners)
    return next((one for one in found if one.kind is Kind.INSTANCE), None)


def _unit(
    book: Book, above: Node, file: File, part: Element | None, instance: Element | None
) -> Unit:
    """A new internal element; it says its class unless only the class above knows that."""
    known = part or instance
    node = above.add(Node("InternalElement", {"Name": known.name if known else ""}))
    unit = Unit(node, file, part, instance)
    unit.own = _own(book, unit)
    node.attributes["ID"] = book.ids.of(part, instance, unit.own)
    for one in unit.players:
        book.put(one, node)
        header.write(book, one, node)
    _refer(book, unit)
    _enter(book, above, unit)
    return unit


def _enter(book: Book, above: Node, unit: Unit) -> None:
    """Let links find the element by the part of the class above that it stands for."""
    graph = book.graph
    waiting = [unit.part] if unit.part is not None else []
    if unit.instance is not None:
        for one in graph.targets(unit.instance, Edge.REPRESENTS):
            book.say(Edge.REPRESENTS, unit.instance, one)
            waiting.append(one)
    while waiting:
        one = waiting.pop()
        if one.id not in above.parts:
            above.parts[one.id] = unit.node
            waiting += graph.targets(one, Edge.REDEFINES)


def _types(book: Book, unit: Unit) -> list[Element]:
    graph, found = book.graph, []
    for one, edge in ((unit.part, Edge.TYPED_BY), (unit.instance, Edge.INSTANCE_OF)):
        for type_ in graph.targets(one, edge) if one is not None else ():
            book.say(edge, one, type_) if one is not None else None
            found.append(type_)
    return found


def _own(book: Book, unit: Unit) -> Element | None:
    """The class that was made for this element alone."""
    owner = unit.part.owner if unit.part is not None else None
    if unit.part is None and unit.instance is not None and unit.instance.subkind != "part":
        owner = unit.instance.owner
    of_masters = _types_of_masters(book, unit)
    for one in _types(book, unit):
        is_own = one.kind is Kind.CLASS and one.subkind == "internal-element"
        if is_own and one.owner == owner and one.id not in of_masters:
            return one
    return None


def _types_of_masters(book: Book, unit: Unit) -> set[str]:
    """Ids of the classes of what a mirror stands for: they are not its own."""
    graph, edges = book.graph, (Edge.TYPED_BY, Edge.INSTANCE_OF)
    players = [one for one in (unit.part, unit.instance) if one is not None]
    masters = [master for one in players for master in graph.targets(one, Edge.MIRRORS)]
    return {type_.id for one in masters for edge in edges for type_ in graph.targets(one, edge)}


def _declared(book: Book, unit: Unit) -> Element | None:
    """The class that the element says; of a part that its class has the one there."""
    if unit.own is not None:
        return book.graph.target(unit.own, Edge.SPECIALIZES)
    return next(iter(_types(book, unit)), None)


def _refer(book: Book, unit: Unit) -> None:
    for one in unit.players:
        for master in book.graph.targets(one, Edge.MIRRORS):
            book.say(Edge.MIRRORS, one, master)
            book.late.append((unit.node, _REFERENCE, master))
    declared = _declared(book, unit)
    if unit.own is not None and declared is not None:
        book.say(Edge.SPECIALIZES, unit.own, declared)
    if _is_mirror(book, unit):
        return
    path = book.path(declared, unit.file) if declared is not None else ""
    missing = next((p for one in unit.players if (p := unresolved(one, "InternalElement"))), "")
    if path or missing:
        unit.node.attributes[_REFERENCE] = path or missing
    elif declared is not None and not is_inline(declared):
        facts = {"edge": "typed-by", "kind": "part", "target": str(declared.kind)}
        book.losses.note(UNSAID_EDGE, unit.players[0], **facts)


def _is_mirror(book: Book, unit: Unit) -> bool:
    return any(book.graph.targets(one, Edge.MIRRORS) for one in unit.players)


# -- values ------------------------------------------------------------------------------------


def _slot(book: Book, unit: Unit, slot: Element) -> None:
    feature = book.graph.target(slot, Edge.INSTANCE_OF)
    if feature is None or not (feature.kind is Kind.PORT or attributes.is_attribute(book, feature)):
        return
    book.say(Edge.INSTANCE_OF, slot, feature)
    path = _path(book, slot)
    if feature.kind is Kind.PORT:
        for one in path:
            interfaces.repeated(book, one, unit.file, unit.node)
        node = interfaces.repeated(book, feature, unit.file, unit.node)
        interfaces.say(book, slot, feature, node)
    else:
        node = _attribute(book, unit, [*path, feature])
        if slot.attrs.get("value") is not None or not _texts(node):
            node.say("Value", text_of(slot.attrs.get("value", "")))
    book.put(slot, node)
    header.write(book, slot, node)


def _texts(node: Node) -> bool:
    return any(child.tag == "Value" for child in node.children)


def _path(book: Book, element: Element) -> list[Element]:
    found = book.graph.targets(element, Edge.PATH)
    for one in found:
        book.say(Edge.PATH, element, one)
    return found


def _attribute(book: Book, unit: Unit, path: list[Element]) -> Node:
    """The attribute of the element that repeats one of its class; added when it is not there."""
    node = unit.node
    for feature in path:
        known = node.child("Attribute", feature.name)
        if known is None:
            known = node.add(Node("Attribute", {"Name": feature.name}, is_copy=True))
            attributes.declare(book, feature, known, unit.file)
        node = known
    return node


def _description(book: Book, unit: Unit, comment: Element) -> None:
    """A text about an attribute of the class, told in this element alone."""
    for feature in book.graph.targets(comment, Edge.REFERENCES):
        if feature.kind is Kind.PROPERTY and not _is_part(book, feature):
            node = _attribute(book, unit, [*_path(book, comment), feature])
            header.describe(book, comment, node)
            book.say(Edge.REFERENCES, comment, feature)


def _interface_ids(book: Book, unit: Unit) -> None:
    """The ids that interfaces of the class have in this element."""
    for one in unit.players:
        found = one.attrs.get("interface_ids")
        for pair in found if isinstance(found, tuple) else ():
            if isinstance(pair, tuple) and len(pair) == 2:
                port = book.graph.get(str(pair[0]))
                if port is not None:
                    node = interfaces.repeated(book, port, unit.file, unit.node)
                    node.attributes["ID"] = str(pair[1])
