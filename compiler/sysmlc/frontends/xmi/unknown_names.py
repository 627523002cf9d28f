"""Reports attributes, values and tags that UML or SysML does not have, each once for each file."""

from collections.abc import Iterable, Iterator, Mapping
from itertools import islice
from typing import NamedTuple, TypeVar

from sysmlc.diagnostics import Rule, Subject, Verdict
from sysmlc.frontends.xmi import namespaces, rules
from sysmlc.frontends.xmi.uml_features import FEATURES, VALUES, is_misplaced
from sysmlc.frontends.xmi.unit import File
from sysmlc.frontends.xmi.vocabulary import NOTATION_FEATURES
from sysmlc.sources import DEFAULT_LIMITS
from sysmlc.support.suggestions import did_you_mean

_MAX_REPORTS = 50
"""Number of names that are reported one by one; the last report counts the others."""

_XMI_ATTRIBUTES = frozenset({"id", "idref", "href", "label", "nil", "type", "uuid", "version"})
"""Attributes in the namespace of XMI (XMI 2.5.1, clause 7.5.2)."""

TOOL_ATTRIBUTES = frozenset({"element", "href", "nsURI"})
"""Attributes of no metaclass that are read: the target of MagicDraw's ElementValue, a reference to
another file, and Ecore's namespace of a profile."""

_PLACES_OF_TOOLS = frozenset(
    {("Constraint", "specification"), ("ControlFlow", "guard"), ("ObjectFlow", "guard")}
)
"""Metaclasses with attributes that are children in UML, but that tools such as StarUML write."""

_READ = (Verdict.MAPPED, Verdict.APPROXIMATED, Verdict.EXTERNAL)

_TAG_WORDS = (
    "allocatedfrom allocatedto bindingpath boundend concern concernlist concerns connector "
    "criterion definitionuri derived derivedfrom description dimension direction end "
    "featuredirection id isatomic isconjugated isencapsulated itemproperty language languages "
    "lower master max mean member method methods min name onnestedport ordered orderedmember "
    "original presentation principal probability propertypath purpose quantitykind rate "
    "reference refinedby refines risk satisfiedby satisfies size source sourcecontext "
    "sourcepropertypath stakeholder stakeholders standarddeviation structuralfeature symbol "
    "targetcontext targetpropertypath text tracedfrom tracedto unit upper verdict verifiedby "
    "verifies verifymethod viewpoint"
)
_SYSML_TAGS = frozenset(_TAG_WORDS.split(" "))
"""Properties of all stereotypes of SysML 1.0 to 1.7, in lower case because tools capitalise them
differently."""

_NO_TAGS = ("base_", "__EA")

_Key = TypeVar("_Key")


class _UnknownAttribute(NamedTuple):
    """An attribute that its metaclass lacks; *metaclass* is empty if no metaclass has it."""

    name: str
    metaclass: str = ""

    @property
    def rule(self) -> Rule:
        """The rule that reports the attribute."""
        return rules.MISPLACED_ATTRIBUTE if self.metaclass else rules.UNKNOWN_ATTRIBUTE


def _list_reports(
    groups: Mapping[_Key, list[int]], noun: str
) -> Iterator[tuple[_Key, list[int], tuple[str, ...]]]:
    """Yield key, rows and notes of the first groups; the last note counts the groups omitted."""
    remaining = len(groups) - _MAX_REPORTS
    for number, (key, rows) in enumerate(islice(groups.items(), _MAX_REPORTS), 1):
        is_last = number == _MAX_REPORTS and remaining > 0
        yield key, rows, (f"{remaining} more such {noun} are in the file",) if is_last else ()


def _format_others(rows: list[int]) -> str:
    return f" and {len(rows) - 1} more" if len(rows) > 1 else ""


def suggest(name: str, names: Iterable[str]) -> str:
    """Return a help text with the most similar name, or the empty string if none is similar."""
    suggestion = did_you_mean(name, names)
    return suggestion if suggestion.startswith("did you mean") else ""


# -- attributes ------------------------------------------------------------------------------------


def report_unknown_attributes(file: File) -> None:
    """Report attributes that the metaclass of their element lacks, and approximate the elements.

    Tags of stereotypes, the content of extensions, and attributes in namespaces of tools are no
    attributes of UML.
    """
    document, applications = file.document, frozenset(file.applications)
    # Nearly all files have only known attributes: the distinct names are checked first.
    names_by_type: dict[str, set[str]] = {}
    for row, type_name in enumerate(document.types):
        if row not in applications:
            names_by_type.setdefault(type_name, set()).update(document.attributes[row])
    if not any(_check(type_, name) for type_, names in names_by_type.items() for name in names):
        return
    groups: dict[_UnknownAttribute, list[int]] = {}
    for row, unknown in _find_rows(file, applications):
        if file.verdicts[row] is Verdict.MAPPED:
            file.approximate(row, unknown[0].rule, f"read without {_format_names(unknown)}")
        for attribute in unknown:
            groups.setdefault(attribute, []).append(row)
    for attribute, rows, notes in _list_reports(groups, "names"):
        _report_attribute(file, attribute, rows, notes)


def _list_unknown(metaclass: str, names: Iterable[str]) -> list[_UnknownAttribute]:
    """Return attributes that the metaclass lacks; those that other metaclasses have come last."""
    checked = (_check(metaclass, name) for name in islice(names, DEFAULT_LIMITS.attributes))
    unknown = [attribute for attribute in checked if attribute is not None]
    return sorted(unknown, key=lambda attribute: attribute.metaclass != "")


def _check(metaclass: str, name: str) -> _UnknownAttribute | None:
    if not _is_known(name):
        return _UnknownAttribute(name)
    is_excepted = name in TOOL_ATTRIBUTES or (metaclass, name) in _PLACES_OF_TOOLS
    if name in FEATURES and not is_excepted and is_misplaced(metaclass, name):
        return _UnknownAttribute(name, metaclass)
    return None


def _is_known(name: str) -> bool:
    if name in FEATURES:
        return True
    namespace, _, local = name.rpartition("}")
    if namespaces.is_xmi(namespace):
        return local in _XMI_ATTRIBUTES
    return bool(namespace) or name in TOOL_ATTRIBUTES


def _find_rows(
    file: File, applications: frozenset[int]
) -> Iterator[tuple[int, list[_UnknownAttribute]]]:
    """Yield the rows of the model that have unknown attributes, with these."""
    document = file.document
    for row, (type_name, values) in enumerate(
        zip(document.types, document.attributes, strict=True)
    ):
        # The file does not write the type of a retyped row, so that no attribute is misplaced.
        unknown = _list_unknown("" if row in document.retyped else type_name, values)
        is_read = bool(unknown) and row not in applications and file.verdicts[row] in _READ
        if is_read and not _is_beside_model(file, row, applications):
            yield row, unknown


def _is_beside_model(file: File, row: int, applications: frozenset[int]) -> bool:
    """Whether the row is the root of XMI, or inside notation or an application."""
    document = file.document
    if row == 0:
        return namespaces.is_xmi(document.namespace(0))
    while row > 0 and row not in applications and document.features[row] not in NOTATION_FEATURES:
        row = document.parents[row]
    return row > 0


def _format_names(unknown: list[_UnknownAttribute]) -> str:
    names = ", ".join(f"'{_format_name(attribute.name)}'" for attribute in unknown[:3])
    return f"{names} and {len(unknown) - 3} more" if len(unknown) > 3 else names


def _format_name(name: str) -> str:
    return name if "}" not in name else f"xmi:{name.rpartition('}')[2]}"


def _report_attribute(
    file: File, attribute: _UnknownAttribute, rows: list[int], notes: tuple[str, ...]
) -> None:
    name, metaclass = attribute
    element = file.qualified_name(rows[0])
    known_names = [f"xmi:{known}" for known in _XMI_ATTRIBUTES] if "}" in name else FEATURES
    file.unit.sink.report(
        attribute.rule,
        file.subject(rows[0]),
        notes=notes,
        help="" if metaclass else suggest(_format_name(name), known_names),
        attribute=_format_name(name),
        element=element,
        others=_format_others(rows),
        **({"metaclass": metaclass} if metaclass else {}),
    )


# -- values ----------------------------------------------------------------------------------------


def report_unknown_values(file: File) -> None:
    """Report values that UML does not list for an attribute; their elements are approximated."""
    groups: dict[tuple[str, str], list[int]] = {}
    for row, name, value in file.unknown_values:
        groups.setdefault((name, value), []).append(row)
        if file.verdicts[row] is Verdict.MAPPED:
            reason = f"'{name}' has a value that UML does not know"
            file.approximate(row, rules.UNKNOWN_VALUE, reason)
    for (name, value), rows, notes in _list_reports(groups, "values"):
        element = file.qualified_name(rows[0])
        file.unit.sink.report(
            rules.UNKNOWN_VALUE,
            file.subject(rows[0]),
            notes=notes,
            attribute=name,
            element=element,
            others=_format_others(rows),
            value=value,
            known=", ".join(VALUES[name]),
        )


# -- tags of stereotypes ---------------------------------------------------------------------------


def is_sysml_tag(name: str) -> bool:
    """Whether a stereotype of SysML has a tag of this name."""
    return name.lower() in _SYSML_TAGS


def report_unknown_tags(file: File) -> None:
    """Report tags on stereotypes of SysML that SysML does not have; these are approximated.

    Tags of other profiles are not checked: those profiles are often not available.
    """
    document = file.document
    groups: dict[tuple[str, str], list[int]] = {}
    for row in file.applications:
        tags = _list_unknown_tags(document.attributes[row])
        tags += _list_unknown_tags(document.features[child] for child in document.children(row))
        is_read = bool(tags) and file.element_ids[row] in file.unit.graph
        if is_read and namespaces.is_sysml(document.namespace(row)):
            if file.verdicts[row] is Verdict.MAPPED:
                file.approximate(row, rules.UNKNOWN_TAG, f"SysML has no tag '{tags[0]}'")
            for tag in dict.fromkeys(tags):
                groups.setdefault((document.features[row], tag), []).append(row)
    for (stereotype, tag), rows, notes in _list_reports(groups, "tags"):
        _report_tag(file, stereotype, tag, rows, notes)


def _list_unknown_tags(names: Iterable[str]) -> list[str]:
    return [
        name
        for name in names
        if "}" not in name and not name.startswith(_NO_TAGS) and not is_sysml_tag(name)
    ]


def _report_tag(
    file: File, stereotype: str, tag: str, rows: list[int], notes: tuple[str, ...]
) -> None:
    application = file.unit.graph[file.element_ids[rows[0]]]
    element = file.unit.graph.qualified_name(file.unit.graph.owner(application) or application)
    file.unit.sink.report(
        rules.UNKNOWN_TAG,
        Subject(element, application.id, file.locate(rows[0])),
        notes=notes,
        help=suggest(tag, _SYSML_TAGS),
        tag=tag,
        stereotype=stereotype,
        element=element,
        others=_format_others(rows),
    )
