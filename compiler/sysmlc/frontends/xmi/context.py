"""What the readers of rows share: the document, the graph, and the bookkeeping of verdicts."""

from collections.abc import Callable
from typing import NamedTuple

from sysmlc.diagnostics import Sink, Subject, Verdict
from sysmlc.frontends.xmi import feature_names as naming
from sysmlc.frontends.xmi import metaclasses, rules
from sysmlc.frontends.xmi import vocabulary as v
from sysmlc.frontends.xmi.keys import KEYS, PASSED_OVER
from sysmlc.frontends.xmi.loose import Loose
from sysmlc.frontends.xmi.rows import Rows
from sysmlc.frontends.xmi.unit import Link, Lowered, Unit
from sysmlc.frontends.xmi.values import ValueText, bound
from sysmlc.ir import AttrValue, Edge, Element, Kind
from sysmlc.sources import DEFAULT_LIMITS

Completion = Callable[["Context", Element, int], None]
"""Adds to an element what is special about it; takes its row."""


class Event(NamedTuple):
    """What an event says of the triggers that name it."""

    types: list[tuple[str, str, int, bool]]
    """Features with a target, its row, and whether it is an href."""
    conditions: list[tuple[str, ValueText]]
    is_relative: bool


class Context(Rows):
    """The lowering of one document.

    Readers leave in ``deferred`` what can only be said when every document is read.
    """

    def __init__(self, unit: Unit, lowered: Lowered, sink: Sink) -> None:
        super().__init__(unit, lowered, sink)
        self.applications: list[int] = []
        self.extensions: list[int] = []
        self.parts: list[int] = []
        self.triggers: list[tuple[Element, int]] = []
        self.event_rows: list[int] = []
        self.events: dict[tuple[str, int], Event] = {}
        self.deferred: list[tuple[Completion, Element, int]] = []
        self.ends: list[tuple[Element, int]] = []
        self.parameters: list[tuple[Element, int]] = []
        self.opaque: dict[str, tuple[Element, int]] = {}
        self.guards: list[tuple[Element, str, int]] = []
        self.rows_of: dict[str, list[tuple[Element, int]]] = {}
        self.odd_values: list[tuple[int, str, str]] = []
        """Rows with an attribute whose value is none that UML knows for it."""
        self.baseless: list[int] = []
        self.loose: list[Loose] = []
        self.flow_targets: frozenset[str] | None = None
        self.computed: set[str] = set()
        """Elements with a bound that is an expression."""
        self.bounds: dict[str, list[AttrValue]] = {}
        self.late_conditions: list[tuple[str, str]] = []
        self.late: list[tuple[Element, str, list[str], bool]] = []

    def may_own(self, owner: str, kind: Kind) -> bool:
        """Whether elements of the kind can stand below the owner."""
        above = self.graph.get(owner)
        return above is not None and above.kind in metaclasses.OWNERS[kind]

    # -- attributes and references -------------------------------------------------------------

    def attribute(self, element: Element, row: int, name: str, value: str) -> None:
        """Put one UML attribute (or reference list) of the row into the graph."""
        edge = v.REFERENCES.get(name)
        if edge is not None:
            if name in v.AMBIGUOUS:
                edge = v.SPECIAL.get((element.kind, name), edge)
            for target in self._targets(row, name, value):
                self.link(edge, element.id, target, row, name)
        elif name in KEYS:
            key = KEYS[name]
            if value != key.default and not key.keep(element, value):
                self.odd_values.append((row, name, value))
        else:
            self._other(element, row, name, value)

    def _targets(self, row: int, name: str, value: str) -> list[str]:
        """The ids in a list, as far as a list may be long."""
        targets = self.document.tokens(value)
        most = DEFAULT_LIMITS.references
        if len(targets) > most:
            subject = Subject(self.qualified_name(row), "", self.place(row))
            self.sink.report(rules.LONG_LIST, subject, feature=name, count=len(targets), most=most)
        return targets[:most]

    def _other(self, element: Element, row: int, name: str, value: str) -> None:
        backwards = v.REVERSED.get((element.kind, name))
        if backwards is not None:
            for target in value.split():
                self.link(backwards, element.id, target, row, name, is_reversed=True)
        elif name in v.CONDITIONS:
            self.conditions(value.split(), name)
        elif name in _BOUNDS:
            self.bound(row, _BOUNDS.index(name), bound(value))
        elif name == "kind" and element.kind in _DIVIDED:
            if value != _DIVIDED[element.kind]:
                element.attrs["subkind"] = metaclasses.hyphenated(value)
        elif name in v.REDUNDANT:
            self.look(row, name, value)
        elif name in naming.NAMING:
            self.keep_ids(element, v.snake(name), self.document.tokens(value))
        elif name not in PASSED_OVER:
            self._said(element, row, name, value)

    def _said(self, element: Element, row: int, name: str, value: str) -> None:
        """Keep an attribute that no table names, unless it says nothing."""
        if name in naming.FLAGS:
            value = _WRITTEN.get(value, value)
        if value not in naming.VALUES.get(name, (value,)):
            self.odd_values.append((row, name, value))
        elif value != v.default(name):
            self.keep(element, v.snake(name), value)

    def look(self, row: int, feature: str, value: str, is_said_elsewhere: bool = True) -> None:
        """Note the ids of a reference that nobody follows which are not in this file."""
        ids = self.document.ids
        missing = [target for target in self.document.tokens(value) if target not in ids]
        if missing and not self.document.is_in_extension(row):
            ordinal = self.document.ordinals[row]
            self.loose.append(Loose(self.gids[row], ordinal, feature, missing, is_said_elsewhere))

    def keep(self, element: Element, key: str, value: str) -> None:
        """Keep what no table names: ids of elements, a truth value, or text."""
        tokens = value.split()
        if tokens and all(token in self.document.ids for token in tokens):
            self.late.append((element, key, tokens, False))
        elif value in ("true", "false"):
            element.attrs[key] = value == "true"
        elif value:
            element.attrs[key] = value

    def keep_ids(self, element: Element, key: str, ids: list[str], is_href: bool = False) -> None:
        """Keep ids (or hrefs) as ids of the graph, when all elements are there."""
        if ids:
            self.late.append((element, key, ids, is_href))

    def text(self, row: int, feature: str) -> None:
        """A child that is only text stands for an attribute of the same name."""
        owner = self.owner(row)
        value = self.document.texts.get(row, "")
        if owner is None:
            self.verdicts[row] = Verdict.UNSUPPORTED
            return
        if not naming.is_known(feature):
            self._report_stray(row, feature)
        if not value:
            return
        if feature == "name":
            self.graph.rename(owner, value)
        elif feature in ("body", "language") and feature in owner.attrs:
            self.opaque[owner.id] = (owner, self.document.parents[row])
        else:
            self.attribute(owner, row, feature, value)

    def _report_stray(self, row: int, feature: str) -> None:
        name = self.qualified_name(self.document.parents[row])
        subject = Subject(name, self.gids[row], self.place(row))
        self.sink.report(rules.STRAY_TEXT, subject, feature=feature, element=name)
        self.verdicts[row] = Verdict.APPROXIMATED
        self.told[row] = rules.STRAY_TEXT, "kept as text: no feature of UML has its name"

    def link(
        self,
        edge: Edge,
        source: str,
        target: str,
        row: int,
        feature: str,
        is_href: bool = False,
        is_reversed: bool = False,
    ) -> None:
        """Leave a reference from an element to an id or href."""
        link = Link(edge, source, self.lowered, target, row, feature, is_href, is_reversed)
        self.unit.links.append(link)

    def link_from(
        self,
        holder: Lowered,
        edge: Edge,
        source: str,
        target: str,
        row: int,
        feature: str,
        is_href: bool,
    ) -> None:
        """Leave a reference that a row of another document makes."""
        self.unit.links.append(Link(edge, source, holder, target, row, feature, is_href))

    def conditions(self, targets: list[str], feature: str) -> None:
        """The constraints with these ids are pre- or postconditions."""
        self.late_conditions.extend((target, v.CONDITIONS[feature]) for target in targets)

    def bound(self, row: int, index: int, value: AttrValue) -> None:
        """Lower (0) or upper (1) bound of the element above the row."""
        gid = self.gids[row]
        if gid:
            self.bounds.setdefault(gid, [1, 1])[index] = value


_BOUNDS = ("lower", "upper")
"""Derived attributes, which Enterprise Architect writes."""

_WRITTEN = {"1": "true", "0": "false"}
"""The other ways to write an xs:boolean."""

_DIVIDED = {Kind.PSEUDOSTATE: "", Kind.TRANSITION: "external"}
"""Kinds whose attribute ``kind`` is their subkind, and the value that is not written."""
