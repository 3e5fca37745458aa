"""Cuts the skin's inner pockets (mouth, eye sockets) off and closes it: one closed surface of genus 0.

The base mesh is already closed, but its mouth and eye sockets are bags folded inward. A bag's opening
is where it is narrowest, and the base mesh is modelled in rings around it: so we cut along the
shortest closed edge loop, drop the smaller side, and a little more of the rim.
"""

from collections import Counter, defaultdict

import numpy as np
import scipy.sparse as sparse

RINGS_OUTSIDE = 2  # cut this many rings before the narrowest, where lips and lids never touch
EYE_REACH = 1.35  # in eyeball radii: farther loops belong to the face, not to the eye


def closed_skin(mesh):
    """The quads of the skin without pockets."""
    quads = mesh.groups["body"]
    loops = [_mouth_loop(mesh, quads)] + [_eye_loop(mesh, quads, f"helper-{side}-eye") for side in "lr"]
    for loop in loops:
        quads = _larger_side(quads, loop)
        for _ in range(RINGS_OUTSIDE):
            quads, loop = _without_ring(quads, loop)
        quads = np.vstack([quads, _zipper(mesh.vertices, _against(quads, loop))])
    return quads


def triangulated(vertices, quads):
    """Splits each quad along its shorter diagonal."""
    a, b, c, d = quads.T
    length_ac = np.linalg.norm(vertices[a] - vertices[c], axis=1)
    length_bd = np.linalg.norm(vertices[b] - vertices[d], axis=1)
    split_ac = (length_ac <= length_bd)[:, None]
    first = np.where(split_ac, np.stack([a, b, c], 1), np.stack([a, b, d], 1))
    second = np.where(split_ac, np.stack([a, c, d], 1), np.stack([b, c, d], 1))
    return np.vstack([first, second])


def euler_characteristic(triangles):
    edges = np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    return len(np.unique(triangles)) - len(np.unique(edges, axis=0)) + len(triangles)


def is_closed_and_oriented(triangles):
    """Whether every edge is run through exactly once each way."""
    ways = Counter(map(tuple, triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)))
    return all(count == 1 and ways[b, a] == 1 for (a, b), count in ways.items())


def _mouth_loop(mesh, quads):
    """The narrowest ring that crosses the mid plane twice between nose and chin, inside the mouth."""
    oral = mesh.helper("helper-upper-teeth"), mesh.helper("helper-lower-teeth")
    teeth = mesh.vertices[np.concatenate(oral)]
    middle = np.unique(quads)
    middle = middle[mesh.mirror[middle] == middle]
    reach = 2 * np.ptp(teeth[:, 1])
    near = np.linalg.norm(mesh.vertices[middle] - teeth.mean(axis=0) * [0, 1, 1], axis=1) < reach
    loops = _closed_loops(quads, middle[near])
    crossing = [loop for loop in loops if np.isin(loop, middle).sum() == 2]
    return min(crossing, key=lambda loop: _length(mesh.vertices, loop))


def _eye_loop(mesh, quads, eyeball):
    ball = mesh.vertices[mesh.helper(eyeball)]
    centre = ball.mean(axis=0)
    radius = np.linalg.norm(ball - centre, axis=1).max()
    skin = np.unique(quads)
    near = skin[np.linalg.norm(mesh.vertices[skin] - centre, axis=1) < EYE_REACH * radius]
    loops = [loop for loop in _closed_loops(quads, near) if np.isin(loop, near).all()]
    return min(loops, key=lambda loop: _length(mesh.vertices, loop))


def _closed_loops(quads, starts):
    """All edge loops through `starts` that close: at each vertex of four edges they go straight on."""
    quads_at_edge = defaultdict(set)
    neighbours = defaultdict(set)
    for index, quad in enumerate(quads.tolist()):
        for a, b in zip(quad, quad[1:] + quad[:1]):
            quads_at_edge[frozenset((a, b))].add(index)
            neighbours[a].add(b)
            neighbours[b].add(a)

    def opposite(a, b):
        """The vertex straight on after walking from a to b, or None at an irregular vertex."""
        if len(neighbours[b]) != 4:
            return None
        here = quads_at_edge[frozenset((a, b))]
        return next((c for c in neighbours[b] if not quads_at_edge[frozenset((b, c))] & here), None)

    found = {}
    for start in starts.tolist():
        for second in sorted(neighbours[start]):
            loop = [start, second]
            while (following := opposite(loop[-2], loop[-1])) not in (None, start) and len(loop) < 200:
                loop.append(following)
            if following == start:
                found.setdefault(frozenset(loop), loop)
    return list(found.values())


def _length(vertices, loop):
    points = vertices[loop]
    return np.linalg.norm(points - np.roll(points, 1, axis=0), axis=1).sum()


def _larger_side(quads, loop):
    """Cuts along the loop; returns the larger of the two sides."""
    cut = {frozenset(edge) for edge in zip(loop, loop[1:] + loop[:1])}
    at_edge = defaultdict(list)
    for index, quad in enumerate(quads.tolist()):
        for edge in map(frozenset, zip(quad, quad[1:] + quad[:1])):
            if edge not in cut:
                at_edge[edge].append(index)
    pairs = np.array([pair for pair in at_edge.values() if len(pair) == 2])
    graph = sparse.coo_matrix((np.ones(len(pairs)), pairs.T), shape=(len(quads), len(quads)))
    count, side = sparse.csgraph.connected_components(graph, directed=False)
    assert count == 2, f"expected two sides, found {count}"
    return quads[side == np.bincount(side).argmax()]


def _without_ring(quads, loop):
    """Drops the ring of quads that borders on the loop; returns the rest and the next loop."""
    beside = np.isin(quads, loop).any(axis=1)
    inside = set(loop)
    step = {}
    for quad in quads[beside].tolist():
        for a, b in zip(quad, quad[1:] + quad[:1]):
            if (a in inside) != (b in inside):
                step.update({a: b} if a in inside else {b: a})
    return quads[~beside], [step[a] for a in loop]


def _against(quads, loop):
    """The loop in the direction against the quads beside it, as a patch that fills it must run."""
    ways = set(map(tuple, quads[:, [0, 1, 1, 2, 2, 3, 3, 0]].reshape(-1, 2)))
    return loop[::-1] if (loop[0], loop[1]) in ways else loop


def _zipper(vertices, loop):
    """Closes a slit from corner to corner: quads between its upper and lower rim, no new vertex."""
    count = len(loop)
    position = vertices[loop]
    index = np.arange(count)

    def rib_length(shift):
        return np.linalg.norm(position - position[(shift - index) % count], axis=1).sum()

    # Vertex k is joined to vertex shift - k. An odd shift has an edge at each corner of the slit.
    shift = min(range(1, count, 2), key=rib_length)
    upper = [(shift + 1) // 2 + k for k in range(count // 2)]
    rows = [(loop[k % count], loop[(shift - k) % count]) for k in upper]
    return np.array([[a, b, d, c] for (a, c), (b, d) in zip(rows, rows[1:])])

