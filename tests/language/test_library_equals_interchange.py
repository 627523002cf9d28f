"""The library's text and its interchange files are one model: two notations, one tree.

The interchange files come with the standard and nobody here wrote them, so they are what the
parser is judged by: metaclass, names, owner, membership, facts, relationships, all in order.
"""

import os
from functools import cache
from pathlib import Path

import pytest

from sysmlc.diagnostics import Sink
from sysmlc.language.interchange import link, read
from sysmlc.language.text import parse
from sysmlc.sources import Source

pytestmark = pytest.mark.corpus

_FOLDER = Path(os.environ.get("SYSMLC_CORPUS", "nowhere")) / "sysml2"
_XMI = _FOLDER / "interchange" / "xmi"
_TEXT = _FOLDER / "omg-release" / "sysml.library"
FILES = sorted(path.relative_to(_XMI).as_posix() for path in _XMI.rglob("*.*mlx"))
_OURS = {"isPrefix"}
"""Facts that interchange files do not have."""


@cache
def interchanged():
    sink = Sink()
    read_in = [read(Source(name, (_XMI / name).read_bytes()), sink) for name in FILES]
    link(read_in, sink)
    return {document.path: document.root for document in read_in}


def written(name):
    path = next(_TEXT.rglob(Path(name).name.removesuffix("x")))
    language = path.suffix.removeprefix(".")
    sink = Sink()
    document = parse(path.read_text("utf-8"), path.name, language, sink)
    assert [found.message for found in sink] == []
    return document.root


def described(node):
    facts = {key: value for key, value in node.attributes.items() if key not in _OURS}
    return (
        node.kind,
        node.short_name,
        node.name,
        node.membership,
        node.role,
        node.visibility,
        dict(sorted(facts.items())),
        [(relation.kind, len(relation.reference.chain)) for relation in node.relations],
        [member.name for member in node.members],
    )


def last_names(node):
    return [[link[-1] for link in relation.reference.chain] for relation in node.relations]


def is_alias(name, other):
    """Whether names may differ: one is not in these files, has no name of its own, is an alias."""
    return name == other or "#" in other or (name, other) == ("AttributeValue", "DataValue")


def test_all_files_of_the_library_that_are_there_are_compared():
    if not FILES:
        pytest.skip("no corpus")
    assert len(FILES) == 34


@pytest.mark.parametrize("name", FILES)
def test_the_text_has_the_elements_of_the_interchange_file(name):
    text, xmi = written(name), interchanged()[name]
    pairs = list(zip(text.walk(), xmi.walk(), strict=True))
    assert [described(one) for one, _ in pairs] == [described(other) for _, other in pairs]


@pytest.mark.parametrize("name", FILES)
def test_the_text_refers_to_what_the_interchange_file_refers_to(name):
    text, xmi = written(name), interchanged()[name]
    wrong = []
    for one, other in zip(text.walk(), xmi.walk(), strict=True):
        for mine, theirs in zip(last_names(one), last_names(other), strict=True):
            if not all(map(is_alias, mine, theirs)):
                wrong.append((one, mine, theirs))
    assert wrong == []
