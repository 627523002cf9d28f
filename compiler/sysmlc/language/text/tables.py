"""The parser's tables: read from the package, or generated where the package has none."""

import hashlib
import marshal
from contextlib import suppress
from functools import cache
from operator import itemgetter
from pathlib import Path
from typing import Any

from msgspec import Struct

from sysmlc.language.text.scan import Types
from sysmlc.support import resources
from sysmlc.support.atomic_files import write as write_file

SHIPPED = Path(__file__).with_name("generated")
"""Folder of the tables that are made when the package is built or installed."""
_GRAMMARS = {
    "kerml": ("kerml-common.lark", "kerml.lark"),
    "sysml": ("kerml-common.lark", "sysml.lark"),
}


TableRule = tuple[int, int, str, "itemgetter[Any]"]


class Tables(Struct, frozen=True, eq=False):
    """What the machine runs: rows by state, defaults by state, rules.

    A row maps numbers of token types and of symbols to actions: a state to go to, or the
    complement of a rule to reduce. A rule is the number of its symbol, its length, the name of
    its function, and what takes the arguments of that from the stack.
    """

    start: int
    item: int
    index: int
    types: Types
    names: dict[int, str]
    rows: list[dict[int, int]]
    defaults: list[int | None]
    rules: list[TableRule]


def grammar(language: str) -> str:
    """The text of a language's grammar: ``kerml`` or ``sysml``."""
    return "\n".join(resources.read_text("grammars", name) for name in _GRAMMARS[language])


def digest(language: str) -> bytes:
    """What the tables of a language are made of: its grammar and what makes them."""
    maker = Path(__file__).with_name("generate.py").read_bytes()
    return hashlib.sha256(grammar(language).encode() + maker).digest()


def write(language: str, folder: Path) -> Path:
    """Generate the tables of a language and write them into a folder of the package."""
    from sysmlc.language.text.generate import tables

    return _store(language, folder, tables(grammar(language)))


@cache
def load(language: str) -> Tables:
    """Return the tables of a language.

    A checkout whose grammar was edited has stale tables. They are generated once, beside the code
    that reads them: never in the cache, because these tables are code.
    """
    data = _shipped(language)
    if data is None:
        data = _generate(language)
    return _opened(marshal.loads(data))


def _shipped(language: str) -> bytes | None:
    """The tables that came with the package, if they are those of its grammar."""
    try:
        data = (SHIPPED / f"{language}.tables").read_bytes()
    except OSError:
        return None
    wanted = digest(language)
    return data[len(wanted) :] if data.startswith(wanted) else None


def _generate(language: str) -> bytes:
    """Generate the tables, and store them in the package unless its folder is read-only."""
    from sysmlc.language.text.generate import tables

    data = tables(grammar(language))
    with suppress(OSError):
        _store(language, SHIPPED, data)
    return data


def _store(language: str, folder: Path, data: bytes) -> Path:
    folder.mkdir(exist_ok=True)
    path = folder / f"{language}.tables"
    write_file(path, digest(language) + data)
    return path


def _opened(raw: dict[str, Any]) -> Tables:
    types = raw["types"]
    numbers = (types["NAME"], types["STRING"], types["NUMBER"], types["BODY"], types["$END"])
    names = {number: text for text, number in raw["words"].items()}
    return Tables(
        raw["start"],
        raw["item"],
        types["_INDEX"],
        Types(raw["words"], *numbers),
        names | {number: name for name, number in types.items() if number not in names},
        raw["rows"],
        raw["defaults"],
        [_rule(*rule) for rule in raw["rules"]],
    )


def _rule(symbol: int, length: int, name: str, places: tuple[int, ...]) -> TableRule:
    return symbol, length, name, itemgetter(1 - 3 * length, *(places or (0,)))
