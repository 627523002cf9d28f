"""Validates sources against XML Schemas of the user.

The schemas of one folder are compiled; files outside the folder are never opened.
"""

import re
from collections.abc import Iterable, Iterator
from io import BytesIO
from pathlib import Path
from typing import cast

from lxml import etree
from msgspec import Struct

from sysmlc.sources.files import Roots, read_whole
from sysmlc.sources.source import DOCUMENT_LIMITS, Source, SourceError
from sysmlc.support.escapes import escape_undecodable

_XS = "{http://www.w3.org/2001/XMLSchema}"
_REFERENCES = frozenset({f"{_XS}{tag}" for tag in ("include", "import", "redefine", "override")})
_VERSION = "SchemaVersion"


class SchemaError(Exception):
    """The folder, or a schema in it, cannot be used; the message gives the reason."""


class Violation(Struct, frozen=True):
    """A violation of a schema.

    ``ordinal`` is the position of the element in document order, ``element`` its qualified name.
    """

    ordinal: int
    element: str
    problem: str


class Schema(Struct, frozen=True):
    """A compiled schema.

    ``roots`` are the elements with which a document may start, ``versions`` the values that the
    schema fixes for the attribute ``SchemaVersion``; without such a value it is for any version.
    """

    name: str
    namespace: str
    roots: frozenset[str]
    versions: frozenset[str]
    compiled: etree.XMLSchema


class Schemas(Struct, frozen=True):
    """The schemas of one folder, sorted by name."""

    folder: Path
    schemas: tuple[Schema, ...]

    def find_violations(self, source: Source) -> tuple[Schema | None, list[Violation]]:
        """Return the schema that fits a source, or None, and the violations of that schema.

        Raises ValueError for XML that is damaged or refused; the front end reports the reason.
        """
        if b"<" not in source.data[:64]:
            return None, []
        root = _parse_source(source)
        schema = self._select_schema(root)
        if schema is None or schema.compiled.validate(root):
            return schema, []
        return schema, list(_iter_violations(root, schema))

    def _select_schema(self, root: etree._Element) -> Schema | None:
        """Return the schema for namespace, root element and, if several fit, version."""
        name = etree.QName(root)
        version = root.get(_VERSION, "")
        candidates = [
            schema
            for schema in self.schemas
            if schema.namespace == (name.namespace or "") and name.localname in schema.roots
        ]
        return min(candidates, key=lambda s: (_rank_version(s, version), s.name), default=None)


def _rank_version(schema: Schema, version: str) -> int:
    """Return a number that is lower for a schema that fits a version better.

    The best schema is one for this version, the next best one for any version.
    """
    if version in schema.versions:
        return 0
    return 2 if schema.versions else 1


# -- loading -----------------------------------------------------------------------------------

_Tree = etree._ElementTree


def load_schemas(folder: Path) -> Schemas:
    """Compile the schemas in a folder and below it that no other schema includes.

    Raises SchemaError.
    """
    if not folder.is_dir():
        raise SchemaError(f"there is no folder '{folder}' for schemas")
    files = sorted(path for path in folder.rglob("*.xsd") if Roots((folder,)).allows(path))
    if not files:
        raise SchemaError(f"there is no schema (*.xsd) in '{folder}'")
    closures = {path: _parse_closure(path, folder) for path in files}
    included = {
        other.resolve() for path, closure in closures.items() for other in closure if other != path
    }
    tops = [path for path in files if path.resolve() not in included]
    # Schemas that include one another in a cycle have no top.
    return Schemas(folder, tuple(_compile(path, folder, closures[path]) for path in tops or files))


def _parse_closure(top: Path, folder: Path) -> dict[Path, _Tree]:
    """Parse a schema and all that it includes or imports, directly or indirectly.

    Raises SchemaError for a reference that leads out of *folder*.
    """
    trees: dict[Path, _Tree] = {}
    worklist = [top]
    while worklist:
        path = worklist.pop()
        if path in trees:
            continue
        trees[path] = tree = _parse_schema(path, folder)
        for node in tree.getroot():
            location = node.get("schemaLocation")
            if node.tag in _REFERENCES and location is not None:
                target = Roots((folder,)).resolve(path, location)
                if target is None:
                    raise SchemaError(
                        f"the schema '{_relative_name(path, folder)}' asks for '{location}', "
                        f"which is not inside '{folder}'"
                    )
                worklist.append(target)
    return trees


def _parse_schema(path: Path, folder: Path) -> _Tree:
    name = _relative_name(path, folder)
    parser = etree.XMLParser(resolve_entities=False, no_network=True, load_dtd=False)
    try:
        data = read_whole(path, name, DOCUMENT_LIMITS)
        tree = etree.parse(BytesIO(data), parser, base_url=str(path))
    except (etree.XMLSyntaxError, SourceError) as problem:
        raise SchemaError(f"the schema '{name}' cannot be read: {problem}") from problem
    if _has_doctype(tree):
        raise SchemaError(f"the schema '{name}' has a DOCTYPE, which is refused")
    if tree.getroot().tag != f"{_XS}schema":
        raise SchemaError(f"'{name}' is not an XML Schema: its root is {tree.getroot().tag!r}")
    return tree


def _relative_name(path: Path, folder: Path) -> str:
    return str(path.relative_to(folder)) if path.is_relative_to(folder) else path.name


def _has_doctype(tree: _Tree) -> bool:
    info = tree.docinfo
    return info is not None and info.internalDTD is not None


def _compile(path: Path, folder: Path, closure: dict[Path, _Tree]) -> Schema:
    name = escape_undecodable(path.relative_to(folder).as_posix())
    try:
        compiled = etree.XMLSchema(closure[path])
    except etree.XMLSchemaParseError as problem:
        raise SchemaError(f"the schema '{name}' is broken: {problem}") from problem
    namespace = closure[path].getroot().get("targetNamespace", "")
    schema_nodes = [
        tree.getroot()
        for tree in closure.values()
        if tree.getroot().get("targetNamespace", namespace) == namespace
    ]
    elements = (node for schema in schema_nodes for node in schema.iterchildren(f"{_XS}element"))
    attributes = (node for schema in schema_nodes for node in schema.iter(f"{_XS}attribute"))
    roots = frozenset(str(element.get("name")) for element in elements)
    versions = {node.get("fixed", "") for node in attributes if node.get("name") == _VERSION}
    return Schema(name, namespace, roots, frozenset(versions - {""}), compiled)


# -- validation --------------------------------------------------------------------------------


def _parse_source(source: Source) -> etree._Element:
    parser = etree.XMLParser(
        resolve_entities=False, no_network=True, load_dtd=False, huge_tree=True
    )
    try:
        root = etree.fromstring(source.data, parser)
    except etree.XMLSyntaxError as problem:
        raise ValueError(str(problem)) from problem
    if _has_doctype(root.getroottree()):
        raise ValueError("it has a DOCTYPE")
    return root


def _iter_violations(root: etree._Element, schema: Schema) -> Iterator[Violation]:
    tree = root.getroottree()
    # lxml creates a proxy for each access to an element: as keys, the proxies stay alive, so that
    # _find_element returns the same ones.
    ordinals = {element: number for number, element in enumerate(root.iter(etree.Element))}
    for entry in cast("Iterable[etree._LogEntry]", schema.compiled.error_log):
        element = _find_element(tree, entry.path)
        if element is None:
            element = root
        problem = _translate_message(entry.message)
        yield Violation(ordinals.get(element, 0), _qualify_name(element), problem)


def _find_element(tree: _Tree, path: str | None) -> "etree._Element | None":
    nodes = tree.xpath(path) if path else None
    node = nodes[0] if isinstance(nodes, list) and nodes else None
    return node if isinstance(node, etree._Element) else None


def _qualify_name(element: etree._Element) -> str:
    """Return the names of *element* and its ancestors, joined by ``::``, without the root."""
    names = [_name_element(ancestor) for ancestor in (element, *element.iterancestors())]
    return "::".join(reversed(names[:-1] or names))


def _name_element(element: etree._Element) -> str:
    name = element.get("Name") or element.get("name") or element.get("Alias")
    return name or etree.QName(element).localname


_ELEMENT = r"Element '(?P<element>[^']*)'"
_ATTRIBUTE = rf"{_ELEMENT}, attribute '(?P<attribute>[^']*)'"
_EXPECTED = r"Expected is (?P<expected>.*?)\.?$"
_INVALID = (
    r"'(?P<value>.*)' is not a valid value of the (?:\w+ )?(?:atomic )?type '(?P<type>[^']*)'\.?$"
)
_TRANSLATIONS = (
    (
        rf"{_ELEMENT}: This element is not expected\. {_EXPECTED}",
        "unexpected element '{element}'; expected {expected}",
    ),
    (rf"{_ELEMENT}: This element is not expected\.?$", "unexpected element '{element}'"),
    (rf"{_ELEMENT}: Missing child element\(s\)\. {_EXPECTED}", "'{element}' lacks {expected}"),
    (
        rf"{_ELEMENT}: The attribute '(?P<attribute>[^']*)' is required but missing\.?$",
        "'{element}' has no attribute '{attribute}'",
    ),
    (
        rf"{_ATTRIBUTE}: The attribute '[^']*' is not allowed\.?$",
        "'{element}' must not have the attribute '{attribute}'",
    ),
    (
        rf"{_ATTRIBUTE}: {_INVALID}",
        "the attribute '{attribute}' of '{element}' is '{value}', which is not a valid {type}",
    ),
    (
        rf"{_ELEMENT}: {_INVALID}",
        "the text of '{element}' is '{value}', which is not a valid {type}",
    ),
    (
        rf"{_ATTRIBUTE}: The value '(?P<value>.*)' does not match the fixed value constraint "
        r"'(?P<fixed>[^']*)'\.?$",
        "the attribute '{attribute}' of '{element}' is '{value}', and must be '{fixed}'",
    ),
    (rf"{_ELEMENT}: Character content .*$", "'{element}' must not hold text"),
)
"""Messages of libxml2 2.9 to 2.14 as patterns, and the messages for users."""
_CHOICE = re.compile(r"^(?:one of )?\( (.*) \)$")
"""Elements that libxml2 expects: ``( a )`` or ``one of ( a, b )``."""


def _translate_message(message: str) -> str:
    plain = re.sub(r"\{[^}]*\}", "", message)
    for pattern, translation in _TRANSLATIONS:
        match = re.match(pattern, plain, re.DOTALL)
        if match:
            facts = match.groupdict()
            if "expected" in facts:
                facts["expected"] = _format_choice(facts["expected"])
            return translation.format(**facts)
    return plain.rstrip(".")


def _format_choice(text: str) -> str:
    """Return ``'a' or 'b'`` for ``one of ( a, b )``."""
    match = _CHOICE.match(text)
    names = [name.strip() for name in (match[1] if match else text).split(",")]
    quoted = [f"'{name}'" for name in names]
    return quoted[0] if len(quoted) == 1 else f"{', '.join(quoted[:-1])} or {quoted[-1]}"
