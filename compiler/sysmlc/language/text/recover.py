"""What is done where the parser cannot go on: say it once, mend it, read on."""

from collections.abc import Iterator

from sysmlc.language.text.errors import Errors
from sysmlc.language.text.generate import ACCEPT
from sysmlc.language.text.machine import Rules, Stack
from sysmlc.language.text.scan import Tokens
from sysmlc.language.text.tables import Tables

_MOST = 500
"""Places that are mended before a text is given up."""
_HELPER = "abstract"
"""A prefix after which a body may stand, for bodies whose head is not understood."""


class Recovery:
    """The state of one text that has errors; see ``next``."""

    def __init__(self, tables: Tables, rules: Rules, tokens: Tokens, errors: Errors) -> None:
        self._tables = tables
        self._rules = rules
        self._tokens = tokens
        self._errors = errors
        self._words = tables.types.words
        self._last = -2
        self._times = 0
        errors.beginnings.extend(self.expected([tables.start]))

    def next(self, stack: Stack, at: int) -> int:
        """Mend the stack or the tokens, where token ``at`` does not fit; where to go on."""
        states = stack[2::3]
        self._times += 1
        if self._times > _MOST:
            return -1
        quiet = at <= self._last + 1
        self._last = at
        for mend in _MENDS:
            following = mend(self, states, at, quiet)
            if following >= 0:
                return following
        if not quiet:
            self._errors.unexpected(at, self.expected(states))
        return self._panic(stack, at)

    def expected(self, states: list[int]) -> list[str]:
        """Texts and names of the types that may follow."""
        names = self._tables.names
        return [names[kind] for kind in names if self._accepts(states, kind)]

    # What is mended without losing anything

    def _comment(self, _states: list[int], at: int, quiet: bool) -> int:
        if self._tokens.types[at] != self._tables.types.body:
            return -1
        if not quiet:
            self._errors.comment(at)
        del self._tokens.types[at], self._tokens.starts[at], self._tokens.ends[at]
        self._last = -2
        return at

    def _substitute(self, states: list[int], at: int, quiet: bool) -> int:
        """A keyword that is meant as a name, one kind of `=` that is meant as another."""
        tokens, written = self._tokens, self._tokens[at]
        if written[:1].isalpha() and written in self._words:
            wanted = [self._tables.types.name]
        elif written in ("=", ":=", "=="):
            likely = ("=", ":=") if written == "==" else (":=", "=")
            wanted = [self._words[other] for other in likely if other in self._words]
        else:
            return -1
        for kind in wanted:
            if self._follows(states, (kind, *tokens.types[at + 1 : at + 2])):
                tokens.types[at] = kind
                if not quiet:
                    self._errors.substituted(at, self._tables.names[kind])
                return at
        return -1

    def _semicolon(self, states: list[int], at: int, quiet: bool) -> int:
        kind = self._words[";"]
        if not self._begins_anew(at) or not self._follows(states, (kind, self._tokens.types[at])):
            return -1
        return self._insert(kind, "';'", at, quiet)

    def _begins_anew(self, at: int) -> bool:
        tokens = self._tokens
        if at == 0 or tokens[at] in ("}", ""):
            return at > 0
        if tokens[at] in self._words and tokens[at].isalpha():
            return True
        between = tokens.text[tokens.ends[at - 1] : tokens.starts[at]]
        return "\n" in between or "\r" in between

    def _closing(self, states: list[int], at: int, quiet: bool) -> int:
        for symbol in ")]":
            kind = self._words[symbol]
            if self._follows(states, (kind, self._tokens.types[at])):
                return self._insert(kind, f"'{symbol}'", at, quiet)
        return -1

    def _insert(self, kind: int, words: str, at: int, quiet: bool) -> int:
        if not quiet:
            self._errors.missing(at, words)
        self._tokens.insert(at, kind)
        return at

    def _stray(self, states: list[int], at: int, quiet: bool) -> int:
        """A `;` or `}` too much: nothing else depends on it."""
        if self._tokens[at] not in (";", "}") or self._item_depth(states) < len(states) - 1:
            return -1
        if not quiet:
            self._errors.stray(at)
        return at + 1

    def _end(self, states: list[int], at: int, _quiet: bool) -> int:
        """The text ends within a body."""
        kind = self._words["}"]
        if self._tokens[at] or not self._accepts(states, kind):
            return -1
        self._errors.unclosed()
        self._tokens.insert(at, kind)
        return at

    # What loses the least otherwise

    def _panic(self, stack: Stack, at: int) -> int:
        tokens = self._tokens
        depth = self._item_depth(stack[2::3])
        for index, symbol in self._stops(at):
            wanted = ";" if symbol in ("}", "") else symbol
            kept = self._kept(stack, depth, self._words[wanted])
            del stack[3 * max(kept, depth) + 3 :]
            self._last = index
            if kept >= 0:
                if wanted != symbol:
                    tokens.insert(index, self._words[wanted])
                return index
            if symbol == "{":
                tokens.insert(index, self._words[_HELPER])
                self._last = index + 1
            return index + 1 if symbol == ";" else index
        return -1

    def _kept(self, stack: Stack, depth: int, kind: int) -> int:
        """The most of the stack, down to where the member begins, that can take a token."""
        states = stack[2::3]
        for top in range(len(states) - 1, depth, -1):
            if self._follows(states[: top + 1], (kind,)):
                return top
        return -1

    def _stops(self, at: int) -> Iterator[tuple[int, str]]:
        """Places where reading can go on: the ends of the member, the start of its body."""
        tokens, open_ones = self._tokens, 0
        for index in range(at, len(tokens.types)):
            written = tokens[index]
            if written in ("(", "["):
                open_ones += 1
            elif written in (")", "]"):
                open_ones -= 1
            elif written in ("{", "}", ";") or not written:
                yield index, written

    # Simulation

    def _has_item(self, state: int) -> bool:
        return self._tables.item in self._tables.rows[state]

    def _item_depth(self, states: list[int]) -> int:
        """Where on the stack the innermost body is whose members are being read."""
        for index in range(len(states) - 1, -1, -1):
            if self._has_item(states[index]):
                return index
        return 0

    def _accepts(self, states: list[int], kind: int) -> bool:
        return self._follows(states, (kind,))

    def _follows(self, states: list[int], kinds: tuple[int, ...]) -> bool:
        """Whether these tokens can come next."""
        simulated = list(states)
        return all(self._shifts(simulated, kind) for kind in kinds)

    def _shifts(self, states: list[int], kind: int) -> bool:
        rows, defaults = self._tables.rows, self._tables.defaults
        while True:
            step = rows[states[-1]].get(kind, defaults[states[-1]])
            if step is None:
                return False
            if step == ACCEPT:
                return True
            if step >= 0:
                states.append(step)
                return True
            symbol, size, _, _ = self._rules[~step]
            del states[-(size // 3) :]
            states.append(rows[states[-1]][symbol])


_MENDS = (
    Recovery._comment,
    Recovery._substitute,
    Recovery._semicolon,
    Recovery._closing,
    Recovery._stray,
    Recovery._end,
)
