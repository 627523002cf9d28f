"""Parser of expressions and effects: Lark runs ``grammars/expression.lark``."""

import re
from collections.abc import Iterator, Mapping
from functools import cache
from typing import TYPE_CHECKING, Any

from msgspec import Struct

from sysmlc.ir.expressions import (
    PRECEDENCE,
    Assignment,
    Binary,
    Call,
    Conditional,
    EffectText,
    Expression,
    ExpressionError,
    ExpressionText,
    Index,
    Invocation,
    Literal,
    Member,
    Name,
    Send,
    Statement,
    Unary,
    is_nested_too_deeply,
    name_of,
    print_expression,
)
from sysmlc.logic.expressions.symbols import ElaborationError, Fault
from sysmlc.support import resources

if TYPE_CHECKING:
    from lark import Lark, Token, Tree

_SPELLING = {"&&": "and", "&": "and", "||": "or", "|": "or", "!": "not", "=": "==", "<>": "!="}
_ESCAPE = {"n": "\n"}
_SHOWN_TOKEN = re.compile(r"\w{1,40}|[^\w\s]")


def tree_of(value: str) -> Expression:
    """Return the syntax tree of an attribute's value. Raises ExpressionError.

    A text is parsed if neither its front end nor the pass ``expressions`` has attached its tree.
    """
    return value.tree if isinstance(value, ExpressionText) else parse_expression(value)


def statements_of(value: str) -> tuple[Statement, ...]:
    """Return the statements of an attribute's value. Raises ExpressionError."""
    return value.tree if isinstance(value, EffectText) else parse_effect(value)


def performed_name(body: str) -> str | None:
    """Return the path of the behaviour that an effect performs; None for any other effect."""
    # Most behaviours have no body, and the parser takes 0.1 s to load.
    if not body:
        return None
    try:
        statements = statements_of(body)
    except ExpressionError:
        return None
    match statements:
        case (Invocation(call),):
            return name_of(call)
    return None


def attach_tree(text: str) -> str:
    """Return the text of an expression with its tree; any other text as it is."""
    try:
        return ExpressionText(text, tree_of(text))
    except ExpressionError:
        return text


def attach_statements(text: str) -> str:
    """Return the text of an effect with its statements; any other text as it is."""
    try:
        return EffectText(text, statements_of(text))
    except ExpressionError:
        return text


def parse_expression(text: str) -> Expression:
    """Parse an expression. Raises ExpressionError."""
    expression: Expression = _parse(text, "expression")
    return expression


def parse_effect(text: str) -> tuple[Statement, ...]:
    """Parse the statements of an effect, which semicolons separate. Raises ExpressionError."""
    statements: tuple[Statement, ...] = _parse(text, "effect")
    return statements


def _parse(text: str, start_rule: str) -> Any:  # noqa: ANN401 - the type depends on the start rule
    from lark.exceptions import UnexpectedInput

    try:
        tree = _make_parser().parse(text, start=start_rule)
        _refuse_chains(tree)
        value = _TreeBuilder().build(tree)
    except UnexpectedInput as error:
        token = getattr(error, "token", None)
        is_at_end = token is not None and token.type == "$END"
        offset = len(text) if is_at_end or error.pos_in_stream is None else error.pos_in_stream
        raise ExpressionError(_explain(text, offset), offset) from None
    except RecursionError:
        raise ExpressionError("the expression is nested too deeply", 0) from None
    if is_nested_too_deeply(value):
        raise ExpressionError("the expression is nested too deeply", 0)
    return value


def _refuse_chains(tree: "Tree[Token]") -> None:
    """Refuse ``a = b = c``, which assigns to both in C and compares the last two in UML."""
    for assignment in tree.find_data("assignment"):
        signs = list(assignment.scan_values(lambda token: token == "="))
        if "=" in assignment.children and len(signs) > 1:
            message = "'=' assigns and compares; write ':=' to assign, or '==' to compare"
            raise ExpressionError(message, 0)


def _explain(text: str, offset: int) -> str:
    if not text[offset:].strip():
        return "the text ends too early"
    # The arrow of OCL is read as a minus sign before a comparison.
    if text[max(0, offset - 1) : offset + 1] == "->":
        return "operations on collections ('->') are not supported"
    token = _SHOWN_TOKEN.search(text, offset)
    return f"unexpected '{token[0] if token else text[offset:].strip()}'"


@cache
def _make_parser() -> "Lark":
    # Importing Lark and building its tables takes 0.1 s, which only models with expressions pay.
    from lark import Lark

    return Lark(
        resources.read_text("grammars", "expression.lark"),
        parser="lalr",
        start=["expression", "effect"],
        propagate_positions=True,
        maybe_placeholders=False,
    )


class _TreeBuilder:
    """Builds the syntax tree from the parse tree of Lark, with one method for each grammar rule.

    A method takes the values of the children; ``_offset`` is the position of the rule's text.
    """

    _offset = 0

    def build(self, tree: "Tree[Token]") -> Any:  # noqa: ANN401 - the type depends on the rule
        children = [
            child if isinstance(child, str) else self.build(child) for child in tree.children
        ]
        # An empty effect has no position.
        self._offset = getattr(tree.meta, "start_pos", 0)
        return getattr(self, tree.data)(children)

    def expression(self, children: list[Expression]) -> Expression:
        return children[0]

    def literal(self, children: "list[Token]") -> Literal:
        (token,) = children
        match token.type:
            case "TRUE" | "FALSE":
                return Literal(token.type == "TRUE")
            case "REAL":
                return Literal(float(token))
            case "STRING":
                return Literal(unquote(token))
        try:
            return Literal(int(token))
        except ValueError:
            # Python limits the digits of a number (sys.set_int_max_str_digits).
            raise ExpressionError("the number has too many digits", self._offset) from None

    def name(self, children: "list[Token]") -> str:
        (token,) = children
        return unquote(token) if token.type == "QUOTED_NAME" else str(token)

    def qualified_name(self, children: list[str]) -> Name:
        return Name(tuple(children))

    def member(self, children: list[Any]) -> Member:
        base, name = children
        return Member(base, name)

    def call(self, children: list[Expression]) -> Call:
        function, *arguments = children
        return Call(function, tuple(arguments))

    def index(self, children: list[Expression]) -> Index:
        base, index = children
        return Index(base, index)

    def unary(self, children: list[Any]) -> Unary:
        operator, operand = children
        return Unary(_normalise(operator), operand)

    def binary(self, children: list[Any]) -> Binary:
        left, operator, right = children
        return Binary(_normalise(operator), left, right)

    def conditional(self, children: list[Expression]) -> Conditional:
        condition, then, otherwise = children
        return Conditional(condition, then, otherwise)

    def effect(self, children: list[Statement]) -> tuple[Statement, ...]:
        return tuple(children)

    def assignment(self, children: list[Any]) -> Assignment:
        target, value = children[0], children[-1]
        if not isinstance(target, Name | Member | Index):
            raise ExpressionError("only a feature can be assigned to", self._offset)
        return Assignment(target, value)

    def receiver(self, children: list[Expression]) -> "_Receiver":
        return _Receiver(children[0])

    def send(self, children: list[Any]) -> Send:
        signal, *arguments = children
        receiver = None
        if arguments and isinstance(arguments[-1], _Receiver):
            receiver = arguments.pop().expression
        return Send(signal, tuple(arguments), receiver)

    def invocation(self, children: list[Expression]) -> Invocation:
        (target,) = children
        if not isinstance(target, Name | Member | Call):
            raise ExpressionError("this is a value and does nothing", self._offset)
        return Invocation(target)


class _Receiver:
    """Marks the receiver among the children of a send statement, which also has arguments."""

    def __init__(self, expression: Expression) -> None:
        self.expression = expression


def _normalise(operator: str) -> str:
    """Return the operator in the spelling of KerML."""
    word = operator.lower()
    return _SPELLING.get(word, word)


def unquote(text: str) -> str:
    """Return the text between quotation marks, without escapes."""
    return re.sub(r"\\(.)", lambda match: _ESCAPE.get(match[1], match[1]), text[1:-1])


# -- guards that exclude each other -------------------------------------------------------------

_COMPLEMENTS = {"<": ">=", ">=": "<", ">": "<=", "<=": ">", "==": "!=", "!=": "=="}
ORDERS = frozenset(["<", "<=", ">", ">="])
_MIRRORED = {"<": ">", ">=": "<=", ">": "<", "<=": ">=", "==": "==", "!=": "!="}
"""The operator after both operands of a comparison have changed places."""


class GuardTerms(Struct, frozen=True):
    """The operands of a guard that is a conjunction, and their negations."""

    terms: frozenset[Expression]
    negations: frozenset[Expression]

    @staticmethod
    def read(guard: str) -> "GuardTerms":
        """Return the terms of a guard; none of a text that cannot be read."""
        try:
            terms = frozenset(_iter_terms(tree_of(guard)))
        except ExpressionError:
            terms = frozenset()
        return GuardTerms(terms, frozenset(map(_negate, terms)))

    def excludes(self, guard: "GuardTerms") -> bool:
        """Whether two guards exclude each other by form, such as ``a < b`` and ``c and a >= b``.

        The operands may have any type, also one whose values are not finite.
        """
        is_disjoint = self.terms.isdisjoint(guard.negations)
        return not (is_disjoint and guard.terms.isdisjoint(self.negations))


def _iter_terms(expression: Expression) -> Iterator[Expression]:
    """Yield the operands of a conjunction."""
    worklist = [expression]
    while worklist:
        part = worklist.pop()
        if isinstance(part, Binary) and part.op == "and":
            worklist += [part.left, part.right]
        else:
            yield part


def _negate(term: Expression) -> Expression:
    if isinstance(term, Binary) and term.op in _COMPLEMENTS:
        return Binary(_COMPLEMENTS[term.op], term.left, term.right)
    if isinstance(term, Unary) and term.op == "not":
        return term.operand
    return Unary("not", term)


# -- comparisons as in Python ----------------------------------------------------------------------


def regroup_negations(expression: Expression) -> Expression:
    """Return the expression with each ``not`` before a comparison applied to all of it.

    In Python ``not a < b`` is ``not (a < b)``; in C, OCL and KerML it is ``(not a) < b``.
    """
    match expression:
        case Unary(op, operand):
            return Unary(op, regroup_negations(operand))
        case Binary(op, left, right) if op in _COMPLEMENTS:
            stripped = _strip_negation(left)
            if stripped is not None:
                return Unary("not", regroup_negations(Binary(op, stripped, right)))
        case Binary(op, left, right):
            return Binary(op, regroup_negations(left), regroup_negations(right))
    return expression


def _strip_negation(operand: Expression) -> Expression | None:
    """Return the left operand of a comparison without the ``not`` at its start; None without it."""
    match operand:
        case Unary("not", negated):
            return negated
        case Binary(op, left, right) if PRECEDENCE[op] > PRECEDENCE["and"]:
            stripped = _strip_negation(left)
            return None if stripped is None else Binary(op, stripped, right)
    return None


def split_chains(expression: Expression) -> Expression:
    """Rewrite each chain of two comparisons: ``0 <= x <= 4`` to ``0 <= x and x <= 4``."""
    match expression:
        case Binary(op, Binary(first, _, middle) as left, right) if {op, first} <= ORDERS:
            return Binary("and", left, Binary(op, middle, right))
        case Binary(op, left, right) if op not in _COMPLEMENTS:
            return Binary(op, split_chains(left), split_chains(right))
        case Unary(op, operand):
            return Unary(op, split_chains(operand))
    return expression


def explain_fault(error: ElaborationError, *expressions: Expression) -> str:
    """Return why expressions have no formula, with advice on a ``not`` before a comparison."""
    if error.fault in (Fault.TYPE, Fault.UNSUPPORTED):
        for expression in expressions:
            regrouped = regroup_negations(expression)
            if regrouped != expression:
                text = print_expression(regrouped)
                return f"{error}; write '{text}' if 'not' is about the comparison"
    return str(error)


# -- conditions without formula ------------------------------------------------------------------


class CanonicalCondition(Struct, frozen=True):
    """A condition in its canonical form, by which its spellings share one input.

    ``text`` is the printed expression without ``not`` around it, or the words of a text that is no
    expression; ``is_negated`` if the condition is the negation of it. ``key`` is equal for a
    comparison and its mirror image; ``complement`` is the key of the opposite comparison.
    """

    text: str
    key: str
    complement: str = ""
    is_negated: bool = False

    @staticmethod
    def read(text: str, origin: str) -> "CanonicalCondition":
        """Return the canonical form of any text; the key of an empty one is *origin*."""
        try:
            expression = tree_of(text)
        except ExpressionError:
            words = " ".join(text.split())
            return CanonicalCondition(words, words or origin)
        is_negated = False
        while (operand := _find_operand(expression)) is not None:
            expression, is_same = operand
            is_negated ^= not is_same
        key, complement = _orient(expression), _orient(_negate(expression))
        return CanonicalCondition(print_expression(expression), key, complement, is_negated)

    def find_input(self, inputs: Mapping[str, str]) -> tuple[str, bool]:
        """Return the input of the condition, and whether the condition is the negation of it.

        *inputs* are names by the keys of conditions; the name is empty if there is none.
        """
        if self.key in inputs:
            return inputs[self.key], self.is_negated
        return inputs.get(self.complement, ""), not self.is_negated


def _find_operand(expression: Expression) -> tuple[Expression, bool] | None:
    """Return the operand that a negation or a comparison with a truth value is about, or None.

    The second value is whether operand and expression are equal; else they are opposites.
    """
    match expression:
        case Unary("not", operand):
            return operand, False
        case Binary("==" | "!=" as op, operand, Literal(bool() as value)) | Binary(
            "==" | "!=" as op, Literal(bool() as value), operand
        ):
            return operand, value is (op == "==")
    return None


def _orient(expression: Expression) -> str:
    """Return the text of an expression; of a comparison and its mirror image, the lesser text."""
    text = print_expression(expression)
    if not isinstance(expression, Binary) or expression.op not in _MIRRORED:
        return text
    mirrored = Binary(_MIRRORED[expression.op], expression.right, expression.left)
    return min(text, print_expression(mirrored))
