"""Packages of AutomationML (.amlx): parts and relationships must fit before one part is read."""

import io
import zipfile

import pytest

from sysmlc.sources import Fault, SourceError, load

KINDS = "http://schemas.automationml.org/container/relationship/"
ROOT = KINDS + "RootDocument"
HEAD = '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">'


def relationships(*targets, root="/plant.aml", mode=""):
    rows = [(ROOT, root), *((KINDS + "AnyContent", target) for target in targets)]
    elements = "".join(
        f'<Relationship Type="{kind}" Target="{target}" Id="R{n}"{mode if n else ""}/>'
        for n, (kind, target) in enumerate(rows)
    )
    return f"{HEAD}{elements}</Relationships>"


def packed(tmp_path, name="plant.amlx", **parts):
    entries = {"_rels/.rels": relationships(), "plant.aml": "<CAEXFile/>", **parts}
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        archive.writestr("[Content_Types].xml", "<Types/>")
        for entry, text in entries.items():
            if text is not None:
                archive.writestr(entry, text)
    path = tmp_path / name
    path.write_bytes(buffer.getvalue())
    return path


def names(path):
    return [source.name for source in load(path, path.name)]


def problem(path):
    with pytest.raises(SourceError) as caught:
        load(path, path.name)
    assert caught.value.fault is Fault.MALFORMED
    return caught.value.file, caught.value.message


def test_the_documents_of_a_package_are_read(tmp_path):
    parts = {
        "_rels/.rels": relationships("/docs/a%20b.pdf"),
        "docs/a b.pdf": "%PDF",
        "_rels/plant.aml.rels": f'{HEAD}<Relationship Type="{KINDS}Library" Target="libs/r.aml" '
        'Id="1"/></Relationships>',
        "libs/r.aml": "<CAEXFile/>",
    }
    assert names(packed(tmp_path, **parts)) == ["plant.amlx!libs/r.aml", "plant.amlx!plant.aml"]


def test_what_a_package_leaves_outside_is_no_part(tmp_path):
    rels = relationships("https://a.b/c.pdf", mode=' TargetMode="External"')
    assert names(packed(tmp_path, **{"_rels/.rels": rels})) == ["plant.amlx!plant.aml"]


@pytest.mark.parametrize(
    ("parts", "place", "message"),
    [
        (
            {"_rels/.rels": relationships(root="/gone.aml")},
            "plant.amlx!_rels/.rels",
            "it has no part 'gone.aml'",
        ),
        (
            {"_rels/.rels": relationships("/docs/gone.pdf")},
            "plant.amlx!_rels/.rels",
            "it has no part 'docs/gone.pdf'",
        ),
        (
            {"docs/a.pdf": "%PDF"},
            "plant.amlx!docs/a.pdf",
            "no relationship of the package leads to its part 'docs/a.pdf'",
        ),
        (
            {"_rels/.rels": f"{HEAD}</Relationships>"},
            "plant.amlx!_rels/.rels",
            "no relationship names its root document",
        ),
        (
            {"_rels/.rels": None},
            "plant.amlx!_rels/.rels",
            "no relationship names its root document",
        ),
        (
            {
                "_rels/.rels": relationships().replace(
                    "</R", f'<Relationship Type="{ROOT}" Target="/b.aml" Id="2"/></R'
                ),
                "b.aml": "<CAEXFile/>",
            },
            "plant.amlx!_rels/.rels",
            "it has 2 root documents, 'plant.aml' and 'b.aml'",
        ),
        (
            {"_rels/.rels": "<Relationships>"},
            "plant.amlx!_rels/.rels",
            "not well-formed XML: no element found",
        ),
    ],
)
def test_a_package_that_does_not_fit_together_is_one_located_error(parts, place, message, tmp_path):
    assert problem(packed(tmp_path, **parts)) == (place, message)


def test_an_archive_without_relationships_is_no_package(tmp_path):
    path = packed(tmp_path, name="plant.zip", **{"_rels/.rels": None})
    assert names(path) == ["plant.zip!plant.aml"]
