#!/usr/bin/env python3
"""Writes the mesh that restyle ships, a two-stage gearbox, from formulas.

    python3 make.py               write gearbox.glb beside this script
    python3 make.py --check       compare instead; exit 1 if it differs, is missing or another .glb is not made here
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
FIT = 0.06  # radial play of cylinders in bores: more than the sagitta of their facets, so that none shows through


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
    return [((x + radius * math.cos(a), y + radius * math.sin(a)), (outward * math.cos(a), outward * math.sin(a))) for a in steps(start, end, count)]


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


def holds(loop, p):
    """Whether the loop is around p, by the crossings of a ray."""
    inside = False
    for a, b in zip(loop, loop[1:] + loop[:1]):
        if (a[1] > p[1]) != (b[1] > p[1]) and p[0] < a[0] + (p[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]):
            inside = not inside
    return inside


def bridged(outer, holes):
    """One loop: each hole, rightmost first, joined to the nearest corner that it sees."""
    holes = sorted(holes, key=lambda h: -max(h)[0])
    loop = list(outer)
    for number, hole in enumerate(holes):
        start = hole.index(max(hole))
        p = hole[start]
        edges = [e for other in [loop, *holes[number:]] for e in zip(other, other[1:] + other[:1])]

        def seen(i):
            q = loop[i]
            for a, b in edges:
                if p in (a, b) or q in (a, b):
                    continue
                if side_of(p, q, a) * side_of(p, q, b) <= 0 and side_of(a, b, p) * side_of(a, b, q) <= 0:
                    return False
            # The way in must lie in the corner: a corner that bridges meet in is there more than once.
            a, b = loop[i - 1], loop[(i + 1) % len(loop)]
            if side_of(a, q, b) > 0:
                return side_of(a, q, p) > 0 and side_of(q, b, p) > 0
            return side_of(a, q, p) > 0 or side_of(q, b, p) > 0

        i = next(i for i in sorted(range(len(loop)), key=lambda i: math.dist(loop[i], p)) if seen(i))
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
        return math.dist(a, c)

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
    corners = sorted(known.values())
    count = Counter()
    for loop in loops:
        for a, b in zip(loop, loop[1:] + loop[:1]):
            length, on = math.dist(a, b), []
            low, high = min(a[0], b[0]) - 1e-6, max(a[0], b[0]) + 1e-6
            for p in corners:
                if low <= p[0] <= high and abs(side_of(a, b, p)) < 1e-6 * length:
                    t = ((p[0] - a[0]) * (b[0] - a[0]) + (p[1] - a[1]) * (b[1] - a[1])) / length
                    if -1e-6 < t < length + 1e-6:
                        on.append((t, p))
            on = [p for _, p in sorted(on)]
            for p, q in zip(on, on[1:]):
                count[min(p, q), max(p, q)] += 1
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
            loop.append(p)
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

    def turned(self, turn):
        """Moved by a function of points that turns, without mirroring, or only shifts."""
        origin = turn((0.0, 0.0, 0.0))
        result = Solid()
        result.triangles = [tuple((turn(p), sub(turn(n), origin)) for p, n in t) for t in self.triangles]
        return result

    def sewn(self, name):
        """Splits edges at corners that lie on them, then checks what a solid must be; answers itself."""
        triangles = self.triangles
        for _ in range(20):
            edges = Counter((key(t[i][0]), key(t[(i + 1) % 3][0])) for t in triangles for i in range(3))
            loose = {e for e in edges if edges[e] != edges[e[1], e[0]]}
            if not loose:
                break
            corners = {}
            ends = {k for e in loose for k in e}
            for t in triangles:
                for p, _ in t:
                    k = key(p)
                    if k in ends:
                        corners.setdefault(k, p)
            result, split = [], False
            for t in triangles:
                where = None
                for i in range(3):
                    (a, m), (b, n) = t[i], t[(i + 1) % 3]
                    e = (key(a), key(b))
                    if e not in loose:
                        continue
                    d, length = sub(b, a), math.dist(a, b)
                    best = None
                    for k, p in corners.items():
                        if k in e:
                            continue
                        share = dot(sub(p, a), d) / length**2
                        if 0 < share < 1 and math.dist(p, add(a, scale(d, share))) < 1e-4:
                            if best is None or abs(share - 0.5) < abs(best[0] - 0.5):
                                best = (share, p)
                    if best:
                        where = (i, *best)
                        break
                if where is None:
                    result.append(t)
                    continue
                i, share, p = where
                (a, m), (b, n), c = t[i], t[(i + 1) % 3], t[(i + 2) % 3]
                middle = (p, unit(add(scale(m, 1 - share), scale(n, share))))
                result += [((a, m), middle, c), (middle, (b, n), c)]
                split = True
            triangles = result
            if not split:
                raise SystemExit(f"{name}: {len(loose)} loose edges, near {sorted(corners.values())[:4]}")
        self.triangles = triangles
        volume = 0.0
        for (a, _), (b, _), (c, _) in triangles:
            volume += dot(a, cross(b, c)) / 6
            if dot(*[cross(sub(b, a), sub(c, a))] * 2) < 1e-10:
                raise SystemExit(f"{name}: a degenerate triangle at {a}")
        if any(edges[e] != 1 for e in edges):
            raise SystemExit(f"{name}: an edge with more than two faces, near {next(e for e in edges if edges[e] != 1)}")
        if volume <= 0:
            raise SystemExit(f"{name}: inside out")
        self.volume = volume
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
    for psi in steps(0, TAU / 4 - pressure, 2):
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
    for q in steps(math.sqrt(first - base), math.sqrt(top - base), 4)[1:]:
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
    heights = steps(chamfer - width / 2, width / 2 - chamfer, slices)

    def corner(q, angle, normal, z, k, rise=0.0):
        turn = lead * z + k * pitch
        n = (math.cos(normal + turn), math.sin(normal + turn), rise)
        return (q * math.cos(angle + turn), q * math.sin(angle + turn), z), unit(n)

    step = pitch / rings
    inner = (web[0] if web else bore) + 1.0
    for k in range(teeth):
        for piece in (left, land, right, root):
            solid.grid([[corner(*c, z, k) for c in piece] for z in heights])
            for end in (-1, 1):
                rise = float(end) if piece is land else 0.0
                rows = [[corner(min(q, top - cut), a, n, end * (width / 2 - chamfer + cut), k, rise) for q, a, n in piece] for cut in (0.0, chamfer)]
                solid.grid(rows)
        for end in (-1, 1):
            z = end * width / 2
            loop = [corner(min(q, top - chamfer), a, n, z, k)[0][:2] for q, a, n in left + right + root[1:]]
            # The ring of the bore does not follow the helix.
            first = k * rings + round(lead * z / step)
            loop += [(inner * math.cos(a), inner * math.sin(a)) for a in ((first + i) * step - pitch / 2 for i in range(rings, -1, -1))]
            for t in ears(loop):
                solid.triangle(*[((*p, z), (0.0, 0.0, float(end))) for p in t])
    top = width / 2
    if not web:
        paths = [[(inner, top), (bore, top - 1), (bore, 1 - top), (inner, -top)]]
    else:
        rim, hub, hub_width, thick, count, on, radius = web
        t, h = thick / 2, hub_width / 2
        far, near = rim - 6, hub + 6
        paths = [
            [(inner, top), (rim, top - 1), (rim - 1.5, t, 3), (far, t)],
            [(near, t), (hub + 1.5, t, 3), (hub, h, -1), (bore, h, -1), (bore, -h, -1), (hub, -h, -1), (hub + 1.5, -t, 3), (near, -t)],
            [(far, -t), (rim - 1.5, -t, 3), (rim, 1 - top), (inner, -top)],
        ]
        holes = [solid.hole(c, radius, 16, level(-t), level(t)) for c in circle(0, 0, on, count)]
        for z in (-t, t):
            rings_of = [circle(0, 0, q, teeth * rings, -pitch / 2) for q in (far, near)]
            solid.flat(rings_of + holes, level(z), (0.0, 0.0, math.copysign(1.0, z)))
    for path in paths:
        solid.revolve(outline(path, False, 3), teeth * rings, -pitch / 2)
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
FLOOR, FOOT = -109.0, -95.0  # bottom, and top of the feet
ENDS = (SHAFT_X[0] - CROWN[0], SHAFT_X[2] + CROWN[2])
BOLTS = [(x, z) for x in (-187.0, -86.0, 6.0, 138.0, 187.0) for z in (-65.5, 65.5)] + [(-191.0, 0.0), (191.0, 0.0)]
DOWELS = [(-191.0, -30.0), (191.0, 30.0)]
BOLT_HOLE, DOWEL = 4.5, 4.0
CAP_SCREWS = [(31.5, 2.5, [TAU * (k + 0.5) / 4 for k in range(4)])] * 2 + [(46.5, 3.0, [TAU * (k + 0.5) / 6 for k in range(6)])]
SIGHT = (-52.0, 0.0, 15.0)  # y, z and radius of the hole in the wall at the output end
DRAIN = (-80.0, 0.0, 8.0)
# The opening on the flat of the cover between the arcs about the last two shafts: half lengths along x and z, corner.
OPENING = (30.0, 24.0, 6.0)
# A rib under each boss of the base, in plan from its shaft: out of the wall, round in front, back into the wall.
RIB_HALF = 6.0
RIB = outline([(RIB_HALF, SIDE), (RIB_HALF, 72.0, 4.0), (-RIB_HALF, 72.0, 4.0), (-RIB_HALF, SIDE)], False)


def ground(y):
    """Puts a point (x, z) at a height."""
    return lambda p: (p[0], y, p[1])


def upright(z):
    """Puts a point (x, y) at z."""
    return lambda p: (p[0], p[1], z)


def box(x0, x1, y0, y1, corner=0.0, count=4):
    return outline([(x0, y0, corner), (x1, y0, corner), (x1, y1, corner), (x0, y1, corner)], True, count)


def tangent(i):
    """The angle of the normal of the straight piece between arcs i and i + 1."""
    return math.acos((CROWN[i] - CROWN[i + 1]) / (SHAFT_X[i + 1] - SHAFT_X[i]))


def crown(inset, foot):
    """The cover's profile from its right foot to its left one, arcs by arcs: pieces of (point, normal)."""
    radii = [r - inset for r in CROWN]
    ends = [math.pi - math.asin(foot / radii[0]), tangent(0), tangent(1), math.asin(foot / radii[2])]
    pieces = [arc(SHAFT_X[i], 0, radii[i], ends[i + 1], ends[i], n) for i, n in ((2, 14), (1, 6), (0, 8))]
    straight = [[pieces[0][-1], pieces[1][0]], [pieces[1][-1], pieces[2][0]]]
    return [pieces[0], straight[0], pieces[1], straight[1], pieces[2]]


def flat_frame(inset):
    """The plane of the cover's flat: places (along the slope from its middle, z), its normal, and half its length."""
    _, (a, b), *_ = crown(inset, 0.0)
    middle, n = ((a[0][0] + b[0][0]) / 2, (a[0][1] + b[0][1]) / 2), a[1]
    along = (n[1], -n[0])
    return lambda p: (middle[0] + along[0] * p[0], middle[1] + along[1] * p[0], p[1]), (*n, 0.0), math.dist(a[0], b[0]) / 2


def boss_angles(radius):
    """From 0 to pi, with the heights of the flange's edge among them."""
    low = [0.0] + [math.asin((FLANGE - below) / radius) for _, below, _, _ in rounding(EDGE, 3)]
    return low, steps(low[-1], math.pi - low[-1], 20)


def flange_half(solid, up, ribs):
    """What cover and base have alike: flange, bosses, bores and holes, upward (1) or downward (-1) from y = 0.
    """
    top = up * FLANGE
    lip = rounding(EDGE, 3)
    # The ends of the flange and its round corners; the long sides are between the bosses.
    plan = box(-FLANGE_X, FLANGE_X, -FLANGE_Z, FLANGE_Z, 16.0, 6)
    for piece in plan:
        if abs(piece[0][1][1]) == 1 and piece[0][1] == piece[-1][1]:
            continue
        rows = [[((p[0], 0.0, p[1]), (n[0], 0.0, n[1])) for p, n in piece]]
        for inset, below, side, rise in lip:
            rows.append([((p[0] - inset * n[0], top - up * below, p[1] - inset * n[1]), (side * n[0], up * rise, side * n[1])) for p, n in piece])
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
            low, high = boss_angles(r)
            starts = [FLANGE_Z] + [FLANGE_Z - inset for inset, *_ in lip]
            # Around the boss: columns of (angle, where along z it begins).
            mantle = [list(zip(low, starts))]
            if ribs:
                first, last = math.acos(RIB_HALF / r), math.acos(-RIB_HALF / r)
                mantle.append([(a, SIDE) for a in steps(high[0], first, 9)])
                mantle.append([(math.acos(p / r), q) for p, q in path(RIB[1:-1])])
                mantle.append([(a, SIDE) for a in steps(last, high[-1], 9)])
            else:
                mantle.append([(a, SIDE) for a in high])
            mantle.append([(math.pi - a, s) for a, s in zip(low, starts)][::-1])
            for columns in mantle:
                rows = []
                for end in (None, FACE - EDGE):
                    rows.append([((x + r * math.cos(a), up * r * math.sin(a), z * (s if end is None else end)), (math.cos(a), up * math.sin(a), 0.0)) for a, s in columns])
                solid.grid(rows)
            around = [0.0] + [a for columns in mantle for a, _ in columns[1:]]
            rows = []
            for inset, below, side, rise in lip:
                q = r - inset
                rows.append([((x + q * math.cos(a), up * q * math.sin(a), z * (FACE - below)), (side * math.cos(a), up * side * math.sin(a), z * rise)) for a in around])
            solid.grid(rows)
            inside = steps(0.0, math.pi, 24)
            solid.grid([[((x + bore * math.cos(a), up * bore * math.sin(a), z * q), (-math.cos(a), -up * math.sin(a), 0.0)) for a in inside] for q in (SIDE - WALL, FACE)])
            face = [[(x + q * math.cos(a), up * q * math.sin(a)) for a in angles] for q, angles in ((r - EDGE, around), (bore, inside))]
            face = [face[0] + face[1][::-1]]
            on, radius, angles = CAP_SCREWS[i]
            for a in angles:
                if math.sin(a) * up > 0:
                    c = (x + on * math.cos(a), on * math.sin(a))
                    face.append(solid.hole(c, radius, 12, upright(z * (FACE - 14)), upright(z * FACE)))
                    solid.flat([circle(*c, radius, 12)], upright(z * (FACE - 14)), (0.0, 0.0, float(z)))
            solid.flat(face, upright(z * FACE), (0.0, 0.0, float(z)))
            below_loops.append([(x - r, z * FLANGE_Z), *[(x - r + inset, z * (FACE - below)) for inset, below, *_ in lip], *[(x + r - inset, z * (FACE - below)) for inset, below, *_ in lip[::-1]], (x + r, z * FLANGE_Z)])
            below_loops.append([(x - bore, z * (SIDE - WALL)), (x - bore, z * FACE), (x + bore, z * FACE), (x + bore, z * (SIDE - WALL))])
            half = math.sqrt(r * r - FLANGE**2)
            top_loops.append([(x - half, z * SIDE), (x - half, z * (FLANGE_Z - EDGE)), (x + half, z * (FLANGE_Z - EDGE)), (x + half, z * SIDE)])
    for centres, radius in ((BOLTS, BOLT_HOLE), (DOWELS, DOWEL)):
        for c in centres:
            loop = solid.hole(c, radius, 16, ground(0.0), ground(top))
            below_loops.append(loop)
            top_loops.append(loop)
    inner = SIDE - WALL
    below_loops.append(points(box(ENDS[0] + WALL, ENDS[1] - WALL, -inner, inner, INNER_ROUND, 5)))
    solid.flat(below_loops, ground(0.0), (0.0, -float(up), 0.0))
    return top_loops


def housing_cover():
    solid = Solid()
    top_loops = flange_half(solid, 1, False)
    for outside, width, wall, radius, foot, facing in ((True, SIDE, 0.0, ROUND, FLANGE, 1), (False, SIDE - WALL, WALL, INNER_ROUND, 0.0, -1)):
        rows = []
        for inset, below, side, rise in rounding(radius, 5):
            rows.append((width - below, wall + inset, side, rise))
        rows = [(-z, inset, side, -rise) for z, inset, side, rise in reversed(rows)] + rows
        lines = []
        for z, inset, side, rise in rows:
            lines.append([[((*p, z), (facing * side * n[0], facing * side * n[1], facing * rise)) for p, n in piece] for piece in crown(inset, foot)])
        for low, high in zip(lines, lines[1:]):
            for i, (a, b) in enumerate(zip(low, high)):
                if i != 1 or b[0][0][2] - a[0][0][2] < 2 * (width - radius) - 1e-6:
                    solid.grid([a, b])
        place, n, half = flat_frame(wall)
        opening = box(-OPENING[0], OPENING[0], -OPENING[1], OPENING[1], OPENING[2], 4)
        straight = width - radius
        solid.flat([[(-half, -straight), (half, -straight), (half, straight), (-half, straight)], points(opening)], place, scale(n, float(facing)))
        if outside:
            deep = flat_frame(WALL)[0]
            solid.wall([[(p, (-m[0], -m[1])) for p, m in piece] for piece in opening], deep, place)
        for z in (-width, width):
            profile = path(crown(wall + radius, foot))
            loops = [profile]
            for x, r, bore in zip(SHAFT_X, BOSS, BORE):
                if outside:
                    loops.append([(x + r * math.cos(a), r * math.sin(a)) for a in boss_angles(r)[1]])
                else:
                    loops.append([(x + bore * math.cos(a), bore * math.sin(a)) for a in steps(0.0, math.pi, 24)])
            solid.flat(loops, upright(z), (0.0, 0.0, math.copysign(1.0, z * facing)))
        if outside:
            ends = [(line[0][0][0], line[-1][-1][0]) for line in lines]
            top_loops.append([(a[0], a[2]) for a, _ in ends] + [(b[0], b[2]) for _, b in reversed(ends)])
    solid.flat(top_loops, ground(FLANGE), (0.0, 1.0, 0.0))
    return solid


def housing_base():
    solid = Solid()
    top_loops = flange_half(solid, -1, True)
    plan = box(*ENDS, -SIDE, SIDE, ROUND, 5)
    top_loops.append(points(plan))
    solid.flat(top_loops, ground(-FLANGE), (0.0, -1.0, 0.0))
    corners = [piece for piece in plan if len(piece) > 2]
    solid.wall(corners, ground(FLOOR), ground(-FLANGE))
    inner = box(ENDS[0] + WALL, ENDS[1] - WALL, WALL - SIDE, SIDE - WALL, INNER_ROUND, 5)
    curb, bed = 6.0, FLOOR + 10.0
    solid.wall([[(p, (-n[0], -n[1])) for p, n in piece] for piece in inner if len(piece) > 2], ground(bed + curb), ground(0.0))
    for piece in inner:
        rows = [[((p[0] - i * n[0], bed + b, p[1] - i * n[1]), (-s * n[0], t, -s * n[1])) for p, n in piece] for i, b, s, t in rounding(curb, 4)]
        solid.grid(rows)
    solid.flat([points(shifted(inner, curb))], ground(bed), (0.0, 1.0, 0.0))
    # The walls at the ends, with the holes for sight glass and drain plug at one of them.
    for x, facing in ((ENDS[0], -1), (ENDS[1], 1)):
        for at, reach, low, high, n in ((x, SIDE - ROUND, FLOOR, -FLANGE, facing), (x - facing * WALL, SIDE - WALL - INNER_ROUND, bed + curb, 0.0, -facing)):
            loops = [[(low, -reach), (high, -reach), (high, reach), (low, reach)]]
            if facing > 0:
                loops += [circle(y, z, r, 24) for y, z, r in (SIGHT, DRAIN)]
            solid.flat(loops, lambda p, at=at: (at, *p), (float(n), 0.0, 0.0))
        if facing > 0:
            for y, z, r in (SIGHT, DRAIN):
                solid.hole((y, z), r, 24, lambda p: (x - WALL, *p), lambda p: (x, *p))
    # The long walls, with feet, bosses and ribs.
    foot_x, foot_z, lip = 165.0, 78.0, rounding(2.0, 3)
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
            loop = solid.hole((x, z * 67.0), 6.5, 20, ground(FLOOR), ground(FOOT))
            tops.append(loop)
            bottoms.append(loop)
        wall = [[(ENDS[0] + ROUND, -FLANGE), (ENDS[0] + ROUND, FLOOR), (ENDS[1] - ROUND, FLOOR), (ENDS[1] - ROUND, -FLANGE)]]
        wall.append([(-foot_x, FLOOR), *[(i - foot_x, FOOT - b) for i, b, *_ in lip], *[(foot_x - i, FOOT - b) for i, b, *_ in reversed(lip)], (foot_x, FLOOR)])
        inside = [[(ENDS[0] + WALL + INNER_ROUND, 0.0), (ENDS[0] + WALL + INNER_ROUND, bed + curb), (ENDS[1] - WALL - INNER_ROUND, bed + curb), (ENDS[1] - WALL - INNER_ROUND, 0.0)]]
        for x, r, bore in zip(SHAFT_X, BOSS, BORE):
            for piece in RIB:
                low = [((x + p[0], FOOT, z * p[1]), (m[0], 0.0, z * m[1])) for p, m in piece]
                high = [((x + p[0], -math.sqrt(r * r - p[0] ** 2), z * p[1]), (m[0], 0.0, z * m[1])) for p, m in piece]
                solid.grid([low, high])
            tops.append([(x + p, z * q) for p, q in path(RIB)])
            start = boss_angles(r)[1][0]
            first = math.acos(RIB_HALF / r)
            arcs = [(r * math.cos(a), -r * math.sin(a)) for a in steps(start, first, 9)]
            arcs = [*arcs, (RIB_HALF, FOOT), (-RIB_HALF, FOOT), *[(-p, q) for p, q in reversed(arcs)]]
            wall.append([(x + p, q) for p, q in arcs])
            inside.append([(x + bore * math.cos(a), -bore * math.sin(a)) for a in steps(0.0, math.pi, 24)])
        solid.flat(wall, upright(z * SIDE), (0.0, 0.0, float(z)))
        solid.flat(inside, upright(z * (SIDE - WALL)), (0.0, 0.0, -float(z)))
        solid.flat(tops, ground(FOOT), (0.0, 1.0, 0.0))
        bottom += bottoms
    solid.flat(bottom, ground(FLOOR), (0.0, -1.0, 0.0))
    return solid
