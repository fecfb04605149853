#!/usr/bin/env python3
"""The bent tube of issue 2 as a solid: what a beam bend leaves out (the section of a bent tube turns oval).

    pip install numpy ; apt-get install calculix-ccx
    python3 bend_solid.py

Tube 16 x 12 mm, L1 300, L2 450, bend radius 40, 90 degrees, E 193 GPa, nu 0.29. C3D20R bricks, root section held,
tip section a rigid body about its centre, 1 N there along Y and along Z. Prints C22 and C33 in um/N for finer and finer meshes.
"""
import subprocess
import tempfile
from pathlib import Path

import numpy as np

L1, L2, R, BORE, OUTER, E, NU = 300.0, 450.0, 40.0, 6.0, 8.0, 193e3, 0.29


def frames(pieces):
    """Centre and in-plane normal of each section, half an element apart."""
    out = []
    for k, (length, n) in enumerate(zip((L1 - R, R * np.pi / 2, L2 - R), pieces)):
        for i in range(k > 0, 2 * n + 1):
            s = length * i / (2 * n)
            a = (0.0, s / R, np.pi / 2)[k]
            centre = [(0, s), (R - R * np.cos(a), L1 - R + R * np.sin(a)), (R + s, L1)][k]
            out.append((np.array([centre[0], 0, centre[1]]), np.array([np.cos(a), 0, -np.sin(a)])))
    return out


def solve(around, through, pieces):
    sections, ids, nodes, bricks = frames(pieces), {}, [], []

    def node(a, c, q):
        key = (a, c % (2 * around), q)
        if key not in ids:
            x, n = sections[a]
            angle = np.pi * key[1] / around
            nodes.append(x + (BORE + (OUTER - BORE) * q / (2 * through)) * (np.cos(angle) * n + np.sin(angle) * np.array([0, 1, 0])))
            ids[key] = len(nodes)
        return ids[key]

    corners = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2)]
    middles = [(1, 0, 0), (2, 1, 0), (1, 2, 0), (0, 1, 0), (1, 0, 2), (2, 1, 2), (1, 2, 2), (0, 1, 2), (0, 0, 1), (2, 0, 1), (2, 2, 1), (0, 2, 1)]
    for a in range(0, len(sections) - 1, 2):
        for c in range(0, 2 * around, 2):
            for q in range(0, 2 * through, 2):
                bricks.append([node(a + k, c + j, q + i) for i, j, k in corners + middles])
    ref, rot = len(nodes) + 1, len(nodes) + 2
    card = lambda i, x: "{},{:.10e},{:.10e},{:.10e}".format(i, *x)
    on = lambda section: [str(v) for (a, _, _), v in ids.items() if a == section]
    d = ["*NODE"] + [card(i + 1, x) for i, x in enumerate(nodes)] + [card(i, sections[-1][0]) for i in (ref, rot)]
    d.append("*ELEMENT,TYPE=C3D20R,ELSET=E")
    for i, b in enumerate(bricks):
        d += [f"{i + 1}," + ",".join(map(str, b[:10])) + ",", ",".join(map(str, b[10:]))]
    d += ["*NSET,NSET=ROOT", *on(0), "*NSET,NSET=END", *on(len(sections) - 1), "*NSET,NSET=REF", str(ref)]
    d += ["*MATERIAL,NAME=M", "*ELASTIC", f"{E},{NU}", "*SOLID SECTION,ELSET=E,MATERIAL=M"]
    d += [f"*RIGID BODY,NSET=END,REF NODE={ref},ROT NODE={rot}", "*BOUNDARY", "ROOT,1,3"]
    for k in (2, 3):
        d += ["*STEP", "*STATIC", "*CLOAD,OP=NEW", f"{ref},{k},1.", "*NODE PRINT,NSET=REF", "U", "*END STEP"]
    with tempfile.TemporaryDirectory() as tmp:
        (Path(tmp) / "bend.inp").write_text("\n".join(d) + "\n")
        subprocess.run(["ccx", "bend"], cwd=tmp, check=True, capture_output=True)
        rows = [l.split() for l in (Path(tmp) / "bend.dat").read_text().splitlines()]
    u = [[1e3 * float(x) for x in r[1:4]] for r in rows if len(r) == 4 and r[0] == str(ref)]
    print(f"{len(bricks):6d} bricks  C22 {u[0][1]:.3f}  C33 {u[1][2]:.3f}", flush=True)


if __name__ == "__main__":
    solve(12, 1, (26, 16, 41))
    solve(16, 1, (40, 24, 64))
    solve(20, 2, (52, 32, 82))
