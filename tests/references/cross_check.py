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
from pathlib import Path

import numpy as np

from beam_references import Rod

HERE = Path(__file__).parent
G0 = 9.80665


class Mesh:
    """Nodes, straight elements, joints and nodal masses of a rod, plain floats, SI."""

    def __init__(self, text, theory, per_piece=4, per_arc=400):
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
        for s in rod.borders():
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
        for lo, hi in zip(borders, borders[1:]):
            k = rod.piece((lo + hi) / 2)
            n = per_arc if k == 1 else per_piece
            for i in range(1, n + 1):
                s = hi if i == n else lo + (hi - lo) * i / n
                # keep each arc border exactly on the border so that tangents and kinks are right
                new = node(s)
                self.elements.append((last, new, rod.sections[k]))
                last = new
            last = station(hi, last)
        self.tip = last

    def frame(self, i, j):
        x = np.subtract(self.nodes[j], self.nodes[i])
        h = np.linalg.norm(x)
        x = x / h
        y = np.array([0.0, 1.0, 0.0])
        return h, x, y, np.cross(x, y)


def values(c):
    """EA, GA_shear (inf in Euler-Bernoulli), EI, GJ, kg/m"""
    return 1 / float(c.axial), (1 / float(c.shear) if c.shear else np.inf), 1 / float(c.bending), 1 / float(c.torsion), float(c.line_mass)


def opensees(text, theory):
    import openseespy.opensees as ops

    # many short elasticBeamColumn elements lose digits to rounding (4e-2 at 400 on one rod), so fewer of them
    m = Mesh(text, theory, per_arc=400 if theory == "timoshenko" else 40)
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
    return c[:, :3], c[:, 3:]


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


def calculix(text, theory):
    """ccx's two-node Timoshenko user element U1; tip forces only.

    The rod is turned in space first: with members along the global axes U1 answers wrongly (1000 times too stiff
    in the plane of the rod), turned it is right.
    """
    if theory != "timoshenko":
        return None
    m = Mesh(text, theory, per_piece=4, per_arc=200)
    if m.joints or any(c.torsion / c.bending > 1.5 for _, _, c in m.elements):
        return None   # ccx refuses a material whose E/2G - 1 is above 0.5
    turn, _ = np.linalg.qr(np.array([[1.0, 2.0, 0.5], [-0.7, 1.1, 0.9], [0.4, -0.8, 1.3]]))
    turn *= np.sign(np.linalg.det(turn))
    normal = ",".join(f"{v:.12e}" for v in turn @ [0.0, 1.0, 0.0])
    d = ["*NODE,NSET=ALL"] + ["{},{:.12e},{:.12e},{:.12e}".format(i + 1, *(turn @ x)) for i, x in enumerate(m.nodes)]
    d += ["*NSET,NSET=TIP", f"{m.tip + 1}"]
    d.append("*USER ELEMENT,TYPE=U1,NODES=2,INTEGRATION POINTS=2,MAXDOF=6")
    kinds = []
    for e, (i, j, c) in enumerate(m.elements):
        if c not in kinds:
            kinds.append(c)
        d += [f"*ELEMENT,TYPE=U1,ELSET=K{kinds.index(c)}", f"{e + 1},{i + 1},{j + 1}"]
    for k, c in enumerate(kinds):
        ea, ga, ei, gj, _ = values(c)
        nu = ei / gj * 2 / 2 - 1          # J = 2I: EI/GJ = E/2G = 1 + nu
        e = 1.0e11                        # any modulus; the section scales with it
        kappa = ga / ea * 2 * (1 + nu)
        d += [f"*MATERIAL,NAME=M{k}", "*ELASTIC", f"{e:.12e},{nu:.12e}"]
        d += [f"*BEAM SECTION,ELSET=K{k},MATERIAL=M{k},SECTION=GENERAL", f"{ea / e:.12e},{ei / e:.12e},0.,{ei / e:.12e},{kappa:.12e}", normal]
    d += ["*BOUNDARY", "1,1,6"]
    for k in range(3):
        d += ["*STEP", "*STATIC", "*CLOAD,OP=NEW", *[f"{m.tip + 1},{i + 1},{turn[i, k]:.12e}" for i in range(3)], "*NODE PRINT,NSET=TIP", "U", "*END STEP"]
    with tempfile.TemporaryDirectory() as tmp:
        (Path(tmp) / "rod.inp").write_text("\n".join(d) + "\n")
        log = subprocess.run(["ccx", "rod"], cwd=tmp, capture_output=True, text=True)
        dat = Path(tmp) / "rod.dat"
        rows = [l.split() for l in dat.read_text().splitlines()] if dat.exists() else []
        rows = [[float(x) for x in r[1:4]] for r in rows if len(r) == 7 and r[0] == str(m.tip + 1)]
        assert len(rows) == 3, log.stdout[-2000:]
    return 1e6 * turn.T @ np.array(rows).T, None


def main():
    solvers = {"opensees": opensees, "pynite": pynite, "calculix": calculix}
    cases = json.loads((HERE / "beam_references.json").read_text())["cases"]
    for name in sys.argv[1:] or solvers:
        print(f"{name}: largest deviation / largest entry")
        for c in cases:
            for r in c["results"]:
                got = solvers[name](c["rod_toml"], r["theory"])
                if got is None:
                    continue
                dev = []
                for g, want in zip(got, (r["cf_um_per_n"], r["cg_um_per_g"])):
                    w = np.array(want)
                    dev.append("-" if g is None else f"{np.abs(g - w).max() / np.abs(w).max():.1e}")
                print(f"  {c['name']:20s} {r['theory']:16s} C^F {dev[0]:>8s}   C^g {dev[1]:>8s}", flush=True)


if __name__ == "__main__":
    main()
