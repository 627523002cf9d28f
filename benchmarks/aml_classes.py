"""The libraries of a generated plant: classes of devices, stations, roles and interfaces."""

from collections.abc import Iterable

from aml_words import (
    DIRECTIONS,
    print_attribute,
    print_direction,
    print_element,
    print_interface,
    print_link,
    print_position,
)

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
"""Data type, unit and attribute type (maybe "") of the attributes that classes declare."""

_DEVICES: dict[str, tuple[str, tuple[str, ...], tuple[str, ...]]] = {
    "Device": ("", ("serial", "vendor"), ("net",)),
    "Actuator": ("Device", ("power", "enabled"), ("command",)),
    "Sensor": ("Device", ("range", "delay"), ("signal",)),
    "Motor": ("Actuator", ("speed", "voltage"), ()),
    "Valve": ("Actuator", ("pressure",), ()),
    "LightBarrier": ("Sensor", ("voltage",), ()),
    "Conveyor": ("Motor", (), ("infeed", "outfeed")),
}
"""Base class, attributes and interfaces of each class of devices."""

STATIONS = {
    "Press": ("Motor", "Valve", "LightBarrier"),
    "Oven": ("Valve", "Valve", "LightBarrier"),
    "Feeder": ("Motor", "LightBarrier", "LightBarrier"),
}
"""The classes of the devices of each class of stations."""

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


def list_attributes(device: str) -> list[str]:
    """Return the names of the attributes of a device, inherited ones first."""
    base, names, _ = _DEVICES[device]
    return [*(list_attributes(base) if base else ()), *names]


def list_ports(device: str) -> list[str]:
    """Return the names of the interfaces of a device, inherited ones first."""
    base, _, names = _DEVICES[device]
    return [*(list_ports(base) if base else ()), *names]


def print_measure(name: str, value: str = "") -> str:
    """Print an attribute of ``MEASURES``: without a value in a class, with one in an instance."""
    data_type, unit, type_ = MEASURES[name]
    return print_attribute(name, data_type, unit, value, type_)


def role_of(device: str) -> str:
    """Return the role that a device plays."""
    return device if device in _ROLES else "Device"


def _print_device_class(name: str) -> str:
    base, attributes, ports = _DEVICES[name]
    path = f' RefBaseClassPath="Devices/{base}"' if base else ""
    content = "".join(map(print_measure, attributes))
    content += _print_ports(name, ports) + _print_supported_role(role_of(name))
    return f'<SystemUnitClass Name="{name}"{path}>\n{content}</SystemUnitClass>\n'


def _print_ports(class_name: str, ports: Iterable[str]) -> str:
    """Print the interfaces that a class declares, with their directions."""
    directions = {port: print_direction(DIRECTIONS[port]) for port in ports}
    return "".join(
        print_interface(port, f"class-{class_name}-{port}", content=direction)
        for port, direction in directions.items()
    )


def _print_station_class(name: str) -> str:
    content = print_measure("delay", "50") + print_position("0", "0")
    content += _print_ports(name, STATION_PORTS)
    links = ""
    for part, device in zip(PARTS, STATIONS[name], strict=True):
        id = f"class-{name}-{part}"
        ports = "".join(print_interface(port, f"{id}-{port}") for port in list_ports(device))
        content += print_element(part, id, f"Devices/{device}", ports)
        links += print_link(f"net-{part}", f"class-{name}-net", f"{id}-net")
    content += _print_supported_role("Station") + links
    return f'<SystemUnitClass Name="{name}">\n{content}</SystemUnitClass>\n'


def _print_supported_role(name: str) -> str:
    return f'<SupportedRoleClass RefRoleClassPath="Roles/{name}"/>\n'


def _print_interface_classes() -> str:
    return (
        f'<InterfaceClass Name="Fieldbus" RefBaseClassPath="{_BASE_INTERFACE}/Communication"/>\n'
        f'<InterfaceClass Name="Material" RefBaseClassPath="{_BASE_INTERFACE}/Port"/>\n'
        f'<InterfaceClass Name="Signal" RefBaseClassPath="{_BASE_INTERFACE}/Communication">\n'
        '<InterfaceClass Name="Command" RefBaseClassPath="Signal"/>\n</InterfaceClass>\n'
    )


def _print_role_class(name: str) -> str:
    return f'<RoleClass Name="{name}" RefBaseClassPath="{_ROLES[name]}"/>\n'


def _print_attribute_type(name: str) -> str:
    return f'<AttributeType Name="{name}" AttributeDataType="xs:double" Unit="{_TYPES[name]}"/>\n'


def _print_library(tag: str, name: str, classes: Iterable[str]) -> str:
    content = "".join(classes)
    return f'<{tag} Name="{name}">\n<Version>1.0</Version>\n{content}</{tag}>\n'


LIBRARIES = "".join(
    (
        _print_library("InterfaceClassLib", "Interfaces", [_print_interface_classes()]),
        _print_library("RoleClassLib", "Roles", map(_print_role_class, _ROLES)),
        _print_library("SystemUnitClassLib", "Devices", map(_print_device_class, _DEVICES)),
        _print_library("SystemUnitClassLib", "Stations", map(_print_station_class, STATIONS)),
        _print_library("AttributeTypeLib", "Quantities", map(_print_attribute_type, _TYPES)),
    )
)
"""The text of all libraries."""
