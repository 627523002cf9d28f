"""The parser proper: tokens are shifted, rules reduced; each reduction builds a part."""

from collections.abc import Callable, Mapping
from typing import Any

from sysmlc.language.text.generate import ACCEPT
from sysmlc.language.text.scan import Tokens
from sysmlc.language.text.tables import Tables

Action = Callable[..., Any]
Stack = list[Any]
"""None, then three entries for each symbol: its value, its first token, the state after it."""
Rules = list[tuple[int, int, Any, Action | None]]


def rules(tables: Tables, actions: Mapping[str, Action]) -> Rules:
    """The rules with their functions; a rule without a name passes its value on."""
    return [
        (symbol, 3 * length, getter, actions[name] if name else None)
        for symbol, length, name, getter in tables.rules
    ]


def run(tables: Tables, rules: Rules, tokens: Tokens, stack: Stack, at: int) -> int:
    """Shift and reduce from token ``at`` on; the number of the token that does not fit.

    That is -1 at the end: ``stack[-3]`` has the value of the whole text then. An action is
    called with the tokens, the number of the token after what it reduces, the number of the
    first one of that, and the values of its arguments; what is absent is None.
    """
    rows, defaults, types = tables.rows, tables.defaults, tokens.types
    state, kind = stack[-1], types[at]
    while True:
        step = rows[state].get(kind)
        if step is None:
            step = defaults[state]
            if step is None:
                return at
        if step >= 0:
            stack += (at, at, step)
            state = step
            at += 1
            kind = types[at]
        elif step != ACCEPT:
            symbol, size, getter, action = rules[~step]
            if action is None:
                state = stack[-1] = rows[stack[-4]][symbol]
            else:
                got = getter(stack)
                value = action(tokens, at, *got)
                del stack[-size:]
                state = rows[stack[-1]][symbol]
                stack += (value, got[0], state)
        else:
            return -1
