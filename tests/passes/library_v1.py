"""Generate the libraries of actions for SysML v1: ``python tests/passes/library_v1.py``.

SysML v1 has neither subjects nor assumptions. The subject of a requirement satisfies the
requirement instead, and the language of a constraint marks an assumption. The actions are abstract:
only actions of a model have contracts.
"""

import re
import tempfile
from pathlib import Path

from sysmlc.driver import Request, compile_model, select_backends
from sysmlc.ir import Edge, Graph, Kind, parse_text, print_text, query
from sysmlc.ir.element import Element

FOLDER = Path(__file__).parents[2] / "metamodels"
LIBRARIES = ("DIN8580", "LineMachines")


def print_library(name: str) -> bytes:
    """Return a library of ``metamodels`` as XMI."""
    text = (FOLDER / f"{name}.sysml").read_text(encoding="utf-8")
    # The compiler would replace a package of this name by the library that it ships.
    text = re.sub(rf"library package {name}\b", "package Library", text)
    text = text.replace(f"{name}::", "Library::")
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / f"{name}.sysml").write_text(text, encoding="utf-8")
        graph = parse_text(_emit(Path(folder), f"{name}.sysml", "ir", "graph.ir").decode())
        for element in list(graph):
            _adapt_to_v1(graph, element, name)
        _mark_as_library(graph, name)
        (Path(folder) / f"{name}.ir").write_text(print_text(graph), encoding="utf-8")
        return _emit(Path(folder), f"{name}.ir", "uml", f"uml/{name}.uml")


def _emit(folder: Path, model: str, backend: str, file: str) -> bytes:
    outcome = compile_model(Request((folder / model,), backends=tuple(select_backends([backend]))))
    return next(output.text for output in outcome.list_published() if output.path == file).encode()


def _mark_as_library(graph: Graph, name: str) -> None:
    """Apply «ModelLibrary» to the package of the library."""
    (package,) = (element for element in graph.of_kind(Kind.PACKAGE) if element.name == name)
    application = Element(f"{package.id}.library", Kind.APPLICATION, "ModelLibrary")
    graph.add(application)
    graph.set(application, namespace="http://www.eclipse.org/uml2/5.0.0/UML/Profile/Standard")
    graph.connect(Edge.SUBJECT, application, package)


def _adapt_to_v1(graph: Graph, element: Element, name: str) -> None:
    if element.name == "Library":
        graph.rename(element, name)
    if element.kind is Kind.ACTIVITY or element.attrs.get("role") == "block":
        graph.set(element, abstract=True)
    if element.kind is Kind.ACTION:
        _add_pins(graph, element)
    for subject in graph.targets(element, Edge.SUBJECT):
        graph.disconnect(Edge.SUBJECT, element, subject)
        graph.connect(Edge.SATISFIES, subject, element)
    for assumption in graph.targets(element, Edge.ASSUMES):
        graph.set(assumption, language="LTL assume")
        graph.disconnect(Edge.ASSUMES, element, assumption)


def _add_pins(graph: Graph, action: Element) -> None:
    """Add a pin for each parameter of the called behaviour; SysML v2 needs no pins."""
    behaviour = graph.target(action, Edge.CALLS)
    for parameter in query.parameters(graph, behaviour) if behaviour is not None else ():
        direction = query.direction_of(parameter)
        pin = Element(f"{action.id}.{parameter.name}", Kind.PIN, parameter.name, action.id)
        pin.attrs["direction"] = direction
        pin.attrs["subkind"] = "argument" if direction == "in" else "result"
        graph.add(pin)
        type_ = graph.target(parameter, Edge.TYPED_BY)
        if type_ is not None:
            graph.connect(Edge.TYPED_BY, pin, type_)


if __name__ == "__main__":
    for name in LIBRARIES:
        (FOLDER / f"{name}.uml").write_bytes(print_library(name))
