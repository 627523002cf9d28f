"""XML schemas of the user: which are loaded, and how violations are described."""

import pytest

from sysmlc.sources import Source
from sysmlc.sources.user_schemas import SchemaError, load_schemas

SCHEMA = '<xs:schema xmlns:xs="http://www.w3.org/2001/XMLSchema"{}>{}</xs:schema>'
ITEM = """<xs:complexType name="Item"><xs:sequence>
  <xs:element name="Size" type="xs:double" minOccurs="0"/>
  <xs:element name="Item" type="Item" minOccurs="0" maxOccurs="unbounded"/></xs:sequence>
  <xs:attribute name="Name" type="xs:string" use="required"/>
  <xs:attribute name="Count" type="xs:integer"/></xs:complexType>"""
FILE = """<xs:element name="File"><xs:complexType><xs:sequence>
  <xs:element name="Item" type="Item" minOccurs="0" maxOccurs="unbounded"/></xs:sequence>
  <xs:attribute name="SchemaVersion" fixed="{}" type="xs:string"/></xs:complexType></xs:element>"""


def write_schemas(folder, **files):
    for name, text in files.items():
        (folder / f"{name}.xsd").write_text(text)
    return load_schemas(folder)


def format_schema(version="1"):
    return SCHEMA.format("", ITEM + FILE.format(version))


def list_violations(schemas, body):
    _, violations = schemas.find_violations(Source("a.xml", f"<File>{body}</File>".encode()))
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
            [(3, "a::Size", "unexpected element 'Size'; expected 'Item'")],
        ),
        (
            '<Item Name="a" Colour="red"/>',
            [(1, "a", "'Item' must not have the attribute 'Colour'")],
        ),
        ('<Item Name="a">text</Item>', [(1, "a", "'Item' must not hold text")]),
    ],
)
def test_a_violation_names_its_element_and_the_problem(body, expected, tmp_path):
    assert list_violations(write_schemas(tmp_path, file=format_schema()), body) == expected


def test_violations_after_line_65535_have_their_element(tmp_path):
    schemas = write_schemas(tmp_path, file=format_schema())
    body = '<Item Name="a"/>\n' * 70_000 + '<Item Name="last" Count="x"/>'
    assert [problem[:2] for problem in list_violations(schemas, body)] == [(70_001, "last")]


def test_the_schema_is_selected_by_namespace_element_and_version(tmp_path):
    with_namespace = SCHEMA.format(' targetNamespace="urn:x"', '<xs:element name="File"/>')
    schemas = write_schemas(
        tmp_path, first=format_schema("1"), second=format_schema("2"), foreign=with_namespace
    )

    def select_schema(text):
        schema, _ = schemas.find_violations(Source("a.xml", text))
        return schema.name if schema else None

    assert select_schema(b"<File/>") == "first.xsd"
    assert select_schema(b'<File SchemaVersion="2"/>') == "second.xsd"
    assert select_schema(b'<File xmlns="urn:x" SchemaVersion="2"/>') == "foreign.xsd"
    assert select_schema(b"<Other/>") is None
    assert select_schema(b'<File xmlns="urn:y"/>') is None
    assert select_schema(b'Package p "Plant"') is None


@pytest.mark.parametrize("text", [b"<File>", b"<!DOCTYPE File><File/>"])
def test_malformed_or_unsafe_xml_is_not_validated(text, tmp_path):
    schemas = write_schemas(tmp_path, file=format_schema())
    with pytest.raises(ValueError, match=r"DOCTYPE|tag"):
        schemas.find_violations(Source("a.xml", text))


def test_a_schema_may_include_another_of_its_folder(tmp_path):
    include = '<xs:include schemaLocation="types/item.xsd"/>'
    (tmp_path / "types").mkdir()
    (tmp_path / "types" / "item.xsd").write_text(SCHEMA.format("", ITEM))
    schemas = write_schemas(tmp_path, file=SCHEMA.format("", include + FILE.format("1")))
    assert [schema.name for schema in schemas.schemas] == ["file.xsd"]
    assert list_violations(schemas, "<Item/>") == [(1, "Item", "'Item' has no attribute 'Name'")]


@pytest.mark.parametrize(
    ("location", "exists"),
    [("../item.xsd", True), ("http://example.org/item.xsd", False), ("gone.xsd", False)],
)
def test_a_schema_outside_of_the_folder_is_not_opened(location, exists, tmp_path):
    folder = tmp_path / "schemas"
    folder.mkdir()
    if exists:
        (tmp_path / "item.xsd").write_text(SCHEMA.format("", ITEM))
    text = SCHEMA.format("", f'<xs:include schemaLocation="{location}"/>' + FILE.format("1"))
    with pytest.raises(SchemaError, match="which is not inside"):
        write_schemas(folder, file=text)


def test_a_link_out_of_the_folder_is_not_a_schema(tmp_path):
    folder = tmp_path / "schemas"
    folder.mkdir()
    (tmp_path / "item.xsd").write_text(format_schema())
    (folder / "link.xsd").symlink_to(tmp_path / "item.xsd")
    with pytest.raises(SchemaError, match="no schema"):
        load_schemas(folder)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("<xs:schema", "cannot be read"),
        ("<html/>", "is not an XML Schema"),
        (SCHEMA.format("", '<xs:element name="a" type="Gone"/>'), "is broken"),
        ('<!DOCTYPE a [<!ENTITY b "c">]>' + SCHEMA.format("", ""), "DOCTYPE"),
    ],
)
def test_an_unusable_schema_is_reported(text, message, tmp_path):
    with pytest.raises(SchemaError, match=message):
        write_schemas(tmp_path, file=text)


def test_a_folder_without_schemas_is_reported(tmp_path):
    with pytest.raises(SchemaError, match="there is no schema"):
        load_schemas(tmp_path)
    with pytest.raises(SchemaError, match="there is no folder"):
        load_schemas(tmp_path / "gone")
