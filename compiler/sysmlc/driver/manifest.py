"""``manifest.json``: what a run read and wrote, what it withheld and why."""

from collections.abc import Mapping

from sysmlc import __version__
from sysmlc.diagnostics import Diagnostic
from sysmlc.driver.outcome import Outcome, OutputFile, Withheld
from sysmlc.driver.ownership import FORMAT
from sysmlc.support.json_text import encode_json


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
            "withheld": [_describe_withheld(file) for file in outcome.withheld],
            "kept": [{"path": path, "sha256": digest} for path, digest in kept.items()],
        }
    )


def _describe_file(file: OutputFile) -> dict[str, object]:
    return {"path": file.path, "backend": file.backend, "sha256": file.sha256}


def _describe_withheld(file: Withheld) -> dict[str, object]:
    return {"path": file.path, "because": [_describe_reason(error) for error in file.because]}


def _describe_reason(error: Diagnostic) -> dict[str, str]:
    return {
        "code": error.rule.code,
        "name": error.rule.name,
        "message": error.message,
        "element": error.subject.name,
    }
