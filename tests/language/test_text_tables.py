"""The LALR(1) tables of the parser: generated reproducibly, shipped, and loaded without Lark."""

import logging
import subprocess
import sys

import pytest
from lark import logger

from sysmlc.language.text import lalr
from sysmlc.language.text.builders import ACTIONS
from sysmlc.language.text.table_generator import generate_tables

LANGUAGES = ("kerml", "sysml")
CONFLICTS = {"kerml": 12, "sysml": 5}
"""Conflicts in which shifting is right, such as the dangling else, and ``accept`` after ``do``."""


@pytest.mark.parametrize("language", LANGUAGES)
def test_a_grammar_has_no_new_conflicts(language, caplog):
    with caplog.at_level(logging.DEBUG, logger=logger.name):
        generate_tables(lalr.read_grammar(language))
    conflicts = [message for message in caplog.messages if message.startswith("Shift/Reduce")]
    assert len(conflicts) == CONFLICTS[language]


@pytest.mark.parametrize("language", LANGUAGES)
def test_equal_grammars_have_equal_tables(language):
    grammar = lalr.read_grammar(language)
    assert generate_tables(grammar) == generate_tables(grammar)


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_rule_of_a_grammar_has_a_function_that_builds_its_node(language):
    names = {name for _, _, name, _ in lalr.load_tables(language).rules}
    assert names - {""} <= set(ACTIONS[language])


def test_every_building_function_is_used_by_a_rule():
    rules = [rule for language in LANGUAGES for rule in lalr.load_tables(language).rules]
    defined = {name for language in LANGUAGES for name in ACTIONS[language]}
    assert defined <= {name for _, _, name, _ in rules}


@pytest.mark.parametrize("language", LANGUAGES)
def test_words_are_reserved_in_their_language(language):
    words = lalr.load_tables(language).types.words
    assert ("part" in words, "classifier" in words) == (language == "sysml", language == "kerml")


def test_shipped_tables_of_another_grammar_are_not_used(tmp_path, monkeypatch):
    monkeypatch.setattr(lalr, "SHIPPED", tmp_path)
    path = lalr.write_tables("sysml", tmp_path)
    shipped = lalr._read_shipped("sysml")
    assert shipped
    assert path.read_bytes().endswith(shipped)
    path.write_bytes(b"x" + path.read_bytes()[1:])
    assert lalr._read_shipped("sysml") is None


def test_missing_tables_are_generated_into_the_package(tmp_path, monkeypatch):
    monkeypatch.setattr(lalr, "SHIPPED", tmp_path / "generated")
    generated = lalr._generate("kerml")
    assert lalr._read_shipped("kerml") == generated


def test_in_a_read_only_package_tables_are_generated_without_being_stored(tmp_path, monkeypatch):
    (tmp_path / "file").touch()
    monkeypatch.setattr(lalr, "SHIPPED", tmp_path / "file" / "generated")
    assert lalr._generate("kerml")
    assert lalr._read_shipped("kerml") is None


def test_a_process_that_has_tables_does_not_import_lark(tmp_path):
    code = (
        "import sys; from sysmlc.diagnostics import Sink; from sysmlc.language.text import parse;"
        "parse('part x;', 'm', 'sysml', Sink()); print('lark' in sys.modules)"
    )
    command = [sys.executable, "-c", code]
    env = {"SYSMLC_CACHE": str(tmp_path), "PATH": ""}
    printed = [subprocess.run(command, capture_output=True, text=True, env=env) for _ in range(2)]
    assert printed[1].stdout == "False\n"
