"""The back end ``smv``: contracts for NuSMV and nuXmv."""

from sysmlc.backends.forms import FormBackend

BACKEND = FormBackend("smv", "contracts for NuSMV and nuXmv (.smv)", (("smv", ".smv"),))
