"""The symbol of a derived unit of QUDV is computed from its factors."""

import pytest
from pass_runs import print_after_second_run, run_until

from sysmlc.ir.text import print_text

QUDV = """\
Package qudv "QUDV"
  Class unit "Unit"
    Property unit.symbol "symbol"
  Class derived "DerivedUnit"
    -> specializes unit
    Property derived.factor "factor"
  Class factor "UnitFactor"
    Property factor.unit "unit"
    Property factor.exponent "exponent"
  Class rational "Rational"
    Property rational.n "numerator"
    Property rational.d "denominator"
Instance m "metre"
  -> instance-of unit
  Slot m.s value="m"
    -> instance-of unit.symbol
Instance s "second"
  -> instance-of unit
"""


def print_speed_unit(*factors: tuple[str, str]) -> str:
    text = QUDV + 'Instance v "speed"\n  -> instance-of derived\n  Slot v.f\n'
    text += "    -> instance-of derived.factor\n    -> references "
    text += " ".join(f"f{number}" for number, _ in enumerate(factors)) + "\n"
    for number, (unit, exponent) in enumerate(factors):
        text += f'Instance f{number} "f"\n  -> instance-of factor\n'
        text += f"  Slot f{number}.u\n    -> instance-of factor.unit\n    -> references {unit}\n"
        text += f"  Slot f{number}.e{exponent}\n"
    return text


def print_exponent(value: str) -> str:
    return f" value={value}\n    -> instance-of factor.exponent"


HALF = (
    "\n    -> instance-of factor.exponent\n    -> references half\n"
    'Instance half "half"\n  -> instance-of rational\n'
    "  Slot half.n value=1\n    -> instance-of rational.n\n"
    "  Slot half.d value=2\n    -> instance-of rational.d"
)


@pytest.mark.parametrize(
    ("factors", "symbol"),
    [
        ([("m", print_exponent("1")), ("s", print_exponent("-1"))], "m·second^-1"),
        ([("m", print_exponent("2"))], "m^2"),
        ([("m", HALF)], "m^(1/2)"),
        ([("factor", print_exponent("1"))], None),
    ],
)
def test_the_symbol_of_a_derived_unit_is_composed_of_its_factors(factors, symbol):
    graph, _ = run_until(print_speed_unit(*factors), "classify")
    assert graph["v"].role == "unit"
    assert graph["v"].attrs.get("symbol") == symbol


def test_the_pass_is_idempotent():
    graph, _ = run_until(
        print_speed_unit(("m", print_exponent("1")), ("s", print_exponent("-1"))), "classify"
    )
    once = print_text(graph)
    assert print_after_second_run(graph, "classify") == once


def test_a_class_of_the_plant_named_unit_is_no_unit_of_qudv():
    graph, _ = run_until(QUDV.replace('"QUDV"', '"Plant"'), "classify")
    assert graph["m"].role == ""
