"""The libraries of a generated plant: devices, stations, and what types them."""

from aml_words import WAYS, attribute, element, interface, link, position, way

BASE_ROLE = "AutomationMLBaseRoleClassLib/AutomationMLBaseRole"
_BASE_INTERFACE = "AutomationMLInterfaceClassLib/AutomationMLBaseInterface"

MEASURES = {
    "speed": ("xs:double", "m/s", "Speed"),
    "power": ("xs:double", "kW", "Power"),
    "voltage": ("xs:double", "V", ""),
    "range": ("xs:double", "mm", "Length"),
    "pressure": ("xs:double", "kPa", ""),
    "delay": ("xs:integer", "ms", ""),
    "serial": ("xs:string", "", ""),
    "vendor": ("xs:string", "", ""),
    "enabled": ("xs:boolean", "", ""),
}
"""Attributes that classes declare: data type, unit, attribute type (or none)."""

_DEVICES: dict[str, tuple[str, tuple[str, ...], tuple[str, ...]]] = {
    "Device": ("", ("serial", "vendor"), ("net",)),
    "Actuator": ("Device", ("power", "enabled"), ("command",)),
    "Sensor": ("Device", ("range", "delay"), ("signal",)),
    "Motor": ("Actuator", ("speed", "voltage"), ()),
    "Valve": ("Actuator", ("pressure",), ()),
    "LightBarrier": ("Sensor", ("voltage",), ()),
    "Conveyor": ("Motor", (), ("infeed", "outfeed")),
}
"""Classes of devices: base class, attributes, interfaces."""

STATIONS = {
    "Press": ("Motor", "Valve", "LightBarrier"),
    "Oven": ("Valve", "Valve", "LightBarrier"),
    "Feeder": ("Motor", "LightBarrier", "LightBarrier"),
}
"""Classes of stations: the classes of their devices."""

PARTS = ("drive", "actor", "sensor")
"""Names of the devices in a station."""

STATION_PORTS = ("net", "infeed", "outfeed")

_ROLES = {
    "Line": f"{BASE_ROLE}/Structure/ResourceStructure",
    "Station": f"{BASE_ROLE}/Resource",
    "Device": f"{BASE_ROLE}/Resource",
    "Actuator": "Roles/Device",
    "Sensor": "Roles/Device",
    "Cabinet": f"{BASE_ROLE}/Resource",
    "Module": f"{BASE_ROLE}/Resource",
}
_TYPES = {"Speed": "m/s", "Power": "kW", "Length": "mm"}


def attributes(device: str) -> list[str]:
    """Names of the attributes of a device, inherited ones first."""
    base, own, _ = _DEVICES[device]
    return [*(attributes(base) if base else ()), *own]


def ports(device: str) -> list[str]:
    """Names of the interfaces of a device, inherited ones first."""
    base, _, own = _DEVICES[device]
    return [*(ports(base) if base else ()), *own]


def declared(name: str, value: str = "") -> str:
    """An attribute as classes declare it, and instances repeat it with a value."""
    data_type, unit, type_ = MEASURES[name]
    return attribute(name, data_type, unit, value, type_)


def role(device: str) -> str:
    """The role that a device plays."""
    return device if device in _ROLES else "Device"


def _device(name: str) -> str:
    base, own, interfaces = _DEVICES[name]
    path = f' RefBaseClassPath="Devices/{base}"' if base else ""
    inside = "".join(map(declared, own))
    inside += "".join(
        interface(one, f"class-{name}-{one}", inside=way(WAYS[one])) for one in interfaces
    )
    inside += _supported(role(name))
    return f'<SystemUnitClass Name="{name}"{path}>\n{inside}</SystemUnitClass>\n'


def _station(name: str) -> str:
    inside = declared("delay", "50") + position("0", "0")
    for one in STATION_PORTS:
        inside += interface(one, f"class-{name}-{one}", inside=way(WAYS[one]))
    links = ""
    for part, device in zip(PARTS, STATIONS[name], strict=True):
        id = f"class-{name}-{part}"
        made = "".join(interface(one, f"{id}-{one}") for one in ports(device))
        inside += element(part, id, f"Devices/{device}", made)
        links += link(f"net-{part}", f"class-{name}-net", f"{id}-net")
    inside += _supported("Station") + links
    return f'<SystemUnitClass Name="{name}">\n{inside}</SystemUnitClass>\n'


def _supported(name: str) -> str:
    return f'<SupportedRoleClass RefRoleClassPath="Roles/{name}"/>\n'


def _interfaces() -> str:
    return (
        f'<InterfaceClass Name="Fieldbus" RefBaseClassPath="{_BASE_INTERFACE}/Communication"/>\n'
        f'<InterfaceClass Name="Material" RefBaseClassPath="{_BASE_INTERFACE}/Port"/>\n'
        f'<InterfaceClass Name="Signal" RefBaseClassPath="{_BASE_INTERFACE}/Communication">\n'
        '<InterfaceClass Name="Command" RefBaseClassPath="Signal"/>\n</InterfaceClass>\n'
    )


def _role_class(name: str) -> str:
    return f'<RoleClass Name="{name}" RefBaseClassPath="{_ROLES[name]}"/>\n'


def _type(name: str) -> str:
    return f'<AttributeType Name="{name}" AttributeDataType="xs:double" Unit="{_TYPES[name]}"/>\n'


def _library(tag: str, name: str, inside: str) -> str:
    return f'<{tag} Name="{name}">\n<Version>1.0</Version>\n{inside}</{tag}>\n'


LIBRARIES = "".join(
    (
        _library("InterfaceClassLib", "Interfaces", _interfaces()),
        _library("RoleClassLib", "Roles", "".join(map(_role_class, _ROLES))),
        _library("SystemUnitClassLib", "Devices", "".join(map(_device, _DEVICES))),
        _library("SystemUnitClassLib", "Stations", "".join(map(_station, STATIONS))),
        _library("AttributeTypeLib", "Quantities", "".join(map(_type, _TYPES))),
    )
)
"""All libraries as text."""
