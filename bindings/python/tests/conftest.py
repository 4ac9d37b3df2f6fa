import os
import pathlib

import pytest

import reeb

# Where the tests are copied away from the sources, REEB_STREAMS tells where the streams are.
STREAMS = pathlib.Path(os.environ.get("REEB_STREAMS") or pathlib.Path(__file__).resolve().parents[3] / "conformance/streams")


def stream(name, kind="core"):
    return STREAMS / kind / f"{name}.reeb"


@pytest.fixture
def groups():
    """15 frames in 4 groups."""
    with reeb.open(stream("groups")) as sequence:
        yield sequence
