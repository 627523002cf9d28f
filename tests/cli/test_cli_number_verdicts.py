"""Verdicts about conditions that compare numbers; each model has properties with known answers."""

import json

import pytest

UNDECIDED = None
TANKS = """part def Tank { out attribute level : Real; }
part def Display {
    in attribute shown : Real;
    exhibit state D {
        entry; then Dark;
        state Dark;
        state Lit;
        transition first Dark if shown > 3.0 then Lit;
    }
}"""
HEATERS = """part def G {
    in attribute temp : Real;
    attribute low : Real = 18.0;
    exhibit state S {
        entry; then A;
        state A;
        state B;
        transition first A if temp < low then B;
    }
}
part def H :> G { attribute :>> low = 20.0; }"""
MODELS = {
    "a counter and an input": (
        "",
        """attribute level : Real := 0.0;
            in attribute limit : Real;
            exhibit state S { entry; then F;
            state F;
            state D;
            transition first F accept Tick if level < 10.0 do assign level := level + 2.5 then F;
            transition first F if level > limit then D;
            }""",
        {
            "G (level <= 10.0)": True,
            "G !(state=D)": UNDECIDED,
            "G (state=F & (level > limit) & event=none -> X state=D)": True,
            "G (state=F & (level > 3.0) & (limit < 2.0) & event=none -> X state=D)": True,
        },
    ),
    "a counter that guards keep in bounds": (
        "",
        """attribute level : Real := 0.0;
            exhibit state S { entry; then F;
            state F;
            transition first F accept Tick if level < 10.0 do assign level := level + 2.5 then F;
            transition first F accept Tock if level > 0.0 do assign level := level - 2.5 then F;
            }""",
        {
            "G (level <= 10.0)": True,
            "G (level >= 0.0)": True,
            "G (level <= 7.5)": False,
        },
    ),
    "a counter without bounds": (
        "",
        """attribute level : Real := 0.0;
            exhibit state S { entry; then F;
            state F;
            state A;
            transition first F accept Tick do assign level := level + 2.5 then F;
            transition first F accept Tock do assign level := level - 2.5 then F;
            transition first F if level > 5.0 then A;
            }""",
        {
            "G (level <= 10.0)": True,
            "G !(state=A)": False,
            "G (level >= 0.0)": False,
        },
    ),
    "a feature that is computed from an input": (
        "",
        """in attribute y : Real;
            attribute x : Real := 0.0;
            exhibit state S { entry; then F;
            state F;
            state A;
            transition first F accept Tick do assign x := y + 1.0 then F;
            transition first F accept Tock if x > 5.0 then A;
            }""",
        {
            "G !(state=A)": False,
            "G (state=F & (y > 4.0) & event=Tick -> X (x > 5.0))": True,
        },
    ),
    "an Integer without a range": (
        "",
        """in attribute level : Integer;
            exhibit state S { entry; then A;
            state A;
            state B;
            transition first A if level > 3 then B;
            transition first B if level < 0 then A;
            }""",
        {
            "G (state=B -> G state=B)": False,
            "G (state=A & level > 3 -> X state=B)": True,
            "G !(state=B)": False,
        },
    ),
    "an Integer that is counted": (
        "",
        """attribute n : Integer := 0;
            exhibit state S { entry; then A;
            state A;
            state B;
            transition first A accept Tick if n < 5 do assign n := n + 1 then A;
            transition first A if n >= 5 then B;
            }""",
        {
            "G (n <= 5)": True,
            "G (state=B -> n == 5)": True,
            "G F event=Tick -> F state=B": True,
            "G n <= 4": False,
        },
    ),
    "Integers that are compared with each other": (
        "",
        """in attribute level : Integer;
            in attribute limit : Integer;
            exhibit state S { entry; then A;
            state A;
            state B;
            transition first A if level > limit + 20 then B;
            }""",
        {
            "G !(state=B)": False,
            "G (state=A & level > limit + 20 -> X state=B)": True,
        },
    ),
    "quantities in several units": (
        "",
        """in attribute level : LengthValue;
            attribute max : LengthValue = 3 [m];
            in attribute temp : ThermodynamicTemperatureValue;
            exhibit state S { entry; then A;
            state A;
            state B;
            transition first A if level < 200 [cm] then B;
            transition first B if level >= 2 [m] and level <= max then A;
            transition first B if temp > 20 ['°C_abs'] and temp < 293.15 [K] then A;
            }""",
        {
            "G (state=A & (level < 2 [m]) -> X state=B)": True,
            "G (state=A & (level >= 200 [cm]) -> X state=A)": True,
            "G (state=B & (level > 3 [m]) -> X state=B)": True,
        },
    ),
    "a bound feature": (
        "",
        """attribute battery : Real = 100.0;
            exhibit state S { entry; then A;
            state A;
            state Low;
            transition first A if battery < 20 then Low;
            }""",
        {
            "G !(state=Low)": False,
            "G (state=A & (battery < 20) -> X state=Low)": True,
        },
    ),
    "features that a connector joins": (
        TANKS,
        """part t1 : Tank;
            part t2 : Tank;
            part d : Display;
            connect t1.level to d.shown;
            exhibit state S { entry; then A;
            state A;
            state B;
            transition first A if t1.level > 5.0 then B;
            transition first B if t2.level > 5.0 then A;}""",
        {
            "G (state=A & (t1.level > 5.0) -> X state=B)": True,
            "G (state=B & (t1.level > 5.0) -> X state=A)": False,
            "G (d.state=Dark & (t1.level < 3.0) -> X d.state=Dark)": True,
        },
    ),
    "an Integer and one with a range": (
        "",
        """in attribute level : Integer;
            in attribute limit : Integer;
            assert constraint { limit >= 0 and limit <= 3 } exhibit state S { entry; then A;
            state A;
            state B;
            transition first A if level > limit + 20 then B;
            }""",
        {
            "G !(state=B)": False,
            "G (state=A & level > limit + 20 -> X state=B)": True,
            "G (state=A & level > 23 -> X state=B)": True,
            "G (state=A & level > 22 -> X state=B)": False,
            "G (state=A & level > 22 & limit < 2 -> X state=B)": True,
        },
    ),
    "a real and an Integer with a range": (
        "",
        """in attribute level : Real;
            in attribute limit : Integer;
            assert constraint { limit >= 0 and limit <= 3 } exhibit state S { entry; then A;
            state A;
            state B;
            transition first A if level > limit + 0.5 then B;
            }""",
        {
            "G !(state=B)": False,
            "G (state=A & level > 3.5 -> X state=B)": True,
            "G (state=A & level > 2.7 -> X state=B)": False,
            "G (state=A & level > 2.7 & limit < 3 -> X state=B)": True,
        },
    ),
    "a redefined threshold": (
        HEATERS,
        """part a : G;
            part b : H;""",
        {
            "G (a.state=A & (a.temp < 17.0) -> X a.state=B)": True,
            "G (b.state=A & (b.temp < 17.0) -> X b.state=B)": True,
            "G (a.state=A & (a.temp < 19.0) -> X a.state=B)": False,
            "G (b.state=A & (b.temp < 19.0) -> X b.state=B)": True,
        },
    ),
    "an Integer and a fraction": (
        "",
        """in attribute n : Integer;
            assert constraint { 0 <= n and n <= 7 } exhibit state S { entry; then A;
            state A;
            state B;
            transition first A if n < 2.5 then B;
            transition first B if n == 2.5 then A;}""",
        {
            "G (state=A & n <= 2 -> X state=B)": True,
            "G (state=A & n < 3.5 -> X state=B)": False,
            "G (state=B -> G state=B)": True,
        },
    ),
    "an assignment that breaks a constraint": (
        "",
        """attribute x : Real := 3.0;
            assert constraint { x < 5 }
            exhibit state S { entry; then A;
            state A;
            state B;
            state D;
            transition first A do assign x := 7 then B;
            transition first B if x > 6 then D;
            }""",
        {"G !(state=D)": False, "G (x < 5)": False},
    ),
    "a value type with limits": (
        "attribute def Percent :> Real { assert constraint { self >= 0 and self <= 100 } }",
        """in attribute p : Percent;
            exhibit state S { entry; then A;
            state A;
            state B;
            transition first A if p > 100 then B;
            transition first A if p < 0 then B;
            }""",
        {"G state=A": True},
    ),
    "a sum of limited numbers": (
        "",
        """in attribute p : Natural;
            in attribute q : Real;
            assert constraint { 0 <= q and q <= 10 }
            exhibit state S { entry; then A;
            state A;
            state B;
            transition first A if p + q < 0 then B;
            transition first A if q - p > 10 then B;
            }""",
        {"G state=A": True},
    ),
}


@pytest.mark.parametrize("name", MODELS)
def test_properties_with_known_answers(workspace, all_passes, name):
    definitions, members, properties = MODELS[name]
    requirements = "".join(
        f"requirement def R{index} {{ subject it : P;"
        f' require constraint {{ language "ltl" /* {text} */ }} }}'
        for index, text in enumerate(properties)
    )
    workspace.write(
        "model.sysml",
        "package M { private import ScalarValues::*; private import SI::*; private import ISQ::*;"
        f"item def Tick; item def Tock; {definitions} part def P {{ {members} }} {requirements} }}",
    )
    result = workspace.sysmlc("contracts", "check", "--format", "json", "model.sysml")
    verdicts = {
        entry["formula"]: {"holds": True, "broken": False}.get(entry["verdict"])
        for entry in json.loads(result.stdout)["requirements"]
    }
    assert list(verdicts.values()) == list(properties.values())


def test_a_function_in_an_assigned_value_is_no_unknown_name(workspace, all_passes):
    workspace.write(
        "model.sysml",
        """package M { private import ScalarValues::*; private import NumericalFunctions::*;
            part def P { attribute x : Real := 0.0; exhibit state S { entry; then A; state A;
                transition first A if x < 5 do assign x := min(x + 1.0, 3.0) then A; } } }""",
    )
    result = workspace.sysmlc("check", "--min-severity", "info", "model.sysml")
    assert "SM412" not in result.output
    assert "calls such as 'min(x + 1.0, 3.0)' are not evaluated" in result.output
