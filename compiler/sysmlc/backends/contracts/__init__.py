"""The back end ``contracts``: contracts as JSON, as one SPIN formula, and explained to people."""

from sysmlc.backends.contracts.backend import ContractsBackend

BACKEND = ContractsBackend()

__all__ = ["BACKEND", "ContractsBackend"]
