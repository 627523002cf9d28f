"""Snapshots inside a MagicDraw model saved as one XML file: as good as those in an archive."""

import pytest
from reading_xmi import read, source
from test_xmi_snapshots import APPLIED, COMPANY, MODEL, SYSML, library, model, snapshot

EXTENSION = """<xmi:Extension extender='MagicDraw UML 19.0'>%s</xmi:Extension>
</xmi:XMI>"""
NAME = (
    "proxy.local__PROJECT$h%s_resource_com$dnomagic$dmagicdraw$duml_umodel$dshared_umodel$dsnapshot"
)


def part(inside, name="a"):
    document = snapshot(inside).data.decode().partition("?>")[2]
    header = "&lt;?xml version=&quot;1.0&quot; encoding=&quot;ASCII&quot;?&gt;"
    return f"<filePart name='{NAME % name}' type='XML' header='{header}'>{document}</filePart>"


def whole(*parts, inside=MODEL, applied="", name="plant.xml"):
    text = model(inside, applied, name).data.decode()
    return source(text.replace("</xmi:XMI>", EXTENSION % "\n".join(parts)), name)


def test_a_part_is_read_like_an_entry_of_an_archive():
    one = read(whole(part(COMPANY), part(SYSML, "b"), applied=APPLIED)).graph
    other = read(model(applied=APPLIED), snapshot(COMPANY), snapshot(SYSML, "b")).graph
    assert len(library(one)) > 15
    assert library(one) == library(other)
    assert [(e.id, e.kind, e.name, e.attrs) for e in one] == [
        (e.id, e.kind, e.name, e.attrs) for e in other
    ]


def test_every_element_is_counted_once():
    reading = read(whole(part(COMPANY)))
    (file,) = reading.coverage.as_json()["files"]
    # The model: 10 elements, and the extension, the part and 28 elements in it.
    assert file["elements"] == reading.totals["elements"]
    assert reading.totals["ignored_notation"] >= 28


def test_references_of_a_part_are_not_references_of_the_model():
    """A snapshot has references of its own, which say nothing of the model."""
    assert library(read(whole(part(COMPANY), inside="")).graph) == {}


@pytest.mark.parametrize(
    "text",
    [
        f"<filePart name='{NAME % 'a'}' type='XML'/>",
        f"<filePart name='{NAME % 'a'}' type='XML'></filePart>",
        "<filePart name='Binaries.properties' type='BINARY'>H4sIAAAA</filePart>",
        "<filePart type='XML'><xmi:XMI/></filePart>",
        f"<filePart name='{NAME % 'a'}' type='XML'><a><b/></a></filePart>",
    ],
)
def test_other_parts_are_skipped(text):
    reading = read(whole(text))
    assert library(reading.graph) == {}
    assert [f for f in reading.findings if "snapshot" in f] == []


def test_a_part_that_does_not_end_takes_no_time():
    damaged = whole().data + f"<filePart name='{NAME % 'a'}'>".encode() * 20_000
    assert "malformed-file" in read(source(damaged, "plant.xml")).findings[0]
