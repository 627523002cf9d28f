"""Project archives (.kpar): descriptions, checksums and usages."""

import hashlib
import io
import json
import zipfile

import pytest

from sysmlc.diagnostics import Sink
from sysmlc.language.interchange import open_archive, read_project, resolve_usages
from sysmlc.language.interchange.projects import satisfies_version
from sysmlc.sources import Source

TEXT = b"package Robots;"
SUM = hashlib.sha256(TEXT).hexdigest()
ABOUT = {"name": "Robots", "version": "1.2.0"}


def meta(value=SUM, algorithm="SHA256", file="Robots.sysml", index=None):
    checksum = {file: {"value": value, "algorithm": algorithm}}
    return {"index": index or {"Robots": "Robots.sysml"}, "checksum": checksum}


def archive(about=ABOUT, said=None, files=None, name="Robots.kpar"):
    """A .kpar with what is said about it and its files; None leaves a description out."""
    said = meta() if said is None else said
    packed = {".project.json": about, ".meta.json": said, **(files or {"Robots.sysml": TEXT})}
    written = io.BytesIO()
    with zipfile.ZipFile(written, "w") as zipped:
        for file, content in packed.items():
            if content is not None:
                data = content if isinstance(content, bytes) else json.dumps(content).encode()
                zipped.writestr(file, data)
    return Source(name, written.getvalue())


def opened(*arguments, **named):
    sink = Sink()
    found = open_archive(archive(*arguments, **named), sink)
    return found, messages(sink)


def messages(sink):
    return [f"{found.rule.code} {found.message}" for found in sink]


def test_an_archive_is_a_project_with_files():
    found, told = opened({**ABOUT, "usage": [{"resource": "a.kpar", "versionConstraint": "1"}]})
    assert told == []
    assert (found.name, found.version, dict(found.index)) == (
        "Robots",
        "1.2.0",
        {"Robots": "Robots.sysml"},
    )
    assert [(use.resource, use.constraint) for use in found.usages] == [("a.kpar", "1")]
    assert [source.name for source in found.files] == ["Robots.kpar!Robots.sysml"]


@pytest.mark.parametrize("algorithm", ["sha256", "SHA-256"])
def test_a_checksum_that_fits_is_not_mentioned(algorithm):
    assert opened(said=meta(algorithm=algorithm))[1] == []


@pytest.mark.parametrize(
    ("algorithm", "value"),
    [
        ("SHA1", hashlib.sha1(TEXT).hexdigest()),
        ("SHA3-256", hashlib.sha3_256(TEXT).hexdigest()),
        ("MD5", hashlib.md5(TEXT).hexdigest()),
        ("BLAKE2b-256", hashlib.blake2b(TEXT, digest_size=32).hexdigest()),
        ("ADLER32", "2db105a1"),
    ],
)
def test_other_algorithms_are_examined_too(algorithm, value):
    assert opened(said=meta(value, algorithm))[1] == []
    assert opened(said=meta("00", algorithm))[1][0].startswith("SM168 ")


def test_a_wrong_checksum_is_an_error_where_it_is_stated():
    sink = Sink()
    open_archive(archive(said=meta("00")), sink)
    assert messages(sink) == [
        "SM168 'Robots.kpar!Robots.sysml' differs from the file that was packed into project "
        f"'Robots': its SHA256 is {SUM}, expected 00"
    ]
    (found,) = sink
    stated = json.dumps(meta("00"))
    assert found.subject.place.file == "Robots.kpar!.meta.json"
    assert stated[found.subject.place.offset :].startswith('"Robots.sysml"')


@pytest.mark.parametrize(
    ("named", "message"),
    [
        (
            {"said": meta(index={"Robots": "Robtos.sysml"})},
            "SM753 project 'Robots' names the file 'Robtos.sysml', which it does not have",
        ),
        (
            {"files": {"Robots.sysml": TEXT, "Extra.sysml": b""}},
            "SM754 project 'Robots' has no checksum for 'Extra.sysml'",
        ),
        (
            {"said": meta(algorithm="MD6")},
            "SM755 the checksum of 'Robots.kpar!Robots.sysml' is not checked: the algorithm "
            "MD6 is not supported",
        ),
        (
            {"about": b"{"},
            "SM752 'Robots.kpar!.project.json' does not describe a project: it is not JSON:"
            " Expecting property name enclosed in double quotes: line 1 column 2 (char 1)",
        ),
        (
            {"about": []},
            "SM752 'Robots.kpar!.project.json' does not describe a project: it is not a JSON "
            "object",
        ),
        (
            {"about": {"version": "1"}},
            "SM752 'Robots.kpar!.project.json' does not describe a project: it has no name",
        ),
        (
            {"about": {**ABOUT, "usage": {}}},
            "SM752 'Robots.kpar!.project.json' does not describe a project: its 'usage' is of the"
            " wrong type",
        ),
    ],
)
def test_what_is_wrong_with_a_project_is_told(named, message):
    assert opened(**named)[1] == [message]


@pytest.mark.parametrize("missing", [".project.json", ".meta.json"])
def test_a_missing_description_is_told(missing):
    named = {"about": None} if missing == ".project.json" else {}
    source = archive(**named)
    if missing == ".meta.json":
        source = repacked(source, missing)
    sink = Sink()
    found = open_archive(source, sink)
    assert messages(sink) == [
        f"SM752 'Robots.kpar!{missing}' does not describe a project: it is missing"
    ]
    assert len(found.files) == 1


def repacked(source, without):
    written = io.BytesIO()
    with (
        zipfile.ZipFile(io.BytesIO(source.data)) as before,
        zipfile.ZipFile(written, "w") as after,
    ):
        for name in before.namelist():
            if name != without:
                after.writestr(name, before.read(name))
    return Source(source.name, written.getvalue())


def test_a_damaged_archive_is_told():
    sink = Sink()
    assert open_archive(Source("a.kpar", archive().data[:60]), sink) is None
    assert [found.rule.code for found in sink] == ["SM750"]


def test_a_folder_is_a_project_too():
    sink = Sink()
    about = Source("lib/.project.json", json.dumps(ABOUT).encode())
    said = Source("lib/.meta.json", json.dumps(meta()).encode())
    found = read_project("lib", [about, said, Source("lib/Robots.sysml", TEXT)], sink)
    assert (messages(sink), found.name, len(found.files)) == ([], "Robots", 1)


def using(resource, constraint=""):
    sink = Sink()
    usage = {"resource": resource, "versionConstraint": constraint}
    user = open_archive(archive({**ABOUT, "name": "Plant", "usage": [usage]}, name="P.kpar"), sink)
    robots = open_archive(archive(name="Robots-1.2.0.kpar"), sink)
    found = resolve_usages(user, [user, robots], sink)
    return [one.name for one in found.values()], messages(sink)


@pytest.mark.parametrize(
    "resource",
    ["Robots-1.2.0.kpar", "https://example.org/1/Robots.kpar", "https://example.org/robots"],
)
def test_a_usage_leads_to_a_given_project(resource):
    assert using(resource, "1.1") == (["Robots"], [])


def test_a_used_project_that_is_not_given_is_told():
    assert using("https://example.org/Grippers.kpar", "2.0.0") == (
        [],
        [
            "SM169 project 'Plant' uses 'https://example.org/Grippers.kpar' (2.0.0),"
            " which is not given"
        ],
    )


def test_a_used_project_of_another_version_is_told():
    assert using("Robots.kpar", "2.0.0") == (
        [],
        ["SM169 project 'Plant' uses 'Robots.kpar' (2.0.0), but the one given is 1.2.0"],
    )


@pytest.mark.parametrize(
    ("constraint", "yes"),
    [
        ("", True),
        ("1.2.0", True),
        ("1.1.7", True),
        ("1.3", False),
        ("2", False),
        ("=1.2", True),
        ("=1.1", False),
        ("~1.2", True),
        ("~1.1", False),
        (">=1.0, <2.0", True),
        (">=1.0, <1.2", False),
        ("any", True),
    ],
)
def test_versions_fit_constraints(constraint, yes):
    assert satisfies_version("1.2.0", constraint) == yes


@pytest.mark.long
@pytest.mark.corpus
def test_the_ten_library_archives_are_as_released(corpus):
    sink = Sink()
    paths = sorted((corpus / "sysml2/interchange/kpar").glob("*.kpar"))
    given = [open_archive(Source(path.name, path.read_bytes()), sink) for path in paths]
    resolved = [len(resolve_usages(one, given, sink)) for one in given]
    assert messages(sink) == []
    assert (len(given), sum(len(one.files) for one in given)) == (10, 94)
    assert resolved == [len(one.usages) for one in given]
