"""Interactions at random: messages, bars, nested fragments, uses, invariants and times."""

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
        self.made: list[Element] = []
        for index in range(self.random.randint(0, 2)):
            self._interaction(index)

    def _interaction(self, index: int) -> None:
        add = self.document.add
        if self.structure.maybe():
            owner, feature = self.random.choice(self.structure.packages), "packagedElement"
        else:
            owner, feature = self.random.choice(self.structure.blocks).element, "ownedBehavior"
        self.interaction = add(owner, feature, "Interaction", f"Scenario{index}")
        self.messages = 0
        self.lifelines = [self._lifeline(i) for i in range(self.random.randint(2, 4))]
        self.occurrences: list[Element] = []
        self._fragments(self.interaction, depth=0)
        self._times()
        self.made.append(self.interaction)

    def _lifeline(self, index: int) -> Element:
        add, block = self.document.add, self.random.choice(self.structure.blocks)
        made = add(self.interaction, "lifeline", "Lifeline", f"line{index}")
        if self.structure.maybe(0.7):
            role = add(
                self.interaction, "ownedAttribute", "Property", f"role{index}", type=block.element
            )
            self.document.set(made, represents=role)
        if self.structure.maybe(0.2):
            add(made, "selector", "LiteralInteger", value="2")
        return made

    # -- fragments -----------------------------------------------------------------------------

    def _fragments(self, owner: Element, depth: int) -> None:
        makers = [self._message, self._message, self._call, self._invariant, self._use, self._lost]
        for _ in range(self.random.randint(1, 4)):
            if depth < 2 and self.structure.maybe(0.25):
                self._nest(owner, depth)
            else:
                self.random.choice(makers)(owner)

    def _occurrence(self, owner: Element, metaclass: str = "") -> Element:
        kind = metaclass or "MessageOccurrenceSpecification"
        made = self.document.add(owner, "fragment", kind, f"o{len(self.occurrences)}")
        self.document.set(made, covered=self.random.choice(self.lifelines))
        self.occurrences.append(made)
        return made

    def _message(self, owner: Element, sort: str | None = None) -> tuple[Element, Element]:
        ends = self._occurrence(owner), self._occurrence(owner)
        self._between(ends[0], ends[1], self.random.choice(_SORTS) if sort is None else sort)
        return ends

    def _between(self, sent: Element | None, received: Element | None, sort: str) -> None:
        made = self.document.add(self.interaction, "message", "Message", f"m{self.messages}")
        self.messages += 1
        for feature, end in (("sendEvent", sent), ("receiveEvent", received)):
            if end is not None:
                self.document.set(made, **{feature: end})
                self.document.set(end, message=made)
        if sort:
            self.document.set(made, messageSort=sort)
        if sort == "asynchSignal":
            self.document.set(made, signature=self.random.choice(self.structure.signals))
        if self.structure.maybe(0.3):
            self.document.add(made, "argument", "LiteralInteger", value="7")

    def _call(self, owner: Element) -> None:
        """A call and its reply, with the execution between them."""
        _, start = self._message(owner, sort="")
        bar = self.document.add(owner, "fragment", "BehaviorExecutionSpecification", "bar")
        self.document.set(bar, covered=[_covered(self.document.model, start)], start=start)
        finish, _ = self._message(owner, sort="reply")
        self.document.set(bar, finish=finish)

    def _lost(self, owner: Element) -> None:
        end = self._occurrence(owner)
        if self.structure.maybe():
            self._between(end, None, "asynchSignal")
        elif self.structure.maybe():
            self._between(None, end, "asynchSignal")
        else:
            gate = self.document.add(self.interaction, "formalGate", "Gate", "gate")
            self._between(gate, end, "asynchSignal")

    def _invariant(self, owner: Element) -> None:
        made = self.document.add(owner, "fragment", "StateInvariant", "inv")
        self.document.set(made, covered=[self.random.choice(self.lifelines)])
        rule = self.document.add(made, "invariant", "Constraint")
        self.document.opaque(rule, "specification", "x > 3", "OCL")

    def _use(self, owner: Element) -> None:
        kind = self.random.choice(["InteractionUse", "Continuation"])
        made = self.document.add(owner, "fragment", kind, "use", covered=self.lifelines[:2])
        if kind == "InteractionUse" and self.made:
            self.document.set(made, refersTo=self.random.choice(self.made))
        if kind == "Continuation" and self.structure.maybe():
            self.document.set(made, setting=True)

    def _nest(self, owner: Element, depth: int) -> None:
        is_considered = self.structure.maybe(0.3)
        kind = "ConsiderIgnoreFragment" if is_considered else "CombinedFragment"
        made = self.document.add(owner, "fragment", kind, "", covered=self.lifelines)
        operator = self.random.choice((*_SINGLE, *_SEVERAL))
        if is_considered:
            operator = self.random.choice(["consider", "ignore"])
            self.document.set(made, message=[self.random.choice(self.structure.signals)])
        if operator != "seq":
            self.document.set(made, interactionOperator=operator)
        for number in range(2 if operator in _SEVERAL else 1):
            self._operand(made, operator, number, depth)

    def _operand(self, owner: Element, operator: str, number: int, depth: int) -> None:
        add = self.document.add
        made = add(owner, "operand", "InteractionOperand", f"part{number}")
        if operator in ("alt", "opt", "loop", "break"):
            guard = add(made, "guard", "InteractionConstraint")
            self.document.opaque(guard, "specification", "else" if number else "n < 3", "OCL")
            if operator == "loop":
                add(guard, "minint", "LiteralInteger", value="1")
                add(guard, "maxint", "LiteralInteger", value="3")
        self._fragments(made, depth + 1)

    # -- times ---------------------------------------------------------------------------------

    def _times(self) -> None:
        """Constraints and observations; Papyrus keeps the durations in the model."""
        add = self.document.add
        if len(self.occurrences) < 2 or not self.structure.maybe():
            return
        first, last = self.occurrences[0], self.occurrences[-1]
        bounds = [self._duration(text) for text in ("0", "5 s")]
        rule = add(self.interaction, "ownedRule", "DurationConstraint", "quick")
        self.document.set(rule, constrainedElement=[first, last])
        add(rule, "specification", "DurationInterval", "", min=bounds[0], max=bounds[1])
        seen = add(self.document.model, "packagedElement", "TimeObservation", "t", event=first)
        self.document.set(seen, firstEvent=False)
        add(self.interaction, "generalOrdering", "GeneralOrdering", before=first, after=last)

    def _duration(self, text: str) -> Element:
        made = self.document.add(self.document.model, "packagedElement", "Duration", f"d{text}")
        self.document.add(made, "expr", "LiteralString", value=text)
        return made


def _covered(model: Element, occurrence: Element) -> Element:
    id_ = occurrence.get("covered")
    return next(one for one in model.iter("lifeline") if id_ in one.attrib.values())
