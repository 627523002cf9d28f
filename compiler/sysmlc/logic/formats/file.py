"""The file that a form is read from, and what says that a form has no words for something.

It needs nothing of what reads and writes: who only asks what forms there are does not import that.
"""

from bisect import bisect_right

from msgspec import Struct

from sysmlc.diagnostics import Place, Rule, Sink, Subject
from sysmlc.logic.contract import Conjunct
from sysmlc.logic.printing import print_formula


class NotExpressibleError(ValueError):
    """A contract that a form has no words for; ``conjunct`` is what it cannot say, if one is."""

    def __init__(self, form: str, reason: str, conjunct: Conjunct | None = None) -> None:
        self.form, self.reason, self.conjunct = form, reason, conjunct
        about = f"'{print_formula(conjunct.formula)}': " if conjunct else ""
        super().__init__(f"{form} cannot say {about}{reason}")


class File(Struct, frozen=True):
    """The text that is read, its name, and who hears what is wrong with it."""

    text: str
    path: str
    sink: Sink
    starts: tuple[int, ...]

    def position(self, at: int) -> tuple[int, int]:
        """Line and column of a character, from 1."""
        line = bisect_right(self.starts, at)
        return line, at - self.starts[line - 1] + 1

    def origin(self, at: int) -> str:
        """A place as conjuncts name what they come from: ``file:line:column``."""
        line, column = self.position(at)
        return f"{self.path}:{line}:{column}"

    def report(self, rule: Rule, at: int, **facts: str) -> None:
        """Report a rule about a character of the text."""
        line, column = self.position(at)
        place = Place(self.path, line=line, column=column)
        shown: dict[str, object] = {name: _printable(fact) for name, fact in facts.items()}
        self.sink.report(rule, Subject(place=place), notes=(), help="", **shown)


def opened(text: str, path: str, sink: Sink) -> File:
    """A text with the places where its lines begin."""
    starts = [0]
    starts.extend(at + 1 for at, char in enumerate(text) if char == "\n")
    return File(text, path, sink, tuple(starts))


def _printable(text: str) -> str:
    """The text without halves of characters, which no file can hold."""
    return text.encode("utf-8", "replace").decode("utf-8")
