import io
import os
import threading
import weakref

import fsspec
import numpy as np
import pytest
from conftest import STREAMS, stream

import reeb


def test_sources_give_the_same():
    path = stream("groups")
    data = path.read_bytes()
    fsspec.filesystem("memory").pipe("/groups.reeb", data)
    wanted = reeb.open(path)[:]
    assert wanted.dtype == np.float32 and wanted.shape == (15, 80, 3)
    for source in (str(path), data, bytearray(data), memoryview(data), io.BytesIO(data)):
        np.testing.assert_array_equal(reeb.open(source)[:], wanted)
    with open(path, "rb") as file, fsspec.open("memory://groups.reeb") as remote:
        np.testing.assert_array_equal(reeb.open(file)[:], wanted)
        np.testing.assert_array_equal(reeb.open(remote)[:], wanted)


def test_headers_alone_are_read_of_an_object():
    class Counted(io.BytesIO):
        taken = 0

        def read(self, size=-1):
            self.taken += size
            return super().read(size)

    file = Counted(stream("long").read_bytes())
    sequence = reeb.open(file, prefetch=False)
    assert file.taken < len(file.getvalue()) / 8
    sequence[0]
    assert file.taken > len(file.getvalue()) / 2


@pytest.mark.parametrize("frames", [
    slice(3, 9), slice(None, None, -1), slice(14, 2, -3), slice(5, 5), [3], [14, 0, 7, 7, 6], np.array([-1, -15]),
    np.arange(15) % 4 == 1
])
def test_indices_are_those_of_numpy(groups, frames):
    every = np.stack([groups[i] for i in range(len(groups))])
    np.testing.assert_array_equal(groups[frames], every[frames])
    np.testing.assert_array_equal(groups.positions(frames, vertices=[79, 0, 3]), every[frames][:, [79, 0, 3]])
    np.testing.assert_array_equal(groups.positions(frames, vertices=slice(10, 20)), every[frames][:, 10:20])


def test_one_frame(groups):
    assert groups[np.int64(4)].shape == (80, 3)
    np.testing.assert_array_equal(groups[-1], groups[14])
    np.testing.assert_array_equal(groups.positions(2, vertices=[1]), groups[2][[1]])
    assert len(groups) == groups.total_frames == 15 and groups.vertex_count == 80


@pytest.mark.parametrize("frames, error", [(15, IndexError), (-16, IndexError), ([0, 15], IndexError),
                                           ([[0]], IndexError), (1.5, TypeError), ([0.5], TypeError),
                                           (np.zeros(3, bool), IndexError), ("a", TypeError)])
def test_wrong_indices(groups, frames, error):
    with pytest.raises(error):
        groups[frames]


def test_iteration_decodes_each_group_once_and_keeps_what_is_kept(groups):
    every = groups[:]
    with reeb.open(stream("groups"), cache_bytes=0) as sequence:
        kept = list(sequence)
        assert sequence.stats["groups_decoded"] == len(sequence.groups) == 4
    np.testing.assert_array_equal(np.stack(kept), every)
    for frame, wanted in zip(groups, every):
        np.testing.assert_array_equal(frame, wanted)


def test_iteration_reuses_memory_that_nobody_holds():
    with reeb.open(stream("full_planes")) as sequence:  # 60 frames
        places = {frame.ctypes.data for frame in sequence}
    assert len(places) <= 32


def test_out_is_written_without_a_copy(groups):
    out = np.zeros((4, 80, 3), np.float32)
    assert groups.positions(slice(3, 7), out=out) is out
    np.testing.assert_array_equal(out, groups[3:7])
    one = np.zeros((80, 3), np.float32)
    assert groups.positions(3, out=one) is one
    np.testing.assert_array_equal(one, out[0])


@pytest.mark.parametrize("out", [
    np.zeros((4, 80, 3)), np.zeros((80, 3), np.float32), np.zeros((4, 80, 6), np.float32)[:, :, ::2],
    np.broadcast_to(np.float32(0), (4, 80, 3)), [[0.0]]
])
def test_wrong_out(groups, out):
    with pytest.raises(ValueError, match="^out:"):
        groups.positions(slice(3, 7), out=out)


def test_between_is_linear(groups):
    a, b = groups[4].astype(float), groups[5].astype(float)
    np.testing.assert_allclose(groups.between(4.25), 0.75 * a + 0.25 * b, atol=1e-6)
    np.testing.assert_array_equal(groups.between(14), groups[14])
    with pytest.raises(IndexError, match="0 to 14"):
        groups.between(14.5)
    assert groups.fps is None and groups.times is None
    with pytest.raises(ValueError, match="frame rate"):
        groups.at(1)


def test_faces_and_normals(groups):
    faces = groups.faces
    assert faces.dtype == np.uint32 and faces.shape == (160, 3)
    assert [list(face) for face in groups.polygons] == faces.tolist()
    corners = groups[6].astype(float)[faces]
    area = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    wanted = np.zeros((80, 3))
    for k in range(3):
        np.add.at(wanted, faces[:, k], area)
    wanted /= np.linalg.norm(wanted, axis=1, keepdims=True)
    np.testing.assert_allclose(groups.normals(6), wanted, atol=1e-5)


def test_polygons_are_fans():
    with reeb.open(stream("fast_polygons")) as sequence:
        polygons = sequence.polygons
        fans = [(p[0], p[k], p[k + 1]) for p in polygons for k in range(1, len(p) - 1)]
        np.testing.assert_array_equal(sequence.faces, fans)
        assert len(set(polygons.sizes)) > 1 and len(polygons[-1]) == polygons.sizes[-1]
        with pytest.raises(IndexError):
            polygons[len(polygons)]


def test_shots_of_different_meshes():
    with reeb.open(stream("attributes")) as sequence:
        first, second = sequence.shots
        assert (first.vertex_count, second.vertex_count) == (34, 6)
        assert sequence[second.frames].shape == (len(second.frames), 6, 3)
        assert [frame.shape[0] for frame in sequence] == [34] * len(first.frames) + [6] * len(second.frames)
        with pytest.raises(ValueError, match="shots"):
            sequence[:]
        with pytest.raises(ValueError, match=r"seq.shots\[i\].faces"):
            sequence.faces
        assert sequence.resources["scene.mtl"].data == b"newmtl\n"
        assert sequence.resources["scene.mtl"].media_type == "model/mtl"


def test_attribute_values(groups):
    with reeb.open(stream("attributes_animated")) as sequence:
        animated = [a for shot in sequence.shots for a in shot.attributes.all if a.animated and a.shot == 0]
        assert {a.domain for a in animated} == {"vertex", "corner", "face", "shot"}
        for info in animated:
            reader = sequence.attribute(info)
            frames = sequence.shots[0].frames
            values = reader[frames]
            elements = sequence.shots[0].element_count(info.domain)
            assert values.dtype == info.dtype and values.shape[:2] == (len(frames), elements)
            for t in frames:
                np.testing.assert_array_equal(reader[t], values[t])
            out = np.empty_like(values)
            assert reader.values(frames, out=out) is out
            np.testing.assert_array_equal(out, values)
    with pytest.raises(KeyError, match="there are none"):
        groups.attribute("pressure")


def test_names_and_render_mesh():
    with reeb.open(stream("attributes_texture")) as sequence:
        assert sequence.attribute("usemtl").names == ["skin", "claw", "eye"]
        mesh = sequence.render_mesh()
        assert sum(r.count for r in mesh.ranges) == len(mesh.triangles) == len(sequence.faces)
        assert [r.name for r in mesh.ranges] == ["skin", "claw", "eye"]
        np.testing.assert_array_equal(mesh.positions(1), sequence[1][mesh.source_vertices])
        uv = sequence.attribute("TEXCOORD_0")[0]
        np.testing.assert_array_equal(mesh.values("TEXCOORD_0", 0), uv[mesh.source_corners])
        material = sequence.attribute("usemtl")[0][mesh.source_faces]
        np.testing.assert_array_equal(mesh.values("usemtl", 0), material)
        corners = sequence.polygons.corners
        np.testing.assert_array_equal(mesh.source_vertices, corners[mesh.source_corners])
        assert mesh.vertex_count > sequence.vertex_count
        assert sequence.render_mesh([]).vertex_count == sequence.vertex_count
        positions, normals = mesh.positions_and_normals(0)
        np.testing.assert_array_equal(normals, sequence.normals(0)[mesh.source_vertices])
        with pytest.raises(KeyError, match="split_by"):
            sequence.render_mesh(["colour"])
        with pytest.raises(IndexError):
            mesh.positions(2)
    with pytest.raises(ValueError, match="is closed"):
        mesh.positions(0)


def test_bounds_hold_all_positions():
    with reeb.open(stream("attributes_normals")) as sequence:
        every = sequence[:].reshape(-1, 3)
        low, high = sequence.bounds
        np.testing.assert_array_equal((low <= every).all(axis=0) & (every <= high).all(axis=0), True)
        np.testing.assert_array_equal([low, high], [every.min(axis=0), every.max(axis=0)])


def test_closed(groups):
    groups.close()
    groups.close()
    assert groups.closed
    with pytest.raises(ValueError, match=r"groups\.reeb is closed"):
        groups[0]


def test_no_such_file():
    with pytest.raises(FileNotFoundError):
        reeb.open("no such file.reeb")
    with pytest.raises(IsADirectoryError):
        reeb.open(STREAMS)
    with pytest.raises(TypeError, match="source"):
        reeb.open(3)


def test_damage_is_told_with_the_name_of_the_file():
    with pytest.raises(reeb.CorruptError, match=r"^.*draco_counts\.reeb: .*its counts are impossible"):
        reeb.open(stream("draco_counts", "faulty"))[0]
    with pytest.raises(reeb.CorruptError, match="^bytes: not a Reeb file"):
        reeb.open(b"no stream at all")
    with pytest.raises(reeb.TruncatedError):
        reeb.open(stream("groups").read_bytes()[:20])
    with reeb.open(stream("damaged_group", "faulty").read_bytes()) as sequence:
        assert sequence.gaps and not sequence.truncated
        with pytest.raises(reeb.CorruptError):
            sequence[sequence.gaps[0][0]]
        assert issubclass(reeb.CorruptError, reeb.ReebError)
    with pytest.raises(reeb.LimitError):
        reeb.open(stream("groups"), max_memory=1000)[0]


class Unreliable(io.BytesIO):
    fails = False

    def read(self, size=-1):
        if self.fails:
            raise ConnectionResetError("the line is dead")
        return super().read(size)


def test_what_a_file_object_raises_comes_through():
    file = Unreliable(stream("groups").read_bytes())
    sequence = reeb.open(file, prefetch=False)
    file.fails = True
    with pytest.raises(ConnectionResetError, match="the line is dead"):
        sequence[0]
    file.fails = False
    assert sequence[0].shape == (80, 3)
    short = Unreliable(stream("groups").read_bytes())
    sequence = reeb.open(short, prefetch=False)
    short.truncate(400)
    with pytest.raises(OSError):
        sequence[14]


def test_many_threads_on_one_sequence(groups):
    every = groups[:]
    faults = []

    def read(seed):
        for i in np.random.default_rng(seed).integers(0, 15, 50):
            if not np.array_equal(groups[i], every[i]):
                faults.append(i)

    threads = [threading.Thread(target=read, args=(seed,)) for seed in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not faults


def test_a_sequence_ends_with_its_last_reference():
    sequence = reeb.open(stream("attributes_texture"))
    held = weakref.ref(sequence._stream)
    mesh, reader = sequence.render_mesh(), sequence.attribute("usemtl")
    assert len(sequence.polygons) and reader.names
    del sequence, mesh, reader
    assert held() is None


def test_a_thousand_opens_leave_nothing():
    path, data = stream("attributes_texture"), stream("attributes_texture").read_bytes()
    files = f"/proc/{os.getpid()}/fd"

    def use(source):
        with reeb.open(source) as sequence:
            sequence[:], sequence.faces, sequence.render_mesh(), sequence.attribute("usemtl")[0], sequence.resources
        reeb.open(source)[1]
        with pytest.raises(IndexError):
            sequence[99]
        with pytest.raises(reeb.CorruptError):
            reeb.open(b"nothing of the kind")

    def resident():
        with open("/proc/self/statm", encoding="ascii") as file:
            return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")

    for _ in range(100):
        use(path), use(data), use(io.BytesIO(data))
    before, before_files = resident(), len(os.listdir(files))
    for _ in range(400):
        use(path), use(data), use(io.BytesIO(data))
    assert len(os.listdir(files)) == before_files
    assert resident() - before < 4 << 20  # 2,400 opens: less than 1.8 kB each
