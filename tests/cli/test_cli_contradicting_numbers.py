"""Numbers do not contradict one another, in one contract and in the parts of a block."""

import pytest

VALVE = """package Plant {
    private import ScalarValues::*;
    part def Valve {
        in attribute inner : Real;
        in attribute outer : Real;
        out attribute open : Boolean;
    }
    requirement def Opens {
        subject valve : Valve;
        require constraint { language "ltl" /* G (inner > 10 & outer < 5 -> X open) */ }
    }
    requirement def Closes {
        subject valve : Valve;
        require constraint { language "ltl" /* G (inner < outer -> X !open) */ }
    }
}
"""
ROOM = """package Home {
    private import ScalarValues::*;
    part def Display {
        in attribute temp : Real;
        in attribute goal : Real;
        out attribute cold : Boolean;
    }
    requirement def Shows {
        subject display : Display;
        require constraint { language "ltl" /* G (cold -> temp < 10 & goal > 20) */ }
    }
    part def Heater {
        in attribute temp : Real;
        in attribute goal : Real;
        out attribute on : Boolean;
    }
    requirement def Heats {
        subject heater : Heater;
        require constraint { language "ltl" /* G (temp < goal -> on) */ }
    }
    part def Room {
        in attribute temp : Real;
        in attribute goal : Real;
        out attribute cold : Boolean;
        out attribute on : Boolean;
        part display : Display;
        part heater : Heater;
        connect temp to display.temp;
        connect goal to display.goal;
        connect temp to heater.temp;
        connect goal to heater.goal;
        connect cold to display.cold;
        connect on to heater.on;
    }
    requirement def Warm {
        subject room : Room;
        require constraint { language "ltl" /* G (cold -> on) */ }
    }
}
"""


@pytest.fixture
def check(workspace, all_passes):
    """Return a function that returns the verdicts on a model."""

    def run(text):
        workspace.write("model.sysml", text)
        return workspace.sysmlc("contracts", "check", "model.sysml").stdout.splitlines()

    return run


def test_requirements_conflict_only_where_numbers_can(check):
    """More than 10 inside and less than 5 outside is never less inside."""
    assert check(VALVE) == ["Plant::Valve: realizable"]
    assert check(VALVE.replace("inner > 10", "inner > 4")) == ["Plant::Valve: unrealizable"]


def test_constants_keep_their_order(check):
    """A model with 'low < high' demands nothing of a number below low and above high."""
    oven = """package Kitchen {
        private import ScalarValues::*;
        part def Oven {
            constant attribute low : Real;
            constant attribute high : Real;
            in attribute temp : Real;
            out attribute on : Boolean;
            assert constraint { low < high }
        }
        requirement def Heats {
            subject oven : Oven;
            require constraint { language "ltl" /* G (temp < low -> X on) */ }
            require constraint { language "ltl" /* G (temp > high -> X !on) */ }
        }
    }"""
    assert check(oven) == ["Kitchen::Oven: realizable"]
    unordered = oven.replace("assert constraint { low < high }", "")
    assert check(unordered) == ["Kitchen::Oven: unrealizable"]


def test_parts_that_compare_different_sums_share_the_numbers(check):
    """One part compares both with numbers, the other one with each other."""
    assert check(ROOM)[-1] == "Home::Room: its 2 parts together satisfy its contract"
    other = ROOM.replace("goal > 20", "goal > 5")
    assert check(other)[-1] == "Home::Room: its 2 parts together violate its contract"
    unconnected = ROOM.replace("connect goal to heater.goal;", "")
    assert check(unconnected)[-1] == "Home::Room: its 2 parts together violate its contract"
