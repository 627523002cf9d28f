"""What real models hold now and then: instances, constraint blocks, structured nodes, histories."""

from dialects.papyrus import PRIMITIVES, Element, say
from dialects.random_structure import Structure


class Rarities:
    """Adds a random choice of rare constructs, each valid by itself, to a structure."""

    def __init__(self, structure: Structure) -> None:
        self.structure = structure
        self.document = structure.document
        self.random = structure.random
        for make in (
            self._instance,
            self._redefinition,
            self._constraint_block,
            self._interface,
            self._signal_content,
            self._use_case,
            self._extension,
            self._collaboration,
            self._template,
            self._submachine,
            self._value_activity,
            self._structured_activity,
            self._interruptible_activity,
            self._rich_machine,
        ):
            if structure.maybe():
                make()

    def _packaged(self, metaclass: str, name: str) -> Element:
        owner = self.random.choice(self.structure.packages)
        return self.document.add(owner, "packagedElement", metaclass, name)

    def _primitive(self, owner: Element, name: str) -> None:
        self.document.refer(owner, "type", "PrimitiveType", PRIMITIVES + name)

    # -- structure -----------------------------------------------------------------------------

    def _instance(self) -> None:
        add, block = self.document.add, self.random.choice(self.structure.blocks)
        made = self._packaged("InstanceSpecification", "unit 1")
        self.document.set(made, classifier=[block.element])
        for feature in block.booleans:
            slot = add(made, "slot", "Slot", definingFeature=feature)
            add(slot, "value", "LiteralBoolean", value="true")
        for feature, _, literals in block.enumerated:
            slot = add(made, "slot", "Slot", definingFeature=feature)
            add(slot, "value", "InstanceValue", instance=literals[0])

    def _redefinition(self) -> None:
        add = self.document.add
        general, special = self._packaged("Class", "General"), self._packaged("Class", "Special")
        for one in (general, special):
            self.document.apply("Blocks:Block", one)
        add(special, "generalization", "Generalization", general=general)
        item = self.structure.items[0]
        many = add(general, "ownedAttribute", "Property", "stock", type=item)
        self.document.set(many, aggregation="shared", isReadOnly=True)
        self.document.multiplicity(many, 0, "*")
        feature = self.random.choice(["redefinedProperty", "subsettedProperty"])
        few = add(special, "ownedAttribute", "Property", "few", type=item)
        self.document.set(few, **{feature: [many]})
        self.document.multiplicity(few, 1, "3")

    def _constraint_block(self) -> None:
        add = self.document.add
        law, user = self._packaged("Class", "Law"), self._packaged("Class", "Plant")
        self.document.apply("ConstraintBlocks:ConstraintBlock", law)
        self.document.apply("Blocks:Block", user)
        parameter = add(law, "ownedAttribute", "Property", "x")
        value = add(user, "ownedAttribute", "Property", "speed")
        for one in (parameter, value):
            self._primitive(one, "Real")
        rule = add(law, "ownedRule", "Constraint", "small", constrainedElement=[parameter])
        self.document.opaque(rule, "specification", "x < 3.5", "OCL")
        use = add(user, "ownedAttribute", "Property", "law", type=law, aggregation="composite")
        bond = add(user, "ownedConnector", "Connector", "bond")
        self.document.apply("Blocks:BindingConnector", bond)
        add(bond, "end", "ConnectorEnd", role=value)
        far = add(bond, "end", "ConnectorEnd", role=parameter)
        self.document.apply("Blocks:NestedConnectorEnd", far, propertyPath=[use])

    def _interface(self) -> None:
        made = self._packaged("Interface", "Startable")
        self.document.add(made, "ownedOperation", "Operation", "start", isAbstract=True)
        block = self.random.choice(self.structure.blocks).element
        self.document.add(
            block, "interfaceRealization", "InterfaceRealization", contract=made,
            client=[block], supplier=[made],
        )  # fmt: skip

    def _signal_content(self) -> None:
        signal = self.random.choice(self.structure.signals)
        attribute = self.document.add(signal, "ownedAttribute", "Property", "payload")
        self._primitive(attribute, "String")
        block = self.random.choice(self.structure.blocks).element
        self.document.add(
            block, "ownedReception", "Reception", signal.get("name", ""), signal=signal
        )

    def _use_case(self) -> None:
        actor, case = self._packaged("Actor", "Operator"), self._packaged("UseCase", "Produce")
        other = self._packaged("UseCase", "Set up")
        self.document.add(case, "include", "Include", "", addition=other)
        self.document.set(case, subject=[self.random.choice(self.structure.blocks).element])
        link = self._packaged("Association", "operates")
        ends = [
            self.document.add(link, "ownedEnd", "Property", f"end{i}", type=one, association=link)
            for i, one in enumerate((actor, case))
        ]
        self.document.set(link, memberEnd=ends)

    def _extension(self) -> None:
        add = self.document.add
        base, more = self._packaged("UseCase", "Run"), self._packaged("UseCase", "Refill")
        point = add(base, "extensionPoint", "ExtensionPoint", "low")
        extend = add(more, "extend", "Extend", extendedCase=base, extensionLocation=[point])
        if self.structure.maybe():
            rule = add(extend, "condition", "Constraint")
            self.document.opaque(rule, "specification", "level < 3", "OCL")

    def _collaboration(self) -> None:
        add, block = self.document.add, self.random.choice(self.structure.blocks)
        made = self._packaged("Collaboration", "Feeding")
        role = add(made, "ownedAttribute", "Property", "feeder", type=block.element)
        self.document.set(made, collaborationRole=[role])
        user = self._packaged("Class", "Cell")
        part = add(user, "ownedAttribute", "Property", "gate", type=block.element)
        use = add(user, "collaborationUse", "CollaborationUse", "feeding", type=made)
        add(use, "roleBinding", "Dependency", client=[role], supplier=[part])

    def _template(self) -> None:
        add = self.document.add
        made, bound = self._packaged("Class", "Stack"), self._packaged("Class", "Pallets")
        signature = add(made, "ownedTemplateSignature", "RedefinableTemplateSignature", "sig")
        formal = add(signature, "ownedParameter", "ClassifierTemplateParameter")
        item = add(formal, "ownedParameteredElement", "Class", "T")
        self.document.set(formal, parameteredElement=item)
        self.document.set(signature, parameter=[formal])
        add(made, "ownedAttribute", "Property", "top", type=item)
        binding = add(bound, "templateBinding", "TemplateBinding", signature=signature)
        substitution = add(binding, "parameterSubstitution", "TemplateParameterSubstitution")
        actual = self.structure.items[0]
        self.document.set(substitution, formal=formal, actual=actual)

    def _submachine(self) -> None:
        add = self.document.add
        inner, outer = (
            self._packaged("StateMachine", "Inner"),
            self._packaged("StateMachine", "Use"),
        )
        entry = add(inner, "connectionPoint", "Pseudostate", "go in", kind="entryPoint")
        region = add(outer, "region", "Region", "Region1")
        state = add(region, "subvertex", "State", "nested", submachine=inner)
        point = add(state, "connection", "ConnectionPointReference", "at", entry=[entry])
        start = add(region, "subvertex", "Pseudostate", "Initial")
        add(region, "transition", "Transition", "", source=start, target=point)

    # -- activities ----------------------------------------------------------------------------

    def _node(self, owner: Element, metaclass: str, name: str, **features: Element) -> Element:
        return self.document.add(owner, "node", metaclass, name, **features)

    def _flow(self, owner: Element, kind: str, source: Element, target: Element) -> Element:
        made = self.document.add(owner, "edge", kind, source=source, target=target)
        if self.structure.maybe(0.3):
            self.document.add(made, "guard", "LiteralBoolean", value="true")
            self.document.add(made, "weight", "LiteralInteger", value="1")
        return made

    def _value_activity(self) -> None:
        """Reads and writes a property, and decides on a value as fUML does."""
        add, work = self.document.add, self._packaged("Activity", "Values")
        holder = self._packaged("Class", "Holder")
        level = add(holder, "ownedAttribute", "Property", "level")
        self._primitive(level, "Integer")
        self_ = self._node(work, "ReadSelfAction", "this")
        this = add(self_, "result", "OutputPin", "this", type=holder)
        read = self._node(work, "ReadStructuralFeatureAction", "read", structuralFeature=level)
        object_ = add(read, "object", "InputPin", "object", type=holder)
        found = add(read, "result", "OutputPin", "level")
        self._primitive(found, "Integer")
        decision = self._node(work, "DecisionNode", "how much?")
        self._flow(work, "ObjectFlow", this, object_)
        self._flow(work, "ObjectFlow", found, decision)
        for number in ("0", "7"):
            store = self._node(work, "DataStoreNode", f"is {number}")
            edge = add(work, "edge", "ObjectFlow", source=decision, target=store)
            guard = add(edge, "guard", "LiteralInteger")
            if number != "0":
                self.document.set(guard, value=number)
        self._writer(work, holder, level)

    def _writer(self, work: Element, holder: Element, level: Element) -> None:
        add = self.document.add
        value = self._node(work, "ValueSpecificationAction", "five")
        add(value, "value", "LiteralInteger", value="5")
        five = add(value, "result", "OutputPin", "five")
        write = self._node(
            work, "AddStructuralFeatureValueAction", "write", structuralFeature=level
        )
        self.document.set(write, isReplaceAll=True)
        add(write, "object", "InputPin", "object", type=holder)
        pin = add(write, "value", "InputPin", "value")
        self._flow(work, "ObjectFlow", five, pin)

    def _structured_activity(self) -> None:
        """A loop and a conditional, with their parts as lists of references."""
        add, work = self.document.add, self._packaged("Activity", "Nested")
        start, end = (
            self._node(work, "InitialNode", "start"),
            self._node(work, "ActivityFinalNode", "end"),
        )
        loop = add(work, "structuredNode", "LoopNode", "loop", isTestedFirst=True)
        test = add(loop, "node", "ValueSpecificationAction", "go on")
        add(test, "value", "LiteralBoolean")
        decider = add(test, "result", "OutputPin", "go on")
        body = add(loop, "node", "OpaqueAction", "body")
        say(body, "n := n + 1", "KerML")
        self.document.set(loop, test=[test], bodyPart=[body], decider=decider)
        choice = add(work, "structuredNode", "ConditionalNode", "choice", isDeterminate=True)
        first = add(choice, "node", "OpaqueAction", "first")
        clause = add(choice, "clause", "Clause", body=[first])
        check = add(choice, "node", "ValueSpecificationAction", "check")
        add(check, "value", "LiteralBoolean", value="true")
        answer = add(check, "result", "OutputPin", "answer")
        self.document.set(clause, test=[check], decider=answer)
        for one, other in ((start, loop), (loop, choice), (choice, end)):
            self._flow(work, "ControlFlow", one, other)

    def _interruptible_activity(self) -> None:
        add, work = self.document.add, self._packaged("Activity", "Watched")
        called = self._packaged("Activity", "Called")
        parameter = add(called, "ownedParameter", "Parameter", "given")
        add(called, "node", "ActivityParameterNode", "given", parameter=parameter)
        start, end = (
            self._node(work, "InitialNode", "start"),
            self._node(work, "ActivityFinalNode", "end"),
        )
        call = self._node(work, "CallBehaviorAction", "call", behavior=called)
        add(call, "argument", "InputPin", "given")
        wait = self._node(work, "AcceptEventAction", "wait")
        event = self._packaged("SignalEvent", "")
        self.document.set(event, signal=self.random.choice(self.structure.signals))
        add(wait, "trigger", "Trigger", "stop", event=event)
        self._flow(work, "ControlFlow", start, call)
        self._flow(work, "ControlFlow", call, end)
        leaving = self._flow(work, "ControlFlow", wait, end)
        region = add(work, "group", "InterruptibleActivityRegion", "watched", node=[call, wait])
        self.document.set(region, interruptingEdge=[leaving])
        self.document.set(leaving, interrupts=region)
        for node in (call, wait):
            self.document.set(node, inInterruptibleRegion=[region])

    # -- state machines ------------------------------------------------------------------------

    def _rich_machine(self) -> None:
        add, machine = self.document.add, self._packaged("StateMachine", "Rich")
        region = add(machine, "region", "Region", "Region1")
        kinds = ("", "choice", "junction", "shallowHistory", "deepHistory", "terminate")
        pseudo = [self._pseudostate(region, kind) for kind in kinds]
        both = add(region, "subvertex", "State", "both")
        for index in range(2):
            inner = add(both, "region", "Region", f"Side{index}")
            begin = add(inner, "subvertex", "Pseudostate", "Initial")
            rest = add(inner, "subvertex", "State", f"rest{index}")
            add(inner, "transition", "Transition", "", source=begin, target=rest)
        say(add(both, "doActivity", "OpaqueBehavior", "hum"), "hum()", "KerML")
        for source, target in zip(pseudo[:2], [pseudo[1], both], strict=True):
            add(region, "transition", "Transition", "", source=source, target=target)
        self._transition(region, both, both, "internal", self._change_event())
        self._transition(region, both, pseudo[-1], "", self._call_event())

    def _pseudostate(self, region: Element, kind: str) -> Element:
        made = self.document.add(region, "subvertex", "Pseudostate", kind or "Initial")
        if kind:
            self.document.set(made, kind=kind)
        return made

    def _transition(
        self, region: Element, source: Element, target: Element, kind: str, event: Element
    ) -> None:
        made = self.document.add(region, "transition", "Transition", source=source, target=target)
        if kind:
            self.document.set(made, kind=kind)
        self.document.add(made, "trigger", "Trigger", "", event=event)

    def _change_event(self) -> Element:
        made = self._packaged("ChangeEvent", "when hot")
        self.document.opaque(made, "changeExpression", "temperature > 90", "OCL")
        return made

    def _call_event(self) -> Element:
        owner = self._packaged("Class", "Callee")
        operation = self.document.add(owner, "ownedOperation", "Operation", "quit")
        made = self._packaged("CallEvent", "quit called")
        self.document.set(made, operation=operation)
        return made
