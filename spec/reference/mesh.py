"""reference_mesh.md: the coded mesh, sections 3 to 6."""
from dataclasses import dataclass

from .bytes import Reader
from .connectivity import decode_connectivity
from .container import FACE_ORDER_KEPT, ORDER_KEPT, PLAIN, read_mesh_header
from .entropy import EVEN, AdaptiveBit, ExpGolomb, IntervalDecoder, SignedInteger
from .errors import Corrupt, Truncated, require
from .fast import Order, Walk, decode_plain_order, decode_positions
from .guesses import Guess, GuessMixture
from .half_edges import NONE, after, find_twins, join_triangles
from .order import arrange_faces, decode_order
from .points import GRID_SIZE, PointDecoder


@dataclass
class Mesh:
    grid: list  # grid position of each coding vertex
    triangles: list  # three coding vertices each, flat; none with two equal corners
    output: list  # output index of each coding vertex
    faces: list  # output indices of the corners of each face
    plain_order: Order = None  # rows of a plain mesh


class Rest:
    """The section *rest*, section 2 of the chapter."""

    def __init__(self, data, header, point_count, triangles, most_corners):
        self.decoder = IntervalDecoder(data)
        self.header = header
        self.triangles = triangles
        self.twins = find_twins(triangles)
        self.plain = header.flags & PLAIN != 0
        if self.plain:
            self.point_position = [(0, 0, 0)] * point_count
        else:
            self.point_position = PointDecoder(self.decoder, point_count, triangles).decode_all()
        self.grid = []
        self.vertex_of_point = []
        self.decode_split_points()
        self.inside = [0] * len(triangles)
        self.decode_polygons()
        self.polygons = join_triangles(triangles, self.twins, self.inside)
        require(self.polygons is not None, "polygons overlap themselves")
        if not self.plain:
            self.decode_loose_vertices()
        self.listed = []
        self.decode_listed_faces(most_corners)
        self.decoder.check()

    def decode_split_points(self):
        """Section 3."""
        same = [AdaptiveBit(), AdaptiveBit()]
        which = ExpGolomb()
        at = {}  # vertices by position, oldest first
        for position in self.point_position:
            here = at.setdefault(position, [])
            if here and same[min(len(here), 2) - 1].decode(self.decoder):
                back = which.decode(self.decoder)
                require(back < len(here), "a split point joins no vertex")
                self.vertex_of_point.append(here[-1 - back])
                continue
            require(len(self.grid) < self.header.vertex_count, "more points than vertices")
            self.decoder.check()
            here.append(len(self.grid))
            self.vertex_of_point.append(len(self.grid))
            self.grid.append(position)

    def decode_polygons(self):
        """Section 4."""
        if not self.decoder.decode(EVEN):
            return
        decided = [0] * (len(self.triangles) // 3)
        marked = list(decided)
        models = {}

        def state(t):
            return min(decided[t], 2) * 3 + min(marked[t], 2)

        for h in range(len(self.triangles)):
            twin = self.twins[h]
            if twin == NONE:
                decided[h // 3] += 1
            elif twin > h:
                a, b = h // 3, twin // 3
                context = (state(a), state(b), self.longest(h) + self.longest(twin))
                bit = models.setdefault(context, AdaptiveBit()).decode(self.decoder)
                self.inside[h] = self.inside[twin] = bit
                for t in (a, b):
                    decided[t] += 1
                    marked[t] += bit
                self.decoder.check()

    def longest(self, h):
        """1 where half-edge h is a longest side of its triangle."""
        def length2(g):
            p, q = (self.point_position[self.triangles[e]] for e in (g, after(g)))
            return sum((p[i] - q[i]) ** 2 for i in range(3))

        own = length2(h)
        return 1 if own >= length2(after(h)) and own >= length2(after(after(h))) else 0

    def decode_loose_vertices(self):
        """Section 5."""
        mixture = GuessMixture(9, 256)
        x1, x2, t = [0] * 3, [0] * 3, [0] * 3
        while len(self.grid) < self.header.vertex_count:
            position = []
            for axis in range(3):
                places = (256 * x1[axis] + 128, 256 * (2 * x1[axis] - x2[axis]) + 128, 256 * x2[axis] + 128)
                guesses = [Guess(3 * axis + i, place, 128 + 8 * t[axis]) for i, place in enumerate(places)]
                x = mixture.decode(self.decoder, guesses, GRID_SIZE)
                t[axis] = t[axis] + abs(x - x1[axis]) - t[axis] // 16
                x2[axis], x1[axis] = x1[axis], x
                position.append(x)
            self.decoder.check()
            self.grid.append(tuple(position))

    def decode_listed_faces(self, most_corners):
        """Section 6."""
        require(self.header.face_count >= len(self.polygons), "fewer faces than polygons")
        size, step = ExpGolomb(), SignedInteger()
        corner = corners = 0
        for _ in range(self.header.face_count - len(self.polygons)):
            face = []
            count = size.decode(self.decoder) + 1
            corners += count
            require(corners <= most_corners, "more face corners than the bytes can hold")
            for _ in range(count):
                corner += step.decode(self.decoder)
                require(0 <= corner < self.header.vertex_count, "a listed face has no such vertex")
                self.decoder.check()
                face.append(corner)
            self.listed.append(face)


def decode_mesh(data):
    """A coded mesh."""
    reader = Reader(data)
    try:
        header = read_mesh_header(reader)
        lengths = (header.draco_bytes, header.rest_bytes, header.position_bytes, header.order_bytes, header.face_bytes)
        draco, rest, position, order, arrangement = (reader.take(n) for n in lengths)
    except Truncated:
        raise Corrupt("the mesh's sections do not fit")
    require(reader.remaining() == 0, "sections do not fill the mesh")
    most = 64 * len(data)
    require(max(header.vertex_count, header.face_count) <= most, "more vertices or faces than the bytes can hold")
    point_count, triangles = decode_connectivity(draco, most)
    parts = Rest(rest, header, point_count, triangles, most)
    vertex = parts.vertex_of_point
    coding_triangles = [[vertex[p] for p in triangles[i:i + 3]] for i in range(0, len(triangles), 3)]
    for face in parts.listed:
        coding_triangles += [[face[0], face[i], face[i + 1]] for i in range(1, len(face) - 1)]
    flat = [v for t in coding_triangles if len(set(t)) == 3 for v in t]
    grid, plain_order = parts.grid, None
    if header.flags & PLAIN:
        plain_order = Order(header.vertex_count, flat)
        walk = Walk(header.vertex_count, flat)
        grid = decode_positions(position, walk)
    if not header.flags & ORDER_KEPT:
        require(not order, "an order where none is kept")
        output = list(range(header.vertex_count))
    elif header.flags & PLAIN:
        output = decode_plain_order(order, walk)
    else:
        output = decode_order(order, header.vertex_count, flat)
    faces = [[output[vertex[p]] for p in polygon] for polygon in parts.polygons]
    faces += [[output[v] for v in face] for face in parts.listed]
    if header.flags & FACE_ORDER_KEPT:
        faces = arrange_faces(arrangement, header.vertex_count, faces)
    return Mesh(grid, flat, output, faces, plain_order)
