"""Makes the parser's tables when the package is built or installed: no user's process does."""

import sys
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class TablesHook(BuildHookInterface):
    """Writes the tables into the package, from which git ignores them."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        root = Path(self.root)
        sys.path.insert(0, str(root / "compiler"))
        from sysmlc.language.text import tables

        for language in ("kerml", "sysml"):
            path = tables.write(language, tables.SHIPPED)
            build_data["artifacts"].append(path.relative_to(root).as_posix())
