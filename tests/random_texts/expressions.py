"""Random expressions of a given type over given variables."""

import re
from collections.abc import Sequence
from typing import NamedTuple

from random_texts.drafts import SCALARS, Definition, Draft, Feature

QUANTITIES = {
    "MassValue": ("kg", "g"),
    "LengthValue": ("m", "mm"),
    "DurationValue": ("s", "min", "h"),
    "SpeedValue": ("m/s", "km/h"),
    "ForceValue": ("N", "kg*m/s^2"),
    "PowerValue": ("W",),
    "ThermodynamicTemperatureValue": ("K",),
    "ElectricCurrentValue": ("A",),
}
"""Quantities of the library with units."""
Type = str | Definition


class Variable(NamedTuple):
    """A feature that an expression may read: its text, and its type."""

    text: str
    type: Type


Variables = Sequence[Variable]


def draw_type(draft: Draft) -> Type:
    """Return a type of attributes: a scalar, a quantity or an enumeration."""
    enumeration = draft.find("enum def")
    if enumeration is not None and draft.is_drawn(0.3):
        return enumeration
    return draft.choose([*SCALARS, *SCALARS, *QUANTITIES])


def refer_type(draft: Draft, type_: Type) -> str:
    """Return a reference to a type."""
    if isinstance(type_, Definition):
        return draft.refer(type_)
    return draft.refer_library("ISQ" if type_ in QUANTITIES else "ScalarValues", type_)


def list_variables(features: Sequence[Feature], prefix: str = "") -> list[Variable]:
    """Return the attributes with a single value, those of parts with a single value included."""
    variables = []
    for feature in features:
        if feature.is_many:
            continue
        name = prefix + feature.name
        if feature.kind == "attribute":
            variables.append(Variable(name, feature.type))
        elif isinstance(feature.type, Definition) and not prefix and feature.kind != "port":
            variables += list_variables(feature.type.features, f"{name}.")
    return variables


def list_globals(draft: Draft) -> list[Variable]:
    """Return the attributes of packages that can be referred to."""
    usage = draft.find("attribute usage")
    return [] if usage is None else [Variable(draft.refer(usage), usage.type)]


def draw_expression(draft: Draft, type_: Type, variables: Variables = (), depth: int = 2) -> str:
    """Return an expression whose result has this type."""
    fitting = [
        variable.text for variable in variables if variable.type is type_ or variable.type == type_
    ]
    if fitting and draft.is_drawn(0.5):
        return draft.choose(fitting)
    if isinstance(type_, Definition):
        value = draft.choose(type_.features).name
        return f"{draft.refer(type_)}::{value}"
    if depth and draft.is_drawn(0.15):
        test = draw_expression(draft, "Boolean", variables, 0)
        values = [draw_expression(draft, type_, variables, depth - 1) for _ in range(2)]
        return f"(if {test} ? {values[0]} else {values[1]})"
    if depth and draft.is_drawn(0.2):
        call = _draw_call(draft, type_, variables)
        if call:
            return call
    return _DRAWERS[type_ if type_ in _DRAWERS else "quantity"](draft, type_, variables, depth)


def _draw_call(draft: Draft, type_: str, variables: Variables) -> str:
    """Return a call of a calculation with this result, or nothing if there is none."""
    calculation = draft.find("calc def", lambda definition: definition.type == type_)
    if calculation is None:
        return ""
    inputs = calculation.list_features("attribute")
    values = [draw_expression(draft, feature.type, variables, 0) for feature in inputs]
    if draft.is_drawn(0.4):
        pairs = [f"{feature.name} = {value}" for feature, value in zip(inputs, values, strict=True)]
        draft.random.shuffle(pairs)
        return f"{draft.refer(calculation)}({', '.join(pairs)})"
    return f"{draft.refer(calculation)}({', '.join(values)})"


def _draw_integer(draft: Draft, type_: str, variables: Variables, depth: int) -> str:
    if not depth:
        return str(draft.random.randint(0, 20))
    left, right = (draw_expression(draft, type_, variables, depth - 1) for _ in range(2))
    forms = [f"({left} + {right})", f"({left} * {right})", left, f"(1, {left}, 3)#(2)"]
    if type_ == "Integer":
        forms += [f"({left} - {right})", f"-{left}", f"NumericalFunctions::max({left}, {right})"]
    return draft.choose(forms)


def _draw_real(draft: Draft, type_: str, variables: Variables, depth: int) -> str:
    literal = draft.choose(["1.5", "0.25", "2.0", "3.5e2", "1E-3", "4.0", ".5", "7"])
    if not depth:
        return literal
    left, right = (draw_expression(draft, type_, variables, depth - 1) for _ in range(2))
    return draft.choose([f"({left} {sign} {right})" for sign in ("+", "-", "*")] + [literal] * 3)


def _draw_boolean(draft: Draft, type_: str, variables: Variables, depth: int) -> str:
    if not depth:
        return draft.choose(["true", "false"])
    if draft.is_drawn(0.5):
        of = draft.choose(["Integer", "Real", *[v.type for v in variables]])
        left, right = (draw_expression(draft, of, variables, 1) for _ in range(2))
        signs = ["==", "!="]
        if not isinstance(of, Definition) and of not in ("Boolean", "String"):
            signs += ["<", "<=", ">", ">="]
        return f"({left} {draft.choose(signs)} {right})"
    left, right = (draw_expression(draft, "Boolean", variables, depth - 1) for _ in range(2))
    signs = ("and", "or", "xor", "implies", "&", "|")
    return draft.choose([f"({left} {sign} {right})" for sign in signs] + [f"not {left}"])


def _draw_string(draft: Draft, type_: str, variables: Variables, depth: int) -> str:
    literal = draft.choose(
        ['"text"', '""', '"a \\"quoted\\" word"', '"line\\nbreak"', '"é // no /* note"']
    )
    return literal if not depth or draft.is_drawn(0.7) else f'({literal} + "more")'


def _draw_quantity(draft: Draft, type_: str, variables: Variables, depth: int) -> str:
    unit = draft.choose(QUANTITIES[type_])
    if "SI" not in draft.package.libraries:
        unit = re.sub(r"[a-zA-Z]+", r"SI::\g<0>", unit)
    number = draft.choose(["1", "2.5", "10", "0.5", "3e2"])
    value = f"{number} [{unit}]"
    if depth and draft.is_drawn(0.3):
        right = draw_expression(draft, type_, variables, depth - 1)
        return draft.choose([f"({value} + {right})", f"({value} - {right})", f"2 * {value}"])
    return value


_DRAWERS = {
    "Integer": _draw_integer,
    "Natural": _draw_integer,
    "Real": _draw_real,
    "Boolean": _draw_boolean,
    "String": _draw_string,
    "quantity": _draw_quantity,
}
