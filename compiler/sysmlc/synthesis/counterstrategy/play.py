"""Interactive play against a counter-strategy: the program is the environment, the user answers."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import islice

from sysmlc.logic.contract import Class, Conjunct, Contract, Owner
from sysmlc.logic.domains import values
from sysmlc.logic.evaluate import is_true
from sysmlc.logic.formula import Literal, has_past, has_primes
from sysmlc.logic.printing import print_formula, print_literal
from sysmlc.synthesis.counterstrategy.environment_strategy import Bits, EnvironmentStrategy
from sysmlc.synthesis.unrealizable import find_original_conjuncts

MAX_ANSWERS = 2_000
"""Allowed answers that are examined in one step; further answers cannot be given."""
_MAX_SHOWN_OPTIONS = 10
_INTRODUCTION = """\
You play '{component}'. In each step the environment chooses its inputs, then you answer with
outputs: name=value, separated by blanks. An output that you omit keeps its value if possible.
'options' shows the allowed answers, 'quit' ends the game."""

Values = Mapping[str, Literal]


class Player:
    """One play of a user; ``play`` runs it."""

    def __init__(
        self,
        environment: EnvironmentStrategy,
        contract: Contract,
        read: Callable[[str], str],
        write: Callable[[str], None],
    ) -> None:
        """Prepare a play of *contract*, which is the original contract without history bits.

        *read* shows a prompt and returns a line; its EOFError ends the play. *write* shows a line.
        """
        self._environment = environment
        self._contract = contract
        self._read, self._write = read, write
        self._outputs = tuple(
            variable for variable in contract.variables if variable.owner is Owner.SYSTEM
        )
        self._symbols = environment.lost_game.arena.symbols

    def play(self) -> bool:
        """Play to the end. Return True if the component has lost, False if the user gave up."""
        self._write(_INTRODUCTION.format(component=self._contract.component))
        first_steps: dict[object, int] = {}
        state: Bits | None = None
        inputs, fair = self._environment.first, 0
        for step in range(1, 1_000_000):
            self._write(f"step {step}: {self._describe_changes(inputs, state)}")
            answers = list(islice(self._environment.iter_answers(state, inputs), MAX_ANSWERS))
            if not answers:
                self._write(self._describe_dead_end(state))
                return True
            answer = self._choose_answer(state, inputs, answers)
            if answer is None:
                return False
            state = {**inputs, **answer}
            # With equal state and memory, the environment can repeat the steps in between forever.
            key = tuple(state.values()), fair
            if key in first_steps:
                self._write(self._describe_loop(state, step, first_steps[key]))
                return True
            first_steps[key] = step
            inputs, fair = self._environment.next_inputs(state, fair)
        return False

    def _describe_changes(self, inputs: Bits, state: Bits | None) -> str:
        """Return the changed inputs as text."""
        current, previous = self._symbols.decode(inputs), self._symbols.decode(state or {})
        changed = {name: value for name, value in current.items() if previous.get(name) != value}
        return _print_values(changed) or "nothing changes"

    def _choose_answer(
        self, state: Bits | None, inputs: Bits, answers: Sequence[Bits]
    ) -> Bits | None:
        """Return the answer that the user chooses, or None if the user gives up.

        Of the allowed answers with the entered values, it is the one with the fewest changes.
        """
        previous = self._symbols.decode(state or {})
        options = [(answer, self._outputs_of(answer)) for answer in answers]
        while (line := self._read_line()) != "quit":
            if line == "options":
                self._show_options([outputs for _, outputs in options])
            elif (requested := self._parse_line(line)) is not None:
                matching = [answer for answer in options if requested.items() <= answer[1].items()]
                if matching:
                    answer_bits, outputs = max(
                        matching, key=lambda answer: len(answer[1].items() & previous.items())
                    )
                    self._write(f"     {_print_values(outputs)}")
                    return answer_bits
                self._explain_refusal(
                    previous, {**previous, **self._symbols.decode(inputs), **requested}
                )
        return None

    def _read_line(self) -> str:
        try:
            return self._read("you: ").strip()
        except EOFError:
            return "quit"

    def _outputs_of(self, bits: Bits) -> dict[str, Literal]:
        values = self._symbols.decode(bits)
        return {variable.name: values[variable.name] for variable in self._outputs}

    def _show_options(self, options: Sequence[Values]) -> None:
        for outputs in options[:_MAX_SHOWN_OPTIONS]:
            self._write(f"     {_print_values(outputs)}")
        if len(options) > _MAX_SHOWN_OPTIONS:
            self._write(f"     and {len(options) - _MAX_SHOWN_OPTIONS:,} more")

    def _parse_line(self, line: str) -> dict[str, Literal] | None:
        """Return the values in a line, or show why the line is invalid and return None."""
        variables = {variable.name: variable for variable in self._outputs}
        requested: dict[str, Literal] = {}
        for word in line.replace(",", " ").split():
            name, _, text = word.partition("=")
            if name not in variables:
                self._write(f"'{name}' is not an output; the outputs are {', '.join(variables)}")
                return None
            values_by_text = {print_literal(v): v for v in values(variables[name].domain)}
            if text not in values_by_text:
                self._write(f"'{name}' is one of {', '.join(values_by_text)}")
                return None
            requested[name] = values_by_text[text]
        return requested

    def _explain_refusal(self, previous: Values, current: Values) -> None:
        """Show the guarantees that a refused answer violates."""
        messages = list(dict.fromkeys(self._violated_guarantees(previous, current)))
        for message in messages or [
            "This answer is not allowed here; 'options' shows the allowed answers."
        ]:
            self._write(message)

    def _violated_guarantees(self, previous: Values, current: Values) -> Iterator[str]:
        """Yield a message for each violated guarantee; none if a value is missing."""
        class_ = Class.SAFETY if previous else Class.INIT
        if any(guarantee.name not in current for guarantee in self._contract.variables):
            return
        for guarantee in self._contract.guarantees:
            values = (previous, current) if previous else (current, None)
            if guarantee.class_ is class_ and not is_true(guarantee.formula, *values):
                text = _text_in_parentheses(guarantee)
                yield f"This answer violates '{print_formula(guarantee.formula)}'{text}."

    def _describe_dead_end(self, state: Bits | None) -> str:
        """Return why no answer is allowed.

        Either the last answer violates a guarantee about a single step, which a game checks in the
        next step, or every answer would violate some guarantee.
        """
        values = self._symbols.decode(state or {})
        for guarantee in self._contract.guarantees:
            is_of_step = guarantee.class_ is Class.SAFETY and not has_primes(guarantee.formula)
            if (
                state
                and is_of_step
                and not has_past(guarantee.formula)
                and not is_true(guarantee.formula, values)
            ):
                violated = f"'{print_formula(guarantee.formula)}'{_text_in_parentheses(guarantee)}"
                return f"Your last answer violates {violated}. You have lost."
        return "No answer is allowed: each one violates a guarantee. You have lost."

    def _describe_loop(self, state: Bits, step: int, earlier: int) -> str:
        lost = self._environment.lost_game
        rank = self._environment.rank(state)
        introduction = (
            f"Step {step} equals step {earlier}, and the environment can repeat this for ever"
        )
        if not lost.game.goals:
            return f"{introduction}. You have lost."
        conjunct = lost.game.goals[rank.goal].conjunct
        if conjunct is None:
            return f"{introduction}. You have lost."
        (goal,) = find_original_conjuncts([conjunct], self._contract)
        guarantee = f"'{print_formula(goal.formula)}'{_text_in_parentheses(goal)}"
        end = "is violated" if goal.class_ is Class.OTHER else "never holds again"
        return f"{introduction}:\n{guarantee} {end}. You have lost."


def _text_in_parentheses(conjunct: Conjunct) -> str:
    """Return the conjunct's text in parentheses, unless it repeats the formula."""
    is_new = conjunct.text not in ("", print_formula(conjunct.formula))
    return f" ({conjunct.text.removesuffix('.')})" if is_new else ""


def _print_values(values: Values) -> str:
    return " ".join(f"{name}={print_literal(value)}" for name, value in values.items())
