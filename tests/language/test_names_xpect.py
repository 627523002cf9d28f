"""The expectations of the pilot implementation about names (Xpect)."""

import pytest
from official_models import load_standard_library
from xpect import XPECT_FILES, read_cases

from sysmlc.diagnostics import Severity, Sink
from sysmlc.language.names import Model, contexts, resolve

pytestmark = pytest.mark.corpus

BEHIND_AN_UNKNOWN_NAME = {("kerml/parsing/ParsingTests_ScopeWithFourDotAndDot.kerml.xt", "b")}
"""Names in a chain behind an unknown one: sysmlc reports only the first unknown name of a chain."""
AFTER_SYNTAX_ERROR = {"kerml/parsing/ParsingTests_BadScopeWithOnlyTwoSingleDot.kerml.xt"}
"""Models with names that are unknown only because the parser recovers from a syntax error."""
HIDDEN_BY_REDEFINITION = {
    "kerml/testsuite/ShadowingTests_ImportAndInnerClassesNamesAreTheSameBadCase3_Rdef.kerml.xt"
}
"""Models in which the pilot lists a redefined name within the feature that redefines it."""


def find_unknown_names(case):
    """Return the messages about unknown names of a model by offset."""
    sink = Sink()
    resolve(case.parse(Sink()), load_standard_library(), sink)
    return {
        offset: diagnostic.message
        for offset, diagnostic in case.list_located(sink)
        if diagnostic.severity is Severity.ERROR
    }


def test_424_of_428_models_are_complete():
    assert (len(XPECT_FILES), len(read_cases())) == (428, 424)


def test_exactly_the_expected_names_are_reported_as_unknown():
    missing, unexpected, count = [], [], 0
    for case in read_cases():
        messages = find_unknown_names(case)
        expected = {unresolved.offset: unresolved.text for unresolved in case.unresolved}
        count += len(messages.keys() & expected.keys())
        missing += [(case.name, expected[offset]) for offset in expected.keys() - messages.keys()]
        if case.name not in AFTER_SYNTAX_ERROR:
            unexpected += [
                (case.name, messages[offset]) for offset in messages.keys() - expected.keys()
            ]
    assert (set(missing), unexpected) == (BEHIND_AN_UNKNOWN_NAME, [])
    assert count == 254


def find_reference(document, offset):
    """Return the relation with the reference at *offset*, and its node; None without one."""
    for node in document.root.walk():
        for relation in node.relations:
            reference = relation.reference
            if reference.start <= offset < reference.end:
                return node, relation
    return None


def test_names_have_the_targets_that_the_pilot_expects():
    wrong, count = [], 0
    for case in read_cases():
        if case.linked:
            documents = case.parse(Sink())
            model = resolve(documents, load_standard_library(), Sink())
            for expected in case.linked:
                _, relation = find_reference(documents[0], expected.offset)
                names = [model.qualified_name(target) for target in relation.reference.targets]
                count += 1
                if expected.target not in [name.replace("::", ".") for name in names]:
                    wrong.append((case.name, expected, names))
    assert wrong == []
    assert count == 194


def list_invisible_names(model, node, relation, scope):
    """Return the names of a scope expectation that are unknown at the reference it is about."""
    context = contexts.find_context(node, relation)
    kinds = contexts.TARGET_KINDS.get(relation.kind)
    names = [tuple(name.split(".")) for name in sorted(scope.names)]
    return [name for name in names if model.lookup.search(context, name, kinds) is None]


def test_names_that_the_pilot_expects_in_a_scope_are_visible_there():
    wrong, scope_count, name_count = [], 0, 0
    for case in read_cases():
        for scope in case.scopes:
            documents = case.parse(Sink())
            resolve(documents, load_standard_library(), Sink())
            reference = find_reference(documents[0], scope.offset)
            if reference is None:
                continue
            invisible = list_invisible_names(
                create_model_before(documents, reference[1]), *reference, scope
            )
            scope_count, name_count = scope_count + 1, name_count + len(scope.names)
            if invisible and case.name not in HIDDEN_BY_REDEFINITION:
                wrong.append((case.name, scope.text, invisible[:5]))
    assert wrong == []
    assert scope_count >= 234
    assert name_count > 16_000


def create_model_before(documents, relation):
    """Return the model as it is while *relation* is looked up.

    A redefinition hides nothing until its own name has been resolved.
    """
    model = Model(documents, load_standard_library())
    if relation.kind == "Redefinition":
        relation.reference.set_targets([])
    return model
