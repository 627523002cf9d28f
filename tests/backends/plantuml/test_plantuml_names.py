"""PlantUML shows any name as the model has it, because the back end escapes its markup."""

import html
import json
import re
import textwrap

import pytest
from diagrams import draw
from hypothesis import Phase, example, given, settings
from hypothesis import strategies as st

from long_runs import examples
from sysmlc.ir.text import parse_text
from sysmlc.support.plantuml_text import escape_line, wrap_lines

NASTY = (
    '**bold** //it// __u__ ""mono"" ~~w~~ --s-- ~x',
    "[[http://x y]] <b>x</b> <U+0041> &#65; &lt; \\n \\t",
    "$x %date() %newline() !define A B !include x",
    "@enduml",
    "' comment /' block '/",
    "a -> b : c } { | # ^ `",
    "= head", "* item", "# item", "|t|", "----", "..x..", "==", "+a", "-a", "~a", "{field} a",
    "note left", "end", "as", "<<fork>>", "}", "]", ":", "a\nb\tc", "", " ", "\u202eabc",
    "日本語のとても長い名前です" * 4, "émigré «x»", "😀 face", "A" * 130, "a_b" * 40, "x y " * 40,
)  # fmt: skip

MODEL = """
Package p {name}
  Class b {name} role="block"
    Property b.v {name} role="value" default={name}
    Port b.p {name}
    Property b.q {name} role="part" aggregation="composite"
      -> typed-by c
    Operation b.o {name}
      Parameter b.o.p {name} direction="in"
    Constraint b.c {name} body={name}
    Connector k {name}
      -> end k1 k2
      ConnectorEnd k1
        -> role b.p
      ConnectorEnd k2
        -> role c.p
        -> path b.q
    Activity a {name}
      Partition lane {name}
      Action a1 {name} subkind="opaque" body={name}
        -> in-partition lane
        Pin pin {name} direction="out"
      Control d {name} subkind="decision"
      ControlFlow f {name} guard={name}
        -> flow-source a1
        -> flow-target d
      Comment n body={name}
    StateMachine m {name}
      Region r {name}
        State s {name}
          -> entry e
          Activity e {name} subkind="opaque" body={name}
        State s2 {name}
        Transition t guard={name}
          -> flow-source s
          -> flow-target s2
          -> trigger tt
          Trigger tt subkind="change" condition={name}
  Interaction i {name}
    Lifeline l1 {name}
    Lifeline l2 {name} selector={name}
    Comment i.c body={name}
    Constraint i.k {name} body={name}
    Occurrence o1
      -> covers l1
    Occurrence o2
      -> covers l2
    Fragment i.f subkind="alt"
      Operand i.f1 guard={name}
      Operand i.f2 guard={name}
        Fragment i.u subkind="ref" arguments={name} return_value={name}
          -> calls i
        Fragment i.v {name} subkind="state-invariant"
          -> covers l1
    Fragment i.g subkind="neg"
      Operand i.g1 guard={name}
    Message m1 {name} arguments={name}
      -> send-event o1
      -> receive-event o2
      -> flow-source l1
      -> flow-target l2
    Observation i.o {name} subkind="time"
      -> references o2
  Actor ac {name}
    -> specializes ac2
  Actor ac2 {name}
  UseCase u {name}
    -> subject b
    Extend u.e
      -> extends u2
      -> references u2.p
      Constraint u.c {name} body={name}
    Constraint u.k {name} body={name}
  UseCase u2 {name}
    ExtensionPoint u2.p {name}
  Comment u.n body={name}
    -> references u
  Class c {name} role="block"
    Port c.p {name} direction="out"
  Enumeration en {name}
    EnumerationLiteral l {name}
  Association as {name}
    -> end as1 as2
    Property as1 {name}
      -> typed-by b
    Property as2 {name}
      -> typed-by c
  Class q {name} role="requirement" req_id={name} text={name}
  Dependency sd {name} role="satisfy"
    -> client b
    -> supplier q
"""

anything = st.text(max_size=60)
markup = st.text(st.sampled_from("*/_-~\"[]{}<>|&#%$!'@^:;.,=+\\ abn0"), max_size=24)


@pytest.mark.long
@pytest.mark.plantuml
@settings(max_examples=2, deadline=None, derandomize=True, phases=[Phase.explicit, Phase.generate])
@given(st.lists(anything | markup, min_size=1, max_size=8))
@example(list(NASTY))
def test_plantuml_shows_any_name_as_it_is_written(plantuml, names):
    files = {}
    for number, name in enumerate(names):
        texts = draw(parse_text(MODEL.replace("{name}", json.dumps(name))))
        files |= {f"{number} {path[-8:]}": text for path, text in texts.items()}
    pictures = plantuml.render(files)
    for number, name in enumerate(names):
        paths = [path for path in pictures if path.startswith(f"{number} ")]
        assert len(paths) == 7
        for path in paths:
            assert remove_blanks(name) in remove_blanks(read_svg_text(pictures[path])), (path, name)


def read_svg_text(svg: bytes) -> str:
    return html.unescape("".join(re.findall(r"<text[^>]*>([^<]*)</text>", svg.decode("utf-8"))))


def remove_blanks(text: str) -> str:
    """Return the text without spaces and without characters that XML does not allow."""
    return "".join(char for char in text if char.isprintable() and char not in " \ufffd")


@pytest.mark.parametrize(
    ("text", "escaped"),
    [
        ("Bay gate [north]", "Bay gate [north]"),
        ('say "stop"', "say <U+0022>stop<U+0022>"),
        ("a//b", "a/<U+002F>b"),
        ("-x", "<U+002D>x"),
        ("a-b_c 0..1", "a-b_c 0..1"),
        ("100 %d", "100 <U+0025>d"),
        ("two\n lines", "two lines"),
        ("bell\a", "bell\ufffd"),
    ],
)
def test_only_markup_of_plantuml_is_escaped(text, escaped):
    assert escape_line(text) == escaped


WORDS = st.lists(st.text("ab-_/ \t\n\xa0é", max_size=7), max_size=12).map(" ".join)


@settings(max_examples=examples(300))
@given(WORDS, st.integers(3, 20))
@example("  two blanks first", 6)
@example("a b", 3)
@example("words-that are as long as a line", 10)
def test_lines_are_wrapped_like_textwrap_does(text, width):
    for row in text.splitlines():
        lines = wrap_lines(row, width)
        expected = textwrap.wrap(row, width, break_long_words=False, break_on_hyphens=False)
        if all(len(word) <= width for word in re.split(r"[ \t]", row)):
            assert lines == tuple(escape_line(line) for line in expected if line.strip())


@given(st.text("ab*/_-['\"\\t<>~%$& {}«»éλ#@|=+()1\u200b\ue000\xa0😀", max_size=8))
def test_each_character_of_a_line_is_shown_or_escaped(text):
    line = " ".join(text.split())
    escape = r"<U\+([0-9A-F]{4,6})>"
    shown = re.sub(escape, lambda match: chr(int(match[1], 16)), escape_line(text))
    assert shown.replace("\\\u200bt", "\\t") == line
    assert not set('"\\~%$&{') & set(re.sub(r"<U\+[0-9A-F]+>", "", escape_line(text)))
    for pair in ("**", "//", "__", "--", "[[", "/'", "'/", "''"):
        assert pair not in escape_line(text)
