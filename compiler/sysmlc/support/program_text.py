"""Texts of models in comments, strings and identifiers of generated programs."""

import re

from sysmlc.support.escapes import is_invisible

_ENDS_OF_COMMENTS = re.compile(r"(?<=\*)/|(?<=/)\*|(?<=\?)\?")
"""The second sign of ``*/``, ``/*`` and ``??``, which starts a trigraph of C."""

_KEYWORDS = """
    alignas alignof asm auto bool break case char const constexpr continue default do double else
    enum extern false float for goto if inline int long nullptr register restrict return short
    signed sizeof static static_assert struct switch thread_local true typedef typeof typeof_unqual
    union unsigned void volatile while
"""
_KEYWORDS_OF_CPP = """
    and and_eq bitand bitor catch char8_t char16_t char32_t class co_await co_return co_yield compl
    concept const_cast consteval constinit decltype delete dynamic_cast explicit export friend
    mutable namespace new noexcept not not_eq operator or or_eq private protected public
    reinterpret_cast requires static_cast template this throw try typeid typename using virtual
    wchar_t xor xor_eq
"""
_MACROS = """
    hpux i386 linux mips sparc sun unix vax
    BUFSIZ CLOCKS_PER_SEC DECIMAL_DIG EDOM EILSEQ EOF ERANGE EXIT_FAILURE EXIT_SUCCESS FILENAME_MAX
    FOPEN_MAX HUGE_VAL HUGE_VALF HUGE_VALL I INFINITY LC_ALL LC_COLLATE LC_CTYPE LC_MONETARY
    LC_NUMERIC LC_TIME L_tmpnam MATH_ERREXCEPT MATH_ERRNO MB_CUR_MAX MB_LEN_MAX NAN NULL
    ONCE_FLAG_INIT RAND_MAX SEEK_CUR SEEK_END SEEK_SET SIGABRT SIGFPE SIGILL SIGINT SIGSEGV SIGTERM
    SIG_DFL SIG_ERR SIG_IGN TIME_UTC TMP_MAX TSS_DTOR_ITERATIONS WEOF complex errno imaginary
    math_errhandling noreturn stderr stdin stdout
"""
"""Macros of the headers of C, and those that compilers define in their default mode."""
C_WORDS = frozenset(f"{_KEYWORDS} {_MACROS}".split())
"""Words that C23 or GNU C may read as something other than a name."""
_CPP_WORDS = C_WORDS.union(_KEYWORDS_OF_CPP.split())
_C_MACRO_FAMILIES = re.compile(
    r"(?:[SU]?CHAR|U?(?:SHRT|INT|LONG|LLONG|INTMAX|INTPTR|INT\d+|INT_(?:FAST|LEAST)\d+)|RSIZE|SIZE|"
    r"PTRDIFF|SIG_ATOMIC|WCHAR|WINT|BOOL)_(?:MAX|MIN|BIT|WIDTH)"
    r"|(?:ATOMIC|DBL|FE|FLT|FP|LDBL)_\w+|(?:PRI|SCN)[bBdioxXu]\w+"
)
"""Macros of limits and formats, whose names are regular."""


def is_c_word(name: str) -> bool:
    """Return whether C or C++ may read an identifier as a keyword or a macro."""
    return name in _CPP_WORDS or _C_MACRO_FAMILIES.fullmatch(name) is not None


def quote_c(text: str) -> str:
    """Return a string literal of C; characters outside of ASCII are octal escapes of UTF-8."""
    # '?' is escaped, because "??=" and the like are trigraphs in C99.
    characters = (
        chr(byte) if 32 <= byte < 127 and chr(byte) not in '"\\?' else f"\\{byte:03o}"
        for byte in text.encode("utf-8", "replace")
    )
    return f'"{"".join(characters)}"'


def quote_python(text: str) -> str:
    """Return a string literal of Python in ASCII."""
    return ascii(text)


def format_comment(text: str, width: int | None = None) -> str:
    r"""Return *text* as one line for a comment that it cannot end or extend.

    The line may stand in comments ``/* */`` of C, Promela and SysML, behind ``//``, ``#`` and
    ``--``, in a docstring of Python and in a string of TLSF. A line that is longer than *width* is
    cut.
    """
    line = " ".join(text.split())
    # A backslash joins lines, and starts escapes in docstrings, which end at quotes.
    shown = "".join("_" if sign in '\\"' or is_invisible(sign) else sign for sign in line)
    safe = _ENDS_OF_COMMENTS.sub(r" \g<0>", shown)
    return safe if width is None or len(safe) <= width else f"{safe[:width]}..."
