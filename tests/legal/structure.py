"""Topics of structure: packages, features, associations, generalisations, interfaces, instances."""

from dialects.papyrus import PRIMITIVES
from legal.draft import PRIMITIVE_TYPES, Draft

_LIBRARY = (
    "pathmap://SysML16_LIBRARIES/SysML-Standard-Library.uml#SysML.package_packagedElement_Libraries"
)
_VALUE_TYPES = f"{_LIBRARY}.package_packagedElement_PrimitiveValueTypes.dataType_packagedElement_"
_UNITS = f"{_LIBRARY}.package_packagedElement_UnitAndQuantityKind.class_packagedElement_"


def add_packages(draft: Draft) -> None:
    """Add imports of packages and elements, a merge, a nested model and comments."""
    outer = draft.add_packaged("Package", "Outer", URI="http://example.org/outer")
    inner = draft.add(outer, "packagedElement", "Package", draft.make_name("Inner"))
    other = draft.add_packaged(draft.choose("Package", "Model"), "Other")
    class_ = draft.add(inner, "packagedElement", "Class", draft.make_name("Hidden"))
    if draft.maybe():
        draft.set(class_, visibility=draft.choose("private", "public"))
    visibility = draft.choose({}, {"visibility": "private"})
    draft.add(other, "packageImport", "PackageImport", importedPackage=outer, **visibility)
    alias = draft.choose({}, {"alias": "Other name"})
    draft.add(other, "elementImport", "ElementImport", importedElement=draft.block, **alias)
    merged = draft.add_packaged("Package", "Merged")
    draft.add(outer, "packageMerge", "PackageMerge", mergedPackage=merged)
    draft.document.add_comment(inner, 'first line\nsecond <line> & "more"', class_, outer)
    draft.document.add_comment(class_, "")
    reference = draft.add(other, "packageImport", "PackageImport")
    href = PRIMITIVES + "_0"
    draft.document.add_reference(reference, "importedPackage", "Model", href)


def add_features(draft: Draft) -> None:
    """Add attributes with all kinds of types, bounds, aggregations and modifiers."""
    owner = draft.add_block("Features")
    for aggregation in ("composite", "shared", "none"):
        part = draft.add_part(owner, draft.item, aggregation)
        if draft.maybe():
            draft.set_bounds(part)
        if draft.maybe():
            draft.add_association(owner, part, draft.item)
    for flag in ("isStatic", "isReadOnly", "isDerived", "isLeaf", "isID"):
        if draft.maybe(0.4):
            value = draft.add_value(owner, "flagged", draft.random.choice(PRIMITIVE_TYPES))
            draft.set(value, **{flag: True})
    nested = draft.add_block("Nested", owner)
    draft.add_part(owner, nested)
    untyped = draft.add(owner, "ownedAttribute", "Property", draft.make_name("untyped"))
    draft.set(untyped, visibility=draft.choose("private", "protected", "package"))
    if draft.maybe():
        draft.add(owner, "ownedAttribute", "Property", type=draft.item)


def add_defaults(draft: Draft) -> None:
    """Add default values of all kinds of value specifications."""
    owner, add = draft.add_block("Defaults"), draft.add
    literals = {
        "LiteralReal": ("Real", "1.5E-3"),
        "LiteralInteger": ("Integer", "-7"),
        "LiteralBoolean": ("Boolean", "true"),
        "LiteralString": ("String", "two\nlines <&> 'quoted'"),
        "LiteralUnlimitedNatural": ("UnlimitedNatural", "*"),
        "LiteralNull": ("String", ""),
    }
    for metaclass, (primitive, text) in literals.items():
        for has_value in (True, False):
            value = draft.add_value(owner, "value", primitive)
            literal = add(value, "defaultValue", metaclass)
            if has_value and text:
                draft.set(literal, value=text)
            if draft.maybe(0.3):
                draft.set_type(literal, primitive)
            if metaclass == "LiteralNull":
                draft.document.set_bounds(value, 0, "1")
    number = draft.add_value(owner, "number", "Integer")
    sum_ = add(number, "defaultValue", "Expression", symbol="+")
    for text in ("1", "2"):
        add(sum_, "operand", "LiteralInteger", value=text)
    text_value = draft.add_value(owner, "text", "String")
    words = add(text_value, "defaultValue", "StringExpression", symbol="concat")
    add(words, "operand", "LiteralString", value="a")
    opaque = draft.add_value(owner, "opaque", "Real")
    text = draft.choose("1.5 * 2", "sqrt(4)")
    draft.add_text(opaque, "defaultValue", text, draft.choose("OCL", "C", ""))
    instance = draft.add_packaged("InstanceSpecification", "pallet", classifier=[draft.item])
    part = draft.add_part(owner, draft.item)
    add(part, "defaultValue", "InstanceValue", instance=instance, type=draft.item)


def add_associations(draft: Draft) -> None:
    """Add binary associations with each ownership of ends, one of three ends, and a class."""
    add, left, right = draft.add, draft.add_block("Left"), draft.add_block("Right")
    styles = {"both": 2, "one": 1, "neither": 0}
    for style, owned_by_classes in styles.items():
        association = draft.add_packaged(draft.choose("Association", "AssociationClass"), style)
        ends = []
        for index, (owner, type_) in enumerate(((left, right), (right, left))):
            name = draft.make_name("end") if draft.maybe(0.8) else ""
            if index < owned_by_classes:
                end = add(owner, "ownedAttribute", "Property", name, type=type_)
            else:
                end = add(association, "ownedEnd", "Property", name, type=type_)
            draft.set(end, association=association)
            if draft.maybe():
                draft.set_bounds(end)
            ends.append(end)
        draft.set(association, memberEnd=ends)
        if style == "neither" and draft.maybe():
            draft.set(association, navigableOwnedEnd=ends[:1])
        if draft.maybe():
            kind = draft.choose("composite", "shared")
            draft.set(ends[0], aggregation=kind)
            _limit_whole(draft, ends[1], kind)
        if draft.maybe(0.3):
            qualifier = add(ends[0], "qualifier", "Property", draft.make_name("key"))
            draft.set_type(qualifier, "String")
    ternary = draft.add_packaged("Association", "three")
    ends = [
        add(ternary, "ownedEnd", "Property", draft.make_name("end"), type=type_)
        for type_ in (left, right, draft.item)
    ]
    draft.set(ternary, memberEnd=ends)
    for end in ends:
        draft.set(end, association=ternary)
        draft.document.set_bounds(end, 0, "*")


def _limit_whole(draft: Draft, end, kind: str) -> None:
    """Make the opposite of a composite end optional: a part has at most one whole."""
    if kind == "composite":
        for bound in [*end.iterchildren("lowerValue", "upperValue")]:
            end.remove(bound)
        for flag in ("isOrdered", "isUnique"):
            end.attrib.pop(flag, None)
        if draft.maybe():
            draft.document.set_bounds(end, 0, "1")


def add_generalisations(draft: Draft) -> None:
    """Add redefinitions, subsets, a derived union, a diamond and a set of generalisations."""
    add = draft.add
    words = ("Top", "Left", "Right", "Bottom")
    top, left, right, bottom = (draft.add_block(word) for word in words)
    draft.set(top, isAbstract=True)
    generalizations = [
        add(special, "generalization", "Generalization", general=general)
        for special, general in ((left, top), (right, top), (bottom, left), (bottom, right))
    ]
    item = draft.add_block("Small pallet")
    add(item, "generalization", "Generalization", general=draft.item)
    many = draft.add_part(top, draft.item)
    draft.document.set_bounds(many, 0, "*")
    draft.set(many, isDerivedUnion=True, isDerived=True, isReadOnly=True)
    few = draft.add_part(left, item)
    draft.document.set_bounds(few, 0, draft.choose("2", "*"))
    draft.set(few, subsettedProperty=[many])
    plain = draft.add_part(top, draft.item, draft.choose("composite", "none"))
    name = draft.choose(plain.get("name"), draft.make_name("new"))
    new = add(right, "ownedAttribute", "Property", name, type=draft.choose(item, draft.item))
    draft.set(new, redefinedProperty=[plain])
    if plain.get("aggregation"):
        draft.set(new, aggregation="composite")
    value = draft.add_value(top, "speed", "Integer")
    narrow = add(bottom, "ownedAttribute", "Property", value.get("name"), redefinedProperty=[value])
    draft.set_type(narrow, "Integer")
    add(narrow, "defaultValue", "LiteralInteger", value="3")
    general = add(top, "ownedOperation", "Operation", draft.make_name("run"), isAbstract=True)
    special = add(left, "ownedOperation", "Operation", general.get("name"))
    draft.set(special, redefinedOperation=[general])
    set_ = draft.add_packaged("GeneralizationSet", "kinds", generalization=generalizations[:2])
    draft.set(set_, isCovering=draft.maybe(), isDisjoint=False)
    draft.set(generalizations[0], generalizationSet=[set_])
    draft.set(generalizations[1], generalizationSet=[set_])
    if draft.maybe():
        draft.set(item, isFinalSpecialization=True)


def add_value_types(draft: Draft) -> None:
    """Add value types with units and structure, primitive types, and enumerations."""
    add = draft.add
    kind, unit = (draft.add_packaged("InstanceSpecification", word) for word in ("size", "m"))
    for instance, class_ in ((kind, "QuantityKind"), (unit, "Unit")):
        draft.document.add_reference(instance, "classifier", "Class", _UNITS + class_)
    length = draft.add_packaged("DataType", "Length")
    tags = draft.choose({}, {"unit": unit}, {"unit": unit, "quantityKind": kind})
    draft.apply("Blocks:ValueType", length, **tags)
    general = add(length, "generalization", "Generalization")
    real = draft.choose(PRIMITIVES, _VALUE_TYPES) + "Real"
    draft.document.add_reference(general, "general", "DataType", real)
    special = draft.add_packaged("DataType", "Width")
    draft.apply("Blocks:ValueType", special)
    add(special, "generalization", "Generalization", general=length)
    point = draft.add_packaged("DataType", "Point")
    draft.apply("Blocks:ValueType", point)
    for name in ("x", "y"):
        coordinate = add(point, "ownedAttribute", "Property", name, type=length)
        if draft.maybe():
            add(coordinate, "defaultValue", "LiteralReal", value="0.5")
    area = add(point, "ownedOperation", "Operation", "area", isQuery=True)
    result = add(area, "ownedParameter", "Parameter", "", direction="return")
    draft.set_type(result, "Real")
    mode = draft.add_packaged("Enumeration", "Mode")
    literals = [
        add(mode, "ownedLiteral", "EnumerationLiteral", draft.make_name(word))
        for word in ("idle", "busy", "")
    ]
    add(literals[0], "specification", "LiteralInteger", value="4")
    more = draft.add_packaged("Enumeration", "More modes")
    add(more, "generalization", "Generalization", general=mode)
    add(more, "ownedLiteral", "EnumerationLiteral", draft.make_name("off"))
    draft.add_packaged("PrimitiveType", "Byte")
    owner = draft.add_block("Values")
    for type_ in (length, special, point, mode):
        value = add(owner, "ownedAttribute", "Property", draft.make_name("value"), type=type_)
        if type_ is mode:
            add(value, "defaultValue", "InstanceValue", instance=literals[1])
        elif draft.maybe(0.4):
            draft.set_bounds(value)


def add_operations(draft: Draft) -> None:
    """Add operations with parameters, conditions, exceptions, a redefinition and methods."""
    add, owner = draft.add, draft.add_block("Operations")
    level = draft.add_value(owner, "level", "Integer")
    operation = add(owner, "ownedOperation", "Operation", draft.make_name("fill"))
    for direction in ("in", "inout", "out", "return"):
        name = "" if direction == "return" else draft.make_name("p")
        parameter = add(operation, "ownedParameter", "Parameter", name, direction=direction)
        draft.set_type(parameter, draft.random.choice(PRIMITIVE_TYPES[:2]))
        if direction != "return" and draft.maybe(0.3):
            effects = {"in": ("read", "delete"), "out": ("create",), "inout": ("update",)}
            draft.set(parameter, effect=draft.choose(*effects[direction]))
        if direction == "in" and draft.maybe():
            add(parameter, "defaultValue", "LiteralInteger", value="2")
    draft.set(operation, raisedException=[draft.item])
    draft.set(operation, concurrency=draft.choose("guarded", "concurrent"))
    for feature, word in (("precondition", "> 0"), ("postcondition", "< 9")):
        rule = draft.add_rule(operation, f"{level.get('name')} {word}")
        draft.set(operation, **{feature: [rule]})
    query = add(owner, "ownedOperation", "Operation", draft.make_name("get"), isQuery=True)
    result = add(query, "ownedParameter", "Parameter", "", direction="return")
    draft.set_type(result, "Integer")
    body = draft.add_rule(query, f"result = {level.get('name')}")
    draft.set(query, bodyCondition=body)
    method = draft.add_behaviour(owner, "ownedBehavior", "return level", "Java")
    draft.set(method, specification=query)
    result = add(method, "ownedParameter", "Parameter", "", direction="return")
    draft.set_type(result, "Integer")
    draft.set(query, method=[method])
    function = draft.add_packaged("FunctionBehavior", "square")
    for direction in ("in", "return"):
        parameter = add(function, "ownedParameter", "Parameter", direction, direction=direction)
        draft.set_type(parameter, "Real")
    overload = add(owner, "ownedOperation", "Operation", operation.get("name"))
    draft.set(overload, isStatic=draft.maybe())
