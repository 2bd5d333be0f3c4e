"""What happens when the package is built: the kernel is compiled if it can be, and if not it stays Python.

Then the wheel is one for every platform. An editable installation is compiled in place.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path
from tempfile import mkdtemp
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class KernelHook(BuildHookInterface):  # type: ignore[type-arg]
    """Adds the compiled kernel to a wheel."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Called before a wheel is made; *version* is "editable" or "standard"."""
        script = Path(self.root, "build_kernel.py")
        folder = (
            Path(self.root, "exactacq", "kernel", "compiled") if version == "editable" else Path(mkdtemp())
        )
        try:
            done = subprocess.run(
                [sys.executable, str(script), str(folder)],
                capture_output=True,
                text=True,
                timeout=600,
                check=False,
            )
        except subprocess.TimeoutExpired:
            self.app.display_warning("exactacq.kernel was not compiled: the compiler took too long")
            return
        if done.returncode:
            self.app.display_warning(f"exactacq.kernel was not compiled: {done.stderr[-2000:]}")
            return
        build_data["pure_python"] = False
        build_data["infer_tag"] = True
        if version != "editable":
            self.folder = folder
            for path in folder.iterdir():
                build_data["force_include"][str(path)] = f"exactacq/kernel/compiled/{path.name}"

    def finalize(self, version: str, build_data: dict[str, Any], artifact_path: str) -> None:
        """Called when the wheel is made."""
        shutil.rmtree(getattr(self, "folder", ""), ignore_errors=True)
