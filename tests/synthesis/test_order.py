"""The order of bits follows the structure: what is alike is interleaved."""

from contracts_in_lines import contract

from sysmlc.synthesis import Manager, Symbols


def order(text: str) -> list[str]:
    bits = Symbols(Manager(), contract(text).variables).manager.bits
    return [bit for bit in bits if not bit.endswith("'")]


def test_many_numbers_of_one_range_are_interleaved():
    alike = "\n".join(f"sys n{number}: 0..3" for number in range(5))
    assert order(f"{alike}\nenv go: bool") == [
        *(f"n{number}.0" for number in range(5)),
        *(f"n{number}.1" for number in range(5)),
        "go.0",
    ]


def test_few_numbers_and_other_variables_stay_as_declared():
    text = "env a: 0..3\nenv go: bool\nsys b: 0..3\nsys c: 0..4"
    assert order(text) == ["a.0", "a.1", "b.0", "b.1", "go.0", "c.0", "c.1", "c.2"]
