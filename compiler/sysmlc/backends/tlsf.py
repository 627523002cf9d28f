"""The back end ``tlsf``: contracts in the format of the synthesis competition."""

from sysmlc.backends.forms import FormBackend

BACKEND = FormBackend("tlsf", "contracts for LTL synthesis (TLSF)", (("tlsf", ".tlsf"),))
