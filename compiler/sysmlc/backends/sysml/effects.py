"""Effects of our grammar as actions of SysML v2: assignments, sendings, performed actions."""

from sysmlc.backends.sysml.book import Book
from sysmlc.backends.sysml.entry import Entry
from sysmlc.backends.sysml.expressions import UnknownNameError, resolved, written
from sysmlc.ir import Element
from sysmlc.logic.expressions.expression import (
    Assignment,
    Call,
    Expression,
    ExpressionError,
    Invocation,
    Send,
    Statement,
)
from sysmlc.logic.expressions.parsing import parse_effect


def statements(book: Book, scope: Entry | None, element: Element) -> list[str] | None:
    """The body of an opaque behaviour as actions, or None when it is in no words of ours."""
    text = element.attrs.get("body")
    if not isinstance(text, str) or "bodies" in element.attrs:
        return None
    try:
        found = [_statement(book, scope, one) for one in parse_effect(text)]
    except (ExpressionError, UnknownNameError, RecursionError):
        return None
    return found or None


def _statement(book: Book, scope: Entry | None, statement: Statement) -> str:
    match statement:
        case Assignment(target, value):
            return f"assign {_feature(book, scope, target)} := {written(book, scope, value)}"
        case Send(signal, args, receiver):
            inside = ", ".join(written(book, scope, one) for one in args)
            end = "" if receiver is None else _receiver(book, scope, receiver)
            return f"send new {written(book, scope, signal)}({inside}){end}"
        case Invocation(call):
            return _perform(book, scope, call)


def _feature(book: Book, scope: Entry | None, target: Expression) -> str:
    found = resolved(book, scope, target)
    if found is None or not found.shape.is_usage:
        raise UnknownNameError("target")
    return written(book, scope, target)


def _receiver(book: Book, scope: Entry | None, receiver: Expression) -> str:
    found = resolved(book, scope, receiver)
    word = "via" if found is not None and found.shape.keyword == "port" else "to"
    return f" {word} {written(book, scope, receiver)}"


def _perform(book: Book, scope: Entry | None, call: Expression) -> str:
    """Something that is done: an action by its name; one with arguments stays as it is."""
    function = call.function if isinstance(call, Call) else call
    if isinstance(call, Call) and call.args:
        raise UnknownNameError("arguments")
    found = resolved(book, scope, function)
    if found is None or found.shape.keyword != "action":
        raise UnknownNameError("action")
    return f"perform {written(book, scope, function)}"
