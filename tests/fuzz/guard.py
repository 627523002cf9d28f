"""Runs command lines of sysmlc in processes of their own, within limits, and measures them.

One lean process imports sysmlc once and forks for each command: what is measured is the work of
the command alone (processor time of the child, its largest resident size), not the start of
Python. ``python -m fuzz.guard`` is that process; it reads commands as lines of JSON.
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
_SHOWN = 50_000_000
_TESTS = Path(__file__).parents[1]


@dataclass(frozen=True, slots=True)
class Bounds:
    """After how much a command is ended: processor time, waiting (seconds), memory (bytes)."""

    seconds: int = 10
    waiting: int = 60
    memory: int = 1 << 30


@dataclass(frozen=True, slots=True)
class Ended:
    """How a command ended: ``code`` is minus the signal when it was killed."""

    code: int
    seconds: float
    megabytes: float
    out: str
    err: str

    @property
    def told(self) -> str:
        """How it ended, in a few lines."""
        start = (self.out + self.err)[:500]
        return f"exit {self.code}, {self.seconds} s, {self.megabytes} MB: {start}"

    @property
    def is_fault(self) -> bool:
        """Whether it ended otherwise than with findings: killed, a traceback, a fault of ours."""
        signs = ("Traceback (most recent", "fault of sysmlc", "SM900", "SM901", "SM905")
        said = self.out + self.err
        return self.code not in (0, 1, 2) or any(sign in said for sign in signs)


class Guard:
    """The other process. ``hash_seed`` is its PYTHONHASHSEED."""

    def __init__(self, hash_seed: int = 0) -> None:
        self._process = subprocess.Popen(
            [sys.executable, "-m", "fuzz.guard"],
            cwd=_TESTS,
            env={**os.environ, "PYTHONHASHSEED": str(hash_seed), "SYSMLC_CACHE": "off"},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )

    def run(self, folder: Path, *args: str, bounds: Bounds | None = None) -> Ended:
        """Run ``sysmlc ARGS`` in the folder."""
        asked = {"folder": str(folder), "args": args, "bounds": asdict(bounds or Bounds())}
        assert self._process.stdin
        assert self._process.stdout
        self._process.stdin.write(json.dumps(asked) + "\n")
        self._process.stdin.flush()
        return Ended(**json.loads(self._process.stdout.readline()))

    def close(self) -> None:
        """End the process."""
        self._process.communicate()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def _serve() -> None:
    _warm_up()
    for line in sys.stdin:
        asked = json.loads(line)
        ended = _run(asked["folder"], asked["args"], Bounds(**asked["bounds"]))
        print(json.dumps(asdict(ended)), flush=True)


def _run(folder: str, args: Sequence[str], bounds: Bounds) -> Ended:
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        child = os.fork()
        if child == 0:
            _become(folder, args, bounds, out.fileno(), err.fileno())
        _, status, used = os.wait4(child, 0)
        return Ended(
            os.waitstatus_to_exitcode(status),
            round(used.ru_utime + used.ru_stime, 3),
            round(used.ru_maxrss / 1024, 1),
            _text(out),
            _text(err),
        )


def _text(stream: object) -> str:
    stream.seek(0)
    return stream.read(_SHOWN).decode("utf-8", "replace")


def _become(folder: str, args: Sequence[str], bounds: Bounds, out: int, err: int) -> None:
    """Be the command: nothing of it comes back."""
    code = 70
    try:
        os.dup2(out, 1)
        os.dup2(err, 2)
        os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
        os.chdir(folder)
        resource.setrlimit(resource.RLIMIT_CPU, (bounds.seconds, bounds.seconds))
        resource.setrlimit(resource.RLIMIT_AS, (bounds.memory, bounds.memory))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        signal.alarm(bounds.waiting)
        code = _command(list(args))
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(code)


def _command(args: list[str]) -> int:
    from sysmlc.cli import group

    try:
        group.run_guarded(group.sysmlc, args, prog_name="sysmlc")
    except SystemExit as ended:
        return int(ended.code or 0)
    return 0


def _warm_up() -> None:
    """Import what a command imports, so that no child does it anew."""
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
        made = compile_model(
            Request(
                (model, model.with_name("no")), backends=tuple(load_backends(list_backend_names()))
            )
        )
        render(make_report(made.diagnostics, made.sources, str), "text", color=False)
    for name in group.COMMANDS:
        import_module(f"sysmlc.cli.{name}")
    _keep_library()
    gc.collect()
    gc.freeze()


def _keep_library() -> None:
    """Parse what is the same for all models of SysML v2: parse tables, the library's files."""
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
    _serve()
