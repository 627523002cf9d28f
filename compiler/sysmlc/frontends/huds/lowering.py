"""From records to elements and references: owners first, then what refers to them."""

from collections.abc import Iterator

from sysmlc.diagnostics import Coverage, Place, Rule, Sink, Subject, Verdict
from sysmlc.frontends.huds import rules
from sysmlc.frontends.huds import vocabulary as v
from sysmlc.frontends.huds.features import ATTRIBUTES, apply_stereotypes
from sysmlc.frontends.huds.records import Record
from sysmlc.frontends.huds.relations import relate
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.sources import DEFAULT_LIMITS, Fault, SourceError


def lower(file: str, records: list[Record], graph: Graph, sink: Sink, coverage: Coverage) -> None:
    """Add the elements of one file, its references as pending ones, and count every record."""
    lowered = Lowered(file, records, graph, sink)
    for record in lowered.in_order():
        lowered.add(record)
    for record in records:
        lowered.finish(record)
    counts = coverage.file(file)
    for record in records:
        counts.count(record.type or "?", lowered.verdicts[record.ordinal])
    lowered.report()


class Lowered:
    """One file on its way into the graph."""

    def __init__(self, file: str, records: list[Record], graph: Graph, sink: Sink) -> None:
        self.file, self.records, self.graph, self.sink = file, records, graph, sink
        self.by_id: dict[str, Record] = {}
        self.verdicts: dict[int, Verdict] = {}
        self._depths: dict[str, int] = {}
        self._lost: dict[tuple[str, str], list[Record]] = {}
        for record in records:
            if not record.id:
                self._lose(record, rules.UNSUPPORTED, _local(record))
            elif self.by_id.setdefault(record.id, record) is not record:
                self._lose(record, rules.REPEATED, record.id)

    def kind(self, record: Record) -> tuple[Kind, str] | None:
        """What the record is in the graph, if it is an element."""
        return v.KINDS.get(_local(record))

    def graph_id(self, id: str) -> str:
        """Id in the graph of an element of the file."""
        return id if id in self.by_id and not self._is_taken(id) else f"{self.file}#{id}"

    def target(self, id: str) -> str:
        """What a relation leads to: an element, or one that MTIP left out."""
        found = self.graph_id(id)
        return found if found in self.graph else f"MTIP:not-exported#{id}"

    def _is_taken(self, id: str) -> bool:
        known = self.graph.get(id)
        return known is not None and known.source != self.file

    def above(self, record: Record) -> Record | None:
        """The owner: of a transition the region of its source, which MTIP does not say."""
        known = self.kind(record)
        if known is not None and known[0] is Kind.TRANSITION:
            record = self.by_id.get(record.first("supplier"), record)
        return self.by_id.get(record.first("hasParent"))

    def in_order(self) -> Iterator[Record]:
        """The records with owners before what they own."""
        done: set[str] = {""}
        for record in self.records:
            chain: list[Record] = []
            above: Record | None = record
            while above is not None and above.id not in done:
                done.add(above.id)
                chain.append(above)
                above = self.above(above)
            yield from reversed(chain)

    def add(self, record: Record) -> None:
        """Add the record's element, or note what became of it instead."""
        known, type_name = self.kind(record), _local(record)
        if known is None:
            self._note(record, type_name)
            return
        kind, subkind = known
        above = record.first("hasParent")
        owner = self._owner(record, kind)
        if record.ordinal in self.verdicts:
            return
        if owner is None and above:
            self._lose_below(record, above, type_name)
            return
        id = self.graph_id(record.id)
        self._check_depth(id, owner)
        element = Element(id, kind, record.value("name"), owner, record.ordinal, self.file)
        if subkind:
            element.attrs["subkind"] = subkind
        self.graph.add(element)
        self.verdicts[record.ordinal] = Verdict.MAPPED
        for key, read in ATTRIBUTES.items():
            text = record.value(key)
            if text:
                read(element, text)

    def _owner(self, record: Record, kind: Kind) -> str | None:
        """Id of the owner when it is there and may own such an element."""
        above = self.above(record)
        owner = self.graph.get(self.graph_id(above.id)) if above else None
        if owner is None or (kind in v.OWNERS and owner.kind not in v.OWNERS[kind]):
            return None
        return owner.id

    def _check_depth(self, id: str, owner: str | None) -> None:
        self._depths[id] = depth = self._depths.get(owner or "", 0) + 1
        if depth > DEFAULT_LIMITS.depth:
            message = f"nested more than {DEFAULT_LIMITS.depth} deep"
            raise SourceError(message, self.file, fault=Fault.LIMIT)

    def _lose_below(self, record: Record, above: str, type_name: str) -> None:
        """What belongs to settings of the tool is none of the model's either."""
        owner = self.by_id.get(above)
        if owner and self.verdicts.get(owner.ordinal) is Verdict.IGNORED_NOTATION:
            self.verdicts[record.ordinal] = Verdict.IGNORED_NOTATION
        else:
            self._lose(record, rules.OWNERLESS, type_name)

    def _note(self, record: Record, type_name: str) -> None:
        if v.is_notation(type_name):
            self.verdicts[record.ordinal] = Verdict.IGNORED_NOTATION
        elif type_name in v.FOLDED:
            self.verdicts[record.ordinal] = Verdict.MAPPED
        else:
            self._lose(record, rules.UNSUPPORTED, type_name)

    def _lose(self, record: Record, rule: Rule, what: str) -> None:
        self.verdicts[record.ordinal] = Verdict.UNSUPPORTED
        self._lost.setdefault((rule.code, what), []).append(record)

    def finish(self, record: Record) -> None:
        """Add what the record says about others."""
        if self.by_id.get(record.id) is not record:
            return
        element = self.graph.get(self.graph_id(record.id))
        relate(self, record, element)
        if element is not None:
            apply_stereotypes(self.graph, element, record)

    def lose_end(self, record: Record, flow: Element, edge: Edge) -> None:
        """The flow leads from or to a node that is not read."""
        known = flow.attrs.get("unresolved")
        names = known if isinstance(known, tuple) else ()
        flow.attrs["unresolved"] = (*names, edge.value)
        self.verdicts[record.ordinal] = Verdict.APPROXIMATED
        self._lost.setdefault((rules.LOOSE_END.code, _local(record)), []).append(record)

    def report(self) -> None:
        """Report what is not read, once for each type."""
        found = {rule.code: rule for rule in _TOLD}
        for (code, what), records in self._lost.items():
            place = Place(self.file, records[0].ordinal)
            self.sink.report(
                found[code],
                Subject(what, place=place),
                count=len(records),
                type=what,
                id=what,
                file=self.file,
            )


_TOLD = (rules.UNSUPPORTED, rules.OWNERLESS, rules.REPEATED, rules.LOOSE_END)


def _local(record: Record) -> str:
    return record.type.rpartition(".")[2]
