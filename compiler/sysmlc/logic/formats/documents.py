"""Contracts in JSON: the neutral form of corpus/gr1 and our own sysmlc-contract/1."""

from collections.abc import Iterator, Mapping
from typing import NoReturn

from sysmlc.logic.classification import convert_to_class
from sysmlc.logic.contract import (
    BooleanDomain,
    Class,
    Conjunct,
    Contract,
    Domain,
    EnumerationDomain,
    IntegerDomain,
    Variable,
)
from sysmlc.logic.formats import rules
from sysmlc.logic.formats.base import OWNERS, SECTIONS
from sysmlc.logic.formats.file import File
from sysmlc.logic.formats.lower import unambiguous
from sysmlc.logic.formats.placed import PlacedList, PlacedObject, PlacedText, loads
from sysmlc.logic.infix import Reader
from sysmlc.logic.ltl import FormulaError, parse_formula

FORMAT = "sysmlc-contract/1"
_SIDES = ("assumptions", "guarantees")


class _Reader(Reader):
    """The files of corpus/gr1 name the literals of enumerations by their numbers too."""

    counts_literals = True


class ShapeError(Exception):
    """JSON that is no contract: what is wrong, and where."""

    def __init__(self, what: str, at: int) -> None:
        super().__init__(what)
        self.at = at


def value(file: File, form: str) -> PlacedObject | None:
    """The object that the file is, or None, which is reported."""
    try:
        found = loads(file.text)
    except RecursionError:
        file.report(rules.NOT_UNDERSTOOD, 0, form=form, reason="it is nested too deeply")
        return None
    except ValueError as error:
        at, reason = getattr(error, "pos", 0), getattr(error, "msg", str(error))
        file.report(rules.NOT_UNDERSTOOD, at, form=form, reason=f"it is no JSON: {reason}")
        return None
    if isinstance(found, PlacedObject):
        return found
    file.report(rules.WRONG_SHAPE, 0, what="a contract is a JSON object")
    return None


def read(file: File) -> tuple[Contract, ...]:
    """The contract of the file; none when anything in it is wrong, which is reported."""
    found = value(file, "JSON")
    if found is None:
        return ()
    before = len(file.sink)
    try:
        contract = _contract(file, found)
    except ShapeError as error:
        file.report(rules.WRONG_SHAPE, error.at, what=str(error))
        return ()
    return () if len(file.sink) > before else (contract,)


def _contract(file: File, found: PlacedObject) -> Contract:
    declared = object_at(found, "variables")
    for name in declared.again:
        file.report(rules.DECLARED_TWICE, declared.at, name=name)
    variables = tuple(_variable(name, given, declared.at) for name, given in declared.items())
    known = {variable.name: variable.domain for variable in variables}
    sides = [tuple(_side(file, found, side, known)) for side in _SIDES]
    return Contract(text_at(found, "name"), text_at(found, "origin"), variables, *sides)


def object_at(owner: PlacedObject, name: str) -> PlacedObject:
    """The object of that name, an empty one when there is none. Raises ShapeError."""
    found = owner.get(name)
    if found is None and name not in owner:
        found = PlacedObject()
        found.at, found.again = owner.at, ()
    if not isinstance(found, PlacedObject):
        raise ShapeError(f"'{name}' is not an object", owner.at)
    return found


def text_at(owner: PlacedObject, name: str) -> str:
    """The text of that name, empty when there is none. Raises ShapeError."""
    found = owner.get(name, "")
    if not isinstance(found, str):
        raise ShapeError(f"'{name}' is not a text", owner.at)
    return str(found)


def _variable(name: str, given: object, at: int) -> Variable:
    if not isinstance(given, PlacedObject):
        raise ShapeError(f"the variable '{name}' is not an object with owner and type", at)
    if not name.isidentifier():
        raise ShapeError(f"'{name}' is no name that formulas can have", given.at)
    owner = given.get("owner")
    if not isinstance(owner, PlacedText) or owner not in OWNERS:
        place = owner.at if isinstance(owner, PlacedText) else given.at
        raise ShapeError(f"the owner of '{name}' is neither 'env' nor 'sys'", place)
    domain = domain_of(name, given.get("type"), given.at)
    return Variable(name, OWNERS[owner], domain, text_at(given, "origin"))


def domain_of(name: str, type_: object, at: int) -> Domain:
    """The domain that a type says: ``"bool"``, ``[0, 7]`` or ``["open", "closed"]``.

    Raises ShapeError.
    """
    match type_:
        case "bool" | "boolean":
            return BooleanDomain()
        case [int(low), int(high)] if isinstance(low, int) and not isinstance(low, bool):
            return _range(name, low, high, at)
        case [str(), *_] if isinstance(type_, list) and all(isinstance(one, str) for one in type_):
            return _enumeration(name, [str(one) for one in type_], at)
        case _:
            what = 'is not "bool", not [least, greatest] and no list of names'
            raise ShapeError(f"the type of '{name}' {what}", getattr(type_, "at", at))


def _range(name: str, low: int, high: int, at: int) -> Domain:
    if isinstance(high, bool) or low > high:
        raise ShapeError(f"the range of '{name}' is empty: {low}..{high}", at)
    return IntegerDomain(low, high)


def _enumeration(name: str, literals: list[str], at: int) -> Domain:
    for literal in literals:
        if not literal.isidentifier():
            raise ShapeError(f"'{literal}' of '{name}' is no name that formulas can have", at)
        if literals.count(literal) > 1:
            raise ShapeError(f"'{name}' has the value '{literal}' twice", at)
    return EnumerationDomain(tuple(literals))


def _side(
    file: File, found: PlacedObject, side: str, known: Mapping[str, Domain]
) -> Iterator[Conjunct]:
    given = object_at(found, side)
    for name in [*given.again, *(one for one in given if one not in list(Class))]:
        raise ShapeError(f"'{name}' of the {side} is twice there or no class", given.at)
    for class_ in Class:
        conjuncts = given.get(class_, PlacedList())
        if not isinstance(conjuncts, PlacedList):
            raise ShapeError(f"'{class_}' of the {side} is not a list", given.at)
        for one in conjuncts:
            made = _conjunct(file, one, SECTIONS[side, class_], class_, known, conjuncts.at)
            if made is not None:
                yield made


def _conjunct(
    file: File, given: object, section: str, class_: Class, known: Mapping[str, Domain], at: int
) -> Conjunct | None:
    """A conjunct: its formula alone, or an object with formula, origin and text."""
    text = given.get("formula") if isinstance(given, PlacedObject) else given
    if not isinstance(text, PlacedText):
        _no_formula(section, getattr(given, "at", at))
    origin, words = file.origin(text.at), ""
    if isinstance(given, PlacedObject):
        origin, words = text_at(given, "origin"), text_at(given, "text")
    try:
        formula = parse_formula(text, known, _Reader)
    except FormulaError as error:
        place = text.offset(error.at)
        file.report(rules.WRONG_FORMULA, place, section=section, reason=str(error))
        return None
    step = convert_to_class(formula, class_)
    if step is None:
        reason = "it has primes" if class_ is Class.INIT else "it looks further than one step"
        file.report(rules.WRONG_CLASS, text.at, formula=text, section=section, reason=reason)
        return None
    return Conjunct(step, class_, origin, words)


def _no_formula(section: str, at: int) -> NoReturn:
    raise ShapeError(f"one of the {section} is neither a formula nor an object with one", at)


def write(contract: Contract, form: str) -> str:
    """The contract in the neutral form, or in ours."""
    from sysmlc.logic.formats.document_text import neutral, text

    made = plain(contract, form)
    return text(made) if form == "contract" else neutral(made)


def plain(contract: Contract, form: str) -> Contract:
    """The contract: JSON has words for all of it."""
    return unambiguous(contract)
