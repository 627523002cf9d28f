"""Topics of activities: control and object flows, groups, partitions, pins, SysML's stereotypes."""

from itertools import pairwise

from dialects.papyrus import Element, add_body
from legal.draft import Draft


class Work:
    """An activity of a block with values that guards and actions can use."""

    def __init__(self, draft: Draft, word: str = "Work") -> None:
        self.draft = draft
        self.block = draft.add_block("Worker")
        self.flag = draft.add_value(self.block, "ready", "Boolean")
        self.count = draft.add_value(self.block, "level", "Integer")
        self.activity = draft.add(self.block, "ownedBehavior", "Activity", draft.make_name(word))
        if draft.maybe(0.3):
            draft.set(self.block, classifierBehavior=self.activity)

    def add_node(self, metaclass: str, word: str = "", owner: Element | None = None, **features):
        is_structured = metaclass in _STRUCTURED and owner is None
        feature = "structuredNode" if is_structured else "node"
        name = "" if word == "" and self.draft.maybe(0.6) else self.draft.make_name(word)
        owner = self.activity if owner is None else owner
        return self.draft.add(owner, feature, metaclass, name, **features)

    def add_action(self, word: str = "do", owner: Element | None = None) -> Element:
        action = self.add_node("OpaqueAction", word, owner)
        if self.draft.maybe(0.3):
            count = self.count.get("name")
            body, language = self.draft.choose(
                (f"{count} = {count} + 1;", "Java"), ("wait a moment", "English"), ("beep()", "C")
            )
            add_body(action, body, language)
        return action

    def add_flow(
        self, source: Element, target: Element, kind: str = "ControlFlow", guard: str = "",
        owner: Element | None = None,
    ) -> Element:  # fmt: skip
        owner = self.activity if owner is None else owner
        name = self.draft.make_name("e") if self.draft.maybe(0.1) else ""
        flow = self.draft.add(owner, "edge", kind, name, source=source, target=target)
        if guard:
            self.draft.add_text(flow, "guard", guard, self.draft.choose("OCL", ""))
        return flow

    def add_chain(self, *nodes: Element, owner: Element | None = None) -> None:
        for source, target in pairwise(nodes):
            self.add_flow(source, target, owner=owner)

    def add_pin(self, action: Element, feature: str, type_: Element | str, **features) -> Element:
        is_input = feature in _INPUTS
        kind = "InputPin" if is_input else "OutputPin"
        pin = self.draft.add(action, feature, kind, self.draft.make_name("pin"), **features)
        if isinstance(type_, str):
            self.draft.set_type(pin, type_)
        else:
            self.draft.set(pin, type=type_)
        return pin

    def add_value_action(self, metaclass: str, value: str, primitive: str, owner=None) -> Element:
        """Add an action that provides a literal, and return its output pin."""
        action = self.add_node("ValueSpecificationAction", "value", owner)
        self.draft.add(action, "value", metaclass, value=value)
        return self.add_pin(action, "result", primitive)

    def add_self(self) -> Element:
        """Add an action that provides the object of the activity, and return its pin."""
        return self.add_pin(self.add_node("ReadSelfAction", "self"), "result", self.block)

    def choose_guard(self) -> str:
        flag, count = self.flag.get("name"), self.count.get("name")
        return str(self.draft.choose(flag, f"not {flag}", f"{count} > 2", f"{count} = 3"))


_STRUCTURED = frozenset(
    ("StructuredActivityNode", "SequenceNode", "LoopNode", "ConditionalNode", "ExpansionRegion")
)
_INPUTS = frozenset(
    [
        *("inputValue", "argument", "object", "value", "target", "first", "second", "request"),
        *("loopVariableInput", "exception", "returnInformation", "replyValue", "collection"),
    ]
)


def add_control(draft: Draft) -> None:
    """Add decisions, merges, forks, joins, both finals, and several initial nodes."""
    work = Work(draft)
    start, end = work.add_node("InitialNode"), work.add_node("ActivityFinalNode")
    first, left, right = (work.add_action() for _ in range(3))
    decision, merge = work.add_node("DecisionNode", "which?"), work.add_node("MergeNode")
    work.add_chain(start, first, decision)
    work.add_flow(decision, left, guard=work.choose_guard())
    work.add_flow(decision, right, guard="else")
    for branch in (left, right):
        work.add_flow(branch, merge)
    fork, join = work.add_node("ForkNode"), work.add_node("JoinNode")
    work.add_flow(merge, fork)
    for _ in range(draft.random.randint(2, 3)):
        work.add_chain(fork, work.add_action("parallel"), join)
    if draft.maybe(0.3):
        draft.set(join, isCombineDuplicate=False)
    work.add_chain(join, work.add_action("last"), end)
    if draft.maybe():
        work.add_chain(
            work.add_node("InitialNode", "second start"), work.add_action(),
            work.add_node("FlowFinalNode"),
        )  # fmt: skip
    if draft.maybe():
        loop = work.add_node("DecisionNode")
        again = work.add_node("MergeNode")
        body = work.add_action("repeat")
        work.add_chain(work.add_node("InitialNode"), again, body, loop)
        work.add_flow(loop, again, guard=work.choose_guard())
        work.add_flow(loop, work.add_node("FlowFinalNode", "enough"), guard="else")


def add_object_flows(draft: Draft) -> None:
    """Add parameters, pins, a central buffer, a data store, and behaviours of flows."""
    work = Work(draft)
    parameters = {}
    for direction in ("in", "out"):
        parameter = draft.add(
            work.activity, "ownedParameter", "Parameter", draft.make_name(direction),
            type=draft.item, direction=direction,
        )  # fmt: skip
        if draft.maybe(0.3):
            draft.set(parameter, isStream=True)
        parameters[direction] = work.add_node(
            "ActivityParameterNode", "given", parameter=parameter, type=draft.item
        )
    action = work.add_action("transform")
    if draft.maybe(0.2):
        draft.set(action, isLocallyReentrant=True)
    taken, made = (work.add_pin(action, f, draft.item) for f in ("inputValue", "outputValue"))
    buffer = work.add_node(draft.choose("CentralBufferNode", "DataStoreNode"), "store")
    draft.set(buffer, type=draft.item)
    if draft.maybe(0.3):
        draft.set(buffer, ordering=draft.choose("LIFO", "unordered"))
    if draft.maybe(0.3):
        draft.add(buffer, "upperBound", "LiteralUnlimitedNatural", value="5")
    work.add_flow(parameters["in"], taken, "ObjectFlow")
    flow = work.add_flow(made, buffer, "ObjectFlow")
    work.add_flow(buffer, parameters["out"], "ObjectFlow")
    if draft.maybe():
        draft.document.set_bounds(taken, draft.random.randint(0, 1), draft.choose("1", "*"))
    if draft.maybe():
        value = work.draft.add(action, "inputValue", "ValuePin", draft.make_name("five"))
        draft.set_type(value, "Integer")
        draft.add(value, "value", "LiteralInteger", value="5")
    if draft.maybe():
        work.add_flow(action, work.add_action("other"))
    _adorn_flow(draft, flow, taken)


def _adorn_flow(draft: Draft, flow: Element, taken: Element) -> None:
    """Give a flow a weight, a transformation and stereotypes, and its pin a stereotype."""
    if draft.maybe():
        draft.add(flow, "weight", "LiteralUnlimitedNatural", value=draft.choose("1", "*"))
    if draft.maybe():
        behaviour = draft.add_packaged("OpaqueBehavior", "polish")
        for direction in ("in", "return"):
            name = draft.make_name("x")
            features = {"direction": direction, "type": draft.item}
            draft.add(behaviour, "ownedParameter", "Parameter", name, **features)
        add_body(behaviour, "return x;", "Java")
        draft.set(flow, transformation=behaviour)
    rate = draft.add_packaged("InstanceSpecification", "five per second")
    name = draft.choose("Rate", "Discrete", "Continuous", "")
    if name:
        draft.apply(f"Activities:{name}", flow, rate=rate)
    name = draft.choose("NoBuffer", "Overwrite", "")
    if name:
        draft.apply(f"Activities:{name}", taken)


def add_decision_on_objects(draft: Draft) -> None:
    """Add a decision on a value, one with a decision input, and a join with a specification."""
    work = Work(draft)
    value = work.add_value_action("LiteralInteger", "3", "Integer")
    decision = work.add_node("DecisionNode", "how many?")
    work.add_flow(value, decision, "ObjectFlow")
    for number in ("3", "4"):
        store = work.add_node("CentralBufferNode", "kept")
        draft.set_type(store, "Integer")
        flow = work.add_flow(decision, store, "ObjectFlow")
        draft.add(flow, "guard", "LiteralInteger", value=number)
    asked = work.add_node("DecisionNode", "ready?")
    behaviour = draft.add_packaged("OpaqueBehavior", "is ready")
    answer = draft.add(behaviour, "ownedParameter", "Parameter", "", direction="return")
    draft.set_type(answer, "Boolean")
    add_body(behaviour, "true", "OCL")
    draft.set(asked, decisionInput=behaviour)
    work.add_chain(work.add_node("InitialNode"), asked)
    for literal in ({"value": True}, {}):
        flow = work.add_flow(asked, work.add_action())
        draft.add(flow, "guard", "LiteralBoolean", **literal)
    if draft.maybe():
        third = work.add_node("DecisionNode", "flow")
        truth = work.add_value_action("LiteralBoolean", "true", "Boolean")
        draft.set(third, decisionInputFlow=work.add_flow(truth, third, "ObjectFlow"))
        work.add_chain(work.add_node("InitialNode"), third)
        draft.add(work.add_flow(third, work.add_action()), "guard", "LiteralBoolean", value=True)
        work.add_flow(third, work.add_node("FlowFinalNode"), guard="else")
    if draft.maybe():
        join = work.add_node("JoinNode")
        edges = [work.add_flow(work.add_node("InitialNode"), join) for _ in range(2)]
        for index, edge in enumerate(edges):
            draft.set(edge, name=f"e{index}")
        draft.add_text(join, "joinSpec", "e0 and e1")
        work.add_flow(join, work.add_action())


def add_partitions(draft: Draft) -> None:
    """Add partitions that represent a part, a class and nothing, one inside another."""
    work = Work(draft)
    part = draft.add_part(work.block, draft.item)
    start, end = work.add_node("InitialNode"), work.add_node("ActivityFinalNode")
    nodes = [work.add_action() for _ in range(3)]
    work.add_chain(start, *nodes, end)
    represented = draft.random.sample([part, draft.block, None], 2)
    lanes = []
    for index, element in enumerate(represented):
        lane = draft.add(work.activity, "group", "ActivityPartition", draft.make_name("lane"))
        draft.set(lane, node=[nodes[index]])
        draft.set(nodes[index], inPartition=[lane])
        if element is not None:
            draft.set(lane, represents=element)
            draft.set(lane, isExternal=draft.maybe(0.3)) if element is draft.block else None
        lanes.append(lane)
    inner = draft.add(lanes[0], "subpartition", "ActivityPartition", draft.make_name("inner"))
    draft.set(inner, node=[nodes[2]])
    draft.set(nodes[2], inPartition=[inner])
    draft.set(work.activity, partition=lanes)
    if draft.maybe(0.3):
        draft.set(lanes[1], isDimension=True)
    if lanes[0].get("represents") and draft.maybe():
        draft.apply("Allocations:AllocateActivityPartition", lanes[0])


def add_interruption(draft: Draft) -> None:
    """Add an interruptible region that an event interrupts."""
    work = Work(draft)
    start, end = work.add_node("InitialNode"), work.add_node("ActivityFinalNode")
    busy, wait = work.add_action("busy"), work.add_node("AcceptEventAction", "wait")
    metaclass = draft.choose("SignalEvent", "TimeEvent", "ChangeEvent")
    event = draft.add_packaged(metaclass, "event")
    if metaclass == "SignalEvent":
        draft.set(event, signal=draft.signal)
    elif metaclass == "TimeEvent":
        draft.set(event, isRelative=True)
        when = draft.add(event, "when", "TimeExpression")
        draft.add(when, "expr", "LiteralInteger", value="5")
    else:
        draft.add_text(event, "changeExpression", f"{work.count.get('name')} > 3")
    draft.add(wait, "trigger", "Trigger", "", event=event)
    rescue = work.add_action("rescue")
    work.add_chain(start, busy, end)
    leaving = work.add_flow(wait, rescue)
    work.add_flow(rescue, end if draft.maybe() else work.add_node("FlowFinalNode"))
    region = draft.add(
        work.activity, "group", "InterruptibleActivityRegion", draft.make_name("region"),
        node=[busy, wait],
    )  # fmt: skip
    for node in (busy, wait):
        draft.set(node, inInterruptibleRegion=[region])
    draft.set(region, interruptingEdge=[leaving])
    draft.set(leaving, interrupts=region)


def add_structured_nodes(draft: Draft) -> None:
    """Add a sequence, a structured node, a loop with a loop variable, and a conditional node."""
    work = Work(draft)
    start, end = work.add_node("InitialNode"), work.add_node("ActivityFinalNode")
    sequence = work.add_node("SequenceNode", "in order")
    for _ in range(2):
        step = draft.add(sequence, "executableNode", "OpaqueAction", draft.make_name("step"))
        add_body(step, "step()", "C")
    plain = work.add_node("StructuredActivityNode", "group")
    inside = [work.add_action("inside", plain) for _ in range(2)]
    work.add_chain(work.add_node("InitialNode", "", plain), *inside, owner=plain)
    if draft.maybe(0.3):
        draft.set(plain, mustIsolate=True)
    loop, choice = _add_loop(work), _add_conditional(work)
    nodes = [sequence, plain, loop, choice]
    work.draft.random.shuffle(nodes)
    work.add_chain(start, *nodes, end)


def _add_loop(work: Work) -> Element:
    """Add a loop that adds one to its variable while a test holds."""
    draft = work.draft
    loop = work.add_node("LoopNode", "loop", isTestedFirst=work.draft.maybe())
    test = work.add_node("ValueSpecificationAction", "test", loop)
    draft.add(test, "value", "LiteralBoolean", value=True)
    decider = work.add_pin(test, "result", "Boolean")
    body = work.add_node("OpaqueAction", "body", loop)
    draft.set(loop, test=[test], bodyPart=[body], decider=decider)
    if draft.maybe():
        setup = work.add_action("set up", loop)
        draft.set(loop, setupPart=[setup])
    if draft.maybe():
        given = work.add_pin(loop, "loopVariableInput", "Integer")
        variable = draft.add(loop, "loopVariable", "OutputPin", draft.make_name("n"))
        draft.set_type(variable, "Integer")
        work.add_pin(loop, "result", "Integer")
        used, made = (work.add_pin(body, f, "Integer") for f in ("inputValue", "outputValue"))
        work.add_flow(variable, used, "ObjectFlow", owner=loop)
        draft.set(loop, bodyOutput=[made])
        first = work.add_value_action("LiteralInteger", "1", "Integer")
        work.add_flow(first, given, "ObjectFlow")
    return loop


def _add_conditional(work: Work) -> Element:
    """Add a conditional node of two clauses, the second of which follows the first."""
    draft = work.draft
    choice = work.add_node("ConditionalNode", "choice")
    draft.set(choice, isAssured=draft.maybe(), isDeterminate=draft.maybe())
    clauses = []
    for _ in range(2):
        test = work.add_node("ValueSpecificationAction", "test", choice)
        draft.add(test, "value", "LiteralBoolean", value=draft.maybe())
        decider = work.add_pin(test, "result", "Boolean")
        body = work.add_action("body", choice)
        features = {"test": [test], "body": [body], "decider": decider}
        clauses.append(draft.add(choice, "clause", "Clause", "", **features))
    draft.set(clauses[1], predecessorClause=[clauses[0]])
    draft.set(clauses[0], successorClause=[clauses[1]])
    return choice


def add_expansion(draft: Draft) -> None:
    """Add an expansion region with its nodes, and an exception handler."""
    work = Work(draft)
    mode = draft.choose("iterative", "parallel", "stream")
    region = work.add_node("ExpansionRegion", "each", mode=mode)
    nodes = [work.add_node("ExpansionNode", "list") for _ in range(2)]
    for node in nodes:
        draft.set(node, type=draft.item)
    draft.set(region, inputElement=[nodes[0]], outputElement=[nodes[1]])
    draft.set(nodes[0], regionAsInput=region)
    draft.set(nodes[1], regionAsOutput=region)
    body = work.add_action("body", region)
    taken, made = (work.add_pin(body, f, draft.item) for f in ("inputValue", "outputValue"))
    work.add_flow(nodes[0], taken, "ObjectFlow", owner=region)
    work.add_flow(made, nodes[1], "ObjectFlow", owner=region)
    source = work.add_action("source")
    work.add_flow(work.add_pin(source, "outputValue", draft.item), nodes[0], "ObjectFlow")
    sink = work.add_action("sink")
    work.add_flow(nodes[1], work.add_pin(sink, "inputValue", draft.item), "ObjectFlow")
    rescue = work.add_action("rescue")
    caught = work.add_pin(rescue, "inputValue", draft.item)
    features = {"handlerBody": rescue, "exceptionInput": caught, "exceptionType": [draft.item]}
    draft.add(source, "handler", "ExceptionHandler", "", **features)
    work.add_pin(rescue, "outputValue", draft.item)
