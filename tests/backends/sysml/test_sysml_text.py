"""The SysML v2 text of small models."""

import os
import re
import subprocess
import sys

import pytest
from hypothesis import given
from hypothesis import strategies as st
from sysml_texts import lines_of, refine, text_of, write
from toolkit import load, split_name

from examples.compiling import PLANT, compile_example
from long_runs import quick_first
from sysmlc.backends.sysml.library import IMPORTED, IMPORTS, UNITS, find_unit_name
from sysmlc.backends.sysml.printing import RESERVED, quote_name
from sysmlc.ir import Element, Kind
from sysmlc.support import resources

STRUCTURE = """
Package p "Plant"
  Class gate "Gate" abstract=true role="block"
    -> specializes device
    Property gate.s "sensor" role="part" aggregation="composite" multiplicity="1..*" ordered=true
      -> typed-by sensor
    Property gate.l "line" role="reference"
      -> typed-by device
    Property gate.o "open" role="value" default=false
      -> typed-by bool
    Port gate.in "in" conjugated=true role="proxy port"
      -> typed-by pallets
    Operation gate.r "release"
      Parameter gate.r.p "pallet" direction="out"
        -> typed-by pallet
  Class device "Device" role="block"
  Class sensor "Sensor" role="block"
    Port sensor.out "seen" role="proxy port"
      -> typed-by pallets
  Class pallet "Mini pallet" role="block"
  Class pallets "Pallets" role="interface block"
    Property pallets.p "pallet" role="flow property" direction="out"
      -> typed-by pallet
DataType bool "Boolean" subkind="primitive" external=true href="x#Boolean"
"""


def test_blocks_are_part_definitions_and_interface_blocks_port_definitions():
    assert (
        text_of(STRUCTURE)
        == """\
package Plant {
    private import ScalarValues::*;

    abstract part def Gate :> Device {
        part sensor : Sensor[1..*] ordered;
        ref part line : Device;
        attribute open : Boolean default = false;
        port 'in' : ~Pallets;

        action release {
            out item pallet : 'Mini pallet';
        }
    }

    part def Device;

    part def Sensor {
        port seen : Pallets;
    }

    part def 'Mini pallet';

    port def Pallets {
        out item pallet : 'Mini pallet';
    }
}
"""
    )


CONNECTIONS = """
Package p "Plant"
  Class line "Line" role="block"
    Property line.a "a" role="part" aggregation="composite"
      -> typed-by belt
    Property line.b "b" role="part" aggregation="composite"
      -> typed-by belt
    Connector c "wire"
      -> end c.1 c.2
      ConnectorEnd c.1 ""
        -> role belt.out
        -> path line.a
      ConnectorEnd c.2 ""
        -> role belt.in
        -> path line.b
    Connector d "" role="binding connector"
      -> end d.1 d.2
      ConnectorEnd d.1 ""
        -> role belt.speed
        -> path line.a
      ConnectorEnd d.2 ""
        -> role belt.speed
        -> path line.b
  ItemFlow f "pallets"
    -> conveys pallet
    -> flow-source belt.out
    -> flow-target belt.in
    -> realizing c
  Class belt "Belt" role="block"
    Port belt.out "o" role="proxy port"
      -> typed-by pallets
    Port belt.in "i" role="proxy port" conjugated=true
      -> typed-by pallets
    Property belt.speed "speed" role="value"
  Class pallet "Pallet" role="block"
  Class pallets "Pallets" role="interface block"
    Property pallets.p "item" role="flow property" direction="out"
      -> typed-by pallet
"""


def test_connections_are_chains_of_features():
    lines = lines_of(CONNECTIONS)
    assert "interface wire connect a.o to b.i;" in lines
    assert "bind a.speed = b.speed;" in lines
    assert "flow pallets of Pallet from a.o.'item' to b.i.'item';" in lines


QUANTITIES = """
Package p "Plant"
  DataType length "Length" role="value type"
    -> references length.u
    Unit length.u "millimetre" symbol="mm" external=true library=true
  DataType width "Width" role="value type"
    -> specializes length
  DataType strange "Strangeness" role="value type"
    -> references strange.u
    Unit strange.u "quark" symbol="qk" external=true library=true
  Class belt "Belt" role="block"
    Property belt.l "length" role="value" default=1.5
      -> typed-by length
  Instance one "belt 1"
    -> instance-of belt
    Slot one.l "length" value=2.5
      -> instance-of belt.l
"""


def test_quantities_have_types_of_isq_and_units_of_si():
    lines = lines_of(QUANTITIES)
    assert "attribute def Length :> ISQ::LengthValue {" in lines
    assert "attribute :>> mRef = SI::mm;" in lines
    assert "attribute length : Length default = 1.5 [SI::mm];" in lines
    assert "part 'belt 1' : Belt {" in lines
    assert ":>> length = 2.5 [SI::mm];" in lines
    # The general states the unit.
    assert "attribute def Width :> Length;" in lines
    annotation = '@Unit { name = "quark"; symbol = "qk"; }'
    assert f"attribute def Strangeness {{ {annotation} }}" in lines


def test_every_unit_is_in_si_or_in_the_shipped_library():
    members = [
        f"attribute a{index} : ISQ::{value} = 1 [{'::'.join(map(quote_name, name.split('::')))}];"
        for index, (symbol, (value, _)) in enumerate(UNITS.items())
        if (name := find_unit_name(Element("u", Kind.UNIT, attrs={"symbol": symbol})))
    ]
    assert len(members) == len(UNITS) > 50
    assert load(load_with_library(f"package P {{ {' '.join(members)} }}")).complaints == []


def load_with_library(text):
    return {"m.sysml": text, "l.sysml": resources.read_text("metamodels", "SysMLC.sysml")}


def test_the_shipped_library_has_the_imported_names():
    text = resources.read_text("metamodels", "SysMLC.sysml")
    loaded = load({"l.sysml": text})
    assert loaded.complaints == []
    short_names = set(re.findall(r"(?:metadata|item) def <(\w+)>", text))
    long_names = {path[1] for path in loaded.elements if len(path) == 2 and path[0] == "SysMLC"}
    assert short_names | long_names == IMPORTED - IMPORTS["ScalarValues"] - OTHERS
    assert IMPORTS["SysMLC"] <= short_names | long_names


OTHERS = IMPORTS["RequirementDerivation"] | IMPORTS["ModelingMetadata"]

REQUIREMENTS = """
Package p "Plant"
  Class r1 "No jam" role="requirement" req_id="R1" text="It never jams."
  Class r2 "Slow" role="requirement" req_id="R1" text="First line.\\nSecond line."
  Class gate "Gate" role="block"
    Property gate.m "motor" role="part" aggregation="composite"
  Dependency d1 "" role="satisfy"
    -> client gate
    -> supplier r1
  Dependency d2 "because" role="derive"
    -> client r2
    -> supplier r1
  Dependency d3 "" role="trace"
    -> client gate
    -> supplier r2
  Dependency d4 "" role="refine"
    -> client gate
    -> supplier r2
  Dependency d5 "" role="verify"
    -> client test
    -> supplier r1
  Activity test "Jam" role="test case"
"""


def test_requirements_are_written_with_their_relations():
    text = text_of(REQUIREMENTS)
    for part in (
        "requirement <R1> 'No jam' {\n        doc /* It never jams. */\n",
        '@Requirement { id = "R1"; }',
        "doc\n        /*\n         * First line.\n         * Second line.\n         */\n",
        "part def Gate {\n        part motor;\n        satisfy 'No jam';\n",
        "#derivation connection because {\n        end #original ::> 'No jam';\n",
        "#trace dependency from Gate to Slow;",
        "#refinement dependency from Gate to Slow;",
        "objective {\n            verify 'No jam';\n",
    ):
        assert part in text, part


BEHAVIOUR = """
Package p "Plant"
  Activity a "Sort"
    Parameter a.in "pallet" direction="in"
    Control i "" subkind="initial"
    Action look "look" subkind="opaque"
    Control d "right?" subkind="decision"
    Action keep "keep" subkind="send"
      -> calls kept
    Action pass "pass" subkind="opaque" body="count := count + 1" language="KerML"
    Control e "" subkind="final"
    Property count "count" subkind="variable"
    ControlFlow f1 ""
      -> flow-source i
      -> flow-target look
    ControlFlow f2 ""
      -> flow-source look
      -> flow-target d
    ControlFlow f3 "" guard="else"
      -> flow-source d
      -> flow-target pass
    ControlFlow f4 "" guard="count = 3 && !(count > 4)"
      -> flow-source d
      -> flow-target keep
    ControlFlow f5 ""
      -> flow-source keep
      -> flow-target e
  Signal kept "Kept"
"""


def test_activities_are_actions_in_the_order_in_which_they_run():
    assert lines_of(BEHAVIOUR)[1:-2] == [
        "action def Sort {",
        "in pallet;",
        "ref count;",
        "first start then look;",
        "action look;",
        "then 'right?';",
        "decide 'right?';",
        "if count == 3 and not (count > 4) then keep;",
        "else pass;",
        "action keep send new Kept();",
        "then done;",
        "action pass assign count := count + 1;",
        "}",
    ]


STATES = """
Package p "Plant"
  Class gate "Gate" role="block"
    -> classifier-behavior gate.m
    Property gate.n "n" role="value"
    Operation gate.go "go"
    StateMachine gate.m "Life"
      Region r "main"
        Pseudostate i "" subkind="initial"
        State s "Shut"
          -> entry s.in
          Activity s.in "lock" subkind="opaque" body="n := 0"
        State b "Both"
          Region b.1 "left"
            State b.1.s "A"
          Region b.2 "right"
            State b.2.s "B"
        FinalState f ""
        Transition t1 ""
          -> flow-source i
          -> flow-target s
        Transition t2 "open" guard="the door is free"
          -> flow-source s
          -> flow-target b
          -> trigger t2.1 t2.2
          Trigger t2.1 "" subkind="call"
            -> typed-by gate.go
          Trigger t2.2 "" subkind="time" when="500 ms" relative=true
        Transition t3 ""
          -> flow-source b.1.s
          -> flow-target f
"""


IMPLEMENTED = """
Package p "Plant"
  Class c "Cell" role="block"
    -> classifier-behavior c.w
    Activity c.w "fill"
      -> specializes f
  Activity f "Fill"
"""


SIGNAL = """
Package p "Plant"
  Signal s "start"
  Class c "Cell" role="block"
    -> classifier-behavior c.m
    StateMachine c.m "life"
      Region r
        State a "idle"
        State b "busy"
        Transition t
          -> flow-source a
          -> flow-target b
          -> trigger t.s
          Trigger t.s subkind="signal"
            -> typed-by s
"""


def test_a_signal_with_an_inherited_name_is_named_with_its_package():
    assert "transition first idle accept Plant::start then busy;" in text_of(SIGNAL)


EFFECT = """
Class c "Cell" role="block"
  -> classifier-behavior c.m
  StateMachine c.m "life"
    Region r
      State a "idle"
      State b "busy"
      Transition t "go"
        -> flow-source a
        -> flow-target b
        -> effect e
        Activity e "log" body="log(1)" language="C" subkind="opaque"
        Comment k body="the log needs both"
          -> references t
"""


def test_a_transition_has_its_comment_behind_an_effect_with_a_body():
    text = text_of(EFFECT)
    assert 'language "C" /* log(1) */\n' in text
    assert "} then busy {" in text
    assert "/* the log needs both */" in text


NAMES = """
Signal g "Go"
  Property g.n "amount"
Class c "Line" role="block"
  -> classifier-behavior c.s
  Property c.n "count"
  Property c.p "places" multiplicity="1..count"
  Operation c.o "open"
  StateMachine c.s "run"
    Region c.r
      State c.a "idle"
        -> entry c.e
        Activity c.e subkind="opaque" body="open()"
      Transition c.t guard="amount > count"
        -> flow-source c.a
        -> flow-target c.a
        -> trigger c.g
        Trigger c.g subkind="signal"
          -> typed-by g
      Transition c.u
        -> flow-source c.a
        -> flow-target c.a
        -> trigger c.w
        Trigger c.w subkind="time" when="count" relative=true
"""


def test_names_in_texts_are_references_and_a_parameter_of_an_event_is_none():
    text = text_of(NAMES)
    assert "ref places[1..count];" in text
    assert "entry open;" in text
    assert "accept after count then idle;" in text
    assert "accept Go if 'amount > count' then idle;" in text


def test_an_operation_is_typed_by_the_activity_that_implements_it():
    assert "perform action fill : Fill;" in text_of(IMPLEMENTED)


def test_state_machines_are_exhibited_states():
    assert lines_of(STATES)[3:] == [
        "part def Gate {",
        "attribute n;",
        "action go;",
        "exhibit state Life {",
        '@Kept { attributes = ("region.name=main"); }',
        "first start then Shut;",
        "state Shut {",
        "entry action lock assign n := 0;",
        "}",
        "transition open first Shut accept go : Call if 'the door is free' then Both;",
        "transition",
        "first Shut",
        "accept after 500 [SysMLC::Units::ms]",
        "if 'the door is free'",
        "then Both;",
        "state Both parallel {",
        "state left {",
        "state A;",
        "}",
        "state right {",
        "state B;",
        "}",
        "}",
        "transition first Both.left.A then done;",
        "#inWords attribute 'the door is free' : Boolean;",
        "}",
        "}",
        "}",
    ]


STEREOTYPE = """
Package p "Plant"
  Class gate "Gate" role="block"
    Application a "Cell" stereotype="Cell" namespace="urn:cells" tag.speed=2 tag.tools=["x", "y"]
      -> subject gate
"""


def test_stereotypes_of_missing_profiles_get_metadata_definitions():
    assert (
        text_of(STEREOTYPE)
        == """\
package Plant {
    part def Gate { @Stereotypes::Cell { speed = 2; tools = ("x", "y"); } }
}

package Stereotypes {
    private import SysMLC::*;

    metadata def Cell {
        @External { href = "urn:cells"; }
        attribute speed : ScalarValues::Integer[0..1];
        attribute tools : ScalarValues::String[0..*];
    }
}
"""
    )


def test_metadata_preserves_the_ids_of_automationml():
    """A class that the front end adds for one InternalElement has no id."""
    lines = lines_of(
        """\
Document d "plant.aml" subkind="caex" @plant.aml:1
Package IH#Plant "Plant" subkind="instance-hierarchy" @plant.aml:2
  Instance i1 "cell" @plant.aml:3
    -> instance-of i1#class
  Class i1#class "cell" role="block" subkind="internal-element" @plant.aml:3
"""
    )
    assert [line for line in lines if "@AutomationML" in line] == [
        '@AutomationML { kind = "instance-hierarchy"; }',
        'part cell : Cell { @AutomationML { id = "i1"; } }',
        '@AutomationML { kind = "internal-element"; }',
    ]


def test_a_feature_that_another_inherited_one_hides_is_referred_to_with_its_owner():
    lines = lines_of("""
Package p "Plant"
  Class a "A" role="block"
    Property a.x "x" role="value"
  Class b "B" role="block"
    Property b.x "x" role="value"
  Class c "C" role="block"
    -> specializes a b
    Property c.y "y" role="value"
      -> subsets a.x
""")
    assert "attribute y :> A::x;" in lines


def test_private_features_with_references_from_outside_become_public():
    model = """
Package p "Plant"
  Class a "A" role="block"
    Property a.x "x" role="value" visibility="private"
    Property a.y "y" role="value" visibility="private"
  Class c "C" role="block"
    Property c.a "a" role="part" aggregation="composite"
      -> typed-by a
    Property c.z "z" role="value"
    Connector d "" role="binding connector"
      -> end d.1 d.2
      ConnectorEnd d.1 ""
        -> role a.x
        -> path c.a
      ConnectorEnd d.2 ""
        -> role c.z
"""
    lines = lines_of(model)
    assert 'attribute x { @Kept { attributes = ("visibility=private"); } }' in lines
    assert "private attribute y;" in lines
    assert "bind a.x = z;" in lines
    assert [loss[:5] for loss in write(refine(model))[1]] == ["SM734"]


@given(st.text(min_size=1))
def test_any_quoted_name_is_read_back(name):
    quoted = quote_name(name)
    assert split_name(quoted)[0] == "".join(map(replace_control_character, name))
    if not quoted.startswith("'"):
        assert quoted.isascii()
        assert quoted not in RESERVED


def replace_control_character(char):
    is_control = ord(char) in (*range(8), 11, *range(14, 32), *range(127, 160), 0x2028, 0x2029)
    is_no_character = 0xD800 <= ord(char) < 0xE000 or ord(char) in (0xFFFE, 0xFFFF)
    return "\ufffd" if is_control or is_no_character else char


@pytest.mark.parametrize(
    "name", quick_first(["it's", "part", "in", "a b", "1st", "\\", "a\nb", "Tür", "_x"], 2)
)
def test_the_toolkit_reads_quoted_names(name):
    loaded = load({"m.sysml": f"package {quote_name(name)} {{ part {quote_name(name)}; }}"})
    assert (name, name) in loaded.elements


def test_the_plant_of_the_thesis_has_its_golden_text(golden):
    """The gate in AutomationML, refined by its overlay and its behaviour."""
    compilation = compile_example(PLANT, "sysml")
    published = compilation.list_published()
    files = {file.path: file.text for file in published if file.backend == "sysml"}
    assert sorted(files) == ["sysml/SysMLC.sysml", "sysml/baygate.sysml"]
    golden.check("sysml", {"baygate.sysml": files["sysml/baygate.sysml"]})


@pytest.mark.parametrize("seed", ["0", "1"])
def test_the_text_does_not_depend_on_hash_seeds(seed):
    script = (
        "import sys; sys.path[:0] = sys.argv[1:]\n"
        "from random import Random\n"
        "from dialects.random_models import random_model\n"
        "from sysml_texts import read_xmi, write\n"
        "files, losses = write(read_xmi(random_model(Random(7), 2)))\n"
        "print(files['model.sysml'], losses)"
    )
    folders = [path for path in sys.path if path.endswith(("tests", "sysml"))]
    command = [sys.executable, "-c", script, *folders]
    environment = os.environ | {"PYTHONHASHSEED": seed}
    seeded = subprocess.run(command, env=environment, capture_output=True, check=True)
    unseeded = subprocess.run(command, capture_output=True, check=True)
    assert seeded.stdout == unseeded.stdout


CYCLIC_TYPES = """
Package p "Plant"
  Class a "A" role="block"
    Property x "x"
      -> typed-by y
    Property y "y" role="part"
      -> typed-by z
    Property z "z"
      -> typed-by y
  Association k "k"
    -> end k.e
    Property k.e "e"
      -> typed-by k
  Instance i "i"
    -> instance-of i
"""


def test_cycles_of_types_are_written():
    lines = lines_of(CYCLIC_TYPES)
    assert lines[2:5] == ["ref x :> y;", "part y :> z;", "ref z :> y;"]
    assert lines[-5:-1] == ["connection def k {", "end e : k;", "}", "part i :> i;"]


def test_a_chain_of_2000_types_is_written():
    rows = (f'    Property f{n} "f{n}"\n      -> typed-by f{n + 1}' for n in range(2000))
    last = '    Property f2000 "f2000" role="part"'
    lines = lines_of("\n".join(['Package p "P"', '  Class a "A" role="block"', *rows, last]))
    assert lines[-4:-2] == ["ref f1999 :> f2000;", "part f2000;"]


def test_associations_with_exponentially_many_paths_are_written():
    """Each association has two ends: to follow every path would double the time for each one."""
    rows = (
        f'  Association a{n} "a{n}"\n    -> end a{n}.x a{n}.y\n'
        f'    Property a{n}.x "x"\n      -> typed-by a{n + 1}\n'
        f'    Property a{n}.y "y"\n      -> typed-by a{n + 2}\n'
        for n in range(60)
    )
    ports = "".join(f'  Class a{n} "a{n}" role="interface block"\n' for n in (60, 61))
    lines = lines_of('Package p "P"\n' + "".join(rows) + ports)
    assert "interface def a59 {" in lines
    assert "connection def a0 {" in lines


def test_associations_typed_by_each_other_are_written():
    rows = [
        f'  Association {name} "{name}"\n'
        + "".join(
            f'    -> end {name}.{type_}\n    Property {name}.{type_} "{type_}"\n'
            f"      -> typed-by {type_}\n"
            for type_ in "kmn"
        )
        for name in "kmn"
    ]
    lines = lines_of('Package p "P"\n' + "".join(rows))
    assert [line for line in lines if line.startswith("connection def")] == [
        f"connection def {name} {{" for name in "kmn"
    ]


VALUES = """
Package p "Plant"
  Class a "A" role="block"
    Property a.x "x" role="value"
      -> typed-by {type}
  Class b "B" role="block"
    -> specializes a
    Property b.x "{name}" role="value" default={default}
      -> typed-by {type}
      -> redefines a.x
DataType int "Integer" subkind="primitive" external=true href="x#Integer"
DataType real "Real" subkind="primitive" external=true href="x#Real"
DataType string "String" subkind="primitive" external=true href="x#String"
"""


@pytest.mark.parametrize(
    ("type", "default", "literal"),
    [
        ("int", '"7"', "7"),
        ("real", '"2.5"', "2.5"),
        ("real", '"7."', '"7."'),
        ("real", '"7e"', '"7e"'),
        ("string", '"7"', '"7"'),
    ],
)
def test_a_text_is_a_number_only_as_the_value_of_a_number_type(type, default, literal):
    (line,) = [
        line
        for line in lines_of(VALUES.format(type=type, name="y", default=default))
        if "default" in line
    ]
    assert line.partition("default = ")[2].partition(" {")[0].rstrip(";") == literal


@pytest.mark.parametrize(
    ("name", "line"),
    [
        ("x", "attribute :>> x default = 2;"),
        ("y", "attribute y : Integer :>> x default = 2;"),
    ],
)
def test_a_redefinition_with_a_name_of_its_own_follows_the_type(name, line):
    assert line in lines_of(VALUES.format(type="int", name=name, default=2))
