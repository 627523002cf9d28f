"""What a text should have said where the parser could not go on, in words."""

from sysmlc.diagnostics import Place, Sink, Subject
from sysmlc.language.text import rules
from sysmlc.language.text.machine import Stack
from sysmlc.language.text.scan import Tokens
from sysmlc.language.text.tables import Tables

_WORDS = {
    "NAME": "a name",
    "STRING": "a text in double quotes",
    "NUMBER": "a number",
    "BODY": "a comment /* ... */",
    "$END": "the end of the text",
}


def tell(tables: Tables, tokens: Tokens, stack: Stack, at: int, path: str, sink: Sink) -> None:
    """Report that token ``at`` does not fit."""
    row = tables.rows[stack[-1]]
    expected = sorted(_in_words(tables.names[kind]) for kind in row if kind in tables.names)
    place = Place(path, offset=len(tokens.text[: tokens.starts[at]].encode()))
    found = f"'{tokens[at]}'" if tokens[at] else "the end of the text"
    sink.report(
        rules.SYNTAX, Subject(place=place), found=found, expected=" or ".join(expected), advice=""
    )


def _in_words(name: str) -> str:
    return _WORDS.get(name, name)
