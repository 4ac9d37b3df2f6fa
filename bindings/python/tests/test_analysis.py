import subprocess
import sys

import numpy as np
import pytest
from test_writing import FACES, POSITIONS, SINGLE, kg_error, tube

import reeb


def torus(rings=40, sides=24, radius=0.4):
    a, b = np.meshgrid(*(2 * np.pi * np.arange(n) / n for n in (rings, sides)), indexing="ij")
    xyz = np.stack(((1 + radius * np.cos(b)) * np.cos(a), (1 + radius * np.cos(b)) * np.sin(a), radius * np.sin(b)), -1)
    i = np.arange(rings * sides).reshape(rings, sides)
    j, k = np.roll(i, -1, axis=0), np.roll(i, -1, axis=1)
    m = np.roll(j, -1, axis=1)
    return xyz.reshape(-1, 3), np.concatenate((np.stack((i, j, m), -1), np.stack((i, m, k), -1))).reshape(-1, 3)


def test_segmentation_of_a_torus_has_its_loop():
    positions, faces = torus()
    result = reeb.segment(positions, faces)
    assert result.graph.loops == 1
    assert set(result.graph.types) >= {"minimum", "maximum"}
    assert result.labels.shape == result.scalar.shape == (len(positions),)
    assert set(result.labels) == set(range(result.region_count))
    assert 0 <= result.scalar.min() and result.scalar.max() <= 1
    assert (result.graph.arcs < len(result.graph.vertices)).all()
    followed = reeb.segment(SINGLE, FACES, regions=3)
    assert followed.region_count == 3
    with pytest.raises(ValueError, match="^regions"):
        reeb.segment(positions, faces, regions=-1)


def test_comparison():
    rng = np.random.default_rng(5)
    other = SINGLE + rng.normal(0, 0.01, SINGLE.shape).astype(np.float32)
    result = reeb.compare(SINGLE, other, FACES)
    difference = other.astype(float) - SINGLE
    assert result.kg == pytest.approx(kg_error(SINGLE, other))
    assert result.rmse == pytest.approx(np.sqrt((difference**2).sum(axis=2).mean()))
    assert result.max_error == pytest.approx(np.abs(difference).max())
    assert np.abs(difference[result.max_frame, result.max_vertex]).max() == np.abs(difference).max()
    np.testing.assert_allclose(result.frames[:, 2], np.abs(difference).max(axis=(1, 2)))
    assert result.sted > 0 and not result.identical
    moved = SINGLE + np.float32(0.5)  # no edge changes
    assert reeb.compare(SINGLE, moved, FACES).sted < 1e-4 * result.sted
    assert reeb.compare(SINGLE, other).sted is None
    sequence = reeb.open(reeb.encode(SINGLE, FACES, lossless=True))
    assert reeb.compare(POSITIONS, sequence).identical
    with pytest.raises(ValueError, match="^other"):
        reeb.compare(SINGLE, SINGLE[1:])


def test_search_finds_the_same_shape_in_another_pose(tmp_path):
    tubes, faces = tube(frames=2, rings=40, sides=24)
    ring, ring_faces = torus()
    shapes = {"tube": reeb.sign(tubes[0], faces), "ring": reeb.sign(ring, ring_faces)}
    found = reeb.search((tubes[1] * 3 + 1, faces), shapes)
    assert [match.name for match in found] == ["tube", "ring"] and found[0].distance < found[1].distance / 2
    assert reeb.search(shapes["ring"], shapes, count=1, by="charts")[0].distance == 0
    again = reeb.Signature.from_bytes(shapes["ring"].to_bytes())
    assert again.distance(shapes["ring"])["all"] < 0.05
    with pytest.raises(reeb.CorruptError):
        reeb.Signature.from_bytes(b"no signature")
    with pytest.raises(ValueError):
        reeb.sign(np.zeros((3, 3)), [[0, 1, 2]])
    with pytest.raises(ValueError, match="^by"):
        reeb.search(again, shapes, by="looks")
    reeb.encode(tubes, faces, tmp_path / "tube.reeb")
    reeb.encode(ring[None], ring_faces, tmp_path / "ring.reeb")
    subprocess.run([sys.executable, "-m", "reeb", "index", tmp_path, "-o", tmp_path / "all.reebi"], check=True)
    assert [match.name for match in reeb.search((ring, ring_faces), tmp_path / "all.reebi")] == [
        str(tmp_path / "ring.reeb"), str(tmp_path / "tube.reeb")]
