#!/usr/bin/env python3
"""Solves the rods of beam_references.json with finite-element programs of other people, and compares.

    pip install mpmath openseespy PyNiteFEA ; apt-get install calculix-ccx
    python3 cross_check.py opensees | pynite | calculix      (none named: all)

Only the geometry comes from beam_references.Rod; the stiffness, the loads and the solution are the other program's.
Printed: largest deviation over C^F and over C^g, relative to the largest entry of that matrix.
"""
import json
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

import numpy as np
from mpmath import mpf

from beam_references import Rod

HERE = Path(__file__).parent
G0 = 9.80665


class Mesh:
    """Nodes, straight elements, joints and nodal masses of a rod, plain floats, SI."""

    def __init__(self, text, theory, per_piece=4, per_arc=400, stations=()):
        rod = Rod(text, theory, 4)
        self.length = float(rod.length)
        self.nodes, self.elements, self.joints, self.mass = [], [], [], {}
        joints = {}
        for s, b, t in rod.joints:
            if b or t:
                joints[float(s)] = (float(b), float(t), np.array([float(x) for x in rod.tangent(s)]))
        masses = {}
        for s, m in rod.masses:
            masses[float(s)] = masses.get(float(s), 0.0) + float(m)

        borders = [0.0]
        for s in rod.borders([mpf(x) / 1000 for x in stations]):
            if float(s) - borders[-1] > 1e-9:
                borders.append(float(s))
        snap = lambda d: {min(borders, key=lambda b: abs(b - s)): v for s, v in d.items()}
        joints, masses = snap(joints), snap(masses)

        def node(s):
            self.nodes.append([float(x) for x in rod.at(s)])
            return len(self.nodes) - 1

        def station(s, last):
            if s in masses:
                self.mass[last] = masses[s]
            if s in joints:
                new = node(s)
                self.joints.append((last, new, *joints[s]))
                return new
            return last

        last = station(0.0, node(0.0))
        self.at = {}
        for lo, hi in zip(borders, borders[1:]):
            k = rod.piece((lo + hi) / 2)
            n = per_arc if k == 1 else per_piece
            for i in range(1, n + 1):
                s = hi if i == n else lo + (hi - lo) * i / n
                # keep each arc border exactly on the border so that tangents and kinks are right
                new = node(s)
                self.elements.append((last, new, rod.sections[k]))
                last = new
            self.at[hi] = last   # the flange's side of a joint
            last = station(hi, last)
        self.tip = last

    def node_at(self, station_mm):
        return self.at[min(self.at, key=lambda b: abs(1000 * b - station_mm))]

    def frame(self, i, j):
        x = np.subtract(self.nodes[j], self.nodes[i])
        h = np.linalg.norm(x)
        x = x / h
        y = np.array([0.0, 1.0, 0.0])
        return h, x, y, np.cross(x, y)


def values(c):
    """EA, GA_shear (inf in Euler-Bernoulli), EI, GJ, kg/m"""
    return 1 / float(c.axial), (1 / float(c.shear) if c.shear else np.inf), 1 / float(c.bending), 1 / float(c.torsion), float(c.line_mass)


def opensees(text, theory, stations=()):
    import openseespy.opensees as ops

    # many short elasticBeamColumn elements lose digits to rounding (4e-2 at 400 on one rod), so fewer of them
    m = Mesh(text, theory, per_arc=400 if theory == "timoshenko" else 40, stations=[x for pair in stations for x in pair])
    ops.wipe()
    ops.model("basic", "-ndm", 3, "-ndf", 6)
    for i, x in enumerate(m.nodes):
        ops.node(i + 1, *x)
    ops.fix(1, 1, 1, 1, 1, 1, 1)
    tag = 0
    loads = []
    for i, j, c in m.elements:
        tag += 1
        h, x, y, z = m.frame(i, j)
        ea, ga, ei, gj, q = values(c)
        ops.geomTransf("Linear", tag, *[float(v) for v in z])
        if np.isfinite(ga):   # unit moduli: E = G = 1, the section carries the stiffness
            ops.element("ElasticTimoshenkoBeam", tag, i + 1, j + 1, 1.0, 1.0, ea, gj, ei, ei, ga, ga, tag)
        else:
            ops.element("elasticBeamColumn", tag, i + 1, j + 1, ea, 1.0, 1.0, gj, ei, ei, tag)
        loads.append((tag, np.cross(z, x), z, x, q * G0))
    for i, j, b, t, tangent in m.joints:
        tag += 1
        k = lambda v: 1 / v if v else 1e10
        ops.uniaxialMaterial("Elastic", 2 * tag, k(t))
        ops.uniaxialMaterial("Elastic", 2 * tag + 1, k(b))
        ops.equalDOF(i + 1, j + 1, 1, 2, 3)
        ops.element("zeroLength", tag, i + 1, j + 1, "-mat", 2 * tag, 2 * tag + 1, 2 * tag + 1, "-dir", 4, 5, 6, "-orient", *[float(v) for v in tangent], 0.0, 1.0, 0.0)
    ops.constraints("Transformation")
    ops.numberer("RCM")
    ops.system("UmfPack")
    ops.algorithm("Linear")
    ops.integrator("LoadControl", 1.0)
    ops.analysis("Static")
    ops.timeSeries("Constant", 1)
    cols = []
    for case in range(6):
        ops.pattern("Plain", case + 1, 1)
        n = np.eye(3)[case % 3]
        if case < 3:
            ops.load(m.tip + 1, *n, 0.0, 0.0, 0.0)
        else:
            for tag, y, z, x, w in loads:
                ops.eleLoad("-ele", tag, "-type", "-beamUniform", float(w * n @ y), float(w * n @ z), float(w * n @ x))
            for i, mass in m.mass.items():
                ops.load(i + 1, *(mass * G0 * n), 0.0, 0.0, 0.0)
        assert ops.analyze(1) == 0
        cols.append([1e6 * ops.nodeDisp(m.tip + 1, d) for d in (1, 2, 3)])
        ops.remove("loadPattern", case + 1)
    c = np.array(cols).T
    between = []
    for k, (load, read) in enumerate(stations):
        cols = []
        for case in range(3):
            ops.pattern("Plain", 10 + 3 * k + case, 1)
            ops.load(m.node_at(load) + 1, *np.eye(3)[case], 0.0, 0.0, 0.0)
            assert ops.analyze(1) == 0
            cols.append([1e6 * ops.nodeDisp(m.node_at(read) + 1, d) for d in range(1, 7)])
            ops.remove("loadPattern", 10 + 3 * k + case)
        between.append(np.array(cols).T)
    return c[:, :3], c[:, 3:], between


def pynite(text, theory):
    from Pynite import FEModel3D

    if theory != "euler-bernoulli":
        return None
    m = Mesh(text, theory, per_piece=2, per_arc=60)
    if m.joints:
        return None
    f = FEModel3D()
    for i, x in enumerate(m.nodes):
        f.add_node(f"n{i}", *x)
    f.def_support("n0", *[True] * 6)
    f.add_material("unit", 1.0, 1.0, 0.0, 0.0)
    for e, (i, j, c) in enumerate(m.elements):
        ea, _, ei, gj, q = values(c)
        f.add_section(f"s{e}", ea, ei, ei, gj)
        f.add_member(f"m{e}", f"n{i}", f"n{j}", "unit", f"s{e}")
        for axis in "XYZ":
            f.add_member_dist_load(f"m{e}", f"F{axis}", q * G0, q * G0, case=f"g{axis}")
    for axis in "XYZ":
        f.add_node_load(f"n{m.tip}", f"F{axis}", 1.0, case=f"f{axis}")
        for i, mass in m.mass.items():
            f.add_node_load(f"n{i}", f"F{axis}", mass * G0, case=f"g{axis}")
    names = [a + b for a in "fg" for b in "XYZ"]
    for name in names:
        f.add_load_combo(name, {name: 1.0})
    f.analyze_linear(check_stability=False)
    tip = f.nodes[f"n{m.tip}"]
    c = np.array([[d[n] for n in names] for d in (tip.DX, tip.DY, tip.DZ)]) * 1e6
    return c[:, :3], c[:, 3:]


def calculix(text, theory, per_metre=160):
    """ccx's B32R with SECTION=PIPE: each beam element is expanded into solids (C3D20R), so its shear, its root
    (whose section cannot change shape) and its corner (a rigid knot) are a solid's: agreement to 1e-3 is what to expect.
    """
    f = tomllib.loads(text)
    hollow = all(f[p]["inner_diameter_mm"] > 0 for p in ("pipe1", "pipe2"))
    if theory != "timoshenko" or not hollow or "joint" in f or f["pipe1"] != f["pipe2"]:
        return None
    rod = Rod(text, theory, 4)
    (mat,) = f["material"].values()
    e = mat["youngs_modulus_gpa"]
    nu = mat["poisson_ratio"] if "poisson_ratio" in mat else e / mat["shear_modulus_gpa"] / 2 - 1
    if nu > 0.5:  # anisotropic: ccx's beam is not
        return None
    outer, bore = f["pipe1"]["outer_diameter_mm"] / 2, f["pipe1"]["inner_diameter_mm"] / 2
    stations, borders = [0.0], [float(s) for s in rod.borders()]
    for lo, hi in zip(borders, borders[1:]):
        n = 2 * max(2, round(per_metre * (hi - lo)))
        stations += [hi if i == n else lo + (hi - lo) * i / n for i in range(1, n + 1)]
    n = len(stations)
    d = ["*NODE"] + ["{},{:.12e},{:.12e},{:.12e}".format(i + 1, *(1000 * float(x) for x in rod.at(mpf(s)))) for i, s in enumerate(stations)]
    d += ["*ELEMENT,TYPE=B32R,ELSET=E"] + [f"{k + 1},{2 * k + 1},{2 * k + 2},{2 * k + 3}" for k in range(n // 2)]
    d += ["*NSET,NSET=TIP", str(n), "*MATERIAL,NAME=M", "*ELASTIC", f"{e * 1e3:.9e},{nu:.9f}", "*DENSITY", f"{mat['density_kg_m3'] * 1e-12:.9e}"]
    d += ["*BEAM SECTION,ELSET=E,MATERIAL=M,SECTION=PIPE", f"{outer:.9f},{outer - bore:.9f}", "0.,1.,0.", "*BOUNDARY", "1,1,6"]
    lumped = [(min(range(n), key=lambda i: abs(stations[i] - float(s))) + 1, float(m) * G0) for s, m in rod.masses if m]
    for k in range(6):
        d += ["*STEP", "*STATIC", "*CLOAD,OP=NEW"]
        loads = [(n, 1.0)] if k < 3 else lumped
        d += [f"{i},{k % 3 + 1},{v:.12e}" for i, v in loads]
        if k:
            d.append("*DLOAD,OP=NEW")
        if k >= 3:
            d += ["E,GRAV,9806.65," + ",".join(str(float(i == k - 3)) for i in range(3))]
        d += ["*NODE PRINT,NSET=TIP", "U", "*END STEP"]
    with tempfile.TemporaryDirectory() as tmp:
        (Path(tmp) / "rod.inp").write_text("\n".join(d) + "\n")
        log = subprocess.run(["ccx", "rod"], cwd=tmp, capture_output=True, text=True)
        dat = Path(tmp) / "rod.dat"
        rows = [l.split() for l in dat.read_text().splitlines()] if dat.exists() else []
        rows = [[float(x) for x in r[1:4]] for r in rows if len(r) == 4 and r[0] == str(n)]
        assert len(rows) == 6, log.stdout[-2000:]
    c = 1000 * np.array(rows).T
    return c[:, :3], c[:, 3:]


def main():
    solvers = {"opensees": opensees, "pynite": pynite, "calculix": calculix}
    cases = json.loads((HERE / "beam_references.json").read_text())["cases"]
    for name in sys.argv[1:] or solvers:
        print(f"{name}: largest deviation / largest entry")
        for c in cases:
            for r in c["results"]:
                stations = r.get("stations", []) if name == "opensees" else []
                more = [[(s["load_station_mm"], s["read_station_mm"]) for s in stations]] if stations else []
                got = solvers[name](c["rod_toml"], r["theory"], *more)
                if got is None:
                    continue
                off = lambda g, want: np.abs(g - np.array(want)).max() / np.abs(want).max()
                note = f"C^F {off(got[0], r['cf_um_per_n']):.1e}   C^g {off(got[1], r['cg_um_per_g']):.1e}"
                if stations:
                    moved = max(off(g[:3], s["displacement_um_per_n"]) for g, s in zip(got[2], stations))
                    turned = max(off(g[3:], s["rotation_urad_per_n"]) for g, s in zip(got[2], stations))
                    note += f"   between stations: displacement {moved:.1e}, rotation {turned:.1e}"
                print(f"  {c['name']:20s} {r['theory']:16s} {note}", flush=True)


if __name__ == "__main__":
    main()
