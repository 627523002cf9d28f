"""Which class references of an AutomationML file lead nowhere: by lxml and IEC 62424 alone."""

from pathlib import Path

from lxml import etree

STANDARD = Path(__file__).parents[2] / "metamodels" / "automationml-libraries.aml"

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
"""Elements that name classes: the attribute, and the kind of class that it means."""


def local(node):
    return etree.QName(node).localname


def classes(root):
    """Kind and path of every class that a file holds."""
    found = set()
    for tag in ("SystemUnitClass", "RoleClass", "InterfaceClass", "AttributeType"):
        for library in root.iterchildren(f"{{*}}{tag}Lib"):
            found |= {(tag, path) for path in _below(library, tag, library.get("Name"))}
    return found


def _below(node, tag, path):
    for child in node.iterchildren(f"{{*}}{tag}"):
        here = f"{path}/{child.get('Name')}"
        yield here
        yield from _below(child, tag, here)


def lead_nowhere(root):
    """Places, in document order of all elements, of the references that find no class."""
    held = classes(root)
    libraries = {(tag, path.split("/")[0]) for tag, path in held}
    standard = classes(etree.parse(str(STANDARD)).getroot())
    known = held | {one for one in standard if (one[0], one[1].split("/")[0]) not in libraries}
    aliases = {node.get("Alias") for node in root.iter("{*}ExternalReference")}
    ids = {_plain(node.get("ID")) for node in root.iter(etree.Element) if node.get("ID")}
    for place, node in enumerate(root.iter(etree.Element)):
        attribute, tag = REFERENCES.get(local(node), ("", ""))
        text = node.get(attribute, "").strip() if attribute else ""
        if text and not _means_element(node, tag, text, ids):
            alias, at, path = text.partition("@")
            is_standard = (tag, path) in standard and alias in aliases
            if not is_standard if at else (tag, text) not in known:
                yield place


def _means_element(node, tag, text, ids):
    """Whether a mirror names an element, or a class the one around it by its bare name."""
    above = node.getparent()
    is_around = local(node) == local(above) == tag and text == above.get("Name")
    return is_around or _plain(text) in ids or _plain(text.split("/")[0]) in ids


def _plain(id):
    return id.strip("{}").lower()
