"""The result of a name lookup does not depend on earlier lookups."""

import sys
from random import Random

import pytest
from official_models import FOLDER, parse_folder
from small_models import (
    list_name_errors,
    load_library,
    parse_texts,
    resolve_texts,
    target_name,
)

from sysmlc.language.library import find_library
from sysmlc.language.names import Model

_WORDS = ("A", "B", "C", "D")


@pytest.fixture(autouse=True)
def allow_deep_recursion():
    """Looking a name up may look up other names, so random models need a deep stack."""
    depth = sys.getrecursionlimit()
    sys.setrecursionlimit(20_000)
    yield
    sys.setrecursionlimit(depth)


def test_the_name_of_an_import_is_not_looked_up_in_the_other_imports_first():
    """Otherwise ``import Tools::*`` meant ``Parts::Tools`` if ``Parts`` was looked up first."""
    model = resolve_texts(
        "package Parts { package Tools { part def Own; } }",
        "package Tools { part def Drill; }",
        "package Cell { private import Parts::*; private import Tools::*; part d : Drill; }",
    )
    assert target_name(model, "Cell::d") == "Tools::Drill"


def test_an_import_may_name_an_imported_package():
    model = resolve_texts(
        "package Parts { package Tools { part def Drill; } }",
        "package Cell { private import Tools::*; private import Parts::*; part d : Drill; }",
    )
    assert target_name(model, "Cell::d") == "Parts::Tools::Drill"


def test_the_type_of_metadata_is_not_looked_up_in_the_base_type_that_the_metadata_implies():
    model = resolve_texts("""
        private import Metaobjects::SemanticMetadata;
        metadata def Service :> SemanticMetadata { :>> baseType = services meta SysML::Usage; }
        action services { metadata def Service; }
        action drill { @Service; }
    """)
    owner = model.documents[0].root.members[-1]
    assert model.target(owner.members[0], owner.members[0].relations[0]).owner.owner is None
    assert "services" in [model.name(general) for general in model.all_supertypes(owner)]


def test_the_ends_of_a_message_do_not_refer_to_each_other():
    text = "part pump; message from pump to pump;"
    flow = resolve_texts(text).documents[0].root.members[1]
    ends = [end for end in flow.members if end.kind == "EventOccurrenceUsage"]
    assert [end.relations[0].reference.target.kind for end in ends] == ["PartUsage", "PartUsage"]
    assert list_name_errors(text) == []


def write_member(random, depth):
    """Return a declaration or an import; many names are cyclic or unknown."""
    first, second, third = (random.choice(_WORDS) for _ in range(3))
    kinds = [
        f"public import {second}::*;",
        f"private import {second}::{third};",
        f"part def {first} :> {second};",
        f"part {first.lower()} : {second};",
        f"part {first.lower()} : {second}::{third};",
        f"action def {first} {{ in x : {second}; }}",
    ]
    if depth < 2:
        inner = " ".join(write_member(random, depth + 1) for _ in range(random.randrange(1, 4)))
        kinds += [f"package {first} {{ {inner} }}", f"part def {first} {{ {inner} }}"] * 3
    return random.choice(kinds)


def write_texts(random):
    """Return three files that refer to each other."""
    return ["\n".join(write_member(random, 0) for _ in range(3)) for _ in range(3)]


def describe(model, node):
    """Return the location of an element, which no lookup changes."""
    return None if node is None else (model.document(node).path, node.kind, node.start)


def look_up_everything(documents, library, random=None):
    """Return the targets of all references and all generals, looked up in some order."""
    model = Model(documents, library)
    nodes = [node for document in documents for node in document.root.walk()]
    lookups = [(node, None) for node in nodes]
    lookups += [(node, relation) for node in nodes for relation in node.relations]
    order = list(range(len(lookups)))
    if random:
        random.shuffle(order)
    results = [None] * len(lookups)
    for index in order:
        node, relation = lookups[index]
        if relation is not None:
            results[index] = describe(model, model.target(node, relation))
        else:
            generals = model.lookup.all_generals(node)
            results[index] = [describe(model, general) for general in generals]
    return results


@pytest.mark.parametrize("seed", range(60))
def test_small_models_have_the_same_targets_in_any_order_of_lookups(seed):
    texts = write_texts(Random(seed))
    expected = look_up_everything(parse_texts(*texts), load_library())
    for order in range(3):
        targets = look_up_everything(parse_texts(*texts), load_library(), Random(order))
        assert targets == expected


@pytest.mark.corpus
@pytest.mark.parametrize(
    "folder", ["ice-lab", "omg-release/training", "omg-release/examples", "showcase"]
)
def test_real_models_have_the_same_targets_in_any_order_of_lookups(folder):
    shuffled = look_up_everything(parse_folder(FOLDER / folder), find_library(), Random(folder))
    assert shuffled == look_up_everything(parse_folder(FOLDER / folder), find_library())
