"""Inputs against the schemas that the user gives with ``--schema``."""

from collections.abc import Iterable
from typing import TYPE_CHECKING

from sysmlc.diagnostics import Place, Severity, Sink, Subject, rule
from sysmlc.driver.inputs import Recognised
from sysmlc.sources import Source

if TYPE_CHECKING:
    from sysmlc.sources.schema import Schema, Schemas, Violation

_MOST = 200
"""Violations of one file that are told each; the others are counted."""

VIOLATION = rule(
    "SM186",
    "schema-violation",
    Severity.WARNING,
    "'{element}' is not as {schema} wants it: {problem}",
    help="write the file again with a tool that follows the schema",
)
NO_SCHEMA = rule(
    "SM187",
    "no-schema-for-file",
    Severity.WARNING,
    "'{file}' was not validated: no schema in '{folder}' is for {what}",
    help="put the schema of that language into the folder, or leave --schema out",
)
MORE = rule(
    "SM188",
    "more-schema-violations",
    Severity.WARNING,
    "'{file}' is not as {schema} wants it in {count} more places",
)


def validate(recognised: Iterable[Recognised], schemas: "Schemas", sink: Sink) -> None:
    """Report where the inputs violate the schema of their language, and which have none."""
    for one in recognised:
        source = one.source
        try:
            schema, violations = schemas.violations(source)
        except ValueError:
            continue
        if schema is None:
            what, folder = one.frontend.name, schemas.folder.name
            sink.report(NO_SCHEMA, _file(source), file=source.name, what=what, folder=folder)
        else:
            _report(source, schema, violations, sink)


def _file(source: Source) -> Subject:
    return Subject(source.name, place=Place(source.name, ordinal=0))


def _report(source: Source, schema: "Schema", violations: "list[Violation]", sink: Sink) -> None:
    for fault in violations[:_MOST]:
        subject = Subject(fault.element, place=Place(source.name, ordinal=fault.ordinal))
        told = {"element": fault.element, "problem": fault.problem}
        sink.report(VIOLATION, subject, notes=(), help="", schema=schema.name, **told)
    left = len(violations) - _MOST
    if left > 0:
        sink.report(MORE, _file(source), file=source.name, schema=schema.name, count=left)
