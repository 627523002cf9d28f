"""Random overlays: the pass is idempotent, ignores the order of entries and never crashes."""

import json
from random import Random

from hypothesis import given
from hypothesis import strategies as st
from overlay_samples import MODEL, PLANT, read_overlay_text
from pass_runs import list_codes, list_diagnostics
from random_structures import structures

from sysmlc.diagnostics import Sink
from sysmlc.ir import Graph
from sysmlc.ir.text import parse_text, print_text
from sysmlc.ir.verify import verify
from sysmlc.overlay import read_overlay
from sysmlc.overlay.model import Refinement
from sysmlc.passes.overlay import Overlay
from sysmlc.sources import Source

WORDS = [
    "Plant/Gate/l1",
    "Plant/Gate/loop",
    "Plant/Gate/twin",
    "l1",
    "Plant/Gate",
    "Plant/Switch",
    "Plant/Stopper",
    "Plant/Gate/st",
    "Plant/Switch/p_swIn",
    "s-in",
    "s-out",
    "Plant/Tag",
    "MiniPallet",
    "Heavy",
    "gate.uml#Gate::Handle",
    "gate.uml#Gate::Gone",
    "Gate::Handle",
    "st",
    "sw",
    "st/p_sOut",
    "p_sIn",
    "getIn",
    "open",
    "String",
    "no such thing",
    "[odd/path]",
    "#",
    "/",
    "::",
]
signs = st.sampled_from("aZé9 /[]#:.@'-")
words = st.sampled_from(WORDS) | st.text(signs, min_size=1, max_size=5)
names = st.sampled_from(["go", "open", "getIn", "st", "v"])


def mapping(**optional):
    return st.fixed_dictionaries({}, optional=optional)


items = mapping(
    domain=st.sampled_from(["physical", "information"]),
    description=st.text(signs, max_size=5),
    specializes=st.lists(words, max_size=2),
    path=words,
)
ports = mapping(direction=st.sampled_from(["in", "out", "inout"]), type=words, path=words)
flows = st.one_of(
    st.fixed_dictionaries({"item": words, "to": words}, optional={"from": words}),
    st.fixed_dictionaries({"item": words, "from": words}),
    st.fixed_dictionaries({"item": words, "both-ways": st.just(True)}),
)
connectors = st.fixed_dictionaries(
    {"flows": st.lists(flows, min_size=1, max_size=3)}, optional={"path": words}
)
parameters = st.fixed_dictionaries(
    {"name": names},
    optional={"type": words, "direction": st.sampled_from(["in", "out", "inout", "return"])},
)
operations = mapping(
    parameters=st.lists(parameters, max_size=2),
    method=words,
    description=st.text(signs, max_size=5),
)
values = mapping(type=words, default=st.booleans() | st.integers() | st.text(signs, max_size=3))
blocks = mapping(
    path=words,
    specializes=st.lists(words, max_size=2),
    values=st.dictionaries(names, values, max_size=2),
    operations=st.dictionaries(names, operations, max_size=2),
    behavior=words,
    calls=st.dictionaries(names, words, max_size=2),
)
allocations = st.fixed_dictionaries({"from": words, "to": words})
overlays = st.fixed_dictionaries(
    {"overlay": st.just(1)},
    optional={
        "package": words,
        "items": st.dictionaries(words, items, max_size=3),
        "ports": st.dictionaries(words, ports, max_size=2),
        "connectors": st.dictionaries(words, connectors, max_size=3),
        "blocks": st.dictionaries(words, blocks, max_size=3),
        "allocations": st.lists(allocations, max_size=2),
    },
)


def apply_overlay(overlay):
    """Apply an overlay, written as JSON, to the plant; return the graph and the diagnostics."""
    graph, sink = parse_text(PLANT + MODEL), Sink()
    refinement = read_overlay_text(json.dumps(overlay, ensure_ascii=False), sink)
    assert refinement is not None, [diagnostic.message for diagnostic in sink]
    graph.store(Refinement, [refinement])
    Overlay().run(graph, sink)
    assert verify(graph) == []
    return graph, sink


def shuffle(value, random):
    """Return the same overlay with its entries in another order, except parameters."""
    if isinstance(value, dict):
        return {
            key: value[key] if key == "parameters" else shuffle(value[key], random)
            for key in random.sample(list(value), len(value))
        }
    if isinstance(value, list):
        return [shuffle(item, random) for item in random.sample(value, len(value))]
    return value


def print_without_locations(graph: Graph) -> str:
    for element in graph:
        element.ordinal = 0
    return print_text(graph)


@given(overlays)
def test_the_pass_is_idempotent(overlay):
    graph, _ = apply_overlay(overlay)
    once = print_text(graph)
    Overlay().run(graph, Sink())
    assert print_text(graph) == once


@given(overlays, st.integers(0, 1 << 30))
def test_the_order_of_entries_does_not_matter(overlay, seed):
    graph, sink = apply_overlay(overlay)
    shuffled_graph, shuffled_sink = apply_overlay(shuffle(overlay, Random(seed)))
    assert print_without_locations(graph) == print_without_locations(shuffled_graph)
    assert sorted(list_diagnostics(sink)) == sorted(list_diagnostics(shuffled_sink))


@given(overlays)
def test_every_diagnostic_has_a_location(overlay):
    for diagnostic in apply_overlay(overlay)[1]:
        assert diagnostic.subject.place is not None
        assert diagnostic.subject.place.file in ("plant.overlay.yaml", "gate.uml")


@given(st.text(max_size=60))
def test_any_text_is_an_overlay_or_reported(text):
    sink = Sink()
    refinement = read_overlay_text("overlay: 1\n" + text, sink)
    assert (refinement is None) == bool(len(sink))


@given(st.binary(max_size=60))
def test_any_bytes_are_an_overlay_or_reported(data):
    sink = Sink()
    refinement = read_overlay(Source("p.overlay.yaml", data), sink)
    assert (refinement is None) == bool(len(sink))


@given(structures(), overlays, st.randoms(use_true_random=False))
def test_overlays_of_random_models_leave_a_valid_graph(graph, overlay, random):
    ids = [element.id for element in graph] or ["none"]
    text = json.dumps(overlay, ensure_ascii=False)
    for word in WORDS:
        text = text.replace(json.dumps(word), json.dumps(random.choice(ids), ensure_ascii=False))
    sink = Sink()
    refinement = read_overlay_text(text, sink)
    if refinement is None:
        assert list_codes(sink) == ["SM323"] * len(sink)
        return
    graph.store(Refinement, [refinement])
    Overlay().run(graph, sink)
    assert verify(graph) == []
    once = print_text(graph)
    Overlay().run(graph, sink)
    assert print_text(graph) == once
