"""Lints of one contract: assumptions and guarantees that are impossible, vacuous or misplaced.

The text shows conjuncts on the wrong side of the contract. Games show vacuous wins, missing or
needless fairness, and assumptions that the component can force the environment to violate. Runs
show dead ends of the environment, and outputs without a frame condition.
"""

from collections.abc import Iterator

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.diagnostics import Rule, Sink
from sysmlc.logic import formula as f
from sysmlc.logic.basis import find_basis
from sysmlc.logic.contract import (
    Class,
    Conjunct,
    Contract,
    IntegerDomain,
    Owner,
    Variable,
    equals,
    select_classes,
)
from sysmlc.logic.domains import size, values
from sysmlc.logic.formula import Formula, Var, variable_names, variables
from sysmlc.logic.printing import print_literal
from sysmlc.logic.region_formulas import print_worded
from sysmlc.synthesis import rules
from sysmlc.synthesis.algebra.fair_systems import FairSystem, Runs
from sysmlc.synthesis.algebra.refinement import has_environment
from sysmlc.synthesis.bdd.manager import Manager, ManagerFactory, Node
from sysmlc.synthesis.decision import Place
from sysmlc.synthesis.games.arena import nodes_of
from sysmlc.synthesis.games.game import Game, make_game
from sysmlc.synthesis.games.relational_product import Product
from sysmlc.synthesis.games.solver import solve


class LintFinding(Struct, frozen=True):
    """A finding about a conjunct, or about the whole contract if there is no conjunct."""

    rule: Rule
    conjunct: Conjunct | None = None
    name: str = ""
    """Value of the placeholder ``name`` in the message of the rule."""
    detail: str = ""
    """Value of the placeholder ``detail`` in the message of the rule."""


_LEFT_OPEN = (rules.NO_FRAME, rules.IDLE)
"""Findings about what a contract leaves open, which a behaviour may decide."""


def lint(
    contract: Contract,
    place: Place,
    sink: Sink,
    create_manager: ManagerFactory,
    *,
    has_behaviour: bool = False,
) -> None:
    """Report suspicious properties of a contract; *create_manager* is called for each lint.

    *has_behaviour*: the contract states requirements on a component with a behaviour, which decides
    what they leave open. Raises OutsideGr1Error for a contract that GR(1) cannot express,
    LimitError.
    """
    within = find_basis((contract,)).reservation
    for finding in _find_all(contract, create_manager):
        if has_behaviour and finding.rule in _LEFT_OPEN:
            continue
        origin = contract.origin if finding.conjunct is None else finding.conjunct.origin
        conjunct = finding.conjunct
        formula = "" if conjunct is None else print_worded(conjunct.formula, contract.variables)
        sink.report(
            finding.rule,
            place(origin),
            component=contract.component,
            formula=formula,
            name=finding.name,
            detail=finding.detail,
            within=within,
        )


def _find_all(contract: Contract, create_manager: ManagerFactory) -> Iterator[LintFinding]:
    findings = list(_check_ownership(contract))
    yield from findings
    # A liveness conjunct about two steps is outside GR(1), so no game can be built.
    if any(finding.rule is rules.NEXT_IN_LIVENESS for finding in findings):
        return
    # Without any environment, every further lint would only show a consequence of that.
    if not has_environment(contract, create_manager()):
        yield LintFinding(rules.NO_ENVIRONMENT)
        return
    yield from _check_runs(contract, create_manager())
    yield from _check_games(contract, create_manager)


def _check_ownership(contract: Contract) -> Iterator[LintFinding]:
    """Yield findings about conjuncts that the wrong side decides, and about misplaced primes."""
    owners = {variable.name: variable.owner for variable in contract.variables}
    for conjunct in contract.assumptions:
        if _sole_owner(conjunct, owners) is Owner.SYSTEM:
            yield _find_wrong_owner(conjunct, "assumes", "the component")
    for conjunct in contract.guarantees:
        if _sole_owner(conjunct, owners) is Owner.ENVIRONMENT:
            yield _find_wrong_owner(conjunct, "promises", "the environment")
        elif conjunct.class_ is Class.INIT and Owner.ENVIRONMENT in map(
            owners.get, variable_names(conjunct.formula)
        ):
            yield LintFinding(rules.INITIAL_INPUT, conjunct)
    for conjunct in (*contract.assumptions, *contract.guarantees):
        if conjunct.class_ is Class.LIVENESS and _primed_names(conjunct.formula):
            yield LintFinding(rules.NEXT_IN_LIVENESS, conjunct)


def _find_wrong_owner(conjunct: Conjunct, verb: str, side: str) -> LintFinding:
    """Return the finding; in a conjunct about two steps, *side* decides the next values only."""
    relation = "whose next values" if _primed_names(conjunct.formula) else "which"
    return LintFinding(rules.WRONG_OWNER, conjunct, verb, f"{relation} {side}")


def _sole_owner(conjunct: Conjunct, owners: dict[str, Owner]) -> Owner | None:
    """Return the owner that alone decides whether the conjunct holds, or None.

    A conjunct about two steps is decided by the owner of the next values. A liveness conjunct has
    no sole owner, because the other side may bring it about through its assumptions and guarantees.
    """
    names = _primed_names(conjunct.formula) or variable_names(conjunct.formula)
    found_owners = {owners[name] for name in names if name in owners}
    is_immediate = conjunct.class_ in (Class.INIT, Class.SAFETY)
    return next(iter(found_owners)) if len(found_owners) == 1 and is_immediate else None


def _primed_names(formula: Formula) -> set[str]:
    return {variable.name for variable in variables(formula) if variable.primed}


# -- games and runs ----------------------------------------------------------------------------

_NOT_LIVENESS = (Class.INIT, Class.SAFETY, Class.OTHER)
_MAX_REMOVED_ASSUMPTIONS = 40
"""Assumptions up to which each of them is removed in turn to find the culprits."""


def _check_games(contract: Contract, create_manager: ManagerFactory) -> Iterator[LintFinding]:
    """Yield findings about the games of a contract and of variants of it."""
    assumed, guaranteed = (
        select_classes(side, Class.LIVENESS) for side in (contract.assumptions, contract.guarantees)
    )
    if not is_won(contract, create_manager):
        yield from _suggest_fairness(contract, create_manager)
    elif (assumed or guaranteed) and is_won(_with_idle_outputs(contract), create_manager):
        yield LintFinding(rules.IDLE)
    elif assumed and guaranteed:
        safety_assumptions = select_classes(contract.assumptions, *_NOT_LIVENESS)
        if is_won(replace(contract, assumptions=safety_assumptions), create_manager):
            yield LintFinding(rules.NEEDLESS)
    if is_forced(contract, create_manager):
        yield LintFinding(rules.NOT_SEPARATED, detail=_describe_culprits(contract, create_manager))


def is_won(contract: Contract, create_manager: ManagerFactory) -> bool:
    """Whether the contract is realizable."""
    return solve(make_game(contract, create_manager()), is_complete=False).is_realizable


def _with_idle_outputs(contract: Contract) -> Contract:
    """Return the contract with the additional guarantee that all outputs stay constant."""
    frames = (
        f.eq(Var(variable.name, primed=True), Var(variable.name))
        for variable in contract.variables
        if variable.owner is Owner.SYSTEM and not variable.is_auxiliary
    )
    frame_conjuncts = (Conjunct(frame, Class.SAFETY, contract.origin) for frame in frames)
    return replace(contract, guarantees=(*contract.guarantees, *frame_conjuncts))


def describe_vacuity(contract: Contract, create_manager: ManagerFactory) -> str:
    """Return why a realizable contract demands nothing of the component, or an empty text."""
    has_outputs = any(variable.owner is Owner.SYSTEM for variable in contract.variables)
    if not has_outputs or not contract.guarantees:
        return ""
    if is_won(_with_impossible_goal(contract), create_manager):
        return "the controller can make the environment violate its assumptions"
    if is_won(_with_idle_outputs(contract), create_manager):
        return "the controller needs to do nothing, since its outputs may stay as they are"
    return ""


# -- fairness ----------------------------------------------------------------------------------


def _suggest_fairness(contract: Contract, create_manager: ManagerFactory) -> Iterator[LintFinding]:
    """Yield a finding with a liveness assumption that makes an unrealizable contract realizable."""
    # Fairness helps only if the safety guarantees alone are realizable.
    safety_guarantees = select_classes(contract.guarantees, *_NOT_LIVENESS)
    if len(safety_guarantees) == len(contract.guarantees) or not is_won(
        replace(contract, guarantees=safety_guarantees), create_manager
    ):
        return
    conditions = (
        equals(variable, f.const(value))
        for variable in contract.variables
        if variable.owner is Owner.ENVIRONMENT and not isinstance(variable.domain, IntegerDomain)
        for value in sorted(values(variable.domain), key=lambda value: value is False)
    )
    for condition in conditions:
        assumption = Conjunct(condition, Class.LIVENESS, contract.origin)
        extended_contract = replace(contract, assumptions=(*contract.assumptions, assumption))
        if is_won(extended_contract, create_manager) and not is_forced(
            extended_contract, create_manager
        ):
            shown = print_worded(condition, contract.variables)
            text = f", for instance if '{shown}' recurred"
            yield LintFinding(rules.NO_FAIRNESS, detail=text)
            return


# -- separation --------------------------------------------------------------------------------


def is_forced(contract: Contract, create_manager: ManagerFactory) -> bool:
    """Whether the component can force the environment to violate its assumptions.

    That is: from some reachable state it can do so while it satisfies its own safety guarantees
    (well-separation: Klein and Pnueli 2010, Maoz and Ringert 2016).
    """
    game = make_game(_with_impossible_goal(contract), create_manager())
    reachable = Runs(_system_of_game(game)).reachable
    return reachable & solve(game).winning != game.manager.false


def _with_impossible_goal(contract: Contract) -> Contract:
    """Return a contract that is won only if the environment violates an assumption.

    In the literature the component may violate its safety guarantees, too. Here it may not, since a
    component that wins its contract may not either.
    """
    impossible_goal = Conjunct(f.FALSE, Class.LIVENESS, contract.origin)
    safety_guarantees = select_classes(contract.guarantees, *_NOT_LIVENESS)
    return replace(contract, guarantees=(*safety_guarantees, impossible_goal))


def _describe_culprits(contract: Contract, create_manager: ManagerFactory) -> str:
    """Return a text with the assumptions whose removal makes the contract well-separated."""
    if len(contract.assumptions) > _MAX_REMOVED_ASSUMPTIONS:
        return ""
    culprits = [
        assumption
        for assumption in contract.assumptions
        if not is_forced(
            replace(
                contract,
                assumptions=tuple(item for item in contract.assumptions if item is not assumption),
            ),
            create_manager,
        )
    ]
    formulas = (print_worded(culprit.formula, contract.variables) for culprit in culprits)
    texts = ", ".join(f"'{formula}'" for formula in formulas)
    return f"; not without {texts}" if texts else ""


_MIN_QUANTITY_VALUES = 3
"""Least number of values of an integer that counts as a quantity; quantities should not jump."""


def _check_runs(contract: Contract, manager: Manager) -> Iterator[LintFinding]:
    """Yield findings about dead ends of the environment and outputs without a frame condition."""
    game = make_game(contract, manager)
    with manager.guard():
        yield from _check_game(contract, game)


def _check_game(contract: Contract, game: Game) -> Iterator[LintFinding]:
    manager = game.manager
    reachable = Runs(_system_of_game(game)).reachable
    can_continue = Product(manager, nodes_of(game.assumptions), game.next_inputs)(manager.true)
    dead_ends = reachable & ~can_continue
    if dead_ends != manager.false:
        yield LintFinding(rules.DEADLOCK, detail=_describe_state(game, dead_ends))
    for variable in contract.variables:
        if variable.owner is Owner.SYSTEM and not _is_always_restricted(game, variable):
            yield from _check_frame(game, variable, reachable & can_continue)


def _system_of_game(game: Game) -> FairSystem:
    """Return the fair system of all steps that assumptions and guarantees allow."""
    initial = game.manager.conjoin(nodes_of((*game.init_assumptions, *game.init_guarantees)))
    parts = (*nodes_of(game.assumptions), *nodes_of(game.guarantees))
    return FairSystem(game.symbols, initial, parts, nodes_of(game.fairness))


def _is_always_restricted(game: Game, variable: Variable) -> bool:
    """Whether some guarantee always restricts the output, examining one guarantee at a time.

    A cheap test that often succeeds, because most guarantees are about a single output.
    """
    manager = game.manager
    bits = game.symbols.bits(variable.name, primed=True)
    other_bits = [bit for bit in game.next_outputs if bit not in bits]
    # The states and next inputs in which every guarantee examined so far allows all values.
    unrestricted = manager.true
    for node in nodes_of(game.guarantees):
        if not manager.support(node).isdisjoint(bits):
            unrestricted = unrestricted & _states_allowing_any_value(
                game, variable, manager.exist(other_bits, node)
            )
    return unrestricted == manager.false


def _states_allowing_any_value(game: Game, variable: Variable, node: Node) -> Node:
    """Return the states and next inputs for which *node* allows all next values of the output."""
    manager, states = game.manager, game.manager.true
    bits = game.symbols.bits(variable.name, primed=True)
    for value in values(variable.domain):
        code = manager.cube(game.symbols.code(variable.name, value, primed=True))
        states = states & manager.exist(bits, node & code)
    return states


def _check_frame(game: Game, variable: Variable, states: Node) -> Iterator[LintFinding]:
    """Yield a finding if the output has no frame condition in *states*."""
    if size(variable.domain) == 1:
        return  # such as the state of a machine with one state
    product = Product(game.manager, nodes_of(game.assumptions), game.next_inputs)
    unconstrained = _states_without_frame(game, variable)
    if isinstance(variable.domain, IntegerDomain) and size(variable.domain) >= _MIN_QUANTITY_VALUES:
        condition = states & product(unconstrained)
        is_free = condition != game.manager.false
    else:
        # A Boolean or enumeration may be free in some steps; report only outputs free in all.
        condition = states
        is_free = states & product(~unconstrained) == game.manager.false
    if is_free:
        condition_text = (
            f"where {_describe_state(game, condition)}" if condition != states else "in any step"
        )
        yield LintFinding(rules.NO_FRAME, name=variable.name, detail=condition_text)


def _states_without_frame(game: Game, variable: Variable) -> Node:
    """Return the states and next inputs for which the guarantees allow all next values.

    Each value may need other values of the other outputs.
    """
    manager = game.manager
    bits = game.symbols.bits(variable.name, primed=True)
    other_bits = [bit for bit in game.next_outputs if bit not in bits]
    join = Product(manager, nodes_of(game.guarantees), other_bits)
    codes = (
        game.symbols.encode({variable.name: value}, primed=True)
        for value in values(variable.domain)
    )
    return manager.conjoin(manager.exist(bits, join(code)) for code in codes)


def _describe_state(game: Game, states: Node) -> str:
    """Return one of the states as text, without variables on which *states* do not depend.

    Auxiliary variables are omitted unless the states depend only on them.
    """
    symbols, manager = game.symbols, game.manager
    all_bits = symbols.all_bits(symbols.variables)
    values = symbols.decode(manager.pick(states, all_bits) or {})
    names = symbols.names(states) or tuple(values)
    shown = [name for name in names if not symbols.variables[name].is_auxiliary] or names
    return ", ".join(f"{name}={print_literal(values[name])}" for name in shown)
