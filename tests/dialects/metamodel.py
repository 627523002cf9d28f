"""Check of documents against UML's own metamodel (uml.ecore), without any code of sysmlc."""

from collections.abc import Iterator
from pathlib import Path

from lxml import etree

from dialects.papyrus import XMI, Element, id_of, metaclass_of

_XSI_TYPE = "{http://www.w3.org/2001/XMLSchema-instance}type"


class Metamodel:
    """The metaclasses of uml.ecore with their general classes and features."""

    def __init__(self, ecore: Path) -> None:
        self._generals: dict[str, list[str]] = {}
        self._own_features: dict[str, dict[str, str]] = {}
        for classifier in etree.parse(ecore).getroot().iter("eClassifiers"):
            if classifier.get(_XSI_TYPE) == "ecore:EClass":
                name = str(classifier.get("name"))
                generals = classifier.get("eSuperTypes", "").split()
                self._generals[name] = [_last_segment(g) for g in generals if g.startswith("#")]
                self._own_features[name] = {
                    str(feature.get("name")): _last_segment(feature.get("eType", ""))
                    for feature in classifier.iter("eStructuralFeatures")
                }

    def find_violations(self, document: bytes) -> list[str]:
        """Return what the metamodel forbids: features, types of values, dangling references."""
        root = etree.fromstring(document)
        elements = {id_of(element): element for element in root.iter("*") if id_of(element)}
        return [
            violation
            for element in root.iter("*")
            if element.get(f"{{{XMI}}}type", "").startswith("uml:")
            for violation in self._check_element(element, elements)
        ]

    def _check_element(self, element: Element, elements: dict[str, Element]) -> Iterator[str]:
        metaclass = metaclass_of(element)
        if metaclass not in self._own_features:
            yield f"no metaclass {metaclass}"
            return
        features = self._collect_features(metaclass)
        for child in element:
            yield from self._check_value(metaclass, str(child.tag), child, features)
        for name, value in element.attrib.items():
            feature = str(name)
            if feature.startswith("{") or feature == "href":
                continue
            if features.get(feature) not in self._own_features:
                yield from self._check_value(metaclass, feature, None, features)
                continue
            for id_ in str(value).split():
                target = elements.get(id_)
                if target is None:
                    yield f"{metaclass}.{feature} names no element"
                yield from self._check_value(metaclass, feature, target, features)

    def _check_value(
        self, metaclass: str, name: str, value: Element | None, features: dict[str, str]
    ) -> Iterator[str]:
        if name == "eAnnotations":
            return
        feature_type = features.get(name)
        if feature_type is None:
            yield f"{metaclass} has no feature {name}"
        elif (
            value is not None
            and feature_type in self._own_features
            and not self._fits(value, feature_type)
        ):
            yield f"{metaclass}.{name} has the type {feature_type}, not {metaclass_of(value)}"

    def _fits(self, value: Element, feature_type: str) -> bool:
        is_untyped = value.get(f"{{{XMI}}}type") is None
        return is_untyped or self._specializes(metaclass_of(value), feature_type)

    def _collect_features(self, metaclass: str) -> dict[str, str]:
        features: dict[str, str] = {}
        for general in self._generals[metaclass]:
            features |= self._collect_features(general)
        return features | self._own_features[metaclass]

    def _specializes(self, metaclass: str, general: str) -> bool:
        generals = self._generals.get(metaclass, ())
        return metaclass == general or any(
            self._specializes(parent, general) for parent in generals
        )


def _last_segment(reference: str) -> str:
    return reference.rpartition("/")[2]
