"""The grammars become tables of an LALR(1) parser, in a form that loads in milliseconds.

Lark builds the tables; nothing of it is needed to use them. This module is run when the package
is built, and at most once by a user of a checkout.
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
"""The action that ends the run."""

_PLAIN = 2
"""Version of the form that has no shared references, so that equal tables have equal bytes."""

Row = dict[int, int]
Form = tuple[int, int, str, tuple[int, ...]]


def tables(grammar: str) -> bytes:
    """The tables of a grammar, marshalled; see ``sysmlc.language.text.tables`` for their form.

    Raises ``lark.exceptions.GrammarError`` where the grammar is not LALR(1).
    """
    from lark import Lark
    from lark.lexer import Lexer, Token

    class Nothing(Lexer):
        def __init__(self, _conf: object) -> None: ...

        def lex(self, *_arguments: object) -> Iterator[Token]:
            return iter(())

    lark = Lark(grammar, parser="lalr", lexer=Nothing, maybe_placeholders=True)
    table = lark.parser.parser._parse_table
    return marshal.dumps(_compact(table, lark.terminals), _PLAIN)


def _compact(table: "Table", terminals: "Collection[TerminalDef]") -> dict[str, object]:
    texts = {term.name: str(term.pattern.value) for term in terminals if term.pattern is not None}
    states = _ordered(table)
    rules = _rules(table, states)
    names = sorted(
        {str(name) for row in table.states.values() for name in row}
        - {r.origin.name for r in rules}
    )
    numbers = {name: number for number, name in enumerate(names, 1)}
    for rule in rules:
        numbers.setdefault(rule.origin.name, len(numbers) + 1)
    order = {rule: number for number, rule in enumerate(rules)}
    rows, defaults = _rows(table, states, numbers, order)
    forms = [_form(rule, numbers) for rule in rules]
    _skip_units(rows, defaults, forms)
    return {
        "item": numbers["item"],
        "start": 0,
        "types": {name: numbers[name] for name in names},
        "words": {texts[name]: numbers[name] for name in names if name in texts},
        "rows": rows,
        "defaults": defaults,
        "rules": forms,
    }


def _ordered(table: "Table") -> list[int]:
    """The states in an order that only the grammar decides: as they are reached, by names."""
    found = dict.fromkeys([table.start_states["start"]])
    waiting = list(found)
    while waiting:
        reached = []
        for _, (action, target) in sorted(table.states[waiting.pop(0)].items(), key=_name):
            if action.name == "Shift" and target not in found:
                found[target] = None
                reached.append(target)
        waiting += reached
    return list(found)


def _name(item: "tuple[str, object]") -> str:
    return str(item[0])


def _rules(table: "Table", states: list[int]) -> "list[Rule]":
    found: dict[Rule, None] = {}
    for state in states:
        for _, (action, argument) in sorted(table.states[state].items(), key=_name):
            if action.name == "Reduce":
                found.setdefault(argument)
    return list(found)


def _rows(
    table: "Table", states: list[int], numbers: Mapping[str, int], order: "Mapping[Rule, int]"
) -> tuple[list[Row], list[int | None]]:
    rows, defaults = [], []
    renumbered = {state: number for number, state in enumerate(states)}
    for state in states:
        made = {
            numbers[name]: renumbered[argument] if action.name == "Shift" else ~order[argument]
            for name, (action, argument) in sorted(table.states[state].items(), key=_name)
        }
        only = set(made.values())
        default = only.pop() if len(only) == 1 and max(only) < 0 else None
        if default is not None:
            made = {}
        if state == table.end_states["start"]:
            made[numbers["$END"]] = ACCEPT
        rows.append(made)
        defaults.append(default)
    return rows, defaults


def _form(rule: "Rule", numbers: Mapping[str, int]) -> Form:
    """Number of its symbol, length, name of its function, places of its arguments on the stack.

    The stack has three entries for each symbol: value, number of the first token, state; its
    very first entry is None, which stands for what is absent.
    """
    length = len(rule.expansion)
    places = _places(rule)
    plain = rule.alias is None and length == 1 and len(places) == 1
    name = "" if plain else str(rule.alias or rule.origin.name)
    return numbers[rule.origin.name], length, name, places


def _places(rule: "Rule") -> tuple[int, ...]:
    length = len(rule.expansion)
    gaps = [False] * length if not rule.options.empty_indices else rule.options.empty_indices
    places, index = [], 0
    for absent in gaps:
        if absent:
            places.append(0)
            continue
        symbol = rule.expansion[index]
        if rule.options.keep_all_tokens or not getattr(symbol, "filter_out", False):
            places.append(-3 * (length - index))
        index += 1
    return tuple(places)


def _skip_units(rows: list[Row], defaults: list[int | None], forms: list[Form]) -> None:
    """Where a state can only reduce a rule that passes one value on, go on to what follows it."""
    left = {
        state: forms[~default][0]
        for state, default in enumerate(defaults)
        if default is not None and not rows[state] and not forms[~default][2]
    }
    for row in rows:
        for key, action in row.items():
            target = action
            while target in left:
                target = row[left[target]]
            row[key] = target
