"""What can be wrong with an AutomationML file."""

from sysmlc.diagnostics import Severity, rule

MISSING_CLASS = rule(
    "SM130",
    "missing-class",
    Severity.ERROR,
    "{element} refers to the {family} '{path}', which does not exist",
    why="The library is there, but it has no such class. Class paths are looked up among classes "
    "of one kind: role classes for roles, system unit classes for internal elements.",
    help="correct the path, or add the class to its library",
    wrong='<InternalElement Name="sw" RefBaseSystemUnitPath="Gate Lib/Swich"/>',
    right='<InternalElement Name="sw" RefBaseSystemUnitPath="Gate Lib/Switch"/>',
)
MISSING_CLASS_LIBRARY = rule(
    "SM131",
    "missing-class-library",
    Severity.WARNING,
    "the library '{library}' is not in the file; {count} to classes of it",
    why="What the classes bring along is not known: no attributes, interfaces or parts.",
    help="give the file that holds it as a further input, or declare it as ExternalReference",
    wrong='<RoleClass Name="Gate" RefBaseClassPath="PlantRoles/Resource"/>',
    right='<RoleClass Name="Gate" RefBaseClassPath="Roles/Resource"/>\n'
    "with RoleClassLib 'Roles' in the file",
)
MISSING_FILE = rule(
    "SM132",
    "missing-external-file",
    Severity.WARNING,
    "the file '{file}' is not part of the compile unit; {count} to classes of it",
    why="What the classes bring along is not known: no attributes, interfaces or parts.",
    help="put the file where the ExternalReference says, or correct its path; a file outside "
    "of the folder of the model is read when it is a further input",
    wrong='<ExternalReference Path="libs/gone.aml" Alias="Roles"/>',
    right='<ExternalReference Path="libs/roles.aml" Alias="Roles"/>',
)
UNDECLARED_ALIAS = rule(
    "SM133",
    "undeclared-alias",
    Severity.ERROR,
    "{element} uses the alias '{alias}', which no ExternalReference declares",
    why="An alias names another file. Without its declaration nobody knows which.",
    help="declare it: <ExternalReference Path='...' Alias='{alias}'/>",
    wrong='<RoleClass Name="Gate" RefBaseClassPath="Base@Roles/Resource"/>',
    right='<ExternalReference Path="libs/roles.aml" Alias="Base"/>\n'
    '<RoleClass Name="Gate" RefBaseClassPath="Base@Roles/Resource"/>',
)
LIBRARY_FAULT = rule(
    "SM149",
    "fault-in-standard-library",
    Severity.WARNING,
    "{element} of the standard library '{library}' refers to '{path}', {problem}",
    why="The file holds a copy of a library of AutomationML that is not whole. The plant is read, "
    "but what the class should inherit is not known.",
    help="take the library anew from its publisher, with the references that it declares",
    wrong='<RoleClassLib Name="AutomationMLBaseRoleClassLib">\n'
    '<RoleClass Name="Port" RefBaseClassPath="Base@Interfaces/Port"/>',
    right='<ExternalReference Path="libs/base.aml" Alias="Base"/>\n'
    '<RoleClassLib Name="AutomationMLBaseRoleClassLib">\n'
    '<RoleClass Name="Port" RefBaseClassPath="Base@Interfaces/Port"/>',
)
CYCLE = rule(
    "SM134",
    "class-cycle",
    Severity.ERROR,
    "the class '{element}' specialises itself: {cycle}",
    why="What it inherits has no end. The reference that closes the circle is left out.",
    help="remove one of the base class references",
    wrong='<RoleClass Name="A" RefBaseClassPath="Roles/B"/>'
    '<RoleClass Name="B" RefBaseClassPath="Roles/A"/>',
    right='<RoleClass Name="A"/><RoleClass Name="B" RefBaseClassPath="Roles/A"/>',
)
DANGLING_LINK = rule(
    "SM135",
    "dangling-link",
    Severity.ERROR,
    "link '{element}': its side {side} says '{reference}', and {problem}",
    why="A link joins two interfaces. The connector is lost; what is known of it becomes a "
    "dependency.",
    help="connect it again in the modelling tool",
    wrong='<InternalLink Name="l" RefPartnerSideA="6f1c:out" RefPartnerSideB="connection A0"/>',
    right='<InternalLink Name="l" RefPartnerSideA="6f1c:out" RefPartnerSideB="7a2d:in"/>',
)
OPEN_LINK = rule(
    "SM136",
    "open-link",
    Severity.INFO,
    "link '{element}' has no side {side}",
    why="CAEX 3.0 allows links that are not connected yet. There is no connector until they are.",
    wrong='<InternalLink Name="l" RefPartnerSideA="6f1c" RefPartnerSideB=""/>',
    right='<InternalLink Name="l" RefPartnerSideA="6f1c" RefPartnerSideB="7a2d"/>',
)
REPEATED_ID = rule(
    "SM137",
    "repeated-aml-id",
    Severity.WARNING,
    "the ID '{id}' of '{element}' is used by another element too",
    why="A link or mirror that names it could mean either; the first in the file is taken.",
    help="give one of them another ID",
    wrong='<InternalElement Name="a" ID="1"/><InternalElement Name="b" ID="1"/>',
    right='<InternalElement Name="a" ID="1"/><InternalElement Name="b" ID="2"/>',
)
MIRROR_WITHOUT_MASTER = rule(
    "SM138",
    "mirror-without-master",
    Severity.ERROR,
    "'{element}' is a mirror of '{reference}', which does not exist",
    why="A mirror is a second place of one element. Its master is gone.",
    help="restore the element, or remove its mirror",
    wrong='<InternalElement Name="m" RefBaseSystemUnitPath="1ac5c9b2-45f8-4a4c-8d6a-6d2f5f3b"/>',
    right='<InternalElement Name="a" ID="1ac5c9b2-45f8-4a4c-8d6a-6d2f5f3b"/>\n'
    '<InternalElement Name="m" RefBaseSystemUnitPath="1ac5c9b2-45f8-4a4c-8d6a-6d2f5f3b"/>',
)
MIRROR_CYCLE = rule(
    "SM143",
    "mirror-cycle",
    Severity.ERROR,
    "'{element}' is a mirror of itself, by way of '{reference}'",
    why="Mirrors may stand for mirrors, but in the end there must be an element.",
    help="let one of them refer to a system unit class, or to nothing",
    wrong='<InternalElement Name="a" ID="1" RefBaseSystemUnitPath="2"/>\n'
    '<InternalElement Name="b" ID="2" RefBaseSystemUnitPath="1"/>',
    right='<InternalElement Name="a" ID="1"/>\n'
    '<InternalElement Name="b" ID="2" RefBaseSystemUnitPath="1"/>',
)
UNSUPPORTED = rule(
    "SM139",
    "unsupported-caex-element",
    Severity.WARNING,
    "{count} '{tag}' not read",
    why="The element is not one that CAEX has at this place, or its meaning is not in the graph. "
    "coverage.json counts such elements.",
    wrong="<InternalElement><Conveyor/></InternalElement>",
    right='<InternalElement><Attribute Name="length"/></InternalElement>',
)
ELEMENT_ORDER = rule(
    "SM140",
    "element-order",
    Severity.WARNING,
    "'{tag}' of '{element}' stands after '{before}', against the schema of CAEX ({count})",
    why="Other tools may refuse the file. sysmlc reads it all the same.",
    help="write the file again with a tool that follows the schema",
    wrong='<InternalElement><RoleRequirements/><InternalLink Name="l"/></InternalElement>',
    right='<InternalElement><InternalLink Name="l"/><RoleRequirements/></InternalElement>',
)
NO_MODEL = rule(
    "SM141",
    "empty-caex-file",
    Severity.WARNING,
    "'{file}' holds no library and no hierarchy",
    why="Nothing can be made of it.",
    wrong="<CAEXFile FileName='a.aml'/>",
    right="<CAEXFile FileName='a.aml'><InstanceHierarchy Name='Plant'/></CAEXFile>",
)
ONLY_LIBRARIES = rule(
    "SM158",
    "only-caex-libraries",
    Severity.INFO,
    "'{file}' holds only libraries; without an instance hierarchy there is no plant to compile",
    why="Contracts, recipes and most diagrams describe the plant of an instance hierarchy. "
    "Libraries alone define what such a plant is made of.",
    help="name the file with the plant, too",
    wrong="<CAEXFile FileName='a.aml'><RoleClassLib Name='Roles'/></CAEXFile>",
    right="<CAEXFile FileName='a.aml'><RoleClassLib Name='Roles'/>"
    "<InstanceHierarchy Name='Plant'/></CAEXFile>",
)
MALFORMED = rule(
    "SM142",
    "malformed-caex-file",
    Severity.ERROR,
    "'{file}' cannot be read: {problem}",
    why="The file is damaged, or it asks for something that safe reading refuses. Nothing of it "
    "is in the graph, because half a plant gives wrong outputs.",
    help="export the plant again from the engineering tool",
    wrong="<CAEXFile><InstanceHierarchy></CAEXFile>",
    right="<CAEXFile><InstanceHierarchy/></CAEXFile>",
)
MAPPING = rule(
    "SM144",
    "mapping-of-nothing",
    Severity.ERROR,
    "a mapping object of '{element}' names '{feature}', which does not exist",
    why="It says which feature of the element is which one of its role; one of them is missing.",
    help="correct the name, or remove the mapping",
    wrong='<AttributeNameMapping SystemUnitAttributeName="len" RoleAttributeName="length"/>',
    right='<AttributeNameMapping SystemUnitAttributeName="l" RoleAttributeName="length"/>\n'
    "where the element has an attribute 'l' and the role one named 'length'",
)
LENIENT_ID = rule(
    "SM145",
    "inexact-id",
    Severity.INFO,
    "'{element}' says '{id}', the ID is '{meant}'",
    why="AutomationML compares IDs as they are written. Other tools do not find this one.",
    help="write the ID in the same way in both places",
    wrong='<InternalElement Name="a" ID="{1ac5c9b2}"/>\n'
    '<InternalLink Name="l" RefPartnerSideA="1AC5C9B2:out" RefPartnerSideB="7a2d:in"/>',
    right='<InternalElement Name="a" ID="{1ac5c9b2}"/>\n'
    '<InternalLink Name="l" RefPartnerSideA="{1ac5c9b2}:out" RefPartnerSideB="7a2d:in"/>',
)
NO_ID = rule(
    "SM146",
    "element-without-id",
    Severity.INFO,
    "'{element}' has no ID{more}",
    why="AutomationML gives every internal element an ID. Without one a renamed element is "
    "another element, for an overlay and for a comparison.",
    help="let the engineering tool give IDs",
    wrong='<InternalElement Name="a"/>',
    right='<InternalElement Name="a" ID="1ac5c9b2-45f8-4a4c-8d6a-6d2f5f3b8a01"/>',
)
UNKNOWN_UNIT = rule(
    "SM147",
    "unknown-unit",
    Severity.WARNING,
    "the unit '{unit}' of '{element}'{more} {problem}",
    why="CAEX takes any text as a unit. One that is not known has no quantity kind, so that "
    "nothing can be converted or compared.",
    help="write its symbol or UN/ECE code; symbols are those of ISO 80000, as 'm/s' or 'm^3/h'",
    wrong='<Attribute Name="length" AttributeDataType="xs:double" Unit="xs:anyUnit"/>',
    right='<Attribute Name="length" AttributeDataType="xs:double" Unit="mm"/>',
)
