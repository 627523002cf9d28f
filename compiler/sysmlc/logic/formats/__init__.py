"""Formats of contracts: read and write them; detect a format by file ending and content.

Each format is a module with three functions: ``read(file)`` returns the contracts of a file and
reports its faults, ``lower(contract, format_name)`` rewrites a contract until the format can
express it, and ``write(contract, format_name)`` prints the lowered contract. One module may serve
several formats.
"""

import re
from collections.abc import Sequence
from importlib import import_module
from pathlib import Path
from typing import Protocol, cast

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.diagnostics import Sink
from sysmlc.logic.contract import Contract
from sysmlc.logic.formats import rules
from sysmlc.logic.formats.draft import SpecificationFile
from sysmlc.logic.formats.writing import NotExpressibleError
from sysmlc.support.suggestions import did_you_mean

__all__ = ["FORMATS", "Format", "NotExpressibleError", "detect_format", "lower", "read", "write"]


class Format(Struct, frozen=True):
    """A format: the name of its module, and the endings and signature of its files."""

    module: str
    endings: tuple[str, ...]
    signature: str = r"(?!)"
    """A regular expression that matches in every file of the format."""
    is_written: bool = True
    is_read: bool = True


class _FormatModule(Protocol):
    """The functions of a format's module."""

    def read(self, file: SpecificationFile) -> tuple[Contract, ...]: ...

    def lower(self, contract: Contract, format_name: str) -> Contract: ...

    def write(self, contract: Contract, format_name: str) -> str: ...


FORMATS = {
    "contract": Format(
        "contract_json", (".contract.json",), r'"format"\s*:\s*"sysmlc-contract/[12]"'
    ),
    "neutral": Format("contract_json", (".gr1.json",), r'^\s*\{[\s\S]*"variables"\s*:'),
    "slugsin": Format("slugs", (".slugsin",)),
    "structured": Format("slugs", (".structuredslugs",), r"^\s*\[(INPUT|OUTPUT)\]"),
    "chase": Format("chase", (), r"^\s*CONTRACT\s+\w+\s*:"),
    "chasejson": Format("chase_json", (".chase.json",), r'^\s*\{[\s\S]*"(inputs|outputs)"\s*:'),
    "smv": Format("smv", (".smv",), r"^\s*MODULE\s+main\b"),
    "spot": Format("spot", (".spot.ltl",), r"^\.(inputs|outputs)\b"),
    "tlsf": Format("tlsf", (".tlsf",), r"^\s*INFO\s*\{"),
    "gr1c": Format("gr1c", (".spc",), r"^\s*(ENV|SYS)\s*:"),
    "spectra": Format("spectra", (".spectra",), r"^\s*(module|spec)\s+\w+\s", is_written=False),
    "promela": Format("promela", (".pml",), is_read=False),
    "spin": Format("spin", (".spin.ltl",), r"^[^\n]*(\[\]|<>)"),
}
"""The formats by name, in the order of detection: an earlier signature wins."""


def detect_format(text: str, path: str) -> str:
    """Return the name of the format of a file, by its ending or else by its content.

    The name is empty if no format matches.
    """
    readable = {name: format_ for name, format_ in FORMATS.items() if format_.is_read}
    for name, format_ in readable.items():
        if path.lower().endswith(format_.endings):
            return name
    for name, format_ in readable.items():
        if re.search(format_.signature, text, re.MULTILINE):
            return name
    return ""


def read(
    text: str, path: str, sink: Sink, format_name: str = "", include: tuple[Path, ...] = ()
) -> tuple[Contract, ...]:
    """Return the contracts of a file; detect the format if its name is empty.

    Imports of the file may lead into its own folder and into the folders of *include*.
    Faults are reported with line and column, and a contract with a fault is omitted. Raises
    ValueError for a format that is unknown or not readable.
    """
    file = SpecificationFile.from_text(
        text.removeprefix("\N{ZERO WIDTH NO-BREAK SPACE}"), path, sink
    )
    file = replace(file, include=include)
    name = format_name or detect_format(text, path)
    if not name:
        file.report(rules.UNKNOWN_FORM, 0, file=path, forms=", ".join(FORMATS))
        return ()
    _check_name(name, "read", [name for name, format_ in FORMATS.items() if format_.is_read])
    return _load_module(name).read(file)


def write(contract: Contract, format_name: str) -> str:
    """Return the contract as text that ends with a newline.

    Raises NotExpressibleError if the format cannot express it, and ValueError for a format that is
    unknown or not writable.
    """
    written = [name for name, format_ in FORMATS.items() if format_.is_written]
    _check_name(format_name, "written", written)
    return _load_module(format_name).write(contract, format_name)


def _check_name(name: str, participle: str, known: Sequence[str]) -> None:
    if name not in known:
        raise ValueError(f"no format '{name}' is {participle}; {did_you_mean(name, known)}")


def lower(contract: Contract, format_name: str) -> Contract:
    """Return the contract as it is read back after it was written in the format.

    ``spin`` has no such function: its printer separates steps itself. Raises NotExpressibleError.
    """
    return _load_module(format_name).lower(contract, format_name)


def _load_module(name: str) -> _FormatModule:
    module = import_module(f"sysmlc.logic.formats.{FORMATS[name].module}")
    return cast("_FormatModule", module)
