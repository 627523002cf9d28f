"""Enterprise Architect's profiles: names of stereotypes, and what the extension holds of them.

No SysML model that Enterprise Architect exported was there to test with: what is said of its SysML
here follows the pattern of its other profiles.
"""

import re
from functools import cache

from sysmlc.frontends.xmi.context import Context
from sysmlc.frontends.xmi.unit import Link
from sysmlc.ir import Edge

_PRIMITIVE = re.compile(r"EA[A-Za-z#+]*_\w+$")
_PRIMITIVE_TYPES = "http://www.omg.org/spec/UML/20161101/PrimitiveTypes.xmi#"
_GUID = re.compile(r"\{[0-9A-Fa-f]{8}(-[0-9A-Fa-f]{4}){3}-[0-9A-Fa-f]{12}\}")
_SYSML = re.compile(r"https?://www\.sparxsystems\.com/profiles/SysML")


def stereotype_of(context: Context, row: int) -> tuple[str, str]:
    """Name and namespace of the stereotype that the row applies, whoever wrote the file.

    Enterprise Architect mangles names (``EAUML__X``) and keeps the whole one in an attribute;
    a name with a prefix is of the profile with that prefix. Its SysML begins in lower case.
    """
    document = context.document
    name, namespace = document.features[row], document.namespace(row)
    whole = document.attributes[row].get("__EAStereoName")
    if whole:
        return qualified(context, whole, namespace)
    return _spelt(name, namespace), namespace


def qualified(context: Context, whole: str, namespace: str = "") -> tuple[str, str]:
    """Name and namespace of a stereotype from ``Prefix::Name``; ``namespace`` if no prefix."""
    prefix, _, name = whole.rpartition("::")
    space = _namespace(context, prefix) if prefix else namespace
    return _spelt(name, space), space


def _namespace(context: Context, prefix: str) -> str:
    """Namespace of a profile by its prefix: one that the file has, else as the tool makes them."""
    start = f"http://www.sparxsystems.com/profiles/{prefix}/"
    return next((uri for uri in context.document.declared if uri.startswith(start)), start)


@cache
def _spelt(name: str, namespace: str) -> str:
    is_lower = _SYSML.match(namespace) and not name.endswith("Requirement")
    return name[:1].upper() + name[1:] if is_lower else name


def id_of(context: Context, guid: str) -> str:
    """Id of the element that a tagged value names by its GUID (``{A059C88E-...}``), or empty."""
    if not _GUID.fullmatch(guid):
        return ""
    number = guid[1:-1].replace("-", "_")
    written = (f"{prefix}_{number}" for prefix in ("EAID", "EAPK"))
    return next((id for id in written if id in context.document.ids), "")


def localise(context: Context) -> None:
    """Tie references to profiles and primitive types to what the extension holds of them."""
    if not context.extensions:
        return
    context.unit.links[:] = [
        _localised(context, link) if link.lowered is context.lowered else link
        for link in context.unit.links
    ]


def _localised(context: Context, link: Link) -> Link:
    document = context.document
    namespace, _, fragment = link.target.partition("#")
    if link.edge is Edge.APPLIES and link.is_href and fragment in document.ids:
        context.unit.profiles.add(namespace, context.gids[document.ids[fragment]])
        return link._replace(target=fragment, is_href=False)
    at = document.ids.get(link.target, -1)
    if not link.is_href and at >= 0 and _is_primitive(context, at):
        name = document.attributes[at].get("name", "")
        return link._replace(target=f"{_PRIMITIVE_TYPES}{name}", is_href=True)
    return link


def _is_primitive(context: Context, row: int) -> bool:
    document = context.document
    id = document.id(row)
    return _PRIMITIVE.match(id) is not None and document.types[row] == "PrimitiveType"
