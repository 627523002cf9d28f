"""How one element reads in a diagram, in UML notation (UML 2.5.1, clauses 9 and 11)."""

import re
from collections.abc import Iterable

from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.query import applications, lineage, redefined_features, templates

_TOOL_ID = re.compile(r"_\d+_\d+_\d+_[0-9a-f]+_\d+_\d+_\d+|(EAID)?_[\w-]{20,}")
"""Ids as MagicDraw, Papyrus and Enterprise Architect make them."""
_TOOL_NAMESPACE = re.compile(
    r"https?://www\.magicdraw\.com/(spec/Customization/|schemas/additional_stereotypes)"
)
"""MagicDraw's own stereotypes (PartProperty, ValueProperty) repeat what the type says."""
_PACKAGES = (Kind.PACKAGE, Kind.PROFILE)
_MODIFIERS = ("ordered", "readonly", "static")
_APPLICATION, _PARAMETER = Kind.APPLICATION, Kind.PARAMETER
"""Members by names of the module: in Python 3.11 those of a class take twice as long."""
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


def keywords(graph: Graph, element: Element) -> tuple[str, ...]:
    """Stereotypes as the model has them, else the word for the role, else for the kind."""
    found = applied(graph, element)
    by_kind = _KIND_WORDS.get(element.kind, "")
    if found:
        first = by_kind if element.kind in _ALWAYS_NAMED else _unsaid_role(graph, element, found)
        return (first, *found) if first else found
    if element.kind is Kind.ACTIVITY:
        by_kind = f"{element.subkind} behavior" if element.subkind else "activity"
    word = _ROLE_WORDS.get(element.role, "") or by_kind
    return (word,) if word else ()


def _unsaid_role(graph: Graph, element: Element, found: tuple[str, ...]) -> str:
    """The word for a role that no applied stereotype gives: SysML v2 says it with a keyword."""
    word = _ROLE_WORDS.get(element.role, "")
    if not word:
        return ""
    general = (one for app in applications(graph, element) for one in lineage(app))
    return "" if word.lower() in {one.lower() for one in (*found, *general)} else word


def applied(graph: Graph, element: Element) -> tuple[str, ...]:
    """Names of the stereotypes that are applied to the element."""
    found = [item for item in graph.owned(element) if item.kind is _APPLICATION]
    if not found:
        return ()
    told = (str(one.attrs.get("stereotype", one.name)) for one in found if _is_telling(one))
    return tuple(dict.fromkeys(_lower_first(name) for name in told if name))


def _is_telling(application: Element) -> bool:
    if "on" in application.attrs:
        return False
    return not _TOOL_NAMESPACE.match(str(application.attrs.get("namespace", "")))


_ALWAYS_NAMED = frozenset([Kind.INTERFACE, Kind.ENUMERATION, Kind.SIGNAL, Kind.ACTOR])


def guillemets(words: Iterable[str]) -> str:
    """``«a, b»``, or nothing."""
    text = ", ".join(words)
    return f"«{text}»" if text else ""


def name(element: Element) -> str:
    """The element's name, or its kind when it has none; a stub is called by its id at times."""
    if element.attrs.get("external") and _TOOL_ID.fullmatch(element.name):
        return "external"
    return element.name.strip() or str(element.attrs.get("subkind") or element.kind)


def type_name(graph: Graph, element: Element) -> str:
    """Name of the element's type; a conjugated port shows ``~``.

    A type that is specific to the property is ``[General]`` (SysML 1.6 clause 8.3.1.1).
    """
    names = [_specific(graph, type_) for type_ in graph.targets(element, Edge.TYPED_BY)]
    return ("~" if element.attrs.get("conjugated") else "") + ", ".join(names) if names else ""


def _specific(graph: Graph, type_: Element) -> str:
    if not type_.attrs.get("property_specific"):
        return name(type_)
    return f"[{', '.join(map(name, graph.targets(type_, Edge.SPECIALIZES))) or name(type_)}]"


def multiplicity(element: Element) -> str:
    """``0..1``, or nothing for exactly one."""
    value = element.attrs.get("multiplicity")
    return "" if value is None else str(value)


def typed(graph: Graph, element: Element, shown: str | None = None) -> str:
    """``name : Type [multiplicity]``."""
    own = (element.name if shown is None else shown).strip()
    type_ = type_name(graph, element)
    text = f"{own} : {type_}".strip() if type_ else own or name(element)
    bounds = multiplicity(element)
    return f"{text} [{bounds}]" if bounds else text


def feature(graph: Graph, element: Element) -> str:
    """A property, port or parameter: ``/in name : Type [1..2] = 5 {ordered, redefines x}``."""
    direction = element.attrs.get("direction")
    slash = "/" if element.attrs.get("derived") else ""
    value = element.attrs.get("default")
    parts = [
        _visibility(element),
        f"{direction} " if direction else "",
        slash + typed(graph, element),
        "" if value is None else f" = {literal(value)}",
        _modifiers(graph, element),
    ]
    return "".join(parts)


def literal(value: object) -> str:
    """A value in model notation: booleans in lower case, lists in braces."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, tuple):
        return "{" + ", ".join(literal(item) for item in value) + "}"
    return str(value)


def operation(graph: Graph, element: Element) -> str:
    """``name(in a : T) : R``."""
    text = f"{_visibility(element)}{name(element)}{signature(graph, element) or '()'}"
    return text + (" {abstract}" if element.attrs.get("abstract") else "")


def signature(graph: Graph, element: Element) -> str:
    """``(in a : T) : R`` of an operation or behaviour; nothing when it has no parameters."""
    parameters = [item for item in graph.owned(element) if item.kind is _PARAMETER]
    taken = [feature(graph, p) for p in parameters if p.attrs.get("direction") != "return"]
    text = template(graph, element) + (f"({', '.join(taken)})" if parameters else "")
    for result in parameters:
        if result.attrs.get("direction") == "return":
            shown = typed(graph, result)
            text += f" {shown}" if shown.startswith(":") else f" : {shown}"
    return text


def template(graph: Graph, element: Element) -> str:
    """``<T, n>`` behind the name of a template; nothing for what is none."""
    names = [name(item) for item in templates.parameters(graph, element)]
    return f"<{', '.join(names)}>" if names else ""


def instance(graph: Graph, element: Element) -> str:
    """``name : Class`` of an instance specification."""
    classes = ", ".join(name(item) for item in graph.targets(element, Edge.INSTANCE_OF))
    return f"{element.name} : {classes}" if classes else name(element)


def slot(graph: Graph, element: Element) -> str:
    """``feature = value``."""
    features = ", ".join(name(item) for item in graph.targets(element, Edge.INSTANCE_OF))
    values = [name(item) for item in graph.targets(element, Edge.REFERENCES)]
    if element.attrs.get("value") is not None:
        values.insert(0, literal(element.attrs["value"]))
    return f"{features or name(element)} = {', '.join(values)}"


def collaboration_use(graph: Graph, element: Element) -> str:
    """``name : Collaboration (role = part, ...)``."""
    bindings = [item for item in graph.owned(element) if item.subkind == "role-binding"]
    parts = [
        f"{name(role)} = {name(part)}"
        for item in bindings
        for role in graph.targets(item, Edge.CLIENT)
        for part in graph.targets(item, Edge.SUPPLIER)
    ]
    text = typed(graph, element)
    return f"{text} ({', '.join(parts)})" if parts else text


def home(graph: Graph, element: Element) -> str | None:
    """Id of the package whose diagram shows the element."""
    return next((one.id for one in graph.ancestors(element) if one.kind in _PACKAGES), None)


def note_text(item: Element) -> str:
    """The text of a comment, or a constraint in braces."""
    if item.kind is Kind.CONSTRAINT:
        return condition(item)
    return str(item.attrs.get("body", item.name))


def condition(element: Element) -> str:
    """``{name: body}`` of a constraint."""
    body = str(element.attrs.get("body", ""))
    inner = ": ".join(part for part in (element.name, body) if part)
    return "{" + inner + "}"


def _visibility(element: Element) -> str:
    signs = {"private": "-", "protected": "#", "package": "~"}
    return signs.get(str(element.attrs.get("visibility", "")), "")


def _modifiers(graph: Graph, element: Element) -> str:
    attrs = element.attrs
    words = [word for word in _MODIFIERS if attrs.get(word)]
    words += ["nonunique"] if attrs.get("unique") is False else []
    for edge, verb in ((Edge.REDEFINES, "redefines"), (Edge.SUBSETS, "subsets")):
        words += [f"{verb} {_referred(graph, target)}" for target in graph.targets(element, edge)]
    return " {" + ", ".join(words) + "}" if words else ""


def _referred(graph: Graph, feature: Element) -> str:
    """Name of a feature that another one redefines; without one it is told by what names it.

    That is the named feature that it redefines itself, else its type, as in ``: Pump``.
    """
    if feature.name.strip():
        return name(feature)
    known = next((one for one in redefined_features(graph, feature) if one.name.strip()), None)
    types = "" if known else type_name(graph, feature)
    return f": {types}" if types else name(known or feature)


def _lower_first(text: str) -> str:
    """``ValueType`` as SysML prints it, ``valueType``; abbreviations (``SD_DD``) stay."""
    return text[:1].lower() + text[1:] if text[1:2].islower() else text
