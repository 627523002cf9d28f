"""Validation of the inputs against the schemas that ``--schema`` names."""

from collections.abc import Iterable
from typing import TYPE_CHECKING

from sysmlc.diagnostics import Place, Severity, Sink, Subject, rule
from sysmlc.driver.inputs import Recognised
from sysmlc.sources import Source
from sysmlc.support.counts import count

if TYPE_CHECKING:
    from sysmlc.sources.user_schemas import Schema, Schemas, Violation

_MOST = 200
"""Violations that are reported for one file. The others are only counted."""

VIOLATION = rule(
    "SM186",
    "schema-violation",
    Severity.WARNING,
    "'{element}' does not conform to {schema}: {problem}",
    help="write the file again with a tool that follows the schema",
)
NO_SCHEMA = rule(
    "SM187",
    "no-schema-for-file",
    Severity.WARNING,
    "'{file}' was not validated: '{folder}' has no schema for {what}",
    help="add the schema of that language to the folder, or omit --schema",
)
MORE = rule(
    "SM188",
    "more-schema-violations",
    Severity.WARNING,
    "'{file}' does not conform to {schema} in {count}",
)


def validate(recognised: Iterable[Recognised], schemas: "Schemas", sink: Sink) -> None:
    """Report where the inputs violate the schema of their language, and which have none."""
    for item in recognised:
        source = item.source
        try:
            schema, violations = schemas.find_violations(source)
        except ValueError:
            continue
        if schema is None:
            what, folder = item.frontend.name, schemas.folder.name
            sink.report(
                NO_SCHEMA, _make_subject(source), file=source.name, what=what, folder=folder
            )
        else:
            _report_violations(source, schema, violations, sink)


def _make_subject(source: Source) -> Subject:
    return Subject(source.name, place=Place(source.name, ordinal=0))


def _report_violations(
    source: Source, schema: "Schema", violations: "list[Violation]", sink: Sink
) -> None:
    for fault in violations[:_MOST]:
        subject = Subject(fault.element, place=Place(source.name, ordinal=fault.ordinal))
        facts = {"element": fault.element, "problem": fault.problem}
        sink.report(VIOLATION, subject, notes=(), help="", schema=schema.name, **facts)
    hidden = len(violations) - _MOST
    if hidden > 0:
        sink.report(
            MORE,
            _make_subject(source),
            file=source.name,
            schema=schema.name,
            count=count(hidden, "more place"),
        )
