"""Documents with locations: TOML, YAML and JSON are read as trees of values with their positions.

``list_violations`` compares a tree with one of the JSON Schemas in ``metamodels``. Configuration,
overlays, scenarios and contracts are read in this way, so that their faults have one wording.
"""

from sysmlc.documents.json_text import find_in_string, parse_json
from sysmlc.documents.schema import Violation, ViolationKind, list_violations
from sysmlc.documents.toml_text import parse_toml
from sysmlc.documents.values import DocumentError, Scalar, Spot, Value
from sysmlc.documents.yaml_text import parse_yaml

__all__ = [
    "DocumentError",
    "Scalar",
    "Spot",
    "Value",
    "Violation",
    "ViolationKind",
    "find_in_string",
    "list_violations",
    "parse_json",
    "parse_toml",
    "parse_yaml",
]
