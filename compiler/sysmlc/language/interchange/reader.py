"""Reads KerML and SysML v2 from XMI (.kermlx, .sysmlx) into the tree (KerML 1.0, 10.2)."""

from sysmlc.diagnostics import Place, Rule, Sink, Subject
from sysmlc.language.interchange import rules
from sysmlc.language.interchange.effective_names import Naming, shown
from sysmlc.language.interchange.folding import Folding
from sysmlc.language.interchange.frames import Frame
from sysmlc.language.interchange.metamodel import is_concrete, is_known
from sysmlc.language.interchange.references import ExchangeDocument, References, name, resolve
from sysmlc.language.tree import Node
from sysmlc.sources import Fault, Limits, Source, SourceError
from sysmlc.sources.xml import SEPARATOR, parse, parser, too_deep

_LIMITS = Limits(depth=20_000)
"""A list of n elements nests 6 n deep (KerML 1.0, 8.2.5.8.2); nothing here recurses."""
_RELATIONSHIP = "ownedRelationship"
_RELATED = "ownedRelatedElement"
_SCHEMA = "http://www.w3.org/2001/XMLSchema-instance"
_XMI = ("http://www.omg.org/XMI", "http://www.omg.org/spec/XMI/", "http://schema.omg.org/spec/XMI/")
_LANGUAGE = ("https://www.omg.org/spec/SysML/", "https://www.omg.org/spec/KerML/")
_OF_XMI = {"id": "@id", "type": "@type", "idref": "@idref", "uuid": "@uuid"}


def read(source: Source, sink: Sink) -> ExchangeDocument:
    """The tree of one interchange file; references that lead to other files are left as hrefs.

    A damaged file is reported and gives an empty tree. Raises SourceError for what exceeds the
    limits. ``link`` resolves references between files that were read together.
    """
    reader = _Reader(source, sink)
    try:
        reader.run()
    except SourceError as problem:
        if problem.fault is Fault.LIMIT:
            raise
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
        """Frames of open elements; None for what only holds models or a value."""
        self._tags: list[str] = []
        self._text: list[str] = []
        self._ordinal = -1
        self._skipped = 0
        self._names: dict[str, str] = {}

    def run(self) -> None:
        made = parser()
        made.StartElementHandler = self._start
        made.EndElementHandler = self._end
        made.CharacterDataHandler = self._text.append
        self._made = made
        parse(self._source, made)

    def document(self) -> ExchangeDocument:
        path = self._source.name
        pending = resolve(self._references, path, self._sink)
        name(self._root, Naming())
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
            too_deep(self._source, self._made, _LIMITS)
        self._text.clear()
        space, _, local = tag.rpartition(SEPARATOR)
        said = self._said(attributes)
        if local in (_RELATIONSHIP, _RELATED) and not space:
            self._element(local, said.get("@type", "").rpartition(":")[2], said)
        elif not self._tags:
            self._top(space, local, said)
        elif space:
            self._inner(space, local, said)
        else:
            self._feature(local, said)

    def _said(self, attributes: dict[str, str]) -> dict[str, str]:
        names = self._names
        try:
            return {names[name]: value for name, value in attributes.items()}
        except KeyError:
            names.update({name: _canonical(name) for name in attributes})
            return {names[name]: value for name, value in attributes.items()}

    def _top(self, space: str, local: str, said: dict[str, str]) -> None:
        if space.startswith(_XMI) and local == "XMI":
            self._push(local, None)
        elif space.startswith(_LANGUAGE):
            self._element(local, local, said)
        else:
            subject = Subject(self._source.name, place=self._place())
            self._sink.report(rules.NO_MODEL, subject, file=self._source.name, root=local)
            self._skipped = 1

    def _inner(self, space: str, local: str, said: dict[str, str]) -> None:
        """An element with a namespace: a model within xmi:XMI, or a tool's own extension."""
        if self._open[-1] is None and space.startswith(_LANGUAGE):
            self._element(local, local, said)
        else:
            self._skipped = 1

    def _element(self, local: str, kind: str, said: dict[str, str]) -> None:
        if said.get("isImplied") == "true":
            self._skipped = 1
        elif not is_concrete(kind):
            owner = next((shown(one.node) for one in reversed(self._open) if one), "")
            subject = Subject(owner or self._source.name, place=self._place())
            self._sink.report(rules.UNKNOWN_METACLASS, subject, kind=kind)
            self._skipped = 1
        else:
            frame = Frame(kind, said.get("@id") or said.get("elementId", ""), self._ordinal)
            self._push(local, frame)
            self._remember(frame)
            self._say(frame, said)

    def _push(self, tag: str, frame: Frame | None) -> None:
        self._tags.append(tag)
        self._open.append(frame)

    def _remember(self, frame: Frame) -> None:
        id = frame.id
        if id in self._references.ids:
            subject = Subject(frame.kind, place=self._place())
            self._sink.report(rules.REPEATED_ID, subject, id=id)
        self._references.stand_for(id, frame.node)

    def _say(self, frame: Frame, said: dict[str, str]) -> None:
        for feature, value in said.items():
            if feature[0] != "@":
                self._take(frame, feature, value)

    def _take(self, frame: Frame, feature: str, value: str) -> None:
        if not is_known(frame.kind, feature):
            self._complain(rules.UNKNOWN_FEATURE, frame, feature)
            return
        wanted = frame.say(feature, value)
        if wanted:
            self._complain(rules.BAD_VALUE, frame, feature, value, wanted)

    def _complain(
        self, rule: Rule, frame: Frame, feature: str, value: str = "", wanted: str = ""
    ) -> None:
        name, kind = shown(frame.node), frame.kind
        subject = Subject(name, place=self._place())
        facts = {"feature": feature, "element": name, "kind": kind, "value": value, "type": wanted}
        self._sink.report(rule, subject, notes=(), help="", **facts)

    def _feature(self, local: str, said: dict[str, str]) -> None:
        """A feature as an element: what it refers to, or its text."""
        frame = self._open[-1]
        target = said.get("href") or said.get("@idref")
        if frame is not None and target is not None:
            if is_known(frame.kind, local):
                frame.targets.setdefault(local, []).append(target)
            else:
                self._complain(rules.UNKNOWN_FEATURE, frame, local)
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
                self._take(owner, local[1:], "".join(self._text))
        elif owner is None:
            self._finish(frame)
        elif local == _RELATIONSHIP:
            self._folding.relationship(frame, owner)
        else:
            self._folding.related(frame, owner)

    def _finish(self, frame: Frame) -> None:
        """A root is closed: the members of a root namespace are those of the document."""
        if frame.kind == "Namespace" and not frame.node.name:
            self._references.stand_for(frame.id, self._root)
            for member in frame.node.members:
                self._root.add_member(member)
            self._root.relations.extend(frame.node.relations)
        else:
            frame.node.membership = "OwningMembership"
            self._root.add_member(frame.node)


def _canonical(name: str) -> str:
    """``@id``, ``@type`` ... for XMI's own attributes; those of other tools are ``@``."""
    space, _, local = name.rpartition(SEPARATOR)
    if not space:
        return name
    if space == _SCHEMA or space.startswith(_XMI):
        return _OF_XMI.get(local, "@")
    return "@"
