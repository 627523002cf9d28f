"""From the namespace of a stereotype application to the stereotype that it applies."""

import re
from functools import cache

from sysmlc.ir import Element, Graph, Kind


class Profiles:
    """Namespaces of the profiles of a compile unit."""

    def __init__(self) -> None:
        self._packages: dict[str, list[str]] = {}
        self._stereotypes: dict[tuple[str, str], Element] | None = None

    def add(self, namespace: str, package: str) -> None:
        """The package (its id in the graph) has the namespace."""
        known = self._packages.setdefault(namespace, [])
        if package not in known:
            known.append(package)

    def find(self, graph: Graph, namespace: str, name: str) -> Element | None:
        """The stereotype with this name in a profile with this namespace, or None."""
        if self._stereotypes is None:
            self._stereotypes = self._index(graph)
        return self._stereotypes.get((namespace, mangled(name)))

    def _index(self, graph: Graph) -> dict[tuple[str, str], Element]:
        spaces: dict[str, list[str]] = {}
        for namespace, packages in self._packages.items():
            for package in packages:
                spaces.setdefault(package, []).append(namespace)
        found: dict[tuple[str, str], Element] = {}
        for stereotype in graph.of_kind(Kind.STEREOTYPE):
            for above in graph.ancestors(stereotype):
                for namespace in (*spaces.get(above.id, ()), *_conventional(above)):
                    found.setdefault((namespace, mangled(stereotype.name)), stereotype)
        return found


@cache
def mangled(name: str) -> str:
    """A stereotype's name as XML element names can hold it."""
    return re.sub(r"\W", "_", name)


def last_segment(namespace: str) -> str:
    """What names the profile in its namespace: ``Arrowhead`` in ``.../schemas/Arrowhead.xmi``."""
    return namespace.rpartition("/")[2].removesuffix(".xmi")


def default_namespace(profile: str) -> str:
    """Return the namespace that MagicDraw gives a profile without a URI of its own."""
    return f"http://www.magicdraw.com/schemas/{mangled(profile)}.xmi"


def _conventional(package: Element) -> list[str]:
    if package.kind is not Kind.PROFILE:
        return []
    uri = package.attrs.get("u_r_i") or package.attrs.get("uri")
    default = default_namespace(package.name)
    return [str(uri), default] if uri else [default]
