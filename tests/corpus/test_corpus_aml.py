"""AutomationML of real tools: every element accounted for, every reference found or told.

What is expected is counted by lxml scripts of a few lines that know nothing of our front end,
and by AML.Engine 2.0.5, the reference implementation, whose known defects are in ``DEFECTS``.
"""

import csv
import re
from collections import Counter
from pathlib import PurePosixPath

import pytest
from classes_of_aml import lead_nowhere
from lxml import etree

from graph_differences import diff
from sysmlc.diagnostics import Coverage, Place, Severity, Sink
from sysmlc.diagnostics.locations import locate
from sysmlc.driver import Request, compile_model, select_backends
from sysmlc.frontends.caex import FRONTEND
from sysmlc.ir import Edge, Graph, Kind
from sysmlc.ir.verify import verify
from sysmlc.sources import Source, load

pytestmark = pytest.mark.corpus

DEV, BAD = 30, 13


class Read:
    def __init__(self, *paths):
        self.sources = [source for path in paths for source in load(path, path.name)]
        self.graph, self.sink, self.coverage = Graph(), Sink(), Coverage()
        FRONTEND.read(self.sources, self.graph, self.sink, self.coverage)
        assert verify(self.graph) == []

    def codes(self):
        return Counter(found.rule.code for found in self.sink)


@pytest.fixture(scope="module")
def aml(corpus):
    return corpus / "aml"


@pytest.fixture(scope="module")
def reading(aml):
    known = {}

    def read(*names):
        if names not in known:
            known[names] = Read(*(aml / name for name in names))
        return known[names]

    return read


def names(aml, folder):
    return sorted(f"{folder}/{path.name}" for path in (aml / folder).iterdir())


def local(node, *tags):
    return [one for one in node.iter("{*}*") if etree.QName(one).localname in tags]


def tree(source):
    parser = etree.XMLParser(huge_tree=True, resolve_entities=False)
    return etree.fromstring(source.data, parser)


# -- every element is accounted for ------------------------------------------------------------


def test_each_element_of_each_file_has_one_verdict_and_all_are_in_the_graph(aml, reading):
    """Interfaces that name a SystemUnitClass (SM633) are there without that."""
    found = names(aml, "dev")
    assert len(found) == DEV
    for name in found:
        read = reading(name)
        for source in read.sources:
            counted = read.coverage.file(source.name)
            assert counted.elements == sum(1 for _ in tree(source).iter(etree.Element)), name
            interfaces = local(tree(source), "ExternalInterface")
            in_part = sum("RefBaseSystemUnitPath" in one.attrib for one in interfaces)
            assert counted.totals()["mapped"] == counted.elements - in_part, name
            assert counted.totals()["approximated"] == in_part, name


@pytest.mark.parametrize("folder", ["bad", "baygate"])
def test_verdicts_sum_to_the_number_of_elements_of_every_file_that_can_be_read(
    folder, aml, reading
):
    read_at_all = 0
    for path in sorted((aml / folder).glob("*.aml")):
        read = reading(f"{folder}/{path.name}")
        counted = {f.file: f.elements for f in read.coverage.files()}
        if "SM142" not in read.codes():
            expected = sum(1 for _ in tree(read.sources[0]).iter(etree.Element))
            assert counted == {path.name: expected}
            read_at_all += 1
    assert read_at_all == {"bad": 5, "baygate": 3}[folder]


def test_each_dev_entry_compiles(aml):
    """What is wrong in it is told; nothing of the compiler fails, nothing is left out."""
    for name in names(aml, "dev"):
        made = compile_model(Request(inputs=(aml / name,)))
        codes = {found.rule.code for found in made.diagnostics}
        assert not any(code.startswith("SM9") or code == "SM142" for code in codes), name
        assert len(made.graph) > 0, name
        assert verify(made.graph) == [], name


# -- references --------------------------------------------------------------------------------


def link_sides(root):
    """Sides of links that lead to an interface, and all: by the words of IEC 62424."""
    by_id, sides = {}, []
    for node in local(root, "InternalElement", "ExternalInterface", "SystemUnitClass"):
        by_id.setdefault(node.get("ID"), node)
    for link in local(root, "InternalLink"):
        sides += [link.get("RefPartnerSideA"), link.get("RefPartnerSideB")]
    return sum(is_interface(side, by_id) for side in sides), len(sides)


def is_interface(side, by_id):
    if side in by_id:
        return etree.QName(by_id[side]).localname == "ExternalInterface"
    for colon in re.finditer(":", side):
        owner = by_id.get(side[: colon.start()])
        if owner is not None:
            inside = list(owner.iterchildren("{*}ExternalInterface"))
            return side[colon.end() :] in [c.get("Name") for c in inside]
    return False


def class_references(root):
    """References of internal elements to classes of the file: those found, and all."""
    known, all_ids = set(), {node.get("ID") for node in local(root, "InternalElement")}
    for library in local(root, "SystemUnitClassLib"):
        known |= set(paths_below(library, library.get("Name")))
    paths = [n.get("RefBaseSystemUnitPath", "") for n in local(root, "InternalElement")]
    paths = [path for path in paths if path and path not in all_ids]
    return sum(path in known for path in paths), len(paths)


def paths_below(node, path):
    for child in node.iterchildren("{*}SystemUnitClass"):
        below = f"{path}/{child.get('Name')}"
        yield below
        yield from paths_below(child, below)


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("dev/eplan_arapc_example.aml", (58, 58)),
        ("dev/amlsec_casestudy_d.aml", (2028, 2028)),
        ("dev/amlsec_casestudy_a.aml", None),
        ("dev/opak_festo_v35_plc.aml", None),
    ],
)
def test_every_side_of_a_link_that_leads_to_an_interface_is_an_end_of_a_relation(
    name, expected, reading
):
    read = reading(name)
    found, every = link_sides(tree(read.sources[0]))
    assert expected in (None, (found, every))
    ends = read.graph.of_kind(Kind.CONNECTOR_END)
    related = [d for d in read.graph.of_kind(Kind.DEPENDENCY) if d.subkind in ("ppr", "succession")]
    assert (len(ends) + 2 * len(related), read.codes()["SM135"]) == (found, every - found)


@pytest.mark.parametrize(
    ("name", "expected"),
    [("dev/mtp_wago_ecockpit.aml", (55, 55)), ("dev/mtp_tud_minimal.aml", (27, 28))],
)
def test_every_class_of_an_internal_element_is_found_or_told(name, expected, reading):
    read = reading(name)
    assert class_references(tree(read.sources[0])) == expected
    found, every = expected
    told = [f for f in read.sink if f.rule.code == "SM130" and "SUCLib" in f.message]
    assert len(told) == every - found


@pytest.mark.parametrize("name", ["mtp_wago_ecockpit", "mtp_tud_minimal", "vera_plant"])
def test_a_class_that_lxml_finds_is_the_type_of_the_part_or_instance(name, reading):
    read = reading(f"dev/{name}.aml")
    graph, seen = read.graph, 0
    root = tree(read.sources[0])
    known = {
        path
        for library in local(root, "SystemUnitClassLib")
        for path in paths_below(library, library.get("Name"))
    }
    for node in local(root, "InternalElement"):
        path = node.get("RefBaseSystemUnitPath")
        element = graph.get(node.get("ID"))
        if path in known and element is not None:
            holders = [element, *graph.targets(element, Edge.REPRESENTS)]
            edges = [(one, edge) for one in holders for edge in (Edge.TYPED_BY, Edge.INSTANCE_OF)]
            types = [type_ for one, edge in edges for type_ in graph.targets(one, edge)]
            general = [graph.qualified_name(t) for type_ in types for t in above(graph, type_)]
            assert path.replace("/", "::") in general, path
            seen += 1
    assert seen > 10


def above(graph, type_):
    """A class and those that it specialises."""
    found = [type_]
    for one in found:
        found += [t for t in graph.targets(one, Edge.SPECIALIZES) if t not in found]
    return found


DEFECTS = {
    "eplan_arapc_example.aml": "names of interfaces with '.' are cut: 54 of 58 sides",
    "mtp_wago_ecockpit.aml": "an InternalElement hides the nested class of its name: 49 of 55",
    "mtp_tud_minimal.aml": "the same: 21 of 28",
}
"""What AML.Engine 2.0.5 does not find, though it is there."""


def test_aml_engine_finds_no_side_and_no_class_that_we_do_not_find(aml, reading):
    rows = list(oracle(aml))
    assert len(rows) > 20
    seen = set()
    for name, row in rows:
        folder = "dev" if (aml / "dev" / name).exists() else "bad"
        read = reading(f"{folder}/{name}")
        root = tree(read.sources[0])
        sides, _ = link_sides(root)
        classes, _ = class_references(root)
        if (sides, classes) != (row["sides_ok"], row["resolved"]):
            assert sides >= row["sides_ok"], name
            assert classes >= row["resolved"], name
            seen.add(name)
    assert seen == set(DEFECTS)


def oracle(aml):
    for line in csv.reader((aml / "oracle_amlengine_2.0.5.tsv").open(), delimiter="\t"):
        cells = dict(cell.split("=") for cell in line[1:] if re.fullmatch(r"\w+=\d+", cell))
        if "sides_ok" in cells and not line[0].startswith("BayGate"):
            yield PurePosixPath(line[0]).name, {k: int(v) for k, v in cells.items()}


def test_each_reference_that_leads_nowhere_is_told_with_its_line(aml, reading):
    for name in names(aml, "dev"):
        read = reading(name)
        places = [found.subject.place for found in read.sink]
        located = locate(read.sources, places)
        assert all(located[place].line > 0 for place in places), name
        missing = [f for f in read.sink if f.rule.code in ("SM131", "SM132")]
        for found in missing:
            assert found.notes, name
            assert all(re.search(r":\d+:\d+\)$", note) for note in found.notes), name


SINGLE, TOGETHER = {"SM130", "SM133", "SM138"}, {"SM131", "SM132"}
"""Rules that are told at each reference, and those that list what they take down."""


def test_the_references_that_lxml_finds_in_vain_are_told_at_their_lines(aml, reading):
    files = [f"dev/{p.name}" for p in sorted((aml / "dev").glob("*.aml"))]
    files += [
        f"bad/i40_{name}.aml" for name in ("alias_undeclared", "link_freetext", "wrong_order")
    ]
    for name in files:
        read = reading(name)
        (source,) = read.sources
        places = [Place(source.name, n) for n in lead_nowhere(tree(source))]
        expected = {found.line for found in locate([source], places).values()}
        assert told_lines(read, source) == expected, name


def told_lines(read, source):
    """Lines of all references that are told to lead nowhere."""
    single = [f.subject.place for f in read.sink if f.rule.code in SINGLE]
    held = [f.subject.place for f in read.sink if f.rule.code == "SM149"]
    lines = {found.line for found in locate([source], [*single, *held]).values()}
    notes = (note for f in read.sink if f.rule.code in TOGETHER for note in f.notes)
    return lines | {int(re.search(r":(\d+):\d+\)$", note)[1]) for note in notes}


# -- what must be diagnosed --------------------------------------------------------------------


@pytest.mark.parametrize(
    ("name", "codes"),
    [
        ("bad/arapc_classlibs_notwellformed.aml", {"SM142": 1}),
        ("bad/i40_link_freetext.aml", {"SM135": 26}),
        ("bad/i40_link_dangling.aml", {"SM135": 2}),
        ("bad/i40_link_no_iface.aml", {"SM135": 2}),
        ("bad/i40_alias_undeclared.aml", {"SM133": 24}),
        ("bad/i40_wrong_order.aml", {"SM140": 1}),
    ],
)
def test_a_bad_file_is_told_what_its_row_in_the_readme_says(name, codes, reading):
    read = reading(name)
    found = read.codes()
    assert {code: found[code] for code in codes} == codes


def test_sides_that_lead_nowhere_are_those_that_lxml_finds(aml, reading):
    for name in ("freetext", "dangling", "no_iface"):
        read = reading(f"bad/i40_link_{name}.aml")
        found, every = link_sides(tree(read.sources[0]))
        assert read.codes()["SM135"] == every - found


CONTAINERS = {
    "AdditionalDocumentNotInRels": "no relationship of the package leads to its part",
    "AutomationMLComponent_WithMissingDocuments": "it has no part 'files/TestTXTDeviceManual.txt'",
    "InvalidRootAmlDocument": "is not a model: it is",
    "MissingPart": "it has no part 'wrongFilePath.txt'",
    "MissingRootDocument": "it has no part 'wrongLinkToFile.aml'",
    "MultipleRootDocuments": "it has 2 root documents, 'root1.aml' and 'root2.aml'",
    "NoRootDocument": "no relationship names its root document",
}


def test_each_bad_container_gives_one_located_error(aml):
    found = [name for name in names(aml, "bad") if name.endswith(".amlx")]
    assert found == [f"bad/invalid_{name}.amlx" for name in CONTAINERS]
    assert len(names(aml, "bad")) == BAD
    for name, problem in CONTAINERS.items():
        made = compile_model(Request(inputs=(aml / "bad" / f"invalid_{name}.amlx",)))
        (error,) = made.diagnostics
        assert problem in error.message
        assert error.severity is Severity.ERROR
        assert error.subject.place.file.startswith(f"invalid_{name}.amlx!")


# -- BayGate -----------------------------------------------------------------------------------

FILES = ["BayGate.aml", "BayGate_caex215.aml", "BayGate_extlibs.aml", "BayGate.amlx"]


@pytest.fixture(scope="module")
def compiled(aml):
    drawn = tuple(select_backends(("plantuml",)))
    requests = {name: Request(inputs=(aml / "baygate" / name,), backends=drawn) for name in FILES}
    return {name: compile_model(request) for name, request in requests.items()}


def is_of_user(graph, element):
    return not element.attrs.get("external")


@pytest.mark.parametrize("name", FILES)
def test_baygate_has_the_totals_of_its_description(name, compiled):
    """Section 11 of baygate/expected.md."""
    graph = compiled[name].graph
    own = [element for element in graph if is_of_user(graph, element)]
    kinds = Counter((e.kind, e.role, e.subkind) for e in own)
    libraries = {"system-unit-class-lib", "role-class-lib", "interface-class-lib"}
    blocks = [element for element in own if element.kind is Kind.CLASS]
    general = [t for e in blocks for t in graph.targets(e, Edge.SPECIALIZES)]
    assert {
        "bdd": sum(e.kind is Kind.PACKAGE and e.subkind in libraries for e in own),
        "ibd": sum(e.kind is Kind.INSTANCE and e.subkind == "" for e in own),
        "blocks": kinds[Kind.CLASS, "block", ""],
        "roles": kinds[Kind.CLASS, "block", "role-class"],
        "interface blocks": kinds[Kind.CLASS, "interface block", ""],
        "ports": sum(e.kind is Kind.PORT for e in own),
        "parts": kinds[Kind.PROPERTY, "part", ""],
        "values": kinds[Kind.PROPERTY, "value", ""],
        "generalizations": len(general),
        "of them to user classes": sum(is_of_user(graph, t) for t in general),
        "realizations": sum(len(graph.targets(e, Edge.REALIZES)) for e in own),
        "connectors": sum(e.kind is Kind.CONNECTOR for e in own),
        "slots": {e.name: e.attrs["value"] for e in own if e.kind is Kind.SLOT},
        "unresolved": sum("unresolved" in e.attrs for e in graph),
        "diagnostics": list(compiled[name].diagnostics),
    } == {
        "bdd": 3,
        "ibd": 1,
        "blocks": 5,
        "roles": 3,
        "interface blocks": 1,
        "ports": 10,
        "parts": 3,
        "values": 2,
        "generalizations": 5,
        "of them to user classes": 1,
        "realizations": 6,
        "connectors": 5,
        "slots": {"length": 1.2, "velocity": 0.3},
        "unresolved": 0,
        "diagnostics": [],
    }


@pytest.mark.parametrize("name", FILES)
def test_the_diagrams_of_baygate_are_those_of_the_thesis(name, compiled):
    """Table 3.1; the value types of CAEX 3.0 (section 6) have a diagram of their own."""
    drawn = {artefact.path.removesuffix(".puml") for artefact in compiled[name].artefacts}
    assert drawn - {"diagrams/Quantities.bdd"} == {
        "diagrams/BayGate%20Breakdown.bdd",
        "diagrams/SysML-RCL.bdd",
        "diagrams/Interface%20Lib.bdd",
        "diagrams/BayGate%20System.BayGate.ibd",
    }


def test_the_links_of_baygate_are_connectors_between_its_ports(compiled):
    for made in compiled.values():
        graph = made.graph
        ends = {
            c.name: [
                ".".join(
                    step.name for e in (Edge.PATH, Edge.ROLE) for step in graph.targets(end, e)
                )
                for end in graph.targets(c, Edge.END)
            ]
            for c in graph.of_kind(Kind.CONNECTOR)
        }
        assert ends == {
            "l_bgIn_sIn": ["p_bgIn", "st.p_sIn"],
            "l_stRf_rfIn": ["st.p_stRf", "rf.p_rfIn"],
            "l_sOut_swIn": ["st.p_sOut", "sw.p_swIn"],
            "l_swOut_bgOut": ["sw.p_swOut", "p_bgOut"],
            "l_swCb_bgCb": ["sw.p_swCb", "p_bgCb"],
        }


HEADER = {"Document", "Import", "Metadata"}
"""Kinds that tell of the files: there are one, three or three in a package."""


@pytest.mark.parametrize("name", FILES[1:])
def test_the_four_files_give_one_graph(name, aml):
    made = (compile_model(Request(inputs=(aml / "baygate" / one,))) for one in (FILES[0], name))
    first, other = (without_header(one.graph) for one in made)
    if name == "BayGate_caex215.aml":
        first, other = without_types(first), without_types(other)
    assert diff(first, other, ignore=("id", "source", "trace", "interface_ids")) == []


def without_header(graph):
    for element in [e for e in graph.roots() if e.kind.value in HEADER]:
        graph.remove(element)
    return graph


def without_types(graph):
    """CAEX 2.15 has no AttributeTypeLib: the types of values are made of their units."""
    for package in [e for e in graph.roots() if e.subkind == "attribute-type-lib"]:
        graph.remove(package)
    for type_ in graph.of_kind(Kind.DATA_TYPE):
        if type_.id in graph:
            graph.remove(type_)
    return graph


# -- encodings ---------------------------------------------------------------------------------


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16", "utf-16-le", "utf-16-be", "utf-8"])
def test_the_encoding_of_a_file_changes_nothing(encoding, aml, reading):
    text = (aml / "baygate" / "BayGate.aml").read_text("utf-8-sig")
    declared = "utf-16" if "16" in encoding else "utf-8"
    data = text.replace('encoding="utf-8"', f'encoding="{declared}"').encode(encoding)
    graph, sink = Graph(), Sink()
    source = Source("BayGate.aml", data)
    assert FRONTEND.detect(source) == 1
    FRONTEND.read([source], graph, sink, Coverage())
    assert list(sink) == []
    assert diff(reading("baygate/BayGate.aml").graph, graph) == []
