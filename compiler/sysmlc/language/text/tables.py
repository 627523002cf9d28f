"""The parser's tables: found in the package or in the user's cache, made where they are nowhere."""

import hashlib
import marshal
from functools import cache
from operator import itemgetter
from typing import Any

from sysmlc import cache as caches
from sysmlc import resources
from sysmlc.language.text.scan import Types
from sysmlc.values import dataclass

_GRAMMARS = {
    "kerml": ("kerml-common.lark", "kerml.lark"),
    "sysml": ("kerml-common.lark", "sysml.lark"),
}


@dataclass(frozen=True, slots=True, eq=False)
class Tables:
    """What the machine runs: rows by state, defaults by state, rules.

    A row maps numbers of token types and of symbols to actions: a state to go to, or the
    complement of a rule to reduce. A rule is the number of its symbol, its length, the name of
    its function, and what takes the arguments of that from the stack.
    """

    start: int
    types: Types
    names: dict[int, str]
    rows: list[dict[int, int]]
    defaults: list[int | None]
    rules: list[tuple[int, int, str, Any]]


def grammar(language: str) -> str:
    """The text of a language's grammar: ``kerml`` or ``sysml``."""
    return "\n".join(resources.text("grammars", name) for name in _GRAMMARS[language])


def digest(language: str) -> str:
    """What the tables of a language depend on."""
    return hashlib.sha256(grammar(language).encode()).hexdigest()


@cache
def load(language: str) -> Tables:
    """The tables of a language."""
    return _opened(marshal.loads(_bytes(language)))


def _bytes(language: str) -> bytes:
    key = digest(language)
    store = caches.default()
    found = store.get(key) if store else None
    if found is None:
        from sysmlc.language.text.generate import tables

        found = tables(grammar(language))
        if store:
            store.put(key, found)
    return found


def _opened(raw: dict[str, Any]) -> Tables:
    types = raw["types"]
    numbers = (types["NAME"], types["STRING"], types["NUMBER"], types["BODY"], types["$END"])
    names = {number: repr(text) for text, number in raw["words"].items()}
    return Tables(
        raw["start"],
        Types(raw["words"], *numbers),
        names | {number: name for name, number in types.items() if number not in names},
        raw["rows"],
        raw["defaults"],
        [_rule(*rule) for rule in raw["rules"]],
    )


def _rule(symbol: int, length: int, name: str, places: tuple[int, ...]) -> Any:
    return symbol, length, name, itemgetter(1 - 3 * length, *(places or (0,)))
