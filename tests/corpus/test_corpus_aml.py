"""AutomationML of real tools: elements have verdicts, references are resolved or reported.

The expected numbers are counted by short lxml scripts, which are independent of the front end, and
by AML.Engine 2.0.5, the reference implementation, whose known defects are in ``DEFECTS``.
"""

import csv
import re
from collections import Counter
from pathlib import PurePosixPath

import pytest
from aml_classes import iter_unresolved
from lxml import etree
from reading_corpus import load_files, local_name, parse_data

from graph_differences import diff
from sysmlc.diagnostics import Coverage, Place, Severity, Sink
from sysmlc.diagnostics.locations import locate
from sysmlc.driver import Request, compile_model
from sysmlc.frontends.caex import FRONTEND
from sysmlc.ir import Edge, Graph, Kind
from sysmlc.ir.verify import verify
from sysmlc.sources import Source

pytestmark = pytest.mark.corpus

DEV, BAD = 30, 13


class Reading:
    def __init__(self, *paths):
        self.sources = load_files(*paths)
        self.graph, self.sink, self.coverage = Graph(), Sink(), Coverage()
        FRONTEND.read(self.sources, self.graph, self.sink, self.coverage)
        assert verify(self.graph) == []

    def count_codes(self):
        return Counter(diagnostic.rule.code for diagnostic in self.sink)


@pytest.fixture(scope="module")
def aml(corpus):
    return corpus / "aml"


@pytest.fixture(scope="module")
def read_entries(aml):
    readings = {}

    def read(*names):
        if names not in readings:
            readings[names] = Reading(*(aml / name for name in names))
        return readings[names]

    return read


def list_entries(aml, folder):
    return sorted(f"{folder}/{path.name}" for path in (aml / folder).iterdir())


def find_local(node, *tags):
    return [element for element in node.iter("{*}*") if local_name(element) in tags]


def parse_source(source):
    return parse_data(source.data)


# -- verdicts of elements ----------------------------------------------------------------------


def test_every_element_of_every_file_is_mapped_or_approximated(aml, read_entries):
    """Interfaces that refer to a SystemUnitClass (SM633) are approximated without the reference."""
    entries = list_entries(aml, "dev")
    assert len(entries) == DEV
    for name in entries:
        reading = read_entries(name)
        for source in reading.sources:
            coverage = reading.coverage.file(source.name)
            assert coverage.elements == sum(1 for _ in parse_source(source).iter(etree.Element)), (
                name
            )
            interfaces = find_local(parse_source(source), "ExternalInterface")
            approximated = sum(
                "RefBaseSystemUnitPath" in interface.attrib for interface in interfaces
            )
            assert coverage.totals()["mapped"] == coverage.elements - approximated, name
            assert coverage.totals()["approximated"] == approximated, name


@pytest.mark.parametrize("folder", ["bad", "baygate"])
def test_verdicts_sum_to_the_number_of_elements_of_every_readable_file(folder, aml, read_entries):
    readable = 0
    for path in sorted((aml / folder).glob("*.aml")):
        reading = read_entries(f"{folder}/{path.name}")
        counts = {coverage.file: coverage.elements for coverage in reading.coverage.files()}
        if "SM142" not in reading.count_codes():
            expected = sum(1 for _ in parse_source(reading.sources[0]).iter(etree.Element))
            assert counts == {path.name: expected}
            readable += 1
    assert readable == {"bad": 5, "baygate": 3}[folder]


def test_each_dev_entry_compiles(aml):
    """Faults in an entry are reported; no entry is omitted, and none makes the compiler fail."""
    for name in list_entries(aml, "dev"):
        compilation = compile_model(Request(inputs=(aml / name,)))
        codes = {diagnostic.rule.code for diagnostic in compilation.diagnostics}
        assert not any(code.startswith("SM9") or code == "SM142" for code in codes), name
        assert len(compilation.graph) > 0, name
        assert verify(compilation.graph) == [], name


# -- references --------------------------------------------------------------------------------


def count_link_sides(root):
    """Count the sides of links that name an interface, and all sides, according to IEC 62424."""
    by_id, sides = {}, []
    for node in find_local(root, "InternalElement", "ExternalInterface", "SystemUnitClass"):
        by_id.setdefault(node.get("ID"), node)
    for link in find_local(root, "InternalLink"):
        sides += [link.get("RefPartnerSideA"), link.get("RefPartnerSideB")]
    return sum(is_interface(side, by_id) for side in sides), len(sides)


def is_interface(side, by_id):
    if side in by_id:
        return local_name(by_id[side]) == "ExternalInterface"
    for colon in re.finditer(":", side):
        owner = by_id.get(side[: colon.start()])
        if owner is not None:
            interfaces = list(owner.iterchildren("{*}ExternalInterface"))
            return side[colon.end() :] in [interface.get("Name") for interface in interfaces]
    return False


def count_class_references(root):
    """Count the resolved references of internal elements to classes of the file, and all."""
    class_paths = find_class_paths(root)
    elements = find_local(root, "InternalElement")
    ids = {element.get("ID") for element in elements}
    paths = [element.get("RefBaseSystemUnitPath", "") for element in elements]
    paths = [path for path in paths if path and path not in ids]
    return sum(path in class_paths for path in paths), len(paths)


def find_class_paths(root):
    return {
        path
        for library in find_local(root, "SystemUnitClassLib")
        for path in iter_class_paths(library, library.get("Name"))
    }


def iter_class_paths(node, path):
    for child in node.iterchildren("{*}SystemUnitClass"):
        child_path = f"{path}/{child.get('Name')}"
        yield child_path
        yield from iter_class_paths(child, child_path)


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("dev/eplan_arapc_example.aml", (58, 58)),
        ("dev/amlsec_casestudy_d.aml", (2028, 2028)),
        ("dev/amlsec_casestudy_a.aml", None),
        ("dev/opak_festo_v35_plc.aml", None),
    ],
)
def test_every_side_of_a_link_at_an_interface_is_an_end_of_a_relation(name, expected, read_entries):
    reading = read_entries(name)
    resolved, total = count_link_sides(parse_source(reading.sources[0]))
    assert expected in (None, (resolved, total))
    ends = reading.graph.of_kind(Kind.CONNECTOR_END)
    relations = [
        d for d in reading.graph.of_kind(Kind.DEPENDENCY) if d.subkind in ("ppr", "succession")
    ]
    assert (len(ends) + 2 * len(relations), reading.count_codes()["SM135"]) == (
        resolved,
        total - resolved,
    )


@pytest.mark.parametrize(
    ("name", "expected"),
    [("dev/mtp_wago_ecockpit.aml", (55, 55)), ("dev/mtp_tud_minimal.aml", (27, 28))],
)
def test_every_class_of_an_internal_element_is_resolved_or_reported(name, expected, read_entries):
    reading = read_entries(name)
    assert count_class_references(parse_source(reading.sources[0])) == expected
    resolved, total = expected
    reported = [
        diagnostic
        for diagnostic in reading.sink
        if diagnostic.rule.code == "SM130" and "SUCLib" in diagnostic.message
    ]
    assert len(reported) == total - resolved


@pytest.mark.parametrize("name", ["mtp_wago_ecockpit", "mtp_tud_minimal", "vera_plant"])
def test_a_class_that_lxml_finds_is_the_type_of_the_part_or_instance(name, read_entries):
    reading = read_entries(f"dev/{name}.aml")
    graph, count = reading.graph, 0
    root = parse_source(reading.sources[0])
    class_paths = find_class_paths(root)
    for node in find_local(root, "InternalElement"):
        path = node.get("RefBaseSystemUnitPath")
        element = graph.get(node.get("ID"))
        if path in class_paths and element is not None:
            holders = [element, *graph.targets(element, Edge.REPRESENTS)]
            edges = [
                (holder, edge) for holder in holders for edge in (Edge.TYPED_BY, Edge.INSTANCE_OF)
            ]
            types = [type_ for holder, edge in edges for type_ in graph.targets(holder, edge)]
            generals = [
                graph.qualified_name(t) for type_ in types for t in list_generals(graph, type_)
            ]
            assert path.replace("/", "::") in generals, path
            count += 1
    assert count > 10


def list_generals(graph, type_):
    """Return a class and the classes that it specialises."""
    classes = [type_]
    for class_ in classes:
        classes += [t for t in graph.targets(class_, Edge.SPECIALIZES) if t not in classes]
    return classes


DEFECTS = {
    "eplan_arapc_example.aml": "names of interfaces with '.' are cut: 54 of 58 sides",
    "mtp_wago_ecockpit.aml": "an InternalElement hides the nested class of its name: 49 of 55",
    "mtp_tud_minimal.aml": "the same: 21 of 28",
}
"""References that AML.Engine 2.0.5 fails to resolve."""


def test_aml_engine_resolves_no_side_and_no_class_that_sysmlc_does_not(aml, read_entries):
    rows = list(read_oracle(aml))
    assert len(rows) > 20
    differing = set()
    for name, row in rows:
        folder = "dev" if (aml / "dev" / name).exists() else "bad"
        reading = read_entries(f"{folder}/{name}")
        root = parse_source(reading.sources[0])
        sides, _ = count_link_sides(root)
        classes, _ = count_class_references(root)
        if (sides, classes) != (row["sides_ok"], row["resolved"]):
            assert sides >= row["sides_ok"], name
            assert classes >= row["resolved"], name
            differing.add(name)
    assert differing == set(DEFECTS)


def read_oracle(aml):
    for line in csv.reader((aml / "oracle_amlengine_2.0.5.tsv").open(), delimiter="\t"):
        cells = dict(cell.split("=") for cell in line[1:] if re.fullmatch(r"\w+=\d+", cell))
        if "sides_ok" in cells and not line[0].startswith("BayGate"):
            yield PurePosixPath(line[0]).name, {k: int(v) for k, v in cells.items()}


def test_every_unresolved_reference_is_reported_with_its_line(aml, read_entries):
    for name in list_entries(aml, "dev"):
        reading = read_entries(name)
        places = [diagnostic.subject.place for diagnostic in reading.sink]
        located = locate(reading.sources, places)
        assert all(located[place].line > 0 for place in places), name
        missing = [
            diagnostic for diagnostic in reading.sink if diagnostic.rule.code in ("SM131", "SM132")
        ]
        for diagnostic in missing:
            assert diagnostic.notes, name
            assert all(re.search(r":\d+:\d+\)$", note) for note in diagnostic.notes), name


RULES_AT_REFERENCES, RULES_WITH_NOTES = {"SM130", "SM133", "SM138"}, {"SM131", "SM132"}
"""Rules reported at each reference, and rules that list several references in notes."""


def test_the_reported_lines_are_those_of_the_references_that_lxml_cannot_resolve(aml, read_entries):
    files = [f"dev/{path.name}" for path in sorted((aml / "dev").glob("*.aml"))]
    files += [
        f"bad/i40_{name}.aml" for name in ("alias_undeclared", "link_freetext", "wrong_order")
    ]
    for name in files:
        reading = read_entries(name)
        (source,) = reading.sources
        places = [Place(source.name, n) for n in iter_unresolved(parse_source(source))]
        expected = {location.line for location in locate([source], places).values()}
        assert list_reported_lines(reading, source) == expected, name


def list_reported_lines(reading, source):
    """Return the lines of all references that are reported as unresolved."""
    single = [
        diagnostic.subject.place
        for diagnostic in reading.sink
        if diagnostic.rule.code in RULES_AT_REFERENCES
    ]
    held_back = [
        diagnostic.subject.place for diagnostic in reading.sink if diagnostic.rule.code == "SM149"
    ]
    lines = {location.line for location in locate([source], [*single, *held_back]).values()}
    notes = (
        note
        for diagnostic in reading.sink
        if diagnostic.rule.code in RULES_WITH_NOTES
        for note in diagnostic.notes
    )
    return lines | {int(re.search(r":(\d+):\d+\)$", note)[1]) for note in notes}


# -- expected diagnostics ---------------------------------------------------------------------


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
def test_a_bad_file_has_the_diagnostics_of_its_row_in_the_readme(name, codes, read_entries):
    reading = read_entries(name)
    counts = reading.count_codes()
    assert {code: counts[code] for code in codes} == codes


def test_unresolved_sides_are_as_many_as_lxml_counts(aml, read_entries):
    for name in ("freetext", "dangling", "no_iface"):
        reading = read_entries(f"bad/i40_link_{name}.aml")
        resolved, total = count_link_sides(parse_source(reading.sources[0]))
        assert reading.count_codes()["SM135"] == total - resolved


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
    containers = [name for name in list_entries(aml, "bad") if name.endswith(".amlx")]
    assert containers == [f"bad/invalid_{name}.amlx" for name in CONTAINERS]
    assert len(list_entries(aml, "bad")) == BAD
    for name, problem in CONTAINERS.items():
        compilation = compile_model(Request(inputs=(aml / "bad" / f"invalid_{name}.amlx",)))
        (error,) = compilation.diagnostics
        assert problem in error.message
        assert error.severity is Severity.ERROR
        assert error.subject.place.file.startswith(f"invalid_{name}.amlx!")


# -- encodings ---------------------------------------------------------------------------------


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16", "utf-16-le", "utf-16-be", "utf-8"])
def test_the_graph_does_not_depend_on_the_encoding_of_the_file(encoding, aml, read_entries):
    text = (aml / "baygate" / "BayGate.aml").read_text("utf-8-sig")
    declared_encoding = "utf-16" if "16" in encoding else "utf-8"
    data = text.replace('encoding="utf-8"', f'encoding="{declared_encoding}"').encode(encoding)
    graph, sink = Graph(), Sink()
    source = Source("BayGate.aml", data)
    assert FRONTEND.detect(source) == 1
    FRONTEND.read([source], graph, sink, Coverage())
    assert list(sink) == []
    assert diff(read_entries("baygate/BayGate.aml").graph, graph) == []
