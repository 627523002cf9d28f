"""Units of measurement and times: symbols, spellings, codes of UN/ECE Rec. 20, factors.

CAEX declares no system of units: the XML attribute Unit is free text. MTP files write the codes.
All notations share the times: a number without a unit is in seconds.
"""

import re
from fractions import Fraction
from typing import NamedTuple


class Unit(NamedTuple):
    """A unit: its symbol, name, quantity (ISO 80000) and UN/ECE code.

    ``factor`` times a number gives the number in the first unit of the quantity with factor 1; it
    is empty if no factor converts the unit exactly.
    """

    symbol: str
    name: str
    quantity: str
    code: str = ""
    factor: str = "1"


UNITS = (
    Unit("1", "one", "dimensionless", "C62"),
    Unit("%", "per cent", "ratio", "P1", "1/100"),
    Unit("m", "metre", "length", "MTR"),
    Unit("km", "kilometre", "length", "KMT", "1000"),
    Unit("dm", "decimetre", "length", "DMT", "1/10"),
    Unit("cm", "centimetre", "length", "CMT", "1/100"),
    Unit("mm", "millimetre", "length", "MMT", "1/1000"),
    Unit("µm", "micrometre", "length", "4H", "1/1000000"),
    Unit("nm", "nanometre", "length", "C45", "1/1000000000"),
    Unit("m²", "square metre", "area", "MTK"),
    Unit("mm²", "square millimetre", "area", "MMK", "1/1000000"),
    Unit("m³", "cubic metre", "volume", "MTQ"),
    Unit("L", "litre", "volume", "LTR", "1/1000"),
    Unit("mL", "millilitre", "volume", "MLT", "1/1000000"),
    Unit("kg", "kilogram", "mass", "KGM"),
    Unit("g", "gram", "mass", "GRM", "1/1000"),
    Unit("mg", "milligram", "mass", "MGM", "1/1000000"),
    Unit("t", "tonne", "mass", "TNE", "1000"),
    Unit("s", "second", "time", "SEC"),
    Unit("ms", "millisecond", "time", "C26", "1/1000"),
    Unit("µs", "microsecond", "time", "B98", "1/1000000"),
    Unit("min", "minute", "time", "MIN", "60"),
    Unit("h", "hour", "time", "HUR", "3600"),
    Unit("d", "day", "time", "DAY", "86400"),
    Unit("m/s", "metre per second", "speed", "MTS"),
    Unit("mm/s", "millimetre per second", "speed", "C16", "1/1000"),
    Unit("km/h", "kilometre per hour", "speed", "KMH", "5/18"),
    Unit("m/min", "metre per minute", "speed", "2X", "1/60"),
    Unit("m/s²", "metre per second squared", "acceleration", "MSK"),
    Unit("rad", "radian", "angle", "C81"),
    Unit("°", "degree", "angle", "DD", ""),
    Unit("rad/s", "radian per second", "angular velocity", "2A"),
    Unit("rpm", "revolutions per minute", "rotational frequency", "RPM", "1/60"),
    Unit("Hz", "hertz", "frequency", "HTZ"),
    Unit("kHz", "kilohertz", "frequency", "KHZ", "1000"),
    Unit("MHz", "megahertz", "frequency", "MHZ", "1000000"),
    Unit("GHz", "gigahertz", "frequency", "A86", "1000000000"),
    Unit("N", "newton", "force", "NEW"),
    Unit("kN", "kilonewton", "force", "B47", "1000"),
    Unit("N·m", "newton metre", "torque", "NU"),
    Unit("Pa", "pascal", "pressure", "PAL"),
    Unit("kPa", "kilopascal", "pressure", "KPA", "1000"),
    Unit("MPa", "megapascal", "pressure", "MPA", "1000000"),
    Unit("bar", "bar", "pressure", "BAR", "100000"),
    Unit("mbar", "millibar", "pressure", "MBR", "100"),
    Unit("J", "joule", "energy", "JOU"),
    Unit("kJ", "kilojoule", "energy", "KJO", "1000"),
    Unit("MJ", "megajoule", "energy", "3B", "1000000"),
    Unit("Wh", "watt hour", "energy", "WHR", "3600"),
    Unit("kWh", "kilowatt hour", "energy", "KWH", "3600000"),
    Unit("W", "watt", "power", "WTT"),
    Unit("kW", "kilowatt", "power", "KWT", "1000"),
    Unit("mW", "milliwatt", "power", "C31", "1/1000"),
    Unit("MW", "megawatt", "power", "MAW", "1000000"),
    Unit("V", "volt", "electric potential", "VLT"),
    Unit("mV", "millivolt", "electric potential", "2Z", "1/1000"),
    Unit("kV", "kilovolt", "electric potential", "KVT", "1000"),
    Unit("A", "ampere", "electric current", "AMP"),
    Unit("mA", "milliampere", "electric current", "4K", "1/1000"),
    Unit("Ω", "ohm", "electric resistance", "OHM"),
    Unit("K", "kelvin", "thermodynamic temperature", "KEL"),
    Unit("°C", "degree Celsius", "thermodynamic temperature", "CEL", ""),
    Unit("m³/h", "cubic metre per hour", "volume flow rate", "MQH", "1/3600"),
    Unit("m³/s", "cubic metre per second", "volume flow rate", "MQS"),
    Unit("L/min", "litre per minute", "volume flow rate", "L2", "1/60000"),
    Unit("L/h", "litre per hour", "volume flow rate", "E32", "1/3600000"),
    Unit("kg/h", "kilogram per hour", "mass flow rate", "E93", "1/3600"),
    Unit("kg/s", "kilogram per second", "mass flow rate", "KGS"),
    Unit("kg/m³", "kilogram per cubic metre", "density", "KMQ"),
    Unit("dB", "decibel", "level", "2N", ""),
    Unit("bit/s", "bit per second", "transfer rate", "B10"),
    Unit("Mbit/s", "megabit per second", "transfer rate", "E20", "1000000"),
    Unit("B", "byte", "storage capacity", "AD"),
    Unit("bit", "bit", "storage capacity", "A99", "1/8"),
    Unit("mol", "mole", "amount of substance", "C34"),
    Unit("cd", "candela", "luminous intensity", "CDL"),
    Unit("lx", "lux", "illuminance", "LUX"),
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
    "m·s^-2": "m/s²",
    "m·s^-1": "m/s",
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
    "secs": "s",
    "msec": "ms",
    "millisec": "ms",
    "millisecs": "ms",
    "microsec": "µs",
    "microsecs": "µs",
    "us": "µs",
    "μs": "µs",
    "mins": "min",
    "hr": "h",
    "hrs": "h",
    "kW·h": "kWh",
    "W·h": "Wh",
    "um": "µm",
    "meter": "m",
    "millimeter": "mm",
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


_PLURALS = {f"{unit.name}s": unit for unit in UNITS}
_NUMBER = re.compile(r"[+-]?\d{1,30}(?:\.\d{1,30})?(?:[eE][+-]?\d{1,2})?")
_UNIT_START = re.compile(r"[^\W\d]|[°%µμ]")


def find_unit(text: str) -> Unit | None:
    """Return the unit that a text means: a symbol, another spelling of one, a name or a code."""
    text = text.replace("⋅", "·").replace("*", "·")
    for sign in "/·":
        text = sign.join(part.strip() for part in text.split(sign))
    return _UNITS_BY_TEXT.get(_SPELLINGS.get(text, text)) or _PLURALS.get(text)


def split_quantity(text: str) -> tuple[Fraction, str] | None:
    """Return the number and the unit of a text such as ``9 s`` or ``9 [s]``; None without both."""
    text = text.strip()
    number = _NUMBER.match(text)
    if number is None:
        return None
    unit = text[number.end() :].strip().removeprefix("[").removesuffix("]").strip()
    is_unit = _UNIT_START.match(unit) and "[" not in unit and "]" not in unit
    return (Fraction(number[0]), unit) if is_unit else None


def convert(number: Fraction, unit: str, target: str) -> Fraction | None:
    """Return the number in the unit *target*; None for units of other quantities or without."""
    if unit == target:
        return number
    source, goal = find_unit(unit), find_unit(target)
    if source is None or goal is None or source.quantity != goal.quantity:
        return None
    if source.symbol == goal.symbol:
        return number
    if not (source.factor and goal.factor):
        return None
    return number * Fraction(source.factor) / Fraction(goal.factor)


_SCALES = {
    "°C_abs": ("K", Fraction(1), Fraction("273.15")),
    "°F_abs": ("K", Fraction(5, 9), Fraction(229835, 900)),
}
"""Interval scales of the SysML v2 library: their unit, its size, and the value of their zero."""


def measure(number: Fraction, unit: str) -> tuple[Fraction, str]:
    """Return the quantity as a number of the first unit of its kind, and the symbol of that unit.

    A unit that no exact factor converts to such a unit stays itself, as an unknown one does.
    """
    if unit in _SCALES:
        symbol, factor, shift = _SCALES[unit]
        return number * factor + shift, symbol
    source = find_unit(unit)
    if source is None:
        return number, unit
    bases = (u for u in UNITS if u.quantity == source.quantity and u.factor == "1")
    base = next(bases, None)
    if base is None or not source.factor:
        return number, source.symbol
    return number * Fraction(source.factor), base.symbol


def find_scale(unit: str) -> tuple[Fraction, Fraction]:
    """Return the size and the zero of a unit: ``measure`` returns ``size * number + zero``."""
    zero, unit_value = (measure(Fraction(value), unit)[0] for value in (0, 1))
    return unit_value - zero, zero


def express(number: Fraction, unit: str) -> Fraction:
    """Return a number as ``measure`` returns it as a number of *unit*."""
    size, zero = find_scale(unit)
    return (number - zero) / size


def show_symbol(unit: str) -> str:
    """Return the symbol of a unit for people: ``°C`` for the scale ``°C_abs``."""
    usual_unit = find_unit(unit)
    return unit.removesuffix("_abs") if usual_unit is None else usual_unit.symbol


def read_number(text: str, unit: str) -> Fraction | None:
    """Return the number in a text, in the unit that ``measure`` returns for *unit*.

    A number without a unit is in *unit*; ``17 °C`` is a temperature, not a difference, where *unit*
    is one of temperatures. The result is None for any other text, and for units that differ.
    """
    text = text.strip()
    quantity = (Fraction(text), unit) if _NUMBER.fullmatch(text) else split_quantity(text)
    if quantity is None:
        return None
    base = measure(Fraction(0), unit)[1]
    readings = (measure(quantity[0], symbol) for symbol in (quantity[1], f"{quantity[1]}_abs"))
    return next((number for number, symbol in readings if symbol == base), None)


# -- times -------------------------------------------------------------------------------------

STEP = Unit("tick", "step", "time", factor="")
"""A step of a contract; the option ``tick_seconds`` states its length."""
_STEP_WORDS = ("tick", "ticks", "step", "steps")
_TIME_WORD = re.compile(r"\s*(after|at)(?=[\s(])", re.IGNORECASE)
_PARENTHESES = re.compile(r"\(([^()]*)\)")


def find_time_unit(word: str) -> Unit | None:
    """Return the unit of time or the step that a word in prose or a tag means in any letter case.

    A quantity of a model is exact: ``SI::H`` is the henry, not the hour.
    """
    if word.lower() in _STEP_WORDS:
        return STEP
    unit = find_unit(word) or find_unit(word.lower())
    return unit if unit is not None and unit.quantity == STEP.quantity else None


def list_time_words() -> list[str]:
    """Return the words that ``find_time_unit`` knows, in lower case, the longest first."""
    words = {word.lower() for word in (*_SPELLINGS, *_UNITS_BY_TEXT, *_PLURALS, *_STEP_WORDS)}
    return sorted(filter(find_time_unit, words), key=lambda word: (-len(word), word))


class Duration(NamedTuple):
    """A number, as it is written, of units of time or of steps."""

    digits: str
    unit: Unit

    def count_steps(self, tick_seconds: float) -> Fraction:
        """Return the number of steps of *tick_seconds* seconds, which may be no whole number."""
        if self.unit is STEP:
            return Fraction(self.digits)
        return Fraction(self.digits) * Fraction(self.unit.factor) / Fraction(str(tick_seconds))

    @property
    def milliseconds(self) -> Fraction | None:
        """The duration in milliseconds; None if it counts steps."""
        return convert(Fraction(self.digits), self.unit.symbol, "ms")


class Time(NamedTuple):
    """A time at which something occurs; ``text`` lacks the words ``after`` and ``at``.

    A relative time counts from the moment at which the wait for it begins. Without ``duration`` it
    is not constant.
    """

    text: str
    is_relative: bool
    duration: Duration | None

    def __str__(self) -> str:
        text = f"{self.duration.digits} {self.duration.unit.symbol}" if self.duration else self.text
        return f"{'after' if self.is_relative else 'at'} {text}"


def read_duration(text: str) -> Duration | None:
    """Return the duration in a text such as ``5 s``, ``5s`` or ``5``, which is in seconds."""
    text = text.strip()
    number = _NUMBER.match(text)
    if number is None or number[0].startswith("-"):
        return None
    quantity = split_quantity(text if number.end() < len(text) else f"{text} s")
    unit = None if quantity is None else find_time_unit(quantity[1])
    return None if unit is None else Duration(number[0], unit)


def read_time(text: str, *, is_relative: bool = False) -> Time:
    """Return the time of a text; a text that begins with ``after`` is relative."""
    word = _TIME_WORD.match(text)
    content = text[word.end() :].strip() if word else text.strip()
    inner = _PARENTHESES.fullmatch(content)
    if inner is not None and read_duration(inner[1]) is not None:
        content = inner[1].strip()
    is_relative = is_relative or (word is not None and word[1].lower() == "after")
    return Time(content, is_relative, read_duration(content) if is_relative else None)
