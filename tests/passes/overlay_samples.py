"""A small plant for the tests of overlays, and a helper that applies overlays to it."""

from sysmlc.diagnostics import Sink
from sysmlc.ir import Graph
from sysmlc.ir.text import parse_text
from sysmlc.overlay import read_overlay
from sysmlc.overlay.model import Refinement
from sysmlc.passes import pipeline
from sysmlc.sources import Source

PLANT = """\
Package plant "Plant"
  Class track "Track" role="interface block"
  Class tag "Tag" role="block"
  Class stopper "Stopper" role="block"
    Port s-in "p_sIn"
      -> typed-by track
    Port s-out "p_sOut"
      -> typed-by track
  Class switch "Switch" role="block"
    Port w-in "p_swIn" direction="in"
      -> typed-by track
  Class gate "Gate" role="block"
    Operation gate.open "open"
    Property st "st" aggregation="composite" role="part"
      -> typed-by stopper
    Property sw "sw" aggregation="composite" role="part"
      -> typed-by switch
    Connector l1 "l1"
      -> end l1.a l1.b
      ConnectorEnd l1.a
        -> role s-out
        -> path st
      ConnectorEnd l1.b
        -> role w-in
        -> path sw
    Connector loop "loop"
      -> end loop.a loop.b
      ConnectorEnd loop.a
        -> role s-out
        -> path st
      ConnectorEnd loop.b
        -> role s-in
        -> path st
    Connector twin1 "twin"
    Connector twin2 "twin"
"""
MODEL = """\
Package model "Gate" @gate.uml:1
  Activity handle "Handle" @gate.uml:2
    Parameter handle.p "pallet" @gate.uml:3
    Control start "start" subkind="initial" @gate.uml:4
    ControlFlow flow @gate.uml:5
      -> flow-source start
      -> flow-target call
    Action call "getIn" subkind="call-operation" @gate.uml:6
"""
ITEMS = "overlay: 1\nitems:\n  MiniPallet: {domain: physical}\n"
FLOW = ITEMS + "connectors:\n  Plant/Gate/l1:\n    flows:\n    - "
GATE = "overlay: 1\nblocks:\n  Plant/Gate:\n"
HANDLED = GATE + "    behavior: gate.uml#Gate::Handle\n"
GETS_IN = "  Plant/Switch: {operations: {getIn: }}\n"


def read_overlay_text(text: str, sink: Sink, file: str = "plant.overlay.yaml") -> Refinement | None:
    """Return the content of an overlay, or None if it is faulty."""
    return read_overlay(Source(file, text.encode("utf-8")), sink)


def apply_overlays(
    *overlays: str, model: str = PLANT + MODEL, until: str = "overlay"
) -> tuple[Graph, Sink]:
    """Run the passes up to *until* on a model with overlays; return the graph and diagnostics."""
    graph, sink = parse_text(model), Sink()
    refinements = [
        read_overlay_text(text, sink, f"{number}.overlay.yaml")
        for number, text in enumerate(overlays)
    ]
    graph.store(Refinement, [refinement for refinement in refinements if refinement is not None])
    pipeline.run(graph, sink, verify_each=True, until=until)
    return graph, sink


def find_element(graph, name, kind=None):
    """Return the first element of this name."""
    return next(e for e in graph if e.name == name and kind in (None, e.kind))
