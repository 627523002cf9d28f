"""Types, features and prefixes of KerML (8.2.4, 8.2.5)."""

from sysmlc.language.text.build import definitions
from sysmlc.language.text.build.connections import Rest, Tail, apply, parted
from sysmlc.language.text.build.definitions import whole
from sysmlc.language.text.build.ends import End
from sysmlc.language.text.build.features import Part, give, multiplicity, specialize
from sysmlc.language.text.build.names import Names, call
from sysmlc.language.text.build.owning import FEATURE, OWNING, made, own
from sysmlc.language.text.scan import Tokens
from sysmlc.language.tree import Node, Reference, Relation

_TYPES = {
    "type": "Type",
    "classifier": "Classifier",
    "datatype": "DataType",
    "class": "Class",
    "struct": "Structure",
    "metaclass": "Metaclass",
    "assoc": "Association",
    "assoc struct": "AssociationStructure",
    "interaction": "Interaction",
    "behavior": "Behavior",
    "function": "Function",
    "predicate": "Predicate",
}
_FEATURES = {
    "feature": "Feature",
    "step": "Step",
    "expr": "Expression",
    "bool": "BooleanExpression",
    "inv": "Invariant",
    "connector": "Connector",
    "succession": "Succession",
    "flow": "Flow",
    "succession flow": "SuccessionFlow",
}
Keyword = int | str


def _words(tokens: Tokens, _at: int, _begin: int, *words: int) -> str:
    return " ".join(tokens[word] for word in words)


def _word(tokens: Tokens, keyword: Keyword) -> str:
    return keyword if isinstance(keyword, str) else tokens[keyword]


def _type(
    tokens: Tokens,
    at: int,
    begin: int,
    keyword: Keyword,
    sufficient: int | None,
    names: Names | None,
    parts: list[Part] | None,
    body: list[Node],
) -> Node:
    kind = _TYPES[_word(tokens, keyword)]
    node = call(made(kind, OWNING, tokens, begin, at), names, tokens)
    if sufficient is not None:
        node.facts["isSufficient"] = True
    specialize(node, parts, tokens)
    if kind != "Type":
        for relation in node.relations:
            if relation.kind == "Specialization":
                relation.kind = "Subclassification"
    return own(node, body)


def _declared(
    tokens: Tokens,
    at: int,
    begin: int,
    keyword: Keyword,
    sufficient: int | None,
    names: Names | None,
    parts: list[Part] | None,
    value: Node | None,
) -> Node:
    words = _word(tokens, keyword).removesuffix(" true")
    negated = words.endswith(" false")
    kind = _FEATURES[words.removesuffix(" false")]
    node = call(made(kind, FEATURE, tokens, begin, at), names, tokens)
    if negated:
        node.facts["isNegated"] = True
    if sufficient is not None:
        node.facts["isSufficient"] = True
    return give(specialize(node, parts, tokens), value)


def _ends(tokens: Tokens, at: int, begin: int, keyword: Keyword, *rest: Rest) -> Node:
    node = _declared(tokens, at, begin, keyword, None, None, None, None)
    ends, body = parted(rest)
    return whole(apply(node, Tail(ends=ends), tokens), tokens, at, body)


def _ends_all(
    tokens: Tokens, at: int, begin: int, keyword: Keyword, _all: int, *rest: Rest
) -> Node:
    node = _ends(tokens, at, begin, keyword, *rest)
    node.facts["isSufficient"] = True
    return node


def _declared_many_ends(
    tokens: Tokens, at: int, _begin: int, node: Node, first: End, rest: list[End], body: list[Node]
) -> Node:
    return whole(apply(node, Tail(ends=[first, *rest]), tokens), tokens, at, body)


def _bound_nameless(
    _tokens: Tokens, _at: int, _begin: int, parts: list[Part], more: list[Part] | None = None
) -> tuple[None, list[Part]]:
    return None, [*parts, *(more or ())]


def _bound_name(
    tokens: Tokens, _at: int, _begin: int, name: int, parts: list[Part]
) -> tuple[Names, list[Part]]:
    return Names(None, tokens.name(name), name), parts


def _bound_name_of(tokens: Tokens, _at: int, _begin: int, name: int) -> tuple[Names, list[Part]]:
    return Names(None, tokens.name(name), name), []


def _binding(
    tokens: Tokens,
    at: int,
    begin: int,
    sufficient: int | None,
    name: tuple[Names | None, list[Part]] | None,
    ends: list[End] | None,
    body: list[Node],
) -> Node:
    node = made("BindingConnector", FEATURE, tokens, begin, at)
    if name is not None:
        specialize(call(node, name[0], tokens), name[1], tokens)
    if sufficient is not None:
        node.facts["isSufficient"] = True
    return whole(apply(node, Tail(ends=ends or []), tokens), tokens, at, body)


def _first_between(_tokens: Tokens, _at: int, _begin: int, source: End, target: End) -> Tail:
    return Tail("", "then", ends=[source, target])


def _namespace(tokens: Tokens, at: int, begin: int, names: Names | None, body: list[Node]) -> Node:
    return own(call(made("Namespace", OWNING, tokens, begin, at), names, tokens), body)


def _multiplicity_range(
    tokens: Tokens, at: int, begin: int, names: Names | None, bounds: Node, body: list[Node]
) -> Node:
    return own(call(multiplicity(bounds, tokens, begin, at), names, tokens), body)


def _multiplicity_subset(
    tokens: Tokens, at: int, begin: int, names: Names | None, subset: Reference, body: list[Node]
) -> Node:
    node = call(made("Multiplicity", OWNING, tokens, begin, at), names, tokens)
    node.relations.append(Relation("Subsetting", subset))
    return own(node, body)


ACTIONS = {
    "inv": _words,
    "assoc_struct": _words,
    "succession_flow": _words,
    "type": _type,
    "declared_all": _declared,
    "usage": definitions.ACTIONS["usage"],
    "usage_ends": _ends,
    "usage_ends_all": _ends_all,
    "usage_many_ends": _ends,
    "declared_many_ends": _declared_many_ends,
    "bound_name": _bound_name,
    "bound_name_of": _bound_name_of,
    "bound_nameless": _bound_nameless,
    "binding": _binding,
    "namespace": _namespace,
    "first_between": _first_between,
    "multiplicity_range": _multiplicity_range,
    "multiplicity_subset": _multiplicity_subset,
}
