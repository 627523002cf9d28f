"""Random connections, interfaces, flows, messages, bindings and allocations."""

from random_texts.drafts import Definition, Draft, Feature
from random_texts.structure import draw_notes

_ENDS = ("source1", "target1", "from1", "to1", "left1", "right1")


def draw_connection_definition(draft: Draft) -> Definition | None:
    """Draw a connection or allocation definition between two part definitions."""
    ends = [draft.find("part def"), draft.find("part def")]
    if None in ends:
        return None
    kind = draft.choose(["connection", "connection", "allocation"])
    definition = draft.make_definition(f"{kind} def")
    texts = draw_notes(draft, 0.2)
    for name, end in zip(draft.random.sample(_ENDS, 2), ends, strict=True):
        cross = draft.choose(["", "", "[1] ", "[0..1] ", "[0..*] ", f"{name}Cross [1] "])
        texts.append(f"end {cross}part {name} : {draft.refer(end)};")
        definition.features.append(Feature(name, "end", end))
    if draft.is_drawn(0.3):
        texts.append("attribute strength1 : ScalarValues::Real;")
    return draft.add(
        definition, draft.make_block(f"{kind} def {draft.identify(definition)}", texts)
    )


def draw_interface_definition(draft: Draft) -> Definition | None:
    """Draw an interface definition between a port definition and its conjugate."""
    port = draft.find("port def")
    if port is None:
        return None
    definition = draft.make_definition("interface def")
    texts = [f"end p1 : {draft.refer(port)};", f"end port p2 : ~{draft.refer(port)};"]
    for feature in port.features:
        if draft.is_drawn(0.5):
            ends = {"out": ("p1", "p2"), "in": ("p2", "p1")}.get(feature.direction, ("p1", "p2"))
            source, target = (f"{end}.{feature.name}" for end in ends)
            texts.append(
                draft.choose(
                    [f"flow {source} to {target};", f"bind p1.{feature.name} = p2.{feature.name};"]
                )
            )
    definition.type = port
    return draft.add(
        definition, draft.make_block(f"interface def {draft.identify(definition)}", texts)
    )


def draw_assembly(draft: Draft) -> Definition | None:
    """Draw a part with two parts, and connectors between them."""
    types = [draft.find("part def"), draft.find("part def")]
    if None in types:
        return None
    keyword = draft.choose(["part def", "part"])
    definition = draft.make_definition(f"assembly {keyword}")
    texts = [f"part m1 : {draft.refer(types[0])};", f"part m2 : {draft.refer(types[1])};"]
    for _ in range(draft.random.randint(1, 4)):
        texts += _draw_connector(draft, types[0], types[1])
    return draft.add(definition, draft.make_block(f"{keyword} {draft.identify(definition)}", texts))


def _draw_connector(draft: Draft, source: Definition, target: Definition) -> list[str]:
    drawers = (_draw_connection, _draw_connection, _draw_interface, _draw_flow, _draw_message)
    return draft.choose(drawers)(draft, source, target)


def _draw_end(draft: Draft, name: str, reference: str) -> str:
    name = draft.choose(["", "", "", f"{name} ::> ", f"{name} references "])
    return draft.choose(["", "", "[1] ", "[0..*] "]) + name + reference


def _draw_connection(draft: Draft, source: Definition, target: Definition) -> list[str]:
    name = draft.draw_name()
    definition = draft.find(
        draft.choose(["connection def", "allocation def"]),
        lambda d: [feature.type for feature in d.features] == [source, target],
    )
    if definition is not None:
        kind = definition.kind.split()[0]
        verb = {"connection": "connect", "allocation": "allocate"}[kind]
        left, right = (
            _draw_end(draft, feature.name, part)
            for feature, part in zip(definition.features, ("m1", "m2"), strict=True)
        )
        ends = draft.choose([f"{left} to {right}", f"({left}, {right})"])
        return [f"{kind} {name} : {draft.refer(definition)} {verb} {ends};"]
    left, right = _draw_end(draft, "a1", "m1"), _draw_end(draft, "b1", "m2")
    return [
        draft.choose(
            [
                f"connect {left} to {right};",
                f"connect ({left}, {right});",
                f"connection {name} connect {left} to {right};",
                f"allocate {left} to {right};",
                f"allocation {name} allocate {left} to {right};",
                f"allocation {name};",
                f"connection {name} {{ end part e1 ::> m1; end part e2 ::> m2; }}",
            ]
        )
    ]


def _draw_interface(draft: Draft, source: Definition, target: Definition) -> list[str]:
    """Draw an interface between two ports of the same definition."""
    pairs = [
        (left, right)
        for left in source.list_features("port")
        for right in target.list_features("port")
        if left.type and left.type is right.type
    ]
    if not pairs:
        return []
    left, right = draft.choose(pairs)
    ends = f"m1.{left.name} to m2.{right.name}"
    forms = [
        f"interface {ends};",
        f"connect {ends};",
        f"interface {draft.draw_name()} connect {ends};",
    ]
    definition = draft.find("interface def", lambda d: d.type is left.type)
    if definition is not None and not left.is_conjugated and right.is_conjugated:
        typed = f"interface {draft.draw_name()} : {draft.refer(definition)} connect "
        forms += [
            typed + f"{ends};",
            typed + f"p1 ::> m1.{left.name} to p2 ::> m2.{right.name};",
        ] * 3
    if left.is_conjugated == right.is_conjugated and not left.is_many and not right.is_many:
        forms.append(f"bind m1.{left.name} = m2.{right.name};")
        forms.append(f"binding {draft.draw_name()} bind m1.{left.name} = m2.{right.name};")
    return [draft.choose(forms)]


def _draw_flow(draft: Draft, source: Definition, target: Definition) -> list[str]:
    """Draw a flow from an output of a port to an input of the same type."""
    pairs = [
        (f"m1.{left.name}.{output.name}", f"m2.{right.name}.{input_.name}", output.type)
        for left in source.list_features("port")
        for right in target.list_features("port")
        for output in _list_directed(left, "out")
        for input_ in _list_directed(right, "in")
        if output.type is input_.type and isinstance(output.type, Definition)
    ]
    if not pairs:
        return []
    left, right, type_ = draft.choose(pairs)
    payload = draft.refer(type_)
    return [
        draft.choose(
            [
                f"flow {left} to {right};",
                f"flow from {left} to {right};",
                f"flow {draft.draw_name()} from {left} to {right};",
                f"flow of {payload} from {left} to {right};",
                f"flow {draft.draw_name()} of pay1 : {payload} from {left} to {right};",
                f"flow of {payload} [1] from {left} to {right};",
                f"succession flow {left} to {right};",
                f"succession flow {draft.draw_name()} of {payload} from {left} to {right};",
            ]
        )
    ]


def _list_directed(port: Feature, direction: str) -> list[Feature]:
    """Return the features of a port with this direction, seen from outside."""
    if not isinstance(port.type, Definition):
        return []
    if port.is_conjugated:
        direction = {"in": "out", "out": "in"}[direction]
    return [f for f in port.type.features if f.direction in (direction, "inout")]


def _draw_message(draft: Draft, source: Definition, target: Definition) -> list[str]:
    payload = draft.find("item def")
    of = f" of {draft.refer(payload)}" if payload else ""
    return [
        draft.choose(
            [
                f"message{of} from m1 to m2;",
                f"message {draft.draw_name()}{of} from m1 to m2;",
                f"message {draft.draw_name()}{of};",
                "message m1 to m2;",
            ]
        )
    ]


def draw_sequence(draft: Draft) -> None:
    """Draw an occurrence definition with messages between events of two parts."""
    payload = draft.find("item def")
    texts = []
    for part in ("a1", "b1"):
        events = [f"event occurrence {part}e{number};" for number in (1, 2)]
        texts.append(
            draft.make_block(
                f"{draft.choose(['part', 'ref part'])} {part}", [events[0], f"then {events[1]}"]
            )
        )
    of = f" of {draft.refer(payload)}" if payload else ""
    texts.append(f"message q1{of} from a1.a1e1 to b1.b1e1;")
    texts.append(f"{draft.choose(['', 'then '])}message q2{of} from b1.b1e2 to a1.a1e2;")
    if draft.is_drawn(0.3):
        texts.append("first q1 then q2;")
    head = f"occurrence {draft.choose(['def ', ''])}{draft.draw_name()}"
    draft.add_member(draft.make_block(head, texts))


def draw_flow_definition(draft: Draft) -> None:
    """Draw a flow definition with a payload."""
    payload = draft.find("item def")
    body = [f"ref :>> payload : {draft.refer(payload)};"] if payload else []
    draft.add_member(draft.make_block(f"flow def {draft.draw_name()}", body))


def draw_dependency(draft: Draft) -> None:
    """Draw a dependency, a comment about an element, or metadata."""
    elements = [d for d in (draft.find(k) for k in ("part def", "item def", "part usage")) if d]
    if not elements:
        return
    references = [draft.refer(element) for element in elements]
    source, target = draft.choose(references), draft.choose(references)
    draft.add_member(
        draft.choose(
            [
                f"dependency {source} to {target};",
                f"dependency from {source} to {target} {{ doc /* why */ }}",
                f"dependency {draft.draw_name()} from {', '.join(references)} to {target};",
                f"comment about {', '.join(references)} /* about some elements */",
                f'comment {draft.draw_name()} about {source} locale "en" /* named */',
                f"alias {draft.draw_name()} for {source};",
                f"alias <{draft.draw_name()}> for {target} {{ doc /* short */ }}",
            ]
        )
    )


def draw_metadata(draft: Draft) -> None:
    """Draw a metadata definition and an annotation by it."""
    name = draft.draw_name()
    level = "attribute level : ScalarValues::Integer"
    bodies = [
        [],
        [f"{level};"],
        [f"{level} default 1;", "attribute note1 : ScalarValues::String [0..1];"],
        [
            "ref :>> annotatedElement : SysML::Usage;",
            "ref :>> annotatedElement : SysML::Definition;",
        ],
    ]
    members = draft.choose(bodies)
    draft.add_member(draft.make_block(f"metadata def {name}", members))
    has_level = bool(members) and members[0].startswith("attribute")
    body = f" {{ {draft.choose(['', ':>> '])}level = 3; }}" if has_level else ";"
    owner = draft.draw_name()
    forms = [
        f"part {owner} {{ @{name}{body} }}",
        f"part {owner} {{ metadata {draft.draw_name()} : {name}{body} }}",
        f"#{name} part def {owner};",
        f"#{name} {owner};",
    ]
    element = draft.find(draft.choose(["part def", "part usage", "item def"]))
    if element is not None:
        about = draft.refer(element)
        forms += 2 * [f"@{name} about {about}{body}", f"metadata {name} about {about}{body}"]
    draft.add_member(draft.choose(forms))
