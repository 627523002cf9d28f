"""Comments, texts in other languages, and elements that SysML v2 knows only as metadata.

AutomationML has documents, aliases, facets and groups without a counterpart in SysML v2.
"""

from sysmlc.backends.sysml.annotations import make_annotation, write_annotations
from sysmlc.backends.sysml.plan import Member
from sysmlc.backends.sysml.preserved_facts import list_all_facts
from sysmlc.backends.sysml.printing import Line, format_comment, quote_name, quote_string
from sysmlc.backends.sysml.writer import Writer
from sysmlc.ir import AttrValue, Edge, Element, Kind, as_items

_UNLISTED_ATTRIBUTES = frozenset({"external", "library", "subkind", "unresolved"})


# -- comments and opaque bodies ------------------------------------------------------------------


def write_comment(writer: Writer, member: Member) -> list[Line]:
    """Write a comment: documentation of its owner, or a comment about other elements."""
    element = member.require_element()
    annotated = writer.graph.targets(element, Edge.REFERENCES)
    owner = writer.graph.owner(element)
    body = element.attrs.get("body", "")
    text = format_comment(str(body))
    name = f" {quote_name(member.name)}" if member.name else ""
    children = _write_children(writer, member)
    record_text_changes(writer, element, str(body))
    if owner is not None and owner.kind is Kind.COMMENT:
        construct = "a comment about a comment"
        writer.record_approximation(element, construct, "one about the same elements")
    if element.role == "element group":
        writer.record_approximation(element, "an element group", "a comment about its members")
    if not annotated and owner is not None:
        construct = "a comment about nothing"
        writer.record_approximation(element, construct, "documentation of its owner")
    has_owner = member.parent is not None and element.role == ""
    locale = element.attrs.get("locale")
    suffix = f" locale {quote_string(str(locale))}" if locale else ""
    if annotated == [owner] or (not annotated and has_owner):
        return [Line(f"doc{name}{suffix}", text=text), *children]
    names = writer.refer_to_targets(member.parent, element, Edge.REFERENCES)
    about = f" about {', '.join(names)}" if names else ""
    return [Line(f"comment{name}{about}{suffix}", text=text), *children]


def _write_children(writer: Writer, member: Member) -> list[Line]:
    return [line for child in member.members for line in writer.write_member(child)]


def record_text_changes(writer: Writer, element: Element, text: str) -> None:
    """Record what a comment of SysML v2 cannot contain: white space around lines, its end mark."""
    if text != _strip_lines(text):
        writer.record_approximation(element, "white space around a text", "none")
    if "*/" in text:
        writer.record_approximation(element, "'*/' in a text", "'* /'")


def _strip_lines(text: str) -> str:
    """Return the text without white space around its lines: a reader of a comment removes it."""
    lines = text.replace("\r\n", "\n").strip().splitlines()
    return "\n".join(line.rstrip() for line in lines)


def write_opaque_bodies(writer: Writer, element: Element) -> list[Line]:
    """Return the bodies of an opaque element as representations in their languages."""
    bodies = element.attrs.get("bodies", element.attrs.get("body"))
    languages = element.attrs.get("languages", element.attrs.get("language", ""))
    texts = () if bodies is None else as_items(bodies)
    if not isinstance(languages, tuple):
        languages = (languages,) * len(texts)
    record_text_changes(writer, element, "\n".join(str(text) for text in texts))
    padded = (*languages, *([""] * len(texts)))
    return [
        Line(f"language {quote_string(str(language))}", text=format_comment(str(text)))
        for text, language in zip(texts, padded, strict=False)
        if text
    ]


# -- metadata ------------------------------------------------------------------------------------


def write_group(writer: Writer, member: Member) -> list[Line]:
    """Write a facet or a group as metadata about its members."""
    element = member.require_element()
    kind = writer.refer_to_sysmlc(member.parent, str(element.kind))
    name = f"{quote_name(member.name)} : " if member.name else ""
    names = writer.refer_to_targets(member.parent, element, Edge.REFERENCES)
    about = f" about {', '.join(names)}" if names else ""
    return [Line(f"metadata {name}{kind}{about}", write_annotations(writer, member))]


def write_document(writer: Writer, member: Member) -> list[Line]:
    """Write a document, an alias or further information.

    Below another member it becomes metadata, from which a reader restores the element; at the top,
    and with children, a comment that lists its attributes.
    """
    element = member.require_element()
    if _is_below_member(member) and not writer.graph.owned(element):
        return [annotate_element(writer, member, element)]
    attributes = sorted(
        (key, value) for key, value in element.attrs.items() if key not in _UNLISTED_ATTRIBUTES
    )
    rows = [f"{key} = {_format_attribute(value)}" for key, value in attributes]
    title = f"{element.kind} {element.subkind}".strip()
    text = format_comment("\n".join([title, *rows]))
    children = _write_children(writer, member)
    names = [
        name
        for target in writer.graph.targets(element, Edge.REFERENCES)
        if target.kind in (Kind.PORT, Kind.PROPERTY, Kind.CLASS)
        and (name := writer.refer_to(member.parent, element, Edge.REFERENCES, target)) is not None
    ]
    about = f" about {', '.join(names)}" if names else ""
    # Comments below a comment stand beside it, where two of them may have the same name.
    has_name = bool(member.name) and (member.parent is None or _is_below_member(member))
    name = f" {quote_name(member.name)}" if has_name else ""
    return [Line(f"comment{name}{about}", text=text), *children]


def _is_below_member(member: Member) -> bool:
    return member.parent is not None and member.parent.shape.keyword != "comment"


def annotate_element(writer: Writer, member: Member, element: Element) -> Line:
    """Return metadata that states kind, name and all facts of an element."""
    facts: dict[str, AttrValue] = {"kind": str(element.kind), "name": element.name}
    owner = writer.graph.owner(element)
    if owner is not None and owner.attrs.get("property_specific"):
        # The parent stands for the feature that is typed by the class.
        facts["isOfType"] = True
    attributes = list_all_facts(writer, element)
    return make_annotation(writer, member, "Element", facts | {"attributes": attributes})


def _format_attribute(value: AttrValue) -> str:
    if isinstance(value, tuple):
        return ", ".join(_format_attribute(item) for item in value)
    return str(value)
