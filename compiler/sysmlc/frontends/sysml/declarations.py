"""What declarations state beyond the facts of the graph: keywords, prefixes, further members.

The graph has fewer kinds of elements than SysML v2. ``part x : X`` and ``item x : X`` are equal
properties there, and a parameter of a constraint may be no element at all. A comparison of two
texts in SysML v2 therefore also compares the statements of this module. They follow the syntax
tree, so that layout and alternative spellings (``:>`` and ``subsets``) make no difference.
"""

from collections.abc import Iterator
from functools import partial

from sysmlc.frontends.sysml import nodes, values
from sysmlc.frontends.sysml.elements import NodeElements
from sysmlc.frontends.sysml.lowering import Lowering
from sysmlc.ir import Element, Graph, Kind
from sysmlc.ir.pending import Declarations, Statement
from sysmlc.language.library import SHIPPED
from sysmlc.language.tree import AttributeValue, Node, Reference, Relation
from sysmlc.support.interpreter import allow_recursion

_Words = tuple[str, ...]
_SYMBOLS = {
    "FeatureTyping": ":",
    "ConjugatedPortTyping": ": ~",
    "Subclassification": ":>",
    "Specialization": ":>",
    "Subsetting": ":>",
    "Redefinition": ":>>",
    "ReferenceSubsetting": "::>",
    "CrossSubsetting": "=>",
    "importedNamespace": "",
    "importedMembership": "",
}
_KEYWORDS = {
    "ReferenceUsage": "ref",
    "Usage": "",
    "Membership": "alias",
    "Documentation": "doc",
    "TextualRepresentation": "rep",
    "NamespaceImport": "import",
    "MembershipImport": "import",
    "NamespaceExpose": "expose",
    "MembershipExpose": "expose",
}
"""Keywords of metaclasses that are not spelled like them."""
_MEMBERSHIPS = {
    "SubjectMembership": "subject",
    "ActorMembership": "actor",
    "StakeholderMembership": "stakeholder",
    "ObjectiveMembership": "objective",
    "FramedConcernMembership": "frame",
    "ReturnParameterMembership": "return",
    "VariantMembership": "variant",
    "EndFeatureMembership": "end",
    "RequirementVerificationMembership": "verify",
    "ViewRenderingMembership": "render",
    "ElementFilterMembership": "filter",
    "assumption": "assume",
    "requirement": "require",
}
"""Words for memberships, or for the roles of memberships that have several."""
_MEMBERS = {
    "Documentation": "documentation",
    "Comment": "documentation",
    "TextualRepresentation": "documentation",
    "MetadataUsage": "metadata",
    "MetadataFeature": "metadata",
}
"""Aspects of members by metaclass; imports and all other members follow below."""
_STATED_WHOLE = frozenset({Kind.APPLICATION, Kind.COMMENT, Kind.CONNECTOR_END, Kind.IMPORT})
"""Kinds whose declarations are single statements about their owners, not one for each part."""
_VALUES = frozenset({"default", "value"})
"""Attributes of elements for their values."""
_LATER_ATTRIBUTES = frozenset({"isPortion", "body"})
"""The attribute that follows from ``portionKind``, and the one behind the name."""


def store_declarations(lowering: Lowering) -> None:
    """Store the statements in the graph; they are collected only if a comparison needs them."""
    declarations = Declarations(partial(_list_statements, lowering))
    lowering.graph.store(Declarations, [*lowering.graph.derived(Declarations), declarations])


def _list_statements(lowering: Lowering) -> list[Statement]:
    with allow_recursion(lowering.trees.depth):
        return [
            statement
            for document in lowering.trees.documents
            if not document.path.startswith(SHIPPED)
            for statement in _iter_statements(lowering, document.root)
        ]


def _iter_statements(lowering: Lowering, root: Node) -> Iterator[Statement]:
    """Yield the statements about the elements of a file.

    A declaration that is no element belongs to the element of the nearest declaration around it. In
    the root namespace, this is the first element.
    """
    elements = (_find_element(lowering.graph, lowering.elements, member) for member in root.members)
    first = next((element for element in elements if element is not None), None)
    if first is None:
        return
    stack = [(member, first, False) for member in reversed(root.members)]
    while stack:
        node, host, is_stated = stack.pop()
        element = _find_element(lowering.graph, lowering.elements, node)
        if element is not None:
            for aspect, words in _iter_parts(lowering, node, element):
                yield Statement(element.id, aspect, words)
            stack += [(member, element, False) for member in reversed(node.members)]
            continue
        # The statement about a member contains its members, except for those that are elements.
        if not is_stated and not _is_part_of_owner(node):
            words = _describe_member(lowering, node)
            if words:
                yield Statement(host.id, _name_member(node), words)
        stack += [(member, host, True) for member in reversed(node.members)]


def _find_element(graph: Graph, elements: NodeElements, node: Node) -> Element | None:
    """Return the element that was added for exactly this node, if the graph still has it."""
    element = elements.own.get(id(node))
    if element is None or element.id not in graph or element.kind in _STATED_WHOLE:
        return None
    return element if elements.origins.get(element.id) is node else None


def _is_part_of_owner(node: Node) -> bool:
    """Whether a node is a part of the declaration of its owner: its value or multiplicity."""
    return node.membership == "FeatureValue" or node.kind == "MultiplicityRange"


def _name_member(node: Node) -> str:
    """Return the aspect under which differences of a member without an element are reported."""
    if _is_import(node):
        return "import"
    aspect = _MEMBERS.get(node.kind) or _MEMBERSHIPS.get(node.role or node.membership)
    return aspect or ("condition" if node.kind in nodes.EXPRESSIONS else "member")


# -- parts of a declaration --------------------------------------------------------------------


def _iter_parts(
    lowering: Lowering, node: Node, element: Element | None = None
) -> Iterator[tuple[str, _Words]]:
    """Yield the aspect and the words of each part of a declaration, without members.

    The name and the value that the element of the node has are no statements.
    """
    yield from _iter_memberships(node)
    if node.kind in nodes.EXPRESSIONS:
        yield "condition", _describe_expression(lowering, node)
        return
    yield from _iter_words(node, "" if element is None else element.name)
    for relation in node.relations:
        yield "specialization", _describe_relation(lowering, relation)
    multiplicity = values.multiplicity_of(lowering.trees, node)
    if multiplicity:
        yield "multiplicity", (f"[{multiplicity}]",)
    expression = nodes.value_of(node)
    has_value = element is not None and not _VALUES.isdisjoint(element.attrs)
    if expression is not None and not has_value:
        role = "default" if expression.role == "default =" else expression.role
        yield "value", (role, *_describe_expression(lowering, expression))
    if "body" in node.attributes:
        yield "body", (_describe_attribute("body", node.attributes["body"]),)


def _iter_memberships(node: Node) -> Iterator[tuple[str, _Words]]:
    # Members are public unless the text states otherwise; imports have no such default.
    if node.visibility and (node.visibility != "public" or _is_import(node)):
        yield "visibility", (node.visibility,)
    membership = _MEMBERSHIPS.get(node.role or node.membership) or node.role
    if membership:
        yield "membership", (membership,)


def _iter_words(node: Node, known_name: str) -> Iterator[tuple[str, _Words]]:
    """Yield prefixes, keyword and names."""
    for attribute, value in node.attributes.items():
        if attribute not in _LATER_ATTRIBUTES:
            yield _name_attribute(attribute), (_describe_attribute(attribute, value),)
    keyword = _spell_keyword(node)
    if keyword:
        yield "keyword", (keyword,)
    if node.short_name and node.short_name != known_name:
        yield "short name", (f"<{node.short_name}>",)
    if node.name and node.name != known_name:
        yield "name", (node.name,)


def _is_import(node: Node) -> bool:
    return node.kind.endswith(("Import", "Expose"))


def _spell_keyword(node: Node) -> str:
    """Return a metaclass as a keyword: ``part`` for a usage, ``part def`` for a definition."""
    if node.kind in _KEYWORDS:
        return _KEYWORDS[node.kind]
    words = nodes.spell_metaclass(node.kind)
    return words.removesuffix(" usage").replace(" definition", " def")


def _name_attribute(name: str) -> str:
    """Return the name of an attribute in words: ``abstract`` for ``isAbstract``."""
    words = nodes.spell_metaclass(name).removeprefix("is ")
    return "readonly" if words == "constant" else words


def _describe_attribute(name: str, value: AttributeValue) -> str:
    if isinstance(value, bool):
        return _name_attribute(name) if value else f"not {_name_attribute(name)}"
    return " ".join(str(value).split())


def _describe_relation(lowering: Lowering, relation: Relation) -> _Words:
    symbol = _SYMBOLS.get(relation.kind, nodes.spell_metaclass(relation.kind))
    names = _describe_reference(lowering, relation.reference)
    return (symbol, *names, "::*") if relation.kind == "importedNamespace" else (symbol, *names)


def _describe_reference(lowering: Lowering, reference: Reference) -> _Words:
    """Return the ids of the elements that a reference names, else their names."""
    targets = reference.targets or ()
    if len(targets) < len(reference.chain):
        return (str(reference),)
    words = [word for target in targets for word in (".", _describe_target(lowering, target))]
    return tuple(words[1:])


def _describe_target(lowering: Lowering, target: Node) -> str:
    element = _find_element(lowering.graph, lowering.elements, target)
    if element is not None:
        return element.id
    is_own = lowering.trees.document_of(target) is not None
    return nodes.name_of(target) if is_own else nodes.qualified_name_of(target)


# -- expressions -------------------------------------------------------------------------------


def _describe_expression(lowering: Lowering, node: Node) -> _Words:
    """Return the words of an expression; names are those of the elements that they refer to."""
    references = [
        word
        for relation in node.relations
        for word in _describe_reference(lowering, relation.reference)
    ]
    operands = [_describe_operand(lowering, member) for member in node.members]
    operator = str(node.attributes.get("operator", ""))
    if operator and len(operands) == 2:
        end = ("]",) if operator == "[" else ()
        return (*operands[0], operator, *operands[1], *end)
    inner = tuple(word for operand in operands for word in operand)
    if node.kind == "FeatureChainExpression":
        return (*inner, ".", *references)
    if node.kind in ("FeatureReferenceExpression", "OperatorExpression"):
        return (*([operator] if operator else []), *references, *inner)
    if "value" in node.attributes:
        return (str(node.attributes["value"]),)
    attributes = [_describe_attribute(key, value) for key, value in node.attributes.items()]
    keyword = nodes.spell_metaclass(node.kind).removesuffix(" expression")
    return (keyword, *attributes, *references, "(", *inner, ")")


def _describe_operand(lowering: Lowering, node: Node) -> _Words:
    if node.kind not in nodes.EXPRESSIONS:
        return _describe_member(lowering, node)
    words = _describe_expression(lowering, node)
    return ("(", *words, ")") if node.kind == "OperatorExpression" else words


# -- members that are no elements --------------------------------------------------------------


def _describe_member(lowering: Lowering, node: Node) -> _Words:
    """Return the words of a declaration and of its members, which stand in braces."""
    # `in x` is `in ref x`; the parser adds unnamed parameters and ends that the text omits.
    parts = [part for part in _iter_parts(lowering, node) if part != ("keyword", ("ref",))]
    head = [word for _, words in parts for word in words]
    body = [word for member in _list_members(lowering, node) for word in (*member, ";")]
    if body:
        return (*head, "{", *body, "}")
    return () if head == ["end"] else tuple(head)


def _list_members(lowering: Lowering, node: Node) -> list[_Words]:
    """Return the words of the members of a declaration that are no elements."""
    if node.kind in nodes.EXPRESSIONS:
        return []
    members = [
        _describe_member(lowering, member)
        for member in node.members
        if not _is_part_of_owner(member)
        and _find_element(lowering.graph, lowering.elements, member) is None
    ]
    return [words for words in members if words]
