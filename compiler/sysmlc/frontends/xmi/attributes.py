"""Attributes of UML elements: edges, attributes of the graph, or values that need no attribute."""

from collections.abc import Mapping
from functools import partial
from types import MappingProxyType
from typing import NamedTuple

from sysmlc.diagnostics import Subject, Verdict
from sysmlc.frontends.xmi import metaclasses, rules, uml_features
from sysmlc.frontends.xmi import vocabulary as v
from sysmlc.frontends.xmi.dangling import select_existing
from sysmlc.frontends.xmi.document import Document, WrittenReference
from sysmlc.frontends.xmi.unit import File, Stage
from sysmlc.frontends.xmi.values import parse_bound, read_opaque, store_alternatives
from sysmlc.ir import AttrValue, Element, Kind
from sysmlc.sources import DEFAULT_LIMITS

_TRUE_OR_ABSENT: Mapping[str, AttrValue] = {**dict.fromkeys(v.TRUE, True), "0": None}
_FALSE_OR_ABSENT: Mapping[str, AttrValue] = {"false": False, "0": False, "1": None}


class _StoredAttribute(NamedTuple):
    """How the graph stores an attribute of UML."""

    name: str
    default: str
    """The text that is not stored."""
    meanings: Mapping[str, AttrValue] | None = None
    """The valid texts and their values; None is a value that needs no attribute."""

    def store(self, element: Element, text: str) -> bool:
        """Set the attribute of the element; return False if *text* is not valid."""
        if self.meanings is None:
            element.attrs[self.name] = text
        elif text in self.meanings:
            value = self.meanings[text]
            if value is not None:
                element.attrs[self.name] = value
        else:
            return False
        return True


_VISIBILITIES = {word: word for word in uml_features.WORDS["visibility"][1:]}

_STORED: Mapping[str, _StoredAttribute] = MappingProxyType(
    {
        **{name: _StoredAttribute(*stored) for name, stored in v.TEXTS.items()},
        "visibility": _StoredAttribute("visibility", "public", _VISIBILITIES),
        **{name: _StoredAttribute(key, "false", _TRUE_OR_ABSENT) for name, key in v.FLAGS.items()},
        **{
            name: _StoredAttribute(key, "true", _FALSE_OR_ABSENT)
            for name, key in v.UNLESS_FALSE.items()
        },
    }
)
"""Attributes that the graph stores under names of its own."""

_HANDLED = frozenset(
    {"partWithPort", "guard", "event", "value"}
    | {"firstEvent", "interactionOperator", "messageKind", "messageSort"}
)
"""Attributes that the handlers of single metaclasses read."""

_PASSED_OVER = (v.REDUNDANT | _HANDLED | {"name"}) - {name for _, name in v.REVERSED}
"""Attributes that no table of edges or attributes of the graph contains."""

_BOUNDS = ("lower", "upper")
"""Derived attributes, which Enterprise Architect writes."""

_BOOLEANS = {"1": "true", "0": "false"}
"""The other ways to write an xs:boolean."""

_OWN_KINDS = {Kind.PSEUDOSTATE: "", Kind.TRANSITION: "external"}
"""Kinds whose attribute ``kind`` is their subkind, and the value that is not stored."""


def lower_attributes(file: File, element: Element, row: int, values: dict[str, str]) -> None:
    """Lower the attributes of a row that has become *element*."""
    for name, value in values.items():
        if name not in _PASSED_OVER and "}" not in name:
            lower_attribute(file, element, row, name, value)
        elif name in v.REDUNDANT:
            file.defer_check(row, name, value)


def lower_attribute(file: File, element: Element, row: int, name: str, value: str) -> None:
    """Lower one attribute or list of references of UML."""
    edge = v.REFERENCES_BY_KIND.get((element.kind, name)) or v.REFERENCES.get(name)
    if edge is not None:
        for target in _limit_targets(file, row, name, value):
            file.add_reference(edge, element.id, WrittenReference(target, row), name)
    elif name in _STORED:
        stored = _STORED[name]
        if value != stored.default and not stored.store(element, value):
            file.unknown_values.append((row, name, value))
    else:
        _lower_other(file, element, row, name, value)


def _limit_targets(file: File, row: int, name: str, value: str) -> list[str]:
    """Return the ids in a list, up to the limit for lists."""
    targets = file.document.split_ids(value)
    most = DEFAULT_LIMITS.references
    if len(targets) > most:
        subject = Subject(file.qualified_name(row), "", file.locate(row))
        file.unit.sink.report(rules.LONG_LIST, subject, feature=name, count=len(targets), most=most)
    return targets[:most]


def _lower_other(file: File, element: Element, row: int, name: str, value: str) -> None:
    reversed_edge = v.REVERSED.get((element.kind, name))
    if name == "specification" and element.kind is Kind.CONSTRAINT:
        # StarUML writes the text here; in UML the value is a child of the constraint.
        element.attrs["body"] = value
    elif reversed_edge is not None:
        for target in value.split():
            reference = WrittenReference(target, row)
            file.add_reference(reversed_edge, element.id, reference, name, is_reversed=True)
    elif name in v.CONDITIONS:
        defer_conditions(file, value.split(), name)
    elif name in _BOUNDS:
        set_bound(file, row, _BOUNDS.index(name), parse_bound(value))
    elif name == "kind" and element.kind in _OWN_KINDS:
        if value != _OWN_KINDS[element.kind]:
            element.attrs["subkind"] = metaclasses.to_kebab_case(value)
    elif name in v.REDUNDANT:
        file.defer_check(row, name, value)
    elif name in uml_features.NAMING:
        defer_ids(file, element, v.to_snake_case(name), file.document.split_ids(value))
    elif name not in _PASSED_OVER:
        _lower_unmapped(file, element, row, name, value)


def _lower_unmapped(file: File, element: Element, row: int, name: str, value: str) -> None:
    """Store an attribute that no table maps, unless it has its default value."""
    if name in uml_features.FLAGS:
        value = _BOOLEANS.get(value, value)
    if value not in uml_features.VALUES.get(name, (value,)):
        file.unknown_values.append((row, name, value))
    elif value != v.default_value(name):
        _store_plain(file, element, v.to_snake_case(name), value)


def _store_plain(file: File, element: Element, key: str, value: str) -> None:
    """Store ids of elements, a truth value, or text."""
    tokens = value.split()
    if tokens and all(token in file.document.ids for token in tokens):
        defer_ids(file, element, key, tokens)
    elif value in ("true", "false"):
        element.attrs[key] = value == "true"
    elif value:
        element.attrs[key] = value


def lower_text(file: File, row: int, feature: str) -> None:
    """Lower a child that contains only text, which stands for an attribute of the same name."""
    owner = file.find_owner(row)
    value = file.document.texts.get(row, "")
    if owner is None:
        file.verdicts[row] = Verdict.UNSUPPORTED
        return
    if feature not in uml_features.FEATURES:
        _report_stray_text(file, row, feature)
    if not value:
        return
    if feature == "name":
        file.unit.graph.rename(owner, value)
    elif feature in ("body", "language") and feature in owner.attrs:
        file.defer(
            Stage.BODIES, partial(_set_body, file.document, owner, file.document.parents[row])
        )
    else:
        lower_attribute(file, owner, row, feature, value)


def _report_stray_text(file: File, row: int, feature: str) -> None:
    name = file.qualified_name(file.document.parents[row])
    subject = Subject(name, file.element_ids[row], file.locate(row))
    file.unit.sink.report(rules.STRAY_TEXT, subject, feature=feature, element=name)
    file.approximate(row, rules.STRAY_TEXT, "kept as text: no feature of UML has its name")


def _set_body(document: Document, element: Element, row: int) -> None:
    """Set the body of an element with several bodies or languages."""
    value = read_opaque(document, row)
    for key, text in (("body", value.value), ("language", value.language)):
        element.attrs.pop(key, None)
        if text:
            element.attrs[key] = text
    store_alternatives(element, value)


# -- attributes that need other elements -----------------------------------------------------------


def set_bound(
    file: File, row: int, index: int, value: AttrValue, *, is_computed: bool = False
) -> None:
    """Set the lower (0) or upper (1) bound of the element of the row."""
    id = file.element_ids[row]
    if id:
        bounds = file.bounds.setdefault(id, [1, 1, False])
        bounds[index], bounds[2] = value, bounds[2] or is_computed


def defer_conditions(file: File, targets: list[str], feature: str) -> None:
    """Mark the constraints with these ids as conditions once all elements exist."""
    file.defer(Stage.ELEMENTS, partial(_mark_conditions, file, targets, v.CONDITIONS[feature]))


def _mark_conditions(file: File, targets: list[str], subkind: str) -> None:
    for target in targets:
        row = file.document.ids.get(target, -1)
        if row >= 0 and file.elements[row]:
            file.unit.graph[file.element_ids[row]].attrs["subkind"] = subkind


def defer_ids(
    file: File, element: Element, key: str, ids: list[str], is_href: bool = False
) -> None:
    """Set an attribute to ids of the graph once all elements exist; *ids* are as written."""
    if ids:
        file.defer(Stage.ELEMENTS, partial(_set_ids, file, element, key, ids, is_href))


def _set_ids(file: File, element: Element, key: str, targets: list[str], is_href: bool) -> None:
    existing = targets if is_href else select_existing(file, element, key, targets)
    ids = [file.unit.find_target_id(file, target, is_href) for target in existing]
    present = tuple(id for id in ids if id is not None)
    if present:
        element.attrs[key] = present if len(present) > 1 or key in v.LISTS else present[0]
