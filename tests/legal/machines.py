"""Topics of state machines: regions, pseudostates, triggers, behaviours, submachines, protocols."""

from dialects.papyrus import Element
from legal.draft import Draft


class Machine:
    """A state machine of a block with values that its guards and effects can use."""

    def __init__(self, draft: Draft, word: str = "Machine") -> None:
        self.draft = draft
        self.block = draft.add_block("Device")
        self.flag = draft.add_value(self.block, "flag", "Boolean")
        self.count = draft.add_value(self.block, "count", "Integer")
        self.machine = draft.add(self.block, "ownedBehavior", "StateMachine", draft.make_name(word))
        draft.set(self.block, classifierBehavior=self.machine)
        self.region = self.add_region(self.machine)

    def add_region(self, owner: Element) -> Element:
        name = self.draft.make_name("Region") if self.draft.maybe(0.8) else ""
        return self.draft.add(owner, "region", "Region", name)

    def add_state(self, region: Element, word: str = "state") -> Element:
        return self.draft.add(region, "subvertex", "State", self.draft.make_name(word))

    def add_pseudostate(self, region: Element, kind: str = "", word: str = "") -> Element:
        name = self.draft.make_name(word) if word or self.draft.maybe(0.3) else ""
        vertex = self.draft.add(region, "subvertex", "Pseudostate", name)
        if kind:
            self.draft.set(vertex, kind=kind)
        return vertex

    def add_transition(
        self, region: Element, source: Element, target: Element, kind: str = ""
    ) -> Element:
        name = self.draft.make_name("t") if self.draft.maybe(0.2) else ""
        ends = {"source": source, "target": target}
        transition = self.draft.add(region, "transition", "Transition", name, **ends)
        if kind:
            self.draft.set(transition, kind=kind)
        return transition

    def enter(self, region: Element, target: Element) -> Element:
        """Add an initial pseudostate and its transition."""
        return self.add_transition(region, self.add_pseudostate(region), target)

    def start_with(self, *words: str) -> list[Element]:
        """Add states to the outermost region, the first of which is entered at first."""
        states = [self.add_state(self.region, word) for word in words]
        self.enter(self.region, states[0])
        return states

    def add_trigger(self, transition: Element, kind: str = "") -> Element:
        """Add a trigger with an event of a random kind."""
        draft = self.draft
        kind = kind or draft.choose("Signal", "Call", "Time", "Change", "AnyReceive")
        event = draft.add_packaged(f"{kind}Event", "event" if draft.maybe() else "")
        if kind == "Signal":
            draft.set(event, signal=draft.signal)
        elif kind == "Call":
            operation = draft.add(self.block, "ownedOperation", "Operation", draft.make_name("op"))
            draft.set(event, operation=operation)
        elif kind == "Time":
            draft.set(event, isRelative=draft.maybe())
            when = draft.add(event, "when", "TimeExpression")
            literals = {"LiteralInteger": "3", "LiteralReal": "2.5", "LiteralString": "5 s"}
            metaclass = draft.random.choice(sorted(literals))
            draft.add(when, "expr", metaclass, value=literals[metaclass])
        elif kind == "Change":
            draft.add_text(event, "changeExpression", f"{self.count.get('name')} > 3")
        name = draft.make_name("trigger") if draft.maybe(0.3) else ""
        return draft.add(transition, "trigger", "Trigger", name, event=event)

    def add_guard(self, transition: Element, text: str = "", language: str = "OCL") -> None:
        draft, flag, count = self.draft, self.flag.get("name"), self.count.get("name")
        choices = (flag, f"not {flag}", f"{count} < 5", f"{flag} and {count} = 2", f"{count} <> 4")
        rule = draft.add(transition, "ownedRule", "Constraint", "")
        draft.add_text(rule, "specification", text or draft.choose(*choices), language)
        draft.set(transition, guard=rule)

    def add_effect(self, owner: Element, feature: str = "effect") -> None:
        flag, count = self.flag.get("name"), self.count.get("name")
        language, text = self.draft.choose(
            ("Java", f"{count} = {count} + 1;"),
            ("C++", f"{flag} = true;"),
            ("KerML", f"{flag} := false"),
            ("English", "move the belt & stop"),
            ("", "beep"),
        )
        self.draft.add_behaviour(owner, feature, text, language)


def add_composite_state(draft: Draft) -> None:
    """Add nested states with all kinds of transitions, triggers and behaviours."""
    machine = Machine(draft)
    off, on = machine.start_with("off", "on")
    region = machine.add_region(on)
    slow, fast = machine.add_state(region, "slow"), machine.add_state(region, "fast")
    machine.enter(region, slow)
    for source, target in ((off, on), (on, off), (slow, fast), (fast, slow)):
        owner = region if source in (slow, fast) else machine.region
        transition = machine.add_transition(owner, source, target)
        for _ in range(draft.random.randint(1, 2)):
            machine.add_trigger(transition)
        if draft.maybe():
            machine.add_guard(transition)
        if draft.maybe():
            machine.add_effect(transition)
    internal = machine.add_transition(region, slow, slow, "internal")
    machine.add_trigger(internal, draft.choose("Signal", "Change"))
    machine.add_effect(internal)
    local = machine.add_transition(machine.region, on, fast, "local")
    machine.add_trigger(local, "Call")
    out = machine.add_transition(machine.region, fast, off)
    machine.add_trigger(out, "Time")
    for feature in ("entry", "doActivity", "exit"):
        if draft.maybe():
            machine.add_effect(draft.choose(off, on, slow), feature)
    if draft.maybe():
        final = draft.add(region, "subvertex", "FinalState", draft.make_name("done"))
        machine.add_trigger(machine.add_transition(region, fast, final), "Signal")
        machine.add_transition(machine.region, on, off)
    invariant = draft.add(off, "stateInvariant", "Constraint", "")
    draft.add_text(invariant, "specification", f"{machine.count.get('name')} >= 0")
    event = draft.add_packaged("SignalEvent", "later", signal=draft.signal)
    draft.add(off, "deferrableTrigger", "Trigger", "", event=event)


def add_orthogonal_state(draft: Draft) -> None:
    """Add a state of two regions, which a fork enters and a join leaves."""
    machine = Machine(draft)
    (idle,) = machine.start_with("idle")
    both, done = machine.add_state(machine.region, "both"), machine.add_state(machine.region)
    fork, join = (machine.add_pseudostate(machine.region, kind) for kind in ("fork", "join"))
    enter = machine.add_transition(machine.region, idle, fork)
    machine.add_trigger(enter)
    for _ in range(2):
        region = machine.add_region(both)
        first, last = machine.add_state(region), machine.add_state(region)
        if draft.maybe():
            machine.enter(region, first)
        machine.add_trigger(machine.add_transition(region, first, last))
        machine.add_transition(machine.region, fork, first)
        machine.add_transition(machine.region, last, join)
    leave = machine.add_transition(machine.region, join, done)
    if draft.maybe():
        machine.add_effect(leave)


def add_histories(draft: Draft) -> None:
    """Add a shallow and a deep history, with and without default transitions."""
    machine = Machine(draft)
    off, on = machine.start_with("off", "on")
    region = machine.add_region(on)
    low, high = machine.add_state(region, "low"), machine.add_state(region, "high")
    machine.enter(region, low)
    machine.add_trigger(machine.add_transition(region, low, high), "Signal")
    kinds = draft.choose(["shallowHistory"], ["deepHistory"], ["shallowHistory", "deepHistory"])
    for kind, trigger in zip(kinds, ("Change", "Call"), strict=False):
        history = machine.add_pseudostate(region, kind)
        machine.add_trigger(machine.add_transition(machine.region, off, history), trigger)
        if draft.maybe():
            machine.add_transition(region, history, draft.choose(low, high))
    machine.add_trigger(machine.add_transition(machine.region, on, off), "Time")


def add_branches(draft: Draft) -> None:
    """Add a choice and a junction with guards and an else branch, and a terminate pseudostate."""
    machine = Machine(draft)
    start, left, right = machine.start_with("start", "left", "right")
    for kind in ("choice", "junction"):
        vertex = machine.add_pseudostate(machine.region, kind)
        into = machine.add_transition(machine.region, start, vertex)
        machine.add_trigger(into, "Signal" if kind == "choice" else "Call")
        if draft.maybe():
            machine.add_effect(into)
        branch = machine.add_transition(machine.region, vertex, left)
        machine.add_guard(branch)
        other = machine.add_transition(machine.region, vertex, right)
        machine.add_guard(other, "else", draft.choose("OCL", ""))
    back = machine.add_transition(machine.region, left, start)
    machine.add_trigger(back)
    if draft.maybe():
        end = machine.add_pseudostate(machine.region, "terminate")
    else:
        end = draft.add(machine.region, "subvertex", "FinalState", draft.make_name("end"))
    machine.add_trigger(machine.add_transition(machine.region, right, end), "Signal")


def add_entry_and_exit_points(draft: Draft) -> None:
    """Add a composite state that is entered by an entry point and left by an exit point."""
    machine = Machine(draft)
    off, on = machine.start_with("off", "on")
    region = machine.add_region(on)
    inside = machine.add_state(region, "inside")
    if draft.maybe():
        machine.enter(region, inside)
    entry, exit_ = (
        draft.add(on, "connectionPoint", "Pseudostate", draft.make_name("point"), kind=kind)
        for kind in ("entryPoint", "exitPoint")
    )
    machine.add_trigger(machine.add_transition(machine.region, off, entry), "Signal")
    into = machine.add_transition(region, entry, inside)
    if draft.maybe():
        machine.add_effect(into)
    machine.add_trigger(machine.add_transition(region, inside, exit_), "Signal")
    machine.add_transition(machine.region, exit_, off)


def add_submachine(draft: Draft) -> None:
    """Add a machine that is used as a state of another one, entered and left by its points."""
    inner, outer = Machine(draft, "Inner"), Machine(draft, "Outer")
    (work,) = inner.start_with("work")
    entry, exit_ = (
        draft.add(inner.machine, "connectionPoint", "Pseudostate", draft.make_name("p"), kind=kind)
        for kind in ("entryPoint", "exitPoint")
    )
    second = inner.add_state(inner.region, "second")
    inner.add_transition(inner.region, entry, second)
    inner.add_trigger(inner.add_transition(inner.region, work, second), "Signal")
    inner.add_trigger(inner.add_transition(inner.region, second, exit_), "Time")
    (idle,) = outer.start_with("idle")
    use = outer.add_state(outer.region, "use")
    draft.set(use, submachine=inner.machine)
    references = [
        draft.add(use, "connection", "ConnectionPointReference", draft.make_name("ref"), **points)
        for points in ({"entry": [entry]}, {"exit": [exit_]})
    ]
    outer.add_trigger(outer.add_transition(outer.region, idle, references[0]), "Signal")
    outer.add_transition(outer.region, references[1], idle)
    if draft.maybe():
        outer.add_trigger(outer.add_transition(outer.region, idle, use), "Call")


def add_protocol(draft: Draft) -> None:
    """Add a protocol state machine to an interface, with conditions on its transitions."""
    add = draft.add
    interface = draft.add_packaged("Interface", "Door")
    operations = [
        add(interface, "ownedOperation", "Operation", draft.make_name(word))
        for word in ("open", "close")
    ]
    machine = add(interface, "protocol", "ProtocolStateMachine", draft.make_name("Protocol"))
    region = add(machine, "region", "Region", "Region1")
    states = [add(region, "subvertex", "State", draft.make_name(word)) for word in ("shut", "open")]
    first = add(region, "subvertex", "Pseudostate", "")
    ends = [(first, states[0], None), (*states, operations[0]), (*states[::-1], operations[1])]
    for source, target, operation in ends:
        features = {"source": source, "target": target}
        transition = add(region, "transition", "ProtocolTransition", "", **features)
        if operation is not None:
            event = draft.add_packaged("CallEvent", "", operation=operation)
            add(transition, "trigger", "Trigger", "", event=event)
            for feature in ("preCondition", "postCondition"):
                if draft.maybe():
                    rule = add(transition, "ownedRule", "Constraint", "")
                    draft.add_text(rule, "specification", "true")
                    draft.set(transition, **{feature: rule})


def add_extended_machine(draft: Draft) -> None:
    """Add a machine that extends the machine of a general block and redefines a state."""
    general = Machine(draft, "General")
    first, second = general.start_with("first", "second")
    general.add_trigger(general.add_transition(general.region, first, second), "Signal")
    special = draft.add_block("Special")
    draft.add(special, "generalization", "Generalization", general=general.block)
    machine = draft.add(special, "ownedBehavior", "StateMachine", draft.make_name("Special"))
    draft.set(special, classifierBehavior=machine)
    draft.set(machine, extendedStateMachine=[general.machine])
    region = draft.add(machine, "region", "Region", "", extendedRegion=general.region)
    state = draft.add(region, "subvertex", "State", second.get("name"), redefinedState=second)
    third = draft.add(region, "subvertex", "State", draft.make_name("third"))
    transition = draft.add(region, "transition", "Transition", "", source=state, target=third)
    general.add_trigger(transition, "Time")
