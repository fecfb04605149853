"""The tip of rods by PyNite (pip install PyNiteFEA): what the guide in docs/design.md quotes. Development only.

    python benches/reference/pynite_rods.py

Three forces and three weights at the tip of an L-shaped rod of two members, as a user of PyNite would write it; prints
C^F along z of rod 5# and the time of a rod. PyNite's members have no shear, so that C^F is that of Euler and Bernoulli.
"""

import math
import time

from Pynite import FEModel3D

E, NU, DENSITY, TIP = 193e9, 0.29, 7930.0, 0.060
G = E / (2 * (1 + NU))
G0 = 9.80665


def tip(l1, l2, outer, inner):
    """Displacements of the tip under 1 N and under 1 g along x, y and z."""
    area = math.pi / 4 * (outer**2 - inner**2)
    i = math.pi / 64 * (outer**4 - inner**4)
    model = FEModel3D()
    model.add_material("steel", E, G, NU, DENSITY)
    model.add_section("tube", area, i, i, 2 * i)
    model.add_node("flange", 0, 0, 0)
    model.add_node("corner", 0, 0, l1)
    model.add_node("tip", l2, 0, l1)
    model.add_member("pipe1", "flange", "corner", "steel", "tube")
    model.add_member("pipe2", "corner", "tip", "steel", "tube")
    model.def_support("flange", True, True, True, True, True, True)
    cases = []
    for axis in "XYZ":
        model.add_node_load("tip", "F" + axis, 1.0, case="F" + axis)
        weight = DENSITY * area * G0
        for member in ("pipe1", "pipe2"):
            model.add_member_dist_load(member, "F" + axis, weight, weight, case="W" + axis)
        model.add_node_load("tip", "F" + axis, TIP * G0, case="W" + axis)
        cases += ["F" + axis, "W" + axis]
    for case in cases:
        model.add_load_combo(case, {case: 1.0})
    model.analyze_linear()
    node = model.nodes["tip"]
    return {case: (node.DX[case], node.DY[case], node.DZ[case]) for case in cases}


five = tip(0.150, 0.525, 0.032, 0.030)
print(f"rod 5#: C^F 33 = {five['FZ'][2] * 1e6:.4f} um/N, C^g 33 = {five['WZ'][2] * 1e6:.4f} um/g")
count = 50
start = time.perf_counter()
for k in range(count):
    tip(0.100 + 0.001 * k, 0.525, 0.032, 0.030)
print(f"{1e3 * (time.perf_counter() - start) / count:.2f} ms a rod")
