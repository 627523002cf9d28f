"""Advice about a token that does not fit: common slips, words of drafts and of other languages."""

from collections.abc import Callable, Collection
from difflib import SequenceMatcher
from functools import cache
from typing import NamedTuple

from sysmlc.language.text.lexer import Tokens
from sysmlc.language.text.spelling import RESERVED
from sysmlc.support.suggestions import did_you_mean

COMMA = "members end with ';', they are not separated by commas"
INITIAL = "':=' gives an initial value, '=' binds for good, 'default' may be overridden"
_SHORT_NAME = "write the short name after the keyword: requirement <'R5'> name"
_PARAMETERS = "parameters are members of the body: {{ in {0}; }}"
_TOKENS = {
    "import": "write the import in a body: private import A::*;",
    ":=": INITIAL,
    ",": COMMA,
    "extends": "write ':>' or 'specializes' before a general type",
    "is": "write ':>' or 'specializes' before a general type, and ':' before the type of a usage",
    "id": _SHORT_NAME,
    "with": "ends of a connection are joined by 'to': connect a to b",
    "when": "write 'accept when c' for a change, 'if c' for a guard, both before 'then'",
}
"""Advice about a token, wherever it stands."""
_FIRST_WORDS = {
    "activity": ("action", "'action' is meant"),
    "assoc": ("connection def", "in SysML an association is a 'connection def'"),
    "association": ("connection def", "in SysML an association is a 'connection def'"),
    "behavior": ("action def", "in SysML a behaviour is an 'action def'"),
    "block": ("part def", "a block is a 'part def'"),
    "class": ("part def", "in SysML a class is a 'part def', 'item def' or 'attribute def'"),
    "component": ("part", "'part' is meant"),
    "connector": ("connect", "'connect' is meant: connect a to b"),
    "datatype": ("attribute def", "in SysML a type of values is an 'attribute def'"),
    "decision": ("decide", "'decide' is meant"),
    "elif": (None, "'else if' is meant"),
    "elseif": (None, "'else if' is meant"),
    "enumeration": ("enum def", "'enum def' is meant"),
    "equation": (None, "an equation is a constraint: assert constraint { a == b }"),
    "extends": (None, "a definition names its general type before its body: part def A :> B"),
    "feature": ("ref", "in SysML a feature is a 'ref', 'attribute', 'part' or 'item'"),
    "final": ("", "what never changes is 'constant'"),
    "foreach": ("for", "'for' is meant: for i in 1..3 { ... }"),
    "full": ("", "every port is a 'port'"),
    "func": ("calc", "'calc' is meant"),
    "function": ("calc def", "in SysML a function is a 'calc def'"),
    "id": (None, _SHORT_NAME),
    "initial": ("entry ; then", "the first state follows the entry action: entry; then a;"),
    "input": ("in", "'in' is meant"),
    "let": ("attribute", "'attribute' is meant"),
    "link": ("connect", "'connect' is meant: connect a to b"),
    "method": ("action", "'action' is meant"),
    "model": (None, "'package' or 'part def' is meant, with the members in braces"),
    "module": ("package", "'package' is meant"),
    "namespace": ("package", "'package' is meant"),
    "note": ("comment", "a text in the model is a comment /* ... */, a note is written // ..."),
    "operation": ("action", "'action' is meant"),
    "output": ("out", "'out' is meant"),
    "parameter": ("attribute", "'attribute' is meant"),
    "predicate": ("constraint def", "in SysML a predicate is a 'constraint def'"),
    "property": ("attribute", "'attribute', 'part' or 'ref' is meant"),
    "proxy": ("", "every port is a 'port'"),
    "readonly": ("constant", "what never changes is 'constant', in KerML 'const'"),
    "set": ("assign", "'assign' is meant: assign x := 3;"),
    "signal": ("item def", "declare a signal as 'item def' or 'attribute def'"),
    "static": ("", "a feature belongs to each element of its type, or to a package"),
    "stereotype": ("metadata def", "a stereotype is a 'metadata def'"),
    "stream": ("flow", "'flow' is meant: flow from a.x to b.y"),
    "struct": ("part def", "in SysML a structure is a 'part def' or 'item def'"),
    "switch": (None, "write a choice with 'if': if x == 1 { ... } else if x == 2 { ... }"),
    "text": (None, "the text of a requirement is its documentation: doc /* ... */"),
    "timeout": (None, "a time is awaited: accept after 3 [SI::s];"),
    "type": (None, "another name of a type is an alias: alias B for A;"),
    "typedef": (None, "another name of a type is an alias: alias B for A;"),
    "usecase": ("use case", "'use case' is meant"),
    "using": ("private import", "names are imported: private import A::*;"),
    "val": ("attribute", "'attribute' is meant"),
    "value": ("attribute", "'attribute' is meant"),
    "valuetype": ("attribute def", "a type of values is an 'attribute def'"),
    "var": ("attribute", "'attribute' is meant"),
    "variable": ("attribute", "'attribute' is meant"),
    "virtual": ("", "every feature can be redefined: part :>> a"),
    "void": ("action", "an operation is an 'action'"),
    "wait": (None, "a time is awaited: accept after 3 [SI::s];"),
}
"""The keywords that a word of another language at the beginning of a member stands for, and advice.

The keywords are empty for a word to omit, and None where the rest of the member must change, too.
"""
_TYPES = """
    ScalarValues::Boolean: bool boolean
    ScalarValues::Integer: int integer long short sint dint lint
    ScalarValues::Natural: uint unsigned usint udint nat natural
    ScalarValues::Real: float double decimal real lreal
    ScalarValues::String: str string wstring char text
    ISQ::DurationValue: duration timedelta
"""
"""Qualified names of types, and words for them in programming languages, IEC 61131-3 and UML."""
_END_TOKENS = frozenset({"to", "then", "="})
DIRECTIONS = frozenset({"in", "out", "inout"})
_SEPARATORS = ("", ";", "{", "}")
_MIN_KEYWORD_LENGTH = 5
"""Length of the shortest word that is taken for a misspelt keyword; shorter ones are names."""
_MIN_MISSPELT_LENGTH = 3
_MAX_MISSPELT_LENGTH = 30
_MIN_SIMILARITY = 0.7
"""Ratio of ``difflib`` from which the first word of a member counts as a misspelt keyword."""
_COMPARISONS = frozenset({"==", "!=", "<", "<=", ">", ">="})
_OPERATORS = {"mod": "%", "div": "/", "rem": "%"}
_DOUBLED_OPERATORS = {"&": "'and'", "|": "'or'"}
ARROWS = ("-", "->", "=>", "~", ",")
ARROW = "an order is written 'first a then b;', a transition 'transition first a then b;'"
JOINED_BY_TO = "ends are joined by 'to': a to b"
COMPARISON = "'==' compares two values, '=' binds one"
NOTE = "a note to the end of the line begins with '//'"
STEREOTYPE = (
    "a stereotype is metadata: #name before a declaration, or @name; in a body; what a "
    "'part def' declares is a block"
)


class Spot(NamedTuple):
    """A token that does not fit, in whose place only the ``expected`` tokens are valid.

    ``before`` are the tokens of its member before it. ``previous`` and ``following`` are the tokens
    beside it, empty at the ends of the text.
    """

    tokens: Tokens
    position: int
    symbol: str
    before: list[str]
    previous: str
    following: str
    expected: Collection[str]


def _find_spot(tokens: Tokens, index: int, expected: Collection[str]) -> Spot:
    previous = tokens[index - 1] if index else ""
    following = "".join(list_next_tokens(tokens, index)[:1])
    before = list_member_before(tokens, index)
    return Spot(tokens, index, tokens[index], before, previous, following, expected)


Hint = Callable[[Spot], str]
"""Returns advice about a token that does not fit, or an empty string."""


def advise_unexpected(
    tokens: Tokens, index: int, expected: Collection[str], beginnings: Collection[str]
) -> str:
    """Return advice about token ``index``, in place of which ``expected`` are valid, or nothing.

    ``beginnings`` are the words with which members of a body begin.
    """
    spot = _find_spot(tokens, index, expected)
    advice = _first_advice(_SLIPS, spot)
    if advice:
        return advice
    # The words of another language are names, and the first word of a member explains more.
    return (
        _TOKENS.get(spot.symbol, "")
        or ("" if spot.symbol.isalpha() else _first_advice(_FOREIGN, spot))
        or _advise_first_word(tokens, index - 1, beginnings)
        or _first_advice(_FOREIGN, spot)
    )


def advise_missing(tokens: Tokens, before: int, index: int, beginnings: Collection[str]) -> str:
    """Return advice about token ``index`` after a member that seems to end at token ``before``."""
    spot = _find_spot(tokens, index, ())
    word, kind = spot.symbol, tokens[before]
    advice = _advise_import(spot) or _advise_ends(spot)
    # A direction behind the kind of a feature: ``port in p``.
    if not advice and word in DIRECTIONS and kind in beginnings and kind.isalpha():
        return f"write the direction before the kind: {word} {kind} ..."
    return advice or _advise_first_word(tokens, before, beginnings)


def _first_advice(hints: tuple[Hint, ...], spot: Spot) -> str:
    texts = (hint(spot) for hint in hints)
    return next((text for text in texts if text), "")


def _advise_first_word(tokens: Tokens, index: int, beginnings: Collection[str]) -> str:
    """Return the keyword that may be meant by the first word of a member that is not a keyword."""
    word = tokens[index] if index >= 0 else ""
    is_first = index == 0 or tokens[index - 1] in _SEPARATORS
    if not is_first or not word.isidentifier() or word in beginnings:
        return ""
    if word in _FIRST_WORDS:
        return _explain_first_word(word)
    similar = list_similar_keywords(word, beginnings)
    return f"'{word}' is not a keyword: did you mean '{similar[0]}'?" if similar else ""


def list_similar_keywords(word: str, keywords: Collection[str]) -> list[str]:
    """Return the keywords that *word* may misspell, most similar first."""
    # The comparison takes quadratic time, and a hostile text may have words of megabytes.
    if not _MIN_MISSPELT_LENGTH <= len(word) <= _MAX_MISSPELT_LENGTH:
        return []
    # A word that begins declarations in another language is not misspelt.
    if word in _FIRST_WORDS or find_type(word):
        return []
    candidates = sorted(keyword for keyword in keywords if keyword.isalpha())
    ratios = {
        keyword: SequenceMatcher(None, word.casefold(), keyword).ratio() for keyword in candidates
    }
    similar = [keyword for keyword in candidates if ratios[keyword] >= _MIN_SIMILARITY]
    # Exchanged letters are the commonest slip: 'prat' is 'part' and not 'port'.
    return sorted(similar, key=lambda key: (sorted(key) != sorted(word), -ratios[key]))


@cache
def _read_types() -> dict[str, str]:
    rows = (row.split(": ") for row in _TYPES.strip().splitlines())
    return {word: type_.strip() for type_, words in rows for word in words.split()}


def find_type(name: str) -> str:
    """Return the qualified name of the type that another language calls *name*, or nothing."""
    return _read_types().get(name.casefold(), "")


def translate_first_word(word: str, name: str) -> tuple[str | None, str]:
    """Return the keywords for a word of another language before a declared name, and advice.

    The keywords are None if no such word is known, or if the rest of the member must change, too.
    """
    if word in _FIRST_WORDS:
        return _FIRST_WORDS[word][0], _explain_first_word(word)
    type_ = find_type(word)
    advice = f"write the kind first and the type after ':', such as attribute {name} : {type_};"
    return ("attribute", advice) if type_ else (None, "")


def _explain_first_word(word: str) -> str:
    return f"'{word}' is not a keyword: {_FIRST_WORDS[word][1]}"


def list_member_before(tokens: Tokens, index: int) -> list[str]:
    """Return the tokens before ``index`` that belong to the same member."""
    start = index
    while start > 0 and tokens[start - 1] not in _SEPARATORS:
        start -= 1
    return [tokens[position] for position in range(start, index)]


def list_next_tokens(tokens: Tokens, index: int) -> list[str]:
    """Return up to two tokens after ``index``."""
    return [tokens[position] for position in range(index + 1, min(index + 3, len(tokens.types)))]


def _advise_if(applies: Callable[[Spot], bool], advice: str) -> Hint:
    """Return a hint that has one text."""
    return lambda at: advice if applies(at) else ""


# -- slips in SysML ------------------------------------------------------------------------------


def _advise_unit(at: Spot) -> str:
    """Advise about a name behind a number: the author probably means a unit, ``5 [kg]``."""
    unit, number = at.symbol, at.previous
    if not number[:1].isdigit() or not unit.isidentifier() or unit in RESERVED:
        return ""
    if unit in _OPERATORS:
        return f"write '{_OPERATORS[unit]}' for '{unit}'"
    # Integers of other languages: 0x1F, 1_000.
    if unit[0] == "_" or number == "0":
        return "write the number in decimal digits only: 31 for 0x1F, 1000 for 1_000"
    return f"units stand in brackets: {number} [{unit}]"


def _advise_parameters(at: Spot) -> str:
    """Advise about a list in parentheses behind a declared name."""
    if at.symbol == "(" and {";", "{"} <= set(at.expected):
        following = list_next_tokens(at.tokens, at.position)
        names = [word for word in following if word not in DIRECTIONS]
        return _PARAMETERS.format(names[0] if names and names[0].isidentifier() else "x")
    is_list = at.symbol in (")", ",", ":") and at.before[2:3] == ["("] and "," in at.expected
    return _PARAMETERS.format(at.before[3]) if is_list and len(at.before) > 3 else ""


def _advise_multiplicity(at: Spot) -> str:
    if at.symbol != "[" or _END_TOKENS.isdisjoint(at.expected):
        return ""
    if "if" in at.expected and "transition" in at.before:
        return "a guard is written with 'if': transition first a if x > 0 then b"
    return "write the multiplicity before the end: [0..1] a"


def _advise_import(at: Spot) -> str:
    if at.symbol == "import" and at.before[:1] == ["from"]:
        return f"write 'private import {'::'.join(at.before[1::2])}::{at.following};'"
    if "import" not in at.before:
        return ""
    if at.symbol == ".":
        return "names of packages are joined by '::'"
    return f"another name is an alias: alias {at.following} for ...;" if at.symbol == "as" else ""


def _advise_ends(at: Spot) -> str:
    """Advise about the ends of a succession or transition."""
    source = at.before[-1] if at.before else "a"
    if at.symbol == "then" and at.before[-2:-1] == ["succession"]:
        return f"write 'first' before the source: succession first {source} then ..."
    if at.symbol in ("from", "to") and "transition" in at.before:
        source = source if at.symbol == "to" else "a"
        return f"a transition names its source and target: transition first {source} then ..."
    return ""


def _advise_quotes(at: Spot) -> str:
    """Advise about a declared name with a hyphen or a leading digit: ``part def my-part``."""
    name = ""
    if at.symbol == "-" and at.previous.isidentifier() and at.following.isalnum():
        name = f"{at.previous}-{at.following}"
    elif at.symbol[:1].isdigit() and at.following.isidentifier() and at.previous == "def":
        name = f"{at.symbol}{at.following}"
    return name and f"put the name in single quotes, here and wherever it is used: '{name}'"


def _advise_then(at: Spot) -> str:
    if at.symbol == "then" and "if" in at.before:
        return "a conditional expression has a question mark: if a ? b else c"
    is_implication = at.before[:1] == ["if"] and "then" in at.before and at.symbol in _COMPARISONS
    return "a condition under a condition is written: a implies b" if is_implication else ""


def _advise_sum(at: Spot) -> str:
    """Advise about an assignment that changes a value: ``n += 1``."""
    before = at.before
    if before[:1] == ["assign"] and at.following == "=":
        return f"write the new value: {before[-1]} := {before[-1]} {at.symbol} ..."
    name, operator = "".join(before[:-1]), "".join(before[-1:])
    if at.symbol == "=" and operator in ("+", "-", "*", "/") and before[0].isidentifier():
        return f"write the new value: assign {name} := {name} {operator} ...;"
    if at.symbol in (";", "}") and before[1:] in (["+", "+"], ["-", "-"]):
        return f"write the new value: assign {before[0]} := {before[0]} {operator} 1;"
    return ""


def _advise_call(at: Spot) -> str:
    """Advise about a call as a statement: ``Drill();``."""
    is_call = at.symbol == ";" and list(at.expected) == ["}"] and at.before[1:2] == ["("]
    return f"an action is performed by a usage: action x : {at.before[0]};" if is_call else ""


def _advise_values(at: Spot) -> str:
    """Advise about decimals and lists: ``3,5``, ``3.``, ``[1, 2]``, ``{1, 2}``."""
    before, following = at.before, at.following
    head = list_member_before(at.tokens, max(at.position - len(before) - 1, 0))
    is_list = at.symbol == "," and head[-1:] == ["="]
    if is_list or (at.symbol == "[" and "null" in at.expected):
        return "a list of values stands in parentheses: (1, 2, 3)"
    if at.symbol == "," and before[-2:-1] == ["="] and (before[-1] + following).isdigit():
        return f"a decimal number has a point: {before[-1]}.{following}"
    if before[-1:] == ["."] and before[-2:][0].isdigit():
        return f"a digit follows the point: {before[-2]}.0"
    return ""


def _advise_bounds(at: Spot) -> str:
    """Advise about multiplicities: ``a[3..]``, ``part[3] a``."""
    before = at.before
    if at.symbol == "]" and before[-1:] == [".."]:
        return f"no upper bound is written '*': [{before[-2]}..*]"
    if before[1:2] != ["["] or before[0] not in RESERVED or "]" not in before[:-1]:
        return ""
    return f"the multiplicity follows the name: {before[0]} {before[-1]}{''.join(before[1:-1])}"


def _advise_relation(at: Spot) -> str:
    """Advise about ``alias B = A``, ``alias A as B``, ``bind a b`` and ``a --> b``."""
    if at.before[:1] == ["alias"] and at.symbol in ("=", "as"):
        names = at.before[-1], at.following
        new, old = names if at.symbol == "=" else names[::-1]
        return f"write 'alias {new} for {old};'"
    if at.before[:1] == ["bind"] and at.symbol.isidentifier():
        return f"write '=' between both: bind {''.join(at.before[1:])} = {at.symbol};"
    return ARROW if at.symbol == "->" and at.before[-1:] == ["-"] else ""


def _advise_name(at: Spot) -> str:
    """Advise about a name in double quotes: ``part def "My part"``."""
    is_name = at.symbol.startswith('"') and "NAME" in at.expected and "BODY" not in at.expected
    return f"a name stands in single quotes: '{at.symbol[1:-1]}'" if is_name else ""


def _advise_package(at: Spot) -> str:
    if at.symbol != "." or "package" not in at.before:
        return ""
    package = at.before[-1]
    return f"a package in another one is a member of its body: package {package} {{ package ..."


def _advise_type_first(at: Spot) -> str:
    """Advise about a type before a name, as programming languages write it: ``Tank t;``."""
    type_, name = "".join(at.before), at.symbol
    is_pair = len(at.before) == 1 and type_.isidentifier() and name.isidentifier()
    if not is_pair or type_ in _FIRST_WORDS or type_[:1].islower():
        return ""
    return f"write the kind first and the type after ':', such as part {name} : {type_};"


_SLIPS: tuple[Hint, ...] = (
    _advise_unit,
    _advise_parameters,
    _advise_multiplicity,
    _advise_import,
    _advise_ends,
    _advise_if(
        lambda at: at.before[:1] == ["return"], "'return' declares the result: return r = ...;"
    ),
    _advise_if(
        lambda at: at.before[:1] == ["assert"],
        "write the asserted condition in braces: assert constraint { x > 0 }",
    ),
    # SysML v1 writes an effect in this way.
    _advise_if(
        lambda at: at.symbol == "/" and "accept" in at.before,
        "an effect is written with 'do': accept e do action x then b",
    ),
    _advise_quotes,
    _advise_if(
        lambda at: at.symbol == "%" and at.previous == "[", "a ratio is a number: 0.2 for 20 %"
    ),
    _advise_then,
    _advise_call,
    _advise_if(
        lambda at: at.symbol == "(" and at.previous == "for",
        "a loop runs over a sequence: for i in 1..3 { ... }",
    ),
    _advise_sum,
    _advise_values,
    _advise_bounds,
    _advise_relation,
    _advise_if(
        lambda at: at.symbol == "{" and at.previous == ";", "take away the ';' before the body"
    ),
    _advise_if(
        lambda at: at.symbol == ";" and at.before[:1] == ["if"] and "{" in at.expected,
        "the steps stand in braces: if x > 0 { ... }",
    ),
    _advise_name,
    _advise_package,
    _advise_if(lambda at: at.symbol == ":" and at.previous == "=", INITIAL),
    _advise_type_first,
)


# -- symbols and words of other languages --------------------------------------------------------


def _advise_doubled_operator(at: Spot) -> str:
    """Advise about ``&&`` and ``||``, which are two tokens each."""
    is_doubled = at.previous == at.symbol and at.symbol in _DOUBLED_OPERATORS
    return f"conditions are joined by {_DOUBLED_OPERATORS[at.symbol]}" if is_doubled else ""


def _advise_spelling(at: Spot) -> str:
    word = at.symbol
    if len(word) < _MIN_KEYWORD_LENGTH or not word.isalpha():
        return ""
    keywords = [keyword for keyword in at.expected if len(keyword) >= _MIN_KEYWORD_LENGTH]
    suggestion = did_you_mean(word, keywords)
    return suggestion if suggestion.startswith("did") and word not in suggestion else ""


_FOREIGN: tuple[Hint, ...] = (
    _advise_doubled_operator,
    _advise_if(
        lambda at: at.symbol == "=" and "==" in at.expected and "=" not in at.expected, COMPARISON
    ),
    _advise_if(
        lambda at: at.symbol == "?" and "?" not in at.expected,
        "a conditional expression starts with 'if': if a ? b else c",
    ),
    _advise_if(
        lambda at: at.symbol == ";" and list(at.expected) == ["}"],
        "the result is an expression without ';' at the end of the body",
    ),
    _advise_if(
        lambda at: at.symbol.startswith('"') and "BODY" in at.expected,
        "write the text between /* and */",
    ),
    _advise_if(lambda at: at.symbol in ARROWS and "to" in at.expected, JOINED_BY_TO),
    _advise_spelling,
)
