"""Labels of single elements in UML notation (UML 2.5.1, clauses 9 and 11).

The last section makes notes of the comments and constraints of a behaviour.
"""

import re
from collections.abc import Iterable

from sysmlc.backends.plantuml.views import Aliases, Note
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.query import applications, lineage, redefined_features, templates
from sysmlc.ir.query.classifiers import name_value_unit
from sysmlc.support.plantuml_text import format_label, join_rows, wrap_lines

_TOOL_ID = re.compile(r"_\d+_\d+_\d+_[0-9a-f]+_\d+_\d+_\d+|(EAID)?_[\w-]{20,}")
"""Ids as MagicDraw, Papyrus and Enterprise Architect generate them."""
_TOOL_NAMESPACE = re.compile(
    r"https?://www\.magicdraw\.com/(spec/Customization/|schemas/additional_stereotypes)"
)
"""Namespaces of MagicDraw's own stereotypes, such as PartProperty, which repeat the type."""
_PACKAGES = (Kind.PACKAGE, Kind.PROFILE)
_MODIFIERS = ("ordered", "readonly", "static")
_APPLICATION, _PARAMETER = Kind.APPLICATION, Kind.PARAMETER
"""Enumeration members as globals: in Python 3.11 access through the class takes twice as long."""
_ROLE_WORDS = {
    "block": "block",
    "interface block": "interfaceBlock",
    "constraint block": "constraint",
    "value type": "valueType",
    "requirement": "requirement",
    "test case": "testCase",
    "full port": "fullPort",
    "proxy port": "proxyPort",
    "flow port": "flowPort",
    "constraint property": "constraint",
    "unit": "unit",
    "quantity kind": "quantityKind",
}
_KIND_WORDS = {
    Kind.INTERFACE: "interface",
    Kind.COMPONENT: "component",
    Kind.DATA_TYPE: "dataType",
    Kind.ENUMERATION: "enumeration",
    Kind.SIGNAL: "signal",
    Kind.ACTOR: "actor",
    Kind.ITEM: "item",
    Kind.UNIT: "unit",
    Kind.QUANTITY_KIND: "quantityKind",
    Kind.INSTANCE: "instance",
    Kind.REQUIREMENT: "requirement",
    Kind.TEST_CASE: "testCase",
    Kind.STATE_MACHINE: "stateMachine",
    Kind.USE_CASE: "useCase",
    Kind.PACKAGE: "package",
}
_ALWAYS_NAMED = frozenset([Kind.INTERFACE, Kind.ENUMERATION, Kind.SIGNAL, Kind.ACTOR])


def keywords(graph: Graph, element: Element) -> tuple[str, ...]:
    """Return the words in guillemets: applied stereotypes, else the keyword of role or kind.

    A keyword that no stereotype expresses stands before the stereotypes.
    """
    stereotypes = list_stereotypes(graph, element)
    by_kind = _KIND_WORDS.get(element.kind, "")
    if stereotypes:
        first = (
            by_kind
            if element.kind in _ALWAYS_NAMED
            else _find_role_keyword(graph, element, stereotypes)
        )
        return (first, *stereotypes) if first else stereotypes
    if element.kind is Kind.ACTIVITY:
        by_kind = f"{element.subkind} behavior" if element.subkind else "activity"
    word = _ROLE_WORDS.get(element.role, "") or by_kind
    return (word,) if word else ()


def _find_role_keyword(graph: Graph, element: Element, stereotypes: tuple[str, ...]) -> str:
    """Return the keyword of the role, or an empty text if an applied stereotype expresses the role.

    In SysML v2 a keyword of the language expresses the role.
    """
    word = _ROLE_WORDS.get(element.role, "")
    if not word:
        return ""
    base_names = (name for app in applications(graph, element) for name in lineage(app))
    return "" if word.lower() in {name.lower() for name in (*stereotypes, *base_names)} else word


def list_stereotypes(graph: Graph, element: Element) -> tuple[str, ...]:
    """Return the names of the stereotypes that are applied to the element."""
    applications_of = [item for item in graph.owned(element) if item.kind is _APPLICATION]
    if not applications_of:
        return ()
    names = (
        str(application.attrs.get("stereotype", application.name))
        for application in applications_of
        if _is_shown(application)
    )
    return tuple(dict.fromkeys(_lower_first(name) for name in names if name))


def _is_shown(application: Element) -> bool:
    # The stereotype is applied to a part of the element that has no element of its own.
    if "on" in application.attrs:
        return False
    return not _TOOL_NAMESPACE.match(str(application.attrs.get("namespace", "")))


def guillemets(words: Iterable[str]) -> str:
    """Return ``«a, b»``, or an empty text."""
    text = ", ".join(words)
    return f"«{text}»" if text else ""


def name(element: Element) -> str:
    """Return the element's name, or its kind if it has none.

    A stub is called "external" if its only name is an id that a tool generated.
    """
    if element.attrs.get("external") and _TOOL_ID.fullmatch(element.name):
        return "external"
    return element.name.strip() or str(element.attrs.get("subkind") or element.kind)


def type_name(graph: Graph, element: Element) -> str:
    """Return the name of the element's type; a conjugated port shows ``~``.

    A type that is specific to the property is ``[General]`` (SysML 1.6 clause 8.3.1.1).
    """
    names = [_name_of_type(graph, type_) for type_ in graph.targets(element, Edge.TYPED_BY)]
    return ("~" if element.attrs.get("conjugated") else "") + ", ".join(names) if names else ""


def _name_of_type(graph: Graph, type_: Element) -> str:
    if not type_.attrs.get("property_specific"):
        return name(type_)
    return f"[{', '.join(map(name, graph.targets(type_, Edge.SPECIALIZES))) or name(type_)}]"


def multiplicity(element: Element) -> str:
    """Return ``0..1``, or an empty text for exactly one."""
    value = element.attrs.get("multiplicity")
    return "" if value is None else str(value)


def format_typed(graph: Graph, element: Element, name_shown: str | None = None) -> str:
    """Return ``name : Type [multiplicity]``."""
    own_name = (element.name if name_shown is None else name_shown).strip()
    type_ = type_name(graph, element)
    text = f"{own_name} : {type_}".strip() if type_ else own_name or name(element)
    bounds = multiplicity(element)
    return f"{text} [{bounds}]" if bounds else text


def feature(graph: Graph, element: Element) -> str:
    """Return the label of a property, port or parameter.

    It reads ``/in name : Type [1..2] = 5 {ordered, redefines x}``.
    """
    direction = element.attrs.get("direction")
    slash = "/" if element.attrs.get("derived") else ""
    value = element.attrs.get("default")
    parts = [
        _format_visibility(element),
        f"{direction} " if direction else "",
        slash + format_typed(graph, element),
        "" if value is None else f" = {_format_quantity(graph, element, 'default')}",
        _format_modifiers(graph, element),
    ]
    return "".join(parts)


def _format_quantity(graph: Graph, element: Element, key: str) -> str:
    """Return the value in an attribute, with the unit that it states itself."""
    return f"{literal(element.attrs[key])} {name_value_unit(graph, element, key)}".rstrip()


def literal(value: object) -> str:
    """Return a value in model notation: booleans in lower case, lists in braces."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, tuple):
        return "{" + ", ".join(literal(item) for item in value) + "}"
    return str(value)


def operation(graph: Graph, element: Element) -> str:
    """Return ``name(in a : T) : R``."""
    text = f"{_format_visibility(element)}{name(element)}{signature(graph, element) or '()'}"
    return text + (" {abstract}" if element.attrs.get("abstract") else "")


def signature(graph: Graph, element: Element) -> str:
    """Return ``(in a : T) : R`` of an operation or behaviour; an empty text without parameters."""
    parameters = [item for item in graph.owned(element) if item.kind is _PARAMETER]
    inputs = [feature(graph, p) for p in parameters if p.attrs.get("direction") != "return"]
    text = template(graph, element) + (f"({', '.join(inputs)})" if parameters else "")
    for result in parameters:
        if result.attrs.get("direction") == "return":
            result_text = format_typed(graph, result)
            text += f" {result_text}" if result_text.startswith(":") else f" : {result_text}"
    return text


def template(graph: Graph, element: Element) -> str:
    """Return ``<T, n>`` for the name of a template; an empty text for other elements."""
    names = [name(item) for item in templates.parameters(graph, element)]
    return f"<{', '.join(names)}>" if names else ""


def instance(graph: Graph, element: Element) -> str:
    """Return ``name : Class`` of an instance specification."""
    classes = ", ".join(name(item) for item in graph.targets(element, Edge.INSTANCE_OF))
    return f"{element.name} : {classes}" if classes else name(element)


def slot(graph: Graph, element: Element) -> str:
    """Return ``feature = value``."""
    features = ", ".join(name(item) for item in graph.targets(element, Edge.INSTANCE_OF))
    values = [name(item) for item in graph.targets(element, Edge.REFERENCES)]
    if element.attrs.get("value") is not None:
        values.insert(0, _format_quantity(graph, element, "value"))
    return f"{features or name(element)} = {', '.join(values)}"


def collaboration_use(graph: Graph, element: Element) -> str:
    """Return ``name : Collaboration (role = part, ...)``."""
    bindings = [item for item in graph.owned(element) if item.subkind == "role-binding"]
    parts = [
        f"{name(role)} = {name(part)}"
        for item in bindings
        for role in graph.targets(item, Edge.CLIENT)
        for part in graph.targets(item, Edge.SUPPLIER)
    ]
    text = format_typed(graph, element)
    return f"{text} ({', '.join(parts)})" if parts else text


def find_package(graph: Graph, element: Element) -> str | None:
    """Return the id of the package whose diagram shows the element."""
    return next((owner.id for owner in graph.ancestors(element) if owner.kind in _PACKAGES), None)


def note_text(item: Element) -> str:
    """Return the text of a comment, or a constraint in braces."""
    if item.kind is Kind.CONSTRAINT:
        return condition(item)
    return str(item.attrs.get("body", item.name))


def condition(element: Element) -> str:
    """Return ``{name: body}`` of a constraint."""
    body = str(element.attrs.get("body", ""))
    inner = ": ".join(part for part in (element.name, body) if part)
    return "{" + inner + "}"


def _format_visibility(element: Element) -> str:
    signs = {"private": "-", "protected": "#", "package": "~"}
    return signs.get(str(element.attrs.get("visibility", "")), "")


def _format_modifiers(graph: Graph, element: Element) -> str:
    attrs = element.attrs
    words = [word for word in _MODIFIERS if attrs.get(word)]
    words += ["nonunique"] if attrs.get("unique") is False else []
    for edge, verb in ((Edge.REDEFINES, "redefines"), (Edge.SUBSETS, "subsets")):
        words += [
            f"{verb} {_name_of_redefined(graph, target)}" for target in graph.targets(element, edge)
        ]
    return " {" + ", ".join(words) + "}" if words else ""


def _name_of_redefined(graph: Graph, feature: Element) -> str:
    """Return the name of a redefined feature, which may have none of its own.

    It is then named after the feature that it redefines, else after its type, as in ``: Pump``.
    """
    if feature.name.strip():
        return name(feature)
    ancestor = next(
        (candidate for candidate in redefined_features(graph, feature) if candidate.name.strip()),
        None,
    )
    types = "" if ancestor else type_name(graph, feature)
    return f": {types}" if types else name(ancestor or feature)


def _lower_first(text: str) -> str:
    """Return the name of a stereotype as SysML prints it: ``valueType`` for ``ValueType``.

    Abbreviations such as ``SD_DD`` are unchanged.
    """
    return text[:1].lower() + text[1:] if text[1:2].islower() else text


# -- notes of behaviours -----------------------------------------------------------------------

_NOTE_WIDTH = 48
_NOTE_KINDS = (Kind.COMMENT, Kind.CONSTRAINT)
_FEATURES = (Kind.PROPERTY, Kind.PORT, Kind.OPERATION, Kind.RECEPTION)


def make_notes(
    graph: Graph,
    behaviour: Element,
    aliases: Aliases,
    with_parameters: bool = False,
    inside: Iterable[Element] | None = None,
) -> tuple[Note, ...]:
    """Return notes for the features, the comments *inside* the behaviour, and its constraints."""
    items = list(graph.subtree(behaviour) if inside is None else inside)
    # Tools write comments and constraints in different orders.
    texts = tuple(
        _make_note(graph, item, aliases)
        for kind in _NOTE_KINDS
        for item in items
        if item.kind is kind and _is_note(item, behaviour) and format_label(note_text(item))
    )
    kinds = (Kind.PARAMETER, *_FEATURES) if with_parameters else _FEATURES
    return (*_make_feature_note(graph, behaviour, aliases, kinds), *texts)


def _make_feature_note(
    graph: Graph, behaviour: Element, aliases: Aliases, kinds: tuple[Kind, ...]
) -> tuple[Note, ...]:
    """Return one note with the attributes and operations of the behaviour.

    A behaviour may have them because it is a class (UML 2.5.1, clause 13.2).
    """
    members = [item for item in graph.owned(behaviour) if item.kind in kinds]
    if not members:
        return ()
    rows = [
        row for item in members for row in wrap_lines(_format_feature(graph, item), _NOTE_WIDTH)
    ]
    alias = aliases.make(f"features of {behaviour.id}", "", "note")
    return (Note(alias, join_rows(rows), (), tuple(item.id for item in members)),)


def _format_feature(graph: Graph, item: Element) -> str:
    if item.kind is Kind.OPERATION:
        return operation(graph, item)
    return feature(graph, item)


def _is_note(item: Element, behaviour: Element) -> bool:
    return item.kind is Kind.COMMENT or item.owner == behaviour.id


def _make_note(graph: Graph, item: Element, aliases: Aliases) -> Note:
    about = [target.id for target in graph.targets(item, Edge.REFERENCES)]
    about = about or ([item.owner] if item.owner else [])
    targets = tuple(aliases[id] for id in about if id in aliases)
    alias = aliases.make(item.id, "", "note")
    return Note(alias, format_label(note_text(item), _NOTE_WIDTH), targets, (item.id,))
