"""Advice about a token that does not fit: common slips, words of drafts and of other languages."""

from collections.abc import Callable, Collection, Iterator
from difflib import SequenceMatcher
from typing import NamedTuple

from sysmlc.language.text.lexer import Tokens
from sysmlc.language.text.spelling import RESERVED
from sysmlc.support.suggestions import did_you_mean

INITIAL = "':=' gives an initial value, '=' binds for good, 'default' may be overridden"
_PARAMETERS = "parameters are members of the body: {{ in {0}; }}"
_TOKENS = {
    "import": "write the import in a body: private import A::*;",
    ":=": INITIAL,
    ",": "members end with ';', they are not separated by commas",
    "extends": "write ':>' or 'specializes' before a general type",
    "is": "write ':>' or 'specializes' before a general type, and ':' before the type of a usage",
    "with": "ends of a connection are joined by 'to': connect a to b",
    "when": "write 'accept when c' for a change, 'if c' for a guard, both before 'then'",
}
"""Advice about a token, wherever it stands."""
_FIRST_WORDS = {
    "activity": "'action' is meant",
    "assoc": "in SysML an association is a 'connection def'",
    "behavior": "in SysML a behaviour is an 'action def'",
    "block": "a block is a 'part def'",
    "class": "in SysML a class is a 'part def', 'item def' or 'attribute def'",
    "component": "'part' is meant",
    "datatype": "in SysML a type of values is an 'attribute def'",
    "decision": "'decide' is meant",
    "elif": "'else if' is meant",
    "elseif": "'else if' is meant",
    "enumeration": "'enum def' is meant",
    "feature": "in SysML a feature is a 'ref', 'attribute', 'part' or 'item'",
    "func": "'calc' is meant",
    "function": "in SysML a function is a 'calc def'",
    "id": "write the short name after the keyword: requirement <'R5'> name",
    "link": "'connection' is meant",
    "operation": "'action' is meant",
    "property": "'attribute', 'part' or 'ref' is meant",
    "readonly": "what never changes is 'constant', in KerML 'const'",
    "predicate": "in SysML a predicate is a 'constraint def'",
    "signal": "declare a signal as 'item def' or 'attribute def'",
    "stream": "'flow' is meant: flow from a.x to b.y",
    "struct": "in SysML a structure is a 'part def' or 'item def'",
    "usecase": "'use case' is meant",
    "value": "'attribute' is meant",
    "var": "'attribute' is meant",
    "valuetype": "a type of values is an 'attribute def'",
}
"""Advice about a word that begins a member and is no keyword."""
_END_TOKENS = frozenset({"to", "then", "="})
_DIRECTIONS = frozenset({"in", "out", "inout"})
_SEPARATORS = ("", ";", "{", "}")
_MIN_KEYWORD_LENGTH = 5
"""Length of the shortest word that is taken for a misspelt keyword; shorter ones are names."""
_MIN_MISSPELT_LENGTH = 3
_MAX_MISSPELT_LENGTH = 30
_MIN_SIMILARITY = 0.7
"""Ratio of ``difflib`` from which the first word of a member counts as a misspelt keyword."""
_DOUBLED_OPERATORS = {"&": "'and'", "|": "'or'"}
_ARROWS = ("-", "->", "=>", "~", ",")
_CONDITION_HEADS = frozenset({"constraint", "assert", "assume", "require"})
_ORDER_HEADS = frozenset({"first", "succession", "transition"})
_PAIR_HEADS = frozenset({"connect", "connection", "flow", "interface", "message"})
ARROW = "an order is written 'first a then b;', a transition 'transition first a then b;'"
_JOINED_BY_TO = "ends are joined by 'to': a to b"
_COMPARISON = "'==' compares two values, '=' binds one"
_MAX_HEAD = 200
"""Tokens before a member in which the head of its body is searched for."""

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
        return f"'{word}' is not a keyword: {_FIRST_WORDS[word]}"
    similar = list_similar_keywords(word, beginnings)
    return f"'{word}' is not a keyword: did you mean '{similar[0]}'?" if similar else ""


def list_similar_keywords(word: str, keywords: Collection[str]) -> list[str]:
    """Return the keywords that *word* may misspell, most similar first."""
    # The comparison takes quadratic time, and a hostile text may have words of megabytes.
    if not _MIN_MISSPELT_LENGTH <= len(word) <= _MAX_MISSPELT_LENGTH or word in _FIRST_WORDS:
        return []
    candidates = sorted(keyword for keyword in keywords if keyword.isalpha())
    ratios = {
        keyword: SequenceMatcher(None, word.casefold(), keyword).ratio() for keyword in candidates
    }
    similar = [keyword for keyword in candidates if ratios[keyword] >= _MIN_SIMILARITY]
    # Exchanged letters are the commonest slip: 'prat' is 'part' and not 'port'.
    return sorted(similar, key=lambda key: (sorted(key) != sorted(word), -ratios[key]))


def _advise_direction(tokens: Tokens, before: int, index: int, beginnings: Collection[str]) -> str:
    """Advise about a direction behind the kind of a feature: ``port in p``."""
    word, kind = tokens[index], tokens[before]
    if word not in _DIRECTIONS or kind not in beginnings or not kind.isalpha():
        return ""
    return f"write the direction before the kind: {word} {kind} ..."


def _member_before(tokens: Tokens, index: int) -> list[str]:
    """Return the tokens before ``index`` that belong to the same member."""
    start = index
    while start > 0 and tokens[start - 1] not in _SEPARATORS:
        start -= 1
    return [tokens[position] for position in range(start, index)]


def _next_tokens(tokens: Tokens, index: int) -> list[str]:
    """Return up to two tokens after ``index``."""
    return [tokens[position] for position in range(index + 1, min(index + 3, len(tokens.types)))]


# -- slips in SysML ------------------------------------------------------------------------------


def _advise_unit(tokens: Tokens, index: int, _expected: Collection[str]) -> str:
    """Advise about a name behind a number: the author probably means a unit, ``5 [kg]``."""
    unit, number = tokens[index], tokens[index - 1] if index else ""
    is_unit = number[:1].isdigit() and unit[:1].isalpha() and unit not in RESERVED
    return f"units stand in brackets: {number} [{unit}]" if is_unit else ""


def _advise_parameters(tokens: Tokens, index: int, expected: Collection[str]) -> str:
    """Advise about a list in parentheses behind a declared name."""
    before = _member_before(tokens, index)
    if tokens[index] == "(" and {";", "{"} <= set(expected):
        names = [word for word in _next_tokens(tokens, index) if word not in _DIRECTIONS]
        return _PARAMETERS.format(names[0] if names and names[0].isidentifier() else "x")
    is_list = tokens[index] in (")", ",", ":") and before[2:3] == ["("] and "," in expected
    return _PARAMETERS.format(before[3]) if is_list and len(before) > 3 else ""


def _advise_multiplicity(tokens: Tokens, index: int, expected: Collection[str]) -> str:
    if tokens[index] != "[" or _END_TOKENS.isdisjoint(expected):
        return ""
    if "if" in expected and "transition" in _member_before(tokens, index):
        return "a guard is written with 'if': transition first a if x > 0 then b"
    return "write the multiplicity before the end: [0..1] a"


def _advise_import(tokens: Tokens, index: int, _expected: Collection[str]) -> str:
    if "import" not in _member_before(tokens, index):
        return ""
    if tokens[index] == ".":
        return "names of packages are joined by '::'"
    name = "".join(_next_tokens(tokens, index)[:1])
    return f"another name is an alias: alias {name} for ...;" if tokens[index] == "as" else ""


def _advise_ends(tokens: Tokens, index: int, _expected: Collection[str]) -> str:
    """Advise about the ends of a succession or transition."""
    before = _member_before(tokens, index)
    source = before[-1] if before else "a"
    if tokens[index] == "then" and before[-2:-1] == ["succession"]:
        return f"write 'first' before the source: succession first {source} then ..."
    if tokens[index] == "to" and "transition" in before:
        return f"a transition names its source and target: transition first {source} then ..."
    return ""


def _advise_condition(tokens: Tokens, index: int, _expected: Collection[str]) -> str:
    is_condition = _member_before(tokens, index)[:1] == ["assert"]
    return (
        "write the asserted condition in braces: assert constraint { x > 0 }"
        if is_condition
        else ""
    )


def _advise_result(tokens: Tokens, index: int, _expected: Collection[str]) -> str:
    """Advise about ``return`` with an expression: it declares the result."""
    is_value = _member_before(tokens, index)[:1] == ["return"]
    return "'return' declares the result: return r = ...;" if is_value else ""


def _advise_effect(tokens: Tokens, index: int, _expected: Collection[str]) -> str:
    """Advise about ``/`` before the effect of a transition, as SysML v1 writes it."""
    is_effect = tokens[index] == "/" and "accept" in _member_before(tokens, index)
    return "an effect is written with 'do': accept e do action x then b" if is_effect else ""


def _advise_quotes(tokens: Tokens, index: int, _expected: Collection[str]) -> str:
    """Advise about a declared name with a hyphen or a leading digit: ``part def my-part``."""
    before, after = tokens[index - 1] if index else "", "".join(_next_tokens(tokens, index)[:1])
    is_hyphen = tokens[index] == "-" and before.isidentifier() and after.isalnum()
    is_digit = tokens[index][:1].isdigit() and after.isidentifier() and before == "def"
    name = f"{before}-{after}" if is_hyphen else f"{tokens[index]}{after}"
    is_name = is_hyphen or is_digit
    return (
        f"put the name in single quotes, here and wherever it is used: '{name}'" if is_name else ""
    )


def _advise_then(tokens: Tokens, index: int, _expected: Collection[str]) -> str:
    is_conditional = tokens[index] == "then" and "if" in _member_before(tokens, index)
    return "a conditional expression has a question mark: if a ? b else c" if is_conditional else ""


def _advise_call(tokens: Tokens, index: int, expected: Collection[str]) -> str:
    """Advise about a call as a statement: ``Drill();``."""
    before = _member_before(tokens, index)
    is_call = tokens[index] == ";" and list(expected) == ["}"] and before[1:2] == ["("]
    return f"an action is performed by a usage: action x : {before[0]};" if is_call else ""


def _advise_loop(tokens: Tokens, index: int, _expected: Collection[str]) -> str:
    is_loop = index > 0 and tokens[index] == "(" and tokens[index - 1] == "for"
    return "a loop runs over a sequence: for i in 1..3 { ... }" if is_loop else ""


def _advise_sum(tokens: Tokens, index: int, _expected: Collection[str]) -> str:
    """Advise about an assignment that changes a value: ``n += 1``."""
    before = _member_before(tokens, index)
    is_sum = before[:1] == ["assign"] and _next_tokens(tokens, index)[:1] == ["="]
    return (
        f"write the new value: {before[-1]} := {before[-1]} {tokens[index]} ..." if is_sum else ""
    )


def _advise_note(tokens: Tokens, index: int, _expected: Collection[str]) -> str:
    is_note = _member_before(tokens, index)[:2] == ["-", "-"]
    return "a note is written // ..." if is_note else ""


def _advise_package(tokens: Tokens, index: int, _expected: Collection[str]) -> str:
    before = _member_before(tokens, index)
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
    before, name = _member_before(tokens, index), tokens[index]
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
    _advise_note,
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
    return _COMPARISON if is_binding else ""


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
    is_arrow = tokens[index] in _ARROWS and "to" in expected
    return _JOINED_BY_TO if is_arrow else ""


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


# -- corrections of a member ---------------------------------------------------------------------


class Correction(NamedTuple):
    """Tokens of a member that the parser reads as others: ``length`` of them from ``position``.

    ``words`` are the keywords and symbols in their place, ``expected`` the one to report.
    """

    position: int
    length: int
    words: tuple[str, ...]
    expected: str
    advice: str


def list_corrections(tokens: Tokens, start: int, index: int) -> Iterator[Correction]:
    """Yield the corrections that may mend a member that begins at ``start`` and fails at ``index``.

    The parser applies the first with which it accepts the member up to ``index``.
    """
    member = [tokens[position] for position in range(start, index + 1)]
    is_condition = not _CONDITION_HEADS.isdisjoint(_read_body_head(tokens, start))
    for position, symbol in enumerate(member, start):
        if is_condition and symbol == "=":
            yield _replace_by("==", position, _COMPARISON)
        elif is_condition and symbol in ("=>", "->"):
            yield _replace_by("implies", position, "an implication is written: a implies b")
        elif symbol in ("::", ":"):
            yield from _correct_colon(tokens, member, start, position)
        elif symbol in _ARROWS and not _ORDER_HEADS.isdisjoint(member):
            yield _replace_by("then", position, "an order is written: first a then b")
        elif symbol in _ARROWS and not _PAIR_HEADS.isdisjoint(member):
            yield _replace_by("to", position, _JOINED_BY_TO)
        elif symbol == "on" and "satisfy" in member:
            yield _replace_by("by", position, "write 'by' before what satisfies it")
    yield from _correct_last_tokens(tokens, member, start, index)


def _correct_colon(
    tokens: Tokens, member: list[str], start: int, index: int
) -> Iterator[Correction]:
    """Yield what a colon may stand for: ``part a :: A``, ``part def B : A``, ``part b : > a``."""
    following = _next_tokens(tokens, index)
    if member[index - start] == "::":
        if index > start + 1:
            advice = "':' stands before a type, '::' joins the names of packages"
            yield _replace_by(":", index, advice)
    elif following[:2] == [">", ">"]:
        yield Correction(index, 3, (":>>",), ":>>", "write ':>>' without blanks")
    elif following[:1] == [">"]:
        yield Correction(index, 2, (":>",), ":>", "write ':>' without blanks")
    elif "def" in member:
        advice = "':>' stands before a general type, ':' before the type of a usage"
        yield _replace_by(":>", index, advice)


def _correct_last_tokens(
    tokens: Tokens, member: list[str], start: int, index: int
) -> Iterator[Correction]:
    """Yield corrections of the last two tokens of *member*, which ends at ``index``."""
    before, last = member[-2] if len(member) > 1 else "", member[-1]
    if (before, last) == ("<", ">"):
        yield Correction(index - 1, 2, ("!=",), "!=", "'!=' means that two values differ")
    if before == ",":
        yield _replace_by(";", index - 1, _TOKENS[","])
    if before == "then" and last == "{" and "if" in member:
        advice = "the steps follow without 'then': if x > 0 { ... }"
        yield Correction(index - 1, 1, (), "{", advice)
    if last == "do" and _next_tokens(tokens, index)[:1] == ["{"]:
        advice = "the steps follow without 'do': while x > 0 { ... }"
        yield Correction(index, 1, (), "{", advice)
    if last in _DIRECTIONS and "".join(_next_tokens(tokens, index)[:1]).isidentifier():
        advice = f"write the direction before the kind: {last} {before} ..."
        yield Correction(index - 1, 2, (last, before), last, advice)
    if last == "then" and member[0].isidentifier():
        advice = f"write 'first' before the source: first {member[0]} then ..."
        yield Correction(start, 0, ("first",), "first", advice)
    if last.isidentifier() and not _ORDER_HEADS.isdisjoint(member[:-1]):
        advice = f"write 'then' before the target: then {last}"
        yield Correction(index, 0, ("then",), "then", advice)


def _replace_by(word: str, index: int, advice: str) -> Correction:
    return Correction(index, 1, (word,), word, advice)


def _read_body_head(tokens: Tokens, start: int) -> list[str]:
    """Return the tokens of the member whose body has a member at ``start``."""
    depth = 0
    for position in range(start - 1, max(-1, start - _MAX_HEAD), -1):
        depth += (tokens[position] == "}") - (tokens[position] == "{")
        if depth < 0:
            return _member_before(tokens, position)
    return []
