"""JSON format of chase-mcp: inputs and outputs with types, conjuncts as strings in LTL."""

from collections.abc import Iterable

from sysmlc.documents import Value, find_in_string
from sysmlc.logic.contract import (
    BooleanDomain,
    Conjunct,
    Contract,
    IntegerDomain,
    Owner,
    Variable,
)
from sysmlc.logic.formats import rules
from sysmlc.logic.formats.chase import lower
from sysmlc.logic.formats.contract_json import (
    ShapeError,
    check_name,
    read_document,
    read_domain,
)
from sysmlc.logic.formats.draft import SIDES, ContractDraft, SpecificationFile
from sysmlc.logic.formats.writing import (
    LTL_WORDS,
    Notation,
    add_prime,
    convert_to_word,
)
from sysmlc.logic.infix import parse_formula
from sysmlc.logic.syntax import FormulaError
from sysmlc.support.output import encode_json

__all__ = ["lower", "read", "write"]
_OWNERS = {"inputs": Owner.ENVIRONMENT, "outputs": Owner.SYSTEM}
_NOTATION = Notation(LTL_WORDS, add_prime, format_name="chase JSON")


def read(file: SpecificationFile) -> tuple[Contract, ...]:
    """Return the contract of the file, or nothing if a fault was reported."""
    document = read_document(file, "chase JSON", "chase-contract")
    if document is None:
        return ()
    draft = ContractDraft(file, "chase JSON")
    try:
        for title, owner in _OWNERS.items():
            for name, type_ in document.iter_entries(title):
                _declare(draft, name, type_, owner)
    except ShapeError as error:
        file.report(rules.WRONG_SHAPE, error.offset, what=str(error))
        return ()
    for owner, side in SIDES.items():
        for text in document.list_items(side):
            _read_conjunct(draft, owner, text)
    return draft.build(document.get_text("name"))


def _declare(draft: ContractDraft, name: str, type_: Value, owner: Owner) -> None:
    offset = type_.spot.character
    if type_.scalar == "real":
        draft.report_outside(offset, f"'{name}', which is a real number,")
        return
    check_name(name, type_)
    draft.declare(name, offset, owner, read_domain(name, type_))


def _read_conjunct(draft: ContractDraft, owner: Owner, text: Value) -> None:
    start = text.spot.character + 1
    try:
        draft.add_ltl(owner, parse_formula(str(text.scalar), draft.domains), start)
    except FormulaError as error:
        offset = start + find_in_string(text, error.offset)
        draft.report_fault(rules.WRONG_FORMULA, offset, section=SIDES[owner], reason=str(error))


def write(contract: Contract, format_name: str) -> str:
    """Return the contract as JSON; enumerations are encoded as integers."""
    lowered = lower(contract, format_name)
    document: dict[str, object] = {"name": convert_to_word(contract.component)}
    for title, owner in _OWNERS.items():
        document[title] = {
            variable.name: _encode_type(variable)
            for variable in lowered.variables
            if variable.owner is owner
        }
    document["assumptions"] = _list_formulas(lowered.assumptions)
    document["guarantees"] = _list_formulas(lowered.guarantees)
    return encode_json(document, 2)


def _encode_type(variable: Variable) -> object:
    match variable.domain:
        case IntegerDomain(low, high):
            return [low, high]
        case BooleanDomain() | _:
            return "bool"


def _list_formulas(conjuncts: Iterable[Conjunct]) -> list[str]:
    return list(map(_NOTATION.print_ltl_conjunct, conjuncts))
