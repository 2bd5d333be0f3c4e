"""The course's notebook runs as it is, and with each solution in place of the answer that it asks for."""

from __future__ import annotations

import re
from pathlib import Path

import nbformat
import pytest
from nbclient import NotebookClient
from nightly import NIGHTLY

COURSE = Path(__file__).resolve().parents[1] / "docs" / "notebooks" / "course.ipynb"
SOLUTION = re.compile(r"<summary>Solution</summary>\n\n```python\n(.*)\n```\n</details>", re.DOTALL)


def course() -> nbformat.NotebookNode:
    return nbformat.read(COURSE, as_version=4)


def printed(notebook: nbformat.NotebookNode) -> str:
    """What the notebook prints when it is run."""
    NotebookClient(notebook, timeout=120, kernel_name="python3").execute()
    outputs = (output for cell in notebook.cells for output in cell.get("outputs", ()))
    return "".join(output.text for output in outputs if output.output_type == "stream")


@pytest.mark.parametrize("is_solved", [False, True] if NIGHTLY else [True])
def test_the_course_runs(is_solved: bool) -> None:
    notebook = course()
    exercises = [k for k, cell in enumerate(notebook.cells) if cell.source.startswith("answer = ...")]
    assert len(exercises) == 8
    for k in exercises:
        solution = SOLUTION.search(notebook.cells[k + 1].source)
        assert solution is not None
        if is_solved:
            cell = notebook.cells[k]
            cell.source = cell.source.replace("answer = ...", solution[1], 1)
    said, expected = printed(notebook), "right" if is_solved else "not answered yet"
    assert [n for n in range(1, 9) if f"Exercise {n}: {expected}" not in said] == []


def test_the_course_is_stored_without_outputs() -> None:
    for cell in course().cells:
        assert not cell.get("outputs")
        assert cell.get("execution_count") is None
