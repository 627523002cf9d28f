"""LALR(1) tables, read from the package or generated, and the parser that runs them."""

import hashlib
import marshal
from collections.abc import Mapping
from contextlib import suppress
from functools import cache
from operator import itemgetter
from pathlib import Path
from typing import Any

from msgspec import Struct

from sysmlc.language.text.lexer import Action, Tokens, TokenTypes
from sysmlc.language.text.table_generator import ACCEPT, generate_tables
from sysmlc.support import resources
from sysmlc.support.atomic_files import write as write_file

SHIPPED = Path(__file__).with_name("generated")
"""Folder of the tables, which are generated when the package is built or installed."""
_GRAMMARS = {
    "kerml": ("kerml-common.lark", "kerml.lark"),
    "sysml": ("kerml-common.lark", "sysml.lark"),
}

TableRule = tuple[int, int, str, "itemgetter[Any]"]


class Tables(Struct, frozen=True, eq=False):
    """Tables of an LALR(1) parser: a row and a default action for each state, and the rules.

    A row maps the numbers of token types and of symbols to actions: the next state, or the
    complement (``~``) of the number of a rule to reduce. A rule has the number of its symbol, its
    length, the name of its build action, and a getter for the arguments of the action on the stack.
    ``start`` is the start state, ``item`` the symbol of a member, ``index`` the token type of a
    bracket in an expression.
    """

    start: int
    item: int
    index: int
    types: TokenTypes
    names: dict[int, str]
    rows: list[dict[int, int]]
    defaults: list[int | None]
    rules: list[TableRule]


def read_grammar(language: str) -> str:
    """Return the text of the grammar of a language: ``kerml`` or ``sysml``."""
    return "\n".join(resources.read_text("grammars", name) for name in _GRAMMARS[language])


def compute_digest(language: str) -> bytes:
    """Return the digest of everything that the tables of a language depend on."""
    generator = Path(__file__).with_name("table_generator.py").read_bytes()
    return hashlib.sha256(read_grammar(language).encode() + generator).digest()


def write_tables(language: str, folder: Path) -> Path:
    """Generate the tables of a language, write them into a folder, and return the path."""
    return _store(language, folder, generate_tables(read_grammar(language)))


@cache
def load_tables(language: str) -> Tables:
    """Return the tables of a language.

    A checkout whose grammar was edited has stale tables. They are generated once, beside the code
    that reads them: never in the cache, because these tables are code.
    """
    data = _read_shipped(language)
    if data is None:
        data = _generate(language)
    return _decode(marshal.loads(data))


def _read_shipped(language: str) -> bytes | None:
    """Return the tables that came with the package, or None if they are absent or stale."""
    try:
        data = (SHIPPED / f"{language}.tables").read_bytes()
    except OSError:
        return None
    expected = compute_digest(language)
    return data[len(expected) :] if data.startswith(expected) else None


def _generate(language: str) -> bytes:
    """Generate the tables, and store them in the package unless its folder is read-only."""
    data = generate_tables(read_grammar(language))
    # A package in a read-only folder works all the same, only slower.
    with suppress(OSError):
        _store(language, SHIPPED, data)
    return data


def _store(language: str, folder: Path, data: bytes) -> Path:
    folder.mkdir(exist_ok=True)
    path = folder / f"{language}.tables"
    write_file(path, compute_digest(language) + data)
    return path


def _decode(raw: dict[str, Any]) -> Tables:
    types = raw["types"]
    numbers = (types["NAME"], types["STRING"], types["NUMBER"], types["BODY"], types["$END"])
    names = {number: text for text, number in raw["words"].items()}
    return Tables(
        raw["start"],
        raw["item"],
        types["_INDEX"],
        TokenTypes(raw["words"], *numbers),
        names | {number: name for name, number in types.items() if number not in names},
        raw["rows"],
        raw["defaults"],
        [_decode_rule(*rule) for rule in raw["rules"]],
    )


def _decode_rule(symbol: int, length: int, name: str, positions: tuple[int, ...]) -> TableRule:
    # A single position as a slice: the getter returns a sequence for any number of positions.
    if len(positions) < 2:
        first = positions[0] if positions else 0
        return symbol, length, name, itemgetter(slice(first, first + len(positions)))
    return symbol, length, name, itemgetter(*positions)


Stack = list[Any]
"""None, then three entries for each symbol: value, index of its first token, next state."""
Rules = list[tuple[int, int, Any, Action | None]]


def bind_actions(tables: Tables, actions: Mapping[str, Action]) -> Rules:
    """Return the rules with their build actions; a rule without a name passes its value on."""
    return [
        (symbol, 3 * length, getter, actions[name] if name else None)
        for symbol, length, name, getter in tables.rules
    ]


def run(tables: Tables, rules: Rules, tokens: Tokens, stack: Stack, index: int) -> int:
    """Shift and reduce from token ``index`` on; return the index of the first that does not fit.

    The result is -1 at the end of the text, where ``stack[-3]`` has the value of the whole text. A
    build action is called with the tokens, whose ``begin`` and ``stop`` are the span of the rule,
    and the values of its arguments. An absent argument is None.
    """
    rows, defaults, types = tables.rows, tables.defaults, tokens.types
    state, token_type = stack[-1], types[index]
    while True:
        step = rows[state].get(token_type)
        # A state with one possible reduction has it as default, without looking at the token.
        if step is None:
            step = defaults[state]
            if step is None:
                return index
        if step >= 0:
            # The inner loop of the parser: one list holds all three entries of a symbol.
            stack += (index, index, step)
            state = step
            index += 1
            token_type = types[index]
        elif step != ACCEPT:
            symbol, size, getter, action = rules[~step]
            if action is None:
                state = stack[-1] = rows[stack[-4]][symbol]
            else:
                begin = stack[1 - size]
                tokens.begin, tokens.stop = begin, index
                value = action(tokens, *getter(stack))
                del stack[-size:]
                state = rows[stack[-1]][symbol]
                stack += (value, begin, state)
        else:
            return -1
