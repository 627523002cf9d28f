"""Lowers records to elements of the graph: owners first, then the relations between elements."""

import re
from collections.abc import Callable, Iterator, Sequence
from functools import cached_property

from sysmlc.diagnostics import Coverage, Place, Rule, Severity, Sink, Subject, Verdict, rule
from sysmlc.frontends.base import read_or_report
from sysmlc.frontends.huds import vocabulary as v
from sysmlc.frontends.huds.records import Record, read_records
from sysmlc.frontends.huds.relations import (
    add_association_ends,
    add_effects,
    add_parameters_of_nodes,
    add_relations,
)
from sysmlc.ir import Edge, Element, Graph, Kind, list_items
from sysmlc.ir.element import derived_id
from sysmlc.sources import DEFAULT_LIMITS, Fault, Source, SourceError
from sysmlc.support.counts import count

MALFORMED = rule(
    "SM185",
    "malformed-mtip-file",
    Severity.ERROR,
    "'{file}' cannot be read: {problem}",
    help="export the model again",
)
UNSUPPORTED = rule(
    "SM181",
    "unsupported-mtip-type",
    Severity.WARNING,
    "{count} of type '{type}' not read",
    help="save the model as .mdzip or .xml in Cameo: these are read more completely",
)
OWNERLESS = rule(
    "SM182",
    "mtip-owner-not-read",
    Severity.WARNING,
    "{count} of type '{type}' not read: the owner is not read either",
    help="save the model as .mdzip or .xml in Cameo: these are read more completely",
)
LOOSE_END = rule(
    "SM184",
    "mtip-end-not-read",
    Severity.WARNING,
    "{count} of type '{type}' with an end that is not read",
    help="save the model as .mdzip or .xml in Cameo: these are read more completely",
)
REPEATED = rule(
    "SM183",
    "repeated-mtip-id",
    Severity.ERROR,
    "the id '{id}' is used by two elements of '{file}'",
    help="export the model again",
)
_LOSS_RULES = (UNSUPPORTED, OWNERLESS, REPEATED, LOOSE_END)


def lower_files(sources: Sequence[Source], graph: Graph, sink: Sink, coverage: Coverage) -> None:
    """Read and lower the files, and count the verdicts of their records.

    A damaged file is reported and skipped. Raises SourceError if a file exceeds the limits.
    """
    for source in sorted(sources, key=lambda source: source.name):
        records = read_or_report(read_records, source, MALFORMED, sink)
        if records is not None:
            lowering = FileLowering(source.name, records, graph)
            lowering.lower()
            counts = coverage.file(source.name)
            for record in records:
                counts.count(record.type or "?", lowering.verdicts[record.ordinal])
            lowering.report_losses(sink)


class FileLowering:
    """Lowers the records of one file, and stores a verdict for each of them."""

    def __init__(self, file: str, records: list[Record], graph: Graph) -> None:
        self.file, self.records, self.graph = file, records, graph
        self.by_id: dict[str, Record] = {}
        self.verdicts: dict[int, Verdict] = {}
        """Verdicts by the ordinal of the record."""
        self._depths: dict[str, int] = {}
        self._losses: dict[tuple[str, str], list[Record]] = {}
        """Records that are not wholly read, by code of the rule and type or id."""
        for record in records:
            if not record.id:
                self._mark_unsupported(record, UNSUPPORTED, record.local_type)
            elif self.by_id.setdefault(record.id, record) is not record:
                self._mark_unsupported(record, REPEATED, record.id)

    def lower(self) -> None:
        """Add all elements, then the relations and stereotypes of each record.

        Facts that MTIP does not state come last: they follow from the others.
        """
        for record in self._iter_owners_first():
            self._add_element(record)
        for record in self.records:
            if self.by_id.get(record.id) is record:
                element = self.graph.get(self.graph_id(record.id))
                add_relations(self, record, element)
                if element is not None:
                    _apply_stereotypes(self.graph, element, record)
        add_association_ends(self)
        add_effects(self.graph)
        add_parameters_of_nodes(self)

    # -- ids and owners ----------------------------------------------------------------------------

    def graph_id(self, id: str) -> str:
        """Return the id in the graph for an id of the file.

        It is the same id, or ``<file>#<id>`` if an element of another file has it, too, or if it is
        the id of no record.
        """
        return id if id in self.by_id and not self._is_in_other_file(id) else f"{self.file}#{id}"

    def target_id(self, id: str) -> str:
        """Return the id in the graph of the target of a relation.

        MTIP does not export elements of some types: a target that is not in the graph gets an id
        that says so, for which an external stub is created.
        """
        if id in v.PRIMITIVES and id not in self.by_id:
            return v.PRIMITIVE_TYPES + id
        graph_id = self.graph_id(id)
        return graph_id if graph_id in self.graph else f"MTIP:not-exported#{id}"

    @cached_property
    def instances_by_name(self) -> dict[tuple[str, str], list[str]]:
        """Graph ids of literals and instances by the id of their enumeration or type, and name."""
        index: dict[tuple[str, str], list[str]] = {}
        for record in self.by_id.values():
            mapped = v.KINDS.get(record.local_type)
            owns_literal = mapped is not None and mapped[0] is Kind.ENUMERATION_LITERAL
            for type_id in record.targets("hasParent" if owns_literal else "classifiedBy"):
                key = type_id, record.value("name")
                index.setdefault(key, []).append(self.graph_id(record.id))
        return index

    def _is_in_other_file(self, id: str) -> bool:
        element = self.graph.get(id)
        return element is not None and element.source != self.file

    def _find_owner(self, record: Record) -> Record | None:
        """Return the record of the owner.

        MTIP does not write the owner of a transition; it is the owner of the source state.
        """
        mapped = v.KINDS.get(record.local_type)
        if mapped is not None and mapped[0] is Kind.TRANSITION:
            record = self.by_id.get(record.find_target("supplier"), record)
        return self.by_id.get(record.find_target("hasParent"))

    def _iter_owners_first(self) -> Iterator[Record]:
        """Yield each record after its owner; a cycle of owners is cut."""
        visited: set[str] = {""}
        for record in self.records:
            chain: list[Record] = []
            ancestor: Record | None = record
            while ancestor is not None and ancestor.id not in visited:
                visited.add(ancestor.id)
                chain.append(ancestor)
                ancestor = self._find_owner(ancestor)
            yield from reversed(chain)

    # -- elements ----------------------------------------------------------------------------------

    def _add_element(self, record: Record) -> None:
        """Add the element of a record; if none is added, store the reason as the verdict."""
        mapped = v.KINDS.get(record.local_type)
        if mapped is None:
            self._mark_omitted(record)
            return
        kind, subkind = mapped
        owner = self._find_owner_id(record, kind)
        if record.ordinal in self.verdicts:
            return
        if owner is None and record.find_target("hasParent"):
            self._mark_ownerless(record)
            return
        id = self.graph_id(record.id)
        self._check_depth(id, owner)
        # MTIP calls every slot "Slot"; slots have no names.
        name = "" if kind is Kind.SLOT else record.value("name")
        element = Element(id, kind, name, owner, record.ordinal, self.file)
        if subkind:
            element.attrs["subkind"] = subkind
        self.graph.add(element)
        self.verdicts[record.ordinal] = Verdict.MAPPED
        for key, store in _ATTRIBUTES.items():
            text = record.value(key)
            if text:
                store(element, text)

    def _find_owner_id(self, record: Record, kind: Kind) -> str | None:
        """Return the id of the owner; None if it is not in the graph or may not own the kind."""
        owner_record = self._find_owner(record)
        owner = self.graph.get(self.graph_id(owner_record.id)) if owner_record else None
        if owner is None or (kind in v.OWNERS and owner.kind not in v.OWNERS[kind]):
            return None
        return owner.id

    def _check_depth(self, id: str, owner: str | None) -> None:
        self._depths[id] = depth = self._depths.get(owner or "", 0) + 1
        if depth > DEFAULT_LIMITS.depth:
            message = f"nested more than {DEFAULT_LIMITS.depth} deep"
            raise SourceError(message, self.file, fault=Fault.LIMIT)

    # -- losses ------------------------------------------------------------------------------------

    def _mark_omitted(self, record: Record) -> None:
        """Store the verdict of a record whose type has no kind in the graph."""
        if v.is_notation(record.local_type):
            self.verdicts[record.ordinal] = Verdict.IGNORED_NOTATION
        elif record.local_type in v.FOLDED:
            self.verdicts[record.ordinal] = Verdict.MAPPED
        else:
            self._mark_unsupported(record, UNSUPPORTED, record.local_type)

    def _mark_ownerless(self, record: Record) -> None:
        """Store the verdict of a record whose owner is not read; it is no loss inside a diagram."""
        owner = self.by_id.get(record.find_target("hasParent"))
        if owner and self.verdicts.get(owner.ordinal) is Verdict.IGNORED_NOTATION:
            self.verdicts[record.ordinal] = Verdict.IGNORED_NOTATION
        else:
            self._mark_unsupported(record, OWNERLESS, record.local_type)

    def _mark_unsupported(self, record: Record, rule: Rule, subject: str) -> None:
        self.verdicts[record.ordinal] = Verdict.UNSUPPORTED
        self._losses.setdefault((rule.code, subject), []).append(record)

    def mark_loose_end(self, record: Record, flow: Element, edge: Edge) -> None:
        """Store that an end of *flow* is not read: *edge*, which leads to it, is not added."""
        edges = list_items(flow.attrs.get("unresolved"))
        flow.attrs["unresolved"] = (*edges, edge.value)
        self.verdicts[record.ordinal] = Verdict.APPROXIMATED
        key = LOOSE_END.code, record.local_type
        self._losses.setdefault(key, []).append(record)

    def mark_unnamed_type(self, record: Record) -> None:
        """Store that the type of a feature is primitive, but not which type it is."""
        self.verdicts[record.ordinal] = Verdict.APPROXIMATED
        self._losses.setdefault((UNSUPPORTED.code, "PrimitiveValueType"), []).append(record)

    def report_losses(self, sink: Sink) -> None:
        """Report the records that are not wholly read, once for each rule and type or id."""
        loss_rules = {rule.code: rule for rule in _LOSS_RULES}
        for (code, name), records in self._losses.items():
            sink.report(
                loss_rules[code],
                Subject(name, place=Place(self.file, records[0].ordinal)),
                count=count(len(records), "element"),
                type=name,
                id=name,
                file=self.file,
            )


# -- attributes and stereotypes --------------------------------------------------------------------

_CAPITAL = re.compile("[A-Z]")
_WITH_MULTIPLICITY = frozenset({Kind.PROPERTY, Kind.PORT, Kind.PARAMETER, Kind.PIN})


def _store_multiplicity(element: Element, text: str) -> None:
    if element.kind in _WITH_MULTIPLICITY and text not in ("1", "1..1", "unspecified"):
        element.attrs["multiplicity"] = "*" if text == "0..*" else text


def _store_default(element: Element, text: str) -> None:
    element.attrs["default"] = text
    element.attrs["default_language"] = ""


def _store_sort(element: Element, text: str) -> None:
    """Store the sort of a message in the words of the graph: ``asynch-signal``."""
    element.attrs["subkind"] = _CAPITAL.sub(lambda match: f"-{match[0].lower()}", text)


def _make_text_handler(key: str) -> Callable[[Element, str], None]:
    def store(element: Element, text: str) -> None:
        element.attrs[key] = text

    return store


_ATTRIBUTES: dict[str, Callable[[Element, str], None]] = {
    "multiplicity": _store_multiplicity,
    "defaultValue": _store_default,
    "direction": _make_text_handler("direction"),
    "guard": _make_text_handler("guard"),
    "body": _make_text_handler("body"),
    "language": _make_text_handler("language"),
    "valueSpecification": _make_text_handler("body"),
    "documentation": _make_text_handler("documentation"),
    "messageSort": _store_sort,
    "text": _make_text_handler("text"),
    "id": _make_text_handler("req_id"),
}
"""Handlers that store the attributes of a record, in this order."""


def _apply_stereotypes(graph: Graph, element: Element, record: Record) -> None:
    """Add an application for each stereotype, with its tagged values."""
    for name, profile in record.list_stereotypes():
        namespace = v.SYSML if profile in v.SYSML_PROFILES else profile
        application = Element(
            derived_id(element.id, f"stereotype {profile}::{name}"),
            Kind.APPLICATION,
            name,
            element.id,
            record.ordinal,
            element.source,
            {"stereotype": name, "namespace": namespace},
        )
        for tag, values in record.iter_tagged_values(name):
            application.attrs[f"tag.{tag}"] = values[0] if len(values) == 1 else values
        graph.add(application)
        graph.connect(Edge.SUBJECT, application, element)
