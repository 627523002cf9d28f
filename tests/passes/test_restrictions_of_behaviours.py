"""Nothing that restricts a behaviour vanishes.

Each construct that restricts a behaviour is put into a small model, readable and unreadable. The
contract must differ from that of the model without the construct, or a finding must name it: a
contract is never stronger than its model without a word.
"""

import re
from collections import defaultdict
from functools import cache

import pytest

from sysmlc.driver import Request, compile_model, select_backends
from sysmlc.logic.contract import Contract
from sysmlc.logic.printing import print_formula

UML = """<?xml version="1.0" encoding="UTF-8"?>
<xmi:XMI xmi:version="20131001" xmlns:xmi="http://www.omg.org/spec/XMI/20131001"
 xmlns:uml="http://www.eclipse.org/uml2/5.0.0/UML">
<uml:Model xmi:id="model" name="Plant">
<packagedElement xmi:type="uml:Signal" xmi:id="go" name="Go"/>
<packagedElement xmi:type="uml:SignalEvent" xmi:id="go_event" signal="go"/>{event}
<packagedElement xmi:type="uml:Class" xmi:id="cell" name="Cell" classifierBehavior="behaviour">
<ownedAttribute xmi:id="ok" name="ok"><type xmi:type="uml:PrimitiveType"
 href="pathmap://UML_LIBRARIES/UMLPrimitiveTypes.library.uml#Boolean"/></ownedAttribute>
<ownedAttribute xmi:type="uml:Port" xmi:id="p" name="p"/>
<ownedAttribute xmi:type="uml:Port" xmi:id="q" name="q"/>
<ownedBehavior xmi:type="uml:OpaqueBehavior" xmi:id="choose" name="choose"/>
{behaviour}{beside}</packagedElement></uml:Model></xmi:XMI>"""

MACHINE = """<ownedBehavior xmi:type="uml:StateMachine" xmi:id="behaviour" name="Control">
{machine}<region xmi:type="uml:Region" xmi:id="region">
<subvertex xmi:type="uml:Pseudostate" xmi:id="initial"/>
<subvertex xmi:type="uml:State" xmi:id="a" name="A">{state}</subvertex>
<subvertex xmi:type="uml:State" xmi:id="b" name="B"/>
<transition xmi:type="uml:Transition" xmi:id="t0" source="initial" target="a"/>
<transition xmi:type="uml:Transition" xmi:id="t1" source="a" target="b"{attribute}>{transition}
</transition></region></ownedBehavior>"""

ACTIVITY = """<ownedBehavior xmi:type="uml:Activity" xmi:id="behaviour" name="Work">{activity}
<node xmi:type="uml:InitialNode" xmi:id="n0"/>
<node xmi:type="uml:OpaqueAction" xmi:id="n1" name="load">{action}</node>
<node xmi:type="uml:DecisionNode" xmi:id="n2" name="ready"/>
<node xmi:type="uml:OpaqueAction" xmi:id="n3" name="left"/>
<node xmi:type="uml:OpaqueAction" xmi:id="n4" name="right"/>
<node xmi:type="uml:ForkNode" xmi:id="n5"/><node xmi:type="uml:JoinNode" xmi:id="n6">{join}</node>
<node xmi:type="uml:ActivityFinalNode" xmi:id="n7"/><node xmi:type="uml:FlowFinalNode" xmi:id="n8"/>
<edge xmi:type="uml:ControlFlow" xmi:id="e0" source="n0" target="n5"/>
<edge xmi:type="uml:ControlFlow" xmi:id="e1" source="n5" target="n1"{plain_attribute}>{plain}</edge>
<edge xmi:type="uml:ControlFlow" xmi:id="e2" source="n5" target="n6"/>
<edge xmi:type="uml:ObjectFlow" xmi:id="e3" source="n1" target="n6"{object}/>
<edge xmi:type="uml:ControlFlow" xmi:id="e4" source="n6" target="n2"/>
<edge xmi:type="uml:ControlFlow" xmi:id="e5" source="n2" target="n3"{branch_attribute}>{branch}
</edge><edge xmi:type="uml:ControlFlow" xmi:id="e6" source="n2" target="n4"/>
<edge xmi:type="uml:ControlFlow" xmi:id="e7" source="n3" target="n7"/>
<edge xmi:type="uml:ControlFlow" xmi:id="e8" source="n4" target="n8"/></ownedBehavior>"""

GO = '<trigger xmi:type="uml:Trigger" xmi:id="trigger" event="go_event"/>'
TRIGGER = '<trigger xmi:type="uml:Trigger" xmi:id="trigger" event="event"/>'


def machine_model(**slots):
    slots = defaultdict(str, slots)
    return UML.format_map(defaultdict(str, slots, behaviour=MACHINE.format_map(slots)))


def activity_model(**slots):
    slots = defaultdict(str, slots)
    return UML.format_map(defaultdict(str, slots, behaviour=ACTIVITY.format_map(slots)))


def value(feature, metaclass, attributes="", content=""):
    head = f'<{feature} xmi:type="uml:{metaclass}" xmi:id="value" {attributes}'
    return f"{head}>{content}</{feature}>"


def values(feature):
    """Return a condition in every way that tools write one, by a name for it."""
    return {
        "expression": value(feature, "OpaqueExpression", "", "<body>ok</body>"),
        "words": value(feature, "OpaqueExpression", "", "<body>the cell is ready</body>"),
        "empty body": value(feature, "OpaqueExpression", "", "<body/>"),
        "blank body": value(feature, "OpaqueExpression", "", "<body>  </body>"),
        "no body": value(feature, "OpaqueExpression"),
        "false": value(feature, "LiteralBoolean"),
        "zero": value(feature, "LiteralInteger"),
        "number": value(feature, "LiteralInteger", 'value="3"'),
        "real": value(feature, "LiteralReal", 'value="1.5"'),
        "string": value(feature, "LiteralString", 'value="ok"'),
        "empty string": value(feature, "LiteralString"),
        "null": value(feature, "LiteralNull"),
        "unlimited": value(feature, "LiteralUnlimitedNatural", 'value="*"'),
        "missing instance": value(feature, "InstanceValue", 'instance="nothing"'),
        "empty tree": value(feature, "Expression"),
        "time": value(feature, "TimeExpression"),
        "interval": value(feature, "Interval"),
        "other file": f'<{feature} xmi:type="uml:OpaqueExpression" href="other.uml#_v"/>',
    }


def constraint(feature, metaclass="Constraint", attributes="", content=None):
    text = values("specification")["expression"] if content is None else content
    head = f'<{feature} xmi:type="uml:{metaclass}" xmi:id="rule" {attributes}'
    return f"{head}>{text}</{feature}>"


def event(metaclass, attributes="", content=""):
    return value("packagedElement", metaclass, attributes, content).replace('"value"', '"event"', 1)


ON_GO = machine_model(transition=GO)
SPONTANEOUS = machine_model()
WORK = activity_model()

GUARDS = {
    f"guard, {name}": machine_model(
        attribute=' guard="rule"',
        transition=GO + constraint("ownedRule", content=content),
    )
    for name, content in {**values("specification"), "no specification": ""}.items()
}
TRANSITIONS = {
    **GUARDS,
    "guard by its name": machine_model(
        attribute=' guard="rule"',
        transition=GO + constraint("ownedRule", attributes='name="load &lt; 3"', content=""),
    ),
    "guard in an attribute": machine_model(
        transition=GO + constraint("guard", attributes='specification="ok"', content="")
    ),
    "guard in another file": machine_model(transition=GO + '<guard href="other.uml#_g"/>'),
    "guard that is missing": machine_model(attribute=' guard="nothing"', transition=GO),
    "guard of the block": machine_model(
        attribute=' guard="rule"', transition=GO, beside=constraint("ownedRule", content="")
    ),
    "guard in the transition's name": machine_model(attribute=' name="Go [ok]"', transition=GO),
    "precondition of a protocol": machine_model(
        transition=GO + constraint("preCondition", content="")
    ),
    "postcondition of a protocol": machine_model(transition=GO + constraint("postCondition")),
    "constraint of the transition": machine_model(transition=GO + constraint("ownedRule")),
    "constraint about the transition": machine_model(
        transition=GO, beside=constraint("ownedRule", attributes='constrainedElement="t1"')
    ),
    "deferred trigger": machine_model(
        transition=GO,
        state=GO.replace("<trigger", "<deferrableTrigger").replace('"trigger"', '"d"'),
    ),
    "state invariant": machine_model(transition=GO, state=constraint("stateInvariant")),
    "state invariant, unreadable": machine_model(
        transition=GO, state=constraint("stateInvariant", content="")
    ),
    "entry without body": machine_model(
        transition=GO, state='<entry xmi:type="uml:OpaqueBehavior" xmi:id="x"/>'
    ),
    "precondition of the machine": machine_model(transition=GO, machine=constraint("precondition")),
    "postcondition of the machine": machine_model(
        transition=GO, machine=constraint("postcondition")
    ),
    "time constraint": machine_model(
        transition=GO,
        machine=constraint("ownedRule", "TimeConstraint", 'constrainedElement="t1"', content=""),
    ),
    "duration constraint": machine_model(
        transition=GO,
        machine=constraint("ownedRule", "DurationConstraint", 'constrainedElement="a"', content=""),
    ),
}
TRIGGERS = {
    "trigger without event": machine_model(transition=GO.replace('event="go_event"', "")),
    "trigger with a missing event": machine_model(transition=TRIGGER),
    "trigger at a port": machine_model(transition=GO.replace("/>", ' port="p"/>')),
    "signal event without signal": machine_model(event=event("SignalEvent"), transition=TRIGGER),
    "call event without operation": machine_model(event=event("CallEvent"), transition=TRIGGER),
    "any-receive event": machine_model(event=event("AnyReceiveEvent"), transition=TRIGGER),
    "time event without time": machine_model(event=event("TimeEvent"), transition=TRIGGER),
    "time event with an empty time": machine_model(
        event=event("TimeEvent", "", '<when xmi:type="uml:TimeExpression" xmi:id="w"/>'),
        transition=TRIGGER,
    ),
    "time event by its name": machine_model(
        event=event("TimeEvent", 'name="after 5 s"'), transition=TRIGGER
    ),
    "change event without condition": machine_model(event=event("ChangeEvent"), transition=TRIGGER),
    "change event by its name": machine_model(
        event=event("ChangeEvent", 'name="when ok"'), transition=TRIGGER
    ),
    "trigger in the transition's name": machine_model(attribute=' name="Go [ok]"'),
    "do behaviour without body": machine_model(
        state='<doActivity xmi:type="uml:OpaqueBehavior" xmi:id="x"/>'
    ),
    "do behaviour in another file": machine_model(state='<doActivity href="other.uml#_d"/>'),
}
FLOWS = {
    **{
        f"guard of a branch, {name}": activity_model(branch=text)
        for name, text in values("guard").items()
    },
    **{
        f"guard of a plain flow, {name}": activity_model(plain=text)
        for name, text in values("guard").items()
    },
    "guard of another element": activity_model(branch='<guard xmi:idref="ok"/>'),
    "guard that is a constraint": activity_model(branch=constraint("guard")),
    "guard in an attribute": activity_model(branch_attribute=' guard="ok"'),
    "guard in the name of a branch": activity_model(branch_attribute=' name="[ok]"'),
    "guard in the name of a flow": activity_model(plain_attribute=' name="[ok]"'),
    **{
        f"weight, {name}": activity_model(plain=value("weight", *written))
        for name, written in {
            "number": ("LiteralInteger", 'value="2"'),
            "unlimited": ("LiteralUnlimitedNatural", 'value="*"'),
            "expression": ("OpaqueExpression", "", "<body>n</body>"),
            "unreadable": ("OpaqueExpression",),
            "null": ("LiteralNull",),
        }.items()
    },
    "join specification": activity_model(join=value("joinSpec", "LiteralString", 'value="or"')),
    "join specification, unreadable": activity_model(join=value("joinSpec", "OpaqueExpression")),
    "selection": activity_model(object=' selection="choose"'),
    "transformation": activity_model(object=' transformation="choose"'),
    "interrupted region that is missing": activity_model(branch_attribute=' interrupts="nothing"'),
    "local precondition": activity_model(action=constraint("localPrecondition")),
    "local postcondition, unreadable": activity_model(
        action=constraint("localPostcondition", content="")
    ),
    "precondition": activity_model(activity=constraint("precondition")),
    "postcondition": activity_model(activity=constraint("postcondition")),
    "duration constraint": activity_model(
        activity=constraint("ownedRule", "DurationConstraint", 'constrainedElement="n1"')
    ),
}

TEXT = """package Plant {{
    private import ScalarValues::*; private import ISQ::*; private import SI::*;
    item def Go; port def In {{ in item go : Go; }}
    part def Cell {{
        attribute ok : Boolean; attribute level : Real; attribute count : Integer;
        port p : In; port q : In;
        {}
    }}
}}"""


def states(transition="", state=";", members=""):
    machine = f"""exhibit state control {{
        entry; then a; state a {state} state b; transition t first a {transition} then b; {members}
    }}"""
    return TEXT.format(machine)


def steps(body):
    return TEXT.format(f"perform action work {{ first start; {body} }}")


ACCEPT = states("accept Go")
PLAIN = steps("then action y; then done;")
LOADED = steps("then action load; first load then y; action y;")

IN_STATES = {
    "if": states("accept Go if ok"),
    "if, real": states("accept Go if level > 1.5"),
    "if, call": states("accept Go if missing(count)"),
    "if, null": states("accept Go if null"),
    "constraint of a state": states("accept Go", "{ assert constraint { ok } }"),
    "constraint that nothing asserts": states("accept Go", "{ constraint { ok } }"),
    "multiplicity of a state": states("accept Go", "[0..1];"),
    "constraint of the machine": states("accept Go", members="assert constraint { ok }"),
}
WAITING_STATES = {
    "if without trigger": states("if level > 1.5"),
    "accept": states("accept Go"),
    "accept via": states("accept Go via p"),
    "accept of any type": states("accept item"),
    "after": states("accept after 5 [s]"),
    "after, not constant": states("accept after level"),
    "at": states("accept at level"),
    "when": states("accept when ok"),
    "when, real": states("accept when level > 1.5"),
    "do": states(state="{ do action { action y; } }"),
}
IN_STEPS = {
    "if": steps("then if ok { action y; } then done;"),
    "if, real": steps("then if level > 1.5 { action y; } then done;"),
    "if and else": steps("then if level > 1.5 { action y; } else { action z; } then done;"),
    "while": steps("then while ok { action y; } then done;"),
    "while, real": steps("then while level > 1.5 { action y; } then done;"),
    "until": steps("then loop { action y; } until ok; then done;"),
    "until, real": steps("then loop { action y; } until level > 1.5; then done;"),
    "for": steps("then for i in 1..3 { action y; } then done;"),
    "accept": steps("then accept Go; then action y; then done;"),
    "accept via": steps("then accept Go via p; then action y; then done;"),
    "accept when": steps("then accept when ok; then action y; then done;"),
    "accept when, real": steps("then accept when level > 1.5; then action y; then done;"),
    "accept after": steps("then accept after 5 [s]; then action y; then done;"),
    "accept at": steps("then accept at level; then action y; then done;"),
    "multiplicity": steps("then action y[3]; then done;"),
    "constraint of an action": steps("then action y { assert constraint { ok } } then done;"),
    "constraint": steps("assert constraint { ok } then action y; then done;"),
}
SUCCESSIONS = {
    "guard": steps("then action load; first load if ok then y; action y;"),
    "guard, real": steps("then action load; first load if level > 1.5 then y; action y;"),
    "multiplicity": steps("then action load; succession [2] first load then y; action y;"),
}

CASES = [
    pytest.param(text, base, id=f"{group}: {name}")
    for group, base, texts in (
        ("UML transition", ON_GO, TRANSITIONS),
        ("UML trigger", SPONTANEOUS, TRIGGERS),
        ("UML activity", WORK, FLOWS),
        ("state", ACCEPT, IN_STATES),
        ("waiting state", states(), WAITING_STATES),
        ("step", PLAIN, IN_STEPS),
        ("succession", LOADED, SUCCESSIONS),
    )
    for name, text in texts.items()
]


@cache
def compile_in(folder, text):
    """Return the contracts as text, and the findings that have a location."""
    model = folder / ("m.uml" if text.startswith("<") else "m.sysml")
    model.write_text(text)
    compilation = compile_model(Request((model,), backends=()))
    contracts = [
        (
            contract.component,
            sorted((str(v.name), str(v.owner), str(v.domain)) for v in contract.variables),
            sorted(print_formula(c.formula) for c in (*contract.assumptions, *contract.guarantees)),
        )
        for contract in compilation.graph.derived(Contract)
    ]
    located = {(d.rule.code, d.message) for d in compilation.diagnostics if d.subject.place}
    return contracts, located


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("restrictions")


@pytest.mark.parametrize(("text", "base"), CASES)
def test_what_restricts_a_behaviour_does_not_vanish(folder, text, base):
    contracts, findings = compile_in(folder, text)
    contracts_without, findings_without = compile_in(folder, base)
    assert contracts_without
    assert contracts != contracts_without or findings - findings_without


@pytest.mark.parametrize("name", [name for name in GUARDS if name != "guard, expression"])
def test_a_guard_without_readable_text_is_an_input_or_no_move(folder, name):
    contracts, _ = compile_in(folder, GUARDS[name])
    moves = [
        formula for _, _, formulas in contracts for formula in formulas if "state'=B" in formula
    ]
    assert all(re.search(r"event=Go & \w+|false", formula) for formula in moves)


@pytest.mark.parametrize("name", [*GUARDS, "guard by its name"])
def test_a_guard_does_not_vanish_in_sysml_v2_text(tmp_path, name):
    model = tmp_path / "m.uml"
    model.write_text(TRANSITIONS[name])
    outputs = compile_model(Request((model,), backends=tuple(select_backends(["sysml"]))))
    (text,) = [file.text for file in outputs.artefacts if file.path == "sysml/m.sysml"]
    contracts, findings = compile_in(tmp_path, text)
    assert not [message for code, message in findings if code == "SM262"]
    moves = [
        formula for _, _, formulas in contracts for formula in formulas if "state'=B" in formula
    ]
    assert all(re.search(r"event=Go & \w+", formula) for formula in moves)


def test_a_literal_that_is_true_restricts_nothing(folder):
    literal = value("guard", "LiteralBoolean", 'value="true"')
    assert compile_in(folder, activity_model(branch=literal)) == compile_in(folder, WORK)


# -- every element of a behaviour matters ----------------------------------------------------------

EVERYTHING = machine_model(
    event=event("TimeEvent", 'name="after 5 s"'),
    attribute=' guard="rule"',
    transition=f"{TRIGGER}{constraint('ownedRule')}",
    state=(
        '<entry xmi:type="uml:OpaqueBehavior" xmi:id="enter"><body>ok := true</body></entry>'
        '<exit xmi:type="uml:OpaqueBehavior" xmi:id="leave" name="leave"/>'
        '<doActivity xmi:type="uml:OpaqueBehavior" xmi:id="stay" name="stay"/>'
        '<stateInvariant xmi:type="uml:Constraint" xmi:id="always"/>'
    ),
)
_ELEMENT = re.compile(r'<(\w+) [^<>]*?xmi:id="(\w+)"[^<>]*?(?:/>|>)')
_WITHOUT_EFFECT = {
    *("model", "cell", "behaviour"),
    # The behaviours do not use these.
    *("go", "go_event", "ok", "p", "q", "choose"),
    # Without this flow, the action that it leads to has none and starts by itself (15.2.3.3).
    "e1",
}


def remove_element(text, id):
    """Return a model without the element with this id and its content."""
    start = next(match for match in _ELEMENT.finditer(text) if match[2] == id)
    if start[0].endswith("/>"):
        return text[: start.start()] + text[start.end() :]
    end = text.index(f"</{start[1]}>", start.end()) + len(f"</{start[1]}>")
    return text[: start.start()] + text[end:]


@pytest.mark.parametrize(
    ("model", "id"),
    [
        pytest.param(model, match[2], id=f"{name} {match[2]}")
        for name, model in (("machine", EVERYTHING), ("activity", FLOWS["guard in an attribute"]))
        for match in _ELEMENT.finditer(model)
        if match[2] not in _WITHOUT_EFFECT
    ],
)
def test_each_element_of_a_behaviour_changes_the_contract_or_the_findings(folder, model, id):
    assert compile_in(folder, remove_element(model, id)) != compile_in(folder, model)
