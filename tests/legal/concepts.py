"""Topics beside blocks: requirements, use cases, instances, deployments, templates, profiles."""

from dialects.papyrus import Element
from legal.draft import Draft


def add_requirements(draft: Draft) -> None:
    """Add requirements, nested and not, with a relation of each kind."""
    requirements = [_add_requirement(draft, index) for index in range(3)]
    inner = draft.add(requirements[0], "nestedClassifier", "Class", draft.make_name("Inner"))
    tags = {"id": "R-9", "text": 'Shall <not> fail & "stop".'}
    draft.apply("Requirements:Requirement", inner, base_NamedElement=inner, **tags)
    test = draft.add_packaged(draft.choose("Activity", "Interaction", "StateMachine"), "Test")
    if "StateMachine" in str(test.attrib.values()):
        region = draft.add(test, "region", "Region", "Region1")
        first = draft.add(region, "subvertex", "Pseudostate", "first")
        state = draft.add(region, "subvertex", "State", draft.make_name("testing"))
        draft.add(region, "transition", "Transition", "", source=first, target=state)
    verdict = draft.add(test, "ownedParameter", "Parameter", "verdict", direction="return")
    href = "pathmap://SysML16_PROFILES/SysML.profile.uml#SysML.package_packagedElement_Requirements"
    draft.document.add_reference(
        verdict, "type", "Enumeration", href + ".enumeration_packagedElement_VerdictKind"
    )
    if "Activity" in str(test.attrib.values()):
        draft.add(test, "node", "ActivityParameterNode", "verdict", parameter=verdict)
    draft.apply("Requirements:TestCase", test)
    relate = [
        ("Requirements:Satisfy", draft.block, requirements[0]),
        ("Requirements:DeriveReqt", requirements[1], requirements[0]),
        ("Requirements:Verify", test, inner),
        ("Requirements:Refine", draft.add_packaged("UseCase", "Use"), requirements[1]),
        ("Requirements:Trace", requirements[2], requirements[1]),
        ("Allocations:Allocate", draft.signal, draft.block),
    ]
    for stereotype, client, supplier in relate:
        if draft.maybe(0.7):
            name = draft.make_name("relation") if draft.maybe() else ""
            owner = draft.random.choice(draft.packages)
            ends = {"client": [client], "supplier": [supplier]}
            relation = draft.add(owner, "packagedElement", "Abstraction", name, **ends)
            draft.apply(stereotype, relation)
    if draft.maybe():
        _add_copy(draft)


def _add_requirement(draft: Draft, index: int) -> Element:
    requirement = draft.add_packaged("Class", "Requirement")
    tags = {"id": f"R-{index}"} if draft.maybe(0.8) else {}
    if draft.maybe(0.8):
        tags["text"] = f"The machine shall hold {index} pallets.\nAlways."
    draft.apply("Requirements:Requirement", requirement, base_NamedElement=requirement, **tags)
    return requirement


def _add_copy(draft: Draft) -> None:
    """Add a copy of a requirement: the same text, another id."""
    master, slave = (draft.add_packaged("Class", word) for word in ("Master", "Slave"))
    for requirement, id_ in ((master, "M-1"), (slave, "M-2")):
        tags = {"id": id_, "text": "Shall be quiet."}
        draft.apply("Requirements:Requirement", requirement, base_NamedElement=requirement, **tags)
    copy = draft.add_packaged("Abstraction", "copy", client=[slave], supplier=[master])
    draft.apply("Requirements:Copy", copy)


def add_use_cases(draft: Draft) -> None:
    """Add use cases with actors, an inclusion, an extension with a condition, and subjects."""
    add = draft.add
    actor, expert = (draft.add_packaged("Actor", word) for word in ("Operator", "Expert"))
    add(expert, "generalization", "Generalization", general=actor)
    case, included, extending = (draft.add_packaged("UseCase", "Use") for _ in range(3))
    draft.set(case, subject=[draft.block])
    draft.set(draft.block, useCase=[case])
    owned = add(draft.block, "ownedUseCase", "UseCase", draft.make_name("Owned"))
    add(case, "include", "Include", "", addition=included)
    add(case, "include", "Include", "", addition=owned)
    point = add(case, "extensionPoint", "ExtensionPoint", draft.make_name("point"))
    extend = add(extending, "extend", "Extend", "", extendedCase=case, extensionLocation=[point])
    if draft.maybe():
        rule = add(extend, "condition", "Constraint", "")
        draft.add_text(rule, "specification", "the door is open", "English")
    association = draft.add_packaged("Association", "takes part")
    ends = [
        add(association, "ownedEnd", "Property", draft.make_name(""), type=type_)
        for type_ in (actor, case)
    ]
    for end in ends:
        draft.set(end, association=association)
    draft.set(association, memberEnd=ends)
    special = draft.add_packaged("UseCase", "Special")
    add(special, "generalization", "Generalization", general=case)


def add_instances(draft: Draft) -> None:
    """Add instances with slots of own and inherited features, nested ones, and a link."""
    add, general, special = draft.add, draft.add_block("General"), draft.add_block("Special")
    add(special, "generalization", "Generalization", general=general)
    number = draft.add_value(general, "number", "Integer")
    words = draft.add_value(special, "words", "String")
    draft.document.set_bounds(words, 0, "*")
    part = draft.add_part(special, draft.item)
    inner = draft.add_packaged("InstanceSpecification", "inner", classifier=[draft.item])
    outer = draft.add_packaged("InstanceSpecification", "outer", classifier=[special])
    values = {"LiteralInteger": (number, ("7",)), "LiteralString": (words, ("a", "b & c"))}
    for metaclass, (feature, texts) in values.items():
        slot = add(outer, "slot", "Slot", definingFeature=feature)
        for text in texts:
            add(slot, "value", metaclass, value=text)
    slot = add(outer, "slot", "Slot", definingFeature=part)
    add(slot, "value", "InstanceValue", instance=inner)
    anonymous = draft.random.choice(draft.packages)
    add(anonymous, "packagedElement", "InstanceSpecification", "", classifier=[draft.block])
    two = draft.add_packaged("InstanceSpecification", "two", classifier=[special, draft.block])
    add(two, "specification", "LiteralString", value="as a whole") if draft.maybe() else None
    association = draft.add_association(special, draft.add_part(special, draft.block), draft.block)
    link = draft.add_packaged("InstanceSpecification", "link", classifier=[association])
    ends = str(association.get("memberEnd")).split()
    for end_id, instance in zip(ends, (two, outer), strict=True):
        slot = add(link, "slot", "Slot", definingFeature=end_id)
        add(slot, "value", "InstanceValue", instance=instance)


def add_deployment(draft: Draft) -> None:
    """Add nodes, devices and environments with artifacts, a manifestation and deployments."""
    add = draft.add
    device = draft.add_packaged("Device", "Controller")
    environment = add(device, "nestedNode", "ExecutionEnvironment", draft.make_name("Runtime"))
    artifact = draft.add_packaged("Artifact", "Program", fileName="program.bin")
    nested = add(artifact, "nestedArtifact", "Artifact", draft.make_name("Part"))
    manifest = {"client": [artifact], "supplier": [draft.block], "utilizedElement": draft.block}
    add(artifact, "manifestation", "Manifestation", "", **manifest)
    specification = draft.add_packaged("DeploymentSpecification", "settings")
    for location, deployed in ((environment, artifact), (device, nested)):
        ends = {"client": [location], "supplier": [deployed], "deployedArtifact": [deployed]}
        deployment = add(location, "deployment", "Deployment", draft.make_name("deploy"), **ends)
        if deployed is artifact:
            draft.set(deployment, configuration=[specification])
            draft.set(specification, deployment=deployment)
    server = draft.add_packaged("Node", "Server")
    path = draft.add_packaged("CommunicationPath", "bus")
    ends = [
        add(path, "ownedEnd", "Property", draft.make_name("end"), type=node, association=path)
        for node in (device, server)
    ]
    draft.set(path, memberEnd=ends)
    component = draft.add_packaged("Component", "Driver")
    draft.set(component, isIndirectlyInstantiated=draft.maybe())
    ends = {"client": [draft.block], "supplier": [component]}
    realization = add(component, "realization", "ComponentRealization", "", **ends)
    draft.set(realization, realizingClassifier=[draft.block])
    inner = add(component, "packagedElement", "Class", draft.make_name("Inner"))
    draft.add_part(component, inner)


def add_templates(draft: Draft) -> None:
    """Add templates of classes, packages and operations, with defaults, and bound elements."""
    add, template = draft.add, draft.add_packaged("Class", "List")
    signature = add(template, "ownedTemplateSignature", "RedefinableTemplateSignature", "")
    formals = []
    for word in ("T", "U"):
        formal = add(signature, "ownedParameter", "ClassifierTemplateParameter", "")
        element = add(formal, "ownedParameteredElement", "Class", draft.make_name(word))
        draft.set(element, templateParameter=formal)
        draft.set(formal, parameteredElement=element)
        draft.add_part(template, element, "none")
        formals.append(formal)
    draft.set(signature, parameter=formals)
    draft.set(formals[1], default=draft.item)
    bound = draft.add_packaged("Class", "Pallets")
    binding = add(bound, "templateBinding", "TemplateBinding", "", signature=signature)
    substitution = {"formal": formals[0], "actual": draft.block}
    add(binding, "parameterSubstitution", "TemplateParameterSubstitution", "", **substitution)
    package = draft.add_packaged("Package", "Pattern")
    of_package = add(package, "ownedTemplateSignature", "TemplateSignature", "")
    formal = add(of_package, "ownedParameter", "TemplateParameter", "")
    number = add(formal, "ownedParameteredElement", "LiteralInteger", "n", value="3")
    draft.set(number, templateParameter=formal)
    draft.set(formal, parameteredElement=number)
    draft.set(of_package, parameter=[formal])


def add_dependencies(draft: Draft) -> None:
    """Add dependencies of all kinds, some between several elements."""
    other = draft.add_packaged("Class", "Other")
    interface = draft.add_packaged("Interface", "Contract")
    for metaclass in ("Dependency", "Abstraction", "Realization", "Usage"):
        relation = draft.add_packaged(metaclass, metaclass.lower())
        draft.set(relation, client=[draft.block, other], supplier=[interface, draft.item])
        if metaclass == "Abstraction":
            mapping = draft.add(relation, "mapping", "OpaqueExpression", "")
            draft.set(mapping, name="how")
        if draft.maybe(0.2):
            draft.document.add_comment(relation, "why")
    contract = {"client": [other], "supplier": [draft.block], "contract": draft.block}
    draft.add(other, "substitution", "Substitution", "", **contract)
    feature = draft.add_value(other, "value", "Real")
    package = draft.packages[-1]
    draft.add_packaged("Dependency", "on a feature", client=[feature], supplier=[package])


def add_profile(draft: Draft) -> None:
    """Add a profile with stereotypes of classes, and apply one with its tags."""
    add = draft.add
    profile = add(draft.document.model, "packagedElement", "Profile", "Plant")
    draft.set(profile, URI="http://example.org/Plant")
    imported = add(profile, "metamodelReference", "PackageImport")
    metamodel = "pathmap://UML_METAMODELS/UML.metamodel.uml#"
    draft.document.add_reference(imported, "importedPackage", "Model", metamodel + "_0")
    general, special = (
        add(profile, "packagedElement", "Stereotype", word) for word in ("Cell", "Robot")
    )
    draft.set(general, isAbstract=True)
    add(special, "generalization", "Generalization", general=general)
    base = add(general, "ownedAttribute", "Property", "base_Class")
    draft.document.add_reference(base, "type", "Class", metamodel + "Class")
    extension = add(profile, "packagedElement", "Extension", "E_Class_Cell")
    features = {"type": general, "aggregation": "composite", "association": extension}
    end = add(extension, "ownedEnd", "ExtensionEnd", "extension_Cell", **features)
    draft.set(base, association=extension)
    draft.set(extension, memberEnd=[base, end])
    axes = add(general, "ownedAttribute", "Property", "axes")
    draft.set_type(axes, "Integer")
    add(axes, "defaultValue", "LiteralInteger", value="6")
    maker = add(special, "ownedAttribute", "Property", "maker")
    draft.set_type(maker, "String")
    draft.document.set_bounds(maker, 0, "1")
    application = add(draft.document.model, "profileApplication", "ProfileApplication")
    draft.set(application, appliedProfile=profile)
    tags = draft.choose({}, {"axes": "4"}, {"axes": "7", "maker": "A & B"})
    robot = draft.add_block("Robot")
    draft.apply("Plant:Robot", robot, **tags)


def add_views(draft: Draft) -> None:
    """Add a viewpoint, a view that conforms to it, and comments with SysML's stereotypes."""
    viewpoint = draft.add_packaged("Class", "Safety")
    stakeholder = draft.add_packaged("Class", "Operator")
    draft.apply("ModelElements:Stakeholder", stakeholder)
    tags = {"purpose": "show what is dangerous", "stakeholder": [stakeholder]}
    draft.apply("ModelElements:Viewpoint", viewpoint, **tags)
    view = draft.add_packaged("Class", "Dangers")
    draft.apply("ModelElements:View", view)
    conform = draft.add(view, "generalization", "Generalization", general=viewpoint)
    draft.apply("ModelElements:Conform", conform)
    expose = draft.add_packaged("Dependency", "", client=[view], supplier=[draft.block])
    draft.apply("ModelElements:Expose", expose)
    for name in ("Problem", "Rationale"):
        draft.document.add_comment(view, f"a {name.lower()}")
        draft.apply(f"ModelElements:{name}", view.findall("ownedComment")[-1])
    group = draft.document.add(view, "ownedComment", "Comment", annotatedElement=[draft.block])
    draft.apply("ModelElements:ElementGroup", group, name="Dangerous")
