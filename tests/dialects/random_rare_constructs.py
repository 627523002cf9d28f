"""Random rare constructs: instances, constraint blocks, structured nodes, histories."""

from dialects.papyrus import PRIMITIVES, Element, add_body
from dialects.random_structure import Structure


class RareConstructs:
    """Adds a random choice of rare constructs, each valid by itself, to a structure."""

    def __init__(self, structure: Structure) -> None:
        self.structure = structure
        self.document = structure.document
        self.random = structure.random
        self.add_packaged = structure.add_packaged
        for make in (
            self._add_instance,
            self._add_redefinition,
            self._add_constraint_block,
            self._add_interface,
            self._add_signal_content,
            self._add_use_cases,
            self._add_extension,
            self._add_collaboration,
            self._add_template,
            self._add_submachine,
            self._add_value_activity,
            self._add_structured_activity,
            self._add_interruptible_activity,
            self._add_rich_machine,
        ):
            if structure.maybe():
                make()

    def _set_primitive_type(self, owner: Element, name: str) -> None:
        self.document.add_reference(owner, "type", "PrimitiveType", PRIMITIVES + name)

    # -- structure -----------------------------------------------------------------------------

    def _add_instance(self) -> None:
        add, block = self.document.add, self.random.choice(self.structure.blocks)
        instance = self.add_packaged("InstanceSpecification", "unit 1")
        self.document.set(instance, classifier=[block.element])
        for feature in block.booleans:
            slot = add(instance, "slot", "Slot", definingFeature=feature)
            add(slot, "value", "LiteralBoolean", value="true")
        for feature, _, literals in block.enumerations:
            slot = add(instance, "slot", "Slot", definingFeature=feature)
            add(slot, "value", "InstanceValue", instance=literals[0])

    def _add_redefinition(self) -> None:
        add = self.document.add
        general, special = (
            self.add_packaged("Class", "General"),
            self.add_packaged("Class", "Special"),
        )
        for block in (general, special):
            self.document.apply("Blocks:Block", block)
        add(special, "generalization", "Generalization", general=general)
        item = self.structure.items[0]
        many = add(general, "ownedAttribute", "Property", "stock", type=item)
        self.document.set(many, aggregation="shared", isReadOnly=True)
        self.document.set_bounds(many, 0, "*")
        feature = self.random.choice(["redefinedProperty", "subsettedProperty"])
        few = add(special, "ownedAttribute", "Property", "few", type=item)
        self.document.set(few, **{feature: [many]})
        self.document.set_bounds(few, 1, "3")

    def _add_constraint_block(self) -> None:
        add = self.document.add
        law, user = self.add_packaged("Class", "Law"), self.add_packaged("Class", "Plant")
        self.document.apply("ConstraintBlocks:ConstraintBlock", law)
        self.document.apply("Blocks:Block", user)
        parameter = add(law, "ownedAttribute", "Property", "x")
        value = add(user, "ownedAttribute", "Property", "speed")
        for attribute in (parameter, value):
            self._set_primitive_type(attribute, "Real")
        rule = add(law, "ownedRule", "Constraint", "small", constrainedElement=[parameter])
        self.document.add_expression(rule, "specification", "x < 3.5", "OCL")
        use = add(user, "ownedAttribute", "Property", "law", type=law, aggregation="composite")
        bond = add(user, "ownedConnector", "Connector", "bond")
        self.document.apply("Blocks:BindingConnector", bond)
        add(bond, "end", "ConnectorEnd", role=value)
        far = add(bond, "end", "ConnectorEnd", role=parameter)
        self.document.apply("Blocks:NestedConnectorEnd", far, propertyPath=[use])

    def _add_interface(self) -> None:
        interface = self.add_packaged("Interface", "Startable")
        self.document.add(interface, "ownedOperation", "Operation", "start", isAbstract=True)
        block = self.random.choice(self.structure.blocks).element
        self.document.add(
            block, "interfaceRealization", "InterfaceRealization", contract=interface,
            client=[block], supplier=[interface],
        )  # fmt: skip

    def _add_signal_content(self) -> None:
        signal = self.random.choice(self.structure.signals)
        attribute = self.document.add(signal, "ownedAttribute", "Property", "payload")
        self._set_primitive_type(attribute, "String")
        block = self.random.choice(self.structure.blocks).element
        self.document.add(
            block, "ownedReception", "Reception", signal.get("name", ""), signal=signal
        )

    def _add_use_cases(self) -> None:
        actor, case = (
            self.add_packaged("Actor", "Operator"),
            self.add_packaged("UseCase", "Produce"),
        )
        included = self.add_packaged("UseCase", "Set up")
        self.document.add(case, "include", "Include", "", addition=included)
        self.document.set(case, subject=[self.random.choice(self.structure.blocks).element])
        link = self.add_packaged("Association", "operates")
        ends = [
            self.document.add(
                link, "ownedEnd", "Property", f"end{i}", type=participant, association=link
            )
            for i, participant in enumerate((actor, case))
        ]
        self.document.set(link, memberEnd=ends)

    def _add_extension(self) -> None:
        add = self.document.add
        base, extending = (
            self.add_packaged("UseCase", "Run"),
            self.add_packaged("UseCase", "Refill"),
        )
        point = add(base, "extensionPoint", "ExtensionPoint", "low")
        extend = add(extending, "extend", "Extend", extendedCase=base, extensionLocation=[point])
        if self.structure.maybe():
            rule = add(extend, "condition", "Constraint")
            self.document.add_expression(rule, "specification", "level < 3", "OCL")

    def _add_collaboration(self) -> None:
        add, block = self.document.add, self.random.choice(self.structure.blocks)
        collaboration = self.add_packaged("Collaboration", "Feeding")
        role = add(collaboration, "ownedAttribute", "Property", "feeder", type=block.element)
        self.document.set(collaboration, collaborationRole=[role])
        user = self.add_packaged("Class", "Cell")
        part = add(user, "ownedAttribute", "Property", "gate", type=block.element)
        use = add(user, "collaborationUse", "CollaborationUse", "feeding", type=collaboration)
        add(use, "roleBinding", "Dependency", client=[role], supplier=[part])

    def _add_template(self) -> None:
        add = self.document.add
        template, bound = (
            self.add_packaged("Class", "Stack"),
            self.add_packaged("Class", "Pallets"),
        )
        signature = add(template, "ownedTemplateSignature", "RedefinableTemplateSignature", "sig")
        formal = add(signature, "ownedParameter", "ClassifierTemplateParameter")
        item = add(formal, "ownedParameteredElement", "Class", "T")
        self.document.set(formal, parameteredElement=item)
        self.document.set(signature, parameter=[formal])
        add(template, "ownedAttribute", "Property", "top", type=item)
        binding = add(bound, "templateBinding", "TemplateBinding", signature=signature)
        substitution = add(binding, "parameterSubstitution", "TemplateParameterSubstitution")
        actual = self.structure.items[0]
        self.document.set(substitution, formal=formal, actual=actual)

    def _add_submachine(self) -> None:
        add = self.document.add
        inner, outer = (
            self.add_packaged("StateMachine", "Inner"),
            self.add_packaged("StateMachine", "Use"),
        )
        entry = add(inner, "connectionPoint", "Pseudostate", "go in", kind="entryPoint")
        region = add(outer, "region", "Region", "Region1")
        state = add(region, "subvertex", "State", "nested", submachine=inner)
        point = add(state, "connection", "ConnectionPointReference", "at", entry=[entry])
        start = add(region, "subvertex", "Pseudostate", "Initial")
        add(region, "transition", "Transition", "", source=start, target=point)

    # -- activities ----------------------------------------------------------------------------

    def _add_node(self, owner: Element, metaclass: str, name: str, **features: Element) -> Element:
        return self.document.add(owner, "node", metaclass, name, **features)

    def _add_flow(self, owner: Element, kind: str, source: Element, target: Element) -> Element:
        flow = self.document.add(owner, "edge", kind, source=source, target=target)
        if self.structure.maybe(0.3):
            self.document.add(flow, "guard", "LiteralBoolean", value="true")
            self.document.add(flow, "weight", "LiteralInteger", value="1")
        return flow

    def _add_value_activity(self) -> None:
        """Add an activity that reads, writes and compares a property, as fUML does."""
        add, work = self.document.add, self.add_packaged("Activity", "Values")
        holder = self.add_packaged("Class", "Holder")
        level = add(holder, "ownedAttribute", "Property", "level")
        self._set_primitive_type(level, "Integer")
        self_ = self._add_node(work, "ReadSelfAction", "this")
        this = add(self_, "result", "OutputPin", "this", type=holder)
        read = self._add_node(work, "ReadStructuralFeatureAction", "read", structuralFeature=level)
        object_ = add(read, "object", "InputPin", "object", type=holder)
        result = add(read, "result", "OutputPin", "level")
        self._set_primitive_type(result, "Integer")
        decision = self._add_node(work, "DecisionNode", "how much?")
        self._add_flow(work, "ObjectFlow", this, object_)
        self._add_flow(work, "ObjectFlow", result, decision)
        for number in ("0", "7"):
            store = self._add_node(work, "DataStoreNode", f"is {number}")
            edge = add(work, "edge", "ObjectFlow", source=decision, target=store)
            guard = add(edge, "guard", "LiteralInteger")
            if number != "0":
                self.document.set(guard, value=number)
        self._add_writing_action(work, holder, level)

    def _add_writing_action(self, work: Element, holder: Element, level: Element) -> None:
        add = self.document.add
        value = self._add_node(work, "ValueSpecificationAction", "five")
        add(value, "value", "LiteralInteger", value="5")
        five = add(value, "result", "OutputPin", "five")
        write = self._add_node(
            work, "AddStructuralFeatureValueAction", "write", structuralFeature=level
        )
        self.document.set(write, isReplaceAll=True)
        add(write, "object", "InputPin", "object", type=holder)
        pin = add(write, "value", "InputPin", "value")
        self._add_flow(work, "ObjectFlow", five, pin)

    def _add_structured_activity(self) -> None:
        """Add an activity with a loop and a conditional, whose parts are lists of references."""
        add, work = self.document.add, self.add_packaged("Activity", "Nested")
        start, end = (
            self._add_node(work, "InitialNode", "start"),
            self._add_node(work, "ActivityFinalNode", "end"),
        )
        loop = add(work, "structuredNode", "LoopNode", "loop", isTestedFirst=True)
        test = add(loop, "node", "ValueSpecificationAction", "go on")
        add(test, "value", "LiteralBoolean")
        decider = add(test, "result", "OutputPin", "go on")
        body = add(loop, "node", "OpaqueAction", "body")
        add_body(body, "n := n + 1", "KerML")
        self.document.set(loop, test=[test], bodyPart=[body], decider=decider)
        choice = add(work, "structuredNode", "ConditionalNode", "choice", isDeterminate=True)
        first = add(choice, "node", "OpaqueAction", "first")
        clause = add(choice, "clause", "Clause", body=[first])
        check = add(choice, "node", "ValueSpecificationAction", "check")
        add(check, "value", "LiteralBoolean", value="true")
        answer = add(check, "result", "OutputPin", "answer")
        self.document.set(clause, test=[check], decider=answer)
        for source, target in ((start, loop), (loop, choice), (choice, end)):
            self._add_flow(work, "ControlFlow", source, target)

    def _add_interruptible_activity(self) -> None:
        add, work = self.document.add, self.add_packaged("Activity", "Watched")
        called = self.add_packaged("Activity", "Called")
        parameter = add(called, "ownedParameter", "Parameter", "given")
        add(called, "node", "ActivityParameterNode", "given", parameter=parameter)
        start, end = (
            self._add_node(work, "InitialNode", "start"),
            self._add_node(work, "ActivityFinalNode", "end"),
        )
        call = self._add_node(work, "CallBehaviorAction", "call", behavior=called)
        add(call, "argument", "InputPin", "given")
        wait = self._add_node(work, "AcceptEventAction", "wait")
        event = self.add_packaged("SignalEvent", "")
        self.document.set(event, signal=self.random.choice(self.structure.signals))
        add(wait, "trigger", "Trigger", "stop", event=event)
        self._add_flow(work, "ControlFlow", start, call)
        self._add_flow(work, "ControlFlow", call, end)
        leaving = self._add_flow(work, "ControlFlow", wait, end)
        region = add(work, "group", "InterruptibleActivityRegion", "watched", node=[call, wait])
        self.document.set(region, interruptingEdge=[leaving])
        self.document.set(leaving, interrupts=region)
        for node in (call, wait):
            self.document.set(node, inInterruptibleRegion=[region])

    # -- state machines ------------------------------------------------------------------------

    def _add_rich_machine(self) -> None:
        add, machine = self.document.add, self.add_packaged("StateMachine", "Rich")
        region = add(machine, "region", "Region", "Region1")
        kinds = ("", "choice", "junction", "shallowHistory", "deepHistory", "terminate")
        pseudo = [self._add_pseudostate(region, kind) for kind in kinds]
        both = add(region, "subvertex", "State", "both")
        for index in range(2):
            inner = add(both, "region", "Region", f"Side{index}")
            begin = add(inner, "subvertex", "Pseudostate", "Initial")
            rest = add(inner, "subvertex", "State", f"rest{index}")
            add(inner, "transition", "Transition", "", source=begin, target=rest)
        add_body(add(both, "doActivity", "OpaqueBehavior", "hum"), "hum()", "KerML")
        for source, target in zip(pseudo[:2], [pseudo[1], both], strict=True):
            add(region, "transition", "Transition", "", source=source, target=target)
        self._add_transition(region, both, both, "internal", self._add_change_event())
        self._add_transition(region, both, pseudo[-1], "", self._add_call_event())

    def _add_pseudostate(self, region: Element, kind: str) -> Element:
        pseudostate = self.document.add(region, "subvertex", "Pseudostate", kind or "Initial")
        if kind:
            self.document.set(pseudostate, kind=kind)
        return pseudostate

    def _add_transition(
        self, region: Element, source: Element, target: Element, kind: str, event: Element
    ) -> None:
        transition = self.document.add(
            region, "transition", "Transition", source=source, target=target
        )
        if kind:
            self.document.set(transition, kind=kind)
        self.document.add(transition, "trigger", "Trigger", "", event=event)

    def _add_change_event(self) -> Element:
        event = self.add_packaged("ChangeEvent", "when hot")
        self.document.add_expression(event, "changeExpression", "temperature > 90", "OCL")
        return event

    def _add_call_event(self) -> Element:
        owner = self.add_packaged("Class", "Callee")
        operation = self.document.add(owner, "ownedOperation", "Operation", "quit")
        event = self.add_packaged("CallEvent", "quit called")
        self.document.set(event, operation=operation)
        return event
