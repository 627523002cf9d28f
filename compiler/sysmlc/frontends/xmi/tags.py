"""Start tags as they are written: what those that differ in values only have in common, once."""

import re
from typing import NamedTuple, TypeVar

from sysmlc.frontends.xmi import namespaces
from sysmlc.frontends.xmi.columns import SPECIAL
from sysmlc.frontends.xmi.makers import Maker, maker
from sysmlc.frontends.xmi.prefixes import Prefixes

Kind = tuple[str, str, tuple[str, ...]]
"""What tags have in common: full name, type as written, full names of the other attributes."""

_K = TypeVar("_K")
_V = TypeVar("_V")

_REMEMBERED = 1 << 14
"""So many tags are remembered: a file whose tags all differ must not fill the memory."""
_NAME = r"[A-Za-z_][A-Za-z0-9_.-]*(?::[A-Za-z_][A-Za-z0-9_.-]*)?"
_TAG = re.compile(
    rf'({_NAME})((?:[ \t\n]+{_NAME}[ \t\n]*=[ \t\n]*"[^"]*")*)[ \t\n]*(/?)>(.*)', re.DOTALL
)
"""Tags that are well-formed beyond doubt, if no attribute comes twice, and the text behind."""
_ATTRIBUTE = re.compile(r'([^\s="]+)\s*=\s*"[^"]*"')
_VALUE = re.compile(r'"[^"]*"')
_DECLARATION = "xmlns"


class NotPlainError(Exception):
    """The file says what this way of reading does not know."""


class Tag(NamedTuple):
    """A tag cut at its quotes: values are the pieces with odd numbers."""

    name: str
    """As it is written."""
    is_empty: bool
    attributes: Maker
    """Makes them but for the type."""
    type_at: int
    """Number of the piece that is the type; 0 without one."""
    kinds: "_Numbers"
    """Numbers of the kinds of rows with this tag, by type."""
    signs: int
    """Line ends and tabs outside values, and quotes; without those of text behind it."""


class Tags:
    """The start tags of one file. ``kinds`` are those of its rows; the root has the first."""

    def __init__(self, prefixes: Prefixes, root: str, values: dict[str, str]) -> None:
        """Takes the root's full name and attributes. Raises NotPlainError."""
        spaces = [uri for uri in prefixes.declared.values() if namespaces.is_xmi(uri)]
        if len(spaces) != 1:
            raise NotPlainError
        self.xmi = spaces[0]
        self._type_key = f"{self.xmi}}}type"
        self.kinds: list[Kind] = []
        self.known: dict[tuple[str, ...], Tag] = {}
        """Tags with white space behind them, by all of it that is not in quotes."""
        self._bare: dict[tuple[str, ...], Tag] = {}
        self._numbers: dict[tuple[str, tuple[str, ...]], _Numbers] = {}
        self._prefixes = prefixes
        type_name = values.pop(self._type_key, "")
        self._of_kind(root, tuple(values))[type_name]

    def read(self, piece: str, parts: list[str]) -> tuple[Tag, str]:
        """What a piece that is not known says, and the text behind its tag, if there is any.

        ``parts`` are the piece, cut at quotes. Raises NotPlainError and IrregularError.
        """
        last, sign, text = parts[-1].partition(">")
        key = (*parts[:-1:2], last + sign)
        tag = self._bare.get(key) if len(parts) % 2 else None
        if tag is None:
            tag, text = self._parsed(piece)
            if '"' in text:
                return tag, text
            _remember(self._bare, key, tag)
        if text and not text.isspace():
            return tag, text
        tag = tag._replace(signs=tag.signs + signs_in(text))
        _remember(self.known, tuple(parts[::2]), tag)
        return tag, ""

    def _parsed(self, piece: str) -> tuple[Tag, str]:
        found = _TAG.fullmatch(piece)
        if found is None or found[1] in SPECIAL:
            raise NotPlainError
        name, attributes, sign, text = found.groups()
        written = _ATTRIBUTE.findall(attributes)
        if len(set(written)) < len(written) or any(map(_declares, written)):
            raise NotPlainError
        full = [self._prefixes.full(one) for one in written]
        places = {one: 2 * number + 1 for number, one in enumerate(full)}
        type_at = places.pop(self._type_key, 0)
        names = tuple(places)
        kinds = self._of_kind(self._prefixes.full(name), names)
        signs = signs_in(_VALUE.sub('""', piece[: found.start(4)]))
        made = maker(names, (*places.values(),))
        return Tag(name, bool(sign), made, type_at, kinds, signs), text

    def _of_kind(self, tag: str, names: tuple[str, ...]) -> "_Numbers":
        known = self._numbers.get((tag, names))
        if known is None:
            known = self._numbers[tag, names] = _Numbers(self.kinds, tag, names)
        return known


class _Numbers(dict[str, int]):
    """Numbers of the kinds of one tag by type."""

    def __init__(self, kinds: list[Kind], tag: str, names: tuple[str, ...]) -> None:
        super().__init__()
        self._kinds, self._tag, self._names = kinds, tag, names

    def __missing__(self, written: str) -> int:
        self[written] = number = len(self._kinds)
        self._kinds.append((self._tag, written, self._names))
        return number


def _declares(name: str) -> bool:
    return name == _DECLARATION or name.startswith(f"{_DECLARATION}:")


def signs_in(text: str) -> int:
    """How many signs there are that mean something else in the value of an attribute."""
    return text.count("\n") + text.count("\t") + text.count('"')


def _remember(known: dict[_K, _V], key: _K, value: _V) -> None:
    if len(known) >= _REMEMBERED:
        known.clear()
    known[key] = value
