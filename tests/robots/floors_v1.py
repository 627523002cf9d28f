"""Write the library of floors for SysML v1: ``python tests/robots/floors_v1.py``.

It is compiled from metamodels/Floors.sysml; only the example in its text differs.
"""

import re
import tempfile
from pathlib import Path

from sysmlc.driver import Request, compile_model, select_backends

FOLDER = Path(__file__).parents[2] / "metamodels"
_EXAMPLE = re.compile(r"columns are counted from 0 in the upper left corner\.\n.*?\n {5}\*\n", re.S)
_EXPLANATION = """columns are counted from 0 in the upper left corner.
     *
     * A floor is a block that specialises 'Floor', with parts for its robots and obstacles, and one
     * for its mission, which has targets. Who has a cell is a block of its own that specialises
     * 'Robot', 'Obstacle' or 'Target' and redefines 'row' and 'column' with default values.
     * Connectors between targets are typed by 'Before' or 'Carry'.
     *
"""


def convert_library() -> bytes:
    """Compile the library of floors for SysML v2 and return it as XMI."""
    text = (FOLDER / "Floors.sysml").read_text(encoding="utf-8")
    text, count = _EXAMPLE.subn(_EXPLANATION, text)
    assert count == 1
    # Under its own name the text would be the library that comes with the compiler.
    text = text.replace("library package Floors", "package Library")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "Floors.sysml"
        path.write_text(text, encoding="utf-8")
        result = compile_model(Request((path,), backends=tuple(select_backends(["uml"]))))
        (text,) = (
            output.text for output in result.list_published() if output.path.endswith(".uml")
        )
    return text.replace('name="Library"', 'name="Floors"').encode()


if __name__ == "__main__":
    (FOLDER / "Floors.uml").write_bytes(convert_library())
