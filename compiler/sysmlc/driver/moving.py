"""An outcome for texts that say the same as before, with their words at other places."""

import re
from bisect import bisect_right
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from json.encoder import encode_basestring

from sysmlc.diagnostics import Diagnostic, Place
from sysmlc.diagnostics.locate import line_starts
from sysmlc.diagnostics.render import Finding, make_report
from sysmlc.driver.outcome import Outcome, OutputFile, Packed, Withheld, digest_of
from sysmlc.driver.tracing import TRACE
from sysmlc.frontends.base import Worded
from sysmlc.sources import Source
from sysmlc.values import replace


class LostError(Exception):
    """A place stands between words, so that nobody knows where it went."""


class Move:
    """Where the places of one text went."""

    def __init__(self, frontend: Worded, old: Source, new: Source) -> None:
        self._old, self._new = _Text(old, frontend.words(old)), _Text(new, frontend.words(new))
        self._starts = [start for start, _ in self._old.words]

    def byte(self, at: int) -> int:
        """Where a byte went; -1 stays -1. Raises LostError."""
        return self._new.byte(self.character(self._old.character(at))) if at >= 0 else at

    def line(self, line: int, column: int) -> tuple[int, int]:
        """Line and column, in characters from 1, to which a character went. Raises LostError."""
        at = self.character(self._old.lines[line - 1] + column - 1)
        moved = bisect_right(self._new.lines, at)
        return moved, at - self._new.lines[moved - 1] + 1

    def character(self, at: int) -> int:
        """Where a character went. Raises LostError.

        The start of a text stands for all of it, unless a word begins there.
        """
        first = self._old.words[0][0], self._new.words[0][0]
        if at == 0 and first != (0, 0):
            if first[0] == 0:
                raise LostError
            return 0
        index = bisect_right(self._starts, at) - 1
        if index < 0 or at > self._old.words[index][1]:
            raise LostError
        (start, end), (new, new_end) = self._old.words[index], self._new.words[index]
        if at > start and new_end - new != end - start:
            raise LostError
        return new + at - start


class _Text:
    """A text in UTF-8, its words and lines; places are bytes of the file or characters."""

    def __init__(self, source: Source, words: Sequence[tuple[int, int]]) -> None:
        self.words = words
        self._data = source.data
        self._text = source.data.decode("utf-8-sig")
        self._mark = len(source.data) - len(self._text.encode())
        self._is_plain = self._text.isascii()

    @cached_property
    def lines(self) -> list[int]:
        """The characters at which lines start."""
        return line_starts(self._text)

    def character(self, at: int) -> int:
        """The character at a byte; the mark before the text counts as its first."""
        if self._is_plain:
            return max(at - self._mark, 0)
        return len(self._data[self._mark : at].decode("utf-8", "replace"))

    def byte(self, at: int) -> int:
        """The byte at which a character starts."""
        return self._mark + (at if self._is_plain else len(self._text[:at].encode()))


def moved(
    kept: Outcome, moves: Mapping[str, Move], sources: Sequence[Source], stale: Mapping[str, str]
) -> Outcome:
    """The outcome with places moved by file; ``sources`` are those files as they are now.

    ``stale`` has the digest that each of them had, which outputs may state. Raises LostError.
    """
    digests = {stale[source.name]: source.sha256 for source in sources}
    texts = Texts(kept.texts, dict(_texts(kept, moves, digests)))
    return replace(
        kept,
        inputs=tuple(
            replace(one, sha256=digests[one.sha256]) if one.path in moves else one
            for one in kept.inputs
        ),
        findings=tuple(_findings(kept.findings, moves, sources)),
        files=tuple(_file(file, texts) for file in kept.files),
        texts=texts,
        withheld=tuple(
            Withheld(one.path, tuple(_diagnostic(error, moves) for error in one.because))
            for one in kept.withheld
        ),
    )


class Texts(Packed):
    """Texts of which some are new; the others are unpacked when they are asked for."""

    def __init__(self, old: Mapping[str, str], new: dict[str, str]) -> None:
        self.new = new
        self._old = old

    def __getitem__(self, path: str) -> str:
        return self.new[path] if path in self.new else self._old[path]

    def packed(self, path: str) -> memoryview | None:
        """The text at the path as it was kept, if it is an old one."""
        if path in self.new or not isinstance(self._old, Packed):
            return None
        return self._old.packed(path)

    def __contains__(self, path: object) -> bool:
        return path in self.new or path in self._old

    def __iter__(self) -> Iterator[str]:
        return iter(self._old)

    def __len__(self) -> int:
        return len(self._old)


# -- findings ----------------------------------------------------------------------------------


def _findings(
    found: Sequence[Finding], moves: Mapping[str, Move], sources: Sequence[Source]
) -> Iterator[Finding]:
    told = [_diagnostic(one.diagnostic, moves) for one in found]
    is_moved = [new is not one.diagnostic for one, new in zip(found, told, strict=True)]
    chosen = [new for new, is_new in zip(told, is_moved, strict=True) if is_new]
    located = iter(make_report(chosen, sources).findings)
    for one, is_new in zip(found, is_moved, strict=True):
        yield next(located) if is_new else one


def _diagnostic(found: Diagnostic, moves: Mapping[str, Move]) -> Diagnostic:
    place = found.subject.place
    move = moves.get(place.file) if place else None
    if place is None or move is None:
        return found
    if place.line:
        raise LostError
    new = Place(place.file, move.byte(place.ordinal), move.byte(place.offset))
    return replace(found, subject=replace(found.subject, place=new))


# -- texts -------------------------------------------------------------------------------------

NAMING = frozenset({"recipe"})
"""Back ends whose files state the digests of the inputs."""


def _texts(
    kept: Outcome, moves: Mapping[str, Move], digests: Mapping[str, str]
) -> Iterator[tuple[str, str]]:
    for file in kept.files:
        if file.path == TRACE:
            yield file.path, _trace(kept.texts[TRACE], moves)
        elif file.backend in NAMING:
            yield file.path, _restated(kept.texts[file.path], digests)


def _restated(text: str, digests: Mapping[str, str]) -> str:
    for old, new in digests.items():
        text = text.replace(old, new)
    return text


def _trace(text: str, moves: Mapping[str, Move]) -> str:
    """``trace.json`` with its lines and columns moved."""
    names = {encode_basestring(name): move for name, move in moves.items()}
    every = "|".join(map(re.escape, names))
    place = re.compile(rf'"file": ({every}),\n(    "line": )(\d+)(,\n    "column": )(\d+)')

    def new(found: re.Match[str]) -> str:
        line, column = names[found[1]].line(int(found[3]), int(found[5]))
        return f'"file": {found[1]},\n{found[2]}{line}{found[4]}{column}'

    return place.sub(new, text)


def _file(file: OutputFile, texts: Texts) -> OutputFile:
    text = texts.new.get(file.path)
    return file if text is None else replace(file, sha256=digest_of(text))
