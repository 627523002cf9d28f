"""Attributes that neither UML nor XMI has: each name is told once for each file.

Only the shapes of rows are looked at; the rows themselves where a shape has such a name.
"""

from collections.abc import Iterator
from itertools import compress, islice

from sysmlc.diagnostics import Subject, Verdict
from sysmlc.frontends.xmi import namespaces, rules
from sysmlc.frontends.xmi.context import Context
from sysmlc.frontends.xmi.naming import FEATURES
from sysmlc.frontends.xmi.vocabulary import NOTATION_FEATURES
from sysmlc.sources import DEFAULT_LIMITS

_OF_XMI = frozenset({"id", "idref", "href", "label", "nil", "type", "uuid", "version"})
"""Attributes in the namespace of XMI (XMI 2.5.1, clause 7.5.2)."""

_WITH_READERS = frozenset({"element", "href", "nsURI"})
"""Attributes of no metaclass: what MagicDraw's ElementValue names, a reference to another file,
and Ecore's name of a profile."""

_MOST = 50
"""So many names are told one by one, the others as a number."""

_READ = (Verdict.MAPPED, Verdict.APPROXIMATED, Verdict.EXTERNAL)


def report(context: Context) -> None:
    """Report them; the elements that have them are approximated.

    Tags of stereotypes, what tools keep in extensions, and attributes in namespaces of their
    own are no attributes of UML.
    """
    shapes = [_unknown(names) for _, _, names in context.document.shapes]
    if not any(shapes):
        return
    found: dict[str, list[int]] = {}
    for row, names in _rows(context, shapes):
        _approximate(context, row, names)
        for name in names:
            found.setdefault(name, []).append(row)
    more = len(found) - _MOST
    for number, (name, rows) in enumerate(islice(found.items(), _MOST), 1):
        _report(context, name, rows, more if number == _MOST else 0)


def _unknown(names: tuple[str, ...]) -> tuple[str, ...]:
    looked_at = islice(names, DEFAULT_LIMITS.attributes)
    return tuple(name for name in looked_at if name not in FEATURES and not _is_known(name))


def _is_known(name: str) -> bool:
    namespace, _, local = name.rpartition("}")
    if namespaces.is_xmi(namespace):
        return local in _OF_XMI
    return bool(namespace) or name in _WITH_READERS


def _rows(context: Context, shapes: list[tuple[str, ...]]) -> Iterator[tuple[int, tuple[str, ...]]]:
    """Rows that are of UML and have such attributes, with these."""
    document, applied = context.document, frozenset(context.applications)
    numbers = document.shape_numbers
    # The last one is for rows whose shape no longer counts.
    is_wanted = [*map(bool, shapes), True]
    for row in compress(range(len(numbers)), map(is_wanted.__getitem__, numbers)):
        names = shapes[numbers[row]] if numbers[row] >= 0 else _unknown_of(context, row)
        is_read = bool(names) and row not in applied and context.verdicts[row] in _READ
        if is_read and not _is_beside_the_model(context, row, applied):
            yield row, names


def _unknown_of(context: Context, row: int) -> tuple[str, ...]:
    return _unknown(tuple(context.document.attributes[row]))


def _is_beside_the_model(context: Context, row: int, applied: frozenset[int]) -> bool:
    """Whether it is the envelope of XMI, or inside notation or an application."""
    document = context.document
    if row == 0:
        return namespaces.is_xmi(document.namespace(0))
    while row > 0 and row not in applied and document.features[row] not in NOTATION_FEATURES:
        row = document.parents[row]
    return row > 0


def _approximate(context: Context, row: int, names: tuple[str, ...]) -> None:
    if context.verdicts[row] is Verdict.MAPPED:
        context.verdicts[row] = Verdict.APPROXIMATED
        written = ", ".join(f"'{_shown(name)}'" for name in names[:3])
        more = f" and {len(names) - 3} more" if len(names) > 3 else ""
        context.told[row] = rules.UNKNOWN_ATTRIBUTE, f"read without {written}{more}"


def _report(context: Context, name: str, rows: list[int], more: int) -> None:
    first, others = rows[0], len(rows) - 1
    element = context.qualified_name(first)
    context.sink.report(
        rules.UNKNOWN_ATTRIBUTE,
        Subject(element, context.gids[first], context.place(first)),
        notes=(f"{more} more such names are in the file",) if more > 0 else (),
        help=_near(name),
        attribute=_shown(name),
        element=element,
        others=f" and {others} more" if others else "",
    )


def _shown(name: str) -> str:
    return name if "}" not in name else f"xmi:{name.rpartition('}')[2]}"


def _near(name: str) -> str:
    """Help that names the feature most like this one; empty where there is none."""
    from sysmlc.suggest import did_you_mean

    known = [f"xmi:{one}" for one in _OF_XMI] if "}" in name else FEATURES
    told = did_you_mean(_shown(name), known)
    return told if told.startswith("did you mean") else ""
