"""A model of SysML v1 has the same contracts after it was saved as SysML v2 text or as UML."""

import pytest

from refinement import run_all
from sysmlc.backends.sysml import LIBRARY, print_document
from sysmlc.backends.uml import write_document
from sysmlc.diagnostics import Coverage, Sink
from sysmlc.frontends.sysml import FRONTEND as SYSML
from sysmlc.frontends.xmi import FRONTEND as XMI
from sysmlc.ir import Graph, parse_text
from sysmlc.logic.contract import Contract
from sysmlc.logic.formula import Apply, Op
from sysmlc.logic.printing import print_formula
from sysmlc.sources import Source
from sysmlc.support import resources

START = """
Package p "Plant"
  Class t "Thing"
  Signal go "Go"
  Activity a "Run"
    Parameter pi "n" direction="in"
      -> typed-by t
    Parameter po "r" direction="out"
      -> typed-by t
    ActivityParameter ni "n" direction="in"
      -> references pi
      -> typed-by t
    ActivityParameter no "r" direction="out"
      -> references po
      -> typed-by t
"""
NODES = {
    "i": 'Control i "begin" subkind="initial"',
    "i2": 'Control i2 "second" subkind="initial"',
    "f": 'Control f "f" subkind="fork"',
    "j": 'Control j "j" subkind="join"',
    "d": 'Control d "d" subkind="decision"',
    "m": 'Control m "" subkind="merge"',
    "e": 'Control e "end" subkind="final"',
    "ff": 'Control ff "ff" subkind="flow-final"',
    "b": 'ObjectNode b "buffer"\n      -> typed-by t',
    "s": 'DataStore s "store"\n      -> typed-by t',
    "ni": "",
    "no": "",
    "g": """Structured g "group" subkind="structured"
      Pin g.i "gin" direction="in" subkind="structured-node-input"
        -> typed-by t
      Pin g.o "gout" direction="out" subkind="structured-node-output"
        -> typed-by t
      Action l "l" subkind="opaque"
        Pin l.i "li" direction="in" subkind="input-value"
          -> typed-by t
      ObjectFlow gl ""
        -> flow-source g.i
        -> flow-target l.i""",
    "c": """Action c "risky" subkind="opaque" handlers=[[["h"],["h.i"],["t"]]]
    Action h "handle" subkind="opaque"
      Pin h.i "fault" direction="in" subkind="input-value"
        -> typed-by t""",
    "w": """Structured zone "zone" subkind="interruptible"
    Action w "wait" subkind="accept"
      -> in-partition zone
      -> trigger w.t
      Trigger w.t "" subkind="signal"
        -> typed-by go""",
}
"""Nodes by id; every other id is that of an action with the pins ``i`` and ``o``."""
ACTION = """Action {id} "{id}" subkind="opaque"
      Pin {id}.i "in1" direction="in" subkind="input-value"{bounds}
        -> typed-by t
      Pin {id}.o "out1" direction="out" subkind="output-value"
        -> typed-by t"""
UNASKED = 'guard="true" guard_literal=true'
"""The guard that modelling tools write for every flow."""


def draw_model(drawing, bounds=""):
    """Return a model in text form. A line of a drawing is a flow, with its attributes at the end.

    Flows that start or end at a pin or store are object flows.
    """
    ids, flows = {}, []
    for number, line in enumerate(drawing.split(";")):
        source, _, target, attributes = (line.strip() + " ").split(" ", 3)
        for end in (source, target):
            ids[end.partition(".")[0]] = None
        has_objects = "." in source + target or {source, target} & {"b", "s", "ni", "no"}
        kind = "ObjectFlow" if has_objects else "ControlFlow"
        flows.append(
            f'{kind} flow{number} "" {attributes}\n'
            f"      -> flow-source {source}\n      -> flow-target {target}"
        )
    nodes = [NODES.get(id, ACTION.format(id=id, bounds=bounds)) for id in ids]
    return START + "".join(f"    {text}\n" for text in (*nodes, *flows) if text)


def list_contracts(graph):
    """Return the formulas of each contract; the order of the operands does not matter."""
    return {
        contract.component: sorted(
            sort_operands(conjunct.formula)
            for conjunct in (*contract.assumptions, *contract.guarantees)
        )
        for contract in graph.derived(Contract)
    }


def sort_operands(formula):
    if not isinstance(formula, Apply):
        return print_formula(formula)
    operands = [sort_operands(operand) for operand in formula.args]
    if formula.op in (Op.AND, Op.OR, Op.IFF):
        operands.sort()
    return f"{formula.op.value}({', '.join(operands)})"


def read_again(graph, backend):
    """Return the graph of the model that a back end writes."""
    copy = Graph()
    if backend == "uml":
        sources = [Source("model.uml", write_document(graph, Sink()).encode())]
        XMI.read(sources, copy, Sink(), Coverage())
    else:
        sources = [Source("model.sysml", print_document(graph, Sink())[0].encode())]
        sources += [Source(LIBRARY, resources.read_text("metamodels", LIBRARY).encode())]
        SYSML.read(sources, copy, Sink(), Coverage())
    run_all(copy, Sink())
    return copy


DRAWINGS = {
    "fork-and-join": "i > x; x.o > f; f > y.i; f > z.i; y.o > j; z.o > j; j > k.i",
    "buffer": "i > x; x.o > b; b > y.i; y > e",
    "buffer-with-two-readers": "i > x; x.o > b; b > y.i; b > z.i",
    "store-and-fork": "i > x; x.o > s; s > f; f > y.i; f > z.i; x > y; y > z; z > e",
    "parameters-and-fork": "ni > f; f > x.i; f > y.i; y.o > m; m > no",
    "buffer-ends-in-a-flow-final": "i > x; x.o > b; b > ff; x > y; y > e",
    "pin-with-two-readers": "i > x; x.o > y.i; x.o > z.i; y > e",
    "start-with-two-flows": "i > x; i > y; x > e; y > e",
    "two-starts": "i > x; i2 > y; y > e",
    "merge-with-two-flows": "i > x; x > m; m > y; m > z",
    "flow-final": "i > f; f > x; f > y; x > ff; y > e",
    "unasked-guards": f"i > f {UNASKED}; f > x {UNASKED}; f > y {UNASKED}; x > z {UNASKED}; "
    f"y > z {UNASKED}; z > e {UNASKED}",
    "unasked-guards-past-a-fork": f"ni > f {UNASKED}; f > x.i {UNASKED}; f > y.i {UNASKED}",
    "guard-on-one-of-two-flows": 'i > f; f > x; f > y; x > z guard="open"; y > z; z > e',
    "merge-of-guarded-flows": 'i > d; d > m guard="open"; d > x guard="else"; x > m; m > y; y > e',
    "guard-between-pins": 'i > x; x.o > y.i guard="open"; y > e',
    "structured-node": "i > x; x.o > g.i; g > y; y > e",
    "exception-handler": "i > c; c > y; y > e",
    "interruptible-region": 'i > x; w > q interrupts="zone"; x > m; q > m; m > e',
}


@pytest.mark.parametrize("backend", ["sysml", "uml"])
@pytest.mark.parametrize("drawing", DRAWINGS.values(), ids=DRAWINGS)
def test_the_contracts_of_an_activity_are_the_same(drawing, backend):
    graph = parse_text(draw_model(drawing))
    run_all(graph, Sink())
    contracts = list_contracts(graph)
    assert contracts
    assert list_contracts(read_again(graph, backend)) == contracts


@pytest.mark.parametrize("bounds", ["2", "0..1", "0..*"])
def test_the_bounds_of_a_pin_restrict_the_flows_as_before(bounds):
    drawing = "i > f; f > x; f > y; x.o > z.i; y.o > z.i; z > e"
    graph = parse_text(draw_model(drawing, f' multiplicity="{bounds}"'))
    run_all(graph, Sink())
    contracts = list_contracts(graph)
    for backend in ("sysml", "uml"):
        assert list_contracts(read_again(graph, backend)) == contracts
