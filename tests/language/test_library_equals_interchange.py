"""The text and the interchange files of the standard library are read to the same trees.

The standard publishes both notations independently of sysmlc, so each is an oracle for the reader
of the other: metaclass, names, owner, membership, attributes and relationships, all in order.
"""

from functools import cache
from pathlib import Path

import pytest
from official_models import LIBRARY_FOLDER, XMI_FILES, read_xmi_library

from sysmlc.diagnostics import Sink
from sysmlc.language.text import parse

pytestmark = pytest.mark.corpus

TEXT_ONLY = {"isPrefix"}
"""Attributes that interchange files do not have."""


@cache
def load_xmi_roots():
    return {document.path: document.root for document in read_xmi_library()}


def parse_library_text(name):
    """Return the root of the text of the interchange file *name*."""
    path = next(LIBRARY_FOLDER.rglob(Path(name).name.removesuffix("x")))
    sink = Sink()
    document = parse(path.read_text("utf-8"), path.name, path.suffix[1:], sink)
    assert [diagnostic.message for diagnostic in sink] == []
    return document.root


def describe(node):
    attributes = {key: value for key, value in node.attributes.items() if key not in TEXT_ONLY}
    return (
        node.kind,
        node.short_name,
        node.name,
        node.membership,
        node.role,
        node.visibility,
        dict(sorted(attributes.items())),
        [(relation.kind, len(relation.reference.chain)) for relation in node.relations],
        [member.name for member in node.members],
    )


def list_last_names(node):
    """Return the last name of each link of the references of an element."""
    return [[link[-1] for link in relation.reference.chain] for relation in node.relations]


def may_be_same(text_name, xmi_name):
    """Whether names agree, or cannot: a target in another file, without a name, or by an alias."""
    is_alias = (text_name, xmi_name) == ("AttributeValue", "DataValue")
    return text_name == xmi_name or "#" in xmi_name or is_alias


def test_the_34_interchange_files_are_compared():
    assert len(XMI_FILES) == 34


@pytest.mark.parametrize("name", XMI_FILES)
def test_the_text_has_the_elements_of_the_interchange_file(name):
    text, xmi = parse_library_text(name), load_xmi_roots()[name]
    assert [describe(node) for node in text.walk()] == [describe(node) for node in xmi.walk()]


@pytest.mark.parametrize("name", XMI_FILES)
def test_the_text_has_the_references_of_the_interchange_file(name):
    text, xmi = parse_library_text(name), load_xmi_roots()[name]
    different = []
    for text_node, xmi_node in zip(text.walk(), xmi.walk(), strict=True):
        references = zip(list_last_names(text_node), list_last_names(xmi_node), strict=True)
        for text_names, xmi_names in references:
            if not all(map(may_be_same, text_names, xmi_names)):
                different.append((text_node, text_names, xmi_names))
    assert different == []
