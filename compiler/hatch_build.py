"""Build hook that generates the parser tables, so that no user's process has to."""

import sys
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class ParserTablesHook(BuildHookInterface):
    """Write the parser tables into the package; git ignores them, a wheel contains them."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        root = Path(self.root)
        sys.path.insert(0, str(root / "compiler"))
        from sysmlc.language.text import lalr

        for language in ("kerml", "sysml"):
            path = lalr.write_tables(language, lalr.SHIPPED)
            build_data["artifacts"].append(path.relative_to(root).as_posix())
