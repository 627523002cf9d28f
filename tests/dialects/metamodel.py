"""Checks documents against UML's own metamodel (uml.ecore), without any code of sysmlc."""

from collections.abc import Iterator
from pathlib import Path

from lxml import etree

from dialects.papyrus import XMI, Element, id_of, metaclass_of

_XSI_TYPE = "{http://www.w3.org/2001/XMLSchema-instance}type"


class Metamodel:
    """Metaclasses with their generals and features, as uml.ecore lists them."""

    def __init__(self, ecore: Path) -> None:
        self._generals: dict[str, list[str]] = {}
        self._own: dict[str, dict[str, str]] = {}
        for found in etree.parse(ecore).getroot().iter("eClassifiers"):
            if found.get(_XSI_TYPE) == "ecore:EClass":
                name = str(found.get("name"))
                generals = found.get("eSuperTypes", "").split()
                self._generals[name] = [_last(g) for g in generals if g.startswith("#")]
                self._own[name] = {
                    str(feature.get("name")): _last(feature.get("eType", ""))
                    for feature in found.iter("eStructuralFeatures")
                }

    def complaints(self, document: bytes) -> list[str]:
        """What the metamodel does not allow: features, types of values, dangling references."""
        root = etree.fromstring(document)
        known = {id_of(element): element for element in root.iter("*") if id_of(element)}
        return [
            complaint
            for element in root.iter("*")
            if element.get(f"{{{XMI}}}type", "").startswith("uml:")
            for complaint in self._of_element(element, known)
        ]

    def _of_element(self, element: Element, known: dict[str, Element]) -> Iterator[str]:
        metaclass = metaclass_of(element)
        if metaclass not in self._own:
            yield f"no metaclass {metaclass}"
            return
        features = self._features(metaclass)
        for child in element:
            yield from self._of_value(metaclass, str(child.tag), child, features)
        for name, value in element.attrib.items():
            if not str(name).startswith("{") and name != "href":
                for word in str(value).split() if features.get(str(name)) in self._own else [""]:
                    target = known.get(word)
                    if word and target is None:
                        yield f"{metaclass}.{name} leads nowhere"
                    yield from self._of_value(metaclass, str(name), target, features)

    def _of_value(
        self, metaclass: str, name: str, value: Element | None, features: dict[str, str]
    ) -> Iterator[str]:
        if name == "eAnnotations":
            return
        wanted = features.get(name)
        if wanted is None:
            yield f"{metaclass} has no feature {name}"
        elif value is not None and wanted in self._own and not self._fits(value, wanted):
            yield f"{metaclass}.{name} wants {wanted}, not {metaclass_of(value)}"

    def _fits(self, value: Element, wanted: str) -> bool:
        untyped = value.get(f"{{{XMI}}}type") is None
        return untyped or self._is(metaclass_of(value), wanted)

    def _features(self, metaclass: str) -> dict[str, str]:
        inherited: dict[str, str] = {}
        for general in self._generals[metaclass]:
            inherited |= self._features(general)
        return inherited | self._own[metaclass]

    def _is(self, metaclass: str, general: str) -> bool:
        above = self._generals.get(metaclass, ())
        return metaclass == general or any(self._is(one, general) for one in above)


def _last(reference: str) -> str:
    return reference.rpartition("/")[2]
