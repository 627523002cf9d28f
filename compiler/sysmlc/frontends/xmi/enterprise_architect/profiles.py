"""Stereotype names and profiles as Enterprise Architect writes them.

No SysML model exported by Enterprise Architect was available for tests: its SysML is assumed to
follow the pattern of its other profiles.
"""

import re
from functools import cache

from sysmlc.frontends.xmi.context import Context
from sysmlc.frontends.xmi.unit import UnresolvedReference
from sysmlc.ir import Edge

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
        return split_stereotype_name(context, qualified_name, namespace)
    return _capitalise_sysml(name, namespace), namespace


def split_stereotype_name(
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
