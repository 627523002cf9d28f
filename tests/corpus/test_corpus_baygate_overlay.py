"""BayGate refined by an overlay: section 10 of baygate/expected.md, for each of its four files.

The overlay and the activity follow sections 3.4.1 and 3.4.2 of the thesis.
"""

import re
import shutil
from collections import Counter

import pytest
from reading_corpus import BAYGATE_FILES

from sysmlc.driver import Request, compile_model, select_backends
from sysmlc.ir import Edge, Kind
from sysmlc.logic.contract import Contract

pytestmark = pytest.mark.corpus
spot = pytest.importorskip("spot")

ITEMS = """\
overlay: 1
items:
  MiniPallet: {domain: physical, description: It moves through the gate.}
  RFID_Tag: {domain: information, description: The identifier of a minipallet.}
"""
CONNECTORS = """\
connectors:
  a6a74a3b-e21d-5fba-8dc1-0ca4f3cc5043/l_bgIn_sIn:
    flows: [{item: MiniPallet, from: p_bgIn, to: st/p_sIn}]
  BayGate System/BayGate/l_stRf_rfIn:
    flows: [{item: RFID_Tag, to: rf}]
  BayGate System/BayGate/l_sOut_swIn:
    flows: [{item: MiniPallet, from: st.p_sOut}]
  BayGate System/BayGate/l_swOut_bgOut:
    flows: [{item: MiniPallet, to: p_bgOut}]
  BayGate System/BayGate/l_swCb_bgCb:
    flows: [{item: MiniPallet, both-ways: true}]
"""
BLOCKS = """\
blocks:
  BayGate Breakdown/RFID_Reader:
    operations:
      readId: {parameters: [{name: tag, type: RFID_Tag}]}
  BayGate Breakdown/Stopper:
    operations:
      release: {parameters: [{name: pallet, type: MiniPallet, direction: return}]}
  BayGate Breakdown/Switch:
    operations:
      getInPallet: {parameters: [{name: pallet, type: MiniPallet}]}
  BayGate System/BayGate:
    values:
      idIsRight: {type: Boolean}
      bayIsFree: {type: Boolean}
    behavior: gate.ir#Gate::HandlePallet
    calls: {releaseWrong: st/release}
"""
ACTIVITY = """\
Package gate "Gate" subkind="model"
  Activity handle "HandlePallet"
    Parameter handle.p "inMP"
    ActivityParameter in "inMP" direction="in"
      -> references handle.p
    ObjectFlow o1
      -> flow-source in
      -> flow-target read.tag
    ObjectFlow o2
      -> flow-source release.pallet
      -> flow-target pull.pallet
    Control start "start" subkind="initial"
    Action read "readId" subkind="call-operation"
      Pin read.tag "tag" direction="in" subkind="argument"
    Control right "right pallet?" subkind="decision"
    Control free "bay free?" subkind="decision"
    Action wrong "releaseWrong" subkind="call-operation"
      Pin wrong.pallet "pallet" direction="out" subkind="result"
    Action wait "OutMP" subkind="opaque"
    Control ready "bay is free" subkind="merge"
    Action release "release" subkind="call-operation"
      Pin release.pallet "pallet" direction="out" subkind="result"
    Action pull "getInPallet" subkind="call-operation"
      Pin pull.pallet "pallet" direction="in" subkind="argument"
    Control handled "handled" subkind="merge"
    Control end "end" subkind="final"
"""
FLOWS = [
    ("start", "read", ""),
    ("read", "right", ""),
    ("right", "wrong", "not idIsRight"),
    ("right", "free", "idIsRight"),
    ("free", "ready", "bayIsFree"),
    ("free", "wait", "else"),
    ("wait", "ready", ""),
    ("ready", "release", ""),
    ("release", "pull", ""),
    ("wrong", "handled", ""),
    ("pull", "handled", ""),
    ("handled", "end", ""),
]


def print_activity():
    lines = [
        f"    ControlFlow f{n}{f' guard={chr(34)}{guard}{chr(34)}' if guard else ''}\n"
        f"      -> flow-source {source}\n      -> flow-target {target}\n"
        for n, (source, target, guard) in enumerate(FLOWS)
    ]
    return ACTIVITY + "".join(lines)


@pytest.fixture(scope="module")
def compilations(corpus, tmp_path_factory):
    """Compile each of the four files as a user does, with the overlay beside it."""
    backends = tuple(select_backends(()))
    compilations = {}
    for name in BAYGATE_FILES:
        folder = tmp_path_factory.mktemp("baygate") / "plant"
        shutil.copytree(corpus / "aml" / "baygate", folder)
        (folder / "gate.ir").write_text(print_activity())
        stem = name.partition(".")[0]
        (folder / f"{stem}.overlay.yaml").write_text(ITEMS + CONNECTORS + BLOCKS)
        compilations[name] = compile_model(Request((folder / name,), backends=backends))
    return compilations


def is_added(element):
    return element.source.endswith(".overlay.yaml")


@pytest.mark.parametrize("name", BAYGATE_FILES)
def test_refined_baygate_has_the_totals_of_its_description(name, compilations):
    graph = compilations[name].graph
    blocks = [element for element in graph.of_kind(Kind.CLASS) if is_added(element)]
    assert {element.name: element.attrs["domain"] for element in blocks} == {
        "MiniPallet": "physical",
        "RFID_Tag": "information",
    }
    counts = Counter(element.kind for element in graph if element.source != "gate.ir")
    assert counts[Kind.ITEM_FLOW] == 5
    assert counts[Kind.CONNECTOR] == 5
    assert counts[Kind.PORT] == 10
    assert sum(element.role == "part" for element in graph.of_kind(Kind.PROPERTY)) == 3


@pytest.mark.parametrize("name", BAYGATE_FILES)
def test_each_item_flows_between_the_ports_of_the_thesis(name, compilations):
    graph = compilations[name].graph
    flows = {}
    for flow in graph.of_kind(Kind.ITEM_FLOW):
        (connector,) = graph.targets(flow, Edge.REALIZING)
        (item,) = graph.targets(flow, Edge.CONVEYS)
        sides = [
            [end.name for end in graph.targets(flow, edge)]
            for edge in (Edge.FLOW_SOURCE, Edge.FLOW_TARGET)
        ]
        flows[connector.name] = (item.name, *sides, connector.attrs["domain"])
    both = ["p_swCb", "p_bgCb"]
    assert flows == {
        "l_bgIn_sIn": ("MiniPallet", ["p_bgIn"], ["p_sIn"], "physical"),
        "l_stRf_rfIn": ("RFID_Tag", ["p_stRf"], ["p_rfIn"], "information"),
        "l_sOut_swIn": ("MiniPallet", ["p_sOut"], ["p_swIn"], "physical"),
        "l_swOut_bgOut": ("MiniPallet", ["p_swOut"], ["p_bgOut"], "physical"),
        "l_swCb_bgCb": ("MiniPallet", both, both, "physical"),
    }


@pytest.mark.parametrize("name", BAYGATE_FILES)
def test_flows_give_ports_their_direction(name, compilations):
    graph = compilations[name].graph
    directions = {port.name: port.attrs.get("direction") for port in graph.of_kind(Kind.PORT)}
    both = dict.fromkeys(["p_swCb", "p_bgCb"], "inout")
    inward = dict.fromkeys(["p_bgIn", "p_sIn", "p_swIn", "p_rfIn"], "in")
    outward = dict.fromkeys(["p_bgOut", "p_swOut", "p_sOut", "p_stRf"], "out")
    assert directions == inward | outward | both


@pytest.mark.parametrize("name", BAYGATE_FILES)
def test_all_calls_of_the_gate_are_resolved(name, compilations):
    graph = compilations[name].graph
    calls = {
        element.name: [graph.qualified_name(call) for call in graph.targets(element, Edge.CALLS)]
        for element in graph.of_kind(Kind.ACTION)
        if element.subkind == "call-operation"
    }
    assert calls == {
        "readId": ["BayGate Breakdown::RFID_Reader::readId"],
        "releaseWrong": ["BayGate Breakdown::Stopper::release"],
        "release": ["BayGate Breakdown::Stopper::release"],
        "getInPallet": ["BayGate Breakdown::Switch::getInPallet"],
    }
    assert sum("unresolved" in element.attrs for element in graph) == 0


@pytest.mark.parametrize("name", BAYGATE_FILES)
def test_the_refined_gate_has_no_diagnostics(name, compilations):
    assert [
        (diagnostic.rule.code, diagnostic.message) for diagnostic in compilations[name].diagnostics
    ] == []


@pytest.mark.parametrize("name", BAYGATE_FILES)
def test_the_contract_of_the_gate_is_derived_and_spot_reads_it(name, compilations):
    compilation = compilations[name]
    (contract,) = compilation.graph.derived(Contract)
    assert contract.component == "BayGate Breakdown::BayGate"
    artefacts = compilation.list_published()
    (text,) = (artefact.text for artefact in artefacts if artefact.path.endswith(".spin.ltl"))
    formula = "\n".join(line for line in text.splitlines() if not line.startswith("//"))
    parsed = spot.parse_infix_psl(formula, spot.default_environment.instance(), False, True)
    assert not parsed.errors
    atoms = {str(atom) for atom in spot.atomic_prop_collect(parsed.f)}
    for action in ("readId", "release", "releaseWrong", "getInPallet"):
        assert any(re.search(rf"run_{action}\b", atom) for atom in atoms), atoms


@pytest.mark.parametrize("name", BAYGATE_FILES[1:])
def test_the_overlay_adds_the_same_elements_to_each_file(name, compilations):
    """Ids are equal too, so that references to a flow survive an export in another version."""
    assert list_added(compilations[name].graph) == list_added(compilations[BAYGATE_FILES[0]].graph)


def list_added(graph):
    elements = [element for element in graph if is_added(element)]
    return sorted(
        (element.id, element.kind, element.name, element.owner, str(element.attrs))
        for element in elements
    )
