"""The back end ``reqtable``: requirements as tables in CSV and Markdown."""

from sysmlc.backends.reqtable.backend import BACKEND, ReqTableBackend

__all__ = ["BACKEND", "ReqTableBackend"]
