"""The local references of XMI files, found by lxml and the Ecore of UML, without the compiler.

A reference is an ``xmi:idref``, an id in an attribute that is a reference of the UML metamodel or
the base of a stereotype, or an id in any other attribute of a stereotype's application. Extensions
and annotations hold data of tools and are skipped.
"""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from lxml import etree
from reading_corpus import local_name, parse_data

_XSI = "{http://www.w3.org/2001/XMLSchema-instance}type"
_TOOL_TAGS = ("Extension", "eAnnotations", "Documentation")


@dataclass(frozen=True, slots=True)
class Reference:
    """A reference in a file; ``holders`` are the ids of the elements around it, innermost first."""

    holders: tuple[str, ...]
    source: str
    feature: str
    target: str
    target_type: str


def list_reference_features(ecore: Path) -> frozenset[str]:
    """Return the features of UML that are references in all classes, and never attributes."""
    kinds: dict[str, set[str]] = {"ecore:EReference": set(), "ecore:EAttribute": set()}
    for feature in etree.parse(ecore).iter("eStructuralFeatures"):
        if feature.get("containment") != "true":
            kinds[str(feature.get(_XSI))].add(str(feature.get("name")))
    return frozenset(kinds["ecore:EReference"] - kinds["ecore:EAttribute"])


def iter_references(data: bytes, features: frozenset[str]) -> Iterator[Reference]:
    """Yield the local references of a document; the ``target_type`` of dangling ones is empty."""
    root = parse_data(data)
    elements = map_elements(root)
    for element in iter_content(root):
        target = _xmi_attribute(element, "}idref")
        if target:
            yield _make_reference(element.getparent(), local_name(element), target, elements)
        for feature, ids in iter_attributes(element, root, elements, features):
            for id in ids:
                yield _make_reference(element, feature, id, elements)


def map_elements(root: etree._Element) -> dict[str, etree._Element]:
    """Map ids to elements."""
    return {
        id: element for element in _iter_elements(root) if (id := _xmi_attribute(element, "}id"))
    }


def classify_child(
    element: etree._Element, elements: Mapping[str, etree._Element]
) -> tuple[str, str, str] | None:
    """Return owner's type, feature and "child" if *element* refers to one of *elements*."""
    if _xmi_attribute(element, "}idref") not in elements:
        return None
    return _type_of(element.getparent()), local_name(element), "child"


def iter_attributes(
    element: etree._Element,
    root: etree._Element,
    elements: Mapping[str, etree._Element],
    features: frozenset[str],
) -> Iterator[tuple[str, list[str]]]:
    """Yield the attributes of an element that are references, with the ids that they contain."""
    is_application = element.getparent() is root and "UML" not in str(element.tag)
    for name, value in element.attrib.items():
        feature, text = str(name), str(value)
        ids = [text] if text in elements else text.split()
        is_reference = feature in features or feature.startswith("base_")
        if "}" in feature:
            continue
        if is_reference or (is_application and ids and all(id in elements for id in ids)):
            yield feature, ids


def _make_reference(
    source: etree._Element, feature: str, target: str, elements: Mapping[str, etree._Element]
) -> Reference:
    elements_around = (source, *source.iterancestors())
    holders = tuple(id for holder in elements_around if (id := _xmi_attribute(holder, "}id")))
    target_element = elements.get(target)
    return Reference(
        holders,
        _type_of(source),
        feature,
        target,
        "" if target_element is None else _type_of(target_element),
    )


def iter_content(root: etree._Element) -> Iterable[etree._Element]:
    """Yield the elements of the model, without the data of tools."""
    tool_data: set[etree._Element] = set()
    for element in _iter_elements(root):
        if element.getparent() in tool_data or local_name(element) in _TOOL_TAGS:
            tool_data.add(element)
        else:
            yield element


def _iter_elements(root: etree._Element) -> Iterator[etree._Element]:
    return (element for element in root.iter() if isinstance(element.tag, str))


def _xmi_attribute(element: etree._Element, name: str) -> str:
    values = (
        value
        for key, value in element.attrib.items()
        if "/XMI" in str(key) and str(key).endswith(name)
    )
    return next((str(value) for value in values), "")


def _type_of(element: etree._Element) -> str:
    return (_xmi_attribute(element, "}type") or local_name(element)).rpartition(":")[2]
