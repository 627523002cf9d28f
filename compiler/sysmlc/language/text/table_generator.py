"""Generator of LALR(1) tables from the grammars, in a form that loads in milliseconds.

Lark computes the tables and is not needed to use them. This module runs when the package is built,
and at most once for the user of a checkout.
"""

import marshal
from collections.abc import Collection, Iterator, Mapping
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from lark.grammar import Rule
    from lark.lexer import TerminalDef
    from lark.parsers.lalr_analysis import ParseTableBase

    Table = ParseTableBase[int]

ACCEPT = -1_000_000
"""The action that ends the parse."""

_MARSHAL_VERSION = 2
"""Version 2 has no shared references, so equal tables have equal bytes."""

Row = dict[int, int]
EncodedRule = tuple[int, int, str, tuple[int, ...]]


def generate_tables(grammar: str) -> bytes:
    """Return the marshalled tables of a grammar, in the form that ``lalr.Tables`` describes.

    Raises ``lark.exceptions.GrammarError`` if the grammar is not LALR(1).
    """
    # Lark takes 50 ms to import, and is needed only where tables are generated.
    from lark import Lark
    from lark.lexer import Lexer, Token

    # Lark asks for a lexer that knows the terminals; tokens come from our own.
    class NoLexer(Lexer):
        def __init__(self, _conf: object) -> None: ...

        def lex(self, *_arguments: object) -> Iterator[Token]:
            return iter(())

    lark = Lark(grammar, parser="lalr", lexer=NoLexer, maybe_placeholders=True)
    table = lark.parser.parser._parse_table
    return marshal.dumps(_encode(table, lark.terminals), _MARSHAL_VERSION)


def _encode(table: "Table", terminals: "Collection[TerminalDef]") -> dict[str, object]:
    texts = {term.name: str(term.pattern.value) for term in terminals if term.pattern is not None}
    states = _order_states(table)
    rules = _order_rules(table, states)
    names = sorted(
        {str(name) for row in table.states.values() for name in row}
        - {r.origin.name for r in rules}
    )
    numbers = {name: number for number, name in enumerate(names, 1)}
    for rule in rules:
        numbers.setdefault(rule.origin.name, len(numbers) + 1)
    order = {rule: number for number, rule in enumerate(rules)}
    rows, defaults = _encode_rows(table, states, numbers, order)
    encoded_rules = [_encode_rule(rule, numbers) for rule in rules]
    _skip_unit_reductions(rows, defaults, encoded_rules)
    return {
        "item": numbers["item"],
        "start": 0,
        "types": {name: numbers[name] for name in names},
        "words": {texts[name]: numbers[name] for name in names if name in texts},
        "rows": rows,
        "defaults": defaults,
        "rules": encoded_rules,
    }


def _order_states(table: "Table") -> list[int]:
    """Return the states in breadth-first order by symbol names, which only the grammar decides."""
    states = dict.fromkeys([table.start_states["start"]])
    waiting = list(states)
    while waiting:
        reached = []
        for _, (action, target) in sorted(table.states[waiting.pop(0)].items(), key=_symbol_name):
            if action.name == "Shift" and target not in states:
                states[target] = None
                reached.append(target)
        waiting += reached
    return list(states)


def _symbol_name(item: "tuple[str, object]") -> str:
    return str(item[0])


def _order_rules(table: "Table", states: list[int]) -> "list[Rule]":
    rules: dict[Rule, None] = {}
    for state in states:
        for _, (action, argument) in sorted(table.states[state].items(), key=_symbol_name):
            if action.name == "Reduce":
                rules.setdefault(argument)
    return list(rules)


def _encode_rows(
    table: "Table", states: list[int], numbers: Mapping[str, int], order: "Mapping[Rule, int]"
) -> tuple[list[Row], list[int | None]]:
    rows, defaults = [], []
    renumbered = {state: number for number, state in enumerate(states)}
    for state in states:
        row = {
            numbers[name]: renumbered[argument] if action.name == "Shift" else ~order[argument]
            for name, (action, argument) in sorted(table.states[state].items(), key=_symbol_name)
        }
        actions = set(row.values())
        default = actions.pop() if len(actions) == 1 and max(actions) < 0 else None
        if default is not None:
            row = {}
        if state == table.end_states["start"]:
            row[numbers["$END"]] = ACCEPT
        rows.append(row)
        defaults.append(default)
    return rows, defaults


def _encode_rule(rule: "Rule", numbers: Mapping[str, int]) -> EncodedRule:
    """Return the number of the symbol, the length, the action and the argument positions of a rule.

    The stack has three entries for each symbol: value, index of the first token, state. Its very
    first entry is None, which serves as the value of an absent argument.
    """
    length = len(rule.expansion)
    positions = _find_argument_positions(rule)
    is_unit = rule.alias is None and length == 1 and len(positions) == 1
    name = "" if is_unit else str(rule.alias or rule.origin.name)
    return numbers[rule.origin.name], length, name, positions


def _find_argument_positions(rule: "Rule") -> tuple[int, ...]:
    length = len(rule.expansion)
    gaps = [False] * length if not rule.options.empty_indices else rule.options.empty_indices
    positions, index = [], 0
    # Lark removes absent optional symbols from the expansion and marks them in empty_indices.
    for absent in gaps:
        if absent:
            positions.append(0)
            continue
        symbol = rule.expansion[index]
        if rule.options.keep_all_tokens or not getattr(symbol, "filter_out", False):
            positions.append(-3 * (length - index))
        index += 1
    return tuple(positions)


def _skip_unit_reductions(
    rows: list[Row], defaults: list[int | None], forms: list[EncodedRule]
) -> None:
    """Bypass states that only reduce a unit rule: a step into one becomes the step after it."""
    symbols = {
        state: forms[~default][0]
        for state, default in enumerate(defaults)
        if default is not None and not rows[state] and not forms[~default][2]
    }
    for row in rows:
        for key, action in row.items():
            target = action
            while target in symbols:
                target = row[symbols[target]]
            row[key] = target
