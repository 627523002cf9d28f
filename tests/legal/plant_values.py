"""Attributes of AutomationML with values, units and constraints that fit their data types."""

from random import Random

VALUES = {
    "xs:double": ("1.5", "0", "-2e3", "INF", "7"),
    "xs:float": ("1.5", "-0.25"),
    "xs:decimal": ("10.00", "+3", "-.5"),
    "xs:integer": ("7", "0", "-3", "+4", "007"),
    "xs:int": ("7", "-3"),
    "xs:long": ("9000000000",),
    "xs:short": ("-300",),
    "xs:byte": ("-128",),
    "xs:unsignedInt": ("4294967295",),
    "xs:unsignedByte": ("255",),
    "xs:positiveInteger": ("1",),
    "xs:nonNegativeInteger": ("0",),
    "xs:boolean": ("true", "false", "1", "0"),
    "xs:string": ("text", "", " two  blanks ", "a\nb", "é <&> \"'"),
    "xs:token": ("word",),
    "xs:anyURI": ("http://example.org/a?b=c#d", "a%20b.xml", "file:///c:/x.xml"),
    "xs:dateTime": ("2024-02-29T12:00:00Z", "2024-01-01T00:00:00.5+01:00"),
    "xs:date": ("2024-02-29", "2023-12-31Z"),
    "xs:time": ("23:59:59", "08:30:00.25"),
    "xs:duration": ("PT5S", "P1DT2H", "-P1M"),
    "xs:hexBinary": ("0FB7", ""),
    "xs:base64Binary": ("AQID",),
    "xs:language": ("de-AT",),
    "": ("anything", "7", "true"),
}
"""Data types with texts of their lexical space (XML Schema part 2)."""

NUMERIC_TYPES = ("xs:double", "xs:float", "xs:decimal", "xs:integer", "xs:int")
UNITS = ("m", "mm", "kg", "s", "m/s", "°C", "kPa", "%", "rpm", "m^3/h", "SEC", "C62", "kW", "N·m")
"""Symbols of ISO 80000 and codes of UN/ECE recommendation 20."""


class Values:
    """Draws data types, values, units and constraints."""

    def __init__(self, random: Random) -> None:
        self.random = random

    def choose_type(self) -> str:
        return self.random.choice([*sorted(VALUES), *["xs:double"] * 12])

    def choose_value(self, type_: str) -> str:
        return self.random.choice(VALUES[type_])

    def choose_unit(self, type_: str) -> str:
        """Return a unit for a number, sometimes; other types have none."""
        has_unit = type_ in NUMERIC_TYPES and self.random.random() < 0.6
        return self.random.choice(UNITS) if has_unit else ""

    def choose_constraint(self, type_: str, value: str) -> tuple[str, list[tuple[str, str]]]:
        """Return the scale of a constraint that *value* satisfies, and its texts by tag."""
        scales = ["NominalScaledType", "UnknownType"]
        if type_ in NUMERIC_TYPES and value not in ("INF", ""):
            scales.append("OrdinalScaledType")
        scale = self.random.choice(scales)
        if scale == "UnknownType":
            return scale, [("Requirements", self.random.choice(("", "any", "x > y & z")))]
        if scale == "NominalScaledType":
            others = self.random.sample(VALUES[type_], min(2, len(VALUES[type_])))
            return scale, [("RequiredValue", text) for text in {value: 0, **dict.fromkeys(others)}]
        number = int(float(value))
        texts = [("RequiredMaxValue", f"{number + 5}"), ("RequiredMinValue", f"{number - 5}")]
        return scale, [pair for pair in texts if self.random.random() < 0.7]
