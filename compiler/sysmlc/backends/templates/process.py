"""The parent's side of the process that renders templates that are not trusted.

The sandbox of Jinja cannot stop ``{{ 10 ** 10 ** 8 }}`` or a loop that prints nothing. A separate
process can be ended: it has limits of time, memory and output (``worker``).
"""

import json
import sys
from collections.abc import Mapping
from contextlib import suppress
from subprocess import DEVNULL, PIPE, Popen

from msgspec.structs import asdict

from sysmlc.backends.templates.files import TemplateError, TemplateLimitError, TemplateText

MAX_SECONDS = 5
"""Time limit of one text; the largest shipped template takes some milliseconds."""
MAX_MEMORY = 1 << 30
"""Memory limit of the process in bytes, on platforms that can limit it."""
# -P: a file of the working folder that is called like a module must not be imported.
_COMMAND = (sys.executable, "-P", "-m", "sysmlc.backends.templates.worker")


class RenderingProcess:
    """A process that renders texts one after the other; starting it takes 0.2 s.

    It reads no files, and gets values as JSON: templates can reach no object of the compiler.
    """

    def __init__(self, templates: Mapping[str, TemplateText], max_characters: int) -> None:
        try:
            self._process = Popen(_COMMAND, stdin=PIPE, stdout=PIPE, stderr=DEVNULL)
        except OSError as problem:
            raise TemplateError(f"Python cannot be started: {problem.strerror}") from problem
        self._setup = {
            "templates": templates,
            "max_characters": max_characters,
            "max_seconds": MAX_SECONDS,
            "max_memory": MAX_MEMORY,
        }

    def render(self, name: str, values: Mapping[str, object]) -> str:
        """Render a template with values of JSON and structs.

        Raises TemplateError; TemplateLimitError if the process ended.
        """
        request = json.dumps({"name": name, "values": values}, default=asdict)
        answer = self._exchange(request)
        if answer is None:
            raise TemplateLimitError(f"{name}: {self._explain_end()}")
        if "fault" in answer:
            raise TemplateError(answer["fault"])
        return answer["text"]

    def _exchange(self, request: str) -> dict[str, str] | None:
        """Send a request and return the answer; None if the process has ended."""
        requests, answers = self._process.stdin, self._process.stdout
        assert requests is not None
        assert answers is not None
        with suppress(BrokenPipeError):
            if self._setup:
                requests.write(json.dumps(self._setup).encode() + b"\n")
                self._setup = {}
            requests.write(request.encode() + b"\n")
            requests.flush()
            line = answers.readline()
            if line.endswith(b"\n"):
                answer: dict[str, str] = json.loads(line)
                return answer
        return None

    def _explain_end(self) -> str:
        """Return why the process has ended, for a message."""
        # faulthandler ends the worker with exit code 1 when the time is over.
        if self._process.wait() == 1:
            return f"takes more than {MAX_SECONDS} s"
        return f"the process that renders it ended with code {self._process.returncode}"

    def close(self) -> None:
        """End the process."""
        self._process.kill()
        self._process.communicate()
