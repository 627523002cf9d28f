"""Random extras of UML: interactions, templates, alternative texts, links, foreign scripts."""

from lxml import etree

from dialects.papyrus import Element
from dialects.random_structure import Structure


class UmlExtras:
    """Adds a random choice of these constructs, each valid by itself, to a structure."""

    def __init__(self, structure: Structure) -> None:
        self.structure = structure
        self.document = structure.document
        self.random = structure.random
        self.add_packaged = structure.add_packaged
        for make in (
            self._add_interaction,
            self._add_template,
            self._add_extension_point,
            self._add_collaboration,
            self._add_alternative_texts,
            self._add_protected_action,
            self._add_links,
            self._add_submachine,
            self._add_foreign_names,
        ):
            if structure.maybe():
                make()

    # -- interactions --------------------------------------------------------------------------

    def _add_interaction(self) -> None:
        add, interaction = self.document.add, self.add_packaged("Interaction", "Feed")
        block = self.random.choice(self.structure.blocks).element
        roles = [
            add(interaction, "ownedAttribute", "Property", name, type=block)
            for name in ("gate", "belt")
        ]
        lines = [
            add(interaction, "lifeline", "Lifeline", str(role.get("name")), represents=role)
            for role in roles
        ]
        self._add_message(interaction, interaction, lines, "start", "")
        loop = add(interaction, "fragment", "CombinedFragment", "again", interactionOperator="loop")
        self.document.set(loop, covered=lines)
        operand = add(loop, "operand", "InteractionOperand", "")
        guard = add(operand, "guard", "InteractionConstraint", "")
        self.document.add_expression(guard, "specification", "n < 3", "OCL")
        add(guard, "maxint", "LiteralInteger", value="3")
        for number in range(self.random.randint(1, 3)):
            sort = self.random.choice(["asynchSignal", "reply", ""])
            self._add_message(interaction, operand, lines[::-1], f"step {number}", sort)
        self._add_execution(interaction, lines[0])

    def _add_message(
        self, interaction: Element, owner: Element, lines: list[Element], name: str, sort: str
    ) -> None:
        add = self.document.add
        message = add(interaction, "message", "Message", name)
        kind = "MessageOccurrenceSpecification"
        for feature, line in zip(("sendEvent", "receiveEvent"), lines, strict=True):
            occurrence = add(owner, "fragment", kind, f"{name} {feature}", message=message)
            self.document.set(occurrence, covered=[line])
            self.document.set(message, **{feature: occurrence})
        if sort:
            self.document.set(message, messageSort=sort)

    def _add_execution(self, interaction: Element, line: Element) -> None:
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

    def _add_template(self) -> None:
        add, template, bound = (
            self.document.add,
            self.add_packaged("Class", "List"),
            self.add_packaged("Class", "Pallets"),
        )
        signature = add(template, "ownedTemplateSignature", "RedefinableTemplateSignature", "Of")
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

    def _add_extension_point(self) -> None:
        add, base, extending = (
            self.document.add,
            self.add_packaged("UseCase", "Run"),
            self.add_packaged("UseCase", "Cool"),
        )
        point = add(base, "extensionPoint", "ExtensionPoint", "hot")
        extend = add(extending, "extend", "Extend", "", extendedCase=base)
        self.document.set(extend, extensionLocation=[point])

    def _add_collaboration(self) -> None:
        add, collaboration = self.document.add, self.add_packaged("Collaboration", "Handover")
        block = self.random.choice(self.structure.blocks).element
        role = add(collaboration, "ownedAttribute", "Property", "giver", type=block)
        self.document.set(collaboration, collaborationRole=[role])
        add(block, "collaborationUse", "CollaborationUse", "handover", type=collaboration)

    def _add_foreign_names(self) -> None:
        """Add names and notes in other scripts, which no code page of Windows contains."""
        class_ = self.add_packaged("Class", "Förderer → 搬送 €")
        self.document.add_comment(class_, "Länge ≤ 5 m\nund “schnell”")

    # -- behaviour -----------------------------------------------------------------------------

    def _add_alternative_texts(self) -> None:
        work = self.add_packaged("Activity", "Alternatives")
        action = self.document.add(work, "node", "OpaqueAction", "start motor")
        behaviour = self.add_packaged("OpaqueBehavior", "Measure")
        rule = self.document.add(behaviour, "ownedRule", "Constraint", "small")
        value = self.document.add(rule, "specification", "OpaqueExpression")
        for owner in (action, behaviour, value):
            for language in self.random.sample(["C++", "OCL", "English", "Java"], 2):
                etree.SubElement(owner, "language").text = language
            for body in ("motor = true", "the motor runs"):
                etree.SubElement(owner, "body").text = body

    def _add_protected_action(self) -> None:
        add, work = self.document.add, self.add_packaged("Activity", "Protected")
        risky = add(work, "node", "OpaqueAction", "risky")
        rescue = add(work, "node", "OpaqueAction", "rescue")
        exception = add(rescue, "inputValue", "InputPin", "caught")
        item = self.structure.items[0]
        handler = add(risky, "handler", "ExceptionHandler", "", handlerBody=rescue)
        self.document.set(handler, exceptionInput=exception, exceptionType=[item])
        region = add(work, "structuredNode", "ExpansionRegion", "all", mode="parallel")
        pins = [add(work, "node", "ExpansionNode", name, type=item) for name in ("in", "out")]
        self.document.set(region, inputElement=[pins[0]], outputElement=[pins[1]])
        self.document.set(pins[0], regionAsInput=region)
        self.document.set(pins[1], regionAsOutput=region)

    def _add_links(self) -> None:
        add, work = self.document.add, self.add_packaged("Activity", "Linked")
        link = self.add_packaged("Association", "holds")
        ends = [
            add(link, "ownedEnd", "Property", name, type=block.element, association=link)
            for name, block in zip(("holder", "held"), self.structure.blocks[:1] * 2, strict=True)
        ]
        self.document.set(link, memberEnd=ends)
        action = add(work, "node", "CreateLinkAction", "tie")
        for end in ends:
            pin = add(action, "inputValue", "InputPin", str(end.get("name")))
            add(action, "endData", "LinkEndCreationData", "", end=end, value=pin)

    def _add_submachine(self) -> None:
        add = self.document.add
        inner, outer = (
            self.add_packaged("StateMachine", "Inner"),
            self.add_packaged("StateMachine", "Outer"),
        )
        point = add(inner, "connectionPoint", "Pseudostate", "in", kind="entryPoint")
        inner_region = add(inner, "region", "Region", "Region1")
        state = add(inner_region, "subvertex", "State", "on")
        add(inner_region, "transition", "Transition", "", source=point, target=state)
        region = add(outer, "region", "Region", "Region1")
        whole = add(region, "subvertex", "State", "whole", submachine=inner)
        use = add(whole, "connection", "ConnectionPointReference", "in", entry=[point])
        first = add(region, "subvertex", "Pseudostate", "Initial")
        add(region, "transition", "Transition", "", source=first, target=use)
