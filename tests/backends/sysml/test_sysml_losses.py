"""Losses: what SysML v2 text cannot express, or expresses in another form than the graph."""

import pytest
from sysml_texts import refine, text_of, write
from toolkit_comparison import compare_together

from rule_examples import parse_rule_examples, read_graphs
from sysmlc.backends.sysml import rules

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


def list_codes(text):
    """Return the codes of the losses of a model in text form."""
    return [loss[:5] for loss in write(refine(text))[1]]


@pytest.mark.parametrize("rule", RULES, ids=lambda rule: rule.name)
def test_the_wrong_example_breaks_the_rule_and_the_right_one_does_not(rule):
    assert rule.code in list_codes(read_graphs(rule).wrong)
    assert write(refine(read_graphs(rule).right))[1] == []


def test_equal_losses_are_one_diagnostic_with_their_number():
    parameters = "".join(f'    TemplateParameter t{number} ""\n' for number in range(3))
    _, losses = write(refine('Package p "Plant"\n  Class a "A"\n' + parameters))
    assert losses == ["SM730 SysML v2 text cannot express template parameter (3 omitted)"]


def test_a_verification_without_a_requirement_is_reported():
    codes = list_codes("""
Package p "Plant"
  Activity t "Try" role="test case"
  Dependency v "" role="verify"
    -> client t
""")
    assert codes == ["SM736"]


def test_references_to_dropped_elements_are_reported():
    codes = list_codes("""
Package p "Plant"
  Class a "A" role="block"
    Connector c "wire"
      -> end c.1 c.2
      ConnectorEnd c.1 ""
      ConnectorEnd c.2 ""
    Comment d "" body="see there"
      -> references c
""")
    assert codes == ["SM736", "SM736"]


@pytest.mark.long
def test_the_text_of_every_example_of_a_rule_can_be_loaded():
    complaints, _, _ = compare_together(parse_rule_examples(refine))
    assert complaints == []


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


def test_a_flow_between_a_store_and_a_control_node_is_no_loss():
    assert write(refine(STORED.format(first="d")))[1] == []


REFERRING_TAG = """
Package p "Plant"
  Class a "A" role="block"
    Application x "Mark" stereotype="Mark" namespace="urn:marks" tag.of="d"
      -> subject a
  Dependency d "{name}" subkind="dependency"
    -> client a
    -> supplier p
"""


def test_a_tag_that_refers_to_an_element_without_a_name_has_its_id():
    texts, losses = write(refine(REFERRING_TAG.format(name="")))
    assert "'of' = \"d\";" in texts["model.sysml"]
    assert losses == [
        "SM734 a tagged value that refers to an element without a name is written as its id "
        "(1 in the text)"
    ]
    texts, losses = write(refine(REFERRING_TAG.format(name="needs")))
    assert "'of' = \"Plant::needs\";" in texts["model.sysml"]
    assert losses == []


def test_a_flow_to_an_element_that_is_not_written_is_reported():
    _, losses = write(
        refine("""
Package p "P"
  Activity a "A"
    Action z "z" subkind="opaque"
    Partition q "lane"
    ControlFlow f
      -> flow-source z
      -> flow-target q
""")
    )
    assert [loss for loss in losses if loss.startswith("SM736")] == [
        "SM736 'flow-target' of control flow leads to an element without a name in the text "
        "(1 omitted)"
    ]
