"""Who asks for which values: recorded for those that are words of a text."""

from collections.abc import ItemsView, Iterator, ValuesView
from contextlib import contextmanager
from typing import TYPE_CHECKING, Never

from sysmlc.ir.element import AttrValue, Element
from sysmlc.values import dataclass

if TYPE_CHECKING:
    from sysmlc.ir.graph import Graph

Value = tuple[str, str]
"""An attribute: the id of its element, and its name."""


@dataclass(frozen=True, slots=True)
class Literal:
    """An attribute that a file says word for word.

    ``form`` says, for the front end, how it becomes the value; each number in it is the character
    of the file at which a literal starts.
    """

    file: str
    form: AttrValue
    id: str
    key: str


class Reads:
    """Which attributes are words of a text, and who asked for them.

    ``reader`` is who asks at present; it may be followed by a part of its work, as a blank and
    the id of the element that it is about. What was asked for once is not told again.
    """

    def __init__(self) -> None:
        self.reader = ""
        self.literals: list[Literal] = []
        self.asked: set[tuple[str, int]] = set()
        """Literals, by file and place, that mean more than attributes."""
        self.readers: dict[Value, dict[str, None]] = {}
        self.rewritten: set[Value] = set()
        """Attributes that somebody set again, so that they are no words of a text any more."""
        self.stored: dict[str, dict[str, None]] = {}
        self.used: dict[str, dict[str, None]] = {}
        """Who kept derived values, and who asked for them, by the module of their type."""
        self.latest: dict[tuple[Value, str], None] = {}
        """Who asked for which attribute, since someone began to listen here."""

    def watch(self, element: Element, literal: Literal) -> None:
        """From now on, note who asks for the attribute."""
        if not isinstance(element.attrs, Watched):
            element.attrs = Watched(element.attrs, element.id, self)
        element.attrs.watch(literal.key)
        self.literals.append(literal)
        self.readers.setdefault((literal.id, literal.key), {})

    def store(self, module: str) -> None:
        """Derived values of a type of this module were kept."""
        self.stored.setdefault(module, {})[self.reader] = None

    def use(self, module: str) -> None:
        """Somebody asked for derived values of a type of this module, or whether there are any."""
        self.used.setdefault(module, {})[self.reader] = None

    @contextmanager
    def part(self, about: str) -> Iterator[None]:
        """Someone's work on one element, which can be done again without the rest."""
        whole = self.reader
        self.reader = f"{whole} {about}"
        try:
            yield
        finally:
            self.reader = whole


class Watched(dict[str, AttrValue]):
    """Attributes of an element some of which are watched. Who asks for all asks for each.

    Which attributes there are is no secret: literals are values, not keys.
    """

    __slots__ = ("_id", "_keys", "_reads")

    def __init__(self, attrs: dict[str, AttrValue], id: str, reads: Reads) -> None:
        super().__init__(attrs)
        self._id = id
        self._keys: dict[str, None] = {}
        self._reads = reads

    def watch(self, key: str) -> None:
        """Note who asks for this one."""
        self._keys[key] = None

    def _note(self, *keys: str) -> None:
        for key in keys:
            if key in self._keys:
                value, reads = (self._id, key), self._reads
                reads.readers.setdefault(value, {})[reads.reader] = None
                reads.latest[value, reads.reader] = None

    def _set(self, *keys: str) -> None:
        self._reads.rewritten.update((self._id, key) for key in keys if key in self._keys)

    def plain(self) -> dict[str, AttrValue]:
        """The attributes, without a note that somebody asked."""
        return dict(dict.items(self))

    # Most values are no words of a text: a call of ``_note`` for each would double the time.
    def __getitem__(self, key: str) -> AttrValue:
        if key in self._keys:
            self._note(key)
        return super().__getitem__(key)

    def get(self, key: str, default: AttrValue = None) -> AttrValue:  # type: ignore[override]
        if key in self._keys:
            self._note(key)
        return super().get(key, default)

    def __iter__(self) -> Iterator[str]:
        # With this method of its own, ``dict(attrs)`` asks for the values one by one.
        return super().__iter__()

    def values(self) -> ValuesView[AttrValue]:  # type: ignore[override]
        self._note(*self._keys)
        return super().values()

    def items(self) -> ItemsView[str, AttrValue]:  # type: ignore[override]
        self._note(*self._keys)
        return super().items()

    def copy(self) -> dict[str, AttrValue]:
        self._note(*self._keys)
        return self.plain()

    def __eq__(self, other: object) -> bool:
        self._note(*self._keys)
        return super().__eq__(other)

    def __ne__(self, other: object) -> bool:
        self._note(*self._keys)
        return super().__ne__(other)

    def __or__(self, other: dict[str, AttrValue]) -> dict[str, AttrValue]:  # type: ignore[override]
        return self.copy() | other

    def __ror__(self, other: dict[str, AttrValue]) -> dict[str, AttrValue]:  # type: ignore[override]
        return other | self.copy()

    def __repr__(self) -> str:
        self._note(*self._keys)
        return super().__repr__()

    def __reduce__(self) -> Never:
        raise TypeError("watched attributes are not copied")

    def __setitem__(self, key: str, value: AttrValue) -> None:
        self._set(key)
        super().__setitem__(key, value)

    def __delitem__(self, key: str) -> None:
        self._set(key)
        super().__delitem__(key)

    def __ior__(self, other: dict[str, AttrValue]) -> "Watched":  # type: ignore[override]
        self.update(other)
        return self

    def update(self, *given: dict[str, AttrValue], **more: AttrValue) -> None:  # type: ignore[override]
        for key, value in dict(*given, **more).items():
            self[key] = value

    def setdefault(self, key: str, default: AttrValue = None) -> AttrValue:  # type: ignore[override]
        self._note(key)
        self._set(key)
        return super().setdefault(key, default)

    def pop(self, key: str, *default: AttrValue) -> AttrValue:  # type: ignore[override]
        self._note(key)
        self._set(key)
        return super().pop(key, *default)

    def popitem(self) -> tuple[str, AttrValue]:
        self._note(*self._keys)
        self._set(*self._keys)
        return super().popitem()

    def clear(self) -> None:
        self._set(*self._keys)
        super().clear()


def unnoted(element: Element, key: str) -> AttrValue:
    """An attribute for who asks only for what no literal in it says, such as names."""
    return dict.get(element.attrs, key)


@contextmanager
def during(graph: "Graph", about: str) -> Iterator[None]:
    """Someone's work on one element of the graph; see ``Reads.part``."""
    if graph.reads is None:
        yield
        return
    with graph.reads.part(about):
        yield
