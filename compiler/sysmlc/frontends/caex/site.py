"""One internal element, or the class at the top of some, and where it stands."""

from sysmlc.frontends.caex.document import Document, Node
from sysmlc.frontends.caex.types import Type
from sysmlc.frontends.caex.vocabulary import ROLE_REFERENCES
from sysmlc.ir import AttrValue, Element

NO_ROWS: list[int] = []
"""What stands for the rows of a site when they are lowered: a list of its own costs as much."""


NO_IDS: list[tuple[AttrValue, ...]] = []
"""What stands for the IDs of a site when they are kept."""


class Site:
    """One internal element, or the class at the top of some, and where it stands.

    ``declared`` is the class that it refers to; ``own`` the class made for what that one has
    not (for a class at the top: itself). ``part`` is the property that stands for it in the
    class above, ``instance`` the Instance that holds its values (empty while there are none).
    ``part_made`` and ``instance_made`` are the elements of these ids, where they were made for it.
    ``ppr`` is product, process, resource or empty. ``inner`` are the rows of the internal
    elements in it, which are released when they are lowered, and ``roles`` those that name a role.
    """

    __slots__ = (
        "_root",
        "declared",
        "document",
        "inner",
        "instance",
        "instance_made",
        "interface_ids",
        "is_known",
        "is_mirror",
        "name",
        "own",
        "parent",
        "part",
        "part_made",
        "ppr",
        "roles",
        "row",
    )

    def __init__(self, document: Document, row: int, parent: "Site | None") -> None:
        self.document = document
        self.row = row
        self.parent = parent
        self.name = document.attributes[row].get("Name", "")
        self._root: Site | None = None if parent is None else parent._root or parent
        self.declared: Type | None = None
        self.own: Type | None = None
        self.part = ""
        self.instance = ""
        self.part_made: Element | None = None
        self.instance_made: Element | None = None
        self.ppr = ""
        self.is_known = False
        self.is_mirror = False
        self.interface_ids: list[tuple[AttrValue, ...]] = []
        self._sort(document.tags, document.ends)

    def _sort(self, tags: list[str], ends: list[int]) -> None:
        """Collect the rows of the internal elements and roles directly below the site."""
        self.inner: list[int] = []
        self.roles: list[int] = []
        row, end = self.row + 1, ends[self.row]
        while row < end:
            if tags[row] == "InternalElement":
                self.inner.append(row)
            elif tags[row] in ROLE_REFERENCES:
                self.roles.append(row)
            row = ends[row]

    @property
    def node(self) -> Node:
        """What the file says of it."""
        return self.document.node(self.row)

    @property
    def root(self) -> "Site":
        """The element at the top of its hierarchy, or the class."""
        return self if self._root is None else self._root

    @property
    def type(self) -> Type | None:
        """What types it."""
        return self.own or self.declared

    def parts_below(self, top: "Site") -> list[str] | None:
        """Ids of the parts that lead from ``top`` down to it; None when it is not below."""
        found = []
        site: Site | None = self
        while site is not top:
            if site is None:
                return None
            found.append(site.part)
            site = site.parent
        return found[::-1]
