"""Random small behaviours: state machines with all kinds of triggers, activities with pins."""

from dialects.papyrus import Element, add_body, metaclass_of
from dialects.random_small_structure import CONDITIONS, Draft

_PSEUDOSTATES = (
    "choice", "junction", "shallowHistory", "deepHistory", "terminate", "entryPoint",
    "exitPoint", "fork", "join",
)  # fmt: skip


class Behaviours:
    """Draws behaviours of classes and packages."""

    def __init__(self, draft: Draft) -> None:
        self.draft = draft
        self.document = draft.document
        for _ in range(draft.random.randint(0, 2)):
            draft.choose([self._draw_state_machine, self._draw_activity, self._draw_activity])()

    def _add_behaviour(self, metaclass: str) -> Element:
        classes = self.draft.list_types("Class")
        if classes and self.draft.is_drawn(0.7):
            owner = self.draft.choose(classes)
            behaviour = self.draft.add(owner, "ownedBehavior", metaclass)
            if self.draft.is_drawn() and "classifierBehavior" not in owner.attrib:
                self.document.set(owner, classifierBehavior=behaviour)
        else:
            behaviour = self.draft.add_packaged(metaclass)
        if self.draft.is_drawn(0.4):
            for _ in range(self.draft.random.randint(1, 3)):
                direction = self.draft.choose(["in", "out", "inout"])
                parameter = self.draft.add(
                    behaviour, "ownedParameter", "Parameter", direction=direction
                )
                self.draft.set_type(parameter)
        self.draft.behaviours.append(behaviour)
        return behaviour

    def _add_trigger(self, owner: Element) -> None:
        name = self.draft.choose([None, ""])
        trigger = self.draft.add(owner, "trigger", "Trigger", name)
        event = self._draw_event()
        if event is not None:
            self.document.set(trigger, event=event)

    def _draw_event(self) -> Element | None:
        kind = self.draft.choose(["signal", "call", "after", "at", "change", "any", "none"])
        if kind == "signal" and self.draft.signals:
            signal = self.draft.choose(self.draft.signals)
            return self.draft.add_packaged("SignalEvent", signal=signal)
        if kind == "call" and self.draft.operations:
            operation = self.draft.choose(self.draft.operations)
            return self.draft.add_packaged("CallEvent", operation=operation)
        if kind in ("after", "at"):
            event = self.draft.add_packaged("TimeEvent", isRelative=kind == "after")
            when = self.document.add(event, "when", "TimeExpression")
            if self.draft.is_drawn():
                self.document.add(when, "expr", "LiteralInteger", value="3")
            else:
                text = self.draft.choose(["5 s", "2 min", "noon", "3.5", "x + 1", "10:00"])
                self.document.add_expression(when, "expr", text)
            return event
        if kind == "change":
            event = self.draft.add_packaged("ChangeEvent")
            self.draft.add_condition(event, "changeExpression")
            return event
        return self.draft.add_packaged("AnyReceiveEvent") if kind == "any" else None

    # -- state machines ------------------------------------------------------------------------

    def _draw_state_machine(self) -> None:
        machine = self._add_behaviour("StateMachine")
        for _ in range(self.draft.choose([1, 1, 1, 2])):
            self._draw_region(machine, 0)

    def _draw_region(self, owner: Element, depth: int) -> None:
        add = self.draft.add
        region = add(owner, "region", "Region", self.draft.choose([None, ""]))
        states = []
        for _ in range(self.draft.random.randint(1, 3)):
            state = add(region, "subvertex", "State")
            self._fill_state(state, depth)
            states.append(state)
        targets = list(states)
        if self.draft.is_drawn(0.4):
            targets.append(add(region, "subvertex", "FinalState", self.draft.choose([None, ""])))
        if self.draft.is_drawn(0.4):
            kind = self.draft.choose(_PSEUDOSTATES)
            name = self.draft.choose([None, ""])
            point = add(region, "subvertex", "Pseudostate", name, kind=kind)
            targets.append(point)
            if kind not in ("terminate", "shallowHistory", "deepHistory"):
                states.append(point)
        if self.draft.is_drawn(0.9):
            initial = add(region, "subvertex", "Pseudostate", self.draft.choose([None, ""]))
            add(region, "transition", "Transition", "", source=initial, target=states[0])
        for _ in range(self.draft.random.randint(0, 4)):
            source, target = self.draft.choose(states), self.draft.choose(targets)
            self._add_transition(region, source, target)

    def _fill_state(self, state: Element, depth: int) -> None:
        for feature in ("entry", "doActivity", "exit"):
            if self.draft.is_drawn(0.2):
                if self.draft.is_drawn(0.7):
                    self.draft.add_behaviour_body(state, feature)
                else:
                    activity = self.draft.add(state, feature, "Activity")
                    self._fill_activity(activity)
        if depth < 1 and self.draft.is_drawn(0.3):
            for _ in range(self.draft.choose([1, 2])):
                self._draw_region(state, depth + 1)

    def _add_transition(self, region: Element, source: Element, target: Element) -> None:
        name = self.draft.choose([None, "", ""])
        transition = self.draft.add(
            region, "transition", "Transition", name, source=source, target=target
        )
        if source is target and self.draft.is_drawn():
            self.document.set(transition, kind=self.draft.choose(["internal", "local"]))
        for _ in range(self.draft.choose([0, 1, 1, 2])):
            if metaclass_of(source) == "State":
                self._add_trigger(transition)
        if self.draft.is_drawn(0.4):
            rule = self.document.add(transition, "ownedRule", "Constraint")
            self.draft.add_condition(rule, "specification")
            self.document.set(transition, guard=rule)
        if self.draft.is_drawn(0.3):
            self.draft.add_behaviour_body(transition, "effect")

    # -- activities ----------------------------------------------------------------------------

    def _draw_activity(self) -> None:
        self._fill_activity(self._add_behaviour("Activity"))

    def _fill_activity(self, activity: Element) -> None:
        nodes: list[Element] = []
        pins: list[Element] = []
        for parameter in activity.findall("ownedParameter"):
            name = self.draft.choose([parameter.get("name"), None])
            node = self.draft.add(
                activity, "node", "ActivityParameterNode", name, parameter=parameter
            )
            pins.append(node)
        drawers = (self._add_action, self._add_action, self._add_action, self._add_control_node)
        for _ in range(self.draft.random.randint(1, 6)):
            node = self.draft.choose(drawers)(activity)
            nodes.append(node)
            pins += [child for child in node if metaclass_of(child).endswith("Pin")]
        if self.draft.is_drawn(0.3):
            metaclass = self.draft.choose(["CentralBufferNode", "DataStoreNode"])
            store = self.draft.add(activity, "node", metaclass)
            self.draft.set_type(store)
            pins.append(store)
        for _ in range(self.draft.random.randint(0, 6)):
            self._add_flow(activity, "ControlFlow", nodes)
        if pins:
            for _ in range(self.draft.random.randint(0, 4)):
                self._add_flow(activity, "ObjectFlow", pins)
        if self.draft.is_drawn(0.2):
            actions = [node for node in nodes if metaclass_of(node).endswith("Action")]
            self.draft.add(activity, "group", "ActivityPartition", node=actions)

    def _add_flow(self, activity: Element, metaclass: str, ends: list[Element]) -> None:
        source, target = self.draft.choose(ends), self.draft.choose(ends)
        if "InputPin" in metaclass_of(source) or "OutputPin" in metaclass_of(target):
            source, target = target, source
        is_legal = (
            source is not target
            and metaclass_of(source) not in ("InputPin", "ActivityFinalNode", "FlowFinalNode")
            and metaclass_of(target) not in ("OutputPin", "InitialNode")
        )
        if not is_legal:
            return
        name = self.draft.choose([None, "", ""])
        flow = self.draft.add(activity, "edge", metaclass, name, source=source, target=target)
        if self.draft.is_drawn(0.3):
            self.draft.add_condition(flow, "guard")

    def _add_control_node(self, activity: Element) -> Element:
        metaclass = self.draft.choose(
            [
                "InitialNode",
                "ActivityFinalNode",
                "FlowFinalNode",
                "DecisionNode",
                "MergeNode",
                "ForkNode",
                "JoinNode",
            ]
        )
        return self.draft.add(activity, "node", metaclass, self.draft.choose([None, ""]))

    def _add_action(self, activity: Element) -> Element:
        kind = self.draft.choose(["opaque", "behaviour", "operation", "send", "accept", "value"])
        if kind == "behaviour" and self.draft.behaviours:
            behaviour = self.draft.choose(self.draft.behaviours)
            action = self._add_node(activity, "CallBehaviorAction", behavior=behaviour)
            self._add_call_pins(action, behaviour)
        elif kind == "operation" and self.draft.operations:
            operation = self.draft.choose(self.draft.operations)
            action = self._add_node(activity, "CallOperationAction", operation=operation)
            self._add_pin(action, "target", "InputPin")
            self._add_call_pins(action, operation)
        elif kind == "send" and self.draft.signals:
            signal = self.draft.choose(self.draft.signals)
            action = self._add_node(activity, "SendSignalAction", signal=signal)
            for _ in range(self.draft.random.randint(0, 2)):
                self._add_pin(action, "argument", "InputPin")
        elif kind == "accept":
            action = self._add_node(activity, "AcceptEventAction")
            for _ in range(self.draft.choose([0, 1, 1, 2])):
                self._add_trigger(action)
            if self.draft.is_drawn():
                self._add_pin(action, "result", "OutputPin")
        elif kind == "value":
            action = self._add_node(activity, "ValueSpecificationAction")
            self.draft.set_value(action, "value")
            self._add_pin(action, "result", "OutputPin")
        else:
            action = self._add_node(activity, "OpaqueAction")
            if self.draft.is_drawn():
                add_body(action, self.draft.choose(CONDITIONS))
            for feature, metaclass in (("inputValue", "InputPin"), ("outputValue", "OutputPin")):
                if self.draft.is_drawn(0.4):
                    self._add_pin(action, feature, metaclass)
        return action

    def _add_node(self, activity: Element, metaclass: str, **tags: Element) -> Element:
        name = self.draft.choose([None, None, None, ""])
        return self.draft.add(activity, "node", metaclass, name, **tags)

    def _add_call_pins(self, action: Element, called: Element) -> None:
        for parameter in called.findall("ownedParameter"):
            direction = parameter.get("direction", "in")
            if direction in ("in", "inout") and self.draft.is_drawn(0.9):
                self._add_pin(action, "argument", "InputPin")
            if direction in ("out", "inout", "return") and self.draft.is_drawn(0.9):
                self._add_pin(action, "result", "OutputPin")

    def _add_pin(self, action: Element, feature: str, metaclass: str) -> Element:
        pin = self.draft.add(action, feature, metaclass, self.draft.choose([None, None, ""]))
        self.draft.set_type(pin)
        return pin
