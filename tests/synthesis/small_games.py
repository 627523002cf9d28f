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


if __name__ == "__main__":
    wrong = [text for seed in range(int(sys.argv[1])) if (text := disagreement(seed))]
    print(*wrong, f"{sys.argv[1]} games, {len(wrong)} disagreements", sep="\n")
    sys.exit(bool(wrong))
