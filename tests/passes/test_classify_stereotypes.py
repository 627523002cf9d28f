"""Each stereotype of the SysML standard has a documented meaning, and that meaning comes out."""

import re
from pathlib import Path

import pytest
from lxml import etree
from pass_runs import list_codes, print_after_second_run, run_until

from sysmlc.ir.text import print_text
from sysmlc.passes.classify import tags, vocabulary

PAGE = Path(__file__).parents[2] / "docs/ir.md"
SYSML = "http://www.omg.org/spec/SysML/20181001/SysML"


def words(text: str) -> frozenset[str]:
    return frozenset(text.split())


STANDARD = words(
    """
    Conform ElementGroup Expose Problem Rationale Stakeholder View Viewpoint
    AdjunctProperty BindingConnector Block BoundReference ClassifierBehaviorProperty
    ConnectorProperty DirectedRelationshipPropertyPath DistributedProperty ElementPropertyPath
    EndPathMultiplicity NestedConnectorEnd ParticipantProperty PropertySpecificType ValueType
    AcceptChangeStructuralFeatureEventAction AddFlowPropertyValueOnNestedPortAction
    ChangeStructuralFeatureEvent DirectedFeature FlowProperty FullPort InterfaceBlock
    InvocationOnNestedPortAction ItemFlow ProxyPort TriggerOnNestedPort ~InterfaceBlock
    ConstraintBlock
    Continuous ControlOperator Discrete NoBuffer Optional Overwrite Probability Rate
    Allocate AllocateActivityPartition
    AbstractRequirement Copy DeriveReqt Refine Requirement Satisfy TestCase Trace Verify
    """
)
"""SysML 1.6 and 1.7, clauses 7 to 11 and 16."""
EARLIER = words(
    """
    Allocated ConjugatedInterfaceBlock ConstraintProperty Dimension FlowPort FlowSpecification
    QuantityKind RequirementRelated Unit
    """
)
"""What SysML 1.0 to 1.5 had besides, and Papyrus's name for ~InterfaceBlock."""


def documented() -> dict[str, str]:
    """Meaning of each stereotype by the table of docs/ir.md."""
    text = PAGE.read_text(encoding="utf-8").partition("## SysML stereotypes")[2]
    rows = re.findall(r"^\| (`.*?) \| (.*) \|$", text.partition("\n## ")[0], re.MULTILINE)
    return {name: meaning for names, meaning in rows for name in re.findall(r"`(.*?)`", names)}


def is_handled(name: str) -> bool:
    plain = vocabulary.mangle(name)
    above = [plain, *vocabulary.find_generals(plain)]
    return any(one in table for one in above for table in (*vocabulary.ROLES, tags.HANDLERS))


def test_the_table_names_every_stereotype_of_the_standard_and_no_other():
    assert documented().keys() == STANDARD | EARLIER


@pytest.mark.parametrize("name", sorted(STANDARD | EARLIER))
def test_every_stereotype_has_a_meaning_or_is_kept_on_purpose(name):
    kept = name in vocabulary.WITHOUT_MEANING
    assert kept or is_handled(name)
    assert ("Application only" in documented()[name]) <= kept


@pytest.mark.corpus
@pytest.mark.parametrize(
    "file", ["profile/papyrus-SysML-1.6.profile.uml", "omg/SysML-1.7-ptc-24-01-02.xmi"]
)
def test_the_published_profiles_have_no_stereotype_that_the_table_lacks(corpus, file):
    root = etree.parse(str(corpus / "xmi" / file)).getroot()
    types = [
        element.get("name")
        for element in root.iter("{*}packagedElement")
        if any(k.endswith("}type") and v == "uml:Stereotype" for k, v in element.attrib.items())
    ]
    assert len(types) > 50
    assert set(types) <= STANDARD | EARLIER


# -- what comes out ----------------------------------------------------------------------------


def applied(element: str, stereotype: str, given: str = "", indent: str = "  ") -> str:
    id = element.split()[1]
    application = f'Application {id}.s stereotype="{stereotype}" namespace="{SYSML}" {given}'
    return f"{element}\n{indent}{application}\n{indent}  -> subject {id}\n"


PLACES = """\
Class gate "Gate" role="block"
  Property motor "motor" aggregation="composite"
    -> typed-by drive
  Port door "door"
    Application door.a stereotype="ProxyPort" namespace="http://www.omg.org/spec/SysML/1/SysML"
      -> subject door
Class drive "Drive" role="block"
  Property speed "speed"
    -> typed-by real
DataType real "Real"
Activity run "Run"
"""
CASES = {
    "Block": ('Class x "X"', 'tag.isEncapsulated="true"', 'role="block" encapsulated=true'),
    "InterfaceBlock": ('Class x "X"', "", 'role="interface block"'),
    "FlowSpecification": ('Interface x "X"', "", 'role="interface block"'),
    "ConjugatedInterfaceBlock": ('Class x "X"', 'tag.original="gate"', "-> references gate"),
    "~InterfaceBlock": ('Class x "X"', 'tag.original="gate"', "-> references gate"),
    "ConstraintBlock": ('Class x "X"', "", 'role="constraint block"'),
    "ValueType": ('DataType x "X"', "", 'role="value type"'),
    "Unit": ('Instance x "X"', "", 'role="unit"'),
    "QuantityKind": ('Instance x "X"', "", 'role="quantity kind"'),
    "Dimension": ('DataType x "X"', "", 'role="quantity kind"'),
    "PropertySpecificType": ('Class x "X"', "", "property_specific=true"),
    "ConstraintProperty": ('Property x "X"', "", 'role="constraint property"'),
    "BoundReference": ('Property x "X"', 'tag.bindingPath=["motor","speed"]', "-> binds speed"),
    "EndPathMultiplicity": (
        'Property x "X"',
        'tag.lower="1" tag.upper="4"',
        'path_multiplicity="1..4"',
    ),
    "ElementPropertyPath": (
        'Dependency x "X"',
        'tag.propertyPath=["motor","speed"]',
        "-> path motor speed",
    ),
    "DirectedRelationshipPropertyPath": (
        'Dependency x "X"',
        'tag.sourcePropertyPath=["motor","speed"] tag.targetContext="drive"',
        'source_path=["motor", "speed"] target_context=["drive"]',
    ),
    "AdjunctProperty": ('Property x "X"', 'tag.principal="run"', "-> references run"),
    "ConnectorProperty": ('Property x "X"', 'tag.connector="run"', "-> references run"),
    "ParticipantProperty": ('Property x "X"', 'tag.end="motor"', "-> references motor"),
    "DistributedProperty": ('Property x "X"', "", 'distribution="DistributedProperty"'),
    "Normal": ('Property x "X"', 'tag.mean="5"', 'distribution="Normal(mean=5)"'),
    "FullPort": ('Port x "X"', "", 'role="full port"'),
    "ProxyPort": ('Port x "X"', "", 'role="proxy port"'),
    "FlowPort": ('Port x "X"', 'tag.isConjugated="true"', 'conjugated=true role="flow port"'),
    "FlowProperty": ('Property x "X"', "", 'direction="inout" role="flow property"'),
    "ItemFlow": ('ItemFlow x "X"', "", 'role="item flow"'),
    "DirectedFeature": (
        'Operation x "X"',
        'tag.featureDirection="required"',
        'feature_direction="required"',
    ),
    "InvocationOnNestedPortAction": (
        'Action x "X" subkind="send"',
        'tag.onNestedPort=["motor","door"]',
        "-> path motor door",
    ),
    "TriggerOnNestedPort": (
        'Trigger x "X"',
        'tag.onNestedPort=["motor","door"]',
        "-> path motor door",
    ),
    "AddFlowPropertyValueOnNestedPortAction": (
        'Action x "X" subkind="write"',
        'tag.onNestedPort="door"',
        "-> path door",
    ),
    "ChangeStructuralFeatureEvent": (
        'Trigger x "X" subkind="change"',
        'tag.structuralFeature="speed"',
        "-> references speed",
    ),
    "AllocateActivityPartition": ('Partition x "X"', "", 'role="allocate partition"'),
    "Allocated": ('Action x "X"', 'tag.AllocatedTo="gate"', "-> allocated-to gate"),
    "Rate": ('ObjectFlow x "X"', 'tag.rate="5 /s"', 'rate="5 /s"'),
    "Continuous": ('ObjectFlow x "X"', "", 'rate="continuous"'),
    "Discrete": ('ObjectFlow x "X"', "", 'rate="discrete"'),
    "Probability": ('ControlFlow x "X"', 'tag.probability="0.3"', 'probability="0.3"'),
    "NoBuffer": ('ObjectNode x "X"', "", "no_buffer=true"),
    "Overwrite": ('Pin x "X"', "", "overwrite=true"),
    "ControlOperator": ('Activity x "X"', "", 'role="control operator"'),
    "AbstractRequirement": ('Class x "X"', 'tag.id="R1"', 'req_id="R1" role="requirement"'),
    "Requirement": ('Class x "X"', 'tag.Text="Safe."', 'role="requirement" text="Safe."'),
    "TestCase": ('Activity x "X"', "", 'role="test case"'),
    "View": ('Package x "X"', 'tag.viewPoint="gate"', "-> realizes gate"),
    "Viewpoint": ('Class x "X"', "", 'role="viewpoint"'),
    "Stakeholder": ('Actor x "X"', "", 'role="stakeholder"'),
    "ElementGroup": (
        'Comment x "X"',
        'tag.criterion="safety" tag.member=["gate","drive"]',
        'criterion="safety" role="element group" -> references gate drive',
    ),
    "Problem": ('Comment x "X"', "", 'role="problem"'),
    "Rationale": ('Comment x "X"', "", 'role="rationale"'),
}
RELATIONS = {
    "Satisfy": ("satisfy", "satisfies"),
    "Verify": ("verify", "verifies"),
    "Refine": ("refine", "refines"),
    "Trace": ("trace", "traces"),
    "DeriveReqt": ("derive", "derives"),
    "Copy": ("copy", "traces"),
    "Allocate": ("allocate", "allocated-to"),
    "Conform": ("conform", "realizes"),
    "Expose": ("expose", "depends"),
}


def about(text: str, id: str) -> str:
    """What the printed graph says of one element: its line and its edges."""
    rows = text.splitlines()
    start = next(at for at, row in enumerate(rows) if re.match(rf" *\w+ {id} ", row + " "))
    found = [rows[start]]
    for row in rows[start + 1 :]:
        if not row.strip().startswith("->"):
            break
        found.append(row)
    return " ".join(" ".join(row.split()) for row in found)


@pytest.mark.parametrize("name", CASES)
def test_what_a_stereotype_says_comes_out(name):
    element, given, expected = CASES[name]
    graph, _ = run_until(PLACES + applied(element, name, given), "classify")
    shown = about(print_text(graph), "x")
    parts = re.findall(r'-> \S+(?: \w+)+|[\w]+=(?:"[^"]*"|\[[^]]*\]|\w+)', expected)
    assert parts
    assert [part for part in parts if part not in shown] == [], shown


@pytest.mark.parametrize("name", RELATIONS)
def test_a_relation_has_its_role_and_its_edge(name):
    role, edge = RELATIONS[name]
    ends = "  -> client run\n  -> supplier gate\n"
    model = applied(f'Dependency x "X"\n{ends}'.rstrip("\n"), name).replace("x\n", "x\n", 1)
    graph, _ = run_until(PLACES + model, "classify")
    text = print_text(graph)
    assert f'role="{role}"' in about(text, "x")
    assert f"-> {edge} gate" in about(text, "run")


def test_the_cases_cover_the_table():
    beside = {"BindingConnector", "NestedConnectorEnd", "Optional", *vocabulary.WITHOUT_MEANING}
    assert documented().keys() - CASES.keys() - RELATIONS.keys() - beside == set()


@pytest.mark.parametrize(("name", "found"), [("Blok", ["SM211"]), ("Block", []), ("Sensor", [])])
def test_a_name_that_sysml_does_not_have_is_told(name, found):
    assert list_codes(run_until(applied('Class x "X"', name), "classify")[1]) == found


def test_a_second_run_changes_nothing():
    rows = (
        applied(f"{c[0]} ".replace(" x ", f" x{i} "), n, c[1])
        for i, (n, c) in enumerate(CASES.items())
    )
    graph, _ = run_until(PLACES + "".join(rows), "classify")
    once = print_text(graph)
    assert print_after_second_run(graph, "classify") == once


def test_tags_that_lead_nowhere_or_to_the_element_itself_give_nothing():
    for given in ('tag.principal="gone"', 'tag.principal="x"', 'tag.principal=""'):
        model = PLACES + applied('Property x "X"', "AdjunctProperty", given)
        graph, sink = run_until(model, "classify")
        assert "references" not in about(print_text(graph), "x")
        assert list_codes(sink) == []


def test_a_tag_typed_by_a_stereotype_leads_to_what_has_it():
    view = applied('Class point "Point"', "Viewpoint") + applied(
        'Class x "X"', "View", 'tag.viewpoint="point.s"'
    )
    graph, _ = run_until(view, "classify")
    assert "-> realizes point" in about(print_text(graph), "x")
