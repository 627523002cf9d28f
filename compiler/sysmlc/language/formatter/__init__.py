"""The canonical layout of a text in KerML or SysML v2."""

from sysmlc.language.formatter.printer import Printer
from sysmlc.language.formatter.statements import statements, tokens, words


def layout(text: str, language: str) -> str:
    """The text in canonical layout; ``language`` is ``kerml`` or ``sysml``.

    Four spaces for each body, one member a line, one blank line at most where there were some,
    lines of 100 characters where tokens allow, comments and notes moved with what they belong
    to. Tokens, comments and notes stay what they are; line ends are those of most lines. The
    text must have no syntax errors. Raises ValueError when a token would become another one,
    which is a fault of ours.
    """
    from sysmlc.language.text import lalr

    types = lalr.load_tables(language).types
    ends = "\r\n" if 2 * text.count("\r\n") > text.count("\n") else "\n"
    plain = text.replace("\r\n", "\n").replace("\r", "\n")
    found = tokens(plain, types)
    printer = Printer()
    printer.body(*statements(found), "")
    made = "".join(f"{line}\n" for line in printer.lines)
    if list(words(tokens(made, types))) != list(words(found)):
        raise ValueError("the layout would change the text")
    return made.replace("\n", ends)


__all__ = ["layout"]
