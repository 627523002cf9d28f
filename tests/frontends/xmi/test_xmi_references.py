"""References between files: paths of EMF, elements that are references, other dialects' ids."""

import itertools

import pytest
from reading_xmi import magicdraw, papyrus, read, source

from sysmlc.frontends.xmi import FRONTEND
from sysmlc.ir import Edge, Kind

LIBRARY = """
<packagedElement xmi:type="uml:Package" xmi:id="p" name="Parts">
  <packagedElement xmi:type="uml:Class" xmi:id="wheel" name="Wheel">
    <ownedAttribute xmi:id="hub" name="hub"/>
    <ownedComment xmi:id="note"/>
    <ownedAttribute xmi:id="rim" name="rim"/>
  </packagedElement>
</packagedElement>"""
BLOCK = '<Blocks:Block xmi:id="app" base_Class="wheel"/>'


def refers_to(fragment, file="lib/Other.uml"):
    return papyrus(
        '<packagedElement xmi:type="uml:Class" xmi:id="k" name="K"><ownedAttribute xmi:id="a">'
        f'<subsettedProperty href="{file}#{fragment}"/></ownedAttribute></packagedElement>'
    )


def target(fragment, file="lib/Other.uml"):
    other = papyrus(LIBRARY, BLOCK, name="lib/Other.uml")
    reading = read(refers_to(fragment, file), other)
    (reference,) = (r for r in reading.graph.pending if r.source == "a")
    return reference.target


@pytest.mark.parametrize(
    ("fragment", "expected"),
    [
        ("/", "lib/Other.uml#m"),
        ("/0", "lib/Other.uml#m"),
        ("//@packagedElement.0", "p"),
        ("/0/@packagedElement.0/@packagedElement.0", "wheel"),
        ("//@packagedElement.0/@packagedElement.0/@ownedAttribute.1", "rim"),
        ("//@packagedElement/@packagedElement/@ownedComment", "note"),
        ("//Parts/Wheel/hub", "hub"),
        ("/1", "app"),
    ],
)
def test_paths_of_emf_lead_through_the_file_that_they_name(fragment, expected):
    assert target(fragment) == expected


@pytest.mark.parametrize(
    "fragment",
    [
        "/2",
        "/x",
        "//@packagedElement.1",
        "//@packagedElement.-1",
        "//@packagedElement.99999999999999999999",
        "//@packagedElement.0/@nothing.0",
        "//Parts/Nothing",
        "//@packagedElement.²",
        "///",
    ],
)
def test_a_path_without_target_becomes_an_external_stub(fragment):
    assert target(fragment) == f"lib/Other.uml#{fragment}"


def test_a_path_is_found_in_the_file_of_that_name_wherever_it_is():
    path = "//@packagedElement.0/@packagedElement.0"
    assert target(path, "platform:/resource/Project/Other.uml") == "wheel"
    assert target(path, "pathmap://PLANT/Other.uml") == "wheel"
    assert target(path, "Third.uml") == f"Third.uml#{path}"


def test_a_file_without_ids_refers_to_itself_by_paths():
    reading = read(
        source(
            """<uml:Model xmi:version="2.1" xmlns:xmi="http://schema.omg.org/spec/XMI/2.1"
 xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"
 xmlns:uml="http://www.eclipse.org/uml2/3.0.0/UML" name="M">
  <packagedElement xmi:type="uml:Class" name="A">
    <ownedAttribute name="b" type="//@packagedElement.1"/>
    <generalization general="//B"/>
  </packagedElement>
  <packagedElement xmi:type="uml:Class" name="B"/>
</uml:Model>"""
        )
    )
    classes = {e.name: e.id for e in reading.graph.of_kind(Kind.CLASS)}
    assert [(r.edge, r.target) for r in reading.graph.pending] == [
        (Edge.TYPED_BY, classes["B"]),
        (Edge.SPECIALIZES, classes["B"]),
    ]


@pytest.mark.parametrize("feature", ["packagedElement", "nestedPackage", "ownedAttribute"])
def test_an_element_with_href_and_no_id_is_a_reference(feature):
    library = papyrus(LIBRARY, name="lib.uml")
    inside = f'<{feature} xmi:type="uml:Class" href="lib.uml#wheel"/>'
    model = papyrus(f'<packagedElement xmi:type="uml:Class" xmi:id="k">{inside}</packagedElement>')
    alone = read(model)
    assert [e.id for e in alone.graph] == ["m", "k"]
    assert not alone.sink.has_errors()
    graph = read(model, library).graph
    assert len(graph.of_kind(Kind.CLASS)) == 2
    assert graph["wheel"].owner == "p"


def test_stereotypes_are_applied_from_another_file():
    plant = papyrus(LIBRARY, name="plant.uml")
    applied = source(
        """<xmi:XMI xmi:version="20131001" xmlns:xmi="http://www.omg.org/spec/XMI/20131001"
 xmlns:Blocks="http://www.eclipse.org/papyrus/sysml/1.6/SysML/Blocks"
 xmlns:uml="http://www.eclipse.org/uml2/5.0.0/UML">
 <Blocks:Block xmi:id="app"><base_Class xmi:type="uml:Class" href="plant.uml#wheel"/></Blocks:Block>
</xmi:XMI>""",
        "stereotypes.uml",
    )
    for order in itertools.permutations((plant, applied)):
        graph = read(*order).graph
        assert graph["app"].owner == "wheel"
        assert (Edge.SUBJECT, "app", "wheel") in {
            (r.edge, r.source, r.target) for r in graph.pending
        }


def test_files_of_two_dialects_refer_to_each_other():
    lib = papyrus(LIBRARY, name="lib.uml")
    cell = magicdraw(
        "<packagedElement xmi:type='uml:Class' xmi:id='cell' name='Cell'>"
        "<ownedAttribute xmi:type='uml:Property' xmi:id='w'><type href='lib.uml#wheel'/>"
        "</ownedAttribute></packagedElement>",
        name="cell.mdxml",
    )
    line = papyrus(
        '<packagedElement xmi:type="uml:Class" xmi:id="line"><generalization xmi:id="g">'
        '<general xmi:type="uml:Class" href="cell.mdxml#cell"/></generalization></packagedElement>',
        name="line.uml",
    )
    texts = set()
    for order in itertools.permutations((lib, cell, line)):
        reading = read(*order)
        references = {(r.source, r.target) for r in reading.graph.pending}
        assert {("w", "wheel"), ("line", "cell")} <= references
        assert "external" not in reading.totals
        texts.add(reading.text)
    assert len(texts) == 1


ROOT = "eee_1045467100313_135436_1"
"""MagicDraw gives this id to the root of every project."""


def project(name, reference):
    text = f"""<xmi:XMI xmlns:uml="http://www.omg.org/spec/UML/20131001"
 xmlns:xmi="http://www.omg.org/spec/XMI/20131001">
<uml:Model xmi:type="uml:Model" xmi:id="{ROOT}" name="Model">
  <packagedElement xmi:type="uml:Dependency" xmi:id="{name}">
    <client xmi:idref="{ROOT}"/>{reference}</packagedElement>
</uml:Model></xmi:XMI>"""
    return source(text, f"{name}.mdzip!com.nomagic.magicdraw.uml_model.model")


def test_roots_of_magicdraw_have_the_same_id_in_every_project():
    elsewhere = f"PROJECT-9?resource=x#{ROOT}"
    sources = (
        project("a", f'<supplier href="b.mdzip#{ROOT}"/>'),
        project("b", f'<supplier href="{elsewhere}"/>'),
    )
    for order in itertools.permutations(sources):
        pending = read(*order).graph.pending
        assert {(r.edge, r.source, r.target) for r in pending} == {
            (Edge.CLIENT, "a", f"{sources[0].name}#{ROOT}"),
            (Edge.SUPPLIER, "a", f"{sources[1].name}#{ROOT}"),
            (Edge.CLIENT, "b", f"{sources[1].name}#{ROOT}"),
            (Edge.SUPPLIER, "b", elsewhere),
        }
    (alone,) = (r for r in read(sources[1]).graph.pending if r.edge == Edge.SUPPLIER)
    assert alone.target == elsewhere


def test_percent_encoded_folders_distinguish_files_of_the_same_name():
    """Ids as short as this one are in many files: only the whole path says which is meant."""
    model = refers_to("wheel", "my%20parts/lib.uml")
    others = [papyrus(LIBRARY, name=f"{folder}/lib.uml") for folder in ("my parts", "others")]
    graph = read(model, *others).graph
    assert "my parts/lib.uml#wheel" in [r.target for r in graph.pending]


def test_percent_encoded_files_are_found():
    model = refers_to("wheel", "lib/My%20Parts%C3%A9.uml")
    other = papyrus(LIBRARY, name="lib/My Partsé.uml")
    assert "wheel" in [r.target for r in read(model, other).graph.pending]
    assert FRONTEND.links(model) == ["lib/My%20Parts%C3%A9.uml"]
