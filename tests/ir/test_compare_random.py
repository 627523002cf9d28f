"""Random models and random changes: a comparison tells exactly what was done."""

from functools import cache
from random import Random

import pytest

from dialects.graph_mutations import KINDS, Mutation, reissued
from dialects.random_models import random_model
from sysmlc.diagnostics import Coverage, Sink
from sysmlc.frontends.xmi import FRONTEND
from sysmlc.ir import Graph
from sysmlc.ir.compare import compare
from sysmlc.passes import pipeline
from sysmlc.sources import Source


@cache
def model(seed):
    return random_model(Random(seed), size=2)


def read(seed):
    graph, sink = Graph(), Sink()
    FRONTEND.read([Source("model.uml", model(seed))], graph, sink, Coverage())
    pipeline.pipeline(["resolve"]).run(graph, sink)
    return graph


SEEDS = range(12)


@pytest.mark.parametrize("seed", SEEDS)
def test_a_model_does_not_differ_from_itself(seed):
    assert compare(read(seed), read(seed)) == []


@pytest.mark.parametrize("seed", SEEDS)
def test_new_ids_another_order_and_other_places_are_no_difference(seed):
    assert compare(read(seed), reissued(read(seed), Random(seed))) == []


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", SEEDS)
def test_one_change_is_told_and_nothing_else(kind, seed):
    changed = read(seed)
    mutation = Mutation(changed, Random(seed))
    assert mutation.make(kind)
    assert told(compare(read(seed), changed)) == [(mutation.what, mutation.name, mutation.aspect)]


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", SEEDS)
def test_one_change_is_told_too_when_all_ids_are_new(kind, seed):
    changed = read(seed)
    mutation = Mutation(changed, Random(seed))
    assert mutation.make(kind)
    assert told(compare(read(seed), reissued(changed, Random(seed)))) == [
        (mutation.what, mutation.name, mutation.aspect)
    ]


def told(changes):
    return [(str(change.what), change.name, change.aspect) for change in changes]
