"""Table of units as AutomationML files write them: symbols, spellings, codes of UN/ECE Rec. 20.

CAEX declares no system of units: the XML attribute Unit is free text. MTP files write the codes.
"""

from typing import NamedTuple


class Unit(NamedTuple):
    """A unit: its symbol, name, quantity (ISO 80000) and UN/ECE code."""

    symbol: str
    name: str
    quantity: str
    code: str = ""


UNITS = (
    Unit("1", "one", "dimensionless", "C62"),
    Unit("%", "per cent", "ratio", "P1"),
    Unit("m", "metre", "length", "MTR"),
    Unit("km", "kilometre", "length", "KMT"),
    Unit("dm", "decimetre", "length", "DMT"),
    Unit("cm", "centimetre", "length", "CMT"),
    Unit("mm", "millimetre", "length", "MMT"),
    Unit("µm", "micrometre", "length", "4H"),
    Unit("m²", "square metre", "area", "MTK"),
    Unit("mm²", "square millimetre", "area", "MMK"),
    Unit("m³", "cubic metre", "volume", "MTQ"),
    Unit("L", "litre", "volume", "LTR"),
    Unit("mL", "millilitre", "volume", "MLT"),
    Unit("kg", "kilogram", "mass", "KGM"),
    Unit("g", "gram", "mass", "GRM"),
    Unit("t", "tonne", "mass", "TNE"),
    Unit("s", "second", "time", "SEC"),
    Unit("ms", "millisecond", "time", "C26"),
    Unit("min", "minute", "time", "MIN"),
    Unit("h", "hour", "time", "HUR"),
    Unit("d", "day", "time", "DAY"),
    Unit("m/s", "metre per second", "speed", "MTS"),
    Unit("mm/s", "millimetre per second", "speed", "C16"),
    Unit("km/h", "kilometre per hour", "speed", "KMH"),
    Unit("m/min", "metre per minute", "speed", "2X"),
    Unit("m/s²", "metre per second squared", "acceleration", "MSK"),
    Unit("rad", "radian", "angle", "C81"),
    Unit("°", "degree", "angle", "DD"),
    Unit("rad/s", "radian per second", "angular velocity", "2A"),
    Unit("rpm", "revolutions per minute", "rotational frequency", "RPM"),
    Unit("Hz", "hertz", "frequency", "HTZ"),
    Unit("kHz", "kilohertz", "frequency", "KHZ"),
    Unit("N", "newton", "force", "NEW"),
    Unit("kN", "kilonewton", "force", "B47"),
    Unit("N·m", "newton metre", "torque", "NU"),
    Unit("Pa", "pascal", "pressure", "PAL"),
    Unit("kPa", "kilopascal", "pressure", "KPA"),
    Unit("MPa", "megapascal", "pressure", "MPA"),
    Unit("bar", "bar", "pressure", "BAR"),
    Unit("mbar", "millibar", "pressure", "MBR"),
    Unit("J", "joule", "energy", "JOU"),
    Unit("kWh", "kilowatt hour", "energy", "KWH"),
    Unit("W", "watt", "power", "WTT"),
    Unit("kW", "kilowatt", "power", "KWT"),
    Unit("V", "volt", "electric potential", "VLT"),
    Unit("mV", "millivolt", "electric potential", "2Z"),
    Unit("A", "ampere", "electric current", "AMP"),
    Unit("mA", "milliampere", "electric current", "4K"),
    Unit("Ω", "ohm", "electric resistance", "OHM"),
    Unit("K", "kelvin", "thermodynamic temperature", "KEL"),
    Unit("°C", "degree Celsius", "thermodynamic temperature", "CEL"),
    Unit("m³/h", "cubic metre per hour", "volume flow rate", "MQH"),
    Unit("m³/s", "cubic metre per second", "volume flow rate", "MQS"),
    Unit("L/min", "litre per minute", "volume flow rate", "L2"),
    Unit("L/h", "litre per hour", "volume flow rate", "E32"),
    Unit("kg/h", "kilogram per hour", "mass flow rate", "E93"),
    Unit("kg/s", "kilogram per second", "mass flow rate", "KGS"),
    Unit("kg/m³", "kilogram per cubic metre", "density", "KMQ"),
    Unit("dB", "decibel", "level", "2N"),
    Unit("bit/s", "bit per second", "transfer rate", "B10"),
    Unit("Mbit/s", "megabit per second", "transfer rate", "E20"),
    Unit("B", "byte", "storage capacity", "AD"),
)

_SPELLINGS = {
    "Celsius": "°C",
    "degC": "°C",
    "ºC": "°C",
    "m^3/h": "m³/h",
    "m3/h": "m³/h",
    "m^3": "m³",
    "m3": "m³",
    "m^2": "m²",
    "m2": "m²",
    "m/s^2": "m/s²",
    "m/s2": "m/s²",
    "kg/m^3": "kg/m³",
    "l": "L",
    "ml": "mL",
    "l/min": "L/min",
    "l/h": "L/h",
    "Nm": "N·m",
    "deg": "°",
    "Ohm": "Ω",
    "sec": "s",
    "um": "µm",
    "μm": "µm",
    "1/min": "rpm",
    "mbps": "Mbit/s",
    "Mbps": "Mbit/s",
    "Mbit/sec": "Mbit/s",
    "percent": "%",
}
"""Other spellings of symbols in files of users."""

TYPE_NAMES = frozenset({"string", "xs:string", "xs:anyUnit", "anyUnit", "double", "xs:double"})
"""Names of types that exporters write in the place of a unit."""

# A symbol takes precedence over a name, and a name over a code.
_UNITS_BY_TEXT = {
    **{unit.code: unit for unit in UNITS if unit.code},
    **{unit.name: unit for unit in UNITS},
    **{unit.symbol: unit for unit in UNITS},
}


def find_unit(text: str) -> Unit | None:
    """Return the unit that a text means: a symbol, another spelling of one, a name or a code."""
    return _UNITS_BY_TEXT.get(_SPELLINGS.get(text, text))
