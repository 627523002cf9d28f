"""The counter-strategy as a game at the keyboard: the environment is played, the reader answers."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import islice

from sysmlc.logic.contract import Class, Conjunct, Contract, Owner, Variable
from sysmlc.logic.domains import values
from sysmlc.logic.evaluate import has_primes, is_true
from sysmlc.logic.formula import Literal
from sysmlc.logic.printing import print_formula, print_literal
from sysmlc.logic.reduction.rules import has_past
from sysmlc.synthesis.counterstrategy.environment_strategy import Bits, EnvironmentStrategy
from sysmlc.synthesis.unrealizable.explanation import original_conjuncts

MOST_ANSWERS = 2_000
"""Answers that are looked through in one step."""
_SHOWN = 10
_INTRODUCTION = """\
You are '{component}'. In each step the environment gives its values, then you answer with yours:
name=value, separated by blanks. What you leave out stays as it is, when it may.
'options' shows what you may answer, 'quit' ends the game."""

Values = Mapping[str, Literal]


class Player:
    """One play; ``read`` asks for a line (EOFError ends the game), ``say`` shows one."""

    def __init__(
        self,
        environment: EnvironmentStrategy,
        contract: Contract,
        read: Callable[[str], str],
        say: Callable[[str], None],
    ) -> None:
        """``contract`` is the one as it was written, without history bits."""
        self._environment = environment
        self._contract = contract
        self._read, self._say = read, say
        self._outputs = tuple(one for one in contract.variables if one.owner is Owner.SYSTEM)
        self._symbols = environment.lost.arena.symbols

    def play(self) -> bool:
        """Play to the end; true when the component has lost, false when the reader gave up."""
        self._say(_INTRODUCTION.format(component=self._contract.component))
        seen: dict[object, int] = {}
        state: Bits | None = None
        given, fair = self._environment.first, 0
        for step in range(1, 1_000_000):
            self._say(f"step {step}: {self._told(given, state)}")
            answers = list(islice(self._environment.answers(state, given), MOST_ANSWERS))
            if not answers:
                self._say(self._stuck(state))
                return True
            answer = self._chosen(state, given, answers)
            if answer is None:
                return False
            state = {**given, **answer}
            key = tuple(state.values()), fair
            if key in seen:
                self._say(self._for_ever(state, step, seen[key]))
                return True
            seen[key] = step
            given, fair = self._environment.next(state, fair)
        return False

    def _told(self, given: Bits, state: Bits | None) -> str:
        """The inputs, those that have changed."""
        now, before = self._symbols.decode(given), self._symbols.decode(state or {})
        new = {name: value for name, value in now.items() if before.get(name) != value}
        return _pairs(new) or "nothing changes"

    def _chosen(self, state: Bits | None, given: Bits, answers: Sequence[Bits]) -> Bits | None:
        """The answer that the reader chooses; None to give up."""
        before = self._symbols.decode(state or {})
        offered = [(one, self._own(one)) for one in answers]
        while (line := self._line()) != "quit":
            if line == "options":
                self._show([own for _, own in offered])
            elif (wanted := self._parsed(line)) is not None:
                fitting = [one for one in offered if wanted.items() <= one[1].items()]
                if fitting:
                    chosen, own = max(fitting, key=lambda one: _same(one[1], before))
                    self._say(f"     {_pairs(own)}")
                    return chosen
                self._object(before, {**before, **self._symbols.decode(given), **wanted})
        return None

    def _line(self) -> str:
        try:
            return self._read("you: ").strip()
        except EOFError:
            return "quit"

    def _own(self, bits: Bits) -> dict[str, Literal]:
        found = self._symbols.decode(bits)
        return {one.name: found[one.name] for one in self._outputs}

    def _show(self, offered: Sequence[Values]) -> None:
        for own in offered[:_SHOWN]:
            self._say(f"     {_pairs(own)}")
        if len(offered) > _SHOWN:
            self._say(f"     and {len(offered) - _SHOWN:,} more")

    def _parsed(self, line: str) -> dict[str, Literal] | None:
        """The values in a line; None, with the reason said, when it is not understood."""
        known = {one.name: one for one in self._outputs}
        found: dict[str, Literal] = {}
        for word in line.replace(",", " ").split():
            name, _, text = word.partition("=")
            if name not in known:
                self._say(f"'{name}' is not yours; yours are {', '.join(known)}")
                return None
            value = _value(known[name], text)
            if value is None:
                all_values = ", ".join(map(print_literal, values(known[name].domain)))
                self._say(f"'{name}' is one of {all_values}")
                return None
            found[name] = value
        return found

    def _object(self, before: Values, now: Values) -> None:
        """Say which promises an answer breaks."""
        broken = list(dict.fromkeys(self._broken(before, now)))
        for said in broken or ["That is not allowed here; 'options' shows what is."]:
            self._say(said)

    def _broken(self, before: Values, now: Values) -> Iterator[str]:
        """What is promised and broken by these values, when they are all known."""
        class_ = Class.SAFETY if before else Class.INIT
        if any(one.name not in now for one in self._contract.variables):
            return
        for one in self._contract.guarantees:
            values = (before, now) if before else (now, None)
            if one.class_ is class_ and not is_true(one.formula, *values):
                yield f"That breaks '{print_formula(one.formula)}'{_about(one)}."

    def _stuck(self, state: Bits | None) -> str:
        """Why there is no answer: what holds already breaks a promise, or whatever comes."""
        now = self._symbols.decode(state or {})
        for one in self._contract.guarantees:
            is_of_step = one.class_ is Class.SAFETY and not has_primes(one.formula)
            if state and is_of_step and not has_past(one.formula) and not is_true(one.formula, now):
                broken = f"'{print_formula(one.formula)}'{_about(one)}"
                return f"Your last answer breaks {broken}. You have lost."
        return "You have no answer: each one breaks what you promise. You have lost."

    def _for_ever(self, state: Bits, step: int, earlier: int) -> str:
        lost = self._environment.lost
        rank = self._environment.rank(state)
        said = f"Step {step} is step {earlier} again, and the environment can go on so for ever"
        if not lost.game.goals:
            return f"{said}. You have lost."
        conjunct = lost.game.goals[rank.goal].conjunct
        if conjunct is None:
            return f"{said}. You have lost."
        (goal,) = original_conjuncts([conjunct], self._contract)
        missed = f"'{print_formula(goal.formula)}'{_about(goal)}"
        end = "is not kept" if goal.class_ is Class.OTHER else "does not come about again"
        return f"{said}:\n{missed} {end}. You have lost."


def _about(conjunct: Conjunct) -> str:
    """What the conjunct says in other words, in parentheses."""
    is_new = conjunct.text not in ("", print_formula(conjunct.formula))
    return f" ({conjunct.text.removesuffix('.')})" if is_new else ""


def _same(own: Values, before: Values) -> int:
    return sum(before.get(name) == value for name, value in own.items())


def _value(variable: Variable, text: str) -> Literal | None:
    found = (one for one in values(variable.domain) if print_literal(one) == text)
    return next(found, None)


def _pairs(values: Values) -> str:
    return " ".join(f"{name}={print_literal(value)}" for name, value in values.items())
