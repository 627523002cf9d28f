"""Outcomes of earlier runs over unchanged inputs, as JSON entries of the cache.

A key covers everything that an outcome depends on (``cache_key``), so that an entry is either
exactly right or not found. An entry that does not decode into the structures below is a miss.
"""

from contextlib import suppress
from pathlib import Path, PureWindowsPath

import msgspec

from sysmlc.backends.base import InputFile
from sysmlc.diagnostics import Diagnostic, Place, Rule, Severity, Subject
from sysmlc.diagnostics.render import Finding
from sysmlc.driver.faults import FAILED
from sysmlc.driver.outcome import Outcome, OutputFile, Withheld
from sysmlc.support.cache import Cache


class _Rule(msgspec.Struct, array_like=True):
    code: str
    name: str
    severity: str
    phrase: str
    why: str
    help: str
    wrong: str
    right: str


class _Place(msgspec.Struct, array_like=True):
    file: str
    ordinal: int
    offset: int
    line: int
    column: int


class _Diagnostic(msgspec.Struct, array_like=True):
    """A diagnostic; ``rule`` is the code of one of the rules of the entry."""

    rule: str
    severity: str
    message: str
    name: str
    id: str
    place: _Place | None
    notes: tuple[str, ...]
    help: str


class _Finding(msgspec.Struct, array_like=True):
    diagnostic: _Diagnostic
    file: str
    line: int
    column: int
    excerpt: str
    xpath: str
    shift: int


class _Input(msgspec.Struct, array_like=True):
    path: str
    sha256: str
    language: str


class _File(msgspec.Struct, array_like=True):
    path: str
    backend: str
    sha256: str
    text: str


class _Withheld(msgspec.Struct, array_like=True):
    path: str
    because: tuple[_Diagnostic, ...]


class _Entry(msgspec.Struct, array_like=True):
    inputs: tuple[_Input, ...]
    rules: tuple[_Rule, ...]
    findings: tuple[_Finding, ...]
    files: tuple[_File, ...]
    withheld: tuple[_Withheld, ...]
    is_complete: bool


def store_outcome(cache: Cache, key: str, outcome: Outcome) -> None:
    """Store an outcome, unless an internal fault or a fault of the machine is part of it."""
    if outcome.exit_code() == FAILED:
        return
    # A file name that is not UTF-8 has lone surrogates, which JSON cannot hold.
    with suppress(UnicodeEncodeError):
        cache.put(key, _encode(outcome))


def load_outcome(cache: Cache, key: str, root: Path) -> Outcome | None:
    """Return the outcome stored under *key*, with *root* as its folder; None for a miss."""
    data = cache.get(key)
    if data is None:
        return None
    try:
        return _decode(data, root)
    except (ValueError, LookupError, RecursionError):
        # msgspec.ValidationError and DecodeError are ValueErrors.
        return None


# -- encoding ----------------------------------------------------------------------------------


def _encode(outcome: Outcome) -> bytes:
    errors = [error for withheld in outcome.withheld for error in withheld.because]
    diagnostics = [finding.diagnostic for finding in outcome.findings]
    rules = {one.rule.code: one.rule for one in (*diagnostics, *errors)}
    entry = _Entry(
        inputs=tuple(_Input(one.path, one.sha256, one.language) for one in outcome.inputs),
        rules=tuple(map(_encode_rule, rules.values())),
        findings=tuple(map(_encode_finding, outcome.findings)),
        files=tuple(
            _File(file.path, file.backend, file.sha256, outcome.texts[file.path])
            for file in outcome.files
        ),
        withheld=tuple(
            _Withheld(one.path, tuple(map(_encode_diagnostic, one.because)))
            for one in outcome.withheld
        ),
        is_complete=outcome.is_complete,
    )
    return msgspec.json.encode(entry)


def _encode_rule(rule: Rule) -> _Rule:
    return _Rule(
        rule.code,
        rule.name,
        str(rule.severity),
        rule.phrase,
        rule.why,
        rule.help,
        rule.wrong,
        rule.right,
    )


def _encode_finding(finding: Finding) -> _Finding:
    return _Finding(
        _encode_diagnostic(finding.diagnostic),
        finding.file,
        finding.line,
        finding.column,
        finding.excerpt,
        finding.xpath,
        finding.shift,
    )


def _encode_diagnostic(diagnostic: Diagnostic) -> _Diagnostic:
    subject = diagnostic.subject
    place = subject.place
    return _Diagnostic(
        diagnostic.rule.code,
        str(diagnostic.severity),
        diagnostic.message,
        subject.name,
        subject.id,
        None
        if place is None
        else _Place(place.file, place.ordinal, place.offset, place.line, place.column),
        diagnostic.notes,
        diagnostic.help,
    )


# -- decoding ----------------------------------------------------------------------------------


def _decode(data: bytes, root: Path) -> Outcome:
    entry = msgspec.json.decode(data, type=_Entry)
    for part in (entry.inputs, entry.files, entry.withheld):
        for named in part:
            _check_path(named.path)
    rules = {rule.code: _decode_rule(rule) for rule in entry.rules}
    return Outcome(
        root=root,
        inputs=tuple(InputFile(one.path, one.sha256, one.language) for one in entry.inputs),
        findings=tuple(_decode_finding(finding, rules) for finding in entry.findings),
        files=tuple(OutputFile(file.path, file.backend, file.sha256) for file in entry.files),
        texts={file.path: file.text for file in entry.files},
        withheld=tuple(
            Withheld(one.path, tuple(_decode_diagnostic(error, rules) for error in one.because))
            for one in entry.withheld
        ),
        is_complete=entry.is_complete,
    )


def _check_path(path: str) -> None:
    """Raise ValueError for a path that could lead out of the folder that it belongs to."""
    # A Windows path splits at both separators and knows drives: the stricter reading of the two.
    windows_path = PureWindowsPath(path)
    if not path or windows_path.anchor or ".." in windows_path.parts:
        raise ValueError(path)


def _decode_rule(rule: _Rule) -> Rule:
    return Rule(
        rule.code,
        rule.name,
        Severity(rule.severity),
        rule.phrase,
        rule.why,
        rule.help,
        rule.wrong,
        rule.right,
    )


def _decode_finding(finding: _Finding, rules: dict[str, Rule]) -> Finding:
    return Finding(
        _decode_diagnostic(finding.diagnostic, rules),
        finding.file,
        finding.line,
        finding.column,
        finding.excerpt,
        finding.xpath,
        finding.shift,
    )


def _decode_diagnostic(diagnostic: _Diagnostic, rules: dict[str, Rule]) -> Diagnostic:
    place = diagnostic.place
    return Diagnostic(
        rules[diagnostic.rule],
        Severity(diagnostic.severity),
        diagnostic.message,
        Subject(
            diagnostic.name,
            diagnostic.id,
            None
            if place is None
            else Place(place.file, place.ordinal, place.offset, place.line, place.column),
        ),
        diagnostic.notes,
        diagnostic.help,
    )
