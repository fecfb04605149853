#!/usr/bin/env python3
"""Reference compliances of bent rods, by the unit-load (virtual work) integral.

No finite elements here. A cantilever is statically determinate: everything that a cut at
station s carries follows from equilibrium of the part beyond it, so a displacement is

    d = integral over s of  N n/EA + V.v/(kappa G A) + T t/GJ + M.m/EI   (+ joints: T t k_t + M.m k_b)

with capitals for the real load and small letters for a unit load at the point and in the
direction asked for. Straight pieces have polynomial integrands, arcs have trigonometric ones;
Gauss-Legendre with 24 nodes on each piece in 40-digit arithmetic gives > 30 correct digits,
which are then rounded to the nearest double. `check()` repeats with other node counts.

    pip install mpmath          (Python >= 3.11 for tomllib)
    python3 beam_references.py              # checks, then writes beam_references.json next to it
    python3 beam_references.py --check      # checks only

Frame: flange at the origin, pipe I along +Z, both pipes in X-Z, tip [L2 sin g, 0, L1 - L2 cos g].
C[m][n]: displacement along m, load along n. cf: um per N at the tip. cg: um per g, where 1 g along +n
is a body force rho*9.80665 in direction +n on the pipes and on every lumped mass.
"""
import json
import re
import sys
import tomllib
from pathlib import Path

from mpmath import cos, mp, mpf, pi, sin, tan

mp.dps = 40
G0 = mpf("9.80665")
CONTACT = [mpf("1.10"), mpf("1.25"), mpf("1.05")]
THEORIES = ("timoshenko", "euler-bernoulli")
AXES = [(1, 0, 0), (0, 1, 0), (0, 0, 1)]
ZERO = (mpf(0), mpf(0), mpf(0))


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def add(a, b):
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def scale(k, a):
    return (k * a[0], k * a[1], k * a[2])


def gauss(n):
    """Gauss-Legendre nodes and weights on [0, 1], by Newton on the Legendre recurrence."""
    out = []
    for i in range(n):
        x = cos(pi * (mpf(i) + mpf(3) / 4) / (n + mpf(1) / 2))
        for _ in range(12):
            p0, p1 = mpf(1), x
            for k in range(2, n + 1):
                p0, p1 = p1, ((2 * k - 1) * x * p1 - (k - 1) * p0) / k
            dp = n * (x * p1 - p0) / (x * x - 1)
            x -= p1 / dp
        out.append(((1 + x) / 2, 1 / ((1 - x * x) * dp * dp)))
    return out


def cowper(nu, m):
    """Cowper (1966), hollow circle, m = inner/outer diameter."""
    q = (1 + m * m) ** 2
    return 6 * (1 + nu) * q / ((7 + 6 * nu) * q + (20 + 12 * nu) * m * m)


def orthotropic(e, nu, m):
    """Dharmarajan & McCutchen (1973), hollow circle, e = E/G: Cowper's where e = 2(1 + nu)."""
    q = (1 + m * m) ** 2
    return 3 * e * q / ((mpf(7) / 2 * e - nu) * q + (10 * e - 8 * nu) * m * m)


def poisson(mat, e, g):
    """As stated; of an isotropic material (0 <= E/2G - 1 <= 1/2) what E and G say; else 0.3."""
    if "poisson_ratio" in mat:
        return mpf(mat["poisson_ratio"])
    nu = e / (2 * g) - 1
    return nu if 0 <= nu <= mpf(1) / 2 else mpf(3) / 10


class Section:
    """Flexibility and mass per length of a tube."""

    def __init__(self, pipe, materials, theory):
        mat = materials[pipe["material"]]
        e = mpf(mat["youngs_modulus_gpa"]) * mpf(10) ** 9
        if "shear_modulus_gpa" in mat:
            g = mpf(mat["shear_modulus_gpa"]) * mpf(10) ** 9
        else:
            g = e / (2 * (1 + mpf(mat["poisson_ratio"])))
        nu = poisson(mat, e, g)
        od, bore = mpf(pipe["outer_diameter_mm"]) / 1000, mpf(pipe["inner_diameter_mm"]) / 1000
        area = pi * (od**2 - bore**2) / 4
        inertia = pi * (od**4 - bore**4) / 64
        self.axial = 1 / (e * area)
        self.shear = 1 / (orthotropic(e / g, nu, bore / od) * g * area) if theory == "timoshenko" else mpf(0)
        self.bending = 1 / (e * inertia)
        self.torsion = 1 / (g * 2 * inertia)
        self.line_mass = mpf(mat["density_kg_m3"]) * area


class Rod:
    """The centreline with everything on it; SI inside."""

    def __init__(self, text, theory, nodes=24):
        f = tomllib.loads(text, parse_float=mpf)
        self.name = f["name"]
        self.rule = gauss(nodes)
        geo = f["geometry"]
        l1, l2 = mpf(geo["l1_mm"]) / 1000, mpf(geo["l2_mm"]) / 1000
        self.turn = pi - mpf(geo.get("gamma_deg", 90)) * pi / 180
        self.radius = mpf(geo.get("bend_radius_mm", 0)) / 1000
        if abs(self.turn) < mpf(10) ** -30:
            self.turn, self.radius = mpf(0), mpf(0)
        cut = self.radius * tan(self.turn / 2)
        self.s1 = l1 - cut
        self.s2 = self.s1 + self.radius * self.turn
        self.length = self.s2 + l2 - cut
        assert self.s1 >= 0 and l2 >= cut, "bend radius too large for the pipes"
        sec = lambda key: Section(f[key], f["material"], theory)
        self.sections = [sec("pipe1"), sec("bend" if "bend" in f else "pipe1"), sec("pipe2")]
        self.masses = [(mpf(m["station_mm"]) / 1000, mpf(m["mass_g"]) / 1000) for m in f.get("mass", [])]
        self.masses.append((self.length, mpf(f.get("tip", {}).get("mass_g", 0)) / 1000))
        self.joints = [
            (
                mpf(j["station_mm"]) / 1000,
                mpf(j.get("bending_urad_per_nm", 0)) / 10**6,
                mpf(j.get("torsion_urad_per_nm", 0)) / 10**6,
            )
            for j in f.get("joint", [])
        ]
        for s, *_ in self.masses + self.joints:
            assert 0 <= s < self.length + mpf(10) ** -30, "station off the rod"

    def piece(self, s):
        """0 pipe I, 1 bend, 2 pipe II; a station on a border belongs to the earlier piece."""
        return 0 if s <= self.s1 else 1 if s <= self.s2 else 2

    def tangent(self, s):
        a = (mpf(0), (s - self.s1) / self.radius if self.radius else mpf(0), self.turn)[self.piece(s)]
        return (sin(a), mpf(0), cos(a))

    def at(self, s):
        if s <= self.s1:
            return (mpf(0), mpf(0), s)
        a = (s - self.s1) / self.radius if self.radius and s <= self.s2 else self.turn
        arc = (self.radius * (1 - cos(a)), mpf(0), self.s1 + self.radius * sin(a))
        return arc if s <= self.s2 else add(arc, scale(s - self.s2, (sin(a), mpf(0), cos(a))))

    def borders(self, extra=()):
        inner = {s for s, *_ in self.masses + self.joints} | set(extra) | {self.s1, self.s2}
        return sorted({mpf(0), self.length} | {s for s in inner if 0 < s < self.length})

    def mass(self):
        pipes = [self.s1, self.s2 - self.s1, self.length - self.s2]
        return sum(l * c.line_mass for l, c in zip(pipes, self.sections)) + sum(m for _, m in self.masses)

    def hanging(self, s):
        """Mass beyond s and its first moment about the point at s."""
        here, total, first = self.at(s), mpf(0), ZERO
        for at, m in self.masses:
            if at > s:
                total, first = total + m, add(first, scale(m, sub(self.at(at), here)))
        for k, (a, b) in enumerate([(mpf(0), self.s1), (self.s1, self.s2), (self.s2, self.length)]):
            a = max(a, s)
            for x, w in self.rule if b > a else []:
                dm = w * (b - a) * self.sections[k].line_mass
                total, first = total + dm, add(first, scale(dm, sub(self.at(a + x * (b - a)), here)))
        return total, first

    def points(self, extra=()):
        """(station, weight x flexibility) for the integral: what the virtual work sums over."""
        b = self.borders(extra)
        for lo, hi in zip(b, b[1:]):
            c = self.sections[self.piece((lo + hi) / 2)]
            for x, w in self.rule:
                k = w * (hi - lo)
                yield lo + x * (hi - lo), k * c.axial, k * c.shear, k * c.bending, k * c.torsion
        for s, bend, twist in self.joints:
            yield s, mpf(0), mpf(0), bend, twist

    def work(self, real, virtual, extra=()):
        """Matrix [virtual][real] of virtual works; each case maps a station to (force, moment)."""
        out = [[mpf(0)] * len(real) for _ in virtual]
        for s, axial, shear, bend, twist in self.points(extra):
            t, here, memo = self.tangent(s), self.at(s), {}
            r, v = [c(s, here, memo) for c in real], [c(s, here, memo) for c in virtual]
            for i, (fv, mv) in enumerate(v):
                for j, (fr, mr) in enumerate(r):
                    n, q = dot(fv, t) * dot(fr, t), dot(mv, t) * dot(mr, t)
                    out[i][j] += axial * n + shear * (dot(fv, fr) - n) + twist * q + bend * (dot(mv, mr) - q)
        return out

    def force(self, station, axis):
        p = self.at(station)
        return lambda s, here, memo: (axis, cross(sub(p, here), axis)) if s < station else (ZERO, ZERO)

    def moment(self, station, axis):
        return lambda s, here, memo: (ZERO, axis) if s < station else (ZERO, ZERO)

    def gravity(self, axis):
        def case(s, here, memo):
            if "h" not in memo:
                memo["h"] = self.hanging(s)
            m, first = memo["h"]
            return scale(m * G0, axis), scale(G0, cross(first, axis))

        return case

    def tip_compliance(self):
        tip = [self.force(self.length, a) for a in AXES]
        w = self.work(tip + [self.gravity(a) for a in AXES], tip)
        return [[x * 10**6 for x in row[:3]] for row in w], [[x * 10**6 for x in row[3:]] for row in w]

    def station_compliance(self, load_mm, read_mm):
        a, b = mpf(load_mm) / 1000, mpf(read_mm) / 1000
        assert 0 <= min(a, b) and max(a, b) < self.length + mpf(10) ** -30, "station off the rod"
        virtual = [self.force(b, x) for x in AXES] + [self.moment(b, x) for x in AXES]
        w = self.work([self.force(a, x) for x in AXES], virtual, (a, b))
        w = [[x * 10**6 for x in row] for row in w]
        return w[:3], w[3:]


STEEL = """[material.steel]
youngs_modulus_gpa = 193.0
poisson_ratio = 0.29
density_kg_m3 = 7930.0
"""
STEEL_G = """[material.steel]
youngs_modulus_gpa = 193.0
shear_modulus_gpa = 74.8
density_kg_m3 = 7930.0
"""
CARBON = """[material.carbon]
youngs_modulus_gpa = 118.0
shear_modulus_gpa = 17.5
density_kg_m3 = 1570.0
"""
CARBON_PAPER = """[material.carbon]
youngs_modulus_gpa = 240.0
shear_modulus_gpa = 92.0
density_kg_m3 = 1600.0
"""


def toml(name, l1, l2, materials, pipe1, pipe2, gamma=None, radius=None, bend=None, tip=None, masses=(), joints=()):
    pipe = lambda p: f'material = "{p[0]}"\nouter_diameter_mm = {p[1]}\ninner_diameter_mm = {p[2]}\n'
    t = f'name = "{name}"\n[geometry]\nl1_mm = {l1}\nl2_mm = {l2}\n'
    t += f"gamma_deg = {gamma}\n" if gamma is not None else ""
    t += f"bend_radius_mm = {radius}\n" if radius is not None else ""
    t += "".join(materials) + "[pipe1]\n" + pipe(pipe1) + "[pipe2]\n" + pipe(pipe2)
    t += "[bend]\n" + pipe(bend) if bend else ""
    t += f"[tip]\nmass_g = {tip}\n" if tip is not None else ""
    for n, s, m in masses:
        t += f'[[mass]]\nname = "{n}"\nstation_mm = {s}\nmass_g = {m}\n'
    for n, s, b, k in joints:
        t += f'[[joint]]\nname = "{n}"\nstation_mm = {s}\n'
        t += (f"bending_urad_per_nm = {b}\n" if b is not None else "") + (f"torsion_urad_per_nm = {k}\n" if k is not None else "")
    return t


S16, S32, S20 = ("steel", 16.0, 12.0), ("steel", 32.0, 30.0), ("steel", 20.0, 0.0)
C50A, C50B, C30 = ("carbon", 50.0, 42.0), ("carbon", 50.0, 46.2), ("carbon", 30.0, 26.0)

# name -> (what it is there for, rod TOML, [(load station, read station) in mm])
CASES = [
    ("the issue's sharp corner", toml("corner", 300.0, 450.0, [STEEL], S16, S16), [(750.0, 300.0), (400.0, 150.0), (150.0, 600.0)]),
    ("the issue's arc, no Winkler correction", toml("arc40", 300.0, 450.0, [STEEL], S16, S16, radius=40.0), [(700.0, 290.0)]),
    ("the issue's open corner", toml("open120", 300.0, 450.0, [STEEL], S16, S16, gamma=120.0), []),
    ("straight, one tube, only self-weight", toml("straight", 200.0, 400.0, [STEEL], S16, S16, gamma=180.0), [(600.0, 250.0), (250.0, 600.0)]),
    ("straight, solid round, tip mass, mass inside", toml("straight-solid", 120.0, 380.0, [STEEL_G], S20, S20, gamma=180.0, tip=55.0, masses=[("ring", 333.0, 80.0)]), []),
    ("straight, steel then carbon, a joint between, masses; bending and torsion differ", toml("straight-two-tubes", 250.0, 500.0, [STEEL_G, CARBON], S32, C30, gamma=180.0, tip=41.0, masses=[("sleeve", 250.0, 35.0)], joints=[("glue", 250.0, 12.0, 31.0)]), [(600.0, 400.0)]),
    ("stocky: shear and axial terms are a large part", toml("stocky", 30.0, 40.0, [STEEL], ("steel", 25.0, 5.0), ("steel", 18.0, 0.0), tip=20.0), [(60.0, 20.0)]),
    ("the paper's rod 5# as reconstructed", toml("paper-5", 150.0, 525.0, [STEEL], S32, S32, tip=60.0), []),
    ("the paper's rod 2# as reconstructed: joint and mass exactly at the sharp corner", toml("paper-2", 150.0, 525.0, [CARBON_PAPER], C50A, C50B, tip=100.0, masses=[("corner", 150.0, 95.0)], joints=[("corner", 150.0, 6.5, 6.5)]), [(675.0, 200.0), (500.0, 400.0)]),
    ("joint exactly at the sharp corner, bending and torsion differ: it has pipe I's tangent", toml("corner-joint", 150.0, 525.0, [CARBON], C50A, C30, gamma=75.0, joints=[("corner", 150.0, 4.0, 90.0)]), []),
    ("acute angle, sharp, two steel tubes", toml("acute60", 320.0, 410.0, [STEEL_G], S32, ("steel", 25.0, 21.0), gamma=60.0, tip=75.5), []),
    ("acute angle with arc of its own section", toml("acute60-arc", 320.0, 410.0, [STEEL_G], S32, ("steel", 25.0, 21.0), gamma=60.0, radius=60.0, bend=("steel", 30.0, 24.0), tip=75.5, masses=[("clip", 300.0, 22.0)]), [(600.0, 280.0)]),
    ("120 degrees with arc, joint on the arc, mass on the arc", toml("open120-arc", 260.0, 340.0, [STEEL], S16, S16, gamma=120.0, radius=90.0, tip=30.0, masses=[("clamp", 270.0, 44.0)], joints=[("weld", 250.0, 20.0, 55.0)]), [(500.0, 240.0), (240.0, 500.0)]),
    ("shallow bend, carbon pipes with a steel bend, sleeves at both ends of the arc", toml("shallow150", 400.0, 300.0, [STEEL_G, CARBON], C50B, C30, gamma=150.0, radius=200.0, bend=("steel", 32.0, 28.0), tip=62.0, masses=[("sleeve-a", 346.4101615137754, 30.0), ("sleeve-b", 451.1299166333351, 26.0)], joints=[("sleeve-a", 346.4101615137754, 8.0, None), ("sleeve-b", 451.1299166333351, None, 14.0)]), []),
    ("joints at the root, inside both pipes and at the tip; two masses at one station, one at the root", toml("joints", 300.0, 450.0, [STEEL], S32, S32, tip=60.0, masses=[("a", 205.0, 30.0), ("b", 205.0, 12.5), ("flange", 0.0, 250.0)], joints=[("root", 0.0, 3.0, 9.0), ("sleeve-a", 205.0, 15.0, 6.0), ("sleeve-b", 512.5, 7.0, 40.0), ("ball", 750.0, 100.0, 100.0)]), [(620.0, 410.0)]),
    ("everything at once: arc, three sections, two materials, masses, joints, tip", toml("everything", 375.0, 600.0, [STEEL_G, CARBON], C50A, C30, gamma=82.5, radius=70.0, bend=("steel", 40.0, 34.0), tip=100.0, masses=[("ring", 180.0, 45.0), ("holder", 350.0, 95.0), ("cable", 700.0, 18.0)], joints=[("sleeve-a", 300.0, 6.5, 11.0), ("sleeve-b", 420.0, 9.5, 3.25)]), [(900.0, 380.0), (380.0, 900.0), (650.0, 200.0)]),
    ("arc that uses up both pipes: a pure quarter circle", toml("quarter", 250.0, 250.0, [STEEL], S16, S16, radius=250.0, tip=10.0), [(300.0, 150.0)]),
    ("long and slender carbon, no corner mass", toml("slender", 600.0, 900.0, [CARBON], C30, ("carbon", 20.0, 17.0), gamma=100.0, tip=15.0), []),
]


def results(text, theory, stations, nodes=24):
    rod = Rod(text, theory, nodes)
    cf, cg = rod.tip_compliance()
    force = (sum(x * x for x in CONTACT)) ** mpf("0.5")
    total = lambda c: sum(abs(x) for row in c for x in row)
    out = {"theory": theory, "cf_um_per_n": cf, "cg_um_per_g": cg, "c_rod_um": total(cg) + force * total(cf)}
    if stations:
        out["stations"] = []
        for load, read in stations:
            d, r = rod.station_compliance(load, read)
            out["stations"].append({"load_station_mm": load, "read_station_mm": read, "displacement_um_per_n": d, "rotation_urad_per_n": r})
    return rod, out


def case(note, text, stations):
    both = [results(text, t, stations) for t in THEORIES]
    rod = both[0][0]
    return {
        "name": rod.name,
        "note": note,
        "rod_toml": text,
        "tip_mm": [x * 1000 for x in rod.at(rod.length)],
        "tip_station_mm": rod.length * 1000,
        "mass_g": rod.mass() * 1000,
        "results": [r for _, r in both],
    }


def plain(x):
    if isinstance(x, mpf):
        return 0.0 if abs(x) < mpf(10) ** -30 else float(x)
    if isinstance(x, (list, tuple)):
        return [plain(y) for y in x]
    return {k: plain(v) for k, v in x.items()} if isinstance(x, dict) else x


def check():
    """Against closed forms that share no code with the integral, and against itself."""
    worst = mpf(0)

    def near(what, got, want, tol):
        nonlocal worst
        rel = abs(got - mpf(want)) / abs(mpf(want))
        assert rel < tol, f"{what}: {mp.nstr(got, 15)} is not {want}"
        print(f"  {what:46s} {mp.nstr(got, 17):>24s}   off by {mp.nstr(rel, 2)}")

    text = {c[1].split('"')[1]: c[1] for c in CASES}
    print("figures printed in issue 2 (6 decimals)")
    for name, m, n, want in [("corner", 0, 0, "21.314804"), ("corner", 0, 2, "-47.711141"), ("corner", 1, 1, "277.622146"), ("corner", 2, 2, "214.842826"), ("arc40", 2, 2, "206.412067"), ("arc40", 1, 1, "267.730628"), ("open120", 0, 0, "122.725607"), ("open120", 2, 2, "161.143164")]:
        near(f"{name} C{m + 1}{n + 1}", Rod(text[name], "timoshenko").tip_compliance()[0][m][n], want, mpf("3e-8"))

    print("closed forms, L-shape: PAPER.md's Eqs 15 and 17 plus the axial term (Euler-Bernoulli)")
    rod = Rod(text["corner"], "euler-bernoulli")
    cf, cg = rod.tip_compliance()
    c = rod.sections[0]
    a, b, ei, gj, ea, q = mpf("0.3"), mpf("0.45"), 1 / c.bending, 1 / c.torsion, 1 / c.axial, c.line_mass * G0
    forms = [
        ("C^F11", cf[0][0], a**3 / (3 * ei) + b / ea),
        ("C^F13", cf[0][2], -(a**2) * b / (2 * ei)),
        ("C^F33", cf[2][2], b**3 / (3 * ei) + a * b**2 / ei + a / ea),
        ("C^F22", cf[1][1], (a**3 + b**3) / (3 * ei) + a * b**2 / gj),
        ("C^g11", cg[0][0], q * (a**3 * b / (3 * ei) + a**4 / (8 * ei) + b**2 / (2 * ea))),
        ("C^g13", cg[0][2], -q * a**2 * b**2 / (4 * ei)),
        ("C^g31", cg[2][0], -q * (a**3 * b / (6 * ei) + a**2 * b**2 / (2 * ei))),
        ("C^g33", cg[2][2], q * (b**4 / (8 * ei) + a * b**3 / (2 * ei) + (a**2 / 2 + a * b) / ea)),
        ("C^g22", cg[1][1], q * (b**4 / (8 * ei) + a**3 * b / (3 * ei) + a**4 / (8 * ei) + a * b**3 / (2 * gj))),
    ]
    for what, got, want in forms:
        near(what, got, want * 10**6, mpf(10) ** -32)

    print("closed forms, quarter circle (curved beam, all terms)")
    rod = Rod(text["quarter"], "timoshenko")
    cf, _ = rod.tip_compliance()
    c, r = rod.sections[1], mpf("0.25")
    near("C^F33 (radial at the tip)", cf[2][2], 10**6 * (pi * r**3 / 4 * c.bending + pi * r / 4 * (c.axial + c.shear)), mpf(10) ** -32)
    near("C^F11 (tangential at the tip)", cf[0][0], 10**6 * ((3 * pi / 4 - 2) * r**3 * c.bending + pi * r / 4 * (c.axial + c.shear)), mpf(10) ** -32)
    near("C^F13", cf[0][2], 10**6 * (-(r**3) / 2 * c.bending + r / 2 * (c.axial - c.shear)), mpf(10) ** -32)
    near("C^F22", cf[1][1], 10**6 * (pi * r**3 / 4 * c.bending + (3 * pi / 4 - 2) * r**3 * c.torsion + pi * r / 2 * c.shear), mpf(10) ** -32)

    print("itself: 16 and 31 nodes in place of 24, Maxwell-Betti between stations")
    for _, t, stations in CASES:
        for theory in THEORIES:
            ref = Rod(t, theory).tip_compliance()
            for nodes in (16, 31):
                for x, y in zip(ref, Rod(t, theory, nodes).tip_compliance()):
                    top = max(abs(v) for row in x for v in row)
                    worst = max([worst] + [abs(u - v) / top for p, q in zip(x, y) for u, v in zip(p, q)])
        for load, read in stations:
            x, y = Rod(t, "timoshenko").station_compliance(load, read)[0], Rod(t, "timoshenko").station_compliance(read, load)[0]
            top = max(abs(v) for row in x for v in row)
            worst = max([worst] + [abs(x[i][j] - y[j][i]) / top for i in range(3) for j in range(3)])
    print(f"  largest relative difference {mp.nstr(worst, 3)}")
    assert worst < mpf(10) ** -20


if __name__ == "__main__":
    check()
    if "--check" not in sys.argv:
        path = Path(__file__).with_suffix(".json")
        note = "Written by beam_references.py (its header states frame, signs and units); do not edit."
        data = {"note": note, "g_m_s2": float(G0), "cases": [plain(case(*c)) for c in CASES]}
        row = lambda m: "[" + ", ".join(m.group(0)[1:-1].split()).replace(",,", ",") + "]"
        path.write_text(re.sub(r"\[[^\[\]{}\"]*\]", row, json.dumps(data, indent=1)) + "\n")
        print(f"wrote {path.name}: {len(CASES)} rods x {len(THEORIES)} theories")
