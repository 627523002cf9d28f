"""Outcomes of earlier runs: the form in which the cache keeps them."""

import json
import zlib
from collections.abc import Iterator, Mapping
from dataclasses import fields
from functools import cached_property
from pathlib import Path
from typing import Any

from sysmlc.backends.base import InputFile
from sysmlc.cache import Cache
from sysmlc.diagnostics import Diagnostic, Place, Rule, Severity, Subject
from sysmlc.diagnostics.render import Finding
from sysmlc.driver.outcome import Outcome, OutputFile, Withheld
from sysmlc.values import dataclass

_LENGTH = 8
"""Bytes that say how long the first part of an entry is; the second holds the texts."""


def remember(cache: Cache, key: str, outcome: Outcome) -> None:
    """Keep an outcome, unless a fault of ours or of the machine is part of it."""
    if outcome.exit_code() == 2:
        return
    first = _packed(_form(outcome))
    cache.put(key, len(first).to_bytes(_LENGTH, "big") + first + _packed(dict(outcome.texts)))


def recall(cache: Cache, key: str, root: Path) -> Outcome | None:
    """The outcome that was kept under the key; its texts are unpacked when they are asked for."""
    entry = cache.get(key)
    if entry is None:
        return None
    start = _LENGTH + int.from_bytes(entry[:_LENGTH], "big")
    return _outcome(_unpacked(entry[_LENGTH:start]), root, _Texts(entry[start:]))


def _packed(value: object) -> bytes:
    text = json.dumps(value, ensure_ascii=False, separators=(",", ":"))
    return zlib.compress(text.encode("utf-8", "surrogatepass"), 1)


def _unpacked(data: bytes) -> Any:  # noqa: ANN401 - JSON
    return json.loads(zlib.decompress(data).decode("utf-8", "surrogatepass"))


def _form(outcome: Outcome) -> dict[str, object]:
    withheld = [error for file in outcome.withheld for error in file.because]
    found = [finding.diagnostic for finding in outcome.findings]
    rules = {one.rule.code: one.rule for one in (*found, *withheld)}
    return {
        "inputs": [_shallow(file) for file in outcome.inputs],
        "rules": {code: _shallow(rule) for code, rule in rules.items()},
        "findings": [_finding(finding) for finding in outcome.findings],
        "files": [_shallow(file) for file in outcome.files],
        "withheld": [[w.path, [_diagnostic(e) for e in w.because]] for w in outcome.withheld],
        "complete": outcome.is_complete,
    }


_FIELDS: dict[type[object], tuple[str, ...]] = {
    made: tuple(field.name for field in fields(made))
    for made in (Finding, Diagnostic, Subject, Place, Rule, InputFile, OutputFile)
}


def _shallow(value: object) -> dict[str, object]:
    """The fields of a value of one of those types; ``asdict`` would copy what is in them."""
    return {name: getattr(value, name) for name in _FIELDS[type(value)]}


def _finding(finding: Finding) -> dict[str, object]:
    return _shallow(finding) | {"diagnostic": _diagnostic(finding.diagnostic)}


def _diagnostic(found: Diagnostic) -> dict[str, object]:
    place = found.subject.place
    subject = _shallow(found.subject) | {"place": place and _shallow(place)}
    return _shallow(found) | {"rule": found.rule.code, "subject": subject}


# -- back again --------------------------------------------------------------------------------


@dataclass(frozen=True)
class _Texts(Mapping[str, str]):
    """The texts of an outcome; most runs only compare digests and need none of them."""

    packed: bytes

    @cached_property
    def _loaded(self) -> dict[str, str]:
        return dict(_unpacked(self.packed))

    def __getitem__(self, path: str) -> str:
        return self._loaded[path]

    def __iter__(self) -> Iterator[str]:
        return iter(self._loaded)

    def __len__(self) -> int:
        return len(self._loaded)


def _outcome(kept: dict[str, Any], root: Path, texts: Mapping[str, str]) -> Outcome:
    rules = {code: _rule(**rule) for code, rule in kept["rules"].items()}
    return Outcome(
        root=root,
        inputs=tuple(InputFile(**file) for file in kept["inputs"]),
        findings=tuple(_found(rules, **finding) for finding in kept["findings"]),
        files=tuple(OutputFile(**file) for file in kept["files"]),
        texts=texts,
        withheld=tuple(
            Withheld(path, tuple(_told(rules, **error) for error in errors))
            for path, errors in kept["withheld"]
        ),
        is_complete=kept["complete"],
    )


def _rule(severity: str, **fields: str) -> Rule:
    return Rule(severity=Severity(severity), **fields)


def _found(rules: Mapping[str, Rule], diagnostic: dict[str, Any], **where: Any) -> Finding:  # noqa: ANN401 - JSON
    return Finding(_told(rules, **diagnostic), **where)


def _told(
    rules: Mapping[str, Rule],
    rule: str,
    severity: str,
    subject: dict[str, Any],
    notes: list[str],
    **texts: str,
) -> Diagnostic:
    place = subject.pop("place")
    about = Subject(**subject, place=Place(**place) if place else None)
    return Diagnostic(rules[rule], Severity(severity), subject=about, notes=tuple(notes), **texts)
