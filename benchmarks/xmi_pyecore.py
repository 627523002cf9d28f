"""Loads a UML model with pyecore, the Python library nearest to Eclipse's own reader.

pyecore does not load UML models as it comes; four things are patched here: the operations of
the metamodel hide its features, its types stay proxies, derived features refuse values, and
packages of profiles are unknown.
"""

import tempfile
from pathlib import Path

from lxml import etree
from pyecore import ecore
from pyecore.resources import URI, ResourceSet

_XSI = "{http://www.w3.org/2001/XMLSchema-instance}"
_TYPES = {
    "Boolean": "EBoolean",
    "Integer": "EInt",
    "Real": "EDouble",
    "String": "EString",
    "UnlimitedNatural": "EString",
}
_ECORE = "http://www.eclipse.org/emf/2002/Ecore#//"
_FLAGS = ("derived", "changeable", "volatile", "transient", "unsettable")


def prepare(model: Path, metamodel: Path) -> ResourceSet:
    """Read the metamodel and make the packages that the model needs."""
    resources = ResourceSet()
    _register(resources, _metamodel(resources, metamodel), model)
    return resources


def load(resources: ResourceSet, model: Path) -> int:
    """Load the model; return the number of its elements."""
    resource = resources.get_resource(URI(str(model)))
    return sum(1 for root in resource.contents for _ in (root, *root.eAllContents()))


def _metamodel(resources: ResourceSet, metamodel: Path) -> ecore.EPackage:
    tree = etree.parse(str(metamodel))
    for operation in list(tree.iter("eOperations", "eAnnotations")):
        operation.getparent().remove(operation)
    for feature in tree.iter("eStructuralFeatures"):
        for flag in _FLAGS:
            feature.attrib.pop(flag, None)
        type_ = feature.get("eType", "")
        name = type_.rpartition("#//")[2]
        if "ecore.ecore#" in type_:
            feature.set("eType", f"ecore:EClass {_ECORE}{name}")
        elif "types.ecore" in type_ and name in _TYPES:
            feature.set("eType", f"ecore:EDataType {_ECORE}{_TYPES[name]}")
    for one in tree.iter("eClassifiers"):
        above = one.get("eSuperTypes", "")
        if "ecore.ecore" in above:
            kept = [e for e in above.split() if e.startswith("#")]
            one.set("eSuperTypes", " ".join(kept))
    with tempfile.TemporaryDirectory() as folder:
        patched = Path(folder) / "uml.ecore"
        tree.write(str(patched))
        package = resources.get_resource(URI(str(patched))).contents[0]
    assert isinstance(package, ecore.EPackage)
    return package


def _register(resources: ResourceSet, uml: ecore.EPackage, model: Path) -> None:
    """Make the packages that the model names: UML under its version, and its profiles."""
    root = etree.parse(str(model)).getroot()
    for uri in root.nsmap.values():
        if "/UML" in uri and "uml2" in uri:
            resources.metamodel_registry[uri] = uml
    for application in root:
        name = etree.QName(application)
        if name.namespace not in resources.metamodel_registry:
            made = ecore.EPackage(name.namespace.rpartition("/")[2], name.namespace, "p")
            resources.metamodel_registry[name.namespace] = made
        _stereotype(resources.metamodel_registry[name.namespace], uml, application)


def _stereotype(
    package: ecore.EPackage, uml: ecore.EPackage, application: "etree._Element"
) -> None:
    name = etree.QName(application).localname
    if package is uml:
        return
    known = package.getEClassifier(name)
    if known is None:
        known = ecore.EClass(name)
        package.eClassifiers.append(known)
    for attribute in application.attrib:
        local = str(attribute)
        if "}" in local or known.findEStructuralFeature(local) is not None:
            continue
        if local.startswith("base_") or local == "propertyPath":
            target = uml.getEClassifier(local[5:]) or uml.getEClassifier("Element")
            many = -1 if local == "propertyPath" else 1
            known.eStructuralFeatures.append(ecore.EReference(local, target, upper=many))
        else:
            known.eStructuralFeatures.append(ecore.EAttribute(local, ecore.EString))
