"""README.md section 3: decoding of shots, groups and frames."""
from . import fast
from .arithmetic import sum32
from .attribute_chunks import read_group_body
from .attributes import animated_sites, decode_static, pack_frame, pack_normals, site_numbers
from .container import CONTINUES, FAST, LOSSLESS, MAIN, THESIS, WEAK_PRIOR, Reference, read_group
from .corrections import Corrections
from .errors import Corrupt, Truncated, require
from .fields import BASIS, COEFFICIENTS, WEAK_PRIOR_COEFFICIENTS, decode_field
from .lossless import LosslessGroup
from .mesh import decode_mesh
from .motion import Motion
from .surface import build_surface_graph
from .synthesis import Synthesis, ThesisSynthesis
from .temporal import build_temporal_graph


class Shot:
    """Step 2."""

    def __init__(self, reference):
        self.reference = reference
        mesh = decode_mesh(reference.mesh)
        self.faces = mesh.faces
        self.plain = mesh.plain_order is not None
        if self.plain:
            self.rows, order = fast.build_fast_graph(mesh.grid, mesh.plain_order)
        else:
            self.rows, order = build_surface_graph(mesh.grid, mesh.triangles)
        self.positions = [mesh.grid[v] for v in order]
        self.output = [mesh.output[v] for v in order]
        self.output_grid = [None] * len(order)
        for v, index in enumerate(mesh.output):
            self.output_grid[index] = mesh.grid[v]


class SiteShot:
    """attributes.md section 10: sites in place of vertices."""
    plain = False

    def __init__(self, sites):
        self.reference = Reference(0, 0, (0.0, 0.0, 0.0), 0.0, b"")
        self.rows, order = build_surface_graph(sites.grid, sites.triangles)
        self.positions = [sites.grid[v] for v in order]
        self.output = order


def decode_part(payload, part, shot):
    """Three channels of an animated attribute in a group."""
    try:
        group = read_group(payload)
    except Truncated as fault:
        raise Corrupt(str(fault))
    same = (group.first_frame, group.frame_count, group.shot) == (part.first_frame, part.frame_count, part.shot)
    plain = group.profile != THESIS and group.region_count == 0 and not group.flags & CONTINUES
    require(same and plain, "agrp: a part does not fit the group")
    return DecodedGroup(group, shot)


def check_group(group, vertex_count):
    """container.md 3.3."""
    coordinates = 3 * group.frame_count
    thesis = group.profile == THESIS
    if group.profile == LOSSLESS:
        require(1 <= group.stored_count <= group.frame_count, "stored_count does not fit the frames")
    fits = group.component_count == coordinates if thesis else group.component_count <= coordinates
    require(fits, "component_count does not fit the frames")
    require(group.region_count <= 1024, "region_count is out of range")
    may_be_weak = group.profile in (MAIN, FAST) and not group.flags & CONTINUES
    require(may_be_weak or not group.flags & WEAK_PRIOR, "a weak prior where no weights start")
    unused = (group.region_count == 0 and group.motion) or (thesis and group.basis)
    require(not unused, "a section is there that the group does not use")
    require(elements(group, vertex_count) <= 512 * (32 + group.section_bytes()), "more than the bytes can hold")


def elements(group, vertex_count):
    coordinates = 3 * group.frame_count
    if group.profile == LOSSLESS:
        return vertex_count * (3 * group.stored_count + 1) + coordinates
    planes = group.component_count + 1
    return ((vertex_count + coordinates) * planes + 12 * group.region_count * group.component_count
            + 8 * group.correction_count)


class DecodedGroup:
    """Step 3. before: the group that this one continues."""

    def __init__(self, group, shot, before=None):
        check_group(group, len(shot.rows))
        require(group.profile == FAST or not shot.plain, "plain meshes are those of the fast profile")
        self.coefficients = self.basis = None
        if group.profile == LOSSLESS:
            self.frames = LosslessGroup(group, shot.rows, shot.positions, shot.reference)
            return
        planes = self.decode_planes(group, shot, before)
        corrections = Corrections(group, shot.rows)
        origin = shot.reference.origin
        if group.profile == THESIS:
            self.frames = ThesisSynthesis(planes, group.axis_step, origin, corrections)
            return
        time_rows, time_order = build_temporal_graph(group.frame_count)
        basis_planes = self.decode_basis(group, time_rows, before)
        self.frames = Synthesis(len(shot.rows), planes, basis_planes, time_order, group.quantization_step, origin,
                                corrections)

    def decode_planes(self, group, shot, before):
        motion = None
        if group.region_count > 0:
            motion = Motion(group.motion, shot.rows, group.region_count, group.component_count,
                            group.profile == THESIS, shot.positions)
        planes = self.decode_coefficients(group, shot, before)
        if motion is None:
            return planes
        return [[sum32(x, motion.motion(r, k)) for r, x in enumerate(plane)] for k, plane in enumerate(planes)]

    def decode_coefficients(self, group, shot, before):
        if group.profile == FAST:
            wary = group.flags & WEAK_PRIOR != 0
            return fast.decode_coefficients(group.coefficients, shot.rows, group.component_count, shot.positions, wary)
        options = WEAK_PRIOR_COEFFICIENTS if group.flags & WEAK_PRIOR else COEFFICIENTS[group.profile]
        self.coefficients = decode_field(group.coefficients, shot.rows, group.component_count,
                                         options, shot.positions, before and before.coefficients)
        return self.coefficients.planes

    def decode_basis(self, group, rows, before):
        if group.profile == FAST:
            return fast.decode_basis(group.basis, rows, 1 + group.component_count)
        self.basis = decode_field(group.basis, rows, 1 + group.component_count, BASIS, before=before and before.basis)
        return self.basis.planes

    def position(self, row, t):
        return self.frames.position(row, t)


class Decoder:
    """Any frame of a file that container.read_file has read."""

    def __init__(self, file):
        self.file = file
        self.shots = {}
        self.groups = {}
        self.sites = {}  # of animated attributes
        self.parts = {}  # of them, by attribute and first frame

    def shot(self, number):
        if number not in self.shots:
            reference = self.file.references.get(number)
            require(reference is not None, "the reference mesh is missing")
            self.shots[number] = Shot(reference)
        return self.shots[number]

    def group(self, number):
        """fields.md section 6 says what groups need others."""
        if number not in self.groups:
            group = self.file.groups[number]
            shot = self.shot(group.shot)
            before = self.group(self.number_before(number)) if group.flags & CONTINUES else None
            self.groups[number] = DecodedGroup(group, shot, before)
        return self.groups[number]

    def number_before(self, number):
        group, before = self.file.groups[number], self.file.groups[number - 1]
        there = number > 0 and before.first_frame + before.frame_count == group.first_frame
        require(there, "the group that a group continues is missing")
        require(before.shot == group.shot and before.profile == group.profile == MAIN,
                "a group continues one of another kind")
        row = self.file.groups[max(0, number - 63):number + 1]
        require(len(row) < 64 or not all(g.flags & CONTINUES for g in row), "too many groups continue each other")
        return number - 1

    def number_of(self, t):
        for number, group in enumerate(self.file.groups):
            if group.first_frame <= t < group.first_frame + group.frame_count:
                return number
        raise Corrupt("frame %d is missing" % t)

    def attributes(self, t):
        """attributes.md: those of the shot that holds frame t."""
        group = self.file.groups[self.number_of(t)]
        return [a for a in self.file.attributes if a.shot == group.shot]

    def attribute(self, attribute, t):
        """Its values in frame t."""
        shot = self.shot(attribute.shot)
        if not attribute.animated():
            return decode_static(attribute, shot.output_grid, shot.faces)
        key = (attribute.shot, attribute.index)
        if key not in self.sites:
            sites, corrections = animated_sites(attribute, shot.output_grid, shot.faces)
            self.sites[key] = (sites, corrections, SiteShot(sites) if attribute.in_groups() else None)
        sites, numbers, site_shot = self.sites[key]
        if attribute.in_groups():
            numbers = self.coded_numbers(attribute, key, site_shot, t)
        return pack_normals(sites, self.frame(t)[0], numbers) if attribute.computed() else pack_frame(attribute, sites, numbers)

    def coded_numbers(self, attribute, key, site_shot, t):
        """Section 10: the numbers of every site in frame t."""
        first = self.file.groups[self.number_of(t)].first_frame
        if (key, first) not in self.parts:
            self.parts[key, first] = self.attribute_group(attribute, first, site_shot)
        scales, parts = self.parts[key, first]
        coordinates = [None] * len(site_shot.rows)
        for r, site in enumerate(site_shot.output):
            coordinates[site] = [x for part in parts for x in part.position(r, t - first)]
        return site_numbers(attribute, scales, coordinates)

    def attribute_group(self, attribute, first, site_shot):
        for part in self.file.attribute_groups:
            if (part.index, part.first_frame) == (attribute.index, first):
                scales, payloads = read_group_body(part, attribute.coded_channels())
                return scales, [decode_part(payload, part, site_shot) for payload in payloads]
        raise Corrupt("an attribute is missing in a group")

    def frame(self, t):
        """Step 4: (positions by output index, faces)."""
        number = self.number_of(t)
        group = self.file.groups[number]
        decoded = self.group(number)
        shot = self.shot(group.shot)
        positions = [None] * len(shot.rows)
        for r, index in enumerate(shot.output):
            positions[index] = decoded.position(r, t - group.first_frame)
        return positions, shot.faces
