"""The pass gives each stereotype of the SysML standard the meaning that docs/ir.md documents."""

import re
from pathlib import Path

import pytest
from lxml import etree
from pass_runs import list_codes, list_diagnostics, print_after_second_run, run_until

from sysmlc.ir.text import print_text
from sysmlc.passes.classify import tags, vocabulary

PAGE = Path(__file__).parents[2] / "docs/ir.md"
SYSML = "http://www.omg.org/spec/SysML/20181001/SysML"


def split_names(text: str) -> frozenset[str]:
    return frozenset(text.split())


STANDARD = split_names(
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
EARLIER = split_names(
    """
    Allocated ConjugatedInterfaceBlock ConstraintProperty Dimension FlowPort FlowSpecification
    QuantityKind RequirementRelated Unit
    """
)
"""Further stereotypes of SysML 1.0 to 1.5, and Papyrus's name for ~InterfaceBlock."""


def read_documented_meanings() -> dict[str, str]:
    """Return the meaning of each stereotype in the table of docs/ir.md."""
    text = PAGE.read_text(encoding="utf-8").partition("## SysML stereotypes")[2]
    rows = re.findall(r"^\| (`.*?) \| (.*) \|$", text.partition("\n## ")[0], re.MULTILINE)
    return {name: meaning for names, meaning in rows for name in re.findall(r"`(.*?)`", names)}


def is_handled(name: str) -> bool:
    """Whether the stereotype or a general of it has a role or a handler of tags."""
    mangled = vocabulary.mangle(name)
    lineage = {mangled, *vocabulary.find_generals(mangled)}
    return any(lineage & {*table} for table in (*vocabulary.ROLES, tags.HANDLERS))


def test_the_table_names_exactly_the_stereotypes_of_the_standard():
    assert read_documented_meanings().keys() == STANDARD | EARLIER


@pytest.mark.parametrize("name", sorted(STANDARD | EARLIER))
def test_every_stereotype_has_a_meaning_or_is_documented_as_application_only(name):
    is_application_only = name in vocabulary.WITHOUT_MEANING
    assert is_application_only or is_handled(name)
    assert ("Application only" in read_documented_meanings()[name]) <= is_application_only


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


# -- meanings in the graph ---------------------------------------------------------------------


def apply_stereotype(element: str, stereotype: str, tags: str = "", indent: str = "  ") -> str:
    id = element.split()[1]
    application = f'Application {id}.s stereotype="{stereotype}" namespace="{SYSML}" {tags}'
    return f"{element}\n{indent}{application}\n{indent}  -> subject {id}\n"


MODEL = """\
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


def find_element_text(text: str, id: str) -> str:
    """Return the line and the edges of an element in the printed graph, as one line."""
    lines = text.splitlines()
    start = next(n for n, line in enumerate(lines) if re.match(rf" *\w+ {id} ", line + " "))
    is_edge = [line.strip().startswith("->") for line in lines[start + 1 :]]
    end = start + 1 + (is_edge.index(False) if False in is_edge else len(is_edge))
    return " ".join(" ".join(lines[start:end]).split())


@pytest.mark.parametrize("name", CASES)
def test_each_stereotype_sets_the_documented_attributes_and_edges(name):
    element, tag_values, expected = CASES[name]
    graph, _ = run_until(MODEL + apply_stereotype(element, name, tag_values), "classify")
    text = find_element_text(print_text(graph), "x")
    parts = re.findall(r'-> \S+(?: \w+)+|[\w]+=(?:"[^"]*"|\[[^]]*\]|\w+)', expected)
    assert parts
    assert [part for part in parts if part not in text] == [], text


@pytest.mark.parametrize("name", RELATIONS)
def test_each_stereotype_of_a_dependency_sets_its_role_and_its_edge(name):
    role, edge = RELATIONS[name]
    ends = "  -> client run\n  -> supplier gate\n"
    model = apply_stereotype(f'Dependency x "X"\n{ends}'.rstrip("\n"), name).replace(
        "x\n", "x\n", 1
    )
    graph, _ = run_until(MODEL + model, "classify")
    text = print_text(graph)
    assert f'role="{role}"' in find_element_text(text, "x")
    assert f"-> {edge} gate" in find_element_text(text, "run")


def test_the_cases_cover_the_table():
    without_case = {"BindingConnector", "NestedConnectorEnd", "Optional"}
    without_case |= {*vocabulary.WITHOUT_MEANING}
    assert read_documented_meanings().keys() - CASES.keys() - RELATIONS.keys() <= without_case


@pytest.mark.parametrize(("name", "codes"), [("Blok", ["SM211"]), ("Block", []), ("Sensor", [])])
def test_a_misspelt_stereotype_of_sysml_is_reported(name, codes):
    assert list_codes(run_until(apply_stereotype('Class x "X"', name), "classify")[1]) == codes


def test_a_missing_profile_is_one_finding_however_many_stereotypes_are_applied():
    line = '  Application {0} stereotype="{1}" namespace="{2}"\n    -> subject x\n'
    applied = [("a", "Gate", "u:plant"), ("b", "Robot", "u:plant"), ("c", "Arm", "u:robots")]
    text = 'Class x "X"\n' + "".join(line.format(*names) for names in applied)
    assert list_diagnostics(run_until(text, "classify")[1]) == [
        "SM211 info: no profile of the compile unit defines the stereotypes Gate, Robot (u:plant) "
        "(applied: 2)",
        "SM211 info: no profile of the compile unit defines stereotype Arm (u:robots) (applied: 1)",
    ]


def test_the_pass_is_idempotent():
    elements = (
        apply_stereotype(f"{element} ".replace(" x ", f" x{number} "), name, tag_values)
        for number, (name, (element, tag_values, _)) in enumerate(CASES.items())
    )
    graph, _ = run_until(MODEL + "".join(elements), "classify")
    once = print_text(graph)
    assert print_after_second_run(graph, "classify") == once


def test_tags_that_name_no_element_or_the_element_itself_add_no_edge():
    for tag_value in ('tag.principal="gone"', 'tag.principal="x"', 'tag.principal=""'):
        model = MODEL + apply_stereotype('Property x "X"', "AdjunctProperty", tag_value)
        graph, sink = run_until(model, "classify")
        assert "references" not in find_element_text(print_text(graph), "x")
        assert list_codes(sink) == []


def test_a_tag_that_names_an_application_refers_to_the_element_of_the_application():
    view = apply_stereotype('Class point "Point"', "Viewpoint") + apply_stereotype(
        'Class x "X"', "View", 'tag.viewpoint="point.s"'
    )
    graph, _ = run_until(view, "classify")
    assert "-> realizes point" in find_element_text(print_text(graph), "x")
