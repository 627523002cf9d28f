"""What machines show and are told: the variables that the expressions of a recipe speak of."""

import re
from collections.abc import Iterable, Iterator

from msgspec.structs import replace

from sysmlc.ir import Element, Kind, query
from sysmlc.passes.recipe.context import Context
from sysmlc.passes.recipe.features import member, value, value_type
from sysmlc.passes.recipe.machines import opcua_node
from sysmlc.recipe.checks import iter_graphs
from sysmlc.recipe.expression import Expr, iter_variables
from sysmlc.recipe.model import (
    MachineVariable,
    Model,
    Parameter,
    Recipe,
    ReferenceType,
)

_NAME = re.compile(r"[^\W\d]\w*")


def with_variables(context: Context, model: Model) -> Model:
    """The model with the variables of its machines that its expressions name."""
    spoken: dict[str, set[str]] = {}
    for parameters, expressions in _scopes(model):
        machines = dict(_machines(parameters))
        for name in (name for one in expressions for name in iter_variables(one)):
            head, _, rest = name.partition(".")
            if rest and head in machines:
                spoken.setdefault(machines[head], set()).add(rest)
    machines_of_model = tuple(
        replace(one, variables=_variables(context, one.element, sorted(spoken.get(one.id, ()))))
        for one in model.machines
    )
    return replace(model, machines=machines_of_model)


def _machines(parameters: Iterable[Parameter]) -> Iterator[tuple[str, str]]:
    """Names of parameters that stand for machines, with the machine."""
    for one in parameters:
        if isinstance(one.type, ReferenceType) and one.type.to == "machine":
            yield one.name, one.type.name


def _scopes(model: Model) -> Iterator[tuple[tuple[Parameter, ...], list[Expr]]]:
    """Each place with names of its own: what is declared there, and its expressions."""
    recipe: Recipe = model.recipe
    bound = [value for task in recipe.tasks for _, value in task.bind]
    yield (*recipe.inputs, *recipe.variables), bound
    for graph in iter_graphs(model):
        found = [value for node in graph.nodes for _, value in node.bind]
        found += [node.expression for node in graph.nodes if node.expression is not None]
        found += [edge.guard for edge in graph.edges if edge.guard is not None]
        yield (*graph.inputs, *graph.variables), found


def _variables(context: Context, machine: str, names: Iterable[str]) -> tuple[MachineVariable, ...]:
    element = context.graph.get(machine)
    found: dict[str, MachineVariable] = {}
    if element is not None:
        type_ = query.type_of(context.graph, element) or element
        for name in names:
            _add(context, type_, name, found)
    return tuple(found[name] for name in sorted(found, key=_in_order))


def _in_order(name: str) -> tuple[str, int, str]:
    """``pallet2`` comes before ``pallet10``."""
    head = name.partition(".")[0]
    digits = re.search(r"\d*$", head)
    number = digits[0] if digits else ""
    return head[: len(head) - len(number)], int(number or 0), name


def _add(context: Context, type_: Element, name: str, found: dict[str, MachineVariable]) -> None:
    """A variable by its dotted name, with what it consists of."""
    at: Element | None = None
    owner: Element | None = type_
    for part in name.split("."):
        at = None if owner is None else member(context, owner, part)
        owner = None if at is None else query.type_of(context.graph, at)
    if at is None or name in found:
        return
    elements = _elements(context, type_, at)
    found[name] = _variable(context, at, name, elements)
    for one in elements:
        _add(context, type_, one, found)
    if owner is not None and owner.attrs.get("property_specific"):
        for feature in query.features(context.graph, owner):
            if feature.kind is Kind.PROPERTY and _says_something(context, feature):
                _add(context, type_, f"{name}.{feature.name}", found)


def _elements(context: Context, type_: Element, feature: Element) -> tuple[str, ...]:
    """Names of the features that a list is made of (``= (pallet1, pallet2)``)."""
    text = feature.attrs.get("default")
    if not isinstance(text, str) or "default_language" not in feature.attrs:
        return ()
    names = [one.strip() for one in text.strip("() ").split(",")]
    known = [one for one in names if _NAME.fullmatch(one) and member(context, type_, one)]
    return tuple(known) if len(known) == len(names) else ()


def _says_something(context: Context, feature: Element) -> bool:
    return value(feature) is not None or bool(opcua_node(context, feature))


def _variable(
    context: Context, feature: Element, name: str, elements: tuple[str, ...]
) -> MachineVariable:
    node = opcua_node(context, feature)
    return MachineVariable(name, value_type(context, feature), value(feature), node, elements)
