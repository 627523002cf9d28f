"""References to other files: which element of the unit they mean, and what to call a stub."""

import posixpath
import re
from functools import lru_cache
from urllib.parse import unquote

from sysmlc.frontends.xmi.document import Document
from sysmlc.frontends.xmi.metaclasses import kind_of
from sysmlc.frontends.xmi.vocabulary import HINTS
from sysmlc.ir import Kind
from sysmlc.ir.identity import ROOT, is_unmistakable

_LONGEST = 8192
"""Characters of an href that count: a longer one leads nowhere, and is told by its beginning."""
_SCHEME = re.compile(r"[A-Za-z][A-Za-z0-9+.-]*:")
_MODEL_FILE = re.compile(r"([^.]+)(?:\.\w+)*\.(?:uml|xmi|mdzip|xml)$")
_READABLE = re.compile(r"[A-Za-z][A-Za-z ]*$")
_PRIMITIVES = frozenset({"Boolean", "Integer", "Real", "String", "UnlimitedNatural"})
_PROJECT = re.compile(r"(local:/)?PROJECT-[^/]*\?resource=")


@lru_cache(4096)
def normalised(href: str, file: str) -> str:
    """The href with its path relative to the unit's root; what has a scheme stays as it is."""
    if len(href) > _LONGEST:
        href = href[:_LONGEST]
    path, _, fragment = href.partition("#")
    if not path:
        return f"{file}#{fragment}"
    if not _SCHEME.match(path):
        folder = posixpath.dirname(file.partition("!")[0])
        path = posixpath.normpath(posixpath.join(folder, unquote(path)))
    return f"{path}#{fragment}"


def is_in_project(href: str, fragment: str) -> bool:
    """Whether it leads into a project as MagicDraw names them: this one, or one that it uses.

    Which of them, only the id can tell, and those of the roots cannot.
    """
    return not fragment.startswith(ROOT) and _PROJECT.match(href) is not None


def can_lead_into(library: str, path: str, id: str) -> bool:
    """Whether a reference to the id in the file ``path`` can mean an element of the library.

    The id alone tells when it is the same in no two models; ``_0`` is in many.
    """
    return is_unmistakable(id) or is_in_project(path, id) or path == library != ""


def base_name(path: str) -> str:
    """Last part of a path or URI, without an archive's entry."""
    return unquote(posixpath.basename(path.partition("!")[0].partition("?")[0]))


def hint(document: Document, row: int, feature: str) -> tuple[Kind | None, str]:
    """Kind, if it is written, and name of the external element that an ``href`` refers to.

    MagicDraw writes its qualified name.
    """
    path, type_name = _reference_extension(document, row)
    href = document.attributes[row].get("href", "")
    name = path or name_in(href)
    known = kind_of(document.types[row] or type_name)
    kind = known[0] if known else None
    if kind is None and feature == "type" and name.rpartition("::")[2] in _PRIMITIVES:
        kind = Kind.DATA_TYPE
    if not name and feature in ("appliedProfile", "importedPackage"):
        file = _MODEL_FILE.match(base_name(href.partition("#")[0]))
        name = file[1] if file else ""
    return kind, name


def likely(feature: str) -> Kind:
    """What the target of a feature is when nothing else says so."""
    return HINTS.get(feature, Kind.CLASS)


@lru_cache(4096)
def name_in(href: str) -> str:
    """A name that can be read in the fragment of an href, or the empty string.

    Eclipse writes ``...stereotype_packagedElement_Block``, OMG writes ``Integer``; other ids
    say nothing.
    """
    fragment = unquote(href.partition("#")[2])
    if re.search(r"_(packagedElement|owned[A-Z][a-z]+|nestedPackage|owned[A-Z]\w+?)_", fragment):
        return re.split(r"_(?:packagedElement|nestedPackage|owned[A-Z][A-Za-z]+)_", fragment)[-1]
    last = fragment.rpartition(".")[2]
    return last if _READABLE.match(last) else ""


def _reference_extension(document: Document, row: int) -> tuple[str, str]:
    for child in range(row + 1, document.ends[row]):
        if document.features[child] == "referenceExtension":
            values = document.attributes[child]
            return values.get("referentPath", ""), values.get("referentType", "")
    return "", ""
