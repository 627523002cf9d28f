"""Elements of the libraries of UML, SysML and MagicDraw, and the hrefs that refer to them.

The data (metamodels/libraries.json, written for this project) are the names in the standards and
tools, and the forms of references to them. They are loaded when a reference first needs them. An
href consists of a file and a fragment; the files of the standards are recognised by their names.
"""

import json
import re
from collections.abc import Collection, Iterable, Iterator
from functools import cache
from typing import Any
from urllib.parse import unquote

from msgspec import Struct

from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind
from sysmlc.ir.element import derived_id
from sysmlc.support import resources

_ROLE_NAME = re.compile(r"[a-zA-Z]+_(?:packagedElement|nestedPackage|owned[A-Z][A-Za-z]+)_(.+)")
_ESCAPE = re.compile(r"_u([0-9a-fA-F]{4})")
_METACLASS = re.compile(r"[A-Z][A-Za-z]+")


class LibraryElement(Struct, frozen=True):
    """An element of a library whose file is not part of the unit.

    ``generals`` and ``metaclasses`` are qualified names; ``href`` is the same for all dialects.
    """

    qualified_name: str
    kind: Kind
    href: str
    generals: tuple[str, ...] = ()
    metaclasses: tuple[str, ...] = ()

    @property
    def name(self) -> str:
        """The last part of the qualified name."""
        return self.qualified_name.rpartition("::")[2]

    @property
    def owner(self) -> str:
        """The qualified name of the package, empty for the library itself."""
        return self.qualified_name.rpartition("::")[0]


class _Library(Struct, frozen=True):
    name: str
    uri: str
    files: str
    """A regular expression for names of files, compiled at the first use."""
    others: str
    """Kind of the elements that are not listed, such as the metaclasses of UML, or empty."""


class Libraries:
    """Index of library elements by qualified name, by id, and by simple name."""

    def __init__(self, content: str) -> None:
        data = json.loads(content)
        self._libraries = {entry["name"]: _read_library(entry) for entry in data["libraries"]}
        self._entries: dict[str, dict[str, Any]] = data["elements"]
        self._by_id: dict[str, str] = {}
        self._by_name: dict[tuple[str, str], list[str]] = {}
        self._stereotypes: dict[tuple[str, str], list[str]] = {}
        for name, entry in self._entries.items():
            self._by_id.update(dict.fromkeys(entry.get("ids", ()), name))
            library, _, rest = name.partition("::")
            for short in (rest.rpartition("::")[2], *entry.get("aliases", ())):
                self._by_name.setdefault((library, short.lower()), []).append(name)
                if entry["kind"] == "Stereotype":
                    tag = re.sub(r"\W", "_", short)
                    self._stereotypes.setdefault((library, tag), []).append(name)

    def find(
        self, file: str, fragment: str, path: str, kinds: Iterable[Kind]
    ) -> LibraryElement | None:
        """Return the element to which a reference into *file* leads, or None.

        The element is found by its id, or else by the name in the fragment, or else by *path*, the
        qualified name in the reference. *kinds* are the kinds that the references expect.
        """
        name = self._by_id.get(fragment)
        if name is None:
            names = (
                self._find_name(library, fragment, path, kinds)
                for library in self._find_libraries(file)
            )
            name = next((name for name in names if name), None)
        return None if name is None else self.get(name)

    def get(self, qualified_name: str) -> LibraryElement | None:
        """Return the element with this qualified name, or None."""
        library, _, rest = qualified_name.partition("::")
        home = self._libraries.get(library)
        entry = self._entries.get(qualified_name)
        if home is None:
            return None
        href = f"{home.uri}#{rest.replace('::', '.') or '_0'}"
        if entry is None:
            is_other = home.others and _METACLASS.fullmatch(rest)
            return LibraryElement(qualified_name, Kind(home.others), href) if is_other else None
        return LibraryElement(
            qualified_name,
            Kind(str(entry["kind"])),
            href,
            tuple(entry.get("specializes", ())),
            tuple(f"UML::{name}" for name in entry.get("extends", ())),
        )

    def generals(self, library: str, name: str) -> tuple[str, ...]:
        """Return the names of the generals of the stereotypes with this name in a library.

        The name has the form of XML tags: ``System_context`` is "System context".
        """
        stereotypes = self._stereotypes.get((library, name), ())
        generals = (
            general
            for stereotype in stereotypes
            for general in self._entries[stereotype].get("specializes", ())
        )
        return tuple(dict.fromkeys(general.rpartition("::")[2] for general in generals))

    def _find_libraries(self, file: str) -> Iterator[_Library]:
        plain = unquote(file)
        return (
            library for library in self._libraries.values() if re.fullmatch(library.files, plain)
        )

    def _find_name(self, library: _Library, fragment: str, path: str, kinds: Iterable[Kind]) -> str:
        for names in (read_names(fragment), [part for part in path.split("::") if part]):
            if not names or names == [library.name]:
                if names or _is_root(fragment):
                    return library.name
                continue
            candidates = self._by_name.get((library.name, names[-1].lower()), [])
            if candidates:
                return min(
                    candidates,
                    key=lambda candidate: _distance(
                        candidate, names, self._kind_of(candidate), kinds
                    ),
                )
            if library.others and _METACLASS.fullmatch(names[-1]):
                return f"{library.name}::{names[-1]}"
        return ""

    def _kind_of(self, name: str) -> Kind:
        return Kind(str(self._entries[name]["kind"]))


def read_names(fragment: str) -> list[str]:
    """Return the names in a fragment, from the root down.

    Eclipse: ``SysML.package_packagedElement_Blocks.stereotype_packagedElement_Block`` or
    ``//blocks/Block``; OMG: ``SysML.Block``, ``_SysML_Libraries_PackageableElement-...``.
    """
    plain = unquote(fragment)
    if "_PackageableElement" in plain:
        parts = plain.removeprefix("_SysML_").split("-")
        return [part.removesuffix("_PackageableElement") for part in parts]
    if _is_root(plain):
        return []
    names = [part for part in re.split(r"[./]", plain) if part and part != "@"]
    matches = ((_ROLE_NAME.fullmatch(name), name) for name in names)
    return [_ESCAPE.sub(_decode_character, match[1] if match else name) for match, name in matches]


@cache
def load_libraries() -> Libraries:
    """Return the libraries, which are loaded once."""
    return Libraries(resources.read_text("metamodels", "libraries.json"))


def _read_library(entry: dict[str, Any]) -> _Library:
    files = "|".join(f"(?:{pattern})" for pattern in entry["files"])
    return _Library(str(entry["name"]), str(entry["uri"]), files, str(entry.get("others", "")))


def _is_root(fragment: str) -> bool:
    return fragment.strip("/") == "" or fragment == "_0" or fragment.endswith("__0")


def _distance(
    name: str, names: list[str], kind: Kind, kinds: Iterable[Kind]
) -> tuple[bool, int, int, str]:
    """Return the sort key of a candidate for a reference: mismatch of kind and owners, depth."""
    owners = {part.lower() for part in name.split("::")}
    missing = sum(part.lower() not in owners for part in names)
    is_package = kind in (Kind.PACKAGE, Kind.PROFILE)
    wants_package = any(expected in (Kind.PACKAGE, Kind.PROFILE) for expected in kinds)
    return is_package is not wants_package and kind not in kinds, missing, name.count("::"), name


def _decode_character(code: re.Match[str]) -> str:
    return chr(int(code[1], 16))


def find_library_element(
    target: str, paths: Collection[str], kinds: Collection[Kind]
) -> LibraryElement | None:
    """Return the element of a known library to which a target leads, or None.

    *paths* and *kinds* come from all references to the target, so that their order has no effect.
    """
    file, fragment = split_href(target)
    return load_libraries().find(file, fragment, min(filter(None, paths), default=""), kinds)


def add_stub(graph: Graph, library_element: LibraryElement, origin: str) -> Element:
    """Return the external stub of a library element; add it with its packages and generals.

    The packages of SysML become profiles in all dialects, because Eclipse applies them one by one
    and a stub must not depend on the dialect of the reference.
    """
    owner = _add_named_stub(graph, library_element.owner, origin)
    id = derived_id(library_element.href, "stub")
    existing = graph.get(id)
    if existing is not None:
        return existing
    attrs: dict[str, AttrValue] = {"external": True, "library": True, "href": library_element.href}
    attrs["origin"] = origin
    stub = graph.add(
        Element(
            id,
            library_element.kind,
            library_element.name,
            None if owner is None else owner.id,
            attrs=attrs,
        )
    )
    for edge, names in (
        (Edge.SPECIALIZES, library_element.generals),
        (Edge.EXTENDS, library_element.metaclasses),
    ):
        for name in names:
            general = _add_named_stub(graph, name, origin)
            if general is not None:
                graph.connect(edge, stub, general)
    return stub


def _add_named_stub(graph: Graph, name: str, origin: str) -> Element | None:
    library_element = load_libraries().get(name) if name else None
    return None if library_element is None else add_stub(graph, library_element, origin)


# -- hrefs -------------------------------------------------------------------------------------

PRIMITIVES = ("Boolean", "Integer", "Real", "String", "UnlimitedNatural")
PRIMITIVE_TYPES = "http://www.omg.org/spec/UML/20161101/PrimitiveTypes.xmi#"
"""The UML primitives of all dialects share one stub each, under this href."""

_STANDARD = re.compile(
    r"""pathmap://(UML_|SysML|SYSMLC_)\w*(LIBRARIES|METAMODELS|PROFILES)/
    | https?://(www|schema)\.omg\.org/spec/(UML|SysML|MOF|XMI)/
    | https?://www\.eclipse\.org/(uml2|emf)/
    | https?://www\.eclipse\.org/papyrus/(0\.7\.0/SysML|sysml/)
    | https?://www\.sparxsystems\.com/profiles/SysML
    | (.*/)?(UML_Standard_Profile|SysML\ Profile|MD_customization_for_\w+)\.(mdzip|mdxml|xml)$
    | (.*/)?UML_Standard_Profile\.[\w.]*profile\.uml$
    """,
    re.VERBOSE,
)
_PRIMITIVES_ONLY = re.compile(r"(.*/)?(UML)?PrimitiveTypes\.(library\.uml|xmi)")
_ALIASES = {
    "bool": "Boolean",
    "boolean": "Boolean",
    "eboolean": "Boolean",
    "byte": "Integer",
    "short": "Integer",
    "int": "Integer",
    "long": "Integer",
    "eint": "Integer",
    "elong": "Integer",
    "eshort": "Integer",
    "float": "Real",
    "double": "Real",
    "efloat": "Real",
    "edouble": "Real",
    "ebiginteger": "Integer",
    "ebigdecimal": "Real",
    "estring": "String",
    **{name.lower(): name for name in PRIMITIVES},
}
_PACKAGED_NAME = re.compile(r"(?:.*[._])?[a-zA-Z]+_packagedElement_(?P<name>.+)")
_PACKAGEABLE = re.compile(r"(?:.*-)?(?P<name>[^-]+)_PackageableElement")


def split_href(href: str) -> tuple[str, str]:
    """Return the file and the fragment of an href."""
    library, _, fragment = href.partition("#")
    return library, fragment


def is_href(target: str) -> bool:
    """Whether the target of a reference names a file, not only an id."""
    return "://" in target or target.find("#") > 0


def is_standard(library: str) -> bool:
    """Whether the file belongs to UML, SysML or sysmlc, so that its content is known."""
    return _STANDARD.match(unquote(library)) is not None


def has_primitives_only(library: str) -> bool:
    """Whether the file is UML's library of primitive types, whose elements are all known."""
    return _PRIMITIVES_ONLY.fullmatch(unquote(library)) is not None


def find_primitive(href: str, path: str, kind: Kind) -> str:
    """Return the UML primitive that an href leads to, or the empty string.

    *path* and *kind* are the qualified name and the kind that the reference states. The primitive
    value types of SysML and the types of Ecore and Java are mapped to the nearest primitive.
    """
    if kind not in (Kind.CLASS, Kind.DATA_TYPE) or not is_standard(split_href(href)[0]):
        return ""
    return _ALIASES.get(read_name(href, path).lower(), "")


def read_name(href: str, path: str) -> str:
    """Return the name of the target of an href: from *path*, or else from the fragment."""
    if path:
        return path.rpartition("::")[2]
    fragment = unquote(split_href(href)[1])
    for form in (_PACKAGEABLE, _PACKAGED_NAME):
        match = form.fullmatch(fragment)
        if match:
            return _ESCAPE.sub(_decode_character, match["name"])
    return re.split(r"[./]", fragment)[-1] or fragment


def choose_kind(href: str, kinds: set[Kind]) -> Kind:
    """Return the kind of an external target from the kinds that its references expect.

    Class is chosen only if no reference expects another kind.
    """
    if "stereotype_packagedElement_" in href:
        return Kind.STEREOTYPE
    specific = sorted(kinds - {Kind.CLASS})
    return specific[0] if specific else Kind.CLASS
