"""Fork server: runs commands of sysmlc in processes of their own, within limits, and measures them.

The server imports sysmlc once and forks for each command. It therefore measures the processor time
and the largest resident size of the command alone, without the start of Python. ``python -m
fuzz.fork_server`` is the server; it reads commands as lines of JSON.
"""

import json
import os
import resource
import signal
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from functools import cache
from pathlib import Path
from typing import Self

MEGABYTE = 1 << 20
_MAX_OUTPUT = 50_000_000
_TESTS = Path(__file__).parents[1]


@dataclass(frozen=True, slots=True)
class Limits:
    """Limits that end a command: processor time and elapsed time in seconds, memory in bytes."""

    seconds: int = 10
    elapsed: int = 60
    memory: int = 1 << 30


@dataclass(frozen=True, slots=True)
class CommandResult:
    """The result of a command; the exit code of a killed command is minus the signal."""

    code: int
    seconds: float
    megabytes: float
    out: str
    err: str

    @property
    def summary(self) -> str:
        """The exit code, the costs and the first output."""
        start = (self.out + self.err)[:500]
        return f"exit {self.code}, {self.seconds} s, {self.megabytes} MB: {start}"

    @property
    def is_crash(self) -> bool:
        """Whether the command crashed: killed, a traceback, or an internal error of sysmlc."""
        signs = ("Traceback (most recent", "fault of sysmlc", "SM900", "SM901", "SM905")
        output = self.out + self.err
        return self.code not in (0, 1, 2) or any(sign in output for sign in signs)


class ForkServer:
    """A client of a fork server whose PYTHONHASHSEED is *hash_seed*."""

    def __init__(self, hash_seed: int = 0) -> None:
        self._process = subprocess.Popen(
            [sys.executable, "-m", "fuzz.fork_server"],
            cwd=_TESTS,
            env={**os.environ, "PYTHONHASHSEED": str(hash_seed), "SYSMLC_CACHE": "off"},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )

    def run(self, folder: Path, *args: str, limits: Limits | None = None) -> CommandResult:
        """Run ``sysmlc ARGS`` in *folder* and return its result."""
        request = {"folder": str(folder), "args": args, "limits": asdict(limits or Limits())}
        assert self._process.stdin
        assert self._process.stdout
        self._process.stdin.write(json.dumps(request) + "\n")
        self._process.stdin.flush()
        return CommandResult(**json.loads(self._process.stdout.readline()))

    def close(self) -> None:
        """End the server."""
        self._process.communicate()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def _serve_commands() -> None:
    _import_commands()
    for line in sys.stdin:
        request = json.loads(line)
        result = _run_command(request["folder"], request["args"], Limits(**request["limits"]))
        print(json.dumps(asdict(result)), flush=True)


def _run_command(folder: str, args: Sequence[str], limits: Limits) -> CommandResult:
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        child = os.fork()
        if child == 0:
            _run_child(folder, args, limits, out.fileno(), err.fileno())
        _, status, usage = os.wait4(child, 0)
        return CommandResult(
            os.waitstatus_to_exitcode(status),
            round(usage.ru_utime + usage.ru_stime, 3),
            round(usage.ru_maxrss / 1024, 1),
            _read_output(out),
            _read_output(err),
        )


def _read_output(stream: object) -> str:
    stream.seek(0)
    return stream.read(_MAX_OUTPUT).decode("utf-8", "replace")


def _run_child(folder: str, args: Sequence[str], limits: Limits, out: int, err: int) -> None:
    """Run the command in the child process; never returns."""
    code = 70
    try:
        os.dup2(out, 1)
        os.dup2(err, 2)
        os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
        os.chdir(folder)
        resource.setrlimit(resource.RLIMIT_CPU, (limits.seconds, limits.seconds))
        resource.setrlimit(resource.RLIMIT_AS, (limits.memory, limits.memory))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        signal.alarm(limits.elapsed)
        code = _invoke(list(args))
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(code)


def _invoke(args: list[str]) -> int:
    from sysmlc.cli import group

    try:
        group.run_guarded(group.sysmlc, args, prog_name="sysmlc")
    except SystemExit as exit_:
        return int(exit_.code or 0)
    return 0


def _import_commands() -> None:
    """Import the modules that commands need, so that no child imports them again."""
    import gc
    from importlib import import_module

    from sysmlc.cli import group
    from sysmlc.diagnostics.renderers import make_report, render
    from sysmlc.driver import (
        Request,
        compile_model,
        list_backend_names,
        load_backends,
        load_full_catalogue,
    )

    load_full_catalogue()
    with tempfile.TemporaryDirectory() as folder:
        model = Path(folder, "m.uml")
        model.write_text(_MODEL)
        compilation = compile_model(
            Request(
                (model, model.with_name("no")), backends=tuple(load_backends(list_backend_names()))
            )
        )
        render(make_report(compilation.diagnostics, compilation.sources, str), "text", color=False)
    for name in group.COMMANDS:
        import_module(f"sysmlc.cli.{name}")
    _cache_library()
    gc.collect()
    gc.freeze()


def _cache_library() -> None:
    """Load what all models of SysML v2 share: parse tables and the files of the library."""
    from sysmlc.driver import Request, compile_model
    from sysmlc.language import library

    with tempfile.TemporaryDirectory() as folder:
        for language in ("sysml", "kerml"):
            model = Path(folder, f"m.{language}")
            model.write_text("package P { private import ScalarValues::*; }")
            compile_model(Request((model,)))
    library.find_library().names()
    library._read_sources = cache(library._read_sources)


_MODEL = """<?xml version="1.0" encoding="UTF-8"?>
<uml:Model xmi:version="20131001" xmlns:xmi="http://www.omg.org/spec/XMI/20131001"
 xmlns:uml="http://www.eclipse.org/uml2/5.0.0/UML" xmi:id="m" name="M">
<packagedElement xmi:type="uml:Class" xmi:id="c" name="C"/></uml:Model>"""


if __name__ == "__main__":
    _serve_commands()
