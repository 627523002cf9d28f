"""The security table for AutomationML: a located finding, within a second and 300 MB."""

import io
import struct
import zipfile

import pytest

HEAD = '<?xml version="1.0" encoding="UTF-8"?>\n'
ROOT = '<CAEXFile xmlns="http://www.dke.de/CAEX" SchemaVersion="3.0" FileName="m.aml">'
PLANT = '<InstanceHierarchy Name="Plant"/>'
BIG = 11_000_000
CENTRAL = b"PK\x01\x02"


def plant(content=PLANT, doctype=""):
    return f"{HEAD}{doctype}{ROOT}{content}</CAEXFile>"


def test_the_file_that_the_others_are_made_of_is_read(asked):
    assert asked.about(plant(), "m.aml").ended.code == 0


def laughs(times):
    more = "".join(f"<!ENTITY e{n} '{f'&e{n - 1};' * 10}'>" for n in range(1, times))
    return plant(f"&e{times - 1};", f"<!DOCTYPE a [<!ENTITY e0 'lol'>{more}]>")


DOCTYPES = {
    "internal entity": plant("&x;", "<!DOCTYPE a [<!ENTITY x 'y'>]>"),
    "file entity": plant("&x;", '<!DOCTYPE a [<!ENTITY x SYSTEM "secret.txt">]>'),
    "external DTD": plant(doctype='<!DOCTYPE a SYSTEM "secret.txt">'),
    "laughs 10^9": laughs(9),
    "quadratic": plant("&x;" * 100_000, f"<!DOCTYPE a [<!ENTITY x '{'x' * 3_000}'>]>"),
}


@pytest.mark.parametrize("name", DOCTYPES)
def test_every_doctype_of_a_plant_is_refused_where_it_stands(asked, name):
    asked.write("TOPSECRET", "secret.txt")
    answer = asked.about(DOCTYPES[name], "m.aml")
    assert (answer.ended.code, answer.only.code, answer.only.line) == (1, "SM142", 2)
    assert "has a DOCTYPE, which is refused" in answer.only.message
    assert "TOPSECRET" not in answer.ended.out + answer.ended.err


@pytest.mark.parametrize("tag", ["InternalElement", "RoleClass", "Attribute", "strange"])
@pytest.mark.parametrize("depth", [501, 1_000_000])
def test_a_plant_nested_too_deep_is_refused_where_it_is_too_deep(asked, tag, depth):
    answer = asked.about(plant(f'<InstanceHierarchy Name="P">{f"<{tag}>" * depth}'), "m.aml")
    assert (answer.ended.code, answer.only.code, answer.only.line) == (2, "SM178", 2)
    assert "nested more than 500 deep" in answer.only.message


@pytest.mark.parametrize("depth", [100, 480])
def test_a_plant_nested_less_deep_is_read(asked, depth):
    inside = "".join(f'<InternalElement Name="e" ID="i{n}">' for n in range(depth))
    text = f'<InstanceHierarchy Name="P">{inside}{"</InternalElement>" * depth}</InstanceHierarchy>'
    assert asked.about(plant(text), "m.aml").ended.code == 0


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


@pytest.mark.parametrize("what", LONG)
def test_long_content_of_a_plant_is_read(asked, what):
    assert asked.about(plant(LONG[what]), "m.aml").ended.code == 0


CIRCLES = {
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


@pytest.mark.parametrize("what", CIRCLES)
def test_circles_of_any_length_end(asked, what):
    assert asked.about(plant(CIRCLES[what]), "m.aml").ended.code in (0, 1)


def test_paths_of_brackets_and_aliases_are_no_work(asked):
    uses = "".join(
        f'<RoleClass Name="r{n}" RefBaseClassPath="{mark * 5_000}"/>'
        for n, mark in enumerate(("[", "]", "[/]", "@", "/", "A@B/"))
    )
    answer = asked.about(plant(f'<RoleClassLib Name="R">{uses}</RoleClassLib>'), "m.aml")
    assert answer.ended.code in (0, 1)


@pytest.mark.parametrize(
    "path", ["../secret.aml", "{folder}/secret.aml", "file://{folder}/secret.aml", "link.aml"]
)
def test_an_external_reference_does_not_leave_the_unit(asked, path):
    secret = plant('<RoleClassLib Name="L"><RoleClass Name="TOPSECRET"/></RoleClassLib>')
    asked.write(secret, "secret.aml")
    (asked.folder / "unit").mkdir()
    (asked.folder / "unit" / "link.aml").symlink_to(asked.folder / "secret.aml")
    text = f'<ExternalReference Path="{path.format(folder=asked.folder)}" Alias="A"/>{PLANT}'
    asked.write(plant(text), "unit/m.aml")
    ended = asked.run("check", "unit/m.aml", "--print-after", "resolve")
    assert "Plant" in ended.out
    assert "TOPSECRET" not in ended.out + ended.err


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


def package(parts=(), target="m.aml", before="", after=""):
    made = io.BytesIO()
    relations = f"{before}{RELATIONS.format(target)}{after}"
    whole = {"[Content_Types].xml": TYPES, "_rels/.rels": relations}
    with zipfile.ZipFile(made, "w", zipfile.ZIP_DEFLATED) as opened:
        for name, data in (whole | dict(parts or {"m.aml": plant()})).items():
            opened.writestr(zipfile.ZipInfo(name), data, zipfile.ZIP_DEFLATED)
    return made.getvalue()


def with_size(data, old, new):
    size = struct.pack("<I", old)
    assert size in data
    return data.replace(size, struct.pack("<I", new))


def test_the_package_that_the_others_are_made_of_is_read(asked):
    assert asked.about(package(), "m.amlx").codes == []


LARGE = plant(f"<!--{' ' * 50_000_000}-->").encode()
PACKAGES = {
    "a bomb": (lambda: package({"m.aml": LARGE}), "SM178"),
    "a bomb as table": (lambda: package(after=" " * 50_000_000), "SM178"),
    "a bomb that says it is small": (
        lambda: with_size(package({"m.aml": LARGE}), len(LARGE), 1000),
        "SM172",
    ),
    "a size that is too small": (
        lambda: with_size(package(), len(plant()), 20),
        "SM172",
    ),
    "four gigabytes": (lambda: with_size(package(), len(plant()), 0xFFFFFFF0), "SM178"),
    "a part that is not there": (lambda: package(target="gone.aml"), "SM172"),
    "a part outside": (lambda: package(target="../m.aml"), "SM172"),
    "a table with a DOCTYPE": (
        lambda: package(before='<!DOCTYPE a [<!ENTITY x "y">]>'),
        "SM177",
    ),
    "a part with a DOCTYPE": (
        lambda: package({"m.aml": plant(doctype="<!DOCTYPE a>")}),
        "SM142",
    ),
    "cut": (lambda: package()[:-40], "SM172"),
}


@pytest.mark.parametrize("what", PACKAGES)
def test_hostile_packages_are_refused_with_one_finding(asked, what):
    make, code = PACKAGES[what]
    answer = asked.about(make(), "m.amlx")
    assert answer.ended.code in (1, 2)
    assert answer.only.code == code
    assert answer.only.file.startswith("m.amlx")
    assert answer.ended.megabytes < 150
