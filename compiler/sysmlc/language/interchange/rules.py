"""Rules of reading KerML and SysML v2 from interchange files."""

from sysmlc.diagnostics import Severity, rule

UNKNOWN_METACLASS = rule(
    "SM163",
    "unknown-metaclass",
    Severity.WARNING,
    "'{kind}' is no metaclass of SysML 2.0: it is left out with all that it owns",
    why="The file was written for another version of the language, or by hand. What stands there "
    "cannot be understood, so outputs do not reflect it.",
    help="export the model again for SysML 2.0 (https://www.omg.org/spec/SysML/20250201)",
    wrong="<ownedRelatedElement xsi:type='sysml:PartDef' declaredName='Robot'/>",
    right="<ownedRelatedElement xsi:type='sysml:PartDefinition' declaredName='Robot'/>",
)
UNKNOWN_FEATURE = rule(
    "SM164",
    "unknown-feature",
    Severity.WARNING,
    "'{feature}' of '{element}' is no feature of a {kind}: nothing is read from it",
    why="The metaclass has no such feature in SysML 2.0: most likely a script misspelt it, or the "
    "file was written for another version of the language.",
    help="look whether the name is spelt as the metamodel does",
    wrong="<ownedRelatedElement xsi:type='sysml:PartDefinition' isAbstrct='true'/>",
    right="<ownedRelatedElement xsi:type='sysml:PartDefinition' isAbstract='true'/>",
)
DANGLING = rule(
    "SM165",
    "dangling-interchange-reference",
    Severity.ERROR,
    "'{feature}' of '{element}' leads to the id '{id}', which {file} does not have",
    why="The element was deleted, or the files come from two different exports. What depends on "
    "the reference is missing from the outputs.",
    help="export all files of the model again, together",
    wrong="<ownedRelationship xsi:type='sysml:FeatureTyping' type='gone'/>",
    right="<ownedRelationship xsi:type='sysml:FeatureTyping' type='robot'/>",
)
MALFORMED = rule(
    "SM750",
    "malformed-interchange",
    Severity.ERROR,
    "'{file}' cannot be read: {problem}",
    why="The file is damaged, or it asks for something that safe reading refuses. Nothing of it "
    "is used, because half a model gives wrong outputs.",
    help="export the model again",
    wrong="<sysml:Namespace><ownedRelationship></sysml:Namespace>",
    right="<sysml:Namespace><ownedRelationship/></sysml:Namespace>",
)
REPEATED_ID = rule(
    "SM751",
    "repeated-interchange-id",
    Severity.ERROR,
    "the id '{id}' is used by two elements",
    why="A reference to it could mean either. Ids are unique in an interchange file.",
    help="export the model again, or give one of them another id",
    wrong="<ownedRelatedElement xmi:id='a'/><ownedRelatedElement xmi:id='a'/>",
    right="<ownedRelatedElement xmi:id='a'/><ownedRelatedElement xmi:id='b'/>",
)
BAD_VALUE = rule(
    "SM756",
    "bad-interchange-value",
    Severity.ERROR,
    "'{feature}' of '{element}' is '{value}', which is no {type}",
    why="The metamodel gives the feature another type, so the value cannot be meant.",
    help="write a value of the type that the metamodel says",
    wrong="<ownedRelatedElement xsi:type='sysml:PartDefinition' isAbstract='yes'/>",
    right="<ownedRelatedElement xsi:type='sysml:PartDefinition' isAbstract='true'/>",
)
NO_MODEL = rule(
    "SM757",
    "no-interchange-model",
    Severity.ERROR,
    "'{file}' holds no model of SysML 2.0: its root is '{root}'",
    why="The root of an interchange file is a sysml:Namespace, or xmi:XMI with one inside "
    "(KerML 1.0, 10.2). Anything else would be left out without a word.",
    help="look whether the file is what its name says",
    wrong="<catalogue/>",
    right='<sysml:Namespace xmlns:sysml="https://www.omg.org/spec/SysML/20250201"/>',
)
CHECKSUM = rule(
    "SM168",
    "wrong-checksum",
    Severity.ERROR,
    "'{file}' is not the file that project '{project}' was made with: its {algorithm} is {found},"
    " the project says {expected}",
    why="A project archive states a checksum of each of its files (KerML 1.0, 10.3) so that damage "
    "and later changes are noticed. What the file says may not be what was released.",
    help="get the archive again from where it came from, or pack it anew with its tool",
    wrong='"checksum": {"Robot.sysml": {"value": "00...", "algorithm": "SHA256"}}',
    right='"checksum": {"Robot.sysml": {"value": "9f86d081...", "algorithm": "SHA256"}}',
)
UNRESOLVED_USAGE = rule(
    "SM169",
    "unresolved-usage",
    Severity.WARNING,
    "project '{project}' uses '{resource}'{constraint}, {problem}",
    why="The elements of the used project are missing when its archive or folder is not given: "
    "names that lead to it will not be found.",
    help="give the archive or folder of the used project as a further input or as --library",
    wrong='"usage": [{"resource": "https://example.org/Missing.kpar"}]',
    right='"usage": [{"resource": "Robots.kpar", "versionConstraint": "1.0.0"}]',
)
BAD_PROJECT = rule(
    "SM752",
    "bad-project-information",
    Severity.ERROR,
    "'{file}' does not describe a project: {problem}",
    why="A project archive says in .project.json what it is and in .meta.json what its files are "
    "(KerML 1.0, 10.3). Without them its checksums and usages cannot be examined.",
    help="pack the archive anew with its tool",
    wrong='{"version": "1.0.0"}',
    right='{"name": "Robots", "version": "1.0.0", "usage": []}',
)
MISSING_FILE = rule(
    "SM753",
    "missing-project-file",
    Severity.ERROR,
    "project '{project}' names the file '{file}', which it does not have",
    why="The index and the checksums of .meta.json name the files of the project (KerML 1.0, "
    "10.3). A file is missing, so the model is not complete.",
    help="get the archive again, or pack it anew with its tool",
    wrong='"index": {"Robots": "Robtos.sysml"}',
    right='"index": {"Robots": "Robots.sysml"}',
)
UNLISTED_FILE = rule(
    "SM754",
    "unlisted-project-file",
    Severity.WARNING,
    "project '{project}' has no checksum for '{file}'",
    why="The project has checksums for its other files (KerML 1.0, 10.3): this one was added "
    "later, or its checksum was forgotten, so nobody can tell whether it is as it was released.",
    help="pack the archive anew with its tool",
    wrong='"checksum": {}',
    right='"checksum": {"Robots.sysml": {"value": "9f86d081...", "algorithm": "SHA256"}}',
)
UNKNOWN_ALGORITHM = rule(
    "SM755",
    "unknown-checksum-algorithm",
    Severity.WARNING,
    "the checksum of '{file}' is not examined: {algorithm} is not known here",
    why="The file could be damaged without anybody noticing.",
    help="pack the archive with SHA256",
    wrong='{"value": "...", "algorithm": "MD6"}',
    right='{"value": "...", "algorithm": "SHA256"}',
)
UNWRITTEN_REFERENCE = rule(
    "SM758",
    "unwritten-reference",
    Severity.WARNING,
    "'{name}' of '{element}' is not in the interchange file, because it leads nowhere",
    why="Interchange files refer by id, and an element that was not found has none. The "
    "relationship is left out with it.",
    help="resolve the name: the message about it says what was looked for",
    wrong="part robot : Robto;",
    right="part robot : Robot;",
)
UNWRITABLE_TEXT = rule(
    "SM759",
    "unwritable-text",
    Severity.WARNING,
    "the '{feature}' of '{element}' has characters that XML cannot have: they are replaced",
    why="XML 1.0 has no control characters besides tab and line ends, whatever way they are "
    "written.",
    help="leave the control characters out",
    wrong="package 'form\\ffeed';",
    right="package 'form feed';",
)
