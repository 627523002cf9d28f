"""What SysML v2 says in other words than the graph, and what it cannot say."""

import pytest
from judging import judged_together
from writing import refined, text_of, written

from sysmlc.backends.sysml import rules
from sysmlc.driver.registry import load_full_catalogue
from sysmlc.ir.text import IrSyntaxError

RULES = (
    rules.UNSAID_KIND,
    rules.UNSAID_EDGE,
    rules.UNSAID_ATTRIBUTE,
    rules.RENAMED,
    rules.APPROXIMATED,
    rules.TEXT_AS_NAME,
    rules.UNREACHABLE,
    rules.NAME_LEFT_OUT,
)


@pytest.mark.parametrize("rule", RULES, ids=lambda rule: rule.name)
def test_a_rule_reports_its_wrong_model_and_not_its_right_one(rule):
    assert rule.code in [one[:5] for one in written(refined(rule.read_page().wrong))[1]]
    assert written(refined(rule.read_page().right))[1] == []


def test_a_loss_is_counted_and_told_once():
    parameters = "".join(f'    TemplateParameter t{number} ""\n' for number in range(3))
    _, told = written(refined('Package p "Plant"\n  Class a "A"\n' + parameters))
    assert told == ["SM730 SysML v2 text cannot express TemplateParameter (3 omitted)"]


def test_a_verification_of_nothing_is_told():
    _, told = written(
        refined("""
Package p "Plant"
  Activity t "Try" role="test case"
  Dependency v "" role="verify"
    -> client t
""")
    )
    assert [line[:5] for line in told] == ["SM736"]


def test_what_cannot_be_written_is_not_referred_to():
    _, told = written(
        refined("""
Package p "Plant"
  Class a "A" role="block"
    Connector c "wire"
      -> end c.1 c.2
      ConnectorEnd c.1 ""
      ConnectorEnd c.2 ""
    Comment d "" body="see there"
      -> references c
""")
    )
    assert [one[:5] for one in told] == ["SM736", "SM736"]


@pytest.mark.long
def test_every_small_model_of_our_rules_can_be_loaded():
    graphs = [graph for graph in map(graph_of, texts()) if graph is not None]
    assert len(graphs) > 150
    complaints, _, _ = judged_together(graphs)
    assert complaints == []


def texts():
    return sorted(
        {
            text
            for rule in load_full_catalogue().values()
            for text in (rule.read_page().wrong, rule.read_page().right)
        }
    )


def graph_of(text):
    """The graph, or None for a model that is written in another form."""
    try:
        return refined(text)
    except (IrSyntaxError, ValueError, KeyError):
        return None


def test_an_empty_graph_is_an_empty_text():
    assert text_of("") == ""


def test_deep_models_are_written():
    deep = "".join(f'{"  " * depth}Package p{depth} "P{depth}"\n' for depth in range(300))
    text = text_of(deep)
    assert text.count("package") == 300
    assert text.startswith("package P0 {\n    package P1 {\n")


STORED = """
Package p "P"
  Class t "Thing"
  Activity a "A"
    DataStore s "store"
      -> typed-by t
    Control d "choose" subkind="merge"
    Action x "x" subkind="opaque"
      Pin x.in "in1" direction="in"
        -> typed-by t
    ObjectFlow f1
      -> flow-source s
      -> flow-target {first}
    ObjectFlow f2
      -> flow-source {first}
      -> flow-target x.in
"""


def test_a_flow_between_a_store_and_a_control_node_is_told_as_said_in_other_words():
    def told(text):
        return [one for one in written(refined(text))[1] if "a store and a control node" in one]

    assert [one[:5] for one in told(STORED.format(first="d"))] == ["SM734"]
    assert told(STORED.format(first="x.in").partition("    ObjectFlow f2")[0]) == []
