"""What a compilation means to its user: findings with places, files, exit code. No graph."""

import hashlib
from collections.abc import Mapping
from pathlib import Path

from msgspec import Struct

from sysmlc.backends.base import InputFile
from sysmlc.diagnostics import Diagnostic
from sysmlc.diagnostics.render import Finding, make_report
from sysmlc.driver import faults
from sysmlc.driver.compilation import Compilation
from sysmlc.driver.tracing import COVERAGE, TRACE, coverage_text, trace_text


class OutputFile(Struct, frozen=True):
    """A file of the output folder, and the back end that made it."""

    path: str
    backend: str
    sha256: str


class Withheld(Struct, frozen=True):
    """A file that is not written, and the errors because of which."""

    path: str
    because: tuple[Diagnostic, ...]


class Outcome(Struct, frozen=True):
    """What came out of one compilation, or of the same one earlier.

    ``findings`` name files as the unit does. ``texts`` holds the text of each of ``files``.
    """

    root: Path
    inputs: tuple[InputFile, ...]
    findings: tuple[Finding, ...]
    files: tuple[OutputFile, ...]
    texts: Mapping[str, str]
    withheld: tuple[Withheld, ...] = ()
    is_complete: bool = True
    """Whether every input could be read; if not, nothing old is removed."""

    def exit_code(self, strict: bool = False) -> int:
        """0 clean; 1 the model is wrong (with ``strict`` also warnings); 2 we failed."""
        return faults.exit_code((found.diagnostic for found in self.findings), strict)


def outcome(compilation: Compilation, has_files: bool = True) -> Outcome:
    """The outcome of a compilation: places become lines, elements their trace.

    Without ``has_files`` it holds the findings only.
    """
    texts = _texts(compilation) if has_files else {}
    backends = {artefact.path: artefact.backend for artefact in compilation.artefacts}
    return Outcome(
        root=compilation.root,
        inputs=compilation.inputs,
        findings=make_report(compilation.diagnostics, compilation.sources).findings,
        files=tuple(
            OutputFile(path, backends.get(path, ""), digest_of(text))
            for path, text in texts.items()
        ),
        texts=texts,
        withheld=tuple(Withheld(path, why) for path, why in sorted(compilation.withheld.items())),
        is_complete=compilation.is_complete,
    )


def _texts(compilation: Compilation) -> dict[str, str]:
    texts = {artefact.path: artefact.text for artefact in compilation.written()}
    return texts | {COVERAGE: coverage_text(compilation), TRACE: trace_text(compilation)}


def digest_of(text: str) -> str:
    """SHA-256, in hex, of a text as it is written."""
    return hashlib.sha256(text.encode("utf-8")).hexdigest()
