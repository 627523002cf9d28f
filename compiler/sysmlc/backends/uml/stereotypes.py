"""Stereotype applications, and the profiles that a model applies or defines.

In XMI, applications are siblings of the model that refer to their base elements.
"""

import re
from collections.abc import Iterator, Sequence

from sysmlc.backends.uml import sysml_profile
from sysmlc.backends.uml.context import Context, make_part_id
from sysmlc.backends.uml.features import to_class_name
from sysmlc.backends.uml.hrefs import is_external, make_reference
from sysmlc.backends.uml.node import Node
from sysmlc.backends.uml.rules import UNSUPPORTED_KIND
from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind, as_items

_UNKNOWN_PROFILE = "urn:sysmlc:stereotypes"
"""Namespace of stereotypes whose profile is not known."""
_TOOL_ID = re.compile(r"_[\w-]{22}|_\w+_\d+_\d+_\d+|EA(ID|PK)_[0-9A-F]{8}_\w+")
"""Ids that Papyrus, MagicDraw and Enterprise Architect generate."""
_MEASURES = ("unit", "quantityKind", "dimension")
_SYSML_PROFILE = "pathmap://SysML16_PROFILES/SysML.profile.uml#SysML.package_packagedElement_"
_NAMESPACE_ANNOTATION = "http://www.eclipse.org/uml2/2.0.0/UML"
_METACLASS_GROUPS: tuple[tuple[str, str], ...] = (
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
"""Metaclasses, and their generals from the nearest on."""
_GENERALS = {
    name: generals.split() for names, generals in _METACLASS_GROUPS for name in names.split()
}


class StereotypeWriter:
    """Writes applications below the root and assigns prefixes to their namespaces."""

    def __init__(self, context: Context, root: Node) -> None:
        self._context = context
        self._root = root
        self._prefixes: dict[str, str] = {}
        self._used_prefixes = {"xmi", "xsi", "uml", "ecore"}
        self.packages: list[str] = []
        """Packages of SysML whose stereotypes the source did not apply itself."""

    @property
    def namespaces(self) -> dict[str, str]:
        """Namespace by prefix."""
        return {prefix: namespace for namespace, prefix in self._prefixes.items()}

    def write_applications(self) -> None:
        """Write all applications of the graph, and those that roles and relations need."""
        graph = self._context.graph
        for application in graph.of_kind(Kind.APPLICATION):
            if not is_external(application):
                self._write_application(application)
        for id in list(self._context.nodes):
            element = graph[id]
            name = sysml_profile.find_missing_stereotype(graph, element)
            if name:
                self._write_role(element, name)
        for name, base_id in self._context.relation_stereotypes:
            node = self._add_sysml_node(name, make_part_id(base_id, "stereotype"))
            node.attributes["base_Abstraction"] = base_id

    # -- one application -----------------------------------------------------------------------

    def _write_application(self, application: Element) -> None:
        bases = list(self._iter_bases(application))
        if not bases:
            losses = self._context.losses
            losses.record(UNSUPPORTED_KIND, application, kind="Application without base")
            return
        name = str(application.attrs.get("stereotype", "")) or application.name
        namespace = str(application.attrs.get("namespace", "")) or _UNKNOWN_PROFILE
        id = self._context.ids[application.id]
        # Papyrus has its own copy of SysML, whose tags start with a small letter.
        is_foreign = sysml_profile.is_foreign(namespace, name)
        node = self._add_sysml_node(name, id) if is_foreign else self._add_node(namespace, name, id)
        self._context.nodes[application.id] = node
        self._add_bases(node, bases)
        for key, value in application.attrs.items():
            if key.startswith("tag."):
                tag = re.sub(r"[^\w.-]", "_", key.removeprefix("tag."))
                if is_foreign:
                    tag = tag[:1].lower() + tag[1:]
                self._write_tag(application, node, tag, value)

    def _add_sysml_node(self, name: str, id: str) -> Node:
        """Add an application of a stereotype in Papyrus's SysML profile."""
        package = sysml_profile.read_packages()[name]
        if package not in self.packages:
            self.packages.append(package)
        return self._add_node(sysml_profile.NAMESPACE + package, name, id)

    def _add_node(self, namespace: str, name: str, id: str) -> Node:
        tag = re.sub(r"\W", "_", name)
        tag = tag if re.match(r"[^\W\d]", tag) else f"_{tag}"
        return self._root.add(Node(f"{self._find_prefix(namespace)}:{tag}", {"xmi:id": id}))

    def _find_prefix(self, namespace: str) -> str:
        if namespace not in self._prefixes:
            prefix = _choose_prefix(namespace, self._used_prefixes)
            self._prefixes[namespace] = prefix
            self._used_prefixes.add(prefix)
        return self._prefixes[namespace]

    def _iter_bases(self, application: Element) -> Iterator[tuple[str, str | Element]]:
        """Yield each base property with the id of a written element, or the external element."""
        graph, context = self._context.graph, self._context
        for subject in graph.targets(application, Edge.SUBJECT):
            if is_external(subject):
                type_ = make_reference(graph, "base", subject).attributes.get("xmi:type", "")
                metaclass = type_.removeprefix("uml:") or "Element"
                yield f"base_{self._choose_base(application, metaclass)}", subject
            elif subject.id in context.nodes:
                metaclass = context.find_node(subject).root_metaclass
                base = self._choose_base(application, metaclass)
                yield f"base_{base}", context.ids[subject.id]
        if "on" in application.attrs:
            yield from self._iter_part_bases(application)

    def _iter_part_bases(self, application: Element) -> Iterator[tuple[str, str]]:
        """Yield the base of an application on a part that the graph folds into its holder.

        Its attribute ``on`` is the metaclass of the part, and the application refers to holders.
        """
        metaclass = to_class_name(str(application.attrs["on"]))
        for holder in self._context.graph.targets(application, Edge.REFERENCES):
            node = self._context.nodes.get(holder.id)
            if node is None:
                continue
            if holder.kind is Kind.TRIGGER and metaclass.endswith("Event"):
                ids = [node.attributes.get("event", "")]
            else:
                ids = [part.id for part in node.iter_parts() if part.metaclass == metaclass]
            if ids and ids[0]:
                yield f"base_{metaclass}", ids[0]
                return

    def _choose_base(self, application: Element, metaclass: str) -> str:
        """Return the nearest general of the base's metaclass that the stereotype extends."""
        extended = [*_iter_extended_metaclasses(self._context.graph, application)]
        by_name = sysml_profile.read_extended_metaclasses()
        for name in sysml_profile.list_lineage(application):
            extended += by_name.get(name, ())
        return _find_nearest(metaclass, extended)

    def _add_bases(self, node: Node, bases: Sequence[tuple[str, str | Element]]) -> None:
        """Write the base properties; several bases of one property are one list of ids."""
        for name, base in dict.fromkeys(bases):
            if isinstance(base, Element):
                node.add(make_reference(self._context.graph, name, base))
            else:
                ids = node.attributes.get(name)
                node.attributes[name] = f"{ids} {base}" if ids else base

    # -- tags ----------------------------------------------------------------------------------

    def _write_tag(self, application: Element, node: Node, tag: str, value: AttrValue) -> None:
        """Write a tagged value: references if all its items are ids of elements, else texts."""
        context = self._context
        items = as_items(value)
        targets = [context.graph.get(item) if isinstance(item, str) else None for item in items]
        elements = [target for target in targets if target is not None]
        are_written = all(
            target.kind is Kind.APPLICATION or context.is_available(target) for target in elements
        )
        if elements and len(elements) == len(items) and are_written:
            context.add_references(node, tag, elements)
            return
        for item in items:
            self._write_text(application, node, tag, item, isinstance(value, tuple))

    def _write_text(
        self, application: Element, node: Node, tag: str, value: AttrValue, is_item: bool
    ) -> None:
        """Write a text: as an href, as a child, or as an XML attribute.

        A text that looks like ids is a child, because readers resolve ids in XML attributes.
        """
        text = ("true" if value else "false") if isinstance(value, bool) else str(value)
        if text.startswith("pathmap:") or (tag in _MEASURES and "#" in text):
            node.add(self._make_tag_reference(application, tag, text))
        elif is_item or self._looks_like_ids(text):
            node.add(Node(tag, text=text))
        else:
            node.attributes[tag] = text

    def _make_tag_reference(self, application: Element, tag: str, href: str) -> Node:
        """Return a reference to an href, with a type if a base element refers to a stub for it."""
        graph = self._context.graph
        for base in graph.targets(application, Edge.SUBJECT):
            for stub in graph.targets(base, Edge.REFERENCES):
                if stub.attrs.get("href") == href:
                    return make_reference(graph, tag, stub)
        return Node(tag, {"href": href})

    def _looks_like_ids(self, text: str) -> bool:
        words, graph = text.split(), self._context.graph
        return bool(words) and all(word in graph or _TOOL_ID.fullmatch(word) for word in words)

    # -- roles ---------------------------------------------------------------------------------

    def _write_role(self, element: Element, name: str) -> None:
        """Add the application that gives an element its role."""
        context = self._context
        id = make_part_id(element.id, f"stereotype {name}")
        if context.losses.round_trip is not None:
            context.losses.round_trip.added.append(id)
            context.losses.round_trip.store_attribute(element, "role")
        node = self._add_sysml_node(name, id)
        metaclass = context.find_node(element).root_metaclass
        extended = sysml_profile.read_extended_metaclasses().get(name, ())
        node.attributes[f"base_{_find_nearest(metaclass, extended)}"] = context.ids[element.id]
        for tag, value in sysml_profile.list_tags(context.graph, element, name).items():
            if isinstance(value, str):
                node.attributes[tag] = value
            elif all(context.is_available(target) for target in value):
                context.add_references(node, tag, value)
            else:
                node.attributes[tag] = value[0].name


def _find_nearest(metaclass: str, extended: Sequence[str]) -> str:
    """Return the metaclass or its nearest general in *extended*; *metaclass* if none is."""
    candidates = (metaclass, *_GENERALS.get(metaclass, ()))
    return next((name for name in candidates if name in extended), metaclass)


def _choose_prefix(namespace: str, used: set[str]) -> str:
    """Return a free prefix made of the last part of a namespace that starts with a letter."""
    parts = re.split(r"[/:]", namespace.rstrip("/:"))
    words = [re.sub(r"\W", "_", re.sub(r"\.xmi$", "", part)) for part in reversed(parts)]
    word = next((word for word in words if re.match(r"[A-Za-z]", word)), "profile")
    if re.match(r"(?i)xml", word):
        # Prefixes that start with xml are reserved (Namespaces in XML 1.0, 3).
        word = f"p_{word}"
    number, prefix = 1, word
    while prefix in used:
        number += 1
        prefix = f"{word}_{number}"
    return prefix


def _iter_extended_metaclasses(graph: Graph, application: Element) -> Iterator[str]:
    """Yield the metaclasses that the applied stereotype and its generals extend, by name."""
    level = graph.targets(application, Edge.INSTANCE_OF)
    visited: set[str] = set()
    while level:
        visited.update(stereotype.id for stereotype in level)
        for stereotype in level:
            yield from (target.name for target in graph.targets(stereotype, Edge.EXTENDS))
        generals = (item for s in level for item in graph.targets(s, Edge.SPECIALIZES))
        level = [general for general in generals if general.id not in visited]


# -- profiles ----------------------------------------------------------------------------------


def write_profiles(context: Context, packages: Sequence[str]) -> None:
    """Declare the namespaces of the model's own profiles, and apply packages of SysML to it."""
    for profile, namespaces in _find_profile_namespaces(context.graph).items():
        if profile.id in context.nodes:
            _declare_namespaces(context, profile, namespaces)
    for root in context.graph.roots():
        if root.kind is Kind.PACKAGE and root.id in context.nodes:
            for package in packages:
                _apply_sysml_package(context, root, package)
            break


def _find_profile_namespaces(graph: Graph) -> dict[Element, list[str]]:
    """Return the namespaces that applications use for the stereotypes of each profile."""
    namespaces: dict[Element, list[str]] = {}
    for application in graph.of_kind(Kind.APPLICATION):
        stereotype = graph.target(application, Edge.INSTANCE_OF)
        namespace = str(application.attrs.get("namespace", ""))
        profile = _find_profile(graph, stereotype) if stereotype is not None else None
        if profile is not None and namespace:
            of_profile = namespaces.setdefault(profile, [])
            if namespace not in of_profile:
                of_profile.append(namespace)
    return namespaces


def _find_profile(graph: Graph, stereotype: Element) -> Element | None:
    for owner in graph.ancestors(stereotype):
        if owner.kind in (Kind.PROFILE, Kind.PACKAGE):
            return owner
    return None


def _declare_namespaces(context: Context, profile: Element, namespaces: list[str]) -> None:
    """Add the annotation with an Ecore package in which Papyrus stores a profile's namespace."""
    annotation = Node("eAnnotations", {"xmi:type": "ecore:EAnnotation"})
    annotation.attributes |= {
        "xmi:id": make_part_id(profile.id, "note"),
        "source": _NAMESPACE_ANNOTATION,
    }
    for index, namespace in enumerate(namespaces):
        id = make_part_id(profile.id, f"package[{index}]")
        package = annotation.add(Node("contents", {"xmi:type": "ecore:EPackage", "xmi:id": id}))
        package.attributes |= {
            "name": profile.name,
            "nsURI": namespace,
            "nsPrefix": profile.name,
        }
    context.find_node(profile).children.insert(0, annotation)


def _apply_sysml_package(context: Context, root: Element, package: str) -> None:
    """Apply a package of Papyrus's SysML 1.6, unless the model does already."""
    href = _SYSML_PROFILE + package.replace("PortsAnd", "Ports_u0026")
    node = context.find_node(root)
    if context.losses.round_trip is not None:
        context.losses.round_trip.profiled.append(node.id)
    hrefs = (part.attributes.get("href") for child in node.children for part in child.children)
    if href in hrefs:
        return
    application = context.add_part(root, node, "profileApplication", "ProfileApplication")
    application.add(Node("appliedProfile", {"xmi:type": "uml:Profile", "href": href}))
