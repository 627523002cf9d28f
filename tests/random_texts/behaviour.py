"""Random actions, states, calculations and constraints."""

from collections.abc import Sequence

from random_texts.drafts import Definition, Draft, Feature
from random_texts.expressions import (
    Variable,
    draw_expression,
    draw_type,
    list_globals,
    refer_type,
)
from random_texts.structure import draw_notes

_INSTANT = 'Time::Iso8601DateTime("2026-01-01T00:00:00Z")'


class Scope:
    """What a behaviour may read, assign, and send through."""

    def __init__(
        self,
        readable: Sequence[Variable] = (),
        assignable: Sequence[Variable] = (),
        ports: Sequence[str] = (),
    ) -> None:
        self.readable = [*readable, *assignable]
        self.assignable = list(assignable)
        self.ports = list(ports)

    def extend(
        self, readable: Sequence[Variable] = (), assignable: Sequence[Variable] = ()
    ) -> "Scope":
        """Return a scope with more variables."""
        old = [variable for variable in self.readable if variable not in self.assignable]
        return Scope([*old, *readable], [*self.assignable, *assignable], self.ports)


def draw_parameters(draft: Draft, count: int) -> list[Feature]:
    """Draw parameters of a behaviour, attributes with a single value."""
    features: list[Feature] = []
    for _ in range(count):
        name = draft.draw_feature_name(feature.name for feature in features)
        direction = draft.choose(["in", "in", "out", "inout"])
        features.append(Feature(name, "attribute", draw_type(draft), direction=direction))
    return features


def declare_parameter(draft: Draft, feature: Feature) -> str:
    """Return the declaration of a parameter."""
    keyword = draft.choose(["", "attribute ", "attribute "])
    return f"{feature.direction} {keyword}{feature.name} : {refer_type(draft, feature.type)};"


def draw_action_definition(draft: Draft) -> Definition:
    """Draw an action definition with parameters and steps."""
    definition = draft.make_definition("action def")
    definition.features = draw_parameters(draft, draft.random.randint(0, 3))
    texts = [*draw_notes(draft, 0.2), *(declare_parameter(draft, f) for f in definition.features)]
    inputs = [Variable(f.name, f.type) for f in definition.features if f.direction != "out"]
    if draft.is_drawn(0.7):
        texts += draw_action_body(draft, Scope([*inputs, *list_globals(draft)]), 2)
    return draft.add(
        definition, draft.make_block(f"action def {draft.identify(definition)}", texts)
    )


def draw_action_usage(draft: Draft) -> Definition:
    """Draw an action of a package."""
    usage = draft.make_definition("action usage")
    texts = draw_action_body(draft, Scope(list_globals(draft)), 2)
    return draft.add(usage, draft.make_block(f"action {draft.identify(usage)}", texts))


def draw_action_body(draft: Draft, scope: Scope, depth: int) -> list[str]:
    """Draw local attributes and the steps of an action, as a sequence or as a graph."""
    texts, assignable = [], []
    for _ in range(draft.random.randint(0, 2)):
        name, type_ = draft.draw_name(), draw_type(draft)
        value = draw_expression(draft, type_, scope.readable, 1)
        texts.append(f"attribute {name} : {refer_type(draft, type_)} := {value};")
        assignable.append(Variable(name, type_))
    scope = scope.extend(assignable=assignable)
    drawer = draft.choose([_draw_sequence, _draw_sequence, _draw_fork, _draw_decision, _draw_graph])
    return texts + drawer(draft, scope, depth)


def _draw_sequence(draft: Draft, scope: Scope, depth: int) -> list[str]:
    steps = [draw_step(draft, scope, depth) for _ in range(draft.random.randint(1, 3))]
    lines = [f"then {step}" for step in steps]
    return [
        "first start;",
        *lines,
        draft.choose(["then done;", "then done;", "then terminate;", ""]),
    ]


def _draw_fork(draft: Draft, scope: Scope, depth: int) -> list[str]:
    fork, join = draft.draw_name(), draft.draw_name()
    names = [draft.draw_name() for _ in range(2)]
    lines = ["first start;", f"then fork {fork};", *(f"    then {name};" for name in names)]
    lines += [f"action {name};\nthen {join};" for name in names]
    return [*lines, f"join {join};", f"then {draw_step(draft, scope, depth)}", "then done;"]


def _draw_decision(draft: Draft, scope: Scope, depth: int) -> list[str]:
    names = [draft.draw_name() for _ in range(2)]
    guard = draw_expression(draft, "Boolean", scope.readable, 1)
    merge = draft.draw_name()
    repeats = draft.is_drawn(0.4)
    lines = ["first start;", f"then merge {merge};" if repeats else ""]
    lines += [f"then {draft.choose(['decide;', f'decide {draft.draw_name()};'])}"]
    lines += [f"    if {guard} then {names[0]};", f"    else {names[1]};"]
    lines += [f"action {names[0]};", f"then {merge};" if repeats else "then done;"]
    return [*lines, f"action {names[1]};", "then done;"]


def _draw_graph(draft: Draft, scope: Scope, depth: int) -> list[str]:
    names = [draft.draw_name() for _ in range(draft.random.randint(2, 3))]
    lines = [f"action {name};" for name in names]
    for source, target in zip(["start", *names], [*names, "done"], strict=True):
        form = draft.choose(["first", "first", "succession first", "succession {} first"])
        lines.append(f"{form.format(draft.draw_name())} {source} then {target};")
    if draft.is_drawn(0.5):
        draft.random.shuffle(lines)
    return lines


def draw_step(draft: Draft, scope: Scope, depth: int) -> str:
    """Draw an action node with everything in it."""
    simple = [_draw_call, _draw_call, _draw_accept, _draw_send, _draw_assignment, _draw_perform]
    nested = [_draw_if, _draw_while, _draw_for, _draw_nested_action]
    return draft.choose(simple + nested if depth else simple)(draft, scope, depth)


def _draw_node_name(draft: Draft) -> str:
    return draft.join_drawn(0.4, f"action {draft.draw_name()} ")


def _draw_call(draft: Draft, scope: Scope, depth: int) -> str:
    definition = draft.find(draft.choose(["action def", "calc def"]))
    name = draft.draw_name()
    if definition is None:
        return f"action {name};"
    texts = []
    for feature in definition.features:
        if feature.direction == "in" and draft.is_drawn(0.7):
            sign = draft.choose(["in ", "in :>> ", "in attribute :>> "])
            value = draw_expression(draft, feature.type, list_globals(draft), 1)
            texts.append(f"{sign}{feature.name} = {value};")
    keyword = definition.kind.split()[0]
    return draft.make_block(f"{keyword} {name} : {draft.refer(definition)}", texts)


def _draw_trigger(draft: Draft, scope: Scope) -> str:
    """Draw the trigger of an accept action or of a transition."""
    item = draft.find("item def")
    via = f" via {draft.choose(scope.ports)}" if scope.ports and draft.is_drawn(0.6) else ""
    if item is not None and draft.is_drawn(0.6):
        reference = draft.refer(item)
        name = draft.choose(["", f"{draft.draw_name()} : ", ": "])
        return f"{name}{reference}{via}"
    time = draw_expression(draft, "DurationValue", (), 0)
    condition = draw_expression(draft, "Boolean", scope.readable, 1)
    name = draft.join_drawn(0.2, f"{draft.draw_name()} ")
    return name + draft.choose([f"after {time}", f"when {condition}", f"at {_INSTANT}"])


def _draw_accept(draft: Draft, scope: Scope, depth: int) -> str:
    return f"{_draw_node_name(draft)}accept {_draw_trigger(draft, scope)};"


def _draw_send(draft: Draft, scope: Scope, depth: int) -> str:
    item = draft.find("item def")
    payload = f"new {draft.refer(item)}()" if item else draw_expression(draft, "Integer", (), 0)
    if scope.ports:
        first, second = draft.choose(scope.ports), draft.choose(scope.ports)
        where = draft.choose([f"via {first}", f"to {first}", f"via {first} to {second}"])
    else:
        where = draft.choose(["", "to self", "via self"])
    return f"{_draw_node_name(draft)}send {payload} {where}".rstrip() + ";"


def _draw_assignment(draft: Draft, scope: Scope, depth: int) -> str:
    if not scope.assignable:
        return _draw_call(draft, scope, depth)
    variable = draft.choose(scope.assignable)
    value = draw_expression(draft, variable.type, scope.readable, 2)
    return f"{_draw_node_name(draft)}assign {variable.text} := {value};"


def _draw_perform(draft: Draft, scope: Scope, depth: int) -> str:
    usage = draft.find("action usage")
    definition = draft.find("action def")
    if usage is not None and draft.is_drawn(0.6):
        return f"perform {draft.refer(usage)};"
    typing = f" : {draft.refer(definition)}" if definition else ""
    return f"perform action {draft.draw_name()}{typing};"


def _draw_body(draft: Draft, scope: Scope, depth: int) -> str:
    """Draw the body of a control structure; the result ends without a line break."""
    head = draft.choose(["", "", f"action {draft.draw_name()} ", "action "])
    steps = [draw_step(draft, scope, depth - 1) for _ in range(draft.random.randint(0, 2))]
    lines = [step if number == 0 else f"then {step}" for number, step in enumerate(steps)]
    body = "\n".join(lines).replace("\n", "\n    ")
    return f"{head}{{\n    {body}\n}}" if lines else f"{head}{{ }}"


def _draw_if(draft: Draft, scope: Scope, depth: int) -> str:
    text = ""
    for _ in range(draft.random.randint(1, 2)):
        test = draw_expression(draft, "Boolean", scope.readable, 2)
        text += f"{' else ' if text else ''}if {test} {_draw_body(draft, scope, depth)}"
    return (
        _draw_node_name(draft)
        + text
        + draft.join_drawn(0.5, f" else {_draw_body(draft, scope, depth)}")
    )


def _draw_while(draft: Draft, scope: Scope, depth: int) -> str:
    test, until = (draw_expression(draft, "Boolean", scope.readable, 1) for _ in range(2))
    head = draft.choose(["loop", f"while {test}"])
    end = draft.join_drawn(0.5, f" until {until};")
    return f"{_draw_node_name(draft)}{head} {_draw_body(draft, scope, depth)}{end}"


def _draw_for(draft: Draft, scope: Scope, depth: int) -> str:
    name = draft.draw_name()
    typing = draft.choose(["", f" : {refer_type(draft, 'Integer')}"])
    values = draft.choose(["(1, 2, 3)", "1..4", "(1, 2)"])
    inner = scope.extend(readable=[Variable(name, "Integer")] if typing else [])
    return (
        f"{_draw_node_name(draft)}for {name}{typing} in {values} {_draw_body(draft, inner, depth)}"
    )


def _draw_nested_action(draft: Draft, scope: Scope, depth: int) -> str:
    texts = draw_action_body(draft, scope, depth - 1)
    return draft.make_block(f"action {draft.draw_name()}", texts)


def draw_calculation(draft: Draft) -> Definition:
    """Draw a calculation definition."""
    definition = draft.make_definition("calc def")
    definition.type = draft.choose(["Integer", "Real", "Boolean", "MassValue"])
    definition.features = draw_parameters(draft, draft.random.randint(1, 2))
    for feature in definition.features:
        feature.direction = "in"
    variables = [Variable(f.name, f.type) for f in definition.features]
    value = draw_expression(draft, definition.type, [*variables, *list_globals(draft)])
    texts = [declare_parameter(draft, feature) for feature in definition.features]
    typing = refer_type(draft, definition.type)
    result = [
        [f"return : {typing};", value],
        [f"return result1 : {typing} = {value};"],
        [f"return attribute : {typing} = {value};"],
        [f"attribute local1 : {typing} = {value};", f"return : {typing};", "local1"],
    ]
    texts += draft.choose(result)
    return draft.add(definition, draft.make_block(f"calc def {draft.identify(definition)}", texts))


def draw_constraint(draft: Draft) -> Definition:
    """Draw a constraint definition."""
    definition = draft.make_definition("constraint def")
    definition.features = draw_parameters(draft, draft.random.randint(1, 2))
    for feature in definition.features:
        feature.direction = "in"
    variables = [Variable(f.name, f.type) for f in definition.features]
    texts = [declare_parameter(draft, feature) for feature in definition.features]
    texts += [*draw_notes(draft, 0.2), draw_expression(draft, "Boolean", variables)]
    return draft.add(
        definition, draft.make_block(f"constraint def {draft.identify(definition)}", texts)
    )


def draw_constraint_usage(draft: Draft, variables: Sequence[Variable]) -> str:
    """Draw a constraint over *variables*, asserted in most cases."""
    head = draft.choose(
        ["assert constraint", "assert constraint", "assert not constraint", "constraint"]
    )
    name = draft.join_drawn(0.5, f" {draft.draw_name()}")
    definition = draft.find("constraint def")
    if definition is not None and draft.is_drawn(0.4):
        texts = [
            f"in {f.name} = {draw_expression(draft, f.type, list_globals(draft), 0)};"
            for f in definition.features
        ]
        return draft.make_block(f"{head}{name} : {draft.refer(definition)}", texts)
    return draft.make_block(f"{head}{name}", [draw_expression(draft, "Boolean", variables)])


def draw_machine(draft: Draft) -> Definition:
    """Draw a part definition with ports, attributes, constraints, actions and states."""
    definition = draft.make_definition("part def")
    texts, ports, variables = [], [], []
    for _ in range(draft.random.randint(0, 2)):
        port, name = draft.find("port def"), draft.draw_name()
        typing = f" : {draft.choose(['', '~'])}{draft.refer(port)}" if port else ""
        texts.append(f"port {name}{typing};")
        ports.append(name)
    for _ in range(draft.random.randint(0, 3)):
        name, type_ = draft.draw_name(), draw_type(draft)
        value = draw_expression(draft, type_, list_globals(draft), 0)
        texts.append(f"attribute {name} : {refer_type(draft, type_)} := {value};")
        variables.append(Variable(name, type_))
    scope = Scope(list_globals(draft), variables, ports)
    for _ in range(draft.random.randint(1, 2)):
        drawer = draft.choose([_draw_state_member, _draw_state_member, _draw_action_member])
        texts.append(drawer(draft, scope))
    if draft.is_drawn(0.4):
        texts.append(draw_constraint_usage(draft, scope.readable))
    return draft.add(definition, draft.make_block(f"part def {draft.identify(definition)}", texts))


def _draw_action_member(draft: Draft, scope: Scope) -> str:
    usage = draft.find("action usage")
    if usage is not None and draft.is_drawn(0.3):
        return f"perform {draft.refer(usage)};"
    head = draft.choose(["action", "perform action"])
    return draft.make_block(f"{head} {draft.draw_name()}", draw_action_body(draft, scope, 1))


def _draw_state_member(draft: Draft, scope: Scope) -> str:
    definition = draft.find("state def")
    name = draft.draw_name()
    if definition is not None and draft.is_drawn(0.3):
        return f"{draft.choose(['exhibit state', 'state'])} {name} : {draft.refer(definition)};"
    head = f"{draft.choose(['exhibit state', 'state'])} {name}"
    if draft.is_drawn(0.2):
        regions = [
            draft.make_block(f"state {draft.draw_name()}", draw_states(draft, scope, 0))
            for _ in range(2)
        ]
        return draft.make_block(f"{head} parallel", regions)
    return draft.make_block(head, draw_states(draft, scope, 1))


def draw_state_definition(draft: Draft) -> Definition:
    """Draw a state definition."""
    definition = draft.make_definition("state def")
    texts = draw_states(draft, Scope(list_globals(draft)), 1)
    return draft.add(definition, draft.make_block(f"state def {draft.identify(definition)}", texts))


def draw_states(draft: Draft, scope: Scope, depth: int) -> list[str]:
    """Draw the states and transitions of a state, with its own entry, do and exit actions."""
    names = [draft.draw_name() for _ in range(draft.random.randint(2, 3))]
    entry = f"entry {_draw_subaction(draft, scope)}" if draft.is_drawn(0.3) else "entry;"
    lines = [f"{entry}\nthen {names[0]};", *_draw_subactions(draft, scope, ("do", "exit"))]
    for index, name in enumerate(names):
        body = _draw_subactions(draft, scope, ("entry", "do", "exit"))
        if depth and draft.is_drawn(0.2):
            body = draw_states(draft, scope, depth - 1)
        target = names[(index + 1) % len(names)]
        state = draft.make_block(f"state {name}", body)
        rest = _draw_transition_rest(draft, scope)
        form = draft.choose(["shorthand", "named", "named", "unnamed"])
        if form == "shorthand":
            # Without a trigger or a guard, the short form has no effect (8.2.2.18.3).
            rest = f"if true {rest}".rstrip() if rest[:2] in ("", "do") else rest
            lines.append(f"{state}\n{rest} then {target};")
        elif form == "named":
            lines += [state, f"transition {draft.draw_name()} first {name} {rest} then {target};"]
        else:
            lines += [state, f"transition first {name} {rest} then {target};"]
    if draft.is_drawn(0.3):
        lines.append(f"transition {names[0]} then done;")
    return lines


def _draw_transition_rest(draft: Draft, scope: Scope) -> str:
    """Draw trigger, guard and effect of a transition."""
    parts = [f"accept {_draw_trigger(draft, scope)}"] if draft.is_drawn(0.8) else []
    if draft.is_drawn(0.4):
        parts.append(f"if {draw_expression(draft, 'Boolean', scope.readable)}")
    if draft.is_drawn(0.4):
        forms = [_draw_send(draft, scope, 0).removesuffix(";"), f"action {draft.draw_name()}"]
        if scope.assignable:
            forms.append(_draw_assignment(draft, scope, 0).removesuffix(";"))
        effect = draft.choose(forms)
        parts.append(f"do {effect}")
    return " ".join(parts)


def _draw_subactions(draft: Draft, scope: Scope, kinds: Sequence[str]) -> list[str]:
    return [f"{kind} {_draw_subaction(draft, scope)}" for kind in kinds if draft.is_drawn(0.25)]


def _draw_subaction(draft: Draft, scope: Scope) -> str:
    usage = draft.find("action usage")
    forms = [f"action {draft.draw_name()};", f"action {{ {draw_step(draft, scope, 0)} }}"]
    forms.append(_draw_send(draft, scope, 0))
    if scope.assignable:
        forms.append(_draw_assignment(draft, scope, 0))
    if usage is not None:
        forms.append(f"{draft.refer(usage)};")
    return draft.choose(forms)
