"""The comparison of random models reports exactly the change that was made."""

from functools import cache
from random import Random

import pytest

from dialects.graph_mutations import KINDS, Mutation, copy_with_new_ids
from dialects.random_models import random_model
from dialects.random_plants import random_plant
from long_runs import quick_first
from sysmlc.diagnostics import Coverage, Sink
from sysmlc.frontends.caex import FRONTEND as CAEX
from sysmlc.frontends.xmi import FRONTEND as XMI
from sysmlc.ir import Graph
from sysmlc.ir.compare import compare
from sysmlc.passes import pipeline
from sysmlc.sources import Source

READERS = {
    "uml": (XMI, lambda seed: random_model(Random(seed), size=2)),
    "aml": (CAEX, lambda seed: random_plant(Random(seed))),
}
SEEDS = [*(("uml", seed) for seed in range(12)), *(("aml", seed) for seed in range(8))]


@cache
def document(form, seed):
    return READERS[form][1](seed)


def read(form, seed):
    graph, sink = Graph(), Sink()
    source = Source(f"model.{form}", document(form, seed))
    READERS[form][0].read([source], graph, sink, Coverage())
    pipeline.build_pipeline(["resolve"]).run(graph, sink)
    return graph


@pytest.mark.parametrize(("form", "seed"), SEEDS)
def test_a_model_does_not_differ_from_itself(form, seed):
    assert compare(read(form, seed), read(form, seed)) == []


@pytest.mark.parametrize(("form", "seed"), SEEDS)
def test_new_ids_another_order_and_other_locations_are_no_difference(form, seed):
    assert compare(read(form, seed), copy_with_new_ids(read(form, seed), Random(seed))) == []


@pytest.mark.parametrize(("form", "seed"), SEEDS)
def test_elements_without_names_are_matched_by_their_surroundings(form, seed):
    old, new = read(form, seed), read(form, seed)
    for graph in (old, new):
        for element in list(graph):
            graph.rename(element, "")
    assert compare(old, copy_with_new_ids(new, Random(seed))) == []


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("model", quick_first(SEEDS, 6), ids=str)
def test_exactly_the_change_is_reported_with_old_ids_and_with_new_ids(kind, model):
    form, seed = model
    changed = read(form, seed)
    mutation = Mutation(changed, Random(seed))
    expected = (
        [] if not mutation.apply(kind) else [(mutation.change, mutation.name, mutation.aspect)]
    )
    assert list_changes(compare(read(form, seed), changed)) == expected
    assert (
        list_changes(compare(read(form, seed), copy_with_new_ids(changed, Random(seed))))
        == expected
    )


def test_every_kind_of_change_is_made_at_least_once():
    for kind in KINDS:
        for form in READERS:
            seeds = [seed for reader, seed in SEEDS if reader == form]
            mutations = (Mutation(read(form, seed), Random(seed)).apply(kind) for seed in seeds)
            assert any(mutations), (kind, form)


def list_changes(changes):
    return [(str(change.what), change.name, change.aspect) for change in changes]
