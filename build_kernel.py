"""Compile the modules of `exactacq.kernel`, in place or into a folder: ``python build_kernel.py [FOLDER]``.

Installing does this by itself (see ``hatch_build.py``); after editing the kernel of an editable installation
it may be run by hand. It needs mypy, setuptools and a C compiler, and fails loudly.
"""

from __future__ import annotations

import os
import shutil
import sys
import tempfile
from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_loader
from pathlib import Path

KERNEL = Path(__file__).resolve().parent / "exactacq" / "kernel"
FLAGS = {
    "unix": ["-O3", "-ffp-contract=off", "-fno-semantic-interposition", "-Wno-unused-function"],
    "msvc": ["/O2", "/fp:precise"],
}
"""No fused multiply-add and no other liberty with floats: both ways give the same bits."""


def build(target: Path) -> list[Path]:
    """Compile the kernel into a folder and return the files made there."""
    from mypyc.build import mypycify
    from setuptools import Distribution
    from setuptools.command.build_ext import build_ext

    loader = SourceFileLoader("kernel", str(KERNEL / "__init__.py"))
    os.environ.pop("EXACTACQ_KERNEL", None)
    kernel = module_from_spec(spec_from_loader("kernel", loader))  # type: ignore[arg-type]
    loader.exec_module(kernel)
    target.mkdir(parents=True, exist_ok=True)
    record = target / kernel.RECORD
    record.unlink(missing_ok=True)
    here = Path.cwd()
    with tempfile.TemporaryDirectory() as folder:
        # A package of its own: what is compiled can use nothing of the rest.
        copy = Path(folder, "exactacq", "kernel")
        copy.mkdir(parents=True)
        for package in (copy.parent, copy):
            (package / "__init__.py").touch()
        modules = [path for path in sorted(KERNEL.glob("*.py")) if path.name != "__init__.py"]
        for path in modules:
            shutil.copy(path, copy)
        os.chdir(folder)
        try:
            names = [f"exactacq/kernel/{path.name}" for path in modules]
            extensions = mypycify(["--config-file=", *names], group_name="exactacq.kernel.all", opt_level="3")
            distribution = Distribution({"name": "exactacq-kernel", "ext_modules": extensions})
            command = build_ext(distribution)
            command.build_lib, command.build_temp = "lib", "temp"
            command.ensure_finalized()
            flags = FLAGS["msvc" if sys.platform == "win32" else "unix"]
            for extension in extensions:
                extension.extra_compile_args = [*extension.extra_compile_args, *flags]
            command.run()
            built = sorted(Path("lib", "exactacq", "kernel").iterdir())
            made = [_placed(path, target) for path in built]
        finally:
            os.chdir(here)
    record.write_text(kernel.digest(KERNEL) + "\n", encoding="ascii")
    return [*made, record]


def _placed(path: Path, folder: Path) -> Path:
    """Copy a file into a folder in one step: a program that runs the former one keeps it."""
    with tempfile.TemporaryDirectory(dir=folder) as beside:
        return Path(shutil.copy(path, beside)).replace(folder / path.name)


if __name__ == "__main__":
    if any(argument.startswith("-") for argument in sys.argv[1:]):
        raise SystemExit(__doc__)
    for made in build(Path(sys.argv[1]).resolve() if len(sys.argv) > 1 else KERNEL / "compiled"):
        print(made)
