"""A plainly written file is cut at its tags, any other goes through the parser: columns agree."""

import random
import re
from random import Random

import pytest
from reading_xmi import source

from dialects.enterprise_architect import write_xmi
from dialects.magicdraw import write_xml
from dialects.random_models import random_model
from sysmlc.frontends.xmi import parsing
from sysmlc.frontends.xmi.document import Document
from sysmlc.sources import DEFAULT_LIMITS, Source, SourceError
from sysmlc.sources.xml import parse, parser

MODEL = """\
<?xml version="1.0" encoding="UTF-8"?>
<xmi:XMI xmi:version="20131001" xmlns:xmi="http://www.omg.org/spec/XMI/20131001" \
xmlns:uml="http://www.eclipse.org/uml2/5.0.0/UML" xmlns:Blocks="urn:blocks">
  <uml:Model xmi:id="m" name="Plant">
    <packagedElement xmi:type="uml:Class" xmi:id="a" name="A"/>
    <packagedElement xmi:type="uml:Class" name="B" xmi:id="b" isAbstract="true">
      <ownedAttribute xmi:id="p" xmi:type="uml:Property" name="p" type="a" aggregation="composite"/>
      <ownedAttribute xmi:id="q" xmi:type="uml:Property" name="q &lt; r" type="a"/>
      <ownedRule xmi:type="uml:Constraint" xmi:id="c" name="x > y">
        <specification xmi:type="uml:OpaqueExpression" xmi:id="s">
          <language>OCL</language>
          <body>x &gt; 3 and y &lt; 4</body>
        </specification>
      </ownedRule>
      <ownedRule xmi:type="uml:Constraint" xmi:id="d" constrainedElement="a b">
        <specification xmi:type="uml:LiteralString" xmi:id="t" value="it's"/>
      </ownedRule>
    </packagedElement>
    <ownedComment xmi:type="uml:Comment" xmi:id="e" body="one&#xA;two"><body/></ownedComment>
  </uml:Model>
  <Blocks:Block xmi:id="f" base_Class="b"/>
</xmi:XMI>
"""


def columns(document):
    return {name: getattr(document, name) for name in Document.__slots__}


def agree(text):
    one = source(text, "m.uml")
    found = parsing._plainly(one)
    assert found is not None
    assert columns(found) == columns(parsing._generally(one))


WRITTEN = {
    "as it is": lambda text: text,
    "with a byte order mark": lambda text: "\ufeff" + text,
    "without declaration": lambda text: text.partition("\n")[2],
    "in another case": lambda text: text.replace("UTF-8", "utf-8"),
    "as ASCII": lambda text: text.replace("UTF-8", "US-ASCII"),
    "with line ends of Windows": lambda text: text.replace("\n", "\r\n"),
    "with line ends of old Macs": lambda text: text.replace("\n", "\r"),
    "in one line": lambda text: re.sub(r">\s+<", "><", text),
    "with tabs": lambda text: text.replace("  ", "\t"),
    "with attributes in lines": lambda text: text.replace(" name=", "\n\t\tname="),
    "with blanks in tags": lambda text: text.replace('">', '" >').replace("/>", "\n/>"),
    "with blanks around =": lambda text: text.replace(" name=", " name = "),
    "with letters of other scripts": lambda text: text.replace('"A"', '"F\u00f6rderer \u6a5f"'),
    "with text behind tags": lambda text: text.replace("</specification>", "</specification>more"),
    "with text behind empty tags": lambda text: text.replace("<body/>", "<body/>more &amp; more"),
    "with text in the root": lambda text: text.replace("  <uml:Model", "text<uml:Model"),
    "with text at the root's end": lambda text: text.replace("</xmi:XMI>", "text</xmi:XMI>"),
    "with a blank referred to": lambda text: text.replace("  <uml:Model", "&#32;<uml:Model"),
    "with quotes in texts": lambda text: text.replace("x &gt; 3", 'x = "a > b"\n'),
    "with one quote in a text": lambda text: text.replace("x &gt; 3", 'x" >'),
    "with references to what starts references": lambda text: text.replace(
        "x &gt; 3", "&amp;gt; &amp;amp; &amp;#65; &quot;&lt;&apos;"
    ).replace('"A"', '"&#38;amp; &#x26;lt; &amp;lt;"'),
    "with lines in texts": lambda text: text.replace("x &gt; 3", "x\n\t3"),
    "with an id twice": lambda text: text.replace('"d"', '"c"'),
    "with many attributes": lambda text: text.replace(
        ' xmi:id="a"', ' xmi:id="a"' + "".join(f' a{n}="{n}"' for n in range(9))
    ),
    "with xmi:idref": lambda text: text.replace(' type="a"', "").replace(
        "<body/>", '<annotatedElement xmi:idref="a"/>'
    ),
}


@pytest.mark.parametrize("write", WRITTEN.values(), ids=WRITTEN)
def test_plain_files_have_the_same_columns_in_both_ways(write):
    agree(write(MODEL))


@pytest.mark.parametrize("seed", range(3))
def test_random_models_of_all_dialects_have_the_same_columns_in_both_ways(seed):
    model = random_model(Random(seed))
    agree(model)
    for one in (source(write_xml(model), "m.xml"), source(write_xmi(model), "m.xmi")):
        assert columns(parsing.read(one)) == columns(parsing._generally(one))


NOT_PLAIN = {
    "CDATA": lambda text: text.replace("OCL", "<![CDATA[OCL]]>"),
    "a comment": lambda text: text.replace("<language", "<!-- --><language"),
    "a comment before the root": lambda text: text.replace("<xmi:XMI", "<!-- --><xmi:XMI", 1),
    "a processing instruction": lambda text: text.replace("<language", "<?tool <x> ?><language"),
    "single quotes": lambda text: text.replace('"A"', "'A'"),
    "a namespace below the root": lambda text: text.replace("<language", '<language xmlns="urn:x"'),
    "a prefix below the root": lambda text: text.replace("<language", '<language xmlns:x="urn:x"'),
    "a prefix that means nothing": lambda text: text.replace("<language", "<x:language"),
    "another encoding": lambda text: text.replace("UTF-8", "iso-8859-1"),
    "a fault": lambda text: text.replace("</language>", "", 1),
    "an end too many": lambda text: text.replace("</language>", "</language></language>", 1),
    "no end": lambda text: text.replace("</xmi:XMI>", ""),
    "two roots": lambda text: text + "<a/>",
    "text behind the root": lambda text: text + "a",
    "text before the root": lambda text: text.replace("<xmi:XMI", "a<xmi:XMI", 1),
    "a DOCTYPE": lambda text: text.replace("<xmi:XMI", "<!DOCTYPE x><xmi:XMI", 1),
    "an entity": lambda text: text.replace("&gt;", "&nbsp;"),
    "no character": lambda text: text.replace("&gt;", "&#1;"),
    "a tag without its end": lambda text: text.replace(
        "    <ownedComment",
        '<packagedElement xmi:type="uml:Class" xmi:id="z" name="Z"/<ownedComment',
    ),
    "a start tag without its end": lambda text: text.replace("<body>", "<body", 1),
    "a start tag that was seen, without its end": lambda text: text.replace(
        "</language>", "</language><language</language>"
    ),
    "an attribute twice": lambda text: text.replace(' name="A"', ' name="A" name="B"'),
    "an attribute without blank": lambda text: text.replace('" name="A"', '"name="A"'),
    "an attribute without value": lambda text: text.replace(' name="A"', " name"),
    "a line end in a value": lambda text: text.replace('"A"', '"A\nB"'),
    "a tab in a value": lambda text: text.replace('"A"', '"A\tB"'),
    "an end of CDATA in a text": lambda text: text.replace("OCL", "]]>"),
    "nothing but references": lambda text: text.replace("OCL", "&lt;" * len(text)),
    "no content": lambda text: text.partition("\n  <uml:Model")[0],
    "an empty root": lambda text: re.sub(r">\s*<uml:Model.*", "/>", text, flags=re.DOTALL),
    "two namespaces of XMI": lambda text: text.replace(
        'xmlns:Blocks="urn:blocks"', 'xmlns:Blocks="http://schema.omg.org/spec/XMI/2.1"'
    ),
    "a drawing": lambda text: text.replace("<body/>", "<diagramRepresentation/>"),
    "attached files": lambda text: text.replace("<body/>", "<filePart/>"),
    "types of XML Schema": lambda text: text.replace("xmi:type", "xsi:type").replace(
        "xmlns:Blocks", 'xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xmlns:Blocks'
    ),
}


@pytest.mark.parametrize("write", NOT_PLAIN.values(), ids=NOT_PLAIN)
def test_files_that_are_not_plain_are_left_to_the_parser(write):
    assert parsing._plainly(source(write(MODEL), "m.uml")) is None


def test_text_that_is_no_utf_8_is_left_to_the_parser():
    for data in (MODEL.encode("utf-16"), MODEL.replace("OCL", "\xf6").encode("latin-1")):
        assert parsing._plainly(Source("m.uml", data)) is None


@pytest.mark.parametrize("depth", [DEFAULT_LIMITS.depth - 20, DEFAULT_LIMITS.depth + 20])
def test_what_is_nested_too_deeply_is_left_to_the_parser(depth):
    inside = "<a>" * depth + "</a>" * depth
    one = source(MODEL.replace("<body/>", inside), "m.uml")
    assert (parsing._plainly(one) is None) == (depth > DEFAULT_LIMITS.depth)


def test_large_files_are_cut_anywhere():
    row = '    <packagedElement xmi:type="uml:Class" xmi:id="k{0}">\n    </packagedElement>\n'
    rows = "".join(map(row.format, range(3000)))
    agree(MODEL.replace("    <ownedComment", f"{rows}    <ownedComment"))


def test_rows_are_not_remembered_without_end(monkeypatch):
    from sysmlc.frontends.xmi import tags

    monkeypatch.setattr(tags, "_REMEMBERED", 4)
    agree(MODEL)


TAGS = ("packagedElement", "xmi:Extension", "body", "ownedRule", "Blocks:Block")
NAMES = ("xmi:id", "xmi:type", "name", "body", "Blocks:x")
VALUES = ("", "a", "a > b", "&amp;", "\n", "uml:Class", "\u00e9", '"', "&#x41;", " ")


def some_xml(chance, depth=0):
    """A random element: any tag inside any other, with texts between them."""
    tag = chance.choice(TAGS)
    names = chance.sample(NAMES, chance.randint(0, 3))
    values = [chance.choice(VALUES).replace('"', "'") for _ in names]
    start = tag + "".join(f' {name}="{one}"' for name, one in zip(names, values, strict=True))
    if chance.random() < 0.3:
        return f"<{start}/>{chance.choice(VALUES)}"
    count = 0 if depth > 3 else chance.randint(0, 3)
    inside = (some_xml(chance, depth + 1) + chance.choice(VALUES) for _ in range(count))
    return f"<{start}>{chance.choice(VALUES)}{''.join(inside)}</{tag}>"


def test_random_files_have_the_same_columns_or_are_left_to_the_parser():
    chance, plain = random.Random(4), 0
    head, _, _ = MODEL.partition("  <uml:Model")
    for _ in range(600):
        one = source(f"{head}{''.join(some_xml(chance) for _ in range(3))}</xmi:XMI>", "m.uml")
        found = parsing._plainly(one)
        if found is not None:
            plain += 1
            assert columns(found) == columns(parsing._generally(one)), one.data
    assert plain > 100


SIGNS = (
    *"<>/\"'&;= \n\tx:-!?[]\x00\x0b\x7f\ufffe\ufffd\r#1",
    "]]>",
    "&amp;",
    "&#0;",
    "<!--",
    "-->",
    "<a>",
    "</a>",
    "<a/>",
    "</body>",
    ' name="x"',
    "xmlns:",
)


def damaged(text, chance):
    """A text with a few small changes anywhere: most of them make it no XML."""
    for _ in range(chance.randint(1, 2)):
        at = chance.randrange(len(text))
        lost = chance.choice((0, 0, 1, 1, 2, 8))
        text = text[:at] + chance.choice((chance.choice(SIGNS), "")) + text[at + lost :]
    return text


def is_well_formed(data):
    made = parser()
    try:
        parse(Source("m.uml", data), made)
    except SourceError:
        return False
    return True


def test_no_damaged_file_passes_that_the_parser_refuses():
    chance, passed, refused = random.Random(7), 0, 0
    for _ in range(3000):
        one = source(damaged(MODEL, chance), "m.uml")
        found = parsing._plainly(one)
        if found is None:
            refused += not is_well_formed(one.data)
            continue
        assert is_well_formed(one.data), one.data
        assert columns(found) == columns(parsing._generally(one)), one.data
        passed += 1
    assert passed > 100
    assert refused > 500
