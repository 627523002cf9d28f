"""Attributes that are literals of the text, word for word, and literals that mean more."""

from collections.abc import Callable, ItemsView, Iterator, KeysView, Sequence, ValuesView
from collections.abc import Set as AbstractSet
from typing import TYPE_CHECKING

from sysmlc.frontends.sysml.forms import BODIES, KINDS, body, form, has_literal, value
from sysmlc.ir import AttrValue, Element, Graph
from sysmlc.ir.reads import Literal, Reads, Watched
from sysmlc.language.text.words import last
from sysmlc.language.tree import Document, Fact, Node

if TYPE_CHECKING:
    from sysmlc.frontends.sysml.lowering import Lowering

Place = tuple[str, int]
"""A file, and the character at which a literal starts."""


class Literals:
    """Which attributes literals of the text were given to, and which literals others asked for.

    A literal that names, checks or the lowering asked for may mean anything; who only gives it
    to an attribute asks ``unnoted``. What was asked for in a tree that is kept counts as asked for,
    as who asked remembers the answer: ``asked`` are the places then.
    """

    def __init__(
        self, documents: Sequence[Document] = (), asked: AbstractSet[Place] = frozenset()
    ) -> None:
        self._values: dict[Place, AttrValue] = {}
        self._asked: set[Place] = set()
        self._were_asked = asked
        self._is_noted = True
        self._files = {id(one.root) for one in documents}
        for document in documents:
            for node in document.root.walk():
                if node.kind in KINDS:
                    self._watch(node, (document.path, node.start), "value")
                elif node.kind in BODIES:
                    at = last(document.text, node.start, node.end)
                    self._watch(node, (document.path, at), "body")

    def _watch(self, node: Node, place: Place, fact: str) -> None:
        found = node.facts.get(fact)
        if found is not None:
            self._values[place] = found
            if isinstance(node.facts, Facts) and node.facts.place in self._were_asked:
                self.note(place)
            node.facts = Facts(node.facts, place, self)

    def note(self, place: Place) -> None:
        """Somebody asked for a literal."""
        if self._is_noted:
            self._asked.add(place)

    def unnoted(self) -> "Literals":
        """Literals that are asked for in this context are only given to an attribute."""
        return self

    def __enter__(self) -> None:
        self._is_noted = False

    def __exit__(self, *raised: object) -> None:
        self._is_noted = True

    def give(
        self,
        low: "Lowering",
        element: Element,
        key: str,
        node: Node,
        how: Callable[[Node], AttrValue] = form,
    ) -> None:
        """An attribute was set to what an expression is, which literals of it decide.

        ``how`` gives the form in which they do.
        """
        document, reads = low.document(node), low.graph.reads
        if reads is None or document is None or id(document.root) not in self._files:
            return
        if not has_literal(node):
            return
        with self.unnoted():
            found = how(node)
        self._give(reads, document, element, key, node, found)

    def give_body(self, low: "Lowering", element: Element, node: Node) -> None:
        """The attribute ``body`` was set to what a comment says."""
        document, reads = low.document(node), low.graph.reads
        if reads is not None and isinstance(node.facts, Facts) and document is not None:
            self._give(reads, document, element, "body", node, body(node.facts.place[1]))

    def _give(
        self,
        reads: Reads,
        document: Document,
        element: Element,
        key: str,
        node: Node,
        found: AttrValue,
    ) -> None:
        known = value(found, lambda at: self._values.get((document.path, at)))
        attrs = element.attrs.plain() if isinstance(element.attrs, Watched) else element.attrs
        if known is not None and repr(known) == repr(attrs.get(key)):
            reads.watch(element, Literal(document.path, found, element.id, key))
        else:
            list(map(self.note, self._within(document.path, node)))

    def _within(self, path: str, node: Node) -> Iterator[Place]:
        facts = (one.facts for one in node.walk())
        return (one.place for one in facts if isinstance(one, Facts) and one.place[0] == path)

    def asked(self) -> frozenset[Place]:
        """The places of literals that were asked for so far."""
        return frozenset(self._asked)

    def finish(self, graph: Graph) -> None:
        """Leave what was given to attributes and asked for by nobody else."""
        if graph.reads is not None:
            graph.reads.asked |= self._asked


UNWATCHED = Literals()
"""Where nobody wants to know."""


def watched(
    documents: Sequence[Document], graph: Graph, asked: AbstractSet[Place] = frozenset()
) -> Literals:
    """The literals of texts, where somebody wants to know of them."""
    texts = [one for one in documents if one.text]
    return UNWATCHED if graph.reads is None else Literals(texts, asked)


class Facts(dict[str, Fact]):
    """Facts of a literal; it is noted when somebody asks for them."""

    __slots__ = ("_literals", "place")

    def __init__(self, facts: dict[str, Fact], place: Place, literals: Literals) -> None:
        super().__init__(facts)
        self.place = place
        self._literals = literals

    def __getitem__(self, key: str) -> Fact:
        self._literals.note(self.place)
        return super().__getitem__(key)

    def get(self, key: str, default: Fact | None = None) -> Fact | None:  # type: ignore[override]
        self._literals.note(self.place)
        return super().get(key, default)

    def __iter__(self) -> Iterator[str]:
        self._literals.note(self.place)
        return super().__iter__()

    def keys(self) -> KeysView[str]:  # type: ignore[override]
        self._literals.note(self.place)
        return super().keys()

    def copy(self) -> dict[str, Fact]:
        self._literals.note(self.place)
        return super().copy()

    def __or__(self, other: dict[str, Fact]) -> dict[str, Fact]:  # type: ignore[override]
        return self.copy() | other

    def __ror__(self, other: dict[str, Fact]) -> dict[str, Fact]:  # type: ignore[override]
        return other | self.copy()

    def __eq__(self, other: object) -> bool:
        self._literals.note(self.place)
        return super().__eq__(other)

    def __ne__(self, other: object) -> bool:
        self._literals.note(self.place)
        return super().__ne__(other)

    def values(self) -> ValuesView[Fact]:  # type: ignore[override]
        self._literals.note(self.place)
        return super().values()

    def items(self) -> ItemsView[str, Fact]:  # type: ignore[override]
        self._literals.note(self.place)
        return super().items()
