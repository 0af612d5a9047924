#!/usr/bin/env python3
"""Writes the molecules that restyle ships, from formulas and published geometry.

    python3 make.py            write every file beside this script
    python3 make.py --check    compare instead; exit 1 if a file differs, is missing or is not made here

Every file names its source in its comment or REMARK line, and so does the function that makes it.
Lengths are in angstrom, angles in degrees. Standard library only.

Checked against an abstract or a database that quotes the source: C60, magnesium, ferrocene (Fe-C and C-C). The numbers of
the others are those that handbooks give under these sources; the papers themselves were not at hand.
"""

import math
import sys
from itertools import product
from pathlib import Path

HERE = Path(__file__).resolve().parent
MOLECULES = []


def molecule(function):
    """Registers a function that returns (file name, text)."""
    MOLECULES.append(function)
    return function


# --- vectors and files ------------------------------------------------------


def add(a, b):
    return tuple(x + y for x, y in zip(a, b))


def sub(a, b):
    return tuple(x - y for x, y in zip(a, b))


def scale(a, s):
    return tuple(x * s for x in a)


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def length(a):
    return math.sqrt(dot(a, a))


def unit(a):
    return scale(a, 1 / length(a))


def number(value, width, decimals):
    """Fixed point without a negative zero."""
    return f"{round(value, decimals) + 0.0:{width}.{decimals}f}"


def centred(atoms):
    """The atoms around the mean of their positions."""
    mean = scale([sum(p[i] for _, p in atoms) for i in range(3)], 1 / len(atoms))
    return [(symbol, sub(p, mean)) for symbol, p in atoms]


def turned(atoms, about_y, about_x):
    """Turned by two angles in degrees, so that nothing hides behind its neighbour in the default view along -z."""
    (cy, sy), (cx, sx) = [(math.cos(math.radians(a)), math.sin(math.radians(a))) for a in (about_y, about_x)]

    def turn(p):
        x, z = cy * p[0] + sy * p[2], cy * p[2] - sy * p[0]
        return (x, cx * p[1] - sx * z, sx * p[1] + cx * z)

    return [(symbol, turn(p)) for symbol, p in atoms]


def xyz(name, comment, atoms):
    rows = [f"{s:<2}" + "".join(number(v, 12, 5) for v in p) for s, p in centred(atoms)]
    return name + ".xyz", "\n".join([str(len(atoms)), comment, *rows]) + "\n"


def place(a, b, c, bond, angle, torsion):
    """The atom d at a distance from c, with the angle b-c-d and the torsion a-b-c-d."""
    angle, torsion = math.radians(angle), math.radians(torsion)
    bc = unit(sub(c, b))
    normal = unit(cross(sub(b, a), bc))
    side = cross(normal, bc)
    along = scale(bc, -bond * math.cos(angle))
    across = scale(side, bond * math.sin(angle) * math.cos(torsion))
    up = scale(normal, bond * math.sin(angle) * math.sin(torsion))
    return add(c, add(along, add(across, up)))


# --- the molecules ----------------------------------------------------------


@molecule
def c60():
    """Icosahedron edges cut at both ends: pentagon bonds next to the corners, the bond of two hexagons between.

    Hedberg et al., Science 1991, 254, 410: 1.458 and 1.401 in the gas.
    """
    pentagon, hexagons = 1.458, 1.401
    edge = 2 * pentagon + hexagons
    golden = (1 + math.sqrt(5)) / 2
    corners = []
    for s, t in product((-1, 1), repeat=2):
        for shift in range(3):
            p = (0, s, t * golden)
            corners.append(scale(p[shift:] + p[:shift], edge / 2))
    atoms = []
    for a in corners:
        for b in corners:
            if a != b and abs(length(sub(b, a)) - edge) < 1e-6:
                atoms.append(("C", add(a, scale(sub(b, a), pentagon / edge))))
    return xyz("c60", "C60; bonds 1.458 and 1.401 A from Hedberg et al., Science 1991, 254, 410", atoms)


@molecule
def arsenic_trioxide():
    """As4O6, Td: As at (a, a, a), O at (d, 0, 0).

    Hampson, Stosick, J. Am. Chem. Soc. 1938, 60, 1814: As-O 1.78, As-O-As 128; O-As-O follows as 98.8, published 99 +- 2.
    """
    bond, angle = 1.78, math.radians(128)
    a = bond * math.sin(angle / 2) / math.sqrt(2)
    d = a + bond * math.cos(angle / 2)
    atoms = [("As", p) for p in [(a, a, a), (a, -a, -a), (-a, a, -a), (-a, -a, a)]]
    for axis in range(3):
        for sign in (1, -1):
            atoms.append(("O", tuple(sign * d if i == axis else 0.0 for i in range(3))))
    return xyz("arsenic_trioxide", "As4O6; As-O 1.78 A, As-O-As 128 deg from Hampson and Stosick, J. Am. Chem. Soc. 1938, 60, 1814", turned(atoms, 24, 16))


@molecule
def anthracene():
    """C14H10, D2h, in the xy plane, long axis y.

    Carbon-carbon lengths of the crystal at 94 K, rounded to 0.01: Brock, Dunitz, Acta Cryst. B 1990, 46, 795.
    The two free angles, 121.5 at C9 and 118.8 at C9a, and C-H 1.09 are ours, near those of the crystal.
    """
    c1_c2, c2_c3, c1_c9a, c9_c9a, c4a_c9a, c_h = 1.36, 1.43, 1.43, 1.40, 1.44, 1.09
    half = math.radians(121.5 / 2)
    tilt = math.radians(180 - 118.8)
    c9a = (c4a_c9a / 2, c9_c9a * math.sin(half))
    c9 = (c9a[0] + c9_c9a * math.cos(half), 0.0)
    c1 = (c9a[0] + c1_c9a * math.cos(tilt), c9a[1] + c1_c9a * math.sin(tilt))
    c2 = (c2_c3 / 2, c1[1] + math.sqrt(c1_c2**2 - (c1[0] - c2_c3 / 2) ** 2))
    flat = lambda p: (p[0], p[1], 0.0)
    c1, c2, c9, c9a = map(flat, (c1, c2, c9, c9a))
    c3 = (-c2[0], c2[1], 0.0)

    def hydrogen(of, *neighbours):
        away = [unit(sub(of, n)) for n in neighbours]
        return add(of, scale(unit(add(*away)), c_h))

    quarter = [("C", c1), ("C", c2), ("C", c9a), ("H", hydrogen(c1, c2, c9a)), ("H", hydrogen(c2, c1, c3))]
    atoms = [(s, (x * p[0], y * p[1], 0.0)) for s, p in quarter for x in (1, -1) for y in (1, -1)]
    atoms += [("C", (x * c9[0], 0.0, 0.0)) for x in (1, -1)]
    atoms += [("H", (x * (c9[0] + c_h), 0.0, 0.0)) for x in (1, -1)]
    return xyz("anthracene", "anthracene; lengths rounded from Brock and Dunitz, Acta Cryst. B 1990, 46, 795", atoms)


@molecule
def magnesium():
    """A hexagonal prism of the metal: layers of 19, 12, 19, 12 and 19 atoms.

    Walker, Marezio, Acta Metall. 1959, 7, 769: hexagonal close packing, a = 3.2094, c = 5.2108.
    """
    a, c = 3.2094, 5.2108
    atoms = []
    for layer in range(-2, 3):
        for i, j in product(range(-4, 5), repeat=2):
            shift = 1 / 3 if layer % 2 else 0.0
            u, v = i + shift, j + shift
            # Inside a hexagon of two cells: all three lattice coordinates are at most 2.
            if max(abs(u), abs(v), abs(u + v)) <= 2 + 1e-9:
                atoms.append(("Mg", (a * (u + v / 2), a * v * math.sqrt(3) / 2, c / 2 * layer)))
    return xyz("magnesium", "magnesium metal; a = 3.2094, c = 5.2108 A from Walker and Marezio, Acta Metall. 1959, 7, 769", turned(atoms, 17, -62))


TETRAHEDRON = [unit(p) for p in [(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)]]


@molecule
def methane():
    """Hirota, J. Mol. Spectrosc. 1979, 77, 213: equilibrium C-H 1.087."""
    atoms = [("C", (0, 0, 0))] + [("H", scale(p, 1.087)) for p in TETRAHEDRON]
    return xyz("methane", "methane; C-H 1.087 A from Hirota, J. Mol. Spectrosc. 1979, 77, 213", turned(atoms, 20, 12))


@molecule
def water():
    """Benedict, Gailar, Plyler, J. Chem. Phys. 1956, 24, 1139: O-H 0.9572, H-O-H 104.52."""
    half = math.radians(104.52 / 2)
    x, y = 0.9572 * math.sin(half), -0.9572 * math.cos(half)
    atoms = [("O", (0, 0, 0)), ("H", (x, y, 0)), ("H", (-x, y, 0))]
    return xyz("water", "water; 0.9572 A and 104.52 deg from Benedict, Gailar and Plyler, J. Chem. Phys. 1956, 24, 1139", atoms)


@molecule
def ammonia():
    """Benedict, Plyler, Can. J. Phys. 1957, 35, 1235: N-H 1.012, H-N-H 106.67."""
    bond = 1.012
    ring = 2 * bond * math.sin(math.radians(106.67 / 2)) / math.sqrt(3)
    height = math.sqrt(bond**2 - ring**2)
    atoms = [("N", (0, 0, 0))]
    for k in range(3):
        turn = math.radians(120 * k)
        atoms.append(("H", (ring * math.sin(turn), -height, ring * math.cos(turn))))
    return xyz("ammonia", "ammonia; 1.012 A and 106.67 deg from Benedict and Plyler, Can. J. Phys. 1957, 35, 1235", turned(atoms, 25, 22))


@molecule
def benzene():
    """Langseth, Stoicheff, Can. J. Phys. 1956, 34, 350: C-C 1.397, C-H 1.084."""
    atoms = []
    for symbol, radius in [("C", 1.397), ("H", 1.397 + 1.084)]:
        for k in range(6):
            turn = math.radians(60 * k + 30)
            atoms.append((symbol, (radius * math.cos(turn), radius * math.sin(turn), 0.0)))
    return xyz("benzene", "benzene; C-C 1.397, C-H 1.084 A from Langseth and Stoicheff, Can. J. Phys. 1956, 34, 350", atoms)


def relax(points, springs, steps=6000):
    """Moves points until every spring (i, j, rest length, weight) is as near its length as all of them allow."""
    points = [list(p) for p in points]
    for _ in range(steps):
        for i, j, rest, weight in springs:
            d = sub(points[j], points[i])
            now = length(d)
            push = scale(d, 0.5 * weight * (now - rest) / now)
            points[i] = list(add(points[i], push))
            points[j] = list(sub(points[j], push))
    return [tuple(p) for p in points]


@molecule
def caffeine():
    """C8H10N4O2: two flat rings, bond lengths typical of their kinds to 0.01, ring angles found by relaxation.

    Lengths: Allen et al., J. Chem. Soc. Perkin Trans. 2 1987, S1 (averages over crystal structures), rounded by us.
    """
    ring = {"N1": (-1, 0.7), "C2": (-1, -0.7), "N3": (0, -1.4), "C4": (1.2, -0.7), "C5": (1.2, 0.7), "C6": (0, 1.4)}
    ring.update({"N7": (2.5, 1.1), "C8": (3.3, 0.0), "N9": (2.5, -1.1)})
    outer = {"O2": (-2.2, -1.3), "O6": (0, 2.6), "C1m": (-2.3, 1.4), "C3m": (0, -2.9), "C7m": (3.0, 2.5), "H8": (4.4, 0.0)}
    bonds = {
        ("N1", "C2"): 1.40, ("C2", "N3"): 1.38, ("N3", "C4"): 1.37, ("C4", "C5"): 1.37, ("C5", "C6"): 1.42, ("C6", "N1"): 1.40,
        ("C5", "N7"): 1.38, ("N7", "C8"): 1.34, ("C8", "N9"): 1.33, ("N9", "C4"): 1.36, ("C2", "O2"): 1.22, ("C6", "O6"): 1.23,
        ("N1", "C1m"): 1.47, ("N3", "C3m"): 1.47, ("N7", "C7m"): 1.47, ("C8", "H8"): 1.08,
    }  # fmt: skip
    names = [*ring, *outer]
    springs = [(names.index(a), names.index(b), rest, 1.0) for (a, b), rest in bonds.items()]
    around = {n: [b if a == n else a for a, b in bonds if n in (a, b)] for n in names}
    bond = lambda a, b: bonds.get((a, b)) or bonds[(b, a)]
    five = {"C4", "C5", "N7", "C8", "N9"}
    for centre, others in around.items():
        for a, b in ((a, b) for a in others for b in others if names.index(a) < names.index(b)):
            in_five = {centre, a, b} <= five
            on_five = centre in five and not in_five
            fused = centre in ("C4", "C5") and on_five
            six = fused and {a, b} <= set(ring) - five | {"C4", "C5"}
            angle = 108 if in_five else 122 if six else 130 if fused else 126 if on_five else 120
            p, q = bond(centre, a), bond(centre, b)
            rest = math.sqrt(p * p + q * q - 2 * p * q * math.cos(math.radians(angle)))
            springs.append((names.index(a), names.index(b), rest, 0.05))
    points = relax([(*p, 0.0) for p in (ring | outer).values()], springs)
    at = dict(zip(names, points))
    atoms = [(name[0], point) for name, point in at.items()]
    # Methyl hydrogens: 1.09 and tetrahedral, one of them in the plane.
    for carbon, nitrogen, turned_to in [("C1m", "N1", "C2"), ("C3m", "N3", "C2"), ("C7m", "N7", "C8")]:
        for torsion in (0, 120, 240):
            atoms.append(("H", place(at[turned_to], at[nitrogen], at[carbon], 1.09, 109.47, torsion)))
    return xyz("caffeine", "caffeine; typical lengths from Allen et al., J. Chem. Soc. Perkin Trans. 2 1987, S1, angles relaxed", atoms)


@molecule
def diamond():
    """C35H36: the carbons within 3.6 A of one, and hydrogens 1.09 along the bonds that were cut.

    Straumanis, Aka, J. Am. Chem. Soc. 1951, 73, 5643: lattice constant 3.5668.
    """
    sites, shell = {(0, 0, 0): 1}, [((0, 0, 0), 1)]
    # Bonds point along +(1,1,1) and its kin from one sublattice, against them from the other; coordinates in a/4.
    steps = [(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)]
    for _ in range(4):
        shell = [(add(p, scale(s, side)), -side) for p, side in shell for s in steps]
        sites.update({p: side for p, side in shell})
    kept = {p: side for p, side in sites.items() if dot(p, p) <= 16}
    position = lambda p: scale(p, 3.5668 / 4)
    atoms = [("C", position(p)) for p in sorted(kept)]
    for p in sorted(kept):
        for s in steps:
            if add(p, scale(s, kept[p])) not in kept:
                atoms.append(("H", add(position(p), scale(unit(s), 1.09 * kept[p]))))
    return xyz("diamond", "hydrogenated diamond cluster; a = 3.5668 A from Straumanis and Aka, J. Am. Chem. Soc. 1951, 73, 5643", turned(atoms, 14, 10))


@molecule
def sodium_chloride():
    """A cube of 4 x 4 x 4 ions. CRC Handbook of Chemistry and Physics, "Crystal ionic structures": halite, a = 5.6402."""
    half = 5.6402 / 2
    atoms = [("Na" if sum(p) % 2 == 0 else "Cl", scale(p, half)) for p in product(range(4), repeat=3)]
    return xyz("sodium_chloride", "sodium chloride, rock salt structure; a = 5.6402 A from the CRC Handbook of Chemistry and Physics", turned(atoms, 29, 21))


@molecule
def nanotube():
    """An open (5,5) armchair tube of seven cells: a sheet with bonds of 1.42, rolled up without stretching.

    Saito, Dresselhaus, Dresselhaus, Physical Properties of Carbon Nanotubes, 1998, chapter 3.
    """
    n, cells, bond = 5, 7, 1.42
    around, along = 3 * bond * n, math.sqrt(3) * bond
    radius = around / (2 * math.pi)
    atoms = []
    for cell, unit_cell in product(range(cells), range(n)):
        for x, y in [(0, 0), (1, 0), (1.5, 0.5), (2.5, 0.5)]:
            turn = (3 * unit_cell + x) * bond / radius
            atoms.append(("C", (radius * math.cos(turn), along * (cell + y), radius * math.sin(turn))))
    return xyz("nanotube", "(5,5) carbon nanotube; C-C 1.42 A along the wall from Saito et al., Physical Properties of Carbon Nanotubes, 1998", turned(atoms, 12, 24))


@molecule
def ferrocene():
    """Eclipsed. Haaland, Nilsson, Acta Chem. Scand. 1968, 22, 2653: Fe-C 2.064, C-C 1.440, C-H 1.104 (drawn in the ring's plane)."""
    ring = 1.440 / (2 * math.sin(math.radians(36)))
    height = math.sqrt(2.064**2 - ring**2)
    atoms = [("Fe", (0, 0, 0))]
    for symbol, radius in [("C", ring), ("H", ring + 1.104)]:
        for side, k in product((1, -1), range(5)):
            turn = math.radians(72 * k)
            atoms.append((symbol, (radius * math.sin(turn), side * height, radius * math.cos(turn))))
    return xyz("ferrocene", "ferrocene; lengths from Haaland and Nilsson, Acta Chem. Scand. 1968, 22, 2653", turned(atoms, 12, 14))


@molecule
def sulfur():
    """S8 crown, D4d. Rettig, Trotter, Acta Cryst. C 1987, 43, 2260: means S-S 2.05, S-S-S 108, rounded."""
    bond, angle = 2.05, math.radians(108)
    across = 2 * bond * math.sin(angle / 2)
    radius = across / math.sqrt(2)
    flat = 2 * radius * math.sin(math.radians(22.5))
    rise = math.sqrt(bond**2 - flat**2)
    atoms = []
    for k in range(8):
        turn = math.radians(45 * k)
        atoms.append(("S", (radius * math.cos(turn), rise / 2 * (-1) ** k, radius * math.sin(turn))))
    return xyz("sulfur", "S8; mean S-S 2.05 A and 108 deg from Rettig and Trotter, Acta Cryst. C 1987, 43, 2260", turned(atoms, 20, 52))


@molecule
def alpha_helix():
    """Sixteen alanines from internal coordinates.

    Lengths and angles: Engh, Huber, Acta Cryst. A 1991, 47, 392. Torsions -57, -47, 180: IUPAC-IUB, Biochemistry 1970, 9, 3471.
    """
    count, phi, psi, omega = 16, -57, -47, 180
    n = (0.0, 0.0, 0.0)
    ca = (1.458, 0.0, 0.0)
    turn = math.radians(111.2)
    c = add(ca, (-1.525 * math.cos(turn), 1.525 * math.sin(turn), 0.0))
    atoms = []
    for residue in range(1, count + 1):
        next_n = place(n, ca, c, 1.329, 116.2, psi)
        oxygen = place(n, ca, c, 1.231, 120.8, psi + 180)
        # The side chain of an L-amino acid: this torsion N-C-CA-CB makes the angle N-CA-CB 110.2.
        beta = place(n, c, ca, 1.521, 110.1, 122.5)
        atoms += [("N", "N", residue, n), ("CA", "C", residue, ca), ("C", "C", residue, c)]
        atoms += [("O", "O", residue, oxygen), ("CB", "C", residue, beta)]
        if residue == count:
            atoms.append(("OXT", "O", residue, place(n, ca, c, 1.231, 120.8, psi)))
        next_ca = place(ca, c, next_n, 1.458, 121.7, omega)
        n, ca, c = next_n, next_ca, place(c, next_n, next_ca, 1.525, 111.2, phi)
    # Turn the axis, through the means of both halves, to y.
    halves = [[p for _, _, residue, p in atoms if (residue <= count / 2) == first] for first in (True, False)]
    means = [scale([sum(p[i] for p in half) for i in range(3)], 1 / len(half)) for half in halves]
    axis = unit(sub(means[1], means[0]))
    side = unit(cross(axis, (0.0, 0.0, 1.0)))
    frame = (side, axis, cross(side, axis))
    points = centred([(name, tuple(dot(f, p) for f in frame)) for name, _, _, p in atoms])
    lines = [
        "REMARK   polyalanine alpha helix, made from internal coordinates by make.py:",
        "REMARK   lengths and angles of Engh and Huber, Acta Cryst. A 1991, 47, 392;",
        "REMARK   phi -57, psi -47, omega 180 of IUPAC-IUB, Biochemistry 1970, 9, 3471",
    ]
    for serial, ((name, element, residue, _), (_, p)) in enumerate(zip(atoms, points), 1):
        xyz_columns = "".join(number(v, 8, 3) for v in p)
        lines.append(f"ATOM  {serial:>5}  {name:<3} ALA A{residue:>4}    {xyz_columns}  1.00  0.00          {element:>2}  ")
    lines += [f"TER   {len(atoms) + 1:>5}      ALA A{count:>4}", "END"]
    return "alpha_helix.pdb", "\n".join(lines) + "\n"


def main():
    files = dict(make() for make in MOLECULES)
    if "--check" not in sys.argv[1:]:
        for name, text in files.items():
            (HERE / name).write_text(text, encoding="ascii", newline="\n")
        return 0
    found = {path.name for path in HERE.iterdir() if path.suffix in (".xyz", ".pdb")}
    wrong = sorted(found ^ files.keys())
    wrong += [name for name in sorted(found & files.keys()) if (HERE / name).read_text(encoding="ascii") != files[name]]
    for name in wrong:
        print(f"{name}: differs from what make.py writes; run make.py", file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
