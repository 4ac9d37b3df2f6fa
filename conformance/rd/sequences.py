"""Finds the sequences to measure, or has some made."""
import dataclasses
import hashlib
import os

import process

SAMPLES = ("creature:25", "sheet:25", "mechanism:25")


@dataclasses.dataclass(frozen=True)
class Sequence:
    name: str
    inputs: tuple  # what `reeb encode` and the peers take: a mesh and a point cache, or a folder of frames

    def fingerprint(self):
        """Tells sequences of one name apart by what is in their files."""
        digest = hashlib.sha256()
        for path in self.files():
            with open(path, "rb") as file:
                digest.update(file.read())
        return digest.hexdigest()

    def files(self):
        for path in self.inputs:
            if os.path.isdir(path):
                yield from sorted(os.path.join(path, name) for name in os.listdir(path))
            else:
                yield path


def of_folder(folder):
    """NAME.obj (or .ply, ...) beside NAME.pc2 or NAME.mdd, or else the folder as one of frames; None if neither."""
    files = sorted(os.listdir(folder))
    meshes = [f for f in files if f.lower().endswith((".obj", ".ply", ".off"))]
    for cache in files:
        stem, extension = os.path.splitext(cache)
        if extension.lower() in (".pc2", ".mdd"):
            mesh = [m for m in meshes if os.path.splitext(m)[0] == stem]
            if mesh:
                return Sequence(stem, (os.path.join(folder, mesh[0]), os.path.join(folder, cache)))
    return Sequence(os.path.basename(os.path.abspath(folder)), (folder,)) if len(meshes) > 1 else None


def find(folders):
    """Sequences of the folders named, which hold one each or folders of one each. Complains of what has none."""
    found = []
    for folder in folders:
        inside = [os.path.join(folder, name) for name in sorted(os.listdir(folder))]
        here = of_folder(folder)
        each = [here] if here else [of_folder(path) for path in inside if os.path.isdir(path)]
        if not any(each):
            raise SystemExit(f"{folder}: neither a mesh with a point cache, nor frames, nor folders of them")
        found += [sequence for sequence in each if sequence]
    return found


def samples(reeb, names, folder):
    """Has `reeb sample` make sequences named like creature:25 (25 frames), which are the same on every machine."""
    made = []
    for name in names:
        sample, _, frames = name.partition(":")
        stem = f"{sample}-{frames or 25}"
        cache = os.path.join(folder, stem + ".pc2")
        process.run([reeb, "sample", sample, "--length", frames or "25", "-o", cache, "-f", "-q"])
        made.append(Sequence(stem, (os.path.join(folder, stem + ".obj"), cache)))
    return made
