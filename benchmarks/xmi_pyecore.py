"""Loading of UML models with pyecore, the Python library nearest to Eclipse's own reader.

pyecore alone cannot load a UML model, for four reasons that this module works around: operations of
the metamodel hide features of the same name, references to types remain proxies, derived features
refuse values, and the packages of profiles are unknown.
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


def prepare_resources(model: Path, metamodel: Path) -> ResourceSet:
    """Return resources with the metamodel and the packages that the model refers to."""
    resources = ResourceSet()
    _register_packages(resources, _load_metamodel(resources, metamodel), model)
    return resources


def load_model(resources: ResourceSet, model: Path) -> int:
    """Load the model; return the number of its elements."""
    resource = resources.get_resource(URI(str(model)))
    return sum(1 for root in resource.contents for _ in (root, *root.eAllContents()))


def _load_metamodel(resources: ResourceSet, metamodel: Path) -> ecore.EPackage:
    """Load a copy of the metamodel without operations, derived features and foreign types."""
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
    for classifier in tree.iter("eClassifiers"):
        supertypes = classifier.get("eSuperTypes", "")
        if "ecore.ecore" in supertypes:
            local_supertypes = [type_ for type_ in supertypes.split() if type_.startswith("#")]
            classifier.set("eSuperTypes", " ".join(local_supertypes))
    with tempfile.TemporaryDirectory() as folder:
        patched = Path(folder) / "uml.ecore"
        tree.write(str(patched))
        package = resources.get_resource(URI(str(patched))).contents[0]
    assert isinstance(package, ecore.EPackage)
    return package


def _register_packages(resources: ResourceSet, uml: ecore.EPackage, model: Path) -> None:
    """Register UML under the version that the model names, and packages of its profiles."""
    root = etree.parse(str(model)).getroot()
    for uri in root.nsmap.values():
        if "/UML" in uri and "uml2" in uri:
            resources.metamodel_registry[uri] = uml
    for application in root:
        name = etree.QName(application)
        if name.namespace not in resources.metamodel_registry:
            profile = ecore.EPackage(name.namespace.rpartition("/")[2], name.namespace, "p")
            resources.metamodel_registry[name.namespace] = profile
        _define_stereotype(resources.metamodel_registry[name.namespace], uml, application)


def _define_stereotype(
    package: ecore.EPackage, uml: ecore.EPackage, application: "etree._Element"
) -> None:
    """Add the class of a stereotype application to its package, with the features that it uses."""
    name = etree.QName(application).localname
    if package is uml:
        return
    stereotype = package.getEClassifier(name)
    if stereotype is None:
        stereotype = ecore.EClass(name)
        package.eClassifiers.append(stereotype)
    for attribute in application.attrib:
        feature = str(attribute)
        if "}" in feature or stereotype.findEStructuralFeature(feature) is not None:
            continue
        if feature.startswith("base_") or feature == "propertyPath":
            target = uml.getEClassifier(feature[5:]) or uml.getEClassifier("Element")
            upper_bound = -1 if feature == "propertyPath" else 1
            reference = ecore.EReference(feature, target, upper=upper_bound)
            stereotype.eStructuralFeatures.append(reference)
        else:
            stereotype.eStructuralFeatures.append(ecore.EAttribute(feature, ecore.EString))
