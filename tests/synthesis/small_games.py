"""Random small contracts in GR(1), the same ones for the same seed.

``python tests/synthesis/small_games.py 2000`` compares that many with the solver that lists states.
"""

import random
import sys

from explicit import Explicit

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


def contract(seed: int) -> Contract:
    """A random contract with at most ``MOST_STATES`` states."""
    die = random.Random(seed)
    while True:
        variables = [variable(die, "a", Owner.ENVIRONMENT), variable(die, "x", Owner.SYSTEM)]
        if die.random() < 0.6:
            variables.append(variable(die, "b", die.choice(list(Owner))))
        if domains.count({one.name: one.domain for one in variables}) <= MOST_STATES:
            break
    die.shuffle(variables)
    inputs = [one for one in variables if one.owner is Owner.ENVIRONMENT]
    assumptions = [
        *conjuncts(die, Class.INIT, 1, inputs, []),
        *conjuncts(die, Class.SAFETY, 3, variables, inputs),
        *conjuncts(die, Class.LIVENESS, 2, variables, []),
    ]
    guarantees = [
        *conjuncts(die, Class.INIT, 1, variables, []),
        *conjuncts(die, Class.SAFETY, 3, variables, variables),
        *conjuncts(die, Class.LIVENESS, 3, variables, []),
    ]
    return Contract(f"g{seed}", "", tuple(variables), tuple(assumptions), tuple(guarantees))


def plant(seed: int) -> Contract:
    """A random contract with a plant, an input that follows from others, and a command.

    Some have a second command, an initial value, or something that spoils the structure.
    """
    die = random.Random(seed)
    a, p = Variable("a", Owner.ENVIRONMENT, BooleanDomain()), numbered("p", Owner.ENVIRONMENT)
    d = Variable("d", Owner.ENVIRONMENT, BooleanDomain())
    x, y = variable(die, "x", Owner.SYSTEM), variable(die, "y", Owner.SYSTEM)
    variables = [a, p, d, x, *([y] if die.random() < 0.4 else [])]
    inputs, outputs = [a, p], variables[3:]
    known = {one.name: one.domain for one in variables}
    meaning = truth(die, [Var("a"), Var("p")], known, 1)
    assumptions = [
        Conjunct(f.iff(Var("d"), meaning), Class.INIT, ""),
        Conjunct(f.prime(f.iff(Var("d"), meaning)), Class.SAFETY, ""),
        *obedient(die, p, [a, p, *outputs]),
        *conjuncts(die, Class.SAFETY, 1, variables, [a]),
        *conjuncts(die, Class.LIVENESS, 1, variables[:3], []),
        *(conjuncts(die, Class.SAFETY, 1, variables, inputs) if die.random() < 0.2 else ()),
    ]
    guarantees = [
        *conjuncts(die, Class.INIT, 1, variables, []),
        *(after for one in conjuncts(die, Class.INIT, 2, variables, []) for after in [later(one)]),
        *conjuncts(die, Class.SAFETY, 1, variables[:3], []),
        *conjuncts(die, Class.LIVENESS, 2, variables[:3], []),
        *(conjuncts(die, Class.SAFETY, 1, variables, variables) if die.random() < 0.3 else ()),
    ]
    return Contract(f"p{seed}", "", tuple(variables), tuple(assumptions), tuple(guarantees))


def numbered(name: str, owner: Owner) -> Variable:
    return Variable(name, owner, IntegerDomain(0, 2))


def later(conjunct: Conjunct) -> Conjunct:
    """The same about the next step, always."""
    return Conjunct(f.prime(conjunct.formula), Class.SAFETY, "")


def obedient(die: random.Random, moved: Variable, about: list[Variable]):
    """A next value for some conditions, for the first one that holds; mostly for all states."""
    known = {one.name: one.domain for one in about}
    pool = [Var(one.name) for one in about]
    left: Formula = f.TRUE
    for _ in range(die.randint(1, 4)):
        case = truth(die, pool, known, 1)
        yield Conjunct(f.implies(f.both(left, case), step(die, moved)), Class.SAFETY, "")
        left = f.both(left, f.negate(case))
    if die.random() < 0.9:
        yield Conjunct(f.implies(left, step(die, moved)), Class.SAFETY, "")


def step(die: random.Random, moved: Variable) -> Formula:
    return f.eq(Var(moved.name, True), Const(die.choice(domains.values(moved.domain))))


def variable(die: random.Random, name: str, owner: Owner) -> Variable:
    return Variable(name, owner, die.choice(DOMAINS))


def conjuncts(die, class_, most, present, after):
    """Up to ``most`` conjuncts about this step and the next one."""
    pool = [*(Var(one.name) for one in present), *(Var(one.name, True) for one in after)]
    known = {one.name: one.domain for one in [*present, *after]}
    for _ in range(die.randint(0, most)):
        yield Conjunct(truth(die, pool, known, die.randint(1, 2)), class_, "")


def truth(die: random.Random, pool: list[Var], known, depth: int) -> Formula:
    if depth == 0:
        return atom(die, pool, known)
    left, right = (truth(die, pool, known, depth - 1) for _ in range(2))
    join = die.choice([f.both, f.either, f.implies, f.implies, f.iff])
    return f.negate(join(left, right)) if die.random() < 0.1 else join(left, right)


def atom(die: random.Random, pool: list[Var], known) -> Formula:
    one = die.choice(pool)
    domain = known[one.name]
    if isinstance(domain, BooleanDomain):
        return one if die.random() < 0.7 else f.negate(one)
    if isinstance(domain, EnumerationDomain):
        return compare(die.choice([Op.EQ, Op.NE]), one, Const(die.choice(domain.literals)))
    op = die.choice([Op.EQ, Op.NE, Op.LT, Op.LE, Op.GT, Op.GE])
    return compare(op, one, number(die, pool, known))


def number(die: random.Random, pool: list[Var], known) -> Formula:
    numbers = [one for one in pool if isinstance(known[one.name], IntegerDomain)]
    chosen = die.choice([die.choice(numbers), Const(die.randint(-1, 5))])
    if die.random() < 0.4:
        op = die.choice([Op.ADD, Op.SUB, Op.MUL, Op.DIV, Op.MOD])
        return f.Apply(op, (chosen, Const(die.randint(-2, 3))))
    return chosen


def disagreement(seed: int, engine: str = "") -> str:
    """What the two solvers say when they do not say the same, about any state or the verdict."""
    made = contract(seed)
    listed = Explicit(made)
    game = make_game(made, Manager(engine))
    solution = solve(game)
    winning = listed.winning()
    for state in listed.states:
        code = game.symbols.encode(listed.value[state])
        if (code <= solution.winning) != (state in winning):
            return f"game {seed}: {listed.value[state]} is {state in winning}"
    verdict = listed.is_realizable()
    return "" if solution.is_realizable == verdict else f"game {seed}: realizable is {verdict}"


def encoded_disagreement(made: Contract, engine: str = "") -> str:
    """What is said of the encoded game when the verdict is not the one of the listed states."""
    arena = encoded(made, engine)
    verdict = Explicit(made).is_realizable()
    found = [solve_arena(arena, is_complete).is_realizable for is_complete in (True, False)]
    return "" if found == [verdict] * 2 else f"{made.component}: realizable is {verdict}"


def encoded(made: Contract, engine: str = ""):
    return eliminate_commands(eliminate_determined_variables(make_game(made, Manager(engine))))


if __name__ == "__main__":
    seeds = range(int(sys.argv[1]))
    wrong = [text for seed in seeds if (text := disagreement(seed))]
    wrong += [text for seed in seeds if (text := encoded_disagreement(contract(seed)))]
    wrong += [text for seed in seeds if (text := encoded_disagreement(plant(seed)))]
    print(*wrong, f"{sys.argv[1]} games, {len(wrong)} disagreements", sep="\n")
    sys.exit(bool(wrong))
