"""Controllers as gr1c writes its strategies in JSON (version 1, its manual's "strategy in JSON").

A node is a step: the values of all variables, with the nodes that the next inputs lead to.
Booleans are 0 and 1, numbers and literals count from 0. What gr1c notes of its own run (its
version, the date) is empty, so that the same contract gives the same text.
"""

from collections.abc import Iterator, Mapping, Sequence

from sysmlc.logic import domains
from sysmlc.logic.contract import BooleanDomain, Class, Conjunct, Contract, Variable
from sysmlc.logic.evaluate import Evaluation, evaluation
from sysmlc.logic.formula import Literal
from sysmlc.support.json_text import append_members, encode_row
from sysmlc.synthesis.bdd.limits import LimitError
from sysmlc.synthesis.controllers.closed import Controller

VERSION = 1
MOST_STEPS = 50_000
"""Steps that are tried; each next input of each node is one."""

Values = Mapping[str, Literal]


def json_of(controller: Controller, contract: Contract, most: int = MOST_STEPS) -> str:
    """The controller as JSON text, a line a node.

    Raises LimitError when more than ``most`` steps would have to be tried.
    """
    head = {
        "version": VERSION,
        "gr1c": "",
        "date": "",
        "extra": f"sysmlc: {contract.component}",
        "ENV": [_declared(one) for one in controller.inputs],
        "SYS": [_declared(one) for one in controller.outputs],
    }
    nodes = ",\n".join(_Unrolling(controller, contract, most).lines())
    return append_members(head, [f'  "nodes": {{\n{nodes}\n  }}'])


def _declared(variable: Variable) -> dict[str, object]:
    if isinstance(variable.domain, BooleanDomain):
        return {variable.name: "boolean"}
    return {variable.name: [0, domains.size(variable.domain) - 1]}


class _Unrolling:
    """The steps of a controller in all environments that keep the assumptions."""

    def __init__(self, controller: Controller, contract: Contract, most: int) -> None:
        self._controller, self._most, self._left = controller, most, most
        self._first = _rules(contract.assumptions, Class.INIT)
        self._later = _rules(contract.assumptions, Class.SAFETY)
        known = {one.name: one.domain for one in controller.inputs}
        if domains.count(known) > most:
            raise LimitError("steps of the strategy", f"{most:,}")
        self._inputs = list(domains.valuations(known))
        self._places: dict[tuple[tuple[Literal, ...], int], int] = {}
        self._found: list[tuple[dict[str, Literal], int]] = []

    def lines(self) -> Iterator[str]:
        """The nodes, those that are found first first."""
        first = set(self._after({}, 0, self._first))
        for place, (values, state) in enumerate(self._found):
            after = self._after(values, state, self._later)
            yield self._line(place, values, state, place in first, list(after))

    def _after(self, values: Values, state: int, rules: Sequence[Evaluation]) -> Iterator[int]:
        """The nodes that the inputs lead to that are allowed after a step."""
        for given in self._inputs:
            self._left -= 1
            if self._left < 0:
                raise LimitError("steps of the strategy", f"{self._most:,}")
            now, then = (values, given) if values else (given, None)
            if all(rule(now, then) for rule in rules):
                yield self._place(values, state, given)

    def _place(self, values: Values, state: int, given: Values) -> int:
        outputs, after = self._controller.step(state, values, given)
        step = dict(given) | outputs
        key = tuple(step.values()), after
        if key not in self._places:
            self._places[key] = len(self._found)
            self._found.append((step, after))
        return self._places[key]

    def _line(
        self, place: int, values: Values, state: int, is_first: bool, after: list[int]
    ) -> str:
        variables = (*self._controller.inputs, *self._controller.outputs)
        node = {
            "state": [_code(variable, values[variable.name]) for variable in variables],
            "mode": state,
            "rgrad": -1,
            "initial": is_first,
            "trans": [str(successor) for successor in after],
        }
        return f'    "{place}": {encode_row(node)}'


def _rules(conjuncts: Sequence[Conjunct], class_: Class) -> list[Evaluation]:
    return [evaluation(one.formula) for one in conjuncts if one.class_ is class_]


def _code(variable: Variable, value: Literal) -> int:
    return domains.values(variable.domain).index(value)
