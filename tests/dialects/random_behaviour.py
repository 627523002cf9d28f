"""Behaviour at random: state machines, and activities made of sequences, choices and forks."""

from random import Random

from dialects.papyrus import Element, PapyrusDocument, metaclass_of, say
from dialects.random_structure import Block, Structure


class Behaviours:
    """Gives blocks state machines and activities; every choice comes from ``random``."""

    def __init__(self, structure: Structure) -> None:
        self.structure = structure
        self.document: PapyrusDocument = structure.document
        self.random: Random = structure.random
        self._events: dict[str, Element] = {}
        for block in structure.blocks:
            if structure.maybe(0.6):
                self._state_machine(block)
            if structure.maybe(0.6):
                self._activity(block)

    # -- what both need ------------------------------------------------------------------------

    def _condition(self, block: Block) -> str:
        choices = [f"{name}" for name in _names(block.booleans)]
        choices += [f"not {name}" for name in _names(block.booleans)]
        choices += [f"{name} > 1" for name in _names(block.integers)]
        for made, kind, literals in block.enumerated:
            literal = self.random.choice(literals).get("name")
            choices.append(f"{made.get('name')} = {kind.get('name')}::{literal}")
        return self.random.choice(choices or ["ready"])

    def _effect(self, block: Block) -> str:
        choices = [f"{name} := true" for name in _names(block.booleans)]
        choices += [
            f"{made.get('name')} := {kind.get('name')}::{literals[0].get('name')}"
            for made, kind, literals in block.enumerated
        ]
        return self.random.choice(choices or ["beep"])

    def _event(self, signal: Element) -> Element:
        name = f"on {signal.get('name')}"
        if name not in self._events:
            made = self.document.add(
                self.document.model, "packagedElement", "SignalEvent", name, signal=signal
            )
            self._events[name] = made
        return self._events[name]

    def _time_event(self) -> Element:
        if "after" not in self._events:
            made = self.document.add(
                self.document.model, "packagedElement", "TimeEvent", "after 3", isRelative=True
            )
            when = self.document.add(made, "when", "TimeExpression")
            self.document.add(when, "expr", "LiteralInteger", value="3")
            self._events["after"] = made
        return self._events["after"]

    # -- state machines ------------------------------------------------------------------------

    def _state_machine(self, block: Block) -> None:
        made = self.document.add(block.element, "ownedBehavior", "StateMachine", "Life")
        self.document.set(block.element, classifierBehavior=made)
        self._region(made, block, depth=0)

    def _region(self, owner: Element, block: Block, depth: int) -> None:
        region = self.document.add(owner, "region", "Region", "Region1")
        initial = self.document.add(region, "subvertex", "Pseudostate", "Initial")
        states = [self._state(region, block, f"s{depth}{i}", depth) for i in range(3)]
        self.document.add(region, "transition", "Transition", source=initial, target=states[0])
        if self.structure.maybe(0.3):
            states.append(self.document.add(region, "subvertex", "FinalState", "Final"))
        for _ in range(self.random.randint(1, 4)):
            source = self.random.choice(states[:3])
            self._transition(region, block, source, self.random.choice(states))

    def _state(self, region: Element, block: Block, name: str, depth: int) -> Element:
        made = self.document.add(region, "subvertex", "State", name)
        for feature in ("entry", "exit"):
            if self.structure.maybe(0.2):
                behaviour = self.document.add(made, feature, "OpaqueBehavior", f"{name} {feature}")
                say(behaviour, self._effect(block), "KerML")
        if depth == 0 and self.structure.maybe(0.2):
            self._region(made, block, depth + 1)
        return made

    def _transition(self, region: Element, block: Block, source: Element, target: Element) -> None:
        made = self.document.add(region, "transition", "Transition", source=source, target=target)
        if self.structure.maybe(0.4):
            rule = self.document.add(made, "ownedRule", "Constraint")
            self.document.opaque(rule, "specification", self._condition(block), "OCL")
            self.document.set(made, guard=rule)
        if self.structure.maybe(0.8):
            signal = self.random.choice(self.structure.signals)
            event = self._event(signal) if self.structure.maybe(0.8) else self._time_event()
            self.document.add(made, "trigger", "Trigger", event=event)
        if self.structure.maybe(0.3):
            effect = self.document.add(made, "effect", "OpaqueBehavior", "effect")
            say(effect, self._effect(block), "KerML")

    # -- activities ----------------------------------------------------------------------------

    def _activity(self, block: Block) -> None:
        name = "Work"
        self._made = self.document.add(block.element, "ownedBehavior", "Activity", name)
        self._counter = 0
        if block.operations and self.structure.maybe():
            operation = block.operations[0]
            self.document.set(self._made, specification=operation)
            self.document.set(operation, method=[self._made])
        initial, final = self._node("InitialNode"), self._node("ActivityFinalNode")
        last = self._sequence(block, initial, depth=0)
        self._flow("ControlFlow", last, final)
        self._partition(block)

    def _node(self, metaclass: str, **features: str | Element) -> Element:
        self._counter += 1
        name = f"{metaclass}{self._counter}"
        return self.document.add(self._made, "node", metaclass, name, **features)

    def _flow(self, kind: str, source: Element, target: Element, guard: str = "") -> None:
        made = self.document.add(self._made, "edge", kind, source=source, target=target)
        if guard:
            self.document.opaque(made, "guard", guard, "" if guard == "else" else "OCL")

    def _sequence(self, block: Block, start: Element, depth: int) -> Element:
        """Some steps after ``start``; the last node is returned."""
        last = start
        for _ in range(self.random.randint(1, 3)):
            step = self.random.choice(["action", "action", "choice", "fork"])
            if step == "choice" and depth < 2:
                last = self._choice(block, last, depth)
            elif step == "fork" and depth < 2:
                last = self._fork(block, last, depth)
            else:
                last = self._action(block, last)
        return last

    def _action(self, block: Block, before: Element) -> Element:
        kind = self.random.choice(["opaque", "call", "send", "accept"])
        if kind == "call" and block.operations:
            made = self._node("CallOperationAction", operation=block.operations[0])
        elif kind == "send":
            signal = self.random.choice(self.structure.signals)
            made = self._node("SendSignalAction", signal=signal)
        elif kind == "accept":
            made = self._node("AcceptEventAction")
            event = self._event(self.random.choice(self.structure.signals))
            self.document.add(made, "trigger", "Trigger", event=event)
        else:
            made = self._node("OpaqueAction")
            if metaclass_of(before) == "OpaqueAction" and self.structure.maybe():
                self._object_flow(before, made)
        self._flow("ControlFlow", before, made)
        return made

    def _object_flow(self, source: Element, target: Element) -> None:
        item = self.random.choice(self.structure.items)
        out = self.document.add(source, "outputValue", "OutputPin", "made", type=item)
        into = self.document.add(target, "inputValue", "InputPin", "used", type=item)
        if self.structure.maybe():
            self.document.multiplicity(into, 0, "1")
        self._flow("ObjectFlow", out, into)

    def _choice(self, block: Block, before: Element, depth: int) -> Element:
        decision, merge = self._node("DecisionNode"), self._node("MergeNode")
        self._flow("ControlFlow", before, decision)
        for guard in (self._condition(block), "else"):
            first = self._node("OpaqueAction")
            self._flow("ControlFlow", decision, first, guard)
            self._flow("ControlFlow", self._sequence(block, first, depth + 1), merge)
        return merge

    def _fork(self, block: Block, before: Element, depth: int) -> Element:
        fork, join = self._node("ForkNode"), self._node("JoinNode")
        self._flow("ControlFlow", before, fork)
        for _ in range(2):
            first = self._node("OpaqueAction")
            self._flow("ControlFlow", fork, first)
            self._flow("ControlFlow", self._sequence(block, first, depth + 1), join)
        return join

    def _partition(self, block: Block) -> None:
        if block.parts and self.structure.maybe():
            part = block.parts[0][0]
            nodes = [node for node in self._made if metaclass_of(node) == "OpaqueAction"]
            made = self.document.add(
                self._made, "group", "ActivityPartition", "lane", represents=part, node=nodes
            )
            self.document.set(self._made, partition=[made])
            for node in nodes:
                self.document.set(node, inPartition=[made])


def _names(elements: list[Element]) -> list[str]:
    return [str(element.get("name")) for element in elements]
