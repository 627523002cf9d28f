"""One reference of each kind in a real file is led to nothing: every one of them is told.

The kinds are found by lxml and the UML Ecore, without the compiler. Stereotypes are left out:
an application without its element is told as such (SM113), tags that name nothing by SM118.
"""

import os
from pathlib import Path

import pytest
from lxml import etree
from references_of import attributes_of, content_of, elements_of, feature_of, reference_features

from sysmlc.diagnostics import Coverage, Sink
from sysmlc.frontends.xmi import FRONTEND
from sysmlc.ir import Graph
from sysmlc.passes import pipeline
from sysmlc.sources import Source

pytestmark = pytest.mark.corpus

SUFFIXES = {".uml", ".xmi", ".xml", ".mdxml"}
LARGE = 700_000
KINDS_IN_ALL = 300


def models() -> list[Path]:
    folder = Path(os.environ.get("SYSMLC_CORPUS", "nowhere")) / "xmi"
    found = sorted(path for path in folder.rglob("*") if path.suffix in SUFFIXES)
    return [path for path in found if path.stat().st_size < LARGE]


@pytest.fixture(scope="module")
def features(corpus):
    return reference_features(corpus / "xmi" / "metamodel" / "uml.ecore")


def spoilt(path, features):
    """The file with one reference of each kind led to nothing, and the kinds by the new targets."""
    root = etree.parse(path, etree.XMLParser(huge_tree=True)).getroot()
    elements = elements_of(root)
    kinds: dict[tuple[str, str, str], str] = {}
    for element in list(content_of(root)):
        if _is_of_tool(element, root):
            continue
        known = feature_of(element, elements)
        if known and not known[1].startswith("base_"):
            key = next(name for name in element.attrib if name.endswith("}idref"))
            _lead_astray(element, key, known, kinds, [])
        for feature, ids in attributes_of(element, root, elements, features):
            if ids and ids[0] in elements and not feature.startswith("base_"):
                kind = etree.QName(element).localname, feature, "attribute"
                _lead_astray(element, feature, kind, kinds, ids[1:])
    return etree.tostring(root), {target: kind for kind, target in kinds.items()}


def _is_of_tool(element, root):
    is_application = element.getparent() is root and "UML" not in str(element.tag)
    above = element if element.getparent() in (None, root) else element.getparent()
    is_tag = above.getparent() is root and "UML" not in str(above.tag)
    is_drawn = any(value.startswith("umldi:") for value in element.attrib.values())
    return is_application or is_tag or is_drawn


def _lead_astray(element, name, kind, kinds, others):
    if kind not in kinds:
        kinds[kind] = f"_nowhere{len(kinds):015d}"
        element.set(name, " ".join([kinds[kind], *others]))


@pytest.mark.parametrize("path", models(), ids=lambda path: path.name)
def test_a_reference_that_leads_nowhere_is_told_whatever_its_kind(path, features):
    data, kinds = spoilt(path, features)
    graph, sink = Graph(), Sink()
    FRONTEND.read([Source(path.name, data)], graph, sink, Coverage())
    pipeline.load("resolve").run(graph, sink)
    told = " ".join(found.message for found in sink)
    assert [kind for target, kind in kinds.items() if target not in told] == []


def test_kinds_are_many(features):
    assert sum(len(spoilt(path, features)[1]) for path in models()) > KINDS_IN_ALL
