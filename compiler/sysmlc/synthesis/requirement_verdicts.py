"""Verdicts about requirements: each conjunct of a requirement is one question to a behaviour.

The runs of the behaviour that satisfy the author's assumptions either all satisfy the conjunct, or
they do if each action ends, or a run violates it. The assumptions that actions end and loops are
left are derived by the compiler: they may prove a requirement, and never refute one.
"""

from collections.abc import Iterable, Iterator
from enum import StrEnum

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.logic import formula as f
from sysmlc.logic.contract import Class, Conjunct, Contract, Owner, Variable
from sysmlc.logic.formula import Apply, Formula, Op
from sysmlc.logic.reduction.contract_reduction import as_ltl, is_gr1
from sysmlc.logic.reduction.formula_reduction import NotReducibleError
from sysmlc.logic.requirements.checked_behaviours import CheckedBehaviour
from sysmlc.synthesis.algebra.fair_systems import DomainError, Trace, Universe
from sysmlc.synthesis.algebra.refinement import Entailment
from sysmlc.synthesis.algebra.tableau import build_tableau
from sysmlc.synthesis.bdd.limits import LimitError
from sysmlc.synthesis.decision import Options
from sysmlc.synthesis.games.game import OutsideGr1Error
from sysmlc.synthesis.witnesses import describe_problem, manager_factory


class Answer(StrEnum):
    """The answer to the question whether a behaviour satisfies a conjunct."""

    HOLDS = "holds"
    HOLDS_IF_ACTIONS_END = "holds-if-actions-end"
    BROKEN = "broken"
    NOT_DECIDED = "not-decided"


class RequirementVerdict(Struct, frozen=True):
    """The answer for one conjunct, with its reason, and the run that violates a broken one."""

    conjunct: Conjunct
    answer: Answer
    reason: str = ""
    trace: Trace | None = None


_UNDECIDED_PROBLEMS = (OutsideGr1Error, DomainError, LimitError, NotReducibleError)


def decide_requirements(
    behaviour: CheckedBehaviour,
    requirements: Contract,
    undischarged: Iterable[Conjunct],
    options: Options,
) -> Iterator[RequirementVerdict]:
    """Yield the verdict about each conjunct that the author requires.

    *undischarged* are the assumptions that the author wrote on the behaviour and that the
    requirements do not entail: the author's guarantees of the behaviour then prove nothing.
    """
    check = _Check(behaviour, requirements, tuple(undischarged), options)
    for conjunct in requirements.guarantees:
        if not conjunct.is_derived:
            try:
                yield check.decide(conjunct)
            except _UNDECIDED_PROBLEMS as problem:
                yield RequirementVerdict(conjunct, Answer.NOT_DECIDED, describe_problem(problem))


class _Check:
    """The facts that hold in all runs, for proofs and for refutations."""

    def __init__(
        self,
        behaviour: CheckedBehaviour,
        requirements: Contract,
        undischarged: tuple[Conjunct, ...],
        options: Options,
    ) -> None:
        self._behaviour = behaviour
        self._requirements = requirements
        self._options = options
        contract = behaviour.contract
        assumed = tuple(
            conjunct
            for conjunct in requirements.assumptions
            if not (conjunct.is_derived and _names_of((conjunct,)) & behaviour.gaps.keys())
        )
        definitions = tuple(conjunct for conjunct in requirements.guarantees if conjunct.is_derived)
        stated = tuple(conjunct for conjunct in contract.guarantees if not conjunct.is_derived)
        self._facts = (*assumed, *definitions, *(() if undischarged else stated))
        self._unproven = (*undischarged, *stated) if undischarged else ()
        self._endings = tuple(conjunct for conjunct in contract.assumptions if conjunct.is_derived)
        variables = (*contract.variables, *requirements.variables)
        self._variable_names = tuple(dict.fromkeys(variable.name for variable in variables))
        self._entailments: dict[tuple[Conjunct, ...], Entailment] = {}

    def decide(self, conjunct: Conjunct) -> RequirementVerdict:
        """Return the verdict about a conjunct."""
        proofs = self._list_proof_readings()
        if not all(self._has_runs(reading) for reading in proofs):
            reason = "no run of the behaviour satisfies the assumptions of the requirement"
            return RequirementVerdict(conjunct, Answer.NOT_DECIDED, reason)
        if self._entails(proofs, (), conjunct):
            return RequirementVerdict(conjunct, Answer.HOLDS)
        endings = () if is_safety(as_ltl(conjunct)) else self._endings
        if endings and self._entails(proofs, endings, conjunct):
            needed = self._minimise(proofs, endings, conjunct)
            reason = " ".join(ending.text for ending in needed)
            return RequirementVerdict(conjunct, Answer.HOLDS_IF_ACTIONS_END, reason)
        return self._refute(conjunct, endings)

    def _list_proof_readings(self) -> list[Contract]:
        """List the descriptions of the behaviour in all of which a conjunct has to hold."""
        behaviour = self._behaviour
        if behaviour.is_called and behaviour.repeated is not None:
            return [behaviour.contract, behaviour.repeated]
        return [behaviour.contract]

    def _minimise(
        self, readings: list[Contract], endings: tuple[Conjunct, ...], conjunct: Conjunct
    ) -> tuple[Conjunct, ...]:
        """Return a smallest subset of the derived assumptions that still proves the conjunct."""
        needed = endings
        for ending in endings:
            rest = tuple(candidate for candidate in needed if candidate != ending)
            if self._entails(readings, rest, conjunct):
                needed = rest
        return needed

    # -- refutation ------------------------------------------------------------------------------

    def _refute(self, conjunct: Conjunct, endings: tuple[Conjunct, ...]) -> RequirementVerdict:
        gap = self._find_gap(conjunct)
        waits: tuple[Conjunct, ...] = ()
        if gap is not None:
            if gap not in self._behaviour.ends or not is_safety(as_ltl(conjunct)):
                return RequirementVerdict(conjunct, Answer.NOT_DECIDED, self._explain_gap(gap))
            # A prefix of a run in which no such action has ended yet is a prefix of the model.
            waits = tuple(
                Conjunct(f.negate(f.var(name)), Class.SAFETY, "")
                for name in sorted(self._behaviour.gaps)
            )
        facts = (*self._unproven, *endings, *waits)
        trace = self._find_violation(self._behaviour.contract, facts, conjunct)
        if trace is None:
            reason = self._explain_gap(gap) if gap else self._explain_unproven()
            return RequirementVerdict(conjunct, Answer.NOT_DECIDED, reason)
        repeated = self._behaviour.repeated
        if repeated and self._find_violation(repeated, facts, conjunct) is None:
            reason = "it depends on whether the activity starts again after its end"
            return RequirementVerdict(conjunct, Answer.NOT_DECIDED, reason)
        return RequirementVerdict(conjunct, Answer.BROKEN, trace=trace)

    def _find_gap(self, conjunct: Conjunct) -> str | None:
        """Return a variable that the model restricts more than the behaviour does, if any.

        Gaps other than the ends of actions come first, because these prevent any refutation.
        """
        own_names = {variable.name for variable in self._behaviour.contract.variables}
        free_names = {
            variable.name
            for variable in self._requirements.variables
            # Inputs are free in the model, too, and conjuncts define history bits.
            if variable.owner is Owner.ENVIRONMENT or self._is_history_bit(variable)
        }
        unknown = sorted(_names_of((conjunct,)) - own_names - free_names)
        gaps = self._behaviour.gaps
        features = [name for name in gaps if name not in self._behaviour.ends]
        return next(iter((*unknown, *features, *gaps)), None)

    def _is_history_bit(self, variable: Variable) -> bool:
        derived = (item for item in self._requirements.guarantees if item.is_derived)
        return variable.name in _names_of(derived)

    def _explain_gap(self, name: str) -> str:
        default = f"the behaviour does not determine '{name}'"
        return self._behaviour.gaps.get(name, default)

    def _explain_unproven(self) -> str:
        return "the behaviour assumes more than the requirement does"

    # -- runs ------------------------------------------------------------------------------------

    def _has_runs(self, reading: Contract) -> bool:
        runs = self._explore(reading, ())
        with runs.manager.guard():
            return runs.is_possible

    def _entails(
        self, readings: Iterable[Contract], endings: tuple[Conjunct, ...], conjunct: Conjunct
    ) -> bool:
        return all(self._find_violation(reading, endings, conjunct) is None for reading in readings)

    def _find_violation(
        self, reading: Contract, facts: tuple[Conjunct, ...], conjunct: Conjunct
    ) -> Trace | None:
        """Return a run of the behaviour with additional facts that violates the conjunct."""
        if is_gr1(conjunct):
            runs = self._explore(reading, facts)
            with runs.manager.guard():
                trace = runs.find_violation(conjunct)
        else:
            negation = Conjunct(f.negate(as_ltl(conjunct)), Class.OTHER, conjunct.origin)
            runs = self._explore(reading, (*facts, negation))
            with runs.manager.guard():
                trace = runs.find_example()
        return None if trace is None else self._show(trace)

    def _explore(self, reading: Contract, facts: tuple[Conjunct, ...]) -> Entailment:
        """Return the runs of a behaviour that satisfy the check's facts and further *facts*."""
        steps = tuple(
            conjunct
            for conjunct in reading.guarantees
            # That an activity goes on for ever follows from the assumption that actions end.
            if conjunct.is_derived and conjunct.class_ is not Class.LIVENESS
        )
        key = (*steps, *facts)
        if key not in self._entailments:
            variables, conjuncts = self._lower((*self._facts, *key))
            predictions = Contract("", "", variables, (), ())
            manager = manager_factory(self._options)()
            with manager.guard():
                universe = Universe((reading, self._requirements, predictions), manager)
                self._entailments[key] = Entailment(universe, universe.system(conjuncts))
        return self._entailments[key]

    def _lower(self, conjuncts: Iterable[Conjunct]) -> tuple[tuple[Variable, ...], list[Conjunct]]:
        """Return the conjuncts with tableaux in place of general LTL, and their variables."""
        names = self._variable_names
        variables: list[Variable] = []
        lowered: list[Conjunct] = []
        for conjunct in conjuncts:
            if is_gr1(conjunct):
                lowered.append(conjunct)
                continue
            taken = (*names, *(variable.name for variable in variables))
            tableau = build_tableau(as_ltl(conjunct), taken)
            variables += tableau.variables
            lowered += (replace(conjunct, formula=tableau.formula, class_=Class.INIT),)
            lowered += tableau.conjuncts
        return tuple(variables), lowered

    def _show(self, trace: Trace) -> Trace:
        """Return the run without the variables that only the check uses."""
        steps = tuple(
            {name: value for name, value in values.items() if name in self._variable_names}
            for values in trace.steps
        )
        return replace(trace, steps=steps)


def _names_of(conjuncts: Iterable[Conjunct]) -> set[str]:
    return {variable.name for conjunct in conjuncts for variable in f.variables(conjunct.formula)}


def is_safety(formula: Formula, is_positive: bool = True) -> bool:
    """Whether each violation of the formula has a finite prefix, judged by its operators alone."""
    if not isinstance(formula, Apply):
        return True
    if formula.op in (_EVENTUAL_OPERATORS if is_positive else _PERPETUAL_OPERATORS):
        return False
    args = formula.args
    if formula.op is Op.IFF:
        return all(is_safety(arg, sign) for arg in args for sign in (True, False))
    negated = args[:1] if formula.op in (Op.NOT, Op.IMPLIES) else ()
    return all(is_safety(arg, not is_positive) for arg in negated) and all(
        is_safety(arg, is_positive) for arg in args[len(negated) :]
    )


_EVENTUAL_OPERATORS = (Op.EVENTUALLY, Op.UNTIL)
_PERPETUAL_OPERATORS = (Op.ALWAYS, Op.RELEASE, Op.WEAK_UNTIL)
