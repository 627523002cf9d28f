"""Hostile XML gets a located diagnostic, within a second and 300 MB."""

import threading
from http.server import BaseHTTPRequestHandler, HTTPServer

import pytest

from fuzz.checker import CLASS, HEAD, ROOT, make_model, nest_entities

BIG = 11_000_000
BODY = '<ownedComment xmi:type="uml:Comment" xmi:id="k"><body>%s</body></ownedComment>'


def make_document(doctype, content="&x;"):
    return f"{HEAD}{doctype}{ROOT}{content}</uml:Model>"


DOCTYPES = {
    "internal entity": make_document("<!DOCTYPE a [<!ENTITY x 'y'>]>"),
    "file entity": make_document('<!DOCTYPE a [<!ENTITY x SYSTEM "secret.txt">]>'),
    "external DTD": make_document('<!DOCTYPE a SYSTEM "secret.txt">'),
    "parameter entity": make_document('<!DOCTYPE a [<!ENTITY % p SYSTEM "secret.txt"> %p;]>'),
    "public DTD": make_document('<!DOCTYPE a PUBLIC "-//W3C//DTD XHTML 1.0//EN" "x.dtd">'),
    "laughs 10^5": make_document(nest_entities(5), "&e4;"),
    "laughs 10^7": make_document(nest_entities(7), "&e6;"),
    "laughs 10^9": make_document(nest_entities(9), "&e8;"),
    "quadratic": make_document(f"<!DOCTYPE a [<!ENTITY x '{'x' * 100_000}'>]>", "&x;" * 100_000),
    "attribute bomb": make_document(
        f"<!DOCTYPE a [<!ENTITY x '{'x' * 100_000}'>]>", f"<a b='{'&x;' * 10_000}'/>"
    ),
    "after a megabyte": make_document(f"<!--{'x' * (1 << 20)}--><!DOCTYPE a>"),
    "recursive entity": make_document("<!DOCTYPE a [<!ENTITY x '&y;'><!ENTITY y '&x;'>]>"),
}


@pytest.mark.parametrize("name", DOCTYPES)
def test_every_doctype_is_refused_at_its_line(checker, name):
    checker.write("TOPSECRET", "secret.txt")
    result = checker.check_content(DOCTYPES[name])
    assert (result.exit_code, result.diagnostic.code, result.diagnostic.line) == (1, "SM100", 2)
    assert result.diagnostic.column
    assert "has a DOCTYPE, which is refused" in result.diagnostic.message
    assert "TOPSECRET" not in result.command.out + result.command.err


def test_an_undeclared_entity_is_reported_at_its_position(checker):
    diagnostic = checker.check_content(make_document("", "<a>&x;</a>")).diagnostic
    assert (diagnostic.code, diagnostic.line, diagnostic.column) == ("SM100", 2, len(ROOT) + 4)
    assert "undefined entity" in diagnostic.message


def test_nothing_is_fetched_from_the_network(checker):
    requests = []

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self):
            requests.append(self.path)
            self.send_error(404)

    server = HTTPServer(("127.0.0.1", 0), Handler)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    server_url = f"http://127.0.0.1:{server.server_port}"
    xsi = 'xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"'
    with_schema_location = make_model().replace(
        "xmi:id", f'{xsi} xsi:schemaLocation="{server_url}/s {server_url}/s" xmi:id', 1
    )
    include = f'<i:include xmlns:i="http://www.w3.org/2001/XInclude" href="{server_url}/i"/>'
    general = f'<generalization xmi:id="g"><general href="{server_url}/m.uml#x"/></generalization>'
    with_reference = CLASS.replace("/>", f">{general}</packagedElement>")
    try:
        for text in (
            make_document(f'<!DOCTYPE a SYSTEM "{server_url}/x.dtd">'),
            make_document(f'<!DOCTYPE a [<!ENTITY % p SYSTEM "{server_url}/x.dtd"> %p;]>'),
            with_schema_location,
            make_model(include),
            make_model(with_reference),
        ):
            checker.check_content(text)
    finally:
        server.shutdown()
        server.server_close()
    assert requests == []


def test_xinclude_is_not_expanded(checker):
    checker.write("TOPSECRET", "secret.txt")
    include = (
        '<i:include xmlns:i="http://www.w3.org/2001/XInclude" parse="text" href="secret.txt"/>'
    )
    result = checker.check_content(make_model(include))
    assert "TOPSECRET" not in result.command.out + result.command.err


@pytest.mark.parametrize("depth", [300, 480])
def test_elements_nested_less_deeply_than_the_limit_are_read(checker, depth):
    packages = '<packagedElement xmi:type="uml:Package" name="p">' * depth
    result = checker.check_content(make_model(packages + "</packagedElement>" * depth))
    assert result.exit_code == 0


@pytest.mark.parametrize("depth", [501, 3_000, 1_000_000])
@pytest.mark.parametrize("around", ["%s", "<xmi:Extension><diagramRepresentation>%s"])
def test_elements_nested_deeper_than_the_limit_are_refused_at_their_position(
    checker, depth, around
):
    result = checker.check_content(make_model(around % ("<a>" * depth)))
    assert (result.exit_code, result.diagnostic.code, result.diagnostic.line) == (2, "SM178", 2)
    assert result.diagnostic.column < len(make_model()) + 600 * 3
    assert "nested more than 500 deep" in result.diagnostic.message


LONG = {
    "text": BODY % ("x" * BIG),
    "text in lines": BODY % ("x\n" * (BIG // 2)),
    "CDATA": BODY % f"<![CDATA[{'<' * BIG}]]>",
    "character references": BODY % ("&#65;" * (BIG // 5)),
    "name": CLASS.replace('"C"', f'"{"C" * BIG}"'),
    "name in lines": CLASS.replace('"C"', f'"{"C&#10;" * (BIG // 6)}"'),
    "id": CLASS.replace('"c"', f'"{"c" * BIG}"'),
    "comment": f"<!--{'c' * BIG}-->",
    "instruction": f"<?c {'c' * BIG}?>",
    "namespaces": "<a " + " ".join(f"xmlns:a{n}='u'" for n in range(100_000)) + "/>",
}


@pytest.mark.parametrize("content", LONG)
def test_long_content_is_read(checker, content):
    assert checker.check_content(make_model(LONG[content])).exit_code == 0


TOO_MANY = {
    "SM128": f'<packagedElement xmi:type="uml:Association" memberEnd="{"c " * (BIG // 5)}"/>',
    "SM129": CLASS.replace("/>", " ".join(f' a{n}="1"' for n in range(200_000)) + "/>"),
}


@pytest.mark.parametrize("code", TOO_MANY)
def test_too_many_references_or_attributes_are_reported_once_at_their_element(checker, code):
    result = checker.check_content(make_model(TOO_MANY[code]))
    assert result.exit_code == 1
    assert [
        (diagnostic.line, diagnostic.column)
        for diagnostic in result.diagnostics
        if diagnostic.code == code
    ] == [(2, len(ROOT) + 1)]


def test_nearly_too_many_attributes_are_read(checker):
    class_ = CLASS.replace("/>", " ".join(f' a{n}="1"' for n in range(900)) + "/>")
    assert set(checker.check_content(make_model(class_)).codes) == {"SM124"}


@pytest.mark.parametrize("name", ["type", "href"])
def test_a_long_unresolved_reference_is_abbreviated_in_the_message(checker, name):
    reference = "a/" * (BIG // 2)
    general = f'<generalization xmi:id="g"><general href="{reference}"/></generalization>'
    content = {
        "type": CLASS.replace("uml:Class", f"uml:{reference}"),
        "href": CLASS.replace("/>", f">{general}</packagedElement>"),
    }[name]
    result = checker.check_content(make_model(content))
    assert result.codes
    assert max(len(diagnostic.message) for diagnostic in result.diagnostics) < 1000


def test_a_file_truncated_at_any_byte_is_reported(tmp_path):
    from sysmlc.diagnostics.locations import locate
    from sysmlc.driver import Request, compile_model

    data = make_model().encode()
    path = tmp_path / "m.uml"
    for length in range(len(data)):
        path.write_bytes(data[:length])
        compilation = compile_model(Request((path,)))
        (diagnostic,) = compilation.diagnostics
        assert compilation.exit_code() == 1
        if data[:length].count(b"<uml:Model "):
            place = diagnostic.subject.place
            assert diagnostic.rule.code == "SM100", length
            assert locate(compilation.sources, [place])[place].line in (1, 2, 3), length


ENCODED = {
    "latin-1 bytes in UTF-8": (
        make_model().replace('"C"', '"é"').encode("latin-1"),
        "not encoded in UTF-8",
    ),
    "UTF-16 without being it": (
        make_model(head=HEAD.replace("8", "16")),
        "declaration is incorrect",
    ),
    "UTF-8 in UTF-16": (make_model().encode("utf-16"), "declaration is incorrect"),
    "mark of UTF-8, UTF-16 declared": (
        make_model(head=HEAD.replace("8", "16")).encode("utf-8-sig"),
        "declaration is incorrect",
    ),
    "half a character of UTF-16": (
        make_model(head=HEAD.replace("8", "16")).encode("utf-16")[:-1],
        "unclosed token",
    ),
    "unknown": (make_model(head=HEAD.replace("UTF-8", "klingon")), "encoding 'klingon' is unknown"),
    "no encoding of texts": (
        make_model(head=HEAD.replace("UTF-8", "base64")),
        "'base64' is unknown",
    ),
    "UTF-7": (make_model(head=HEAD.replace("UTF-8", "UTF-7")), "encoding 'UTF-7' is unknown"),
    "broken Shift_JIS": (
        make_model(head=HEAD.replace("UTF-8", "Shift_JIS"))
        .replace('"C"', '"\x81"')
        .encode("latin-1"),
        "not encoded in Shift_JIS",
    ),
    "NUL": (make_model().replace('"C"', '"\0"'), "invalid token"),
    "NULs at the end": (make_model() + "\0" * 100, "invalid token"),
    "surrogate": (
        make_model().replace('"C"', '"\ud800"').encode("utf-8", "surrogatepass"),
        "not encoded in UTF-8",
    ),
    "overlong": (make_model().encode().replace(b'"C"', b'"\xc0\xaf"'), "not encoded in UTF-8"),
    "reference to NUL": (make_model().replace('"C"', '"&#0;"'), "invalid character number"),
    "reference to a surrogate": (
        make_model().replace('"C"', '"&#xD800;"'),
        "invalid character number",
    ),
}


@pytest.mark.parametrize("name", ENCODED)
def test_wrong_encodings_and_characters_are_located(checker, name):
    data, reason = ENCODED[name]
    result = checker.check_content(data)
    assert (result.exit_code, result.diagnostic.code) == (1, "SM100")
    assert reason in result.diagnostic.message
    assert result.diagnostic.line in (1, 2)
    assert result.diagnostic.column


@pytest.mark.parametrize("version", ["1.1", "2.0"])
def test_every_version_of_xml_is_read(checker, version):
    assert checker.check_content(make_model(head=HEAD.replace("1.0", version))).exit_code == 0


@pytest.mark.parametrize(
    "data", [b"", b" \n", HEAD.encode(), b"\x1f\x8b\x08" + b"x" * 50, b"<html/>", b"{}", b"\0" * 99]
)
def test_a_file_that_is_not_a_model_is_reported_as_such(checker, data):
    result = checker.check_content(data)
    assert (result.exit_code, result.diagnostic.code, result.diagnostic.file) == (
        1,
        "SM171",
        "m.uml",
    )
