"""Namespaces of XMI, UML, SysML and of the profiles of a compile unit."""

import re
from functools import cache, lru_cache

from sysmlc.ir import Element, Graph, Kind

EMF_XMI = "http://www.omg.org/XMI"
"""Namespace that EMF writes if the options of UML2 are not set, and in files that are no models."""
_XMI = re.compile(
    r"https?://(www|schema)\.omg\.org/spec/XMI(/[\d.]+)?/?$|^omg\.org/XMI/2|" + EMF_XMI + "$"
)
_UML = re.compile(
    r"https?://www\.eclipse\.org/uml2/[\d.]+/UML/?$"
    r"|https?://(www|schema)\.omg\.org/spec/UML/[\d.]+/?$"
    # MagicDraw 17 writes this placeholder into some of its files.
    r"|uml_namespace$"
)
_SYSML = re.compile(
    r"https?://www\.eclipse\.org/papyrus/(0\.7\.0/SysML|sysml/[\d.]+/SysML)/\w"
    r"|https?://(www|schema)\.omg\.org/spec/SysML/"
    r"|https?://www\.sparxsystems\.com/profiles/SysML"
)
_SETTINGS = re.compile(r"MagicDrawProfile/?$|eclipse\.org/emf/2002/Ecore$|/UMLD[IC]/?$|/spec/MOF/")


@lru_cache(256)
def is_xmi(namespace: str) -> bool:
    """Whether *namespace* is that of a version of XMI 2."""
    return _XMI.match(namespace) is not None


@lru_cache(256)
def is_uml(namespace: str) -> bool:
    """Whether *namespace* is that of a version of UML 2; those of UML profiles are not."""
    return _UML.match(namespace) is not None


@lru_cache(256)
def is_settings(namespace: str) -> bool:
    """Whether all elements of *namespace* are notation or settings of a tool."""
    return _SETTINGS.search(namespace) is not None


def is_sysml(namespace: str) -> bool:
    """Whether the elements of *namespace* are applications of stereotypes of SysML itself."""
    return _SYSML.match(namespace) is not None


class Profiles:
    """Finds the stereotypes of a compile unit by the namespace of their profile and their name."""

    def __init__(self) -> None:
        self._packages: dict[str, list[str]] = {}
        self._stereotypes: dict[tuple[str, str], Element] | None = None

    def add(self, namespace: str, package: str) -> None:
        """Record that the package with the graph id *package* has this namespace."""
        packages = self._packages.setdefault(namespace, [])
        if package not in packages:
            packages.append(package)

    def find_stereotype(self, graph: Graph, namespace: str, name: str) -> Element | None:
        """Return the stereotype *name* in a profile with this namespace, or None.

        The first call builds the index, so that all profiles must have been added before.
        """
        if self._stereotypes is None:
            self._stereotypes = self._index_stereotypes(graph)
        return self._stereotypes.get((namespace, mangle_name(name)))

    def _index_stereotypes(self, graph: Graph) -> dict[tuple[str, str], Element]:
        namespaces: dict[str, list[str]] = {}
        for namespace, ids in self._packages.items():
            for id in ids:
                namespaces.setdefault(id, []).append(namespace)
        index: dict[tuple[str, str], Element] = {}
        for stereotype in graph.of_kind(Kind.STEREOTYPE):
            name = mangle_name(stereotype.name)
            for package in graph.ancestors(stereotype):
                recorded = namespaces.get(package.id, ())
                for namespace in (*recorded, *_conventional_namespaces(package)):
                    index.setdefault((namespace, name), stereotype)
        return index


@cache
def mangle_name(name: str) -> str:
    """Return the name of a stereotype as it is written in XML element names."""
    return re.sub(r"\W", "_", name)


def profile_in_namespace(namespace: str) -> str:
    """Return the profile's name in a namespace: ``Arrowhead`` in ``.../schemas/Arrowhead.xmi``."""
    return namespace.rpartition("/")[2].removesuffix(".xmi")


def default_namespace(profile: str) -> str:
    """Return the namespace that MagicDraw gives a profile without a URI of its own."""
    return f"http://www.magicdraw.com/schemas/{mangle_name(profile)}.xmi"


def _conventional_namespaces(package: Element) -> list[str]:
    """Return the URI of a profile, if it has one, and the namespace that MagicDraw gives it."""
    if package.kind is not Kind.PROFILE:
        return []
    uri = package.attrs.get("u_r_i") or package.attrs.get("uri")
    default = default_namespace(package.name)
    return [str(uri), default] if uri else [default]
