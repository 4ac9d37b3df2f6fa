"""reference_mesh.md section 7: the output index of every coding vertex."""
import bisect

from .connectivity import NONE, after, before, coding_order, edges_from, find_twins
from .entropy import RangeDecoder
from .guesses import Guess, GuessMixture

SCALE = 2048


def decode_order(data, vertex_count, triangles):
    decoder = RangeDecoder(data)
    mixture = GuessMixture(9, 512)
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
        likely = 0
        if k > 0:
            likely = rank(output[u[k - 1]])
            guesses.append(Guess(0, 256 * likely, SCALE))
        beside = {turn[p] for h in fans[v] for p in (triangles[after(h)], triangles[before(h)])}
        for j, turn_of_neighbour in enumerate(sorted((t for t in beside if t < k), reverse=True)):
            r = rank(output[u[turn_of_neighbour]])
            likely = r if j == 0 else likely
            guesses.append(Guess(min(1 + j, 5), 256 * r, SCALE))
        r = mixture.decode(decoder, guesses, len(free), min(likely, len(free) - 1), 1)
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
