"""The rows of one document: their owners, ids, names, places and verdicts."""

from sysmlc.diagnostics import Place, Rule, Sink, Subject, Verdict
from sysmlc.frontends.xmi import rules
from sysmlc.frontends.xmi.unit import Lowered, Unit
from sysmlc.ir import Element
from sysmlc.ir.identity import derived_id


class Rows:
    """What becomes of the rows of one document, and what they are called."""

    def __init__(self, unit: Unit, lowered: Lowered, sink: Sink) -> None:
        self.unit = unit
        self.graph = unit.graph
        self.sink = sink
        self.lowered = lowered
        self.document = lowered.document
        self.gids = lowered.gids
        self.verdicts = lowered.verdicts
        self.lost: dict[int, str] = {}
        """What approximated rows are read without, where SM114 tells of it."""
        self.told: dict[int, tuple[Rule, str]] = {}
        """Rules that tell of other approximated rows, and why those are."""
        self._positions: dict[tuple[str, str], int] = {}

    # -- verdicts ------------------------------------------------------------------------------

    def inherit(self, row: int) -> None:
        """The row is mapped as part of what is above it."""
        parent = self.document.parents[row]
        self.gids[row] = self.gids[parent] if parent >= 0 else ""
        self.verdicts[row] = Verdict.MAPPED

    def owner(self, row: int) -> Element | None:
        """Element of the nearest row above that has one."""
        parent = self.document.parents[row]
        if parent < 0:
            return None
        return self.lowered.own[parent] or self.graph.get(self.gids[parent])

    def subtree(self, row: int, verdict: Verdict) -> int:
        """Give the row and all its content one verdict; return the row after."""
        end, above = self.document.ends[row], self.document.parents[row]
        gid = self.gids[row] or (self.gids[above] if above >= 0 else "")
        if end == row + 1:
            self.verdicts[row], self.gids[row] = verdict, gid
        else:
            self.verdicts[row:end] = [verdict] * (end - row)
            self.gids[row:end] = [gid] * (end - row)
        return end

    def next_row(self, row: int) -> int:
        """Where the walk goes on: after the row's content if that has its verdict already."""
        following = row + 1
        end = self.document.ends[row]
        return end if following < end and self.verdicts[following] is not None else following

    def approximate(self, row: int, lost: str) -> None:
        """The row is in the graph without part of its meaning."""
        self.verdicts[row] = Verdict.APPROXIMATED
        self.lost[row] = lost

    # -- ids and names -------------------------------------------------------------------------

    def new_id(self, row: int, owner: str, feature: str) -> str:
        """Id for the row's element: its own, else one that its place tells."""
        id = self.document.attributes[row].get(self.document.id_key)
        if not id:
            return derived_id(owner or self.document.name, self._position(owner, feature))
        known = self.unit.graph_id(self.document.name, id)
        if id in self.document.repeated and known in self.graph:
            self._report_repeated(row, id)
            return derived_id(known, str(self.document.ordinals[row]))
        return known

    def _position(self, owner: str, feature: str) -> str:
        number = self._positions.get((owner, feature), 0)
        self._positions[owner, feature] = number + 1
        return f"{feature}[{number}]"

    def _report_repeated(self, row: int, id: str) -> None:
        if self.document.is_in_extension(row):
            return
        subject = Subject(self.qualified_name(row), id, self.place(row))
        self.sink.report(rules.REPEATED_ID, subject, id=id, file=self.document.name)

    def qualified_name(self, row: int) -> str:
        """Name of a row, also of one that has no element of its own."""
        if self.lowered.own[row]:
            return self.graph.qualified_name(self.graph[self.gids[row]])
        owner = self.owner(row)
        name = self.document.attributes[row].get("name") or f"<{self.document.features[row]}>"
        return f"{self.graph.qualified_name(owner)}::{name}" if owner is not None else name

    def place(self, row: int) -> Place:
        """Place of the row."""
        return Place(self.document.name, self.document.ordinals[row])
