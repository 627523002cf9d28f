"""Classes of AutomationML as the unit knows them, and how a class path finds one."""

from collections.abc import Iterator
from typing import NamedTuple

from sysmlc.frontends.caex.document import Document, Node
from sysmlc.frontends.caex.paths import split
from sysmlc.frontends.caex.vocabulary import BASE, CLASS_TAGS, LIBRARIES, Family


class Member(NamedTuple):
    """A feature of a class: the id of its element, and its type when that is a class."""

    id: str
    type: "Type | None"
    node: Node


class Type:
    """A class of a library, or the own class of one InternalElement.

    ``members`` holds its own features by tag of CAEX and name; ``base`` is what it specialises.
    """

    __slots__ = ("base", "document", "family", "id", "members", "node", "path")

    def __init__(
        self, id: str, node: Node, document: Document, family: Family, path: tuple[str, ...] = ()
    ) -> None:
        self.id = id
        self.node = node
        self.document = document
        self.family = family
        self.path = path
        self.base: Type | None = None
        self.members: dict[tuple[str, str], Member] = {}

    def chain(self) -> Iterator["Type"]:
        """The class and those that it specialises, the nearest first."""
        one: Type | None = self
        while one is not None:
            yield one
            one = one.base

    def find(self, tag: str, name: str) -> Member | None:
        """The feature of this tag and name, own or inherited; the nearest one overrides."""
        key = (tag, name)
        one: Type | None = self
        while one is not None:
            found = one.members.get(key)
            if found is not None:
                return found
            one = one.base
        return None

    def conforms(self, *names: str) -> bool:
        """Whether it is, or specialises, a class with the path."""
        return any(one.path == names for one in self.chain())


class Missing(NamedTuple):
    """Why a path leads nowhere: what is missing (``alias``, ``file``, ``library``, ``class``)."""

    what: str
    name: str


class Types:
    """All classes of a unit by file, family and path."""

    def __init__(self, documents: list[Document], built_in: Document) -> None:
        self.built_in = built_in
        self._by_path: dict[tuple[str, Family, tuple[str, ...]], Type] = {}
        self._libraries: set[tuple[str, Family, str]] = set()
        self._documents = {document.name: document for document in documents}
        self._aliases: dict[tuple[str, str], str] = {}
        for document in (*documents, built_in):
            for library in document.root.of(*LIBRARIES):
                self._libraries.add((document.name, LIBRARIES[library.tag][0], library.name))

    def declare(self, document: Document, alias: str, file: str) -> None:
        """The file's alias means another file (which may not be there)."""
        self._aliases.setdefault((document.name, alias), file)

    def add(self, type: Type) -> None:
        """Know a class under its path; of two with the same path the first counts."""
        self._by_path.setdefault((type.document.name, type.family, type.path), type)

    def __iter__(self) -> Iterator[Type]:
        return iter(self._by_path.values())

    def find(self, text: str, family: Family, document: Document) -> Type | Missing:
        """The class that a path means in a file."""
        alias, names = split(text)
        file = document.name
        if alias:
            declared = self._aliases.get((document.name, alias))
            if declared is None:
                return Missing("alias", alias)
            if declared not in self._documents:
                return Missing("file", declared)
            file = declared
        found = self._by_path.get((file, family, names))
        if found is None and (file, family, names[0]) not in self._libraries:
            found = self._by_path.get((self.built_in.name, family, names))
            if found is None:
                return self._outside(family, names[0])
        return found or Missing("class", "/".join(names))

    def _outside(self, family: Family, library: str) -> Missing:
        is_known = (self.built_in.name, family, library) in self._libraries
        return Missing("class" if is_known else "library", library)

    def base(self, type: Type) -> "Type | Missing | None":
        """What the class specialises: a bare name means the class around it."""
        text = type.node.attributes.get(BASE[type.family], "").strip()
        if not text:
            return None
        above = type.node.parent
        if above is not None and above.tag in CLASS_TAGS and text == above.name:
            return self._by_path.get((type.document.name, type.family, type.path[:-1]))
        return self.find(text, type.family, type.document)
