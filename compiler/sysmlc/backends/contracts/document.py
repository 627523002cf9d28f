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

FORMAT = "sysmlc-contract/1"


def document(contract: Contract) -> dict[str, object]:
    """JSON value of the contract (metamodels/sysmlc-contract.schema.json)."""
    return {
        "format": FORMAT,
        "name": contract.component,
        "origin": contract.origin,
        "variables": {
            variable.name: {
                "owner": variable.owner.value,
                "type": _type(variable.domain),
                "origin": variable.origin,
            }
            for variable in contract.variables
        },
        "assumptions": _side(contract.assumptions),
        "guarantees": _side(contract.guarantees),
    }


def _type(domain: Domain) -> str | list[int] | list[str]:
    match domain:
        case BooleanDomain():
            return "bool"
        case IntegerDomain(low, high):
            return [low, high]
        case EnumerationDomain(literals):
            return list(literals)


def _side(conjuncts: Iterable[Conjunct]) -> dict[str, list[dict[str, str]]]:
    found: dict[str, list[dict[str, str]]] = {class_.value: [] for class_ in Class}
    for one in conjuncts:
        found[one.class_.value].append(
            {
                "formula": print_formula(one.formula),
                "class": one.class_.value,
                "origin": one.origin,
                "text": one.text,
            }
        )
    return found
