"""Texts of contracts, as its templates say.

Generated from templates/contracts by ``python -m sysmlc.backends.translate``; do not edit.
"""

# fmt: off
# ruff: noqa: ANN401, C901, E501, PLR0912, RUF100

from collections.abc import Callable
from typing import Any


def _contract_md(page: Any) -> str:
    made: list[str] = []
    add = made.append
    def sections(found: Any, nothing: Any) -> str:
        made: list[str] = []
        add = made.append
        for section in found:
            add(
                "\n"
                f"### {section.title}\n"
            )
            for row in section.rows:
                add(
                    f"- {row.text} *({row.element})*\n"
                    f"  `{row.formula}`\n"
                )
            if section.unset:
                add("- Nothing of this is so:\n")
                for row in section.unset:
                    add(f"  - `{row.formula}` *({row.element})*\n")
        if not found:
            add(
                "\n"
                f"{nothing}\n"
            )
        return "".join(made)
    def variables(rows: Any, nothing: Any) -> str:
        made: list[str] = []
        add = made.append
        if rows:
            add(
                "\n"
                "| variable | values | from |\n"
                "|---|---|---|\n"
            )
            for row in rows:
                add(f"| `{row.formula}` | {row.text} | {row.element} |\n")
        else:
            add(
                "\n"
                f"{nothing}\n"
            )
        return "".join(made)
    add(
        f"# Contract of {page.component}\n"
        "\n"
    )
    if page.about:
        add(
            f"{page.about}\n"
            "\n"
        )
    add(f"From {page.element}")
    if page.place:
        add(f" in `{page.place}`")
    add(
        "; made by sysmlc: change the model, not this file.\n"
        "As long as the environment keeps the assumptions, the component keeps the guarantees.\n"
        "A prime (`x'`) is the value in the next step: the reaction to a step is seen in the next.\n"
        "\n"
    )
    if page.words:
        add(
            f"Names of variables: {page.words}.\n"
            "\n"
        )
    add(
        "## What the environment decides\n"
        f"{variables(page.inputs, 'Nothing.')}\n"
        "## What the component decides\n"
        f"{variables(page.outputs, 'Nothing.')}\n"
        "## Assumptions\n"
        f"{sections(page.assumptions, 'None: the component copes with every environment.')}\n"
        "## Guarantees\n"
        f"{sections(page.guarantees, 'None.')}\n"
    )
    return "".join(made)


TEXTS: dict[str, Callable[..., str]] = {
    "contract.md.j2": _contract_md,
}
