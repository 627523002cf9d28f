"""Random requirements about random blocks, and their answers by explicit exploration.

The exploration reads the block through the interpreter of ``component_runs``, never a contract.
Spot decides whether the explored runs violate a requirement.
"""

import re
from random import Random

import spot
from component_runs import (
    FEATURES,
    Block,
    Move,
    first_state,
    list_actions,
    list_branches,
    list_inputs,
    list_reactions,
    name_choice,
    observe,
    observe_decisions,
)
from spot import buddy

SHAPES = (
    "G({p} -> X {q})",
    "G({p} -> F {q})",
    "G({p} & {q} -> {r})",
    "G({p} -> ({q} W {r}))",
    "G({p} -> X({q} U {r}))",
    "G({p} -> X X {q})",
    "G({p} & X {q} -> X {r})",
    "F {p} -> (!{p} U {q})",
    "G F {p} -> G F {q}",
    "F G {p}",
    "G(!({p} & {q}))",
    "F {p}",
    "G {p} | G {q}",
    "G(running({action}) -> F finished({action}))",
    "G({p} & running({action}) -> F {q})",
    "G(running({action}) -> (running({action}) U {p}))",
    "G({p} -> F !running({action}))",
)
"""Frequent forms of requirements about literals p, q and r, and an action."""

_ATOM = re.compile(r"(running|finished)\([\w.]+\)|(state|event)=\w+|b\d")


# -- formulas ----------------------------------------------------------------------------------


def make_requirements(random: Random, block: Block, count: int) -> list[str]:
    """Return random formulas about a block; half of them have a frequent form."""
    atoms, actions = list_atoms(block), list_actions(block)
    # A block without activities has no requirements about actions.
    shapes = [shape for shape in SHAPES if actions or "{action}" not in shape]
    return [
        _fill_shape(random, random.choice(shapes), atoms, actions or [""])
        if random.random() < 0.6
        else _make_formula(random, atoms, 3)
        for _ in range(count)
    ]


def list_atoms(block: Block) -> list[str]:
    """Return the names of features, states, events and actions, as formulas have them."""
    events = sorted({move.event for move in block.moves if move.event})
    return [
        *FEATURES,
        *(f"state={state}" for state in block.states),
        *(f"event={event}" for event in ("none", *events)),
        *(f"{word}({path})" for path in list_actions(block) for word in ("running", "finished")),
    ]


def _fill_shape(random: Random, shape: str, atoms: list[str], actions: list[str]) -> str:
    literals = {letter: random.choice(("", "!")) + random.choice(atoms) for letter in "pqr"}
    return shape.format(**literals, action=random.choice(actions)).replace("!!", "")


def _make_formula(random: Random, atoms: list[str], depth: int) -> str:
    if depth == 0 or random.random() < 0.2:
        return random.choice(("", "!")) + random.choice(atoms)
    operator = random.choice("GFXUW&|>")
    left = _make_formula(random, atoms, depth - 1)
    if operator in "GFX":
        return f"{operator}({left})"
    right = _make_formula(random, atoms, depth - 1)
    return f"(({left}) {'->' if operator == '>' else operator} ({right}))"


def _name_transition(source: str, target: str, guard: str) -> str:
    return f"transition '{source} to {target}{f' [{guard}]' if guard else ''}'"


# -- answers -----------------------------------------------------------------------------------


class ExploredBlock:
    """The runs of a block as an automaton whose edges say what is observed in a step.

    ``observed`` are all facts that some step shows, ``taken`` the transitions that some step takes,
    with the states to which they lead, ``passed`` the names of decisions that tokens reach, with
    the guards that hold then or "", and ``changed`` the features that some step changes.
    """

    def __init__(self, block: Block, limit: int) -> None:
        """Explore the block. Raises ValueError if it has more than *limit* states."""
        self._variables = {atom: f"p{number}" for number, atom in enumerate(list_atoms(block))}
        self._block = block
        self.observed: set[str] = set()
        self.taken: set[tuple[Move, str]] = set()
        self.passed: set[tuple[str, str]] = set()
        self.changed: set[str] = set()
        self._actions = list_actions(block, is_elementary=True)
        self._dictionary = spot.make_bdd_dict()
        self._fair_runs = spot.make_twa_graph(self._dictionary)
        # An action that runs ends sooner or later: again and again, it does not run or it ends.
        self._fair_runs.set_generalized_buchi(len(self._actions))
        self._labels = {
            atom: buddy.bdd_ithvar(self._fair_runs.register_ap(variable))
            for atom, variable in self._variables.items()
        }
        self._explore(limit)
        self._runs = spot.twa_graph(self._fair_runs, spot.twa_prop_set.all())
        self._runs.set_acceptance(0, spot.acc_code.t())
        for edge in self._runs.edges():
            edge.acc = spot.mark_t()

    def _explore(self, limit: int) -> None:
        block = self._block
        numbers = {first_state(block): self._fair_runs.new_state()}
        worklist = [first_state(block)]
        while worklist:
            state = worklist.pop()
            self.passed |= observe_decisions(block, state)
            for event, ended in list_inputs(block, state):
                facts = observe(block, state, event, ended)
                self.observed |= facts
                for move, after in list_reactions(block, state, event, ended):
                    self.taken |= set() if move is None else {(move, after.state)}
                    values = zip(FEATURES, state.values, after.values, strict=True)
                    self.changed |= {name for name, old, new in values if old != new}
                    if after not in numbers:
                        if len(numbers) == limit:
                            raise ValueError("too many states")
                        numbers[after] = self._fair_runs.new_state()
                        worklist.append(after)
                    self._add_step(numbers[state], numbers[after], facts)

    def _add_step(self, source: int, target: int, facts: frozenset) -> None:
        label = buddy.bddtrue
        for atom, variable in self._labels.items():
            label &= variable if atom in facts else -variable
        marks = [
            number
            for number, action in enumerate(self._actions)
            if f"running({action})" not in facts or f"finished({action})" in facts
        ]
        self._fair_runs.new_edge(source, target, label, marks)

    def list_unreached(self) -> dict[str, list[str]]:
        """Return the names of what no step reaches, in the words of ``contracts check``."""
        block, observed = self._block, self.observed
        states = [state for state in block.states if f"state={state}" not in observed]
        actions = [path for path in list_actions(block) if f"running({path})" not in observed]
        never_taken = []
        for move in block.moves:
            branches, taken = list_branches(block, move), {item for item, _ in self.taken}
            target = name_choice(block, move) if branches else move.target
            if f"state={move.source}" in observed and move not in taken:
                never_taken.append(_name_transition(move.source, target, move.guard))
            never_taken += [
                _name_transition(target, end, guard)
                for guard, end in branches
                if move in taken and (move, end) not in self.taken
            ]
        reached = {decision for decision, _ in self.passed}
        never_true = [
            guard
            for steps in block.activities.values()
            for step in steps
            for guard in step.guards
            # ``else`` has no condition that could be wrong: its action is unreachable.
            if guard != "else" and step.name in reached and (step.name, guard) not in self.passed
        ]
        return {
            "unreachable": sorted(states + actions),
            "never_taken": sorted(never_taken),
            "never_true": sorted(never_true),
            "never_changed": [name for name in FEATURES if name not in self.changed],
        }

    def decide(self, requirement: str) -> str:
        """Return the verdict about a requirement, in the words of ``contracts check``."""
        text = _ATOM.sub(lambda match: self._variables[match[0]], requirement)
        violations = spot.translate(spot.formula(f"!({text})"), dict=self._dictionary)
        if not self._runs.intersects(violations):
            return "holds"
        return "broken" if self._fair_runs.intersects(violations) else "holds-if-actions-end"
