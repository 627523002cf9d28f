"""Usages are typed by definitions of their own kind."""

from typing import NamedTuple

from sysmlc.diagnostics import Sink
from sysmlc.language.checks.rules import ONE_TYPE, TYPED_BY
from sysmlc.language.metaclasses import ALL_GENERALS, FEATURES, describe_kind, kinds_of
from sysmlc.language.names import Model
from sysmlc.language.tree import Document, Node, make_subject


class Wanted(NamedTuple):
    """What the types of a usage must be."""

    kinds: frozenset[str]
    words: str
    single: bool = False


_WANTED: tuple[tuple[str, Wanted], ...] = (
    (
        "EnumerationUsage",
        Wanted(kinds_of("EnumerationDefinition"), "an enumeration definition", True),
    ),
    ("AttributeUsage", Wanted(kinds_of("DataType"), "attribute definitions")),
    ("AllocationUsage", Wanted(kinds_of("AllocationDefinition"), "allocation definitions")),
    ("InterfaceUsage", Wanted(kinds_of("InterfaceDefinition"), "interface definitions")),
    ("FlowUsage", Wanted(kinds_of("Interaction"), "flow definitions")),
    ("ConnectionUsage", Wanted(kinds_of("Association"), "connection definitions")),
    ("MetadataUsage", Wanted(kinds_of("Metaclass"), "a metadata definition", True)),
    ("ViewUsage", Wanted(kinds_of("ViewDefinition"), "a view definition", True)),
    ("RenderingUsage", Wanted(kinds_of("RenderingDefinition"), "a rendering definition", True)),
    ("PortUsage", Wanted(kinds_of("PortDefinition"), "port definitions")),
    ("ViewpointUsage", Wanted(kinds_of("ViewpointDefinition"), "a viewpoint definition", True)),
    ("ConcernUsage", Wanted(kinds_of("ConcernDefinition"), "a concern definition", True)),
    (
        "RequirementUsage",
        Wanted(kinds_of("RequirementDefinition"), "a requirement definition", True),
    ),
    ("ConstraintUsage", Wanted(kinds_of("Predicate"), "a constraint definition", True)),
    (
        "AnalysisCaseUsage",
        Wanted(kinds_of("AnalysisCaseDefinition"), "an analysis definition", True),
    ),
    (
        "VerificationCaseUsage",
        Wanted(kinds_of("VerificationCaseDefinition"), "a verification definition", True),
    ),
    ("UseCaseUsage", Wanted(kinds_of("UseCaseDefinition"), "a use case definition", True)),
    ("CaseUsage", Wanted(kinds_of("CaseDefinition"), "a case definition", True)),
    ("CalculationUsage", Wanted(kinds_of("Function"), "a calculation definition", True)),
    ("StateUsage", Wanted(kinds_of("Behavior"), "state definitions")),
    ("ActionUsage", Wanted(kinds_of("Behavior"), "action definitions")),
    ("OccurrenceUsage", Wanted(kinds_of("Class"), "occurrence, item or part definitions")),
    ("ReferenceUsage", Wanted(kinds_of("Classifier"), "definitions")),
)


def _by_kind() -> dict[str, Wanted]:
    """What each metaclass of usages wants: the first line of the table that is a general of it."""
    found: dict[str, Wanted] = {}
    for kind in kinds_of("Usage") - kinds_of("Connector"):
        for general, wanted in _WANTED:
            if general in ALL_GENERALS[kind]:
                found[kind] = wanted
                break
    connectors = kinds_of("ConnectionUsage") | kinds_of("FlowUsage")
    for kind in connectors:
        found[kind] = next(w for g, w in _WANTED if g in ALL_GENERALS[kind])
    return found


_BY_KIND = _by_kind()
RELATIONS = frozenset({"FeatureTyping", "Subsetting", "ReferenceSubsetting", "Redefinition"})
"""Relations that say types."""


KINDS = frozenset(_BY_KIND)
"""Metaclasses of usages that are checked."""


def check(model: Model, document: Document, node: Node, sink: Sink) -> None:
    """Report a usage whose types are not what its kind wants."""
    wanted = _BY_KIND.get(node.kind)
    if wanted is None or not _is_known(node):
        return
    types = _types(model, node)
    if all(one.kind in wanted.kinds for one in types) and not (wanted.single and len(types) > 1):
        return
    place = make_subject(document, node, node.start)
    name = model.name(node)
    what = f"{describe_kind(node).partition(' ')[2]} '{name}'" if name else describe_kind(node)
    for one in types:
        if one.kind not in wanted.kinds:
            sink.report(
                TYPED_BY,
                place,
                usage=what,
                wanted=wanted.words,
                type=model.name(one),
                found=describe_kind(one),
            )
            return
    if wanted.single and len(types) > 1:
        names = " and ".join(f"'{model.name(one)}'" for one in types)
        sink.report(ONE_TYPE, place, usage=what, types=names)


def _is_known(node: Node) -> bool:
    """Whether all was found that the text says types by."""
    for relation in node.relations:
        if relation.kind in RELATIONS and relation.reference.target is None:
            return False
    return True


def _types(model: Model, node: Node) -> list[Node]:
    """The types of a usage; a usage that is used as a type is one as well."""
    usages = [
        relation.reference.target
        for relation in node.relations
        if relation.kind == "FeatureTyping" and relation.reference.target is not None
    ]
    wrong = [one for one in usages if one.kind in FEATURES]
    return wrong or model.types(node)
