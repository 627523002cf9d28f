"""The formatter of KerML and SysML v2: text in canonical layout."""

from sysmlc.language.formatter.printer import Printer
from sysmlc.language.formatter.statements import group_statements, iter_meaning, read_tokens
from sysmlc.language.text.lalr import load_tables


def format_text(text: str, language: str) -> str:
    """Return the text in canonical layout; ``language`` is ``kerml`` or ``sysml``.

    The layout has four spaces for each body, one member a line, at most one blank line in a row,
    and lines of 100 characters where tokens allow. Comments and notes move with what they belong
    to. Tokens, comments and notes do not change, and the line ends are those of most lines.

    The text must have no syntax errors. Raises ValueError if a token would change, which is a fault
    of the formatter.
    """

    types = load_tables(language).types
    line_end = "\r\n" if 2 * text.count("\r\n") > text.count("\n") else "\n"
    plain = text.replace("\r\n", "\n").replace("\r", "\n")
    source_tokens = read_tokens(plain, types)
    printer = Printer()
    printer.print_body(*group_statements(source_tokens), "")
    formatted = "".join(f"{line}\n" for line in printer.lines)
    # A wrong space would change the model without notice, so the result is checked every time.
    if list(iter_meaning(read_tokens(formatted, types))) != list(iter_meaning(source_tokens)):
        raise ValueError("the layout would change the text")
    return formatted.replace("\n", line_end)


__all__ = ["format_text"]
