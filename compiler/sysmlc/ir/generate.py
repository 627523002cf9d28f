"""Generate ``kinds.py`` from ``metamodels/ir.ecore``: ``python -m sysmlc.ir.generate``."""

import re
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

from pyecore.ecore import EModelElement
from pyecore.resources import ResourceSet

from sysmlc.support import resources

_HEAD = '''"""Kinds of elements and of edges.

Generated from metamodels/ir.ecore by ``python -m sysmlc.ir.generate``; do not edit.
"""

from enum import StrEnum
'''


def generate() -> str:
    """Return the text of ``kinds.py`` for the current metamodel."""
    metamodel = ResourceSet().get_resource(str(resources.path("metamodels", "ir.ecore")))
    package = metamodel.contents[0]
    base = package.getEClassifier("Element")
    classes = [c for c in package.eClassifiers if base in c.eSuperTypes]
    edges = [r for r in base.eReferences if r.name != "attrs"]
    kinds = _enumeration_lines(
        "Kind", "Kind of an element, in the words of the standards.", classes, str
    )
    return "\n".join(
        [_HEAD, *kinds, "", *_enumeration_lines("Edge", "Kind of an edge.", edges, _hyphenate), ""]
    )


def _enumeration_lines(
    name: str, doc: str, members: Iterable[EModelElement], spell: Callable[[str], str]
) -> Iterator[str]:
    yield f"\nclass {name}(StrEnum):"
    yield f'    """{doc}"""\n'
    for member in members:
        value = spell(member.name)
        yield from _comment_lines(_read_documentation(member))
        yield f'    {_make_identifier(value)} = "{value}"'


def _read_documentation(member: EModelElement) -> str:
    return str(member.eAnnotations[0].details["documentation"])


def _comment_lines(text: str) -> Iterator[str]:
    line = "    #"
    for word in text.split():
        if len(line) + len(word) > 98:
            yield line
            line = "    #"
        line += f" {word}"
    yield line


def _hyphenate(name: str) -> str:
    return re.sub(r"([A-Z])", lambda m: "-" + m[1].lower(), name)


def _make_identifier(value: str) -> str:
    return re.sub(r"(?<=[a-z])([A-Z])", r"_\1", value).replace("-", "_").upper()


def main() -> None:
    """Write ``kinds.py`` beside this module."""
    target = Path(__file__).with_name("kinds.py")
    target.write_text(generate(), encoding="utf-8")
    print(f"wrote {target.name}")


if __name__ == "__main__":
    main()
