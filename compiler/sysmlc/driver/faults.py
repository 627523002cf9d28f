"""Rules of the driver: what can go wrong around a compilation."""

from collections.abc import Iterable

from sysmlc.diagnostics import Diagnostic, Place, Severity, Sink, Subject, rule
from sysmlc.sources import Fault, SourceError

MISSING_FILE = rule(
    "SM170",
    "missing-file",
    Severity.ERROR,
    "there is no file or folder '{path}'",
    why="A model that is not there cannot be compiled; nothing is written.",
    help="look at the spelling; file names are relative to the working folder",
    wrong="sysmlc modle.uml",
    right="sysmlc model.uml",
)
NOT_THERE = rule(
    "SM148",
    "external-data-not-there",
    Severity.INFO,
    "the model refers to what is not there: '{file}'{more}",
    why="Geometry, logic and other documents are recorded but not read. A reference to a file "
    "that is not beside the model, or outside of its folder, may be out of date.",
    wrong='<Attribute Name="refURI"><Value>file:///geometry/gone.dae</Value></Attribute>',
    right='<Attribute Name="refURI"><Value>file:///geometry/gate.dae</Value></Attribute>',
)
UNOPENED = rule(
    "SM179",
    "unopened-file",
    Severity.ERROR,
    "'{path}' {reason}",
    why="The file is there but the operating system does not let us read it.",
    help="look at its permissions",
    wrong="chmod 000 plant.uml; sysmlc plant.uml",
    right="chmod 644 plant.uml; sysmlc plant.uml",
)
UNRECOGNISED = rule(
    "SM171",
    "unrecognised-content",
    Severity.ERROR,
    "'{path}' is not a model: {reason}",
    why="Front ends recognise their files by content, whatever the name ends in. "
    "A file that was named on the command line but is not understood would otherwise be "
    "silently left out.",
    help="expected XMI, AutomationML or SysML v2 (front ends: {frontends}); save a project of a "
    "modelling tool as XMI first",
    wrong="<html><body>a page that was saved instead of the model</body></html>",
    right='<xmi:XMI xmlns:xmi="http://www.omg.org/spec/XMI/20131001"'
    ' xmlns:uml="http://www.eclipse.org/uml2/5.0.0/UML">...</xmi:XMI>',
)
MALFORMED = rule(
    "SM172",
    "damaged-archive",
    Severity.ERROR,
    "'{path}' cannot be read: {reason}",
    why="The archive is damaged or holds no model. Nothing of it is used: a model that is "
    "silently cut short gives wrong outputs.",
    help="save the project again in the modelling tool",
    wrong="a .mdzip whose download was cut off",
    right="the whole .mdzip",
)
REFUSED = rule(
    "SM177",
    "refused-file",
    Severity.ERROR,
    "'{path}' is refused: {reason}",
    why="Models come from others. A DOCTYPE can hide entities that read files or grow without "
    "end, and an archive can name files outside its folder; no modelling tool writes either.",
    help="remove the DOCTYPE, or save the model again in the modelling tool",
    wrong='<!DOCTYPE x [<!ENTITY e SYSTEM "file:///etc/passwd">]><uml:Model/>',
    right="<uml:Model/>",
)
TOO_LARGE = rule(
    "SM178",
    "too-large",
    Severity.ERROR,
    "'{path}' exceeds a limit: {reason}",
    why="Files larger or deeper than any real model are refused before they exhaust memory.",
    help="split the model, or look whether the file is what you think",
    wrong="an archive of 1 MB that unpacks to 10 GB",
    right="an archive of 1 MB that unpacks to 20 MB",
)
NOTHING_TO_COMPILE = rule(
    "SM173",
    "nothing-to-compile",
    Severity.ERROR,
    "'{path}' holds no model",
    why="A folder is searched for files whose names end as models' do "
    "(.uml, .xmi, .xml, .mdxml, .mdzip, .aml, .amlx, .caex, .sysml, .kerml, .sysmlx, .kermlx, "
    ".kpar, .ir); there is none.",
    help="name a file, or a folder with files of such names",
    wrong="models/readme.txt",
    right="models/plant.uml",
)
UNSUPPORTED = rule(
    "SM174",
    "unsupported-content",
    Severity.ERROR,
    "{number} of the {all} elements of '{file}' are not supported",
    why="With --strict-input everything that has a meaning must be in the graph. "
    "coverage.json lists the verdict on every element.",
    help="remove them from the model, or compile without --strict-input",
    wrong="<packagedElement xmi:type='uml:Duration'/>",
    right="<packagedElement xmi:type='uml:Class'/>",
)
SKIPPED = rule(
    "SM175",
    "skipped-file",
    Severity.WARNING,
    "'{path}' is named like a model but is none: {reason}",
    why="In a folder only what is recognised is compiled; a file that is named like a model "
    "may have been meant.",
    help="name the files instead of the folder if this one is not meant",
    wrong="models/ with plant.uml and an empty notes.xml",
    right="models/ with plant.uml",
)
EMPTY = rule(
    "SM157",
    "empty-file",
    Severity.WARNING,
    "'{path}' is empty: it defines nothing",
    why="A text of SysML v2 without a declaration is allowed, but a model that is named was "
    "probably meant to have content. Some editors leave an empty file when saving fails.",
    help="save the model again, or remove the file",
    wrong="sysmlc plant.sysml, which has 0 bytes",
    right="sysmlc plant.sysml, which has 'package Plant;'",
)
SAME_NAME = rule(
    "SM159",
    "same-file-name",
    Severity.ERROR,
    "a second file is called '{path}' in outputs and messages; it is not read",
    why="Names of files are shown in Unicode's composed form (NFC), with escapes for bytes that "
    "are not UTF-8. Two files whose names differ only in such a way cannot be told apart.",
    help="rename one of the files",
    wrong="Größe.sysml twice in one folder, once with 'ö' and once with 'o' and a diaeresis",
    right="Größe.sysml and Höhe.sysml",
)
CHANGING = rule(
    "SM127",
    "changing-file",
    Severity.ERROR,
    "'{path}' {reason}",
    why="Another program is writing the file. It was read twice and changed both times; half of "
    "a model would give wrong outputs, so nothing of it is used.",
    help="compile again when the modelling tool has saved; 'sysmlc watch' waits for that",
    wrong="sysmlc plant.mdzip while the tool saves it",
    right="sysmlc plant.mdzip after the tool has saved it",
)
LEADS_OUT = rule(
    "SM180",
    "link-leads-out",
    Severity.WARNING,
    "'{path}' is a link that leads out of the folder; it is not read",
    why="Folders of models come from others. A link in one could make sysmlc read any file of "
    "this machine, and findings would quote it.",
    help="name the file itself if it is meant",
    wrong="ln -s /etc/secrets.xml models/plant.uml; sysmlc models/",
    right="ln -s shared/plant.uml models/plant.uml; sysmlc models/",
)
INTERNAL_FAULT = rule(
    "SM900",
    "internal-fault",
    Severity.ERROR,
    "fault of sysmlc in {where}: {problem}",
    why="This is a fault of sysmlc or of a plug-in, not of the model. What the faulty part "
    "would have made is not written.",
    help="please report it with the command and the model; -v shows where it happened",
)
INVALID_GRAPH = rule(
    "SM901",
    "invalid-graph",
    Severity.ERROR,
    "fault of sysmlc: after {where} the graph is not valid: {problem}",
    why="With --verify-each the graph is checked after the front ends and after each pass. "
    "An invalid graph is a fault of the part that ran last.",
    help="please report it with the model",
)
UNUSED_SUPPRESSION = rule(
    "SM902",
    "unused-suppression",
    Severity.WARNING,
    "no finding '{name}' about '{element}' is left to suppress",
    why="A suppression that no longer matches hides the next finding that does.",
    help="remove the [[suppress]] entry",
    wrong='[[suppress]]\nrule = "untyped-port"\nelement = "Plant::Gone"\nreason = "legacy"',
    right='[[suppress]]\nrule = "untyped-port"\nelement = "Plant::Gate::in"\nreason = "legacy"',
)
UNKNOWN_LEVEL_ELEMENT = rule(
    "SM903",
    "unknown-level-element",
    Severity.WARNING,
    "[recipe.levels] names '{name}', which is not in the model",
    why="The level that was meant for an element is given to none, and the recipe misses it.",
    help="write the qualified name as the findings and 'sysmlc show' do",
    wrong='[recipe.levels]\n"Plant::Asemble" = "task"',
    right='[recipe.levels]\n"Plant::Assemble" = "task"',
)

_BY_FAULT = {
    Fault.MALFORMED: MALFORMED,
    Fault.REFUSED: REFUSED,
    Fault.LIMIT: TOO_LARGE,
    Fault.MISSING: UNOPENED,
    Fault.CHANGING: CHANGING,
}

STOPPING = frozenset(
    found.code
    for found in (MISSING_FILE, UNOPENED, TOO_LARGE, CHANGING, INTERNAL_FAULT, INVALID_GRAPH)
)
"""Rules after which we could not do our work: exit code 2."""


FAILED = 2
"""Exit code: we could not do our work."""


def exit_code(found: Iterable[Diagnostic], strict: bool = False) -> int:
    """0 clean; 1 the model is wrong (with ``strict`` also warnings); 2 we failed."""
    known = {(one.rule.code, one.severity) for one in found}
    if any(code in STOPPING for code, _ in known):
        return 2
    bad = {Severity.ERROR, Severity.WARNING} if strict else {Severity.ERROR}
    return 1 if any(severity in bad for _, severity in known) else 0


def about_file(name: str) -> Subject:
    """A file as the subject of a finding."""
    return Subject(place=Place(name))


def report_unreadable(problem: SourceError, sink: Sink) -> None:
    """Report a file that cannot be read, at the byte where it ends to make sense."""
    subject = Subject(place=Place(problem.file, offset=problem.offset))
    sink.report(_BY_FAULT[problem.fault], subject, path=problem.file, reason=problem.message)
