"""The objects of a component, itself and its parts, and the features that they have.

A feature belongs to the object that owns it, whichever behaviour writes it. Connectors and bindings
make features of several objects equal.
"""

import re
from collections.abc import Iterable, Iterator

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.ir.expressions import (
    Expression,
    Member,
    ParsedText,
    Statement,
    element_of,
    last_name,
    name_of,
    walk_tree,
)
from sysmlc.logic.cells import Fact
from sysmlc.logic.composition.structure import (
    Channels,
    iter_joined_names,
    iter_links,
    iter_usages,
    join_path,
)
from sysmlc.logic.contract import Domain, Owner, Variable
from sysmlc.logic.expressions.context import Context, context_of
from sysmlc.logic.expressions.features import Feature
from sysmlc.logic.expressions.named_elements import VALUE_KINDS
from sysmlc.logic.expressions.parsing import attach_tree
from sysmlc.logic.expressions.resolution import NameResolver
from sysmlc.logic.formula import Literal
from sysmlc.logic.identifiers import Names
from sysmlc.logic.regions import Term
from sysmlc.support.disjoint_sets import DisjointSets

Slot = tuple[str, str]
"""The path of an object, and the name of one of its features."""
_PATH = re.compile(r"[^\W\d]\w*(?:\s*(?:\.|::)\s*[^\W\d]\w*)+")
"""Plain names that are joined by dots or double colons."""
_MAX_OBJECTS = 200


class ComponentError(Exception):
    """A reason why the step relation of a component cannot be built."""


class ComponentObject(Struct, frozen=True):
    """The component itself (empty path) or one of its parts, with its type."""

    path: str
    type_: Element
    owner: "ComponentObject | None" = None

    def extend_path(self, name: str) -> tuple[str, ...]:
        """Return the names of the parts that lead to the object, and *name* after them."""
        return (*self.path.split("."), name) if self.path else (name,)

    def list_family(self, graph: Graph) -> tuple[Element, ...]:
        """Return the type of the object and the generals of the type, nearest first."""
        return self.type_, *query.generals(graph, self.type_)


class FeatureSlot(Struct, frozen=True):
    """The value that joined features share: its variable, and what the model says about it."""

    variable: Variable
    default: Literal | None
    elements: tuple[Element, ...]
    is_input: bool
    """Whether the environment decides it: all joined features have the direction ``in`` or
    ``inout``, or something outside the component is connected with the only one.
    """
    is_computed: bool
    """Whether an expression that is no constant states the value."""


class ObjectTree:
    """The objects of a component and the variables of their features."""

    def __init__(
        self, graph: Graph, type_: Element, assumed_range: tuple[int, int], names: Names
    ) -> None:
        """Collect the objects and join their features. Raises ComponentError."""
        self.graph = graph
        self.assumed_range = assumed_range
        self.names = names
        self.root = ComponentObject("", type_)
        self.objects = [self.root]
        self.joined: DisjointSets[Slot] = DisjointSets()
        self.channels = Channels()
        self._contexts: dict[str, Context] = {}
        self._slots: dict[Slot, FeatureSlot] = {}
        self._add_parts(self.root, {type_.id})
        for object_ in self.objects:
            self._join_features(object_)

    def _add_parts(self, owner: ComponentObject, enclosing: set[str]) -> None:
        for usage in iter_usages(self.graph, owner.type_, owner.path):
            if usage.element.kind not in (Kind.PROPERTY, Kind.PORT) or usage.element.role != "part":
                continue
            bounds = query.bounds(usage.element.attrs.get("multiplicity"))
            if bounds is not None and bounds[0] != bounds[1]:
                raise ComponentError(f"'{usage.path}' has no fixed number of objects")
            if usage.type_.id in enclosing:
                raise ComponentError(f"'{usage.path}' contains a part of its own type")
            part = ComponentObject(usage.path, usage.type_, owner)
            self.objects.append(part)
            if len(self.objects) > _MAX_OBJECTS:
                raise ComponentError(f"it has more than {_MAX_OBJECTS} parts")
            self._add_parts(part, enclosing | {usage.type_.id})

    def _join_features(self, owner: ComponentObject) -> None:
        for left, right in iter_links(self.graph, owner.type_, owner.path):
            self.channels.connect(owner.path, left, right)
            for left_name, right_name in iter_joined_names(left, right, self._list_names):
                self.joined.union(
                    self._follow_parts(left.path, left_name),
                    self._follow_parts(right.path, right_name),
                )

    def _list_names(self, path: str) -> Iterable[str]:
        holder = self.find_object(path)
        return () if holder is None else self.context(holder).variables

    # -- objects -----------------------------------------------------------------------------------

    def find_object(self, path: str) -> ComponentObject | None:
        """Return the object with a path, or None."""
        return next((object_ for object_ in self.objects if object_.path == path), None)

    def find_holder(self, start: ComponentObject, feature: Element) -> ComponentObject | None:
        """Return the object nearest to *start*, from the inside out, that has the feature."""
        owner = self.graph.owner(feature)
        object_: ComponentObject | None = start
        while object_ is not None:
            if owner in object_.list_family(self.graph):
                return object_
            object_ = object_.owner
        return None

    def find_performer(self, start: ComponentObject, activity: Element) -> ComponentObject | None:
        """Return the object that performs an activity which an object calls.

        It is the object itself or one around it that has the activity, or else the only part that
        has it; None if several may be meant. An activity of no classifier is performed by the
        caller.
        """
        owner = self.graph.owner(activity)
        if owner is None or owner.kind is Kind.PACKAGE:
            return start
        holders = [object_ for object_ in self.objects if owner in object_.list_family(self.graph)]
        object_: ComponentObject | None = start
        while object_ is not None:
            if owner in self.graph.ancestors(object_.type_):
                return object_
            if object_ in holders:
                # The call may name a part of that object, which has the activity, too.
                inner = [part for part in holders if part.path.startswith(f"{object_.path}.")]
                inner = inner if object_.path else holders[1:]
                return None if inner else object_
            object_ = object_.owner
        return holders[0] if len(holders) == 1 else None

    def find_named_activity(
        self, start: ComponentObject, path: str
    ) -> tuple[ComponentObject, Element] | None:
        """Return the activity that the text of a behaviour names, and the object that performs it.

        The object is *start*, one around it, or the part to which the path leads.
        """
        *parts, name = path.split(".")
        holder: ComponentObject | None = start
        if parts:
            holder = self.find_object(".".join(filter(None, (start.path, *parts))))
        while holder is not None:
            scopes = (*holder.list_family(self.graph), *self.graph.ancestors(holder.type_))
            for scope in scopes:
                for activity in self.graph.owned(scope):
                    if activity.kind is Kind.ACTIVITY and activity.name == name and name:
                        return holder, activity
            holder = None if parts else holder.owner
        return None

    def context(self, object_: ComponentObject) -> Context:
        """Return what names mean inside an object."""
        if object_.path not in self._contexts:
            self._contexts[object_.path] = context_of(self.graph, object_.type_, self.assumed_range)
        return self._contexts[object_.path]

    # -- features ----------------------------------------------------------------------------------

    def find_slot(
        self,
        object_: ComponentObject,
        element: Element,
        variable: str,
        behaviour: Element | None = None,
    ) -> Slot | None:
        """Return the slot of a feature that a behaviour of an object names, or None.

        *variable* is the variable of the feature in the behaviour. A value at a port
        (``level.value``) belongs to the object that has the port, a value in a part
        (``cell.full``) to the part.
        """
        contexts = [self.context(object_)]
        if behaviour is not None:
            contexts.insert(0, self.context_in(object_, behaviour))
        for context in contexts:
            for name, candidate in context.variables.items():
                if " " in name and candidate == variable:
                    return object_.path, name  # A sum of features of the object.
                # A path comes first: an object around may have the feature, too.
                is_same = "." in name and candidate == variable
                if is_same and context.features[name].element is element:
                    return self.slot_of(object_.path, name)
        holder = self.find_holder(object_, element)
        return None if holder is None else self.slot_of(holder.path, self._find_name(element))

    def find_unread_name(self, behaviour: Element, element: Element) -> str:
        """Return a path in a condition that leads to a feature of another object, or "".

        The condition is an input of the behaviour, although the model decides the feature.
        """
        for key in ("guard", "condition"):
            for path in self._list_nodes(element, str(element.attrs.get(key, ""))):
                if self._leads_elsewhere(behaviour, path):
                    return name_of(path) or ""
        return ""

    def _list_nodes(self, user: Element, text: str) -> Iterator[Expression | Statement]:
        """Yield the nodes of an expression, or the paths of names in a text of another language."""
        resolver = NameResolver(self.graph)
        paths: list[str] = [text] if isinstance(text, ParsedText) else _PATH.findall(text)
        for part in map(attach_tree, paths):
            if isinstance(part, ParsedText):
                yield from walk_tree(resolver.resolve(user, part.tree))

    def _leads_elsewhere(self, behaviour: Element, path: Expression | Statement) -> bool:
        """Whether a path leads from the object that has a behaviour, or a package, to a feature."""
        feature, name = self.graph.get(element_of(path)), name_of(path) or ""
        if feature is None or feature.kind not in (*VALUE_KINDS, Kind.INSTANCE):
            return False
        # The environment decides the values that a message brings.
        owner = self.graph.owner(feature)
        is_received = owner is None or owner.kind in (Kind.SIGNAL, Kind.OPERATION)
        while isinstance(path, Member):
            path = path.base
        first = self.graph.get(element_of(path))
        is_own = first is not None and behaviour in self.graph.ancestors(first)
        return last_name(name) != name and not is_received and not is_own

    def context_in(self, object_: ComponentObject, behaviour: Element) -> Context:
        """Return what names mean in a behaviour of an object."""
        key = f"{object_.path} {behaviour.id}"
        if key not in self._contexts:
            # The names of an activity are its own; it is read without its classifier.
            classifier = behaviour if behaviour.kind is Kind.ACTIVITY else object_.type_
            self._contexts[key] = context_of(self.graph, classifier, self.assumed_range, behaviour)
        return self._contexts[key]

    def slot_of(self, path: str, name: str) -> Slot:
        """Return the representative of the joined features to which a feature belongs.

        A name that leads into a part (``cell.full``) is a feature of the part.
        """
        return self.joined.find(self._follow_parts(path, name))

    def _follow_parts(self, path: str, name: str) -> Slot:
        if " " in name:
            return path, name
        first, dot, rest = name.partition(".")
        part = join_path(path, first)
        if not dot or self.find_object(part) is None:
            return self._find_outer_path(path, name), name
        return self._follow_parts(part, rest)

    def _find_outer_path(self, path: str, name: str) -> str:
        """Return the path of the object that has a feature which an object names.

        In a part without definition of its own, the features of the block around it are visible.
        """
        object_ = self.find_object(path)
        if object_ is None or not object_.type_.attrs.get("property_specific"):
            return path
        feature = self.context(object_).features.get(name)
        holder = None if feature is None else self.find_holder(object_, feature.element)
        return path if holder is None else holder.path

    def has_feature(self, object_: ComponentObject, name: str) -> bool:
        """Whether a name denotes a feature of an object, or along a path one of its parts."""
        path, feature = self._follow_parts(object_.path, name)
        holder = self.find_object(path)
        return holder is not None and feature in self.context(holder).features

    def _find_name(self, feature: Element) -> str:
        """Return the name of the feature that a feature redefines in the end, else its own."""
        redefined = self.graph.target(feature, Edge.REDEFINES)
        return self._find_name(redefined) if redefined is not None else feature.name

    def find_features(self, slot: Slot) -> list[tuple[ComponentObject, Feature]]:
        """Return the features that share a slot, each with the object that has it."""
        features = [
            (object_, self.context(object_).features[name])
            for object_, name in self.iter_joined_names(slot)
        ]
        path, name = slot
        holder = self.find_object(path)
        if features or holder is None or " " not in name:
            return features
        # Only the behaviours of an object name the features of its parts, and sums of them.
        sums = (context.features.get(name) for context in self._list_contexts(holder))
        return [(holder, feature) for feature in sums if feature is not None][:1]

    def _list_contexts(self, object_: ComponentObject) -> list[Context]:
        """Return what names mean inside an object, and in the behaviours that were read so far."""
        read = (item for key, item in self._contexts.items() if key.startswith(f"{object_.path} "))
        return [self.context(object_), *read]

    def iter_joined_names(self, slot: Slot) -> Iterator[tuple[ComponentObject, str]]:
        """Yield the names of the features that share a slot, each with the object that has it."""
        for object_ in self.objects:
            for name in self.context(object_).features:
                own = object_.path, name
                if self._follow_parts(*own) == own and self.joined.find(own) == slot:
                    yield object_, name

    def read_slot(self, slot: Slot) -> FeatureSlot:
        """Return the variable of a slot. Raises ComponentError for values that are not finite."""
        if slot not in self._slots:
            self._slots[slot] = self._read_slot(slot)
        return self._slots[slot]

    @property
    def used_slots(self) -> dict[Slot, FeatureSlot]:
        """The slots that were read so far."""
        return self._slots

    def _read_slot(self, slot: Slot) -> FeatureSlot:
        joined = self.find_features(slot)
        path, name = slot
        if not joined:
            raise ComponentError(f"'{join_path(path, name)}' is not a feature of a part")
        domains: list[Domain] = [
            feature.domain for _, feature in joined if feature.domain is not None
        ]
        if len(domains) < len(joined):
            is_several = any(feature.has_several_values for _, feature in joined)
            obstacle = "several values" if is_several else "no finite type"
            raise ComponentError(f"'{join_path(path, name)}' has {obstacle}")
        if any(domain != domains[0] for domain in domains):
            raise ComponentError(
                f"'{join_path(path, name)}' is joined with a feature of other values"
            )
        # The feature of the outermost object gives the name, that of the decider the initial value.
        holder, first = joined[0]
        # Variables of the component itself have the names that its own contract uses.
        base = first.variable if not holder.path else f"{holder.path}_{first.variable}"
        variable = first.variable if not holder.path else self.names.new(base)
        deciding = sorted(joined, key=lambda pair: pair[1].direction == "in")
        defaults = (feature.default for _, feature in deciding if feature.default is not None)
        return FeatureSlot(
            replace(
                first.make_variable(Owner.SYSTEM),
                name=variable,
                term=self._place_term(holder, first.term),
                constants=self._place_names(holder, first.constants),
                is_range_assumed=all(feature.is_assumed for _, feature in joined),
            ),
            next(defaults, None),
            tuple(feature.element for _, feature in joined),
            " " in name  # No behaviour assigns a sum itself.
            or all(self._is_input(feature) for _, feature in joined)
            or (len(joined) == 1 and self._is_open(name, first)),
            any(_is_computed(feature) for _, feature in joined),
        )

    def _place_names(self, holder: ComponentObject, variables: Iterable[str]) -> tuple[str, ...]:
        """Return the slots, as paths, of variables in the context of an object."""
        names = {
            variable: name
            for context in reversed(self._list_contexts(holder))
            for name, variable in context.variables.items()
        }
        slots = (self.slot_of(holder.path, names[variable]) for variable in variables)
        return tuple(join_path(*slot) for slot in slots)

    def _place_term(self, holder: ComponentObject, term: Term) -> Term:
        """Return a sum of variables of an object as a sum of slots."""
        keys = self._place_names(holder, (name for name, _ in term))
        return tuple((key, factor) for key, (_, factor) in zip(keys, term, strict=True))

    def iter_facts(self) -> Iterator[Fact]:
        """Yield the sums of slots that constraints keep in an interval."""
        for object_ in self.objects:
            for term, interval in self.context(object_).facts:
                yield self._place_term(object_, term), interval

    def _is_input(self, feature: Feature) -> bool:
        # A flow property without a direction is ``inout`` (SysML 1.6 clause 9.3.2.8).
        default = "inout" if feature.element.kind is Kind.FLOW_PROPERTY else ""
        return (feature.direction or default) in ("in", "inout")

    def _is_open(self, name: str, feature: Feature) -> bool:
        """Whether a feature that nothing inside joins may get its value through a connection."""
        if feature.direction == "out":
            return False
        is_connected = any(True for _ in self.graph.sources(feature.element, Edge.ROLE))
        return "." in name or is_connected


def _is_computed(feature: Feature) -> bool:
    # A default such as ``0..5`` states a range.
    text = str(feature.element.attrs.get("default", ".."))
    return feature.default is None and ".." not in text


def is_value(element: Element | None) -> bool:
    """Whether an element has a value of its own in an object."""
    return element is not None and element.kind in VALUE_KINDS
