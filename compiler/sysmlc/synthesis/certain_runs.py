"""Runs of a behaviour that are runs of the model, too.

A condition without formula is a free input, and a value stops at the bound of an assumed range. A
run is certain if its steps are possible whatever the values of such conditions are, and if no value
is stopped.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.logic import domains
from sysmlc.logic import formula as f
from sysmlc.logic.basis import find_cone
from sysmlc.logic.components.derivation import ComponentBehaviour
from sysmlc.logic.contract import (
    BooleanDomain,
    Class,
    Conjunct,
    Contract,
    Domain,
    IntegerDomain,
    Owner,
    Source,
    Variable,
    equals,
)
from sysmlc.logic.formula import Apply, Const, Formula, Op, Var
from sysmlc.logic.simplification import substitute
from sysmlc.synthesis.algebra.fair_systems import Trace

_MAX_CONDITIONS = 6
"""Conditions in one conjunct up to which all their values are examined: there are 2^6."""
_VIOLATED = Variable("is violated", Owner.SYSTEM, BooleanDomain(), is_auxiliary=True)
"""Whether an earlier step violates the conjunct that a run is about."""
AUXILIARY = Contract("", "", (_VIOLATED,), (), ())
"""The variables that ``CertainRuns`` adds to those of a behaviour."""


class CertainRuns(Struct, frozen=True):
    """The restriction of runs to those that are certain.

    ``conditions`` are the inputs for conditions without formula, each with the Booleans that
    remember it. ``clamps`` are variables with assumed ranges, and when a value of each is stopped.
    """

    conditions: tuple[tuple[str, ...], ...] = ()
    clamps: tuple[tuple[str, Formula], ...] = ()
    domains: Mapping[str, Domain] = {}
    """The values of the inputs; a Boolean that remembers one is not listed."""

    @property
    def doubts(self) -> tuple[str, ...]:
        """The variables because of which runs are not certain."""
        names = (
            *(condition[0] for condition in self.conditions),
            *(name for name, _ in self.clamps),
        )
        return tuple(dict.fromkeys(names))

    def ignore(self, name: str) -> "CertainRuns":
        """Return the restriction that ignores a variable."""
        return replace(
            self,
            conditions=tuple(item for item in self.conditions if item[0] != name),
            clamps=tuple(clamp for clamp in self.clamps if clamp[0] != name),
        )

    @property
    def _free(self) -> tuple[str, ...]:
        return tuple(name for condition in self.conditions for name in condition)

    def restrict(
        self, facts: Sequence[Conjunct], conjunct: Conjunct
    ) -> tuple[Conjunct, ...] | None:
        """Return facts of certain runs that violate a conjunct; None if they cannot be stated.

        Behind a step that violates a conjunct about single steps, any continuation will do: also
        from this step on, if the conjunct does not name the next one.
        """
        if not self.doubts:
            return ()
        is_about_steps = conjunct.class_ in (Class.INIT, Class.SAFETY)
        certain: list[Conjunct] = []
        is_violated: Formula = f.FALSE
        ends_here: Formula = f.FALSE
        if is_about_steps:
            is_violated = f.var(_VIOLATED.name)
            violation = f.either(is_violated, f.negate(conjunct.formula))
            certain.append(_state(f.negate(is_violated), Class.INIT))
            certain.append(_state(f.fold_iff(f.prime(is_violated), violation), Class.SAFETY))
            names_next = any(v.primed for v in f.variables(conjunct.formula))
            ends_here = is_violated if names_next else violation
        clamps = (f.either(is_violated, f.negate(clamp)) for _, clamp in self.clamps)
        certain += (_state(clamp, Class.SAFETY) for clamp in clamps)
        if self._names(conjunct):
            return None
        for fact in facts:
            names = self._names(fact)
            is_fairness = is_about_steps and fact.class_ is Class.LIVENESS
            is_memory = f.variable_names(fact.formula) <= {*self._free}
            if not names or is_fairness or is_memory:
                continue
            primed = {v.name for v in f.variables(fact.formula) if v.primed}
            if len(names) > _MAX_CONDITIONS or fact.class_ is Class.OTHER or primed & {*names}:
                return None
            formula = fact.formula
            for name in names:
                domain = self.domains.get(name, BooleanDomain())
                cases = (
                    substitute(formula, {name: Const(value)}) for value in domains.values(domain)
                )
                formula = f.both(*cases)
            guard = ends_here if primed else is_violated
            is_step = fact.class_ is Class.SAFETY
            certain.append(_state(f.either(guard, formula) if is_step else formula, fact.class_))
        return tuple(certain)

    def drop_values(self, trace: Trace) -> Trace:
        """Return a certain run without the values that do not matter."""
        hidden = {_VIOLATED.name, *self._free}
        steps = tuple(
            {name: value for name, value in values.items() if name not in hidden}
            for values in trace.steps
        )
        return replace(trace, steps=steps)

    def _names(self, conjunct: Conjunct) -> list[str]:
        named = f.variable_names(conjunct.formula)
        return [name for name in self._free if name in named]


def find_certain_runs(
    behaviour: ComponentBehaviour, requirements: Contract, about: Iterable[Conjunct]
) -> CertainRuns:
    """Return the restriction of runs that conjuncts are about."""
    contract = behaviour.contract
    variables = (*contract.variables, *requirements.variables)
    named = f.variable_names(*(conjunct.formula for conjunct in about))
    cone = find_cone(named, (contract, requirements), behaviour.list_reads())
    conditions = {v.name: v.domain for v in variables if v.condition and v.name in cone}
    return CertainRuns(
        tuple((name, *_iter_memories(contract, name)) for name in conditions),
        tuple(clamp for clamp in _iter_clamps(behaviour) if clamp[0] in cone),
        conditions,
    )


def _iter_clamps(behaviour: ComponentBehaviour) -> Iterator[tuple[str, Formula]]:
    if behaviour.clamps is not None:
        yield from behaviour.clamps
        return
    for variable in behaviour.contract.variables:
        domain = variable.domain
        is_assigned = variable.is_range_assumed and variable.owner is Owner.SYSTEM
        if is_assigned and isinstance(domain, IntegerDomain):
            bounds = (equals(variable, Const(bound)) for bound in (domain.low, domain.high))
            yield variable.name, f.either(*bounds)


def _iter_memories(contract: Contract, condition: str) -> Iterator[str]:
    """Yield the Booleans defined as the value of a condition, or its negation, one step ago."""
    values = f.var(condition), f.negate(f.var(condition))
    for conjunct in contract.guarantees:
        match conjunct.formula:
            case Apply(Op.IFF, (Var(memory, True), value)) if value in values:
                yield memory


def _state(formula: Formula, class_: Class) -> Conjunct:
    return Conjunct(formula, class_, "", source=Source.DERIVED)
