"""The parser's tables: LALR(1), the same for the same grammar, and loaded without Lark."""

import logging
import subprocess
import sys

import pytest
from lark import logger

from sysmlc.language.text import tables
from sysmlc.language.text.build import ACTIONS
from sysmlc.language.text.generate import tables as generate

LANGUAGES = ("kerml", "sysml")
CONFLICTS = {"kerml": 13, "sysml": 4}
"""Places where shifting is right: dangling else, a list of parts of a declaration, and such."""


@pytest.mark.parametrize("language", LANGUAGES)
def test_a_grammar_has_only_the_conflicts_that_are_known(language, caplog):
    with caplog.at_level(logging.DEBUG, logger=logger.name):
        generate(tables.grammar(language))
    conflicts = [one for one in caplog.messages if one.startswith("Shift/Reduce")]
    assert len(conflicts) == CONFLICTS[language]


@pytest.mark.parametrize("language", LANGUAGES)
def test_equal_grammars_have_equal_tables(language):
    grammar = tables.grammar(language)
    assert generate(grammar) == generate(grammar)


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_rule_has_a_function_that_builds_its_part(language):
    names = {name for _, _, name, _ in tables.load(language).rules}
    assert names - {""} <= set(ACTIONS[language])


def test_all_functions_are_used():
    used = {name for one in LANGUAGES for _, _, name, _ in tables.load(one).rules}
    known = {name for one in LANGUAGES for name in ACTIONS[one]}
    assert known <= used


@pytest.mark.parametrize("language", LANGUAGES)
def test_words_are_reserved_in_their_language(language):
    words = tables.load(language).types.words
    assert ("part" in words, "classifier" in words) == (language == "sysml", language == "kerml")


def test_shipped_tables_of_another_grammar_are_not_taken(tmp_path, monkeypatch):
    monkeypatch.setattr(tables, "SHIPPED", tmp_path)
    path = tables.write("sysml", tmp_path)
    shipped = tables._shipped("sysml")
    assert shipped
    assert path.read_bytes().endswith(shipped)
    path.write_bytes(b"x" + path.read_bytes()[1:])
    assert tables._shipped("sysml") is None


def test_missing_tables_are_generated_beside_the_code(tmp_path, monkeypatch):
    monkeypatch.setattr(tables, "SHIPPED", tmp_path / "generated")
    generated = tables._generate("kerml")
    assert tables._shipped("kerml") == generated


def test_tables_are_generated_in_a_read_only_package(tmp_path, monkeypatch):
    (tmp_path / "file").touch()
    monkeypatch.setattr(tables, "SHIPPED", tmp_path / "file" / "generated")
    assert tables._generate("kerml")
    assert tables._shipped("kerml") is None


def test_a_process_that_has_tables_does_not_import_lark(tmp_path):
    code = (
        "import sys; from sysmlc.diagnostics import Sink; from sysmlc.language.text import parse;"
        "parse('part x;', 'm', 'sysml', Sink()); print('lark' in sys.modules)"
    )
    run = [sys.executable, "-c", code]
    env = {"SYSMLC_CACHE": str(tmp_path), "PATH": ""}
    printed = [subprocess.run(run, capture_output=True, text=True, env=env) for _ in range(2)]
    assert printed[1].stdout == "False\n"
