"""A unit that a process keeps is after each edit what a new process makes of it."""

from collections.abc import Iterator, Mapping
from collections.abc import Set as AbstractSet
from random import Random

import pytest
from resolving import library

from edited_texts import UNIT, edited
from sysmlc.diagnostics import Sink
from sysmlc.language.checks import check
from sysmlc.language.kept import Kept
from sysmlc.language.library import Library, find
from sysmlc.language.names import Model, resolve_all
from sysmlc.language.names.adding import implied_relations
from sysmlc.language.text import parse
from sysmlc.language.tree import Document, Node
from sysmlc.sources import Source


class Compiled:
    """Texts, resolved and checked: of what was kept, if something was."""

    def __init__(self, texts: Mapping[str, str], found: Library, kept: Kept | None = None) -> None:
        sources = [Source(name, text.encode()) for name, text in sorted(texts.items())]
        known = kept.documents(sources) if kept else {}
        self.sink = Sink()
        documents = [known.get(one.name) or _read(one, self.sink) for one in sources]
        is_faulty = len(self.sink) > 0
        self.is_renewed = kept is not None and not is_faulty and kept.renew(documents, found)
        if kept is None or not self.is_renewed:
            documents = [_read(one, Sink()) for one in sources]
            kept = Kept(Model(documents, found))
        self.model = kept.model
        resolve_all(self.model, self.sink)
        check(self.model, self.sink)
        self.kept = None if is_faulty else kept

    def findings(self) -> list[object]:
        return [(one.rule.code, one.message, one.subject, one.help) for one in self.sink]

    def own(self) -> set[Node]:
        return {node for one in self.model.documents for node in one.root.walk()}

    def holders(self) -> list[object]:
        """What remembers something about nodes."""
        known = [self.model, self.model.lookup, self.model._types]
        return known if self.kept is None else [*known, self.kept]

    def facts(self) -> list[object]:
        """All that the model says of its nodes; nodes by their places."""
        model = self.model
        places: dict[Node, object] = {}
        for document in model.documents:
            for at, node in enumerate(document.root.walk()):
                places[node] = document.path, at
        return [
            (
                places[node],
                [getattr(node, one) for one in Node.__slots__ if one not in _OTHERS],
                [_said(one, places) for one in node.relations],
                [_place(one, places) for one in (node.owner, *node.members) if one],
                model.name(node),
                [_place(one, places) for one in model.supers(node)],
                [_place(one, places) for one in model.types(node)],
                [_place(one, places) for one in model.lookup.by_position(node)],
                [(one.kind, str(one.reference)) for one in implied_relations(model, node)],
            )
            for node in list(places)
        ]


def _nodes(found: object) -> Iterator[Node]:
    """The nodes in what is remembered."""
    if isinstance(found, Node | Document):
        yield found if isinstance(found, Node) else found.root
    elif isinstance(found, Mapping):
        yield from _nodes([*found.keys(), *found.values()])
    elif isinstance(found, list | tuple | AbstractSet):
        for one in found:
            yield from _nodes(one)


_OTHERS = ("owner", "members", "relations")


def _said(relation, places):
    reference = relation.reference
    targets = [_place(one, places) for one in reference.targets or ()]
    return relation.kind, reference.chain, reference.start, reference.end, targets


def _place(node, places):
    """Where a node is: in the unit, else in the library."""
    if node not in places:
        owner = node.owner
        at = owner.members.index(node) if owner else 0
        places[node] = (*(_place(owner, places) if owner else ()), (node.kind, node.name, at))
    return places[node]


def _read(source: Source, sink: Sink) -> Document:
    return parse(source.data.decode(), source.name, "sysml", sink, source)


def assert_same(one: Compiled, other: Compiled) -> None:
    assert one.findings() == other.findings()
    assert one.facts() == other.facts()


def after(edits, texts=UNIT):
    """What is kept of a unit after one edit more each time; each is held against a new one."""
    kept, texts, made = Compiled(texts, library()).kept, dict(texts), None
    for name, old, new in edits:
        assert old in texts[name]
        texts[name] = texts[name].replace(old, new, 1)
        made = Compiled(texts, library(), kept)
        assert_same(made, Compiled(texts, library()))
        kept = made.kept
    return made


@pytest.mark.parametrize("seed", range(12))
def test_after_random_edits_a_kept_unit_is_as_a_new_one(seed):
    random, texts, kept, before = Random(seed), UNIT, None, [UNIT]
    renewed = 0
    for _ in range(25):
        made = Compiled(texts, library(), kept)
        assert_same(made, Compiled(texts, library()))
        renewed, kept = renewed + made.is_renewed, made.kept
        is_back = kept is None or random.random() < 0.35
        before.append(texts)
        texts = random.choice(before) if is_back else edited(texts, random)
    assert renewed > 5


@pytest.mark.corpus
def test_after_random_edits_the_kept_laboratory_is_as_a_new_one(corpus):
    folder, found = corpus / "sysml2/ice-lab", find(corpus / "sysml2/omg-release/sysml.library", {})
    paths = sorted(folder.rglob("*.sysml"))
    texts = {one.relative_to(folder).as_posix(): one.read_text() for one in paths}
    random, kept = Random(1), None
    for _ in range(5):
        made = Compiled(texts, found, kept)
        assert_same(made, Compiled(texts, found))
        kept, texts = made.kept, edited(texts, random)


def test_what_does_not_see_an_edit_stays():
    kept = Compiled(UNIT, library()).kept
    lock, turn = (one.root.members[0].members[-2] for one in kept.model.documents[:2])
    start = turn.start
    texts = {**UNIT, "b.sysml": UNIT["b.sysml"].replace("part other", "part more; part other")}
    made = Compiled(texts, library(), kept)
    assert made.is_renewed
    assert lock is made.model.documents[0].root.members[0].members[-2]
    assert turn is made.model.documents[1].root.members[0].members[-2]
    assert {lock, turn} <= made.model.sound
    assert turn.start == start + len("part more; ")


def test_a_name_that_dangles_comes_back():
    after(
        [
            ("a.sysml", "part def Wide", "part def Broad"),
            ("b.sysml", "part door", "part door2"),
            ("a.sysml", "part def Broad", "part def Wide"),
            ("b.sysml", "part door2", "part door"),
        ]
    )


def test_a_nested_namesake_of_what_is_edited_is_not_seen_for_it():
    made = after([("a.sysml", "port inn : Plug;", "port inn : Plug; part p;")])
    turn = made.model.documents[1].root.members[0].members[-2]
    assert turn in made.model.sound
    after(
        [
            ("b.sysml", "action def Gate;", "action def Gat;"),
            ("a.sysml", "attribute width", "attribute w"),
            ("b.sysml", "action def Gat;", "action def Gate;"),
        ]
    )


def test_what_imports_let_pass_is_seen():
    after(
        [
            ("b.sysml", "part def Room {", "part def Room { public import Alpha::*;"),
            ("a.sysml", "part def Lock;", "part def Lock { part bolt; }"),
            ("d.sysml", "part extra : Gate;", "part extra : Lock { part :>> bolt; }"),
            ("a.sysml", "part bolt;", "part nut;"),
            ("d.sysml", "import Gamma::*", "import Gamma::**"),
            ("a.sysml", "part nut;", "part bolt;"),
        ]
    )


def test_what_may_help_with_a_lost_name_is_looked_for_in_the_new_texts():
    after(
        [
            ("d.sysml", "part extra : Gate;", "part extra : Bolt;"),
            ("a.sysml", "part def Lock;", "part def Lock; part def Bolt;"),
            ("a.sysml", "part def Bolt;", "part def Bolts;"),
        ]
    )


@pytest.mark.parametrize(
    ("name", "old", "new"),
    [
        ("d.sysml", "package Delta", "package Omega"),
        ("d.sysml", "package Delta", "package Gamma"),
        ("d.sysml", "package Delta", "package 'it\\'s'"),
        ("a.sysml", "package Alpha {", "package More; package Alpha {"),
        ("a.sysml", "package Alpha", "package Parts"),
    ],
)
def test_nothing_is_kept_where_root_members_have_other_names(name, old, new):
    assert not after([(name, old, new)]).is_renewed


def test_what_may_help_with_a_lost_name_is_told_whatever_was_resolved_before():
    """An import behind the name led nowhere yet in a new process."""
    texts = {
        "a.sysml": "package Alpha { part foo; }",
        "b.sysml": "package Beta { part def X { part :>> foo; private import Alpha; } part y; }",
    }
    made = after([("b.sysml", "part y", "part z")], texts)
    assert [one.help for one in made.sink] == ["'foo' is in 'Alpha': import Alpha::*, not it alone"]


def test_quotes_may_say_what_a_tree_does_not():
    texts = {
        "a.sysml": "package Alpha { part def P; }",
        "b.sysml": "package Beta { package '$' { package Alpha { part def P; } } "
        "part x : '$'::Alpha::P; part y; }",
    }
    assert after([("b.sysml", "'$'::Alpha", "$  ::Alpha")], texts).is_renewed


@pytest.mark.parametrize("seed", range(6))
def test_nothing_is_remembered_of_nodes_that_are_no_more(seed):
    random, kept, gone = Random(seed), None, set()
    unit = {**UNIT, "e.sysml": "package Notes { metadata def M { attribute a; } part p { @M; } }"}
    texts = unit
    for _ in range(12):
        made = Compiled(texts, library(), kept)
        if kept is not made.kept:
            gone = set()
        kept, own = made.kept, made.own()
        gone -= own
        assert gone.isdisjoint(_nodes([vars(one) for one in made.holders()]))
        gone |= own
        texts = edited(unit, random)


def test_nothing_is_kept_where_the_library_speaks_of_a_package_of_the_unit():
    texts = {"a.sysml": "package Parts { part def Part; part def Gate; }"}
    assert not after([("a.sysml", "Gate", "Door")], texts).is_renewed


def test_nothing_is_kept_of_a_circle():
    texts = {"a.sysml": "package P1 { part def A1 :> B1; part def B1 :> A1; part def C1; }"}
    assert not after([("a.sysml", "C1;", "C2;")], texts).is_renewed


def test_nothing_is_kept_with_another_library():
    kept = Compiled(UNIT, library()).kept
    assert not Compiled(UNIT, Library([]), kept).is_renewed
