"""Writes the libraries of actions for SysML v1 anew: ``python tests/passes/library_v1.py``.

SysML v1 has no subjects and no assumptions: what a requirement is about satisfies it, and an
assumption says so in its language. Actions are abstract: only those of a model have contracts.
"""

import re
import tempfile
from pathlib import Path

from sysmlc.driver import Request, compile_model, select_backends
from sysmlc.ir import Edge, Graph, Kind, parse_text, print_text, query
from sysmlc.ir.element import Element

FOLDER = Path(__file__).parents[2] / "metamodels"
LIBRARIES = ("DIN8580", "LineMachines")


def library(name: str) -> bytes:
    """A library of ``metamodels`` as XMI."""
    text = (FOLDER / f"{name}.sysml").read_text(encoding="utf-8")
    # Under its own name the text would be the library that comes with the compiler.
    text = re.sub(rf"library package {name}\b", "package Library", text)
    text = text.replace(f"{name}::", "Library::")
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / f"{name}.sysml").write_text(text, encoding="utf-8")
        graph = parse_text(_emitted(Path(folder), f"{name}.sysml", "ir", "graph.ir").decode())
        for element in list(graph):
            _for_v1(graph, element, name)
        (Path(folder) / f"{name}.ir").write_text(print_text(graph), encoding="utf-8")
        return _emitted(Path(folder), f"{name}.ir", "uml", f"uml/{name}.uml")


def _emitted(folder: Path, model: str, backend: str, file: str) -> bytes:
    made = compile_model(Request((folder / model,), backends=tuple(select_backends([backend]))))
    return next(one.text for one in made.list_published() if one.path == file).encode()


def _for_v1(graph: Graph, element: Element, name: str) -> None:
    if element.name == "Library":
        graph.rename(element, name)
    if element.kind is Kind.ACTIVITY or element.attrs.get("role") == "block":
        graph.set(element, abstract=True)
    if element.kind is Kind.ACTION:
        _add_pins(graph, element)
    for subject in graph.targets(element, Edge.SUBJECT):
        graph.disconnect(Edge.SUBJECT, element, subject)
        graph.connect(Edge.SATISFIES, subject, element)
    for assumed in graph.targets(element, Edge.ASSUMES):
        graph.set(assumed, language="LTL assume")
        graph.disconnect(Edge.ASSUMES, element, assumed)


def _add_pins(graph: Graph, action: Element) -> None:
    """A pin for each parameter of what is called: the notation of SysML v2 does without."""
    called = graph.target(action, Edge.CALLS)
    for parameter in query.parameters(graph, called) if called is not None else ():
        direction = query.direction_of(parameter)
        made = Element(f"{action.id}.{parameter.name}", Kind.PIN, parameter.name, action.id)
        made.attrs["direction"] = direction
        made.attrs["subkind"] = "argument" if direction == "in" else "result"
        graph.add(made)
        type_ = graph.target(parameter, Edge.TYPED_BY)
        if type_ is not None:
            graph.connect(Edge.TYPED_BY, made, type_)


if __name__ == "__main__":
    for one in LIBRARIES:
        (FOLDER / f"{one}.uml").write_bytes(library(one))
