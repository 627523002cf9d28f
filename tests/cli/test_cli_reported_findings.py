"""Which findings are reported: short text, severities, selected rules, accepted findings."""

import json

import pytest
from click.testing import CliRunner

from sysmlc.cli.group import sysmlc

MODEL = """\
package P {
    private import ScalarValues::*;
    part def Tank {
        attribute level : Integer;
        attribute limit : Integer;
        constraint { level <= 7 }
        exhibit state life {
            entry; then low;
            state low;
            transition first low if level > limit * limit then high;
            state high;
        }
    }
    part def Valve { port p; }
    package Old { import P::*; }
}
"""


@pytest.fixture
def check(tmp_path, monkeypatch):
    """Return a function that checks the model with options and returns exit code and lines."""
    monkeypatch.chdir(tmp_path)

    def run(*options, model=MODEL):
        (tmp_path / "tank.sysml").write_text(model)
        result = CliRunner().invoke(sysmlc, ["check", "--no-cache", "tank.sysml", *options])
        return result.exit_code, result.stderr.splitlines()

    return run


def list_heads(lines):
    return [line.partition(" ")[0] for line in lines if line.startswith(("info", "warning", "err"))]


def test_the_text_has_one_line_for_each_rule_with_infos(check):
    exit_code, lines = check()
    assert exit_code == 0
    assert lines == [
        "warning[SM197 v2-import-visibility]: the import has no visibility "
        "and is read as 'public import'",
        "  --> tank.sysml:15:19",
        "    |",
        " 15 |     package Old { import P::*; }",
        "    |                   ^",
        "  help: write 'private import' to use the names in this namespace only, "
        "or let 'sysmlc format --fix' write 'public import'",
        "",
        "info[SM300 undirected-ports]: ports of 'P::Valve' without a direction (1): 'p' "
        "(tank.sysml:14:14)",
        "info[SM410 assumed-range]: attribute 'level' has no range; 0..7 is assumed "
        "(tank.sysml:4:19 and 1 more)",
        "info[SM481 v2-approximated]: a constraint that nothing asserts is read as one that holds "
        "(1 in the unit) (tank.sysml:6:9)",
        "",
        "1 warning, 4 infos in 1 file; --min-severity info shows each info",
    ]


def test_min_severity_shows_each_info_or_hides_them(check):
    assert list_heads(check("--min-severity", "info")[1]).count("info[SM410") == 2
    _, lines = check("--min-severity", "warning")
    assert list_heads(lines) == ["warning[SM197"]
    assert lines[-1] == "1 warning in 1 file"
    assert check("--min-severity", "error") == (0, [])


def test_selected_and_ignored_rules_may_be_codes_starts_of_codes_and_names(check):
    assert list_heads(check("--select", "SM410,v2-approximated")[1]) == ["info[SM410", "info[SM481"]
    assert list_heads(check("--ignore", "SM4", "--ignore", "SM300")[1]) == ["warning[SM197"]
    exit_code, lines = check("--ignore", "no-such-rule")
    assert (exit_code, lines[0][:36]) == (2, "sysmlc: unknown rule 'no-such-rule';")


def test_strict_considers_reported_warnings_only(check):
    assert check("--strict")[0] == 1
    assert check("--strict", "--ignore", "SM197")[0] == 0


def test_errors_are_always_reported(check):
    exit_code, lines = check("--ignore", "SM2", "--select", "SM410", model="part a : Missing;")
    assert (exit_code, list_heads(lines)) == (1, ["error[SM205"])


def test_grouped_lines_stand_below_their_file(check):
    lines = check("--format", "grouped", "--select", "SM410")[1]
    head = "info[SM410 assumed-range]"
    assert lines == [
        "tank.sysml",
        f"  4:19: {head}: attribute 'level' has no range; 0..7 is assumed (P::Tank::level)",
        f"  5:19: {head}: attribute 'limit' has no range; 0..15 is assumed (P::Tank::limit)",
        "",
        "2 infos in 1 file",
    ]


def test_a_configuration_accepts_findings_of_files(check, tmp_path):
    (tmp_path / "sysmlc.toml").write_text(
        '[[suppress]]\nrule = "SM197"\nfile = "tank.*"\nreason = "an old model"\n'
        '[[suppress]]\nrule = "SM410"\nfile = "other/*"\nreason = "another model"\n'
    )
    heads = list_heads(check()[1])
    assert "warning[SM197" not in heads
    assert "info[SM410" in heads


@pytest.mark.parametrize("pattern", [".", "/", "[", "**"])
def test_a_strange_pattern_of_files_is_no_fault(check, tmp_path, pattern):
    entry = f'[[suppress]]\nrule = "SM197"\nfile = "{pattern}"\nreason = "none"\n'
    (tmp_path / "sysmlc.toml").write_text(entry)
    assert check()[0] == 0


# -- comments in the model -------------------------------------------------------------------------


def add_to_tank(comment):
    return MODEL.replace("part def Tank {", f"part def Tank {{\n        {comment}")


def test_a_comment_accepts_findings_about_its_owner(check):
    model = add_to_tank("comment /* sysmlc: ignore SM410: checked by the supplier */")
    assert "info[SM410" not in list_heads(check(model=model)[1])


def test_a_comment_accepts_findings_about_the_elements_that_it_annotates(check):
    model = add_to_tank("comment about level /* sysmlc: ignore assumed-range, SM410 */")
    lines = check("--min-severity", "info", "--select", "SM410,SM907", model=model)[1]
    assert list_heads(lines) == ["info[SM410"]
    assert "(P::Tank::limit)" in lines[1]


def test_a_comment_that_matches_no_finding_is_reported(check):
    model = add_to_tank("comment /* sysmlc: ignore SM421 */")
    lines = check("--select", "SM907", model=model)[1]
    assert lines[0] == (
        "warning[SM907 unused-ignore-comment]: the comment 'sysmlc: ignore SM421' matches "
        "no finding about 'P::Tank'"
    )


def test_a_comment_accepts_no_errors(check):
    model = add_to_tank("comment /* sysmlc: ignore SM433 */")
    model = model.replace("level : Integer", "level : Integer := 9")
    model = model.replace("{ level <= 7 }", "{ level >= 0 and level <= 7 }")
    assert list_heads(check("--select", "SM907", model=model)[1]) == [
        "warning[SM907",
        "error[SM433",
    ]


def test_json_lists_every_finding(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "tank.sysml").write_text(MODEL)
    result = CliRunner().invoke(sysmlc, ["check", "--no-cache", "tank.sysml", "--format", "json"])
    codes = [diagnostic["code"] for diagnostic in json.loads(result.stdout)["diagnostics"]]
    assert sorted(codes) == ["SM197", "SM300", "SM410", "SM410", "SM481"]


# -- findings about one fact -------------------------------------------------------------------

UNKNOWN = """\
package P {
    part a : Tankk;
    part b : Tankk;
    part c : Tankk;
    part d : Tankk;
    part e : Tankk;
    part f : Pumpp;
}
"""


def test_a_missing_name_is_one_finding_with_its_places(check):
    exit_code, lines = check(model=UNKNOWN)
    assert exit_code == 1
    assert [line for line in lines if line.startswith("error") or "note" in line] == [
        "error[SM205 unresolved-name]: unknown name 'Tankk' (5 places)",
        "  note: also b (tank.sysml:3:14)",
        "  note: also c (tank.sysml:4:14)",
        "  note: also d (tank.sysml:5:14)",
        "  note: also e (tank.sysml:6:14)",
        "error[SM205 unresolved-name]: unknown name 'Pumpp'",
    ]
    assert lines[-1] == "2 errors in 1 file"


def test_many_places_are_listed_with_verbose_and_in_json(check, tmp_path):
    model = UNKNOWN.replace("part f : Pumpp", "part f : Tankk")
    _, lines = check(model=model)
    assert [line for line in lines if "note" in line][-2:] == [
        "  note: also d (tank.sysml:5:14)",
        "  note: 2 more notes; --verbose shows them",
    ]
    _, lines = check("--verbose", model=model)
    assert sum("note: also" in line for line in lines) == 5
    result = CliRunner().invoke(
        sysmlc, ["check", "--no-cache", str(tmp_path / "tank.sysml"), "--format", "json"]
    )
    (finding,) = json.loads(result.stdout)["diagnostics"]
    assert finding["message"] == "unknown name 'Tankk' (6 places)"
    assert len(finding["notes"]) == 5


def test_equal_warnings_are_one_finding_and_equal_errors_are_not(check):
    imports = "package Q { import P::*; import P::*; }"
    assert list_heads(check(model=MODEL + imports)[1])[0] == "warning[SM197"
    assert "(3 places)" in check(model=MODEL + imports)[1][0]
    _, lines = check(model="package P { part a b; part c b; }")
    heads = [line for line in lines if line.startswith("error")]
    assert len(heads) == 2
    assert len(set(heads)) == 1


def test_a_range_that_is_missing_is_one_finding_of_all_rules_about_it(check):
    text = """\
package P {
    private import ScalarValues::*;
    part def Belt {
        attribute count : Integer;
        perform action step {
            first start;
            then action add { assign count := count + 1; }
            then decide; if count > 3 then done; else add;
        }
    }
}
"""
    _, lines = check("--min-severity", "info", model=text)
    assert list_heads(lines) == ["info[SM410"]
    assert (
        "  note: also: the contract of 'step' treats 'count' as an input although action 'add' "
        "assigns it: it has no range (tank.sysml:4:19)"
    ) in lines

    assert list_heads(check("--select", "SM544", model=text)[1]) == ["info[SM544"]
    assert list_heads(check("--ignore", "SM410", model=text)[1]) == ["info[SM544"]


def test_a_bound_of_an_assumed_range_is_no_fault_of_the_author(check):
    text = """\
package P {
    private import ScalarValues::*;
    part def Belt {
        attribute count : Integer := 0;
        item def Go;
        exhibit state run {
            entry; then on;
            state on;
            transition first on accept Go do assign count := count + 1 then on;
        }
    }
}
"""
    _, lines = check("--min-severity", "info", model=text)
    assert list_heads(lines) == ["info[SM410"]
    assert (
        "  note: transition 'on to on' can take it out of this range; "
        "the contract stops at the bound"
    ) in lines
    stated = text.replace(
        "Integer := 0;", "Integer := 0; assert constraint { 0 <= count and count <= 9 }"
    )
    assert "warning[SM428" in list_heads(check("--min-severity", "info", model=stated)[1])


def test_findings_are_accepted_one_by_one_before_they_are_merged(check, tmp_path):
    (tmp_path / "sysmlc.toml").write_text(
        '[[suppress]]\nrule = "SM205"\nelement = "a"\nreason = "in work"\n'
    )
    _, lines = check(model=UNKNOWN)
    assert lines[:2] == [
        "error[SM205 unresolved-name]: unknown name 'Tankk' (4 places)",
        "  --> tank.sysml:3:14 (b)",
    ]


REPEATED_ID = """\
Class a "NoJam" role="requirement" req_id="R1"
Class b "Quiet" role="requirement" req_id="R1"
Class c "Fast" role="requirement" req_id="R1"
Class d "Light" role="requirement" req_id="R2"
"""


def test_requirements_with_one_id_are_one_finding(tmp_path):
    path = tmp_path / "line.ir"
    path.write_text(REPEATED_ID)
    result = CliRunner().invoke(sysmlc, ["check", "--no-cache", str(path)])
    assert list_heads(result.stderr.splitlines()) == ["warning[SM213"]
    assert "requirement 'Fast' has the id R1, as 'NoJam' has (2 places)" in result.stderr


def test_print_after_runs_an_analysis_that_no_back_end_needs(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "tank.sysml").write_text("package Plant;")
    command = ["tank.sysml", "--no-cache", "--emit", "ir", "--print-after", "contracts"]
    assert CliRunner().invoke(sysmlc, command).stdout.startswith("// after contracts")
