"""Advice about a token that does not fit: common slips, words of drafts and of other languages."""

from collections.abc import Callable, Collection
from difflib import SequenceMatcher
from functools import cache

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

Hint = Callable[[Tokens, int, Collection[str]], str]
"""Returns advice about a token in whose place only other tokens are valid, or an empty string."""


def advise_unexpected(
    tokens: Tokens, index: int, expected: Collection[str], beginnings: Collection[str]
) -> str:
    """Return advice about token ``index``, in place of which ``expected`` are valid, or nothing.

    ``beginnings`` are the words with which members of a body begin.
    """
    advice = _first_advice(_SLIPS, tokens, index, expected)
    if advice:
        return advice
    # The words of another language are names, and the first word of a member explains more.
    is_symbol = not tokens[index].isalpha()
    return (
        _TOKENS.get(tokens[index], "")
        or (_first_advice(_FOREIGN, tokens, index, expected) if is_symbol else "")
        or _advise_first_word(tokens, index - 1, beginnings)
        or _first_advice(_FOREIGN, tokens, index, expected)
    )


def advise_missing(tokens: Tokens, before: int, index: int, beginnings: Collection[str]) -> str:
    """Return advice about token ``index`` after a member that seems to end at token ``before``."""
    return (
        _advise_import(tokens, index, ())
        or _advise_ends(tokens, index, ())
        or _advise_direction(tokens, before, index, beginnings)
        or _advise_first_word(tokens, before, beginnings)
    )


def _first_advice(
    hints: tuple[Hint, ...], tokens: Tokens, index: int, expected: Collection[str]
) -> str:
    texts = (hint(tokens, index, expected) for hint in hints)
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
    if not _MIN_MISSPELT_LENGTH <= len(word) <= _MAX_MISSPELT_LENGTH or _is_foreign(word):
        return []
    candidates = sorted(keyword for keyword in keywords if keyword.isalpha())
    ratios = {
        keyword: SequenceMatcher(None, word.casefold(), keyword).ratio() for keyword in candidates
    }
    similar = [keyword for keyword in candidates if ratios[keyword] >= _MIN_SIMILARITY]
    # Exchanged letters are the commonest slip: 'prat' is 'part' and not 'port'.
    return sorted(similar, key=lambda key: (sorted(key) != sorted(word), -ratios[key]))


def _is_foreign(word: str) -> bool:
    """Whether a word begins declarations in another language."""
    return word in _FIRST_WORDS or bool(find_type(word))


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


def _advise_direction(tokens: Tokens, before: int, index: int, beginnings: Collection[str]) -> str:
    """Advise about a direction behind the kind of a feature: ``port in p``."""
    word, kind = tokens[index], tokens[before]
    if word not in DIRECTIONS or kind not in beginnings or not kind.isalpha():
        return ""
    return f"write the direction before the kind: {word} {kind} ..."


def list_member_before(tokens: Tokens, index: int) -> list[str]:
    """Return the tokens before ``index`` that belong to the same member."""
    start = index
    while start > 0 and tokens[start - 1] not in _SEPARATORS:
        start -= 1
    return [tokens[position] for position in range(start, index)]


def list_next_tokens(tokens: Tokens, index: int) -> list[str]:
    """Return up to two tokens after ``index``."""
    return [tokens[position] for position in range(index + 1, min(index + 3, len(tokens.types)))]


# -- slips in SysML ------------------------------------------------------------------------------


def _advise_unit(tokens: Tokens, index: int, _expected: Collection[str]) -> str:
    """Advise about a name behind a number: the author probably means a unit, ``5 [kg]``."""
    unit, number = tokens[index], tokens[index - 1] if index else ""
    if not number[:1].isdigit() or not unit.isidentifier() or unit in RESERVED:
        return ""
    if unit in _OPERATORS:
        return f"write '{_OPERATORS[unit]}' for '{unit}'"
    # Integers of other languages: 0x1F, 1_000.
    if unit[0] == "_" or number == "0":
        return "write the number in decimal digits only: 31 for 0x1F, 1000 for 1_000"
    return f"units stand in brackets: {number} [{unit}]"


def _advise_parameters(tokens: Tokens, index: int, expected: Collection[str]) -> str:
    """Advise about a list in parentheses behind a declared name."""
    before = list_member_before(tokens, index)
    if tokens[index] == "(" and {";", "{"} <= set(expected):
        names = [word for word in list_next_tokens(tokens, index) if word not in DIRECTIONS]
        return _PARAMETERS.format(names[0] if names and names[0].isidentifier() else "x")
    is_list = tokens[index] in (")", ",", ":") and before[2:3] == ["("] and "," in expected
    return _PARAMETERS.format(before[3]) if is_list and len(before) > 3 else ""


def _advise_multiplicity(tokens: Tokens, index: int, expected: Collection[str]) -> str:
    if tokens[index] != "[" or _END_TOKENS.isdisjoint(expected):
        return ""
    if "if" in expected and "transition" in list_member_before(tokens, index):
        return "a guard is written with 'if': transition first a if x > 0 then b"
    return "write the multiplicity before the end: [0..1] a"


def _advise_import(tokens: Tokens, index: int, _expected: Collection[str]) -> str:
    before = list_member_before(tokens, index)
    if tokens[index] == "import" and before[:1] == ["from"]:
        name = "".join(list_next_tokens(tokens, index)[:1])
        return f"write 'private import {'::'.join(before[1::2])}::{name};'"
    if "import" not in before:
        return ""
    if tokens[index] == ".":
        return "names of packages are joined by '::'"
    name = "".join(list_next_tokens(tokens, index)[:1])
    return f"another name is an alias: alias {name} for ...;" if tokens[index] == "as" else ""


def _advise_ends(tokens: Tokens, index: int, _expected: Collection[str]) -> str:
    """Advise about the ends of a succession or transition."""
    before = list_member_before(tokens, index)
    source = before[-1] if before else "a"
    if tokens[index] == "then" and before[-2:-1] == ["succession"]:
        return f"write 'first' before the source: succession first {source} then ..."
    if tokens[index] in ("from", "to") and "transition" in before:
        source = source if tokens[index] == "to" else "a"
        return f"a transition names its source and target: transition first {source} then ..."
    return ""


def _advise_condition(tokens: Tokens, index: int, _expected: Collection[str]) -> str:
    is_condition = list_member_before(tokens, index)[:1] == ["assert"]
    return (
        "write the asserted condition in braces: assert constraint { x > 0 }"
        if is_condition
        else ""
    )


def _advise_result(tokens: Tokens, index: int, _expected: Collection[str]) -> str:
    """Advise about ``return`` with an expression: it declares the result."""
    is_value = list_member_before(tokens, index)[:1] == ["return"]
    return "'return' declares the result: return r = ...;" if is_value else ""


def _advise_effect(tokens: Tokens, index: int, _expected: Collection[str]) -> str:
    """Advise about ``/`` before the effect of a transition, as SysML v1 writes it."""
    is_effect = tokens[index] == "/" and "accept" in list_member_before(tokens, index)
    return "an effect is written with 'do': accept e do action x then b" if is_effect else ""


def _advise_quotes(tokens: Tokens, index: int, _expected: Collection[str]) -> str:
    """Advise about a declared name with a hyphen or a leading digit: ``part def my-part``."""
    before, after = tokens[index - 1] if index else "", "".join(list_next_tokens(tokens, index)[:1])
    is_hyphen = tokens[index] == "-" and before.isidentifier() and after.isalnum()
    is_digit = tokens[index][:1].isdigit() and after.isidentifier() and before == "def"
    name = f"{before}-{after}" if is_hyphen else f"{tokens[index]}{after}"
    is_name = is_hyphen or is_digit
    return (
        f"put the name in single quotes, here and wherever it is used: '{name}'" if is_name else ""
    )


def _advise_then(tokens: Tokens, index: int, _expected: Collection[str]) -> str:
    before = list_member_before(tokens, index)
    if tokens[index] == "then" and "if" in before:
        return "a conditional expression has a question mark: if a ? b else c"
    is_implication = before[:1] == ["if"] and "then" in before and tokens[index] in _COMPARISONS
    return "a condition under a condition is written: a implies b" if is_implication else ""


def _advise_call(tokens: Tokens, index: int, expected: Collection[str]) -> str:
    """Advise about a call as a statement: ``Drill();``."""
    before = list_member_before(tokens, index)
    is_call = tokens[index] == ";" and list(expected) == ["}"] and before[1:2] == ["("]
    return f"an action is performed by a usage: action x : {before[0]};" if is_call else ""


def _advise_loop(tokens: Tokens, index: int, _expected: Collection[str]) -> str:
    is_loop = index > 0 and tokens[index] == "(" and tokens[index - 1] == "for"
    return "a loop runs over a sequence: for i in 1..3 { ... }" if is_loop else ""


def _advise_sum(tokens: Tokens, index: int, _expected: Collection[str]) -> str:
    """Advise about an assignment that changes a value: ``n += 1``."""
    before = list_member_before(tokens, index)
    if before[:1] == ["assign"] and list_next_tokens(tokens, index)[:1] == ["="]:
        return f"write the new value: {before[-1]} := {before[-1]} {tokens[index]} ..."
    name, operator = "".join(before[:-1]), "".join(before[-1:])
    if tokens[index] == "=" and operator in ("+", "-", "*", "/") and before[0].isidentifier():
        return f"write the new value: assign {name} := {name} {operator} ...;"
    if tokens[index] in (";", "}") and before[1:] in (["+", "+"], ["-", "-"]):
        return f"write the new value: assign {before[0]} := {before[0]} {operator} 1;"
    return ""


def _advise_values(tokens: Tokens, index: int, expected: Collection[str]) -> str:
    """Advise about decimals and lists: ``3,5``, ``3.``, ``[1, 2]``, ``{1, 2}``."""
    before = list_member_before(tokens, index)
    following = "".join(list_next_tokens(tokens, index)[:1])
    head = list_member_before(tokens, max(index - len(before) - 1, 0))
    is_list = tokens[index] == "," and head[-1:] == ["="]
    if is_list or (tokens[index] == "[" and "null" in expected):
        return "a list of values stands in parentheses: (1, 2, 3)"
    if tokens[index] == "," and before[-2:-1] == ["="] and (before[-1] + following).isdigit():
        return f"a decimal number has a point: {before[-1]}.{following}"
    if before[-1:] == ["."] and before[-2:][0].isdigit():
        return f"a digit follows the point: {before[-2]}.0"
    return ""


def _advise_bounds(tokens: Tokens, index: int, _expected: Collection[str]) -> str:
    """Advise about multiplicities: ``a[3..]``, ``part[3] a``."""
    before = list_member_before(tokens, index)
    if tokens[index] == "]" and before[-1:] == [".."]:
        return f"no upper bound is written '*': [{before[-2]}..*]"
    is_early = before[1:2] == ["["] and before[0] in RESERVED and "]" in before[:-1]
    name = before[-1] if before else ""
    bounds = "".join(before[1:-1])
    return f"the multiplicity follows the name: {before[0]} {name}{bounds}" if is_early else ""


def _advise_relation(tokens: Tokens, index: int, _expected: Collection[str]) -> str:
    """Advise about ``alias B = A``, ``alias A as B``, ``bind a b`` and ``a --> b``."""
    before, symbol = list_member_before(tokens, index), tokens[index]
    following = "".join(list_next_tokens(tokens, index)[:1])
    if before[:1] == ["alias"] and symbol in ("=", "as"):
        names = (before[-1], following) if symbol == "=" else (following, before[-1])
        return f"write 'alias {names[0]} for {names[1]};'"
    if before[:1] == ["bind"] and symbol.isidentifier():
        return f"write '=' between both: bind {''.join(before[1:])} = {symbol};"
    return ARROW if symbol == "->" and before[-1:] == ["-"] else ""


def _advise_body(tokens: Tokens, index: int, expected: Collection[str]) -> str:
    """Advise about ``if x action a;`` and ``package A; { ... }``."""
    if tokens[index] == "{" and index and tokens[index - 1] == ";":
        return "take away the ';' before the body"
    is_step = tokens[index] == ";" and list_member_before(tokens, index)[:1] == ["if"]
    return "the steps stand in braces: if x > 0 { ... }" if is_step and "{" in expected else ""


def _advise_name(tokens: Tokens, index: int, expected: Collection[str]) -> str:
    """Advise about a name in double quotes: ``part def "My part"``."""
    is_name = tokens[index].startswith('"') and "NAME" in expected and "BODY" not in expected
    return f"a name stands in single quotes: '{tokens[index][1:-1]}'" if is_name else ""


def _advise_package(tokens: Tokens, index: int, _expected: Collection[str]) -> str:
    before = list_member_before(tokens, index)
    is_path = tokens[index] == "." and "package" in before
    return (
        f"a package in another one is a member of its body: package {before[-1]} {{ package ..."
        if is_path
        else ""
    )


def _advise_percent(tokens: Tokens, index: int, _expected: Collection[str]) -> str:
    is_unit = tokens[index] == "%" and index > 0 and tokens[index - 1] == "["
    return "a ratio is a number: 0.2 for 20 %" if is_unit else ""


def _advise_initial(tokens: Tokens, index: int, _expected: Collection[str]) -> str:
    return INITIAL if index and tokens[index] == ":" and tokens[index - 1] == "=" else ""


def _advise_type_first(tokens: Tokens, index: int, _expected: Collection[str]) -> str:
    """Advise about a type before a name, as programming languages write it: ``Tank t;``."""
    before, name = list_member_before(tokens, index), tokens[index]
    is_pair = len(before) == 1 and before[0].isidentifier() and name.isidentifier()
    if not is_pair or before[0] in _FIRST_WORDS or before[0][:1].islower():
        return ""
    return f"write the kind first and the type after ':', such as part {name} : {before[0]};"


_SLIPS: tuple[Hint, ...] = (
    _advise_unit,
    _advise_parameters,
    _advise_multiplicity,
    _advise_import,
    _advise_ends,
    _advise_result,
    _advise_condition,
    _advise_effect,
    _advise_quotes,
    _advise_percent,
    _advise_then,
    _advise_call,
    _advise_loop,
    _advise_sum,
    _advise_values,
    _advise_bounds,
    _advise_relation,
    _advise_body,
    _advise_name,
    _advise_package,
    _advise_initial,
    _advise_type_first,
)


# -- symbols and words of other languages --------------------------------------------------------


def _advise_doubled_operator(tokens: Tokens, index: int, _expected: Collection[str]) -> str:
    """Advise about ``&&`` and ``||``, which are two tokens each."""
    symbol = tokens[index]
    is_doubled = index > 0 and tokens[index - 1] == symbol and symbol in _DOUBLED_OPERATORS
    return f"conditions are joined by {_DOUBLED_OPERATORS[symbol]}" if is_doubled else ""


def _advise_comparison(tokens: Tokens, index: int, expected: Collection[str]) -> str:
    is_binding = tokens[index] == "=" and "==" in expected and "=" not in expected
    return COMPARISON if is_binding else ""


def _advise_conditional(tokens: Tokens, index: int, expected: Collection[str]) -> str:
    is_question = tokens[index] == "?" and "?" not in expected
    return "a conditional expression starts with 'if': if a ? b else c" if is_question else ""


def _advise_result_end(tokens: Tokens, index: int, expected: Collection[str]) -> str:
    """Advise about a `;` behind the expression that is the result of a body."""
    is_result = tokens[index] == ";" and list(expected) == ["}"]
    return "the result is an expression without ';' at the end of the body" if is_result else ""


def _advise_comment(tokens: Tokens, index: int, expected: Collection[str]) -> str:
    is_text = tokens[index].startswith('"') and "BODY" in expected
    return "write the text between /* and */" if is_text else ""


def _advise_connection(tokens: Tokens, index: int, expected: Collection[str]) -> str:
    is_arrow = tokens[index] in ARROWS and "to" in expected
    return JOINED_BY_TO if is_arrow else ""


def _advise_spelling(tokens: Tokens, index: int, expected: Collection[str]) -> str:
    word = tokens[index]
    if len(word) < _MIN_KEYWORD_LENGTH or not word.isalpha():
        return ""
    keywords = [keyword for keyword in expected if len(keyword) >= _MIN_KEYWORD_LENGTH]
    suggestion = did_you_mean(word, keywords)
    return suggestion if suggestion.startswith("did") and word not in suggestion else ""


_FOREIGN: tuple[Hint, ...] = (
    _advise_doubled_operator,
    _advise_comparison,
    _advise_conditional,
    _advise_result_end,
    _advise_comment,
    _advise_connection,
    _advise_spelling,
)
