"""References that no edge follows: their targets must exist in a file of the unit.

Handlers note such references whose target is not in their own file. Most of them repeat the
reference of the other end, or ownership (``incoming``, ``association``). Targets that no file of
the unit defines are reported once for each element and feature.
"""

from collections.abc import Collection

from sysmlc.diagnostics import Place, Subject
from sysmlc.frontends.xmi import rules, uml_features
from sysmlc.frontends.xmi import vocabulary as v
from sysmlc.frontends.xmi.unit import File, UncheckedReference
from sysmlc.frontends.xmi.vocabulary import to_snake_case
from sysmlc.ir import Element

_REDUNDANT_KEYS = frozenset(map(to_snake_case, uml_features.REDUNDANT_REFERENCES))


def check_references_inside(file: File, row: int, followed: Collection[str] = ()) -> None:
    """Defer a check of the references in a row and its content that become no elements.

    Targets that are missing are reported. References of the features *followed* are not redundant:
    no other feature states them, so a missing target is an error. Notation has no references: the
    ``source`` of an annotation of Eclipse is the URI of a tool.
    """
    document = file.document
    notation_end = row
    for inner in range(row, document.ends[row]):
        if inner < notation_end:
            continue
        if document.features[inner] in v.NOTATION_FEATURES:
            notation_end = document.ends[inner]
            continue
        for name, value in document.attributes[inner].items():
            if name in uml_features.NAMING or name in followed:
                file.defer_check(inner, name, value, name not in followed)
        idref = document.idref(inner)
        if idref and inner != row:
            feature = document.features[inner]
            file.defer_check(document.parents[inner], feature, idref, feature not in followed)


def select_existing(file: File, element: Element, key: str, targets: list[str]) -> list[str]:
    """Return the ids of the attribute *key* that exist, and note the others to report them."""
    ids = file.document.ids
    if key in uml_features.CHECKED_BY_RESOLVE or all(target in ids for target in targets):
        return targets
    missing = [target for target in targets if _is_missing(file, target)]
    if missing:
        reference = UncheckedReference(
            element.id, element.ordinal, key, missing, key in _REDUNDANT_KEYS
        )
        file.unchecked_references.append(reference)
    return [target for target in targets if target not in missing]


def report_dangling(file: File) -> None:
    """Report targets that no file of the unit has; all documents must have been lowered."""
    groups: dict[tuple[int, str, bool], list[UncheckedReference]] = {}
    for reference in file.unchecked_references:
        missing = [target for target in reference.targets if _is_missing(file, target)]
        if missing:
            key = reference.ordinal, reference.feature, reference.is_redundant
            groups.setdefault(key, []).append(reference._replace(targets=missing))
    for references in groups.values():
        targets = [target for reference in references for target in reference.targets]
        _report(file, references[0], targets)


def _is_missing(file: File, target: str) -> bool:
    return file.unit.find_target(file, target, False) is None


def _report(file: File, first: UncheckedReference, targets: list[str]) -> None:
    holder = file.unit.graph.get(first.holder)
    place = Place(file.document.name, first.ordinal)
    name = file.unit.graph.qualified_name(holder) if holder is not None else file.document.name
    rule = rules.DANGLING_OPPOSITE if first.is_redundant else rules.DANGLING_FEATURE
    others = len(dict.fromkeys(targets)) - 1
    file.unit.sink.report(
        rule,
        Subject(name, first.holder, place),
        cause=f"missing {targets[0]}" if others == 0 else "",
        feature=first.feature,
        element=name,
        target=targets[0],
        others=f" and {others} more that do" if others else ", which does",
    )
