"""chase-mcp's JSON: inputs and outputs with types, assumptions and guarantees as LTL in texts."""

from collections.abc import Iterable

from sysmlc.logic.contract import (
    BooleanDomain,
    Conjunct,
    Contract,
    IntegerDomain,
    Owner,
    Variable,
)
from sysmlc.logic.formats import rules
from sysmlc.logic.formats.base import said_ltl
from sysmlc.logic.formats.chase import plain, word
from sysmlc.logic.formats.documents import ShapeError, domain_of, object_at, text_at, value
from sysmlc.logic.formats.draft import SIDE, Draft
from sysmlc.logic.formats.file import File
from sysmlc.logic.formats.placed import PlacedList, PlacedObject, PlacedText
from sysmlc.logic.formats.spelt import LTL, Spelling, primed
from sysmlc.logic.ltl import FormulaError, parse_formula
from sysmlc.support.json_text import encode_json

__all__ = ["plain", "read", "write"]
_DECLARING = {"inputs": Owner.ENVIRONMENT, "outputs": Owner.SYSTEM}
_SPELLING = Spelling(LTL, primed)


def read(file: File) -> tuple[Contract, ...]:
    """The contract of the file; none when anything in it is wrong, which is reported."""
    found = value(file, "chase JSON")
    if found is None:
        return ()
    draft = Draft(file, "chase JSON")
    try:
        _read(draft, found)
        return draft.contracts(text_at(found, "name"))
    except ShapeError as error:
        file.report(rules.WRONG_SHAPE, error.at, what=str(error))
        return ()


def _read(draft: Draft, found: PlacedObject) -> None:
    for title, owner in _DECLARING.items():
        declared = object_at(found, title)
        for name in declared.again:
            draft.fault(rules.DECLARED_TWICE, declared.at, name=name)
        for name, type_ in declared.items():
            _declare(draft, name, type_, declared.at, owner)
    for owner, side in SIDE.items():
        for text in _texts(found, side):
            _conjunct(draft, owner, text)


def _declare(draft: Draft, name: str, type_: object, at: int, owner: Owner) -> None:
    if type_ == "real":
        what = f"'{name}', which is a real number,"
        draft.fault(rules.OUTSIDE, getattr(type_, "at", at), what=what, form="chase JSON")
        return
    if not name.isidentifier():
        raise ShapeError(f"'{name}' is no name that formulas can have", at)
    draft.declare(name, at, owner, domain_of(name, type_, at))


def _texts(found: PlacedObject, side: str) -> list[PlacedText]:
    given = found.get(side, PlacedList())
    if not isinstance(given, PlacedList) or not all(isinstance(one, PlacedText) for one in given):
        raise ShapeError(f"'{side}' is not a list of formulas", getattr(given, "at", found.at))
    return given


def _conjunct(draft: Draft, owner: Owner, text: PlacedText) -> None:
    try:
        draft.add_ltl(owner, parse_formula(text, draft.domains), text.at)
    except FormulaError as error:
        place, section = text.offset(error.at), SIDE[owner]
        draft.fault(rules.WRONG_FORMULA, place, section=section, reason=str(error))


def write(contract: Contract, form: str) -> str:
    """The contract; enumerations are counted."""
    made = plain(contract, form)
    declared = {
        title: {one.name: _type(one) for one in made.variables if one.owner is owner}
        for title, owner in _DECLARING.items()
    }
    said_ = {"assumptions": _lines(made.assumptions), "guarantees": _lines(made.guarantees)}
    return encode_json({"name": word(contract.component)} | declared | said_, 2)


def _type(variable: Variable) -> object:
    match variable.domain:
        case IntegerDomain(low, high):
            return [low, high]
        case BooleanDomain() | _:
            return "bool"


def _lines(conjuncts: Iterable[Conjunct]) -> list[str]:
    return [said_ltl("chase JSON", _SPELLING, one) for one in conjuncts]
