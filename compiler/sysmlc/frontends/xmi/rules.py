"""Rules of reading XMI."""

from sysmlc.diagnostics import Severity, rule

MALFORMED = rule(
    "SM100",
    "malformed-file",
    Severity.ERROR,
    "'{file}' cannot be read: {problem}",
    why="The file is damaged, or it asks for something that safe reading refuses. Nothing of it "
    "is in the graph, because half a model gives wrong outputs.",
    help="open and save the model again in the modelling tool",
    wrong="<uml:Model><packagedElement></uml:Model>",
    right="<uml:Model><packagedElement/></uml:Model>",
)
NO_MODEL = rule(
    "SM110",
    "no-known-content",
    Severity.ERROR,
    "'{file}' looks like UML in XMI, but nothing in it is known to sysmlc",
    why="The file would otherwise be left out without a word.",
    help="check with which tool and version it was exported; UML 2 in XMI 2.1 and later is read",
    wrong='<xmi:XMI xmlns:xmi="http://www.omg.org/spec/XMI/20131001"><settings/></xmi:XMI>',
    right='<xmi:XMI xmlns:xmi="http://www.omg.org/spec/XMI/20131001"'
    ' xmlns:uml="http://www.omg.org/spec/UML/20131001"><uml:Model/></xmi:XMI>',
)
UNSUPPORTED = rule(
    "SM111",
    "unsupported-element",
    Severity.WARNING,
    "{count} of type '{type}' not read ({number} with all that they contain)",
    why="Its type is none of UML 2.5.1, or it stands where UML allows no such element; outputs do "
    "not reflect it. "
    "coverage.json counts such elements; --strict-input makes them errors.",
    wrong="<packagedElement xmi:type='uml:State'/>",
    right="<packagedElement xmi:type='uml:Class'/>",
)
REPEATED_ID = rule(
    "SM112",
    "repeated-id",
    Severity.ERROR,
    "the id '{id}' is used by two elements of '{file}'",
    why="A reference to it could mean either. Ids are unique in an XMI file.",
    help="give one of them another xmi:id, or save the model again",
    wrong="<packagedElement xmi:id='a'/><packagedElement xmi:id='a'/>",
    right="<packagedElement xmi:id='a'/><packagedElement xmi:id='b'/>",
)
MISSING_PART = rule(
    "SM119",
    "missing-part",
    Severity.WARNING,
    "'{owner}' contains '{href}', {problem}",
    why="Papyrus can keep parts of a model in files of their own. The model is incomplete without "
    "them: outputs do not show what such a file holds.",
    help="give the file as a further input; or load and save the whole model in the modelling tool",
    wrong='<packagedElement xmi:type="uml:Package" href="Deleted.uml#_robots"/>',
    right='<packagedElement xmi:type="uml:Package" href="Robots.uml#_robots"/>',
)
LONG_LIST = rule(
    "SM128",
    "long-list",
    Severity.ERROR,
    "'{feature}' lists {count} ids; those after the first {most} are left out",
    why="No model has so many references in one place: the file is damaged, or made to exhaust "
    "memory.",
    help="look whether the file is what you think",
    wrong="<edge source='_a _a _a ... (a million times)'/>",
    right="<edge source='_a'/>",
)
MANY_ATTRIBUTES = rule(
    "SM129",
    "many-attributes",
    Severity.ERROR,
    "'{element}' has {count} attributes; those after the first {most} are left out",
    why="No element of a model has so many: the file is damaged, or made to exhaust memory.",
    help="look whether the file is what you think",
    wrong="<packagedElement a1='' a2='' a3='' ... (ten thousand of them)/>",
    right="<packagedElement name='Gate'/>",
)
BAD_BOUND = rule(
    "SM117",
    "bad-bound",
    Severity.ERROR,
    "multiplicity {multiplicity} of '{element}' has a bound that is no natural number",
    why="A bound is a number from 0 on, * for the upper one, or an expression that gives such a "
    "number (UML 2.5.1 clause 7.5.3). What is written here says nothing of how many there are.",
    help="write a number, or * as upper bound",
    wrong="<upperValue xmi:type='uml:LiteralString' value='many'/>",
    right="<upperValue xmi:type='uml:LiteralUnlimitedNatural' value='*'/>",
)
STRAY_TEXT = rule(
    "SM123",
    "stray-text",
    Severity.WARNING,
    "'{element}' has a text '{feature}', which is no feature of UML",
    why="The graph keeps the text as an attribute of the element, but nothing is made of it.",
    help="look whether the name is spelt as UML does; else remove it",
    wrong="<ownedAttribute name='speed'><unit>mm/s</unit></ownedAttribute>",
    right="<ownedAttribute><name>speed</name></ownedAttribute>",
)
UNKNOWN_ATTRIBUTE = rule(
    "SM124",
    "unknown-attribute",
    Severity.WARNING,
    "attribute '{attribute}' of '{element}'{others} is known neither to UML nor to XMI",
    why="No metaclass of UML 2 has such a feature, so nothing is made of the attribute: most "
    "likely its name was misspelt by a script or by hand. What tools say in namespaces or "
    "extensions of their own is not meant.",
    help="look whether the name is spelt as UML does; else remove it",
    wrong="<packagedElement xmi:type='uml:Class' xmi:id='g' name='Gate' isAbstrct='true'/>",
    right="<packagedElement xmi:type='uml:Class' xmi:id='g' name='Gate' isAbstract='true'/>",
)
MISPLACED_ATTRIBUTE = rule(
    "SM154",
    "misplaced-attribute",
    Severity.WARNING,
    "attribute '{attribute}' of '{element}'{others} belongs to other elements of UML than "
    "{metaclass}",
    why="UML has a feature of this name, but not for this metaclass, so that the attribute says "
    "nothing: most likely the type of the element was changed, or the name is another one's.",
    help="look whether the type of the element is meant, and remove the attribute if it is",
    wrong="<ownedAttribute xmi:type='uml:Property' xmi:id='p' name='size' isAbstract='true'/>",
    right="<ownedAttribute xmi:type='uml:Property' xmi:id='p' name='size' isDerived='true'/>",
)
UNKNOWN_VALUE = rule(
    "SM126",
    "unknown-value",
    Severity.WARNING,
    "'{attribute}' of '{element}'{others} is '{value}', which is none of {known}",
    why="UML lists what the attribute may be, and this is not among it: most likely it was "
    "misspelt by a script or by hand. What is meant is not known, so that it counts as not said.",
    help="choose the value again in the modelling tool",
    wrong="<packagedElement xmi:type='uml:Class' xmi:id='g' name='Gate' isAbstract='yes'/>",
    right="<packagedElement xmi:type='uml:Class' xmi:id='g' name='Gate' isAbstract='true'/>",
)
UNKNOWN_TAG = rule(
    "SM125",
    "unknown-tag",
    Severity.WARNING,
    "tag '{tag}' of stereotype '{stereotype}' on '{element}'{others} is none of SysML",
    why="No stereotype of SysML 1.0 to 1.7 has a tag of this name. The graph keeps it, but nothing "
    "is made of it, and what was meant is missing: a flow property without direction, for "
    "instance, goes both ways.",
    help="look whether the name is spelt as SysML does; else keep the value in a stereotype of "
    "your own",
    wrong="<PortsAndFlows:FlowProperty base_Property='p' directon='in'/>",
    right="<PortsAndFlows:FlowProperty base_Property='p' direction='in'/>",
)
DANGLING_OPPOSITE = rule(
    "SM116",
    "dangling-opposite",
    Severity.WARNING,
    "'{feature}' of '{element}' names '{target}'{others} not exist",
    why="The feature says again what the other end of a relation says, or what ownership says, "
    "so nothing of the graph depends on it. But the file names something that is not there: "
    "most likely it was deleted by hand or lost in a merge.",
    help="look whether something is missing; else save the model again in the modelling tool",
    wrong="<node xmi:type='uml:MergeNode' xmi:id='m' incoming='deleted'/>",
    right="<node xmi:type='uml:MergeNode' xmi:id='m' incoming='a'/>\n"
    "<edge xmi:type='uml:ControlFlow' xmi:id='a' source='i' target='m'/>",
)
DANGLING_FEATURE = rule(
    "SM120",
    "dangling-feature",
    Severity.ERROR,
    "'{feature}' of '{element}' names '{target}'{others} not exist",
    why="Nothing else in the file says what the feature says, so that part of the meaning of the "
    "element is lost.",
    help="restore what it names in the modelling tool, or remove the reference",
    wrong="<node xmi:type='uml:ExpansionNode' xmi:id='n' regionAsInput='deleted'/>",
    right="<node xmi:type='uml:ExpansionNode' xmi:id='n' regionAsInput='r'/>\n"
    "<node xmi:type='uml:ExpansionRegion' xmi:id='r' inputElement='n'/>",
)
BASELESS = rule(
    "SM113",
    "stereotype-without-element",
    Severity.WARNING,
    "stereotype '{stereotype}' is applied {times} to nothing that is in the model",
    why="Tools leave such applications behind when the element was deleted, or when it is drawn "
    "only. They have no effect.",
    help="remove the application, or apply the stereotype again",
    wrong="<Blocks:Block base_Class='deleted'/>",
    right="<Blocks:Block base_Class='_a'/>",
)
APPROXIMATED = rule(
    "SM114",
    "approximated-element",
    Severity.INFO,
    "{count} of type '{type}' read without {lost}",
    why="The element is in the graph, but part of its meaning is not.",
    wrong="<weight xmi:type='uml:OpaqueExpression'><body>a</body><body>b</body></weight>",
    right="<weight xmi:type='uml:OpaqueExpression'><body>a</body></weight>",
)
LOST_TAG = rule(
    "SM118",
    "tag-names-missing-element",
    Severity.WARNING,
    "tag '{tag}' of stereotype '{stereotype}' names '{target}', which does not exist",
    why="The value is the id of an element that the file does not have: it was deleted, or it is "
    "in another file. What the stereotype says of it is lost.",
    help="choose the value again in the modelling tool, or remove it",
    wrong="<Plant:Cell base_Class='_a' robot='_Zk3cQPoREe2dJ8u5Yq1m4w'/>",
    right="<Plant:Cell base_Class='_a' robot='_b'/>",
)
BROKEN_SNAPSHOT = rule(
    "SM115",
    "broken-snapshot",
    Severity.WARNING,
    "the snapshot '{file}' of a used project cannot be read: {problem}",
    why="A project archive holds what its model takes from other projects in snapshots. Without "
    "one of them the model is read, but what it takes from there is known by name only.",
    help="open the project in the modelling tool with its used projects at hand, and save it",
    wrong='<xmi:XMI xmlns:uml="http://www.nomagic.com/magicdraw/UML/2.5.1"><uml:Package></xmi:XMI>',
    right='<xmi:XMI xmlns:uml="http://www.nomagic.com/magicdraw/UML/2.5.1"><uml:Package/></xmi:XMI>',
)

UNKNOWN_IN_LIBRARY = rule(
    "SM155",
    "unknown-library-attribute",
    Severity.WARNING,
    "attribute '{attribute}' of '{element}'{others}, taken from '{library}', is known neither to "
    "UML nor to MagicDraw",
    why="What a model takes from a used project is read like the model itself, and no metaclass "
    "of UML 2 has such a feature: most likely the snapshot was changed by a script or by hand.",
    help="open the project in the modelling tool with its used projects at hand, and save it",
    wrong='<packagedElement xsi:type="uml:Class" ID="r" name="Robot" isAbstrct="true"/>',
    right='<packagedElement xsi:type="uml:Class" ID="r" name="Robot" isAbstract="true"/>',
)
