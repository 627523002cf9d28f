"""The textual notations of KerML and SysML v2: text becomes a tree."""

from functools import cache
from typing import TYPE_CHECKING

from sysmlc.language.tree import Document

if TYPE_CHECKING:
    from sysmlc.diagnostics import Sink
    from sysmlc.language.text.machine import Rules
    from sysmlc.sources import Source


def parse(
    text: str, path: str, language: str, sink: "Sink", source: "Source | None" = None
) -> Document:
    """The tree of a text in ``language``: ``kerml`` or ``sysml``.

    What is wrong in it is reported; the tree has what was understood.
    """
    from sysmlc.language.text import machine, tables
    from sysmlc.language.text.build.namespaces import root
    from sysmlc.language.text.scan import scan

    made = tables.load(language)
    tokens = scan(text, made.types)
    if len(tokens.types) == 1:
        return Document(path, language, root(tokens, []), text, source)
    stack = [None, 0, made.start]
    wrong = machine.run(made, _rules(language), tokens, stack, 0)
    members = stack[-3] if wrong < 0 else []
    if wrong >= 0:
        from sysmlc.language.text.errors import tell

        tell(made, tokens, stack, wrong, path, sink)
    return Document(path, language, root(tokens, members), text, source)


@cache
def _rules(language: str) -> "Rules":
    from sysmlc.language.text import machine, tables
    from sysmlc.language.text.build import ACTIONS

    return machine.rules(tables.load(language), ACTIONS[language])
