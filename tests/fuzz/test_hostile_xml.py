"""Every case of the security table about XML: a located finding, within a second and 300 MB."""

import threading
from http.server import BaseHTTPRequestHandler, HTTPServer

import pytest

from fuzz.answers import CLASS, HEAD, ROOT, model

BOMB = "<!ENTITY e0 'lolololol'>"
BIG = 11_000_000
BODY = '<ownedComment xmi:type="uml:Comment" xmi:id="k"><body>%s</body></ownedComment>'


def laughs(times):
    steps = range(1, times)
    more = "".join(f"<!ENTITY e{n} '{f'&e{n - 1};' * 10}'>" for n in steps)
    return f"{HEAD}<!DOCTYPE a [{BOMB}{more}]>{ROOT}&e{times - 1};</uml:Model>"


def with_doctype(doctype, content="&x;"):
    return f"{HEAD}{doctype}{ROOT}{content}</uml:Model>"


DOCTYPES = {
    "internal entity": with_doctype("<!DOCTYPE a [<!ENTITY x 'y'>]>"),
    "file entity": with_doctype('<!DOCTYPE a [<!ENTITY x SYSTEM "secret.txt">]>'),
    "external DTD": with_doctype('<!DOCTYPE a SYSTEM "secret.txt">'),
    "parameter entity": with_doctype('<!DOCTYPE a [<!ENTITY % p SYSTEM "secret.txt"> %p;]>'),
    "public DTD": with_doctype('<!DOCTYPE a PUBLIC "-//W3C//DTD XHTML 1.0//EN" "x.dtd">'),
    "laughs 10^5": laughs(5),
    "laughs 10^7": laughs(7),
    "laughs 10^9": laughs(9),
    "quadratic": with_doctype(f"<!DOCTYPE a [<!ENTITY x '{'x' * 100_000}'>]>", "&x;" * 100_000),
    "attribute bomb": with_doctype(
        f"<!DOCTYPE a [<!ENTITY x '{'x' * 100_000}'>]>", f"<a b='{'&x;' * 10_000}'/>"
    ),
    "after a megabyte": with_doctype(f"<!--{'x' * (1 << 20)}--><!DOCTYPE a>"),
    "recursive entity": with_doctype("<!DOCTYPE a [<!ENTITY x '&y;'><!ENTITY y '&x;'>]>"),
}


@pytest.mark.parametrize("name", DOCTYPES)
def test_every_doctype_is_refused_where_it_stands(asked, name):
    asked.write("TOPSECRET", "secret.txt")
    answer = asked.about(DOCTYPES[name])
    assert (answer.ended.code, answer.only.code, answer.only.line) == (1, "SM100", 2)
    assert answer.only.column
    assert "has a DOCTYPE, which is refused" in answer.only.message
    assert "TOPSECRET" not in answer.ended.out + answer.ended.err


def test_an_entity_that_is_not_declared_is_no_text(asked):
    found = asked.about(with_doctype("", "<a>&x;</a>")).only
    assert (found.code, found.line, found.column) == ("SM100", 2, len(ROOT) + 4)
    assert "undefined entity" in found.message


def test_nothing_is_fetched_from_the_network(asked):
    hits = []

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self):
            hits.append(self.path)
            self.send_error(404)

    server = HTTPServer(("127.0.0.1", 0), Handler)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    here = f"http://127.0.0.1:{server.server_port}"
    xsi = 'xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"'
    located = model().replace("xmi:id", f'{xsi} xsi:schemaLocation="{here}/s {here}/s" xmi:id', 1)
    include = f'<i:include xmlns:i="http://www.w3.org/2001/XInclude" href="{here}/i"/>'
    general = f'<generalization xmi:id="g"><general href="{here}/m.uml#x"/></generalization>'
    refers = CLASS.replace("/>", f">{general}</packagedElement>")
    try:
        for text in (
            with_doctype(f'<!DOCTYPE a SYSTEM "{here}/x.dtd">'),
            with_doctype(f'<!DOCTYPE a [<!ENTITY % p SYSTEM "{here}/x.dtd"> %p;]>'),
            located,
            model(include),
            model(refers),
        ):
            asked.about(text)
    finally:
        server.shutdown()
        server.server_close()
    assert hits == []


def test_xinclude_is_not_expanded(asked):
    asked.write("TOPSECRET", "secret.txt")
    include = (
        '<i:include xmlns:i="http://www.w3.org/2001/XInclude" parse="text" href="secret.txt"/>'
    )
    answer = asked.about(model(include))
    assert "TOPSECRET" not in answer.ended.out + answer.ended.err


@pytest.mark.parametrize("depth", [300, 480])
def test_what_is_nested_deeper_than_any_model_is_still_read(asked, depth):
    packages = '<packagedElement xmi:type="uml:Package" name="p">' * depth
    answer = asked.about(model(packages + "</packagedElement>" * depth))
    assert answer.ended.code == 0


@pytest.mark.parametrize("depth", [501, 3_000, 1_000_000])
@pytest.mark.parametrize("around", ["%s", "<xmi:Extension><diagramRepresentation>%s"])
def test_what_is_nested_deeper_is_refused_where_it_is_too_deep(asked, depth, around):
    found = asked.about(model(around % ("<a>" * depth)))
    assert (found.ended.code, found.only.code, found.only.line) == (2, "SM178", 2)
    assert found.only.column < len(model()) + 600 * 3
    assert "nested more than 500 deep" in found.only.message


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


@pytest.mark.parametrize("what", LONG)
def test_long_content_is_read(asked, what):
    assert asked.about(model(LONG[what])).ended.code == 0


REFUSED = {
    "SM128": f'<packagedElement xmi:type="uml:Association" memberEnd="{"c " * (BIG // 5)}"/>',
    "SM129": CLASS.replace("/>", " ".join(f' a{n}="1"' for n in range(200_000)) + "/>"),
}


@pytest.mark.parametrize("code", REFUSED)
def test_crowds_are_cut_and_told(asked, code):
    answer = asked.about(model(REFUSED[code]))
    assert answer.ended.code == 1
    assert [(f.line, f.column) for f in answer.findings if f.code == code] == [(2, len(ROOT) + 1)]


def test_what_is_nearly_a_crowd_is_read(asked):
    twenty = CLASS.replace("/>", " ".join(f' a{n}="1"' for n in range(900)) + "/>")
    assert set(asked.about(model(twenty)).codes) == {"SM124"}


@pytest.mark.parametrize("name", ["type", "href"])
def test_long_references_lead_nowhere_and_are_told_shortly(asked, name):
    long = "a/" * (BIG // 2)
    general = f'<generalization xmi:id="g"><general href="{long}"/></generalization>'
    content = {
        "type": CLASS.replace("uml:Class", f"uml:{long}"),
        "href": CLASS.replace("/>", f">{general}</packagedElement>"),
    }[name]
    answer = asked.about(model(content))
    assert answer.codes
    assert max(len(found.message) for found in answer.findings) < 1000


def test_a_truncated_file_is_reported_whichever_byte_is_the_last(tmp_path):
    from sysmlc.diagnostics.locations import locate
    from sysmlc.driver import Request, compile_model

    whole = model().encode()
    path = tmp_path / "m.uml"
    for length in range(len(whole)):
        path.write_bytes(whole[:length])
        made = compile_model(Request((path,)))
        (found,) = made.diagnostics
        assert made.exit_code() == 1
        if whole[:length].count(b"<uml:Model "):
            place = found.subject.place
            assert found.rule.code == "SM100", length
            assert locate(made.sources, [place])[place].line in (1, 2, 3), length


ENCODED = {
    "latin-1 bytes in UTF-8": (
        model().replace('"C"', '"é"').encode("latin-1"),
        "not encoded in UTF-8",
    ),
    "UTF-16 without being it": (model(head=HEAD.replace("8", "16")), "declaration is incorrect"),
    "UTF-8 in UTF-16": (model().encode("utf-16"), "declaration is incorrect"),
    "mark of UTF-8, UTF-16 declared": (
        model(head=HEAD.replace("8", "16")).encode("utf-8-sig"),
        "declaration is incorrect",
    ),
    "half a character of UTF-16": (
        model(head=HEAD.replace("8", "16")).encode("utf-16")[:-1],
        "unclosed token",
    ),
    "unknown": (model(head=HEAD.replace("UTF-8", "klingon")), "encoding 'klingon' is unknown"),
    "no encoding of texts": (model(head=HEAD.replace("UTF-8", "base64")), "'base64' is unknown"),
    "UTF-7": (model(head=HEAD.replace("UTF-8", "UTF-7")), "encoding 'UTF-7' is unknown"),
    "broken Shift_JIS": (
        model(head=HEAD.replace("UTF-8", "Shift_JIS")).replace('"C"', '"\x81"').encode("latin-1"),
        "not encoded in Shift_JIS",
    ),
    "NUL": (model().replace('"C"', '"\0"'), "invalid token"),
    "NULs at the end": (model() + "\0" * 100, "invalid token"),
    "surrogate": (
        model().replace('"C"', '"\ud800"').encode("utf-8", "surrogatepass"),
        "not encoded in UTF-8",
    ),
    "overlong": (model().encode().replace(b'"C"', b'"\xc0\xaf"'), "not encoded in UTF-8"),
    "reference to NUL": (model().replace('"C"', '"&#0;"'), "invalid character number"),
    "reference to a surrogate": (model().replace('"C"', '"&#xD800;"'), "invalid character number"),
}


@pytest.mark.parametrize("name", ENCODED)
def test_wrong_encodings_and_characters_are_located(asked, name):
    data, reason = ENCODED[name]
    answer = asked.about(data)
    assert (answer.ended.code, answer.only.code) == (1, "SM100")
    assert reason in answer.only.message
    assert answer.only.line in (1, 2)
    assert answer.only.column


@pytest.mark.parametrize("version", ["1.1", "2.0"])
def test_the_version_of_xml_does_not_matter(asked, version):
    assert asked.about(model(head=HEAD.replace("1.0", version))).ended.code == 0


@pytest.mark.parametrize(
    "data", [b"", b" \n", HEAD.encode(), b"\x1f\x8b\x08" + b"x" * 50, b"<html/>", b"{}", b"\0" * 99]
)
def test_what_is_no_model_is_said_to_be_none(asked, data):
    answer = asked.about(data)
    assert (answer.ended.code, answer.only.code, answer.only.file) == (1, "SM171", "m.uml")
