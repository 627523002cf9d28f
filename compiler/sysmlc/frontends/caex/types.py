"""Classes of AutomationML as the unit knows them, and how a class path finds one."""

from collections.abc import Callable, Iterator
from functools import partial
from typing import NamedTuple

from sysmlc.frontends.caex.document import Document, Node
from sysmlc.frontends.caex.paths import split
from sysmlc.frontends.caex.vocabulary import BASE, CLASS_TAGS, LIBRARIES, Family


class Member(NamedTuple):
    """A feature of a class: the id of its element, its type when that is a class, its place."""

    id: str
    type: "Type | None"
    document: Document
    row: int

    @property
    def node(self) -> Node:
        """What says it in the file."""
        return self.document.node(self.row)


member: Callable[[tuple[str, "Type | None", Document, int]], Member] = partial(
    tuple.__new__, Member
)
"""Makes a member of its parts, in a third of the time that a call of the class takes."""


class Type:
    """A class of a library, or the own class of one InternalElement.

    ``members`` holds its own features by tag of CAEX and name; ``base`` is what it specialises.
    """

    __slots__ = ("base", "document", "family", "id", "members", "path", "row")

    def __init__(
        self, id: str, document: Document, row: int, family: Family, path: tuple[str, ...] = ()
    ) -> None:
        self.id = id
        self.document = document
        self.row = row
        self.family = family
        self.path = path
        self.base: Type | None = None
        self.members: dict[tuple[str, str], Member] = {}

    @property
    def node(self) -> Node:
        """What says it in the file."""
        return self.document.node(self.row)

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

    def inherits(self, tag: str, name: str) -> bool:
        """Whether a class that it specialises has the feature."""
        return self.base is not None and self.base.find(tag, name) is not None

    def conforms(self, *names: str) -> bool:
        """Whether it is, or specialises, a class with the path."""
        return any(one.path == names for one in self.chain())


class Missing(NamedTuple):
    """Why a path leads nowhere: what is missing (``alias``, ``file``, ``library``, ``class``)."""

    what: str
    name: str


class Types:
    """All classes of a unit by file, family and path."""

    def __init__(self, documents: list[Document]) -> None:
        self._by_path: dict[tuple[str, Family, tuple[str, ...]], Type] = {}
        self._libraries: set[tuple[str, Family, str]] = set()
        self._documents = {document.name for document in documents}
        self._aliases: dict[tuple[str, str], str] = {}
        self._standard: dict[tuple[Family, str], str] = {}
        for document in documents:
            for node in document.root.of(*LIBRARIES):
                self._libraries.add((document.name, LIBRARIES[node.tag][0], node.name))

    def declare(self, document: Document, alias: str, file: str) -> str:
        """The file's alias means another file (which may not be there): the first one counts."""
        return self._aliases.setdefault((document.name, alias), file)

    def hold(self, document: Document, family: Family, library: str) -> None:
        """A standard library is provided; it is asked where a file has none of its name."""
        self._standard[family, library] = document.name

    def add(self, type: Type) -> None:
        """Know a class under its path; of two with the same path the first counts."""
        key = (type.document.name, type.family, type.path)
        self._by_path.setdefault(key, type)

    def find(self, text: str, family: Family, document: Document) -> Type | Missing:
        """The class that a path means in a file."""
        alias, names = split(text)
        file = self._file(document, alias)
        if isinstance(file, Missing) and file.what == "alias":
            return file
        if isinstance(file, Missing) or (file, family, names[0]) not in self._libraries:
            return self._in_standard(family, names, file)
        return self._by_path.get((file, family, names)) or Missing("class", "/".join(names))

    def _file(self, document: Document, alias: str) -> str | Missing:
        if not alias:
            return document.name
        declared = self._aliases.get((document.name, alias))
        if declared is None:
            return Missing("alias", alias)
        return declared if declared in self._documents else Missing("file", declared)

    def _in_standard(
        self, family: Family, names: tuple[str, ...], file: str | Missing
    ) -> Type | Missing:
        held = self._standard.get((family, names[0]))
        if held is None:
            return file if isinstance(file, Missing) else Missing("library", names[0])
        return self._by_path.get((held, family, names)) or Missing("class", "/".join(names))

    def base(self, type: Type) -> "Type | str | None":
        """What the class specialises: a class around it of that bare name, or a path."""
        text = type.node.attributes.get(BASE[type.family], "").strip()
        above = type.node.parent
        if text and above is not None and above.tag in CLASS_TAGS and text == above.name:
            return self._by_path.get((type.document.name, type.family, type.path[:-1]))
        return text or None
