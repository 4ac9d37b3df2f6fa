"""reference_mesh.md: half-edges (section 1), the order of points (2.2), polygons (4).

A list of triangles is flat: corner i of triangle t is triangles[3 t + i], and half-edge 3 t + i starts there.
"""
import heapq

NONE = -1


def after(h):
    """The next half-edge of the triangle."""
    return h - 2 if h % 3 == 2 else h + 1


def before(h):
    return h + 2 if h % 3 == 0 else h - 1


def find_twins(triangles):
    """Section 1: the twin of every half-edge, or NONE."""
    between = {}
    for h, start in enumerate(triangles):
        end = triangles[after(h)]
        between.setdefault((min(start, end), max(start, end)), []).append(h)
    twins = [NONE] * len(triangles)
    for edges in between.values():
        if len(edges) == 2 and triangles[edges[0]] != triangles[edges[1]]:
            twins[edges[0]], twins[edges[1]] = edges[1], edges[0]
    return twins


def edges_from(count, triangles):
    """The half-edges that start at each point, in order."""
    fans = [[] for _ in range(count)]
    for h, start in enumerate(triangles):
        fans[start].append(h)
    return fans


def coding_order(count, triangles):
    """Section 2.2, first paragraph."""
    fans = edges_from(count, triangles)
    coded = [False] * count
    ready = [0] * count  # triangles with both other corners coded, 6 at most
    waiting = []  # (-number, when it came to that number, point)
    clock = 0
    lowest = 0
    order = []
    while len(order) < count:
        point = NONE
        while waiting and point == NONE:
            number, _, candidate = heapq.heappop(waiting)
            if not coded[candidate] and ready[candidate] == -number:
                point = candidate
        if point == NONE:
            while coded[lowest]:
                lowest += 1
            point = lowest
        coded[point] = True
        order.append(point)
        for h in fans[point]:
            a, b = triangles[after(h)], triangles[before(h)]
            if coded[a] != coded[b]:
                other = b if coded[a] else a
                if ready[other] < 6:
                    ready[other] += 1
                    clock += 1
                    heapq.heappush(waiting, (-ready[other], clock, other))
    return order


def join_triangles(triangles, twins, inside):
    """Section 4: the polygons, as lists of points; None where triangles do not form trees."""
    if not forest(triangles, twins, inside):
        return None
    polygons = []
    walked = set()
    for first in range(len(triangles)):
        if inside[first] or first in walked:
            continue
        polygon = []
        h = first
        while True:
            polygon.append(triangles[h])
            walked.add(h)
            h = after(h)
            while inside[h]:
                h = after(twins[h])
            if h == first:
                break
        polygons.append(polygon)
    return polygons


def forest(triangles, twins, inside):
    """Whether the triangles that inside edges join form trees and nothing else."""
    count = len(triangles) // 3
    parent = list(range(count))

    def root(t):
        while parent[t] != t:
            t = parent[t]
        return t

    for h in range(len(triangles)):
        if inside[h] and twins[h] > h:
            a, b = root(h // 3), root(twins[h] // 3)
            if a == b:
                return False
            parent[a] = b
    return True
