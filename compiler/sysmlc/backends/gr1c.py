"""The back end ``gr1c``: contracts as .spc files."""

from sysmlc.backends.forms import FormBackend

BACKEND = FormBackend("gr1c", "contracts for gr1c (.spc)", (("gr1c", ".spc"),))
