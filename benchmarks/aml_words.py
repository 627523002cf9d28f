"""Printing of single elements of CAEX 3.0, one line each, for a generated plant."""

from random import Random

INTERFACES = {
    "net": "Interfaces/Fieldbus",
    "command": "Interfaces/Signal/Command",
    "signal": "Interfaces/Signal",
    "infeed": "Interfaces/Material",
    "outfeed": "Interfaces/Material",
}
"""Class of an interface by the name of the interface."""

DIRECTIONS = {"net": "InOut", "command": "In", "signal": "Out", "infeed": "In", "outfeed": "Out"}
"""Direction of the interfaces that classes declare, by the name of the interface."""


def print_attribute(
    name: str, data_type: str, unit: str = "", value: str = "", type_: str = ""
) -> str:
    """Print an attribute; ``type_`` is a class of the library Quantities."""
    type_attributes = f' Unit="{unit}"' if unit else ""
    if type_:
        type_attributes += f' RefAttributeType="Quantities/{type_}"'
    head = f'<Attribute Name="{name}" AttributeDataType="{data_type}"{type_attributes}'
    return f"{head}><Value>{value}</Value></Attribute>\n" if value else f"{head}/>\n"


def print_position(x: str, y: str) -> str:
    """Print an attribute that has attributes."""
    content = print_attribute("x", "xs:double", "m", x) + print_attribute("y", "xs:double", "m", y)
    return f'<Attribute Name="position">\n{content}</Attribute>\n'


def print_interface(name: str, id: str, class_name: str = "", content: str = "") -> str:
    """Print an external interface.

    The class is that of *class_name* in ``INTERFACES``, or that of the name if it is empty.
    """
    path = INTERFACES[class_name or name]
    head = f'<ExternalInterface Name="{name}" ID="{id}" RefBaseClassPath="{path}"'
    return f"{head}>\n{content}</ExternalInterface>\n" if content else f"{head}/>\n"


def print_direction(direction: str) -> str:
    """Print the attribute of an interface that states in which direction items flow."""
    return print_attribute("Direction", "xs:string", "", direction)


def print_link(name: str, side_a: str, side_b: str) -> str:
    """Print a link between two interfaces."""
    return f'<InternalLink Name="{name}" RefPartnerSideA="{side_a}" RefPartnerSideB="{side_b}"/>\n'


def print_element(name: str, id: str, path: str, content: str) -> str:
    """Print an internal element; ``path`` is its class, its master, or empty."""
    base = f' RefBaseSystemUnitPath="{path}"' if path else ""
    head = f'<InternalElement Name="{name}" ID="{id}"{base}'
    return f"{head}>\n{content}</InternalElement>\n" if content else f"{head}/>\n"


def print_role(role: str) -> str:
    """Print the role that an internal element plays."""
    return f'<RoleRequirements RefBaseRoleClassPath="{role}"/>\n'


def make_id(random: Random) -> str:
    """Return a GUID that depends only on the seed."""
    text = f"{random.getrandbits(128):032x}"
    return f"{text[:8]}-{text[8:12]}-{text[12:16]}-{text[16:20]}-{text[20:]}"
