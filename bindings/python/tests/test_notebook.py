import os
import pathlib

import pytest

EXAMPLES = pathlib.Path(os.environ.get("REEB_EXAMPLES") or pathlib.Path(__file__).resolve().parents[3] / "examples/python")


def test_the_example_runs_and_shows_two_pictures():
    nbclient = pytest.importorskip("nbclient")
    nbformat = pytest.importorskip("nbformat")
    pytest.importorskip("matplotlib")
    notebook = nbformat.read(EXAMPLES / "simulation.ipynb", as_version=4)
    nbclient.NotebookClient(notebook, timeout=300, resources={"metadata": {"path": EXAMPLES}}).execute()
    kinds = [set(output.get("data", {})) for cell in notebook.cells for output in cell.get("outputs", [])]
    assert sum("image/png" in kind for kind in kinds) == 2
