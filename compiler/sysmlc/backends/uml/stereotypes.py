"""Stereotype applications: siblings of the model that name their base elements."""

import re
from collections.abc import Iterator, Sequence

from sysmlc.backends.uml import sysml
from sysmlc.backends.uml.book import Book
from sysmlc.backends.uml.hrefs import is_outside, reference
from sysmlc.backends.uml.identity import part_id
from sysmlc.backends.uml.names import capital
from sysmlc.backends.uml.node import Node
from sysmlc.backends.uml.rules import UNSAID_KIND
from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind

_UNKNOWN = "urn:sysmlc:stereotypes"
"""Namespace of stereotypes whose profile is not known."""
_MADE_BY_TOOLS = re.compile(r"_[\w-]{22}|_\w+_\d+_\d+_\d+|EA(ID|PK)_[0-9A-F]{8}_\w+")
_MEASURES = ("unit", "quantityKind", "dimension")
_FAMILIES: tuple[tuple[str, str], ...] = (
    ("Model Profile", "Package"),
    (
        "Activity StateMachine Interaction OpaqueBehavior FunctionBehavior ProtocolStateMachine",
        "Behavior Class BehavioredClassifier Classifier",
    ),
    ("Class Component Node Device ExecutionEnvironment", "Class BehavioredClassifier Classifier"),
    ("AssociationClass", "Class Association Classifier"),
    ("DataType Enumeration PrimitiveType", "DataType Classifier"),
    ("Interface Signal Association Actor UseCase Artifact Collaboration", "Classifier"),
    ("Property Port", "Property StructuralFeature Feature"),
    ("Operation Reception", "BehavioralFeature Feature"),
    ("ControlFlow ObjectFlow", "ActivityEdge"),
    ("Abstraction Realization Usage Substitution Deployment", "Dependency DirectedRelationship"),
    ("Dependency InformationFlow", "DirectedRelationship"),
    ("InputPin OutputPin ValuePin ActionInputPin", "Pin ObjectNode ActivityNode"),
    ("ActivityParameterNode CentralBufferNode DataStoreNode", "ObjectNode ActivityNode"),
)
_GENERALS = {name: generals.split() for names, generals in _FAMILIES for name in names.split()}


class Stereotypes:
    """Writes applications below the root and knows the prefixes of their namespaces."""

    def __init__(self, book: Book, root: Node) -> None:
        self._book = book
        self._root = root
        self._prefixes: dict[str, str] = {}
        self._taken = {"xmi", "xsi", "uml", "ecore"}
        self.packages: list[str] = []
        """Packages of SysML that the source did not apply itself."""

    @property
    def namespaces(self) -> dict[str, str]:
        """Namespace by prefix."""
        return {prefix: space for space, prefix in self._prefixes.items()}

    def write(self) -> None:
        """Write all applications of the graph, and those that only roles tell of."""
        for application in self._book.graph.of_kind(Kind.APPLICATION):
            if not is_outside(application):
                self._application(application)
        for id in list(self._book.nodes):
            element = self._book.graph[id]
            name = sysml.missing(self._book.graph, element)
            if name:
                self._role(element, name)

        for name, base in self._book.relations:
            space = sysml.NAMESPACE + self._package(name)
            node = self._node(space, name, part_id(base, "stereotype"))
            node.attributes["base_Abstraction"] = base

    # -- one application -----------------------------------------------------------------------

    def _application(self, application: Element) -> None:
        bases = list(self._bases(application))
        if not bases:
            self._book.losses.note(UNSAID_KIND, application, kind="Application without base")
            return
        name = str(application.attrs.get("stereotype", "")) or application.name
        space = str(application.attrs.get("namespace", "")) or _UNKNOWN
        is_foreign = sysml.is_foreign(space, name)
        if is_foreign:
            space = sysml.NAMESPACE + self._package(name)
        node = self._node(space, name, self._book.ids[application.id])
        self._book.nodes[application.id] = node
        self._add_bases(node, bases)
        for key, value in application.attrs.items():
            if key.startswith("tag."):
                tag = re.sub(r"[^\w.-]", "_", key.removeprefix("tag."))
                self._tag(application, node, _small(tag) if is_foreign else tag, value)

    def _package(self, name: str) -> str:
        package = sysml.packages()[name]
        if package not in self.packages:
            self.packages.append(package)
        return package

    def _node(self, space: str, name: str, id: str) -> Node:
        tag = re.sub(r"\W", "_", name)
        tag = tag if re.match(r"[^\W\d]", tag) else f"_{tag}"
        return self._root.add(Node(f"{self._prefix(space)}:{tag}", {"xmi:id": id}))

    def _prefix(self, space: str) -> str:
        if space not in self._prefixes:
            self._prefixes[space] = _free(space, self._taken)
            self._taken.add(self._prefixes[space])
        return self._prefixes[space]

    def _bases(self, application: Element) -> Iterator[tuple[str, str | Element]]:
        """Names of base properties, each with the id in the file or the element outside."""
        graph, book = self._book.graph, self._book
        for subject in graph.targets(application, Edge.SUBJECT):
            if is_outside(subject):
                metaclass = reference(graph, "base", subject).attributes.get("xmi:type", "")
                plain = metaclass.removeprefix("uml:") or "Element"
                yield f"base_{self._base(application, plain)}", subject
            elif subject.id in book.nodes:
                plain = book.node(subject).metaclass or _root_type(book.node(subject))
                yield f"base_{self._base(application, plain)}", book.ids[subject.id]
        if "on" in application.attrs:
            yield from self._folded(application, capital(str(application.attrs["on"])))

    def _folded(self, application: Element, metaclass: str) -> Iterator[tuple[str, str]]:
        for holder in self._book.graph.targets(application, Edge.REFERENCES):
            node = self._book.nodes.get(holder.id)
            if node is None:
                continue
            if holder.kind is Kind.TRIGGER and metaclass.endswith("Event"):
                found = [node.attributes.get("event", "")]
            else:
                found = [one.id for one in node.parts() if one.metaclass == metaclass]
            if found and found[0]:
                yield f"base_{metaclass}", found[0]
                return

    def _base(self, application: Element, metaclass: str) -> str:
        """The metaclass that the stereotype extends and the base element has."""
        fits = (metaclass, *_GENERALS.get(metaclass, ()))
        known = [*_extended(self._book.graph, application)]
        for name in sysml.lineage(application):
            known += sysml.bases().get(name, ())
        return next((name for name in fits if name in known), metaclass)

    def _add_bases(self, node: Node, bases: Sequence[tuple[str, str | Element]]) -> None:
        for name, base in dict.fromkeys(bases):
            if isinstance(base, Element):
                node.add(reference(self._book.graph, name, base))
            else:
                known = node.attributes.get(name)
                node.attributes[name] = f"{known} {base}" if known else base

    # -- tags ----------------------------------------------------------------------------------

    def _tag(self, holder: Element, node: Node, tag: str, value: AttrValue) -> None:
        graph, book = self._book.graph, self._book
        given = value if isinstance(value, tuple) else (value,)
        found = [graph.get(one) if isinstance(one, str) else None for one in given]
        targets = [one for one in found if one is not None]
        if targets and len(targets) == len(found):
            written = [one for one in targets if one.kind is Kind.APPLICATION]
            if len(written) == len(targets) or all(
                is_outside(t) or t.id in book.nodes for t in targets if t not in written
            ):
                self._named(node, tag, targets)
                return
        for one in given:
            self._text(holder, node, tag, one, isinstance(value, tuple))

    def _named(self, node: Node, tag: str, targets: Sequence[Element]) -> None:
        graph, ids = self._book.graph, self._book.ids
        if not any(map(is_outside, targets)):
            node.attributes[tag] = " ".join(ids[one.id] for one in targets)
            return
        for one in targets:
            local = Node(tag, {"xmi:idref": ids[one.id]})
            node.add(reference(graph, tag, one) if is_outside(one) else local)

    def _text(
        self, holder: Element, node: Node, tag: str, value: AttrValue, is_one_of_many: bool
    ) -> None:
        text = ("true" if value else "false") if isinstance(value, bool) else str(value)
        if text.startswith("pathmap:") or (tag in _MEASURES and "#" in text):
            node.add(self._href(holder, tag, text))
        elif is_one_of_many or self._looks_like_ids(text):
            node.add(Node(tag, text=text))
        else:
            node.attributes[tag] = text

    def _href(self, holder: Element, tag: str, href: str) -> Node:
        """An href with the type of the stub that stands for it."""
        graph = self._book.graph
        for base in graph.targets(holder, Edge.SUBJECT):
            for stub in graph.targets(base, Edge.REFERENCES):
                if stub.attrs.get("href") == href:
                    return reference(graph, tag, stub)
        return Node(tag, {"href": href})

    def _looks_like_ids(self, text: str) -> bool:
        tokens = text.split()
        graph = self._book.graph
        return bool(tokens) and all(one in graph or _MADE_BY_TOOLS.fullmatch(one) for one in tokens)

    # -- what only roles tell ------------------------------------------------------------------

    def _role(self, element: Element, name: str) -> None:
        book = self._book
        id = part_id(element.id, f"stereotype {name}")
        if book.losses.kept is not None:
            book.losses.kept.made.append(id)
            book.losses.kept.attribute(element, "role")
        node = self._node(sysml.NAMESPACE + self._package(name), name, id)
        metaclass = book.node(element).metaclass or _root_type(book.node(element))
        fits = (metaclass, *_GENERALS.get(metaclass, ()))
        base = next((one for one in fits if one in sysml.bases().get(name, ())), metaclass)
        node.attributes[f"base_{base}"] = book.ids[element.id]
        for tag, given in sysml.tags(book.graph, element, name).items():
            if isinstance(given, str):
                node.attributes[tag] = given
            elif all(is_outside(one) or one.id in book.nodes for one in given):
                self._named(node, tag, given)
            else:
                node.attributes[tag] = given[0].name


def _root_type(node: Node) -> str:
    return node.tag.removeprefix("uml:")


def _small(tag: str) -> str:
    return tag[:1].lower() + tag[1:]


def _free(space: str, taken: set[str]) -> str:
    last = re.split(r"[/:]", space.rstrip("/:"))
    words = [re.sub(r"\W", "_", re.sub(r"\.xmi$", "", part)) for part in reversed(last)]
    plain = next((word for word in words if re.match(r"[A-Za-z]", word)), "profile")
    if re.match(r"(?i)xml", plain):
        plain = f"p_{plain}"
    number, prefix = 1, plain
    while prefix in taken:
        number += 1
        prefix = f"{plain}_{number}"
    return prefix


def _extended(graph: Graph, application: Element) -> Iterator[str]:
    """Names of the metaclasses that the applied stereotype, or a general one, extends."""
    level = graph.targets(application, Edge.INSTANCE_OF)
    seen: set[str] = set()
    while level:
        seen.update(one.id for one in level)
        for one in level:
            yield from (target.name for target in graph.targets(one, Edge.EXTENDS))
        ups = (up for one in level for up in graph.targets(one, Edge.SPECIALIZES))
        level = [up for up in ups if up.id not in seen]
