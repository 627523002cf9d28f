"""JSON format of chase-mcp: inputs and outputs with types, conjuncts as strings in LTL."""

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
from sysmlc.logic.formats.chase import lower
from sysmlc.logic.formats.contract_json import (
    ShapeError,
    check_name,
    object_at,
    read_document,
    read_domain,
    text_at,
)
from sysmlc.logic.formats.draft import (
    SIDES,
    ContractDraft,
    LocatedList,
    LocatedObject,
    LocatedText,
    SpecificationFile,
)
from sysmlc.logic.formats.writing import (
    LTL_WORDS,
    Notation,
    add_prime,
    convert_to_word,
    print_ltl_conjunct,
)
from sysmlc.logic.infix import parse_formula
from sysmlc.logic.syntax import FormulaError
from sysmlc.support.output import encode_json

__all__ = ["lower", "read", "write"]
_OWNERS = {"inputs": Owner.ENVIRONMENT, "outputs": Owner.SYSTEM}
_NOTATION = Notation(LTL_WORDS, add_prime)


def read(file: SpecificationFile) -> tuple[Contract, ...]:
    """Return the contract of the file, or nothing if a fault was reported."""
    document = read_document(file, "chase JSON")
    if document is None:
        return ()
    draft = ContractDraft(file, "chase JSON")
    try:
        _read_document(draft, document)
        return draft.build(text_at(document, "name"))
    except ShapeError as error:
        file.report(rules.WRONG_SHAPE, error.offset, what=str(error))
        return ()


def _read_document(draft: ContractDraft, document: LocatedObject) -> None:
    for title, owner in _OWNERS.items():
        declarations = object_at(document, title)
        for name in declarations.duplicates:
            draft.report_fault(rules.DECLARED_TWICE, declarations.offset, name=name)
        for name, type_ in declarations.items():
            _declare(draft, name, type_, declarations.offset, owner)
    for owner, side in SIDES.items():
        for text in _list_texts(document, side):
            _read_conjunct(draft, owner, text)


def _declare(draft: ContractDraft, name: str, type_: object, offset: int, owner: Owner) -> None:
    if type_ == "real":
        type_offset = getattr(type_, "offset", offset)
        draft.report_outside(type_offset, f"'{name}', which is a real number,")
        return
    check_name(name, offset)
    draft.declare(name, offset, owner, read_domain(name, type_, offset))


def _list_texts(document: LocatedObject, side: str) -> list[LocatedText]:
    texts = document.get(side, LocatedList())
    if not isinstance(texts, LocatedList) or not all(
        isinstance(text, LocatedText) for text in texts
    ):
        offset = getattr(texts, "offset", document.offset)
        raise ShapeError(f"'{side}' is not a list of formulas", offset)
    return texts


def _read_conjunct(draft: ContractDraft, owner: Owner, text: LocatedText) -> None:
    try:
        draft.add_ltl(owner, parse_formula(text, draft.domains), text.offset)
    except FormulaError as error:
        draft.report_fault(
            rules.WRONG_FORMULA,
            text.offset_of(error.offset),
            section=SIDES[owner],
            reason=str(error),
        )


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
    return [print_ltl_conjunct("chase JSON", _NOTATION, conjunct) for conjunct in conjuncts]
