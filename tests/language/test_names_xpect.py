"""The pilot implementation's own expectations about names (Xpect)."""

import os
from functools import cache
from pathlib import Path

import pytest
import xpect

from sysmlc.diagnostics import Severity, Sink
from sysmlc.language.library import find_library
from sysmlc.language.names import Model, contexts, resolve
from sysmlc.language.text import parse

pytestmark = pytest.mark.corpus

_FOLDER = Path(os.environ.get("SYSMLC_CORPUS", "nowhere")) / "sysml2"
_XPECT = _FOLDER / "pilot-xpect"
FILES = sorted(path.relative_to(_XPECT).as_posix() for path in _XPECT.rglob("*.xt"))
NOT_OURS = ("sysml/queryx/",)
"""A query language that is no part of SysML."""
NEXT_TO_ANOTHER = {("kerml/parsing/ParsingTests_ScopeWithFourDotAndDot.kerml.xt", "b")}
"""Links after one that is unknown: we tell a chain once, at the first name that is missing."""
AFTER_SYNTAX = {"kerml/parsing/ParsingTests_BadScopeWithOnlyTwoSingleDot.kerml.xt"}
"""Unknown names that only recovery from a syntax error makes of the text."""
HIDDEN_MEANWHILE = {
    "kerml/testsuite/ShadowingTests_ImportAndInnerClassesNamesAreTheSameBadCase3_Rdef.kerml.xt"
}
"""A redefined name that the pilot still lists within the feature that redefines it."""


@cache
def library():
    return find_library(_FOLDER / "omg-release" / "sysml.library")


def cases():
    """The test models whose files are all there."""
    read = [xpect.read(_XPECT / name) for name in FILES if not name.startswith(NOT_OURS)]
    return [case for case in read if case.is_complete]


def name_of(case):
    return case.path.relative_to(_XPECT).as_posix()


def documents(case):
    sink = Sink()
    beside = [parse(t, n, n.rpartition(".")[2], sink) for n, t in sorted(case.beside().items())]
    return [parse(case.text, case.path.name, case.language, sink), *beside]


def unknown(case, made):
    """Offsets in the test model at which a name is told to be unknown."""
    sink = Sink()
    resolve(made, library(), sink)
    text = case.text.encode()
    return {
        len(text[: found.subject.place.offset].decode()): found.message
        for found in sink
        if found.severity is Severity.ERROR and found.subject.place.file == case.path.name
    }


def test_the_files_that_are_tried():
    assert (len(FILES), len(cases())) == (428, 424)


def test_what_must_be_unknown_is_told_at_its_place_and_nothing_else():
    missed, extra, hit = [], [], 0
    for case in cases():
        told = unknown(case, documents(case))
        expected = {one.offset: one.text for one in case.unresolved}
        hit += len(told.keys() & expected.keys())
        missed += [(name_of(case), expected[o]) for o in sorted(expected.keys() - told.keys())]
        if name_of(case) not in AFTER_SYNTAX:
            extra += [(name_of(case), told[o]) for o in sorted(told.keys() - expected.keys())]
    assert (set(missed), extra) == (NEXT_TO_ANOTHER, [])
    assert hit == 254


def reference_at(document, offset):
    for node in document.root.walk():
        for relation in node.relations:
            reference = relation.reference
            if reference.start <= offset < reference.end:
                return node, relation
    return None


def test_names_lead_where_the_pilot_says():
    wrong, count = [], 0
    for case in cases():
        if case.linked:
            made = documents(case)
            model = resolve(made, library(), Sink())
            for expected in case.linked:
                _, relation = reference_at(made[0], expected.offset)
                names = [model.qualified_name(n) for n in relation.reference.targets]
                count += 1
                if expected.target not in [name.replace("::", ".") for name in names]:
                    wrong.append((name_of(case), expected, names))
    assert wrong == []
    assert count == 194


def missing(model, made, expected):
    """Names of a scope expectation that lead nowhere from the place it is about."""
    node, relation = reference_at(made[0], expected.offset)
    start = contexts.find_context(node, relation)
    kinds = contexts.TARGET_KINDS.get(relation.kind)
    names = [tuple(name.split(".")) for name in sorted(expected.names)]
    return [name for name in names if model.lookup.search(start, name, kinds) is None]


def test_what_the_pilot_has_in_a_scope_is_found_from_there():
    wrong, count, names = [], 0, 0
    for case in cases():
        for expected in case.scopes:
            made = documents(case)
            resolve(made, library(), Sink())
            node_and_relation = reference_at(made[0], expected.offset)
            if node_and_relation is None:
                continue
            model = _within(made, node_and_relation[1])
            absent = missing(model, made, expected)
            count, names = count + 1, names + len(expected.names)
            if absent and name_of(case) not in HIDDEN_MEANWHILE:
                wrong.append((name_of(case), expected.text, absent[:5]))
    assert wrong == []
    assert count >= 234
    assert names > 16_000


def _within(made, relation):
    """The model as it is while a redefinition is looked up: it hides nothing yet."""
    model = Model(made, library())
    if relation.kind == "Redefinition":
        relation.reference.set_targets([])
    return model
