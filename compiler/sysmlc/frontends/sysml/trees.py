"""The syntax trees of a compile unit, and what they state about nodes as a whole."""

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import chain
from operator import attrgetter
from typing import TYPE_CHECKING

from sysmlc.diagnostics import Place, Sink, Subject
from sysmlc.frontends.sysml import nodes
from sysmlc.language.tree import Document, Node, Relation

if TYPE_CHECKING:
    from sysmlc.language.names import Model

NodesByKind = Mapping[str, Sequence[Node]]
_FLOWS = ("FlowUsage", "SuccessionFlowUsage", "Flow", "SuccessionFlow")
_TYPINGS = frozenset({"FeatureTyping", "ConjugatedPortTyping"})
_TYPE_SOURCES = frozenset({"Redefinition", "Subsetting", "ReferenceSubsetting"})
_list_members = attrgetter("members")


class Trees:
    """The syntax trees of the documents of a unit. Sets of integers hold identities of nodes."""

    def __init__(self, documents: Sequence[Document], model: "Model") -> None:
        self.documents = documents
        self.indexes: list[NodesByKind] = []
        """The nodes of each document by metaclass, owners first."""
        self.depth = 0
        """Number of levels of the deepest tree."""
        self._model = model
        self._documents: dict[int, Document] = {}
        for document in documents:
            index, levels = _index_by_kind(document.root)
            members = chain.from_iterable(index.values())
            self._documents.update(dict.fromkeys(map(id, members), document))
            self.indexes.append(index)
            self.depth = max(self.depth, levels)
        self.nodes_by_kind = _merge_indexes(self.indexes)
        self.signals = _find_signals(self.nodes_by_kind)
        """Item definitions that are sent or accepted."""
        self.flow_features = _find_flow_features(self.nodes_by_kind)
        """Features at which flows start or end."""

    @property
    def roots(self) -> list[Node]:
        """The root namespaces of the documents of the unit."""
        return [document.root for document in self.documents]

    def document_of(self, node: Node) -> Document | None:
        """Return the document of the unit that contains the node; None for the library."""
        return self._documents.get(id(node))

    def source_of(self, node: Node) -> tuple[str, int]:
        """Return path and ordinal of a node for its element; ("", -1) in the library."""
        document = self._documents.get(id(node))
        return ("", -1) if document is None else (document.path, document.ordinal_of(node))

    def subject_of(self, node: Node) -> Subject:
        """Return the node as the subject of a diagnostic."""
        document = self._documents.get(id(node))
        name = nodes.qualified_name_of(node)
        if document is None:
            return Subject(name)
        return Subject(name, place=Place(document.path, document.ordinal_of(node)))

    def is_misplaced(self, node: Node, sink: Sink) -> bool:
        """Whether the parser reported that the node is not allowed in its owner (SM195)."""
        document = self._documents.get(id(node))
        if document is None:
            return False
        place = Place(document.path, offset=document.byte_offsets.byte_of(node.start))
        return sink.has_reported(("SM195",), place)

    def _resolve(self, node: Node, relation: Relation) -> Node | None:
        target = relation.reference.target
        return target if target is not None else self._model.target(node, relation)

    def types_of(self, node: Node) -> list[Node]:
        """Return the definitions that type a feature (KerML 1.0, 8.3.3.3.4).

        A feature without types of its own has those of the features that it redefines or subsets.
        The search is depth-first and follows a chain of redefinitions of any length.
        """
        types: dict[int, Node] = {}
        visited: set[int] = set()
        pending = [node]
        while pending:
            feature = pending.pop()
            if id(feature) in visited:
                continue
            visited.add(id(feature))
            typings = [relation for relation in feature.relations if relation.kind in _TYPINGS]
            for relation in typings:
                type_ = self._resolve(feature, relation)
                if type_ is not None:
                    types.setdefault(id(type_), type_)
            if not typings:
                targets = [
                    self._resolve(feature, relation)
                    for relation in feature.relations
                    if relation.kind in _TYPE_SOURCES
                ]
                pending += [target for target in reversed(targets) if target is not None]
        return list(types.values())


# -- analysis before the lowering --------------------------------------------------------------


def _index_by_kind(root: Node) -> tuple[NodesByKind, int]:
    """Return the nodes of a document by metaclass, owners first, and the depth of the tree."""
    index: dict[str, list[Node]] = defaultdict(list)
    depth, level = 0, [root]
    while level:
        for node in level:
            index[node.kind].append(node)
        depth, level = depth + 1, list(chain.from_iterable(map(_list_members, level)))
    return index, depth


def _merge_indexes(indexes: Iterable[NodesByKind]) -> NodesByKind:
    """Return the nodes of all documents by metaclass, one document after the other."""
    merged: dict[str, list[Node]] = {}
    for index in indexes:
        for kind, members in index.items():
            merged.setdefault(kind, []).extend(members)
    return merged


def _find_signals(nodes_by_kind: NodesByKind) -> set[int]:
    """Return the identities of the definitions that are signals.

    A signal is sent or accepted, or it is an item definition that types no feature.
    """
    signals = {id(definition) for definition in _iter_payload_types(nodes_by_kind)}
    items = {id(definition) for definition in nodes_by_kind.get("ItemDefinition", ())}
    if not items:
        return signals
    return signals | (items - {id(type_) for type_ in _iter_feature_types(nodes_by_kind)})


def _find_flow_features(nodes_by_kind: NodesByKind) -> set[int]:
    """Return the identities of the features at which flows start or end."""
    flows = (flow for kind in _FLOWS for flow in nodes_by_kind.get(kind, ()))
    paths = (nodes.path_of_end(end) for flow in flows for end in nodes.ends_of(flow))
    return {id(path[-1]) for path in paths if path and path[-1] is not None}


def _iter_payload_types(nodes_by_kind: NodesByKind) -> Iterator[Node]:
    """Yield the types that accept actions accept, expressions instantiate, and messages carry."""
    for node in nodes_by_kind.get("AcceptActionUsage", ()):
        for parameter in nodes.iter_by_membership(node, "ParameterMembership"):
            yield from _iter_targets(parameter, "FeatureTyping")
    for kind in ("ConstructorExpression", "InvocationExpression"):
        for node in nodes_by_kind.get(kind, ()):
            yield from _iter_targets(node, "Membership", "FeatureTyping")
    for message in filter(nodes.is_message, nodes_by_kind.get("FlowUsage", ())):
        for member in message.members:
            yield from _iter_targets(member, "FeatureTyping")


def _iter_feature_types(nodes_by_kind: NodesByKind) -> Iterator[Node]:
    """Yield the types of usages, except for payloads of accept actions."""
    for kind, features in nodes_by_kind.items():
        if kind.endswith("Usage") or kind == "PayloadFeature":
            for feature in features:
                if kind == "PayloadFeature" or not _is_accepted_payload(feature):
                    yield from _iter_targets(feature, "FeatureTyping")


def _is_accepted_payload(node: Node) -> bool:
    owner = node.owner
    return owner is not None and owner.kind == "AcceptActionUsage"


def _iter_targets(node: Node, *kinds: str) -> Iterator[Node]:
    for reference in nodes.list_references(node, *kinds):
        if reference.target is not None:
            yield reference.target
