"""Compiles the modules that every row of a plant passes, for a wheel of one platform.

Only where ``SYSMLC_COMPILED=1`` is set when the wheel is built (docs/decisions/0021); it needs
mypy with mypyc, setuptools and a C compiler. What is compiled is the same Python that runs without.
"""

import subprocess
import sys
from pathlib import Path

REQUIRED = ["mypy[mypyc]>=1.15", "setuptools>=77"]
"""What building needs beside hatchling."""

_CAEX = (
    *("account", "attributes", "columns", "context", "document", "features", "holders"),
    *("identifiers", "interfaces", "links", "members", "metadata", "pieces", "plain", "plans"),
    *("roles", "rows", "sides", "site", "sites", "slots", "structures", "swift", "tags", "types"),
)
_IR = ("graph", "neighbours", "reference")
MODULES = (
    *(f"sysmlc/frontends/caex/{name}.py" for name in _CAEX),
    *(f"sysmlc/ir/{name}.py" for name in _IR),
)
"""Places below ``compiler``. Elements stay as they are: they make slots of their own."""


def build(root: Path, folder: Path) -> dict[str, str]:
    """Compile in a process of its own; places in the wheel by files in ``folder``.

    Raises CalledProcessError when something cannot be compiled.
    """
    run = [sys.executable, str(Path(__file__).resolve()), str(folder)]
    subprocess.run(run, cwd=root / "compiler", check=True, stdout=sys.stderr)
    made = sorted((folder / "lib").rglob("*.*"))
    return {str(path): path.relative_to(folder / "lib").as_posix() for path in made}


def main(folder: str) -> None:
    """Compile into a folder, from the folder ``compiler``."""
    from mypyc.build import mypycify
    from setuptools import setup

    options = ["--config-file=", "--ignore-missing-imports", f"--cache-dir={folder}/cache"]
    extensions = mypycify(
        [*MODULES, *options], opt_level="3", group_name="sysmlc", target_dir=f"{folder}/c"
    )
    places = ["--build-lib", f"{folder}/lib", "--build-temp", f"{folder}/temp"]
    setup(name="sysmlc", ext_modules=extensions, script_args=["build_ext", *places])


if __name__ == "__main__":
    main(sys.argv[1])
