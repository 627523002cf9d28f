"""Variables of machines that the expressions of a recipe read or set."""

import re
from collections.abc import Iterable, Iterator

from msgspec.structs import replace

from sysmlc.ir import Element, Kind, query
from sysmlc.logic.expressions.expression import Expression
from sysmlc.passes.recipe.context import Context
from sysmlc.passes.recipe.features import find_member, literal_default, value_type
from sysmlc.passes.recipe.machines import find_opcua_node
from sysmlc.recipe.checks import iter_graphs
from sysmlc.recipe.expression import iter_variables
from sysmlc.recipe.model import (
    MachineVariable,
    Model,
    Parameter,
    Recipe,
    ReferenceType,
)

_NAME = re.compile(r"[^\W\d]\w*")


def add_machine_variables(context: Context, model: Model) -> Model:
    """Return the model, each machine with the variables that expressions name."""
    names_by_machine: dict[str, set[str]] = {}
    for parameters, expressions in _list_scopes(model):
        machines = dict(_machine_parameters(parameters))
        for name in (name for expression in expressions for name in iter_variables(expression)):
            head, _, rest = name.partition(".")
            if rest and head in machines:
                names_by_machine.setdefault(machines[head], set()).add(rest)
    machines_of_model = tuple(
        replace(
            machine,
            variables=_build_variables(
                context, machine.element, sorted(names_by_machine.get(machine.id, ()))
            ),
        )
        for machine in model.machines
    )
    return replace(model, machines=machines_of_model)


def _machine_parameters(parameters: Iterable[Parameter]) -> Iterator[tuple[str, str]]:
    """Yield the names of parameters that stand for machines, with the machine."""
    for parameter in parameters:
        if isinstance(parameter.type, ReferenceType) and parameter.type.to == "machine":
            yield parameter.name, parameter.type.name


def _list_scopes(model: Model) -> Iterator[tuple[tuple[Parameter, ...], list[Expression]]]:
    """Yield each scope of names: the declared parameters, and the expressions that use them."""
    recipe: Recipe = model.recipe
    bindings = [value for task in recipe.tasks for _, value in task.bind]
    yield (*recipe.inputs, *recipe.variables), bindings
    for graph in iter_graphs(model):
        expressions = [value for node in graph.nodes for _, value in node.bind]
        expressions += [node.expression for node in graph.nodes if node.expression is not None]
        expressions += [edge.guard for edge in graph.edges if edge.guard is not None]
        yield (*graph.inputs, *graph.variables), expressions


def _build_variables(
    context: Context, machine: str, names: Iterable[str]
) -> tuple[MachineVariable, ...]:
    element = context.graph.get(machine)
    variables_by_name: dict[str, MachineVariable] = {}
    if element is not None:
        type_ = query.type_of(context.graph, element) or element
        for name in names:
            _add_variable(context, type_, name, variables_by_name)
    return tuple(variables_by_name[name] for name in sorted(variables_by_name, key=_natural_order))


def _natural_order(name: str) -> tuple[str, int, str]:
    """Return the sort key of a name: ``pallet2`` precedes ``pallet10``."""
    head = name.partition(".")[0]
    digits = re.search(r"\d*$", head)
    number = digits[0] if digits else ""
    return head[: len(head) - len(number)], int(number or 0), name


def _add_variable(
    context: Context, type_: Element, name: str, variables_by_name: dict[str, MachineVariable]
) -> None:
    """Add a variable by its dotted name, with its elements and described features."""
    feature: Element | None = None
    owner: Element | None = type_
    for part in name.split("."):
        feature = None if owner is None else find_member(context, owner, part)
        owner = None if feature is None else query.type_of(context.graph, feature)
    if feature is None or name in variables_by_name:
        return
    elements = _list_elements(context, type_, feature)
    variables_by_name[name] = _build_variable(context, feature, name, elements)
    for element in elements:
        _add_variable(context, type_, element, variables_by_name)
    if owner is not None and owner.attrs.get("property_specific"):
        for part_feature in query.features(context.graph, owner):
            if part_feature.kind is Kind.PROPERTY and _has_data(context, part_feature):
                _add_variable(context, type_, f"{name}.{part_feature.name}", variables_by_name)


def _list_elements(context: Context, type_: Element, feature: Element) -> tuple[str, ...]:
    """Return the names of the features that a list consists of (``= (pallet1, pallet2)``)."""
    text = feature.attrs.get("default")
    if not isinstance(text, str) or "default_language" not in feature.attrs:
        return ()
    names = [element_name.strip() for element_name in text.strip("() ").split(",")]
    features = [
        element_name
        for element_name in names
        if _NAME.fullmatch(element_name) and find_member(context, type_, element_name)
    ]
    return tuple(features) if len(features) == len(names) else ()


def _has_data(context: Context, feature: Element) -> bool:
    return literal_default(feature) is not None or bool(find_opcua_node(context, feature))


def _build_variable(
    context: Context, feature: Element, name: str, elements: tuple[str, ...]
) -> MachineVariable:
    node = find_opcua_node(context, feature)
    return MachineVariable(
        name, value_type(context, feature), literal_default(feature), node, elements
    )
