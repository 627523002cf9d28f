"""Packages, imports, aliases, dependencies, annotations (KerML 8.2.3, SysML 8.2.2.3 to 8.2.2.5)."""

from sysmlc.language.metaclasses import is_composite
from sysmlc.language.text.builders.declarations import Names, apply_names
from sysmlc.language.text.builders.nodes import OWNING, add_members, make_node
from sysmlc.language.text.lexer import Tokens, strip_comment, unquote
from sysmlc.language.tree import Node, Reference, Relation


def build_root(tokens: Tokens, members: list[Node]) -> Node:
    """Return the root namespace of a text."""
    node = Node("Namespace", start=0, end=len(tokens.text))
    add_members(node, members)
    if tokens.ref_usages:
        _drop_redundant_ref(tokens.ref_usages)
    return node


def _drop_redundant_ref(nodes: list[Node]) -> None:
    """Drop `ref` from usages that are referential anyway (SysML 8.2.2.6.2, note 1)."""
    for node in nodes:
        # `is_composite` looks at the attribute, so it answers for the usage without `ref`.
        node.attributes.pop("isReference", None)
        if is_composite(node):
            node.attributes["isReference"] = True


def _build_package(
    tokens: Tokens, stop: int, begin: int, names: Names | None, body: list[Node]
) -> Node:
    node = apply_names(make_node("Package", OWNING, tokens, begin, stop), names, tokens)
    return add_members(node, body)


def _make_annotation(
    kind: str,
    tokens: Tokens,
    stop: int,
    begin: int,
    names: Names | None,
    locale: int | None,
    body: int,
) -> Node:
    node = apply_names(make_node(kind, OWNING, tokens, begin, stop), names, tokens)
    if locale is not None:
        node.attributes["locale"] = _read_string(tokens, locale)
    node.attributes["body"] = strip_comment(tokens[body])
    return node


def _read_string(tokens: Tokens, index: int) -> str:
    return unquote(tokens[index])


def _add_annotated_elements(node: Node, about: list[Reference] | None) -> Node:
    for reference in about or ():
        node.relations.append(Relation("Annotation", reference))
    return node


def _build_comment(
    tokens: Tokens,
    stop: int,
    begin: int,
    names: Names | None,
    about: list[Reference] | None,
    locale: int | None,
    body: int,
) -> Node:
    return _add_annotated_elements(
        _make_annotation("Comment", tokens, stop, begin, names, locale, body), about
    )


def _build_located_comment(tokens: Tokens, stop: int, begin: int, locale: int, body: int) -> Node:
    return _make_annotation("Comment", tokens, stop, begin, None, locale, body)


def _build_bare_comment(tokens: Tokens, stop: int, begin: int, body: int) -> Node:
    return _make_annotation("Comment", tokens, stop, begin, None, None, body)


def _build_documentation(
    tokens: Tokens, stop: int, begin: int, names: Names | None, locale: int | None, body: int
) -> Node:
    return _make_annotation("Documentation", tokens, stop, begin, names, locale, body)


def _build_representation(
    tokens: Tokens, stop: int, begin: int, names: Names | None, language: int, body: int
) -> Node:
    node = _make_annotation("TextualRepresentation", tokens, stop, begin, names, None, body)
    node.attributes["language"] = _read_string(tokens, language)
    return node


def _build_bare_representation(
    tokens: Tokens, stop: int, begin: int, language: int, body: int
) -> Node:
    return _build_representation(tokens, stop, begin, None, language, body)


def build_metadata(
    tokens: Tokens,
    stop: int,
    begin: int,
    names: Names | None,
    typing: Relation,
    about: list[Reference] | None,
    body: list[Node],
) -> Node:
    """Build a metadata usage that is a separate member (SysML 8.2.2.27)."""
    node = apply_names(make_node("MetadataUsage", OWNING, tokens, begin, stop), names, tokens)
    node.relations.append(typing)
    return add_members(_add_annotated_elements(node, about), body)


def build_prefix_metadata(tokens: Tokens, stop: int, begin: int, reference: Reference) -> Node:
    """Build metadata before a member: ``#name``."""
    node = make_node("MetadataUsage", OWNING, tokens, begin, stop)
    node.relations.append(Relation("FeatureTyping", reference))
    node.attributes["isPrefix"] = True
    return node


def _build_named_dependency(
    tokens: Tokens,
    stop: int,
    begin: int,
    names: Names | None,
    clients: list[Reference],
    suppliers: list[Reference],
    body: list[Node],
) -> Node:
    node = apply_names(make_node("Dependency", OWNING, tokens, begin, stop), names, tokens)
    node.relations += [Relation("client", end) for end in clients]
    node.relations += [Relation("supplier", end) for end in suppliers]
    return add_members(node, body)


def _build_dependency(
    tokens: Tokens,
    stop: int,
    begin: int,
    clients: list[Reference],
    suppliers: list[Reference],
    body: list[Node],
) -> Node:
    return _build_named_dependency(tokens, stop, begin, None, clients, suppliers, body)


def _build_alias(
    tokens: Tokens,
    stop: int,
    begin: int,
    names: Names | None,
    reference: Reference,
    body: list[Node],
) -> Node:
    node = apply_names(make_node("Membership", "", tokens, begin, stop), names, tokens)
    node.relations.append(Relation("Membership", reference))
    return add_members(node, body)


def _make_import(
    kind: str, recursive: bool, tokens: Tokens, stop: int, begin: int, name: Reference
) -> Node:
    node = make_node(kind, "", tokens, begin, stop)
    node.relations.append(Relation(f"imported{kind.removesuffix('Import')}", name))
    if recursive:
        node.attributes["isRecursive"] = True
    return node


def _build_member_import(tokens: Tokens, stop: int, begin: int, name: Reference) -> Node:
    return _make_import("MembershipImport", False, tokens, stop, begin, name)


def _build_recursive_member_import(tokens: Tokens, stop: int, begin: int, name: Reference) -> Node:
    return _make_import("MembershipImport", True, tokens, stop, begin, name)


def _build_namespace_import(tokens: Tokens, stop: int, begin: int, name: Reference) -> Node:
    return _make_import("NamespaceImport", False, tokens, stop, begin, name)


def _build_recursive_namespace_import(
    tokens: Tokens, stop: int, begin: int, name: Reference
) -> Node:
    return _make_import("NamespaceImport", True, tokens, stop, begin, name)


def _build_filtered_import(
    tokens: Tokens, stop: int, begin: int, imported: Node, condition: Node
) -> Node:
    condition.membership = "ElementFilterMembership"
    # A second filter belongs to the same filter package.
    if imported.members:
        imported.members[0].add_member(condition)
        return imported
    imported.visibility = "public"
    outer_import = make_node("NamespaceImport", "", tokens, begin, stop)
    package = outer_import.add_member(make_node("Package", "", tokens, begin, stop))
    package.add_member(imported)
    package.add_member(condition)
    return outer_import


def _build_import(tokens: Tokens, stop: int, begin: int, imported: Node, body: list[Node]) -> Node:
    tokens.restricted_nodes.append(imported)
    imported.start, imported.end = tokens.starts[begin], tokens.ends[stop - 1]
    return add_members(imported, body)


def _build_import_all(
    tokens: Tokens, stop: int, begin: int, imported: Node, body: list[Node]
) -> Node:
    imported.attributes["isImportAll"] = True
    return _build_import(tokens, stop, begin, imported, body)


def _build_expose(tokens: Tokens, stop: int, begin: int, imported: Node, body: list[Node]) -> Node:
    imported.kind = imported.kind.replace("Import", "Expose")
    return _build_import(tokens, stop, begin, imported, body)


def _build_filter(tokens: Tokens, _stop: int, _begin: int, condition: Node) -> Node:
    tokens.restricted_nodes.append(condition)
    condition.membership = "ElementFilterMembership"
    return condition


def apply_visibility(
    tokens: Tokens, _stop: int, begin: int, visibility: int, item: Node | list[Node]
) -> Node | list[Node]:
    """Set the visibility of a member, or of all members that one declaration produces."""
    nodes = item if isinstance(item, list) else [item]
    for node in nodes:
        node.visibility = tokens[visibility]
    nodes[0].start = tokens.starts[begin]
    return item


ACTIONS = {
    "package": _build_package,
    "comment": _build_comment,
    "located_comment": _build_located_comment,
    "bare_comment": _build_bare_comment,
    "documentation": _build_documentation,
    "representation": _build_representation,
    "bare_representation": _build_bare_representation,
    "metadata": build_metadata,
    "prefix_metadata": build_prefix_metadata,
    "named_dependency": _build_named_dependency,
    "dependency": _build_dependency,
    "alias": _build_alias,
    "imported_member": _build_member_import,
    "imported_member_recursive": _build_recursive_member_import,
    "imported_namespace": _build_namespace_import,
    "imported_namespace_recursive": _build_recursive_namespace_import,
    "imported_filtered": _build_filtered_import,
    "import": _build_import,
    "import_all": _build_import_all,
    "expose": _build_expose,
    "filter": _build_filter,
    "visible": apply_visibility,
    "visible_result": apply_visibility,
}
