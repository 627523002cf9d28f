"""What the sides of internal links lead to: interfaces, in every style that files have."""

from collections.abc import Callable
from functools import partial
from typing import NamedTuple

from sysmlc.frontends.caex import rules
from sysmlc.frontends.caex.context import Context
from sysmlc.frontends.caex.document import Document, Node
from sysmlc.frontends.caex.paths import split
from sysmlc.frontends.caex.site import Site
from sysmlc.frontends.caex.sites import Sites

SIDES = {"A": "RefPartnerSideA", "B": "RefPartnerSideB"}


class End(NamedTuple):
    """The port that a side of a link means, and the internal element that has it."""

    port: str
    site: Site


_end: Callable[[tuple[str, Site]], End] = partial(tuple.__new__, End)


class Problem(NamedTuple):
    """Why a side leads nowhere; ``known`` is what it names all the same."""

    text: str
    known: str = ""


class Sides:
    """Finds the ends of the links of a unit."""

    def __init__(self, context: Context, sites: Sites) -> None:
        self._context = context
        self._sites = sites
        self._spot = context.ids.spot
        self._rows = sites.rows
        self._direct: dict[str, End] = {}
        self._named: dict[Node, dict[str, Node]] = {}
        self._below: dict[Node, dict[str, list[Node]]] = {}

    def direct(self, text: str) -> End | None:
        """The end that is named by the ID of an interface and nothing else, as in CAEX 3.0."""
        known = self._direct.get(text)
        if known is not None:
            return known
        place = self._spot(text)
        if place is None:
            return None
        document, row = place
        tags, port, rows = document.tags, document.elements[row], self._rows(document)
        if not port or tags[row] != "ExternalInterface":
            return None
        above = document.parents[row]
        site = rows[above]
        while site is None and tags[above] == "ExternalInterface":
            above = document.parents[above]
            site = rows[above]
        if site is None:
            return None
        found = self._direct[text] = _end((port, site))
        return found

    def end(self, node: Node, document: Document, side: str) -> End | Problem | None:
        """The end that a side means; None when it is open. What leads nowhere is reported."""
        text = node.attributes.get(SIDES[side], "").strip()
        if not text:
            self._context.report(rules.OPEN_LINK, document, node, element=node.name, side=side)
            return None
        found = self._found(text, document, node)
        if isinstance(found, Problem):
            facts = {"side": side, "reference": text, "problem": found.text}
            self._context.report(rules.DANGLING_LINK, document, node, element=node.name, **facts)
        return found

    def _found(self, text: str, document: Document, node: Node) -> End | Problem:
        """An interface by its id; by the id of its owner and its name; by a path."""
        direct = self._context.find(text, document)
        if direct is not None:
            self._context.tell_lenient(document, node, text)
            return self._of_node(direct[1])
        for at in (i for i, sign in enumerate(text) if sign == ":"):
            owner = self._context.find(text[:at], document) or self._by_path(text[:at])
            if owner is not None:
                self._context.tell_lenient(document, node, text[:at])
                return self._of_name(owner[1], text[at + 1 :])
        return Problem("no element has that id" if _is_id(text) else "it names no interface")

    def _by_path(self, path: str) -> tuple[Document, Node] | None:
        top, *names = split(path).names
        for document in self._context.documents:
            nodes = self._inside(document.root).get(top, [])
            for name in names:
                nodes = [node for above in nodes for node in self._inside(above).get(name, ())]
            if len(nodes) == 1:
                return document, nodes[0]
        return None

    def _inside(self, node: Node) -> dict[str, list[Node]]:
        """What a path can mean next, by name: all paths of a file ask for it."""
        known = self._below.get(node)
        if known is None:
            known = self._below[node] = {}
            for one in node.children if node.row == 0 else node.of("InternalElement"):
                known.setdefault(one.name, []).append(one)
        return known

    def _of_node(self, node: Node) -> End | Problem:
        above = node.parent
        while above is not None and above.tag == "ExternalInterface":
            above = above.parent
        site = self._sites.of(above) if above is not None else None
        if node.tag == "ExternalInterface" and site is not None and node.element:
            return End(node.element, site)
        return Problem(f"that is no interface but '{node.name}'", node.element)

    def _of_name(self, owner: Node, name: str) -> End | Problem:
        node = self._interfaces(owner).get(name)
        if node is not None:
            return self._of_node(node)
        site = self._sites.of(owner)
        known = site.type.find("ExternalInterface", name) if site and site.type else None
        if site is not None and known is not None:
            return End(known.id, site)
        return Problem(f"'{owner.name}' has no interface '{name}'", owner.element)

    def _interfaces(self, owner: Node) -> dict[str, Node]:
        """The interfaces of an element by name, the first of each: all its links ask for them."""
        known = self._named.get(owner)
        if known is None:
            known = self._named[owner] = {}
            for node in owner.of("ExternalInterface"):
                known.setdefault(node.name, node)
        return known


def _is_id(text: str) -> bool:
    return len(text) >= 32 and " " not in text
