"""Lookup of the references in an overlay: by id first, then by path or qualified name."""

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from posixpath import dirname, normpath
from typing import NamedTuple
from unicodedata import normalize

from sysmlc.diagnostics import Rule, Sink
from sysmlc.documents import Spot
from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind, derived_id, list_items
from sysmlc.ir.query import BEHAVIORS, CLASSIFIERS, generals, type_of
from sysmlc.overlay.model import Change, Key, Refinement, Term, place_of
from sysmlc.passes.overlay import rules
from sysmlc.passes.resolve.libraries import PRIMITIVE_TYPES
from sysmlc.support.suggestions import did_you_mean

_SEPARATORS = frozenset("/[]@:")


def split_path(path: str) -> tuple[str, ...]:
    """Return the names of a path; brackets only delimit the name in them, as in CAEX paths."""
    return tuple(_read_names(path)) if "[" in path else tuple(path.split("/"))


def _read_names(path: str) -> Iterator[str]:
    name, depth = "", 0
    for character in path:
        depth += (character == "[") - (character == "]")
        if character == "/" and depth == 0:
            yield name
            name = ""
        elif not (character == "[" and depth == 1) and not (character == "]" and depth == 0):
            name += character
    yield name


def join_path(names: Iterable[str]) -> str:
    """Return the path of these names, with brackets around names that contain a separator."""
    # AML.Engine writes brackets around all names as soon as one name needs them.
    return "/".join(f"[{n}]" if _SEPARATORS.intersection(n) else n for n in names)


def name_in_unit(file: str, name: str) -> str:
    """Return the name in the unit of a file that *file* refers to by the relative path *name*."""
    return normalize("NFC", normpath(f"{dirname(file) or '.'}/{name}"))


_GUID = re.compile(r"\{?([0-9A-Fa-f]{8}(?:-[0-9A-Fa-f]{4}){3}-[0-9A-Fa-f]{12})\}?")
_PRIMITIVES = frozenset({"Boolean", "Integer", "Real", "String", "UnlimitedNatural"})
_MAX_COMPARED = 2_000
"""Limit of names for a suggestion; comparing more takes seconds."""
_MAX_SUGGESTIONS = 20
"""Limit of suggestions: a new export of the model may invalidate thousands of references."""
_MAX_LISTED = 5


_ByName = dict[str, list[Element]]


class Sort(NamedTuple):
    """The kinds of elements to which a reference may lead, and their title in messages."""

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
    """Looks up the references of one overlay, reports failures, and adds elements to the graph."""

    graph: Graph
    sink: Sink
    refinement: Refinement
    roots: list[Element]
    """Elements without an owner, including packages that overlays add."""
    items: dict[str, Element] = field(default_factory=dict)
    """Item types by the keys of their entries."""
    behaviors: dict[str, list[Element]] = field(default_factory=dict)
    """Behaviours by reference, looked up before any behaviour was moved."""
    entry_element: str = ""
    """Id of the element of the current entry, which errors in the entry are attributed to."""
    _other_ids: dict[str, Element] | None = None
    _members: dict[str, tuple[tuple[int, str], _ByName]] = field(default_factory=dict)
    _suggestions: int = 0

    # -- lookup --------------------------------------------------------------------------------

    def find_entry(self, key: Key, sort: Sort) -> Element | None:
        """Return the element of an entry; report an unknown or ambiguous one and return None."""
        elements = self.find_named(key.text, sort)
        if key.path:
            elements = self._compare_with_path(key, elements, self.find_named(key.path, sort))
        self.entry_element = ""
        element = self.require_one(Term(key.text, key.spot), elements, sort, key.path)
        self.entry_element = "" if element is None else element.id
        return element

    def _compare_with_path(
        self, key: Key, by_id: list[Element], by_path: list[Element]
    ) -> list[Element]:
        """Return the elements with the id, or else those at the path; report a disagreement."""
        if len(by_path) != 1 or by_path == by_id:
            return by_id or by_path
        id, path = key.text, str(key.path)
        if not by_id:
            self.report(rules.BY_PATH, key, id=id, path=path, new=by_path[0].id)
        elif len(by_id) == 1:
            self.report(rules.OTHER_PATH, key, id=id, path=path, meant=self.path_of(by_id[0]))
        return by_id or by_path

    def find_term(self, term: Term, sort: Sort) -> Element | None:
        """Return the element of a reference; report an unknown or ambiguous one, return None."""
        if sort is TYPE:
            item = self.items.get(term.text) or self._find_primitive(term.text)
            if item is not None:
                return item
        return self.require_one(term, self.find_named(term.text, sort), sort, "")

    def find_named(self, text: str, sort: Sort) -> list[Element]:
        """Return the elements of a reference.

        The text is an id, a path, a qualified name or ``file#qualified name``.
        """
        by_id = self._find_by_id(text)
        if by_id is not None:
            return _unique([self._convert(by_id, sort)])
        file, separator, name = text.partition("#")
        unit_name = name_in_unit(self.refinement.file, file) if separator else ""
        name_part = name if separator else text
        for names in dict.fromkeys((split_path(name_part), tuple(name_part.split("::")))):
            elements = [
                self._convert(element, sort) for element in self._walk_path(names, unit_name)
            ]
            if any(elements):
                return _unique(elements)
        return []

    def _find_by_id(self, text: str) -> Element | None:
        element = self.graph.get(text) or self.graph.get(normalise_guid(text))
        if element is not None:
            return element
        if self._other_ids is None:
            self._other_ids = dict(_list_other_ids(self.graph))
        return self._other_ids.get(normalise_guid(text))

    def _walk_path(self, names: tuple[str, ...], file: str) -> Iterator[Element]:
        level = [element for element in self.roots if element.name == names[0] and all(names)]
        for name in names[1:]:
            members = [element for top in level for element in self._find_inside(top, name)]
            level = list(dict.fromkeys(members))
        for element in level:
            if not file or element.source == file:
                yield element

    def _find_inside(self, top: Element, name: str) -> list[Element]:
        """Return the members with this name of an element, its types or their generals."""
        scopes = [top]
        for scope in scopes[:]:
            scopes += self.graph.targets(scope, Edge.INSTANCE_OF)
            type_ = type_of(self.graph, scope)
            scopes += [] if type_ is None else [type_]
        for scope in scopes[:]:
            scopes += generals(self.graph, scope)
        for scope in scopes:
            members = self._index_members(scope).get(name)
            if members:
                return members
        return []

    def _index_members(self, top: Element) -> _ByName:
        """Return the elements that an element owns, by name. The index is cached."""
        owned = self.graph.owned(top)
        # Overlays append members or move them away, which changes their number or the last id.
        current = (len(owned), owned[-1].id if owned else "")
        version, by_name = self._members.get(top.id, ((-1, ""), {}))
        if version != current:
            by_name = {}
            for element in owned:
                by_name.setdefault(element.name, []).append(element)
            self._members[top.id] = (current, by_name)
        return by_name

    def _convert(self, element: Element, sort: Sort) -> Element | None:
        """Return the element, or else its part or classifier, if it is of the sort, or None."""
        if not sort.kinds or element.kind in sort.kinds:
            return element
        if sort is FEATURE:
            return self.graph.target(element, Edge.REPRESENTS)
        if sort in (BLOCK, TYPE):
            classifier = self.graph.target(element, Edge.INSTANCE_OF) or type_of(
                self.graph, element
            )
            if classifier is not None and classifier.kind in sort.kinds:
                return classifier
        return None

    def _find_primitive(self, name: str) -> Element | None:
        if name not in _PRIMITIVES:
            return None
        for data_type in self.graph.of_kind(Kind.DATA_TYPE):
            if data_type.subkind == "primitive" and data_type.name == name:
                return data_type
        href = PRIMITIVE_TYPES + name
        attrs: dict[str, AttrValue] = {"external": True, "href": href, "subkind": "primitive"}
        return self.graph.add(Element(derived_id(href, "stub"), Kind.DATA_TYPE, name, attrs=attrs))

    # -- diagnostics ---------------------------------------------------------------------------

    def report(self, rule: Rule, term: Term | Key, **facts: str) -> None:
        """Report a diagnostic at a term of the overlay."""
        subject = self.refinement.subject(term, self.entry_element)
        self.sink.report(rule, subject, notes=(), help="", **facts)

    def require_one(
        self, term: Term, elements: list[Element], sort: Sort, path: str
    ) -> Element | None:
        """Return the only element; report a missing or ambiguous one and return None."""
        if len(elements) == 1:
            return elements[0]
        if elements:
            listed = self._list_paths(elements)
            self.report(rules.AMBIGUOUS, term, word=term.text, sort=sort.title, listed=listed)
        elif (of_any_sort := self.find_named(term.text, ANYTHING)) and len(of_any_sort) == 1:
            kind = of_any_sort[0].kind.value
            self.report(rules.WRONG_SORT, term, word=term.text, sort=sort.title, kind=kind)
        else:
            advice = self._describe_missing_file(term) or self._suggest(path or term.text, sort)
            self.report(rules.NO_MATCH, term, word=term.text, sort=sort.title, advice=advice)
        return None

    def _describe_missing_file(self, term: Term) -> str:
        """Return a clause if the reference names a file that is not in the unit, or else ""."""
        file, separator, _ = term.text.partition("#")
        name = name_in_unit(self.refinement.file, file)
        is_present = not separator or any(element.source == name for element in self.graph)
        return "" if is_present else f"the file '{file}' is not part of the compile unit"

    def _suggest(self, word: str, sort: Sort) -> str:
        self._suggestions += 1
        if self._suggestions > _MAX_SUGGESTIONS:
            return "only the first findings of this kind name similar elements"
        if _GUID.fullmatch(word.strip()):
            return "'sysmlc show MODEL' prints all ids"
        hint = did_you_mean(word, self.list_paths(sort))
        return hint if not hint.endswith(" more") else "'sysmlc show MODEL' prints all names"

    def _list_paths(self, elements: Iterable[Element]) -> str:
        words = [f"{self.path_of(element)} ({element.id})" for element in elements]
        return ", ".join(words[:_MAX_LISTED]) + (", ..." if len(words) > _MAX_LISTED else "")

    def list_paths(self, sort: Sort) -> list[str]:
        """Return the paths of elements of this sort, for suggestions."""
        elements = self.graph.of_kind(*sort.kinds) if sort.kinds else list(self.graph)
        named_elements = [
            element for element in elements if element.name and not element.attrs.get("library")
        ]
        return [
            *(self.items if sort is TYPE else ()),
            *(self.path_of(element) for element in named_elements[:_MAX_COMPARED]),
        ]

    def path_of(self, element: Element) -> str:
        """Return the path of an element in overlays, or its id if an owner has no name."""
        names = [element.name, *(ancestor.name for ancestor in self.graph.ancestors(element))]
        return join_path(reversed(names)) if all(names) else element.id

    # -- changes -------------------------------------------------------------------------------

    def record_change(self, element: Element, fact: str, term: Term | Key) -> None:
        """Record a fact about an element of the model, for back ends that preserve its text."""
        change = Change(element.id, fact, place_of(self.refinement.file, term.spot))
        if change not in self.graph.derived(Change):
            self.graph.store(Change, [*self.graph.derived(Change), change])

    # -- new elements --------------------------------------------------------------------------

    def ensure_element(
        self, id: str, kind: Kind, name: str, owner: str | None, spot: Spot, **attrs: AttrValue
    ) -> Element:
        """Return the element with this id, after adding it if needed and setting *attrs*."""
        element = self.graph.get(id)
        if element is None:
            file = self.refinement.file
            element = self.graph.add(Element(id, kind, name, owner, spot.offset, file, attrs={}))
            if owner is None:
                self.roots.append(element)
        self.graph.set(element, **attrs)
        return element


def _list_other_ids(graph: Graph) -> Iterator[tuple[str, Element]]:
    """Yield alternative ids of elements: GUIDs in another spelling, ids of repeated interfaces."""
    for element in graph:
        if normalise_guid(element.id) != element.id:
            yield normalise_guid(element.id), element
    for element in graph.of_kind(Kind.PROPERTY, Kind.INSTANCE):
        for pair in list_items(element.attrs.get("interface_ids")):
            port = graph.get(str(pair[0])) if isinstance(pair, tuple) else None
            if port is not None and isinstance(pair, tuple):
                yield normalise_guid(str(pair[1])), port


def normalise_guid(id: str) -> str:
    """Return a GUID in lower case and without braces; return any other id unchanged."""
    # Tools differ in braces and case, and may change both in a new export.
    match = _GUID.fullmatch(id.strip())
    return match[1].lower() if match else id


def _unique(elements: Iterable[Element | None]) -> list[Element]:
    return list(dict.fromkeys(element for element in elements if element is not None))
