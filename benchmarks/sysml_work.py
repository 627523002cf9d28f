"""What ``sysml.py`` measures, each in a process of its own: ``sysml_work.py WORK FOLDER``."""

import sys
from collections.abc import Iterator
from pathlib import Path

from work import Measured, Work, run

sys.path = [entry for entry in sys.path if entry != str(Path(__file__).parent)]
"""Without the folder of the benchmarks, in which ``sysml`` is the name of a script."""

_SUFFIXES = (".sysml", ".kerml")


def files(folder: Path) -> list[Path]:
    """The texts of a folder, in order."""
    return sorted(path for path in folder.rglob("*.*ml") if path.suffix in _SUFFIXES)


def _texts(folder: Path) -> Iterator[tuple[str, str, str]]:
    for path in files(folder):
        yield path.read_text("utf-8"), path.name, path.suffix.removeprefix(".")


def scan(folder: Path, *_arguments: str) -> tuple[Measured, int]:
    """The scanner alone: the least that any parser in Python needs."""
    from sysmlc.language.text import lalr
    from sysmlc.language.text.lexer import tokenize as tokens

    types = {name: lalr.load_tables(name).types for name in ("kerml", "sysml")}
    texts = list(_texts(folder))
    measured = Measured()
    for text, _, language in texts:
        tokens(text, types[language])
    measured.lap("scan")
    return measured, sum(len(text.encode()) for text, _, _ in texts)


def parse(folder: Path, *_arguments: str) -> tuple[Measured, int]:
    """Text to tree, the loading of the tables included."""
    from sysmlc.diagnostics import Sink
    from sysmlc.language.text import parse as tree

    texts, sink = list(_texts(folder)), Sink()
    measured = Measured()
    for text, name, language in texts:
        tree(text, name, language, sink)
    measured.lap("parse")
    assert not len(sink)
    return measured, sum(len(text.encode()) for text, _, _ in texts)


def resolve(folder: Path, *_arguments: str) -> tuple[Measured, int]:
    """Text to a tree whose names lead to elements."""
    from sysmlc.diagnostics import Sink
    from sysmlc.language.library import find_library
    from sysmlc.language.names import resolve as names
    from sysmlc.language.text import parse as tree

    texts, sink = list(_texts(folder)), Sink()
    measured = Measured()
    documents = [tree(text, name, language, sink) for text, name, language in texts]
    measured.lap("parse")
    names(documents, find_library(), sink)
    measured.lap("resolve")
    return measured, sum(len(text.encode()) for text, _, _ in texts)


def tree_sitter(folder: Path, *_arguments: str) -> tuple[Measured, int]:
    """tree-sitter-sysml: a parser in C for editors; no names, errors are nodes."""
    import tree_sitter_sysml
    from tree_sitter import Language, Parser

    parser = Parser(Language(tree_sitter_sysml.language()))
    texts = [text.encode() for text, _, _ in _texts(folder)]
    measured = Measured()
    broken = sum(parser.parse(text).root_node.has_error for text in texts)
    measured.lap(f"tree-sitter, {broken} of {len(texts)} files with errors")
    return measured, sum(map(len, texts))


def toolkit(folder: Path, *_arguments: str) -> tuple[Measured, int]:
    """The OpenMBEE toolkit (distribution ``sysml``): parsed and linked in Rust."""
    import sysml

    sources = {f"{number}-{name}": text for number, (text, name, _) in enumerate(_texts(folder))}
    library = sysml.standard_library()
    measured = Measured()
    sysml.Model.from_toolkit(sources=sources, library_dir=library)
    measured.lap("toolkit, its library included")
    return measured, sum(len(text.encode()) for text in sources.values())


WORKS: dict[str, Work] = {
    "scan": scan,
    "parse": parse,
    "resolve": resolve,
    "tree-sitter": tree_sitter,
    "toolkit": toolkit,
}

if __name__ == "__main__":
    sys.exit(run(WORKS))
