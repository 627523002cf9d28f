"""Outcomes of earlier runs: the form in which the cache keeps them."""

import json
import zlib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import fields
from functools import cached_property
from itertools import accumulate
from operator import attrgetter
from pathlib import Path
from typing import Any

from sysmlc.backends.base import InputFile
from sysmlc.cache import Cache
from sysmlc.diagnostics import Diagnostic, Place, Rule, Severity, Subject
from sysmlc.diagnostics.render import Finding
from sysmlc.driver.outcome import Outcome, OutputFile, Packed, Withheld
from sysmlc.values import dataclass

_LENGTH = 8
"""Bytes that say how long a part of an entry is: the outcome, its texts' lengths; then texts."""
_LONG = 2**21
"""Characters from which a text is always worth the time to compress it."""
_PLAIN = "\0"
"""What a text begins with that is kept as it is; compressed ones begin otherwise."""
_Kept = dict[str, bytes | memoryview]
"""Texts as they are kept, by their digests."""
_last: dict[str, _Kept] = {}
"""Those of the outcome that this process kept last, by its unit."""


def remember(cache: Cache, key: str, outcome: Outcome, unit: str = "") -> None:
    """Keep an outcome, unless a fault of ours or of the machine is part of it.

    Texts that the last outcome of the ``unit`` has, too, are taken from there.
    """
    if outcome.exit_code() == 2:
        return
    texts = dict(_packed_texts(outcome, cache, unit))
    _last.clear()
    _last[unit] = {file.sha256: texts[file.path] for file in outcome.files}
    parts = [_packed(_form(outcome)), _packed({path: len(data) for path, data in texts.items()})]
    lengths = [len(part).to_bytes(_LENGTH, "big") for part in parts]
    cache.put(key, *lengths, *parts, *texts.values())
    if unit:
        cache.put(unit, key.encode())


def _packed_texts(
    outcome: Outcome, cache: Cache, unit: str
) -> Iterator[tuple[str, bytes | memoryview]]:
    """Each text as it is kept: as in an outcome before, if that has the text.

    What is new there is about to be edited again: to compress it takes longer than it is worth.
    """
    before = outcome.texts if isinstance(outcome.texts, Packed) else None
    known = {} if before is not None else _last.get(unit) or _last_texts(cache, unit)
    is_edited = before is not None or bool(known)
    for file in outcome.files:
        kept = known.get(file.sha256) if before is None else before.packed(file.path)
        yield file.path, _new(outcome.texts[file.path], is_edited) if kept is None else kept


def _new(text: str, is_edited: bool) -> bytes:
    if is_edited and len(text) < _LONG:
        return f"{_PLAIN}{text}".encode("utf-8", "surrogatepass")
    return zlib.compress(text.encode("utf-8", "surrogatepass"), 1)


def _last_texts(cache: Cache, unit: str) -> _Kept:
    """Texts of the last outcome of a unit, as they are kept, by their digests."""
    key = cache.get(unit) if unit else None
    entry = cache.get(key.decode()) if key else None
    if entry is None:
        return {}
    form, texts = _opened(entry)
    return {sha256: texts.packed(path) for path, _, sha256 in form["files"]}


def recall(cache: Cache, key: str, root: Path) -> Outcome | None:
    """The outcome that was kept under the key; its texts are unpacked when they are asked for."""
    entry = cache.get(key)
    if entry is None:
        return None
    form, texts = _opened(entry)
    return _outcome(form, root, texts)


def _opened(entry: bytes) -> "tuple[dict[str, Any], _Texts]":
    lengths = [int.from_bytes(entry[at : at + _LENGTH], "big") for at in (0, _LENGTH)]
    start = 2 * _LENGTH
    middle, end = start + lengths[0], start + sum(lengths)
    texts = _Texts(memoryview(entry)[end:], json.loads(entry[middle:end]))
    return json.loads(entry[start:middle]), texts


def _packed(value: object) -> bytes:
    return json.dumps(value, separators=(",", ":")).encode()


def _unpacked(data: memoryview) -> str:
    if data[:1] == _PLAIN.encode():
        return str(data[1:], "utf-8", "surrogatepass")
    return zlib.decompress(data).decode("utf-8", "surrogatepass")


def _form(outcome: Outcome) -> dict[str, object]:
    withheld = [error for file in outcome.withheld for error in file.because]
    found = [finding.diagnostic for finding in outcome.findings]
    rules = {one.rule.code: one.rule for one in (*found, *withheld)}
    return {
        "inputs": [_fields(file) for file in outcome.inputs],
        "rules": {code: _fields(rule) for code, rule in rules.items()},
        "findings": [_finding(finding) for finding in outcome.findings],
        "files": [_fields(file) for file in outcome.files],
        "withheld": [[w.path, [_diagnostic(e) for e in w.because]] for w in outcome.withheld],
        "complete": outcome.is_complete,
    }


_GETTERS: dict[type[object], Callable[[object], tuple[object, ...]]] = {
    made: attrgetter(*(field.name for field in fields(made)))
    for made in (Finding, Place, Rule, InputFile, OutputFile)
}


def _fields(value: object) -> tuple[object, ...]:
    """The fields of a value of one of those types, in order."""
    return _GETTERS[type(value)](value)


def _finding(finding: Finding) -> tuple[object, ...]:
    _, *where = _fields(finding)
    return _diagnostic(finding.diagnostic), *where


def _diagnostic(found: Diagnostic) -> tuple[object, ...]:
    about = found.subject
    place = about.place and _fields(about.place)
    code, severity, message = found.rule.code, found.severity, found.message
    return code, severity, message, about.name, about.id, place, found.notes, found.help


# -- back again --------------------------------------------------------------------------------


@dataclass(frozen=True)
class _Texts(Packed):
    """The texts of an outcome, each unpacked when it is asked for; most runs need none."""

    all: memoryview
    lengths: Mapping[str, int]
    """How many bytes of ``all`` are which text, in order."""

    @cached_property
    def _starts(self) -> dict[str, int]:
        return dict(zip(self.lengths, accumulate(self.lengths.values(), initial=0), strict=False))

    def packed(self, path: str) -> memoryview:
        """The text at the path, as it is kept."""
        start = self._starts[path]
        return self.all[start : start + self.lengths[path]]

    def __getitem__(self, path: str) -> str:
        return _unpacked(self.packed(path))

    def __contains__(self, path: object) -> bool:
        return path in self.lengths

    def __iter__(self) -> Iterator[str]:
        return iter(self.lengths)

    def __len__(self) -> int:
        return len(self.lengths)


def _outcome(kept: dict[str, Any], root: Path, texts: Mapping[str, str]) -> Outcome:
    rules = {code: _rule(*rule) for code, rule in kept["rules"].items()}
    return Outcome(
        root=root,
        inputs=tuple(InputFile(*file) for file in kept["inputs"]),
        findings=tuple(_found(rules, *finding) for finding in kept["findings"]),
        files=tuple(OutputFile(*file) for file in kept["files"]),
        texts=texts,
        withheld=tuple(
            Withheld(path, tuple(_told(rules, *error) for error in errors))
            for path, errors in kept["withheld"]
        ),
        is_complete=kept["complete"],
    )


def _rule(code: str, name: str, severity: str, *texts: str) -> Rule:
    return Rule(code, name, Severity(severity), *texts)


def _found(rules: Mapping[str, Rule], diagnostic: list[Any], *where: Any) -> Finding:  # noqa: ANN401 - JSON
    return Finding(_told(rules, *diagnostic), *where)


def _told(
    rules: Mapping[str, Rule],
    rule: str,
    severity: str,
    message: str,
    name: str,
    id: str,
    place: list[Any] | None,
    notes: list[str],
    help: str,
) -> Diagnostic:
    about = Subject(name, id, Place(*place) if place else None)
    return Diagnostic(rules[rule], Severity(severity), message, about, tuple(notes), help)
