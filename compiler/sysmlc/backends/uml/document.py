"""The whole document: nodes for all elements, then what they hold, then stereotypes."""

from collections.abc import Iterator

from sysmlc.backends.uml import attributes, events, relations
from sysmlc.backends.uml.book import Book
from sysmlc.backends.uml.hrefs import is_outside
from sysmlc.backends.uml.identity import part_id
from sysmlc.backends.uml.kept import Kept, is_plant
from sysmlc.backends.uml.metaclasses import APPROXIMATED as RESTATED
from sysmlc.backends.uml.metaclasses import UNSAID, metaclass_of
from sysmlc.backends.uml.node import Node, printed
from sysmlc.backends.uml.places import place
from sysmlc.backends.uml.rules import (
    APPROXIMATED,
    ILLEGAL,
    MOVED,
    RESPELT_ID,
    UNSAID_ATTRIBUTE,
    UNSAID_KIND,
    Losses,
)
from sysmlc.backends.uml.stereotypes import Stereotypes
from sysmlc.diagnostics import Sink, Subject
from sysmlc.ir import Edge, Element, Graph, Kind

_NAMESPACES = {
    "xmi": "http://www.omg.org/spec/XMI/20131001",
    "xsi": "http://www.w3.org/2001/XMLSchema-instance",
    "ecore": "http://www.eclipse.org/emf/2002/Ecore",
    "uml": "http://www.eclipse.org/uml2/5.0.0/UML",
}
_UNNAMED = frozenset(
    {
        Kind.COMMENT,
        Kind.SLOT,
        Kind.IMPORT,
        Kind.CONNECTOR_END,
        Kind.TEMPLATE_BINDING,
        Kind.TEMPLATE_SUBSTITUTION,
    }
)
"""Kinds that UML gives no name; a template parameter is called as what it stands for."""
_OF_PASSES = frozenset({Kind.UNIT, Kind.QUANTITY_KIND, Kind.VIEW})
"""Kinds of what passes add to a model, besides stubs."""
_VALUES = ("value", "default")
"""Attributes with values of attributes."""
_PROFILE = "pathmap://SysML16_PROFILES/SysML.profile.uml#SysML.package_packagedElement_"
_NOTE = "http://www.eclipse.org/uml2/2.0.0/UML"


def document(graph: Graph, sink: Sink) -> str:
    """The graph as XMI; what UML cannot say is reported."""
    losses = Losses(graph)
    book = Book(graph, losses)
    if is_plant(graph):
        losses.kept = Kept(graph, book.ids)
        losses.kept.libraries()
    root = Node("xmi:XMI")
    for top in graph.roots():
        _nodes(book, top)
    for wire in _wires(graph):
        if wire.owner in book.nodes:
            _nodes(book, wire)
    _parts(book)
    root.children = book.tops
    stereotypes = Stereotypes(book, root)
    stereotypes.write()
    _profiles(book, stereotypes)
    _keep(book)
    _note_respelt(book)
    spaces = _NAMESPACES | stereotypes.namespaces
    root.attributes = {"xmi:version": "20131001"}
    root.attributes |= {f"xmlns:{prefix}": spaces[prefix] for prefix in spaces}
    text, replaced = printed(root)
    losses.report(sink)
    if replaced:
        first = next((graph.subject(one) for one in graph.roots()), Subject())
        sink.report(ILLEGAL, first, count=replaced)
    return text


def _note_respelt(book: Book) -> None:
    """Note the values that name an element by an id which the saved element does not have."""
    respelt = {id for id, written in book.ids.items() if id != written}
    for element in book.graph if respelt else ():
        if any(element.attrs.get(key) in respelt for key in _VALUES):
            book.losses.note(RESPELT_ID, element)


# -- nodes -------------------------------------------------------------------------------------


def _nodes(book: Book, top: Element) -> None:
    """Nodes for an element and all below it that is written, each at its place."""
    graph, stack = book.graph, [top]
    while stack:
        element = stack.pop()
        if not _is_written(book, element) or (element is not top and _is_wire(graph, element)):
            continue
        _place(book, element)
        stack.extend(reversed(book.graph.owned(element)))


def _wires(graph: Graph) -> list[Element]:
    """Connectors of instances come last: their classes hold them, wherever these are."""
    return [one for one in graph.of_kind(Kind.CONNECTOR) if _is_wire(graph, one)]


def _is_wire(graph: Graph, element: Element) -> bool:
    owner = graph.owner(element)
    return element.kind is Kind.CONNECTOR and owner is not None and owner.kind is Kind.INSTANCE


def _is_written(book: Book, element: Element) -> bool:
    if is_outside(element) or element.kind is Kind.APPLICATION:
        return False
    if element.kind in _OF_PASSES and "origin" in element.attrs:
        return False
    if element.kind in UNSAID:
        for one in book.graph.subtree(element):
            book.losses.note(UNSAID_KIND, one, kind=str(one.kind))
        return False
    return True


def _place(book: Book, element: Element) -> None:
    metaclass, is_whole = metaclass_of(book.graph, element)
    holder, feature = _holder(book, element)
    if holder is None:
        feature = ""
    node = Node(feature or f"uml:{metaclass}", is_element=True)
    if feature:
        node.attributes["xmi:type"] = f"uml:{metaclass}"
    node.attributes["xmi:id"] = book.ids[element.id]
    _name(book, element, node)
    book.nodes[element.id] = node
    (book.tops if holder is None else holder.children).append(node)
    if element.kind in RESTATED:
        said = f"kind {element.kind}"
        book.losses.note(APPROXIMATED, element, said=said, written=metaclass)
    elif not is_whole:
        said = f"{element.kind} ({element.subkind})"
        book.losses.note(APPROXIMATED, element, said=said, written=metaclass)


def _name(book: Book, element: Element, node: Node) -> None:
    if not element.name or element.kind is Kind.TEMPLATE_PARAMETER:
        return
    if element.kind in _UNNAMED:
        feature = book.graph.target(element, Edge.INSTANCE_OF)
        if feature is not None and feature.name == element.name:
            if book.losses.kept is not None:
                book.losses.kept.attribute(element, "name")
            return
        facts = {"attribute": "name", "kind": str(element.kind)}
        book.losses.note(UNSAID_ATTRIBUTE, element, **facts)
    else:
        node.attributes["name"] = element.name


def _holder(book: Book, element: Element) -> tuple[Node | None, str]:
    """The nearest node above that may hold the element, and in which feature."""
    if _is_wire(book.graph, element):
        _note_moved(book, element)
        return _class_of(book, element), "ownedConnector"
    for number, owner in enumerate(book.graph.ancestors(element)):
        feature = place(book.graph, owner, element)
        if feature:
            if number:
                _note_moved(book, element)
            is_formal = element.kind is Kind.TEMPLATE_PARAMETER
            return events.signature(book, owner) if is_formal else book.node(owner), feature
    if element.owner is not None:
        _note_moved(book, element)
    return None, ""


def _class_of(book: Book, connector: Element) -> Node | None:
    """The class of the instance that owns the connector; UML's instances own none."""
    owner = book.graph.owner(connector)
    classes = book.graph.targets(owner, Edge.INSTANCE_OF) if owner is not None else []
    known = (book.nodes[one.id] for one in classes if one.id in book.nodes)
    return next(known, None)


def _note_moved(book: Book, element: Element) -> None:
    owner = book.graph.owner(element)
    kind = str(owner.kind) if owner is not None else "file"
    book.losses.note(MOVED, element, owner=kind, kind=str(element.kind))


# -- content -----------------------------------------------------------------------------------


def _parts(book: Book) -> None:
    for id in list(book.nodes):
        relations.write(book, book.graph[id])
    events.write_events(book)
    for id in list(book.nodes):
        element = book.graph[id]
        attributes.write(book, element)
        _conditions(book, element)
        if element.subkind == "collaboration":
            _roles(book, element)


def _conditions(book: Book, element: Element) -> None:
    """Pre- and postconditions are owned rules that a reference tells from others."""
    if element.kind is not Kind.CONSTRAINT or book.node(element).tag != "ownedRule":
        return
    owner = book.graph.owner(element)
    feature = _condition(owner, element) if owner is not None else ""
    if owner is not None and feature:
        known = book.node(owner).attributes
        written = known.get(feature)
        id = book.ids[element.id]
        known[feature] = f"{written} {id}" if written else id


def _condition(owner: Element, rule: Element) -> str:
    if owner.kind is Kind.TRANSITION:
        names = {"precondition": "preCondition", "postcondition": "postCondition"}
        return names.get(rule.subkind, "")
    if rule.subkind == "invariant":
        return "stateInvariant" if owner.kind in (Kind.STATE, Kind.FINAL_STATE) else ""
    if owner.kind in (Kind.OPERATION, Kind.ACTIVITY, Kind.STATE_MACHINE, Kind.INTERACTION):
        names = {"body": "bodyCondition"} if owner.kind is Kind.OPERATION else {}
        plain = {"precondition": "precondition", "postcondition": "postcondition"}
        return (plain | names).get(rule.subkind, "")
    return ""


def _roles(book: Book, collaboration: Element) -> None:
    roles = [one for one in book.graph.owned(collaboration) if one.kind is Kind.PROPERTY]
    book.refer(collaboration, book.node(collaboration), "collaborationRole", roles, "role")


def _keep(book: Book) -> None:
    """Add the comment for what UML cannot say of a plant."""
    kept = book.losses.kept
    if kept is None:
        return
    top = next((one for one in book.tops if one.tag == "uml:Package"), None)
    if top is None:
        top = Node("uml:Package", {"xmi:id": part_id("kept", "package"), "name": "AutomationML"})
        book.tops.insert(0, top)
        kept.made.append(top.id)
    comment = Node("ownedComment", {"xmi:type": "uml:Comment", "xmi:id": part_id(top.id, "kept")})
    comment.add(Node("body", text=kept.text()))
    top.children.insert(0, comment)


# -- profiles ----------------------------------------------------------------------------------


def _profiles(book: Book, stereotypes: Stereotypes) -> None:
    for profile, spaces in _namespaces(book.graph).items():
        if profile.id in book.nodes:
            _note(book, profile, spaces)
    tops = [one for one in book.graph.roots() if one.kind is Kind.PACKAGE and one.id in book.nodes]
    for package in stereotypes.packages if tops else ():
        _apply(book, tops[0], package)


def _namespaces(graph: Graph) -> dict[Element, list[str]]:
    """Namespaces that applications use for the stereotypes of each profile."""
    found: dict[Element, list[str]] = {}
    for application in graph.of_kind(Kind.APPLICATION):
        stereotype = graph.target(application, Edge.INSTANCE_OF)
        space = str(application.attrs.get("namespace", ""))
        profile = _profile(graph, stereotype) if stereotype is not None else None
        if profile is not None and space and space not in found.setdefault(profile, []):
            found[profile].append(space)
    return found


def _profile(graph: Graph, stereotype: Element) -> Element | None:
    above: Iterator[Element] = graph.ancestors(stereotype)
    return next((one for one in above if one.kind in (Kind.PROFILE, Kind.PACKAGE)), None)


def _note(book: Book, profile: Element, spaces: list[str]) -> None:
    """Papyrus keeps the namespace of a profile in an Ecore package beside it."""
    note = Node("eAnnotations", {"xmi:type": "ecore:EAnnotation"})
    note.attributes |= {"xmi:id": part_id(profile.id, "note"), "source": _NOTE}
    for number, space in enumerate(spaces):
        id = part_id(profile.id, f"package[{number}]")
        contents = note.add(Node("contents", {"xmi:type": "ecore:EPackage", "xmi:id": id}))
        contents.attributes |= {"name": profile.name, "nsURI": space, "nsPrefix": profile.name}
    book.node(profile).children.insert(0, note)


def _apply(book: Book, root: Element, package: str) -> None:
    """Apply a package of SysML 1.6, unless the model does already."""
    href = _PROFILE + package.replace("PortsAnd", "Ports_u0026")
    node = book.node(root)
    if book.losses.kept is not None:
        book.losses.kept.applied.append(node.id)
    known = (one.attributes.get("href") for part in node.children for one in part.children)
    if href in known:
        return
    made = book.part(root, node, "profileApplication", "ProfileApplication")
    made.add(Node("appliedProfile", {"xmi:type": "uml:Profile", "href": href}))
