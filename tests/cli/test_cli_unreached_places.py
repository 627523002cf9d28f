"""``contracts check`` reports the parts of behaviours that no run reaches."""

import re

import pytest

from sysmlc.synthesis import rules

pytestmark = pytest.mark.usefixtures("all_passes")


@pytest.fixture
def find_unreached(workspace):
    """Return a function that checks a model and returns the findings with their lines."""

    def check(text, file="plant.sysml"):
        workspace.write(file, text)
        result = workspace.sysmlc("contracts", "check", "--min-severity", "info", file)
        findings = re.findall(r"(SM5\d\d) [\w-]+\]: (.*)\n +--> \S+?:(\d+)", result.stderr)
        return [f"{line}: {code} {message}" for code, message, line in findings]

    return check


# -- branches of pseudostates ----------------------------------------------------------------------

TANK = """package Plant {
    private import ScalarValues::*;
    item def Fill; item def Drain;
    part def Tank {
        attribute level : Integer := 0;
        assert constraint { level >= 0 and level <= 3 }
        exhibit state Control {
            entry; then Idle;
            state Idle; state Low; state Full;
            #SysMLC::KIND state check;
            transition first Idle accept Fill do assign level := level + 2 then check;
            transition first check if level < 2 then Low;
            transition first check if level >= 2 then Full;
            transition first Low accept Drain do assign level := RESET then Idle;
            transition first Full accept Drain do assign level := RESET then Idle;
        }
    }
    requirement def Starts {
        subject tank : Tank; require constraint { language "ltl" /* state=Idle */ }
    }
}
"""
NEVER_LOW = [
    "9: SM559 no run of 'Plant::Tank' reaches 'Low'",
    "12: SM517 no run of 'Plant::Tank' takes transition 'check to Low [level < 2]', although runs "
    "reach its source",
]
NEVER_FULL = [
    "9: SM559 no run of 'Plant::Tank' reaches 'Full'",
    "13: SM517 no run of 'Plant::Tank' takes transition 'check to Full [level >= 2]', although "
    "runs reach its source",
]


@pytest.mark.parametrize(
    ("kind", "reset", "findings"),
    [
        # The guards behind a choice read what the effect has assigned, those behind a junction
        # what was before the transition (UML 2.5.1, 14.2.3.7).
        ("Choice", "level - 1", NEVER_LOW),
        ("Choice", "0", NEVER_LOW),
        ("Junction", "level - 1", []),
        ("Junction", "0", NEVER_FULL),
    ],
)
def test_branches_of_choices_and_junctions_that_are_never_taken(
    kind, reset, findings, find_unreached
):
    assert find_unreached(TANK.replace("KIND", kind).replace("RESET", reset)) == findings


DRILL = """package Plant {
    private import ScalarValues::*;
    part def Drill {
        attribute sharp : Boolean := true;
        action bore {
            first start then turn; action turn assign sharp := RESULT; then action lift; then done;
        }
        exhibit state Control {
            entry; then Boring;
            state Boring { do bore; }
            state Grinding;
            #SysMLC::Choice state check;
            transition first Boring then check;
            transition first check if sharp then Boring;
            transition first check if not sharp then Grinding;
            transition first Grinding do assign sharp := true then Boring;
        }
    }
    requirement def Starts {
        subject drill : Drill; require constraint { language "ltl" /* state=Boring */ }
    }
}
"""


@pytest.mark.parametrize(
    ("result", "findings"),
    [
        (
            "true",
            [
                "11: SM559 no run of 'Plant::Drill' reaches 'Grinding'",
                "15: SM517 no run of 'Plant::Drill' takes transition 'check to Grinding [not "
                "sharp]', although runs reach its source",
                "4: SM519 'sharp' of 'Plant::Drill' is assigned, but no run changes its value",
            ],
        ),
        (
            "false",
            [
                "14: SM517 no run of 'Plant::Drill' takes transition 'check to Boring [sharp]', "
                "although runs reach its source"
            ],
        ),
    ],
)
def test_branches_behind_the_completion_of_a_state(result, findings, find_unreached):
    assert find_unreached(DRILL.replace("RESULT", result)) == findings


PUMP = """\
<xmi:XMI xmlns:xmi="http://www.omg.org/spec/XMI/20131001" xmi:version="20131001"
  xmlns:uml="http://www.eclipse.org/uml2/5.0.0/UML"
  xmlns:Blocks="http://www.eclipse.org/papyrus/sysml/1.6/SysML/Blocks"
  xmlns:Requirements="http://www.eclipse.org/papyrus/sysml/1.6/SysML/Requirements">
<uml:Model xmi:id="m" name="Plant">
<packagedElement xmi:type="uml:PrimitiveType" xmi:id="bool" name="Boolean"/>
<packagedElement xmi:type="uml:Signal" xmi:id="go" name="Go"/>
<packagedElement xmi:type="uml:SignalEvent" xmi:id="eg" signal="go"/>
<packagedElement xmi:type="uml:Class" xmi:id="pump" name="Pump" classifierBehavior="sm">
 <ownedAttribute xmi:type="uml:Property" xmi:id="hot" name="hot" type="bool">
  <defaultValue xmi:type="uml:LiteralBoolean" xmi:id="hot.d"/>
 </ownedAttribute>
 <ownedBehavior xmi:type="uml:StateMachine" xmi:id="sm" name="Control">
  <region xmi:id="r" name="state">
   <subvertex xmi:type="uml:Pseudostate" xmi:id="i"/>
   <subvertex xmi:type="uml:Pseudostate" xmi:id="c" name="check" kind="choice"/>
   <subvertex xmi:type="uml:State" xmi:id="cold" name="Cold"/>
   <subvertex xmi:type="uml:State" xmi:id="warm" name="Warm"/>
   <transition xmi:id="t0" source="i" target="c"/>
   <transition xmi:id="t1" source="c" target="cold" guard="t1.g">
    <ownedRule xmi:type="uml:Constraint" xmi:id="t1.g">
     <specification xmi:type="uml:OpaqueExpression" xmi:id="t1.s">
      <body>not hot</body></specification>
    </ownedRule>
   </transition>
   <transition xmi:id="t2" source="c" target="warm" guard="t2.g">
    <ownedRule xmi:type="uml:Constraint" xmi:id="t2.g">
     <specification xmi:type="uml:OpaqueExpression" xmi:id="t2.s">
      <body>hot</body></specification>
    </ownedRule>
   </transition>
   <transition xmi:id="t3" source="cold" target="SECOND">
    <trigger xmi:id="t3.t" event="eg"/>
    <effect xmi:type="uml:OpaqueBehavior" xmi:id="t3.e" name=""><body>hot := true</body></effect>
   </transition>
  </region>
 </ownedBehavior>
</packagedElement>
<packagedElement xmi:type="uml:Class" xmi:id="req" name="Starts">
 <ownedRule xmi:type="uml:Constraint" xmi:id="rule" name="cold" constrainedElement="req">
  <specification xmi:type="uml:OpaqueExpression" xmi:id="sp">
   <language>LTL</language>
   <body>state=Cold</body></specification>
 </ownedRule>
</packagedElement>
<packagedElement xmi:type="uml:Abstraction" xmi:id="sat" client="pump" supplier="req"/>
</uml:Model>
<Blocks:Block xmi:id="b1" base_Class="pump"/>
<Requirements:Requirement xmi:id="b2" base_NamedElement="req" base_Class="req" id="R1" text="x"/>
<Requirements:Satisfy xmi:id="b3" base_DirectedRelationship="sat" base_Abstraction="sat"/>
</xmi:XMI>
"""


@pytest.mark.parametrize(
    ("second", "findings"),
    [
        # The first step takes a branch: 'hot' is false.
        (
            "cold",
            [
                "18: SM559 no run of 'Plant::Pump' reaches 'Warm'",
                "26: SM517 no run of 'Plant::Pump' takes transition 'check to Warm [hot]', "
                "although runs reach its source",
            ],
        ),
        ("c", []),
    ],
)
def test_a_branch_counts_as_taken_at_the_start(second, findings, find_unreached):
    assert find_unreached(PUMP.replace("SECOND", second), "plant.uml") == findings


# -- events ----------------------------------------------------------------------------------------

TIME_EVENT = """<packagedElement xmi:type="uml:TimeEvent" xmi:id="{id}" isRelative="true">
 <when xmi:type="uml:TimeExpression" xmi:id="{id}.w">
  <expr xmi:type="uml:LiteralInteger" xmi:id="{id}.e" value="{count}"/>
 </when>
</packagedElement>
"""
COLD_AGAIN = """<transition xmi:id="t4" source="cold" target="cold">
 <trigger xmi:id="t4.t" event="reset"/>
</transition>
"""


@pytest.mark.parametrize(
    ("steps_until_reset", "findings"),
    [
        (
            2,
            [
                "34: SM516 no run of 'Plant::Pump' accepts time event 'after 4 steps' of "
                "transition 'Cold to check', although runs wait for it"
            ],
        ),
        # Either may be taken, as both occur in the same step.
        (4, []),
    ],
)
def test_one_of_several_triggers_that_no_run_accepts(steps_until_reset, findings, find_unreached):
    late = TIME_EVENT.format(id="late", count=4)
    reset = TIME_EVENT.format(id="reset", count=steps_until_reset)
    text = PUMP.replace("SECOND", "c").replace("</uml:Model>", f"{late}{reset}</uml:Model>")
    trigger = '<trigger xmi:id="t3.t" event="eg"/>\n'
    text = text.replace(trigger, f'{trigger}<trigger xmi:id="t3.u" event="late"/>\n')
    text = text.replace("  </region>", f"{COLD_AGAIN}  </region>")
    assert find_unreached(text, "plant.uml") == findings


def test_an_action_that_waits_for_a_signal_that_is_never_sent(find_unreached):
    text = rules.NEVER_ACCEPTED.read_page().wrong
    assert find_unreached(text)[1:] == [
        "11: SM517 no run of 'P::Cell' takes transition 'Watch to Watch [enabled]' of 'sensor', "
        "although runs reach its source",
        "18: SM516 no run of 'P::Cell' accepts the event of action 'gripper.work.wait', although "
        "runs wait for it",
    ]


# -- submachines -----------------------------------------------------------------------------------

LINE = """package Plant {
    item def Go; item def Stop;
    state def Work {
        entry; then Slow;
        state Slow; state Fast;
        transition first Slow accept Go then Fast;
    }
    part def Line {
        exhibit state Control {
            entry; then First;
            state First : Work; state Second : Work;
            transition first First accept Stop then Second;
            transition first Second accept Stop then First;
        }
    }
    requirement def Starts {
        subject line : Line; require constraint { language "ltl" /* G state!=Second */ }
    }
}
"""


def test_a_submachine_is_reached_if_one_of_the_states_that_use_it_is(find_unreached):
    blocked = LINE.replace("accept Stop then Second", "accept Stop if false then Second")
    # The author requires that 'Second' is never reached; 'First' performs 'Work', too.
    assert find_unreached(blocked) == []
    nowhere = blocked.replace("Go then", "Go if false then")
    assert find_unreached(nowhere) == [
        "5: SM559 no run of 'Plant::Line' reaches 'Fast'",
        "6: SM517 no run of 'Plant::Line' takes transition 'Slow to Fast [false]', although runs "
        "reach its source",
    ]


# -- numbers ---------------------------------------------------------------------------------------

COUNTER = """package Plant {
    private import ScalarValues::*;
    private import SI::*;
    private import ISQ::*;
    part def Counter {
        attribute x : LengthValue := 5 [m];
        exhibit state Control {
            entry; then Run;
            state Run;
            state Far;
            transition first Run if x <= 6 [m] do assign x := VALUE then Run;
            transition first Run if x > 6 [m] then Far;
        }
    }
    requirement def Rule {
        subject counter : Counter; require constraint { language "ltl" /* FORMULA */ }
    }
}
"""


def find_unreached_by_counter(find_unreached, value, formula="F state=Far"):
    return find_unreached(COUNTER.replace("VALUE", value).replace("FORMULA", formula))


def test_a_number_that_changes_inside_its_region_changes(find_unreached):
    never_far = [
        "10: SM559 no run of 'Plant::Counter' reaches 'Far'",
        "12: SM517 no run of 'Plant::Counter' takes transition 'Run to Far [x > 6 [m]]', although "
        "runs reach its source",
    ]
    assert find_unreached_by_counter(find_unreached, "-x", "G x >= -6 [m]") == never_far


def test_an_assigned_quantity_is_no_input(find_unreached):
    # A requirement about the steps is no truism, although the steps never miss a point.
    assert find_unreached_by_counter(find_unreached, "x + 20 [cm]", "G x >= 5 [m]") == []
    assert find_unreached_by_counter(find_unreached, "x + 20 [cm]") == []
