"""Printing of the production lines of a generated plant.

The stations of a line repeat the content of their classes with values and ids of their own. Some
devices have more attributes than their class. A control cabinet has elements on several levels
without classes, as many tools write it. A line also has links within and between stations, a group
of mirrors, and roles. The proportions are those of real files (33 % of the elements are attributes,
8 % internal elements), and the compiler reports nothing about the plant.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from random import Random

import aml_classes as classes
from aml_words import (
    make_id,
    print_attribute,
    print_direction,
    print_element,
    print_interface,
    print_link,
    print_position,
    print_role,
)

HEAD = """<?xml version="1.0" encoding="utf-8"?>
<CAEXFile xmlns="http://www.dke.de/CAEX" SchemaVersion="3.0" FileName="plant.aml">
<SuperiorStandardVersion>AutomationML 2.10</SuperiorStandardVersion>
<SourceDocumentInformation OriginName="sysmlc benchmarks" OriginID="aml_model" OriginVersion="1" \
LastWritingDateTime="2026-01-01T00:00:00Z"/>
<InstanceHierarchy Name="Plant">
<Version>1.0</Version>
"""
FOOT = f"</InstanceHierarchy>\n{classes.LIBRARIES}</CAEXFile>\n"

_VENDORS = ("Alpha Drives", "Beta Sensors", "Gamma Automation", "Delta &amp; Sons")
_STATION_COUNT = 6
_EXTENDED_SHARE = 0.05
"""Share of the devices that have an attribute that their class lacks."""


@dataclass(frozen=True, slots=True)
class _Element:
    """The text of an internal element, its id, and the ids of its interfaces by name."""

    text: str
    id: str
    ports: dict[str, str]


def print_line(number: int, random: Random) -> str:
    """Print a production line: a row of stations and conveyors, a cabinet, and a group."""
    positions = range(1, _STATION_COUNT + 1)
    stations = [_make_station(f"S{number}.{k}", random) for k in positions]
    belts = [_make_device(f"B{number}.{k}", "Conveyor", random) for k in positions]
    cabinet = _make_cabinet(f"C{number}", random)
    content = "<Description>Production line of the generated plant</Description>\n"
    content += print_attribute("throughput", "xs:double", "1/min", str(random.randint(10, 90)))
    content += "".join(element.text for element in (*stations, *belts, cabinet))
    content += _print_group(f"G{number}", [belt.id for belt in belts[:3]], random)
    content += "".join(_print_links(stations, belts, cabinet)) + print_role("Roles/Line")
    return print_element(f"Line{number}", make_id(random), "", content)


def _print_links(
    stations: list[_Element], belts: list[_Element], cabinet: _Element
) -> Iterable[str]:
    for k, (station, belt) in enumerate(zip(stations, belts, strict=True), 1):
        yield print_link(f"m{k}", station.ports["outfeed"], belt.ports["infeed"])
        yield print_link(f"f{k}", station.ports["net"], cabinet.ports[f"X{k}"])
        yield print_link(f"b{k}", belt.ports["net"], cabinet.ports[f"X{k + _STATION_COUNT}"])


# -- instances of classes ----------------------------------------------------------------------


def _make_station(name: str, random: Random) -> _Element:
    kind = random.choice(tuple(classes.STATIONS))
    parts = list(zip(classes.PARTS, classes.STATIONS[kind], strict=True))
    devices = [_make_device(part, device, random) for part, device in parts]
    ports = {port: make_id(random) for port in classes.STATION_PORTS}
    content = classes.print_measure("delay", str(random.randint(51, 200)))
    content += print_position(*(f"{random.uniform(1, 99):.2f}" for _ in "xy"))
    content += _print_interfaces(ports) + "".join(device.text for device in devices)
    for part, device in zip(classes.PARTS, devices, strict=True):
        content += print_link(f"net-{part}", ports["net"], device.ports["net"])
    content += print_role("Roles/Station")
    id = make_id(random)
    return _Element(print_element(name, id, f"Stations/{kind}", content), id, ports)


def _make_device(name: str, kind: str, random: Random) -> _Element:
    ports = {port: make_id(random) for port in classes.list_ports(kind)}
    content = "".join(
        classes.print_measure(attribute, _choose_value(attribute, random))
        for attribute in classes.list_attributes(kind)
    )
    if random.random() < _EXTENDED_SHARE:
        content += print_attribute("inventory", "xs:string", "", f"I-{random.getrandbits(24)}")
    content += _print_interfaces(ports) + print_role(f"Roles/{classes.role_of(kind)}")
    id = make_id(random)
    return _Element(print_element(name, id, f"Devices/{kind}", content), id, ports)


def _print_interfaces(ports: dict[str, str]) -> str:
    return "".join(print_interface(name, id) for name, id in ports.items())


def _choose_value(name: str, random: Random) -> str:
    if name in ("vendor", "serial"):
        return random.choice(_VENDORS) if name == "vendor" else f"SN-{random.getrandbits(32):08x}"
    data_type = classes.MEASURES[name][0]
    if data_type == "xs:boolean":
        return random.choice(("true", "false"))
    return str(random.randint(1, 500)) if data_type == "xs:integer" else f"{random.random():.4f}"


# -- elements without a class ------------------------------------------------------------------


def _make_cabinet(name: str, random: Random) -> _Element:
    """Return a cabinet with racks and modules."""
    ports = {f"X{k}": make_id(random) for k in range(1, 2 * _STATION_COUNT + 1)}
    content = print_attribute("protection", "xs:string", "", "IP54")
    content += "".join(
        print_interface(port, id, "net", print_direction("InOut")) for port, id in ports.items()
    )
    content += "".join(_print_rack(f"Rack{k}", random) for k in (1, 2))
    content += print_role("Roles/Cabinet")
    id = make_id(random)
    return _Element(print_element(name, id, "", content), id, ports)


def _print_rack(name: str, random: Random) -> str:
    modules = "".join(_print_module(f"M{k}", k, random) for k in range(1, 4))
    return print_element(name, make_id(random), "", modules + print_role("Roles/Cabinet"))


def _print_module(name: str, slot: int, random: Random) -> str:
    attributes = (
        ("order", "xs:string", "", f"6ES7-{random.getrandbits(16)}"),
        ("current", "xs:double", "mA", str(random.randint(10, 900))),
        ("slot", "xs:integer", "", str(slot)),
        ("address", "xs:string", "", f"10.0.{random.randint(0, 255)}.{random.randint(1, 254)}"),
        ("firmware", "xs:string", "", f"V{random.randint(1, 4)}.{random.randint(0, 9)}"),
    )
    content = "".join(print_attribute(*attribute) for attribute in attributes)
    id, direction = make_id(random), random.choice(("In", "Out"))
    content += print_interface("signal", id, content=print_direction(direction))
    content += print_role("Roles/Module")
    return print_element(name, make_id(random), "", content)


def _print_group(name: str, masters: Iterable[str], random: Random) -> str:
    mirrors = "".join(
        print_element(f"mirror{k}", make_id(random), master, "")
        for k, master in enumerate(masters, 1)
    )
    content = mirrors + print_role(f"{classes.BASE_ROLE}/Group")
    return print_element(name, make_id(random), "", content)
