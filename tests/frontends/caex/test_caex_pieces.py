"""A plainly written file is cut at its tags, any other goes through the parser: columns agree."""

import random
import re

import pytest

from sysmlc.frontends.caex import columns, pieces, sections, wellformed
from sysmlc.frontends.caex.document import Document
from sysmlc.frontends.caex.vocabulary import FOLDED
from sysmlc.sources import Source, SourceError
from sysmlc.sources.xml import parse, parser

PLANT = """\
<?xml version="1.0" encoding="utf-8"?>
<CAEXFile xmlns="http://www.dke.de/CAEX" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" \
xsi:schemaLocation="CAEX.xsd" SchemaVersion="3.0" FileName="plant.aml">
  <AdditionalInformation>
    <WriterHeader><WriterName>sysmlc &amp; others</WriterName>, more</WriterHeader>
  </AdditionalInformation>
  <InstanceHierarchy Name="Plant">
    <Version>1.0</Version>
    <InternalElement Name="A" ID="a">
      <Description>first &lt;of&gt; &#x41;&#66;</Description>
      <Attribute Name="x" AttributeDataType="xs:double" ID="i1"><Value>1</Value></Attribute>
      <Attribute Name="x" AttributeDataType="xs:double" ID="i2"><Value/></Attribute>
      <Attribute Name="y"><DefaultValue> 2 </DefaultValue><Value>3</Value></Attribute>
      <Attribute Name="z"><Value>3</Value><Value>4</Value></Attribute>
      <Attribute Name="y"><Value>5</Value></Attribute>
      <Attribute Name="x > y" Unit="&quot;q&quot;"/>
      <ExternalInterface Name="p" ID="p1" RefBaseClassPath="L/P"/>
      <ExternalInterface Name="p" ID="p2" RefBaseClassPath="L/P"/>
      <ExternalInterface Name="p" ID="p3" RefBaseClassPath="L/P" ChangeMode="Change"/>
      <InternalLink Name="l" RefPartnerSideA="p1" RefPartnerSideB="p2"/>
      <InternalLink Name="l &amp; m" RefPartnerSideA="p1" RefPartnerSideB="p2"/>
    </InternalElement>
  </InstanceHierarchy>
</CAEXFile>
"""

SOUND = PLANT.replace("&#x41;&#66;", "AB")
"""What no parser has to check again."""
SHORT = (
    '<CAEXFile SchemaVersion="3.0"><InstanceHierarchy Name="P"><InternalElement Name="A" ID="a">'
    '<Attribute Name="x"><Value>1</Value></Attribute><Attribute Name="x"><Value>2</Value>'
    "</Attribute></InternalElement></InstanceHierarchy></CAEXFile>"
)


def read(text, by):
    document = Document("plant.aml")
    by(document, Source("plant.aml", text.encode() if isinstance(text, str) else text))
    return document


def said(document):
    rows = range(len(document.tags))
    document.verdicts, document.elements = [None] * len(rows), [""] * len(rows)
    return (
        [
            (node.tag, node.attributes, node.texts, node.ordinal)
            for node in map(document.node, rows)
        ],
        document.parents,
        document.ends,
        document.ids,
        document.has_changes,
    )


def agree(text):
    assert pieces.fill(Document("plant.aml"), Source("plant.aml", text.encode()))
    assert said(read(text, pieces.fill)) == said(read(text, columns.fill))


WRITTEN = {
    "as it is": lambda text: text,
    "with a byte order mark": lambda text: "\ufeff" + text,
    "without declaration": lambda text: text.partition("\n")[2],
    "with line ends of Windows": lambda text: text.replace("\n", "\r\n"),
    "with line ends of old Macs": lambda text: text.replace("\n", "\r"),
    "in one line": lambda text: re.sub(r">\s+<", "><", text),
    "with tabs": lambda text: text.replace("  ", "\t"),
    "with comments": lambda text: text.replace("<Attribute", "<!-- <Value> --><Attribute"),
    "with comments in texts": lambda text: text.replace("first", "fi<!-- > -->rst"),
    "with attributes in lines": lambda text: text.replace(" ID=", "\n\tID="),
    "with white space in values": lambda text: text.replace('="x', '="\n\tx'),
    "with prefixes": lambda text: re.sub(r"<(/?)(\w)", r"<\1c:\2", text.replace("s=", "s:c=", 1)),
    "with blanks in tags": lambda text: text.replace('">', '" >').replace("/>", " />"),
    "with letters of other scripts": lambda text: text.replace('"A"', '"Förderer \u6a5f"'),
    "with text between elements": lambda text: text.replace("</Attribute>", "</Attribute>more"),
    "with a reference behind the root": lambda text: text.replace("  <Addi", "&#10;<Addi"),
    "with a namespace below": lambda text: text.replace("<WriterHeader", '<WriterHeader xmlns=""'),
}


@pytest.mark.parametrize("write", WRITTEN.values(), ids=WRITTEN)
def test_plain_files_have_the_same_columns_in_both_ways(write):
    agree(write(PLANT))


VALUES = "".join(
    f'<Attribute Name="{name}"><Value>{number} &gt; 0</Value></Attribute>\n{more}'
    for number in range(30)
    for name, more in (("x", ""), ("y", "<Note>text"), ("z", ""), ("z", "<Value>1</Value></Note>"))
)
BESIDE = f'<CAEXFile><InternalElement Name="A" ID="a">{VALUES}</InternalElement></CAEXFile>'


@pytest.mark.parametrize("size", [*range(200, 300, 9), 1 << 16])
@pytest.mark.parametrize("text", [PLANT, BESIDE], ids=["plant", "values beside one another"])
def test_columns_do_not_depend_on_where_the_text_is_cut(text, size, monkeypatch):
    monkeypatch.setattr(sections, "_AT_ONCE", size)
    agree(text)


@pytest.mark.parametrize("said", ["</Attribute>", "</Value>", "<Value>", "<", ">", "&", "<b>", "/"])
def test_a_fault_between_values_that_are_alike_is_left_to_the_parser(said):
    before, sign, behind = BESIDE.rpartition("</Value></Attribute>\n<Attribute")
    for text in (before + said + sign + behind, before + sign + said + behind):
        data = text.encode()
        is_plain = pieces.fill(Document("plant.aml"), Source("plant.aml", data))
        assert not is_plain or wellformed.root(Source("plant.aml", data)) is not None


NOT_PLAIN = {
    "CDATA": lambda text: text.replace("first", "<![CDATA[<Value>]]>"),
    "a processing instruction": lambda text: text.replace("<Version", "<?tool <x> ?><Version"),
    "single quotes": lambda text: text.replace('"x > y"', "'x \" ID=\"5'"),
    "an attribute with prefix": lambda text: text.replace('="y"', '="y" xsi:type="T"'),
    "a reference in an ID": lambda text: text.replace('ID="p2"', 'ID="&lt;p2&gt;"'),
    "a line end in an ID": lambda text: text.replace('ID="p2"', 'ID="p\n2"'),
    "elements in a value": lambda text: text.replace(">5<", "><b>5</b><"),
    "another encoding": lambda text: text.replace("utf-8", "iso-8859-1"),
    "a fault": lambda text: text.replace("</Attribute>", "", 1),
    "a DOCTYPE": lambda text: text.replace("<CAEXFile", "<!DOCTYPE x><CAEXFile", 1),
    "a root of another kind": lambda text: text.replace("CAEXFile", "Plant"),
    "an empty root": lambda text: '<CAEXFile SchemaVersion="3.0"/>',
}


@pytest.mark.parametrize("write", NOT_PLAIN.values(), ids=NOT_PLAIN)
def test_files_that_are_not_plain_are_left_to_the_parser(write):
    document = Document("plant.aml")
    assert not pieces.fill(document, Source("plant.aml", write(PLANT).encode()))
    assert not document.tags
    assert not any(document.texts.values())


def test_a_file_that_is_too_deep_is_left_to_the_parser():
    depth = 600
    text = "<CAEXFile>" + "<InternalElement>" * depth + "</InternalElement>" * depth + "</CAEXFile>"
    assert not pieces.fill(Document("deep.aml"), Source("deep.aml", text.encode()))


def test_a_parser_checks_what_is_out_of_the_way_and_nothing_else(monkeypatch):
    checked = []
    root = wellformed.root
    monkeypatch.setattr(wellformed, "root", lambda one: checked.append(one.name) or root(one))
    monkeypatch.setattr(wellformed, "root_alone", lambda one: root(one))
    read(SOUND, pieces.fill)
    assert not checked
    for text in (PLANT, WRITTEN["with a namespace below"](SOUND), SOUND + "<!-- -->"):
        read(text, pieces.fill)
    read(WRITTEN["with prefixes"](SOUND), pieces.fill)
    assert len(checked) == 4


def test_text_that_is_no_utf_8_is_left_to_the_parser():
    data = PLANT.encode("utf-16")
    assert not pieces.fill(Document("plant.aml"), Source("plant.aml", data))


@pytest.mark.parametrize("said", ["more", '"', '"more"', "&amp;"])
@pytest.mark.parametrize("tag", ["</Attribute>", 'RefPartnerSideB="p2"/>', '<Attribute Name="y">'])
def test_text_where_there_should_be_none_is_noticed_in_both_ways(tag, said):
    clean = PLANT.replace(", more", "")
    before, _, behind = clean.rpartition(tag)
    for fill in (pieces.fill, columns.fill):
        assert not read(clean, fill).has_stray
        assert read(before + tag + said + behind, fill).has_stray


def test_rows_that_say_the_same_but_for_the_id_share_their_attributes():
    document = read(PLANT, pieces.fill)
    one, other = (document.ids.index(id) for id in ("p1", "p2"))
    assert document.attributes[one] is document.attributes[other]
    assert document.alike[one] == document.alike[other] == one
    assert document.node(other).attributes == {"Name": "p", "ID": "p2", "RefBaseClassPath": "L/P"}


TAGS = ("InternalElement", "Attribute", "Value", "Description", "Revision", "InternalLink", "Note")
VALUES = ("", "a", "a > b", "&amp;", "\n", "ID=", "é")


def some_xml(chance, depth=0):
    """A random element: any tag inside any other, with texts between them."""
    tag = chance.choice(TAGS)
    names = chance.sample(("Name", "ID", "Unit", "xmlns"), chance.randint(0, 2))
    start = tag + "".join(f' {name}="{chance.choice(VALUES)}"' for name in names)
    if chance.random() < 0.2:
        return f"<{start}/>"
    is_folded = tag in FOLDED and chance.random() < 0.95
    count = 0 if is_folded or depth > 3 else chance.randint(0, 3)
    inside = (some_xml(chance, depth + 1) + chance.choice(VALUES) for _ in range(count))
    return f"<{start}>{chance.choice(VALUES)}{''.join(inside)}</{tag}>"


def test_random_files_have_the_same_columns_or_are_left_to_the_parser():
    chance, plain = random.Random(4), 0
    for _ in range(600):
        text = "<CAEXFile>" + "".join(some_xml(chance) for _ in range(3)) + "</CAEXFile>"
        if pieces.fill(Document("x"), Source("x", text.encode())):
            plain += 1
            assert said(read(text, pieces.fill)) == said(read(text, columns.fill)), text
    assert plain > 100


SIGNS = (
    *"<>/\"'&;= \n\tx:-!?[]\x00\x0b\x7f\ufffe\ufffd\r#1",
    "]]>",
    "&amp;",
    "&#0;",
    "<!--",
    "-->",
)
TAGS_WRITTEN = (
    "<Value>",
    "</Value>",
    "<Value/>",
    "</Attribute>",
    '<Attribute Name="a">',
    "<!-- -->",
)


def damaged(text, chance):
    """A text with a few small changes anywhere: most of them make it no XML."""
    for _ in range(chance.randint(1, 2)):
        at = chance.randrange(len(text))
        lost = chance.choice((0, 0, 1, 1, 2, 8))
        put = chance.choice((chance.choice(SIGNS), chance.choice(TAGS_WRITTEN), ""))
        text = text[:at] + put + text[at + lost :]
    return text


def is_well_formed(data):
    made = parser()
    try:
        parse(Source("plant.aml", data), made)
    except SourceError:
        return False
    return True


def test_no_damaged_file_passes_that_the_parser_refuses():
    chance, passed, refused = random.Random(7), 0, 0
    for _ in range(2000):
        text = damaged(chance.choice((SOUND, SHORT)), chance)
        data = text.encode()
        if pieces.fill(Document("plant.aml"), Source("plant.aml", data)):
            assert is_well_formed(data), text
            assert said(read(text, pieces.fill)) == said(read(text, columns.fill)), text
            passed += 1
        else:
            refused += not is_well_formed(data)
    assert passed > 100
    assert refused > 500
