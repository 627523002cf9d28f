"""Binary operators by how tightly they bind (KerML 8.2.5.8.1, Table 6)."""

LEVELS = (
    ("??",),
    ("implies",),
    ("or", "|"),
    ("xor",),
    ("and", "&"),
    ("==", "!=", "===", "!=="),
    ("istype", "hastype", "@", "@@", "as", "meta"),
    ("<", ">", "<=", ">="),
    ("..",),
    ("+", "-"),
    ("*", "/", "%"),
    ("^", "**"),
)
"""Those that bind less first; only ``if`` binds less than all of them."""
LEVEL = {operator: level for level, group in enumerate(LEVELS) for operator in group}
"""The number of each operator's row."""
