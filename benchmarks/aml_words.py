"""How a generated plant is written: elements of CAEX 3.0 as text, a line each."""

from random import Random

INTERFACES = {
    "net": "Interfaces/Fieldbus",
    "command": "Interfaces/Signal/Command",
    "signal": "Interfaces/Signal",
    "infeed": "Interfaces/Material",
    "outfeed": "Interfaces/Material",
}
"""Names of interfaces, and the class of each."""

WAYS = {"net": "InOut", "command": "In", "signal": "Out", "infeed": "In", "outfeed": "Out"}
"""Which way things go through the interfaces that classes declare."""


def attribute(name: str, data_type: str, unit: str = "", value: str = "", type_: str = "") -> str:
    """An attribute; ``type_`` is a class of the library Quantities."""
    said = f' Unit="{unit}"' if unit else ""
    if type_:
        said += f' RefAttributeType="Quantities/{type_}"'
    head = f'<Attribute Name="{name}" AttributeDataType="{data_type}"{said}'
    return f"{head}><Value>{value}</Value></Attribute>\n" if value else f"{head}/>\n"


def position(x: str, y: str) -> str:
    """An attribute with attributes."""
    inside = attribute("x", "xs:double", "m", x) + attribute("y", "xs:double", "m", y)
    return f'<Attribute Name="position">\n{inside}</Attribute>\n'


def interface(name: str, id: str, class_name: str = "", inside: str = "") -> str:
    """An external interface of the class that its name stands for, or another one has."""
    path = INTERFACES[class_name or name]
    head = f'<ExternalInterface Name="{name}" ID="{id}" RefBaseClassPath="{path}"'
    return f"{head}>\n{inside}</ExternalInterface>\n" if inside else f"{head}/>\n"


def way(direction: str) -> str:
    """The attribute of an interface that says which way things go."""
    return attribute("Direction", "xs:string", "", direction)


def link(name: str, one: str, other: str) -> str:
    """A link between two interfaces."""
    return f'<InternalLink Name="{name}" RefPartnerSideA="{one}" RefPartnerSideB="{other}"/>\n'


def element(name: str, id: str, path: str, inside: str) -> str:
    """An internal element; ``path`` is its class, its master, or empty."""
    base = f' RefBaseSystemUnitPath="{path}"' if path else ""
    head = f'<InternalElement Name="{name}" ID="{id}"{base}'
    return f"{head}>\n{inside}</InternalElement>\n" if inside else f"{head}/>\n"


def requirement(role: str) -> str:
    """The role that an internal element plays."""
    return f'<RoleRequirements RefBaseRoleClassPath="{role}"/>\n'


def new_id(chance: Random) -> str:
    """A GUID that only the seed decides."""
    text = f"{chance.getrandbits(128):032x}"
    return f"{text[:8]}-{text[8:12]}-{text[12:16]}-{text[16:20]}-{text[20:]}"
