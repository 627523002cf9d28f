"""XML Schemas of the user: only from their folder, and faults in words with their elements."""

import pytest

from sysmlc.sources import Source
from sysmlc.sources.user_schemas import SchemaError, load_schemas

HEAD = '<xs:schema xmlns:xs="http://www.w3.org/2001/XMLSchema"{}>{}</xs:schema>'
ITEM = """<xs:complexType name="Item"><xs:sequence>
  <xs:element name="Size" type="xs:double" minOccurs="0"/>
  <xs:element name="Item" type="Item" minOccurs="0" maxOccurs="unbounded"/></xs:sequence>
  <xs:attribute name="Name" type="xs:string" use="required"/>
  <xs:attribute name="Count" type="xs:integer"/></xs:complexType>"""
FILE = """<xs:element name="File"><xs:complexType><xs:sequence>
  <xs:element name="Item" type="Item" minOccurs="0" maxOccurs="unbounded"/></xs:sequence>
  <xs:attribute name="SchemaVersion" fixed="{}" type="xs:string"/></xs:complexType></xs:element>"""


def schemas(folder, **files):
    for name, text in files.items():
        (folder / f"{name}.xsd").write_text(text)
    return load_schemas(folder)


def plain(version="1"):
    return HEAD.format("", ITEM + FILE.format(version))


def problems(loaded, body):
    _, violations = loaded.find_violations(Source("a.xml", f"<File>{body}</File>".encode()))
    return [(violation.ordinal, violation.element, violation.problem) for violation in violations]


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        ('<Item Name="a"><Size>1.5</Size><Item Name="b"/></Item>', []),
        ("<Item/>", [(1, "Item", "'Item' has no attribute 'Name'")]),
        (
            '<Item Name="a"><Item Name="b" Count="x"/></Item>',
            [
                (
                    2,
                    "a::b",
                    "the attribute 'Count' of 'Item' is 'x', which is not a valid xs:integer",
                )
            ],
        ),
        (
            '<Item Name="a"><Size>big</Size></Item>',
            [(2, "a::Size", "the text of 'Size' is 'big', which is not a valid xs:double")],
        ),
        (
            '<Item Name="a"><Item Name="b"/><Size>1</Size></Item>',
            [(3, "a::Size", "'Size' stands where 'Item' should")],
        ),
        (
            '<Item Name="a" Colour="red"/>',
            [(1, "a", "'Item' must not have the attribute 'Colour'")],
        ),
        ('<Item Name="a">text</Item>', [(1, "a", "'Item' must not hold text")]),
    ],
)
def test_a_violation_has_its_element_and_says_what_is_wrong(body, expected, tmp_path):
    assert problems(schemas(tmp_path, file=plain()), body) == expected


def test_every_violation_is_found_far_behind_line_65535(tmp_path):
    loaded = schemas(tmp_path, file=plain())
    body = '<Item Name="a"/>\n' * 70_000 + '<Item Name="last" Count="x"/>'
    assert [problem[:2] for problem in problems(loaded, body)] == [(70_001, "last")]


def test_the_schema_is_chosen_by_namespace_element_and_version(tmp_path):
    space = HEAD.format(' targetNamespace="urn:x"', '<xs:element name="File"/>')
    loaded = schemas(tmp_path, one=plain("1"), two=plain("2"), other=space)

    def chosen(text):
        schema, _ = loaded.find_violations(Source("a.xml", text))
        return schema.name if schema else None

    assert chosen(b"<File/>") == "one.xsd"
    assert chosen(b'<File SchemaVersion="2"/>') == "two.xsd"
    assert chosen(b'<File xmlns="urn:x" SchemaVersion="2"/>') == "other.xsd"
    assert chosen(b"<Other/>") is None
    assert chosen(b'<File xmlns="urn:y"/>') is None
    assert chosen(b'Package p "Plant"') is None


@pytest.mark.parametrize("text", [b"<File>", b"<!DOCTYPE File><File/>"])
def test_what_is_no_safe_xml_is_not_validated(text, tmp_path):
    loaded = schemas(tmp_path, file=plain())
    with pytest.raises(ValueError, match=r"DOCTYPE|tag"):
        loaded.find_violations(Source("a.xml", text))


def test_a_schema_may_include_another_of_its_folder(tmp_path):
    include = '<xs:include schemaLocation="types/item.xsd"/>'
    (tmp_path / "types").mkdir()
    (tmp_path / "types" / "item.xsd").write_text(HEAD.format("", ITEM))
    loaded = schemas(tmp_path, file=HEAD.format("", include + FILE.format("1")))
    assert [schema.name for schema in loaded.schemas] == ["file.xsd"]
    assert problems(loaded, "<Item/>") == [(1, "Item", "'Item' has no attribute 'Name'")]


@pytest.mark.parametrize(
    ("place", "is_there"),
    [("../item.xsd", True), ("http://example.org/item.xsd", False), ("gone.xsd", False)],
)
def test_a_schema_outside_of_the_folder_is_not_opened(place, is_there, tmp_path):
    folder = tmp_path / "schemas"
    folder.mkdir()
    if is_there:
        (tmp_path / "item.xsd").write_text(HEAD.format("", ITEM))
    text = HEAD.format("", f'<xs:include schemaLocation="{place}"/>' + FILE.format("1"))
    with pytest.raises(SchemaError, match="which is not inside"):
        schemas(folder, file=text)


def test_a_link_that_leads_out_of_the_folder_is_no_schema_of_it(tmp_path):
    folder = tmp_path / "schemas"
    folder.mkdir()
    (tmp_path / "item.xsd").write_text(plain())
    (folder / "link.xsd").symlink_to(tmp_path / "item.xsd")
    with pytest.raises(SchemaError, match="no schema"):
        load_schemas(folder)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("<xs:schema", "cannot be read"),
        ("<html/>", "is not an XML Schema"),
        (HEAD.format("", '<xs:element name="a" type="Gone"/>'), "is broken"),
        ('<!DOCTYPE a [<!ENTITY b "c">]>' + HEAD.format("", ""), "DOCTYPE"),
    ],
)
def test_a_schema_that_cannot_be_used_is_told(text, message, tmp_path):
    with pytest.raises(SchemaError, match=message):
        schemas(tmp_path, file=text)


def test_a_folder_without_schemas_is_told(tmp_path):
    with pytest.raises(SchemaError, match="there is no schema"):
        load_schemas(tmp_path)
    with pytest.raises(SchemaError, match="there is no folder"):
        load_schemas(tmp_path / "gone")
