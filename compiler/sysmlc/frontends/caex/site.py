"""One internal element, or the class at the top of some, and where it stands."""

from sysmlc.frontends.caex.document import Document, Node
from sysmlc.frontends.caex.types import Type
from sysmlc.ir import AttrValue


class Site:
    """One internal element, or the class at the top of some, and where it stands.

    ``declared`` is the class that it refers to; ``own`` the class made for what that one has
    not (for a class at the top: itself). ``part`` is the property that stands for it in the
    class above, ``instance`` the Instance that holds its values (empty while there are none).
    ``ppr`` is product, process, resource or empty.
    """

    __slots__ = (
        "declared",
        "document",
        "instance",
        "interface_ids",
        "is_known",
        "is_mirror",
        "node",
        "own",
        "parent",
        "part",
        "ppr",
        "root",
    )

    def __init__(self, node: Node, document: Document, parent: "Site | None") -> None:
        self.node = node
        self.document = document
        self.parent = parent
        self.root: Site = self if parent is None else parent.root
        self.declared: Type | None = None
        self.own: Type | None = None
        self.part = ""
        self.instance = ""
        self.ppr = ""
        self.is_known = False
        self.is_mirror = False
        self.interface_ids: list[tuple[AttrValue, ...]] = []

    @property
    def type(self) -> Type | None:
        """What types it."""
        return self.own or self.declared

    def parts_below(self, top: "Site") -> list[str]:
        """Ids of the parts that lead from ``top`` down to it."""
        found = []
        site: Site | None = self
        while site is not None and site is not top:
            found.append(site.part)
            site = site.parent
        return found[::-1]
