"""Random interactions: messages, executions, nested fragments, uses, invariants and times."""

from dialects.papyrus import Element
from dialects.random_structure import Structure

_SORTS = ("", "asynchCall", "asynchSignal", "reply", "createMessage", "deleteMessage")
_SINGLE = ("opt", "loop", "break", "neg", "assert", "critical")
_SEVERAL = ("alt", "par", "seq", "strict")


class Interactions:
    """Adds interactions to packages and blocks; every choice comes from ``random``."""

    def __init__(self, structure: Structure) -> None:
        self.structure = structure
        self.document = structure.document
        self.random = structure.random
        self.interactions: list[Element] = []
        for index in range(self.random.randint(0, 2)):
            self._add_interaction(index)

    def _add_interaction(self, index: int) -> None:
        add = self.document.add
        if self.structure.maybe():
            owner, feature = self.random.choice(self.structure.packages), "packagedElement"
        else:
            owner, feature = self.random.choice(self.structure.blocks).element, "ownedBehavior"
        self.interaction = add(owner, feature, "Interaction", f"Scenario{index}")
        self.messages = 0
        self.lifelines = [self._add_lifeline(i) for i in range(self.random.randint(2, 4))]
        self.occurrences: list[Element] = []
        self._add_fragments(self.interaction, depth=0)
        self._add_times()
        self.interactions.append(self.interaction)

    def _add_lifeline(self, index: int) -> Element:
        add, block = self.document.add, self.random.choice(self.structure.blocks)
        lifeline = add(self.interaction, "lifeline", "Lifeline", f"line{index}")
        if self.structure.maybe(0.7):
            role = add(
                self.interaction, "ownedAttribute", "Property", f"role{index}", type=block.element
            )
            self.document.set(lifeline, represents=role)
        if self.structure.maybe(0.2):
            add(lifeline, "selector", "LiteralInteger", value="2")
        return lifeline

    # -- fragments -----------------------------------------------------------------------------

    def _add_fragments(self, owner: Element, depth: int) -> None:
        makers = [
            self._add_message,
            self._add_message,
            self._add_call,
            self._add_invariant,
            self._add_use,
            self._add_lost_message,
        ]
        for _ in range(self.random.randint(1, 4)):
            if depth < 2 and self.structure.maybe(0.25):
                self._add_nested(owner, depth)
            else:
                self.random.choice(makers)(owner)

    def _add_occurrence(self, owner: Element, metaclass: str = "") -> Element:
        kind = metaclass or "MessageOccurrenceSpecification"
        occurrence = self.document.add(owner, "fragment", kind, f"o{len(self.occurrences)}")
        self.document.set(occurrence, covered=self.random.choice(self.lifelines))
        self.occurrences.append(occurrence)
        return occurrence

    def _add_message(self, owner: Element, sort: str | None = None) -> tuple[Element, Element]:
        ends = self._add_occurrence(owner), self._add_occurrence(owner)
        self._connect(ends[0], ends[1], self.random.choice(_SORTS) if sort is None else sort)
        return ends

    def _connect(self, sent: Element | None, received: Element | None, sort: str) -> None:
        message = self.document.add(self.interaction, "message", "Message", f"m{self.messages}")
        self.messages += 1
        for feature, end in (("sendEvent", sent), ("receiveEvent", received)):
            if end is not None:
                self.document.set(message, **{feature: end})
                self.document.set(end, message=message)
        if sort:
            self.document.set(message, messageSort=sort)
        if sort == "asynchSignal":
            self.document.set(message, signature=self.random.choice(self.structure.signals))
        if self.structure.maybe(0.3):
            self.document.add(message, "argument", "LiteralInteger", value="7")

    def _add_call(self, owner: Element) -> None:
        """Add a call and its reply, with the execution between them."""
        _, start = self._add_message(owner, sort="")
        bar = self.document.add(owner, "fragment", "BehaviorExecutionSpecification", "bar")
        self.document.set(bar, covered=[_find_covered(self.document.model, start)], start=start)
        finish, _ = self._add_message(owner, sort="reply")
        self.document.set(bar, finish=finish)

    def _add_lost_message(self, owner: Element) -> None:
        end = self._add_occurrence(owner)
        if self.structure.maybe():
            self._connect(end, None, "asynchSignal")
        elif self.structure.maybe():
            self._connect(None, end, "asynchSignal")
        else:
            gate = self.document.add(self.interaction, "formalGate", "Gate", "gate")
            self._connect(gate, end, "asynchSignal")

    def _add_invariant(self, owner: Element) -> None:
        invariant = self.document.add(owner, "fragment", "StateInvariant", "inv")
        self.document.set(invariant, covered=[self.random.choice(self.lifelines)])
        rule = self.document.add(invariant, "invariant", "Constraint")
        self.document.add_expression(rule, "specification", "x > 3", "OCL")

    def _add_use(self, owner: Element) -> None:
        kind = self.random.choice(["InteractionUse", "Continuation"])
        use = self.document.add(owner, "fragment", kind, "use", covered=self.lifelines[:2])
        if kind == "InteractionUse" and self.interactions:
            self.document.set(use, refersTo=self.random.choice(self.interactions))
        if kind == "Continuation" and self.structure.maybe():
            self.document.set(use, setting=True)

    def _add_nested(self, owner: Element, depth: int) -> None:
        is_considered = self.structure.maybe(0.3)
        kind = "ConsiderIgnoreFragment" if is_considered else "CombinedFragment"
        fragment = self.document.add(owner, "fragment", kind, "", covered=self.lifelines)
        operator = self.random.choice((*_SINGLE, *_SEVERAL))
        if is_considered:
            operator = self.random.choice(["consider", "ignore"])
            self.document.set(fragment, message=[self.random.choice(self.structure.signals)])
        if operator != "seq":
            self.document.set(fragment, interactionOperator=operator)
        for number in range(2 if operator in _SEVERAL else 1):
            self._add_operand(fragment, operator, number, depth)

    def _add_operand(self, owner: Element, operator: str, number: int, depth: int) -> None:
        add = self.document.add
        operand = add(owner, "operand", "InteractionOperand", f"part{number}")
        if operator in ("alt", "opt", "loop", "break"):
            guard = add(operand, "guard", "InteractionConstraint")
            self.document.add_expression(
                guard, "specification", "else" if number else "n < 3", "OCL"
            )
            if operator == "loop":
                add(guard, "minint", "LiteralInteger", value="1")
                add(guard, "maxint", "LiteralInteger", value="3")
        self._add_fragments(operand, depth + 1)

    # -- times ---------------------------------------------------------------------------------

    def _add_times(self) -> None:
        """Add constraints and observations of time; Papyrus stores durations in the model."""
        add = self.document.add
        if len(self.occurrences) < 2 or not self.structure.maybe():
            return
        first, last = self.occurrences[0], self.occurrences[-1]
        bounds = [self._add_duration(text) for text in ("0", "5 s")]
        rule = add(self.interaction, "ownedRule", "DurationConstraint", "quick")
        self.document.set(rule, constrainedElement=[first, last])
        add(rule, "specification", "DurationInterval", "", min=bounds[0], max=bounds[1])
        observation = add(
            self.document.model, "packagedElement", "TimeObservation", "t", event=first
        )
        self.document.set(observation, firstEvent=False)
        add(self.interaction, "generalOrdering", "GeneralOrdering", before=first, after=last)

    def _add_duration(self, text: str) -> Element:
        duration = self.document.add(self.document.model, "packagedElement", "Duration", f"d{text}")
        self.document.add(duration, "expr", "LiteralString", value=text)
        return duration


def _find_covered(model: Element, occurrence: Element) -> Element:
    id_ = occurrence.get("covered")
    return next(lifeline for lifeline in model.iter("lifeline") if id_ in lifeline.attrib.values())
