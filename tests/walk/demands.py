"""What the demands of the walk need: a folder, the command in it, and a note of what is seen."""
import os
import re
import struct
import subprocess
import tempfile


class Run:
    """What came of one command."""

    def __init__(self, done):
        self.code = done.returncode
        self.out = done.stdout
        self.err = done.stderr.decode("utf-8", "replace")

    def says(self, *patterns):
        return all(re.search(p, self.err) for p in patterns)


class Walk:
    """Runs `reeb` in a new folder for every demand."""

    def __init__(self, reeb):
        self.reeb = os.path.abspath(reeb)
        self.results = []  # (demand, expected, seen, good)

    def demand(self, what):
        """Begins a demand: from here on files are in a folder of their own."""
        self.what = what
        self.holder = tempfile.TemporaryDirectory()
        self.folder = self.holder.name

    def expect(self, wanted, seen, good=None):
        """Notes one thing expected and what was seen; `good` where equality does not tell."""
        self.results.append((self.what, wanted, seen, wanted == seen if good is None else bool(good)))

    def expect_run(self, command, code, *patterns):
        """Runs a command that must end with `code` and say the patterns; gives what came."""
        done = self.run(*command)
        name = " ".join(os.fsdecode(word)[:40] for word in command)
        self.expect((name, code, *patterns), (done.code, done.err), done.code == code and done.says(*patterns))
        return done

    def expect_refused(self, seen, *patterns):
        """`seen`: what should be a message."""
        self.expect(("an error", *patterns), seen, isinstance(seen, str) and all(re.search(p, seen) for p in patterns))

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, content):
        path = self.path(name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "wb") as file:
            file.write(content.encode() if isinstance(content, str) else content)
        return name

    def read(self, name):
        with open(self.path(name), "rb") as file:
            return file.read()

    def run(self, *arguments, **options):
        return Run(subprocess.run([self.reeb, *arguments], cwd=self.folder, capture_output=True,
                                  **{"stdin": subprocess.DEVNULL, "timeout": 900, **options}))

    def shell(self, text, **options):
        environment = {**os.environ, "PATH": os.path.dirname(self.reeb) + os.pathsep + os.environ["PATH"]}
        return Run(subprocess.run(["bash", "-c", text], cwd=self.folder, env=environment, capture_output=True,
                                  stdin=subprocess.DEVNULL, timeout=900, **options))

    def points(self, *arguments):
        """Positions of all frames after a lossless encoding, or the message."""
        done = self.run("encode", *arguments, "-o", "walk_.reeb", "-f", "--lossless", "-q")
        if done.code != 0:
            return done.err
        frames = self.run("decode", "walk_.reeb", "-o", "-", "--format", "pc2", "-q")
        if frames.code != 0:
            return frames.err
        count = (len(frames.out) - 32) // 4
        values = struct.unpack(f"<{count}f", frames.out[32:])
        return [values[i:i + 3] for i in range(0, count, 3)]

    def faces(self, *arguments):
        """The first frame's faces, from 1, or the message."""
        done = self.run("encode", *arguments, "-o", "walk_.reeb", "-f", "--lossless", "-q")
        if done.code != 0:
            return done.err
        mesh = self.run("decode", "walk_.reeb", "-o", "-", "--format", "obj", "--frames", "1", "-q").out.decode()
        rows = [line.split()[1:] for line in mesh.splitlines() if line.startswith("f ")]
        return [[int(corner.split("/")[0]) for corner in row] for row in rows]

    def order(self, *arguments):
        """The x of the only vertex of every frame, or the message."""
        seen = self.points(*arguments)
        return seen if isinstance(seen, str) else [int(p[0]) for p in seen]


def cache(points, frames):
    """A PC2: `frames` lists of 3 * points floats."""
    head = b"POINTCACHE2\0" + struct.pack("<iiffi", 1, points, 0.0, 1.0, len(frames))
    return head + b"".join(struct.pack(f"<{3 * points}f", *frame) for frame in frames)


def grid(side, height=lambda x, y: 0.0, unit=1.0):
    """A square of side * side vertices: (vertices, OBJ lines of faces)."""
    vertices = [(x * unit, y * unit, height(x, y)) for y in range(side) for x in range(side)]
    faces = []
    for y in range(side - 1):
        for x in range(side - 1):
            a = y * side + x + 1
            faces.append(f"f {a} {a + 1} {a + side + 1}\nf {a} {a + side + 1} {a + side}\n")
    return vertices, "".join(faces)


def obj(vertices, faces):
    return "".join("v %.9g %.9g %.9g\n" % v for v in vertices) + faces
