"""A reference that names nothing is reported, whatever its kind, in every real file.

The kinds are found by lxml and the Ecore of UML, without the compiler. Stereotypes have rules of
their own: SM113 for an application without its element, SM118 for a tag that names nothing.
"""

from pathlib import Path

import pytest
from lxml import etree
from reading_corpus import list_models, lower
from xmi_references import (
    classify_child,
    iter_attributes,
    iter_content,
    list_reference_features,
    map_elements,
)

from sysmlc.sources import Source

pytestmark = pytest.mark.corpus

LARGE = 700_000
KINDS_IN_ALL = 300


def list_small_models() -> list[Path]:
    return list_models("xmi", suffixes=(".uml", ".xmi", ".xml", ".mdxml"), largest=LARGE)


@pytest.fixture(scope="module")
def features(corpus):
    return list_reference_features(corpus / "xmi" / "metamodel" / "uml.ecore")


def break_references(path, features):
    """Break one reference of each kind; return the file, and the kinds by the new targets."""
    root = etree.parse(path, etree.XMLParser(huge_tree=True)).getroot()
    elements = map_elements(root)
    kinds: dict[tuple[str, str, str], str] = {}
    for element in list(iter_content(root)):
        if _is_of_tool(element, root):
            continue
        child_kind = classify_child(element, elements)
        if child_kind and not child_kind[1].startswith("base_"):
            key = next(name for name in element.attrib if name.endswith("}idref"))
            _break_reference(element, key, child_kind, kinds, [])
        for feature, ids in iter_attributes(element, root, elements, features):
            if ids and ids[0] in elements and not feature.startswith("base_"):
                kind = etree.QName(element).localname, feature, "attribute"
                _break_reference(element, feature, kind, kinds, ids[1:])
    return etree.tostring(root), {target: kind for kind, target in kinds.items()}


def _is_of_tool(element, root):
    is_application = element.getparent() is root and "UML" not in str(element.tag)
    holder = element if element.getparent() in (None, root) else element.getparent()
    is_tag = holder.getparent() is root and "UML" not in str(holder.tag)
    is_drawing = any(value.startswith("umldi:") for value in element.attrib.values())
    return is_application or is_tag or is_drawing


def _break_reference(element, name, kind, kinds, more_targets):
    if kind not in kinds:
        kinds[kind] = f"_nowhere{len(kinds):015d}"
        element.set(name, " ".join([kinds[kind], *more_targets]))


@pytest.mark.parametrize("path", list_small_models(), ids=lambda path: path.name)
def test_a_dangling_reference_of_each_kind_is_reported(path, features):
    data, kinds = break_references(path, features)
    _, sink = lower([Source(path.name, data)], ("resolve",))
    messages = " ".join(diagnostic.message for diagnostic in sink)
    assert [kind for target, kind in kinds.items() if target not in messages] == []


def test_the_corpus_has_many_kinds_of_references(features):
    assert (
        sum(len(break_references(path, features)[1]) for path in list_small_models()) > KINDS_IN_ALL
    )
