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
from sysmlc.frontends.xmi.namespaces import mangle_name
from sysmlc.frontends.xmi.unit import ElementHandler, File, UnresolvedReference
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


def read_extensions(file: File) -> None:
    """Add the content of the extensions; applications must be in the graph already."""
    queue = deque(
        row for extension in _list_extensions(file) for row in _list_descriptions(file, extension)
    )
    while queue:
        row = queue.popleft()
        _read_description(file, row)
        queue.extend(_list_descriptions(file, row))


def _list_extensions(file: File) -> list[int]:
    document = file.document
    return [
        row
        for row in document.children(0)
        if file.verdicts[row] is Verdict.IGNORED_NOTATION
        and document.attributes[row].get("extender") == "Enterprise Architect"
    ]


def _list_descriptions(file: File, row: int) -> Iterator[int]:
    document = file.document
    for feature in _LISTS:
        for holder in document.children(row, feature):
            yield from document.children(holder)


def _read_description(file: File, row: int) -> None:
    document = file.document
    id = document.idref(row)
    _read_details(file, row, id)
    for holder, end_prefix in (("source", "src"), ("target", "dst")):
        for end in document.children(row, holder):
            # The id of an end is that of the connector with its first two digits replaced.
            _read_details(file, end, f"{_PREFIX}{end_prefix}{id[len(_PREFIX) + 2 :]}")


def _read_details(file: File, row: int, id: str) -> None:
    """Read what a description states about the element *id*."""
    document = file.document
    target = file.unit.find_target(file, id, False)
    element = file.unit.graph.get(target.element_id) if target else None
    if element is None or target is None:
        return
    if not target.element:
        # A note on content of an element, such as an event, is a note on that element.
        for feature in ("properties", "documentation"):
            for child in document.children(row, feature):
                _add_note(file, element, child, id)
        return
    for child in document.children(row):
        handler = _DETAILS.get(document.features[child])
        if handler is not None:
            handler(file, element, child)


# -- notes -----------------------------------------------------------------------------------------


def _read_note(file: File, element: Element, row: int) -> None:
    _add_note(file, element, row, element.id)


def _add_note(file: File, element: Element, row: int, origin: str) -> None:
    """Add a comment unless the model has it; *origin* is the id from which its id is derived."""
    values = file.document.attributes[row]
    text = values.get("value") or values.get("documentation", "")
    if not text:
        return
    file.verdicts[row] = Verdict.MAPPED
    if not any(_is_comment(owned, text) for owned in file.unit.graph.owned(element)):
        id = derived_id(origin, "documentation")
        comment = Element(id, Kind.COMMENT, "", element.id, *_source(file, row))
        comment.attrs["body"] = text
        file.unit.graph.add(comment)
        file.unit.graph.connect(Edge.REFERENCES, comment, element)


def _is_comment(element: Element, text: str) -> bool:
    return element.kind is Kind.COMMENT and element.attrs.get("body") == text


# -- constraints -----------------------------------------------------------------------------------


def _read_constraints(file: File, element: Element, row: int) -> None:
    """Add the constraints ``<constraint name= type=>`` that the model does not have."""
    document = file.document
    for number, child in enumerate(document.children(row, "constraint")):
        values = document.attributes[child]
        body = next((values[name] for name in _CONSTRAINT_TEXTS if values.get(name)), "")
        name = values.get("name", "")
        if not name and not body:
            continue
        file.verdicts[row] = file.verdicts[child] = Verdict.MAPPED
        if not any(_is_constraint(owned, name, body) for owned in file.unit.graph.owned(element)):
            id = derived_id(element.id, f"constraint[{number}]")
            _add_constraint(file, element, child, id, name, body)


def _is_constraint(element: Element, name: str, body: str) -> bool:
    has_name = bool(name) and element.name == name
    has_body = element.attrs.get("body") == (body or name)
    return element.kind is Kind.CONSTRAINT and (has_name or has_body)


def _add_constraint(file: File, element: Element, row: int, id: str, name: str, body: str) -> None:
    constraint = Element(id, Kind.CONSTRAINT, name if body else "", element.id, *_source(file, row))
    # Users of Enterprise Architect write formulas in the field that other tools use for the name.
    constraint.attrs["body"] = body or name
    type_name = file.document.attributes[row].get("type", "")
    if type_name.lower() in _CONSTRAINT_SUBKINDS:
        constraint.attrs["subkind"] = _CONSTRAINT_SUBKINDS[type_name.lower()]
    elif type_name.upper() == "OCL":
        constraint.attrs["language"] = "OCL"
    elif type_name:
        constraint.attrs["tag.type"] = type_name
    file.unit.graph.add(constraint)


# -- tagged values and stereotypes -----------------------------------------------------------------


def _read_tags(file: File, element: Element, row: int) -> None:
    """Store the tagged values that no application of a stereotype has."""
    for tag in file.document.children(row):
        values = file.document.attributes[tag]
        name, value = values.get("name", ""), values.get("value", "")
        if name and value:
            file.verdicts[tag] = Verdict.MAPPED
            applications = _list_applications(file, element)
            if not any(_has_tag(application, name) for application in applications):
                key = f"tag.{name.rpartition('::')[2]}"
                element.attrs[key] = find_id_by_guid(file, value) or value


def _has_tag(application: Element, name: str) -> bool:
    short = mangle_name(name.rpartition("::")[2])
    return any(f"tag.{tag}" in application.attrs for tag in (name, mangle_name(name), short))


def _read_stereotypes(file: File, element: Element, row: int) -> None:
    """Apply the stereotypes that ``xrefs`` lists: ``$DES=@STEREO;Name=..;FQName=..;@ENDSTEREO``."""
    text = file.document.attributes[row].get("value", "")
    for entry in _STEREOTYPE.findall(text):
        file.verdicts[row] = Verdict.MAPPED
        fields = dict(field.partition("=")[::2] for field in entry.split(";"))
        _apply(file, element, row, fields.get("FQName") or fields.get("Name", ""))


def _apply(file: File, element: Element, row: int, qualified_name: str) -> None:
    name, namespace = _split_stereotype_name(file, qualified_name)
    applied = {mangle_name(app.name) for app in _list_applications(file, element)}
    if not name or mangle_name(name) in applied:
        return
    id = derived_id(element.id, f"{mangle_name(name)}[{file.document.ordinals[row]}]")
    application = Element(id, Kind.APPLICATION, name, element.id, *_source(file, row))
    application.attrs["stereotype"], application.attrs["namespace"] = name, namespace
    file.unit.graph.add(application)
    file.unit.graph.connect(Edge.SUBJECT, application, element)
    stereotype = file.unit.profiles.find_stereotype(file.unit.graph, namespace, name)
    if stereotype is not None:
        file.unit.graph.connect(Edge.INSTANCE_OF, application, stereotype)


def _list_applications(file: File, element: Element) -> list[Element]:
    return [owned for owned in file.unit.graph.owned(element) if owned.kind is Kind.APPLICATION]


def _source(file: File, row: int) -> tuple[int, str]:
    """Ordinal and file of the row."""
    return file.document.ordinals[row], file.document.name


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


def read_stereotype_name(file: File, row: int) -> tuple[str, str]:
    """Return name and namespace of the stereotype that the row applies, whatever tool wrote it.

    Enterprise Architect mangles the name in the tag (``EAUML__X``) and writes the qualified name in
    an attribute.
    """
    document = file.document
    name, namespace = document.features[row], document.namespace(row)
    qualified_name = document.attributes[row].get("__EAStereoName")
    if qualified_name:
        return _split_stereotype_name(file, qualified_name, namespace)
    return _capitalise_sysml(name, namespace), namespace


def _split_stereotype_name(
    file: File, qualified_name: str, default_namespace: str = ""
) -> tuple[str, str]:
    """Return name and namespace of the stereotype ``Prefix::Name``.

    A name without prefix is in *default_namespace*.
    """
    prefix, _, name = qualified_name.rpartition("::")
    namespace = _find_namespace(file, prefix) if prefix else default_namespace
    return _capitalise_sysml(name, namespace), namespace


def _find_namespace(file: File, prefix: str) -> str:
    """Return the namespace that the file declares for a profile, else the tool's pattern for it."""
    start = f"http://www.sparxsystems.com/profiles/{prefix}/"
    declared = file.document.declared_namespaces
    return next((uri for uri in declared if uri.startswith(start)), start)


@cache
def _capitalise_sysml(name: str, namespace: str) -> str:
    # Enterprise Architect's SysML profile writes ``block``, but ``functionalRequirement``.
    is_lower = _SYSML.match(namespace) and not name.endswith("Requirement")
    return name[:1].upper() + name[1:] if is_lower else name


def find_id_by_guid(file: File, guid: str) -> str:
    """Return the id of the element with a GUID (``{A059C88E-...}``), or the empty string."""
    if not _GUID.fullmatch(guid):
        return ""
    number = guid[1:-1].replace("-", "_")
    candidates = (f"{prefix}_{number}" for prefix in ("EAID", "EAPK"))
    return next((id for id in candidates if id in file.document.ids), "")


def localise_references(file: File) -> None:
    """Redirect references to profiles and primitive types to the copies in the extension."""
    if _list_extensions(file):
        file.unit.references[:] = [
            _localise(file, reference) if reference.file is file else reference
            for reference in file.unit.references
        ]


def _localise(file: File, reference: UnresolvedReference) -> UnresolvedReference:
    document = file.document
    namespace, _, fragment = reference.target.partition("#")
    if reference.edge is Edge.APPLIES and reference.is_href and fragment in document.ids:
        file.unit.profiles.add(namespace, file.element_ids[document.ids[fragment]])
        return reference._replace(target=fragment, is_href=False)
    row = document.ids.get(reference.target, -1)
    if not reference.is_href and row >= 0 and _is_primitive(file, row):
        name = document.attributes[row].get("name", "")
        return reference._replace(target=f"{_PRIMITIVE_TYPES}{name}", is_href=True)
    return reference


def _is_primitive(file: File, row: int) -> bool:
    document = file.document
    is_named_so = _PRIMITIVE.match(document.id(row)) is not None
    return is_named_so and document.types[row] == "PrimitiveType"
