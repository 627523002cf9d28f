"""Forms that contracts are read from and written in, found by name, by ending and by content."""

import re
from importlib import import_module
from typing import Any

from msgspec import Struct

from sysmlc.diagnostics import Sink
from sysmlc.logic.contract import Contract
from sysmlc.logic.formats import rules
from sysmlc.logic.formats.file import NotExpressibleError, opened

__all__ = ["FORMS", "Form", "NotExpressibleError", "form_of", "plain", "read", "write"]


class Form(Struct, frozen=True):
    """One form: the module that reads and writes it, endings of its files, how they begin."""

    module: str
    endings: tuple[str, ...]
    sign: str = r"(?!)"
    """What is in every file of the form (a regular expression)."""
    is_written: bool = True
    is_read: bool = True


FORMS = {
    "contract": Form("documents", (".contract.json",), r'"format"\s*:\s*"sysmlc-contract/1"'),
    "neutral": Form("documents", (".gr1.json",), r'^\s*\{[\s\S]*"variables"\s*:'),
    "slugsin": Form("slugsin", (".slugsin",)),
    "structured": Form("slugs", (".structuredslugs",), r"^\s*\[(INPUT|OUTPUT)\]"),
    "chase": Form("chase", (), r"^\s*CONTRACT\s+\w+\s*:"),
    "chasejson": Form("chasejson", (".chase.json",), r'^\s*\{[\s\S]*"(inputs|outputs)"\s*:'),
    "smv": Form("smv", (".smv",), r"^\s*MODULE\s+main\b"),
    "spot": Form("spot", (".spot.ltl",), r"^\.(inputs|outputs)\b"),
    "tlsf": Form("tlsf", (".tlsf",), r"^\s*INFO\s*\{"),
    "gr1c": Form("gr1c", (".spc",), r"^\s*(ENV|SYS)\s*:"),
    "spectra": Form("spectra", (".spectra",), r"^\s*(module|spec)\s+\w+\s", is_written=False),
    "spin": Form("spin", (".spin.ltl",), r"^[^\n]*(\[\]|<>)"),
}
"""The forms by name. What a file is, is asked of the endings first, then of the signs, in order."""


def form_of(text: str, path: str) -> str:
    """The name of the form that a file is in; empty when it is not seen."""
    for name, form in FORMS.items():
        if path.lower().endswith(form.endings) and form.is_read:
            return name
    for name, form in FORMS.items():
        if form.is_read and re.search(form.sign, text, re.MULTILINE):
            return name
    return ""


def read(text: str, path: str, sink: Sink, form: str = "") -> tuple[Contract, ...]:
    """The contracts of a file; ``form`` empty means that it is to be seen from the file.

    What is wrong is reported with line and column; a contract that has something wrong is not
    among those that are returned. Raises ValueError for a form that is not known or not read.
    """
    file = opened(text.removeprefix("\N{ZERO WIDTH NO-BREAK SPACE}"), path, sink)
    found = form or form_of(text, path)
    if not found:
        file.report(rules.UNKNOWN_FORM, 0, file=path, forms=", ".join(FORMS))
        return ()
    if found not in FORMS or not FORMS[found].is_read:
        raise ValueError(f"form {found!r} is not read")
    return _of(found).read(file)  # type: ignore[no-any-return]


def write(contract: Contract, form: str) -> str:
    """The contract in a form, ending with a newline.

    Raises NotExpressibleError when the form has no words for it, and ValueError for a form that
    is not known or not written.
    """
    if form not in FORMS or not FORMS[form].is_written:
        raise ValueError(f"form {form!r} is not written")
    return _of(form).write(contract, form)  # type: ignore[no-any-return]


def plain(contract: Contract, form: str) -> Contract:
    """The contract that a form has words for: what reading gives when it was written.

    Raises NotExpressibleError.
    """
    return _of(form).plain(contract, form)  # type: ignore[no-any-return]


def _of(form: str) -> Any:  # noqa: ANN401 - a module
    return import_module(f"sysmlc.logic.formats.{FORMS[form].module}")
