"""Edges of elements: references, and the relations that UML holds as parts of an element."""

from collections.abc import Callable, Sequence

from sysmlc.backends.uml import events, values
from sysmlc.backends.uml.book import Book
from sysmlc.backends.uml.hrefs import href_of, is_outside
from sysmlc.backends.uml.links import feature
from sysmlc.backends.uml.meant import applications, is_meant
from sysmlc.backends.uml.node import Node
from sysmlc.backends.uml.rules import APPROXIMATED
from sysmlc.ir import Edge, Element, Kind

_Targets = Sequence[Element]
_Writer = Callable[[Book, Element, _Targets], None]
_BEHAVIOURED = (
    Kind.CLASS,
    Kind.COMPONENT,
    Kind.ACTOR,
    Kind.USE_CASE,
    Kind.ACTIVITY,
    Kind.STATE_MACHINE,
    Kind.INTERACTION,
    Kind.ASSOCIATION,
)


def write(book: Book, element: Element) -> None:
    """Write all edges that leave an element whose node is made."""
    for edge in book.edges:
        targets = book.graph.targets(element, edge)
        if not targets:
            continue
        writer = _WRITERS.get(edge) or _WRITERS_OF.get((element.kind, edge))
        if writer is not None:
            writer(book, element, targets)
        else:
            _plain(book, element, edge, targets)


def _plain(book: Book, element: Element, edge: Edge, targets: _Targets) -> None:
    by_feature: dict[str, list[Element]] = {}
    for target in targets:
        name = feature(element, edge, target)
        if name and not (element.kind is Kind.COMMENT and _is_member(book, element, target)):
            by_feature.setdefault(name, []).append(target)
        elif not is_meant(book.graph, element, edge, target):
            _relation(book, element, edge, target)
    for name, named in by_feature.items():
        book.refer(element, book.node(element), name, named, edge.value)


def _is_member(book: Book, comment: Element, target: Element) -> bool:
    """Members of an element group are told by its stereotype."""
    if comment.role != "element group":
        return False
    for one in applications(book.graph, comment):
        for given in (one.attrs.get("tag.member"), one.attrs.get("tag.orderedMember")):
            if target.id in (given if isinstance(given, tuple) else (given,)):
                return True
    return False


# -- parts of the element ----------------------------------------------------------------------


def _folded(
    book: Book, element: Element, tag: str, metaclass: str, name: str, target: Element
) -> None:
    if not is_outside(target) and target.id not in book.nodes:
        book.lost(element, name, target)
        return
    made = book.part(element, book.node(element), tag, metaclass)
    book.refer(element, made, name, [target], name)


def _specializes(book: Book, element: Element, targets: _Targets) -> None:
    for target in targets:
        _folded(book, element, "generalization", "Generalization", "general", target)


def _includes(book: Book, element: Element, targets: _Targets) -> None:
    for target in targets:
        _folded(book, element, "include", "Include", "addition", target)


def _realizes(book: Book, element: Element, targets: _Targets) -> None:
    for target in targets:
        if is_meant(book.graph, element, Edge.REALIZES, target):
            continue
        if element.kind is Kind.STATE_MACHINE and target.kind is Kind.STATE_MACHINE:
            name = ("conformance", "ProtocolConformance", "generalMachine")
            _folded(book, element, *name, target)
        elif element.kind in _BEHAVIOURED and target.kind is Kind.INTERFACE:
            name = ("interfaceRealization", "InterfaceRealization", "contract")
            _folded(book, element, *name, target)
            _client(book, element, target)
        else:
            _relation(book, element, Edge.REALIZES, target)


def _client(book: Book, element: Element, target: Element) -> None:
    """An interface realization is a dependency from the classifier to the interface."""
    made = book.node(element).children[-1] if book.node(element).children else None
    if made is None or made.tag != "interfaceRealization":
        return
    made.attributes["client"] = book.ids[element.id]
    if not is_outside(target):
        made.attributes["supplier"] = book.ids[target.id]


def _applies(book: Book, element: Element, targets: _Targets) -> None:
    for target in targets:
        _folded(book, element, "profileApplication", "ProfileApplication", "appliedProfile", target)


def _extends(book: Book, element: Element, targets: _Targets) -> None:
    if element.kind is Kind.STEREOTYPE:
        for target in targets:
            _extension(book, element, target)
        return
    held = [one for one in book.graph.owned(element) if one.kind is Kind.EXTEND]
    told = {t.id for one in held for t in book.graph.targets(one, Edge.EXTENDS)}
    for target in targets:
        if target.id not in told:
            _folded(book, element, "extend", "Extend", "extendedCase", target)


def _extension(book: Book, stereotype: Element, metaclass: Element) -> None:
    """A property of the stereotype and an extension of its profile."""
    node, name = book.node(stereotype), metaclass.name
    base = book.part(stereotype, node, "ownedAttribute", "Property")
    base.attributes["name"] = f"base_{name}"
    kind = {"xmi:type": "uml:Class", "href": href_of(book.graph, metaclass)}
    base.add(Node("type", kind))
    above = book.graph.owner(stereotype)
    if above is None:
        return
    holder = book.node(above)
    extension = book.part(stereotype, holder, "packagedElement", "Extension")
    base.attributes["association"] = extension.id
    extension.attributes["name"] = f"E_{stereotype.name}_{name}"
    end = book.part(stereotype, extension, "ownedEnd", "ExtensionEnd")
    end.attributes |= {
        "name": f"extension_{stereotype.name}",
        "type": book.ids[stereotype.id],
        "aggregation": "composite",
        "association": extension.id,
    }
    extension.attributes["memberEnd"] = f"{end.id} {base.id}"


def _guard(book: Book, element: Element, targets: _Targets) -> None:
    if element.kind is Kind.TRANSITION:
        book.refer(element, book.node(element), "guard", targets, "guard")


def _held(book: Book, element: Element, targets: _Targets) -> None:
    """Behaviours of states stand in them; one that stands elsewhere UML cannot name."""
    for target in targets:
        if target.owner != element.id:
            book.lost(element, "behaviour of another owner", target)


def _relation(book: Book, element: Element, edge: Edge, target: Element) -> None:
    """A relation that UML says by a dependency in a package."""
    known = _DEPENDENCIES.get(edge)
    if known is None or not (is_outside(target) or target.id in book.nodes):
        book.lost(element, edge.value, target)
        return
    metaclass, stereotype = known
    packages = (one for one in book.graph.ancestors(element) if one.kind is Kind.PACKAGE)
    above = next((book.nodes[one.id] for one in packages if one.id in book.nodes), None)
    if above is None:
        above = Node("")
    made = book.part(element, above, "packagedElement", metaclass)
    made.attributes["client"] = book.ids[element.id]
    book.refer(element, made, "supplier", [target], edge.value)
    if not above.tag:
        made.tag = f"uml:{made.attributes.pop('xmi:type').removeprefix('uml:')}"
        book.tops.append(made)
    if stereotype:
        book.relations.append((stereotype, made.id))
    if book.losses.kept is not None:
        book.losses.kept.made.append(made.id)
        book.losses.kept.edge(edge.value, element, target)
    facts = {"said": f"'{edge}' from {element.kind}", "written": metaclass}
    book.losses.note(APPROXIMATED, element, **facts)


_DEPENDENCIES = {
    Edge.REALIZES: ("Realization", ""),
    Edge.DEPENDS: ("Dependency", ""),
    Edge.SATISFIES: ("Abstraction", "Satisfy"),
    Edge.DERIVES: ("Abstraction", "DeriveReqt"),
    Edge.VERIFIES: ("Abstraction", "Verify"),
    Edge.REFINES: ("Abstraction", "Refine"),
    Edge.TRACES: ("Abstraction", "Trace"),
    Edge.ALLOCATED_TO: ("Abstraction", "Allocate"),
}
"""Metaclass and stereotype of the dependency that means an edge."""


# -- single kinds ------------------------------------------------------------------------------


def _slot_values(book: Book, element: Element, targets: _Targets) -> None:
    for target in targets:
        if is_outside(target) or target.id in book.nodes:
            values.instance(book, element, book.node(element), "value", target)
        else:
            book.lost(element, "references", target)


def _path(book: Book, element: Element, targets: _Targets) -> None:
    """The last part of the path holds the port; a nested path is told by its stereotype."""
    if book.losses.kept is not None:
        for target in targets:
            book.losses.kept.edge("path", element, target)
    role = book.graph.target(element, Edge.ROLE)
    last = targets[-1]
    if role is None or role.kind is Kind.PORT or last is role or len(targets) == 1:
        book.refer(element, book.node(element), "partWithPort", [last], "path")


def _general_set(book: Book, element: Element, targets: _Targets) -> None:
    """A set is of generalizations; the graph has the classifiers that they are of."""
    made = [_first_part(book, target, "generalization") for target in targets]
    for target, id in zip(targets, made, strict=True):
        if not id:
            book.lost(element, "references", target)
    book.node(element).attributes["generalization"] = " ".join(filter(None, made))


def _first_part(book: Book, element: Element, tag: str) -> str:
    """Id of the first part of an element with the tag, or the empty string."""
    node = book.nodes.get(element.id)
    return next((one.id for one in node.children if one.tag == tag), "") if node else ""


def _binds(book: Book, element: Element, targets: _Targets) -> None:
    for target in targets:
        if target.id in book.nodes:
            made = events.signature(book, target)
            book.node(element).attributes["signature"] = made.id
        elif is_outside(target):
            book.refer(element, book.node(element), "signature", [target], "binds")
            made = book.node(element).children[-1]
            made.attributes["xmi:type"] = "uml:TemplateSignature"


def _trigger(book: Book, element: Element, targets: _Targets) -> None:
    """The events of triggers are written when everything else is."""
    for target in targets:
        if element.kind is Kind.TRIGGER or target.owner == element.id:
            continue
        book.lost(element, "trigger", target)


def _message_ends(book: Book, element: Element, targets: _Targets) -> None:
    """What the occurrences at the ends of a message cover tells its lifelines."""
    ends = (Edge.SEND_EVENT, Edge.RECEIVE_EVENT)
    if not any(book.graph.targets(element, edge) for edge in ends):
        for target in targets:
            book.lost(element, "end without occurrence", target)


def _message_event(edge: Edge, name: str) -> _Writer:
    def write(book: Book, element: Element, targets: _Targets) -> None:
        book.refer(element, book.node(element), name, targets, edge.value)
        for target in targets:
            if target.id in book.nodes:
                book.node(target).attributes["message"] = book.ids[element.id]

    return write


def _member_ends(book: Book, element: Element, targets: _Targets) -> None:
    book.refer(element, book.node(element), "memberEnd", targets, "end")
    for target in targets:
        if target.id in book.nodes:
            book.node(target).attributes["association"] = book.ids[element.id]


def _nothing(book: Book, element: Element, targets: _Targets) -> None:
    """Ownership, or what passes add, says it."""


_WRITERS: dict[Edge, _Writer] = {
    Edge.SPECIALIZES: _specializes,
    Edge.INCLUDES: _includes,
    Edge.REALIZES: _realizes,
    Edge.APPLIES: _applies,
    Edge.GUARD: _guard,
    Edge.ENTRY: _held,
    Edge.DO: _held,
    Edge.EXIT: _held,
    Edge.EFFECT: _held,
    Edge.TRIGGER: _trigger,
}
_WRITERS_OF: dict[tuple[Kind, Edge], _Writer] = {
    (Kind.USE_CASE, Edge.EXTENDS): _extends,
    (Kind.STEREOTYPE, Edge.EXTENDS): _extends,
    (Kind.SLOT, Edge.REFERENCES): _slot_values,
    (Kind.CONNECTOR_END, Edge.PATH): _path,
    (Kind.CONNECTOR, Edge.END): _nothing,
    (Kind.ASSOCIATION, Edge.END): _member_ends,
    (Kind.GENERALIZATION_SET, Edge.REFERENCES): _general_set,
    (Kind.TEMPLATE_BINDING, Edge.BINDS): _binds,
    (Kind.TRIGGER, Edge.TYPED_BY): _trigger,
    (Kind.TRIGGER, Edge.REFERENCES): _trigger,
    (Kind.MESSAGE, Edge.FLOW_SOURCE): _message_ends,
    (Kind.MESSAGE, Edge.FLOW_TARGET): _message_ends,
    (Kind.MESSAGE, Edge.SEND_EVENT): _message_event(Edge.SEND_EVENT, "sendEvent"),
    (Kind.MESSAGE, Edge.RECEIVE_EVENT): _message_event(Edge.RECEIVE_EVENT, "receiveEvent"),
}
