"""``manifest.json``: what a run read and wrote, what it withheld and why."""

from collections.abc import Iterable

from sysmlc import __version__
from sysmlc.diagnostics import Diagnostic
from sysmlc.driver.outcome import Outcome, OutputFile, Withheld
from sysmlc.driver.tracing import COVERAGE, TRACE
from sysmlc.output import encode_json

MANIFEST = "manifest.json"

_OURS = frozenset({COVERAGE, TRACE})
"""Files that the driver writes beside those of the back ends; the manifest does not list them."""


def manifest_text(outcome: Outcome, kept: Iterable[str] = ()) -> str:
    """Inputs and files with their digests, what is withheld and why, what is ``kept``.

    ``kept`` are files of an earlier run whose inputs could not be read this time.
    """
    return encode_json(
        {
            "format": "sysmlc-manifest/2",
            "sysmlc": __version__,
            "inputs": [
                {"path": file.path, "sha256": file.sha256, "language": file.language}
                for file in outcome.inputs
            ],
            "files": [_file(file) for file in outcome.files if file.path not in _OURS],
            "withheld": [_withheld(file) for file in outcome.withheld],
            "kept": [{"path": path} for path in kept],
        }
    )


def _file(file: OutputFile) -> dict[str, object]:
    return {"path": file.path, "backend": file.backend, "sha256": file.sha256}


def _withheld(file: Withheld) -> dict[str, object]:
    return {"path": file.path, "because": [_because(error) for error in file.because]}


def _because(error: Diagnostic) -> dict[str, str]:
    return {
        "code": error.rule.code,
        "name": error.rule.name,
        "message": error.message,
        "element": error.subject.name,
    }
