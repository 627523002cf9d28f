"""Topics of actions: calls, signals, events, objects, structural features, links, variables."""

from dialects.papyrus import Element
from legal.activities import Work
from legal.draft import Draft


def add_calls(draft: Draft) -> None:
    """Add calls of a behaviour and of an operation, with all their pins."""
    work = Work(draft)
    called = draft.add_packaged("Activity", "Called")
    operation = draft.add(work.block, "ownedOperation", "Operation", draft.make_name("compute"))
    for owner in (called, operation):
        for direction in ("in", "inout", "out", "return"):
            parameter = draft.add(owner, "ownedParameter", "Parameter", draft.make_name("p"))
            draft.set(parameter, direction=direction)
            draft.set_type(parameter, "Integer")
            if owner is called:
                for _ in range(2 if direction == "inout" else 1):
                    node = draft.add(
                        called, "node", "ActivityParameterNode", draft.make_name("given"),
                        parameter=parameter,
                    )  # fmt: skip
                    draft.set_type(node, "Integer")
    inputs = list(called.iterchildren("node"))[:2]
    step = draft.add(called, "node", "OpaqueAction", draft.make_name("step"))
    draft.add(called, "edge", "ObjectFlow", source=inputs[0], target=_add_integer(draft, step))
    call = work.add_node("CallBehaviorAction", "call", behavior=called)
    ask = work.add_node("CallOperationAction", "ask", operation=operation)
    for action in (call, ask):
        for _ in range(2):
            value = work.add_value_action("LiteralInteger", "2", "Integer")
            work.add_flow(value, work.add_pin(action, "argument", "Integer"), "ObjectFlow")
        for _ in range(3):
            work.add_pin(action, "result", "Integer")
    work.add_flow(work.add_self(), work.add_pin(ask, "target", work.block), "ObjectFlow")
    work.add_chain(work.add_node("InitialNode"), call, ask, work.add_node("ActivityFinalNode"))
    if draft.maybe():
        draft.set(call, isSynchronous=True)
    other = work.add_node("StartObjectBehaviorAction", "start")
    draft.set(other, isSynchronous=False)
    draft.set(work.block, classifierBehavior=work.activity)
    work.add_flow(work.add_self(), work.add_pin(other, "object", work.block), "ObjectFlow")


def _add_integer(draft: Draft, action: Element) -> Element:
    pin = draft.add(action, "inputValue", "InputPin", draft.make_name("pin"))
    draft.set_type(pin, "Integer")
    return pin


def add_signals(draft: Draft) -> None:
    """Add actions that send, broadcast, accept and unmarshal a signal with an attribute."""
    work = Work(draft)
    name = draft.signal.get("name")
    draft.add(draft.block, "ownedReception", "Reception", name, signal=draft.signal)
    signal = draft.add_packaged("Signal", "News")
    payload = draft.add(signal, "ownedAttribute", "Property", draft.make_name("payload"))
    draft.set_type(payload, "Integer")
    name = signal.get("name")
    reception = draft.add(work.block, "ownedReception", "Reception", name, signal=signal)
    parameter = draft.add(reception, "ownedParameter", "Parameter", payload.get("name"))
    draft.set_type(parameter, "Integer")
    send = work.add_node("SendSignalAction", "send", signal=signal)
    broadcast = work.add_node("BroadcastSignalAction", "broadcast", signal=signal)
    for action in (send, broadcast):
        value = work.add_value_action("LiteralInteger", "2", "Integer")
        work.add_flow(value, work.add_pin(action, "argument", "Integer"), "ObjectFlow")
    work.add_flow(work.add_self(), work.add_pin(send, "target", work.block), "ObjectFlow")
    event = draft.add_packaged("SignalEvent", "news", signal=signal)
    accept = work.add_node("AcceptEventAction", "accept")
    draft.add(accept, "trigger", "Trigger", draft.make_name("t"), event=event)
    if draft.maybe():
        draft.set(accept, isUnmarshall=True)
        work.add_pin(accept, "result", "Integer")
    elif draft.maybe():
        work.add_pin(accept, "result", signal)
    chain = [work.add_node("InitialNode"), send, broadcast, accept]
    work.add_chain(*chain, work.add_node("ActivityFinalNode"))
    if draft.maybe():
        box = work.add_node("SendObjectAction", "send object")
        work.add_flow(work.add_self(), work.add_pin(box, "target", work.block), "ObjectFlow")
        work.add_flow(work.add_self(), work.add_pin(box, "request", work.block), "ObjectFlow")


def add_call_events(draft: Draft) -> None:
    """Add an action that accepts a call, and the one that replies to it."""
    work = Work(draft)
    operation = draft.add(work.block, "ownedOperation", "Operation", draft.make_name("serve"))
    result = draft.add(operation, "ownedParameter", "Parameter", "", direction="return")
    draft.set_type(result, "Integer")
    event = draft.add_packaged("CallEvent", "", operation=operation)
    accept = work.add_node("AcceptCallAction", "accept", isUnmarshall=True)
    draft.add(accept, "trigger", "Trigger", "", event=event)
    token = draft.add(accept, "returnInformation", "OutputPin", draft.make_name("who"))
    reply = work.add_node("ReplyAction", "reply")
    draft.add(reply, "replyToCall", "Trigger", "", event=event)
    back = draft.add(reply, "returnInformation", "InputPin", draft.make_name("who"))
    answer = work.add_pin(reply, "replyValue", "Integer")
    work.add_flow(token, back, "ObjectFlow")
    value = work.add_value_action("LiteralInteger", "4", "Integer")
    work.add_flow(value, answer, "ObjectFlow")
    work.add_chain(accept, reply)


def add_features(draft: Draft) -> None:
    """Add actions that read, write, remove and clear a feature of the activity's object."""
    work = Work(draft)
    many = draft.add_value(work.block, "many", "Integer")
    draft.document.set_bounds(many, 0, "*")
    read = work.add_node("ReadStructuralFeatureAction", "read", structuralFeature=many)
    result = work.add_pin(read, "result", "Integer")
    draft.document.set_bounds(result, 0, "*")
    add = work.add_node("AddStructuralFeatureValueAction", "add", structuralFeature=many)
    remove = work.add_node("RemoveStructuralFeatureValueAction", "remove", structuralFeature=many)
    clear = work.add_node("ClearStructuralFeatureAction", "clear", structuralFeature=many)
    if draft.maybe():
        draft.set(add, isReplaceAll=True)
    if draft.maybe():
        draft.set(remove, isRemoveDuplicates=True)
    for action in (read, add, remove, clear):
        work.add_flow(work.add_self(), work.add_pin(action, "object", work.block), "ObjectFlow")
        if action in (add, remove):
            value = work.add_value_action("LiteralInteger", "1", "Integer")
            work.add_flow(value, work.add_pin(action, "value", "Integer"), "ObjectFlow")
        if action is not read and draft.maybe():
            work.add_pin(action, "result", work.block)
    work.add_chain(work.add_node("InitialNode"), read, add, remove, clear)


def add_objects(draft: Draft) -> None:
    """Add actions that create, compare, classify and destroy objects."""
    work = Work(draft)
    create = work.add_node("CreateObjectAction", "create", classifier=draft.item)
    made = work.add_pin(create, "result", draft.item)
    fork = work.add_node("ForkNode")
    work.add_flow(made, fork, "ObjectFlow")
    test = work.add_node("TestIdentityAction", "same?")
    for feature in ("first", "second"):
        pin = draft.add(test, feature, "InputPin", draft.make_name("p"))
        work.add_flow(fork, pin, "ObjectFlow")
    work.add_pin(test, "result", "Boolean")
    check = work.add_node("ReadIsClassifiedObjectAction", "is it?", classifier=draft.item)
    if draft.maybe():
        draft.set(check, isDirect=True)
    work.add_flow(fork, draft.add(check, "object", "InputPin", draft.make_name("p")), "ObjectFlow")
    work.add_pin(check, "result", "Boolean")
    extent = work.add_node("ReadExtentAction", "all", classifier=draft.item)
    draft.document.set_bounds(work.add_pin(extent, "result", draft.item), 0, "*")
    destroy = work.add_node("DestroyObjectAction", "destroy")
    draft.set(destroy, isDestroyLinks=draft.maybe())
    pin = draft.add(destroy, "target", "InputPin", draft.make_name("p"))
    work.add_flow(fork, pin, "ObjectFlow")
    work.add_chain(create, test, check, destroy)
    if draft.maybe():
        change = work.add_node("ReclassifyObjectAction", "change", newClassifier=[draft.block])
        draft.set(change, oldClassifier=[draft.item])
        pin = draft.add(change, "object", "InputPin", draft.make_name("p"))
        work.add_flow(fork, pin, "ObjectFlow")
    if draft.maybe():
        reduce = draft.add_packaged("FunctionBehavior", "sum")
        for direction in ("in", "in", "return"):
            name = draft.make_name("x")
            parameter = draft.add(reduce, "ownedParameter", "Parameter", name, direction=direction)
            draft.set_type(parameter, "Integer")
        action = work.add_node("ReduceAction", "reduce", reducer=reduce, isOrdered=draft.maybe())
        pin = work.add_pin(action, "collection", "Integer")
        draft.document.set_bounds(pin, 0, "*")
        work.add_pin(action, "result", "Integer")
        work.add_flow(work.add_value_action("LiteralInteger", "1", "Integer"), pin, "ObjectFlow")
    if draft.maybe():
        fail = work.add_node("RaiseExceptionAction", "fail")
        work.add_flow(fork, work.add_pin(fail, "exception", draft.item), "ObjectFlow")


def add_links(draft: Draft) -> None:
    """Add actions that create, read and destroy links of an association."""
    work = Work(draft)
    link = draft.add_packaged("Association", "holds")
    ends = [
        draft.add(link, "ownedEnd", "Property", draft.make_name("end"), type=type_)
        for type_ in (draft.block, draft.item)
    ]
    for end in ends:
        draft.set(end, association=link)
        draft.document.set_bounds(end, 0, "*")
    draft.set(link, memberEnd=ends, navigableOwnedEnd=ends)
    kinds = {
        "CreateLinkAction": "LinkEndCreationData",
        "DestroyLinkAction": "LinkEndDestructionData",
        "ReadLinkAction": "LinkEndData",
    }
    actions = []
    for metaclass, data in kinds.items():
        action = work.add_node(metaclass, "link")
        for end in ends:
            features = {"end": end}
            if not (metaclass == "ReadLinkAction" and end is ends[1]):
                type_ = draft.block if end is ends[0] else draft.item
                pin = features["value"] = work.add_pin(action, "inputValue", type_)
                create = work.add_node("CreateObjectAction", "create", classifier=type_)
                work.add_flow(work.add_pin(create, "result", type_), pin, "ObjectFlow")
            draft.add(action, "endData", data, "", **features)
        actions.append(action)
    result = work.add_pin(actions[-1], "result", draft.item)
    draft.document.set_bounds(result, 0, "*")
    work.add_chain(actions[0], actions[2], actions[1])


def add_variables(draft: Draft) -> None:
    """Add a variable of an activity, and actions that write, read and clear it."""
    work = Work(draft)
    variable = draft.add(work.activity, "variable", "Variable", draft.make_name("v"))
    draft.set_type(variable, "Integer")
    write = work.add_node("AddVariableValueAction", "write", variable=variable)
    value = work.add_value_action("LiteralInteger", "4", "Integer")
    work.add_flow(value, work.add_pin(write, "value", "Integer"), "ObjectFlow")
    draft.set(write, isReplaceAll=True)
    read = work.add_node("ReadVariableAction", "read", variable=variable)
    work.add_pin(read, "result", "Integer")
    clear = work.add_node("ClearVariableAction", "clear", variable=variable)
    end = work.add_node("ActivityFinalNode")
    work.add_chain(work.add_node("InitialNode"), write, read, clear, end)
    rule = draft.add(write, "localPrecondition", "Constraint", "")
    draft.add_text(rule, "specification", f"{work.count.get('name')} > 0")
