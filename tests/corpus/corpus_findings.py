"""Findings of builds of corpus models, and findings that are about one fact.

Two findings of a build are about one fact if they have the same file, rule and message, or if they
are at the same line and column. ``SUMMARIES`` and ``REVIEWED_PAIRS`` state which findings at one
place are about two facts.
"""

import json
import re
from collections.abc import Iterable, Iterator
from itertools import combinations
from pathlib import Path
from typing import Any

from click.testing import CliRunner

from sysmlc.cli.group import sysmlc

SUMMARIES = {
    "SM211": "all applications of stereotypes of a missing profile, at the first of them",
    "SM701": "all elements of an owner that no diagram shows, at the first of them",
}
"""Rules that list many elements and have the place of the first one."""

REVIEWED_PAIRS = {
    ("SM147", "SM631"): "an attribute with a wrong unit and a wrong value",
    ("SM154", "SM154"): "two attributes that the metaclass of an element does not have",
    ("SM202", "SM210"): "a port that subsets one of another block, and its stereotype",
    ("SM203", "SM204"): "a feature that is wider than the one that it subsets, in type and number",
    ("SM310", "SM314"): "an item flow against the direction of a port, and without item",
    ("SM428", "SM434"): "a transition with an effect out of range, whose event can be lost",
    ("SM458", "SM468"): "a guard that is not understood, on a flow that leaves no decision",
}
"""Rules whose findings at one place are about two facts, and which these are."""

_NUMBER_OF_PLACES = re.compile(r" \(\d+ places\)$")

Finding = dict[str, Any]
"""A finding of the format JSON."""


def build_model(path: Path, output: Path) -> tuple[int, list[Finding], int]:
    """Build a model; return the exit code, the findings and the number of output files."""
    options = ["-o", str(output), "--format", "json", "--no-cache"]
    result = CliRunner().invoke(sysmlc, ["build", str(path), *options])
    assert result.exception is None or isinstance(result.exception, SystemExit), path.name
    folders = [folder for folder in output.iterdir() if folder.is_dir()]
    number = sum(1 for folder in folders for _ in folder.rglob("*.*"))
    return result.exit_code, json.loads(result.stdout)["diagnostics"], number


def list_repeated_facts(findings: Iterable[Finding]) -> list[str]:
    """Return a line for each pair of findings about one fact."""
    by_text: dict[tuple[str, ...], list[Finding]] = {}
    by_place: dict[tuple[str, int, int], list[Finding]] = {}
    for finding in findings:
        message = _NUMBER_OF_PLACES.sub("", finding["message"])
        by_text.setdefault((finding["file"], finding["code"], message), []).append(finding)
        if finding["line"] is not None:
            place = (finding["file"], finding["line"], finding["column"])
            by_place.setdefault(place, []).append(finding)
    pairs = [
        pair
        for groups in (by_text, by_place)
        for group in groups.values()
        for pair in combinations(group, 2)
    ]
    return list(dict.fromkeys(_describe_pairs(pairs)))


def _describe_pairs(pairs: Iterable[tuple[Finding, Finding]]) -> Iterator[str]:
    for first, second in pairs:
        codes = tuple(sorted((first["code"], second["code"])))
        is_summary = not SUMMARIES.keys().isdisjoint(codes) and codes[0] != codes[1]
        if not is_summary and codes not in REVIEWED_PAIRS:
            where = f"{first['file']}:{first['line']}:{first['column']}"
            texts = [f"{finding['code']} {finding['message']}" for finding in (first, second)]
            yield f"{where} {' | '.join(texts)}"
