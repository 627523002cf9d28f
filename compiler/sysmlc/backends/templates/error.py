"""Exceptions about templates that cannot be read or rendered."""


class TemplateError(Exception):
    """A template cannot be used; the message starts with its file and line where known."""


class TemplateLimitError(TemplateError):
    """A template exceeded a limit, and the process that rendered it ended."""


class UnusableFolderError(TemplateError):
    """A folder holds a template that cannot be read safely."""
