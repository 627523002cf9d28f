"""Every local reference that XMI files write, found without the compiler: by lxml and UML's Ecore.

A reference is an ``xmi:idref``, an id in an attribute that is a reference of the UML metamodel or
the base of a stereotype, or an id in any other attribute of a stereotype's application. What tools
keep in extensions and annotations is left out: it is theirs.
"""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from lxml import etree

_XSI = "{http://www.w3.org/2001/XMLSchema-instance}type"
_NOTED = ("Extension", "eAnnotations", "Documentation")


@dataclass(frozen=True, slots=True)
class Written:
    """A reference as a file writes it; ``holders`` are ids around it, the nearest first."""

    holders: tuple[str, ...]
    source: str
    feature: str
    target: str
    target_type: str


def reference_features(ecore: Path) -> frozenset[str]:
    """Features of UML that refer to elements, and are in no class an attribute with a value."""
    kinds: dict[str, set[str]] = {"ecore:EReference": set(), "ecore:EAttribute": set()}
    for feature in etree.parse(ecore).iter("eStructuralFeatures"):
        if feature.get("containment") != "true":
            kinds[str(feature.get(_XSI))].add(str(feature.get("name")))
    return frozenset(kinds["ecore:EReference"] - kinds["ecore:EAttribute"])


def written(data: bytes, features: frozenset[str]) -> Iterator[Written]:
    """All local references of a document; one without target has the empty ``target_type``."""
    root = etree.fromstring(data, etree.XMLParser(huge_tree=True, resolve_entities=False))
    elements = elements_of(root)
    for element in content_of(root):
        target = _xmi(element, "}idref")
        if target:
            yield _written(element.getparent(), _name(element), target, elements)
        for feature, ids in attributes_of(element, root, elements, features):
            for one in ids:
                yield _written(element, feature, one, elements)


def elements_of(root: etree._Element) -> dict[str, etree._Element]:
    """Every element that has an id, by that."""
    return {id: one for one in _elements(root) if (id := _xmi(one, "}id"))}


def feature_of(
    element: etree._Element, elements: Mapping[str, etree._Element]
) -> tuple[str, str, str] | None:
    """What a child that is a reference to one of the elements is: owner, feature, and so."""
    if _xmi(element, "}idref") not in elements:
        return None
    return _type(element.getparent()), _name(element), "child"


def attributes_of(
    element: etree._Element,
    root: etree._Element,
    elements: Mapping[str, etree._Element],
    features: frozenset[str],
) -> Iterator[tuple[str, list[str]]]:
    """Attributes of an element that are references, with the ids that they name."""
    is_application = element.getparent() is root and "UML" not in str(element.tag)
    for name, value in element.attrib.items():
        feature, text = str(name), str(value)
        ids = [text] if text in elements else text.split()
        is_reference = feature in features or feature.startswith("base_")
        if "}" in feature:
            continue
        if is_reference or (is_application and ids and all(one in elements for one in ids)):
            yield feature, ids


def _written(
    source: etree._Element, feature: str, target: str, elements: Mapping[str, etree._Element]
) -> Written:
    around = (source, *source.iterancestors())
    holders = tuple(id for one in around if (id := _xmi(one, "}id")))
    found = elements.get(target)
    return Written(holders, _type(source), feature, target, "" if found is None else _type(found))


def content_of(root: etree._Element) -> Iterable[etree._Element]:
    """The elements of the model, without what tools keep beside it."""
    noted: set[etree._Element] = set()
    for element in _elements(root):
        if element.getparent() in noted or _name(element) in _NOTED:
            noted.add(element)
        else:
            yield element


def _elements(root: etree._Element) -> Iterator[etree._Element]:
    return (element for element in root.iter() if isinstance(element.tag, str))


def _xmi(element: etree._Element, name: str) -> str:
    found = (v for k, v in element.attrib.items() if "/XMI" in str(k) and str(k).endswith(name))
    return next((str(value) for value in found), "")


def _type(element: etree._Element) -> str:
    return (_xmi(element, "}type") or _name(element)).rpartition(":")[2]


def _name(element: etree._Element) -> str:
    return etree.QName(element).localname
