"""Findings stand at the start tag of what is wrong, with its XPath and a name."""

import pytest

from sysmlc.diagnostics.renderers import make_report
from sysmlc.driver import Request, compile_model

HEAD = (
    '<xmi:XMI xmlns:xmi="http://www.omg.org/spec/XMI/20131001"'
    ' xmlns:uml="http://www.eclipse.org/uml2/5.0.0/UML" xmlns:B="http://b">\n'
)
PLANT = f"""{HEAD}<uml:Model xmi:id="m" name="Plant">
 <packagedElement xmi:type="uml:Class" xmi:id="g" name="Gate">
  %s
 </packagedElement>
</uml:Model>
%s
</xmi:XMI>
"""


def list_locations(folder, inside="", beside="", encode=str.encode):
    """Return rule, line, column, XPath and name of the errors and the diagnostics of reading."""
    path = folder / "plant.uml"
    path.write_bytes(encode(PLANT % (inside, beside)))
    compilation = compile_model(Request(inputs=(path,)))
    return [
        (
            item.diagnostic.rule.code,
            item.line,
            item.column,
            item.xpath,
            item.diagnostic.subject.name,
        )
        for item in make_report(compilation.diagnostics, compilation.sources).findings
        for diagnostic in (item.diagnostic,)
        if diagnostic.is_error or diagnostic.rule.code.startswith("SM1")
    ]


GATE = "/xmi:XMI/uml:Model[1]/packagedElement[1]"


def test_a_child_without_target_has_its_own_location(tmp_path):
    inside = '<ownedAttribute xmi:id="p" name="item"><type xmi:idref="gone"/></ownedAttribute>'
    assert list_locations(tmp_path, inside) == [
        ("SM150", 4, 42, f"{GATE}/ownedAttribute[1]/type[1]", "Plant::Gate::item")
    ]


def test_an_attribute_without_target_is_located_at_its_element(tmp_path):
    inside = '<ownedAttribute\n   xmi:id="p" name="item"\n   type="gone"/>'
    assert list_locations(tmp_path, inside) == [
        ("SM150", 4, 3, f"{GATE}/ownedAttribute[1]", "Plant::Gate::item")
    ]


def test_a_repeated_id_is_located_at_the_second_element(tmp_path):
    inside = '<ownedAttribute xmi:id="p" name="a"/><ownedAttribute xmi:id="p" name="b"/>'
    assert list_locations(tmp_path, inside) == [
        ("SM112", 4, 40, f"{GATE}/ownedAttribute[2]", "Plant::Gate::b")
    ]


def test_unread_elements_and_stereotypes_without_base_are_located(tmp_path):
    inside = '<nestedClassifier xmi:type="uml:Nonsense" xmi:id="n"/>'
    assert list_locations(tmp_path, inside, '<B:Block xmi:id="b" base_Class="gone"/>') == [
        ("SM111", 4, 3, f"{GATE}/nestedClassifier[1]", "Plant::Gate::<nestedClassifier>"),
        ("SM113", 7, 1, "/xmi:XMI/B:Block[1]", "Block"),
    ]


def test_an_approximated_row_is_located_at_its_element(tmp_path):
    several = "<body>a</body><body>b</body>"
    inside = (
        '<ownedAttribute xmi:id="p" name="item"><upperValue xmi:type="uml:OpaqueExpression">'
        f"{several}</upperValue></ownedAttribute>"
    )
    assert list_locations(tmp_path, inside) == [
        (
            "SM114",
            4,
            42,
            f"{GATE}/ownedAttribute[1]/upperValue[1]",
            "Plant::Gate::item::<upperValue>",
        )
    ]


def test_a_missing_library_is_located_at_its_first_use(tmp_path):
    inside = '<ownedAttribute name="item"><type href="lib.uml#_x"/></ownedAttribute>'
    assert list_locations(tmp_path, inside) == [
        ("SM152", 4, 31, f"{GATE}/ownedAttribute[1]/type[1]", "Plant::Gate::item")
    ]


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16", "windows-1252"])
@pytest.mark.parametrize("newline", ["\n", "\r\n"])
def test_malformed_xml_is_located_in_characters_where_the_parser_stopped(
    tmp_path, encoding, newline
):
    def encode(text):
        declared = f'<?xml version="1.0" encoding="{encoding}"?>\n{text}'
        return declared.replace("\n", newline).encode(encoding)

    inside = '<ownedAttribute name="ééé"/></wrong>'
    assert list_locations(tmp_path, inside, encode=encode) == [
        ("SM100", 5, 3 + inside.index("wrong"), GATE, "plant.uml")
    ]


def test_a_file_that_is_cut_off_ends_in_the_element_that_is_open(tmp_path):
    (location,) = list_locations(
        tmp_path, encode=lambda text: text[: text.index("</packagedElement>")].encode()
    )
    assert (location[0], location[3]) == ("SM100", GATE)


def test_large_line_and_column_numbers(tmp_path):
    inside = "\n" * 70_000 + '<ownedAttribute xmi:id="p" name="a" type="gone"/>'
    assert list_locations(tmp_path, inside)[0][:3] == ("SM150", 70_004, 1)
    inside = '<ownedAttribute name="a"/>' * 5_000 + '<ownedAttribute name="b" type="gone"/>'
    assert list_locations(tmp_path, inside)[0][:4] == (
        "SM150",
        4,
        3 + 26 * 5_000,
        f"{GATE}/ownedAttribute[5001]",
    )


def test_strict_input_is_located_at_the_root(tmp_path):
    path = tmp_path / "plant.uml"
    path.write_text(PLANT % ('<nestedClassifier xmi:type="uml:Nonsense"/>', ""))
    compilation = compile_model(Request(inputs=(path,), strict_input=True))
    places = {
        item.diagnostic.rule.code: (item.line, item.column, item.xpath)
        for item in make_report(compilation.diagnostics, compilation.sources).findings
    }
    assert places["SM174"] == (1, 1, "/xmi:XMI")
