"""Loops over floats: typed modules of plain Python, compiled where the installation found a compiler.

The modules take and return floats and integers only. What they decide they decide for certain (see
`exactacq.kernel.bounded`); everything else is left to exact arithmetic. Compiled or not, the floats are the
same to the last bit.

The compiled forms of all modules lie together in the folder ``compiled`` beside the sources, with a digest of
the sources that they were made from. If that is the digest of the present sources, the folder comes first on
the package's search path, and each module is loaded from there under its own name. So sources that were
edited are never shadowed by what was compiled before. The environment variable ``EXACTACQ_KERNEL`` chooses:
``python`` forbids the compiled forms, ``compiled`` requires them; without it they are used if they are there.
"""

from hashlib import sha256
from importlib.machinery import EXTENSION_SUFFIXES
from os import environ
from pathlib import Path

SWITCH = "EXACTACQ_KERNEL"
"""The environment variable that chooses."""
FOLDER = Path(__file__).parent / "compiled"
"""Where the compiled forms are."""
RECORD = f"sources{EXTENSION_SUFFIXES[0]}.sha256"
"""The file there that says what they were made from, one for each kind of interpreter."""


def digest(folder: Path) -> str:
    """The digest of the sources in a folder, this file excepted: what is compiled."""
    total = sha256()
    for path in sorted(folder.glob("*.py")):
        if path.name != "__init__.py":
            total.update(f"{path.name}\n".encode() + path.read_bytes().replace(b"\r\n", b"\n"))
    return total.hexdigest()


def _compiled() -> bool:
    """Whether compiled forms of the present sources are there and allowed; ImportError if they should be."""
    wish = environ.get(SWITCH, "")
    if wish not in ("", "python", "compiled"):
        raise ImportError(f"{SWITCH} must be 'python', 'compiled' or unset, not {wish!r}", name=__name__)
    if wish == "python":
        return False
    record = FOLDER / RECORD
    if not record.exists():
        fault = "was not compiled for this interpreter when it was installed"
    elif record.read_text(encoding="ascii").strip() != digest(FOLDER.parent):
        fault = "was edited since it was compiled"
    else:
        return True
    if wish == "compiled":
        raise ImportError(f"{SWITCH}=compiled, but exactacq.kernel {fault}", name=__name__)
    return False


COMPILED = _compiled()
"""Whether the compiled forms run."""
DESCRIPTION = "compiled kernel" if COMPILED else "kernel in Python"
"""Which form of the kernel runs, for people to read."""

if COMPILED:
    __path__.insert(0, str(FOLDER))

EXACT_ONLY = False
"""For tests: whether the bounds of all data are infinite, so that nothing is decided by floats.

See `exactacq.numbers.float_bounds`. Boxes stay, which are rounded outward: they choose what is looked at."""
