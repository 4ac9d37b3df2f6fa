"""README.md section 3: decoding of shots, groups and frames."""
from .arithmetic import sum32
from .container import LOSSLESS, THESIS
from .corrections import Corrections
from .errors import Corrupt, require
from .fields import BASIS, COEFFICIENTS, decode_field
from .lossless import LosslessGroup
from .mesh import decode_mesh
from .motion import Motion
from .surface import build_surface_graph
from .synthesis import Synthesis, ThesisSynthesis
from .temporal import build_temporal_graph


class Shot:
    """Step 2."""

    def __init__(self, reference, draco_command):
        self.reference = reference
        mesh = decode_mesh(reference.mesh, draco_command)
        self.faces = mesh.faces
        self.rows, order = build_surface_graph(mesh.grid, mesh.triangles)
        self.positions = [mesh.grid[v] for v in order]
        self.output = [mesh.output[v] for v in order]


def check_group(group):
    """container.md 3.3."""
    coordinates = 3 * group.frame_count
    thesis = group.profile == THESIS
    if group.profile == LOSSLESS:
        fits = 1 <= group.component_count <= group.frame_count
    else:
        fits = group.component_count == coordinates if thesis else group.component_count <= coordinates
    require(fits, "component_count does not fit the frames")
    require(group.region_count <= 1024, "region_count is out of range")
    unused = (group.region_count == 0 and group.motion) or (thesis and group.basis)
    require(not unused, "a section is there that the group does not use")


def decode_group(group, shot):
    """Step 3; what it returns gives position(row, t)."""
    check_group(group)
    if group.profile == LOSSLESS:
        return LosslessGroup(group, shot.rows, shot.positions, shot.reference)
    thesis = group.profile == THESIS
    motion = None
    if group.region_count > 0:
        motion = Motion(group.motion, shot.rows, group.region_count, group.component_count, thesis, shot.positions)
    planes = decode_field(group.coefficients, shot.rows, group.component_count, COEFFICIENTS[group.profile],
                          shot.positions)
    if motion is not None:
        for k, plane in enumerate(planes):
            planes[k] = [sum32(x, motion.motion(r, k)) for r, x in enumerate(plane)]
    corrections = Corrections(group, shot.rows)
    if thesis:
        return ThesisSynthesis(planes, group.axis_step, shot.reference.origin, corrections)
    time_rows, time_order = build_temporal_graph(group.frame_count)
    basis = decode_field(group.basis, time_rows, 1 + group.component_count, BASIS)
    return Synthesis(len(shot.rows), planes, basis, time_order, group.quantization_step, shot.reference.origin,
                     corrections)


class Decoder:
    """Any frame of a file that container.read_file has read."""

    def __init__(self, file, draco_command):
        self.file = file
        self.draco_command = draco_command
        self.shots = {}
        self.groups = {}

    def shot(self, number):
        if number not in self.shots:
            reference = self.file.references.get(number)
            require(reference is not None, "the reference mesh is missing")
            self.shots[number] = Shot(reference, self.draco_command)
        return self.shots[number]

    def frame(self, t):
        """Step 4: (positions by output index, faces)."""
        for number, group in enumerate(self.file.groups):
            if group.first_frame <= t < group.first_frame + group.frame_count:
                break
        else:
            raise Corrupt("frame %d is missing" % t)
        shot = self.shot(group.shot)
        if number not in self.groups:
            self.groups[number] = decode_group(group, shot)
        positions = [None] * len(shot.rows)
        for r, index in enumerate(shot.output):
            positions[index] = self.groups[number].position(r, t - group.first_frame)
        return positions, shot.faces
