"""Opaque elements and expressions with several bodies: all are kept, the legible one counts."""

import pytest
from reading_xmi import papyrus, read

BODIES = """<language>C++</language><language>OCL</language>
  <body>if (full()) halt();</body><body>self.full</body>"""
BOTH = {
    "bodies": ("if (full()) halt();", "self.full"),
    "languages": ("C++", "OCL"),
}


def element(model, id="x"):
    reading = read(papyrus(model))
    assert reading.findings == []
    return reading.graph[id].attrs


@pytest.mark.parametrize(
    ("model", "key"),
    [
        (
            f'<packagedElement xmi:type="uml:OpaqueBehavior" xmi:id="x">{BODIES}</packagedElement>',
            "",
        ),
        (
            '<packagedElement xmi:type="uml:Activity" xmi:id="a">'
            f'<node xmi:type="uml:OpaqueAction" xmi:id="x">{BODIES}</node></packagedElement>',
            "",
        ),
        (
            '<ownedRule xmi:id="x"><specification xmi:type="uml:OpaqueExpression">'
            f"{BODIES}</specification></ownedRule>",
            "",
        ),
        (
            '<packagedElement xmi:type="uml:Activity" xmi:id="a">'
            '<edge xmi:type="uml:ControlFlow" xmi:id="x"><guard xmi:type="uml:OpaqueExpression">'
            f"{BODIES}</guard></edge></packagedElement>",
            "guard_",
        ),
        (
            '<packagedElement xmi:type="uml:Class" xmi:id="c"><ownedAttribute xmi:id="x">'
            '<defaultValue xmi:type="uml:OpaqueExpression">'
            f"{BODIES}</defaultValue></ownedAttribute></packagedElement>",
            "default_",
        ),
        (
            '<packagedElement xmi:type="uml:Activity" xmi:id="a"><node xmi:type="uml:OpaqueAction">'
            '<inputValue xmi:type="uml:ValuePin" xmi:id="x"><value xmi:type="uml:OpaqueExpression">'
            f"{BODIES}</value></inputValue></node></packagedElement>",
            "value_",
        ),
    ],
    ids=["behaviour", "action", "constraint", "guard", "default", "value-pin"],
)
def test_all_bodies_are_stored_and_the_one_in_an_expression_language_counts(model, key):
    attrs = element(model)
    assert {name: attrs[f"{key}{name}"] for name in BOTH} == BOTH
    assert attrs[key.rstrip("_") or "body"] == "self.full"
    assert attrs[f"{key}language"] == "OCL"


def test_a_guard_that_is_a_constraint_of_the_transition():
    attrs = element(
        '<packagedElement xmi:type="uml:StateMachine" xmi:id="m1"><region xmi:id="r">'
        '<transition xmi:id="x" guard="g" source="a" target="a"><ownedRule xmi:id="g">'
        f'<specification xmi:type="uml:OpaqueExpression">{BODIES}</specification>'
        '</ownedRule></transition><subvertex xmi:type="uml:State" xmi:id="a"/>'
        "</region></packagedElement>"
    )
    assert (attrs["guard"], attrs["guard_language"]) == ("self.full", "OCL")
    assert attrs["guard_bodies"] == BOTH["bodies"]


def test_the_condition_of_an_event():
    attrs = element(
        '<packagedElement xmi:type="uml:StateMachine" xmi:id="m1"><region xmi:id="r">'
        '<transition xmi:id="t" source="a" target="a"><trigger xmi:id="x" event="e"/></transition>'
        '<subvertex xmi:type="uml:State" xmi:id="a"/></region></packagedElement>'
        '<packagedElement xmi:type="uml:ChangeEvent" xmi:id="e">'
        f'<changeExpression xmi:type="uml:OpaqueExpression">{BODIES}</changeExpression>'
        "</packagedElement>"
    )
    assert attrs["condition"] == "self.full"
    assert attrs["condition_languages"] == BOTH["languages"]


@pytest.mark.parametrize(
    ("text", "body", "language"),
    [
        ("<language>Java</language><language/><body>a()</body><body>b</body>", "b", ""),
        ("<language>Java</language><body>a()</body><body>b</body>", "b", ""),
        ("<language>Alf</language><language>C</language><body>a</body><body>b</body>", "a", "Alf"),
        ("<language>OCL</language><language>C</language><body/><body>b</body>", "b", "C"),
        (
            "<language>C</language><language>English</language><body>a</body><body>b</body>",
            "b",
            "English",
        ),
    ],
)
def test_which_body_counts(text, body, language):
    attrs = element(
        f'<packagedElement xmi:type="uml:OpaqueBehavior" xmi:id="x">{text}</packagedElement>'
    )
    assert (attrs["body"], attrs.get("language", "")) == (body, language)


def test_one_body_has_no_list():
    attrs = element(
        '<packagedElement xmi:type="uml:OpaqueBehavior" xmi:id="x">'
        "<language>Java</language><body>a()</body></packagedElement>"
    )
    assert attrs == {"subkind": "opaque", "body": "a()", "language": "Java"}
