"""Packages, imports, aliases, dependencies, annotations (KerML 8.2.3, SysML 8.2.2.3 to 8.2.2.5)."""

from sysmlc.language.text.build.names import Names, call
from sysmlc.language.text.build.owning import OWNING, made, own
from sysmlc.language.text.scan import Tokens, body_text
from sysmlc.language.tree import Node, Reference, Relation


def root(tokens: Tokens, members: list[Node]) -> Node:
    """The root namespace of a text."""
    node = Node("Namespace", start=0, end=len(tokens.text))
    own(node, members)
    if tokens.referential:
        _drop_redundant(tokens.referential)
    return node


def _drop_redundant(nodes: list[Node]) -> None:
    """The word `ref` says nothing about what is referential anyway (SysML 8.2.2.6.2, note 1)."""
    from sysmlc.language.composition import is_composite

    for node in nodes:
        node.facts.pop("isReference", None)
        if is_composite(node):
            node.facts["isReference"] = True


def _package(tokens: Tokens, at: int, begin: int, names: Names | None, body: list[Node]) -> Node:
    node = call(made("Package", OWNING, tokens, begin, at), names, tokens)
    return own(node, body)


def _annotation(
    kind: str,
    tokens: Tokens,
    at: int,
    begin: int,
    names: Names | None,
    locale: int | None,
    body: int,
) -> Node:
    node = call(made(kind, OWNING, tokens, begin, at), names, tokens)
    if locale is not None:
        node.facts["locale"] = _string(tokens, locale)
    node.facts["body"] = body_text(tokens[body])
    return node


def _string(tokens: Tokens, index: int) -> str:
    from sysmlc.language.text.scan import unquoted

    return unquoted(tokens[index])


def _about(node: Node, about: list[Reference] | None) -> Node:
    for reference in about or ():
        node.relations.append(Relation("Annotation", reference))
    return node


def _comment(
    tokens: Tokens,
    at: int,
    begin: int,
    names: Names | None,
    about: list[Reference] | None,
    locale: int | None,
    body: int,
) -> Node:
    return _about(_annotation("Comment", tokens, at, begin, names, locale, body), about)


def _located_comment(tokens: Tokens, at: int, begin: int, locale: int, body: int) -> Node:
    return _annotation("Comment", tokens, at, begin, None, locale, body)


def _bare_comment(tokens: Tokens, at: int, begin: int, body: int) -> Node:
    return _annotation("Comment", tokens, at, begin, None, None, body)


def _documentation(
    tokens: Tokens, at: int, begin: int, names: Names | None, locale: int | None, body: int
) -> Node:
    return _annotation("Documentation", tokens, at, begin, names, locale, body)


def _representation(
    tokens: Tokens, at: int, begin: int, names: Names | None, language: int, body: int
) -> Node:
    node = _annotation("TextualRepresentation", tokens, at, begin, names, None, body)
    node.facts["language"] = _string(tokens, language)
    return node


def _bare_representation(tokens: Tokens, at: int, begin: int, language: int, body: int) -> Node:
    return _representation(tokens, at, begin, None, language, body)


def metadata(
    tokens: Tokens,
    at: int,
    begin: int,
    names: Names | None,
    typing: Relation,
    about: list[Reference] | None,
    body: list[Node],
) -> Node:
    """A metadata usage that stands for itself (SysML 8.2.2.27)."""
    node = call(made("MetadataUsage", OWNING, tokens, begin, at), names, tokens)
    node.relations.append(typing)
    return own(_about(node, about), body)


def prefix_metadata(tokens: Tokens, at: int, begin: int, reference: Reference) -> Node:
    """Metadata before a member: ``#name``."""
    node = made("MetadataUsage", OWNING, tokens, begin, at)
    node.relations.append(Relation("FeatureTyping", reference))
    node.facts["isPrefix"] = True
    return node


def _named_dependency(
    tokens: Tokens,
    at: int,
    begin: int,
    names: Names | None,
    clients: list[Reference],
    suppliers: list[Reference],
    body: list[Node],
) -> Node:
    node = call(made("Dependency", OWNING, tokens, begin, at), names, tokens)
    node.relations += [Relation("client", end) for end in clients]
    node.relations += [Relation("supplier", end) for end in suppliers]
    return own(node, body)


def _dependency(
    tokens: Tokens,
    at: int,
    begin: int,
    clients: list[Reference],
    suppliers: list[Reference],
    body: list[Node],
) -> Node:
    return _named_dependency(tokens, at, begin, None, clients, suppliers, body)


def _alias(
    tokens: Tokens, at: int, begin: int, names: Names | None, reference: Reference, body: list[Node]
) -> Node:
    node = call(made("Membership", "", tokens, begin, at), names, tokens)
    node.relations.append(Relation("Membership", reference))
    return own(node, body)


def _imported(
    kind: str, recursive: bool, tokens: Tokens, at: int, begin: int, name: Reference
) -> Node:
    node = made(kind, "", tokens, begin, at)
    node.relations.append(Relation(f"imported{kind.removesuffix('Import')}", name))
    if recursive:
        node.facts["isRecursive"] = True
    return node


def _member(tokens: Tokens, at: int, begin: int, name: Reference) -> Node:
    return _imported("MembershipImport", False, tokens, at, begin, name)


def _member_recursive(tokens: Tokens, at: int, begin: int, name: Reference) -> Node:
    return _imported("MembershipImport", True, tokens, at, begin, name)


def _namespace(tokens: Tokens, at: int, begin: int, name: Reference) -> Node:
    return _imported("NamespaceImport", False, tokens, at, begin, name)


def _namespace_recursive(tokens: Tokens, at: int, begin: int, name: Reference) -> Node:
    return _imported("NamespaceImport", True, tokens, at, begin, name)


def _filtered(tokens: Tokens, at: int, begin: int, imported: Node, condition: Node) -> Node:
    condition.membership = "ElementFilterMembership"
    if imported.members:
        imported.members[0].own(condition)
        return imported
    imported.visibility = "public"
    outer = made("NamespaceImport", "", tokens, begin, at)
    package = outer.own(made("Package", "", tokens, begin, at))
    package.own(imported)
    package.own(condition)
    return outer


def _import(tokens: Tokens, at: int, begin: int, imported: Node, body: list[Node]) -> Node:
    tokens.special.append(imported)
    imported.start, imported.end = tokens.starts[begin], tokens.ends[at - 1]
    return own(imported, body)


def _import_all(tokens: Tokens, at: int, begin: int, imported: Node, body: list[Node]) -> Node:
    imported.facts["isImportAll"] = True
    return _import(tokens, at, begin, imported, body)


def _expose(tokens: Tokens, at: int, begin: int, imported: Node, body: list[Node]) -> Node:
    imported.kind = imported.kind.replace("Import", "Expose")
    return _import(tokens, at, begin, imported, body)


def _filter(tokens: Tokens, _at: int, _begin: int, condition: Node) -> Node:
    tokens.special.append(condition)
    condition.membership = "ElementFilterMembership"
    return condition


def visible(
    tokens: Tokens, _at: int, begin: int, visibility: int, item: Node | list[Node]
) -> Node | list[Node]:
    """Give the visibility to all of an item."""
    nodes = item if isinstance(item, list) else [item]
    for node in nodes:
        node.visibility = tokens[visibility]
    nodes[0].start = tokens.starts[begin]
    return item


ACTIONS = {
    "package": _package,
    "comment": _comment,
    "located_comment": _located_comment,
    "bare_comment": _bare_comment,
    "documentation": _documentation,
    "representation": _representation,
    "bare_representation": _bare_representation,
    "metadata": metadata,
    "prefix_metadata": prefix_metadata,
    "named_dependency": _named_dependency,
    "dependency": _dependency,
    "alias": _alias,
    "imported_member": _member,
    "imported_member_recursive": _member_recursive,
    "imported_namespace": _namespace,
    "imported_namespace_recursive": _namespace_recursive,
    "imported_filtered": _filtered,
    "import": _import,
    "import_all": _import_all,
    "expose": _expose,
    "filter": _filter,
    "visible": visible,
    "visible_result": visible,
}
