"""Unresolved class references of AutomationML, found by lxml and IEC 62424 alone."""

from pathlib import Path

from lxml import etree
from reading_corpus import local_name

STANDARD_LIBRARIES = Path(__file__).parents[2] / "metamodels" / "automationml-libraries.aml"

REFERENCES = {
    "InternalElement": ("RefBaseSystemUnitPath", "SystemUnitClass"),
    "SystemUnitClass": ("RefBaseClassPath", "SystemUnitClass"),
    "RoleClass": ("RefBaseClassPath", "RoleClass"),
    "InterfaceClass": ("RefBaseClassPath", "InterfaceClass"),
    "ExternalInterface": ("RefBaseClassPath", "InterfaceClass"),
    "Attribute": ("RefAttributeType", "AttributeType"),
    "AttributeType": ("RefAttributeType", "AttributeType"),
    "SupportedRoleClass": ("RefRoleClassPath", "RoleClass"),
    "RoleRequirements": ("RefBaseRoleClassPath", "RoleClass"),
}
"""Elements that refer to classes: the attribute, and the kind of the class."""


def list_classes(root):
    """Return the kind and path of every class in a file."""
    classes = set()
    for tag in ("SystemUnitClass", "RoleClass", "InterfaceClass", "AttributeType"):
        for library in root.iterchildren(f"{{*}}{tag}Lib"):
            classes |= {(tag, path) for path in _iter_paths(library, tag, library.get("Name"))}
    return classes


def _iter_paths(node, tag, path):
    for child in node.iterchildren(f"{{*}}{tag}"):
        child_path = f"{path}/{child.get('Name')}"
        yield child_path
        yield from _iter_paths(child, tag, child_path)


def iter_unresolved(root):
    """Yield the ordinals, in document order, of elements whose reference names no class."""
    file_classes = list_classes(root)
    libraries = {(tag, path.split("/")[0]) for tag, path in file_classes}
    standard = list_classes(etree.parse(str(STANDARD_LIBRARIES)).getroot())
    known_classes = file_classes | {
        class_ for class_ in standard if (class_[0], class_[1].split("/")[0]) not in libraries
    }
    aliases = {node.get("Alias") for node in root.iter("{*}ExternalReference")}
    ids = {_normalize_id(node.get("ID")) for node in root.iter(etree.Element) if node.get("ID")}
    for ordinal, node in enumerate(root.iter(etree.Element)):
        attribute, tag = REFERENCES.get(local_name(node), ("", ""))
        text = node.get(attribute, "").strip() if attribute else ""
        if text and not _means_element(node, tag, text, ids):
            alias, separator, path = text.partition("@")
            is_standard = (tag, path) in standard and alias in aliases
            if not is_standard if separator else (tag, text) not in known_classes:
                yield ordinal


def _means_element(node, tag, text, ids):
    """Whether a reference names an element, or the class around it by its bare name."""
    owner = node.getparent()
    is_owner = local_name(node) == local_name(owner) == tag and text == owner.get("Name")
    return is_owner or _normalize_id(text) in ids or _normalize_id(text.split("/")[0]) in ids


def _normalize_id(id):
    return id.strip("{}").lower()
