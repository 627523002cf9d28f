"""Reader of KerML and SysML v2 from XMI (.kermlx, .sysmlx) into the tree (KerML 1.0, 10.2)."""

from sysmlc.diagnostics import Place, Rule, Sink, Subject
from sysmlc.language.interchange import rules
from sysmlc.language.interchange.effective_names import QualifiedNames, describe_node
from sysmlc.language.interchange.element_ids import (
    ExchangeDocument,
    References,
    resolve_local,
    set_names,
)
from sysmlc.language.interchange.folding import Folding
from sysmlc.language.interchange.frames import Frame
from sysmlc.language.interchange.metamodel import has_feature, is_concrete
from sysmlc.language.tree import Node
from sysmlc.sources import Fault, Limits, Source, SourceError
from sysmlc.sources.xml import SEPARATOR, make_parser, parse, refuse_depth

_LIMITS = Limits(depth=20_000)
"""A list of n elements is 6 n deep (KerML 1.0, 8.2.5.8.2); the reader does not recurse."""
_RELATIONSHIP = "ownedRelationship"
_RELATED = "ownedRelatedElement"
_SCHEMA = "http://www.w3.org/2001/XMLSchema-instance"
_XMI = ("http://www.omg.org/XMI", "http://www.omg.org/spec/XMI/", "http://schema.omg.org/spec/XMI/")
_LANGUAGE = ("https://www.omg.org/spec/SysML/", "https://www.omg.org/spec/KerML/")
_XMI_ATTRIBUTES = {"id": "@id", "type": "@type", "idref": "@idref", "uuid": "@uuid"}


def read(source: Source, sink: Sink) -> ExchangeDocument:
    """Return the tree of one interchange file; references into other files stay hrefs.

    A damaged file is reported and gives an empty tree. Raises SourceError for a file that exceeds
    the limits. ``link`` resolves references between files that were read together.
    """
    reader = _Reader(source, sink)
    try:
        reader.run()
    except SourceError as problem:
        if problem.fault is Fault.LIMIT:
            raise
        # Half a model gives wrong outputs, so nothing of a damaged file is used.
        reader = _Reader(source, sink)
        subject = Subject(source.name, place=Place(source.name, offset=problem.offset))
        sink.report(rules.MALFORMED, subject, file=source.name, problem=problem.message)
    return reader.document()


class _Reader:
    def __init__(self, source: Source, sink: Sink) -> None:
        self._source = source
        self._sink = sink
        self._references = References()
        self._folding = Folding(self._references)
        self._root = Node("Namespace", start=0)
        self._open: list[Frame | None] = []
        """Frames of open elements; None for an XML element that is no element of the model."""
        self._tags: list[str] = []
        self._text: list[str] = []
        self._ordinal = -1
        self._skipped = 0
        self._names: dict[str, str] = {}

    def run(self) -> None:
        xml_parser = make_parser()
        xml_parser.StartElementHandler = self._start
        xml_parser.EndElementHandler = self._end
        xml_parser.CharacterDataHandler = self._text.append
        self._parser = xml_parser
        parse(self._source, xml_parser)

    def document(self) -> ExchangeDocument:
        path = self._source.name
        pending = resolve_local(self._references, path, self._sink)
        set_names(self._root, QualifiedNames())
        language = "kerml" if path.lower().endswith(".kermlx") else "sysml"
        ids = self._references.ids
        return ExchangeDocument(path, language, self._root, "", self._source, ids, pending)

    # -- start tags ----------------------------------------------------------------------------

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        self._ordinal += 1
        if self._skipped:
            self._skipped += 1
            return
        if len(self._tags) >= _LIMITS.depth:
            refuse_depth(self._source, self._parser, _LIMITS)
        self._text.clear()
        space, _, local = tag.rpartition(SEPARATOR)
        values = self._canonical_attributes(attributes)
        if local in (_RELATIONSHIP, _RELATED) and not space:
            self._open_element(local, values.get("@type", "").rpartition(":")[2], values)
        elif not self._tags:
            self._open_root(space, local, values)
        elif space:
            self._open_model(space, local, values)
        else:
            self._open_feature(local, values)

    def _canonical_attributes(self, attributes: dict[str, str]) -> dict[str, str]:
        names = self._names
        # The attribute names of a file are few, and memoised.
        try:
            return {names[name]: value for name, value in attributes.items()}
        except KeyError:
            names.update({name: _canonical_name(name) for name in attributes})
            return {names[name]: value for name, value in attributes.items()}

    def _open_root(self, space: str, local: str, values: dict[str, str]) -> None:
        if space.startswith(_XMI) and local == "XMI":
            self._push(local, None)
        elif space.startswith(_LANGUAGE):
            self._open_element(local, local, values)
        else:
            subject = Subject(self._source.name, place=self._place())
            self._sink.report(rules.NO_MODEL, subject, file=self._source.name, root=local)
            self._skipped = 1

    def _open_model(self, space: str, local: str, values: dict[str, str]) -> None:
        """Open an element with a namespace: a model within xmi:XMI, or a tool's extension."""
        if self._open[-1] is None and space.startswith(_LANGUAGE):
            self._open_element(local, local, values)
        else:
            self._skipped = 1

    def _open_element(self, local: str, kind: str, values: dict[str, str]) -> None:
        # Implied relationships follow from the others, and name resolution computes them.
        if values.get("isImplied") == "true":
            self._skipped = 1
        elif not is_concrete(kind):
            owner = next((describe_node(frame.node) for frame in reversed(self._open) if frame), "")
            subject = Subject(owner or self._source.name, place=self._place())
            self._sink.report(rules.UNKNOWN_METACLASS, subject, kind=kind)
            self._skipped = 1
        else:
            frame = Frame(kind, values.get("@id") or values.get("elementId", ""), self._ordinal)
            self._push(local, frame)
            self._bind_id(frame)
            for feature, value in values.items():
                if feature[0] != "@":
                    self._set_attribute(frame, feature, value)

    def _push(self, tag: str, frame: Frame | None) -> None:
        self._tags.append(tag)
        self._open.append(frame)

    def _bind_id(self, frame: Frame) -> None:
        id = frame.id
        if id in self._references.ids:
            subject = Subject(frame.kind, place=self._place())
            self._sink.report(rules.REPEATED_ID, subject, id=id)
        self._references.bind_id(id, frame.node)

    def _set_attribute(self, frame: Frame, feature: str, value: str) -> None:
        if not has_feature(frame.kind, feature):
            self._report_feature(rules.UNKNOWN_FEATURE, frame, feature)
            return
        expected = frame.set_attribute(feature, value)
        if expected:
            self._report_feature(rules.BAD_VALUE, frame, feature, value, expected)

    def _report_feature(
        self, rule: Rule, frame: Frame, feature: str, value: str = "", expected: str = ""
    ) -> None:
        name = describe_node(frame.node)
        subject = Subject(name, place=self._place())
        facts = {"feature": feature, "element": name, "kind": frame.kind}
        facts |= {"value": value, "type": expected}
        self._sink.report(rule, subject, notes=(), help="", **facts)

    def _open_feature(self, local: str, values: dict[str, str]) -> None:
        """Open a feature that is an XML element: a reference, or a text."""
        frame = self._open[-1]
        target = values.get("href") or values.get("@idref")
        if frame is not None and target is not None:
            if has_feature(frame.kind, local):
                frame.targets.setdefault(local, []).append(target)
            else:
                self._report_feature(rules.UNKNOWN_FEATURE, frame, local)
        self._push(f"@{local}" if target is None else "", None)

    def _place(self) -> Place:
        return Place(self._source.name, ordinal=self._ordinal)

    # -- end tags ------------------------------------------------------------------------------

    def _end(self, tag: str) -> None:
        if self._skipped:
            self._skipped -= 1
            return
        local, frame = self._tags.pop(), self._open.pop()
        owner = self._open[-1] if self._open else None
        if frame is None:
            if local.startswith("@") and owner is not None:
                self._set_attribute(owner, local[1:], "".join(self._text))
        elif owner is None:
            self._close_root(frame)
        elif local == _RELATIONSHIP:
            self._folding.fold_relationship(frame, owner)
        else:
            self._folding.fold_related_element(frame, owner)

    def _close_root(self, frame: Frame) -> None:
        """Close a root; the members of a root namespace are those of the document."""
        if frame.kind == "Namespace" and not frame.node.name:
            self._references.bind_id(frame.id, self._root)
            for member in frame.node.members:
                self._root.add_member(member)
            self._root.relations.extend(frame.node.relations)
        else:
            frame.node.membership = "OwningMembership"
            self._root.add_member(frame.node)


def _canonical_name(name: str) -> str:
    """Return ``@id``, ``@type`` ... for attributes of XMI; ``@`` for those of other tools."""
    space, _, local = name.rpartition(SEPARATOR)
    if not space:
        return name
    if space == _SCHEMA or space.startswith(_XMI):
        return _XMI_ATTRIBUTES.get(local, "@")
    return "@"
