"""What the tools call their diagrams, and our words for them (annexes A of SysML and UML)."""

_WORDS = (
    ("table", "table"),
    ("matrix", "matrix"),
    ("relationmap", "matrix"),
    ("blockdefinition", "bdd"),
    ("internalblock", "ibd"),
    ("compositestructure", "ibd"),
    ("parametric", "par"),
    ("requirement", "req"),
    ("usecase", "uc"),
    ("activity", "act"),
    ("statemachine", "stm"),
    ("statechart", "stm"),
    ("sequence", "sd"),
    ("package", "pkg"),
    ("class", "class"),
    ("logical", "class"),
    ("object", "class"),
    ("component", "class"),
    ("deployment", "class"),
    ("profile", "class"),
)


def diagram_word(*types: str) -> str:
    """Our word for a diagram; the first of the types that is known counts.

    Empty for diagrams that are neither SysML's nor UML's, such as mind maps.
    """
    for type_ in types:
        plain = type_.lower().replace(" ", "").replace("_", "")
        for part, word in _WORDS:
            if part in plain:
                return word
    return ""
