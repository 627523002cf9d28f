"""Random behaviour: state machines, and activities made of sequences, decisions and forks."""

from random import Random

from dialects.papyrus import Element, PapyrusDocument, add_body, metaclass_of
from dialects.random_structure import Block, Structure


class Behaviours:
    """Adds state machines and activities to blocks; every choice comes from ``random``."""

    def __init__(self, structure: Structure) -> None:
        self.structure = structure
        self.document: PapyrusDocument = structure.document
        self.random: Random = structure.random
        self._events: dict[str, Element] = {}
        for block in structure.blocks:
            if structure.maybe(0.6):
                self._add_state_machine(block)
            if structure.maybe(0.6):
                self._add_activity(block)

    # -- guards, effects and events -------------------------------------------------------------

    def _choose_condition(self, block: Block) -> str:
        choices = [f"{name}" for name in _list_names(block.booleans)]
        choices += [f"not {name}" for name in _list_names(block.booleans)]
        choices += [f"{name} > 1" for name in _list_names(block.integers)]
        for attribute, kind, literals in block.enumerations:
            literal = self.random.choice(literals).get("name")
            choices.append(f"{attribute.get('name')} = {kind.get('name')}::{literal}")
        return self.random.choice(choices or ["ready"])

    def _choose_effect(self, block: Block) -> str:
        choices = [f"{name} := true" for name in _list_names(block.booleans)]
        choices += [
            f"{attribute.get('name')} := {kind.get('name')}::{literals[0].get('name')}"
            for attribute, kind, literals in block.enumerations
        ]
        return self.random.choice(choices or ["beep"])

    def _find_event(self, signal: Element) -> Element:
        name = f"on {signal.get('name')}"
        if name not in self._events:
            event = self.document.add(
                self.document.model, "packagedElement", "SignalEvent", name, signal=signal
            )
            self._events[name] = event
        return self._events[name]

    def _find_time_event(self) -> Element:
        if "after" not in self._events:
            event = self.document.add(
                self.document.model, "packagedElement", "TimeEvent", "after 3", isRelative=True
            )
            when = self.document.add(event, "when", "TimeExpression")
            self.document.add(when, "expr", "LiteralInteger", value="3")
            self._events["after"] = event
        return self._events["after"]

    # -- state machines ------------------------------------------------------------------------

    def _add_state_machine(self, block: Block) -> None:
        machine = self.document.add(block.element, "ownedBehavior", "StateMachine", "Life")
        self.document.set(block.element, classifierBehavior=machine)
        self._add_region(machine, block, depth=0)

    def _add_region(self, owner: Element, block: Block, depth: int) -> None:
        region = self.document.add(owner, "region", "Region", "Region1")
        initial = self.document.add(region, "subvertex", "Pseudostate", "Initial")
        states = [self._add_state(region, block, f"s{depth}{i}", depth) for i in range(3)]
        self.document.add(region, "transition", "Transition", source=initial, target=states[0])
        if self.structure.maybe(0.3):
            states.append(self.document.add(region, "subvertex", "FinalState", "Final"))
        for _ in range(self.random.randint(1, 4)):
            source = self.random.choice(states[:3])
            self._add_transition(region, block, source, self.random.choice(states))

    def _add_state(self, region: Element, block: Block, name: str, depth: int) -> Element:
        state = self.document.add(region, "subvertex", "State", name)
        for feature in ("entry", "exit"):
            if self.structure.maybe(0.2):
                behaviour = self.document.add(state, feature, "OpaqueBehavior", f"{name} {feature}")
                add_body(behaviour, self._choose_effect(block), "KerML")
        if depth == 0 and self.structure.maybe(0.2):
            self._add_region(state, block, depth + 1)
        return state

    def _add_transition(
        self, region: Element, block: Block, source: Element, target: Element
    ) -> None:
        transition = self.document.add(
            region, "transition", "Transition", source=source, target=target
        )
        if self.structure.maybe(0.4):
            rule = self.document.add(transition, "ownedRule", "Constraint")
            self.document.add_expression(
                rule, "specification", self._choose_condition(block), "OCL"
            )
            self.document.set(transition, guard=rule)
        if self.structure.maybe(0.8):
            signal = self.random.choice(self.structure.signals)
            event = (
                self._find_event(signal) if self.structure.maybe(0.8) else self._find_time_event()
            )
            self.document.add(transition, "trigger", "Trigger", event=event)
        if self.structure.maybe(0.3):
            effect = self.document.add(transition, "effect", "OpaqueBehavior", "effect")
            add_body(effect, self._choose_effect(block), "KerML")

    # -- activities ----------------------------------------------------------------------------

    def _add_activity(self, block: Block) -> None:
        name = "Work"
        self._activity = self.document.add(block.element, "ownedBehavior", "Activity", name)
        self._counter = 0
        if block.operations and self.structure.maybe():
            operation = block.operations[0]
            self.document.set(self._activity, specification=operation)
            self.document.set(operation, method=[self._activity])
        initial, final = self._add_node("InitialNode"), self._add_node("ActivityFinalNode")
        last = self._add_sequence(block, initial, depth=0)
        self._add_flow("ControlFlow", last, final)
        self._add_partition(block)

    def _add_node(self, metaclass: str, **features: str | Element) -> Element:
        self._counter += 1
        name = f"{metaclass}{self._counter}"
        return self.document.add(self._activity, "node", metaclass, name, **features)

    def _add_flow(self, kind: str, source: Element, target: Element, guard: str = "") -> None:
        flow = self.document.add(self._activity, "edge", kind, source=source, target=target)
        if guard:
            self.document.add_expression(flow, "guard", guard, "" if guard == "else" else "OCL")

    def _add_sequence(self, block: Block, start: Element, depth: int) -> Element:
        """Add some steps after *start* and return the last node."""
        last = start
        for _ in range(self.random.randint(1, 3)):
            step = self.random.choice(["action", "action", "choice", "fork"])
            if step == "choice" and depth < 2:
                last = self._add_decision(block, last, depth)
            elif step == "fork" and depth < 2:
                last = self._add_fork(block, last, depth)
            else:
                last = self._add_action(block, last)
        return last

    def _add_action(self, block: Block, before: Element) -> Element:
        kind = self.random.choice(["opaque", "call", "send", "accept"])
        if kind == "call" and block.operations:
            action = self._add_node("CallOperationAction", operation=block.operations[0])
        elif kind == "send":
            signal = self.random.choice(self.structure.signals)
            action = self._add_node("SendSignalAction", signal=signal)
        elif kind == "accept":
            action = self._add_node("AcceptEventAction")
            event = self._find_event(self.random.choice(self.structure.signals))
            self.document.add(action, "trigger", "Trigger", event=event)
        else:
            action = self._add_node("OpaqueAction")
            if metaclass_of(before) == "OpaqueAction" and self.structure.maybe():
                self._add_object_flow(before, action)
        self._add_flow("ControlFlow", before, action)
        return action

    def _add_object_flow(self, source: Element, target: Element) -> None:
        item = self.random.choice(self.structure.items)
        out = self.document.add(source, "outputValue", "OutputPin", "made", type=item)
        into = self.document.add(target, "inputValue", "InputPin", "used", type=item)
        if self.structure.maybe():
            self.document.set_bounds(into, 0, "1")
        self._add_flow("ObjectFlow", out, into)

    def _add_decision(self, block: Block, before: Element, depth: int) -> Element:
        decision, merge = self._add_node("DecisionNode"), self._add_node("MergeNode")
        self._add_flow("ControlFlow", before, decision)
        for guard in (self._choose_condition(block), "else"):
            first = self._add_node("OpaqueAction")
            self._add_flow("ControlFlow", decision, first, guard)
            self._add_flow("ControlFlow", self._add_sequence(block, first, depth + 1), merge)
        return merge

    def _add_fork(self, block: Block, before: Element, depth: int) -> Element:
        fork, join = self._add_node("ForkNode"), self._add_node("JoinNode")
        self._add_flow("ControlFlow", before, fork)
        for _ in range(2):
            first = self._add_node("OpaqueAction")
            self._add_flow("ControlFlow", fork, first)
            self._add_flow("ControlFlow", self._add_sequence(block, first, depth + 1), join)
        return join

    def _add_partition(self, block: Block) -> None:
        if block.parts and self.structure.maybe():
            part = block.parts[0][0]
            nodes = [node for node in self._activity if metaclass_of(node) == "OpaqueAction"]
            partition = self.document.add(
                self._activity, "group", "ActivityPartition", "lane", represents=part, node=nodes
            )
            self.document.set(self._activity, partition=[partition])
            for node in nodes:
                self.document.set(node, inPartition=[partition])


def _list_names(elements: list[Element]) -> list[str]:
    return [str(element.get("name")) for element in elements]
