"""Snapshots in MagicDraw's archives: what a model takes from other projects is known."""

import itertools
import zipfile

import pytest
from reading_xmi import MAGICDRAW, read, source

from sysmlc.driver import Request, compile_model
from sysmlc.frontends.xmi import FRONTEND
from sysmlc.ir import Edge, Kind

SNAPSHOT = """<?xml version="1.0" encoding="ASCII"?>
<xmi:XMI xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI"
 xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"
 xmlns:uml="http://www.nomagic.com/magicdraw/UML/2.5.1">%s</xmi:XMI>"""

SYSML = """
<uml:Profile xmi:id="sysml" ID="sysml" name="SysML">
  <packagedElement xsi:type="uml:Package" xmi:id="blocks" ID="blocks" name="Blocks">
    <packagedElement xsi:type="uml:Stereotype" xmi:id="block" ID="block" name="Block">
      <ownedAttribute xmi:id="b1" ID="b1" name="base_Class"><type href="#class"/></ownedAttribute>
      <ownedAttribute xmi:id="enc" ID="enc" name="isEncapsulated">
        <type href="#truth"/></ownedAttribute>
    </packagedElement>
    <packagedElement xsi:type="uml:Stereotype" xmi:id="unused" ID="unused" name="Unused"/>
  </packagedElement>
</uml:Profile>
<uml:Package xmi:id="std" ID="std" name="UML Standard Profile">
  <packagedElement xsi:type="uml:Model" xmi:id="meta" ID="meta" name="UML2 Metamodel">
    <packagedElement xsi:type="uml:Class" xmi:id="class" ID="class" name="Class"/>
    <packagedElement xsi:type="uml:PrimitiveType" xmi:id="truth" ID="truth" name="Boolean"/>
  </packagedElement>
</uml:Package>"""

COMPANY = """
<uml:Profile xmi:id="company" ID="company" name="Company Profile">
  <packagedElement xsi:type="uml:Stereotype" xmi:id="station" ID="station" name="Work-Station">
    <generalization xmi:id="g1" ID="g1" general="block"/>
    <ownedAttribute xmi:id="bay" ID="bay" name="bay"/>
  </packagedElement>
  <packagedElement xsi:type="uml:Stereotype" xmi:id="note" ID="note" name="Note"/>
</uml:Profile>
<uml:Package xmi:id="lib" ID="lib" name="Library">
  <packagedElement xsi:type="uml:Class" xmi:id="robot" ID="robot" name="Robot" isAbstract="true">
    <appliedStereotypeInstance xmi:id="asi" ID="asi" classifier="note station">
      <slot xmi:id="s1" ID="s1" definingFeature="bay">
        <value xsi:type="uml:LiteralString" xmi:id="v1" ID="v1" value="7"/></slot>
      <slot xmi:id="s2" ID="s2" definingFeature="enc">
        <value xsi:type="uml:ElementValue" xmi:id="v2" ID="v2" element="arm"/></slot>
    </appliedStereotypeInstance>
    <generalization xmi:id="g2" ID="g2">
      <general xsi:type="uml:Class" href="#machine"/></generalization>
    <ownedAttribute xmi:id="arm" ID="arm" name="arm" aggregation="composite" type="tool"/>
    <ownedAttribute xsi:type="uml:Port" xmi:id="in" ID="in" name="in" type="lost"/>
    <ownedConnector xmi:id="con" ID="con"><end xmi:id="e1" ID="e1" role="in"/></ownedConnector>
  </packagedElement>
  <packagedElement xsi:type="uml:Class" xmi:id="machine" ID="machine" name="Machine"/>
  <packagedElement xsi:type="uml:Class" xmi:id="tool" ID="tool" name="Tool">
    <ownedAttribute xmi:id="on" ID="on" name="on"><type href="#truth"/></ownedAttribute>
  </packagedElement>
  <packagedElement xsi:type="uml:Class" xmi:id="other" ID="other" name="Other"/>
</uml:Package>"""

MODEL = """
<packagedElement xmi:type='uml:Class' xmi:id='cell' name='Cell'>
  <ownedAttribute xmi:type='uml:Property' xmi:id='p' name='r' aggregation='composite'>
    <type href='Company%20Library.mdzip#robot'><xmi:Extension extender='MagicDraw UML'>
      <referenceExtension referentPath='Library::Robot' referentType='Class'/>
    </xmi:Extension></type>
  </ownedAttribute>
</packagedElement>"""
APPLIED = "<Company_Profile:Work_Station xmi:id='app' base_Class='cell' bay='1'/>"


def model(inside=MODEL, applied="", name="plant.mdzip!com.nomagic.magicdraw.uml_model.model"):
    head = MAGICDRAW.replace(
        "xmlns:sysml=",
        "xmlns:Company_Profile='http://www.magicdraw.com/schemas/Company_Profile.xmi' xmlns:sysml=",
    )
    body = f"<uml:Model xmi:type='uml:Model' xmi:id='m' name='M'>{inside}</uml:Model>{applied}"
    return source(head % body, name)


def snapshot(inside, name="a"):
    entry = f"proxy.local__PROJECT$h{name}_resource_com$dnomagic$dmagicdraw"
    return source(SNAPSHOT % inside, f"plant.mdzip!{entry}$duml_umodel$dshared_umodel$dsnapshot")


def archive(folder, *sources):
    path = folder / "plant.mdzip"
    with zipfile.ZipFile(path, "w") as zipped:
        for one in sources:
            zipped.writestr(one.name.partition("!")[2], one.data)
    return path


def library(graph):
    return {e.id: graph.qualified_name(e) for e in graph if e.attrs.get("library")}


def test_elements_that_the_model_refers_to_are_read_with_their_needs():
    reading = read(model(), snapshot(COMPANY))
    graph = reading.graph
    assert {id: name for id, name in library(graph).items() if "Application" not in id} == {
        "lib": "Library",
        "robot": "Library::Robot",
        "machine": "Library::Machine",
        "tool": "Library::Tool",
        "arm": "Library::Robot::arm",
        "in": "Library::Robot::in",
        "on": "Library::Tool::on",
        "asi": "Library::Robot::Note",
        "company": "Company Profile",
        "station": "Company Profile::Work-Station",
        "bay": "Company Profile::Work-Station::bay",
        "note": "Company Profile::Note",
        **{id: name for id, name in library(graph).items() if name.endswith("Work_Station")},
    }
    assert [r.target for r in graph.pending if r.source == "p"] == ["robot"]
    robot = graph["robot"]
    assert (robot.kind, robot.attrs["abstract"], robot.attrs["external"]) == (
        Kind.CLASS,
        True,
        True,
    )
    assert robot.attrs["href"] == "Company%20Library.mdzip#robot"
    assert [up.name for up in graph.targets(robot, Edge.SPECIALIZES)] == ["Machine"]
    assert graph.target(graph["arm"], Edge.TYPED_BY) is graph["tool"]


def test_targets_in_no_snapshot_are_noted_at_the_library_element():
    graph = read(model(), snapshot(COMPANY)).graph
    assert graph["in"].attrs["unresolved"] == ("typed-by",)
    assert "unresolved" not in graph["arm"].attrs


def test_one_instance_holds_the_tags_of_several_stereotypes():
    graph = read(model(), snapshot(COMPANY), snapshot(SYSML, "b")).graph
    applied = {e.name: e for e in graph.sources(graph["robot"], Edge.SUBJECT)}
    assert list(applied) == ["Note", "Work_Station"]
    station = applied["Work_Station"]
    assert graph.target(station, Edge.INSTANCE_OF) is graph["station"]
    assert {k: v for k, v in station.attrs.items() if k.startswith("tag.")} == {
        "tag.bay": "7",
        "tag.isEncapsulated": "arm",
    }
    assert not any(key.startswith("tag.") for key in applied["Note"].attrs)


def test_primitive_types_and_metaclasses_are_those_of_every_dialect():
    graph = read(model(applied=APPLIED), snapshot(COMPANY), snapshot(SYSML, "b")).graph
    assert {(r.source, r.edge, r.target) for r in graph.pending if "#" in r.target} == {
        ("on", "typed-by", "http://www.omg.org/spec/UML/20161101/PrimitiveTypes.xmi#Boolean"),
        ("enc", "typed-by", "http://www.omg.org/spec/UML/20161101/PrimitiveTypes.xmi#Boolean"),
        ("block", "extends", "http://www.omg.org/spec/UML/20161101/UML.xmi#Class"),
    }


def test_an_applied_stereotype_is_found_by_the_name_of_its_profile():
    graph = read(model("", APPLIED.replace("cell", "m")), snapshot(COMPANY)).graph
    assert graph.target(graph["app"], Edge.INSTANCE_OF) is graph["station"]
    assert library(graph) == {
        "company": "Company Profile",
        "station": "Company Profile::Work-Station",
        "bay": "Company Profile::Work-Station::bay",
    }


def test_classes_become_blocks_by_generalization(tmp_path):
    compilation = compile_model(
        Request(
            (archive(tmp_path, model(applied=APPLIED), snapshot(COMPANY), snapshot(SYSML, "b")),)
        )
    )
    assert compilation.graph["app"].attrs["lineage"] == ("Work-Station", "Block")
    assert compilation.graph["cell"].role == compilation.graph["robot"].role == "block"
    assert compilation.graph["p"].role == "part"
    assert [diagnostic.rule.code for diagnostic in compilation.diagnostics] == []


def test_without_the_snapshot_of_its_profile_a_stereotype_is_unknown(tmp_path):
    compilation = compile_model(Request((archive(tmp_path, model(applied=APPLIED)),)))
    assert sorted(diagnostic.rule.code for diagnostic in compilation.diagnostics) == [
        "SM152",
        "SM211",
    ]
    assert compilation.graph["cell"].role == ""


def test_of_several_copies_the_largest_counts():
    small = """<uml:Package xmi:id="lib" ID="lib" name="Library">
      <packagedElement xsi:type="uml:Class" xmi:id="robot" ID="robot" name="Robot" isActive="true"/>
    </uml:Package>"""
    texts = set()
    sources = model(), snapshot(small, "0"), snapshot(COMPANY, "1")
    for order in itertools.permutations(sources):
        reading = read(*order)
        texts.add(reading.text)
        robot = reading.graph["robot"]
        assert robot.source.partition("$h")[2].startswith("1_")
        assert robot.attrs["active"]
    assert len(texts) == 1


def test_the_root_of_another_project_is_not_the_root_of_the_model():
    inside = """<uml:Model xmi:id="m" ID="m" name="Data">
      <packagedElement xsi:type="uml:Class" xmi:id="robot" ID="robot" name="Robot"/></uml:Model>"""
    graph = read(model(), snapshot(inside)).graph
    assert graph["m"].name == "M"
    assert library(graph) == {"robot": "Robot"}


def test_several_models_of_one_archive_are_merged():
    shared = model(
        "<packagedElement xmi:type='uml:Class' xmi:id='tool2' name='Tool 2'/>",
        name="plant.mdzip!com.nomagic.magicdraw.uml_model.shared_model",
    ).data.replace(b"xmi:id='m'", b"xmi:id='m2'")
    first = model(
        "<packagedElement xmi:type='uml:Class' xmi:id='k'><generalization xmi:id='g'>"
        "<general href='PROJECT-1?resource=com.nomagic#tool2'/></generalization>"
        "</packagedElement>"
    )
    graph = read(first, source(shared, "plant.mdzip!x.shared_model")).graph
    assert [r.target for r in graph.pending] == ["tool2"]


def test_every_element_of_a_snapshot_is_counted():
    reading = read(model(), snapshot(COMPANY))
    files = {file["file"]: file for file in reading.coverage.as_json()["files"]}
    counted = files[snapshot(COMPANY).name]
    assert counted["elements"] == (SNAPSHOT % COMPANY).count("<") - 1 - (SNAPSHOT % COMPANY).count(
        "</"
    )
    assert counted["by_type"]["uml:Class"] == {"external": 2, "mapped": 3}


def test_library_content_gives_no_diagnostics_and_no_outputs(tmp_path):
    from sysmlc.driver.registry import list_backend_names, load_backends

    inside = COMPANY.replace('type="lost"', 'isConjugated="true"')
    path = archive(tmp_path, model(), snapshot(inside), snapshot(SYSML, "b"))
    # What CAEX and SysML v2 cannot say of the model is theirs to tell.
    names = [name for name in list_backend_names() if name not in ("aml", "sysml", "sysmlx")]
    compilation = compile_model(Request((path,), backends=tuple(load_backends(names))))
    assert compilation.diagnostics == ()
    drawn = {a.path: a.text for a in compilation.list_published() if a.path.endswith(".puml")}
    assert list(drawn) == ["diagrams/M.bdd.puml"]
    assert "**Cell**" in drawn["diagrams/M.bdd.puml"]
    assert "**Robot**" not in drawn["diagrams/M.bdd.puml"]


@pytest.mark.parametrize(
    ("damage", "findings"),
    [(lambda text: text[:-20], ["broken-snapshot"]), (lambda text: text + b"\n", [])],
)
def test_a_damaged_snapshot_is_skipped_with_a_warning(damage, findings):
    one = snapshot(COMPANY)
    reading = read(model(), source(damage(one.data), one.name))
    assert [diagnostic.rule.name for diagnostic in reading.sink] == findings
    assert ("robot" in reading.graph) is (not findings)
    assert not reading.sink.has_errors()


@pytest.mark.parametrize(
    "inside",
    [
        '<uml:Package ID="robot"><packagedElement xsi:type="uml:Class" ID="robot" name="R"/>'
        "</uml:Package>",
        '<uml:Class ID="robot"><owningPackage href="#lib"/></uml:Class>'
        '<uml:Package ID="lib"><owningPackage href="#robot"/></uml:Package>',
        '<uml:Class ID="robot"><generalization ID="g" general="robot"/></uml:Class>',
        '<uml:Class ID=""/><uml:Class ID="robot"><ownedLiteral ID="l" name="x"/></uml:Class>',
        '<uml:Stereotype ID="robot"><ownedEnd ID="robot2"/><slot ID="s" definingFeature="s"/>'
        "</uml:Stereotype>",
    ],
)
def test_invalid_content_of_a_snapshot_is_ignored(inside):
    graph = read(model(), snapshot(inside)).graph
    assert [r.target.rpartition("#")[2] for r in graph.pending] == ["robot"]


def test_an_archive_of_snapshots_alone_holds_no_model(tmp_path):
    compilation = compile_model(Request((archive(tmp_path, snapshot(COMPANY)),)))
    assert [diagnostic.message for diagnostic in compilation.diagnostics] == [
        "'plant.mdzip' cannot be read: the archive holds no model"
    ]


def test_a_snapshot_is_recognised_by_its_namespace_and_place():
    assert FRONTEND.detect(snapshot(COMPANY)) == 1.0
    assert FRONTEND.links(snapshot(COMPANY)) == []
    lone = source(SNAPSHOT % COMPANY, "company.xml")
    assert FRONTEND.detect(lone) < 1.0


def test_the_library_itself_overrides_its_snapshots(tmp_path):
    whole = model(
        "<packagedElement xmi:type='uml:Class' xmi:id='robot' name='Robot'>"
        "<ownedAttribute xmi:type='uml:Property' xmi:id='arm' name='whole arm'/></packagedElement>"
    ).data.replace(b"xmi:id='m'", b"xmi:id='l'")
    with zipfile.ZipFile(tmp_path / "Company Library.mdzip", "w") as zipped:
        zipped.writestr("com.nomagic.magicdraw.uml_model.model", whole)
    archive(tmp_path, model(), snapshot(COMPANY))
    compilation = compile_model(Request((tmp_path / "plant.mdzip",)))
    assert [file.path.partition("!")[0] for file in compilation.inputs] == [
        "Company Library.mdzip",
        "plant.mdzip",
        "plant.mdzip",
    ]
    assert not library(compilation.graph)
    assert compilation.graph["arm"].name == "whole arm"
    assert (
        compilation.graph.target(compilation.graph["p"], Edge.TYPED_BY)
        is compilation.graph["robot"]
    )


def test_archives_that_use_the_same_library_share_its_elements(tmp_path):
    other = model(
        MODEL.replace("'cell'", "'cell2'").replace("'p'", "'p2'"), name="other.mdzip!x.model"
    ).data.replace(b"xmi:id='m'", b"xmi:id='m2'")
    archive(tmp_path, model(), snapshot(COMPANY), snapshot(SYSML, "b"))
    with zipfile.ZipFile(tmp_path / "other.mdzip", "w") as zipped:
        zipped.writestr("com.nomagic.magicdraw.uml_model.model", other)
        zipped.writestr(snapshot(COMPANY).name.partition("!")[2], snapshot(COMPANY).data)
    compilation = compile_model(Request((tmp_path,)))
    users = compilation.graph.sources(compilation.graph["robot"], Edge.TYPED_BY)
    assert sorted(user.id for user in users) == ["p", "p2"]
    assert [diagnostic.rule.code for diagnostic in compilation.diagnostics] == []


def test_an_id_that_many_files_have_does_not_lead_into_a_snapshot():
    inside = '<uml:Package ID="_0" name="Library"/><uml:Package ID="_1" name="More"/>'
    imports = (
        "<packageImport xmi:type='uml:PackageImport' xmi:id='i%d'><importedPackage href='%s'/>"
        "</packageImport>"
    )
    hrefs = (
        "http://www.omg.org/spec/UML/20110701/PrimitiveTypes.xmi#_0",
        "Company.mdzip#_0",
        "PROJECT-1?resource=x#_1",
    )
    written = "".join(imports % pair for pair in enumerate(hrefs))
    graph = read(model(written), snapshot(inside)).graph
    assert [r.target for r in graph.pending] == [hrefs[0], "_0", "_1"]
