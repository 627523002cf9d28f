"""Contracts in JSON: ``sysmlc-contract/1`` and the neutral form of corpus/gr1.

Both have the same structure. In sysmlc-contract/1, the content of ``<component>.contract.json``, a
conjunct is an object with formula, class, origin and text; in the neutral form it is the formula.
"""

from collections.abc import Iterable, Iterator, Mapping

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
from sysmlc.logic.formats.draft import (
    SECTION_NAMES,
    SIDES,
    LocatedList,
    LocatedObject,
    LocatedText,
    SpecificationFile,
    parse_json,
)
from sysmlc.logic.formats.lowering import rename_ambiguous_literals
from sysmlc.logic.infix import FormulaReader, parse_formula
from sysmlc.logic.printing import print_formula
from sysmlc.logic.syntax import FormulaError
from sysmlc.support.output import encode_json

FORMAT = "sysmlc-contract/1"
_OWNERS = {str(owner): owner for owner in Owner}


class _NeutralReader(FormulaReader):
    """Reads formulas of corpus/gr1, in which numbers may stand for literals of enumerations."""

    accepts_literal_numbers = True


class ShapeError(Exception):
    """JSON that does not have the shape of a contract, with the offset of the fault."""

    def __init__(self, reason: str, offset: int) -> None:
        super().__init__(reason)
        self.offset = offset


# -- reading ---------------------------------------------------------------------------------------


def read(file: SpecificationFile) -> tuple[Contract, ...]:
    """Return the contract of the file, or nothing if a fault was reported."""
    document = read_document(file, "JSON")
    if document is None:
        return ()
    reported_before = len(file.sink)
    try:
        contract = _read_contract(file, document)
    except ShapeError as error:
        file.report(rules.WRONG_SHAPE, error.offset, what=str(error))
        return ()
    return () if len(file.sink) > reported_before else (contract,)


def read_document(file: SpecificationFile, language: str) -> LocatedObject | None:
    """Return the JSON object of the file; report and return None if it is not one."""
    try:
        document = parse_json(file.text)
    except RecursionError:
        file.report(rules.NOT_UNDERSTOOD, 0, form=language, reason="it is nested too deeply")
        return None
    except ValueError as error:
        # A lone ValueError is a number with more digits than Python converts.
        offset, reason = getattr(error, "pos", 0), getattr(error, "msg", str(error))
        file.report(rules.NOT_UNDERSTOOD, offset, form=language, reason=f"it is not JSON: {reason}")
        return None
    if isinstance(document, LocatedObject):
        return document
    file.report(rules.WRONG_SHAPE, 0, what="a contract is a JSON object")
    return None


def _read_contract(file: SpecificationFile, document: LocatedObject) -> Contract:
    declarations = object_at(document, "variables")
    for name in declarations.duplicates:
        file.report(rules.DECLARED_TWICE, declarations.offset, name=name)
    variables = tuple(
        _read_variable(name, declaration, declarations.offset)
        for name, declaration in declarations.items()
    )
    domains = {variable.name: variable.domain for variable in variables}
    assumptions, guarantees = (
        tuple(_read_side(file, document, side, domains)) for side in SIDES.values()
    )
    name, origin = text_at(document, "name"), text_at(document, "origin")
    return Contract(name, origin, variables, assumptions, guarantees)


def object_at(owner: LocatedObject, name: str) -> LocatedObject:
    """Return the member of that name, an empty object if there is none. Raises ShapeError."""
    member = owner.get(name)
    if member is None and name not in owner:
        member = LocatedObject()
        member.offset, member.duplicates = owner.offset, ()
    if not isinstance(member, LocatedObject):
        raise ShapeError(f"'{name}' is not an object", owner.offset)
    return member


def text_at(owner: LocatedObject, name: str) -> str:
    """Return the string of that name, empty if there is none. Raises ShapeError."""
    member = owner.get(name, "")
    if not isinstance(member, str):
        raise ShapeError(f"'{name}' is not a text", owner.offset)
    return str(member)


def _read_variable(name: str, declaration: object, offset: int) -> Variable:
    if not isinstance(declaration, LocatedObject):
        reason = f"the variable '{name}' is not an object with owner and type"
        raise ShapeError(reason, offset)
    check_name(name, declaration.offset)
    owner = declaration.get("owner")
    if not isinstance(owner, LocatedText) or owner not in _OWNERS:
        owner_offset = owner.offset if isinstance(owner, LocatedText) else declaration.offset
        raise ShapeError(f"the owner of '{name}' is neither 'env' nor 'sys'", owner_offset)
    domain = read_domain(name, declaration.get("type"), declaration.offset)
    return Variable(
        name,
        _OWNERS[owner],
        domain,
        text_at(declaration, "origin"),
        is_auxiliary=declaration.get("auxiliary") is True,
        is_range_assumed=declaration.get("assumed") is True and isinstance(domain, IntegerDomain),
        condition=text_at(declaration, "condition"),
        wording=text_at(declaration, "wording"),
    )


def check_name(name: str, offset: int) -> None:
    """Raise ShapeError unless the name of a variable can stand in formulas."""
    if not name.isidentifier():
        raise ShapeError(f"'{name}' is not a valid name in formulas", offset)


def read_domain(name: str, type_: object, offset: int) -> Domain:
    """Return the domain of a type: ``"bool"``, ``[0, 7]`` or ``["open", "closed"]``.

    Raises ShapeError.
    """
    match type_:
        case "bool" | "boolean":
            return BooleanDomain()
        case [int(low), int(high)] if isinstance(low, int) and not isinstance(low, bool):
            if isinstance(high, bool) or low > high:
                raise ShapeError(f"the range of '{name}' is empty: {low}..{high}", offset)
            return IntegerDomain(low, high)
        case [str(), *_] if all(isinstance(literal, str) for literal in type_):
            return _read_enumeration(name, [str(literal) for literal in type_], offset)
        case _:
            reason = 'is not "bool", not [least, greatest] and no list of names'
            type_offset = getattr(type_, "offset", offset)
            raise ShapeError(f"the type of '{name}' {reason}", type_offset)


def _read_enumeration(name: str, literals: list[str], offset: int) -> Domain:
    for literal in literals:
        if not literal.isidentifier():
            reason = f"'{literal}' of '{name}' is not a valid name in formulas"
            raise ShapeError(reason, offset)
        if literals.count(literal) > 1:
            raise ShapeError(f"'{name}' has the value '{literal}' twice", offset)
    return EnumerationDomain(tuple(literals))


def _read_side(
    file: SpecificationFile, document: LocatedObject, side: str, domains: Mapping[str, Domain]
) -> Iterator[Conjunct]:
    classes = object_at(document, side)
    faulty = [*classes.duplicates, *(name for name in classes if name not in list(Class))]
    if faulty:
        raise ShapeError(f"'{faulty[0]}' of the {side} is twice there or no class", classes.offset)
    for class_ in Class:
        items = classes.get(class_, LocatedList())
        if not isinstance(items, LocatedList):
            raise ShapeError(f"'{class_}' of the {side} is not a list", classes.offset)
        for item in items:
            conjunct = _read_conjunct(file, item, side, class_, domains, items.offset)
            if conjunct is not None:
                yield conjunct


def _read_conjunct(
    file: SpecificationFile,
    item: object,
    side: str,
    class_: Class,
    domains: Mapping[str, Domain],
    list_offset: int,
) -> Conjunct | None:
    """Read a conjunct: a formula, or an object with formula, origin and text.

    Report a faulty formula and return None. Raises ShapeError.
    """
    section = SECTION_NAMES[side, class_]
    formula_text = item.get("formula") if isinstance(item, LocatedObject) else item
    if not isinstance(formula_text, LocatedText):
        reason = f"one of the {section} is neither a formula nor an object with one"
        raise ShapeError(reason, getattr(item, "offset", list_offset))
    origin, text, source = file.origin_at(formula_text.offset), "", Source.AUTHOR
    if isinstance(item, LocatedObject):
        origin, text = text_at(item, "origin"), text_at(item, "text")
        source = _read_source(item)
    try:
        formula = parse_formula(formula_text, domains, _NeutralReader)
    except FormulaError as error:
        offset = formula_text.offset_of(error.offset)
        file.report(rules.WRONG_FORMULA, offset, section=section, reason=str(error))
        return None
    step = convert_to_class(formula, class_)
    if step is None:
        reason = "it has primes" if class_ is Class.INIT else "it looks further than one step"
        file.report(
            rules.WRONG_CLASS,
            formula_text.offset,
            formula=formula_text,
            section=section,
            reason=reason,
        )
        return None
    return Conjunct(step, class_, origin, text, source=source)


def _read_source(item: LocatedObject) -> Source:
    """Return who states a conjunct: the author if the object does not say it. Raises ShapeError."""
    text = text_at(item, "source") or Source.AUTHOR
    if text not in list(Source):
        raise ShapeError("the source of a conjunct is neither 'author' nor 'derived'", item.offset)
    return Source(text)


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
    document = {
        "format": FORMAT,
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
    if variable.wording:
        entry["wording"] = variable.wording
    return entry


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
