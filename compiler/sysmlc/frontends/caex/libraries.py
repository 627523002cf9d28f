"""Libraries and their classes: packages, blocks, interface blocks and value types."""

import posixpath
from collections.abc import Iterator
from urllib.parse import unquote

from sysmlc.diagnostics import Verdict
from sysmlc.frontends.caex import repeats, rules
from sysmlc.frontends.caex.context import Context
from sysmlc.frontends.caex.document import Document, Node
from sysmlc.frontends.caex.types import Type
from sysmlc.frontends.caex.vocabulary import CLASS_TAGS, LIBRARIES, ROLES, STANDARD, Family
from sysmlc.ir import Edge, Kind


def lower(context: Context, document: Document) -> list[Type]:
    """Add the libraries of a file with their classes, nested ones below the class around them."""
    return [
        type for node in document.root.of(*LIBRARIES) for type in library(context, document, node)
    ]


def library(context: Context, document: Document, node: Node) -> Iterator[Type]:
    """Add one library; its classes in document order."""
    family, class_tag, subkind = LIBRARIES[node.tag]
    context.add(
        Kind.PACKAGE,
        node,
        document,
        None,
        subkind=subkind,
        version=node.text("Version"),
    )
    waiting = [(child, node) for child in reversed(node.children) if child.tag == class_tag]
    while waiting:
        child, above = waiting.pop()
        yield _class(context, document, child, above, family)
        waiting += [(c, child) for c in reversed(child.children) if CLASS_TAGS.get(c.tag) is family]


def _class(context: Context, document: Document, node: Node, above: Node, family: Family) -> Type:
    is_role = family is Family.ROLE
    kind = Kind.DATA_TYPE if family is Family.ATTRIBUTE else Kind.CLASS
    element = context.add(
        kind,
        node,
        document,
        above.element,
        role=ROLES[family],
        subkind="role-class" if is_role else None,
        abstract=True if is_role else None,
    )
    type = Type(element.id, document, node.row, family, (*_path(above), node.name))
    context.types.add(type)
    return type


def _path(node: Node) -> tuple[str, ...]:
    names = [part.name for part in (node, *node.above()) if part.tag != "CAEXFile"]
    return tuple(reversed(names))


def specialise(context: Context, types: list[Type]) -> None:
    """Tie every class to what it specialises; a circle is reported and cut."""
    for type in types:
        found = context.types.base(type)
        if isinstance(found, str):
            found = context.type(found, type.family, type.document, type.node)
        type.base = found
    acyclic: set[Type] = set()
    for type in types:
        _cut_cycle(context, type, acyclic)
        if type.base is not None:
            context.graph.connect(Edge.SPECIALIZES, type.id, type.base.id)


def _cut_cycle(context: Context, start: Type, acyclic: set[Type]) -> None:
    seen: dict[Type, None] = {}
    one: Type | None = start
    while one is not None and one not in seen and one not in acyclic:
        seen[one] = None
        one = one.base
    if one is start and start in seen:
        names = " -> ".join(t.node.name for t in (*seen, start))
        context.report(
            rules.CYCLE, start.document, start.node, element=start.node.name, cycle=names
        )
        start.base = None
    if one is None or one not in seen or one is start:
        acyclic.update(seen)


def in_order(types: list[Type]) -> Iterator[Type]:
    """The classes, each after the one that it specialises."""
    done: set[Type] = set()
    for type in types:
        for one in reversed(list(type.chain())):
            if one not in done:
                done.add(one)
                yield one


def set_apart(context: Context) -> None:
    """Mark the standard libraries that files hold as the built-in ones are: not of the plant."""
    graph = context.graph
    for document in context.documents:
        for node in document.root.of(*LIBRARIES):
            if node.name in STANDARD:
                for element in graph.subtree(graph[node.element]):
                    graph.set(element, external=True, library=True)


def in_order_of_parts(context: Context, types: list[Type]) -> list[Type]:
    """The classes, each after those that it specialises and those of its internal elements.

    Where classes hold each other the first one stands first.
    """
    done: dict[Type, None] = {}
    started: set[Type] = set()
    for type in types:
        waiting = [(type, False)]
        while waiting:
            one, is_left = waiting.pop()
            if is_left:
                done[one] = None
            elif one not in started:
                started.add(one)
                waiting.append((one, True))
                waiting += [(needed, False) for needed in _needed(context, one)]
    return [type for type in done if not type.document.is_built_in]


def _needed(context: Context, type: Type) -> Iterator[Type]:
    if type.base is not None:
        yield type.base
    inside = list(type.node.of("InternalElement"))
    for node in inside:
        inside += node.of("InternalElement")
        path = node.attributes.get("RefBaseSystemUnitPath", "").strip()
        found = context.types.find(path, Family.SYSTEM_UNIT, type.document) if path else None
        if isinstance(found, Type):
            yield found


def header(context: Context, document: Document) -> None:
    """The file itself, and the files that it refers to by alias."""
    root = document.root
    element = context.add(
        Kind.DOCUMENT,
        root,
        document,
        None,
        id=f"{document.name}#",
        subkind="caex",
        version=document.version,
        description=root.text("Description"),
        superior_standard=root.text("SuperiorStandardVersion"),
    )
    context.graph.rename(element, root.attributes.get("FileName", "") or document.name)
    if not any(True for _ in root.of(*LIBRARIES, "InstanceHierarchy")):
        context.report(rules.NO_MODEL, document, root, file=document.name)
    for node in root.of("ExternalReference"):
        _alias(context, document, node)
    for node in root.of("SuperiorStandardVersion", "Description"):
        node.verdict = Verdict.MAPPED


def report_missing_plant(context: Context) -> None:
    """Report the first file of a unit that has libraries but no instance hierarchy."""
    roots = [document.root for document in context.documents]
    if any(True for root in roots for _ in root.of("InstanceHierarchy")):
        return
    for document in context.documents:
        if any(True for _ in document.root.of(*LIBRARIES)):
            context.report(rules.ONLY_LIBRARIES, document, document.root, file=document.name)
            return


def _alias(context: Context, document: Document, node: Node) -> None:
    alias, path = node.attributes.get("Alias", ""), node.attributes.get("Path", "")
    repeats.declare(context, document, node, _file(document.name, path))
    element = context.add(
        Kind.IMPORT,
        node,
        document,
        None,
        id=context.free(f"{document.name}#{alias}", node),
        subkind="alias",
        path=path,
    )
    context.graph.rename(element, alias)


def tie_aliases(context: Context) -> None:
    """Let each alias lead to the file that it means, where that is part of the unit."""
    for document in context.documents:
        for node in document.root.of("ExternalReference"):
            target = f"{_file(document.name, node.attributes.get('Path', ''))}#"
            if target in context.graph:
                context.graph.connect(Edge.REFERENCES, node.element, target)


def _file(name: str, path: str) -> str:
    """Name in the unit of the file that a path means, seen from another file."""
    archive, _, entry = name.rpartition("!")
    plain = unquote(path.partition("#")[0])
    if archive:
        start = "" if plain.startswith("/") else posixpath.dirname(entry)
        return f"{archive}!{posixpath.normpath(posixpath.join(start, plain.lstrip('/')))}"
    return posixpath.normpath(posixpath.join(posixpath.dirname(name), plain))


def mark(node: Node, verdict: Verdict = Verdict.MAPPED) -> None:
    """Give the node and all below it one verdict."""
    for one in node.walk():
        one.verdict = verdict
