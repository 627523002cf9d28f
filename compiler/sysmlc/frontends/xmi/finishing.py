"""What could only be said when every row of every document was read."""

from sysmlc.frontends.xmi import bounds, dangling
from sysmlc.frontends.xmi import vocabulary as v
from sysmlc.frontends.xmi.context import Context


def finish(context: Context) -> None:
    """What could only be said when every row of every document was read."""
    bounds.write(context)
    for target, subkind in context.late_conditions:
        row = context.document.ids.get(target, -1)
        if row >= 0 and context.lowered.own[row]:
            context.graph[context.gids[row]].attrs["subkind"] = subkind
    for element, key, targets, is_href in context.late:
        there = targets if is_href else dangling.existing(context, element, key, targets)
        found = [context.unit.target_id(context.lowered, t, is_href) for t in there]
        ids = tuple(id for id in found if id is not None)
        if ids:
            element.attrs[key] = ids if len(ids) > 1 or key in v.LISTS else ids[0]
