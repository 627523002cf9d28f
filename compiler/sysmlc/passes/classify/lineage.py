"""The lineage of stereotype applications: the applied stereotype and its generals."""

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import lru_cache

from msgspec import Struct

from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.query import tag
from sysmlc.passes.classify.vocabulary import MEANINGFUL, Family, find_family, find_generals, mangle

_CACHE_SIZE = 1 << 10
"""Size of the cache of lineages: a model applies a few stereotypes thousands of times."""


class Ancestor(Struct, frozen=True):
    """A stereotype of a lineage: its local name and the family of its profile."""

    name: str
    family: Family


_FAMILIES = {
    "SysML": Family.SYSML,
    "additional_stereotypes": Family.SYSML,
    "sysmlc": Family.SYSMLC,
}
"""Family of a profile without a namespace, by the name of the profile."""

_LIBRARY_FAMILIES = _FAMILIES | {
    **dict.fromkeys(
        ("StandardProfile", "StandardProfileL2", "StandardProfileL3", "Standard"), Family.STANDARD
    ),
    **dict.fromkeys(("MagicDraw_Profile", "UML_Standard_Profile"), Family.TOOL),
}
"""Family of a profile in a library, by its name; library profiles have no namespace either."""


@dataclass(slots=True)
class Profiles:
    """Index of the stereotypes of the unit, by namespace and local name."""

    graph: Graph
    _by_name: dict[str, list[Element]] = field(default_factory=dict)
    _families: dict[str, Family] = field(default_factory=dict)
    _stereotypes: dict[tuple[str, str], Element | None] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for stereotype in self.graph.of_kind(Kind.STEREOTYPE):
            if stereotype.attrs.get("library") or not stereotype.attrs.get("external"):
                self._by_name.setdefault(mangle(stereotype.name), []).append(stereotype)

    def lineage(self, application: Element) -> tuple[Ancestor, ...]:
        """Return the applied stereotype and its generals, the most special one first.

        Generals in profiles of the unit are followed by those that SysML defines for its own
        stereotypes. If no profile of the unit defines the stereotype, only SysML's generals follow.
        """
        stereotype = self.find_stereotype(application)
        if stereotype is None:
            attrs = application.attrs
            return _lineage_by_name(
                str(attrs.get("namespace", "")), str(attrs.get("stereotype", ""))
            )
        ancestors = (
            ancestor
            for member in self._walk_generals(stereotype)
            for ancestor in _walk_sysml_generals(member)
        )
        return tuple(dict.fromkeys(ancestors))

    def find_stereotype(self, application: Element) -> Element | None:
        """Return the applied Stereotype, an element of the unit or external stub, or None."""
        assigned = self.graph.target(application, Edge.INSTANCE_OF)
        if assigned is not None and assigned.kind is Kind.STEREOTYPE:
            return assigned
        namespace = str(application.attrs.get("namespace", ""))
        key = namespace, mangle(str(application.attrs.get("stereotype", "")))
        if key not in self._stereotypes:
            self._stereotypes[key] = self._choose(*key)
        return self._stereotypes[key]

    def _choose(self, namespace: str, name: str) -> Element | None:
        """Return the stereotype of that name whose profile has the namespace, or None.

        If no profile matches, the result is a stereotype of that name in the same family. In the
        family of custom profiles it must be the only one.
        """
        owner_family = find_family(namespace)
        candidates = sorted(self._by_name.get(name, ()), key=lambda candidate: candidate.id)
        if owner_family is not Family.CUSTOM:
            # The vocabulary knows SysML's own stereotypes, so that stubs are not needed.
            candidates = [
                candidate for candidate in candidates if not candidate.attrs.get("external")
            ]
        for fits in (self._has_uri, self._has_name):
            match = next(
                (candidate for candidate in candidates if fits(candidate, namespace)), None
            )
            if match is not None:
                return match
        of_same_family = [
            candidate for candidate in candidates if self._family_of(candidate) is owner_family
        ]
        return (
            of_same_family[0]
            if of_same_family and (len(of_same_family) == 1 or owner_family is not Family.CUSTOM)
            else None
        )

    def _walk_generals(self, stereotype: Element) -> Iterator[Ancestor]:
        visited = {stereotype.id}
        level = [stereotype]
        while level:
            yield from (Ancestor(member.name, self._family_of(member)) for member in level)
            generals = [
                general
                for member in level
                for general in self.graph.targets(member, Edge.SPECIALIZES)
            ]
            level = [general for general in dict.fromkeys(generals) if general.id not in visited]
            visited.update(general.id for general in level)

    def _family_of(self, stereotype: Element) -> Family:
        if stereotype.id not in self._families:
            self._families[stereotype.id] = self._find_family(stereotype)
        return self._families[stereotype.id]

    def _find_family(self, stereotype: Element) -> Family:
        profiles = self._profiles_of(stereotype)
        uris, families = [self._uri_of(profile) for profile in profiles], _FAMILIES
        if stereotype.attrs.get("external"):
            uris, families = [str(stereotype.attrs.get("href", ""))], _LIBRARY_FAMILIES
        by_uri = map(find_family, uris)
        by_name = (families.get(mangle(profile.name), Family.CUSTOM) for profile in profiles)
        candidates = (family for family in (*by_uri, *by_name) if family is not Family.CUSTOM)
        return next(candidates, Family.CUSTOM)

    def _profiles_of(self, stereotype: Element) -> list[Element]:
        ancestors = self.graph.ancestors(stereotype)
        return [ancestor for ancestor in ancestors if ancestor.kind in (Kind.PROFILE, Kind.PACKAGE)]

    def _uri_of(self, profile: Element) -> str:
        return str(profile.attrs.get("uri") or tag(self.graph, profile, "nsURI") or "")

    def _has_uri(self, stereotype: Element, namespace: str) -> bool:
        return any(self._uri_of(profile) == namespace for profile in self._profiles_of(stereotype))

    def _has_name(self, stereotype: Element, namespace: str) -> bool:
        # MagicDraw derives the namespace from the name of the profile:
        # http://www.magicdraw.com/schemas/Arrowhead.xmi of the profile "Arrowhead".
        last = re.sub(r"\.xmi$", "", namespace.rpartition("/")[2])
        return any(mangle(profile.name) == last for profile in self._profiles_of(stereotype))


@lru_cache(_CACHE_SIZE)
def _lineage_by_name(namespace: str, name: str) -> tuple[Ancestor, ...]:
    """Return the lineage of a stereotype that no profile of the unit defines."""
    return tuple(dict.fromkeys(_walk_sysml_generals(Ancestor(name, find_family(namespace)))))


def _walk_sysml_generals(start: Ancestor) -> Iterator[Ancestor]:
    """Yield the ancestor and its generals as SysML defines them."""
    level = [start]
    while level:
        yield from level
        level = [
            Ancestor(general, ancestor.family)
            for ancestor in level
            if ancestor.family is Family.SYSML
            for general in find_generals(mangle(ancestor.name))
        ]


def find_meanings(lineage: tuple[Ancestor, ...]) -> tuple[str, ...]:
    """Return the stereotypes of SysML and of UML's standard profile (Trace, Refine) by name."""
    families = (Family.SYSML, Family.STANDARD)
    return tuple(mangle(ancestor.name) for ancestor in lineage if ancestor.family in families)


def find_look_alike(lineage: tuple[Ancestor, ...]) -> str:
    """Return the first SysML name in a lineage of custom stereotypes only, or the empty string.

    Papyrus profiles often declare a FullPort of their own without specialising SysML's, and a
    profile that is not in the unit cannot state its generals. A stereotype in the namespace of
    another standard (MARTE's FlowPort) never counts.
    """
    if any(ancestor.family is not Family.CUSTOM for ancestor in lineage):
        return ""
    return next((ancestor.name for ancestor in lineage if ancestor.name in MEANINGFUL), "")


def meanings_of_sysml(name: str) -> tuple[str, ...]:
    """Return the meanings of the SysML stereotype with this name: itself and its generals."""
    return find_meanings(tuple(_walk_sysml_generals(Ancestor(name, Family.SYSML))))
