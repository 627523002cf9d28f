"""Names that a careless writer lets out of a comment, string or cell, and models of them."""

import json
import random
import re

from sysmlc.logic.identifiers import identifier

PIECES = (
    # C, C++ and Promela.
    *("*/", "*", "/", "/*", "//", "\\", "\\\n", "??/", "??'", "??=", "<%", "%:", ";", "}", "{"),
    *('"', "'", "#include <x>", "int", "main", "linux", 'R"(', '\\"', "%s", "%n", "0x"),
    # Python and Jinja.
    *('"""', "'''", "#", "\\N{", "\\x", "#}", "{#", "{{", "}}", "{%", "%}", "; abort()", "__doc__"),
    # PlantUML.
    *("!include x", "@enduml", "@startuml", "%date()", "'/", "/'", "$x", "<U+0041>", "[[x]]"),
    # Markdown, HTML and XML.
    *("<script>", "</script>", "<!--", "-->", "]]>", "<![CDATA[", "&lt;", "&#60;", "<a@b.c>"),
    *("[a](javascript:b)", "![a](b)", "[a]: b", "](b)", "<http://x.y>", "`", "```", "~~~", "|"),
    *("***", "___", "# ", "1. ", "- ", "> ", "    ", "\t", "===", "---", "~~", "**", "_", "<br>"),
    *("| a | b |", "</details>"),
    # Spreadsheets, SMV, LTL and SysML v2.
    *("=cmd|' /C'!A0", "+", "-", "@", "--", "G", "X", "U", "next(x)", ":=", ":", "::", ".", ","),
    # Line ends, control characters and characters that change how others are displayed.
    *("\n", "\r", "\r\n", "\x0b", "\x0c", "\x1c", "\x1d", "\x1e", "\x85", "\u2028", "\u2029"),
    *("\0", "\x07", "\x1b[31m", "\x7f", "\u200b", "\u200e", "\u202e", "\u2066", "\ufeff", "\ufffe"),
    # Letters.
    *("a", "B", "0", " ", "\xa0", "\xad", "\u0301", "é", "装置", "🤖", "ﷺ", "ـ", "ß"),
)

MODEL = """
Package p{i} {0}
  Class c{i} {1} role="block"
    -> classifier-behavior m{i}
    Comment n{i} body={9}
      -> references c{i}
    Property f{i} {2} default=0 unit={11}
      -> typed-by int
    Constraint k{i} {3} body={12}
    Property b{i} {3}
      -> typed-by bool
    Property e{i} {4}
      -> typed-by en{i}
    Property g{i} {6} role="part" aggregation="composite"
      -> typed-by d{i}
    Port o{i} {5} direction="out"
      -> typed-by d{i}
    StateMachine m{i} {6}
      Region r{i} {7}
        Pseudostate i{i} subkind="initial"
        State s{i} {8}
        State u{i} {9}
        Transition t{i}
          -> flow-source i{i}
          -> flow-target s{i}
        Transition v{i} {10} guard={13}
          -> flow-source s{i}
          -> flow-target u{i}
          -> trigger tr{i}
          -> effect ef{i}
          Activity ef{i} {11} subkind="opaque" body={14}
          Trigger tr{i} subkind="signal"
            -> typed-by sg{i}
        Transition w{i}
          -> flow-source u{i}
          -> flow-target s{i}
          -> trigger tx{i}
          Trigger tx{i} subkind="time" when="after 3 s"
  Class d{i} {11} role="block"
    -> classifier-behavior ac{i}
    Activity ac{i} {10}
      Action a{i} {5} subkind="opaque" body={6}
      Action aa{i} {7} subkind="opaque"
      ControlFlow cf{i} {8} guard={9}
        -> flow-source a{i}
        -> flow-target aa{i}
  Signal sg{i} {8}
  Enumeration en{i} {7}
    EnumerationLiteral l{i} {10}
    EnumerationLiteral ll{i} {0}
  Class q{i} {2} role="requirement" req_id={3} text={4}
    Constraint qk{i} {5} language="LTL" body={15}
  Class qq{i} {4} role="requirement" req_id={5} text={15}
  Dependency sd{i} {6} role="satisfy"
    -> client c{i}
    -> supplier q{i}
"""
NAMES = 12
"""Names of one package."""


def draw_names(count: int, seed: int) -> list[str]:
    """Return names of up to seven pieces; every hundredth is long, and some are empty."""
    source = random.Random(seed)
    names = []
    for number in range(count):
        name = "".join(
            source.choice(PIECES) for _ in range(source.choice((0, 1, 2, 2, 3, 4, 5, 7)))
        )
        names.append((name * 1_000)[:3_000] if number % 100 == 50 else name)
    return names


def build_model(names: list[str]) -> str:
    """Return a model in IR text with a package for each ``NAMES`` names."""
    packages = (names[start : start + NAMES] for start in range(0, len(names), NAMES))
    text = "".join(_build_package(number, part) for number, part in enumerate(packages))
    return f'DataType int "Integer"\nDataType bool "Boolean"\n{text}'


def _build_package(number: int, names: list[str]) -> str:
    count, flag, choice = (_quote(names[index]) for index in (2, 3, 4))
    formulas = (
        f"0 <= {count} <= 9",
        f"{count} < 9 and {flag}",
        f"{count} := {count} + 1; {choice} := {_quote(names[10])}",
        f"G F ({identifier(names[2])} < 5)",
    )
    texts = [json.dumps(text) for text in (*names, *formulas)]
    package = MODEL.replace("{i}", str(number))
    return re.sub(r"\{(\d+)\}", lambda match: texts[int(match[1])], package)


def _quote(name: str) -> str:
    """Return a name as formulas spell it."""
    escaped = name.replace("\\", "\\\\").replace("'", "\\'").replace("\n", "\\n")
    return f"'{escaped}'"
