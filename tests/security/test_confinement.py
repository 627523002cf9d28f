"""A repository can make sysmlc read files in the project root, and no other files."""

import pytest

UML = """\
<?xml version="1.0" encoding="UTF-8"?>
<uml:Model xmi:version="20131001" xmlns:xmi="http://www.omg.org/spec/XMI/20131001"
    xmlns:uml="http://www.eclipse.org/uml2/5.0.0/UML" xmi:id="{id}" name="{id}">
  <packagedElement xmi:type="uml:Class" xmi:id="{id}_class" name="Block_of_{id}">{content}
  </packagedElement>
</uml:Model>
"""
GENERAL = (
    '<generalization xmi:id="g"><general xmi:type="uml:Class" href="{href}"/></generalization>'
)
NAMED = '[[model]]\nname = "{name}"\nfiles = ["plant.ir"]\n'
UNIT = '[[model]]\nname = "plant"\nfiles = [{files}]\n'


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('output = "../x"', "sysmlc.toml:1:1: 'output': '../x' leads out of the project root"),
        ('output = "{outside}"', "'output': '{outside}' leads out of the project root"),
        ('output = "a\\u0000b"', "leads out of the project root"),
        ('templates = "../outside"', "'templates': '../outside' leads out of the project root"),
        (
            '[[model]]\nname = "../../x"\nfiles = ["plant.ir"]',
            "sysmlc.toml:2:1: the name '../../x' leads out",
        ),
        (
            '[[model]]\nname = "/x"\nfiles = ["plant.ir"]',
            "the name '/x' leads out of the output folder",
        ),
        (
            UNIT.format(files='"../outside/secret.ir"'),
            "sysmlc.toml:3:9: 'files': '../outside/secret",
        ),
        (UNIT.format(files='"{outside}/secret.ir"'), "'files': '{outside}/secret.ir' leads out"),
        (UNIT.format(files='"../outside/*.ir"'), "'files': '../outside/*.ir' leads out"),
        (UNIT.format(files='"{outside}/*.ir"'), "'files': '{outside}/*.ir' leads out"),
        (UNIT.format(files='"*/../../outside/*.ir"'), "'*/../../outside/*.ir' leads out"),
        (UNIT.format(files='"link.ir"'), "'files': 'link.ir' leads out of the project root"),
        (UNIT.format(files='"link*.ir"'), "link.ir' is a link that leads out of the project root"),
        (UNIT.format(files='"linked/secret.ir"'), "'linked/secret.ir' leads out"),
        (UNIT.format(files='"linked/*.ir"'), "'linked/*.ir' leads out"),
        (UNIT.format(files='"link*/*.ir"'), "/linked' is a link that leads out of"),
    ],
)
@pytest.mark.parametrize("command", ["build", "check"])
def test_a_path_of_the_configuration_that_leads_out_is_refused(project, command, text, message):
    (project.folder / "link.ir").symlink_to("../outside/secret.ir")
    (project.folder / "linked").symlink_to("../outside")
    project.write("sysmlc.toml", text.replace("{outside}", str(project.outside)))
    before = project.snapshot()
    result = project.run(command)
    assert result.exit_code == 2
    assert message.replace("{outside}", str(project.outside)) in result.stderr
    assert project.snapshot() == before


@pytest.mark.parametrize(
    "files", ['"sub/../plant.ir"', '"*.ir"', '"{project}/plant.ir"', '"link.ir"', '"linked/*.ir"']
)
def test_a_path_of_the_configuration_inside_the_root_is_read(project, files):
    project.write("sub/same.ir")
    (project.folder / "link.ir").symlink_to("plant.ir")
    (project.folder / "linked").symlink_to("sub")
    files = files.replace("{project}", str(project.folder))
    project.write("sysmlc.toml", f'{UNIT.format(files=files)}output = "sub/../gen"\n')
    result = project.run("build", "--emit", "graph")
    assert (result.exit_code, (project.folder / "gen/graph.json").is_file()) == (0, True)


@pytest.mark.parametrize(
    "pattern", ["root?ink/**/*", "*/**/*.ir", "[r]ootlink/*/*", "**/rootlink/*", "sub/*nk/*.ir"]
)
def test_wildcards_are_expanded_inside_the_root_only(project, pattern):
    """The message names the link and nothing to which it leads."""
    (project.folder / "rootlink").symlink_to("/")
    (project.folder / "sub").mkdir()
    (project.folder / "sub/link").symlink_to("../../outside")
    project.write("sysmlc.toml", UNIT.format(files=f'"{pattern}"'))
    result = project.run("check")
    link = "sub/link" if pattern.startswith("sub") else "rootlink"
    assert result.exit_code == 2
    assert f"'{project.folder / link}' is a link that leads out of the project" in result.stderr


def test_a_recursive_wildcard_follows_no_link(project):
    (project.folder / "rootlink").symlink_to("/")
    project.write("sub/deep/second.ir", 'Package second "Second"\n')
    project.write("sysmlc.toml", UNIT.format(files='"**/*.ir"'))
    result = project.run("show", "plant.ir")
    assert result.exit_code == 0
    result = project.run("check", "--format", "json")
    assert (result.exit_code, "usr" in result.output) == (0, False)


def test_links_in_a_circle_end(project):
    for name in ("a", "b", "c"):
        (project.folder / name).symlink_to(".")
    pattern = "*/" * 60 + "*.ir"
    project.write("sysmlc.toml", UNIT.format(files=f'"{pattern}"'))
    assert project.run("check", "--time-limit", "20").exit_code == 0


@pytest.mark.parametrize("name", ["../outside/secret.ir", "link.ir"])
def test_a_path_on_the_command_line_may_lead_out_of_the_root(project, name):
    (project.folder / "link.ir").symlink_to("../outside/secret.ir")
    assert project.run("build", name, "-o", "../outside/gen").exit_code == 0
    assert (project.outside / "gen/manifest.json").is_file()


def write_uml(path, id, href=""):
    path.parent.mkdir(parents=True, exist_ok=True)
    content = GENERAL.format(href=href) if href else ""
    path.write_text(UML.format(id=id, content=content), encoding="utf-8")


@pytest.mark.parametrize(
    ("href", "is_read"),
    [
        ("../../outside/secret.uml", False),
        ("file:///{outside}/secret.uml", False),
        ("{outside}/secret.uml", False),
        ("platform:/resource/outside/secret.uml", False),
        ("linked/secret.uml", False),
        ("../lib/drives.uml", True),
    ],
)
def test_references_of_models_are_followed_inside_the_project_roots(project, href, is_read):
    """The common folder of models in two projects contains more than the two projects."""
    write_uml(project.outside / "secret.uml", "secret")
    write_uml(project.folder / "lib/drives.uml", "drives")
    (project.folder / "models").mkdir()
    (project.folder / "models/linked").symlink_to(project.outside)
    href = f"{href.replace('{outside}', str(project.outside))}#x"
    write_uml(project.folder / "models/plant.uml", "plant", href)
    write_uml(project.outside.parent / "second/other.uml", "other")
    (project.outside.parent / "second/.git").mkdir()
    project.write("sysmlc.toml", "")
    result = project.run("show", "models/plant.uml", "../second/other.uml")
    assert "Block_of_secret" not in result.stdout
    assert ("Block_of_drives" in result.stdout) == is_read


def test_a_reference_of_automationml_is_not_followed_out_of_the_root(project):
    write_uml(project.outside / "secret.uml", "secret")
    project.write(
        "plant.aml",
        '<CAEXFile FileName="plant.aml" SchemaVersion="2.15">'
        '<ExternalReference Path="../outside/secret.uml" Alias="s"/>'
        '<InstanceHierarchy Name="Plant"/></CAEXFile>',
    )
    write_uml(project.outside.parent / "second/other.uml", "other")
    result = project.run("show", "plant.aml", "../second/other.uml")
    assert "Plant" in result.stdout
    assert "Block_of_secret" not in result.stdout


def test_an_overlay_that_is_a_link_out_of_the_root_is_not_read(project):
    (project.outside / "secret.yaml").write_text("password: 1\n")
    (project.folder / "plant.overlay.yaml").symlink_to("../outside/secret.yaml")
    second = project.outside.parent / "second/other.ir"
    second.parent.mkdir()
    second.write_text('Package other "Other"\n')
    result = project.run("check", "plant.ir", str(second))
    assert "SM180" in result.stderr
    assert "password" not in result.stderr


def test_a_part_file_that_is_a_link_out_of_the_root_is_not_read(project):
    project.write("gate.ltl", "G (request -> F grant)\n")
    without_owners = project.run("synth", "gate.ltl", "--realizable").output
    (project.outside / "secret.part").write_text(".inputs request\n.outputs grant\n")
    (project.folder / "gate.part").symlink_to("../outside/secret.part")
    assert project.run("synth", "gate.ltl", "--realizable").output == without_owners
    (project.folder / "gate.part").unlink()
    project.write("gate.part", ".inputs request\n.outputs grant\n")
    assert project.run("synth", "gate.ltl", "--realizable").output != without_owners


def test_format_of_a_folder_does_not_follow_links_out_of_it(project):
    (project.outside / "secret.sysml").write_text("package  P{}\n")
    (project.folder / "link.sysml").symlink_to("../outside/secret.sysml")
    project.write("plant.sysml", "package  P{}\n")
    project.write(".git/hooks.sysml", "package  P{}\n")
    before = project.snapshot()
    assert project.run("format", ".").exit_code == 0
    changed = {name for name, data in project.snapshot().items() if before[name] != data}
    assert changed == {"project/plant.sysml"}


@pytest.mark.parametrize("name", ["link.sysml", "inner.sysml", "linked", "linked/secret.sysml"])
@pytest.mark.parametrize("options", [(), ("--check",), ("--diff",)])
def test_format_neither_reads_nor_writes_through_a_named_link(project, name, options):
    """The user may have written ``*.sysml``, which names the links of the repository too."""
    (project.outside / "secret.sysml").write_text("package  Secret{}\n")
    (project.folder / "link.sysml").symlink_to("../outside/secret.sysml")
    (project.folder / "inner.sysml").symlink_to("plant.sysml")
    (project.folder / "linked").symlink_to("../outside")
    project.write("plant.sysml", "package  P{}\n")
    before = project.snapshot()
    result = project.run("format", "plant.sysml", name, *options)
    assert (result.exit_code, project.snapshot() == before) == (2, True)
    assert f"sysmlc: '{name}' " in result.stderr
    assert "Secret" not in result.output
