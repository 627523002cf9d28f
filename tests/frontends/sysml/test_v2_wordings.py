"""Messages about SysML v2 text are in its words, not in those of profiles and SysML v1."""

import re
from string import Formatter

import pytest

from sysmlc.driver import Request, compile_model, load_full_catalogue
from sysmlc.frontends.sysml.rules import WORDINGS

RECIPE = """package Shop {{
    private import RecipeLevels::*;
    action def Make :> Recipe {{ action c : Cut; }}
    action def Cut :> Task {{ action s : Saw; }}
    action def Saw :> MachineService;
    part def Mill :> Machine;
    {}
}}
"""
FOREIGN_WORDS = (
    "«|stereotype|opaque|tagged value|initial node|pseudostate|orthogonal|lifeline|propert(?:y|ies)"
)


def list_findings(text, folder):
    """Return the codes of warnings and errors about a text, and their advice."""
    path = folder / "m.sysml"
    path.write_text(text, encoding="utf-8")
    diagnostics = compile_model(Request((path,), backends=())).diagnostics
    return [(d.rule.code, d.message, d.help) for d in diagnostics if d.severity != "info"]


def test_a_task_without_a_machine_gets_the_dependency_to_write(tmp_path):
    ((code, message, advice),) = list_findings(RECIPE.format(""), tmp_path)
    assert code == "SM607"
    assert message == (
        "task 'Shop::Make::c' cannot be performed: no machine is related to it or to its service "
        "'Shop::Saw'"
    )
    dependency = re.search(r"'(dependency .*)' for each service", advice)[1]
    written = dependency.replace("<service>", "Saw").replace("<machine>", "Mill")
    assert list_findings(RECIPE.format(written), tmp_path) == []


def test_a_machine_that_is_related_to_the_task_only_is_not_enough_for_its_services(tmp_path):
    relation = "dependency from Cut to Mill { @Capability { duration = 9 [SI::s]; } }"
    findings = list_findings(RECIPE.format(relation), tmp_path)
    messages = [message for code, message, _ in findings if code == "SM607"]
    assert [message.partition(": ")[2] for message in messages] == [
        "none of its machines offers the service 'Shop::Saw'"
    ]


def test_a_value_of_metadata_is_named_without_guillemets(tmp_path):
    relation = "dependency from Saw to Mill { @Capability { duration = 5 [SI::kg]; } }"
    messages = [message for _, message, _ in list_findings(RECIPE.format(relation), tmp_path)]
    assert any(message.startswith("'duration' of Capability on ") for message in messages)


@pytest.mark.parametrize("code", WORDINGS)
def test_a_wording_has_the_facts_of_its_rule_and_no_word_of_another_language(code):
    rule, wording = load_full_catalogue()[code], WORDINGS[code]
    facts, used = (
        {field for text in texts for _, field, *_ in Formatter().parse(text) if field}
        for texts in ((rule.phrase, rule.help), wording)
    )
    assert used <= facts
    text = (wording.phrase or rule.phrase) + wording.help
    assert re.findall(FOREIGN_WORDS, re.sub(r"\{\w+\}", "", text)) == []
