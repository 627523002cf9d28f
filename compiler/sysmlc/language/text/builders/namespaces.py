"""Packages, imports, aliases, dependencies, annotations (KerML 8.2.3, SysML 8.2.2.3 to 8.2.2.5)."""

from functools import partial

from sysmlc.language.metaclasses import is_composite
from sysmlc.language.text.builders.declarations import Names, make_element
from sysmlc.language.text.builders.nodes import OWNING, add_members, make_node, omit_first
from sysmlc.language.text.lexer import Tokens, strip_comment, unquote
from sysmlc.language.tree import Node, Reference, Relation


def build_root(tokens: Tokens, members: list[Node]) -> Node:
    """Return the root namespace of a text."""
    node = Node("Namespace", start=0, end=len(tokens.text))
    add_members(node, members)
    # `ref` is redundant in usages that are referential anyway (SysML 8.2.2.6.2, note 1).
    for usage in tokens.ref_usages:
        # `is_composite` looks at the attribute, so it answers for the usage without `ref`.
        usage.attributes.pop("isReference", None)
        if is_composite(usage):
            usage.attributes["isReference"] = True
    return node


def build_namespace(kind: str, tokens: Tokens, names: Names | None, body: list[Node]) -> Node:
    """Build a package, or a namespace of KerML."""
    return add_members(make_element(kind, OWNING, tokens, names), body)


def _build_annotation(
    kind: str, tokens: Tokens, names: Names | None, locale: int | None, body: int
) -> Node:
    node = make_element(kind, OWNING, tokens, names)
    if locale is not None:
        node.attributes["locale"] = unquote(tokens[locale])
    node.attributes["body"] = strip_comment(tokens[body])
    return node


def _add_annotated_elements(node: Node, about: list[Reference] | None) -> Node:
    node.relations += [Relation("Annotation", reference) for reference in about or ()]
    return node


def _build_comment(
    tokens: Tokens,
    names: Names | None,
    about: list[Reference] | None,
    locale: int | None,
    body: int,
) -> Node:
    node = _build_annotation("Comment", tokens, names, locale, body)
    return _add_annotated_elements(node, about)


def _build_representation(tokens: Tokens, names: Names | None, language: int, body: int) -> Node:
    node = _build_annotation("TextualRepresentation", tokens, names, None, body)
    node.attributes["language"] = unquote(tokens[language])
    return node


def build_metadata(
    kind: str,
    tokens: Tokens,
    names: Names | None,
    typing: Relation,
    about: list[Reference] | None,
    body: list[Node],
) -> Node:
    """Build metadata that is a separate member (SysML 8.2.2.27)."""
    node = make_element(kind, OWNING, tokens, names, [typing])
    return add_members(_add_annotated_elements(node, about), body)


def build_prefix_metadata(kind: str, tokens: Tokens, reference: Reference) -> Node:
    """Build metadata before a member: ``#name``."""
    node = make_element(kind, OWNING, tokens, None, [Relation("FeatureTyping", reference)])
    node.attributes["isPrefix"] = True
    return node


def _build_dependency(
    tokens: Tokens,
    names: Names | None,
    clients: list[Reference],
    suppliers: list[Reference],
    body: list[Node],
) -> Node:
    node = make_element("Dependency", OWNING, tokens, names)
    node.relations += [Relation("client", end) for end in clients]
    node.relations += [Relation("supplier", end) for end in suppliers]
    return add_members(node, body)


def _build_alias(
    tokens: Tokens, names: Names | None, reference: Reference, body: list[Node]
) -> Node:
    node = make_element("Membership", "", tokens, names, [Relation("Membership", reference)])
    return add_members(node, body)


def _build_imported(kind: str, recursive: bool, tokens: Tokens, name: Reference) -> Node:
    node = make_node(f"{kind}Import", "", tokens)
    node.relations.append(Relation(f"imported{kind}", name))
    if recursive:
        node.attributes["isRecursive"] = True
    return node


def _build_filtered_import(tokens: Tokens, imported: Node, condition: Node) -> Node:
    condition.membership = "ElementFilterMembership"
    # A second filter belongs to the same filter package.
    if imported.members:
        imported.members[0].add_member(condition)
        return imported
    imported.visibility = "public"
    outer_import = make_node("NamespaceImport", "", tokens)
    package = outer_import.add_member(make_node("Package", "", tokens))
    package.add_member(imported)
    package.add_member(condition)
    return outer_import


def _build_import(tokens: Tokens, imported: Node, body: list[Node]) -> Node:
    tokens.restricted_nodes.append(imported)
    imported.start = tokens.starts[tokens.begin]
    imported.end = tokens.ends[tokens.stop - 1]
    return add_members(imported, body)


def _build_import_all(tokens: Tokens, imported: Node, body: list[Node]) -> Node:
    imported.attributes["isImportAll"] = True
    return _build_import(tokens, imported, body)


def _build_expose(tokens: Tokens, imported: Node, body: list[Node]) -> Node:
    imported.kind = imported.kind.replace("Import", "Expose")
    return _build_import(tokens, imported, body)


def _build_filter(tokens: Tokens, condition: Node) -> Node:
    tokens.restricted_nodes.append(condition)
    condition.membership = "ElementFilterMembership"
    return condition


def _apply_visibility(
    tokens: Tokens, visibility: int, item: Node | list[Node]
) -> Node | list[Node]:
    """Set the visibility of a member, or of all members that one declaration produces."""
    nodes = item if isinstance(item, list) else [item]
    for node in nodes:
        node.visibility = tokens[visibility]
    nodes[0].start = tokens.starts[tokens.begin]
    return item


ACTIONS = {
    "package": partial(build_namespace, "Package"),
    "comment": _build_comment,
    "located_comment": omit_first(partial(_build_annotation, "Comment")),
    "bare_comment": omit_first(partial(_build_annotation, "Comment"), 2),
    "documentation": partial(_build_annotation, "Documentation"),
    "representation": _build_representation,
    "bare_representation": omit_first(_build_representation),
    "metadata": partial(build_metadata, "MetadataUsage"),
    "prefix_metadata": partial(build_prefix_metadata, "MetadataUsage"),
    "named_dependency": _build_dependency,
    "dependency": omit_first(_build_dependency),
    "alias": _build_alias,
    "imported_member": partial(_build_imported, "Membership", False),
    "imported_member_recursive": partial(_build_imported, "Membership", True),
    "imported_namespace": partial(_build_imported, "Namespace", False),
    "imported_namespace_recursive": partial(_build_imported, "Namespace", True),
    "imported_filtered": _build_filtered_import,
    "import": _build_import,
    "import_all": _build_import_all,
    "expose": _build_expose,
    "filter": _build_filter,
    "visible": _apply_visibility,
}
