"""Contracts in every form: what was written is read again, and says the same."""

import json
import re

import jsonschema
import pytest
import spot
from contract_cases import canonical, contracts
from hypothesis import given, settings

from long_runs import examples
from sysmlc.diagnostics import Sink
from sysmlc.logic import formats
from sysmlc.logic.formats import NotExpressibleError
from sysmlc.support import resources

GAMES = ("gr1c", "slugsin", "structured")
TEXTS = (*GAMES, "tlsf", "spot", "smv", "chase", "chasejson", "neutral", "contract")


@pytest.mark.parametrize("form", TEXTS)
@given(contract=contracts)
@settings(max_examples=examples(60), deadline=None)
def test_what_was_written_is_read_again(form, contract):
    try:
        text = formats.write(contract, form)
    except NotExpressibleError as error:
        assert form == "gr1c"
        assert error.conjunct is not None  # noqa: PT017
        return
    sink = Sink()
    (again,) = formats.read(text, "Gate.txt", sink, form)
    assert [found.message for found in sink] == []
    assert canonical(again) == canonical(formats.lower(contract, form))


@given(contract=contracts)
@settings(max_examples=examples(30), deadline=None)
def test_spin_s_formula_is_read_again_but_for_ranges(contract):
    text = formats.write(contract, "spin")
    sink = Sink()
    (again,) = formats.read(text, "Gate.spin.ltl", sink)
    assert [found.message for found in sink] == []
    names = {one.name: one.owner for one in contract.variables}
    assert {one.name: one.owner for one in again.variables}.items() <= names.items()
    lines = [one.splitlines()[0] for one in (text, formats.write(again, "spin"))]
    formulas = [re.sub(r"\{(.*?)\}", r'"\1"', one) for one in lines]
    assert spot.are_equivalent(*map(spot.formula, formulas))


SCHEMAS = {"neutral": "neutral-contract", "chasejson": "chase-contract"}


@pytest.mark.parametrize(("form", "schema"), SCHEMAS.items())
@given(contract=contracts)
@settings(max_examples=examples(25), deadline=None)
def test_json_is_as_its_schema_says(form, schema, contract):
    rules = json.loads(resources.read_text("metamodels", f"{schema}.schema.json"))
    jsonschema.validate(json.loads(formats.write(contract, form)), rules)
