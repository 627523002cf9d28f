"""Classes of a unit: their members, and the symbol table that resolves class paths."""

from collections.abc import Callable, Iterator, Mapping
from functools import lru_cache, partial
from typing import NamedTuple

from sysmlc.frontends.caex.document import Document, Node
from sysmlc.frontends.caex.vocabulary import BASE_REFERENCES, CLASS_TAGS, LIBRARIES, Family


class Member(NamedTuple):
    """A feature of a class: the id of its element, its type when that is a class, its row."""

    id: str
    type: "Type | None"
    document: Document
    row: int

    @property
    def node(self) -> Node:
        """The node that declares the feature."""
        return self.document.node(self.row)


make_member: Callable[[tuple[str, "Type | None", Document, int]], Member] = partial(
    tuple.__new__, Member
)
"""Makes a member of a tuple of its fields, in a third of the time of ``Member(...)``."""


class Type:
    """A class of a library, or the class made for a single feature or internal element.

    ``base`` is the class that it specialises. ``members`` holds its own features by tag and name.
    ``path`` is empty for a class that is not in a library.
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
        """The node that declares the class."""
        return self.document.node(self.row)

    def iter_chain(self) -> Iterator["Type"]:
        """Yield the class and the classes that it specialises, nearest first."""
        type: Type | None = self
        while type is not None:
            yield type
            type = type.base

    def find_member(self, tag: str, name: str) -> Member | None:
        """Return the feature of this tag and name, own or inherited; the nearest one overrides."""
        key = (tag, name)
        type: Type | None = self
        while type is not None:
            member = type.members.get(key)
            if member is not None:
                return member
            type = type.base
        return None

    def conforms_to(self, *path: str) -> bool:
        """Whether the class has the path, or specialises a class that has it."""
        return any(type.path == path for type in self.iter_chain())

    def specializes(self, general: "Type") -> bool:
        """Whether the class is *general*, or inherits from it."""
        return any(type is general for type in self.iter_chain())


def find_meaning(type: Type | None, meanings: Mapping[tuple[str, ...], str]) -> str:
    """Return the meaning of a class in a table by path, or the empty string.

    Classes of plants have the meaning of the standard class that they specialise: inheritance
    decides, never the name alone.
    """
    if type is not None:
        for general in type.iter_chain():
            if general.path in meanings:
                return meanings[general.path]
    return ""


# -- class paths -----------------------------------------------------------------------------------


class ClassPath(NamedTuple):
    """A class path: the alias of another file or nothing, and the names from the library down."""

    alias: str
    names: tuple[str, ...]


@lru_cache(65536)
def split_path(text: str) -> ClassPath:
    """Split a class path such as ``Alias@Lib/Class/Nested``.

    A name that contains a separator is written in brackets. AML.Engine brackets every name of a
    path when one needs it, so names with and without brackets are equal.
    """
    if "[" not in text:
        alias, separator, rest = text.partition("@")
        if separator:
            return ClassPath(alias, tuple(rest.split("/")))
        return ClassPath("", tuple(text.split("/")))
    names = _split_brackets(text)
    if text.startswith("["):
        return ClassPath("", tuple(names))
    alias, separator, first = names[0].partition("@")
    return ClassPath(alias, (first, *names[1:])) if separator else ClassPath("", tuple(names))


def _split_brackets(text: str) -> list[str]:
    """Split a path at each ``/`` outside brackets, and drop the outer brackets."""
    names, name, depth = [], "", 0
    for character in text:
        depth += (character == "[") - (character == "]")
        is_outer_bracket = (character == "[" and depth == 1) or (character == "]" and depth == 0)
        if character == "/" and depth == 0:
            names.append(name)
            name = ""
        elif not is_outer_bracket:
            name += character
    return [*names, name]


# -- symbol table ----------------------------------------------------------------------------------


class MissingTarget(NamedTuple):
    """The reason why a path does not resolve: a missing alias, file, library or class."""

    kind: str
    """``alias``, ``file``, ``library`` or ``class``."""
    name: str


class TypeTable:
    """Symbol table: all classes of a unit by file, family and path."""

    def __init__(self, documents: list[Document]) -> None:
        self._by_path: dict[tuple[str, Family, tuple[str, ...]], Type] = {}
        self._libraries: set[tuple[str, Family, str]] = set()
        self._documents = {document.name for document in documents}
        self._aliases: dict[tuple[str, str], str] = {}
        self._standard_files: dict[tuple[Family, str], str] = {}
        for document in documents:
            for node in document.root.iter_children(*LIBRARIES):
                self._libraries.add((document.name, LIBRARIES[node.tag].family, node.name))

    def declare_alias(self, document: Document, alias: str, file: str) -> str:
        """Declare an alias of a file in *document*; return the file of its first declaration.

        The file need not be part of the unit.
        """
        return self._aliases.setdefault((document.name, alias), file)

    def add_standard_library(self, document: Document, family: Family, library: str) -> None:
        """Make a standard library visible in files that have no library of its name."""
        self._standard_files[family, library] = document.name

    def add(self, type: Type) -> None:
        """Add a class under its path; of two classes with one path the first counts."""
        key = (type.document.name, type.family, type.path)
        self._by_path.setdefault(key, type)

    def find(self, text: str, family: Family, document: Document) -> Type | MissingTarget:
        """Return the class that a path in a file means."""
        alias, names = split_path(text)
        file = self._find_file(document, alias)
        if isinstance(file, MissingTarget) and file.kind == "alias":
            return file
        if isinstance(file, MissingTarget) or (file, family, names[0]) not in self._libraries:
            return self._find_standard(family, names, file)
        return self._find_class(file, family, names)

    def _find_class(
        self, file: str, family: Family, names: tuple[str, ...]
    ) -> Type | MissingTarget:
        return self._by_path.get((file, family, names)) or MissingTarget("class", "/".join(names))

    def _find_file(self, document: Document, alias: str) -> str | MissingTarget:
        if not alias:
            return document.name
        file = self._aliases.get((document.name, alias))
        if file is None:
            return MissingTarget("alias", alias)
        return file if file in self._documents else MissingTarget("file", file)

    def _find_standard(
        self, family: Family, names: tuple[str, ...], file: str | MissingTarget
    ) -> Type | MissingTarget:
        standard_file = self._standard_files.get((family, names[0]))
        if standard_file is None:
            return file if isinstance(file, MissingTarget) else MissingTarget("library", names[0])
        return self._find_class(standard_file, family, names)

    def find_base(self, type: Type) -> "Type | str | None":
        """Return the class around *type* if it is named as its base, else the path of the base.

        Every library of the AutomationML Editor names the enclosing class by its bare name.
        """
        text = type.node.attributes.get(BASE_REFERENCES[type.family], "").strip()
        parent = type.node.parent
        if text and parent is not None and parent.tag in CLASS_TAGS and text == parent.name:
            return self._by_path.get((type.document.name, type.family, type.path[:-1]))
        return text or None
