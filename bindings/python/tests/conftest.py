import pathlib

import pytest

import reeb

STREAMS = pathlib.Path(__file__).resolve().parents[3] / "conformance" / "streams"


def stream(name, kind="core"):
    return STREAMS / kind / f"{name}.reeb"


@pytest.fixture
def groups():
    """15 frames in 4 groups."""
    with reeb.open(stream("groups")) as sequence:
        yield sequence
