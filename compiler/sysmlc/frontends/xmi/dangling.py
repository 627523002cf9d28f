"""References that lead nowhere although no reader follows them: no name of an element is lost.

Most say only what the other end says, or what ownership says (``incoming``, ``association``):
what they name must exist all the same. Readers note what they do not follow while they walk;
what no file of the unit has is told once for each element and feature.
"""

from sysmlc.diagnostics import Place, Subject
from sysmlc.frontends.xmi import feature_names as naming
from sysmlc.frontends.xmi import rules
from sysmlc.frontends.xmi.context import Context
from sysmlc.frontends.xmi.loose import Loose, Names
from sysmlc.frontends.xmi.vocabulary import snake
from sysmlc.ir import Element

_SAID_ELSEWHERE = frozenset(map(snake, naming.SAID_ELSEWHERE))


def look_inside(context: Context, row: int, lost: Names = ()) -> None:
    """Note the dangling references of a row, and of all inside, that become no elements.

    Those that ``lost`` names are said nowhere else.
    """
    document = context.document
    for at in range(row, document.ends[row]):
        for name, value in document.attributes[at].items():
            if name in naming.NAMING or name in lost:
                context.look(at, name, value, name not in lost)
        idref = document.idref(at)
        if idref and at != row:
            feature = document.features[at]
            context.look(document.parents[at], feature, idref, feature not in lost)


def existing(context: Context, element: Element, key: str, targets: list[str]) -> list[str]:
    """The ids kept under ``key`` that lead somewhere; the others are noted."""
    if key in naming.ASKED_LATER or all(target in context.document.ids for target in targets):
        return targets
    missing = [target for target in targets if _is_missing(context, target)]
    if missing:
        is_said = key in _SAID_ELSEWHERE
        context.loose.append(Loose(element.id, element.ordinal, key, missing, is_said))
    return [target for target in targets if target not in missing]


def report(context: Context) -> None:
    """Report what no file of the unit has; all documents must have been read."""
    found: dict[tuple[int, str, bool], list[Loose]] = {}
    for one in context.loose:
        missing = [target for target in one.targets if _is_missing(context, target)]
        if missing:
            key = one.ordinal, one.feature, one.is_said_elsewhere
            found.setdefault(key, []).append(one._replace(targets=missing))
    for uses in found.values():
        _report(context, uses[0], [target for one in uses for target in one.targets])


def _is_missing(context: Context, target: str) -> bool:
    return context.unit.find(context.lowered, target, False) is None


def _report(context: Context, first: Loose, targets: list[str]) -> None:
    holder = context.graph.get(first.holder)
    place = Place(context.document.name, first.ordinal)
    name = context.graph.qualified_name(holder) if holder is not None else context.document.name
    rule = rules.DANGLING_OPPOSITE if first.is_said_elsewhere else rules.DANGLING_FEATURE
    others = len(dict.fromkeys(targets)) - 1
    context.sink.report(
        rule,
        Subject(name, first.holder, place),
        feature=first.feature,
        element=name,
        target=targets[0],
        others=f" and {others} more that do" if others else ", which does",
    )
