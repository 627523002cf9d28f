"""Packages of AutomationML (.amlx): parts are read only if all relationships are consistent."""

import io
import zipfile

import pytest

from sysmlc.sources import Fault, SourceError, load

KIND_PREFIX = "http://schemas.automationml.org/container/relationship/"
ROOT = KIND_PREFIX + "RootDocument"
HEAD = '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">'


def format_relationships(*targets, root="/plant.aml", mode=""):
    targets_by_kind = [
        (ROOT, root),
        *((KIND_PREFIX + "AnyContent", target) for target in targets),
    ]
    elements = "".join(
        f'<Relationship Type="{kind}" Target="{target}" Id="R{n}"{mode if n else ""}/>'
        for n, (kind, target) in enumerate(targets_by_kind)
    )
    return f"{HEAD}{elements}</Relationships>"


def write_package(tmp_path, name="plant.amlx", **parts):
    entries = {"_rels/.rels": format_relationships(), "plant.aml": "<CAEXFile/>", **parts}
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        archive.writestr("[Content_Types].xml", "<Types/>")
        for entry, text in entries.items():
            if text is not None:
                archive.writestr(entry, text)
    path = tmp_path / name
    path.write_bytes(buffer.getvalue())
    return path


def read_names(path):
    return [source.name for source in load(path, path.name)]


def read_problem(path):
    with pytest.raises(SourceError) as raised:
        load(path, path.name)
    assert raised.value.fault is Fault.MALFORMED
    return raised.value.file, raised.value.message


def test_the_documents_of_a_package_are_read(tmp_path):
    parts = {
        "_rels/.rels": format_relationships("/docs/a%20b.pdf"),
        "docs/a b.pdf": "%PDF",
        "_rels/plant.aml.rels": f'{HEAD}<Relationship Type="{KIND_PREFIX}Library" '
        'Target="libs/r.aml" Id="1"/></Relationships>',
        "libs/r.aml": "<CAEXFile/>",
    }
    assert read_names(write_package(tmp_path, **parts)) == [
        "plant.amlx!libs/r.aml",
        "plant.amlx!plant.aml",
    ]


def test_an_external_target_is_not_a_part(tmp_path):
    rels = format_relationships("https://a.b/c.pdf", mode=' TargetMode="External"')
    assert read_names(write_package(tmp_path, **{"_rels/.rels": rels})) == ["plant.amlx!plant.aml"]


@pytest.mark.parametrize(
    ("parts", "location", "message"),
    [
        (
            {"_rels/.rels": format_relationships(root="/gone.aml")},
            "plant.amlx!_rels/.rels",
            "it has no part 'gone.aml'",
        ),
        (
            {"_rels/.rels": format_relationships("/docs/gone.pdf")},
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
                "_rels/.rels": format_relationships().replace(
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
def test_an_inconsistent_package_is_one_located_error(parts, location, message, tmp_path):
    assert read_problem(write_package(tmp_path, **parts)) == (location, message)


def test_an_archive_without_relationships_is_not_a_package(tmp_path):
    path = write_package(tmp_path, name="plant.zip", **{"_rels/.rels": None})
    assert read_names(path) == ["plant.zip!plant.aml"]


def test_files_of_the_operating_system_are_no_parts(tmp_path):
    foreign = {".DS_Store": "x", "__MACOSX/._plant.aml": "x", "docs/Thumbs.db": "x"}
    assert read_names(write_package(tmp_path, **foreign)) == ["plant.amlx!plant.aml"]


def test_any_other_part_needs_a_relationship(tmp_path):
    _, problem = read_problem(write_package(tmp_path, **{"manual.txt": "x"}))
    assert problem == "no relationship of the package leads to its part 'manual.txt'"
