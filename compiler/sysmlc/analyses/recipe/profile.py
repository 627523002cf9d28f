"""Recipe levels and tagged values of the shipped profile, metamodels/sysmlc.profile.uml."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from fractions import Fraction

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind, query
from sysmlc.ir.query.classifiers import name_value_unit, unit_of
from sysmlc.passes.classify import vocabulary
from sysmlc.passes.classify.lineage import Profiles
from sysmlc.passes.classify.vocabulary import Family
from sysmlc.recipe.model import Range
from sysmlc.support.units import convert, find_time_unit, split_quantity

NAMESPACE = "urn:sysmlc:profile:1"
"""Namespace of the shipped profile, metamodels/sysmlc.profile.uml."""

_NO_LEVELS = ("capability", "opc ua call")
"""Entries of the vocabulary that are no levels: they mark relations and calls of services."""
LEVELS = {name: level for name, level in vocabulary.LEVELS.items() if level not in _NO_LEVELS}
"""Level of the recipe, by stereotype of the profile."""

CALL_KINDS = ("call", "read", "write", "subscribe")
MATERIAL_USES = ("consumed", "produced", "carried")

_LEVEL_EDGES = (Edge.SPECIALIZES, Edge.TYPED_BY, Edge.REDEFINES, Edge.CALLS, Edge.METHOD)
"""Edges whose source takes over the level of their target."""


def find_profile_stereotypes(graph: Graph) -> dict[str, tuple[str, ...]]:
    """Return the stereotypes of the shipped profile by the id of the application.

    An application means the applied stereotype or its generals. Stereotypes of other profiles mean
    nothing here, even if they have the same name (BPMN has a «Task»). An application without a
    namespace, which only graphs in text form have, means what it names.
    """
    profiles = Profiles(graph)
    stereotypes: dict[str, tuple[str, ...]] = {}
    for application in graph.of_kind(Kind.APPLICATION):
        names = query.lineage(application)
        if "namespace" in application.attrs:
            ancestors = profiles.lineage(application)
            names = tuple(item.name for item in ancestors if item.family is Family.SYSMLC)
        if names:
            stereotypes[application.id] = names
    return stereotypes


def find_stated_levels(
    graph: Graph,
    stereotypes: Mapping[str, tuple[str, ...]],
    levels: Mapping[str, str],
    segment: Callable[[Element], str],
) -> dict[str, str]:
    """Return the levels by id that options, ``classify`` or stereotypes give to elements.

    *stereotypes* is the result of ``find_profile_stereotypes``. *levels* are those of the options,
    by ids or qualified names, and take precedence. *segment* returns the part of a qualified name
    that stands for an element.
    """
    stated = _levels_of_stereotypes(graph, stereotypes)
    names = frozenset(LEVELS.values())
    for element in graph:
        if "level" in element.attrs and (level := str(element.attrs["level"])) in names:
            stated[element.id] = level
    roots = graph.roots() if levels else []
    for name, level in levels.items():
        stated.update(
            (element.id, level) for element in _find_named(graph, name, roots, segment) if level
        )
    stated.update((id, level) for id, level in levels.items() if level and id in graph)
    return stated


def _levels_of_stereotypes(
    graph: Graph, stereotypes: Mapping[str, tuple[str, ...]]
) -> dict[str, str]:
    """Return the levels by id that applied stereotypes give to elements."""
    names: dict[str, set[str]] = {}
    for application, applied in stereotypes.items():
        for subject in graph.targets(graph[application], Edge.SUBJECT):
            names.setdefault(subject.id, set()).update(applied)
    levels = LEVELS.items()
    stated = (
        (id, next((level for name, level in levels if name in applied), ""))
        for id, applied in names.items()
    )
    return {id: level for id, level in stated if level}


def _find_named(
    graph: Graph, name: str, siblings: list[Element], segment: Callable[[Element], str]
) -> Iterator[Element]:
    """Yield the elements with a qualified name, searching only owners whose name is a prefix."""
    for element in siblings:
        part = segment(element)
        if name == part:
            yield element
        elif name.startswith(f"{part}::"):
            yield from _find_named(graph, name[len(part) + 2 :], graph.owned(element), segment)


def find_followers(graph: Graph, first: Iterable[str]) -> set[str]:
    """Return *first* and the ids of all elements that may take over a level from one of these."""
    worklist = [graph[id] for id in first]
    reached = {element.id for element in worklist}
    while worklist:
        element = worklist.pop()
        users = (user for edge in _LEVEL_EDGES for user in graph.sources(element, edge))
        new = [user for user in users if user.id not in reached]
        reached.update(user.id for user in new)
        worklist += new
    return reached


UNITS = {
    **dict.fromkeys(("duration", "minDuration", "maxDuration", "timeout"), "ms"),
    **dict.fromkeys(("minPower", "maxPower"), "W"),
}
"""Unit in which the recipe has the number of a tag; a number without a unit is in this unit."""

MAX_NUMBER = 2**53
"""The largest whole number up to which readers of JSON represent all whole numbers exactly."""

_NUMERIC_TAGS = (*UNITS, "priority", "maxIterations", "quantity", "available", "buffer")


class Tags(Struct, frozen=True):
    """Tagged values of an application, read as the types of the profile.

    The methods return None or an empty value for a tag that is absent or has another form.
    """

    attrs: Mapping[str, object]
    units: Mapping[str, str] = {}
    """Units that the value types of tags state; a unit in a tagged value takes precedence."""
    material_unit: str = ""
    """Unit in which the recipe has amounts of the material to which the tags belong."""

    def override(self, tags: "Tags") -> "Tags":
        """Return these tagged values, with those of *tags* in the place of their own."""
        return replace(self, attrs={**self.attrs, **tags.attrs}, units={**self.units, **tags.units})

    def text(self, name: str) -> str:
        """Return the first text of a tag, or the empty string."""
        return next(iter(self.texts(name)), "")

    def texts(self, name: str) -> list[str]:
        """Return all texts of a tag."""
        value = self.attrs.get(f"tag.{name}")
        if value is None:
            return []
        return [str(item) for item in value] if isinstance(value, tuple) else [str(value)]

    def ids(self, name: str) -> list[str]:
        """Return the references of a tag, ids or names; spaces separate several in one text."""
        return [id for text in self.texts(name) for id in text.split()]

    def flag(self, name: str) -> bool | None:
        """Return a truth value, or None."""
        return {"true": True, "false": False}.get(self.text(name).lower())

    def unit(self, name: str) -> str:
        """Return the unit in which the model states the number of a tag, or the empty string."""
        quantity = split_quantity(self.text(name))
        if quantity is None:
            return self.units.get(name, "")
        word = find_time_unit(quantity[1]) if self.target_unit(name) == "ms" else None
        return word.symbol if word and word.factor else quantity[1]

    def target_unit(self, name: str) -> str:
        """Return the unit in which the recipe has the number of a tag, or the empty string."""
        is_amount = name in ("available", "quantity")
        return self.material_unit if is_amount else UNITS.get(name, "")

    def amount(self, name: str) -> int | float | None:
        """Return a number that is not negative, in the unit of the recipe, or None."""
        number = self._read_number(name)
        return number if number is not None and 0 <= number <= MAX_NUMBER else None

    def is_too_large(self, name: str) -> bool:
        """Whether a number has more digits than the recipe can represent."""
        number = self._read_number(name)
        return number is not None and number > MAX_NUMBER

    def _read_number(self, name: str) -> int | float | None:
        """Return a number in the unit of the recipe, or None."""
        text, stated, target = self.text(name), self.unit(name), self.target_unit(name)
        quantity = split_quantity(text)
        number = read_number(text) if quantity is None else shorten(quantity[0])
        return convert_value(number, stated, target) if stated else number

    def integer(self, name: str) -> int | None:
        """Return a whole number that is not negative, in the unit of the recipe, or None."""
        value = self.amount(name)
        return int(value) if value is not None and value == int(value) else None

    def endpoint(self, name: str) -> str | None:
        """Return an OPC UA address, or None."""
        text = self.text(name)
        return text if text.startswith("opc.tcp://") else None

    def call_kind(self, name: str) -> str | None:
        """Return the use of an OPC UA node; ``call`` if the tag is absent."""
        text = self.text(name) or "call"
        return text if text in CALL_KINDS else None

    def material_use(self, name: str) -> str | None:
        """Return how a material is used, or None."""
        text = self.text(name)
        return text if text in MATERIAL_USES else None

    def range(self, low: str, high: str) -> Range | None:
        """Return the range of two tags; if only one is present, it is both bounds."""
        values = [v for v in (self.amount(low), self.amount(high)) if v is not None]
        return Range(values[0], values[-1]) if values else None


def read_tags(graph: Graph, application: Element | None) -> Tags:
    """Return the tagged values of an application; none for None."""
    if application is None:
        return Tags({})
    stereotype = graph.target(application, Edge.INSTANCE_OF)
    family = [] if stereotype is None else [stereotype, *query.generals(graph, stereotype)]
    tags = [feature for classifier in family for feature in query.features(graph, classifier)]
    stated = ((tag.name, unit_of(graph, tag)) for tag in reversed(tags))
    units = {name: str(unit.attrs.get("symbol") or unit.name) for name, unit in stated if unit}
    constants: dict[str, AttrValue] = {}
    for name in _NUMERIC_TAGS:
        element = graph.get(str(application.attrs.get(f"tag.{name}", "")))
        if element is not None:
            constants[f"tag.{name}"], unit_name = _read_constant(graph, element)
            units[name] = unit_name or units.get(name, "")
    return Tags({**application.attrs, **constants}, units)


def _read_constant(graph: Graph, element: Element) -> tuple[str, str]:
    """Return the constant number of an attribute and its unit, or else the name of the attribute.

    The unit is empty if the attribute does not state it.
    """
    key = "value" if element.kind is Kind.INSTANCE else "default"
    number = element.attrs.get(key)
    is_number = isinstance(number, int | float) and not isinstance(number, bool)
    if not is_number or element.attrs.get(f"{key}_kind") == "initial":
        return element.name, ""
    return str(number), name_value_unit(graph, element, key)


def shorten(number: Fraction) -> int | float:
    """Return a number as an integer if it is whole, else as a float."""
    return int(number) if number.denominator == 1 else float(number)


def convert_value(value: object, unit: str, target: str) -> int | float | None:
    """Return a number in the unit *target*, or None if it cannot be converted."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    number = convert(Fraction(str(value)), unit, target)
    return None if number is None else shorten(number)


def read_number(text: str) -> int | float | None:
    """Return the number of a text, or None; whole numbers become integers."""
    try:
        return int(text)
    except ValueError:
        pass
    try:
        value = float(text)
    except ValueError:
        return None
    # float() also reads `nan` and `inf`; NaN is the only number that differs from itself.
    if value != value or value in (float("inf"), float("-inf")):
        return None
    return int(value) if value == int(value) else value
