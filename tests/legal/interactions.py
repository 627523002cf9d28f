"""Topics of interactions: lifelines, messages, fragments, executions, gates and times."""

from dialects.papyrus import Element
from legal.draft import Draft

_SINGLE = ("opt", "loop", "break", "neg", "assert", "critical")
_SEVERAL = ("alt", "par", "seq", "strict")


class Scenario:
    """An interaction between parts of a block; occurrences stand in their order in time."""

    def __init__(self, draft: Draft, word: str = "Scenario") -> None:
        self.draft = draft
        self.block = draft.add_block("System")
        self.operation = draft.add(
            draft.block, "ownedOperation", "Operation", draft.make_name("operation")
        )
        name = draft.signal.get("name")
        if name not in [reception.get("name") for reception in draft.block.iter("ownedReception")]:
            draft.add(draft.block, "ownedReception", "Reception", name, signal=draft.signal)
        self.interaction = draft.add(
            self.block, "ownedBehavior", "Interaction", draft.make_name(word)
        )
        self.lifelines = [self.add_lifeline() for _ in range(draft.random.randint(2, 3))]

    def add_lifeline(self) -> Element:
        draft = self.draft
        role = draft.add_part(self.block, draft.block)
        name = draft.make_name("line") if draft.maybe() else ""
        return draft.add(self.interaction, "lifeline", "Lifeline", name, represents=role)

    def add_occurrence(self, owner: Element, line: Element, metaclass: str = "") -> Element:
        kind = metaclass or "MessageOccurrenceSpecification"
        name = self.draft.make_name("o")
        return self.draft.add(owner, "fragment", kind, name, covered=[line])

    def add_message(
        self, sent: Element | None, received: Element | None, sort: str = "", word: str = "m"
    ) -> Element:
        """Add a message between its ends; a message without one of them is lost or found."""
        draft = self.draft
        message = draft.add(self.interaction, "message", "Message", draft.make_name(word))
        for feature, end in (("sendEvent", sent), ("receiveEvent", received)):
            if end is not None:
                draft.set(message, **{feature: end})
                draft.set(end, message=message)
        if sort:
            draft.set(message, messageSort=sort)
        if sort == "asynchSignal":
            draft.set(message, signature=draft.signal)
        elif sort in ("", "asynchCall", "reply"):
            draft.set(message, signature=self.operation)
        return message

    def exchange(self, owner: Element, *lines: Element, sort: str = "asynchSignal") -> Element:
        """Add a message from the first line to the second; return its reception."""
        sent, received = (self.add_occurrence(owner, line) for line in lines)
        self.add_message(sent, received, sort)
        return received

    def choose_lines(self) -> list[Element]:
        return self.draft.random.sample(self.lifelines, 2)


def add_messages(draft: Draft) -> None:
    """Add calls with replies and executions, signals, a creation and a destruction."""
    scenario = Scenario(draft)
    owner = scenario.interaction
    caller, called = scenario.choose_lines()
    start = scenario.exchange(owner, caller, called, sort="")
    run = draft.add(owner, "fragment", "BehaviorExecutionSpecification", draft.make_name("run"))
    draft.set(run, covered=[called], start=start)
    if draft.maybe():
        scenario.exchange(owner, called, called, sort="asynchSignal")
    sent, received = (scenario.add_occurrence(owner, line) for line in (called, caller))
    scenario.add_message(sent, received, "reply")
    draft.set(run, finish=sent)
    scenario.exchange(owner, *scenario.choose_lines())
    message = scenario.exchange(owner, caller, called, sort="asynchCall")
    if draft.maybe():
        born = scenario.add_lifeline()
        sent, received = (scenario.add_occurrence(owner, line) for line in (caller, born))
        scenario.add_message(sent, received, "createMessage")
        scenario.exchange(owner, caller, born)
        sent = scenario.add_occurrence(owner, caller)
        end = scenario.add_occurrence(owner, born, "DestructionOccurrenceSpecification")
        scenario.add_message(sent, end, "deleteMessage")
    if draft.maybe():
        scenario.add_message(scenario.add_occurrence(owner, caller), None, "asynchSignal", "lost")
    if draft.maybe():
        scenario.add_message(None, scenario.add_occurrence(owner, called), "asynchSignal", "found")
    if draft.maybe():
        ordering = {"before": start, "after": message}
        draft.add(owner, "generalOrdering", "GeneralOrdering", "", **ordering)


def add_fragments(draft: Draft) -> None:
    """Add combined fragments of all operators, some nested, and a state invariant."""
    scenario = Scenario(draft)
    scenario.exchange(scenario.interaction, *scenario.choose_lines())
    for _ in range(draft.random.randint(1, 3)):
        _add_fragment(scenario, scenario.interaction, 0)
    line = draft.random.choice(scenario.lifelines)
    name = draft.make_name("invariant")
    invariant = draft.add(scenario.interaction, "fragment", "StateInvariant", name)
    draft.set(invariant, covered=[line])
    rule = draft.add(invariant, "invariant", "Constraint", "")
    draft.add_text(rule, "specification", "the gate is shut", "English")


def _add_fragment(scenario: Scenario, owner: Element, depth: int) -> None:
    draft = scenario.draft
    operator = draft.choose(*_SINGLE, *_SEVERAL, "consider", "ignore")
    filters = operator in ("consider", "ignore")
    kind = "ConsiderIgnoreFragment" if filters else "CombinedFragment"
    fragment = draft.add(owner, "fragment", kind, "", covered=scenario.lifelines)
    if operator != "seq":
        draft.set(fragment, interactionOperator=operator)
    if filters:
        draft.set(fragment, message=[draft.signal])
    for number in range(draft.random.randint(2, 3) if operator in _SEVERAL else 1):
        operand = draft.add(fragment, "operand", "InteractionOperand", "")
        draft.set(operand, covered=scenario.lifelines)
        if operator in ("alt", "opt", "loop", "break") and draft.maybe(0.8):
            guard = draft.add(operand, "guard", "InteractionConstraint", "")
            text = "else" if operator == "alt" and number else "x < 3"
            draft.add_text(guard, "specification", text, "")
            if operator == "loop" and draft.maybe():
                draft.add(guard, "minint", "LiteralInteger", "", value="1")
                draft.add(guard, "maxint", "LiteralInteger", "", value="3")
        scenario.exchange(operand, *scenario.choose_lines())
        if depth < 2 and draft.maybe(0.3):
            _add_fragment(scenario, operand, depth + 1)


def add_uses(draft: Draft) -> None:
    """Add the use of another interaction with gates, and a lifeline that is decomposed."""
    inner, outer = Scenario(draft, "Inner"), Scenario(draft, "Outer")
    formal = draft.add(inner.interaction, "formalGate", "Gate", draft.make_name("gate"))
    received = inner.add_occurrence(inner.interaction, inner.lifelines[0])
    inner.add_message(formal, received, "asynchSignal")
    outer.exchange(outer.interaction, *outer.choose_lines())
    use = draft.add(
        outer.interaction, "fragment", "InteractionUse", draft.make_name("use"),
        refersTo=inner.interaction, covered=outer.lifelines[1:],
    )  # fmt: skip
    actual = draft.add(use, "actualGate", "Gate", formal.get("name"))
    sent = outer.add_occurrence(outer.interaction, outer.lifelines[0])
    outer.add_message(sent, actual, "asynchSignal")
    if draft.maybe():
        part = draft.add(
            outer.interaction, "fragment", "PartDecomposition", draft.make_name("part"),
            refersTo=inner.interaction, covered=outer.lifelines[:1],
        )  # fmt: skip
        draft.set(outer.lifelines[0], decomposedAs=part)


def add_times(draft: Draft) -> None:
    """Add observations and constraints of times and durations."""
    scenario = Scenario(draft)
    owner, add = scenario.interaction, draft.add
    first = scenario.exchange(owner, *scenario.choose_lines())
    last = scenario.exchange(owner, *scenario.choose_lines())
    bounds = []
    for text in ("1", "5"):
        duration = draft.add_packaged("Duration", "d")
        add(duration, "expr", "LiteralInteger", "", value=text)
        bounds.append(duration)
    rule = add(owner, "ownedRule", "DurationConstraint", draft.make_name("quick"))
    draft.set(rule, constrainedElement=[first, last])
    add(rule, "specification", "DurationInterval", "", min=bounds[0], max=bounds[1])
    draft.add_packaged("TimeObservation", "t", event=first)
    draft.add_packaged("DurationObservation", "d", event=[first, last])
    moments = [draft.add_packaged("TimeExpression", "moment") for _ in range(2)]
    for moment, text in zip(moments, ("0", "9"), strict=True):
        add(moment, "expr", "LiteralInteger", "", value=text)
    when = add(owner, "ownedRule", "TimeConstraint", draft.make_name("when"))
    draft.set(when, constrainedElement=[last])
    add(when, "specification", "TimeInterval", "", min=moments[0], max=moments[1])
    if draft.maybe():
        invariant = add(owner, "fragment", "Continuation", draft.make_name("then"), setting=True)
        draft.set(invariant, covered=scenario.lifelines)
