"""Finds what the words of an overlay mean: by id first, then by path or qualified name."""

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from posixpath import dirname, normpath
from typing import NamedTuple
from unicodedata import normalize

from sysmlc.diagnostics import Rule, Sink
from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind, derived_id
from sysmlc.ir.query import BEHAVIORS, CLASSIFIERS, generals, type_of
from sysmlc.overlay.model import Key, Refinement, Spot, Term
from sysmlc.passes.overlay import rules
from sysmlc.passes.resolve.hrefs import PRIMITIVE_TYPES
from sysmlc.support.suggestions import did_you_mean

_SEPARATORS = frozenset("/[]@:")


def split(path: str) -> tuple[str, ...]:
    """The names of a path; brackets mean nothing but the name in them, as in CAEX paths."""
    return tuple(_names(path)) if "[" in path else tuple(path.split("/"))


def _names(path: str) -> Iterator[str]:
    name, depth = "", 0
    for sign in path:
        depth += (sign == "[") - (sign == "]")
        if sign == "/" and depth == 0:
            yield name
            name = ""
        elif not (sign == "[" and depth == 1) and not (sign == "]" and depth == 0):
            name += sign
    yield name


def join(names: Iterable[str]) -> str:
    """The path of these names; AML.Engine brackets all when one needs it, we that one."""
    return "/".join(f"[{n}]" if _SEPARATORS.intersection(n) else n for n in names)


def beside(file: str, name: str) -> str:
    """Name in the unit of the file that ``file`` calls ``name``."""
    return normalize("NFC", normpath(f"{dirname(file) or '.'}/{name}"))


_GUID = re.compile(r"\{?([0-9A-Fa-f]{8}(?:-[0-9A-Fa-f]{4}){3}-[0-9A-Fa-f]{12})\}?")
_PRIMITIVES = frozenset({"Boolean", "Integer", "Real", "String", "UnlimitedNatural"})
_TELLING = 2_000
"""Names among which the nearest is looked for; comparing more takes seconds."""
_ADVISED = 20
"""Words of an overlay that are answered with the nearest name: an export may lose thousands."""
_LISTED = 5


_ByName = dict[str, list[Element]]


class Sort(NamedTuple):
    """What a word may mean: kinds of elements, and how a sentence calls them."""

    title: str
    kinds: tuple[Kind, ...]


BLOCK = Sort("block", (Kind.CLASS, Kind.COMPONENT))
TYPE = Sort("type", tuple(kind for kind in CLASSIFIERS if kind not in BEHAVIORS))
PORT = Sort("port", (Kind.PORT,))
FEATURE = Sort("port or part", (Kind.PORT, Kind.PROPERTY))
CONNECTOR = Sort("connector", (Kind.CONNECTOR,))
OPERATION = Sort("operation", (Kind.OPERATION,))
BEHAVIOR = Sort("activity or state machine", (Kind.ACTIVITY, Kind.STATE_MACHINE))
PACKAGE = Sort("package", (Kind.PACKAGE,))
ANYTHING = Sort("element", ())


@dataclass(slots=True)
class Finder:
    """Looks in one graph for what one overlay names, and adds what it says."""

    graph: Graph
    sink: Sink
    refinement: Refinement
    roots: list[Element]
    """What no element owns; packages that overlays add join them."""
    items: dict[str, Element] = field(default_factory=dict)
    """Item types by the keys of their entries."""
    behaviors: dict[str, list[Element]] = field(default_factory=dict)
    """What the words for behaviours meant before any behaviour was moved."""
    about: str = ""
    """Id of the element that the entry is about which is being added: errors in it are its own."""
    _other_ids: dict[str, Element] | None = None
    _named: dict[str, tuple[tuple[int, str], _ByName]] = field(default_factory=dict)
    _advised: int = 0

    # -- what words mean -----------------------------------------------------------------------

    def entry(self, key: Key, sort: Sort) -> Element | None:
        """What an entry is about; None when that is not clear, which is reported."""
        found = self.named(key.text, sort)
        if key.path:
            found = self._with_path(key, found, self.named(key.path, sort))
        self.about = ""
        one = self.only(Term(key.text, key.spot), found, sort, key.path)
        self.about = "" if one is None else one.id
        return one

    def _with_path(self, key: Key, found: list[Element], other: list[Element]) -> list[Element]:
        """What the id means, else the path; that the two do not agree is reported."""
        if len(other) != 1 or other == found:
            return found or other
        id, path = key.text, str(key.path)
        if not found:
            self.report(rules.BY_PATH, key, id=id, path=path, new=other[0].id)
        elif len(found) == 1:
            self.report(rules.OTHER_PATH, key, id=id, path=path, meant=self.path(found[0]))
        return found or other

    def term(self, term: Term, sort: Sort) -> Element | None:
        """What a word means; None when that is not clear, which is reported."""
        if sort is TYPE:
            known = self.items.get(term.text) or self._primitive(term.text)
            if known is not None:
                return known
        return self.only(term, self.named(term.text, sort), sort, "")

    def named(self, text: str, sort: Sort) -> list[Element]:
        """Everything that an id, a path, a qualified name or ``file#qualified name`` means."""
        by_id = self._by_id(text)
        if by_id is not None:
            return _unique([self._as(by_id, sort)])
        file, sign, name = text.partition("#")
        unit_name = beside(self.refinement.file, file) if sign else ""
        words = name if sign else text
        for names in dict.fromkeys((split(words), tuple(words.split("::")))):
            found = [self._as(one, sort) for one in self._along(names, unit_name)]
            if any(found):
                return _unique(found)
        return []

    def _by_id(self, text: str) -> Element | None:
        found = self.graph.get(text) or self.graph.get(plain(text))
        if found is not None:
            return found
        if self._other_ids is None:
            self._other_ids = dict(_other_ids(self.graph))
        return self._other_ids.get(plain(text))

    def _along(self, names: tuple[str, ...], file: str) -> Iterator[Element]:
        level = [one for one in self.roots if one.name == names[0] and all(names)]
        for name in names[1:]:
            inside = [one for top in level for one in self._inside(top, name)]
            level = list(dict.fromkeys(inside))
        for one in level:
            if not file or one.source == file:
                yield one

    def _inside(self, top: Element, name: str) -> list[Element]:
        """What has this name in an element, or in what it is an instance or usage of."""
        waiting = [top]
        for one in waiting[:]:
            waiting += self.graph.targets(one, Edge.INSTANCE_OF)
            type_ = type_of(self.graph, one)
            waiting += [] if type_ is None else [type_]
        for one in waiting[:]:
            waiting += generals(self.graph, one)
        for one in waiting:
            found = self._members(one).get(name)
            if found:
                return found
        return []

    def _members(self, top: Element) -> _ByName:
        """What an element owns, by name; asked for again and again of large hierarchies."""
        owned = self.graph.owned(top)
        last = (len(owned), owned[-1].id if owned else "")
        seen, known = self._named.get(top.id, ((-1, ""), {}))
        if seen != last:
            known = {}
            for one in owned:
                known.setdefault(one.name, []).append(one)
            self._named[top.id] = (last, known)
        return known

    def _as(self, element: Element, sort: Sort) -> Element | None:
        """The element, or what classifies it when only that is of the sort."""
        if not sort.kinds or element.kind in sort.kinds:
            return element
        if sort is FEATURE:
            return self.graph.target(element, Edge.REPRESENTS)
        if sort in (BLOCK, TYPE):
            found = self.graph.target(element, Edge.INSTANCE_OF) or type_of(self.graph, element)
            if found is not None and found.kind in sort.kinds:
                return found
        return None

    def _primitive(self, name: str) -> Element | None:
        if name not in _PRIMITIVES:
            return None
        for known in self.graph.of_kind(Kind.DATA_TYPE):
            if known.subkind == "primitive" and known.name == name:
                return known
        href = PRIMITIVE_TYPES + name
        attrs: dict[str, AttrValue] = {"external": True, "href": href, "subkind": "primitive"}
        return self.graph.add(Element(derived_id(href, "stub"), Kind.DATA_TYPE, name, attrs=attrs))

    # -- what is reported ----------------------------------------------------------------------

    def report(self, rule: Rule, term: Term | Key, **facts: str) -> None:
        """Report a rule about a word of the overlay."""
        subject = self.refinement.subject(term, self.about)
        self.sink.report(rule, subject, notes=(), help="", **facts)

    def only(self, term: Term, found: list[Element], sort: Sort, path: str) -> Element | None:
        """The one that was found; that there is none, or several, is reported."""
        if len(found) == 1:
            return found[0]
        if found:
            listed = self._listed(found)
            self.report(rules.AMBIGUOUS, term, word=term.text, sort=sort.title, listed=listed)
        elif (other := self.named(term.text, ANYTHING)) and len(other) == 1:
            kind = other[0].kind.value
            self.report(rules.WRONG_SORT, term, word=term.text, sort=sort.title, kind=kind)
        else:
            advice = self._absent(term) or self._nearest(path or term.text, sort)
            self.report(rules.NO_MATCH, term, word=term.text, sort=sort.title, advice=advice)
        return None

    def _absent(self, term: Term) -> str:
        """That the file which a word names was not read, if so."""
        file, sign, _ = term.text.partition("#")
        name = beside(self.refinement.file, file)
        is_there = not sign or any(element.source == name for element in self.graph)
        return "" if is_there else f"the file '{file}' is not part of the compile unit"

    def _nearest(self, word: str, sort: Sort) -> str:
        self._advised += 1
        if self._advised > _ADVISED:
            return "the first findings of this kind name what is near"
        if _GUID.fullmatch(word.strip()):
            return "'sysmlc show MODEL' prints all ids"
        hint = did_you_mean(word, self.known(sort))
        return hint if not hint.endswith(" more") else "'sysmlc show MODEL' prints all names"

    def _listed(self, found: Iterable[Element]) -> str:
        words = [f"{self.path(one)} ({one.id})" for one in found]
        return ", ".join(words[:_LISTED]) + (", ..." if len(words) > _LISTED else "")

    def known(self, sort: Sort) -> list[str]:
        """Paths of what a word of this sort may mean, as far as a person can choose among them."""
        elements = self.graph.of_kind(*sort.kinds) if sort.kinds else list(self.graph)
        own = [one for one in elements if one.name and not one.attrs.get("library")]
        return [*(self.items if sort is TYPE else ()), *(self.path(one) for one in own[:_TELLING])]

    def path(self, element: Element) -> str:
        """Path by which an element can be named."""
        names = [element.name, *(one.name for one in self.graph.ancestors(element))]
        return join(reversed(names)) if all(names) else element.id

    # -- what is added -------------------------------------------------------------------------

    def add(
        self, id: str, kind: Kind, name: str, owner: str | None, spot: Spot, **attrs: AttrValue
    ) -> Element:
        """The element of the overlay with this id, new or known, with these attributes."""
        known = self.graph.get(id)
        if known is None:
            file = self.refinement.file
            known = self.graph.add(Element(id, kind, name, owner, spot.offset, file, attrs={}))
            if owner is None:
                self.roots.append(known)
        self.graph.set(known, **attrs)
        return known


def _other_ids(graph: Graph) -> Iterator[tuple[str, Element]]:
    """Ids that stand for an element beside its own: of repeated interfaces, in another spelling."""
    for element in graph:
        if plain(element.id) != element.id:
            yield plain(element.id), element
    for element in graph.of_kind(Kind.PROPERTY, Kind.INSTANCE):
        pairs = element.attrs.get("interface_ids")
        for pair in pairs if isinstance(pairs, tuple) else ():
            port = graph.get(str(pair[0])) if isinstance(pair, tuple) else None
            if port is not None and isinstance(pair, tuple):
                yield plain(str(pair[1])), port


def plain(id: str) -> str:
    """A GUID without braces and in lower case, as writers differ in both; else the id itself."""
    found = _GUID.fullmatch(id.strip())
    return found[1].lower() if found else id


def _unique(found: Iterable[Element | None]) -> list[Element]:
    return list(dict.fromkeys(one for one in found if one is not None))
