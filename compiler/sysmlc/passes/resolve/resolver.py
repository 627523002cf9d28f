"""What each reference means: an element of the unit, or a stand-in for one outside it."""

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from sysmlc.ir import AttrValue, Element, Graph, Kind
from sysmlc.ir.identity import derived_id
from sysmlc.passes.resolve.hrefs import (
    PRIMITIVE_TYPES,
    is_href,
    kind_of,
    name_of,
    primitive,
    split,
)
from sysmlc.passes.resolve.references import Need, Use
from sysmlc.passes.resolve.targets import Targets
from sysmlc.values import dataclass

if TYPE_CHECKING:
    from sysmlc.passes.resolve.libraries import StandIn


@dataclass(slots=True)
class Answers:
    """What each target means, by the file that names it."""

    graph: Graph
    targets: Targets
    outside: dict[str, list[Need]] = field(default_factory=dict)
    """Needs of elements outside the unit, by the href of the stand-in."""
    known: "dict[str, StandIn]" = field(default_factory=dict)
    """Those of ``outside`` that are elements of a known library."""
    _found: dict[tuple[str, str], str | None] = field(default_factory=dict)
    _stubs: dict[str, str] = field(default_factory=dict)

    def find(self, needs: list[Need]) -> None:
        """Look for every target, and make the stand-ins for those outside the unit."""
        distant: dict[str, list[Need]] = {}
        for need in needs:
            if need.target not in self.graph and self._is_outside(need.file, need.target):
                distant.setdefault(need.target, []).append(need)
        for target in sorted(distant):
            href = self._canonical(target, distant[target])
            self._stubs[target] = stand_in_id(href)
            self.outside.setdefault(href, []).extend(distant[target])
        for href in sorted(self.outside):
            self._add(href, self.outside[href])

    def get(self, file: str, target: str) -> Element | None:
        """The element that ``target`` means in a file."""
        if target in self.graph:
            return self.graph[target]
        found = self._found.get((file, target))
        return self.graph.get(found or self._stubs.get(target))

    def _is_outside(self, file: str, target: str) -> bool:
        element = self.targets.find(file, target)
        self._found[file, target] = element.id if element else None
        if element is not None or not is_href(target):
            return False
        return not self.targets.files(file, split(target)[0])

    def _canonical(self, target: str, needs: list[Need]) -> str:
        from sysmlc.passes.resolve.outside import known

        # All are asked, for the order in which they come must not matter.
        said = {(need.path, need.kind) for need in needs}
        name = max({primitive(target, path, kind) for path, kind in said})
        if name:
            return PRIMITIVE_TYPES + name
        found = known(target, {path for path, _ in said}, {kind for _, kind in said})
        if found is None:
            return target
        if found.owner == "PrimitiveTypes":
            return PRIMITIVE_TYPES + found.name
        self.known[found.href] = found
        return found.href

    def _add(self, href: str, needs: list[Need]) -> None:
        if href in self.known:
            from sysmlc.passes.resolve.outside import add

            add(self.graph, self.known[href], _origin(needs))
        else:
            _stand_in(self.graph, href, needs)


def stand_in_id(href: str) -> str:
    """Id of the stand-in for an element outside the unit, by its address."""
    return derived_id(href, "stub")


def _origin(needs: list[Need]) -> str:
    return min((need.first() for need in needs), key=Use.place).holder.id


def _stand_in(graph: Graph, href: str, needs: list[Need]) -> None:
    id = stand_in_id(href)
    if id in graph:
        return
    path = min((need.path for need in needs if need.path), default="")
    kind = kind_of(href, {need.kind for need in needs})
    attrs: dict[str, AttrValue] = {"external": True, "href": href}
    if href.startswith(PRIMITIVE_TYPES):
        kind, path = Kind.DATA_TYPE, ""
        attrs["subkind"] = "primitive"
    if "::" in path:
        attrs["qualified_name"] = path
    attrs["origin"] = _origin(needs)
    graph.add(Element(id, kind, name_of(href, path), attrs=attrs))
