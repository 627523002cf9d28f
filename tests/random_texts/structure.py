"""Random definitions and usages of structure: attributes, items, parts, ports and connections."""

from collections.abc import Callable, Sequence

from random_texts.drafts import SCALARS, Definition, Draft, Feature
from random_texts.expressions import (
    QUANTITIES,
    draw_expression,
    draw_type,
    list_globals,
    list_variables,
    refer_type,
)

Drawn = tuple[Feature, str]
"""A feature and its text."""


def draw_multiplicity(draft: Draft) -> tuple[str, bool]:
    """Return a multiplicity as text, and whether it allows several values."""
    if draft.is_drawn(0.6):
        return "", False
    bounds = draft.choose(["1", "0..1", "1..1", "*", "0..*", "1..*", "2", "2..4", "3..*"])
    order = draft.choose(
        ["", "", " ordered", " nonunique", " ordered nonunique", " nonunique ordered"]
    )
    is_many = bounds not in ("1", "0..1", "1..1")
    return f" [{bounds}]{order if is_many else ''}", is_many


def declare(draft: Draft, name: str, typing: str, multiplicity: str) -> str:
    """Return name, typing and multiplicity in one of the two orders."""
    typing = (
        draft.choose([f" : {typing}", f": {typing}", f" defined by {typing}"]) if typing else ""
    )
    order = [typing, multiplicity]
    if draft.is_drawn(0.3) and typing:
        order.reverse()
    return name + "".join(order)


def draw_attribute(draft: Draft, taken: Sequence[Feature]) -> Drawn:
    """Draw an attribute of a definition, in many cases with a value."""
    type_ = draw_type(draft)
    multiplicity, is_many = draw_multiplicity(draft)
    feature = Feature(
        draft.draw_feature_name(other.name for other in taken), "attribute", type_, is_many
    )
    value = ""
    if not multiplicity and draft.is_drawn(0.6):
        sign = draft.choose(["=", "=", ":=", "default", "default =", "default :="])
        feature.is_fixed = sign in ("=", ":=")
        variables = [*list_variables(taken), *list_globals(draft)]
        value = f" {sign} {draw_expression(draft, type_, variables)}"
    prefix = draft.choose(["", "", "", "derived ", "constant "])
    text = declare(draft, feature.name, refer_type(draft, type_), multiplicity)
    return feature, draft.make_block(f"{prefix}attribute {text}{value}", draw_notes(draft, 0.1))


def draw_notes(draft: Draft, probability: float) -> list[str]:
    """Draw documentation, comments and textual representations of the enclosing element."""
    if not draft.is_drawn(probability):
        return []
    return [
        draft.choose(
            [
                "doc /* A short text. */",
                'doc locale "en_US" /*\n * Two lines\n * of text: "quoted".\n */',
                "comment /* a remark */",
                "/* a comment without keyword */",
                'comment locale "de" /* Prüfung */',
                'rep language "ocl" /* self.x > 0 */',
                'language "alf" /* a = b; */',
                f"doc D{draft.random.randint(1, 99)} /* named */",
            ]
        )
    ]


def draw_structural(draft: Draft, kind: str, taken: Sequence[Feature]) -> Drawn:
    """Draw a part, an item or an occurrence with or without a definition."""
    definition = draft.find(f"{kind} def")
    multiplicity, is_many = draw_multiplicity(draft)
    prefix = draft.choose(["", "", "", "", "ref ", "protected ", "private ref ", "abstract "])
    name = draft.draw_feature_name(other.name for other in taken)
    if definition is None:
        feature = Feature(name, kind, "", is_many)
        return feature, draft.make_block(
            f"{prefix}{kind} {declare(draft, name, '', multiplicity)}", draw_notes(draft, 0.3)
        )
    feature = Feature(name, kind, definition, is_many)
    if "pr" in prefix:
        feature.kind = "hidden"
    head = f"{prefix}{kind} {declare(draft, name, draft.refer(definition), multiplicity)}"
    body = draw_redefinitions(draft, definition) if draft.is_drawn(0.5) else []
    return feature, draft.make_block(head, [*body, *draw_notes(draft, 0.1)])


def draw_port(draft: Draft, taken: Sequence[Feature]) -> Drawn:
    """Draw a port, conjugated in some cases."""
    definition = draft.find("port def")
    multiplicity, is_many = draw_multiplicity(draft)
    name = draft.draw_feature_name(other.name for other in taken)
    if definition is None:
        item = draft.find("item def")
        body = [f"in item i1 : {draft.refer(item)};"] if item else ["out attribute o1;"]
        return Feature(name, "port", "", is_many), draft.make_block(
            f"port {name}{multiplicity}", body
        )
    is_conjugated = draft.is_drawn(0.4)
    feature = Feature(name, "port", definition, is_many, is_conjugated=is_conjugated)
    typing = ("~" if is_conjugated else "") + draft.refer(definition)
    return feature, draft.make_block(f"port {declare(draft, name, typing, multiplicity)}", [])


def draw_redefinitions(draft: Draft, definition: Definition) -> list[str]:
    """Draw redefinitions of the features that a usage or a special definition inherits."""
    texts = []
    for feature in definition.features:
        if not draft.is_drawn(0.4) or feature.is_fixed or feature.kind == "hidden":
            continue
        text = _draw_redefinition(draft, feature)
        if text:
            texts.append(text)
    return texts


def _draw_redefinition(draft: Draft, feature: Feature) -> str:
    sign = draft.choose([":>> ", ":>>", "redefines "])
    if feature.kind == "attribute":
        if feature.is_many or (
            isinstance(feature.type, Definition) and feature.type.kind != "enum def"
        ):
            return f"attribute {sign}{feature.name};"
        value = draw_expression(draft, feature.type, list_globals(draft), 1)
        prefix = draft.choose(["attribute ", "", "", "derived attribute "])
        typing = draft.join_drawn(0.2, f" : {refer_type(draft, feature.type)}")
        return f"{prefix}{sign}{feature.name}{typing} = {value};"
    if feature.kind in ("part", "item") and isinstance(feature.type, Definition):
        head = f"{feature.kind} {sign}{feature.name}"
        return draft.make_block(head, draw_redefinitions(draft, feature.type))
    if feature.kind == "port" and not feature.direction:
        return f"port {sign}{feature.name};"
    return ""


def draw_attribute_definition(draft: Draft) -> Definition:
    """Draw a definition of attributes: a special scalar, or attributes of its own."""
    definition = draft.make_definition("attribute def")
    head = f"attribute def {draft.identify(definition)}"
    if draft.is_drawn(0.4):
        base = refer_type(draft, draft.choose([*SCALARS, *QUANTITIES]))
        sign = draft.choose([":>", "specializes"])
        return draft.add(definition, f"{head} {sign} {base};")
    texts = draw_notes(draft, 0.3)
    for _ in range(draft.random.randint(1, 3)):
        feature, text = draw_attribute(draft, definition.features)
        definition.features.append(feature)
        texts.append(text)
    return draft.add(definition, draft.make_block(head, texts))


def draw_enumeration(draft: Draft) -> Definition:
    """Draw an enumeration; its values are features."""
    definition = draft.make_definition("enum def")
    texts = draw_notes(draft, 0.3)
    for _ in range(draft.random.randint(2, 4)):
        name = draft.draw_feature_name(feature.name for feature in definition.features)
        definition.features.append(Feature(name, "value", definition))
        texts.append(draft.make_block(draft.choose(["", "enum "]) + name, draw_notes(draft, 0.1)))
    return draft.add(definition, draft.make_block(f"enum def {draft.identify(definition)}", texts))


_MEMBERS: dict[str, Sequence[Callable[[Draft, Sequence[Feature]], Drawn]]] = {
    "item def": (draw_attribute, draw_attribute, lambda d, t: draw_structural(d, "item", t)),
    "part def": (
        draw_attribute,
        draw_attribute,
        draw_port,
        lambda d, t: draw_structural(d, "part", t),
        lambda d, t: draw_structural(d, "item", t),
    ),
    "occurrence def": (draw_attribute, lambda d, t: draw_structural(d, "part", t)),
}


def draw_members(draft: Draft, kind: str, inherited: Sequence[Feature], count: int) -> list[Drawn]:
    """Draw members of a definition; their names differ from those of the inherited features."""
    drawn: list[Drawn] = []
    for _ in range(count):
        taken = [*inherited, *(feature for feature, _ in drawn)]
        drawn.append(draft.choose(_MEMBERS[kind])(draft, taken))
    return drawn


def draw_structure_definition(draft: Draft, kind: str) -> Definition:
    """Draw a definition of parts, items or occurrences, in some cases a special one."""
    definition = draft.make_definition(kind)
    general = draft.find(kind)
    redefinitions: list[str] = []
    head = ""
    if general is not None and draft.is_drawn(0.4):
        head = f" {draft.choose([':>', ':> ', 'specializes '])}{draft.refer(general)}"
        definition.features += general.features
        redefinitions = draw_redefinitions(draft, general)
        _fix_redefined(definition, redefinitions)
    drawn = draw_members(draft, kind, definition.features, draft.random.randint(0, 4))
    definition.features += [feature for feature, _ in drawn]
    texts = [*draw_notes(draft, 0.2), *redefinitions, *(text for _, text in drawn)]
    prefix = draft.choose(["", "", "", "abstract "])
    head = f"{prefix}{kind} {draft.identify(definition)}{head}"
    return draft.add(definition, draft.make_block(head, texts))


def _fix_redefined(definition: Definition, redefinitions: Sequence[str]) -> None:
    """Replace the features with a new value by features that nothing redefines again."""
    joined = "\n".join(redefinitions)
    definition.features[:] = [
        Feature(f.name, f.kind, f.type, f.is_many, f.direction, f.is_fixed or f.name in joined)
        for f in definition.features
    ]


def draw_port_definition(draft: Draft) -> Definition:
    """Draw a port definition with features that have a direction."""
    definition = draft.make_definition("port def")
    texts = draw_notes(draft, 0.1)
    for _ in range(draft.random.randint(1, 3)):
        name = draft.draw_feature_name(feature.name for feature in definition.features)
        direction = draft.choose(["in", "out", "inout"])
        item = draft.find("item def")
        if item is not None and draft.is_drawn(0.6):
            feature = Feature(name, "item", item, direction=direction)
            texts.append(f"{direction} item {name} : {draft.refer(item)};")
        else:
            type_ = draw_type(draft)
            feature = Feature(name, "attribute", type_, direction=direction, is_fixed=True)
            texts.append(f"{direction} attribute {name} : {refer_type(draft, type_)};")
        definition.features.append(feature)
    return draft.add(definition, draft.make_block(f"port def {draft.identify(definition)}", texts))


def draw_usage(draft: Draft, kind: str) -> Definition:
    """Draw a part or an item of a package."""
    definition = draft.find(f"{kind} def")
    usage = draft.make_definition(f"{kind} usage")
    if definition is None:
        drawn = draw_members(draft, f"{kind} def", [], draft.random.randint(0, 3))
        usage.features += [feature for feature, _ in drawn]
        head = f"{kind} {draft.identify(usage)}"
        return draft.add(usage, draft.make_block(head, [text for _, text in drawn]))
    usage.type = definition
    redefinitions = draw_redefinitions(draft, definition)
    usage.features += definition.features
    _fix_redefined(usage, redefinitions)
    head = f"{kind} {draft.identify(usage)} : {draft.refer(definition)}"
    return draft.add(usage, draft.make_block(head, [*redefinitions, *draw_notes(draft, 0.1)]))


def draw_special_usage(draft: Draft) -> None:
    """Draw a part that subsets, references or is bound to a part of a package."""
    part = draft.find("part usage")
    if part is None:
        return
    name, reference = draft.draw_name(), draft.refer(part)
    nested = [feature for feature in part.list_features("part") if not feature.is_many]
    if nested:
        reference = draft.choose([reference, f"{reference}.{draft.choose(nested).name}"])
    forms = [f"part {name} :> {reference};", f"part {name} subsets {reference};"]
    forms += [f"ref part {name} ::> {reference};", f"part {name} references {reference};"]
    forms += [f"ref part {name} = {reference};", f"ref {name} :> {reference};"]
    draft.add_member(draft.choose(forms))


def draw_global_attribute(draft: Draft) -> Definition:
    """Draw an attribute of a package with a value."""
    usage = draft.make_definition("attribute usage")
    usage.type = draw_type(draft)
    value = draw_expression(draft, usage.type, list_globals(draft))
    head = f"attribute {draft.identify(usage)} : {refer_type(draft, usage.type)}"
    return draft.add(usage, f"{head} {draft.choose(['=', ':=', 'default'])} {value};")


def draw_individual(draft: Draft) -> None:
    """Draw an individual definition and a usage of it with snapshots and time slices."""
    general = draft.find("part def")
    if general is None:
        return
    name = draft.draw_name()
    keyword = draft.choose(["individual part def", "individual def", "individual occurrence def"])
    draft.add_member(f"{keyword} {name} :> {draft.refer(general)};")
    body = ["snapshot s1;", "timeslice t1 { snapshot s2; }", "individual part i1;"]
    body = draft.random.sample(body, draft.random.randint(0, 3))
    if len(body) > 1 and draft.is_drawn(0.5):
        body[1] = f"then {body[1]}"
    usage = draft.choose(["individual part", "individual"])
    draft.add_member(draft.make_block(f"{usage} {draft.draw_name()} : {name}", body))


def draw_variation(draft: Draft) -> None:
    """Draw a variation of parts or of attributes with variants."""
    name, definition = draft.draw_name(), draft.find("part def")
    if definition is None:
        draft.add_member(
            f"variation attribute def {name} {{ variant attribute v1; variant attribute v2; }}"
        )
        return
    reference = draft.refer(definition)
    usage = draft.find("part usage", lambda usage: usage.type is definition)
    variants = [f"variant part v1 : {reference};", "variant part v2 { doc /* 2 */ }"]
    if usage is not None:
        variants.append(f"variant {draft.refer(usage)};")
    if draft.is_drawn(0.5):
        draft.add_member(draft.make_block(f"variation part {name} : {reference}", variants))
        return
    head = f"variation part def {name} :> {reference}"
    draft.add_member(draft.make_block(head, variants))
    draft.add_member(f"part {draft.draw_name()} : {name} = {name}::v1;")
