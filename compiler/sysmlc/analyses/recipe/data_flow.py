"""Data flow of an activity: the variables that pins assign and that expressions read."""

from collections import Counter
from collections.abc import Iterator, Mapping
from functools import cached_property

from msgspec import Struct

from sysmlc.analyses.recipe.context import Context
from sysmlc.analyses.recipe.expressions import (
    build_parameter,
    find_feature,
    is_data,
    is_input,
    read_expression,
    resolve_literals,
    unit_name,
)
from sysmlc.analyses.recipe.profile import convert_value
from sysmlc.ir import Edge, Element, Kind, query
from sysmlc.ir.expressions import (
    Expression,
    Literal,
    Member,
    Name,
    ParsedText,
    dotted_name,
    walk_tree,
)
from sysmlc.ir.query.classifiers import name_value_unit
from sysmlc.logic.feature_writes import find_bound_name
from sysmlc.recipe.expression import make_opaque, make_variable, map_operands, variable_name
from sysmlc.recipe.model import Parameter, Scalar

_OUT = ("out", "inout")


class DataFlow(Struct, frozen=True, dict=True):
    """The variables of one activity, by which its actions pass values on.

    An output pin assigns the variable of its own name. This is an attribute or parameter of the
    activity (``declared``), or else a variable that the pin declares. If several pins declare the
    same name (``shared``), their variables are called ``action.pin``.
    """

    context: Context
    activity: Element
    declared: frozenset[str]
    shared: frozenset[str]
    dotted: frozenset[str] = frozenset()
    """Names ``action.pin`` in expressions of the activity; they may refer to output pins."""
    outputs: tuple[Element, ...] = ()
    """Output pins of the actions of the activity."""

    @classmethod
    def build(cls, context: Context, activity: Element) -> "DataFlow":
        """Return the data flow of an activity."""
        kinds = (Kind.PARAMETER, Kind.PROPERTY)
        declared = frozenset(
            context.label(element)
            for element in context.contents(activity)
            if element.kind in kinds
        )
        outputs = tuple(_list_output_pins(context, activity))
        pin_counts = Counter(map(context.label, outputs))
        repeated = {name for name, count in pin_counts.items() if count > 1}
        dotted = _find_dotted_names(context, activity)
        return cls(context, activity, declared, frozenset(repeated - declared), dotted, outputs)

    # -- reads and writes of actions -----------------------------------------------------------

    def bind_inputs(self, node: Element) -> tuple[tuple[str, Expression], ...]:
        """Return the names of input pins with the expressions of their values, sorted."""
        values = {
            self.context.label(pin): self._find_value(pin)
            for pin in self._list_pins(node, "in", "inout")
        }
        return tuple(
            (name, value) for name in sorted(values) if (value := values[name]) is not None
        )

    def assign_outputs(self, node: Element) -> tuple[tuple[str, str], ...]:
        """Return the names of output pins with the variables that they assign, sorted."""
        return tuple(
            sorted(
                (self.context.label(pin), self.variable_of(pin))
                for pin in self._list_pins(node, *_OUT)
            )
        )

    def read(self, text: str) -> Expression:
        """Return the expression of a text, with ``rename_variables`` applied."""
        return self.rename_variables(resolve_literals(self.context, read_expression(text)))

    def rename_variables(self, expression: Expression) -> Expression:
        """Replace names of output pins, and of attributes bound to them, by their variables."""
        return _rename_variables(expression, self._variables) if self.dotted else expression

    @cached_property
    def _variables(self) -> dict[str, str]:
        """The variables of output pins, by ``action.pin`` and by attributes bound to the pins."""
        variables = {self._dotted_name(pin): self.variable_of(pin) for pin in self.outputs}
        bound = dict(self._iter_bound_attributes())
        while new := [name for name, path in bound.items() if path in variables]:
            variables |= {name: variables[bound.pop(name)] for name in new}
        return variables

    def _iter_bound_attributes(self) -> Iterator[tuple[str, str]]:
        """Yield the attributes with a binding ``= path``, and the path."""
        for element in self.context.contents(self.activity):
            text = element.attrs.get("default")
            is_bound = element.attrs.get("default_kind") == "bound" and isinstance(text, str)
            if element.kind is Kind.PROPERTY and is_bound and "default_language" in element.attrs:
                yield self.context.label(element), str(text)

    def variable_of(self, pin: Element) -> str:
        """Return the variable that an output pin assigns: its bound feature, or its own name."""
        for flow in query.outgoing(self.context.graph, pin):
            target = query.flow_target(self.context.graph, flow)
            if target is not None and target.kind is Kind.ACTIVITY_PARAMETER:
                return self._parameter_name(target)
            if target is not None and target.kind is Kind.PROPERTY:
                return self.context.label(target)
        bound = find_bound_feature(self.context, pin)
        if bound:
            return bound
        name, dotted_name = self.context.label(pin), self._dotted_name(pin)
        return dotted_name if name in self.shared or dotted_name in self.dotted else name

    def _dotted_name(self, pin: Element) -> str:
        """Return ``action.pin``."""
        name, action = self.context.label(pin), self.context.graph.owner(pin)
        return name if action is None else f"{self.context.label(action)}.{name}"

    def find_sizes(self, collection: Expression) -> tuple[int, int | None]:
        """Return the smallest and largest size of a collection by its multiplicity.

        A largest size None is unlimited. Without a multiplicity nothing is known of the smallest.
        """
        feature = find_feature(self.context, collection)
        multiplicity = None if feature is None else feature.attrs.get("multiplicity")
        limits = None if feature is None else query.bounds(multiplicity)
        if limits is None:
            return 0, None
        return 0 if multiplicity is None else limits[0], limits[1]

    def source_of(self, flow: Element) -> Expression | None:
        """Return the value that an object flow transports, or None.

        The value is the variable of the output pin or parameter at which the chain of flows starts.
        """
        graph, seen = self.context.graph, {flow.id}
        stack = [flow]
        while stack:
            end = query.flow_source(graph, stack.pop())
            if end is None:
                continue
            if end.kind is Kind.PIN and not self._is_passed_on(end):
                return make_variable(self.variable_of(end))
            if end.kind is Kind.ACTIVITY_PARAMETER:
                return make_variable(self._parameter_name(end))
            incoming = [
                previous for previous in query.incoming(graph, end) if previous.id not in seen
            ]
            seen.update(previous.id for previous in incoming)
            stack.extend(previous for previous in incoming if previous.kind is Kind.OBJECT_FLOW)
        return None

    def _is_passed_on(self, pin: Element) -> bool:
        """Whether the pin belongs to an inlined node, and so only passes its value on."""
        owner = self.context.graph.owner(pin)
        return owner is not None and self.context.is_inlined(owner)

    # -- declarations --------------------------------------------------------------------------

    def list_parameters(self, *directions: str) -> tuple[Parameter, ...]:
        """Return the parameters of these directions, without materials and optional machines."""
        return list_data_parameters(self.context, self.activity, *directions)

    def list_variables(self) -> tuple[Parameter, ...]:
        """Return the variables for attributes and output pins of the activity, sorted by name."""
        elements = self.context.contents(self.activity)
        attributes = [
            element
            for element in elements
            if element.kind is Kind.PROPERTY
            and is_data(self.context, element)
            and not (self.dotted and self.context.label(element) in self._variables)
        ]
        by_name = {
            self.context.label(element): build_parameter(self.context, element)
            for element in attributes
        }
        # Optional machines and materials are no parameters, but expressions read their features.
        heads = {name.partition(".")[0] for name in self.dotted}
        for element in query.parameters(self.context.graph, self.activity, "in"):
            if element.name in heads and not is_input(self.context, element):
                by_name[element.name] = build_parameter(self.context, element)
        for pin in self.outputs:
            name = self.variable_of(pin)
            if name not in self.declared and is_data(self.context, pin):
                parameter = build_parameter(self.context, pin)
                by_name.setdefault(name, Parameter(name, parameter.type, parameter.unit))
        return tuple(by_name[name] for name in sorted(by_name))

    def _list_pins(self, node: Element, *directions: str) -> Iterator[Element]:
        for pin in self.context.graph.owned(node):
            fits = pin.kind is Kind.PIN and pin.attrs.get("direction") in directions
            if fits and is_input(self.context, pin):
                yield pin

    def _find_value(self, pin: Element) -> Expression | None:
        value = pin.attrs.get("value")
        if isinstance(value, str) and "value_instance" in pin.attrs:
            return Literal(value)
        if isinstance(value, str):
            return self.read(value)
        unit = name_value_unit(self.context.graph, pin, "value")
        if isinstance(value, bool | int | float):
            return self._read_quantity(pin, value, unit) if unit else Literal(value)
        for flow in query.incoming(self.context.graph, pin):
            source = self.source_of(flow)
            if source is not None:
                return source
        # A pin without value and flow reads the variable that an output pin of its name assigns.
        name = self.context.label(pin)
        return make_variable(name) if name in self.declared else None

    def _read_quantity(self, pin: Element, number: Scalar, unit: str) -> Expression:
        """Return a number in the unit of the pin's type; without one, a time in milliseconds."""
        target = unit_name(self.context, pin) or "ms"
        converted = convert_value(number, unit, target)
        return make_opaque(f"{number} {unit}") if converted is None else Literal(converted)

    def _parameter_name(self, node: Element) -> str:
        parameter = self.context.graph.target(node, Edge.REFERENCES)
        return self.context.label(node if parameter is None else parameter)


def _rename_variables(expression: Expression, names: Mapping[str, str]) -> Expression:
    name = variable_name(expression)
    if name is not None:
        return make_variable(names[name]) if name in names else expression
    return map_operands(expression, lambda operand: _rename_variables(operand, names))


def _find_dotted_names(context: Context, activity: Element) -> frozenset[str]:
    """Return the paths ``a.b`` in values, guards and bodies of an activity."""
    texts: list[object] = []
    for node in context.contents(activity):
        if node.kind is Kind.COMMENT:
            continue
        texts += [node.attrs.get(key) for key in ("guard", "body", "default", "collection")]
        texts += [pin.attrs.get("value") for pin in context.graph.owned(node)]
    trees = [text.tree for text in texts if isinstance(text, ParsedText)]
    nodes = (node for tree in trees for node in walk_tree(tree) if isinstance(node, Member))
    return frozenset(dotted_name(node) or "" for node in nodes if isinstance(node.base, Name))


def list_data_parameters(
    context: Context, element: Element, *directions: str
) -> tuple[Parameter, ...]:
    """Return the parameters of these directions that hold values or required machines."""
    elements = query.parameters(context.graph, element, *directions)
    return tuple(
        build_parameter(context, declared) for declared in elements if is_input(context, declared)
    )


def find_bound_feature(context: Context, pin: Element) -> str:
    """Return the path of the feature to which the model binds an output pin, or ''."""
    action = context.graph.owner(pin)
    is_text = isinstance(pin.attrs.get("value"), str) and "value_instance" not in pin.attrs
    if action is None or not is_text:
        return ""
    return (find_bound_name(context.graph, action, pin) or "").removeprefix("self.")


def _list_output_pins(context: Context, activity: Element) -> Iterator[Element]:
    for node in context.contents(activity):
        if node.kind is Kind.ACTION:
            for pin in context.graph.owned(node):
                if pin.kind is Kind.PIN and pin.attrs.get("direction") in _OUT:
                    yield pin
