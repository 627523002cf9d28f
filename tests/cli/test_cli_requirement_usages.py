"""A requirement usage has id, text, subject and verdict of its definition (SysML v2)."""

import json

MODEL = """\
package Hall {
    private import ScalarValues::*;
    attribute def Go;
    part def Lamp {
        attribute on : Boolean := false;
        state def Run {
            entry; then off;
            state off { entry assign on := false; }
            accept Go then lit;
            state lit { entry assign on := true; }
        }
        exhibit state run : Run;
    }
    requirement def <'R1'> Dark {
        doc /* the lamp is never on */
        subject lamp : Lamp;
        require constraint { not lamp.on }
    }
    requirement def <'R2'> Cheap { doc /* a lamp costs 5 EUR */ subject lamp : Lamp; }
    requirement dark : Dark;
    requirement cheap : Cheap;
    requirement <'R3'> cheaper :> cheap { doc /* a lamp costs 4 EUR */ }
    part lamp1 : Lamp;
    satisfy dark by lamp1;
    satisfy cheap by lamp1;
    verification def Test { objective { verify dark; } }
}
"""


def list_open_requirements(text):
    """Return the rules about open requirements and what they name."""
    return [
        (line[5:10], line.rpartition(" ")[2])
        for line in text.splitlines()
        if line.startswith(("info[SM715", "info[SM716"))
    ]


def test_the_table_shows_id_text_and_verdicts_of_the_definition(workspace, all_passes):
    workspace.write("hall.sysml", MODEL)
    result = workspace.sysmlc("hall.sysml", "--emit", "reqtable", "--min-severity", "info")
    assert workspace.read("out/requirements/Hall.requirements.md").splitlines()[4:] == [
        "| id | name | text | owner | satisfied by | verified by |",
        "|---|---|---|---|---|---|",
        "| R1 | Dark | the lamp is never on | Hall |  |  |",
        "| R1 | dark | the lamp is never on | Hall | Hall::lamp1 | Hall::Test |",
        "| R2 | Cheap | a lamp costs 5 EUR | Hall |  |  |",
        "| R2 | cheap | a lamp costs 5 EUR | Hall | Hall::lamp1 |  |",
        "| R3 | cheaper | a lamp costs 4 EUR | Hall |  |  |",
    ]
    # 'dark' is verified, so that its definition is; each of the others is open itself.
    assert list_open_requirements(result.stderr) == [
        ("SM716", "'Hall::Cheap'"),
        ("SM716", "'Hall::cheap'"),
        ("SM716", "'Hall::cheaper'"),
    ]


def test_a_usage_is_verified_if_its_definition_is(workspace, all_passes):
    workspace.write("hall.sysml", MODEL.replace("verify dark", "verify requirement : Cheap"))
    result = workspace.sysmlc("hall.sysml", "--emit", "reqtable", "--min-severity", "info")
    # The text of 'cheaper' asks for more than its definition.
    assert list_open_requirements(result.stderr) == [
        ("SM716", "'Hall::Dark'"),
        ("SM716", "'Hall::dark'"),
        ("SM716", "'Hall::cheaper'"),
    ]


def test_the_diagram_leads_from_the_usage_to_its_definition(workspace, all_passes):
    workspace.write("hall.sysml", MODEL)
    workspace.sysmlc("hall.sysml", "--emit", "plantuml")
    diagram = workspace.read("out/diagrams/Hall.req.puml")
    assert diagram.count("{field} id = R1") == diagram.count("text = the lamp is never on") == 2
    assert "dark_1 <|-- dark_2\n" in diagram


def test_the_verdict_names_the_usage_and_the_text_of_its_definition(workspace, all_passes):
    workspace.write("hall.sysml", MODEL)
    result = workspace.sysmlc("contracts", "check", "hall.sysml", "--format", "json")
    requirements = [
        (entry["requirement"], entry["component"], entry["formula"], entry["verdict"])
        for entry in json.loads(result.stdout)["requirements"]
    ]
    assert requirements == [
        ("Hall::dark", "Hall::Lamp", "G (!on)", "broken"),
        ("Hall::cheap", "Hall::Lamp", "a lamp costs 5 EUR", "not-decided"),
        ("Hall::cheaper", "Hall::Lamp", "a lamp costs 4 EUR", "not-decided"),
    ]
