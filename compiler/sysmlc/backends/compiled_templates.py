"""Our templates, compiled once: their bytecode is kept where Python keeps that of our modules."""

import sys
from contextlib import suppress
from hashlib import sha256
from importlib.util import cache_from_source
from pathlib import Path
from pickle import UnpicklingError

import jinja2
from jinja2.bccache import Bucket, BytecodeCache

from sysmlc.output import write


class CompiledTemplates(BytecodeCache):
    """Bytecode in ``__pycache__`` beside the templates, or below ``PYTHONPYCACHEPREFIX``.

    What is damaged, old or cannot be written costs time only, and Python's own switch against
    writing bytecode counts. ``options`` are those of the environment, on which bytecode depends.
    """

    def __init__(self, options: object) -> None:
        self._options = f"{jinja2.__version__} {options!r} "

    def get_cache_key(self, name: str, filename: str | None = None) -> str:
        """Path of the bytecode."""
        return cache_from_source(filename or name)

    def get_source_checksum(self, source: str) -> str:
        """Digest of all that the bytecode depends on."""
        return sha256((self._options + source).encode()).hexdigest()

    def load_bytecode(self, bucket: Bucket) -> None:
        """Give what is kept for this source."""
        with suppress(OSError, EOFError, ValueError, TypeError, UnpicklingError):
            bucket.bytecode_from_string(Path(bucket.key).read_bytes())

    def dump_bytecode(self, bucket: Bucket) -> None:
        """Keep what was compiled."""
        if not sys.dont_write_bytecode:
            with suppress(OSError):
                write(bucket.key, bucket.bytecode_to_string())
