"""Metadata of an element: stereotypes and their tags, ids of AutomationML, preserved facts."""

from collections.abc import Iterator, Mapping

from sysmlc.backends.sysml.attribute_coverage import is_measure
from sysmlc.backends.sysml.plan import Member
from sysmlc.backends.sysml.preserved_facts import has_complete_flow, list_unexpressed_facts
from sysmlc.backends.sysml.printing import (
    Line,
    format_comment,
    quote_name,
    quote_string,
    replace_control_characters,
)
from sysmlc.backends.sysml.profiles import find_tag_name, is_standard
from sysmlc.backends.sysml.references import format_reference, visible_members
from sysmlc.backends.sysml.rules import UNSAID_ATTRIBUTE
from sysmlc.backends.sysml.shapes import is_part_port
from sysmlc.backends.sysml.writer import Writer
from sysmlc.ir import AttrValue, Edge, Element, Kind, list_items
from sysmlc.ir.query import BEHAVIORS, CLASSIFIERS
from sysmlc.ir.query.names import find_caex_id

_STRUCTURAL_SUBKINDS = frozenset({"part", "model", "caex", "internal-link", "alias", "variable"})
"""Subkinds that follow from the place of an element, so that no metadata states them."""
_WITH_SUBKIND = (
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
"""Kinds whose subkind no keyword of SysML v2 expresses."""
_KIND_NAMES = {
    Kind.INTERFACE: "interface",
    Kind.COMPONENT: "component",
    Kind.ACTOR: "actor",
    Kind.ITEM: "item",
    Kind.PROFILE: "profile",
    Kind.DATA_STORE: "data-store",
    Kind.INTERACTION: "interaction",
}
"""Kinds that share their keyword with another kind."""
_ITEMS = (Kind.CLASS, Kind.SIGNAL, Kind.ITEM, Kind.DATA_TYPE, Kind.COMPONENT)
"""Kinds of items that flow; the domain of flows and connectors follows from them."""
_CAEX_ATTRIBUTES = {
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
"""Feature of the metadata definition ``AutomationML`` by attribute."""
_BEHAVIOUR_USAGES = ("action", "state")
"""Keywords of usages that are read as behaviours of a classifier."""
_STEPS = frozenset({Kind.ACTION, Kind.STRUCTURED, Kind.CONTROL})


def write_annotations(writer: Writer, member: Member) -> list[Line]:
    """Return all metadata of the element of a member; none for a member without an element."""
    element = member.element
    if element is None:
        return []
    return [
        *_iter_documentation(element),
        *_iter_source_name(writer, member, element),
        *_iter_preserved_facts(writer, member, element),
        *_iter_caex_attributes(writer, member, element),
        *_iter_interface_ids(writer, member, element),
        *_iter_kind(writer, member, element),
        *_iter_partitions(writer, member, element),
        *_iter_href(writer, member, element),
        *_iter_applications(writer, member, element),
    ]


def make_annotation(
    writer: Writer, member: Member, name: str, facts: Mapping[str, AttrValue]
) -> Line:
    """Return metadata by a definition of the library ``SysMLC``; absent values are omitted."""
    body = [
        Line(f"{key} = {_format_value(value)}")
        for key, value in facts.items()
        if value not in (None, "")
    ]
    return Line(f"@{writer.refer_to_sysmlc(member, name)}", body, is_short=True)


def _format_value(value: AttrValue) -> str:
    if isinstance(value, tuple):
        return f"({', '.join(_format_value(item) for item in value)})"
    if isinstance(value, bool):
        return "true" if value else "false"
    return repr(value) if isinstance(value, int | float) else quote_string(str(value))


def _iter_documentation(element: Element) -> Iterator[Line]:
    """Yield the description of an AutomationML feature as documentation."""
    text = element.attrs.get("description")
    if text and not is_measure(element):
        yield Line("doc", text=format_comment(str(text)))


def _iter_source_name(writer: Writer, member: Member, element: Element) -> Iterator[Line]:
    """Yield metadata with the name in the source if the member has a different name."""
    if member.name and member.name != replace_control_characters(element.name):
        yield make_annotation(writer, member, "Named", {"name": element.name})


def _iter_preserved_facts(writer: Writer, member: Member, element: Element) -> Iterator[Line]:
    facts = list_unexpressed_facts(writer, member, element)
    if facts:
        yield make_annotation(writer, member, "Kept", {"attributes": facts})


# -- AutomationML --------------------------------------------------------------------------------


def _iter_caex_attributes(writer: Writer, member: Member, element: Element) -> Iterator[Line]:
    facts = _list_caex_facts(writer, element)
    if facts:
        yield make_annotation(writer, member, "AutomationML", facts)


def _list_caex_facts(writer: Writer, element: Element) -> dict[str, AttrValue]:
    """Return the attributes that AutomationML gives to an element, without absent values."""
    facts: dict[str, AttrValue] = {"id": find_caex_id(element, writer.caex_files)}
    for key, name in _CAEX_ATTRIBUTES.items():
        value = element.attrs.get(key)
        if value is not None:
            facts[name] = str(value) if key == "default_value" else _flatten(value)
    is_caex = element.source in writer.caex_files or any(facts.values())
    if (is_caex and _needs_subkind(element)) or is_part_of_class(writer, element):
        facts["kind"] = element.subkind
    return {name: value for name, value in facts.items() if value not in (None, "", ())}


def is_part_of_class(writer: Writer, element: Element) -> bool:
    """Whether an instance has values for a part of a class; in a class it would be a part."""
    owner = writer.graph.owner(element)
    is_values = element.kind is Kind.INSTANCE and element.subkind == "part"
    return is_values and owner is not None and owner.kind is not Kind.INSTANCE


def _flatten(value: AttrValue) -> AttrValue:
    """Return pairs as ``key=value``: features of metadata hold no lists of lists."""
    if isinstance(value, tuple):
        return tuple(
            "=".join(map(str, item)) if isinstance(item, tuple) else item for item in value
        )
    return value


def _iter_interface_ids(writer: Writer, member: Member, element: Element) -> Iterator[Line]:
    """Yield redefined ports with the ids that an InternalElement gives to inherited interfaces."""
    for pair in list_items(element.attrs.get("interface_ids")):
        port_id, id = pair if isinstance(pair, tuple) else ("", "")
        port = writer.graph.get(str(port_id))
        name = None if port is None else writer.refer_to_redefined(member, port)
        if name is not None:
            annotation = make_annotation(writer, member, "AutomationML", {"id": id})
            yield Line(f"port :>> {name}", [annotation])


# -- kinds ---------------------------------------------------------------------------------------


def _iter_kind(writer: Writer, member: Member, element: Element) -> Iterator[Line]:
    """Yield the kind of an element, where the keyword does not determine it, and its domain."""
    has_subkind = _needs_subkind(element) and element.source not in writer.caex_files
    name = element.subkind if has_subkind else _KIND_NAMES.get(element.kind)
    name = name or _name_plain_port(writer, element) or _name_operation(writer, element)
    name = name or _name_idle_activity(writer, member, element)
    if element.kind is Kind.PACKAGE and member.shape.is_definition:
        # Views and viewpoints of SysML 1.3 and older may be packages.
        name = name or "package"
    name = name or _name_reference(writer, member, element)
    domain = element.attrs.get("domain") if element.kind in _ITEMS else None
    if name or domain:
        yield make_annotation(writer, member, "Kind", {"name": name, "domain": domain})


def _needs_subkind(element: Element) -> bool:
    subkind = element.subkind
    is_structural = subkind in _STRUCTURAL_SUBKINDS
    return bool(subkind) and element.kind in _WITH_SUBKIND and not is_structural


def _name_plain_port(writer: Writer, element: Element) -> str | None:
    """Return ``port`` for a port that would be read as a proxy port of SysML.

    Metadata for AutomationML states the same.
    """
    if element.kind is not Kind.PORT or element.role != "port":
        return None
    if is_part_port(writer.graph, element) or _list_caex_facts(writer, element):
        return None
    return "port"


def _name_operation(writer: Writer, element: Element) -> str | None:
    """Return the kind of an operation of a behaviour, which would be read as one of its steps."""
    if element.kind not in (Kind.OPERATION, Kind.RECEPTION):
        return None
    owner = writer.graph.owner(element)
    return str(element.kind).lower() if owner is not None and owner.kind in BEHAVIORS else None


def _name_reference(writer: Writer, member: Member, element: Element) -> str | None:
    """Return ``property`` for a reference that would be read as a lifeline or a behaviour."""
    owner = writer.graph.owner(element) if element.kind is Kind.PROPERTY else None
    if owner is not None and member.shape.keyword in _BEHAVIOUR_USAGES:
        is_classifier = owner.kind in CLASSIFIERS or owner.kind is Kind.STATE_MACHINE
        return "property" if is_classifier else None
    if owner is None or owner.kind is not Kind.INTERACTION or member.shape.keyword == "ref":
        return None
    return "property" if element.attrs.get("aggregation") != "composite" else None


def _name_idle_activity(writer: Writer, member: Member, element: Element) -> str | None:
    """Return ``activity`` for an activity without actions, which would be read as an operation."""
    is_usage = element.kind is Kind.ACTIVITY and member.shape.keyword == "action"
    owner = writer.graph.owner(element) if is_usage else None
    if owner is None or owner.kind not in CLASSIFIERS or element.attrs.get("body"):
        return None
    is_run = element in writer.graph.targets(owner, Edge.CLASSIFIER_BEHAVIOR)
    has_steps = any(_is_written_step(writer, child) for child in writer.graph.owned(element))
    return None if is_run or has_steps else "activity"


def _is_written_step(writer: Writer, node: Element) -> bool:
    """Whether a node is a step of the text: a start or an end is one if a flow leads to it."""
    if node.kind not in _STEPS:
        return False
    member = writer.plan.find(node)
    is_named = member is not None and member.shape.keyword != "start"
    return is_named or has_complete_flow(writer.graph, node)


def _iter_partitions(writer: Writer, member: Member, element: Element) -> Iterator[Line]:
    """Yield the names of the partitions and regions that contain an action."""
    names, represented_names = [], []
    for partition in writer.graph.targets(element, Edge.IN_PARTITION):
        represented = writer.graph.target(partition, Edge.REPRESENTS)
        name = partition.name or ("" if represented is None else represented.name)
        if name:
            names.append(name)
            represented_names.append(
                "" if represented is None else writer.graph.qualified_name(represented)
            )
    facts: dict[str, AttrValue] = {"names": tuple(names)}
    if any(represented_names):
        facts["represents"] = tuple(represented_names)
    if names:
        yield make_annotation(writer, member, "Partition", facts)


def _iter_href(writer: Writer, member: Member, element: Element) -> Iterator[Line]:
    href = element.attrs.get("href")
    if element.attrs.get("external") and href:
        yield make_annotation(writer, member, "External", {"href": href})


# -- stereotypes ---------------------------------------------------------------------------------


def _iter_applications(writer: Writer, member: Member, element: Element) -> Iterator[Line]:
    for application in writer.graph.sources(element, Edge.SUBJECT):
        is_new = application.id not in writer.expressed
        if application.kind is not Kind.APPLICATION or not is_new:
            continue
        writer.expressed.add(application.id)
        if is_standard(application):
            construct = "an applied stereotype of SysML"
            writer.record_approximation(element, construct, "a keyword")
            continue
        definition = writer.plan.metadata_definitions.get(application.id)
        if definition is not None:
            yield _write_application(writer, member, application, definition)


def _write_application(
    writer: Writer, member: Member, application: Element, definition: Member
) -> Line:
    stereotype_name = format_reference(writer.plan, member, definition)
    body = []
    for key, value in application.attrs.items():
        tag = key.removeprefix("tag.")
        if not key.startswith("tag."):
            continue
        name = find_tag_name(visible_members(writer.plan, definition), tag)
        if name is None:
            facts = {"attribute": key, "kind": application.name or "Application"}
            writer.losses.record(UNSAID_ATTRIBUTE, application, **facts)
            continue
        body.append(Line(f"{quote_name(name)} = {_format_tag(writer, application, value)}"))
    return Line(f"@{stereotype_name}", body, is_short=True)


def _format_tag(writer: Writer, application: Element, value: AttrValue) -> str:
    """Return a tagged value; an id of an element becomes its qualified name in the text.

    An element without a name is named by its id, which is reported.
    """
    if isinstance(value, tuple):
        return f"({', '.join(_format_tag(writer, application, item) for item in value)})"
    if isinstance(value, str):
        element = writer.graph.get(value)
        # An id that equals the name is a text: ``prefix="SysML"`` in a profile called SysML.
        if element is None or element.name == value:
            return quote_string(value)
        name = _join_text_names(writer, element)
        if name is None:
            construct = "a tagged value that refers to an element without a name"
            writer.record_approximation(application, construct, "its id")
        return quote_string(name or value)
    return _format_value(value)


def _join_text_names(writer: Writer, element: Element) -> str | None:
    """Return the qualified name of an element, from the names that its owners have in the text.

    Return None if the element itself has no name.
    """
    if element.attrs.get("external"):
        return writer.graph.qualified_name(element)
    path = [element, *writer.graph.ancestors(element)]
    members = [writer.plan.find(step) for step in path]
    names = [
        step.name if member is None or member.element is not step else member.name
        for step, member in zip(path, members, strict=True)
    ]
    return "::".join(name for name in reversed(names) if name) if names[0] else None
