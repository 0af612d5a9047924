#!/usr/bin/env python3
"""Writes the meshes that restyle ships, a two-stage gearbox and a bracket, from formulas.

    python3 make.py               write every file beside this script
    python3 make.py --check       compare instead; exit 1 if a file differs, is missing or is not made here
    python3 make.py --layers [N]  count the surfaces along N x N parallel rays of the default view (200)

glTF 2.0 binary in metres; here lengths are in millimetres and angles in radians unless a name says otherwise. Standard library only.

The shafts run along z in the plane y = 0, where the housing is split; the root node turns all of it for the default view along -z.
The parts are faces of four kinds (revolved, ruled, lofted, and flat with holes), sewn along their edges; no boolean operations.
Every part is checked: closed, wound counter-clockwise outside, without degenerate triangles, of positive volume.

Teeth: basic rack of ISO 53, profile A (pressure angle 20 degrees, addendum 1, dedendum 1.25, tip rounding 0.38 modules); involute and
root fillet as textbooks derive them from that rack. The first stage is helical, its helix angle chosen for the centre distance.
Bearings have the bore, outside diameter and width of 6205 and 6208 (ISO 15); what is inside of them is ours. Bolts, nuts, washers, socket
screws and keys have the main dimensions that handbooks give after ISO 4014, 4032, 7089, 4762 and DIN 6885; the rest is ours.
"""

import json
import math
import struct
import sys
from collections import Counter
from pathlib import Path

HERE = Path(__file__).resolve().parent
TAU = 2 * math.pi
# Radial play of shafts in bores, and of what sits in the housing: more than the sagitta of the facets, so that none shows through.
FIT, SEAT = 0.1, 0.15


# --- vectors ----------------------------------------------------------------


def add(a, b):
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def scale(a, s):
    return (a[0] * s, a[1] * s, a[2] * s)


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    return scale(a, 1 / math.sqrt(dot(a, a)))


def steps(a, b, count):
    """count + 1 numbers from a to b."""
    return [a + (b - a) * i / count for i in range(count + 1)]


# --- outlines in the plane: lists of pieces, each a list of (point, outward normal) ------------------------------


def arc(x, y, radius, start, end, count, outward=1):
    return [
        ((x + radius * math.cos(a), y + radius * math.sin(a)), (outward * math.cos(a), outward * math.sin(a)))
        for a in steps(start, end, count)
    ]


def line(p, q):
    """Its normal points to the right of the way from p to q."""
    length = math.dist(p, q)
    n = ((q[1] - p[1]) / length, (p[0] - q[0]) / length)
    return [(p, n), (q, n)]


def outline(corners, closed=True, count=4):
    """Straight lines through corners (x, y) or (x, y, size): a size > 0 rounds the corner, a size < 0 cuts it off.

    Counter-clockwise about the material, so that normals point outward.
    """
    n = len(corners)
    ends, bends = [], []
    for i, corner in enumerate(corners):
        p, size = corner[:2], corner[2] if len(corner) > 2 else 0.0
        if not size or not closed and i in (0, n - 1):
            ends.append((p, p))
            bends.append([])
            continue
        before, after = corners[i - 1][:2], corners[(i + 1) % n][:2]
        u, v = [((q[0] - p[0]) / math.dist(p, q), (q[1] - p[1]) / math.dist(p, q)) for q in (before, after)]
        turn = math.acos(max(-1.0, min(1.0, -(u[0] * v[0] + u[1] * v[1]))))
        left = 1 if u[1] * v[0] - u[0] * v[1] > 0 else -1
        cut = size * math.tan(turn / 2) if size > 0 else -size
        a, b = [(p[0] + cut * w[0], p[1] + cut * w[1]) for w in (u, v)]
        ends.append((a, b))
        if size < 0:
            bends.append([line(a, b)])
            continue
        # The centre lies to the left of the incoming direction -u where the way turns left.
        centre = (a[0] + left * size * u[1], a[1] - left * size * u[0])
        start = math.atan2(a[1] - centre[1], a[0] - centre[0])
        bends.append([arc(*centre, size, start, start + left * turn, count, left)])
    pieces = []
    for i in range(n if closed else n - 1):
        pieces += bends[i]
        p, q = ends[i][1], ends[(i + 1) % n][0]
        if math.dist(p, q) > 1e-9:
            pieces.append(line(p, q))
    return pieces


def points(pieces):
    """The points of a closed outline, each once."""
    return [p for piece in pieces for p, _ in piece[:-1]]


def path(pieces):
    """The points of an open outline, each once."""
    return points(pieces) + [pieces[-1][-1][0]]


def circle(x, y, radius, count, start=0.0):
    return [(x + radius * math.cos(start + TAU * i / count), y + radius * math.sin(start + TAU * i / count)) for i in range(count)]


def shifted(pieces, offset):
    """The outline moved inward: exact for round and straight pieces."""
    return [[((p[0] - offset * n[0], p[1] - offset * n[1]), n) for p, n in piece] for piece in pieces]


def rounding(radius, count):
    """Rows of an edge rounding, from the side to the top: (inward offset, distance below the top, share of side and of top normal)."""
    return [(radius * (1 - math.cos(a)), radius * (1 - math.sin(a)), math.cos(a), math.sin(a)) for a in steps(0, TAU / 4, count)]


# --- flat faces: ear clipping -----------------------------------------------


def side_of(a, b, c):
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def area_of(loop):
    return sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(loop, loop[1:] + loop[:1])) / 2


def order(p):
    """To compare points by, alike on all machines: last bits do not count."""
    return round(p[0], 6), round(p[1], 6)


def holds(loop, p):
    """Whether the loop is around p, by the crossings of a ray."""
    inside = False
    for a, b in zip(loop, loop[1:] + loop[:1]):
        if (a[1] > p[1]) != (b[1] > p[1]) and p[0] < a[0] + (p[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]):
            inside = not inside
    return inside


def bridged(outer, holes):
    """One loop: each hole, rightmost first, joined to the nearest corner that it sees."""
    holes = sorted(holes, key=lambda h: max(map(order, h)), reverse=True)
    loop = list(outer)
    for number, hole in enumerate(holes):
        start = max(range(len(hole)), key=lambda i: order(hole[i]))
        p = hole[start]
        edges = [e for other in [loop, *holes[number:]] for e in zip(other, other[1:] + other[:1])]

        def seen(i):
            q = loop[i]
            for a, b in edges:
                if p in (a, b) or q in (a, b):
                    continue
                if side_of(p, q, a) * side_of(p, q, b) < 1e-6 and side_of(a, b, p) * side_of(a, b, q) < 1e-6:
                    return False
            # The way in must lie in the corner: a corner that bridges meet in is there more than once.
            a, b = loop[i - 1], loop[(i + 1) % len(loop)]
            if side_of(a, q, b) > -1e-6:
                return side_of(a, q, p) > 1e-6 and side_of(q, b, p) > 1e-6
            return side_of(a, q, p) > 1e-6 or side_of(q, b, p) > 1e-6

        i = next(i for i in sorted(range(len(loop)), key=lambda i: round(math.dist(loop[i], p), 6)) if seen(i))
        loop = loop[: i + 1] + hole[start:] + hole[: start + 1] + loop[i:]
    return loop


def ears(loop):
    """Triangles of a simple counter-clockwise loop; of the ears that there are, the one with the shortest cut goes first."""
    before = {i: i - 1 for i in range(len(loop))}
    after = {i: i + 1 for i in range(len(loop))}
    before[0], after[len(loop) - 1] = len(loop) - 1, 0

    def cut(i):
        a, b, c = loop[before[i]], loop[i], loop[after[i]]
        if side_of(a, b, c) < 1e-7:
            return None
        for j in after:
            p = loop[j]
            if p not in (a, b, c) and side_of(a, b, p) >= -1e-9 and side_of(b, c, p) >= -1e-9 and side_of(c, a, p) >= -1e-9:
                return None
        return round(math.dist(a, c), 5)

    cuts = {i: cut(i) for i in after}
    triangles = []
    while len(after) > 3:
        i = min((i for i, c in cuts.items() if c is not None), key=cuts.get)
        a, b = before.pop(i), after.pop(i)
        del cuts[i]
        triangles.append((loop[a], loop[i], loop[b]))
        after[a], before[b] = b, a
        cuts[a], cuts[b] = cut(a), cut(b)
    a = next(iter(after))
    triangles.append((loop[before[a]], loop[a], loop[after[a]]))
    return triangles


def regions(loops):
    """Loops of the symmetric difference of all loops: edges that are there twice cancel, whole or in part."""
    known = {}
    loops = [[known.setdefault((round(x * 1e5 + 0.237), round(y * 1e5 + 0.237)), (x, y)) for x, y in loop] for loop in loops]
    corners = [known[k] for k in sorted(known)]
    count = Counter()
    for loop in loops:
        for a, b in zip(loop, loop[1:] + loop[:1]):
            length, on = math.dist(a, b), []
            low, high = min(a[0], b[0]) - 1e-6, max(a[0], b[0]) + 1e-6
            for i, p in enumerate(corners):
                if low <= p[0] <= high and abs(side_of(a, b, p)) < 1e-6 * length:
                    t = ((p[0] - a[0]) * (b[0] - a[0]) + (p[1] - a[1]) * (b[1] - a[1])) / length
                    if -1e-6 < t < length + 1e-6:
                        on.append((t, i))
            on = [i for _, i in sorted(on)]
            for i, j in zip(on, on[1:]):
                count[min(i, j), max(i, j)] += 1
    next_to = {}
    for (p, q), times in sorted(count.items()):
        if times % 2:
            next_to.setdefault(p, []).append(q)
            next_to.setdefault(q, []).append(p)
    found = []
    while next_to:
        p = start = min(next_to)
        loop = []
        while True:
            loop.append(corners[p])
            q = next_to[p].pop(0)
            next_to[q].remove(p)
            for r in (p, q):
                if not next_to[r]:
                    del next_to[r]
            p = q
            if p == start:
                break
        found.append(loop)
    return found


def filled(loops):
    """Triangles of the area within an odd number of the loops."""
    depth = [sum(holds(other, loop[0]) for other in loops if other is not loop) for loop in loops]
    turned = [loop if (area_of(loop) > 0) == (d % 2 == 0) else loop[::-1] for loop, d in zip(loops, depth)]
    triangles = []
    for outer, d in zip(turned, depth):
        if d % 2 == 0:
            holes = [h for h, e in zip(turned, depth) if e == d + 1 and holds(outer, h[0])]
            triangles += ears(bridged(outer, holes))
    return triangles


# --- solids -----------------------------------------------------------------


def key(p):
    """One for all points that are meant to be one; the shift keeps round numbers away from where rounding changes."""
    return (round(p[0] * 2000 + 0.237), round(p[1] * 2000 + 0.237), round(p[2] * 2000 + 0.237))


class Solid:
    """Triangles with a normal at each corner; which way round they go follows from the normals."""

    def __init__(self):
        self.triangles = []

    def triangle(self, *corners):
        (a, m), (b, n), (c, o) = corners
        if len({key(a), key(b), key(c)}) == 3:
            outside = dot(cross(sub(b, a), sub(c, a)), add(m, add(n, o))) > 0
            self.triangles.append(corners if outside else (corners[0], corners[2], corners[1]))

    def grid(self, rows):
        """A surface through rows of (point, normal)."""
        for low, high in zip(rows, rows[1:]):
            for a, b, c, d in zip(low, low[1:], high, high[1:]):
                # The shorter diagonal, the same one for all that are as good as equal.
                if math.dist(a[0], d[0]) < math.dist(b[0], c[0]) - 1e-6:
                    self.triangle(a, b, d)
                    self.triangle(a, d, c)
                else:
                    self.triangle(a, b, c)
                    self.triangle(b, d, c)

    def flat(self, loops, place, normal):
        """The area within an odd number of plane loops; `place` puts a point of their plane into space."""
        for triangle in filled(regions(loops)):
            self.triangle(*[(place(p), normal) for p in triangle])

    def wall(self, pieces, low, high):
        """Straight up from an outline; low and high put a point of the plane into space."""
        for piece in pieces:
            rows = []
            for put in (low, high):
                origin = put((0.0, 0.0))
                rows.append([(put(p), sub(put(n), origin)) for p, n in piece])
            self.grid(rows)

    def hole(self, centre, radius, count, low, high):
        """A round hole between two planes; answers its loop in the plane."""
        self.wall([arc(*centre, radius, 0, TAU, count, -1)], low, high)
        return circle(*centre, radius, count)

    def revolve(self, pieces, count, start=0.0):
        """About z, from an outline of (radius, z)."""
        turns = circle(0, 0, 1, count, start)
        turns.append(turns[0])
        for piece in pieces:
            self.grid([[((r * c, r * s, z), (m * c, m * s, n)) for c, s in turns] for (r, z), (m, n) in piece])

    def split(self, edges, name):
        """Splits the triangles beside edges without a neighbour at a corner that lies on the edge."""
        loose = {e for e in edges if edges[e] != edges[e[1], e[0]]}
        ends = {k for e in loose for k in e}
        corners = {}
        for t in self.triangles:
            for p, _ in t:
                if key(p) in ends:
                    corners.setdefault(key(p), p)
        result = []
        for t in self.triangles:
            for i in range(3):
                (a, m), (b, n), c = t[i], t[(i + 1) % 3], t[(i + 2) % 3]
                e = (key(a), key(b))
                if e not in loose:
                    continue
                way, length = sub(b, a), math.dist(a, b)
                shares = [(dot(sub(p, a), way) / length**2, p) for k, p in corners.items() if k not in e]
                on = [(s, p) for s, p in shares if 0 < s < 1 and math.dist(p, add(a, scale(way, s))) < 1e-4]
                if on:
                    share, p = min(on, key=lambda o: round(abs(o[0] - 0.5), 6))
                    middle = (p, unit(add(scale(m, 1 - share), scale(n, share))))
                    result += [((a, m), middle, c), (middle, (b, n), c)]
                    break
            else:
                result.append(t)
        if len(result) == len(self.triangles):
            raise SystemExit(f"{name}: {len(loose)} edges without a neighbour, near {sorted(corners.values())[:4]}")
        self.triangles = result

    def sewn(self, name):
        """Closed by splitting edges, then checked for what a solid must be; answers itself."""
        while True:
            edges = Counter((key(t[i][0]), key(t[(i + 1) % 3][0])) for t in self.triangles for i in range(3))
            if all(edges[e] == edges.get((e[1], e[0])) for e in edges):
                break
            self.split(edges, name)
        if any(times != 1 for times in edges.values()):
            raise SystemExit(f"{name}: an edge with more than two faces, near {next(e for e in edges if edges[e] != 1)}")
        volume = 0.0
        for (a, _), (b, _), (c, _) in self.triangles:
            volume += dot(a, cross(b, c)) / 6
            double = cross(sub(b, a), sub(c, a))
            if dot(double, double) < 1e-8:
                raise SystemExit(f"{name}: a degenerate triangle at {a}")
        if volume <= 0:
            raise SystemExit(f"{name}: inside out")
        return self


def revolved(corners, count, closed=True, rounds=3):
    solid = Solid()
    solid.revolve(outline(corners, closed, rounds), count)
    return solid


def level(z):
    return lambda p: (p[0], p[1], z)


# --- gears ------------------------------------------------------------------


def tooth(teeth, module, helix, play=0.06):
    """One side of a tooth in the transverse plane, from root to tip: (radius, angle, angle of the outward normal).

    Both angles count from the middle of the tooth. `play` is the thinning of a tooth, as an arc of the reference circle.
    """
    transverse = module / math.cos(helix)
    pressure = math.atan(math.tan(math.radians(20)) / math.cos(helix))
    r = teeth * transverse / 2
    addendum, dedendum, tip = module, 1.25 * module, 0.38 * module
    pitch = TAU / teeth
    flank = []
    # The root is what the rounded tip of the rack's tooth sweeps: its normal goes through the pitch point.
    b = dedendum - tip
    c = (math.pi * transverse / 2 + play) / 2 - b * math.tan(pressure) - tip / math.cos(pressure)
    for psi in steps(0, TAU / 4 - pressure, 2 if teeth < 40 else 1):
        x = b * math.tan(psi)
        foot = (x + tip * math.sin(psi), r - b - tip * math.cos(psi))
        roll = (x - c) / r
        angle = math.atan2(foot[0], foot[1]) - roll  # from the middle of the gap
        flank.append((math.hypot(*foot), angle - pitch / 2, -psi - roll - pitch / 2))
    # Involute: half the tooth's angle at radius q is its half at the reference circle, plus inv(pressure) - inv(angle at q).
    inv = lambda a: math.tan(a) - a
    half = (math.pi * transverse / 2 - play) / (2 * r) + inv(pressure)
    base = r * math.cos(pressure)
    top = r + addendum
    first = flank[-1][0]
    for q in steps(math.sqrt(first - base), math.sqrt(top - base), 4 if teeth < 40 else 3)[1:]:
        q = base + q * q
        a = math.acos(base / q)
        angle = inv(a) - half
        flank.append((q, angle, angle - TAU / 4 + a))
    return flank


def gear(teeth, module, width, bore, helix=0.0, hand=1, slices=1, rings=1, web=None):
    """A wheel about z with the middle of a tooth at angle 0 in the plane z = 0; `rings` facets of the bore for each tooth.

    `web`: radius within the rim, radius of the hub, width of the hub, thickness of the web, and number, circle and radius of its holes.
    """
    solid = Solid()
    chamfer = 0.6
    left = tooth(teeth, module, helix)
    right = [(q, -a, -n) for q, a, n in reversed(left)]
    top, pitch = left[-1][0], TAU / teeth
    lead = hand * math.tan(helix) / (teeth * module / math.cos(helix) / 2)
    land = [(top, left[-1][1], 0.0), (top, right[0][1], 0.0)]
    root = [(right[-1][0], right[-1][1], pitch / 2), (right[-1][0], left[0][1] + pitch, pitch / 2)]
    heights = steps(-width / 2, width / 2, slices)
    # The chamfer of the tips reaches into the last facet of each flank.
    if left[-2][0] > top - chamfer:
        raise SystemExit(f"gear with {teeth} teeth: the chamfer cuts more than one facet")

    def corner(q, angle, normal, z, k):
        turn = lead * z + k * pitch
        return (q * math.cos(angle + turn), q * math.sin(angle + turn), z), (math.cos(normal + turn), math.sin(normal + turn), 0.0)

    def tip(q, angle, normal, k, end):
        """At the chamfer: the point where the edge begins to be cut, on the way to the next slice, and the one that it is cut to."""
        if q <= top - chamfer:
            at = corner(q, angle, normal, end * width / 2, k)
            return at, at
        (a, n), (b, _) = [corner(q, angle, normal, z, k) for z in ((heights[0], heights[1]) if end < 0 else (heights[-1], heights[-2]))]
        return (add(a, scale(sub(b, a), chamfer * slices / width)), n), (corner(top - chamfer, angle, normal, end * width / 2, k)[0], n)

    step = pitch / rings
    inner = web[0] if web else bore + 1
    for k in range(teeth):
        for piece in (left, land, right, root):
            smooth, sharp = (piece, []) if piece is root else (piece[:-1], piece[-2:]) if piece is left else (piece[1:], piece[:2])
            if piece is land:
                smooth, sharp = [], land
            solid.grid([[corner(*c, z, k) for c in smooth] for z in heights])
            if sharp:
                ends = [[tip(*c, k, end) for c in sharp] for end in (-1, 1)]
                solid.grid([[e[0] for e in ends[0]], *[[corner(*c, z, k) for c in sharp] for z in heights[1:-1]], [e[0] for e in ends[1]]])
                for end, corners in zip((-1, 1), ends):
                    # A chamfer of 45 degrees on the land; beside it a sliver of the flank.
                    turned = [[(p, unit(add(n, (0.0, 0.0, float(end)))) if piece is land else n) for p, n in row] for row in zip(*corners)]
                    solid.grid(turned)
        for end in (-1, 1):
            z = end * width / 2
            loop = [corner(min(q, top - chamfer), a, n, z, k)[0][:2] for q, a, n in left + right + root[1:]]
            # The ring of the bore does not follow the helix.
            first = k * rings + round(lead * z / step)
            loop += [(inner * math.cos(a), inner * math.sin(a)) for a in ((first + i) * step - pitch / 2 for i in range(rings, -1, -1))]
            for t in ears(loop):
                solid.triangle(*[((*p, z), (0.0, 0.0, float(end))) for p in t])
    top, count = width / 2, teeth * rings
    turn = lambda path, n: solid.revolve(outline(path, False, 2), n, -pitch / 2)
    if not web:
        turn([(inner, top), (bore, top - 1), (bore, 1 - top), (inner, -top)], count)
        return solid
    rim, hub, hub_width, thick, holes, on, radius = web
    t, h = thick / 2, hub_width / 2
    far, near, hub_count = rim - 5, hub + 5, 40
    turn([(rim, top), (rim - 1.5, t, 3), (far, t)], count)
    turn(
        [(near, t), (hub + 1.5, t, 3), (hub, h, -1), (bore, h, -1), (bore, -h, -1), (hub, -h, -1), (hub + 1.5, -t, 3), (near, -t)],
        hub_count,
    )
    turn([(far, -t), (rim - 1.5, -t, 3), (rim, -top)], count)
    windows = [solid.hole(c, radius, 16, level(-t), level(t)) for c in circle(0, 0, on, holes)]
    for z in (-t, t):
        edges = [circle(0, 0, far, count, -pitch / 2), circle(0, 0, near, hub_count, -pitch / 2)]
        solid.flat(edges + windows, level(z), (0.0, 0.0, math.copysign(1.0, z)))
    return solid


# --- housing ----------------------------------------------------------------

SHAFT_X = (-131.0, -41.0, 71.5)  # input, intermediate and output shaft: centre distances 90 and 112.5
BORE = (26.0, 26.0, 40.0)  # bearing seats
BOSS = (37.0, 37.0, 53.0)
CROWN = (48.0, 88.0, 107.0)  # the cover goes around the wheels in arcs about the shafts
WALL = 9.0
ROUND, INNER_ROUND = 8.0, 8.0  # of the cast edges, outside and inside
SIDE = 55.0  # half the width, outside
FLANGE_X, FLANGE_Z, FLANGE = 203.0, 76.0, 12.0  # half length, half width and thickness of each flange
FACE = 79.0  # where the bosses end
EDGE = 1.5  # rounding of flanges and bosses
# The fillet between wall and boss: beyond the boss's radius, off the wall, and the normal's shares along radius and axis.
FILLET = [(2.5 * (1 - math.sin(a)), 2.5 * (1 - math.cos(a)), math.sin(a), math.cos(a)) for a in steps(0, TAU / 4, 2)]
FLOOR, FOOT = -109.0, -95.0  # bottom, and top of the feet
ENDS = (SHAFT_X[0] - CROWN[0], SHAFT_X[2] + CROWN[2])
BOLTS = [(x, z) for x in (-187.0, -86.0, 6.0, 138.0, 187.0) for z in (-65.5, 65.5)] + [(-191.0, 0.0), (191.0, 0.0)]
DOWELS = [(-191.0, -30.0), (191.0, 30.0)]
BOLT_HOLE, DOWEL = 4.5, 4.0
CAP_SCREWS = [(31.5, 2.7, [TAU * (k + 0.5) / 4 for k in range(4)])] * 2 + [(46.5, 3.3, [TAU * (k + 0.5) / 6 for k in range(6)])]
SIGHT = (-46.0, 20.0, 15.0)  # y, z and radius of the hole in the wall at the output end
DRAIN = (-80.0, -20.0, 8.0)
# Where the cooling coil comes out at the other end: y, z, radius of the hole.
COIL = [(-84.0, -30.0, 7.0), (-84.0, 30.0, 7.0)]
# The opening on the flat of the cover between the arcs about the last two shafts: half lengths along x and z, corner.
OPENING = (30.0, 24.0, 6.0)
LID_SCREWS = [(x, z) for x in (-36.0, 36.0) for z in (-28.0, 28.0)]
# A rib under each boss of the base, in plan from its shaft: out of the wall, round in front, back into the wall.
RIB_HALF = 6.0
RIB = outline([(RIB_HALF, SIDE), (RIB_HALF, 72.0, 4.0), (-RIB_HALF, 72.0, 4.0), (-RIB_HALF, SIDE)], False)


def ground(y):
    """Puts a point (x, z) at a height."""
    return lambda p: (p[0], y, p[1])


def box(x0, x1, y0, y1, corner=0.0, count=4):
    return outline([(x0, y0, corner), (x1, y0, corner), (x1, y1, corner), (x0, y1, corner)], True, count)


def tangent(i):
    """The angle of the normal of the straight piece between arcs i and i + 1."""
    return math.acos((CROWN[i] - CROWN[i + 1]) / (SHAFT_X[i + 1] - SHAFT_X[i]))


def crown(inset, foot):
    """The cover's profile from its right foot to its left one, arcs by arcs: pieces of (point, normal)."""
    radii = [r - inset for r in CROWN]
    ends = [math.pi - math.asin(foot / radii[0]), tangent(0), tangent(1), math.asin(foot / radii[2])]
    pieces = [arc(SHAFT_X[i], 0, radii[i], ends[i + 1], ends[i], n) for i, n in ((2, 14), (1, 5), (0, 8))]
    straight = [[pieces[0][-1], pieces[1][0]], [pieces[1][-1], pieces[2][0]]]
    return [pieces[0], straight[0], pieces[1], straight[1], pieces[2]]


def flat_frame(inset):
    """The plane of the cover's flat: places (along the slope from its middle, z), its normal, and half its length."""
    _, (a, b), *_ = crown(inset, 0.0)
    middle, n = ((a[0][0] + b[0][0]) / 2, (a[0][1] + b[0][1]) / 2), a[1]
    along = (n[1], -n[0])
    return lambda p: (middle[0] + along[0] * p[0], middle[1] + along[1] * p[0], p[1]), (*n, 0.0), math.dist(a[0], b[0]) / 2


def boss_foot(radius):
    """Angles from 0 up to the top of the flange, by the rows of its edge."""
    return [0.0] + [math.asin((FLANGE - below) / radius) for _, below, _, _ in rounding(EDGE, 2)]


def boss_arcs(radius, ribs):
    """Angles around a boss from one side of the flange to the other; two arcs where a rib comes between."""
    start = math.asin(FLANGE / radius)
    if not ribs:
        return [steps(start, math.pi - start, 18)]
    first = math.acos(RIB_HALF / radius)
    right = steps(start, first, 8)
    return [right, [math.pi - a for a in reversed(right)]]


def boss_half(solid, i, up, z, ribs):
    """Half a boss with its bore and the holes of the cap's screws; `z` is the side, 1 or -1."""
    x, r, bore = SHAFT_X[i], BOSS[i], BORE[i]
    lip = rounding(EDGE, 2)

    def at(radius, angle, height, side=1.0, rise=0.0):
        """A point and its normal, whose shares along radius and axis are given."""
        c, s = math.cos(angle), up * math.sin(angle)
        return (x + radius * c, radius * s, z * height), (side * c, side * s, z * rise)

    # Columns around the mantle: angle, and where along the axis it begins.
    low = list(zip(boss_foot(r), [FLANGE_Z] + [FLANGE_Z - inset for inset, *_ in lip]))
    mantle = [low] + [[(a, SIDE + FILLET[-1][1]) for a in part] for part in boss_arcs(r, ribs)]
    if ribs:
        mantle.insert(2, [(math.acos(p / r), q) for p, q in path(RIB[1:-1])])
    mantle.append([(math.pi - a, s) for a, s in reversed(low)])
    for columns in mantle:
        solid.grid([[at(r, a, s) for a, s in columns], [at(r, a, FACE - EDGE) for a, _ in columns]])
    for part in zip(*[boss_arcs(r + beyond, ribs) for beyond, *_ in FILLET]):
        solid.grid([[at(r + beyond, a, SIDE + off, m, n) for a in angles] for (beyond, off, m, n), angles in zip(FILLET, part)])
    around = [0.0] + [a for columns in mantle for a, _ in columns[1:]]
    solid.grid([[at(r - inset, a, FACE - below, side, rise) for a in around] for inset, below, side, rise in lip])
    inside = steps(0.0, math.pi, 20)
    solid.grid([[at(bore, a, q, -1.0) for a in inside] for q in (SIDE - WALL, FACE)])
    face = [[at(r - EDGE, a, FACE)[0][:2] for a in around] + [at(bore, a, FACE)[0][:2] for a in reversed(inside)]]
    on, radius, angles = CAP_SCREWS[i]
    for a in angles:
        if math.sin(a) * up > 0:
            c = (x + on * math.cos(a), on * math.sin(a))
            face.append(solid.hole(c, radius, 8, level(z * (FACE - 14)), level(z * FACE)))
            solid.flat([face[-1]], level(z * (FACE - 14)), (0.0, 0.0, float(z)))
    solid.flat(face, level(z * FACE), (0.0, 0.0, float(z)))


def flange_half(solid, up, ribs):
    """What cover and base have alike: flange, bosses, bores and holes, upward (1) or downward (-1) from y = 0."""
    top = up * FLANGE
    lip = rounding(EDGE, 2)
    # The ends of the flange and its round corners; the long sides are between the bosses.
    plan = box(-FLANGE_X, FLANGE_X, -FLANGE_Z, FLANGE_Z, 16.0, 6)
    for piece in plan:
        if len(piece) == 2 and abs(piece[0][1][1]) > 0.5:
            continue
        rows = [[((p[0], 0.0, p[1]), (n[0], 0.0, n[1])) for p, n in piece]]
        for inset, below, side, rise in lip:
            rows.append(
                [((p[0] - inset * n[0], top - up * below, p[1] - inset * n[1]), (side * n[0], up * rise, side * n[1])) for p, n in piece]
            )
        solid.grid(rows)
    below_loops = [points(plan)]
    top_loops = [points(shifted(plan, EDGE))]
    for z in (-1, 1):
        # From the left corner to the right one, around the bosses.
        limits = [lambda y: 16.0 - FLANGE_X]
        for x, r in zip(SHAFT_X, BOSS):
            limits += [lambda y, x=x, r=r: x - math.sqrt(r * r - y * y), lambda y, x=x, r=r: x + math.sqrt(r * r - y * y)]
        limits.append(lambda y: FLANGE_X - 16.0)
        for left, right in zip(limits[::2], limits[1::2]):
            rows = []
            for inset, below, side, rise in [(0.0, FLANGE, 1.0, 0.0), *lip]:
                y = FLANGE - below
                rows.append([((x(y), up * y, z * (FLANGE_Z - inset)), (0.0, up * rise, z * side)) for x in (left, right)])
            solid.grid(rows)
        for i, (x, r, bore) in enumerate(zip(SHAFT_X, BOSS, BORE)):
            boss_half(solid, i, up, z, ribs)
            rim = [(r - inset, z * (FACE - below)) for inset, below, *_ in lip]
            below_loops.append(
                [(x - p, q) for p, q in [(r, z * FLANGE_Z), *rim]] + [(x + p, q) for p, q in [*rim[::-1], (r, z * FLANGE_Z)]]
            )
            below_loops.append([(x + p, z * q) for p, q in ((-bore, SIDE - WALL), (-bore, FACE), (bore, FACE), (bore, SIDE - WALL))])
            side = [(math.sqrt((r + beyond) ** 2 - FLANGE**2), z * (SIDE + off)) for beyond, off, *_ in FILLET]
            side.append((side[-1][0], z * (FLANGE_Z - EDGE)))
            top_loops.append([(x - p, q) for p, q in side] + [(x + p, q) for p, q in reversed(side)])
    for centres, radius in ((BOLTS, BOLT_HOLE), (DOWELS, DOWEL)):
        for c in centres:
            loop = solid.hole(c, radius, 12, ground(0.0), ground(top))
            below_loops.append(loop)
            top_loops.append(loop)
    inner = SIDE - WALL
    below_loops.append(points(box(ENDS[0] + WALL, ENDS[1] - WALL, -inner, inner, INNER_ROUND, 4)))
    solid.flat(below_loops, ground(0.0), (0.0, -float(up), 0.0))
    return top_loops


def housing_cover():
    solid = Solid()
    top_loops = flange_half(solid, 1, False)
    for outside, width, wall, radius, foot, facing in (
        (True, SIDE, 0.0, ROUND, FLANGE, 1),
        (False, SIDE - WALL, WALL, INNER_ROUND, 0.0, -1),
    ):
        rows = []
        for inset, below, side, rise in rounding(radius, 4):
            rows.append((width - below, wall + inset, side, rise))
        rows = [(-z, inset, side, -rise) for z, inset, side, rise in reversed(rows)] + rows
        lines = []
        for z, inset, side, rise in rows:
            lines.append(
                [[((*p, z), (facing * side * n[0], facing * side * n[1], facing * rise)) for p, n in piece] for piece in crown(inset, foot)]
            )
        for low, high in zip(lines, lines[1:]):
            for i, (a, b) in enumerate(zip(low, high)):
                if i != 1 or b[0][0][2] - a[0][0][2] < 2 * (width - radius) - 1e-6:
                    solid.grid([a, b])
        place, n, half = flat_frame(wall)
        opening = box(-OPENING[0], OPENING[0], -OPENING[1], OPENING[1], OPENING[2], 4)
        straight = width - radius
        screws = [circle(*c, 2.5, 12) for c in LID_SCREWS]
        solid.flat([points(box(-half, half, -straight, straight)), points(opening), *screws], place, scale(n, float(facing)))
        if outside:
            deep = flat_frame(WALL)[0]
            solid.wall([[(p, (-m[0], -m[1])) for p, m in piece] for piece in opening], deep, place)
            for c in LID_SCREWS:
                solid.hole(c, 2.5, 12, deep, place)
        for z in (-width, width):
            profile = path(crown(wall + radius, foot))
            loops = [profile]
            for x, r, bore in zip(SHAFT_X, BOSS, BORE):
                if outside:
                    q = r + FILLET[0][0]
                    loops.append([(x + q * math.cos(a), q * math.sin(a)) for a in boss_arcs(q, False)[0]])
                else:
                    loops.append([(x + bore * math.cos(a), bore * math.sin(a)) for a in steps(0.0, math.pi, 20)])
            solid.flat(loops, level(z), (0.0, 0.0, math.copysign(1.0, z * facing)))
        if outside:
            ends = [(line[0][0][0], line[-1][-1][0]) for line in lines]
            top_loops.append([(a[0], a[2]) for a, _ in ends] + [(b[0], b[2]) for _, b in reversed(ends)])
    solid.flat(top_loops, ground(FLANGE), (0.0, 1.0, 0.0))
    return solid


def housing_base():
    solid = Solid()
    top_loops = flange_half(solid, -1, True)
    plan = box(*ENDS, -SIDE, SIDE, ROUND, 4)
    top_loops.append(points(plan))
    solid.flat(top_loops, ground(-FLANGE), (0.0, -1.0, 0.0))
    corners = [piece for piece in plan if len(piece) > 2]
    solid.wall(corners, ground(FLOOR), ground(-FLANGE))
    inner = box(ENDS[0] + WALL, ENDS[1] - WALL, WALL - SIDE, SIDE - WALL, INNER_ROUND, 4)
    curb, bed = 6.0, FLOOR + 10.0
    solid.wall([[(p, (-n[0], -n[1])) for p, n in piece] for piece in inner if len(piece) > 2], ground(bed + curb), ground(0.0))
    for piece in inner:
        rows = [
            [((p[0] - i * n[0], bed + b, p[1] - i * n[1]), (-s * n[0], t, -s * n[1])) for p, n in piece] for i, b, s, t in rounding(curb, 3)
        ]
        solid.grid(rows)
    solid.flat([points(shifted(inner, curb))], ground(bed), (0.0, 1.0, 0.0))
    # The walls at the ends, with the holes for cooling coil, sight glass and drain plug.
    for x, facing, holes in ((ENDS[0], -1, COIL), (ENDS[1], 1, [SIGHT, DRAIN])):
        for at, reach, low, high, n in (
            (x, SIDE - ROUND, FLOOR, -FLANGE, facing),
            (x - facing * WALL, SIDE - WALL - INNER_ROUND, bed + curb, 0.0, -facing),
        ):
            loops = [[(low, -reach), (high, -reach), (high, reach), (low, reach)]]
            loops += [circle(y, z, r, 20) for y, z, r in holes]
            solid.flat(loops, lambda p, at=at: (at, *p), (float(n), 0.0, 0.0))
        for y, z, r in holes:
            solid.hole((y, z), r, 20, lambda p: (x - facing * WALL, *p), lambda p: (x, *p))
    # The long walls, with feet, bosses and ribs.
    foot_x, foot_z, lip = 165.0, 78.0, rounding(2.0, 2)
    bottom = [points(plan)]
    for z in (-1, 1):
        foot = outline([(-foot_x, -SIDE), (-foot_x, -foot_z, 12), (foot_x, -foot_z, 12), (foot_x, -SIDE)], False, 6)
        foot = [[((p[0], -z * p[1]), (n[0], -z * n[1])) for p, n in piece] for piece in foot]
        for piece in foot:
            rows = [[((p[0], FLOOR, p[1]), (n[0], 0.0, n[1])) for p, n in piece]]
            rows += [[((p[0] - i * n[0], FOOT - b, p[1] - i * n[1]), (s * n[0], t, s * n[1])) for p, n in piece] for i, b, s, t in lip]
            solid.grid(rows)
        tops, bottoms = [path(shifted(foot, 2.0))], [path(foot)]
        for x in (-145.0, 0.0, 145.0):
            loop = solid.hole((x, z * 67.0), 6.5, 16, ground(FLOOR), ground(FOOT))
            tops.append(loop)
            bottoms.append(loop)
        wall = [[(ENDS[0] + ROUND, -FLANGE), (ENDS[0] + ROUND, FLOOR), (ENDS[1] - ROUND, FLOOR), (ENDS[1] - ROUND, -FLANGE)]]
        wall.append(
            [
                (-foot_x, FLOOR),
                *[(i - foot_x, FOOT - b) for i, b, *_ in lip],
                *[(foot_x - i, FOOT - b) for i, b, *_ in reversed(lip)],
                (foot_x, FLOOR),
            ]
        )
        inside = [
            [
                (ENDS[0] + WALL + INNER_ROUND, 0.0),
                (ENDS[0] + WALL + INNER_ROUND, bed + curb),
                (ENDS[1] - WALL - INNER_ROUND, bed + curb),
                (ENDS[1] - WALL - INNER_ROUND, 0.0),
            ]
        ]
        for x, r, bore in zip(SHAFT_X, BOSS, BORE):
            sides = [[((RIB_HALF, SIDE + off), (1.0, 0.0)) for _, off, *_ in FILLET] + [RIB[0][1]]]
            sides.append([((-p, q), (-1.0, 0.0)) for (p, q), _ in reversed(sides[0])])
            for piece in [sides[0], *RIB[1:-1], sides[1]]:
                rows = [[], []]
                for p, m in piece:
                    beyond = next((b for b, off, *_ in FILLET if SIDE + off == p[1]), 0.0)
                    for row, y in zip(rows, (FOOT, -math.sqrt((r + beyond) ** 2 - p[0] ** 2))):
                        row.append(((x + p[0], y, z * p[1]), (m[0], 0.0, z * m[1])))
                solid.grid(rows)
            tops.append([(x + p, z * q) for p, q in path(RIB)])
            q = r + FILLET[0][0]
            left, right = [[(x + q * math.cos(a), -q * math.sin(a)) for a in angles] for angles in boss_arcs(q, True)]
            wall.append([*left, (x + RIB_HALF, FOOT), (x - RIB_HALF, FOOT), *right])
            inside.append([(x + bore * math.cos(a), -bore * math.sin(a)) for a in steps(0.0, math.pi, 20)])
        solid.flat(wall, level(z * SIDE), (0.0, 0.0, float(z)))
        solid.flat(inside, level(z * (SIDE - WALL)), (0.0, 0.0, -float(z)))
        solid.flat(tops, ground(FOOT), (0.0, 1.0, 0.0))
        bottom += bottoms
    solid.flat(bottom, ground(FLOOR), (0.0, -1.0, 0.0))
    return solid


# --- small parts ------------------------------------------------------------


def hexagon(solid, across, low, high, chamfers, columns=4):
    """Six sides with 30 degree chamfers, below and above if so told; answers the loop of what is left of each end."""
    inside, tilt = across / 2 * 0.96, math.tan(math.radians(30))
    count = 6 * columns
    corners = []
    for i in range(count + 1):
        a = TAU * i / count
        radius = across / 2 / math.cos((a % (TAU / 6)) - TAU / 12)
        corners.append((radius * math.cos(a), radius * math.sin(a), max(0.0, radius - inside) * tilt))
    flat = [(math.cos(TAU * (k + 0.5) / 6), math.sin(TAU * (k + 0.5) / 6), 0.0) for k in range(6)]
    for k in range(6):
        side = corners[k * columns : (k + 1) * columns + 1]
        solid.grid([[((x, y, z + s * d * c), flat[k]) for x, y, d in side] for z, s, c in ((low, 1, chamfers[0]), (high, -1, chamfers[1]))])
    loops = []
    for z, s, chamfer in ((low, 1, chamfers[0]), (high, -1, chamfers[1])):
        if chamfer:
            ring = circle(0, 0, inside, count) + [(inside, 0.0)]
            normals = [unit((x * tilt / inside, y * tilt / inside, -s)) for x, y in ring]
            solid.grid(
                [[((x, y, z + s * d), n) for (x, y, d), n in zip(corners, normals)], [((x, y, z), n) for (x, y), n in zip(ring, normals)]]
            )
            loops.append(ring[:-1])
        else:
            loops.append([(x, y) for x, y, _ in corners[:-1]])
    return loops


def hex_bolt(across, head, radius, length, columns=4, above=()):
    """Head upward from z = 0; `above` continues the top of the head, as (radius, z), to the axis."""
    solid = Solid()
    bottom, top = hexagon(solid, across, 0.0, head, (False, True), columns)
    count = 6 * columns
    solid.flat([bottom, circle(0, 0, radius, count)], level(0.0), (0.0, 0.0, -1.0))
    solid.revolve(outline([(0, -length), (radius, -length, -0.8), (radius, 0)], False), count)
    solid.revolve(outline([(top[0][0], head), *above, (0, above[-1][1] if above else head)], False, 3), count)
    return solid


def nut(across, height, radius, columns=2):
    solid = Solid()
    bottom, _ = hexagon(solid, across, 0.0, height, (True, True), columns)
    solid.revolve(outline([(bottom[0][0], height), (radius, height, -0.4), (radius, 0), (bottom[0][0], 0)], False), 6 * columns)
    return solid


def socket_screw(radius, length, head_radius, head, across):
    """Head upward from z = 0, with a socket half as deep as the head is high."""
    solid = Solid()
    count, bottom = 12, head / 2
    top = head_radius - 0.6
    solid.revolve(
        outline([(0, -length), (radius, -length), (radius, 0), (head_radius, 0), (head_radius, head, -0.6), (top, head)], False), count
    )
    corners = circle(0, 0, across / math.sqrt(3), 6)
    solid.flat([circle(0, 0, top, count), corners], level(head), (0.0, 0.0, 1.0))
    solid.wall([line(q, p) for p, q in zip(corners, corners[1:] + corners[:1])], level(bottom), level(head))
    solid.flat([corners], level(bottom), (0.0, 0.0, 1.0))
    return solid


def ring(inside, outside, width, count, chamfer=0.4):
    """From z = 0 upward, where its outer edge is cut off."""
    return revolved([(inside, 0), (outside, 0), (outside, width, -chamfer), (inside, width)], count)


def ball(radius, parts=4):
    """An octahedron, each face in parts * parts, blown up."""
    solid = Solid()
    for sx in (-1, 1):
        for sy in (-1, 1):
            for sz in (-1, 1):
                # Angles rather than lengths in equal parts, so that the facets are alike.
                at = lambda u, v: unit(tuple(s * math.tan(TAU / 8 * t / parts) for s, t in ((sx, parts - u - v), (sy, u), (sz, v))))
                for u in range(parts):
                    for v in range(parts - u):
                        cells = [((u, v), (u + 1, v), (u, v + 1))]
                        if u + v < parts - 1:
                            cells.append(((u + 1, v), (u + 1, v + 1), (u, v + 1)))
                        for cell in cells:
                            solid.triangle(*[(scale(at(*p), radius), at(*p)) for p in cell])
    return solid


def guard(radius, half, thick, deep, start, stop, count=14):
    """A gutter of sheet metal around the lower part of a wheel, its sides turned inward; angles from +x."""
    solid = Solid()
    r, w = radius + thick, half + thick
    section = outline(
        [
            (r, -w),
            (r, w),
            (radius - deep, w),
            (radius - deep, half),
            (radius, half),
            (radius, -half),
            (radius - deep, -half),
            (radius - deep, -w),
        ]
    )
    turns = [(math.cos(a), math.sin(a)) for a in steps(start, stop, count)]
    for piece in section:
        solid.grid([[((q * c, q * s, z), (m * c, m * s, n)) for c, s in turns] for (q, z), (m, n) in piece])
    for (c, s), facing in ((turns[0], 1), (turns[-1], -1)):
        solid.flat([points(section)], lambda p: (p[0] * c, p[0] * s, p[1]), (facing * s, -facing * c, 0.0))
    return solid


def coil(outside, inside, count=8):
    """A tube in the plane y = 0, there and back twice, with open ends at the left."""
    solid = Solid()
    left, right, bend, out = -150.0, -6.0, 10.0, ENDS[0] - 16
    way = [((out, -30.0), (1, 0))]  # points and directions
    for z, x, facing in ((-20.0, right, 1), (0.0, left, -1), (20.0, right, 1)):
        for a in steps(-TAU / 4, TAU / 4, 5):
            c, s = facing * math.cos(a), math.sin(a)
            way.append(((x + bend * c, z + bend * s), (-facing * s, abs(c))))
    way.append(((out, 30.0), (-1, 0)))
    around = circle(0, 0, 1, count) + [(1.0, 0.0)]
    for radius, facing in ((outside, 1), (inside, -1)):
        rows = []
        for (x, z), (u, w) in way:
            rows.append(
                [((x - radius * c * w, radius * s, z + radius * c * u), (-facing * c * w, facing * s, facing * c * u)) for c, s in around]
            )
        solid.grid(rows)
    for z in (-30.0, 30.0):
        side = 1 if z < 0 else -1
        loops = [[(z + side * r * c, r * s) for c, s in around[:-1]] for r in (outside, inside)]
        solid.flat(loops, lambda p: (out, p[1], p[0]), (-1.0, 0.0, 0.0))
    return solid


def union(across, height, stub, bore, depth):
    """A hexagon from z = 0 upward and a stub downward, drilled through."""
    solid = Solid()
    bottom, top = hexagon(solid, across, 0.0, height, (False, True), 3)
    solid.flat([bottom, circle(0, 0, stub, 18)], level(0.0), (0.0, 0.0, -1.0))
    solid.revolve(outline([(top[0][0], height), (bore, height, -0.5), (bore, -depth), (stub, -depth, -0.8), (stub, 0)], False), 18)
    return solid


class Bearing:
    """A deep groove ball bearing about z; its cage is open downward."""

    def __init__(self, bore, outside, width, ball_radius, balls):
        self.bore, self.outside, self.width, self.ball, self.balls = bore, outside, width, ball_radius, balls
        self.pitch = (bore + outside) / 2
        self.groove = round(1.07 * ball_radius, 2)
        self.lands = (round(self.pitch - 0.55 * ball_radius, 1), round(self.pitch + 0.55 * ball_radius, 1))

    def race(self, outer):
        half = self.width / 2
        land = self.lands[1] if outer else self.lands[0]
        opening = math.acos((land - self.pitch) / self.groove)
        deep = self.groove * math.sin(opening)
        solid = Solid()
        if outer:
            r = self.outside - SEAT
            corners = [(land, -deep), (land, -half), (r, -half, -0.9), (r, half, -0.9), (land, half), (land, deep)]
            groove = arc(self.pitch, 0, self.groove, opening, -opening, 4, -1)
        else:
            r = self.bore
            corners = [(land, deep), (land, half), (r, half, -0.9), (r, -half, -0.9), (land, -half), (land, -deep)]
            groove = arc(self.pitch, 0, self.groove, TAU - opening, opening, 4, -1)
        solid.revolve([*outline(corners, False), groove], 27)
        return solid

    def cage(self):
        solid = Solid()
        pocket, reach, high = 1.08 * self.ball + 0.1, math.radians(84), 1.08 * self.ball + 1.3
        pieces = []  # of its lower edge: (angle about z, height, tangential and axial part of the normal)
        for k in range(self.balls):
            piece = []
            for t in steps(-reach, reach, 4):
                piece.append(
                    (TAU * k / self.balls + math.asin(pocket * math.sin(t) / self.pitch), pocket * math.cos(t), -math.sin(t), -math.cos(t))
                )
            pieces.append(piece)
            a, b = piece[-1], TAU / self.balls + pieces[-1][0][0]
            pieces.append([(a[0], a[1], 0.0, -1.0), ((a[0] + b) / 2, a[1], 0.0, -1.0), (b, a[1], 0.0, -1.0)])
        radii = [self.pitch - 0.42 * self.ball, self.pitch + 0.42 * self.ball]
        for piece in pieces:
            around = [(math.cos(a), math.sin(a), z, u, w) for a, z, u, w in piece]
            solid.grid([[((r * c, r * s, z), (-u * s, u * c, w)) for c, s, z, u, w in around] for r in radii])
            solid.grid([[((r * c, r * s, high), (0.0, 0.0, 1.0)) for c, s, *_ in around] for r in radii])
            for r, facing in zip(radii, (-1, 1)):
                solid.grid([[((r * c, r * s, h or z), (facing * c, facing * s, 0.0)) for c, s, z, *_ in around] for h in (0.0, high)])
        return solid


def shaft(corners, count=48, keyway=None):
    """From (radius, z) along the outside.

    `keyway`: radius and limits of its cylinder, limits of the slot, its width and the height of its bottom. The slot points to +y.
    """
    solid = Solid()
    pieces = outline(corners, False, 2)
    if keyway is None:
        solid.revolve(pieces, count)
        return solid
    radius, low, high, start, stop, width, bottom = keyway
    chosen = [p for p in pieces if p[0][0][0] == p[-1][0][0] == radius and low - 1e-6 < p[0][0][1] < p[-1][0][1] < high + 1e-6]
    (piece,) = chosen
    solid.revolve([p for p in pieces if p is not piece], count)
    low, high = piece[0][0][1], piece[-1][0][1]
    step = TAU / count

    def at(a):
        """On the facets of the neighbours."""
        q = radius * math.cos(step / 2) / math.cos((a % step) - step / 2)
        return q * math.cos(a), q * math.sin(a)

    first = math.acos(width / 2 / radius)
    last = math.pi - first
    regular = [step * i for i in range(2 * count)]
    bend = {math.acos(width / 2 * math.cos(t) / radius) for t in steps(0, math.pi, 10)}
    near = [a for a in regular if first + 0.01 < a < last - 0.01]
    slot = sorted([*near, *[a for a in bend if all(abs(a - b) > 0.02 for b in near)]])
    half = at(slot[0])[0]
    rest = [last, *[a for a in regular if last + 1e-6 < a < first + TAU - 1e-6], first + TAU]
    solid.grid([[((*at(a), z), (math.cos(a), math.sin(a), 0.0)) for a in rest] for z in (low, high)])
    ends = []
    for z, facing, limit in ((start + half, -1, low), (stop - half, 1, high)):
        curve = [(a, z + facing * math.sqrt(max(0.0, half**2 - at(a)[0] ** 2))) for a in slot]
        solid.grid(
            [
                [((*at(a), q), (math.cos(a), math.sin(a), 0.0)) for a, q in curve],
                [((*at(a), limit), (math.cos(a), math.sin(a), 0.0)) for a in slot],
            ]
        )
        wall = [(at(a), q, (-at(a)[0] / half, 0.0, (z - q) / half)) for a, q in curve]
        solid.grid([[((x, bottom if deep else y, q), n) for (x, y), q, n in wall] for deep in (False, True)])
        ends.append([((x, y), q) for (x, y), q, _ in wall])
    for i in (0, -1):
        (x, y), z = ends[0][i]
        top = ends[1][i][1]
        solid.grid([[((x, h, q), (-x / half, 0.0, 0.0)) for q in (z, top)] for h in (bottom, y)])
    loop = [(x, q) for (x, _), q in ends[0]] + [(x, q) for (x, _), q in reversed(ends[1])]
    solid.flat([loop], ground(bottom), (0.0, 1.0, 0.0))
    return solid


def feather_key(width, height, length):
    """Along z, from y = 0 upward, with round ends."""
    solid = Solid()
    half = width / 2
    plan = [
        arc(0, half, half, TAU / 2, TAU, 10),
        line((half, half), (half, length - half)),
        arc(0, length - half, half, 0, TAU / 2, 10),
        line((-half, length - half), (-half, half)),
    ]
    cut = 0.4
    top = shifted(plan, cut)
    solid.wall(plan, ground(0.0), ground(height - cut))
    for low, high in zip(plan, top):
        solid.grid(
            [
                [((p[0], height - cut, p[1]), unit((n[0], 1.0, n[1]))) for p, n in low],
                [((p[0], height, p[1]), unit((n[0], 1.0, n[1]))) for p, n in high],
            ]
        )
    solid.flat([points(plan)], ground(0.0), (0.0, -1.0, 0.0))
    solid.flat([points(top)], ground(height), (0.0, 1.0, 0.0))
    return solid


def end_cap(i, thick, spigot, recess, pocket=None, bore=None):
    """Over a bearing: its flange from z = 0 upward, a spigot of the given depth into the bore; closed, or with a pocket for a seal."""
    solid = Solid()
    rim, seat, count = BOSS[i] - 0.5, BORE[i] - SEAT, 30 if i < 2 else 40
    solid.revolve(outline([(rim, 0), (rim, thick, 1.2), (rim - 1.2, thick)], False, 2), count)
    under = [(recess, -3), (recess, -spigot), (seat, -spigot, -1), (seat, 0)]
    if pocket:
        inner = pocket + 0.6
        path_in = [(inner, thick), (pocket, thick - 0.6), (pocket, 1), (bore, 1), (bore, -3), *under]
    else:
        inner = recess + 1
        path_in = [(inner, thick), (inner - 2.5, thick - 1.5, 1.0), (0, thick - 1.5)]
        solid.revolve(outline([(0, -3), *under], False), count)
    solid.revolve(outline(path_in, False, 2), count)
    on, radius, angles = CAP_SCREWS[i]
    holes = [solid.hole((on * math.cos(a), on * math.sin(a)), radius + 0.2, 10, level(0.0), level(thick)) for a in angles]
    solid.flat([circle(0, 0, rim - 1.2, count), circle(0, 0, inner, count), *holes], level(thick), (0.0, 0.0, 1.0))
    solid.flat([circle(0, 0, rim, count), circle(0, 0, seat, count), *holes], level(0.0), (0.0, 0.0, -1.0))
    return solid


def seal(inside, outside, width):
    lip = [(inside + 2.4, width - 1.6), (inside + 1.6, width), (inside + 0.04, width - 1.5), (inside + 1, width - 3.2)]
    return revolved(
        [(inside + 1, 0), (outside, 0, -0.6), (outside, width, -0.6), (outside - 3.2, width), (outside - 4.2, width - 1.6), *lip], 30
    )


def plate(half_x, half_z, corner, thick, holes, chamfer=0.0, opening=None):
    """Flat on y = 0; `holes`: (x, z, radius)."""
    solid = Solid()
    plan = box(-half_x, half_x, -half_z, half_z, corner, 5)
    solid.wall(plan, ground(0.0), ground(thick - chamfer))
    top = shifted(plan, chamfer)
    if chamfer:
        for low, high in zip(plan, top):
            rows = [[((p[0], y, p[1]), unit((n[0], 1.0, n[1]))) for p, n in piece] for piece, y in ((low, thick - chamfer), (high, thick))]
            solid.grid(rows)
    inside = [solid.hole((x, z), r, 16, ground(0.0), ground(thick)) for x, z, r in holes]
    if opening:
        solid.wall([[(p, (-n[0], -n[1])) for p, n in piece] for piece in opening], ground(0.0), ground(thick))
        inside.append(points(opening))
    solid.flat([points(plan), *inside], ground(0.0), (0.0, -1.0, 0.0))
    solid.flat([points(top), *inside], ground(thick), (0.0, 1.0, 0.0))
    return solid


def angle_bracket(leg=80.0, thick=10.0, width=64.0, round_=12.0, fillet=8.0):
    """Legs along +x and +y, both from z = 0; alike but for their holes."""
    solid = Solid()
    plan = outline([(0, 0), (leg, 0, round_), (leg, width, round_), (0, width)], False, 8)
    inner = thick + fillet
    near = [(inner, 0.0), *path(plan[1:-1]), (inner, width)]
    bores = [((48.0, 32.0), 14.0, 14.0)] + [((48.0 + a, 32.0 + b), 2.75, 2.75) for a in (-17.0, 17.0) for b in (-17.0, 17.0)]
    lying = lambda h: lambda p: (p[0], h, p[1])
    standing = lambda h: lambda p: (h, p[0], p[1])
    for put, holes in ((lying, [((56.0, 16.0), 4.5, 7.5), ((56.0, 48.0), 4.5, 7.5)]), (standing, bores)):
        up = put(1.0)((0.0, 0.0))
        solid.wall(plan[1:-1], put(0.0), put(thick))
        below, above = [path(plan)], [near]
        for centre, radius, wide in holes:
            count, step = (36 if radius > 10 else 20), thick
            if wide > radius:
                step = thick / 2
                above.append(solid.hole(centre, wide, count, put(step), put(thick)))
                solid.flat([above[-1], circle(*centre, radius, count)], put(step), up)
            below.append(solid.hole(centre, radius, count, put(0.0), put(step)))
            if wide == radius:
                above.append(below[-1])
        solid.flat(below, put(0.0), scale(up, -1.0))
        solid.flat(above, put(thick), up)
    bend = [arc(inner, inner, fillet, TAU * 3 / 4, TAU / 2, 8, -1)]
    solid.wall(bend, level(0.0), level(width))
    end = leg - round_
    side = [(0.0, 0.0), (end, 0.0), (end, thick), *path(bend), (thick, end), (0.0, end)]
    for z, facing in ((0.0, -1.0), (width, 1.0)):
        solid.flat([side], level(z), (0.0, 0.0, facing))
    return solid


# --- the assembly -----------------------------------------------------------

# Base colour (linear), metallic, roughness.
MATERIALS = {
    "Cast iron": ((0.055, 0.13, 0.17, 1.0), 0.1, 0.55),
    "Steel": ((0.56, 0.57, 0.58, 1.0), 1.0, 0.42),
    "Hardened steel": ((0.40, 0.41, 0.45, 1.0), 1.0, 0.28),
    "Zinc-plated": ((0.62, 0.63, 0.60, 1.0), 1.0, 0.36),
    "Brass": ((0.80, 0.56, 0.22, 1.0), 1.0, 0.3),
    "Rubber": ((0.014, 0.014, 0.016, 1.0), 0.0, 0.8),
    "Glass": ((0.80, 0.90, 0.86, 0.4), 0.0, 0.05),
}


def quaternion(axis, degrees):
    half = math.radians(degrees) / 2
    return tuple(math.sin(half) if i == axis else 0.0 for i in range(3)) + (math.cos(half),)


def after(p, q):
    """The turn p after the turn q."""
    a, b = p[:3], q[:3]
    v = add(cross(a, b), add(scale(b, p[3]), scale(a, q[3])))
    return (*v, p[3] * q[3] - dot(a, b))


UP = quaternion(0, -90)  # turns z to y
DOWN = quaternion(0, 90)
BACK = quaternion(1, 180)  # turns z to -z
RIGHT = quaternion(1, 90)  # turns z to x
LEFT = quaternion(1, -90)  # turns z to -x


class Node:
    """A part or a group; `mirrored` flips z before it is turned and moved."""

    def __init__(self, name, mesh=None, at=(0.0, 0.0, 0.0), turn=None, mirrored=False):
        self.name, self.mesh, self.at, self.turn, self.mirrored, self.children = name, mesh, at, turn, mirrored, []

    def add(self, *arguments, **named):
        node = Node(*arguments, **named)
        self.children.append(node)
        return node


class Assembly:
    """Meshes, each with its material, and the tree that places them; the root turns it for the default view."""

    def __init__(self, name):
        self.meshes = {}
        self.root = Node(name, turn=after(quaternion(0, 28), quaternion(1, -37)))

    def mesh(self, name, material, solid):
        self.meshes[name] = (material, solid.sewn(name))
        return name


class Gearbox(Assembly):
    """A speed reducer of ratio 10.5: a helical stage 21 : 67 and a spur stage 21 : 69."""

    def __init__(self):
        super().__init__("Reducer")
        self.casing()
        self.gears()
        self.guards()
        self.bearings()
        self.fasteners()
        self.fittings()

    def casing(self):
        casing = self.root.add("Casing")
        casing.add("Housing base", self.mesh("housing base", "Cast iron", housing_base()))
        casing.add("Housing cover", self.mesh("housing cover", "Cast iron", housing_cover()))
        blind = self.mesh("end cap, small, closed", "Steel", end_cap(0, 8, 10, 22))
        small = self.mesh("end cap, small", "Steel", end_cap(0, 8, 10, 22, 21, 14))
        blind_large = self.mesh("end cap, large, closed", "Steel", end_cap(2, 9, 9, 35))
        large = self.mesh("end cap, large", "Steel", end_cap(2, 9, 9, 35, 31, 21.5))
        for number, (x, near, far) in enumerate(zip(SHAFT_X, (small, blind, large), (blind, blind, blind_large))):
            casing.add(f"End cap {2 * number + 1}", near, (x, 0.0, FACE))
            casing.add(f"End cap {2 * number + 2}", far, (x, 0.0, -FACE), mirrored=True)
        casing.add("Seal input", self.mesh("seal 25 x 42 x 7", "Rubber", seal(12.5, 21 - FIT, 7)), (SHAFT_X[0], 0.0, FACE + 1))
        casing.add("Seal output", self.mesh("seal 40 x 62 x 8", "Rubber", seal(20, 31 - FIT, 8)), (SHAFT_X[2], 0.0, FACE + 1))

    def gears(self):
        seat = 12.5 - FIT
        x1, x2, x3 = SHAFT_X
        helix = math.acos((21 + 67) * 2 / 2 / (x2 - x1))
        corners = [
            (0, -67),
            (2.5, -71),
            (seat, -71, -1),
            (seat, -54),
            (14 - FIT, -54, -0.4),
            (14 - FIT, -9),
            (18, -9, -0.6),
            (18, -5, -0.6),
        ]
        corners += [(15.5, -5, 2), (15.5, 54, -0.6), (seat, 54), (seat, 92, -0.6), (11, 92, 1), (11, 142, -1.2), (2.5, 142), (0, 138)]
        group = self.root.add("Input stage", at=(x1, 0.0, 0.0))
        group.add("Input shaft", self.mesh("input shaft", "Steel", shaft(corners, 32, (11, 92, 142, 98, 134, 6 + FIT, 11 - 3.5))))
        group.add("Key input", self.mesh("key 6 x 6 x 36", "Steel", feather_key(6, 6, 36 - FIT)), (0.0, 11 - 3.5 + FIT, 98 + FIT / 2))
        group.add("Gear 1", self.mesh("gear, 21 teeth, module 2", "Hardened steel", gear(21, 2, 28, 14, helix, 1, 3, 2)), (0.0, 0.0, -23.0))
        spacer = self.mesh("spacer 28 x 35 x 17", "Steel", ring(14, 17.5, 17, 30))
        group.add("Spacer 1", spacer, (0.0, 0.0, -54.0))

        group = self.root.add("Intermediate stage", at=(x2, 0.0, 0.0))
        corners = [
            (0, -67),
            (2.5, -71),
            (seat, -71, -1),
            (seat, -54),
            (15 - FIT, -54, -0.4),
            (15 - FIT, -9),
            (20, -9, -0.8),
            (20, -1, -0.8),
        ]
        corners += [(15 - FIT, -1), (15 - FIT, 54, -0.4), (seat, 54), (seat, 71, -1), (2.5, 71), (0, 67)]
        group.add("Intermediate shaft", self.mesh("intermediate shaft", "Steel", shaft(corners, 32)))
        wheel = gear(67, 2, 24, 15, helix, -1, 1, 1, (58, 25, 28, 9, 6, 41.5, 8))
        group.add("Gear 2", self.mesh("gear, 67 teeth, module 2", "Hardened steel", wheel), (0.0, 0.0, -23.0))
        group.add("Gear 3", self.mesh("gear, 21 teeth, module 2.5", "Hardened steel", gear(21, 2.5, 38, 15, rings=2)), (0.0, 0.0, 18.0))
        spacer = self.mesh("spacer 30 x 36 x 17", "Steel", ring(15, 18, 17, 30))
        group.add("Spacer 2", spacer, (0.0, 0.0, -54.0))
        group.add("Spacer 3", spacer, (0.0, 0.0, 37.0))

        group = self.root.add("Output stage", at=(x3, 0.0, 0.0))
        seat = 20 - FIT
        corners = [
            (0, -66),
            (3, -72),
            (seat, -72, -1),
            (seat, -52),
            (24, -52, -0.6),
            (24, -10, 2),
            (29, -10, -0.8),
            (29, -2, -0.8),
            (23 - FIT, -2),
        ]
        corners += [(23 - FIT, 52, -0.5), (seat, 52), (seat, 94, -0.6), (19, 94, 0.6), (19, 166, -1.6), (3, 166), (0, 160)]
        group.add("Output shaft", self.mesh("output shaft", "Steel", shaft(corners, 40, (19, 94, 166, 104, 156, 10 + FIT, 19 - 5))))
        group.add("Key output", self.mesh("key 10 x 8 x 52", "Steel", feather_key(10, 8, 52 - FIT)), (0.0, 19 - 5 + FIT, 104 + FIT / 2))
        wheel = gear(69, 2.5, 34, 23, web=(75, 36, 40, 12, 6, 55.5, 11.5))
        group.add("Gear 4", self.mesh("gear, 69 teeth, module 2.5", "Hardened steel", wheel), (0.0, 0.0, 18.0))
        group.add("Spacer 4", self.mesh("spacer 46 x 52 x 14", "Steel", ring(23, 26, 14, 36)), (0.0, 0.0, 38.0))

    def guards(self):
        group = self.root.add("Lubrication")
        bed = FLOOR + 10
        wheels = ((SHAFT_X[1], -23.0, 73.0, 13.5, 206, 338), (SHAFT_X[2], 18.0, 91.5, 18.5, 202, 350))
        for number, (x, z, radius, half, start, stop) in enumerate(wheels, 1):
            sheet = guard(radius, half, 1.5, 16, math.radians(start), math.radians(stop))
            group.add(f"Splash guard {number}", self.mesh(f"splash guard {number}", "Zinc-plated", sheet), (x, 0.0, z))
            # Two pegs carry it, which touch it with their inner edges.
            height = -math.sqrt((radius + 1.5) ** 2 - 6**2) - bed
            peg = self.mesh(f"peg {number}", "Steel", revolved([(0, 0), (4, 0), (4, height), (0, height)], 14, False))
            for k in (-1, 1):
                group.add(f"Guard peg {2 * number + (k - 1) // 2}", peg, (x + 10 * k, bed, -20.0 if number == 1 else z), UP)
        group.add("Cooling coil", self.mesh("cooling coil", "Brass", coil(5.0, 4.0)), (0.0, COIL[0][0], 0.0))
        socket = self.mesh("union", "Zinc-plated", union(19, 9, 7 - FIT, 5 + FIT, 9))
        for number, (y, z, _) in enumerate(COIL, 1):
            group.add(f"Coil union {number}", socket, (ENDS[0], y, z), LEFT)

    def bearings(self):
        group = self.root.add("Bearings")
        number = 0
        for kind, dimensions, z, shafts in (
            ("6205", (12.5, 26, 15, 3.97, 9), 61.5, SHAFT_X[:2]),
            ("6208", (20, 40, 18, 5.95, 9), 61.0, SHAFT_X[2:]),
        ):
            bearing = Bearing(*dimensions)
            outer = self.mesh(f"{kind} outer ring", "Hardened steel", bearing.race(True))
            inner = self.mesh(f"{kind} inner ring", "Hardened steel", bearing.race(False))
            cage = self.mesh(f"{kind} cage", "Brass", bearing.cage())
            sphere = self.mesh(f"{kind} ball", "Hardened steel", ball(bearing.ball, 3 if bearing.ball < 5 else 4))
            for x in shafts:
                for side in (1, -1):
                    number += 1
                    part = group.add(f"Bearing {number}", None, (x, 0.0, side * z), mirrored=side < 0)
                    part.add(f"Bearing {number} outer ring", outer)
                    part.add(f"Bearing {number} inner ring", inner)
                    # Each set of balls stands where it came to rest.
                    rest = quaternion(2, 13.0 * number)
                    part.add(f"Bearing {number} cage", cage, turn=rest)
                    balls = part.add(f"Bearing {number} balls", turn=rest)
                    for k, (a, b) in enumerate(circle(0, 0, bearing.pitch, bearing.balls), 1):
                        balls.add(f"Bearing {number} ball {k}", sphere, (a, b, 0.0))

    def fasteners(self):
        bolts = self.root.add("Fasteners")
        bolt = self.mesh("bolt M8 x 40", "Zinc-plated", hex_bolt(13, 5.3, 3.95, 40, 3))
        m8 = self.mesh("nut M8", "Zinc-plated", nut(13, 6.8, 4.02))
        washer = self.mesh("washer 8.4 x 16", "Zinc-plated", ring(4.2, 8, 1.6, 18, 0.0))
        for k, (x, z) in enumerate(BOLTS, 1):
            bolts.add(f"Bolt {k}", bolt, (x, FLANGE + 1.6, z), after(UP, quaternion(2, 37.0 * k)))
            bolts.add(f"Washer {2 * k - 1}", washer, (x, FLANGE, z), UP)
            bolts.add(f"Washer {2 * k}", washer, (x, -FLANGE, z), DOWN)
            bolts.add(f"Nut {k}", m8, (x, -FLANGE - 1.6, z), after(DOWN, quaternion(2, 23.0 * k)))
        pin = self.mesh(
            "dowel pin 8 x 28", "Steel", revolved([(0, -14), (DOWEL - SEAT, -14, -1), (DOWEL - SEAT, 14, -0.6), (0, 14)], 16, False)
        )
        for k, (x, z) in enumerate(DOWELS, 1):
            bolts.add(f"Dowel pin {k}", pin, (x, 0.5, z), UP)
        m5 = self.mesh("screw M5 x 16", "Zinc-plated", socket_screw(2.44, 16, 4.25, 5, 4))
        m6 = self.mesh("screw M6 x 20", "Zinc-plated", socket_screw(2.94, 20, 5, 6, 5))
        number = 0
        for x, (on, _, angles), mesh, thick in zip(SHAFT_X, CAP_SCREWS, (m5, m5, m6), (8, 8, 9)):
            for side in (1, -1):
                for a in angles:
                    number += 1
                    spin = quaternion(2, 41.0 * number)
                    bolts.add(
                        f"Screw {number}",
                        mesh,
                        (x + on * math.cos(a), on * math.sin(a), side * (FACE + thick)),
                        spin if side > 0 else after(BACK, spin),
                    )
        place, n, _ = flat_frame(0.0)
        self.tilt = quaternion(2, math.degrees(math.atan2(n[1], n[0])) - 90)
        for number, (x, z) in enumerate(LID_SCREWS, 1):
            bolts.add(
                f"Lid screw {number}", m5, add(place((x, z)), scale(n, 6.0)), after(self.tilt, after(UP, quaternion(2, 41.0 * number)))
            )

    def fittings(self):
        fittings = self.root.add("Fittings")
        place, n, _ = flat_frame(0.0)
        at = lambda height: add(place((0.0, 0.0)), scale(n, height))
        screws = [(x, z, 2.8) for x, z in LID_SCREWS]
        opening = box(-OPENING[0], OPENING[0], -OPENING[1], OPENING[1], OPENING[2])
        fittings.add("Gasket", self.mesh("gasket", "Rubber", plate(44, 36, 9, 1.0, screws, 0.0, opening)), at(0.0), self.tilt)
        fittings.add(
            "Inspection lid",
            self.mesh("inspection lid", "Steel", plate(44, 36, 9, 5.0, [*screws, (0.0, 0.0, 6.0)], 0.8)),
            at(1.0),
            self.tilt,
        )
        above = [(5.5, 6), (5.5, 9, 0.8), (11.5, 9, 1.0), (11.5, 17, 2.5), (8.5, 19.5, 2.0)]
        breather = hex_bolt(17, 6, 5.9, 10, 3, above)
        fittings.add("Breather", self.mesh("breather", "Brass", breather), at(6.0), after(self.tilt, UP))
        x = ENDS[1]
        corners = [(10.5, -9), (14.7, -9, -0.8), (14.7, 0), (20, 0), (20, 6, 1.5), (13.6, 6), (12.5, 4.9), (12.5, -2), (10.5, -2)]
        fittings.add("Sight glass ring", self.mesh("sight glass ring", "Brass", revolved(corners, 30)), (x, *SIGHT[:2]), RIGHT)
        glass = [(0, -1.9), (12.5 - FIT, -1.9), (12.5 - FIT, 3.0, -0.4), (8, 3.4), (0, 3.6)]
        fittings.add("Sight glass", self.mesh("sight glass", "Glass", revolved(glass, 30, False)), (x, *SIGHT[:2]), RIGHT)
        fittings.add("Drain washer", self.mesh("drain washer", "Brass", ring(8.05, 11.5, 1.5, 24)), (x, *DRAIN[:2]), RIGHT)
        fittings.add("Drain plug", self.mesh("drain plug", "Zinc-plated", hex_bolt(17, 7, 7.9, 12, 3)), (x + 1.5, *DRAIN[:2]), RIGHT)


class Bracket(Assembly):
    """One small part: an angle of 80 x 80 x 10 with a fillet, a bore and counterbored holes."""

    def __init__(self):
        super().__init__("Bracket")
        self.root.add("Angle bracket", self.mesh("angle bracket", "Steel", angle_bracket()))


# --- the file ---------------------------------------------------------------


def number(value, decimals):
    """Rounded, so that another machine's last bit of a sine is not seen; without a negative zero."""
    return round(value, decimals) + 0.0


def glb(scene):
    """The file: one primitive for each mesh, all places, normals and indices in a view of their own."""
    used = {material for material, _ in scene.meshes.values()}
    materials = [name for name in MATERIALS if name in used]
    meshes, nodes, accessors = [], [], []
    places, normals, indices = bytearray(), bytearray(), bytearray()
    index_of = {}
    for name, (material, solid) in scene.meshes.items():
        vertices, order = {}, []
        for triangle in solid.triangles:
            for p, n in triangle:
                vertex = (*[number(c, 4) for c in p], *[number(c, 3) for c in unit(n)])
                order.append(vertices.setdefault(vertex, len(vertices)))
        packed = [struct.pack("<3f", *[c * 0.001 for c in v[:3]]) for v in vertices]
        exact = list(zip(*[struct.unpack("<3f", p) for p in packed]))
        first = len(accessors)
        accessors.append(
            {
                "bufferView": 0,
                "byteOffset": len(places),
                "componentType": 5126,
                "count": len(vertices),
                "type": "VEC3",
                "min": [min(c) for c in exact],
                "max": [max(c) for c in exact],
            }
        )
        accessors.append({"bufferView": 1, "byteOffset": len(normals), "componentType": 5126, "count": len(vertices), "type": "VEC3"})
        places += b"".join(packed)
        for v in vertices:
            normals += struct.pack("<3f", *unit(v[3:]))
        wide = len(vertices) > 65535
        accessors.append(
            {"bufferView": 2, "byteOffset": len(indices), "componentType": 5125 if wide else 5123, "count": len(order), "type": "SCALAR"}
        )
        indices += struct.pack(f"<{len(order)}{'I' if wide else 'H'}", *order)
        indices += bytes(-len(indices) % 4)
        primitive = {"attributes": {"POSITION": first, "NORMAL": first + 1}, "indices": first + 2, "material": materials.index(material)}
        index_of[name] = len(meshes)
        meshes.append({"name": name, "primitives": [primitive]})

    def put(node):
        entry = {"name": node.name}
        nodes.append(entry)
        where = len(nodes) - 1
        if node.mesh:
            entry["mesh"] = index_of[node.mesh]
        if any(node.at):
            entry["translation"] = [number(c * 0.001, 7) for c in node.at]
        if node.turn:
            entry["rotation"] = [number(c, 7) for c in node.turn]
        if node.mirrored:
            entry["scale"] = [1, 1, -1]
        if node.children:
            entry["children"] = [put(child) for child in node.children]
        return where

    put(scene.root)
    shades = []
    for name in materials:
        colour, metallic, rough = MATERIALS[name]
        shade = {"name": name, "pbrMetallicRoughness": {"baseColorFactor": colour, "metallicFactor": metallic, "roughnessFactor": rough}}
        if colour[3] < 1:
            shade["alphaMode"] = "BLEND"
        shades.append(shade)
    views, offset = [], 0
    for part, target in ((places, 34962), (normals, 34962), (indices, 34963)):
        views.append({"buffer": 0, "byteOffset": offset, "byteLength": len(part), "target": target})
        offset += len(part)
    views[0]["byteStride"] = views[1]["byteStride"] = 12
    tree = {
        "asset": {"version": "2.0", "generator": "restyle meshes/make.py"},
        "scene": 0,
        "scenes": [{"name": scene.root.name, "nodes": [0]}],
        "nodes": nodes,
        "meshes": meshes,
        "materials": shades,
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"byteLength": offset}],
    }
    text = json.dumps(tree, separators=(",", ":")).encode("ascii")
    text += b" " * (-len(text) % 4)
    body = bytes(places + normals + indices)
    head = struct.pack("<4sII", b"glTF", 2, 12 + 8 + len(text) + 8 + len(body))
    return head + struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(body), b"BIN\0") + body


# --- what is in it ----------------------------------------------------------


def turn_by(q, p):
    t = scale(cross(q[:3], p), 2.0)
    return add(p, add(scale(t, q[3]), cross(q[:3], t)))


def placed(scene):
    """Each node with a mesh, and the function that puts the mesh's points into the scene."""

    def walk(node, outer):
        def put(p):
            if node.mirrored:
                p = (p[0], p[1], -p[2])
            if node.turn:
                p = turn_by(node.turn, p)
            return outer(add(p, node.at))

        if node.mesh:
            yield node, put
        for child in node.children:
            yield from walk(child, put)

    yield from walk(scene.root, lambda p: p)


def layers(scene, size):
    """Surfaces along each ray of a square grid over the scene, along -z."""
    triangles = []
    for node, put in placed(scene):
        _, solid = scene.meshes[node.mesh]
        triangles += [[put(p)[:2] for p, _ in t] for t in solid.triangles]
    low, high = [[f(p[i] for t in triangles for p in t) for i in range(2)] for f in (min, max)]
    cell = max(high[0] - low[0], high[1] - low[1]) / size
    # Rays pass through the middles of the cells; an irrational shift keeps them off edges.
    origin = [(a + b) / 2 - cell * size / 2 + cell * 0.0137 * math.sqrt(i + 2) for i, (a, b) in enumerate(zip(low, high))]
    counts = Counter()
    for t in triangles:
        a, b, c = [((x - origin[0]) / cell - 0.5, (y - origin[1]) / cell - 0.5) for x, y in t]
        if side_of(a, b, c) < 0:
            b, c = c, b
        for row in range(math.ceil(min(a[1], b[1], c[1])), math.floor(max(a[1], b[1], c[1])) + 1):
            left, right = -1e9, 1e9
            for p, q in ((a, b), (b, c), (c, a)):
                if p[1] != q[1]:
                    x = p[0] + (row - p[1]) * (q[0] - p[0]) / (q[1] - p[1])
                    if q[1] < p[1]:
                        left = max(left, x)
                    else:
                        right = min(right, x)
            for column in range(math.ceil(left), math.floor(right) + 1):
                counts[column, row] += 1
    return sorted(counts.values())


def main():
    arguments = sys.argv[1:]
    scenes = {"gearbox.glb": Gearbox(), "bracket.glb": Bracket()}
    files = {name: glb(scene) for name, scene in scenes.items()}
    for name, scene in scenes.items():
        parts = [node.mesh for node, _ in placed(scene)]
        count = {mesh: len(solid.triangles) for mesh, (_, solid) in scene.meshes.items()}
        print(
            f"{name}: {len(parts)} parts of {len(count)} meshes, {sum(map(count.get, parts))} triangles "
            f"({sum(count.values())} stored), {len(files[name])} bytes"
        )
    if "--layers" in arguments:
        size = int((arguments[arguments.index("--layers") + 1 :] or ["200"])[0])
        for name, scene in scenes.items():
            n = layers(scene, size)
            mean = sum(n) / len(n)
            print(f"{name}: covered {len(n) / size**2:.3f}, layers: median {n[len(n) // 2]}, mean {mean:.2f}, maximum {n[-1]}")
        return 0
    if "--check" not in arguments:
        for name, content in files.items():
            (HERE / name).write_bytes(content)
        return 0
    found = {path.name for path in HERE.iterdir() if path.suffix == ".glb"}
    wrong = sorted(found ^ files.keys())
    wrong += [name for name in sorted(found & files.keys()) if (HERE / name).read_bytes() != files[name]]
    for name in wrong:
        print(f"{name}: differs from what make.py writes; run make.py", file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
