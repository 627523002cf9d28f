"""Controllers as JSON values and back, for the cache: a formula is a list of its parts."""

from collections.abc import Mapping, Sequence
from typing import Any

from sysmlc.logic.contract import Variable
from sysmlc.logic.formula import Apply, Const, Formula, Op, Var
from sysmlc.synthesis.controllers.closed import Controller
from sysmlc.synthesis.controllers.mealy import Machine, Move
from sysmlc.synthesis.controllers.table import Bit, Entry, Table

Form = Mapping[str, Any]


def form_of(made: Controller) -> Form:
    """A controller as JSON; variables by their names."""
    names = {"inputs": _names(made.inputs), "outputs": _names(made.outputs)}
    if isinstance(made, Machine):
        states = [[_form_of_move(one) for one in moves] for moves in made.states]
        return names | {"registers": _names(made.registers), "states": states}
    return names | {
        "bits": [[one.variable, one.place, one.is_before] for one in made.bits],
        "nodes": made.nodes,
        "entries": [[one.outputs, one.onward] for one in (made.first, *made.modes)],
    }


def controller_of(form: Form, variables: Sequence[Variable]) -> Controller:
    """The controller over variables of its contract. Raises LookupError, ValueError, TypeError."""
    known = {one.name: one for one in variables}
    inputs, outputs = (tuple(known[one] for one in form[side]) for side in ("inputs", "outputs"))
    if "states" in form:
        registers = tuple(known[one] for one in form["registers"])
        states = tuple(tuple(map(_move_of, moves)) for moves in form["states"])
        return Machine(inputs, outputs, registers, states)
    first, *modes = (Entry(tuple(done), tuple(onward)) for done, onward in form["entries"])
    nodes = tuple((bit, low, high) for bit, low, high in form["nodes"])
    bits = tuple(Bit(*one) for one in form["bits"])
    return Table(inputs, outputs, bits, nodes, first, tuple(modes))


def _names(variables: Sequence[Variable]) -> list[str]:
    return [one.name for one in variables]


def _form_of_move(move: Move) -> list[Any]:
    return [_listed(move.when), [_listed(one) for one in move.output], move.state]


def _move_of(form: Sequence[Any]) -> Move:
    when, output, state = form
    return Move(_formula(when), tuple(map(_formula, output)), state)


def _listed(formula: Formula) -> Any:  # noqa: ANN401 - JSON
    match formula:
        case Const(value):
            return [value]
        case Var(name, is_primed):
            return ["'" if is_primed else "", name]
        case Apply(op, args):
            return [op.value, *map(_listed, args)]


def _formula(form: Any) -> Formula:  # noqa: ANN401 - JSON
    match form:
        case [value]:
            return Const(value)
        case ["'" | "" as prime, str(name)]:
            return Var(name, bool(prime))
        case [op, *args]:
            return Apply(Op(op), tuple(map(_formula, args)))
        case _:
            raise ValueError(form)
