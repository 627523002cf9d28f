"""Metadata of an element: stereotypes with their tags, ids of AutomationML, what UML alone says."""

from collections.abc import Mapping

from sysmlc.backends.sysml.book import Book
from sysmlc.backends.sysml.entry import Entry
from sysmlc.backends.sysml.kept import facts
from sysmlc.backends.sysml.printing import Line
from sysmlc.backends.sysml.references import reference, visible
from sysmlc.backends.sysml.rules import UNSAID_ATTRIBUTE
from sysmlc.backends.sysml.shapes import is_part_port
from sysmlc.backends.sysml.stereotypes import is_standard
from sysmlc.backends.sysml.words import comment_lines, quoted, string, writable
from sysmlc.ir import AttrValue, Edge, Element, Kind
from sysmlc.ir.query import CLASSIFIERS

_STRUCTURAL = frozenset({"part", "model", "caex", "internal-link", "alias", "variable"})
_SUBKINDS = (
    Kind.CLASS,
    Kind.COMPONENT,
    Kind.PROPERTY,
    Kind.PACKAGE,
    Kind.ASSOCIATION,
    Kind.INSTANCE,
    Kind.STATE_MACHINE,
    Kind.OBJECT_NODE,
    Kind.STRUCTURED,
    Kind.CONSTRAINT,
)
"""Kinds whose subkind no keyword of SysML v2 says."""
_KINDS = {
    Kind.INTERFACE: "interface",
    Kind.COMPONENT: "component",
    Kind.ACTOR: "actor",
    Kind.ITEM: "item",
    Kind.PROFILE: "profile",
    Kind.DATA_STORE: "data-store",
    Kind.INTERACTION: "interaction",
}
"""Kinds that a keyword of SysML v2 says only nearly."""
_ITEMS = (Kind.CLASS, Kind.SIGNAL, Kind.ITEM, Kind.DATA_TYPE, Kind.COMPONENT)
"""Kinds of what flows; the domain of flows and connectors follows from it."""
_OF_CLASS = "#class"
"""Ends the id of a class that only one InternalElement has; AutomationML gave it none."""
_AML = {
    "data_type": "dataType",
    "unit": "unit",
    "category": "category",
    "semantics": "semantics",
    "version": "version",
    "change_mode": "changeMode",
    "copyright": "copyright",
    "ppr": "ppr",
    "associated_facet": "associatedFacet",
    "default_value": "defaultValue",
}


def of(book: Book, entry: Entry) -> list[Line]:
    """All metadata of an element."""
    element = entry.element
    if element is None:
        return []
    return [
        *_description(element),
        *_named(book, entry, element),
        *_kept(book, entry, element),
        *_aml(book, entry, element),
        *_interfaces(book, entry, element),
        *_kind(book, entry, element),
        *_partitions(book, entry, element),
        *_outside(book, entry, element),
        *_applications(book, entry, element),
    ]


def _description(element: Element) -> list[Line]:
    """What AutomationML says of a feature in words; documents and libraries list it themselves."""
    text = element.attrs.get("description")
    return [Line("doc", text=comment_lines(str(text)))] if text else []


def _named(book: Book, entry: Entry, element: Element) -> list[Line]:
    """The name in the source, where the text has another one; none where the text needs one."""
    if not entry.name or entry.name == writable(element.name):
        return []
    return [ours(book, entry, "Named", {"name": element.name})]


def _kept(book: Book, entry: Entry, element: Element) -> list[Line]:
    """Attributes that nothing else in the text says."""
    found = facts(book, entry, element)
    return [ours(book, entry, "Kept", {"attributes": found})] if found else []


def ours(book: Book, entry: Entry, name: str, facts: Mapping[str, AttrValue]) -> Line:
    """An annotation by a metadata definition of our library; absent values are left out."""
    body = [
        Line(f"{key} = {_value(value)}") for key, value in facts.items() if value not in (None, "")
    ]
    return Line(f"@{book.ours(entry, name)}", body, is_short=True)


def _value(value: AttrValue) -> str:
    if isinstance(value, tuple):
        return f"({', '.join(_value(one) for one in value)})"
    if isinstance(value, bool):
        return "true" if value else "false"
    return repr(value) if isinstance(value, int | float) else string(str(value))


def _aml(book: Book, entry: Entry, element: Element) -> list[Line]:
    facts: dict[str, AttrValue] = {}
    if element.source in book.caex:
        local = element.id.rpartition("#")[2]
        is_made = "/" in local or element.id.endswith(_OF_CLASS)
        is_own = not is_made and local not in ("", element.name)
        facts["id"] = local if is_own else None
    for key, name in _AML.items():
        given = element.attrs.get(key)
        if given is not None:
            facts[name] = str(given) if key == "default_value" else _flat(given)
    if facts and _is_told(element):
        facts["kind"] = element.subkind
    kept = {key: value for key, value in facts.items() if value not in (None, "", ())}
    return [ours(book, entry, "AutomationML", kept)] if kept else []


def _flat(value: AttrValue) -> AttrValue:
    """Pairs as one text each: attributes of metadata hold no lists of lists."""
    if isinstance(value, tuple):
        return tuple("=".join(map(str, one)) if isinstance(one, tuple) else one for one in value)
    return value


def _kind(book: Book, entry: Entry, element: Element) -> list[Line]:
    is_named = _is_told(element) and element.source not in book.caex
    domain = element.attrs.get("domain") if element.kind in _ITEMS else None
    name = element.subkind if is_named else _KINDS.get(element.kind)
    name = name or _plain_port(book, element) or _still(book, entry, element)
    facts = {"name": name, "domain": domain}
    return [ours(book, entry, "Kind", facts)] if any(facts.values()) else []


def _plain_port(book: Book, element: Element) -> str | None:
    """A port of UML, where SysML has proxy ports; those of AutomationML all are."""
    is_plain = element.kind is Kind.PORT and element.role == "port"
    is_plain = is_plain and not is_part_port(book.graph, element)
    return "port" if is_plain and element.source not in book.caex else None


def _still(book: Book, entry: Entry, element: Element) -> str | None:
    """A behaviour of a classifier that does nothing, which would be an operation."""
    is_usage = element.kind is Kind.ACTIVITY and entry.shape.keyword == "action"
    owner = book.graph.owner(element) if is_usage else None
    if owner is None or owner.kind not in CLASSIFIERS or element.attrs.get("body"):
        return None
    is_run = element in book.graph.targets(owner, Edge.CLASSIFIER_BEHAVIOR)
    has_steps = any(one.kind in _STEPS for one in book.graph.owned(element))
    return None if is_run or has_steps else "activity"


_STEPS = frozenset({Kind.ACTION, Kind.STRUCTURED, Kind.CONTROL})


def _partitions(book: Book, entry: Entry, element: Element) -> list[Line]:
    """The partitions and regions that an action stands in, as their names show them."""
    names, meant = [], []
    for one in book.graph.targets(element, Edge.IN_PARTITION):
        represented = book.graph.target(one, Edge.REPRESENTS)
        name = one.name or ("" if represented is None else represented.name)
        if name:
            names.append(name)
            meant.append("" if represented is None else book.graph.qualified_name(represented))
    facts: dict[str, AttrValue] = {"names": tuple(names)}
    if any(meant):
        facts["represents"] = tuple(meant)
    return [ours(book, entry, "Partition", facts)] if names else []


def _is_told(element: Element) -> bool:
    subkind = element.subkind
    return bool(subkind) and element.kind in _SUBKINDS and subkind not in _STRUCTURAL


def _interfaces(book: Book, entry: Entry, element: Element) -> list[Line]:
    """Ids that the interfaces of an InternalElement have besides those of its class."""
    given = element.attrs.get("interface_ids")
    lines = []
    for pair in given if isinstance(given, tuple) else ():
        port, id = pair if isinstance(pair, tuple) else ("", "")
        target = book.graph.get(str(port))
        name = None if target is None else book.redefined(entry, target)
        if name is not None:
            note = ours(book, entry, "AutomationML", {"id": id})
            lines.append(Line(f"port :>> {name}", [note]))
    return lines


def _outside(book: Book, entry: Entry, element: Element) -> list[Line]:
    href = element.attrs.get("href")
    if element.attrs.get("external") and href:
        return [ours(book, entry, "External", {"href": href})]
    return []


def _applications(book: Book, entry: Entry, element: Element) -> list[Line]:
    lines = []
    for one in book.graph.sources(element, Edge.SUBJECT):
        if one.kind is not Kind.APPLICATION or one.id in book.said:
            continue
        book.said.add(one.id)
        if is_standard(one):
            book.approximated(element, "an applied stereotype of SysML", "a keyword")
            continue
        definition = book.plan.applied.get(one.id)
        if definition is not None:
            lines.append(_application(book, entry, one, definition))
    return lines


def _application(book: Book, entry: Entry, one: Element, definition: Entry) -> Line:
    name = reference(book.plan, entry, definition)
    body = []
    for key, value in one.attrs.items():
        tag = key.removeprefix("tag.")
        if not key.startswith("tag."):
            continue
        if tag not in visible(book.plan, definition):
            book.losses.note(UNSAID_ATTRIBUTE, one, attribute=key, kind=one.name or "Application")
            continue
        body.append(Line(f"{quoted(tag)} = {_tagged(book, value)}"))
    return Line(f"@{name}", body, is_short=True)


def _tagged(book: Book, value: AttrValue) -> str:
    """A tagged value; elements are named by their qualified names."""
    if isinstance(value, tuple):
        return f"({', '.join(_tagged(book, one) for one in value)})"
    if isinstance(value, str):
        found = book.graph.get(value)
        return string(value if found is None else book.graph.qualified_name(found))
    return _value(value)
