"""What a name leads to does not depend on what was asked before it."""

import sys
from random import Random

import pytest
from resolving import documents, leads, library, resolved, told

from sysmlc.diagnostics import Sink
from sysmlc.language.library import find_library
from sysmlc.language.names import Model
from sysmlc.language.text import parse

_WORDS = ("A", "B", "C", "D")


@pytest.fixture(autouse=True)
def _room():
    """Names lead to names that lead to names."""
    depth = sys.getrecursionlimit()
    sys.setrecursionlimit(20_000)
    yield
    sys.setrecursionlimit(depth)


def test_what_a_namespace_imports_is_looked_at_last_for_its_imports():
    """Else the second import leads to ``Parts::Tools`` only if the first was asked for before."""
    model = resolved(
        "package Parts { package Tools { part def Own; } }",
        "package Tools { part def Drill; }",
        "package Cell { private import Parts::*; private import Tools::*; part d : Drill; }",
    )
    assert leads(model, "Cell::d") == "Tools::Drill"


def test_an_import_may_name_what_another_import_brings():
    model = resolved(
        "package Parts { package Tools { part def Drill; } }",
        "package Cell { private import Tools::*; private import Parts::*; part d : Drill; }",
    )
    assert leads(model, "Cell::d") == "Parts::Tools::Drill"


def test_the_type_of_metadata_is_not_looked_for_in_what_the_metadata_makes_of_its_owner():
    model = resolved("""
        private import Metaobjects::SemanticMetadata;
        metadata def Service :> SemanticMetadata { :>> baseType = services meta SysML::Usage; }
        action services { metadata def Service; }
        action drill { @Service; }
    """)
    owner = model.documents[0].root.members[-1]
    assert model.target(owner.members[0], owner.members[0].relations[0]).owner.owner is None
    assert "services" in [model.name(one) for one in model.all_supertypes(owner)]


def test_the_ends_of_a_message_are_not_each_other():
    text = "part pump; message from pump to pump;"
    flow = resolved(text).documents[0].root.members[1]
    ends = [one for one in flow.members if one.kind == "EventOccurrenceUsage"]
    assert [one.relations[0].reference.target.kind for one in ends] == ["PartUsage", "PartUsage"]
    assert told(text) == []


def member(random, depth):
    """A declaration or an import; many names lead in circles, and many nowhere."""
    name, other, third = (random.choice(_WORDS) for _ in range(3))
    kinds = [
        f"public import {other}::*;",
        f"private import {other}::{third};",
        f"part def {name} :> {other};",
        f"part {name.lower()} : {other};",
        f"action def {name} {{ in x : {other}; }}",
    ]
    if depth < 2:
        inner = " ".join(member(random, depth + 1) for _ in range(random.randrange(1, 4)))
        kinds += [f"package {name} {{ {inner} }}", f"part def {name} {{ {inner} }}"] * 3
    return random.choice(kinds)


def texts(random):
    """Three files that say things of one another."""
    return ["\n".join(member(random, 0) for _ in range(3)) for _ in range(3)]


def named(model, node):
    """An element by its place, which no question changes."""
    return None if node is None else (model.document(node).path, node.kind, node.start)


def answers(read, known, random=None):
    """Where all references lead, and what all elements specialise, asked in some order."""
    model = Model(read, known)
    nodes = [node for document in read for node in document.root.walk()]
    asked = [(node, None) for node in nodes]
    asked += [(node, relation) for node in nodes for relation in node.relations]
    order = list(range(len(asked)))
    if random:
        random.shuffle(order)
    found = [None] * len(asked)
    for index in order:
        node, relation = asked[index]
        if relation is not None:
            found[index] = named(model, model.target(node, relation))
        else:
            found[index] = [named(model, one) for one in model.lookup.all_generals(node)]
    return found


@pytest.mark.parametrize("seed", range(60))
def test_small_models_give_the_same_answers_in_any_order_of_questions(seed):
    said = texts(Random(seed))
    expected = answers(documents(*said), library())
    for order in range(3):
        assert answers(documents(*said), library(), Random(order)) == expected


@pytest.mark.corpus
@pytest.mark.parametrize(
    "folder", ["ice-lab", "omg-release/training", "omg-release/examples", "showcase"]
)
def test_real_models_give_the_same_answers_in_any_order_of_questions(folder, corpus):
    paths = sorted((corpus / "sysml2" / folder).rglob("*.sysml"))

    def read():
        return [parse(path.read_text("utf-8"), str(path), "sysml", Sink()) for path in paths]

    assert answers(read(), find_library(), Random(folder)) == answers(read(), find_library())
