"""Trees as bytes: what was parsed before is not parsed again, nodes are made when asked for."""

import marshal
import sys
from contextlib import suppress
from functools import lru_cache
from pathlib import Path
from typing import Any

from sysmlc import __version__, resources
from sysmlc.cache import Cache
from sysmlc.diagnostics import Sink
from sysmlc.language.tree import Document, Node, Reference, Relation
from sysmlc.sources import Source

_Packed = tuple[Any, ...]
_SIZE = 12
_NEW = Node.__new__
_PACKAGES = frozenset({"Package", "LibraryPackage"})


class StoredNode(Node):
    """A node of a stored tree: members, relations and facts are made when they are asked for."""

    __slots__ = ("packed",)

    def __init__(self, packed: _Packed, owner: Node | None) -> None:
        (
            self.kind,
            self.name,
            self.short,
            self.membership,
            self.role,
            self.visibility,
            self.start,
            self.end,
            self.name_start,
        ) = packed[:9]
        self.owner = owner
        self.packed = packed

    def __getattr__(self, name: str) -> object:
        made: object
        if name == "members":
            packed = self.packed[9]
            within = marshal.loads(packed) if isinstance(packed, bytes) else packed
            made = [StoredNode(one, self) for one in within]
        elif name == "relations":
            made = [Relation(k, Reference(c, s, e)) for k, c, s, e in self.packed[10]]
        elif name == "facts":
            made = dict(self.packed[11])
        else:
            raise AttributeError(name)
        setattr(self, name, made)
        return made


def pack(root: Node) -> bytes | None:
    """The tree as bytes without its text; None for one that is too deep to be kept.

    Members of what is directly in a package are bytes of their own: of a library most are
    never asked for.
    """
    packed: dict[Node, _Packed] = {}
    try:
        for node in reversed(list(root.walk())):
            packed[node] = _packed(node, tuple([packed.pop(one) for one in node.members]))
        return marshal.dumps(packed[root])
    except ValueError:
        return None


def _packed(node: Node, members: tuple[_Packed, ...]) -> _Packed:
    is_apart = bool(members) and node.owner is not None and node.owner.kind in _PACKAGES
    return (
        node.kind,
        node.name,
        node.short,
        node.membership,
        node.role,
        node.visibility,
        node.start,
        node.end,
        node.name_start,
        marshal.dumps(members) if is_apart else members,
        tuple(
            [
                (r.kind, r.reference.chain, r.reference.start, r.reference.end)
                for r in node.relations
            ]
        ),
        tuple(node.facts.items()),
    )


def unpack(data: bytes) -> StoredNode | None:
    """The tree that ``pack`` made bytes of; None when it is damaged."""
    packed = _unpacked(data)
    return StoredNode(packed, None) if packed is not None else None


def _unpacked(data: bytes) -> _Packed | None:
    try:
        packed = marshal.loads(data)
    except (EOFError, TypeError, ValueError):
        return None
    return packed if isinstance(packed, tuple) and len(packed) == _SIZE else None


@lru_cache(maxsize=256)
def _kept(cache: Cache, key: str) -> _Packed:
    """An entry of the cache, which a process that stays asks for again and again.

    Raises KeyError for none, and for one that is damaged.
    """
    entry = cache.get(key)
    packed = _unpacked(entry) if entry else None
    if packed is None:
        raise KeyError(key)
    return packed


def _whole(root: StoredNode) -> Node:
    """A stored tree with all nodes made: less work than one by one where each is asked for."""
    made = Node(root.kind)
    waiting = [(made, root.packed)]
    for one, packed in waiting:
        (
            one.kind,
            one.name,
            one.short,
            one.membership,
            one.role,
            one.visibility,
            one.start,
            one.end,
            one.name_start,
            members,
            relations,
            facts,
        ) = packed
        one.facts = dict(facts)
        one.relations = (
            [Relation(k, Reference(c, s, e)) for k, c, s, e in relations] if relations else []
        )
        one.members = owned = []
        within = marshal.loads(members) if isinstance(members, bytes) else members
        for inner in within:
            member = _NEW(Node)
            member.owner = one
            owned.append(member)
            waiting.append((member, inner))
    return made


def read(
    source: Source,
    path: str,
    language: str,
    sink: Sink,
    cache: Cache | None,
    *,
    is_library: bool = True,
) -> Document:
    """The document of a textual file, from the cache when it was parsed without a finding.

    Of a library most elements are never asked for.
    """
    text = source.data.decode("utf-8-sig", "replace")
    key = f"{source.sha256}-{language}-{code()}" if cache else ""
    if cache:
        with suppress(KeyError):
            root = StoredNode(_kept(cache, key), None)
            return Document(path, language, root if is_library else _whole(root), text, source)
    from sysmlc.language.text import parse

    before = len(sink)
    document = parse(text, path, language, sink, source)
    if cache and len(sink) == before:
        packed = pack(document.root)
        if packed:
            cache.put(key, packed)
    return document


@lru_cache(maxsize=1)
def code() -> str:
    """What is kept of a text depends on beside it: Python, our version, the parser's code."""
    here = Path(__file__).parent
    files = [here / "tree.py", here / "stored.py", *sorted((here / "text").rglob("*.py"))]
    files += sorted(resources.path("grammars").glob("*.lark"))
    stats = [file.stat() for file in files]
    size, newest = sum(s.st_size for s in stats), max(s.st_mtime_ns for s in stats)
    return f"{sys.version_info.major}.{sys.version_info.minor}-{__version__}-{size:x}-{newest:x}"
