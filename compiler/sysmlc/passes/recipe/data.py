"""Data of an activity: which variables its guards, pins and parameters stand for."""

import re
from collections import Counter
from collections.abc import Iterator, Mapping

from msgspec import Struct, field

from sysmlc.ir import Edge, Element, Kind, query
from sysmlc.passes.recipe.context import Context
from sysmlc.passes.recipe.expressions import read, read_time, with_values
from sysmlc.passes.recipe.features import feature_at, is_data, is_input, parameter
from sysmlc.passes.recipe.regions import is_inlined
from sysmlc.recipe.expression import Apply, Call, Expr, Index, Lit, Var
from sysmlc.recipe.model import Parameter


class Data(Struct, frozen=True):
    """Variables of one activity.

    An output pin is the variable of its own name: an attribute or parameter of the activity, or
    one that the pin declares; two undeclared pins of one name become ``action.pin``.
    """

    context: Context
    activity: Element
    declared: frozenset[str]
    shared: frozenset[str]
    dotted: frozenset[str] = frozenset()
    """Names ``action.pin`` by which the activity's expressions speak of output pins."""
    outputs: tuple[Element, ...] = ()
    """Output pins of its actions."""
    _renamed: dict[str, str] = field(default_factory=dict)

    @classmethod
    def of(cls, context: Context, activity: Element) -> "Data":
        """The data of an activity."""
        inside = context.contents(activity)
        kinds = (Kind.PARAMETER, Kind.PROPERTY)
        names = {context.label(one) for one in inside if one.kind in kinds}
        outputs = tuple(_outputs(context, activity))
        pins = Counter(map(context.label, outputs))
        shared = {name for name, count in pins.items() if count > 1}
        spoken = _spoken(context, activity)
        return cls(context, activity, frozenset(names), frozenset(shared - names), spoken, outputs)

    # -- what an action reads and writes -------------------------------------------------------

    def bind(self, node: Element) -> tuple[tuple[str, Expr], ...]:
        """Input pins of an action with the expressions that fill them, by name."""
        found = {self.context.label(pin): self._filled(pin) for pin in self._pins(node, "in")}
        return tuple(
            (name, value) for name, value in sorted(found.items(), key=_first) if value is not None
        )

    def assign(self, node: Element) -> tuple[tuple[str, str], ...]:
        """Output pins of an action with the variables that they set, by name."""
        return tuple(sorted(self._assigned(node)))

    def _assigned(self, node: Element) -> Iterator[tuple[str, str]]:
        for pin in self._pins(node, "out"):
            yield self.context.label(pin), self.variable(pin)

    def read(self, text: str) -> Expr:
        """An expression of the activity, with the variables that output pins set."""
        found = with_values(self.context, self.activity, read(text))
        if not self.dotted:
            return found
        if not self._renamed:
            self._renamed.update(self._names_of_outputs())
        return _renamed(found, self._renamed)

    def _names_of_outputs(self) -> Iterator[tuple[str, str]]:
        """Names ``action.pin`` of output pins, with the variables that these set."""
        for pin in self.outputs:
            owner = self.context.graph.owner(pin)
            if owner is not None:
                label = f"{self.context.label(owner)}.{self.context.label(pin)}"
                yield label, self.variable(pin)

    def variable(self, pin: Element) -> str:
        """Variable that an output pin sets."""
        for flow in query.outgoing(self.context.graph, pin):
            target = query.flow_target(self.context.graph, flow)
            if target is not None and target.kind is Kind.ACTIVITY_PARAMETER:
                return self._parameter_name(target)
        name = self.context.label(pin)
        owner = self.context.graph.owner(pin)
        full = name if owner is None else f"{self.context.label(owner)}.{name}"
        return full if name in self.shared or full in self.dotted else name

    def size(self, collection: Expr) -> int | None:
        """How many elements a collection has at most, when its multiplicity says it."""
        match collection:
            case Var(name):
                found = feature_at(self.context, self.activity, name)
                limits = None if found is None else query.bounds(found.attrs.get("multiplicity"))
                return None if limits is None else limits[1]
            case _:
                return None

    def source_of(self, flow: Element) -> Expr | None:
        """Value that an object flow carries: the variable of the pin or parameter it starts at."""
        graph, seen = self.context.graph, {flow.id}
        stack = [flow]
        while stack:
            start = query.flow_source(graph, stack.pop())
            if start is None:
                continue
            if start.kind is Kind.PIN and not self._is_passed_on(start):
                return Var(self.variable(start))
            if start.kind is Kind.ACTIVITY_PARAMETER:
                return Var(self._parameter_name(start))
            before = [one for one in query.incoming(graph, start) if one.id not in seen]
            seen.update(one.id for one in before)
            stack.extend(one for one in before if one.kind is Kind.OBJECT_FLOW)
        return None

    def _is_passed_on(self, pin: Element) -> bool:
        """Whether a pin of a block only hands on what comes to it."""
        owner = self.context.graph.owner(pin)
        return owner is not None and is_inlined(self.context.graph, owner)

    # -- declarations --------------------------------------------------------------------------

    def parameters(self, *directions: str) -> tuple[Parameter, ...]:
        """Parameters with one of the directions; materials and optional machines are left out."""
        return data_parameters(self.context, self.activity, *directions)

    def variables(self) -> tuple[Parameter, ...]:
        """Attributes of the activity, and what output pins declare, by name."""
        inside = self.context.contents(self.activity)
        attributes = [
            one for one in inside if one.kind is Kind.PROPERTY and is_data(self.context, one)
        ]
        found = {self.context.label(one): parameter(self.context, one) for one in attributes}
        heads = {name.partition(".")[0] for name in self.dotted}
        for one in query.parameters(self.context.graph, self.activity, "in"):
            if one.name in heads and not is_input(self.context, one):
                found[one.name] = parameter(self.context, one)
        names = self.declared
        for pin in self.outputs:
            name = self.variable(pin)
            if name not in names and is_data(self.context, pin):
                made = parameter(self.context, pin)
                found.setdefault(name, Parameter(name, made.type, made.unit))
        return tuple(found[name] for name in sorted(found))

    def _pins(self, node: Element, direction: str) -> Iterator[Element]:
        for pin in self.context.graph.owned(node):
            fits = pin.kind is Kind.PIN and pin.attrs.get("direction") == direction
            if fits and is_input(self.context, pin):
                yield pin

    def _filled(self, pin: Element) -> Expr | None:
        value = pin.attrs.get("value")
        if isinstance(value, str) and "value_instance" in pin.attrs:
            return Lit(value)
        if isinstance(value, str):
            return self.read(value)
        unit = pin.attrs.get("value_unit")
        if isinstance(value, bool | int | float):
            return read_time(f"{value} {unit}") if isinstance(unit, str) else Lit(value)
        for flow in query.incoming(self.context.graph, pin):
            found = self.source_of(flow)
            if found is not None:
                return found
        name = self.context.label(pin)
        return Var(name) if name in self.declared else None

    def _parameter_name(self, node: Element) -> str:
        found = self.context.graph.target(node, Edge.REFERENCES)
        return self.context.label(node if found is None else found)


def _first(pair: tuple[str, Expr | None]) -> str:
    return pair[0]


def _renamed(expression: Expr, names: Mapping[str, str]) -> Expr:
    match expression:
        case Var(name):
            return Var(names.get(name, name))
        case Apply(op, args):
            return Apply(op, tuple(_renamed(one, names) for one in args))
        case Index(base, index):
            return Index(_renamed(base, names), _renamed(index, names))
        case Call(function, args):
            return Call(function, tuple(_renamed(one, names) for one in args))
        case _:
            return expression


def _spoken(context: Context, activity: Element) -> frozenset[str]:
    """Dotted names in the values, guards and texts of an activity."""
    texts: list[object] = []
    for node in context.contents(activity):
        if node.kind is Kind.COMMENT:
            continue
        texts += [node.attrs.get(key) for key in ("guard", "body", "default", "collection")]
        texts += [pin.attrs.get("value") for pin in context.graph.owned(node)]
    dotted = (_DOTTED.findall(text) for text in texts if isinstance(text, str) and "." in text)
    return frozenset(name for found in dotted for name in found)


_DOTTED = re.compile(r"[^\W\d]\w*\.[^\W\d]\w*")


def data_parameters(context: Context, element: Element, *directions: str) -> tuple[Parameter, ...]:
    """Parameters that hold values, or a machine that is needed, in order."""
    found = query.parameters(context.graph, element, *directions)
    return tuple(parameter(context, one) for one in found if is_input(context, one))


def _outputs(context: Context, activity: Element) -> Iterator[Element]:
    for node in context.contents(activity):
        for pin in context.graph.owned(node) if node.kind is Kind.ACTION else ():
            if pin.kind is Kind.PIN and pin.attrs.get("direction") == "out":
                yield pin
