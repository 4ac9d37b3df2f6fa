"""reference_mesh.md sections 7 and 8: the output index of every coding vertex, and of every face."""
import bisect

from .half_edges import NONE, after, before, coding_order, edges_from, find_twins
from .entropy import IntervalDecoder, adaptive_bits
from .guesses import Guess, GuessMixture

SCALE = 2048


def decode_order(data, vertex_count, triangles):
    return decode_indices(IntervalDecoder(data), vertex_count, triangles)


def decode_indices(decoder, vertex_count, triangles, expected=None):
    """Section 7; `expected`: an index that each vertex is guessed to have, of kind 9."""
    mixture = GuessMixture(10, 512)
    twins = find_twins(triangles)
    fans = edges_from(vertex_count, triangles)
    u = coding_order(vertex_count, triangles)
    turn = [0] * vertex_count
    for k, v in enumerate(u):
        turn[v] = k
    output = [None] * vertex_count
    free = list(range(vertex_count))

    def rank(index):
        """Free indices below."""
        return bisect.bisect_left(free, index)

    for k, v in enumerate(u):
        guesses = []
        for j, index in enumerate(parallelogram_indices(v, k, triangles, twins, fans, turn, output)):
            guesses.append(Guess(min(6 + j, 8), 256 * rank(index), SCALE))
        if k > 0:
            guesses.append(Guess(0, 256 * rank(output[u[k - 1]]), SCALE))
        beside = {turn[p] for h in fans[v] for p in (triangles[after(h)], triangles[before(h)])}
        for j, turn_of_neighbour in enumerate(sorted((t for t in beside if t < k), reverse=True)):
            guesses.append(Guess(min(1 + j, 5), 256 * rank(output[u[turn_of_neighbour]]), SCALE))
        if expected is not None:
            guesses.append(Guess(9, 256 * rank(expected[v]), SCALE))
        r = mixture.decode(decoder, guesses, len(free))
        decoder.check()
        output[v] = free.pop(r)
    return output


def parallelogram_indices(v, k, triangles, twins, fans, turn, output):
    """o(a) + o(b) - o(c), where that is an index."""
    found = []
    for h in fans[v]:
        ab = after(h)
        if twins[ab] == NONE:
            continue
        a, b, c = triangles[ab], triangles[after(ab)], triangles[before(twins[ab])]
        if max(turn[a], turn[b], turn[c]) < k:
            index = output[a] + output[b] - output[c]
            if 0 <= index < len(output):
                found.append(index)
    return found


def arrange_faces(data, vertex_count, faces):
    """Section 8: the faces in the order of the output, each from its first corner on."""
    decoder = IntervalDecoder(data)
    expected = [min(face) * len(faces) // vertex_count for face in faces]
    index = decode_indices(decoder, len(faces), dual_triangles(faces), expected)
    arranged = [None] * len(faces)
    for face, place in zip(faces, index):
        arranged[place] = face
    models = [[adaptive_bits(4) for _ in range(5)] for _ in range(4)]
    face_before, last = [], 0
    for place, face in enumerate(arranged):
        at = face.index(min(face))
        passed = 0
        while passed + 1 < len(face):
            vertex = face[at]
            where = face_before.index(vertex) if vertex in face_before else 4
            if models[min(passed, 3)][where][last].decode(decoder):
                break
            passed += 1
            at = (at + 1) % len(face)
        decoder.check()
        last = min(passed, 3)
        arranged[place] = face[at:] + face[:at]
        face_before = arranged[place][:4]
    return arranged


def dual_triangles(faces):
    edges = {}
    for f, face in enumerate(faces):
        for i, v in enumerate(face):
            w = face[(i + 1) % len(face)]
            edges.setdefault((min(v, w), max(v, w)), []).append(f)
    triangles = []
    for f, face in enumerate(faces):
        across = []
        for i, v in enumerate(face):
            w = face[(i + 1) % len(face)]
            beside = edges[min(v, w), max(v, w)]
            if len(beside) == 2 and beside[0] != beside[1]:
                across.append(beside[0] + beside[1] - f)
        for i, n in enumerate(across):
            following = across[(i + 1) % len(across)]
            if n != following:
                triangles += [f, n, following]
    return triangles
