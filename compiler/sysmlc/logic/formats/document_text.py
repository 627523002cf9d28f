"""A contract as the content of ``<component>.contract.json`` (sysmlc-contract/1).

The neutral form of corpus/gr1 with ``{formula, class, origin, text}`` for each conjunct.
"""

from collections.abc import Iterable
from functools import lru_cache
from json.encoder import encode_basestring

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
from sysmlc.logic.printing import print_formula
from sysmlc.output import json_text

FORMAT = "sysmlc-contract/1"
_REMEMBERED = 1 << 10
"""Texts of domains that are kept: most variables are Boolean."""


def text(contract: Contract) -> str:
    """JSON of the contract (metamodels/sysmlc-contract.schema.json), indented by two.

    There are thousands of variables and conjuncts: they are written without dicts between.
    """
    known = {"format": FORMAT, "name": contract.component, "origin": contract.origin}
    head = json_text(known, 2).removesuffix("\n}")
    variables = ",\n    ".join(map(_variable_text, contract.variables))
    named = f"{{\n    {variables}\n  }}" if variables else "{}"
    sides = (("assumptions", contract.assumptions), ("guarantees", contract.guarantees))
    told = "".join(_side_text(*side) for side in sides)
    return f'{head},\n  "variables": {named}{told}\n}}'


def _variable_text(variable: Variable) -> str:
    return (
        f'{encode_basestring(variable.name)}: {{\n      "owner": "{variable.owner}",'
        f'\n      "type": {_type_text(variable.domain)},'
        f'\n      "origin": {encode_basestring(variable.origin)}\n    }}'
    )


@lru_cache(_REMEMBERED)
def _type_text(domain: Domain) -> str:
    return json_text(type_of(domain), 2).replace("\n", "\n      ")


def _side_text(name: str, conjuncts: Iterable[Conjunct]) -> str:
    found: dict[Class, list[str]] = {class_: [] for class_ in Class}
    for one in conjuncts:
        found[one.class_].append(
            f'{{\n        "formula": {encode_basestring(print_formula(one.formula))},'
            f'\n        "class": "{one.class_}",'
            f'\n        "origin": {encode_basestring(one.origin)},'
            f'\n        "text": {encode_basestring(one.text)}\n      }}'
        )
    rows = (
        f'\n    "{class_}": [\n      {joined}\n    ]' if joined else f'\n    "{class_}": []'
        for class_, joined in ((class_, ",\n      ".join(texts)) for class_, texts in found.items())
    )
    return f',\n  "{name}": {{{",".join(rows)}\n  }}'


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
    return json_text({"name": contract.component, "variables": variables} | sides, 1)
