"""Reports: print the findings of compilations, compute exit codes, and write result files."""

import json
import os
import re
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

import click
from msgspec.structs import replace

from sysmlc.support.counts import count
from sysmlc.support.escapes import escape_undecodable

if TYPE_CHECKING:
    from sysmlc.backends.base import InputFile
    from sysmlc.cli.session import Settings
    from sysmlc.cli.units import Unit
    from sysmlc.config import Config
    from sysmlc.diagnostics import Diagnostic
    from sysmlc.diagnostics.renderers import Finding
    from sysmlc.driver import Compilation, Outcome, Publication


_DEFAULT_LIMIT = 1_000
"""The largest number of findings that are printed for people by default."""
_MAX_NOTES = 4
"""Notes of a finding that are printed for people, unless ``--verbose`` asks for all."""
_MAX_CORE_NOTES = 12
"""The same for a contract that is unrealizable."""
_NO_DETAILS: Mapping[str, object] = {}
_FORMS_ON_STDOUT = frozenset({"json", "sarif", "github"})


def report_outcomes(
    outcomes: "Iterable[Outcome]",
    settings: "Settings",
    publications: "Iterable[Publication]" = (),
    details: Mapping[str, object] = _NO_DETAILS,
    *,
    is_one_line: bool = False,
) -> None:
    """Print the findings about all units and their output folders as one report.

    A finding about a library that several units use is printed once. *details* and *is_one_line*
    are those of ``print_findings``.
    """
    from sysmlc.diagnostics.renderers import make_report

    findings = [
        finding
        for outcome in outcomes
        for finding in localize(outcome.root, outcome.findings, outcome.inputs)
    ]
    diagnostics = [d for publication in publications for d in publication.diagnostics]
    findings += localize(Path.cwd(), make_report(diagnostics, ()).findings)
    unique = dict.fromkeys(findings)
    print_findings(unique, settings, details, folds_infos=True, is_one_line=is_one_line)


def list_findings(compilation: "Compilation", only_errors: bool = False) -> "list[Finding]":
    """Return the findings of a compilation, with file names relative to the working folder."""
    from sysmlc.diagnostics.renderers import make_report

    diagnostics = [d for d in compilation.diagnostics if d.is_error or not only_errors]
    findings = make_report(diagnostics, compilation.sources).findings
    return localize(compilation.root, findings, compilation.inputs)


def localize(
    root: Path, findings: "Iterable[Finding]", inputs: "Iterable[InputFile]" = ()
) -> "list[Finding]":
    """Return the findings with file names relative to the working folder.

    Names of *inputs* and of files with findings are also replaced in messages, notes and help.
    """
    findings = list(findings)
    files = {finding.file for finding in findings if finding.file} | {file.path for file in inputs}
    names = {file: localize_name(root, file) for file in sorted(files)}
    spellings = {spelling: names[file] for file in names for spelling in (file, str(root / file))}
    changed = {spelling: name for spelling, name in spellings.items() if spelling != name}
    if not changed:
        return findings
    alternatives = "|".join(re.escape(name) for name in sorted(changed, key=len, reverse=True))
    pattern = re.compile(rf"(?<=')(?:{alternatives})(?=')|(?<![^\s(])(?:{alternatives})(?=:\d)")

    def localize_text(text: str) -> str:
        return pattern.sub(lambda match: changed[match[0]], text)

    return [_localize_finding(finding, names, localize_text) for finding in findings]


def _localize_finding(
    finding: "Finding", names: Mapping[str, str], localize_text: Callable[[str], str]
) -> "Finding":
    diagnostic = finding.diagnostic
    return replace(
        finding,
        file=names.get(finding.file, ""),
        diagnostic=replace(
            diagnostic,
            message=localize_text(diagnostic.message),
            notes=tuple(map(localize_text, diagnostic.notes)),
            help=localize_text(diagnostic.help),
        ),
    )


def localize_name(root: Path, name: str) -> str:
    """Return the name of an input relative to the working folder if it is inside that folder."""
    path, folder = root / name, Path.cwd()
    if not path.is_relative_to(folder):
        return name
    return escape_undecodable(path.relative_to(folder).as_posix())


def print_findings(
    findings: "Iterable[Finding]",
    settings: "Settings",
    details: Mapping[str, object] = _NO_DETAILS,
    *,
    folds_infos: bool = False,
    is_one_line: bool = False,
) -> None:
    """Print the reported findings in the form that the user selected, one for each fact.

    *details* are members of the document that only the format JSON has. With *folds_infos*, the
    text has one line for each rule with infos, unless options ask for more. With *is_one_line*, a
    JSON or SARIF document is one line.
    """
    from sysmlc.diagnostics import Severity
    from sysmlc.diagnostics.renderers import (
        XPATH_FORMATS,
        merge_facts,
        render,
        render_json,
        shorten,
    )

    on_stdout = settings.form in _FORMS_ON_STDOUT
    stream = sys.stdout if on_stdout else sys.stderr
    selected = [finding for finding in findings if is_reported(finding.diagnostic, settings)]
    reported = merge_facts(selected)
    is_short = folds_infos and settings.form == "text" and not settings.verbose
    infos = [finding for finding in reported if finding.diagnostic.severity is Severity.INFO]
    folded = infos if is_short and not settings.min_severity else []
    shown = [f for f in reported if not (folded and f.diagnostic.severity is Severity.INFO)]
    report = shorten(shown, _find_limit(settings))
    report = replace(report, folded=tuple(folded))
    if settings.form not in XPATH_FORMATS and not settings.verbose:
        report = replace(report, findings=tuple(map(_shorten_finding, report.findings)))
    if settings.form == "json":
        text = render_json(report, details)
    else:
        text = render(report, settings.form, color=has_color(stream))
    if is_one_line and settings.form in ("json", "sarif"):
        text = json.dumps(json.loads(text), ensure_ascii=False) + "\n"
    # has_color has decided; without color=True click would decide again.
    click.echo(text, nl=False, err=not on_stdout, color=True)
    if report.hidden:
        click.echo(
            f"{len(report.hidden)} more are not shown; --max-diagnostics 0 shows all", err=True
        )


def _shorten_finding(finding: "Finding") -> "Finding":
    """Return the finding without its XPath and with the first and the key one of many notes."""
    from sysmlc.diagnostics import KEY_MARK

    notes = finding.diagnostic.notes
    # A core is of use only as a whole, together with the assumptions that would help.
    is_core = finding.diagnostic.rule.code == "SM532"
    if len(notes) > (_MAX_CORE_NOTES if is_core else _MAX_NOTES):
        key = [note for note in notes[_MAX_NOTES - 1 :] if KEY_MARK in note][:1]
        first = notes[: _MAX_NOTES - 1 - len(key)]
        rest = count(len(notes) - len(first) - len(key), "more note")
        short_notes = (*first, *key, f"{rest}; --verbose shows them")
        finding = replace(finding, diagnostic=replace(finding.diagnostic, notes=short_notes))
    return replace(finding, xpath="") if finding.xpath else finding


def is_reported(diagnostic: "Diagnostic", settings: "Settings") -> bool:
    """Whether the options select a diagnostic; errors are always reported."""
    from sysmlc.diagnostics import Severity

    severities = [severity.value for severity in Severity]
    limit = settings.min_severity or severities[-1]
    if diagnostic.is_error:
        return True
    if severities.index(diagnostic.severity.value) > severities.index(limit):
        return False
    is_selected = not settings.select or _matches_rule(diagnostic, settings.select)
    return is_selected and not _matches_rule(diagnostic, settings.ignore)


def _matches_rule(diagnostic: "Diagnostic", names: Iterable[str]) -> bool:
    rule = diagnostic.rule
    return any(name == rule.name or rule.code.startswith(name) for name in names)


def _find_limit(settings: "Settings") -> int:
    """Return the largest number of findings to print; 0 means all, the default for programs."""
    if settings.max_diagnostics is None:
        return 0 if settings.form in ("json", "sarif") else _DEFAULT_LIMIT
    return settings.max_diagnostics


def allows_sentences(settings: "Settings") -> bool:
    """Whether standard output may have text besides the findings, which JSON does not allow."""
    return settings.form not in ("json", "sarif")


def exit_code_of(outcome: "Outcome | Compilation", config: "Config", settings: "Settings") -> int:
    """Return the exit code of an outcome.

    ``--strict`` or the configuration may make it strict; then the reported warnings count.
    """
    from sysmlc.driver.faults import compute_exit_code

    reported = (d for d in outcome.diagnostics if is_reported(d, settings))
    return compute_exit_code(reported, settings.strict or config.strict)


def exit_code_of_all(
    units: "Sequence[Unit]", outcomes: "Sequence[Outcome]", settings: "Settings"
) -> int:
    """Return the highest exit code; each unit has the strictness of its own project."""
    pairs = zip(units, outcomes, strict=True)
    return max(exit_code_of(outcome, unit.config, settings) for unit, outcome in pairs)


def has_color(stream: object) -> bool:
    """Whether text on a stream is coloured: by ``--color``, NO_COLOR, FORCE_COLOR or the terminal.

    Sources: https://no-color.org and https://force-color.org.
    """
    context = click.get_current_context(silent=True)
    if context is not None and context.color is not None:
        return context.color
    if os.environ.get("NO_COLOR"):
        return False
    if os.environ.get("FORCE_COLOR"):
        return True
    is_terminal = getattr(stream, "isatty", lambda: False)()
    return bool(is_terminal) and os.environ.get("TERM") != "dumb"


# -- result files ------------------------------------------------------------------------------


class ReadUnit(Protocol):
    """What a command has read: a compilation, or a file with contracts."""

    @property
    def root(self) -> Path:
        """The folder that the paths of the inputs are relative to."""

    @property
    def inputs(self) -> "tuple[InputFile, ...]":
        """The files that were read."""


def publish_results(
    command: str,
    files: Iterable[tuple[str, str]],
    folder: Path,
    units: "Sequence[ReadUnit]",
    settings: "Settings",
) -> "list[Finding]":
    """Write pairs of path in *folder* and text, with the manifest of results.

    Return the reasons why nothing was written, if it was refused; the exit code is then 2.
    """
    from sysmlc.cli.session import fail
    from sysmlc.config import find_boundary
    from sysmlc.diagnostics.renderers import make_report
    from sysmlc.driver import Target, collect_results, publish
    from sysmlc.support.output import OutputPathError

    texts = dict(files)
    if not texts:
        return []
    paths = [unit.root / file.path.partition("!")[0] for unit in units for file in unit.inputs]
    inputs = [file for unit in units for file in unit.inputs]
    boundary = find_boundary(folder, paths)
    target = Target(folder, boundary, tuple(paths), settings.is_forced, command)
    try:
        publication = publish(collect_results(command, Path(), inputs, texts), target)
    except OutputPathError as problem:
        fail(str(problem))
    return localize(Path.cwd(), make_report(publication.diagnostics, ()).findings)
