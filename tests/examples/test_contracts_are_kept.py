"""The contracts of every example can be kept, and nothing in them is suspicious."""

import pytest

from examples.compiling import EXAMPLES, PLANT, TEXT, compile_example
from sysmlc.diagnostics import Sink
from sysmlc.logic.contract import Contract
from sysmlc.synthesis.contract_checks import check_contracts
from sysmlc.synthesis.decision import Options

MODELS = [*EXAMPLES, PLANT, TEXT]


@pytest.mark.parametrize("path", MODELS, ids=lambda path: f"{path.parent.name}/{path.name}")
def test_the_contracts_of_an_example_are_kept_and_not_suspicious(path):
    made, sink = compile_example(path), Sink()
    graph = made.graph
    found = graph.derived(Contract)
    results = check_contracts(
        found, found, lambda origin: graph.subject(graph[origin]), sink, Options()
    )
    verdicts = {one.verdict.component: one.verdict.is_realizable for one in results}
    assert [name for name, is_kept in verdicts.items() if not is_kept] == []
    assert [(one.rule.code, one.message) for one in sink] == []
    assert verdicts
