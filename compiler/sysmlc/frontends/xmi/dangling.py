"""Reports references that no edge follows and whose target does not exist.

Most of them repeat the reference of the other end, or ownership (``incoming``, ``association``),
but their targets must exist nevertheless. Handlers note the targets that are not in their own file;
targets that no file of the unit defines are reported once for each element and feature.
"""

from collections.abc import Collection

from sysmlc.diagnostics import Place, Subject
from sysmlc.frontends.xmi import rules, uml_features
from sysmlc.frontends.xmi.context import Context, UncheckedReference
from sysmlc.frontends.xmi.vocabulary import to_snake_case
from sysmlc.ir import Element

_REDUNDANT_KEYS = frozenset(map(to_snake_case, uml_features.REDUNDANT_REFERENCES))


def check_references_inside(context: Context, row: int, followed: Collection[str] = ()) -> None:
    """Note the references of a row and its content, which become no elements.

    Nothing else states the references named *followed*, so that their loss is an error.
    """
    document = context.document
    for inner in range(row, document.ends[row]):
        for name, value in document.attributes[inner].items():
            if name in uml_features.NAMING or name in followed:
                context.defer_check(inner, name, value, name not in followed)
        idref = document.idref(inner)
        if idref and inner != row:
            feature = document.features[inner]
            context.defer_check(document.parents[inner], feature, idref, feature not in followed)


def select_existing(context: Context, element: Element, key: str, targets: list[str]) -> list[str]:
    """Return the ids of the attribute *key* that exist, and note the others to report them."""
    ids = context.document.ids
    if key in uml_features.CHECKED_BY_RESOLVE or all(target in ids for target in targets):
        return targets
    missing = [target for target in targets if _is_missing(context, target)]
    if missing:
        reference = UncheckedReference(
            element.id, element.ordinal, key, missing, key in _REDUNDANT_KEYS
        )
        context.unchecked_references.append(reference)
    return [target for target in targets if target not in missing]


def report_dangling(context: Context) -> None:
    """Report targets that no file of the unit has; all documents must have been lowered."""
    groups: dict[tuple[int, str, bool], list[UncheckedReference]] = {}
    for reference in context.unchecked_references:
        missing = [target for target in reference.targets if _is_missing(context, target)]
        if missing:
            key = reference.ordinal, reference.feature, reference.is_redundant
            groups.setdefault(key, []).append(reference._replace(targets=missing))
    for references in groups.values():
        targets = [target for reference in references for target in reference.targets]
        _report(context, references[0], targets)


def _is_missing(context: Context, target: str) -> bool:
    return context.unit.find_target(context.file, target, False) is None


def _report(context: Context, first: UncheckedReference, targets: list[str]) -> None:
    holder = context.graph.get(first.holder)
    place = Place(context.document.name, first.ordinal)
    name = context.graph.qualified_name(holder) if holder is not None else context.document.name
    rule = rules.DANGLING_OPPOSITE if first.is_redundant else rules.DANGLING_FEATURE
    others = len(dict.fromkeys(targets)) - 1
    context.sink.report(
        rule,
        Subject(name, first.holder, place),
        feature=first.feature,
        element=name,
        target=targets[0],
        others=f" and {others} more that do" if others else ", which does",
    )
