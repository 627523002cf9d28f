"""A contract as the content of ``<component>.contract.json`` (sysmlc-contract/1).

The neutral form of corpus/gr1 with ``{formula, class, origin, text}`` for each conjunct.
"""

from collections.abc import Iterable

from sysmlc.logic.contract import (
    BooleanDomain,
    Class,
    Conjunct,
    Contract,
    Domain,
    EnumerationDomain,
    IntegerDomain,
)
from sysmlc.logic.printing import print_formula
from sysmlc.support.json_text import encode_json

FORMAT = "sysmlc-contract/1"


def text(contract: Contract) -> str:
    """Return the contract as a document after metamodels/sysmlc-contract.schema.json."""
    document = {
        "format": FORMAT,
        "name": contract.component,
        "origin": contract.origin,
        "variables": {
            variable.name: {
                "owner": str(variable.owner),
                "type": type_of(variable.domain),
                "origin": variable.origin,
            }
            for variable in contract.variables
        },
        "assumptions": _group_by_class(contract.assumptions),
        "guarantees": _group_by_class(contract.guarantees),
    }
    return encode_json(document, 2)


def _group_by_class(conjuncts: Iterable[Conjunct]) -> dict[str, list[dict[str, str]]]:
    """Return the conjuncts of each class, of classes without conjuncts an empty list."""
    groups: dict[str, list[dict[str, str]]] = {str(class_): [] for class_ in Class}
    for conjunct in conjuncts:
        groups[str(conjunct.class_)].append(
            {
                "formula": print_formula(conjunct.formula),
                "class": str(conjunct.class_),
                "origin": conjunct.origin,
                "text": conjunct.text,
            }
        )
    return groups


def type_of(domain: Domain) -> str | list[int] | list[str]:
    """A domain as JSON: ``bool``, least and greatest value, or the literals."""
    match domain:
        case BooleanDomain():
            return "bool"
        case IntegerDomain(low, high):
            return [low, high]
        case EnumerationDomain(literals):
            return list(literals)


def neutral(contract: Contract) -> str:
    """JSON of the contract in the form of corpus/gr1, indented by one."""
    variables = {
        one.name: {"owner": str(one.owner), "type": type_of(one.domain)}
        for one in contract.variables
    }
    sides = {
        side: {
            str(class_): [print_formula(one.formula) for one in conjuncts if one.class_ is class_]
            for class_ in Class
            if class_ is not Class.OTHER or any(one.class_ is class_ for one in conjuncts)
        }
        for side, conjuncts in (
            ("assumptions", contract.assumptions),
            ("guarantees", contract.guarantees),
        )
    }
    return encode_json({"name": contract.component, "variables": variables} | sides)
