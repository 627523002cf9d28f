"""What may help where a token does not fit: common slips, words of drafts and other languages."""

from collections.abc import Callable, Collection

from sysmlc.language.text.foreign import direction, foreign
from sysmlc.language.text.scan import Tokens
from sysmlc.support.suggestions import did_you_mean

INITIAL = "':=' gives an initial value, '=' binds for good, 'default' may be overridden"
_PARAMETERS = "parameters are members of the body: {{ in {0}; }}"
_TOKENS = {
    "import": "an import stands in a body: private import A::*;",
    ":=": INITIAL,
    ",": "members end with ';', they are not separated by commas",
    "extends": "what is more special says ':>' or 'specializes'",
    "is": "what is more special says ':>' or 'specializes', a type stands behind ':'",
    "with": "ends of a connection are joined by 'to': connect a to b",
    "then": "an expression asks with a question mark: if a ? b else c",
    "when": "what is waited for is 'accept when c', a condition is 'if c', both before 'then'",
}
"""What to say about a token, wherever it stands."""
_FIRST = {
    "activity": "'action' is meant",
    "assoc": "in SysML an association is a 'connection def'",
    "behavior": "in SysML a behaviour is an 'action def'",
    "block": "a block is a 'part def'",
    "class": "in SysML a class is a 'part def', 'item def' or 'attribute def'",
    "component": "'part' is meant",
    "datatype": "in SysML a type of values is an 'attribute def'",
    "decision": "'decide' is meant",
    "enumeration": "'enum def' is meant",
    "feature": "in SysML a feature is a 'ref', 'attribute', 'part' or 'item'",
    "func": "'calc' is meant",
    "function": "in SysML a function is a 'calc def'",
    "id": "an identifier stands behind the keyword: requirement <'R5'> name",
    "link": "'connection' is meant",
    "operation": "'action' is meant",
    "property": "'attribute', 'part' or 'ref' is meant",
    "readonly": "what never changes is 'constant', in KerML 'const'",
    "predicate": "in SysML a predicate is a 'constraint def'",
    "signal": "what is sent is an 'item def' or 'attribute def'",
    "stream": "'flow' is meant: flow from a.x to b.y",
    "struct": "in SysML a structure is a 'part def' or 'item def'",
    "usecase": "'use case' is meant",
    "value": "'attribute' is meant",
    "var": "'attribute' is meant",
    "valuetype": "a type of values is an 'attribute def'",
}
"""What to say about a word that begins a member and is no keyword."""
_ENDS = frozenset({"to", "then", "="})
_DIRECTIONS = frozenset({"in", "out", "inout"})
_BREAKS = ("", ";", "{", "}")


def slip(tokens: Tokens, at: int, expected: Collection[str], beginnings: Collection[str]) -> str:
    """What may help with token ``at``, in place of which ``expected`` may stand; or nothing.

    ``beginnings`` are the words with which members of a body begin.
    """
    for about in _SLIPS:
        said = about(tokens, at, expected)
        if said:
            return said
    foreign_one = foreign(tokens, at, expected) if not tokens[at].isalpha() else ""
    known = _TOKENS.get(tokens[at], "") or foreign_one
    return known or first_word(tokens, at - 1, beginnings) or foreign(tokens, at, expected)


def missing(tokens: Tokens, before: int, at: int, beginnings: Collection[str]) -> str:
    """What may help where a member seems to end with token ``before``, and ``at`` follows."""
    return (
        _import(tokens, at, ())
        or _ends(tokens, at, ())
        or direction(tokens, before, at, beginnings)
        or first_word(tokens, before, beginnings)
    )


def first_word(tokens: Tokens, at: int, beginnings: Collection[str]) -> str:
    """Where a member starts with a word that no keyword is: the keyword that may be meant."""
    word = tokens[at] if at >= 0 else ""
    is_first = at == 0 or tokens[at - 1] in _BREAKS
    if not is_first or not word.isidentifier() or word in beginnings:
        return ""
    if word in _FIRST:
        return f"'{word}' is no keyword: {_FIRST[word]}"
    said = did_you_mean(word, [known for known in beginnings if known.isalpha()])
    return f"'{word}' is no keyword: {said}" if said.startswith("did") else ""


def _member(tokens: Tokens, at: int) -> list[str]:
    """The tokens before ``at`` of the member that it stands in."""
    start = at
    while start > 0 and tokens[start - 1] not in _BREAKS:
        start -= 1
    return [tokens[index] for index in range(start, at)]


def _unit(tokens: Tokens, at: int, _expected: Collection[str]) -> str:
    """A name behind a number is meant as its unit."""
    unit, number = tokens[at], tokens[at - 1] if at else ""
    is_unit = number[:1].isdigit() and unit[:1].isalpha()
    return f"units stand in brackets: {number} [{unit}]" if is_unit else ""


def _parameters(tokens: Tokens, at: int, expected: Collection[str]) -> str:
    """A list in parentheses behind the name that is declared."""
    before = _member(tokens, at)
    if tokens[at] == "(" and {";", "{"} <= set(expected):
        names = [word for word in _following(tokens, at) if word not in _DIRECTIONS]
        return _PARAMETERS.format(names[0] if names and names[0].isidentifier() else "x")
    is_list = tokens[at] in (")", ",", ":") and before[2:3] == ["("] and "," in expected
    return _PARAMETERS.format(before[3]) if is_list and len(before) > 3 else ""


def _following(tokens: Tokens, at: int) -> list[str]:
    """The two tokens after one, as far as there are so many."""
    return [tokens[index] for index in range(at + 1, min(at + 3, len(tokens.types)))]


def _multiplicity(tokens: Tokens, at: int, expected: Collection[str]) -> str:
    is_end = tokens[at] == "[" and not _ENDS.isdisjoint(expected)
    return "the multiplicity of an end stands before it: [0..1] a" if is_end else ""


def _import(tokens: Tokens, at: int, _expected: Collection[str]) -> str:
    if "import" not in _member(tokens, at):
        return ""
    if tokens[at] == ".":
        return "names of packages are joined by '::'"
    name = "".join(_following(tokens, at)[:1])
    return f"another name is an alias: alias {name} for ...;" if tokens[at] == "as" else ""


def _ends(tokens: Tokens, at: int, _expected: Collection[str]) -> str:
    """A succession or transition whose ends are said with other words."""
    before = _member(tokens, at)
    source = before[-1] if before else "a"
    if tokens[at] == "then" and before[-2:-1] == ["succession"]:
        return f"before the source stands 'first': succession first {source} then ..."
    if tokens[at] == "to" and "transition" in before:
        return f"a transition says where it begins and ends: transition first {source} then ..."
    return ""


def _condition(tokens: Tokens, at: int, _expected: Collection[str]) -> str:
    is_condition = _member(tokens, at)[:1] == ["assert"]
    return "what is asserted stands in braces: assert constraint { x > 0 }" if is_condition else ""


def _result(tokens: Tokens, at: int, _expected: Collection[str]) -> str:
    """``return`` declares the result: an expression is its value."""
    is_value = _member(tokens, at)[:1] == ["return"]
    return "'return' declares the result: return r = ...;" if is_value else ""


_SLIPS: tuple[Callable[[Tokens, int, Collection[str]], str], ...] = (
    _unit,
    _parameters,
    _multiplicity,
    _import,
    _ends,
    _result,
    _condition,
)
