"""Which stereotypes an application stands for, the general ones included."""

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import lru_cache

from msgspec import Struct

from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.query import tag
from sysmlc.passes.classify.vocabulary import MEANINGFUL, Family, family, mangled, parents

_REMEMBERED = 1 << 10
"""Stereotypes whose lineage is kept: a model applies a few of them thousands of times."""


class Ancestor(Struct, frozen=True):
    """One stereotype of a lineage: its local name and whose it is."""

    name: str
    family: Family


_FAMILIES = {
    "SysML": Family.SYSML,
    "additional_stereotypes": Family.SYSML,
    "sysmlc": Family.SYSMLC,
}
"""Whose a profile is that does not say its namespace, by its name."""

_LIBRARY_FAMILIES = _FAMILIES | {
    **dict.fromkeys(
        ("StandardProfile", "StandardProfileL2", "StandardProfileL3", "Standard"), Family.STANDARD
    ),
    **dict.fromkeys(("MagicDraw_Profile", "UML_Standard_Profile"), Family.TOOL),
}
"""The same for library content, which says no namespace and is nobody's own."""


@dataclass(slots=True)
class Profiles:
    """Stereotypes of the unit, found for applications by namespace and local name."""

    graph: Graph
    _named: dict[str, list[Element]] = field(default_factory=dict)
    _families: dict[str, Family] = field(default_factory=dict)
    _chosen: dict[tuple[str, str], Element | None] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for stereotype in self.graph.of_kind(Kind.STEREOTYPE):
            if stereotype.attrs.get("library") or not stereotype.attrs.get("external"):
                self._named.setdefault(mangled(stereotype.name), []).append(stereotype)

    def lineage(self, application: Element) -> tuple[Ancestor, ...]:
        """From the applied stereotype to the most general one, each name of a family once.

        Profiles of the unit come first; behind them, or without them, stands what SysML says
        of its own stereotypes.
        """
        stereotype = self.stereotype(application)
        if stereotype is None:
            attrs = application.attrs
            return _said(str(attrs.get("namespace", "")), str(attrs.get("stereotype", "")))
        above = (one for up in self._family_tree(stereotype) for one in _known_above(up))
        return tuple(dict.fromkeys(above))

    def stereotype(self, application: Element) -> Element | None:
        """The applied Stereotype when a file of the unit, or a stand-in, has it."""
        given = self.graph.target(application, Edge.INSTANCE_OF)
        if given is not None and given.kind is Kind.STEREOTYPE:
            return given
        namespace = str(application.attrs.get("namespace", ""))
        key = namespace, mangled(str(application.attrs.get("stereotype", "")))
        if key not in self._chosen:
            self._chosen[key] = self._choose(*key)
        return self._chosen[key]

    def _choose(self, namespace: str, name: str) -> Element | None:
        """The one of that name whose profile has the namespace; alone in the unit it will do,
        unless the namespace is known to be somebody else's."""
        whose = family(namespace)
        candidates = sorted(self._named.get(name, ()), key=lambda one: one.id)
        if whose is not Family.CUSTOM:
            # What SysML says of its own stereotypes is known without any library.
            candidates = [one for one in candidates if not one.attrs.get("external")]
        for fits in (self._has_uri, self._has_name):
            found = next((one for one in candidates if fits(one, namespace)), None)
            if found is not None:
                return found
        same = [one for one in candidates if self._family(one) is whose]
        return same[0] if same and (len(same) == 1 or whose is not Family.CUSTOM) else None

    def _family_tree(self, stereotype: Element) -> Iterator[Ancestor]:
        seen = {stereotype.id}
        level = [stereotype]
        while level:
            yield from (Ancestor(one.name, self._family(one)) for one in level)
            ups = [up for one in level for up in self.graph.targets(one, Edge.SPECIALIZES)]
            level = [up for up in dict.fromkeys(ups) if up.id not in seen]
            seen.update(up.id for up in level)

    def _family(self, stereotype: Element) -> Family:
        if stereotype.id not in self._families:
            self._families[stereotype.id] = self._find_family(stereotype)
        return self._families[stereotype.id]

    def _find_family(self, stereotype: Element) -> Family:
        if stereotype.attrs.get("external"):
            found = family(str(stereotype.attrs.get("href", "")))
            return self._library_family(stereotype) if found is Family.CUSTOM else found
        for profile in self._profiles(stereotype):
            found = family(self._uri(profile))
            if found is not Family.CUSTOM:
                return found
        names = (mangled(profile.name) for profile in self._profiles(stereotype))
        return next((_FAMILIES[name] for name in names if name in _FAMILIES), Family.CUSTOM)

    def _library_family(self, stereotype: Element) -> Family:
        names = (mangled(profile.name) for profile in self._profiles(stereotype))
        known = (_LIBRARY_FAMILIES[name] for name in names if name in _LIBRARY_FAMILIES)
        return next(known, Family.CUSTOM)

    def _profiles(self, stereotype: Element) -> list[Element]:
        above = self.graph.ancestors(stereotype)
        return [one for one in above if one.kind in (Kind.PROFILE, Kind.PACKAGE)]

    def _uri(self, profile: Element) -> str:
        return str(profile.attrs.get("uri") or tag(self.graph, profile, "nsURI") or "")

    def _has_uri(self, stereotype: Element, namespace: str) -> bool:
        return any(self._uri(one) == namespace for one in self._profiles(stereotype))

    def _has_name(self, stereotype: Element, namespace: str) -> bool:
        # MagicDraw: http://www.magicdraw.com/schemas/Arrowhead.xmi of the profile "Arrowhead".
        last = re.sub(r"\.xmi$", "", namespace.rpartition("/")[2])
        return any(mangled(one.name) == last for one in self._profiles(stereotype))


@lru_cache(_REMEMBERED)
def _said(namespace: str, name: str) -> tuple[Ancestor, ...]:
    """The lineage of a stereotype that only SysML can say something of."""
    return tuple(dict.fromkeys(_known_above(Ancestor(name, family(namespace)))))


def _known_above(start: Ancestor) -> Iterator[Ancestor]:
    level = [start]
    while level:
        yield from level
        level = [
            Ancestor(up, one.family)
            for one in level
            if one.family is Family.SYSML
            for up in parents(mangled(one.name))
        ]


def meanings(lineage: tuple[Ancestor, ...]) -> tuple[str, ...]:
    """Names that count as stereotypes of SysML (UML's Trace and Refine among them)."""
    known = (Family.SYSML, Family.STANDARD)
    return tuple(mangled(one.name) for one in lineage if one.family in known)


def look_alike(lineage: tuple[Ancestor, ...]) -> str:
    """Name of SysML's that a purely custom lineage bears, or the empty string.

    Papyrus profiles often declare a FullPort of their own without specialising SysML's, and a
    profile that is not in the unit cannot say what it specialises. Another standard's
    namespace (MARTE's FlowPort) is never mistaken.
    """
    if any(one.family is not Family.CUSTOM for one in lineage):
        return ""
    return next((one.name for one in lineage if one.name in MEANINGFUL), "")


def known_meanings(name: str) -> tuple[str, ...]:
    """Meanings of SysML's stereotype of this name."""
    return meanings(tuple(_known_above(Ancestor(name, Family.SYSML))))
