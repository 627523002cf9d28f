"""Readers of metaclasses that become elements and have something special to them."""

from collections.abc import Callable

from sysmlc.diagnostics import Verdict
from sysmlc.frontends.xmi import metaclasses
from sysmlc.frontends.xmi.context import Completion, Context
from sysmlc.frontends.xmi.making import make

Reader = Callable[[Context, int], None]


def reading(type_name: str, complete: Completion) -> Reader:
    """A reader of one metaclass: the element as the tables say, then what ``complete`` adds."""
    kind, subkind = metaclasses.KINDS[type_name]

    def read(context: Context, row: int) -> None:
        feature = context.document.features[row]
        if make(context, row, kind, subkind, type_name, feature):
            complete(context, context.graph[context.gids[row]], row)
        else:
            context.subtree(row, Verdict.UNSUPPORTED)

    return read
