"""The outcome of a compilation: located findings, files and exit code, without the graph."""

import hashlib
from collections.abc import Mapping
from pathlib import Path

from msgspec import Struct

from sysmlc.backends.base import InputFile
from sysmlc.diagnostics import Diagnostic
from sysmlc.diagnostics.render import Finding, make_report
from sysmlc.driver import faults
from sysmlc.driver.compilation import Compilation
from sysmlc.driver.tracing import COVERAGE, TRACE, format_coverage, format_trace


class OutputFile(Struct, frozen=True):
    """A file of the output folder, and the back end that generated it."""

    path: str
    backend: str
    sha256: str


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

    def exit_code(self, strict: bool = False) -> int:
        """Return 0 (clean), 1 (errors, with *strict* also warnings) or 2 (no result)."""
        return faults.compute_exit_code((finding.diagnostic for finding in self.findings), strict)


def summarize(compilation: Compilation, has_files: bool = True) -> Outcome:
    """Return the outcome of a compilation; without *has_files* it has only the findings.

    Locations are resolved to lines and columns.
    """
    texts = _collect_texts(compilation) if has_files else {}
    backends = {artefact.path: artefact.backend for artefact in compilation.artefacts}
    return Outcome(
        root=compilation.root,
        inputs=compilation.inputs,
        findings=make_report(compilation.diagnostics, compilation.sources).findings,
        files=tuple(
            OutputFile(path, backends.get(path, ""), compute_text_digest(text))
            for path, text in texts.items()
        ),
        texts=texts,
        withheld=tuple(Withheld(path, why) for path, why in sorted(compilation.withheld.items())),
        is_complete=compilation.is_complete,
    )


def _collect_texts(compilation: Compilation) -> dict[str, str]:
    texts = {artefact.path: artefact.text for artefact in compilation.list_published()}
    return texts | {COVERAGE: format_coverage(compilation), TRACE: format_trace(compilation)}


def compute_text_digest(text: str) -> str:
    """Return the SHA-256, in hex, of a text as a file contains it."""
    return hashlib.sha256(text.encode("utf-8")).hexdigest()
