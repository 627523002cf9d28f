"""The back end ``chase``: contracts in CHASE's language and in its JSON."""

from sysmlc.backends.forms import FormBackend

BACKEND = FormBackend(
    "chase",
    "contracts for CHASE (.chase.ltl, .chase.json)",
    (("chase", ".chase.ltl"), ("chasejson", ".chase.json")),
)
