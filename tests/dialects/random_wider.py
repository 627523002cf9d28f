"""What models hold beside structure and activities: interactions, templates, alternative texts."""

from lxml import etree

from dialects.papyrus import Element
from dialects.random_structure import Structure


class Wider:
    """Adds a random choice of such constructs, each valid by itself, to a structure."""

    def __init__(self, structure: Structure) -> None:
        self.structure = structure
        self.document = structure.document
        self.random = structure.random
        for make in (
            self._interaction,
            self._template,
            self._extension_point,
            self._collaboration,
            self._alternative_texts,
            self._protected_action,
            self._links,
            self._submachine,
            self._abroad,
        ):
            if structure.maybe():
                make()

    def _packaged(self, metaclass: str, name: str) -> Element:
        owner = self.random.choice(self.structure.packages)
        return self.document.add(owner, "packagedElement", metaclass, name)

    # -- interactions --------------------------------------------------------------------------

    def _interaction(self) -> None:
        add, made = self.document.add, self._packaged("Interaction", "Feed")
        block = self.random.choice(self.structure.blocks).element
        roles = [
            add(made, "ownedAttribute", "Property", name, type=block) for name in ("gate", "belt")
        ]
        lines = [
            add(made, "lifeline", "Lifeline", str(role.get("name")), represents=role)
            for role in roles
        ]
        self._message(made, made, lines, "start", "")
        loop = add(made, "fragment", "CombinedFragment", "again", interactionOperator="loop")
        self.document.set(loop, covered=lines)
        operand = add(loop, "operand", "InteractionOperand", "")
        guard = add(operand, "guard", "InteractionConstraint", "")
        self.document.opaque(guard, "specification", "n < 3", "OCL")
        add(guard, "maxint", "LiteralInteger", value="3")
        for number in range(self.random.randint(1, 3)):
            sort = self.random.choice(["asynchSignal", "reply", ""])
            self._message(made, operand, lines[::-1], f"step {number}", sort)
        self._execution(made, lines[0])

    def _message(
        self, interaction: Element, owner: Element, lines: list[Element], name: str, sort: str
    ) -> None:
        add = self.document.add
        message = add(interaction, "message", "Message", name)
        kind = "MessageOccurrenceSpecification"
        for feature, line in zip(("sendEvent", "receiveEvent"), lines, strict=True):
            one = add(owner, "fragment", kind, f"{name} {feature}", message=message)
            self.document.set(one, covered=[line])
            self.document.set(message, **{feature: one})
        if sort:
            self.document.set(message, messageSort=sort)

    def _execution(self, interaction: Element, line: Element) -> None:
        add = self.document.add
        ends = [
            add(interaction, "fragment", "ExecutionOccurrenceSpecification", name, covered=[line])
            for name in ("begin", "end")
        ]
        run = add(interaction, "fragment", "BehaviorExecutionSpecification", "run", covered=[line])
        self.document.set(run, start=ends[0], finish=ends[1])
        for end in ends:
            self.document.set(end, execution=run)

    # -- structure -----------------------------------------------------------------------------

    def _template(self) -> None:
        add, made, bound = (
            self.document.add,
            self._packaged("Class", "List"),
            self._packaged("Class", "Pallets"),
        )
        signature = add(made, "ownedTemplateSignature", "RedefinableTemplateSignature", "Of")
        parameter = add(signature, "ownedParameter", "ClassifierTemplateParameter", "")
        element = add(parameter, "ownedParameteredElement", "Class", "T")
        self.document.set(element, templateParameter=parameter)
        self.document.set(parameter, parameteredElement=element)
        self.document.set(signature, parameter=[parameter])
        binding = add(bound, "templateBinding", "TemplateBinding", "", signature=signature)
        self.document.set(binding, boundElement=bound)
        use = add(
            binding, "parameterSubstitution", "TemplateParameterSubstitution", "", formal=parameter
        )
        self.document.set(use, actual=self.structure.items[0])

    def _extension_point(self) -> None:
        add, base, more = (
            self.document.add,
            self._packaged("UseCase", "Run"),
            self._packaged("UseCase", "Cool"),
        )
        point = add(base, "extensionPoint", "ExtensionPoint", "hot")
        extend = add(more, "extend", "Extend", "", extendedCase=base)
        self.document.set(extend, extensionLocation=[point])

    def _collaboration(self) -> None:
        add, made = self.document.add, self._packaged("Collaboration", "Handover")
        block = self.random.choice(self.structure.blocks).element
        role = add(made, "ownedAttribute", "Property", "giver", type=block)
        self.document.set(made, collaborationRole=[role])
        add(block, "collaborationUse", "CollaborationUse", "handover", type=made)

    def _abroad(self) -> None:
        """Names and notes in other scripts, which a code page of Windows does not hold."""
        made = self._packaged("Class", "Förderer → 搬送 €")
        self.document.comment(made, "Länge ≤ 5 m\nund “schnell”")

    # -- behaviour -----------------------------------------------------------------------------

    def _alternative_texts(self) -> None:
        work = self._packaged("Activity", "Alternatives")
        action = self.document.add(work, "node", "OpaqueAction", "start motor")
        behaviour = self._packaged("OpaqueBehavior", "Measure")
        rule = self.document.add(behaviour, "ownedRule", "Constraint", "small")
        value = self.document.add(rule, "specification", "OpaqueExpression")
        for owner in (action, behaviour, value):
            for language in self.random.sample(["C++", "OCL", "English", "Java"], 2):
                etree.SubElement(owner, "language").text = language
            for body in ("motor = true", "the motor runs"):
                etree.SubElement(owner, "body").text = body

    def _protected_action(self) -> None:
        add, work = self.document.add, self._packaged("Activity", "Protected")
        risky = add(work, "node", "OpaqueAction", "risky")
        rescue = add(work, "node", "OpaqueAction", "rescue")
        caught = add(rescue, "inputValue", "InputPin", "caught")
        item = self.structure.items[0]
        handler = add(risky, "handler", "ExceptionHandler", "", handlerBody=rescue)
        self.document.set(handler, exceptionInput=caught, exceptionType=[item])
        region = add(work, "structuredNode", "ExpansionRegion", "all", mode="parallel")
        pins = [add(work, "node", "ExpansionNode", name, type=item) for name in ("in", "out")]
        self.document.set(region, inputElement=[pins[0]], outputElement=[pins[1]])
        self.document.set(pins[0], regionAsInput=region)
        self.document.set(pins[1], regionAsOutput=region)

    def _links(self) -> None:
        add, work = self.document.add, self._packaged("Activity", "Linked")
        link = self._packaged("Association", "holds")
        ends = [
            add(link, "ownedEnd", "Property", name, type=one.element, association=link)
            for name, one in zip(("holder", "held"), self.structure.blocks[:1] * 2, strict=True)
        ]
        self.document.set(link, memberEnd=ends)
        action = add(work, "node", "CreateLinkAction", "tie")
        for end in ends:
            pin = add(action, "inputValue", "InputPin", str(end.get("name")))
            add(action, "endData", "LinkEndCreationData", "", end=end, value=pin)

    def _submachine(self) -> None:
        add = self.document.add
        inner, outer = (
            self._packaged("StateMachine", "Inner"),
            self._packaged("StateMachine", "Outer"),
        )
        point = add(inner, "connectionPoint", "Pseudostate", "in", kind="entryPoint")
        inside = add(inner, "region", "Region", "Region1")
        state = add(inside, "subvertex", "State", "on")
        add(inside, "transition", "Transition", "", source=point, target=state)
        region = add(outer, "region", "Region", "Region1")
        whole = add(region, "subvertex", "State", "whole", submachine=inner)
        use = add(whole, "connection", "ConnectionPointReference", "in", entry=[point])
        first = add(region, "subvertex", "Pseudostate", "Initial")
        add(region, "transition", "Transition", "", source=first, target=use)
