"""Enterprise Architect: its extension elements, and its names of stereotypes and profiles.

The extension repeats most of the model. Notes (as comments), constraints, tagged values without a
stereotype, and stereotypes without an application are read; the rest is notation. No SysML model
exported by Enterprise Architect was available for tests: its SysML is assumed to follow the pattern
of its other profiles.
"""

import re
from collections import deque
from collections.abc import Iterator
from functools import cache

from sysmlc.diagnostics import Verdict
from sysmlc.frontends.xmi.context import Context, ElementHandler
from sysmlc.frontends.xmi.namespaces import mangle_name
from sysmlc.frontends.xmi.unit import UnresolvedReference
from sysmlc.ir import Edge, Element, Kind
from sysmlc.ir.element import derived_id

_STEREOTYPE = re.compile(r"@STEREO;(.*?)@ENDSTEREO", re.DOTALL)
_PREFIX = "EAID_"
_LISTS = ("elements", "connectors", "attributes", "operations", "parameters")
"""Features that contain descriptions of elements, which can be nested."""
_CONSTRAINT_SUBKINDS = {
    "pre-condition": "precondition",
    "post-condition": "postcondition",
    "invariant": "invariant",
}
_CONSTRAINT_TEXTS = ("notes", "description", "documentation")
"""Attributes that hold the text of a constraint, in different versions of the tool."""


def read_extensions(context: Context) -> None:
    """Add the content of the extensions; applications must be in the graph already."""
    queue = deque(
        row for extension in context.extensions for row in _list_descriptions(context, extension)
    )
    while queue:
        row = queue.popleft()
        _read_description(context, row)
        queue.extend(_list_descriptions(context, row))


def _list_descriptions(context: Context, row: int) -> Iterator[int]:
    document = context.document
    for feature in _LISTS:
        for holder in document.children(row, feature):
            yield from document.children(holder)


def _read_description(context: Context, row: int) -> None:
    document = context.document
    id = document.idref(row)
    _read_details(context, row, id)
    for holder, end_prefix in (("source", "src"), ("target", "dst")):
        for end in document.children(row, holder):
            # The id of an end is that of the connector with its first two digits replaced.
            _read_details(context, end, f"{_PREFIX}{end_prefix}{id[len(_PREFIX) + 2 :]}")


def _read_details(context: Context, row: int, id: str) -> None:
    """Read what a description states about the element *id*."""
    document = context.document
    target = context.unit.find_target(context.file, id, False)
    element = context.graph.get(target.element_id) if target else None
    if element is None or target is None:
        return
    if not target.element:
        # A note on content of an element, such as an event, is a note on that element.
        for feature in ("properties", "documentation"):
            for child in document.children(row, feature):
                _add_note(context, element, child, id)
        return
    for child in document.children(row):
        handler = _DETAILS.get(document.features[child])
        if handler is not None:
            handler(context, element, child)


# -- notes -----------------------------------------------------------------------------------------


def _read_note(context: Context, element: Element, row: int) -> None:
    _add_note(context, element, row, element.id)


def _add_note(context: Context, element: Element, row: int, origin: str) -> None:
    """Add a comment unless the model has it; *origin* is the id from which its id is derived."""
    values = context.document.attributes[row]
    text = values.get("value") or values.get("documentation", "")
    if not text:
        return
    context.verdicts[row] = Verdict.MAPPED
    if not any(_is_comment(owned, text) for owned in context.graph.owned(element)):
        id = derived_id(origin, "documentation")
        comment = Element(id, Kind.COMMENT, "", element.id, *_source(context, row))
        comment.attrs["body"] = text
        context.graph.add(comment)
        context.graph.connect(Edge.REFERENCES, comment, element)


def _is_comment(element: Element, text: str) -> bool:
    return element.kind is Kind.COMMENT and element.attrs.get("body") == text


# -- constraints -----------------------------------------------------------------------------------


def _read_constraints(context: Context, element: Element, row: int) -> None:
    """Add the constraints ``<constraint name= type=>`` that the model does not have."""
    document = context.document
    for number, child in enumerate(document.children(row, "constraint")):
        values = document.attributes[child]
        body = next((values[name] for name in _CONSTRAINT_TEXTS if values.get(name)), "")
        name = values.get("name", "")
        if not name and not body:
            continue
        context.verdicts[row] = context.verdicts[child] = Verdict.MAPPED
        if not any(_is_constraint(owned, name, body) for owned in context.graph.owned(element)):
            id = derived_id(element.id, f"constraint[{number}]")
            _add_constraint(context, element, child, id, name, body)


def _is_constraint(element: Element, name: str, body: str) -> bool:
    has_name = bool(name) and element.name == name
    has_body = element.attrs.get("body") == (body or name)
    return element.kind is Kind.CONSTRAINT and (has_name or has_body)


def _add_constraint(
    context: Context, element: Element, row: int, id: str, name: str, body: str
) -> None:
    constraint = Element(
        id, Kind.CONSTRAINT, name if body else "", element.id, *_source(context, row)
    )
    # Users of Enterprise Architect write formulas in the field that other tools use for the name.
    constraint.attrs["body"] = body or name
    type_name = context.document.attributes[row].get("type", "")
    if type_name.lower() in _CONSTRAINT_SUBKINDS:
        constraint.attrs["subkind"] = _CONSTRAINT_SUBKINDS[type_name.lower()]
    elif type_name.upper() == "OCL":
        constraint.attrs["language"] = "OCL"
    elif type_name:
        constraint.attrs["tag.type"] = type_name
    context.graph.add(constraint)


# -- tagged values and stereotypes -----------------------------------------------------------------


def _read_tags(context: Context, element: Element, row: int) -> None:
    """Store the tagged values that no application of a stereotype has."""
    for tag in context.document.children(row):
        values = context.document.attributes[tag]
        name, value = values.get("name", ""), values.get("value", "")
        if name and value:
            context.verdicts[tag] = Verdict.MAPPED
            applications = _list_applications(context, element)
            if not any(_has_tag(application, name) for application in applications):
                key = f"tag.{name.rpartition('::')[2]}"
                element.attrs[key] = find_id_by_guid(context, value) or value


def _has_tag(application: Element, name: str) -> bool:
    short = mangle_name(name.rpartition("::")[2])
    return any(f"tag.{tag}" in application.attrs for tag in (name, mangle_name(name), short))


def _read_stereotypes(context: Context, element: Element, row: int) -> None:
    """Apply the stereotypes that ``xrefs`` lists: ``$DES=@STEREO;Name=..;FQName=..;@ENDSTEREO``."""
    text = context.document.attributes[row].get("value", "")
    for entry in _STEREOTYPE.findall(text):
        context.verdicts[row] = Verdict.MAPPED
        fields = dict(field.partition("=")[::2] for field in entry.split(";"))
        _apply(context, element, row, fields.get("FQName") or fields.get("Name", ""))


def _apply(context: Context, element: Element, row: int, qualified_name: str) -> None:
    name, namespace = _split_stereotype_name(context, qualified_name)
    applied = {mangle_name(app.name) for app in _list_applications(context, element)}
    if not name or mangle_name(name) in applied:
        return
    id = derived_id(element.id, f"{mangle_name(name)}[{context.document.ordinals[row]}]")
    application = Element(id, Kind.APPLICATION, name, element.id, *_source(context, row))
    application.attrs["stereotype"], application.attrs["namespace"] = name, namespace
    context.graph.add(application)
    context.graph.connect(Edge.SUBJECT, application, element)
    stereotype = context.unit.profiles.find_stereotype(context.graph, namespace, name)
    if stereotype is not None:
        context.graph.connect(Edge.INSTANCE_OF, application, stereotype)


def _list_applications(context: Context, element: Element) -> list[Element]:
    return [owned for owned in context.graph.owned(element) if owned.kind is Kind.APPLICATION]


def _source(context: Context, row: int) -> tuple[int, str]:
    """Ordinal and file of the row."""
    return context.document.ordinals[row], context.document.name


_DETAILS: dict[str, ElementHandler] = {
    "constraints": _read_constraints,
    "properties": _read_note,
    "documentation": _read_note,
    "tags": _read_tags,
    "xrefs": _read_stereotypes,
}
"""Handlers of the content of a description, by feature."""


# -- stereotypes and profiles ------------------------------------------------------------------

_PRIMITIVE = re.compile(r"EA[A-Za-z#+]*_\w+$")
_PRIMITIVE_TYPES = "http://www.omg.org/spec/UML/20161101/PrimitiveTypes.xmi#"
_GUID = re.compile(r"\{[0-9A-Fa-f]{8}(-[0-9A-Fa-f]{4}){3}-[0-9A-Fa-f]{12}\}")
_SYSML = re.compile(r"https?://www\.sparxsystems\.com/profiles/SysML")


def read_stereotype_name(context: Context, row: int) -> tuple[str, str]:
    """Return name and namespace of the stereotype that the row applies, whatever tool wrote it.

    Enterprise Architect mangles the name in the tag (``EAUML__X``) and writes the qualified name in
    an attribute.
    """
    document = context.document
    name, namespace = document.features[row], document.namespace(row)
    qualified_name = document.attributes[row].get("__EAStereoName")
    if qualified_name:
        return _split_stereotype_name(context, qualified_name, namespace)
    return _capitalise_sysml(name, namespace), namespace


def _split_stereotype_name(
    context: Context, qualified_name: str, default_namespace: str = ""
) -> tuple[str, str]:
    """Return name and namespace of the stereotype ``Prefix::Name``.

    A name without prefix is in *default_namespace*.
    """
    prefix, _, name = qualified_name.rpartition("::")
    namespace = _find_namespace(context, prefix) if prefix else default_namespace
    return _capitalise_sysml(name, namespace), namespace


def _find_namespace(context: Context, prefix: str) -> str:
    """Return the namespace that the file declares for a profile, else the tool's pattern for it."""
    start = f"http://www.sparxsystems.com/profiles/{prefix}/"
    declared = context.document.declared_namespaces
    return next((uri for uri in declared if uri.startswith(start)), start)


@cache
def _capitalise_sysml(name: str, namespace: str) -> str:
    # Enterprise Architect's SysML profile writes ``block``, but ``functionalRequirement``.
    is_lower = _SYSML.match(namespace) and not name.endswith("Requirement")
    return name[:1].upper() + name[1:] if is_lower else name


def find_id_by_guid(context: Context, guid: str) -> str:
    """Return the id of the element with a GUID (``{A059C88E-...}``), or the empty string."""
    if not _GUID.fullmatch(guid):
        return ""
    number = guid[1:-1].replace("-", "_")
    candidates = (f"{prefix}_{number}" for prefix in ("EAID", "EAPK"))
    return next((id for id in candidates if id in context.document.ids), "")


def localise_references(context: Context) -> None:
    """Redirect references to profiles and primitive types to the copies in the extension."""
    if context.extensions:
        context.unit.references[:] = [
            _localise(context, reference) if reference.file is context.file else reference
            for reference in context.unit.references
        ]


def _localise(context: Context, reference: UnresolvedReference) -> UnresolvedReference:
    document = context.document
    namespace, _, fragment = reference.target.partition("#")
    if reference.edge is Edge.APPLIES and reference.is_href and fragment in document.ids:
        context.unit.profiles.add(namespace, context.element_ids[document.ids[fragment]])
        return reference._replace(target=fragment, is_href=False)
    row = document.ids.get(reference.target, -1)
    if not reference.is_href and row >= 0 and _is_primitive(context, row):
        name = document.attributes[row].get("name", "")
        return reference._replace(target=f"{_PRIMITIVE_TYPES}{name}", is_href=True)
    return reference


def _is_primitive(context: Context, row: int) -> bool:
    document = context.document
    is_named_so = _PRIMITIVE.match(document.id(row)) is not None
    return is_named_so and document.types[row] == "PrimitiveType"
