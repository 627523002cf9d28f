"""``manifest.json``, ``coverage.json`` and ``trace.json``: what outputs say about themselves."""

import hashlib
import json
from collections.abc import Iterable, Mapping

from sysmlc import __version__
from sysmlc.diagnostics import Diagnostic, Place
from sysmlc.driver.compilation import Compilation
from sysmlc.driver.places import Locator
from sysmlc.output import Artefact

MANIFEST = "manifest.json"
COVERAGE = "coverage.json"
TRACE = "trace.json"


def manifest_text(compilation: Compilation, kept: Iterable[str] = ()) -> str:
    """Inputs and files with their digests, what is withheld and why, what is ``kept``.

    ``kept`` are files of an earlier run whose inputs could not be read this time.
    """
    return _json(
        {
            "schema": "sysmlc-manifest/1",
            "sysmlc": __version__,
            "inputs": [
                {"path": file.path, "sha256": file.sha256, "language": file.language}
                for file in compilation.inputs
            ],
            "files": [_file(artefact) for artefact in compilation.written()],
            "withheld": [
                {"path": path, "because": [_because(error) for error in errors]}
                for path, errors in sorted(compilation.withheld.items())
            ],
            "kept": [{"path": path} for path in kept],
        }
    )


def coverage_text(compilation: Compilation) -> str:
    """The verdict on every element of the inputs."""
    return _json({"schema": "sysmlc-coverage/1", **compilation.coverage.as_json()})


def trace_text(compilation: Compilation) -> str:
    """Which elements each file comes from, and where those stand in the inputs."""
    written = compilation.written()
    ids = dict.fromkeys(id for artefact in written for id in artefact.trace)
    return _json(
        {
            "schema": "sysmlc-trace/1",
            "outputs": [{"path": a.path, "elements": list(a.trace)} for a in written],
            "elements": _elements(compilation, ids),
        }
    )


def _elements(compilation: Compilation, ids: Iterable[str]) -> list[dict[str, object]]:
    graph = compilation.graph
    known = [element for element in map(graph.get, ids) if element is not None]
    subjects = {element.id: graph.subject(element) for element in known}
    places = Locator(compilation.sources)(s.place for s in subjects.values() if s.place)
    return [
        {
            "id": id,
            "qualified_name": subject.name,
            "source": _source(subject.place, places) if subject.place else None,
        }
        for id, subject in sorted(subjects.items(), key=lambda pair: (pair[1].name, pair[0]))
    ]


def _source(place: Place, places: Mapping[Place, Place]) -> dict[str, object]:
    found = places.get(place, place)
    return {"file": place.file, "line": found.line or None, "column": found.column or None}


def _file(artefact: Artefact) -> dict[str, object]:
    digest = hashlib.sha256(artefact.text.encode("utf-8")).hexdigest()
    return {"path": artefact.path, "backend": artefact.backend, "sha256": digest}


def _because(error: Diagnostic) -> dict[str, str]:
    return {
        "code": error.rule.code,
        "name": error.rule.name,
        "message": error.message,
        "element": error.subject.name,
    }


def _json(value: object) -> str:
    return json.dumps(value, ensure_ascii=False, indent=1) + "\n"
