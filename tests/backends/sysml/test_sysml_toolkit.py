"""The OpenMBEE toolkit loads the text and finds names, metaclasses and types of the model.

The toolkit complains about references that it cannot resolve. ``expected_elements`` derives
from the graph alone what the toolkit has to find.
"""

from random import Random

import pytest
from sysml_texts import read_xmi, refine, write
from toolkit import load, split_name, sysml
from toolkit_comparison import compare, compare_together

from dialects.random_models import random_model
from examples.compiling import ROOT, compile_example
from long_runs import quick_first

EXAMPLES = sorted((ROOT / "examples").glob("*/*.uml"))
ELEMENT_COUNTS = {
    "gate": 25,
    "baygate-behaviour": 126,
    "four-tasks": 82,
    "lego-recipe": 181,
    "hall": 17,
}
"""Number of elements that are compared in each example."""
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


def count_compared(graph):
    """Return how many elements were compared, all without a difference."""
    complaints, differences, count = compare(graph)
    assert (complaints, differences) == ([], [])
    return count


@pytest.mark.parametrize("path", quick_first(EXAMPLES), ids=lambda path: path.stem)
def test_examples_have_the_expected_elements(path):
    assert count_compared(compile_example(path, "ir").graph) == ELEMENT_COUNTS[path.stem]


@pytest.mark.parametrize("seed", quick_first(range(0, 50, 10)))
def test_random_models_have_the_expected_elements(seed):
    graphs = [read_xmi(random_model(Random(seed + step), 2)) for step in range(10)]
    complaints, differences, count = compare_together(graphs)
    assert (complaints, differences) == ([], [])
    assert count > 200


@pytest.mark.corpus
@pytest.mark.parametrize("suffix", quick_first([".aml", ".amlx", "_caex215.aml", "_extlibs.aml"]))
def test_the_gate_of_the_thesis_has_the_expected_elements(corpus, suffix):
    path = corpus / "aml" / "baygate" / f"BayGate{suffix}"
    assert count_compared(compile_example(path, "ir").graph) == 28


@pytest.mark.corpus
@pytest.mark.parametrize("name", quick_first(AML))
def test_real_plants_have_the_expected_elements(corpus, name):
    assert count_compared(compile_example(corpus / "aml" / "dev" / name, "ir").graph) > 1


@pytest.mark.corpus
@pytest.mark.parametrize("name", quick_first(XMI))
def test_real_models_have_the_expected_elements(corpus, name):
    assert count_compared(compile_example(corpus / "xmi" / name, "ir").graph) > 20


GATE = """
Package p "Plant"
  Class gate "Gate" role="block"
    Property gate.s "sensor" role="part" aggregation="composite"
      -> typed-by sensor
  Class sensor "Sensor" role="block"
"""


@pytest.mark.long
def test_the_comparison_reports_missing_elements_and_other_kinds_and_types(monkeypatch):
    graph = refine(GATE)
    assert count_compared(graph) == 4
    files, _ = write(graph)
    text = files["model.sysml"]
    for old, new, problem in (
        ("part def Sensor;", "part def Sender;", "is missing"),
        ("part def Gate", "port def Gate", "is {'PortDefinition'}"),
        ("sensor : Sensor", "sensor : Gate", "has not the type Sensor"),
    ):
        changed = text.replace(old, new)
        assert changed != text
        monkeypatch.setattr(
            "toolkit_comparison.write", lambda _, text=changed: ({"m.sysml": text}, [])
        )
        complaints, differences, _ = compare(graph)
        assert any(problem in difference for difference in differences), differences
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
def test_the_toolkit_complains_about_unknown_names(member):
    assert load({"m.sysml": f"package P {{ {member} }}"}).complaints


def test_the_toolkit_rejects_syntax_errors():
    with pytest.raises(sysml.SdkError):
        load({"m.sysml": "package P { part part; }"})


def test_qualified_names_are_split_at_their_separators():
    assert split_name("A::'b c'::'it\\'s'::d") == ("A", "b c", "it's", "d")
