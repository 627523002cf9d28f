"""Error recovery: report a token that does not fit, mend the text or the stack, and parse on.

A mend that loses nothing is tried first (a substituted, inserted or ignored token). Otherwise
panic mode drops the stack down to where the rest of the member can be parsed.
"""

from collections.abc import Iterator

from sysmlc.language.text import hints
from sysmlc.language.text.corrections import list_corrections
from sysmlc.language.text.errors import Errors
from sysmlc.language.text.lalr import Rules, Stack, Tables
from sysmlc.language.text.lexer import Tokens
from sysmlc.language.text.table_generator import ACCEPT

_MAX_RECOVERIES = 500
"""Recoveries after which the rest of a text is given up."""
_MAX_CORRECTED = 100
"""Tokens of a member before the error, up to which a slip is searched for."""
_CONDITIONS = ("assert", "assume", "require", "if")
"""First words of members that mean something else without their conditions."""
_PREFIX_WITH_BODY = "abstract"
"""A prefix that a body may follow, inserted before a body whose head was not understood."""


class Recovery:
    """Recovers from the syntax errors of one text.

    A mend takes the states of the stack and the index of the token that does not fit. It returns
    the index of the token to parse on from, or -1 if it does not apply.
    """

    def __init__(self, tables: Tables, rules: Rules, tokens: Tokens, errors: Errors) -> None:
        self._tables = tables
        self._rules = rules
        self._tokens = tokens
        self._errors = errors
        self._words = tables.types.words
        self._last_error = -2
        self._count = 0
        errors.beginnings.extend(self._find_expected([tables.start]))

    def recover(self, stack: Stack, index: int) -> int:
        """Mend the stack or the tokens; return where to parse on, or -1 to give the text up."""
        self._count += 1
        # Each recovery simulates the parser for all token types; hostile texts must not take
        # minutes.
        if self._count > _MAX_RECOVERIES:
            return -1
        # An error at the very next token follows from the mend, not from the text.
        self._errors.is_quiet = index <= self._last_error + 1
        self._last_error = index
        next_index = self._mend(stack, index)
        self._errors.is_quiet = False
        return next_index

    def _mend(self, stack: Stack, index: int) -> int:
        if not self._errors.is_quiet:
            for correct in (self._correct_keyword, self._correct_member):
                next_index = correct(stack, index)
                if next_index >= 0:
                    return next_index
        states = stack[2::3]
        for mend in _MENDS:
            next_index = mend(self, states, index)
            if next_index >= 0:
                return next_index
        self._report_unexpected(states, index)
        return self._panic(stack, index)

    def _report_unexpected(self, states: list[int], index: int) -> None:
        # The expected tokens take long to find.
        if not self._errors.is_quiet:
            self._errors.report_unexpected(index, self._find_expected(states))

    def _find_expected(self, states: list[int]) -> list[str]:
        """Return the texts and type names of the tokens that may come next."""
        names = self._tables.names
        return [names[token_type] for token_type in names if self._accepts(states, token_type)]

    # -- mends that lose nothing -----------------------------------------------------------------

    def _correct_keyword(self, stack: Stack, index: int) -> int:
        """Take the name before ``index`` for the misspelt keyword of the member, ``prt def A``."""
        tokens, types = self._tokens, self._tables.types
        word_index = index - 1
        if word_index < 0 or tokens.types[word_index] != types.name:
            return -1
        start = self._find_member_start(word_index)
        if types.name in tokens.types[start:word_index]:
            return -1
        body = self._find_body(stack[2::3])
        states = stack[2 : 3 * body + 3 : 3]
        for keyword in hints.list_similar_keywords(tokens[word_index], self._errors.beginnings):
            prefixes, following = tokens.types[start:word_index], tokens.types[index : index + 1]
            if self._accepts_all(states, (*prefixes, self._words[keyword], *following)):
                self._errors.report_misspelt_keyword(word_index, keyword)
                tokens.types[word_index] = self._words[keyword]
                word_span = tokens.starts[word_index], tokens.ends[word_index]
                tokens.corrections[word_span] = keyword
                del stack[3 * body + 3 :]
                return start
        return -1

    def _correct_member(self, stack: Stack, index: int) -> int:
        """Replace a token of the member that only fails later, as in ``part a :: A;``."""
        tokens = self._tokens
        start = self._find_member_start(index)
        if index - start > _MAX_CORRECTED:
            return -1
        body = self._find_body(stack[2::3])
        states = stack[2 : 3 * body + 3 : 3]
        for correction in list_corrections(tokens, start, index):
            if any(word not in self._words for word in correction.words):
                continue
            words = {word: self._words[word] for word in correction.words}
            before = tokens.types[start : correction.position]
            end = correction.position + correction.length
            after = tokens.types[end : max(index, end) + 1]
            if self._accepts_all(states, (*before, *words.values(), *after)):
                self._errors.report_correction(correction)
                tokens.forget_from(tokens.starts[start])
                tokens.replace(correction.position, correction.length, words)
                del stack[3 * body + 3 :]
                # After a note or a stereotype the next error has nothing to do with it.
                if not words and correction.position == start:
                    self._last_error = start
                return start
        return -1

    def _find_member_start(self, index: int) -> int:
        """Return the first token of the member that contains token ``index``."""
        separators = {self._words[symbol] for symbol in ";{}"} | {self._tables.types.body}
        while index > 0 and self._tokens.types[index - 1] not in separators:
            index -= 1
        return index

    def _drop_comment(self, _states: list[int], index: int) -> int:
        if self._tokens.types[index] != self._tables.types.body:
            return -1
        self._errors.report_comment(index)
        del self._tokens.types[index], self._tokens.starts[index], self._tokens.ends[index]
        # The next token has the same index now, and is a first error if it does not fit.
        self._last_error = -2
        return index

    def _substitute(self, states: list[int], index: int) -> int:
        """Take a keyword or string for a name, or one kind of `=` for another."""
        tokens, text = self._tokens, self._tokens[index]
        is_string = tokens.types[index] == self._tables.types.string
        if is_string or (text[:1].isalpha() and text in self._words):
            candidates = [self._tables.types.name]
        elif text in ("=", ":=", "=="):
            substitutes = ("=", ":=") if text == "==" else (":=", "=")
            candidates = [self._words[word] for word in substitutes if word in self._words]
        else:
            return -1
        for token_type in candidates:
            if self._accepts_all(states, (token_type, *tokens.types[index + 1 : index + 2])):
                tokens.types[index] = token_type
                # A name in typographic quotation marks is reported already.
                if is_string and text[0] == '"':
                    self._report_unexpected(states, index)
                elif not is_string:
                    self._errors.report_substitution(index, self._tables.names[token_type])
                return index
        return -1

    def _insert_semicolon(self, states: list[int], index: int) -> int:
        semicolon, types = self._words[";"], self._tokens.types
        count = self._count_beginning(index)
        if not count or not self._accepts_all(states, (semicolon, *types[index : index + count])):
            return -1
        return self._insert(semicolon, "';'", index)

    def _count_beginning(self, index: int) -> int:
        """Return how many tokens from ``index`` on must fit after an inserted `;`.

        The result is 0 if no member begins at the token or ends before it.
        """
        tokens = self._tokens
        if index == 0 or tokens[index] in ("}", ""):
            return int(index > 0)
        if self._begins_line(index):
            return 1
        # In the same line the keyword may as well be a superfluous word: `= 3 default;`.
        return 2 if tokens[index] in self._words and tokens[index].isalpha() else 0

    def _begins_line(self, index: int) -> bool:
        gap = self._tokens.text[self._tokens.ends[index - 1] : self._tokens.starts[index]]
        return "\n" in gap or "\r" in gap

    def _insert_opening_brace(self, states: list[int], index: int) -> int:
        """Insert `{` before members that are indented, if the text has a `}` too many for it."""
        if index == 0 or not self._begins_line(index) or not self._has_extra_brace():
            return -1
        start = self._find_member_start(index - 1)
        if self._find_column(index) <= self._find_column(start):
            return -1
        brace = self._words["{"]
        if not self._accepts_all(states, (brace, self._tokens.types[index])):
            return -1
        return self._insert(brace, "'{'", index)

    def _find_column(self, index: int) -> int:
        start = self._tokens.starts[index]
        return start - max(self._tokens.text.rfind(end, 0, start) for end in "\n\r")

    def _has_extra_brace(self) -> bool:
        types = self._tokens.types
        return types.count(self._words["}"]) > types.count(self._words["{"])

    def _drop_extra_brace(self, states: list[int], index: int) -> int:
        """Drop a `}` within a declaration, as in ``part x : };``, if no `{` belongs to it."""
        tokens = self._tokens
        is_within = tokens[index] == "}" and tokens.types[index + 1] == self._words[";"]
        if not is_within or not self._has_extra_brace():
            return -1
        self._report_unexpected(states, index)
        tokens.replace(index, 1, {})
        return index

    def _insert_closing_bracket(self, states: list[int], index: int) -> int:
        # Only closing brackets are inserted: an opening one could stand anywhere before.
        for symbol in ")]":
            token_type = self._words[symbol]
            if self._accepts_all(states, (token_type, self._tokens.types[index])):
                return self._insert(token_type, f"'{symbol}'", index)
        return -1

    def _insert(self, token_type: int, words: str, index: int) -> int:
        self._errors.report_missing(index, words)
        self._tokens.insert(index, token_type)
        return index

    def _skip_stray(self, states: list[int], index: int) -> int:
        """Skip a `;` or `}` between members."""
        if self._tokens[index] not in (";", "}") or self._find_body(states) < len(states) - 1:
            return -1
        self._errors.report_stray(index)
        return index + 1

    def _close_body(self, states: list[int], index: int) -> int:
        """Insert `}` where the text ends within a body."""
        brace = self._words["}"]
        if self._tokens[index] or not self._accepts(states, brace):
            return -1
        self._errors.report_unclosed()
        self._tokens.insert(index, brace)
        return index

    # -- panic mode ------------------------------------------------------------------------------

    def _panic(self, stack: Stack, index: int) -> int:
        """Skip to the end or the body of the member; parse on with as much of it as possible."""
        tokens = self._tokens
        body = self._find_body(stack[2::3])
        for stop, symbol in self._find_stops(index):
            required = ";" if symbol in ("}", "") else symbol
            top = self._find_accepting(stack, body, self._words[required])
            # A word of another language, as in 'block A;', and half a condition declare nothing.
            start = self._find_member_start(index)
            if index > 0 and (start == index - 1 or self._tokens[start] in _CONDITIONS):
                top = -1
            del stack[3 * max(top, body) + 3 :]
            self._last_error = stop
            if top >= 0:
                if required != symbol:
                    tokens.insert(stop, self._words[required])
                    self._last_error = stop + 1
                return stop
            # The head of the member is lost, but its members are still worth reading.
            if symbol == "{":
                tokens.insert(stop, self._words[_PREFIX_WITH_BODY])
                self._last_error = stop + 1
            return stop + 1 if symbol == ";" else stop
        return -1

    def _find_accepting(self, stack: Stack, body: int, token_type: int) -> int:
        """Return the highest stack position above ``body`` that accepts a token, or -1."""
        states = stack[2::3]
        for top in range(len(states) - 1, body, -1):
            if self._accepts(states[: top + 1], token_type):
                return top
        return -1

    def _find_stops(self, index: int) -> Iterator[tuple[int, str]]:
        """Yield `;`, braces and the end of the text: where a member or its head may end.

        A `;` in parentheses ends nothing, as in the loops of other languages.
        """
        closing = -1
        for position in range(index, len(self._tokens.types)):
            text = self._tokens[position]
            if text == "(" and position > closing:
                closing = self._find_closing(position)
            if text in ("{", "}") or not text or (text == ";" and position > closing):
                yield position, text

    def _find_closing(self, index: int) -> int:
        """Return the `)` of the `(` at ``index``, or ``index`` if a brace or nothing follows."""
        depth = 0
        for position in range(index, len(self._tokens.types)):
            text = self._tokens[position]
            if text in ("{", "}"):
                break
            depth += (text == "(") - (text == ")")
            if not depth:
                return position
        return index

    # -- simulation of the parser ----------------------------------------------------------------

    def _find_body(self, states: list[int]) -> int:
        """Return the stack position of the innermost body whose members are being parsed."""
        for position in range(len(states) - 1, -1, -1):
            if self._tables.item in self._tables.rows[states[position]]:
                return position
        return 0

    def _accepts(self, states: list[int], token_type: int) -> bool:
        return self._accepts_all(states, (token_type,))

    def _accepts_all(self, states: list[int], token_types: tuple[int, ...]) -> bool:
        """Whether tokens of these types can come next."""
        # The stack itself must stay as it is until a mend is chosen.
        simulated = list(states)
        return all(self._shift(simulated, token_type) for token_type in token_types)

    def _shift(self, states: list[int], token_type: int) -> bool:
        """Reduce and shift on a stack of states without values; return False for a syntax error."""
        rows, defaults = self._tables.rows, self._tables.defaults
        while True:
            step = rows[states[-1]].get(token_type, defaults[states[-1]])
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


# The first mend that applies wins, so those that change the least come first.
_MENDS = (
    Recovery._drop_comment,
    Recovery._substitute,
    Recovery._drop_extra_brace,
    Recovery._insert_opening_brace,
    Recovery._insert_semicolon,
    Recovery._insert_closing_bracket,
    Recovery._skip_stray,
    Recovery._close_body,
)
