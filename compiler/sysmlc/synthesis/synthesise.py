"""From a contract to a machine that is known to keep it."""

from sysmlc.diagnostics import Sink
from sysmlc.logic.contract import Contract
from sysmlc.logic.printing import print_formula
from sysmlc.logic.reduction.reduce import reduced
from sysmlc.synthesis import rules
from sysmlc.synthesis.decide import Options, Place, Verdict, decide
from sysmlc.synthesis.game import make_game
from sysmlc.synthesis.manager import LimitError, Manager
from sysmlc.synthesis.mealy import Machine, explored
from sysmlc.synthesis.minimise import minimised
from sysmlc.synthesis.solve import solve
from sysmlc.synthesis.strategy import Controller
from sysmlc.synthesis.verify import Fault, faults
from sysmlc.values import dataclass


@dataclass(frozen=True, slots=True)
class Synthesis:
    """A verdict, and the machine when there is one that passes the check."""

    verdict: Verdict
    contract: Contract
    machine: Machine | None = None

    @property
    def exit_code(self) -> int:
        """0 with a machine, 1 unrealizable, 2 not decided or no machine."""
        return self.verdict.exit_code or 2 * (self.machine is None)

    def text(self) -> str:
        """The verdict on one line, with figures of the machine behind it."""
        if self.machine is None:
            return self.verdict.text()
        size, moves = self.machine.size, sum(map(len, self.machine.moves))
        states = "1 state" if size == 1 else f"{size:,} states"
        return f"{self.verdict.text()}; machine: {states}, {moves:,} moves, checked"


def synthesised(contract: Contract, place: Place, sink: Sink, options: Options) -> Synthesis:
    """Decide a contract, and make a machine that keeps it; what fails is reported."""
    verdict = decide(contract, place, sink, options)
    if not verdict.is_realizable:
        return Synthesis(verdict, contract)
    try:
        found = _checked(contract, options)
    except LimitError as problem:
        found = str(problem)
    if isinstance(found, Machine):
        return Synthesis(verdict, contract, found)
    component = contract.component
    sink.report(rules.NO_MACHINE, place(contract.origin), component=component, why=found)
    return Synthesis(verdict, contract)


def _checked(contract: Contract, options: Options) -> Machine | str:
    """A machine that keeps the contract, or why the one that was made is none."""
    made = reduced(contract).contract
    game = make_game(made, _manager(options))
    solution = solve(game)
    with game.manager.guard():
        machine = minimised(explored(Controller(solution)))
    fault = next(faults(machine, made, _manager(options)), None)
    return _said(fault) if fault else machine


def _manager(options: Options) -> Manager:
    return Manager(options.engine, options.limits, options.progress)


def _said(fault: Fault) -> str:
    if fault.conjunct is None:
        return "the one that was made has no answer to inputs that are allowed"
    formula = print_formula(fault.conjunct.formula)
    return f"the one that was made does not keep '{formula}'"
