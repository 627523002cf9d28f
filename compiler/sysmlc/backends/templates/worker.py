"""The process that renders untrusted templates: ``python -m sysmlc.backends.templates.worker``.

The first line of standard input holds the templates and the limits; each further line asks for one
text and is answered by one line of standard output. All lines are JSON.
"""

import faulthandler
import json
import os
import sys
from contextlib import suppress
from pathlib import Path
from types import SimpleNamespace

from sysmlc.backends.templates.files import TemplateError, TemplateText
from sysmlc.backends.templates.sandbox import make_environment, render

_MAX_DEPTH = 10_000
"""Recursion limit: values nest as deep as the model, and each level takes some calls."""


def main() -> None:
    """Answer requests until standard input ends."""
    setup = json.loads(sys.stdin.buffer.readline())
    templates = {name: TemplateText(*pair) for name, pair in setup["templates"].items()}
    environment = make_environment(templates)
    sys.setrecursionlimit(_MAX_DEPTH)
    _limit_memory(setup["max_memory"])
    with Path(os.devnull).open("w") as null:
        for line in sys.stdin.buffer:
            # The watchdog is a thread of C: it ends the process in the middle of an operation.
            faulthandler.dump_traceback_later(setup["max_seconds"], exit=True, file=null)
            request = json.loads(line, object_hook=lambda fields: SimpleNamespace(**fields))
            answer = {}
            try:
                values = vars(request.values)
                answer["text"] = render(environment, request.name, values, setup["max_characters"])
            except TemplateError as fault:
                answer["fault"] = str(fault)
            sys.stdout.buffer.write(json.dumps(answer).encode() + b"\n")
            sys.stdout.buffer.flush()
            faulthandler.cancel_dump_traceback_later()


def _limit_memory(size: int) -> None:
    """Make allocations above *size* bytes fail; Windows and macOS cannot."""
    with suppress(ImportError, OSError, ValueError):
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (size, resource.getrlimit(resource.RLIMIT_AS)[1]))


if __name__ == "__main__":
    main()
