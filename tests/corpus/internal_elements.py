"""What CAEX files state about their internal elements, as facts that can be compared."""

from collections import Counter

from lxml import etree

from sysmlc.sources.caex_vocabulary import NAMESPACE

ROLES = {"RoleRequirements": "RefBaseRoleClassPath", "SupportedRoleClass": "RefRoleClassPath"}


def list_facts(texts):
    """Return a multiset of facts: path of names, subject, and what the files state."""
    roots = [etree.fromstring(text.encode()) for text in texts]
    names = {
        node.get("ID"): path_of(node)
        for root in roots
        for node in root.iter(tag("InternalElement"), tag("ExternalInterface"))
    }
    facts = Counter()
    for root in roots:
        for element in root.iter(tag("InternalElement")):
            facts.update((path_of(element), *fact) for fact in iter_facts(element))
        for link in root.iter(tag("InternalLink")):
            sides = (link.get("RefPartnerSideA", ""), link.get("RefPartnerSideB", ""))
            ends = sorted(names.get(side, side) for side in sides)
            facts[path_of(link.getparent()), "link", link.get("Name"), *ends] += 1
    return facts


def iter_facts(element):
    """Yield subject and content of each fact about an internal element itself."""
    yield "element", element.get("ID")
    yield "class", without_alias(element.get("RefBaseSystemUnitPath", ""))
    for name, attribute in ROLES.items():
        for role in element.findall(tag(name)):
            yield "role", without_alias(role.get(attribute, ""))
    yield from iter_attributes(element, "")
    for interface in element.findall(tag("ExternalInterface")):
        name, class_ = interface.get("Name"), interface.get("RefBaseClassPath", "")
        yield "interface", name, interface.get("ID"), without_alias(class_)
        yield from iter_attributes(interface, f"{name}:")


def iter_attributes(element, prefix):
    """Yield data type, unit and values of all attributes, with inner ones."""
    for attribute in element.findall(tag("Attribute")):
        name = f"{prefix}{attribute.get('Name')}"
        values = [attribute.findtext(tag(child)) for child in ("Value", "DefaultValue")]
        kinds = [attribute.get(key) for key in ("AttributeDataType", "Unit")]
        yield "attribute", name, *kinds, *values
        yield from iter_attributes(attribute, f"{name}.")


def path_of(node):
    """Return the names from the hierarchy or library down to an element."""
    steps = [node, *node.iterancestors()]
    return "/".join(step.get("Name", "") for step in reversed(steps[:-1]))


def without_alias(path):
    """Return a class path without the alias of its file: the way back leads to one file."""
    return path.rpartition("@")[2]


def tag(name):
    return f"{{{NAMESPACE}}}{name}"
