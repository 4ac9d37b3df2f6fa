import json
import subprocess
import sys

import numpy as np
from test_writing import FACES, SINGLE

import reeb


def command(*arguments):
    return subprocess.run([sys.executable, "-m", "reeb", *map(str, arguments)], capture_output=True, text=True)


def test_the_command_line_reads_what_the_package_writes(tmp_path):
    path, out = tmp_path / "tube.reeb", tmp_path / "out.reeb"
    report = reeb.encode(SINGLE, FACES, path, kg=0.1)
    info = json.loads(command("info", "--json", path).stdout)
    assert info["frames"] == len(SINGLE)
    assert command("encode", path, "-o", out, "--lossless").returncode == 0
    np.testing.assert_array_equal(reeb.open(out)[:], reeb.open(path)[:])
    assert report.bytes == path.stat().st_size


def test_a_notebook_shows_a_picture():
    picture = reeb.open(reeb.encode(SINGLE, FACES))._repr_png_()
    assert picture.startswith(b"\x89PNG")
    width, height = (int.from_bytes(picture[at:at + 4], "big") for at in (16, 20))
    assert width >= 400 and height >= 100


def test_exit_codes_and_version():
    assert command("--version").stdout.startswith(f"reeb {reeb.__version__}, format version {reeb.format_version}")
    assert command("info", "no such file.reeb").returncode == 1
    assert command("no such command").returncode == 2
