"""What may stand where it is: results, variable features, imports at the top."""

from collections.abc import Iterator

from sysmlc.diagnostics import Severity, rule
from sysmlc.language.checks.found import DECLARED_FEATURES, DECLARED_TYPES, Found, name_of
from sysmlc.language.metaclasses import kinds_of
from sysmlc.language.names import Model
from sysmlc.language.names.implied import find_owning_type
from sysmlc.language.tree import Node

SECOND_RESULT = rule(
    "SM265",
    "several-results",
    Severity.ERROR,
    "'{name}' has {count} result expressions, {whose}",
    help="keep one of them",
)
VARIABLE_PORTION = rule(
    "SM266",
    "variable-portion",
    Severity.ERROR,
    "'{name}' is a portion and cannot change",
    help="leave 'var' or 'portion' out",
)
VARIABLE_ELSEWHERE = rule(
    "SM267",
    "variable-elsewhere",
    Severity.ERROR,
    "'{name}' may change, and '{owner}' has no time in which it could",
    help="leave 'var' out",
)
ROOT_IMPORT = rule(
    "SM268",
    "public-root-import",
    Severity.ERROR,
    "the import of '{name}' stands in no package and is not private",
    help="write 'private' before 'import'",
)

_FUNCTIONS = kinds_of("Function") | (kinds_of("Expression") & DECLARED_TYPES)
_IMPORTS = frozenset({"MembershipImport", "NamespaceImport"})


def check_result(model: Model, node: Node) -> Iterator[Found]:
    """Report a result expression beside another, own or inherited."""
    own = _results(node)
    if not own and not model.lookup.generals(node):
        return
    inherited = [one for general in model.all_supertypes(node)[1:] for one in _results(general)]
    count = len(own) + len(inherited)
    if count > 1:
        start = own[-1].start if own else node.start
        whose = "inherited ones" if not own else "its own and inherited ones"
        facts = {"name": name_of(model, node), "count": str(count)}
        yield Found(SECOND_RESULT, start, {**facts, "whose": whose if inherited else "its own"})


def _results(node: Node) -> list[Node]:
    return [one for one in node.members if one.membership == "ResultExpressionMembership"]


def check_variable(model: Model, node: Node) -> Iterator[Found]:
    """Report a feature that is said to change and cannot."""
    if node.attributes.get("isVariable") is not True:
        return
    owner = find_owning_type(node)
    facts = {"name": name_of(model, node), "owner": name_of(model, node.owner)}
    if node.attributes.get("isPortion"):
        yield Found(VARIABLE_PORTION, node.start, facts)
    elif owner is None or not model.specializes(owner, "Occurrences::Occurrence"):
        yield Found(VARIABLE_ELSEWHERE, node.start, facts)


def check_import(model: Model, node: Node) -> Iterator[Found]:
    """Report an import of the root namespace that others could see."""
    is_at_top = node.owner is not None and node.owner.owner is None
    if is_at_top and node.visibility != "private" and node.relations:
        yield Found(ROOT_IMPORT, node.start, {"name": str(node.relations[0].reference)})


CHECKS = ((_FUNCTIONS, check_result), (DECLARED_FEATURES, check_variable), (_IMPORTS, check_import))
