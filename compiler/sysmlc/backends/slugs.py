"""The back end ``slugs``: contracts as structured slugs and as slugsin."""

from sysmlc.backends.forms import FormBackend

BACKEND = FormBackend(
    "slugs",
    "contracts for slugs (.structuredslugs, .slugsin)",
    (("structured", ".structuredslugs"), ("slugsin", ".slugsin")),
)
