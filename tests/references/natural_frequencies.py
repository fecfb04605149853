#!/usr/bin/env python3
"""Natural frequencies of bent rods by displacement elements, apart from the program's flexibilities.

Two-node Timoshenko elements of twelve freedoms (cubic deflection, quadratic rotation, linked so
that the shear strain is constant: J. S. Przemieniecki, Theory of Matrix Structural Analysis, 1968;
consistent mass with rotary inertia by quadrature of these functions: Z. Friedman and J. B.
Kosmatka, Computers & Structures 47 (1993) 473-481). Arcs are chords, with the line mass of the arc.
A joint is two nodes at one place that move together and turn against its springs. Shear coefficient
of the hollow circle: G. R. Cowper, J. Appl. Mech. 33 (1966) 335-340.

    pip install numpy          (Python >= 3.11 for tomllib)
    python3 natural_frequencies.py          # writes natural_frequencies.json next to it
    python3 natural_frequencies.py --check  # compares with twice the elements, writes nothing
"""
import json
import math
import sys
import tomllib
from pathlib import Path

import numpy as np

HERE = Path(__file__).parent
COUNT = 4
CASES = {
    "rods/5.toml": (HERE / "../../rods/5.toml").read_text(),
    "an obtuse rod with an arc, a joint, a mass and a heavy tip": """\
name = "arc"
[geometry]
l1_mm = 220.0
l2_mm = 480.0
gamma_deg = 105.0
bend_radius_mm = 60.0
[material.aluminium]
youngs_modulus_gpa = 70.0
poisson_ratio = 0.33
density_kg_m3 = 2700.0
[pipe1]
material = "aluminium"
outer_diameter_mm = 30.0
inner_diameter_mm = 24.0
[pipe2]
material = "aluminium"
outer_diameter_mm = 30.0
inner_diameter_mm = 26.0
[[mass]]
name = "collar"
station_mm = 120.0
mass_g = 90.0
[[joint]]
name = "clamp"
station_mm = 400.0
bending_urad_per_nm = 60.0
torsion_urad_per_nm = 100.0
[tip]
mass_g = 150.0
""",
}


def section(pipe, materials):
    material = materials[pipe["material"]]
    e, nu = material["youngs_modulus_gpa"] * 1e9, material["poisson_ratio"]
    g = e / (2 * (1 + nu))
    outer, inner = pipe["outer_diameter_mm"] / 2e3, pipe["inner_diameter_mm"] / 2e3
    area = math.pi * (outer**2 - inner**2)
    second = math.pi / 4 * (outer**4 - inner**4)
    m = inner / outer
    kappa = 6 * (1 + nu) * (1 + m**2) ** 2 / ((7 + 6 * nu) * (1 + m**2) ** 2 + (20 + 12 * nu) * m**2)
    rho = material["density_kg_m3"]
    return dict(ea=e * area, ei=e * second, gj=2 * g * second, ga=kappa * g * area, mu=rho * area, rho_i=rho * second)


def plane(length, s):
    """Stiffness and mass of (w1, t1, w2, t2) in one plane, slope w' = t where nothing shears."""
    phi = 12 * s["ei"] / (s["ga"] * length**2)
    c = s["ei"] / (length**3 * (1 + phi))
    a, b = (4 + phi) * length**2, (2 - phi) * length**2
    k = c * np.array([[12, 6 * length, -12, 6 * length], [6 * length, a, -6 * length, b],
                      [-12, -6 * length, 12, -6 * length], [6 * length, b, -6 * length, a]])
    mass = np.zeros((4, 4))
    nodes, weights = np.polynomial.legendre.leggauss(6)
    for node, weight in zip((nodes + 1) / 2, weights * length / 2):
        x, f = node, 1 / (1 + phi)
        w = f * np.array([
            2 * x**3 - 3 * x**2 - phi * x + 1 + phi,
            length * (x**3 - (2 + phi / 2) * x**2 + (1 + phi / 2) * x),
            -2 * x**3 + 3 * x**2 + phi * x,
            length * (x**3 - (1 - phi / 2) * x**2 - phi / 2 * x)])
        t = f * np.array([
            6 / length * (x**2 - x), 3 * x**2 - (4 + phi) * x + 1 + phi,
            -6 / length * (x**2 - x), 3 * x**2 - (2 - phi) * x])
        mass += weight * (s["mu"] * np.outer(w, w) + s["rho_i"] * np.outer(t, t))
    return k, mass


def element(length, s, mass_scale):
    """Twelve freedoms along the element's own axes: x along it."""
    k, m = np.zeros((12, 12)), np.zeros((12, 12))
    s = dict(s, mu=s["mu"] * mass_scale, rho_i=s["rho_i"] * mass_scale)
    for start, stiff, inertia in ((0, s["ea"], s["mu"]), (3, s["gj"], 2 * s["rho_i"])):
        at = [start, start + 6]
        k[np.ix_(at, at)] += stiff / length * np.array([[1, -1], [-1, 1]])
        m[np.ix_(at, at)] += inertia * length / 6 * np.array([[2, 1], [1, 2]])
    bend, mass = plane(length, s)
    for at, sign in (((1, 5, 7, 11), 1), ((2, 4, 8, 10), -1)):
        turn = np.diag([1, sign, 1, sign])
        k[np.ix_(at, at)] += turn @ bend @ turn
        m[np.ix_(at, at)] += turn @ mass @ turn
    return k, m


def path(rod, fineness):
    """Places, and for every element its pipe and the arc length that it stands for; stations of nodes."""
    geometry = rod["geometry"]
    l1, l2 = geometry["l1_mm"] / 1e3, geometry["l2_mm"] / 1e3
    gamma, radius = math.radians(geometry["gamma_deg"]), geometry["bend_radius_mm"] / 1e3
    turn = math.pi - gamma
    cut = radius * math.tan(turn / 2)
    along2 = np.array([math.sin(turn), 0, math.cos(turn)])
    corner = np.array([0, 0, l1])
    arc = radius * turn
    breaks = {0.0, l1 - cut, l1 - cut + arc, l1 + l2 - 2 * cut + arc}
    extra = [one["station_mm"] / 1e3 for key in ("mass", "joint") for one in rod.get(key, [])]
    breaks = sorted(breaks | set(extra))

    def place(s):
        if s <= l1 - cut:
            return np.array([0, 0, s])
        if s >= l1 - cut + arc:
            return corner + along2 * (cut + s - (l1 - cut + arc))
        angle = (s - (l1 - cut)) / radius
        return np.array([radius * (1 - math.cos(angle)), 0, l1 - cut + radius * math.sin(angle)])

    stations = [0.0]
    pipes = []
    for low, high in zip(breaks, breaks[1:]):
        if high - low < 1e-12:
            continue
        middle = (low + high) / 2
        is_arc = l1 - cut < middle < l1 - cut + arc
        pieces = fineness * (4 if is_arc else 1)
        for piece in range(pieces):
            stations.append(low + (high - low) * (piece + 1) / pieces)
            pipes.append("pipe1" if middle < l1 - cut + arc else "pipe2")  # the arc is bent of pipe I
    return stations, [place(s) for s in stations], pipes


def frequencies(text, fineness):
    rod = tomllib.loads(text)
    sections = {name: section(rod[name], rod["material"]) for name in ("pipe1", "pipe2")}
    stations, places, pipes = path(rod, fineness)
    joints = {j["station_mm"] / 1e3: j for j in rod.get("joint", [])}
    # translations are shared at a joint, rotations are not: freedoms of the near and the far side
    near, far, count = [], [], 0
    for station in stations:
        own = list(range(count, count + 6))
        count += 6
        near.append(own)
        if any(abs(station - at) < 1e-9 for at in joints):
            far.append(own[:3] + list(range(count, count + 3)))
            count += 3
        else:
            far.append(own)
    k, m = np.zeros((count, count)), np.zeros((count, count))
    tangents = []
    for index, pipe in enumerate(pipes):
        step = places[index + 1] - places[index]
        length = np.linalg.norm(step)
        x = step / length
        tangents.append(x)
        y = np.array([0.0, 1.0, 0.0])
        frame = np.array([x, y, np.cross(x, y)])
        turned = np.kron(np.eye(4), frame)
        stiff, mass = element(length, sections[pipe], (stations[index + 1] - stations[index]) / length)
        at = far[index] + near[index + 1]
        k[np.ix_(at, at)] += turned.T @ stiff @ turned
        m[np.ix_(at, at)] += turned.T @ mass @ turned
    for at, joint in joints.items():
        index = min(range(len(stations)), key=lambda i: abs(stations[i] - at))
        x = tangents[index - 1]
        soft = joint["bending_urad_per_nm"] * 1e-6
        twist = joint["torsion_urad_per_nm"] * 1e-6
        spring = np.eye(3) / soft + (1 / twist - 1 / soft) * np.outer(x, x)
        one, other = near[index][3:], far[index][3:]
        k[np.ix_(one, one)] += spring
        k[np.ix_(other, other)] += spring
        k[np.ix_(one, other)] -= spring
        k[np.ix_(other, one)] -= spring
    lumps = [(one["station_mm"] / 1e3, one["mass_g"] / 1e3) for one in rod.get("mass", [])]
    lumps.append((stations[-1], rod["tip"]["mass_g"] / 1e3))
    for at, mass in lumps:
        index = min(range(len(stations)), key=lambda i: abs(stations[i] - at))
        for axis in range(3):
            m[near[index][axis], near[index][axis]] += mass
    free = slice(6, None)
    lower = np.linalg.cholesky(k[free, free])
    half = np.linalg.solve(lower, m[free, free])
    flexible = np.linalg.solve(lower, half.T)
    periods = np.linalg.eigvalsh((flexible + flexible.T) / 2)[::-1]
    return [float(1 / (2 * math.pi * math.sqrt(p))) for p in periods[:COUNT]]


def main():
    found = {}
    for name, text in CASES.items():
        coarse, fine = frequencies(text, 20), frequencies(text, 40)
        change = max(abs(a / b - 1) for a, b in zip(coarse, fine))
        print(name, [f"{f:.6f}" for f in fine], f"change with half the elements {change:.1e}", file=sys.stderr)
        if change > 3e-5:
            sys.exit("has not converged")
        # what is left falls as 1/n**2 or faster
        found[name] = [b + (b - a) / 3 for a, b in zip(coarse, fine)]
    if "--check" not in sys.argv:
        cases = [dict(name=n, rod_toml=CASES[n], first_frequencies_hz=f) for n, f in found.items()]
        (HERE / "natural_frequencies.json").write_text(json.dumps(cases, indent=1, ensure_ascii=False) + "\n")


if __name__ == "__main__":
    main()
