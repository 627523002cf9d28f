"""Attributes that neither UML nor XMI has, or UML elsewhere: each is told once for each file."""

from collections.abc import Iterable, Iterator
from itertools import islice

from sysmlc.diagnostics import Rule, Subject, Verdict
from sysmlc.frontends.xmi import namespaces, rules
from sysmlc.frontends.xmi.context import Context
from sysmlc.frontends.xmi.feature_names import FEATURES
from sysmlc.frontends.xmi.uml_features import is_misplaced
from sysmlc.frontends.xmi.vocabulary import NOTATION_FEATURES
from sysmlc.sources import DEFAULT_LIMITS

_OF_XMI = frozenset({"id", "idref", "href", "label", "nil", "type", "uuid", "version"})
"""Attributes in the namespace of XMI (XMI 2.5.1, clause 7.5.2)."""

WITH_READERS = frozenset({"element", "href", "nsURI"})
"""Attributes of no metaclass: what MagicDraw's ElementValue names, a reference to another file,
and Ecore's name of a profile."""

_MOST = 50
"""So many names are told one by one, the others as a number."""

_READ = (Verdict.MAPPED, Verdict.APPROXIMATED, Verdict.EXTERNAL)

_Odd = tuple[str, str]
"""Name of an attribute, and the metaclass that does not have it; empty where none has it."""


def report(context: Context) -> None:
    """Report them; the elements that have them are approximated.

    Tags of stereotypes, what tools keep in extensions, and attributes in namespaces of their
    own are no attributes of UML.
    """
    document = context.document
    elements = zip(document.types, document.attributes, strict=True)
    written = {(type_name, name) for type_name, values in elements for name in values}
    if not any(_unknown(type_name, [name]) for type_name, name in written):
        return
    found: dict[_Odd, list[int]] = {}
    for row, odd in _rows(context):
        _approximate(context, row, odd)
        for one in odd:
            found.setdefault(one, []).append(row)
    more = len(found) - _MOST
    for number, (one, rows) in enumerate(islice(found.items(), _MOST), 1):
        _report(context, one, rows, more if number == _MOST else 0)


def _unknown(metaclass: str, names: Iterable[str]) -> tuple[_Odd, ...]:
    looked_at = tuple(islice(names, DEFAULT_LIMITS.attributes))
    unknown = [(name, "") for name in looked_at if not _is_known(name)]
    known = [name for name in looked_at if name in FEATURES and name not in WITH_READERS]
    return (*unknown, *((name, metaclass) for name in known if is_misplaced(metaclass, name)))


def _is_known(name: str) -> bool:
    if name in FEATURES:
        return True
    namespace, _, local = name.rpartition("}")
    if namespaces.is_xmi(namespace):
        return local in _OF_XMI
    return bool(namespace) or name in WITH_READERS


def _rows(context: Context) -> Iterator[tuple[int, tuple[_Odd, ...]]]:
    """Rows that are of UML and have such attributes, with these."""
    document, applied = context.document, frozenset(context.applications)
    for row, (type_name, values) in enumerate(
        zip(document.types, document.attributes, strict=True)
    ):
        # Of a row that was given another type than is written: what no metaclass has.
        odd = _unknown("" if row in document.retyped else type_name, values)
        is_read = bool(odd) and row not in applied and context.verdicts[row] in _READ
        if is_read and not _is_beside_the_model(context, row, applied):
            yield row, odd


def _is_beside_the_model(context: Context, row: int, applied: frozenset[int]) -> bool:
    """Whether it is the envelope of XMI, or inside notation or an application."""
    document = context.document
    if row == 0:
        return namespaces.is_xmi(document.namespace(0))
    while row > 0 and row not in applied and document.features[row] not in NOTATION_FEATURES:
        row = document.parents[row]
    return row > 0


def _approximate(context: Context, row: int, odd: tuple[_Odd, ...]) -> None:
    if context.verdicts[row] is Verdict.MAPPED:
        context.verdicts[row] = Verdict.APPROXIMATED
        written = ", ".join(f"'{_shown(name)}'" for name, _ in odd[:3])
        more = f" and {len(odd) - 3} more" if len(odd) > 3 else ""
        context.told[row] = _rule(odd[0]), f"read without {written}{more}"


def _rule(one: _Odd) -> Rule:
    return rules.MISPLACED_ATTRIBUTE if one[1] else rules.UNKNOWN_ATTRIBUTE


def _report(context: Context, one: _Odd, rows: list[int], more: int) -> None:
    name, metaclass = one
    first, others = rows[0], len(rows) - 1
    element = context.qualified_name(first)
    context.sink.report(
        _rule(one),
        Subject(element, context.gids[first], context.place(first)),
        notes=(f"{more} more such names are in the file",) if more > 0 else (),
        help="" if metaclass else _near(name),
        attribute=_shown(name),
        element=element,
        others=f" and {others} more" if others else "",
        **({"metaclass": metaclass} if metaclass else {}),
    )


def _shown(name: str) -> str:
    return name if "}" not in name else f"xmi:{name.rpartition('}')[2]}"


def _near(name: str) -> str:
    """Help that names the feature most like this one; empty where there is none."""
    from sysmlc.support.suggestions import did_you_mean

    known = [f"xmi:{one}" for one in _OF_XMI] if "}" in name else FEATURES
    told = did_you_mean(_shown(name), known)
    return told if told.startswith("did you mean") else ""
