"""Templates of back ends: the shipped ones, and files of a user that replace them by name."""

from sysmlc.backends.templates.files import TemplateError
from sysmlc.backends.templates.rendering import Templates

__all__ = ["TemplateError", "Templates"]
