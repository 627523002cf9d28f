"""The way that most rows of a large file go: elements made as the plan of their shape says."""

from collections.abc import Callable, Mapping

from sysmlc.diagnostics import Verdict
from sysmlc.frontends.xmi.context import Context
from sysmlc.frontends.xmi.shapes import Plan, Shape, plan_of


class _Plans(dict[Shape, Plan | None]):
    """Plans of the shapes that were met so far."""

    def __init__(
        self, context: Context, features: Mapping[str, object], types: Mapping[str, object]
    ) -> None:
        super().__init__()
        # The value of an ElementValue (MagicDraw) is the name of whatever element it names.
        self._are_names_asked = "ElementValue" in context.document.types
        self._keys = context.document.id_key, context.document.idref_key
        self._features = features
        self._types = types

    def __missing__(self, shape: Shape) -> Plan | None:
        made = plan_of(shape, self._keys, self._features, self._types)
        if made is not None and self._are_names_asked:
            made = made._replace(is_done=False)
        self[shape] = made
        return made


Way = Callable[[Context, int], int]
"""Lowers one row, perhaps with its content; returns the first row after."""


class Swift:
    """Lowers the rows of one document, those for which there is a plan at once."""

    def __init__(
        self, context: Context, features: Mapping[str, object], types: Mapping[str, object]
    ) -> None:
        self._context = context
        self._plans = _Plans(context, features, types)

    def walk(self, row: int, root: Way, other: Way) -> None:
        """Lower all rows from this one on: roots by ``root``, rows without a plan by ``other``.

        Roots are this row and what is right below the row before. Everything is in one frame,
        because a call for each row, or for each attribute, would cost as much as the work
        itself: half of the budget of the whole front end.
        """
        context = self._context
        document, lowered, graph, links = (
            context.document,
            context.lowered,
            context.graph,
            context.unit.links,
        )
        features, types, attributes = document.features, document.types, document.attributes
        parents, ordinals, ids = document.parents, document.ordinals, document.ids
        gids, own, verdicts = context.gids, lowered.own, context.verdicts
        clashes, plans, new = context.unit.clashes, self._plans, graph.new
        file, id_key, mapped = document.name, document.id_key, Verdict.MAPPED
        links.begin(lowered)
        add_edge, add_target, add_row = (
            links.edges.append,
            links.targets.append,
            links.rows.append,
        )
        end, above_roots = len(features), row - 1
        while row < end:
            above = parents[row]
            if above == above_roots:
                row = root(context, row)
                continue
            values = attributes[row]
            shape = (features[row], types[row], *values)
            plan = plans[shape]
            if plan is None:
                row = other(context, row)
                continue
            kind, subkind, type_name, owners, detail, may_be_metaclass, is_done, steps = plan
            owner, id, name = gids[above], values[id_key], values.get("name", "")
            is_special = may_be_metaclass and name.startswith("base_")
            if is_special or id in clashes or (owners and not context.may_own(owner, kind)):
                row = other(context, row)
                continue
            made = new(id, kind, name, owner or None, ordinals[row], file)
            if made is None:
                row = other(context, row)
                continue
            if subkind:
                made.attrs = {"subkind": subkind}
            gids[row] = id
            own[row] = 1
            verdicts[row] = mapped
            if detail is not None:
                detail(context, made, row, type_name, shape[0])
            for step, edge, key, default in steps:
                value = values[step]
                if edge is not None and value in ids:
                    add_edge(edge)
                    add_target(value)
                    add_row(row)
                elif not key:
                    context.attribute(made, row, step, value)
                elif value != default:
                    made.attrs[key] = value
            attributes[row] = _TAKEN if is_done else values
            row += 1


_TAKEN: dict[str, str] = {}
"""Attributes of rows that nobody looks at again: what is taken need not be kept in memory."""
