"""XML Schemas of the user: loaded from one folder and nowhere else, and what violates them."""

import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import cast

from lxml import etree
from msgspec import Struct

from sysmlc.sources.roots import Roots
from sysmlc.sources.source import Source
from sysmlc.support.escapes import escape_undecodable

_XS = "{http://www.w3.org/2001/XMLSchema}"
_LOADING = frozenset({f"{_XS}{tag}" for tag in ("include", "import", "redefine", "override")})
_VERSION = "SchemaVersion"


class SchemaError(Exception):
    """The folder, or a schema in it, cannot be used; the message says why."""


class Violation(Struct, frozen=True):
    """One fault: the ordinal of the element, names down to it, what is wrong."""

    ordinal: int
    element: str
    problem: str


class Schema(Struct, frozen=True):
    """A compiled schema: namespace, root elements, and versions that its files may state."""

    name: str
    namespace: str
    roots: frozenset[str]
    versions: frozenset[str]
    compiled: etree.XMLSchema


class Schemas(Struct, frozen=True):
    """The schemas of one folder, sorted by name."""

    folder: Path
    schemas: tuple[Schema, ...]

    def violations(self, source: Source) -> tuple[Schema | None, list[Violation]]:
        """The schema of a source, None when there is none for it, and what violates it.

        Raises ValueError for XML that is damaged or refused: reading it tells why.
        """
        root = _root(source) if _is_markup(source) else None
        schema = None if root is None else self._schema(root)
        if root is None or schema is None or schema.compiled.validate(root):
            return schema, []
        return schema, list(_violations(root, schema))

    def _schema(self, root: etree._Element) -> Schema | None:
        """The one for the namespace and the element; of several the one of its version."""
        name = etree.QName(root)
        version = root.get(_VERSION, "")
        fitting = [
            one
            for one in self.schemas
            if one.namespace == (name.namespace or "") and name.localname in one.roots
        ]
        ranked = sorted(fitting, key=lambda one: (_rank(one.versions, version), one.name))
        return ranked[0] if ranked else None


def _rank(versions: frozenset[str], version: str) -> int:
    return 0 if version in versions else 2 if versions else 1


# -- loading -----------------------------------------------------------------------------------


def load_schemas(folder: Path) -> Schemas:
    """The schemas in a folder and below it. Raises SchemaError."""
    if not folder.is_dir():
        raise SchemaError(f"there is no folder '{folder}' for schemas")
    files = sorted(path for path in folder.rglob("*.xsd") if Roots((folder,)).allows(path))
    if not files:
        raise SchemaError(f"there is no schema (*.xsd) in '{folder}'")
    closures = {path: _closure(path, folder) for path in files}
    loaded = {other for path, closure in closures.items() for other in closure if other != path}
    tops = [path for path in files if path.resolve() not in {one.resolve() for one in loaded}]
    return Schemas(folder, tuple(_compile(path, folder, closures[path]) for path in tops or files))


def _tree(path: Path, folder: Path) -> etree._ElementTree:
    name = path.relative_to(folder) if path.is_relative_to(folder) else path.name
    parser = etree.XMLParser(resolve_entities=False, no_network=True, load_dtd=False)
    try:
        tree = etree.parse(str(path), parser)
    except (etree.XMLSyntaxError, OSError) as problem:
        raise SchemaError(f"the schema '{name}' cannot be read: {problem}") from problem
    if _has_doctype(tree):
        raise SchemaError(f"the schema '{name}' has a DOCTYPE, which is refused")
    if tree.getroot().tag != f"{_XS}schema":
        raise SchemaError(f"'{name}' is not an XML Schema: its root is {tree.getroot().tag!r}")
    return tree


def _has_doctype(tree: etree._ElementTree) -> bool:
    info = tree.docinfo
    return info is not None and info.internalDTD is not None


def _closure(top: Path, folder: Path) -> dict[Path, etree._ElementTree]:
    """A schema with all that it includes or imports; nothing outside of the folder is opened."""
    found: dict[Path, etree._ElementTree] = {}
    waiting = [top]
    while waiting:
        path = waiting.pop()
        if path in found:
            continue
        found[path] = tree = _tree(path, folder)
        for one in tree.getroot():
            place = one.get("schemaLocation")
            if one.tag in _LOADING and place is not None:
                target = Roots((folder,)).resolve(path, place)
                if target is None:
                    name = path.relative_to(folder) if path.is_relative_to(folder) else path.name
                    raise SchemaError(
                        f"the schema '{name}' asks for '{place}', which is not inside '{folder}'"
                    )
                waiting.append(target)
    return found


def _compile(path: Path, folder: Path, closure: dict[Path, etree._ElementTree]) -> Schema:
    name = escape_undecodable(path.relative_to(folder).as_posix())
    try:
        compiled = etree.XMLSchema(closure[path])
    except etree.XMLSchemaParseError as problem:
        raise SchemaError(f"the schema '{name}' is broken: {problem}") from problem
    namespace = closure[path].getroot().get("targetNamespace", "")
    own_roots = [
        tree.getroot()
        for tree in closure.values()
        if tree.getroot().get("targetNamespace", namespace) == namespace
    ]
    roots = {
        str(one.get("name")) for root in own_roots for one in root.iterchildren(f"{_XS}element")
    }
    attributes = (one for root in own_roots for one in root.iter(f"{_XS}attribute"))
    versions = {one.get("fixed", "") for one in attributes if one.get("name") == _VERSION}
    return Schema(name, namespace, frozenset(roots), frozenset(versions - {""}), compiled)


# -- validating --------------------------------------------------------------------------------


def _is_markup(source: Source) -> bool:
    return b"<" in source.data[:64]


def _root(source: Source) -> etree._Element:
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


def _violations(root: etree._Element, schema: Schema) -> Iterator[Violation]:
    tree = root.getroottree()
    # The proxies must live as long as they are keys.
    ordinals = {one: number for number, one in enumerate(root.iter(etree.Element))}
    for entry in cast("Iterable[etree._LogEntry]", schema.compiled.error_log):
        found = _at(tree, entry.path)
        element = root if found is None else found
        problem = _in_words(entry.message)
        yield Violation(ordinals.get(element, 0), _name(element), problem)


def _at(tree: etree._ElementTree, path: str | None) -> "etree._Element | None":
    found = tree.xpath(path) if path else None
    first = found[0] if isinstance(found, list) and found else None
    return first if isinstance(first, etree._Element) else None


def _name(element: etree._Element) -> str:
    names = [_own_name(one) for one in (element, *element.iterancestors())]
    return "::".join(reversed(names[:-1] or names))


def _own_name(element: etree._Element) -> str:
    given = element.get("Name") or element.get("name") or element.get("Alias")
    return given or etree.QName(element).localname


_WORDS = (
    (
        r"Element '(?P<a>[^']*)': This element is not expected\. Expected is (?P<b>.*?)\.?$",
        "'{a}' stands where {b} should",
    ),
    (r"Element '(?P<a>[^']*)': This element is not expected\.?$", "'{a}' must not stand here"),
    (
        r"Element '(?P<a>[^']*)': Missing child element\(s\)\. Expected is (?P<b>.*?)\.?$",
        "'{a}' lacks {b}",
    ),
    (
        r"Element '(?P<a>[^']*)': The attribute '(?P<b>[^']*)' is required but missing\.?$",
        "'{a}' has no attribute '{b}'",
    ),
    (
        r"Element '(?P<a>[^']*)', attribute '(?P<b>[^']*)': "
        r"The attribute '[^']*' is not allowed\.?$",
        "'{a}' must not have the attribute '{b}'",
    ),
    (
        r"Element '(?P<a>[^']*)', attribute '(?P<b>[^']*)': '(?P<c>.*)' is not a valid value "
        r"of the (?:\w+ )?(?:atomic )?type '(?P<d>[^']*)'\.?$",
        "the attribute '{b}' of '{a}' is '{c}', which is not a valid {d}",
    ),
    (
        r"Element '(?P<a>[^']*)': '(?P<c>.*)' is not a valid value "
        r"of the (?:\w+ )?(?:atomic )?type '(?P<d>[^']*)'\.?$",
        "the text of '{a}' is '{c}', which is not a valid {d}",
    ),
    (
        r"Element '(?P<a>[^']*)', attribute '(?P<b>[^']*)': The value '(?P<c>.*)' does not match "
        r"the fixed value constraint '(?P<d>[^']*)'\.?$",
        "the attribute '{b}' of '{a}' is '{c}', and must be '{d}'",
    ),
    (r"Element '(?P<a>[^']*)': Character content .*$", "'{a}' must not hold text"),
)
"""Messages of libxml2 2.9 to 2.14, and what they mean for who has the file."""
_CHOICE = re.compile(r"^(?:one of )?\( (.*) \)$")


def _in_words(message: str) -> str:
    plain = re.sub(r"\{[^}]*\}", "", message)
    for pattern, words in _WORDS:
        found = re.match(pattern, plain, re.DOTALL)
        if found:
            facts = found.groupdict()
            if "should" in words or "lacks" in words:
                facts["b"] = _choice(facts["b"])
            return words.format(**facts)
    return plain.rstrip(".")


def _choice(text: str) -> str:
    found = _CHOICE.match(text)
    names = [name.strip() for name in (found[1] if found else text).split(",")]
    quoted = [f"'{name}'" for name in names]
    return quoted[0] if len(quoted) == 1 else f"{', '.join(quoted[:-1])} or {quoted[-1]}"
