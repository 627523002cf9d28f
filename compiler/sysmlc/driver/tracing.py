"""``coverage.json`` and ``trace.json``: the verdicts on the inputs, and the sources of outputs."""

from collections.abc import Iterable
from itertools import chain

from sysmlc.diagnostics import Place
from sysmlc.diagnostics.locate import positions
from sysmlc.driver.compilation import Compilation
from sysmlc.ir import Element
from sysmlc.support.json_text import encode_json

COVERAGE = "coverage.json"
TRACE = "trace.json"


def format_coverage(compilation: Compilation) -> str:
    """Return the verdict on every element of the inputs."""
    return encode_json({"format": "sysmlc-coverage/2", **compilation.coverage.as_json()})


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
    located = positions(compilation.sources, ordinals)
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
