"""Every JSON document of the corpus follows its schema; all documents contain every member."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from json_documents import (
    EXAMPLES,
    SCHEMAS,
    Document,
    command_documents,
    compile_documents,
    declared_properties,
    find_violations,
    written_properties,
)
from rich_recipe import rich_recipe
from rule_examples import read_graphs
from sysmlc.driver import load_full_catalogue
from sysmlc.ir import parse_text

pytestmark = [pytest.mark.corpus, pytest.mark.long]

LARGEST = 2_500_000
"""Size in bytes of the largest XMI and AutomationML files that are compiled."""
ICE_LEVELS = """\
[recipe.levels]
task = "RecipePrimitives::Task"
machine-service = "RecipePrimitives::MachineService"
machine-function = "RecipePrimitives::MachineFunction"
"""
"""The ICE laboratory has recipes, but not the names of the profile."""
NUMBERS = """package Home {
    private import ScalarValues::*;
    private import SI::*;
    part def Heater {
        constant attribute low : ISQ::ThermodynamicTemperatureValue = 18 ['°C_abs'];
        constant attribute goal : Real;
        in attribute temp : ISQ::ThermodynamicTemperatureValue;
        in attribute load : Real;
        in attribute count : Integer;
        exhibit state modes {
            entry; then Off;
            state Off;
            state On;
            transition first Off if temp < low and load < goal then On;
            transition first On if temp >= 22 ['°C_abs'] or count > 3 then Off;
        }
    }
}
"""
"""A model whose contract has all members about numbers."""
READ_ONLY = {
    "neutral-contract",
    "sysmlc-config",
    "sysmlc-libraries",
    "sysmlc-overlay",
    "sysmlc-scenario",
}
"""Schemas of files that sysmlc reads and does not write."""
NEVER_WRITTEN = {
    # The type of a machine's variable can be a material, but no model has such a variable.
    "sysmlc-recipe#/valueType/material",
    # Only flows with «Probability» have expected times, and no requirement states a shortest time.
    "sysmlc-recipe#/derivedDuration/expected",
    "sysmlc-recipe#/flowGraph/edges/probability",
    "sysmlc-recipe#/timeLimits/min",
    # ``contracts check`` writes these, not ``build``; tests/cli checks them.
    *(
        f"sysmlc-diagnostics#/requirements/{member}"
        for member in (
            *("requirement", "component", "formula", "verdict", "reason"),
            *("witness", "witness/loop", "witness/steps", "vacuous", "needs"),
            *("witness/violated", "assumed_ranges", "unread_conditions"),
            *("witness/numbers", "witness/numbers/number", "witness/numbers/unit"),
        )
    ),
    *(
        f"sysmlc-diagnostics#/behaviours/{member}"
        for member in (
            "component",
            "unreachable",
            "never_taken",
            "never_accepted",
            "never_true",
            "never_changed",
            "write_conflicts",
            "assumed_ranges",
        )
    ),
    # ``watch`` and commands that fail write these; tests/cli checks them.
    "sysmlc-diagnostics#/failure",
    "sysmlc-diagnostics#/output",
    *(
        f"sysmlc-diagnostics#/output/{member}"
        for member in ("folder", "is_updated", "changed", "withheld")
    ),
}


def find_models(corpus: Path) -> Iterator[Path]:
    """Yield the examples and the models of the corpus, folders of SysML v2 text as one unit."""
    yield from (path for path in sorted(EXAMPLES.iterdir()) if path.name != "robots")
    yield from sorted(EXAMPLES.glob("robots/hall.*"))
    for folder in ("xmi/papyrus", "xmi/magicdraw", "xmi/ea", "xmi/omg", "aml/dev"):
        for path in sorted((corpus / folder).iterdir()):
            is_model = path.suffix not in (".md", ".txt", ".di", ".notation")
            if path.is_file() and is_model and path.stat().st_size < LARGEST:
                yield path
    text = corpus / "sysml2"
    yield from (text / "omg-release" / "training", text / "omg-release" / "examples")
    yield from (path for path in sorted((text / "showcase").iterdir()) if path.is_dir())


def find_documents(corpus: Path, folder: Path) -> Iterator[Document]:
    """Yield the documents of all models, of all commands, and of the models that explain rules."""
    for number, model in enumerate(find_models(corpus)):
        yield from compile_documents(model, folder / str(number))
    config = folder / "ice.toml"
    config.write_text(ICE_LEVELS)
    laboratory = corpus / "sysml2" / "ice-lab"
    yield from compile_documents(laboratory, folder / "ice", "--config", config)
    (folder / "commands").mkdir()
    yield from command_documents(folder / "commands")
    heater = folder / "numbers.sysml"
    heater.write_text(NUMBERS, encoding="utf-8")
    yield from compile_documents(heater, folder / "numbers")
    rules = load_full_catalogue()
    # A machine with an id of a plant, whose elements no recipe uses.
    texts = [rich_recipe(), *read_graphs(rules["SM628"])]
    texts += [
        text for rule in rules.values() for text in (rule.read_page().wrong, rule.read_page().right)
    ]
    # The rules about comments with JSON have examples with damaged comments.
    graphs = [text for text in texts if _is_graph(text) and "sysmlc-kept" not in text]
    for number, text in enumerate(graphs):
        model = folder / f"rule{number}.ir"
        model.write_text(text)
        yield from compile_documents(model, folder / f"rule{number}")


def _is_graph(text: str) -> bool:
    try:
        return len(parse_text(text)) > 0
    except ValueError:
        return False


def test_documents_follow_their_schemas_and_contain_every_member(corpus, tmp_path):
    """Both properties share one test because the documents take some minutes."""
    violations: list[str] = []
    written: set[str] = set()
    for document in find_documents(corpus, tmp_path):
        violations += find_violations(document)
        if not violations:
            written |= written_properties(document)
    assert violations == []
    declared = {member for name in SCHEMAS for member in declared_properties(name)}
    ours = {member for member in declared if member.partition("#")[0] not in READ_ONLY}
    assert ours - written == NEVER_WRITTEN
