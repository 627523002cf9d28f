"""The objects of a component, itself and its parts, and the features that they have.

A feature belongs to the object that owns it, whichever behaviour writes it. Connectors and bindings
make features of several objects equal.
"""

from collections.abc import Iterator

from msgspec import Struct

from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.logic.composition.structure import End, iter_links, iter_usages, join_path
from sysmlc.logic.contract import Domain, Owner, Variable
from sysmlc.logic.expressions.context import Context, context_of
from sysmlc.logic.expressions.features import Feature
from sysmlc.logic.expressions.named_elements import VALUE_KINDS
from sysmlc.logic.formula import Literal
from sysmlc.logic.identifiers import Names
from sysmlc.support.disjoint_sets import DisjointSets

Slot = tuple[str, str]
"""The path of an object, and the name of one of its features."""
_MAX_OBJECTS = 200


class ComponentError(Exception):
    """A reason why the step relation of a component cannot be built."""


class ComponentObject(Struct, frozen=True):
    """The component itself (empty path) or one of its parts, with its type."""

    path: str
    type_: Element
    owner: "ComponentObject | None" = None

    def list_family(self, graph: Graph) -> tuple[Element, ...]:
        """Return the type of the object and the generals of the type, nearest first."""
        return self.type_, *query.generals(graph, self.type_)


class FeatureSlot(Struct, frozen=True):
    """The value that joined features share: its variable, and what the model says about it."""

    variable: Variable
    default: Literal | None
    elements: tuple[Element, ...]
    is_input: bool
    """Whether all joined features have the direction ``in``, so that the environment decides it."""


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
        self.channels: DisjointSets[Slot] = DisjointSets()
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
        for left_ends, right_ends in iter_links(self.graph, owner.type_, owner.path):
            for left in left_ends:
                for right in right_ends:
                    self.channels.union((left.path, left.feature), (right.path, right.feature))
                    self._join_ends(left, right)

    def _join_ends(self, left: End, right: End) -> None:
        if not (left.feature and right.feature):
            return
        suffixes = set(self._iter_suffixes(right))
        for suffix in self._iter_suffixes(left):
            if suffix in suffixes:
                self.joined.union(
                    (left.path, left.feature + suffix), (right.path, right.feature + suffix)
                )

    def _iter_suffixes(self, end: End) -> Iterator[str]:
        holder = self.find_object(end.path)
        for name in () if holder is None else self.context(holder).variables:
            if name == end.feature or name.startswith(f"{end.feature}."):
                yield name[len(end.feature) :]

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

    def context(self, object_: ComponentObject) -> Context:
        """Return what names mean inside an object."""
        if object_.path not in self._contexts:
            self._contexts[object_.path] = context_of(self.graph, object_.type_, self.assumed_range)
        return self._contexts[object_.path]

    # -- features ----------------------------------------------------------------------------------

    def find_slot(self, object_: ComponentObject, element: Element, variable: str) -> Slot | None:
        """Return the slot of a feature that a behaviour of an object names, or None.

        *variable* is the variable of the feature in the behaviour. A value at a port
        (``level.value``) belongs to the object that has the port.
        """
        holder = self.find_holder(object_, element)
        if holder is not None:
            return self.slot_of(holder.path, self._find_name(element))
        variables = self.context(object_).variables
        dotted = (name for name in variables if "." in name and variables[name] == variable)
        name = next(dotted, None)
        return None if name is None else self.slot_of(object_.path, name)

    def slot_of(self, path: str, name: str) -> Slot:
        """Return the representative of the joined features to which a feature belongs."""
        return self.joined.find((path, name))

    def _find_name(self, feature: Element) -> str:
        """Return the name of the feature that a feature redefines in the end, else its own."""
        redefined = self.graph.target(feature, Edge.REDEFINES)
        return self._find_name(redefined) if redefined is not None else feature.name

    def find_features(self, slot: Slot) -> list[tuple[ComponentObject, Feature]]:
        """Return the features that share a slot, each with the object that has it."""
        joined: list[tuple[ComponentObject, Feature]] = []
        for object_ in self.objects:
            features = self.context(object_).features
            for name in features:
                if self.joined.find((object_.path, name)) == slot:
                    joined.append((object_, features[name]))
        return joined

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
            raise ComponentError(f"'{join_path(path, name)}' has not finitely many values")
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
            Variable(variable, Owner.SYSTEM, domains[0], first.element.id),
            next(defaults, None),
            tuple(feature.element for _, feature in joined),
            all(feature.direction == "in" for _, feature in joined),
        )


def is_value(element: Element | None) -> bool:
    """Whether an element has a value of its own in an object."""
    return element is not None and element.kind in VALUE_KINDS
