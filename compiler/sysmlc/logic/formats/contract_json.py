"""Contracts in JSON: ``sysmlc-contract`` and the neutral form of corpus/gr1.

Both have the same structure. In sysmlc-contract, the content of ``<component>.contract.json``, a
conjunct is an object with formula, class, origin and text; in the neutral form it is the formula.
"""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from fractions import Fraction

import msgspec

from sysmlc.documents import DocumentError, Value, find_in_string, list_violations, parse_json
from sysmlc.logic.classification import convert_to_class
from sysmlc.logic.contract import (
    BooleanDomain,
    Class,
    Conjunct,
    Contract,
    Domain,
    EnumerationDomain,
    IntegerDomain,
    Owner,
    Source,
    Variable,
)
from sysmlc.logic.formats import rules
from sysmlc.logic.formats.draft import SECTION_NAMES, SIDES, SpecificationFile
from sysmlc.logic.formats.lowering import rename_ambiguous_literals
from sysmlc.logic.infix import FormulaReader, parse_formula
from sysmlc.logic.printing import print_formula
from sysmlc.logic.regions import Cut, Interval, Regions, print_number
from sysmlc.logic.syntax import FormulaError
from sysmlc.support.output import encode_json
from sysmlc.support.suggestions import find_similar

FORMATS = ("sysmlc-contract/1", "sysmlc-contract/2")
"""The second version adds the numbers behind literals; a contract without them has the first."""
_LOW_ENDS, _HIGH_ENDS = ("from", "above"), ("below", "up_to")
"""Members for the ends of an interval, by whether the cut is above the number."""
_NEUTRAL_KEYS = ("name", "origin", "variables", *SIDES.values())


class _Numbers(msgspec.Struct, omit_defaults=True):
    """The member ``numbers`` of a variable: the regions of a number and the sum that it is."""

    intervals: tuple[Mapping[str, str], ...] = ()
    unit: str = ""
    symbol: str = ""
    integers: bool = False
    words: Mapping[str, str] = {}
    term: Mapping[str, str] = {}
    constants: tuple[str, ...] = ()


class _NeutralReader(FormulaReader):
    """Reads formulas of corpus/gr1, in which numbers may stand for literals of enumerations."""

    accepts_literal_numbers = True


class ShapeError(Exception):
    """A value that a contract cannot have, although the schema allows it."""

    def __init__(self, reason: str, value: Value) -> None:
        super().__init__(reason)
        self.offset = value.spot.character


# -- reading ---------------------------------------------------------------------------------------


def read(file: SpecificationFile) -> tuple[Contract, ...]:
    """Return the contract of the file, or nothing if a fault was reported."""
    reported_before = len(file.sink)
    document = read_document(file, "JSON")
    if document is None:
        return ()
    try:
        contract = _read_contract(file, document)
    except ShapeError as error:
        file.report(rules.WRONG_SHAPE, error.offset, what=str(error))
        return ()
    return () if len(file.sink) > reported_before else (contract,)


def read_document(file: SpecificationFile, language: str, schema: str = "") -> Value | None:
    """Return the JSON object of the file; report what *schema* forbids, and return None.

    Without *schema*, the member ``format`` distinguishes the two forms of a contract.
    """
    try:
        document = parse_json(file.text)
    except DocumentError as error:
        reason = error.problem
        file.report(rules.NOT_UNDERSTOOD, error.spot.character, form=language, reason=reason)
        return None
    if not schema:
        is_neutral = document.get("format") is None
        schema = "neutral-contract" if is_neutral else "sysmlc-contract"
        for key in document.keys if is_neutral else ():
            # Other members are comments, unless they are conjuncts that would be lost.
            similar = "" if key in _NEUTRAL_KEYS else find_similar(key, _NEUTRAL_KEYS)
            if similar:
                what = f"at the top: unknown key '{key}'; did you mean '{similar}'?"
                file.report(rules.WRONG_SHAPE, document.keys[key].character, what=what)
    violations = list_violations(document, f"{schema}.schema.json")
    for violation in violations:
        file.report(rules.WRONG_SHAPE, violation.spot.character, what=str(violation))
    return None if violations else document


def _read_contract(file: SpecificationFile, document: Value) -> Contract:
    variables = tuple(
        _read_variable(name, declaration)
        for name, declaration in document.iter_entries("variables")
    )
    domains = {variable.name: variable.domain for variable in variables}
    assumptions, guarantees = (
        tuple(_read_side(file, document, side, domains)) for side in SIDES.values()
    )
    name, origin = document.get_text("name"), document.get_text("origin")
    return Contract(name, origin, variables, assumptions, guarantees)


def _read_variable(name: str, declaration: Value) -> Variable:
    check_name(name, declaration)
    domain = read_domain(name, declaration.find(["type"]))
    numbers = declaration.get("numbers")
    if numbers is not None:
        if not isinstance(domain, EnumerationDomain):
            raise ShapeError(f"the type of '{name}' has no literals for its numbers", numbers)
        domain = replace(domain, regions=_read_regions(name, domain, numbers))
    sum_ = _Numbers() if numbers is None else msgspec.convert(numbers.as_json(), _Numbers)
    return Variable(
        name,
        Owner(declaration.get_text("owner")),
        domain,
        declaration.get_text("origin"),
        is_auxiliary=declaration.get("auxiliary") is not None,
        is_range_assumed="assumed" in declaration.keys and isinstance(domain, IntegerDomain),
        condition=declaration.get_text("condition"),
        reason=declaration.get_text("reason"),
        wording=declaration.get_text("wording"),
        term=tuple((name, Fraction(factor)) for name, factor in sum_.term.items()),
        constants=sum_.constants,
    )


def _read_regions(name: str, domain: EnumerationDomain, numbers: Value) -> Regions:
    """Return the regions behind the literals of a variable. Raises ShapeError."""
    document = msgspec.convert(numbers.as_json(), _Numbers)
    intervals = tuple(map(_read_interval, document.intervals))
    ends = [cut for interval in intervals for cut in (interval.low, interval.high)]
    is_ascending = all(interval.intersect(interval) for interval in intervals) and all(
        high is not None and low is not None and high <= low
        for high, low in zip(ends[1:-1:2], ends[2::2], strict=True)
    )
    if len(intervals) != len(domain.literals) or not is_ascending:
        reason = f"the intervals of '{name}' are not one for each literal in ascending order"
        raise ShapeError(reason, numbers)
    words = tuple((Fraction(number), word) for number, word in document.words.items())
    return Regions(intervals, document.unit, document.integers, words, document.symbol)


def _read_interval(ends: Mapping[str, str]) -> Interval:
    def find_cut(below: str, above: str) -> Cut | None:
        cuts = (Cut(Fraction(ends[key]), key == above) for key in (below, above) if key in ends)
        return next(cuts, None)

    return Interval(find_cut(*_LOW_ENDS), find_cut(*_HIGH_ENDS))


def check_name(name: str, declaration: Value) -> None:
    """Raise ShapeError unless the name of a variable can stand in formulas."""
    if not name.isidentifier():
        raise ShapeError(f"'{name}' is not a valid name in formulas", declaration)


def read_domain(name: str, type_: Value) -> Domain:
    """Return the domain of a type: ``"bool"``, ``[0, 7]`` or ``["open", "closed"]``.

    Raises ShapeError.
    """
    match type_.as_json():
        case [int() | float() as low, int() | float() as high]:
            if low > high:
                raise ShapeError(f"the range of '{name}' is empty: {low}..{high}", type_)
            return IntegerDomain(int(low), int(high))
        case [*literals]:
            return _read_enumeration(name, list(map(str, literals)), type_)
        case _:
            return BooleanDomain()


def _read_enumeration(name: str, literals: list[str], type_: Value) -> Domain:
    for literal in literals:
        if not literal.isidentifier():
            raise ShapeError(f"'{literal}' of '{name}' is not a valid name in formulas", type_)
    return EnumerationDomain(tuple(literals))


def _read_side(
    file: SpecificationFile, document: Value, side: str, domains: Mapping[str, Domain]
) -> Iterator[Conjunct]:
    for class_ in Class:
        for item in document.find([side]).list_items(class_):
            conjunct = _read_conjunct(file, item, side, class_, domains)
            if conjunct is not None:
                yield conjunct


def _read_conjunct(
    file: SpecificationFile, item: Value, side: str, class_: Class, domains: Mapping[str, Domain]
) -> Conjunct | None:
    """Read a conjunct: a formula, or an object with formula, origin and text.

    Report a faulty formula and return None.
    """
    section = SECTION_NAMES[side, class_]
    text = item.get("formula") or item
    start = text.spot.character + 1
    try:
        formula = parse_formula(str(text.scalar), domains, _NeutralReader)
    except FormulaError as error:
        offset = start + find_in_string(text, error.offset)
        file.report(rules.WRONG_FORMULA, offset, section=section, reason=str(error))
        return None
    step = convert_to_class(formula, class_)
    if step is None:
        reason = "it has primes" if class_ is Class.INIT else "it looks further than one step"
        file.report(
            rules.WRONG_CLASS, start, formula=str(text.scalar), section=section, reason=reason
        )
        return None
    origin = item.get_text("origin") if item is not text else file.origin_at(start)
    source = Source(item.get_text("source") or Source.AUTHOR)
    return Conjunct(step, class_, origin, item.get_text("text"), source=source)


# -- writing ---------------------------------------------------------------------------------------


def lower(contract: Contract, format_name: str) -> Contract:
    """Return the contract without ambiguous names; JSON expresses everything else."""
    return rename_ambiguous_literals(contract)


def write(contract: Contract, format_name: str) -> str:
    """Return the contract in one of the two formats."""
    lowered = lower(contract, format_name)
    return print_contract(lowered) if format_name == "contract" else _print_neutral(lowered)


def print_contract(contract: Contract) -> str:
    """Return the contract as a document after metamodels/sysmlc-contract.schema.json."""
    has_numbers = any(variable.term for variable in contract.variables)
    document = {
        "format": FORMATS[has_numbers],
        "name": contract.component,
        "origin": contract.origin,
        "variables": {variable.name: _encode_variable(variable) for variable in contract.variables},
        "assumptions": _group_by_class(contract.assumptions),
        "guarantees": _group_by_class(contract.guarantees),
    }
    return encode_json(document, 2)


def _encode_variable(variable: Variable) -> dict[str, object]:
    entry: dict[str, object] = {
        "owner": str(variable.owner),
        "type": encode_domain(variable.domain),
        "origin": variable.origin,
    }
    if variable.is_auxiliary:
        entry["auxiliary"] = True
    if variable.is_range_assumed:
        entry["assumed"] = True
    if variable.condition:
        entry["condition"] = variable.condition
    if variable.reason:
        entry["reason"] = variable.reason
    if variable.wording:
        entry["wording"] = variable.wording
    if isinstance(variable.domain, EnumerationDomain) and variable.domain.regions is not None:
        entry["numbers"] = msgspec.to_builtins(_encode_numbers(variable, variable.domain.regions))
    return entry


def _encode_numbers(variable: Variable, regions: Regions) -> _Numbers:
    return _Numbers(
        tuple(map(_encode_interval, regions.intervals)),
        regions.unit,
        regions.symbol,
        regions.is_integral,
        {print_number(number): word for number, word in regions.labels},
        {name: print_number(factor) for name, factor in variable.term},
        variable.constants,
    )


def _encode_interval(interval: Interval) -> dict[str, str]:
    ends = (interval.low, _LOW_ENDS), (interval.high, _HIGH_ENDS)
    return {keys[cut.is_above]: print_number(cut.number) for cut, keys in ends if cut is not None}


def _group_by_class(conjuncts: Iterable[Conjunct]) -> dict[str, list[dict[str, str]]]:
    """Return the conjuncts of each class; the list of a class without conjuncts is empty."""
    groups: dict[str, list[dict[str, str]]] = {str(class_): [] for class_ in Class}
    for conjunct in conjuncts:
        entry = {
            "formula": print_formula(conjunct.formula),
            "class": str(conjunct.class_),
            "origin": conjunct.origin,
            "text": conjunct.text,
        }
        if conjunct.is_derived:
            entry["source"] = str(conjunct.source)
        groups[str(conjunct.class_)].append(entry)
    return groups


def encode_domain(domain: Domain) -> str | list[int] | list[str]:
    """Return a domain as JSON: ``bool``, least and greatest value, or the literals."""
    match domain:
        case BooleanDomain():
            return "bool"
        case IntegerDomain(low, high):
            return [low, high]
        case EnumerationDomain(literals):
            return list(literals)


def _print_neutral(contract: Contract) -> str:
    """Return the contract in the neutral form, indented by one."""
    document: dict[str, object] = {
        "name": contract.component,
        "variables": {
            variable.name: {"owner": str(variable.owner), "type": encode_domain(variable.domain)}
            for variable in contract.variables
        },
        "assumptions": _list_formulas(contract.assumptions),
        "guarantees": _list_formulas(contract.guarantees),
    }
    return encode_json(document)


def _list_formulas(conjuncts: Iterable[Conjunct]) -> dict[str, list[str]]:
    """Return the formulas of each class; omit the class "other" if it is empty.

    GR(1) tools, for which the neutral form was made, know the other three classes only.
    """
    formulas: dict[str, list[str]] = {str(class_): [] for class_ in Class}
    for conjunct in conjuncts:
        formulas[str(conjunct.class_)].append(print_formula(conjunct.formula))
    if not formulas[str(Class.OTHER)]:
        del formulas[str(Class.OTHER)]
    return formulas
