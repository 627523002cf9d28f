"""Random small contracts in GR(1); the seed determines the contract.

``python tests/synthesis/small_games.py 2000`` compares the verdicts on 2,000 contracts of each kind
with those of the explicit solver.
"""

import random
import sys

from explicit import ExplicitGame

from sysmlc.logic import domains
from sysmlc.logic import formula as f
from sysmlc.logic.contract import (
    BooleanDomain,
    Class,
    Conjunct,
    Contract,
    EnumerationDomain,
    IntegerDomain,
    Owner,
    Variable,
)
from sysmlc.logic.formula import Const, Formula, Op, Var, compare
from sysmlc.synthesis import Manager, make_game, solve
from sysmlc.synthesis.games.command_elimination import eliminate_commands
from sysmlc.synthesis.games.solver import solve_arena
from sysmlc.synthesis.games.variable_elimination import eliminate_determined_variables

DOMAINS = (
    BooleanDomain(),
    BooleanDomain(),
    IntegerDomain(0, 2),
    IntegerDomain(-1, 1),
    IntegerDomain(2, 5),
    EnumerationDomain(("red", "amber", "green")),
)
MOST_STATES = 24


def random_contract(seed: int) -> Contract:
    """Return a random contract with at most ``MOST_STATES`` states."""
    die = random.Random(seed)
    while True:
        variables = [
            random_variable(die, "a", Owner.ENVIRONMENT),
            random_variable(die, "x", Owner.SYSTEM),
        ]
        if die.random() < 0.6:
            variables.append(random_variable(die, "b", die.choice(list(Owner))))
        if domains.count({variable.name: variable.domain for variable in variables}) <= MOST_STATES:
            break
    die.shuffle(variables)
    inputs = [variable for variable in variables if variable.owner is Owner.ENVIRONMENT]
    assumptions = [
        *iter_random_conjuncts(die, Class.INIT, 1, inputs, []),
        *iter_random_conjuncts(die, Class.SAFETY, 3, variables, inputs),
        *iter_random_conjuncts(die, Class.LIVENESS, 2, variables, []),
    ]
    guarantees = [
        *iter_random_conjuncts(die, Class.INIT, 1, variables, []),
        *iter_random_conjuncts(die, Class.SAFETY, 3, variables, variables),
        *iter_random_conjuncts(die, Class.LIVENESS, 3, variables, []),
    ]
    return Contract(f"g{seed}", "", tuple(variables), tuple(assumptions), tuple(guarantees))


def random_plant(seed: int) -> Contract:
    """Return a random contract with a plant, an input determined by others, and a command.

    Some contracts have a second command, an initial value, or a rule that prevents encoding.
    """
    die = random.Random(seed)
    a, p = (
        Variable("a", Owner.ENVIRONMENT, BooleanDomain()),
        number_variable("p", Owner.ENVIRONMENT),
    )
    d = Variable("d", Owner.ENVIRONMENT, BooleanDomain())
    x, y = random_variable(die, "x", Owner.SYSTEM), random_variable(die, "y", Owner.SYSTEM)
    variables = [a, p, d, x, *([y] if die.random() < 0.4 else [])]
    inputs, outputs = [a, p], variables[3:]
    domains_by_name = {variable.name: variable.domain for variable in variables}
    meaning = random_condition(die, [Var("a"), Var("p")], domains_by_name, 1)
    assumptions = [
        Conjunct(f.iff(Var("d"), meaning), Class.INIT, ""),
        Conjunct(f.prime(f.iff(Var("d"), meaning)), Class.SAFETY, ""),
        *iter_plant_rules(die, p, [a, p, *outputs]),
        *iter_random_conjuncts(die, Class.SAFETY, 1, variables, [a]),
        *iter_random_conjuncts(die, Class.LIVENESS, 1, variables[:3], []),
        *(
            iter_random_conjuncts(die, Class.SAFETY, 1, variables, inputs)
            if die.random() < 0.2
            else ()
        ),
    ]
    guarantees = [
        *iter_random_conjuncts(die, Class.INIT, 1, variables, []),
        *(
            shift_to_next_step(conjunct)
            for conjunct in iter_random_conjuncts(die, Class.INIT, 2, variables, [])
        ),
        *iter_random_conjuncts(die, Class.SAFETY, 1, variables[:3], []),
        *iter_random_conjuncts(die, Class.LIVENESS, 2, variables[:3], []),
        *(
            iter_random_conjuncts(die, Class.SAFETY, 1, variables, variables)
            if die.random() < 0.3
            else ()
        ),
    ]
    return Contract(f"p{seed}", "", tuple(variables), tuple(assumptions), tuple(guarantees))


def number_variable(name: str, owner: Owner) -> Variable:
    return Variable(name, owner, IntegerDomain(0, 2))


def shift_to_next_step(conjunct: Conjunct) -> Conjunct:
    """Return a safety conjunct that states *conjunct* about the next step."""
    return Conjunct(f.prime(conjunct.formula), Class.SAFETY, "")


def iter_plant_rules(die: random.Random, moved: Variable, about: list[Variable]):
    """Yield rules that assign a next value in each of some disjoint cases, mostly all cases."""
    domains_by_name = {variable.name: variable.domain for variable in about}
    pool = [Var(variable.name) for variable in about]
    remaining: Formula = f.TRUE
    for _ in range(die.randint(1, 4)):
        case = random_condition(die, pool, domains_by_name, 1)
        yield Conjunct(
            f.implies(f.both(remaining, case), assign_next_value(die, moved)), Class.SAFETY, ""
        )
        remaining = f.both(remaining, f.negate(case))
    if die.random() < 0.9:
        yield Conjunct(f.implies(remaining, assign_next_value(die, moved)), Class.SAFETY, "")


def assign_next_value(die: random.Random, moved: Variable) -> Formula:
    return f.eq(Var(moved.name, True), Const(die.choice(domains.values(moved.domain))))


def random_variable(die: random.Random, name: str, owner: Owner) -> Variable:
    return Variable(name, owner, die.choice(DOMAINS))


def iter_random_conjuncts(die, class_, most, present, after):
    """Yield up to *most* conjuncts about the current and the next step."""
    pool = [
        *(Var(variable.name) for variable in present),
        *(Var(variable.name, True) for variable in after),
    ]
    domains_by_name = {variable.name: variable.domain for variable in [*present, *after]}
    for _ in range(die.randint(0, most)):
        yield Conjunct(random_condition(die, pool, domains_by_name, die.randint(1, 2)), class_, "")


def random_condition(die: random.Random, pool: list[Var], domains_by_name, depth: int) -> Formula:
    if depth == 0:
        return random_atom(die, pool, domains_by_name)
    left, right = (random_condition(die, pool, domains_by_name, depth - 1) for _ in range(2))
    join = die.choice([f.both, f.either, f.implies, f.implies, f.iff])
    return f.negate(join(left, right)) if die.random() < 0.1 else join(left, right)


def random_atom(die: random.Random, pool: list[Var], domains_by_name) -> Formula:
    variable = die.choice(pool)
    domain = domains_by_name[variable.name]
    if isinstance(domain, BooleanDomain):
        return variable if die.random() < 0.7 else f.negate(variable)
    if isinstance(domain, EnumerationDomain):
        return compare(die.choice([Op.EQ, Op.NE]), variable, Const(die.choice(domain.literals)))
    op = die.choice([Op.EQ, Op.NE, Op.LT, Op.LE, Op.GT, Op.GE])
    return compare(op, variable, random_comparison_operand(die, pool, domains_by_name))


def random_comparison_operand(die: random.Random, pool: list[Var], domains_by_name) -> Formula:
    numbers = [
        operand for operand in pool if isinstance(domains_by_name[operand.name], IntegerDomain)
    ]
    chosen = die.choice([die.choice(numbers), Const(die.randint(-1, 5))])
    if die.random() < 0.4:
        op = die.choice([Op.ADD, Op.SUB, Op.MUL, Op.DIV, Op.MOD])
        return f.Apply(op, (chosen, Const(die.randint(-2, 3))))
    return chosen


def describe_disagreement(seed: int, engine: str = "") -> str:
    """Describe a state or verdict on which the two solvers disagree; empty if they agree."""
    contract = random_contract(seed)
    explicit = ExplicitGame(contract)
    game = make_game(contract, Manager(engine))
    solution = solve(game)
    winning = explicit.find_winning_states()
    for state in explicit.states:
        code = game.symbols.encode(explicit.value[state])
        if (code <= solution.winning) != (state in winning):
            return f"game {seed}: {explicit.value[state]} is {state in winning}"
    verdict = explicit.is_realizable()
    return "" if solution.is_realizable == verdict else f"game {seed}: realizable is {verdict}"


def describe_encoded_disagreement(contract: Contract, engine: str = "") -> str:
    """Describe a wrong verdict on the encoded game; empty if the explicit solver agrees."""
    arena = encode_game(contract, engine)
    verdict = ExplicitGame(contract).is_realizable()
    verdicts = [solve_arena(arena, is_complete).is_realizable for is_complete in (True, False)]
    return "" if verdicts == [verdict] * 2 else f"{contract.component}: realizable is {verdict}"


def encode_game(contract: Contract, engine: str = ""):
    return eliminate_commands(eliminate_determined_variables(make_game(contract, Manager(engine))))


if __name__ == "__main__":
    seeds = range(int(sys.argv[1]))
    wrong = [text for seed in seeds if (text := describe_disagreement(seed))]
    wrong += [
        text for seed in seeds if (text := describe_encoded_disagreement(random_contract(seed)))
    ]
    wrong += [text for seed in seeds if (text := describe_encoded_disagreement(random_plant(seed)))]
    print(*wrong, f"{sys.argv[1]} games, {len(wrong)} disagreements", sep="\n")
    sys.exit(bool(wrong))
