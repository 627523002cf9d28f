"""Texts that differ from a SysML v2 text in exactly one token, and what the compiler sees of it."""

import re
from collections import Counter
from collections.abc import Iterator, Mapping
from random import Random

from msgspec import Struct

from sysmlc.diagnostics import Coverage, Sink
from sysmlc.frontends.sysml import FRONTEND
from sysmlc.ir import Graph
from sysmlc.ir.compare import compare
from sysmlc.language.text.lexer import TOKEN
from sysmlc.passes import pipeline
from sysmlc.sources import Source

_SWAPPED = {
    "=": (":=",),
    ":=": ("=",),
    ":>": (":>>", "::>", ":"),
    ":>>": (":>",),
    ":": (":>",),
    "..": (",",),
    "<": ("<=", ">"),
    "<=": ("<",),
    ">": (">=", "<"),
    ">=": (">",),
    "+": ("-",),
    "-": ("+",),
    "*": ("**", "/", "1"),
    "/": ("*",),
    "**": ("*",),
    "==": ("!=",),
    "and": ("or",),
    "or": ("and",),
    "in": ("out", "inout"),
    "out": ("in", "inout"),
    "inout": ("in", "out"),
    "private": ("public", "protected"),
    "public": ("private",),
    "protected": ("private",),
    "default": ("default :",),
    "assert": ("assume", "require"),
    "assume": ("require",),
    "require": ("assume",),
    "entry": ("exit", "do"),
    "do": ("exit", "entry"),
    "exit": ("entry", "do"),
    "all": ("",),
    "true": ("false",),
    "false": ("true",),
    "part": ("item", "port", "attribute"),
    "item": ("part", "attribute"),
    "attribute": ("item", "ref"),
    "action": ("calc", "state"),
    "perform": ("include", "exhibit"),
    "satisfy": ("verify", "assert"),
    "verify": ("satisfy",),
    "connect": ("bind",),
    "bind": ("connect",),
    "flow": ("message",),
    "redefines": ("subsets",),
    "subsets": ("redefines",),
    "specializes": ("subsets",),
    "ordered": ("nonunique",),
    "snapshot": ("timeslice",),
    "timeslice": ("snapshot",),
    "derived": ("constant",),
    "when": ("after", "at"),
    "after": ("at", "when"),
    "at": ("after", "when"),
    "then": ("first",),
    "first": ("then",),
    "doc": ("comment",),
}
"""Keywords and symbols that another one may replace without an error of syntax."""
_PACKAGE = re.compile(r"^\s*(?:library )?package ('[^']*'|\w+)", re.MULTILINE)
_IMPORT = re.compile(r"\bimport (?:all )?('[^']*'|\w+)")
_WORD = re.compile(r"[^\W\d]\w*|'.*'", re.DOTALL)


class Mutation(Struct, frozen=True):
    """A change of one token: an empty ``after`` is a deletion."""

    path: str
    offset: int
    before: str
    after: str
    text: str

    @property
    def line(self) -> str:
        """Return the number and the text of the changed line, and what changed in it."""
        number = self.text.count("\n", 0, self.offset) + 1
        source = self.text.splitlines()[number - 1].strip() if self.text else ""
        return f"{self.path}:{number}: {self.before!r} -> {self.after!r} | {source}"


class View(Struct, frozen=True, eq=False):
    """What the compiler sees of a text: the graph, and how often it reports each finding."""

    graph: Graph
    findings: Counter[tuple[str, str]]


def look_at(path: str, text: str, imported: Mapping[str, str]) -> View:
    """Read a text and the texts that it imports as ``sysmlc diff`` does."""
    graph, sink = Graph(), Sink()
    sources = [Source(name, text.encode()) for name, text in (imported | {path: text}).items()]
    FRONTEND.read(sources, graph, sink, Coverage())
    pipeline.build_pipeline(("resolve",)).run(graph, sink)
    findings = Counter((finding.rule.code, finding.message) for finding in sink)
    return View(graph, findings)


def find_imported(path: str, texts: Mapping[str, str]) -> dict[str, str]:
    """Return the texts whose packages a text imports, directly or not."""
    packages = {name: path for path, text in texts.items() for name in _PACKAGE.findall(text)}
    imported, pending = {path: texts[path]}, [path]
    while pending:
        for name in _IMPORT.findall(texts[pending.pop()]):
            path = packages.get(name, path)
            if path not in imported:
                imported[path] = texts[path]
                pending.append(path)
    return imported


def is_noticed(before: View, after: View) -> bool:
    """Whether the second text has a new finding, or a difference from the first."""
    return bool(after.findings - before.findings) or bool(compare(before.graph, after.graph))


def draw_mutations(texts: Mapping[str, str], count: int, seed: int) -> list[Mutation]:
    """Draw mutations of random tokens, from texts in proportion to their length."""
    random = Random(seed)
    tokens = [(path, text, *token) for path, text in texts.items() for token in _iter_tokens(text)]
    mutations = []
    for path, text, start, end in random.choices(tokens, k=count):
        before = text[start:end]
        after = "" if random.random() < 0.5 else _change_token(before, random)
        changed = text[:start] + after + text[end:]
        mutations.append(Mutation(path, start, before, after, changed))
    return mutations


def _iter_tokens(text: str) -> Iterator[tuple[int, int]]:
    """Yield the offsets of each token; notes and blanks are none."""
    for match in TOKEN.finditer(text):
        if match.lastindex:
            yield match.span(match.lastindex)


def _change_token(token: str, random: Random) -> str:
    """Return another token of the same type; an empty text if there is none."""
    if token in _SWAPPED:
        return random.choice(_SWAPPED[token])
    if token.startswith("/*"):
        return token[:-2] + " not */"
    if token[0] in "\"'":
        return f"{token[:-1]}x{token[-1]}"
    if token[0].isdigit():
        return token + "1"
    return token + "x" if _WORD.fullmatch(token) else ""
