"""Project archives (.kpar): descriptions, checksums, and usages of other projects."""

import hashlib
import io
import json
import zipfile

import pytest
from interchange_files import list_messages

from sysmlc.diagnostics import Sink
from sysmlc.language.interchange import open_archive, read_project, resolve_usages
from sysmlc.language.interchange.projects import satisfies_version
from sysmlc.sources import Source

TEXT = b"package Robots;"
SUM = hashlib.sha256(TEXT).hexdigest()
ABOUT = {"name": "Robots", "version": "1.2.0"}


def write_meta(value=SUM, algorithm="SHA256", file="Robots.sysml", index=None):
    """Return the content of .meta.json: an index and a checksum."""
    checksum = {file: {"value": value, "algorithm": algorithm}}
    return {"index": index or {"Robots": "Robots.sysml"}, "checksum": checksum}


def write_archive(project=ABOUT, meta=None, files=None, name="Robots.kpar"):
    """Return a .kpar with descriptions and files; a description that is False is omitted."""
    descriptions = {
        ".project.json": project,
        ".meta.json": write_meta() if meta is None else meta,
    }
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w") as archive:
        for file, content in descriptions.items():
            if content is not False:
                is_raw = isinstance(content, bytes)
                archive.writestr(file, content if is_raw else json.dumps(content))
        for file, content in (files or {"Robots.sysml": TEXT}).items():
            archive.writestr(file, content)
    return Source(name, data.getvalue())


def open_project(**contents):
    """Return the project of an archive with *contents*, and the messages about it."""
    sink = Sink()
    project = open_archive(write_archive(**contents), sink)
    return project, list_messages(sink)


def test_an_archive_is_a_project_with_files():
    usage = {"resource": "a.kpar", "versionConstraint": "1"}
    project, messages = open_project(project={**ABOUT, "usage": [usage]})
    assert messages == []
    assert (project.name, project.version, dict(project.index)) == (
        "Robots",
        "1.2.0",
        {"Robots": "Robots.sysml"},
    )
    assert [(usage.resource, usage.constraint) for usage in project.usages] == [("a.kpar", "1")]
    assert [source.name for source in project.files] == ["Robots.kpar!Robots.sysml"]


@pytest.mark.parametrize("algorithm", ["sha256", "SHA-256"])
def test_a_matching_checksum_is_accepted(algorithm):
    assert open_project(meta=write_meta(algorithm=algorithm))[1] == []


@pytest.mark.parametrize(
    ("algorithm", "value"),
    [
        ("SHA1", hashlib.sha1(TEXT).hexdigest()),
        ("SHA224", hashlib.sha224(TEXT).hexdigest()),
        ("SHA384", hashlib.sha384(TEXT).hexdigest()),
        ("SHA512", hashlib.sha512(TEXT).hexdigest()),
        ("SHA3-256", hashlib.sha3_256(TEXT).hexdigest()),
        ("SHA3-384", hashlib.sha3_384(TEXT).hexdigest()),
        ("SHA3-512", hashlib.sha3_512(TEXT).hexdigest()),
        ("MD5", hashlib.md5(TEXT).hexdigest()),
        ("BLAKE2b-256", hashlib.blake2b(TEXT, digest_size=32).hexdigest()),
        ("BLAKE2b-384", hashlib.blake2b(TEXT, digest_size=48).hexdigest()),
        ("BLAKE2b-512", hashlib.blake2b(TEXT, digest_size=64).hexdigest()),
        ("ADLER32", "2db105a1"),
    ],
)
def test_checksums_of_all_algorithms_are_checked(algorithm, value):
    assert open_project(meta=write_meta(value, algorithm))[1] == []
    assert open_project(meta=write_meta("00", algorithm))[1][0].startswith("SM168 ")


def test_a_wrong_checksum_is_an_error_at_its_location():
    sink = Sink()
    open_archive(write_archive(meta=write_meta("00")), sink)
    assert list_messages(sink) == [
        "SM168 'Robots.kpar!Robots.sysml' differs from the file that was packed into project "
        f"'Robots': its SHA256 is {SUM}, expected 00"
    ]
    (diagnostic,) = sink
    place = diagnostic.subject.place
    assert place.file == "Robots.kpar!.meta.json"
    assert json.dumps(write_meta("00"))[place.offset :].startswith('"Robots.sysml"')


@pytest.mark.parametrize(
    ("contents", "message"),
    [
        (
            {"meta": write_meta(index={"Robots": "Robtos.sysml"})},
            "SM753 project 'Robots' names the file 'Robtos.sysml', which it does not have",
        ),
        (
            {"files": {"Robots.sysml": TEXT, "Extra.sysml": b""}},
            "SM754 project 'Robots' has no checksum for 'Extra.sysml'",
        ),
        (
            {"meta": write_meta(algorithm="MD6")},
            "SM755 the checksum of 'Robots.kpar!Robots.sysml' is not checked: the algorithm "
            "MD6 is not supported",
        ),
        (
            {"project": b"{"},
            "SM752 'Robots.kpar!.project.json' does not describe a project: it is not JSON:"
            " Expecting property name enclosed in double quotes: line 1 column 2 (char 1)",
        ),
        (
            {"project": b'{"name": "\\ud800"}'},
            "SM752 'Robots.kpar!.project.json' does not describe a project: it is not JSON:"
            r" an escape such as \ud800 is only half of a character",
        ),
        (
            {"project": []},
            "SM752 'Robots.kpar!.project.json' does not describe a project: it is not a JSON "
            "object",
        ),
        (
            {"project": {"version": "1"}},
            "SM752 'Robots.kpar!.project.json' does not describe a project: it has no name",
        ),
        (
            {"project": {**ABOUT, "usage": {}}},
            "SM752 'Robots.kpar!.project.json' does not describe a project: its 'usage' is of the"
            " wrong type",
        ),
    ],
)
def test_a_fault_of_a_project_is_reported(contents, message):
    assert open_project(**contents)[1] == [message]


@pytest.mark.parametrize(
    ("argument", "file"), [("project", ".project.json"), ("meta", ".meta.json")]
)
def test_a_missing_description_is_reported_and_the_files_are_read(argument, file):
    project, messages = open_project(**{argument: False})
    assert messages == [f"SM752 'Robots.kpar!{file}' does not describe a project: it is missing"]
    assert len(project.files) == 1


def test_a_truncated_archive_is_reported():
    sink = Sink()
    assert open_archive(Source("a.kpar", write_archive().data[:60]), sink) is None
    assert [diagnostic.rule.code for diagnostic in sink] == ["SM750"]


def test_a_folder_is_a_project_too():
    sink = Sink()
    sources = [
        Source("lib/.project.json", json.dumps(ABOUT).encode()),
        Source("lib/.meta.json", json.dumps(write_meta()).encode()),
        Source("lib/Robots.sysml", TEXT),
    ]
    project = read_project("lib", sources, sink)
    assert (list_messages(sink), project.name, len(project.files)) == ([], "Robots", 1)


def resolve_usage(resource, constraint=""):
    """Return the projects that a usage of *resource* refers to, and the messages."""
    sink = Sink()
    usage = {"resource": resource, "versionConstraint": constraint}
    description = {**ABOUT, "name": "Plant", "usage": [usage]}
    plant = open_archive(write_archive(description, name="P.kpar"), sink)
    robots = open_archive(write_archive(name="Robots-1.2.0.kpar"), sink)
    projects = resolve_usages(plant, [plant, robots], sink)
    return [project.name for project in projects.values()], list_messages(sink)


@pytest.mark.parametrize(
    "resource",
    ["Robots-1.2.0.kpar", "https://example.org/1/Robots.kpar", "https://example.org/robots"],
)
def test_a_usage_refers_to_a_project_among_the_inputs(resource):
    assert resolve_usage(resource, "1.1") == (["Robots"], [])


def test_a_usage_of_a_project_that_is_not_an_input_is_reported():
    assert resolve_usage("https://example.org/Grippers.kpar", "2.0.0") == (
        [],
        [
            "SM169 project 'Plant' uses 'https://example.org/Grippers.kpar' (2.0.0),"
            " which is not given"
        ],
    )


def test_a_usage_of_another_version_is_reported():
    assert resolve_usage("Robots.kpar", "2.0.0") == (
        [],
        ["SM169 project 'Plant' uses 'Robots.kpar' (2.0.0), but the one given is 1.2.0"],
    )


@pytest.mark.parametrize(
    ("constraint", "satisfies"),
    [
        ("", True),
        ("1.2.0", True),
        ("1.1.7", True),
        ("1.3", False),
        ("2", False),
        ("=1.2", True),
        ("=1.1", False),
        ("==1.2", True),
        ("==1.1", False),
        ("<1.3", True),
        ("<1.2", False),
        ("<=1.2", True),
        ("<=1.1", False),
        (">1.1", True),
        (">1.2", False),
        ("~1.2", True),
        ("~1.1", False),
        (">=1.0, <2.0", True),
        (">=1.0, <1.2", False),
        ("any", True),
    ],
)
def test_versions_satisfy_constraints(constraint, satisfies):
    assert satisfies_version("1.2.0", constraint) == satisfies


@pytest.mark.long
@pytest.mark.corpus
def test_the_ten_archives_of_the_library_are_read_without_diagnostics(corpus):
    sink = Sink()
    paths = sorted((corpus / "sysml2/interchange/kpar").glob("*.kpar"))
    projects = [open_archive(Source(path.name, path.read_bytes()), sink) for path in paths]
    assert (len(projects), sum(len(project.files) for project in projects)) == (10, 94)
    for project in projects:
        assert len(resolve_usages(project, projects, sink)) == len(project.usages)
    assert list_messages(sink) == []
