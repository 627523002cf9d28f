"""The way that most rows of a large file go: elements made as the plan of their shape says."""

from collections.abc import Callable, Mapping

from sysmlc.diagnostics import Verdict
from sysmlc.frontends.xmi import vocabulary as v
from sysmlc.frontends.xmi.context import Context
from sysmlc.frontends.xmi.shapes import plan_of, reader_of
from sysmlc.frontends.xmi.structure import reference

Way = Callable[[Context, int], int]
"""Lowers one row, perhaps with its content; returns the first row after."""

Reader = Callable[[Context, int], None]
"""Reads a row that is no element, and its content."""


class Swift:
    """Lowers the rows of one document, those whose shape says what to do at once."""

    def __init__(
        self, context: Context, features: Mapping[str, Reader], types: Mapping[str, Reader]
    ) -> None:
        self._context = context
        document = context.document
        keys = document.id_key, document.idref_key
        shapes = document.shapes
        # The last ones are those of rows without a shape.
        self._plans = [*(plan_of(shape, keys, features, types) for shape in shapes), None]
        self._readers = [*(reader_of(shape, keys, features, _refer) for shape in shapes), None]
        if "ElementValue" in document.types:
            # The value of an ElementValue (MagicDraw) is the name of whatever element it names.
            self._plans = [plan and plan._replace(is_done=False) for plan in self._plans]

    def walk(self, row: int, root: Way, other: Way) -> None:
        """Lower all rows from this one on: roots by ``root``, rows without a plan by ``other``.

        Roots are this row and what is right below the row before. Everything is in one frame,
        because a call for each row, or for each attribute, would cost as much as the work
        itself: half of the budget of the whole front end.
        """
        context = self._context
        document, lowered, links = context.document, context.lowered, context.unit.links
        shapes, attributes, features = (
            document.shape_numbers,
            document.attributes,
            document.features,
        )
        parents, ordinals, row_of = document.parents, document.ordinals, document.ids.get
        gids, own, verdicts = context.gids, lowered.own, context.verdicts
        clashes, plans, new = context.unit.clashes, self._plans, context.graph.new
        file, id_key, mapped = document.name, document.id_key, Verdict.MAPPED
        links.begin(lowered)
        add_edge, add_source = links.edges.append, links.sources.append
        add_target, add_found, add_row = (
            links.targets.append,
            links.found.append,
            links.rows.append,
        )
        end, above_roots = len(shapes), row - 1
        while row < end:
            above, plan = parents[row], plans[shapes[row]]
            if plan is None or above == above_roots:
                row = root(context, row) if above == above_roots else self._read(row, other)
                continue
            kind, type_name, owners, said, detail, may_be_metaclass, is_done, steps = plan
            values = attributes[row]
            owner, id, name = gids[above], values[id_key], values.get("name", "")
            is_other = may_be_metaclass and name.startswith("base_")
            if is_other or id in clashes or (owners and not context.may_own(owner, kind)):
                row = other(context, row)
                continue
            made = new(id, kind, name, owner or None, ordinals[row], file, said.copy())
            if made is None:
                row = other(context, row)
                continue
            gids[row] = id
            own[row] = made
            verdicts[row] = mapped
            if detail is not None:
                detail(context, made, row, type_name, features[row])
            for step, is_id, is_list, edge, key in steps:
                value = values[step]
                at = row_of(value) if is_id else None
                if at is not None:
                    if edge is not None:
                        add_edge(edge)
                        add_source(made)
                        add_target(value)
                        add_found(at)
                        add_row(row)
                elif key is None:
                    context.listed(made, row, step, edge, not is_id, is_list)
                elif value != key.default and not key.keep(made, value):
                    context.odd_values.append((row, step, value))
            if is_done:
                attributes[row] = _TAKEN
            row += 1

    def _read(self, row: int, other: Way) -> int:
        """A row of a shape without a plan."""
        context = self._context
        document = context.document
        reader = self._readers[document.shape_numbers[row]]
        if reader is None:
            return other(context, row)
        context.gids[row] = context.gids[document.parents[row]]
        context.verdicts[row] = Verdict.MAPPED
        reader(context, row)
        return document.ends[row]


def _refer(context: Context, row: int) -> None:
    """A row that names another element: nearly all are an edge between two of the same file."""
    document, own, feature = context.document, context.lowered.own, context.document.features[row]
    owner, target = own[document.parents[row]], document.idref(row)
    at = None if "href" in document.attributes[row] else document.ids.get(target)
    if owner is None or at is None or document.ends[row] != row + 1 or feature in _OWNING:
        reference(context, row, feature)
        return
    edge = v.SPECIAL.get((owner.kind, feature)) if feature in v.AMBIGUOUS else None
    edge = edge or v.REFERENCES.get(feature)
    backwards = v.REVERSED.get((owner.kind, feature)) if edge is None else None
    if edge is None and backwards is None:
        reference(context, row, feature)
    elif edge is not None:
        context.unit.links.add(edge, owner, target, at, row)
    elif backwards is not None:
        context.unit.links.add_reversed(backwards, owner, target, at, row)


_OWNING = frozenset({"packagedElement", "nestedPackage"})
"""Features of what an element owns, which are no references even if they look so."""

_TAKEN: dict[str, str] = {}
"""Attributes of rows that nobody looks at again: what is taken need not be kept in memory."""
