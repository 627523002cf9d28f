"""What is suspicious in a contract: promises that nobody can keep, and those that cost nothing."""

from sysmlc.synthesis.lints.lint import lint

__all__ = ["lint"]
