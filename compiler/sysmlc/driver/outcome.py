"""The outcome of a compilation: located findings, files and exit code, without the graph.

Three files of every output folder describe it: ``coverage.json`` has the verdicts on the inputs,
``trace.json`` the sources of the outputs, ``manifest.json`` what a run read and wrote, what it
withheld and why.
"""

import hashlib
from collections.abc import Iterable, Mapping
from itertools import chain
from pathlib import Path

from msgspec import Struct

from sysmlc import __version__
from sysmlc.backends.base import InputFile
from sysmlc.diagnostics import Diagnostic, Place
from sysmlc.diagnostics.locations import find_positions
from sysmlc.diagnostics.renderers import Finding, make_report
from sysmlc.driver import faults
from sysmlc.driver.compilation import Compilation
from sysmlc.driver.ownership import FORMAT
from sysmlc.ir import Element
from sysmlc.support.output import encode_json

COVERAGE = "coverage.json"
TRACE = "trace.json"


def format_trace(compilation: Compilation) -> str:
    """Return the elements that each file comes from, and where each stands in the inputs."""
    artefacts = compilation.list_published()
    ids = dict.fromkeys(chain.from_iterable(artefact.trace for artefact in artefacts))
    elements = filter(None, map(compilation.graph.get, ids))
    content = {
        "format": "sysmlc-trace/2",
        "outputs": [{"path": artefact.path, "elements": artefact.trace} for artefact in artefacts],
        "elements": _describe_elements(compilation, elements),
    }
    return encode_json(content)


def _describe_elements(
    compilation: Compilation, elements: Iterable[Element]
) -> list[dict[str, object]]:
    """Return id, name and source of each element, sorted by name and id."""
    subjects = sorted(map(compilation.graph.subject, elements), key=lambda s: (s.name, s.id))
    places = [subject.place or Place("") for subject in subjects]
    ordinals: dict[str, list[int]] = {}
    for place in places:
        ordinals.setdefault(place.file, []).append(place.ordinal)
    located = find_positions(compilation.sources, ordinals)
    return [
        {
            "id": subject.id,
            "qualified_name": subject.name,
            "source": _describe_source(place, located) if place.file else None,
        }
        for subject, place in zip(subjects, places, strict=True)
    ]


def _describe_source(
    place: Place, located: dict[str, dict[int, tuple[int, int]]]
) -> dict[str, object]:
    line, column = located.get(place.file, {}).get(place.ordinal, (0, 0))
    return {"file": place.file, "line": line or None, "column": column or None}


# -- outcome -----------------------------------------------------------------------------------


class OutputFile(Struct, frozen=True):
    """A file of the output folder, and the back end that generated it.

    ``name`` is the full name of the element after which the file is named, if there is one.
    """

    path: str
    backend: str
    sha256: str
    name: str = ""


class Withheld(Struct, frozen=True):
    """A file that is not written, and the errors that are the reason."""

    path: str
    because: tuple[Diagnostic, ...]


class Outcome(Struct, frozen=True):
    """The outcome of one compilation, computed now or loaded from the cache.

    ``findings`` name files relative to ``root``. ``texts`` has the text of each file by path.
    """

    root: Path
    inputs: tuple[InputFile, ...]
    findings: tuple[Finding, ...]
    files: tuple[OutputFile, ...]
    texts: Mapping[str, str]
    withheld: tuple[Withheld, ...] = ()
    is_complete: bool = True
    """Whether every input was read. If not, files of earlier runs are not removed."""

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """The diagnostics of the findings."""
        return tuple(finding.diagnostic for finding in self.findings)

    def exit_code(self, strict: bool = False) -> int:
        """Return 0 (clean), 1 (errors, with *strict* also warnings) or 2 (no result)."""
        return faults.compute_exit_code(self.diagnostics, strict)


def summarize(compilation: Compilation, has_files: bool = True) -> Outcome:
    """Return the outcome of a compilation; without *has_files* it has only the findings.

    Locations are resolved to lines and columns.
    """
    texts: dict[str, str] = {}
    if has_files:
        texts = {artefact.path: artefact.text for artefact in compilation.list_published()}
        coverage = {"format": "sysmlc-coverage/2", **compilation.coverage.as_json()}
        texts |= {COVERAGE: encode_json(coverage), TRACE: format_trace(compilation)}
    origins = {item.path: (item.backend, item.name) for item in compilation.artefacts}
    return Outcome(
        root=compilation.root,
        inputs=compilation.inputs,
        findings=make_report(compilation.diagnostics, compilation.sources).findings,
        files=tuple(
            OutputFile(path, backend, compute_text_digest(text), name)
            for path, text in texts.items()
            for backend, name in [origins.get(path, ("", ""))]
        ),
        texts=texts,
        withheld=tuple(Withheld(path, why) for path, why in sorted(compilation.withheld.items())),
        is_complete=compilation.is_complete,
    )


def collect_results(
    command: str, root: Path, inputs: Iterable[InputFile], texts: Mapping[str, str]
) -> Outcome:
    """Return the outcome of a command that writes only its own results, such as ``synth``.

    It counts as incomplete, so that results of earlier runs are not removed.
    """
    files = (OutputFile(path, command, compute_text_digest(texts[path])) for path in sorted(texts))
    return Outcome(root, tuple(inputs), (), tuple(files), texts, is_complete=False)


def compute_text_digest(text: str) -> str:
    """Return the SHA-256, in hex, of a text as a file contains it."""
    return hashlib.sha256(text.encode("utf-8")).hexdigest()


# -- manifest ----------------------------------------------------------------------------------


def format_manifest(outcome: Outcome, kept: Mapping[str, str]) -> str:
    """Return the manifest: inputs and files with their digests, withheld files and the reasons.

    *kept* are paths and digests of files of an earlier run, whose inputs could not be read now.
    """
    return encode_json(
        {
            "format": FORMAT,
            "sysmlc": __version__,
            "inputs": [
                {"path": file.path, "sha256": file.sha256, "language": file.language}
                for file in outcome.inputs
            ],
            "files": [_describe_file(file) for file in outcome.files],
            "withheld": [
                {"path": file.path, "because": [_describe_reason(error) for error in file.because]}
                for file in outcome.withheld
            ],
            "kept": [{"path": path, "sha256": digest} for path, digest in kept.items()],
        }
    )


def _describe_file(file: OutputFile) -> dict[str, object]:
    name = {"name": file.name} if file.name else {}
    return {"path": file.path, **name, "backend": file.backend, "sha256": file.sha256}


def _describe_reason(error: Diagnostic) -> dict[str, str]:
    return {
        "code": error.rule.code,
        "name": error.rule.name,
        "message": error.message,
        "element": error.subject.name,
    }
