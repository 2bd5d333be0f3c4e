"""A typed module of the benchmarks, compiled by mypyc where mypyc and a C compiler are, as the kernel is."""

from __future__ import annotations

import subprocess
import sys
from functools import cache
from importlib import import_module
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from tempfile import TemporaryDirectory
from types import ModuleType

PROGRAM = """
import sys
from mypyc.build import mypycify
from setuptools import Distribution
from setuptools.command.build_ext import build_ext
extensions = mypycify(["--config-file=", sys.argv[1]], opt_level="3")
command = build_ext(Distribution({"name": "benchmark", "ext_modules": extensions}))
command.build_lib, command.build_temp = "lib", "temp"
command.ensure_finalized()
command.run()
"""


@cache
def compiled(name: str) -> tuple[ModuleType, bool]:
    """A module beside this one, and whether it is compiled: into a folder for temporary files, anew."""
    source = Path(__file__).with_name(f"{name}.py")
    with TemporaryDirectory(prefix="exactacq-benchmark-", ignore_cleanup_errors=True) as folder:
        (Path(folder) / source.name).write_text(source.read_text(encoding="utf-8"), encoding="utf-8")
        command = [sys.executable, "-c", PROGRAM, source.name]
        try:
            done = subprocess.run(command, cwd=folder, capture_output=True, timeout=300, check=False)
        except subprocess.TimeoutExpired:
            return import_module(name), False
        built = [path for path in Path(folder, "lib").glob(f"{name}.*") if path.suffix in (".so", ".pyd")]
        if done.returncode or not built:
            return import_module(name), False
        spec = spec_from_file_location(name, built[0])
        assert spec is not None
        assert spec.loader is not None
        module = module_from_spec(spec)
        spec.loader.exec_module(module)
        return module, True
