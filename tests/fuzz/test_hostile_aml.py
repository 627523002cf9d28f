"""Hostile AutomationML gets a located diagnostic, within a second and 300 MB."""

import io
import zipfile

import pytest

from fuzz.checker import HEAD, change_size, nest_entities

ROOT = '<CAEXFile xmlns="http://www.dke.de/CAEX" SchemaVersion="3.0" FileName="m.aml">'
PLANT = '<InstanceHierarchy Name="Plant"/>'
BIG = 11_000_000
CENTRAL = b"PK\x01\x02"


def make_plant(content=PLANT, doctype=""):
    return f"{HEAD}{doctype}{ROOT}{content}</CAEXFile>"


def test_the_plant_without_faults_is_read(checker):
    assert checker.check_content(make_plant(), "m.aml").exit_code == 0


DOCTYPES = {
    "internal entity": make_plant("&x;", "<!DOCTYPE a [<!ENTITY x 'y'>]>"),
    "file entity": make_plant("&x;", '<!DOCTYPE a [<!ENTITY x SYSTEM "secret.txt">]>'),
    "external DTD": make_plant(doctype='<!DOCTYPE a SYSTEM "secret.txt">'),
    "laughs 10^9": make_plant("&e8;", nest_entities(9)),
    "quadratic": make_plant("&x;" * 100_000, f"<!DOCTYPE a [<!ENTITY x '{'x' * 3_000}'>]>"),
}


@pytest.mark.parametrize("name", DOCTYPES)
def test_every_doctype_of_a_plant_is_refused_at_its_line(checker, name):
    checker.write("TOPSECRET", "secret.txt")
    result = checker.check_content(DOCTYPES[name], "m.aml")
    assert (result.exit_code, result.diagnostic.code, result.diagnostic.line) == (1, "SM142", 2)
    assert "has a DOCTYPE, which is refused" in result.diagnostic.message
    assert "TOPSECRET" not in result.command.out + result.command.err


@pytest.mark.parametrize("tag", ["InternalElement", "RoleClass", "Attribute", "strange"])
@pytest.mark.parametrize("depth", [501, 1_000_000])
def test_a_plant_nested_deeper_than_the_limit_is_refused_at_its_line(checker, tag, depth):
    result = checker.check_content(
        make_plant(f'<InstanceHierarchy Name="P">{f"<{tag}>" * depth}'), "m.aml"
    )
    assert (result.exit_code, result.diagnostic.code, result.diagnostic.line) == (2, "SM178", 2)
    assert "nested more than 500 deep" in result.diagnostic.message


@pytest.mark.parametrize("depth", [100, 480])
def test_a_plant_nested_less_deeply_than_the_limit_is_read(checker, depth):
    elements = "".join(f'<InternalElement Name="e" ID="i{n}">' for n in range(depth))
    text = (
        f'<InstanceHierarchy Name="P">{elements}{"</InternalElement>" * depth}</InstanceHierarchy>'
    )
    assert checker.check_content(make_plant(text), "m.aml").exit_code == 0


LONG = {
    "name": f'<InstanceHierarchy Name="{"n" * BIG}"/>',
    "id": f'<InstanceHierarchy Name="P"><InternalElement Name="e" ID="{"1" * BIG}"/>'
    "</InstanceHierarchy>",
    "value": '<InstanceHierarchy Name="P"><InternalElement Name="e" ID="1"><Attribute Name="a">'
    f"<Value>{'9' * BIG}</Value></Attribute></InternalElement></InstanceHierarchy>",
    "description": f'<InstanceHierarchy Name="P"><Description>{"d" * BIG}</Description>'
    "</InstanceHierarchy>",
    "comment": f"<!--{'c' * BIG}-->{PLANT}",
}


@pytest.mark.parametrize("content", LONG)
def test_long_content_of_a_plant_is_read(checker, content):
    assert checker.check_content(make_plant(LONG[content]), "m.aml").exit_code == 0


CYCLES = {
    "classes": '<RoleClassLib Name="R">'
    + "".join(f'<RoleClass Name="c{n}" RefBaseClassPath="R/c{(n + 1) % 200}"/>' for n in range(200))
    + "</RoleClassLib>",
    "mirrors": '<InstanceHierarchy Name="P">'
    + "".join(
        f'<InternalElement Name="e{n}" ID="i{n}" RefBaseSystemUnitPath="i{(n + 1) % 200}"/>'
        for n in range(200)
    )
    + "</InstanceHierarchy>",
    "classes of parts": '<SystemUnitClassLib Name="S">'
    + "".join(
        f'<SystemUnitClass Name="c{n}"><InternalElement Name="p" ID="i{n}"'
        f' RefBaseSystemUnitPath="S/c{(n + 1) % 200}"/></SystemUnitClass>'
        for n in range(200)
    )
    + "</SystemUnitClassLib>",
}


@pytest.mark.parametrize("cycle", CYCLES)
def test_cycles_of_any_length_terminate(checker, cycle):
    assert checker.check_content(make_plant(CYCLES[cycle]), "m.aml").exit_code in (0, 1)


def test_long_paths_of_brackets_and_aliases_take_no_time(checker):
    classes = "".join(
        f'<RoleClass Name="r{n}" RefBaseClassPath="{mark * 5_000}"/>'
        for n, mark in enumerate(("[", "]", "[/]", "@", "/", "A@B/"))
    )
    result = checker.check_content(
        make_plant(f'<RoleClassLib Name="R">{classes}</RoleClassLib>'), "m.aml"
    )
    assert result.exit_code in (0, 1)


@pytest.mark.parametrize(
    "path", ["../secret.aml", "{folder}/secret.aml", "file://{folder}/secret.aml", "link.aml"]
)
def test_an_external_reference_does_not_leave_the_unit(checker, path):
    secret = make_plant('<RoleClassLib Name="L"><RoleClass Name="TOPSECRET"/></RoleClassLib>')
    checker.write(secret, "secret.aml")
    (checker.folder / "unit").mkdir()
    (checker.folder / "unit" / "link.aml").symlink_to(checker.folder / "secret.aml")
    text = f'<ExternalReference Path="{path.format(folder=checker.folder)}" Alias="A"/>{PLANT}'
    checker.write(make_plant(text), "unit/m.aml")
    command = checker.run("check", "unit/m.aml", "--print-after", "resolve")
    assert "Plant" in command.out
    assert "TOPSECRET" not in command.out + command.err


# -- packages ------------------------------------------------------------------------------------

TYPES = (
    '<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">'
    '<Default Extension="rels"'
    ' ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
    '<Default Extension="aml" ContentType="model/vnd.automationml+xml"/></Types>'
)
RELATIONS = (
    '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">'
    '<Relationship Id="r" Type="http://schemas.automationml.org/container/relationship/RootDocument"'
    ' Target="/{}"/></Relationships>'
)


def make_package(parts=(), target="m.aml", before="", after=""):
    buffer = io.BytesIO()
    relations = f"{before}{RELATIONS.format(target)}{after}"
    standard_parts = {"[Content_Types].xml": TYPES, "_rels/.rels": relations}
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in (standard_parts | dict(parts or {"m.aml": make_plant()})).items():
            archive.writestr(zipfile.ZipInfo(name), data, zipfile.ZIP_DEFLATED)
    return buffer.getvalue()


def test_the_package_without_faults_is_read(checker):
    assert checker.check_content(make_package(), "m.amlx").codes == []


LARGE = make_plant(f"<!--{' ' * 50_000_000}-->").encode()
PACKAGES = {
    "a bomb": (lambda: make_package({"m.aml": LARGE}), "SM178"),
    "a bomb as table": (lambda: make_package(after=" " * 50_000_000), "SM178"),
    "a bomb that says it is small": (
        lambda: change_size(make_package({"m.aml": LARGE}), len(LARGE), 1000),
        "SM172",
    ),
    "a size that is too small": (
        lambda: change_size(make_package(), len(make_plant()), 20),
        "SM172",
    ),
    "four gigabytes": (lambda: change_size(make_package(), len(make_plant()), 0xFFFFFFF0), "SM178"),
    "a part that is not there": (lambda: make_package(target="gone.aml"), "SM172"),
    "a part outside": (lambda: make_package(target="../m.aml"), "SM172"),
    "a table with a DOCTYPE": (
        lambda: make_package(before='<!DOCTYPE a [<!ENTITY x "y">]>'),
        "SM177",
    ),
    "a part with a DOCTYPE": (
        lambda: make_package({"m.aml": make_plant(doctype="<!DOCTYPE a>")}),
        "SM142",
    ),
    "cut": (lambda: make_package()[:-40], "SM172"),
}


@pytest.mark.parametrize("fault", PACKAGES)
def test_a_hostile_package_is_refused_with_one_diagnostic(checker, fault):
    make, code = PACKAGES[fault]
    result = checker.check_content(make(), "m.amlx")
    assert result.exit_code in (1, 2)
    assert result.diagnostic.code == code
    assert result.diagnostic.file.startswith("m.amlx")
    assert result.command.megabytes < 150
