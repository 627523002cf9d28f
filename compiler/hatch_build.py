"""Makes the parser's tables when the package is built or installed: no user's process does."""

import os
import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

_COMPILED = "SYSMLC_COMPILED"
"""Variable of the environment that asks for a wheel with compiled modules."""


class TablesHook(BuildHookInterface):
    """Writes the tables into the package, from which git ignores them; compiles when asked to."""

    def dependencies(self) -> list[str]:
        if os.environ.get(_COMPILED) != "1":
            return []
        self._find_modules()
        import hatch_compiled

        return hatch_compiled.REQUIRED

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        root = Path(self.root)
        self._find_modules()
        from sysmlc.language.text import tables

        for language in ("kerml", "sysml"):
            path = tables.write(language, tables.SHIPPED)
            build_data["artifacts"].append(path.relative_to(root).as_posix())
        if os.environ.get(_COMPILED) == "1" and version == "standard":
            import hatch_compiled

            self._folder = TemporaryDirectory(prefix="sysmlc-compiled-")
            made = hatch_compiled.build(root, Path(self._folder.name))
            build_data["force_include"].update(made)
            build_data.update(pure_python=False, infer_tag=True)

    def finalize(self, version: str, build_data: dict[str, Any], artifact_path: str) -> None:
        if hasattr(self, "_folder"):
            self._folder.cleanup()

    def _find_modules(self) -> None:
        sys.path.insert(0, str(Path(self.root) / "compiler"))
