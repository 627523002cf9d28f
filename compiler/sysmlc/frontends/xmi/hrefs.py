"""References to other files: the paths and fragments of hrefs, and stubs for external targets."""

import posixpath
import re
from functools import lru_cache
from urllib.parse import unquote

from sysmlc.frontends.xmi import namespaces
from sysmlc.frontends.xmi.document import Document
from sysmlc.frontends.xmi.metaclasses import kind_of
from sysmlc.frontends.xmi.vocabulary import TARGET_KINDS
from sysmlc.ir import Kind
from sysmlc.ir.element import ROOT, is_globally_unique

_MAX_LENGTH = 8192
"""Characters of an href that count: a longer one is cut, and leads nowhere."""
_SCHEME = re.compile(r"[A-Za-z][A-Za-z0-9+.-]*:")
_MODEL_FILE = re.compile(r"([^.]+)(?:\.\w+)*\.(?:uml|xmi|mdzip|xml)$")
_READABLE = re.compile(r"[A-Za-z][A-Za-z ]*$")
_PRIMITIVES = frozenset({"Boolean", "Integer", "Real", "String", "UnlimitedNatural"})
_PROJECT = re.compile(r"(local:/)?PROJECT-[^/]*\?resource=")


@lru_cache(4096)
def normalise_href(href: str, file: str) -> str:
    """Return *href* with its path relative to the root of the unit; an absolute URI is unchanged.

    *file* is the file that contains the href.
    """
    if len(href) > _MAX_LENGTH:
        href = href[:_MAX_LENGTH]
    path, _, fragment = href.partition("#")
    if not path:
        return f"{file}#{fragment}"
    if not _SCHEME.match(path):
        folder = posixpath.dirname(file.partition("!")[0])
        path = posixpath.normpath(posixpath.join(folder, unquote(path)))
    return f"{path}#{fragment}"


def is_in_project(href: str, fragment: str) -> bool:
    """Whether *href* leads into a project of MagicDraw: the model's own, or a used one.

    Only the id identifies the project, not the href; the ids of roots are equal in all projects.
    """
    return not fragment.startswith(ROOT) and _PROJECT.match(href) is not None


def can_lead_into(library: str, path: str, id: str) -> bool:
    """Whether a reference to *id* in the file *path* can mean an element of *library*.

    Generated ids are unique across models, so the path does not matter for them. An id such as
    ``_0`` occurs in many models, so the path decides.
    """
    return is_globally_unique(id) or is_in_project(path, id) or path == library != ""


def base_name(path: str) -> str:
    """Return the last part of a path or URI, without an archive's entry."""
    return unquote(posixpath.basename(path.partition("!")[0].partition("?")[0]))


# -- path fragments of EMF -------------------------------------------------------------------------


def is_path(fragment: str) -> bool:
    """Whether *fragment* is a path of EMF such as ``//@packagedElement.0/@ownedAttribute.2``."""
    return fragment.startswith("/")


def find_row_at_path(document: Document, fragment: str) -> int | None:
    """Return the row that the path leads to, or None.

    The first segment is the number of the root, empty for the first. ``@feature.2`` is the third
    child of that feature, ``@feature`` its only one; a segment without ``@`` is a name.
    """
    first, *steps = fragment.removeprefix("/").split("/")
    roots = _list_roots(document)
    number = _parse_number(first or "0")
    row = roots[number] if number is not None and number < len(roots) else None
    for step in steps:
        row = None if row is None else _find_child(document, row, step)
    return row


def _list_roots(document: Document) -> list[int]:
    """Return the roots that EMF counts: the children of ``xmi:XMI`` that are not XMI's own."""
    if not namespaces.is_xmi(document.namespace(0)):
        return [0]
    return [row for row in document.children(0) if not namespaces.is_xmi(document.namespace(row))]


def _find_child(document: Document, row: int, step: str) -> int | None:
    if not step.startswith("@"):
        return next((c for c in document.children(row) if document.get(c, "name") == step), None)
    feature, _, index = step.removeprefix("@").partition(".")
    number = _parse_number(index or "0")
    children = list(document.children(row, feature))
    return children[number] if number is not None and number < len(children) else None


def _parse_number(text: str) -> int | None:
    return int(text) if text.isdecimal() and len(text) < 10 else None


# -- stubs -----------------------------------------------------------------------------------------


def read_stub(document: Document, row: int, feature: str) -> tuple[Kind | None, str]:
    """Return the kind, if it is written, and the name of the external target of an href."""
    path, type_name = _read_reference_extension(document, row)
    href = document.href(row)
    name = path or read_name(href)
    mapped = kind_of(document.types[row] or type_name)
    kind = mapped[0] if mapped else None
    if kind is None and feature == "type" and name.rpartition("::")[2] in _PRIMITIVES:
        kind = Kind.DATA_TYPE
    if not name and feature in ("appliedProfile", "importedPackage"):
        file = _MODEL_FILE.match(base_name(href.partition("#")[0]))
        name = file[1] if file else ""
    return kind, name


def guess_kind(feature: str) -> Kind:
    """Return the kind that targets of *feature* usually have."""
    return TARGET_KINDS.get(feature, Kind.CLASS)


@lru_cache(4096)
def read_name(href: str) -> str:
    """Return a name that can be read in the fragment of an href, or the empty string.

    Eclipse writes ``...stereotype_packagedElement_Block``, OMG writes ``Integer``; other ids
    contain no name.
    """
    fragment = unquote(href.partition("#")[2])
    if re.search(r"_(packagedElement|owned[A-Z][a-z]+|nestedPackage|owned[A-Z]\w+?)_", fragment):
        return re.split(r"_(?:packagedElement|nestedPackage|owned[A-Z][A-Za-z]+)_", fragment)[-1]
    last = fragment.rpartition(".")[2]
    return last if _READABLE.match(last) else ""


def _read_reference_extension(document: Document, row: int) -> tuple[str, str]:
    """Return the qualified name and type that MagicDraw writes beside an href, or empty strings."""
    for child in range(row + 1, document.ends[row]):
        if document.features[child] == "referenceExtension":
            values = document.attributes[child]
            return values.get("referentPath", ""), values.get("referentType", "")
    return "", ""
