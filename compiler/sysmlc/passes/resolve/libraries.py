"""Stand-ins for the libraries of UML, SysML and MagicDraw: names, kinds, generalizations.

The data are ours (metamodels/libraries.json): what the standards and tools call their elements
and how their references write them. They are read when a reference first needs them.
"""

import json
import re
from collections.abc import Collection, Iterable, Iterator
from functools import cache
from urllib.parse import unquote

from msgspec import Struct

from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind
from sysmlc.ir.identity import derived_id
from sysmlc.passes.resolve.hrefs import split
from sysmlc.support import resources

_ROLE_NAME = re.compile(r"[a-zA-Z]+_(?:packagedElement|nestedPackage|owned[A-Z][A-Za-z]+)_(.+)")
_ESCAPE = re.compile(r"_u([0-9a-fA-F]{4})")
_METACLASS = re.compile(r"[A-Z][A-Za-z]+")


class StandIn(Struct, frozen=True):
    """What is known of one element of a library.

    ``generals`` and ``metaclasses`` are qualified names; ``href`` is the same for all dialects.
    """

    qualified_name: str
    kind: Kind
    href: str
    generals: tuple[str, ...] = ()
    metaclasses: tuple[str, ...] = ()

    @property
    def name(self) -> str:
        """Its name: the last part of the qualified one."""
        return self.qualified_name.rpartition("::")[2]

    @property
    def owner(self) -> str:
        """Qualified name of its package, empty for the library itself."""
        return self.qualified_name.rpartition("::")[0]


class _Library(Struct, frozen=True):
    name: str
    uri: str
    files: str
    """A regular expression, compiled when somebody asks for a file."""
    others: str


class Libraries:
    """The stand-ins, by qualified name, by id and by the name that a reference shows."""

    def __init__(self, content: str) -> None:
        data = json.loads(content)
        self._libraries = {one["name"]: _library(one) for one in data["libraries"]}
        self._entries: dict[str, dict[str, object]] = data["elements"]
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

    def find(self, file: str, fragment: str, path: str, kinds: Iterable[Kind]) -> StandIn | None:
        """The element that a reference into ``file`` means.

        Told by its id, else by the name in the fragment, else by ``path``, the qualified name
        that the reference shows; ``kinds`` is what it is used as.
        """
        known = self._by_id.get(fragment)
        if known is None:
            found = (self._named(one, fragment, path, kinds) for one in self._of_file(file))
            known = next((name for name in found if name), None)
        return None if known is None else self.get(known)

    def get(self, qualified_name: str) -> StandIn | None:
        """The element with this qualified name, or None."""
        library, _, rest = qualified_name.partition("::")
        home = self._libraries.get(library)
        entry = self._entries.get(qualified_name)
        if home is None:
            return None
        href = f"{home.uri}#{rest.replace('::', '.') or '_0'}"
        if entry is None:
            is_other = home.others and _METACLASS.fullmatch(rest)
            return StandIn(qualified_name, Kind(home.others), href) if is_other else None
        return StandIn(
            qualified_name,
            Kind(str(entry["kind"])),
            href,
            tuple(entry.get("specializes", ())),  # type: ignore[arg-type]
            tuple(f"UML::{name}" for name in entry.get("extends", ())),  # type: ignore[attr-defined]
        )

    def generals(self, library: str, name: str) -> tuple[str, ...]:
        """Names of what the stereotypes of this name in a library specialise.

        The name is as XML tags show it: ``System_context`` is "System context".
        """
        found = self._stereotypes.get((library, name), ())
        ups = (up for one in found for up in self._entries[one].get("specializes", ()))  # type: ignore[attr-defined]
        return tuple(dict.fromkeys(up.rpartition("::")[2] for up in ups))

    def _of_file(self, file: str) -> Iterator[_Library]:
        plain = unquote(file)
        return (one for one in self._libraries.values() if re.fullmatch(one.files, plain))

    def _named(self, library: _Library, fragment: str, path: str, kinds: Iterable[Kind]) -> str:
        for names in (names_in(fragment), [part for part in path.split("::") if part]):
            if not names or names == [library.name]:
                if names or _is_root(fragment):
                    return library.name
                continue
            found = self._by_name.get((library.name, names[-1].lower()), [])
            if found:
                return min(found, key=lambda one: _distance(one, names, self._kind(one), kinds))
            if library.others and _METACLASS.fullmatch(names[-1]):
                return f"{library.name}::{names[-1]}"
        return ""

    def _kind(self, name: str) -> Kind:
        return Kind(str(self._entries[name]["kind"]))


def names_in(fragment: str) -> list[str]:
    """Names from the root down that a fragment shows, as the tools write them.

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
    found = ((_ROLE_NAME.fullmatch(name), name) for name in names)
    return [_ESCAPE.sub(_character, match[1] if match else name) for match, name in found]


@cache
def libraries() -> Libraries:
    """The stand-ins; read once."""
    return Libraries(resources.read_text("metamodels", "libraries.json"))


def _library(entry: dict[str, object]) -> _Library:
    files = "|".join(f"(?:{pattern})" for pattern in entry["files"])  # type: ignore[attr-defined]
    return _Library(str(entry["name"]), str(entry["uri"]), files, str(entry.get("others", "")))


def _is_root(fragment: str) -> bool:
    return fragment.strip("/") == "" or fragment == "_0" or fragment.endswith("__0")


def _distance(
    name: str, names: list[str], kind: Kind, kinds: Iterable[Kind]
) -> tuple[bool, int, int, str]:
    """How far an element is from what a reference shows: kind, owners, depth."""
    above = {part.lower() for part in name.split("::")}
    missing = sum(part.lower() not in above for part in names)
    is_package = kind in (Kind.PACKAGE, Kind.PROFILE)
    wants_package = any(one in (Kind.PACKAGE, Kind.PROFILE) for one in kinds)
    return is_package is not wants_package and kind not in kinds, missing, name.count("::"), name


def _character(code: re.Match[str]) -> str:
    return chr(int(code[1], 16))


def find_library_element(
    target: str, paths: Collection[str], kinds: Collection[Kind]
) -> StandIn | None:
    """The element of a known library that a reference means, or None.

    ``paths`` and ``kinds`` are what all references to it say: their order must not matter.
    """
    file, fragment = split(target)
    return libraries().find(file, fragment, min(filter(None, paths), default=""), kinds)


def add_stub(graph: Graph, stand_in: StandIn, origin: str) -> Element:
    """Add the stand-in with its packages, generals and metaclasses, unless it is there.

    The packages of SysML are profiles, for Eclipse applies them one by one: what a stand-in is
    must not depend on the dialect that uses it.
    """
    owner = _add_named(graph, stand_in.owner, origin)
    id = derived_id(stand_in.href, "stub")
    found = graph.get(id)
    if found is not None:
        return found
    attrs: dict[str, AttrValue] = {"external": True, "library": True, "href": stand_in.href}
    attrs["origin"] = origin
    made = graph.add(
        Element(id, stand_in.kind, stand_in.name, None if owner is None else owner.id, attrs=attrs)
    )
    for edge, names in (
        (Edge.SPECIALIZES, stand_in.generals),
        (Edge.EXTENDS, stand_in.metaclasses),
    ):
        for name in names:
            general = _add_named(graph, name, origin)
            if general is not None:
                graph.connect(edge, made, general)
    return made


def _add_named(graph: Graph, name: str, origin: str) -> Element | None:
    stand_in = libraries().get(name) if name else None
    return None if stand_in is None else add_stub(graph, stand_in, origin)
