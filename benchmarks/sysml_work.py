"""The works that ``sysml.py`` measures: ``python sysml_work.py WORK FOLDER``."""

import gc
import sys
from pathlib import Path
from typing import NamedTuple

from work import Measurement, Work, run_work

# The script `sysml.py` in this folder would hide the package `sysml` of the toolkit.
sys.path = [entry for entry in sys.path if entry != str(Path(__file__).parent)]

_NEW_OBJECTS = 200_000
"""New objects between two collections of the command ``sysmlc``."""
_SUFFIXES = (".sysml", ".kerml")


class _Text(NamedTuple):
    """The content of a file and its name, with the language that the suffix of the name gives."""

    content: str
    name: str
    language: str


def _read_texts(folder: Path) -> list[_Text]:
    """Return the texts of a folder, sorted by path."""
    paths = sorted(path for path in folder.rglob("*.*ml") if path.suffix in _SUFFIXES)
    return [_Text(path.read_text("utf-8"), path.name, path.suffix[1:]) for path in paths]


def _count_bytes(texts: list[_Text]) -> int:
    return sum(len(text.content.encode()) for text in texts)


def scan_texts(folder: Path, *_arguments: str) -> tuple[Measurement, int]:
    """Split the texts into tokens; every parser in Python takes at least as long."""
    from sysmlc.language.text import lalr
    from sysmlc.language.text.lexer import tokenize

    types = {name: lalr.load_tables(name).types for name in ("kerml", "sysml")}
    texts = _read_texts(folder)
    measurement = Measurement()
    for text in texts:
        tokenize(text.content, types[text.language])
    measurement.end_lap("scan")
    return measurement, _count_bytes(texts)


def parse_texts(folder: Path, *_arguments: str) -> tuple[Measurement, int]:
    """Parse the texts to trees; the grammar tables are loaded within the measurement."""
    from sysmlc.diagnostics import Sink
    from sysmlc.language.text import parse

    texts, sink = _read_texts(folder), Sink()
    measurement = Measurement()
    for text in texts:
        parse(*text, sink)
    measurement.end_lap("parse")
    assert not len(sink)
    return measurement, _count_bytes(texts)


def resolve_texts(folder: Path, *_arguments: str) -> tuple[Measurement, int]:
    """Parse the texts and resolve their names in a process that has parsed the library files.

    A process that stays alive, such as ``sysmlc watch``, parses each library file once.
    """
    texts = _read_texts(folder)
    # This resolution parses the library files that the texts import; its measurement is dropped.
    _resolve(texts)
    # The compiler, too, freezes what it has read, so that no later collection visits it.
    gc.collect()
    gc.freeze()
    return _resolve(texts), _count_bytes(texts)


def resolve_on_demand(folder: Path, *_arguments: str) -> tuple[Measurement, int]:
    """Parse the texts and resolve their names in a new process, which parses library files, too."""
    texts = _read_texts(folder)
    return _resolve(texts), _count_bytes(texts)


def _resolve(texts: list[_Text]) -> Measurement:
    """Parse the texts and resolve their names; return the measurement of both."""
    from sysmlc.diagnostics import Sink
    from sysmlc.language.library import find_library
    from sysmlc.language.names import resolve
    from sysmlc.language.text import parse

    sink = Sink()
    measurement = Measurement()
    documents = [parse(*text, sink) for text in texts]
    measurement.end_lap("parse")
    # Every call within a process returns the same library, with the files that are parsed.
    resolve(documents, find_library(), sink)
    measurement.end_lap("resolve")
    return measurement


def parse_with_tree_sitter(folder: Path, *_arguments: str) -> tuple[Measurement, int]:
    """Parse with tree-sitter-sysml, a parser in C for editors. It does not resolve names."""
    import tree_sitter_sysml
    from tree_sitter import Language, Parser

    parser = Parser(Language(tree_sitter_sysml.language()))
    texts = [text.content.encode() for text in _read_texts(folder)]
    measurement = Measurement()
    broken = sum(parser.parse(text).root_node.has_error for text in texts)
    measurement.end_lap(f"tree-sitter, {broken} of {len(texts)} files with errors")
    return measurement, sum(map(len, texts))


def link_with_toolkit(folder: Path, *_arguments: str) -> tuple[Measurement, int]:
    """Parse and link with the OpenMBEE toolkit (distribution ``sysml``), which is in Rust."""
    import sysml

    texts = _read_texts(folder)
    sources = {f"{number}-{text.name}": text.content for number, text in enumerate(texts)}
    library = sysml.standard_library()
    measurement = Measurement()
    sysml.Model.from_toolkit(sources=sources, library_dir=library)
    measurement.end_lap("toolkit with its library")
    return measurement, _count_bytes(texts)


def check_by_pass(folder: Path, *_arguments: str) -> tuple[Measurement, int]:
    """Compile a folder without back ends, like ``sysmlc check``, with a lap for each pass."""
    from sysmlc.driver.compilation import Observer, Request, compile_model
    from sysmlc.ir import Graph

    gc.set_threshold(_NEW_OBJECTS)
    measurement = Measurement()

    class Laps(Observer):
        def after(self, what: str, graph: Graph) -> None:
            measurement.end_lap(what)

    compile_model(Request((folder,)), Laps())
    measurement.end_lap("end")
    return measurement, _count_bytes(_read_texts(folder))


WORKS: dict[str, Work] = {
    "scan": scan_texts,
    "parse": parse_texts,
    "check-by-pass": check_by_pass,
    "resolve": resolve_texts,
    "resolve-on-demand": resolve_on_demand,
    "tree-sitter": parse_with_tree_sitter,
    "toolkit": link_with_toolkit,
}

if __name__ == "__main__":
    sys.exit(run_work(WORKS))
