"""What a generated plant says: production lines that are instances of classes, and others.

A line has stations that say again what their classes have, with values and ids of their own;
devices with more than their class; a control cabinet several deep without classes, as many
tools write it; links within and between stations; a group of mirrors; roles. The proportions
are those of real files (a third attributes, eight hundredths internal elements), and the
compiler has nothing to object to.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from random import Random

import aml_classes as classes
from aml_words import attribute, element, interface, link, new_id, position, requirement, way

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
_WITH_MORE = 0.05
"""Share of devices that have an attribute beyond those of their class."""


@dataclass(frozen=True, slots=True)
class _Made:
    """Text of an internal element, its id, and the ids of its interfaces by name."""

    text: str
    id: str
    ports: dict[str, str]


def line(number: int, chance: Random) -> str:
    """One production line: stations in a row, a conveyor after each, a cabinet, a group."""
    places = range(1, _STATION_COUNT + 1)
    stations = [_station(f"S{number}.{k}", chance) for k in places]
    belts = [_device(f"B{number}.{k}", "Conveyor", chance) for k in places]
    cabinet = _cabinet(f"C{number}", chance)
    inside = "<Description>Production line of the generated plant</Description>\n"
    inside += attribute("throughput", "xs:double", "1/min", str(chance.randint(10, 90)))
    inside += "".join(one.text for one in (*stations, *belts, cabinet))
    inside += _group(f"G{number}", [belt.id for belt in belts[:3]], chance)
    inside += "".join(_links(stations, belts, cabinet)) + requirement("Roles/Line")
    return element(f"Line{number}", new_id(chance), "", inside)


def _links(stations: list[_Made], belts: list[_Made], cabinet: _Made) -> Iterable[str]:
    for k, (station, belt) in enumerate(zip(stations, belts, strict=True), 1):
        yield link(f"m{k}", station.ports["outfeed"], belt.ports["infeed"])
        yield link(f"f{k}", station.ports["net"], cabinet.ports[f"X{k}"])
        yield link(f"b{k}", belt.ports["net"], cabinet.ports[f"X{k + _STATION_COUNT}"])


# -- instances of classes ----------------------------------------------------------------------


def _station(name: str, chance: Random) -> _Made:
    kind = chance.choice(tuple(classes.STATIONS))
    named = list(zip(classes.PARTS, classes.STATIONS[kind], strict=True))
    devices = [_device(part, device, chance) for part, device in named]
    ports = {one: new_id(chance) for one in classes.STATION_PORTS}
    inside = classes.declared("delay", str(chance.randint(51, 200)))
    inside += position(*(f"{chance.uniform(1, 99):.2f}" for _ in "xy"))
    inside += _interfaces(ports) + "".join(device.text for device in devices)
    for part, device in zip(classes.PARTS, devices, strict=True):
        inside += link(f"net-{part}", ports["net"], device.ports["net"])
    inside += requirement("Roles/Station")
    id = new_id(chance)
    return _Made(element(name, id, f"Stations/{kind}", inside), id, ports)


def _device(name: str, kind: str, chance: Random) -> _Made:
    ports = {one: new_id(chance) for one in classes.ports(kind)}
    values = (classes.declared(one, _value(one, chance)) for one in classes.attributes(kind))
    inside = "".join(values)
    if chance.random() < _WITH_MORE:
        inside += attribute("inventory", "xs:string", "", f"I-{chance.getrandbits(24)}")
    inside += _interfaces(ports) + requirement(f"Roles/{classes.role(kind)}")
    id = new_id(chance)
    return _Made(element(name, id, f"Devices/{kind}", inside), id, ports)


def _interfaces(ports: dict[str, str]) -> str:
    return "".join(interface(name, id) for name, id in ports.items())


def _value(name: str, chance: Random) -> str:
    if name in ("vendor", "serial"):
        return chance.choice(_VENDORS) if name == "vendor" else f"SN-{chance.getrandbits(32):08x}"
    data_type = classes.MEASURES[name][0]
    if data_type == "xs:boolean":
        return chance.choice(("true", "false"))
    return str(chance.randint(1, 500)) if data_type == "xs:integer" else f"{chance.random():.4f}"


# -- what has no class -------------------------------------------------------------------------


def _cabinet(name: str, chance: Random) -> _Made:
    """A cabinet with racks, modules and channels, none of which has a class."""
    ports = {f"X{k}": new_id(chance) for k in range(1, 2 * _STATION_COUNT + 1)}
    inside = attribute("protection", "xs:string", "", "IP54")
    inside += "".join(interface(one, id, "net", way("InOut")) for one, id in ports.items())
    inside += "".join(_rack(f"Rack{k}", chance) for k in (1, 2)) + requirement("Roles/Cabinet")
    id = new_id(chance)
    return _Made(element(name, id, "", inside), id, ports)


def _rack(name: str, chance: Random) -> str:
    modules = "".join(_module(f"M{k}", k, chance) for k in range(1, 4))
    return element(name, new_id(chance), "", modules + requirement("Roles/Cabinet"))


def _module(name: str, slot: int, chance: Random) -> str:
    values = (
        ("order", "xs:string", "", f"6ES7-{chance.getrandbits(16)}"),
        ("current", "xs:double", "mA", str(chance.randint(10, 900))),
        ("slot", "xs:integer", "", str(slot)),
        ("address", "xs:string", "", f"10.0.{chance.randint(0, 255)}.{chance.randint(1, 254)}"),
        ("firmware", "xs:string", "", f"V{chance.randint(1, 4)}.{chance.randint(0, 9)}"),
    )
    inside = "".join(attribute(*value) for value in values)
    inside += interface("signal", new_id(chance), inside=way(chance.choice(("In", "Out"))))
    inside += requirement("Roles/Module")
    return element(name, new_id(chance), "", inside)


def _group(name: str, masters: Iterable[str], chance: Random) -> str:
    mirrors = "".join(
        element(f"mirror{k}", new_id(chance), master, "") for k, master in enumerate(masters, 1)
    )
    inside = mirrors + requirement(f"{classes.BASE_ROLE}/Group")
    return element(name, new_id(chance), "", inside)
