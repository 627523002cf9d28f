"""The OpenMBEE toolkit loads our text without complaint, with the names of the model.

It finds a name that we refer to or says so; names, metaclasses and types are those that the
graph alone tells (expected.py).
"""

from random import Random

import pytest
from judging import judged, judged_together
from toolkit import load, parts, sysml
from writing import read, refined, written

from dialects.random_models import random_model
from examples.compiling import ROOT, compile_example
from long_runs import quick_first

EXAMPLES = sorted((ROOT / "examples").glob("*/*.uml"))
JUDGED = {
    "gate": 25,
    "baygate-behaviour": 125,
    "four-tasks": 82,
    "lego-recipe": 181,
    "hall": 17,
}
"""Elements of each example that the judge looks at (expected.py)."""
AML = (
    "amlbaselibs_215.aml",
    "amlsec_rolelib.aml",
    "eplan_arapc_example.aml",
    "festo_dmi_alias.aml",
    "i40_grouping_mirror.aml",
    "mapping_object_30.aml",
    "mtp_tud_minimal.aml",
    "opak_component_fragment.aml",
    "topology_2021.aml",
    "vera_plant.aml",
)
XMI = (
    "ea/EnterpriseArchitectExtensions.xmi",
    "magicdraw/Smart_street_light_2.mdzip",
    "magicdraw/Wired_Camera_Example.mdzip",
    "papyrus/AllDiagrams.uml",
    "papyrus/Arrowhead-5.0.uml",
    "papyrus/CraneModel.uml",
    "papyrus/RoboCab.uml",
    "papyrus/TutoFMU.uml",
    "papyrus/fUML-Tests.uml",
    "papyrus/tracker.uml",
)


def agrees(graph):
    complaints, differences, count = judged(graph)
    assert (complaints, differences) == ([], [])
    return count


@pytest.mark.parametrize("path", quick_first(EXAMPLES), ids=lambda path: path.stem)
def test_examples(path):
    assert agrees(compile_example(path, "ir").graph) == JUDGED[path.stem]


@pytest.mark.parametrize("seed", quick_first(range(0, 50, 10)))
def test_models_at_random(seed):
    graphs = [read(random_model(Random(seed + more), 2)) for more in range(10)]
    complaints, differences, count = judged_together(graphs)
    assert (complaints, differences) == ([], [])
    assert count > 200


@pytest.mark.corpus
@pytest.mark.parametrize("suffix", quick_first([".aml", ".amlx", "_caex215.aml", "_extlibs.aml"]))
def test_the_gate_of_the_thesis(corpus, suffix):
    path = corpus / "aml" / "baygate" / f"BayGate{suffix}"
    assert agrees(compile_example(path, "ir").graph) == 28


@pytest.mark.corpus
@pytest.mark.parametrize("name", quick_first(AML))
def test_real_plants(corpus, name):
    assert agrees(compile_example(corpus / "aml" / "dev" / name, "ir").graph) > 1


@pytest.mark.corpus
@pytest.mark.parametrize("name", quick_first(XMI))
def test_real_models(corpus, name):
    assert agrees(compile_example(corpus / "xmi" / name, "ir").graph) > 20


GATE = """
Package p "Plant"
  Class gate "Gate" role="block"
    Property gate.s "sensor" role="part" aggregation="composite"
      -> typed-by sensor
  Class sensor "Sensor" role="block"
"""


@pytest.mark.long
def test_the_judge_sees_what_is_missing_has_another_kind_or_another_type(monkeypatch):
    graph = refined(GATE)
    assert agrees(graph) == 4
    files, _ = written(graph)
    text = files["model.sysml"]
    for old, new, told in (
        ("part def Sensor;", "part def Sender;", "is missing"),
        ("part def Gate", "port def Gate", "is {'PortDefinition'}"),
        ("sensor : Sensor", "sensor : Gate", "has not the type Sensor"),
    ):
        changed = text.replace(old, new)
        assert changed != text
        monkeypatch.setattr("judging.written", lambda _, text=changed: ({"m.sysml": text}, []))
        complaints, differences, _ = judged(graph)
        assert any(told in one for one in differences), differences
        assert bool(complaints) == (new == "part def Sender;")


@pytest.mark.parametrize(
    "member",
    quick_first(
        [
            "part a : Missing;",
            "part def A :> Missing;",
            "part a { part :>> missing; }",
            "part a; connect a.missing to a;",
            "attribute a = missing + 1;",
            "part a { @Missing { } }",
            "part def A; dependency from A to Missing;",
            "state s { state a; transition first a then missing; }",
        ],
        2,
    ),
)
def test_the_toolkit_complains_about_names_that_it_does_not_find(member):
    assert load({"m.sysml": f"package P {{ {member} }}"}).complaints


def test_the_toolkit_refuses_what_is_no_sysml():
    with pytest.raises(sysml.SdkError):
        load({"m.sysml": "package P { part part; }"})


def test_qualified_names_are_taken_apart():
    assert parts("A::'b c'::'it\\'s'::d") == ("A", "b c", "it's", "d")
