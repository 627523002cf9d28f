"""Rules about blocks with parts: what parts assume of one another, promise together, and lose."""

from sysmlc.diagnostics import Severity, rule


def _cell(feeds: str, takes: str = "assume G F ready", whole: str = "G F taken") -> str:
    """A cell of a feeder and a picker in SysML v2, each with what is required of it."""
    return f"""\
package Line {{
    private import ScalarValues::*;
    part def Feeder {{ out attribute ready : Boolean; }}
    part def Picker {{ in attribute ready : Boolean; out attribute taken : Boolean; }}
    part def Cell {{
        out attribute taken : Boolean;
        part feeder : Feeder;
        part picker : Picker;
        bind feeder.ready = picker.ready;
        bind picker.taken = taken;
    }}
    requirement def Feeds {{
        subject feeder : Feeder;
        require constraint {{ language "ltl" /* {feeds} */ }}
    }}
    requirement def Takes {{
        subject picker : Picker;
        assume constraint {{ language "ltl" /* {takes.removeprefix("assume ")} */ }}
        require constraint {{ language "ltl" /* G F taken */ }}
    }}
    requirement def Works {{
        subject cell : Cell;
        require constraint {{ language "ltl" /* {whole} */ }}
    }}
}}
"""


def _two_senders(later: str) -> str:
    """A lamp that two switches switch, the second after some steps."""
    switch = """\
    part def {name} {{
        port tells : ~Told;
        exhibit state life {{
            entry; then waiting;
            state waiting;
            transition first waiting accept after {later} do send {what}() to tells then idle;
            state idle;
        }}
    }}
"""
    return (
        """\
package Room {
    attribute def on;
    attribute def off;
    port def Told { in ref on; in ref off; }
    part def Lamp {
        port told : Told;
        exhibit state life {
            entry; then dark;
            state dark;
            transition first dark accept on then bright;
            state bright;
            transition first bright accept off then dark;
        }
    }
"""
        + switch.format(name="One", what="on", later="2")
        + switch.format(name="Other", what="off", later=later)
        + """\
    part def Room {
        part lamp : Lamp;
        part one : One;
        part other : Other;
        connect lamp.told to one.tells;
        connect lamp.told to other.tells;
    }
}
"""
    )


OPEN = rule(
    "SM595",
    "part-assumption-open",
    Severity.ERROR,
    "part '{part}' of '{component}' assumes '{formula}', which nothing around it promises{said}",
    why="A part keeps its contract only in an environment that keeps the part's assumptions: the "
    "other parts, and what the block itself assumes.",
    help="let another part promise it, let the block assume it, or let the part do without it; the "
    "run shows what happens",
    wrong=_cell("G F !ready"),
    right=_cell("G F ready"),
)
CIRCLE = rule(
    "SM596",
    "parts-wait-for-one-another",
    Severity.WARNING,
    "part '{part}' of '{component}' assumes '{formula}', kept by others only after it{said}",
    why="What recurs cannot be promised by two parts that each wait for the other: nobody begins.",
    help="let one of the parts begin: promise it without that assumption",
    wrong=_cell("G F ready")
    .replace(
        'require constraint { language "ltl" /* G F ready */ }',
        'assume constraint { language "ltl" /* G F taken */ }\n'
        '        require constraint { language "ltl" /* G F ready */ }',
    )
    .replace("part def Feeder { ", "part def Feeder { in attribute taken : Boolean; ")
    .replace(
        "bind picker.taken = taken;",
        "bind picker.taken = taken;\n        bind picker.taken = feeder.taken;",
    ),
    right=_cell("G F ready"),
)
BREAK = rule(
    "SM597",
    "parts-break-whole",
    Severity.ERROR,
    "the parts of '{component}' together do not keep '{formula}'{said}",
    why="What a block promises has to follow from what its parts promise together.",
    help="let a part promise more, or the block less; the run shows what happens",
    wrong=_cell("G F ready", whole="G (taken -> X !taken)"),
    right=_cell("G F ready", whole="G F taken"),
)
CONTRADICT = rule(
    "SM548",
    "parts-contradict",
    Severity.ERROR,
    "there is no run in which all parts of '{component}' keep what they promise",
    why="Everything follows of what cannot be: nothing can be said of parts that contradict one "
    "another.",
    help="change one of the promises, or what joins the parts",
    wrong=_cell("G F ready")
    .replace("G F ready */ }", "G !ready */ }", 1)
    .replace("G F taken */ }", "G (ready & F taken) */ }", 1),
    right=_cell("G F ready"),
)
LOST = rule(
    "SM506",
    "sent-in-one-step",
    Severity.WARNING,
    "in '{component}' two things are sent in one step, and one of them is lost{said}",
    why="A component takes one event in a step (UML 2.5.1, 14.2.3.9.1): of what is sent to it "
    "together one occurs, and nothing says which.",
    help="let one wait until the other was taken; the run shows how it comes about",
    wrong=_two_senders("2"),
    right=_two_senders("3"),
)
NOT_COMPOSED = rule(
    "SM598",
    "parts-not-composed",
    Severity.WARNING,
    "the parts of '{component}' are not put together: {reason}",
    why="Only contracts in GR(1), or that history bits bring there, are composed, within the "
    "limits of time and memory.",
    help="give more time (--question-limit), or say it in the patterns that are known",
    wrong=_cell("F G ready"),
    right=_cell("G F ready"),
)
