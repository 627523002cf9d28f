"""Rules of the driver about inputs, configuration, limits and internal faults, and exit codes."""

from collections.abc import Iterable

from sysmlc.diagnostics import Diagnostic, Place, Severity, Sink, Subject, rule
from sysmlc.sources import Fault, SourceError

MISSING_FILE = rule(
    "SM170",
    "missing-file",
    Severity.ERROR,
    "there is no file or folder '{path}'",
    help="check the spelling; file names are relative to the working folder",
)
NOT_THERE = rule(
    "SM148",
    "external-data-not-there",
    Severity.INFO,
    "the model refers to a file that does not exist: '{file}'{more}",
)
UNOPENED = rule(
    "SM179",
    "unopened-file",
    Severity.ERROR,
    "'{path}' {reason}",
    help="check its permissions",
)
UNRECOGNISED = rule(
    "SM171",
    "unrecognised-content",
    Severity.ERROR,
    "'{path}' is not a model: {reason}",
    help=(
        "expected XMI, AutomationML or SysML v2 (front ends: {frontends}); save a project of a "
        "modelling tool as XMI first"
    ),
)
MALFORMED = rule(
    "SM172",
    "damaged-archive",
    Severity.ERROR,
    "'{path}' cannot be read: {reason}",
    help="save the project again in the modelling tool",
)
REFUSED = rule(
    "SM177",
    "refused-file",
    Severity.ERROR,
    "'{path}' is refused: {reason}",
    help="remove the DOCTYPE, or save the model again in the modelling tool",
)
TOO_LARGE = rule(
    "SM178",
    "too-large",
    Severity.ERROR,
    "'{path}' exceeds a limit: {reason}",
    help="split the model, or check that this is the right file",
)
NOTHING_TO_COMPILE = rule(
    "SM173",
    "nothing-to-compile",
    Severity.ERROR,
    "'{path}' contains no model",
    help="name a model file, or a folder that contains model files",
)
UNSUPPORTED = rule(
    "SM174",
    "unsupported-content",
    Severity.ERROR,
    "not supported: {number} of {all} of '{file}'",
    help="remove them from the model, or compile without --strict-input",
)
SKIPPED = rule(
    "SM175",
    "skipped-file",
    Severity.WARNING,
    "'{path}' is named like a model but is not one: {reason}",
    help="to skip this file, name the other files instead of the folder",
)
EMPTY = rule(
    "SM157",
    "empty-file",
    Severity.WARNING,
    "'{path}' is empty: it defines nothing",
    help="save the model again, or remove the file",
)
NOT_OPENED = rule(
    "SM103",
    "archive-not-opened",
    Severity.INFO,
    "'{path}' holds models, which are not read: {entries}",
    help="name the file itself to read them, or unpack it",
)
FOREIGN_PARTS = rule(
    "SM102",
    "foreign-package-part",
    Severity.WARNING,
    "the package '{path}' contains files of the operating system, which are not read: {entries}",
    help="pack it again without them",
)
SAME_NAME = rule(
    "SM159",
    "same-file-name",
    Severity.ERROR,
    "a second file is called '{path}' in outputs and messages; it is not read",
    help="rename one of the files",
)
CHANGING = rule(
    "SM127",
    "changing-file",
    Severity.ERROR,
    "'{path}' {reason}",
    help="compile again when the modelling tool has saved; 'sysmlc watch' waits for that",
)
LEADS_OUT = rule(
    "SM180",
    "link-leads-out",
    Severity.WARNING,
    "'{path}' is a link that leads out of the folder; it is not read",
    help="name the file itself if it is meant",
)
SPECIAL_FILE = rule(
    "SM908",
    "special-file",
    Severity.WARNING,
    "'{path}' is a pipe, a socket or a device; it is not read",
    help="remove it from the folder",
)
INTERNAL_FAULT = rule(
    "SM900",
    "internal-fault",
    Severity.ERROR,
    "internal error of sysmlc in {where}: {problem}",
    help="please report it with the command and the model; -v shows where it happened",
)
PLUG_IN_IGNORED = rule(
    "SM914",
    "plug-in-ignored",
    Severity.WARNING,
    "{reason}",
    help="install the missing package, or repair or uninstall the plug-in",
)
PLUG_IN_FAULT = rule(
    "SM915",
    "plug-in-fault",
    Severity.ERROR,
    "{where} failed: {problem} ({source})",
    help="report it to the authors of the plug-in; the files of other back ends are written",
)
PLUG_IN_STOP = rule(
    "SM916",
    "plug-in-stop",
    Severity.ERROR,
    "{where} failed, so that nothing is written: {problem} ({source})",
    help="report it to the authors of the plug-in, or uninstall the plug-in",
)
MISSING_PACKAGE = rule(
    "SM917",
    "missing-package",
    Severity.ERROR,
    "{where} cannot load the package '{package}': {problem}",
    help="install it; docs/dependencies.md lists the packages that sysmlc needs",
)
OUTPUT_WITHOUT_PACKAGE = rule(
    "SM918",
    "output-without-package",
    Severity.ERROR,
    "{where} cannot load the package '{package}', so that its files are missing: {problem}",
    help="install it; docs/dependencies.md lists the packages that sysmlc needs",
)
INVALID_GRAPH = rule(
    "SM901",
    "invalid-graph",
    Severity.ERROR,
    "internal error of sysmlc: the graph is invalid after {where}: {problem}",
    help="please report it with the model",
)
UNUSED_SUPPRESSION = rule(
    "SM902",
    "unused-suppression",
    Severity.WARNING,
    "the suppression of '{name}' for '{element}' matches no finding",
    help="remove the [[suppress]] entry",
)
UNKNOWN_LEVEL_ELEMENT = rule(
    "SM903",
    "unknown-level-element",
    Severity.WARNING,
    "[recipe.levels] names '{name}', which is not in the model",
    help="write the qualified name as the findings and 'sysmlc show' do",
)

_BY_FAULT = {
    Fault.MALFORMED: MALFORMED,
    Fault.REFUSED: REFUSED,
    Fault.LIMIT: TOO_LARGE,
    Fault.MISSING: UNOPENED,
    Fault.CHANGING: CHANGING,
}

STOPPING = frozenset(
    rule.code
    for rule in (
        MISSING_FILE,
        UNOPENED,
        TOO_LARGE,
        CHANGING,
        INTERNAL_FAULT,
        PLUG_IN_STOP,
        MISSING_PACKAGE,
        INVALID_GRAPH,
    )
)
"""Rules whose diagnostics lead to exit code 2."""
INSTALLATION_FAULTS = frozenset(
    {PLUG_IN_IGNORED.code, PLUG_IN_FAULT.code, OUTPUT_WITHOUT_PACKAGE.code}
)
"""Rules about missing outputs, whose diagnostics may disappear although no file changes."""


FAILED = 2
"""Exit code of a run that could not do its work."""


def compute_exit_code(diagnostics: Iterable[Diagnostic], strict: bool = False) -> int:
    """Return 0 (clean), 1 (errors, with *strict* also warnings) or 2 (no result)."""
    codes = {(diagnostic.rule.code, diagnostic.severity) for diagnostic in diagnostics}
    if any(code in STOPPING for code, _ in codes):
        return FAILED
    failing = {Severity.ERROR, Severity.WARNING} if strict else {Severity.ERROR}
    return 1 if any(severity in failing for _, severity in codes) else 0


def about_file(name: str) -> Subject:
    """Return a file as the subject of a diagnostic."""
    return Subject(place=Place(name))


def find_missing_package(problem: Exception) -> str:
    """Return the package of others that an ImportError names; empty for any other problem."""
    name = (problem.name or "") if isinstance(problem, ImportError) else ""
    package = name.partition(".")[0]
    return "" if package == "sysmlc" else package


def report_ignored_plug_in(sink: Sink, reason: str) -> None:
    """Report why a plug-in is ignored; with a sink this is a ``registry.Note``."""
    sink.report(PLUG_IN_IGNORED, Subject(), reason=reason)


def report_unreadable(problem: SourceError, sink: Sink) -> None:
    """Report a file that cannot be read, at the byte where reading failed."""
    subject = Subject(place=Place(problem.file, offset=problem.offset))
    sink.report(_BY_FAULT[problem.fault], subject, path=problem.file, reason=problem.message)


# -- limits and crashes of the process ---------------------------------------------------------

TIME_LIMIT = rule(
    "SM904",
    "time-limit",
    Severity.ERROR,
    "the command did not end within {seconds} s",
    help=(
        "give more time (--time-limit, 0 for no limit), or fewer or smaller models; "
        "'time-limit' in sysmlc.toml can only shorten the time"
    ),
)
MEMORY_LIMIT = rule(
    "SM905",
    "memory-limit",
    Severity.ERROR,
    "{limit} not enough for this command",
    help=(
        "give more memory (--memory-limit, 0 for no limit), or fewer or smaller models; "
        "'memory-limit' in sysmlc.toml can only lower the limit"
    ),
)
CRASH = rule(
    "SM906",
    "crash",
    Severity.ERROR,
    "the command was ended by {signal}",
    help=(
        "try a lower --memory-limit after SIGKILL and a higher one after other signals; if that "
        "does not help, please report it with the command and the model"
    ),
)
