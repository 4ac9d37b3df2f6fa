import os
import signal
import subprocess
import sys
import textwrap
import threading
import time

import numpy as np
import pytest

import reeb


def tube(frames=12, rings=20, sides=12):
    """A tube that bends: positions and triangles."""
    z, a = np.meshgrid(np.linspace(0, 4, rings), 2 * np.pi * np.arange(sides) / sides, indexing="ij")
    t = np.linspace(0, 1, frames)[:, None, None]
    bend = 0.3 * np.sin(z[None] + 3 * t) + 0.4 * t * z[None]
    xyz = np.stack(np.broadcast_arrays(np.cos(a) + bend, np.sin(a), z[None] - 0.1 * bend), axis=-1)
    i = np.arange((rings - 1) * sides).reshape(rings - 1, sides)
    j = np.roll(i, -1, axis=1)
    quads = np.stack((i, j, j + sides, i + sides), axis=-1).reshape(-1, 4)
    triangles = np.concatenate((quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]))
    return xyz.reshape(frames, -1, 3), triangles


POSITIONS, FACES = tube()
SINGLE = POSITIONS.astype(np.float32)


def kg_error(a, b):
    a, b = np.asarray(a, float), np.asarray(b, float)
    return 100 * np.linalg.norm(a - b) / np.linalg.norm(a - a.mean(axis=1, keepdims=True))


def test_kg_is_met_and_reported():
    data = reeb.encode(SINGLE, FACES, kg=0.2)
    decoded = reeb.open(data)[:]
    assert 0.15 < kg_error(SINGLE, decoded) <= 0.202
    r = data.report
    assert r.kg == pytest.approx(kg_error(SINGLE, decoded), rel=1e-3)
    distance = np.linalg.norm(SINGLE.astype(float) - decoded, axis=2)
    assert r.rmse == pytest.approx(np.sqrt((distance**2).mean()), rel=1e-3)
    assert r.max_error == pytest.approx(np.abs(SINGLE.astype(float) - decoded).max(), rel=1e-3)
    assert r.bytes == len(data) and r.bpvf == pytest.approx(8 * len(data) / SINGLE[..., 0].size)
    assert (r.target, r.wanted, r.rounding) == ("kg", 0.2, 0)
    assert sum(r.sections.values()) == len(data)
    told = reeb.report(data)
    assert (told.target, told.wanted, told.sections) == (r.target, r.wanted, r.sections)
    assert told.kg == pytest.approx(r.kg, rel=1e-2)
    assert reeb.report(reeb.encode(SINGLE, FACES, note_errors=False)).kg is None


def test_max_error_holds_with_rounding_counted():
    far = POSITIONS + 1000  # binary32 rounds by 3e-5
    data = reeb.encode(far, FACES, max_error=1e-3)
    assert np.abs(reeb.open(data)[:] - far).max() <= 1e-3
    assert 2e-5 < data.report.rounding < 4e-5 and "rounded" in data.report.notes[-1]
    with pytest.raises(ValueError, match="max_error: 1e-05 is out of reach, since float32"):
        reeb.encode(far, FACES, max_error=1e-5)
    diagonal = np.linalg.norm(np.ptp(SINGLE.reshape(-1, 3), axis=0))
    assert reeb.encode(SINGLE, FACES, max_error="0.1%").report.max_error <= 1e-3 * diagonal
    with pytest.raises(ValueError, match="max_error"):
        reeb.encode(SINGLE, FACES, max_error="much")


def test_other_targets():
    assert len(reeb.encode(SINGLE, FACES, size=1500)) <= 1500
    assert reeb.encode(SINGLE, FACES, bpvf=6.0).report.bpvf <= 6.0
    np.testing.assert_array_equal(reeb.open(reeb.encode(SINGLE, FACES, lossless=True))[:], SINGLE)
    with pytest.raises(ValueError, match="kg and lossless: there is one target"):
        reeb.encode(SINGLE, FACES, kg=1, lossless=True)


@pytest.mark.parametrize("profile", ["main", "fast"])
def test_any_layout_gives_the_same_bytes(profile):
    wanted = reeb.encode(SINGLE, FACES, profile=profile)
    padded = np.zeros((*SINGLE.shape[:2], 4), np.float32)
    padded[..., :3] = SINGLE
    for positions in (np.asfortranarray(SINGLE), padded[..., :3], SINGLE.astype(float), SINGLE.tolist(),
                      SINGLE.astype(">f4")):
        for faces in (FACES, FACES.astype(np.uint8 if FACES.max() < 256 else np.int16), FACES.tolist()):
            assert reeb.encode(positions, faces, profile=profile) == wanted


def test_faces_of_any_size():
    ragged = [[0, 1, 2, 3], [4, 5, 6], [10, 9, 8, 7, 6]]
    sequence = reeb.open(reeb.encode(SINGLE, ragged, lossless=True))
    assert [face.tolist() for face in sequence.polygons] == ragged
    again = reeb.open(reeb.encode(SINGLE, sequence.polygons, lossless=True))
    assert [face.tolist() for face in again.polygons] == ragged
    assert reeb.open(reeb.encode(SINGLE, [])).faces.shape == (0, 3)


def test_path_time_metadata_and_resources(tmp_path):
    path = tmp_path / "out.reeb"
    path.write_bytes(b"older")
    result = reeb.encode(SINGLE, FACES, path, fps=24, start_time=10, metadata={"name": "tube ü"},
                         resources={"skin.png": ("image/png", b"\x89PNG")})
    assert isinstance(result, reeb.Report) and result.bytes == path.stat().st_size
    assert os.listdir(tmp_path) == ["out.reeb"]
    with reeb.open(path) as sequence:
        assert (sequence.fps, sequence.start_time, sequence.metadata["name"]) == (24, 10, "tube ü")
        np.testing.assert_allclose(sequence.times, np.arange(12) / 24)
        np.testing.assert_array_equal(sequence.at(0.125), sequence[3])
        np.testing.assert_array_equal(sequence.at(99), sequence[11])
        np.testing.assert_array_equal(sequence.at(13 / 24, loop=True), sequence[1])
        assert sequence.resources["skin.png"].data == b"\x89PNG"
        low, high = sequence.bounds
        assert (low <= sequence[:].min(axis=(0, 1))).all() and (high >= sequence[:].max(axis=(0, 1))).all()
    with pytest.raises(FileNotFoundError):
        reeb.encode(SINGLE, FACES, tmp_path / "no" / "out.reeb")


def matched(faces, given):
    """Of each face the one of `given` that it is, and the corner of that which is its first."""
    places = {tuple(np.roll(face, -turn)): (i, turn) for i, face in enumerate(given.tolist()) for turn in range(3)}
    found = np.array([places[tuple(face)] for face in faces.tolist()])
    return found[:, 0], found[:, 1]


def test_attributes_come_back():
    frames, vertices = SINGLE.shape[:2]
    pressure = np.sin(SINGLE[..., 2] + SINGLE[..., 0])
    part = np.arange(len(FACES)) % 3
    uv = np.random.default_rng(1).random((FACES.size, 2))
    data = reeb.encode(SINGLE, FACES, attributes={
        "pressure": ("vertex", pressure, "error:0.001"),
        "temperature": ("vertex", pressure[0].astype(float)),
        "part": ("face", part),
        "inside": ("face", part == 1),
        "uv": reeb.Attribute(uv, "corner", keep="bits:10", semantic="texture_coordinate"),
        "step": ("shot", np.arange(frames)[:, None] * 0.5, "exact"),
        "skin": reeb.Attribute(part.astype(np.uint16), "face", semantic="material", names=["red", "green", "blue"])
    })
    with reeb.open(data) as sequence:
        infos = sequence.attributes
        assert set(infos) == {"pressure", "temperature", "part", "inside", "uv", "step", "skin"}
        assert infos["pressure"].animated and not infos["temperature"].animated
        assert np.abs(sequence.attribute("pressure")[:] - pressure).max() <= 0.001
        assert 0 < np.abs(sequence.attribute("temperature")[0] - pressure[0]).max() < np.ptp(pressure) / 2**16
        face, turn = matched(sequence.faces, FACES)
        np.testing.assert_array_equal(sequence.attribute("part")[5], part[face])
        np.testing.assert_array_equal(sequence.attribute("inside")[5], part[face] == 1)
        corners = (3 * face[:, None] + (turn[:, None] + np.arange(3)) % 3).ravel()
        assert np.abs(sequence.attribute("uv")[0] - uv[corners]).max() <= 2**-11 + 1e-6
        np.testing.assert_array_equal(sequence.attribute("step")[:], np.arange(frames)[:, None] * 0.5)
        assert sequence.attribute("skin").names == ["red", "green", "blue"]


BAD_FRAME = SINGLE.copy()
BAD_FRAME[3, 17, 1] = np.nan


@pytest.mark.parametrize("positions, faces, options, message", [
    (BAD_FRAME, FACES, {}, r"^positions: frame 3, vertex 17, axis 1 is not finite \(nan\)$"),
    (np.full((2, 3, 3), 1e39), [], {}, r"^positions: frame 0, vertex 0, axis 0 is beyond float32"),
    (SINGLE[0], FACES, {}, r"^positions: has to be \[frames, vertices, 3\], not \[240, 3\]"),
    (SINGLE[..., :2], FACES, {}, r"^positions: has to be"),
    (SINGLE[:0], FACES, {}, r"^positions: is empty, \[0, 240, 3\]"),
    (SINGLE[:, :0], [], {}, r"^positions: is empty"),
    (SINGLE.astype(complex), FACES, {}, r"^positions: has to be numbers"),
    (SINGLE, FACES + 1, {}, r"^faces: face 226 has vertex 240, and there are 240"),
    (SINGLE, [[0, 1, -1]], {}, r"^faces: face 0 has vertex -1"),
    (SINGLE, [[0, 1, 2], []], {}, r"^faces: face 1 has no corner"),
    (SINGLE, FACES.astype(float), {}, r"^faces: has to be vertex numbers"),
    (SINGLE, FACES.ravel(), {}, r"^faces: has to be \[triangles, 3\]"),
    (SINGLE, FACES, {"kg": 0}, r"^kg: has to be a number above 0"),
    (SINGLE, FACES, {"kg": float("nan")}, r"^kg: has to be a number above 0"),
    (SINGLE, FACES, {"profile": "best"}, r"^profile: is one of main, fast, thesis"),
    (SINGLE, FACES, {"effort": 10}, r"^effort: is 1 to 9, not 10"),
    (SINGLE, FACES, {"fps": -1}, r"^fps: has to be"),
    (SINGLE, FACES, {"attributes": {"p": ("edge", [1])}}, r"^attributes\['p'\]: domain is one of"),
    (SINGLE, FACES, {"attributes": {"p": ("vertex", [1, 2])}}, r"^attributes\['p'\]: is \[2\]; there are 240 values"),
    (SINGLE, FACES, {"attributes": {"p": ("face", np.full(len(FACES), 1 << 40))}}, r"^attributes\['p'\]: .* int32"),
    (SINGLE, FACES, {"attributes": {"p": ("shot", [1.0], "bits:99")}}, r"^attributes\[p\]: keep: .*1 to 24"),
    (SINGLE, FACES, {"attributes": {"p": [1]}}, r"^attributes\['p'\]: has to be \(domain, values\)"),
    (SINGLE[:2, :2], [], {"attributes": {"p": ("vertex", np.zeros((2, 2)))}}, r"may be animated or not"),
    (SINGLE, FACES, {"size": 10}, r"out of reach"),
])
def test_wrong_arguments(positions, faces, options, message):
    with pytest.raises(ValueError, match=message):
        reeb.encode(positions, faces, **options)


def test_progress_rises_and_may_end_the_encoding():
    positions, faces = tube(frames=40, rings=60, sides=40)
    seen = []
    reeb.encode(positions, faces, progress=seen.append)
    assert seen == sorted(seen) and seen[-1] == 1 and all(0 <= part <= 1 for part in seen)

    def stop(done):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        reeb.encode(positions, faces, progress=stop)


def test_encoder_without_a_loss(tmp_path):
    path = tmp_path / "run.reeb"
    with reeb.Encoder(path, FACES, lossless=True, fps=30, group_length=5) as encoder:
        for frame in SINGLE[:7]:
            encoder.add(frame)
        encoder.add(SINGLE[7:])
        assert not path.exists()
    assert os.listdir(tmp_path) == ["run.reeb"]
    with reeb.open(path) as sequence:
        assert len(sequence) == sequence.total_frames == 12 and sequence.fps == 30 and not sequence.truncated
        assert sequence.gaps == [] and [len(group) for group in sequence.groups] == [5, 5, 2]
        np.testing.assert_array_equal(sequence[:], SINGLE)
        np.testing.assert_array_equal(np.sort(sequence.faces), np.sort(FACES))
    assert encoder.report.bytes == path.stat().st_size and encoder.report.max_error == 0


def test_encoder_with_a_target_is_encode(tmp_path):
    path = tmp_path / "run.reeb"
    with reeb.Encoder(path, FACES, kg=0.1) as encoder:
        for frame in POSITIONS:
            encoder.add(frame)
    assert path.read_bytes() == reeb.encode(POSITIONS, FACES, kg=0.1)
    assert encoder.report.rounding > 0


def test_encoder_leaves_nothing_after_an_error(tmp_path):
    with pytest.raises(ValueError, match="^frame 1: positions: 3 vertices, but frame 0 has 240"):
        with reeb.Encoder(tmp_path / "run.reeb", FACES, lossless=True) as encoder:
            encoder.add(SINGLE[0])
            encoder.add(SINGLE[1, :3])
    with pytest.raises(ValueError, match="^frame 1: positions: vertex 17, axis 1 is not finite"):
        with reeb.Encoder(tmp_path / "run.reeb", FACES, lossless=True) as encoder:
            encoder.add(SINGLE[0])
            encoder.add(BAD_FRAME[3])
    with pytest.raises(ValueError, match="no frame was added"):
        with reeb.Encoder(tmp_path / "run.reeb", FACES):
            pass
    with pytest.raises(ValueError, match="the encoder is closed"):
        encoder.add(SINGLE[0])
    assert os.listdir(tmp_path) == []


def run_interrupted(code, after):
    """Runs code that prints a line and then takes long; how long it takes to end after Ctrl-C, and how it did."""
    # A job in the background may have been started with the signal ignored.
    helper = textwrap.dedent("""
        import signal, sys
        signal.signal(signal.SIGINT, signal.default_int_handler)
        sys.path.insert(0, sys.argv[1])
        from test_writing import *
        """)
    process = subprocess.Popen([sys.executable, "-c", helper + textwrap.dedent(code), os.path.dirname(__file__)],
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    process.stdout.readline()
    time.sleep(after)
    start = time.monotonic()
    process.send_signal(signal.SIGINT)
    try:
        _, errors = process.communicate(timeout=60)
    finally:
        process.kill()
    return time.monotonic() - start, errors


@pytest.mark.parametrize("options", ["effort=5", "lossless=True"])
def test_ctrl_c_ends_encoding_within_a_second(options):
    seconds, errors = run_interrupted(f"""
        positions, faces = tube(frames=150, rings=300, sides=150)
        print("ready", flush=True)
        reeb.encode(positions.astype(np.float32), faces, threads=1, {options})
        """, after=0.7)
    assert "KeyboardInterrupt" in errors
    assert seconds < patience()


def test_ctrl_c_ends_decoding_within_a_second():
    seconds, errors = run_interrupted("""
        positions, faces = tube(frames=40, rings=200, sides=150)
        data = reeb.encode(positions.astype(np.float32), faces, kg=0.01, effort=1)
        print("ready", flush=True)
        while True:
            reeb.open(data)[:]
        """, after=0.3)
    assert "KeyboardInterrupt" in errors
    assert seconds < patience()


def patience():
    """A second, on a machine that has a processor for this."""
    return max(1.0, 1.0 * os.getloadavg()[0] / os.cpu_count())


def test_the_lock_is_released_while_encoding_and_decoding():
    positions, faces = tube(frames=60, rings=150, sides=60)
    ticks, done = [], threading.Event()

    def tick():
        while not done.is_set():
            ticks.append(time.monotonic())
            time.sleep(0.001)

    thread = threading.Thread(target=tick, daemon=True)
    thread.start()
    start = time.monotonic()
    data = reeb.encode(positions, faces, effort=1, threads=1)
    middle = time.monotonic()
    reeb.open(data)[:]
    end = time.monotonic()
    done.set()
    thread.join()
    for first, last in ((start, middle), (middle, end)):
        within = [first, *(t for t in ticks if first < t < last), last]
        assert np.diff(within).max() < max(0.5 * (last - first), 0.02)
