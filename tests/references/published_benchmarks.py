#!/usr/bin/env python3
"""Published beam, section and laminate figures, recomputed from their definitions.

    pip install mpmath
    python3 published_benchmarks.py

Beams: the unit-load integral along the centreline (as in beam_references.py, but for any section and any curve).
Each line: what, the published figure, ours, ratio. README.md states geometry, directions and sources.
"""
from mpmath import cos, cosh, mp, mpf, pi, quad, sin, sinh, sqrt, tanh

mp.dps = 30


def line(what, published, ours):
    p = mpf(published)
    print(f"  {what:58s} {published:>10s}  {mp.nstr(ours, 12):>17s}   ratio {mp.nstr(ours / p, 7)}")


def saint_venant(a, b, terms=60):
    """Torsion constant of a rectangle a >= b (series)."""
    s = sum(tanh((2 * n + 1) * pi * a / (2 * b)) / mpf(2 * n + 1) ** 5 for n in range(terms))
    return a * b**3 * (mpf(1) / 3 - 64 * b / (pi**5 * a) * s)


def macneal_harder():
    print("MacNeal & Harder 1985, straight beam: L 6, 0.2 deep (in plane) x 0.1, E 1e7, nu 0.3; unit loads at the free end")
    e, nu, l, h, b = mpf(10) ** 7, mpf("0.3"), mpf(6), mpf("0.2"), mpf("0.1")
    g = e / (2 * (1 + nu))
    area, strong, weak, kappa = h * b, b * h**3 / 12, h * b**3 / 12, mpf(5) / 6
    j = saint_venant(h, b)
    line("extension", "3.0e-5", l / (e * area))
    line("in-plane shear", "0.1081", l**3 / (3 * e * strong) + l / (kappa * g * area))
    line("out-of-plane shear", "0.4321", l**3 / (3 * e * weak) + l / (kappa * g * area))
    line("twist, unit torque (rad), Saint-Venant J", "0.03208", l / (g * j))
    print(f"    Saint-Venant J = {mp.nstr(j, 12)}; 0.03208 would need J = {mp.nstr(l / (g * mpf('0.03208')), 6)}")

    print("MacNeal & Harder 1985, curved beam: radii 4.12 and 4.32, thickness 0.1, 90 degrees, E 1e7, nu 0.25; unit loads at the free end")
    nu, r_in, r_out = mpf("0.25"), mpf("4.12"), mpf("4.32")
    g, r = e / (2 * (1 + nu)), (r_in + r_out) / 2
    end = pi / 2
    radial = lambda s: quad(lambda a: sin(a) ** 2, [0, s])
    ring = quad(lambda a: (1 - cos(a)) ** 2, [0, end])
    in_plane = r**3 / (e * strong) * radial(end) + r * radial(end) / (e * area) + r * quad(lambda a: cos(a) ** 2, [0, end]) / (kappa * g * area)
    line("in-plane, radial force, thin curved beam", "0.08734", in_plane)
    line("in-plane, the same with R = 4.2", "0.08734", mpf("4.2") ** 3 / (e * strong) * pi / 4 + mpf("4.2") * pi / 4 * (1 / (e * area) + 1 / (kappa * g * area)))
    tangential = r**3 / (e * strong) * ring + r * pi / 4 * (1 / (e * area) + 1 / (kappa * g * area))
    line("in-plane, tangential force (not the published load)", "0.08734", tangential)
    line("out-of-plane, R = 4.22", "0.5022", r**3 * (radial(end) / (e * weak) + ring / (g * j)) + r * end / (kappa * g * area))
    # exact curved beam of plane stress elasticity (Timoshenko & Goodier, art. 33): radial force on a quarter ring
    n = r_in**2 - r_out**2 + (r_in**2 + r_out**2) * mp.log(r_out / r_in)
    line("in-plane, plane-stress elasticity (Timoshenko & Goodier)", "0.08734", pi * (r_in**2 + r_out**2) / (e * n) / b)

    print("MacNeal & Harder 1985, twisted beam: L 12, width 1.1, thickness 0.32, 90 degrees twist, E 29e6, nu 0.22; unit loads at the free end")
    e, nu, l, w, t = mpf(29) * 10**6, mpf("0.22"), mpf(12), mpf("1.1"), mpf("0.32")
    g, area = e / (2 * (1 + nu)), w * t
    strong, weak = t * w**3 / 12, w * t**3 / 12
    k = kappa * g * area
    twist = lambda x: pi / 2 * x / l
    # width along Y at the root, along Z at the tip. Bending by a force along Y: moment about Z; I about Z is strong at the root.
    along_root_width = quad(lambda x: (l - x) ** 2 * (cos(twist(x)) ** 2 / (e * strong) + sin(twist(x)) ** 2 / (e * weak)), [0, l]) + l / k
    along_root_thickness = quad(lambda x: (l - x) ** 2 * (sin(twist(x)) ** 2 / (e * strong) + cos(twist(x)) ** 2 / (e * weak)), [0, l]) + l / k
    coupling = quad(lambda x: (l - x) ** 2 * sin(twist(x)) * cos(twist(x)) * (1 / (e * strong) - 1 / (e * weak)), [0, l])
    line("'in-plane': force along the WIDTH AT THE TIP", "0.005424", along_root_thickness)
    line("'out-of-plane': force along the THICKNESS AT THE TIP", "0.001754", along_root_width)
    print(f"    cross displacement (force along one, displacement along the other), either way: {mp.nstr(abs(coupling), 12)}")


def vpcs():
    print("VPCS SSLL06: quarter circle R 3, tube 20 x 16 mm, E 2e11, in its plane; nu 0.3 for the shear term")
    tube = lambda d, b: (pi * (d**2 - b**2) / 4, pi * (d**4 - b**4) / 64)
    area, inertia = tube(mpf("0.020"), mpf("0.016"))
    e, nu, r = mpf(2) * 10**11, mpf("0.3"), mpf(3)
    ei, f1, f2, mz = e * inertia, 10, 5, 8
    # clamped at A = (0, R), centre O, free end B = (R, 0): the section at angle a from B is at (R cos a, R sin a).
    # F1 along +x and F2 along +y at B give moments about z at the section: F1*R*sin a + F2*R*(1 - cos a) (+ Mz), all of one sign.
    m = lambda a: f1 * r * sin(a) + f2 * r * (1 - cos(a)) + mz
    bend = lambda virtual: quad(lambda a: m(a) * virtual(a) * r / ei, [0, pi / 2])
    u, v, th = bend(lambda a: r * sin(a)), bend(lambda a: r * (1 - cos(a))), bend(lambda a: mpf(1))
    line("u_B along F1, bending only", "0.3791", u)
    line("v_B along F2, bending only", "0.2417", v)
    line("theta_B about Mz, bending only", "0.1654", th)
    line("  formula for u", "0.3791", r**2 / (4 * ei) * (f1 * pi * r + 2 * f2 * r + 4 * mz))
    line("  formula for v", "0.2417", r**2 / (4 * ei) * (2 * f1 * r + (3 * pi - 8) * f2 * r + 2 * (pi - 2) * mz))
    line("  formula for theta", "0.1654", r / (4 * ei) * (4 * f1 * r + 2 * (pi - 2) * f2 * r + 2 * pi * mz))
    # axial and shear terms: tangent at a is (-sin a, cos a); N = F.t, V = F.n with n = (cos a, sin a)
    ga = cowper(nu, mpf("0.8")) * e / (2 * (1 + nu)) * area
    extra = lambda fx, fy: quad(lambda a: ((-f1 * sin(a) + f2 * cos(a)) * (-fx * sin(a) + fy * cos(a)) / (e * area) + (f1 * cos(a) + f2 * sin(a)) * (fx * cos(a) + fy * sin(a)) / ga) * r, [0, pi / 2])
    line("u_B with axial and shear (Cowper) terms", "0.3791", u + extra(1, 0))
    line("v_B with axial and shear (Cowper) terms", "0.2417", v + extra(0, 1))

    print("VPCS SSLL07: quarter circle R 1, tube 20 x 16 mm, E 2e11, nu 0.3, F = 100 N out of plane at the free end B")
    r, f = mpf(1), 100
    gj = e / (2 * (1 + nu)) * 2 * inertia
    bending, torsion = lambda a: -f * r * cos(a), lambda a: f * r * (1 - sin(a))
    # a from the clamped end A: the section at a is at (R cos a, R sin a), B at 90 degrees
    u = quad(lambda a: (bending(a) ** 2 / ei + torsion(a) ** 2 / gj) / f * r, [0, pi / 2])
    line("u_B along F, bending and torsion", "0.13462", u)
    line("  formula FR^3/EI (pi/4 + (1+nu)(3pi/4 - 2))", "0.13462", f * r**3 / ei * (pi / 4 + (1 + nu) * (3 * pi / 4 - 2)))
    line("u_B with shear (Cowper) term", "0.13462", u + f * r * pi / 2 / (cowper(nu, mpf("0.8")) * e / (2 * (1 + nu)) * area))
    line("torsion at 15 degrees from A", "74.1180", torsion(pi / 12))
    line("bending at 15 degrees from A", "-96.5925", bending(pi / 12))


def vpcs_as_rods():
    """The same two arcs as rod files, so that they can be asked of a program whose frame is the tool frame."""
    from beam_references import Rod, THEORIES

    def rod(r_mm, theory):
        pipe = 'material = "m"\nouter_diameter_mm = 20.0\ninner_diameter_mm = 16.0\n'
        return Rod(
            f'name = "arc"\n[geometry]\nl1_mm = {r_mm}\nl2_mm = {r_mm}\nbend_radius_mm = {r_mm}\n'
            f"[material.m]\nyoungs_modulus_gpa = 200.0\npoisson_ratio = 0.3\ndensity_kg_m3 = 7800.0\n[pipe1]\n{pipe}[pipe2]\n{pipe}",
            theory,
        )

    print("The arcs as rods: l1 = l2 = bend radius = R, gamma 90, tube 20 x 16, E 200, nu 0.3 (axial always in, shear in Timoshenko)")
    for theory in THEORIES:
        r = rod("3000.0", theory)
        cases = [r.force(r.length, a) for a in ((1, 0, 0), (0, 0, 1))] + [r.moment(r.length, (0, 1, 0))]
        w = r.work(cases, cases)
        load = (-5, 10, -8)   # F2 = 5 N along -X, F1 = 10 N along +Z, Mz = 8 N m about -Y
        u, v, th = (sum(w[i][j] * load[j] for j in range(3)) for i in (1, 0, 2))
        print(f"  SSLL06 {theory:16s} z {mp.nstr(u, 15)} m, x {mp.nstr(v, 15)} m, rotation about Y {mp.nstr(th, 15)} rad")
        r = rod("1000.0", theory)
        print(f"  SSLL07 {theory:16s} y {mp.nstr(100 * r.tip_compliance()[0][1][1] / 10**6, 15)} m for 100 N along Y")


def cowper(nu, m):
    q = (1 + m * m) ** 2
    return 6 * (1 + nu) * q / ((7 + 6 * nu) * q + (20 + 12 * nu) * m * m)


def shear_coefficients():
    print("Cowper 1966, Table 1: solid circle 6(1+nu)/(7+6nu), thin tube 2(1+nu)/(4+3nu), both ends of the hollow-circle formula")
    for nu, solid, thin in [("0", "0.857", "0.500"), ("0.3", "0.886", "0.531"), ("0.5", "0.900", "0.545")]:
        line(f"solid circle, nu {nu}", solid, cowper(mpf(nu), mpf(0)))
        line(f"thin tube (m = 1), nu {nu}", thin, cowper(mpf(nu), mpf(1)))
        assert abs(cowper(mpf(nu), mpf(1)) - 2 * (1 + mpf(nu)) / (4 + 3 * mpf(nu))) < mpf(10) ** -25


def ply(e1, e2, g12, nu12, degrees):
    """Q-bar (11, 12, 22, 16, 26, 66)."""
    nu21 = nu12 * e2 / e1
    k = 1 / (1 - nu12 * nu21)
    q11, q22, q12, q66 = k * e1, k * e2, k * nu12 * e2, g12
    c, s = cos(degrees * pi / 180), sin(degrees * pi / 180)
    return (
        q11 * c**4 + 2 * (q12 + 2 * q66) * s**2 * c**2 + q22 * s**4,
        (q11 + q22 - 4 * q66) * s**2 * c**2 + q12 * (s**4 + c**4),
        q11 * s**4 + 2 * (q12 + 2 * q66) * s**2 * c**2 + q22 * c**4,
        (q11 - q12 - 2 * q66) * s * c**3 + (q12 - q22 + 2 * q66) * s**3 * c,
        (q11 - q12 - 2 * q66) * s**3 * c + (q12 - q22 + 2 * q66) * s * c**3,
        (q11 + q22 - 2 * q12 - 2 * q66) * s**2 * c**2 + q66 * (s**4 + c**4),
    )


def laminate(e1, e2, g12, nu12, angles):
    """Membrane E_x, E_y, G_xy, nu_xy of a balanced symmetric laminate of equal plies."""
    plies = [ply(e1, e2, g12, nu12, a) for a in angles]
    a11, a12, a22, a16, a26, a66 = (sum(p[i] for p in plies) / len(plies) for i in range(6))
    assert abs(a16) + abs(a26) < mpf(10) ** -20
    return a11 - a12**2 / a22, a22 - a12**2 / a11, a66, a12 / a22


def laminates():
    t300 = (mpf(181), mpf("10.3"), mpf("7.17"), mpf("0.28"))
    print("T300/5208 (Tsai & Hahn 1980): E1 181, E2 10.3, G12 7.17 GPa, nu12 0.28; quasi-isotropic [0/+-45/90]s")
    ex, _, g, nu = laminate(*t300, (0, 45, -45, 90))
    line("E", "69.68", ex)
    line("G", "26.88", g)
    line("nu", "0.296", nu)
    print("Kaw, Mechanics of Composite Materials, example 2.7: Q-bar of a 60 degree graphite/epoxy ply, the same material")
    q = ply(*t300, 60)
    for name, i, want in [("11", 0, "23.65"), ("12", 1, "32.46"), ("22", 2, "109.4"), ("16", 3, "20.05"), ("26", 4, "54.19"), ("66", 5, "36.74")]:
        line(f"Q-bar {name}", want, q[i])
    print("Not published, for tests: T300/5208 tube laminates, E_axial, E_hoop, G, nu_axial-hoop (GPa)")
    for name, angles in [("[0/+-45/90]s", (0, 45, -45, 90)), ("[0_4/+-45]s", (0, 0, 0, 0, 45, -45)), ("[+-45]s", (45, -45)), ("[0/+-30]s", (0, 30, -30)), ("[0]", (0,))]:
        print(f"  {name:14s} " + "  ".join(f"{mp.nstr(x, 16):>20s}" for x in laminate(*t300, angles)))


def bend_flexibility():
    print("Bend of issue 2 (L1 300, L2 450, tube 16 x 12, bend radius 40, 90 degrees), arc bending x k (um/N), Timoshenko")
    from beam_references import CASES, Rod

    text = next(c[1] for c in CASES if 'name = "arc40"' in c[1])
    t, r, rm = mpf(2), mpf(40), mpf(7)
    h = t * r / rm**2
    karman, asme = (10 + 12 * h**2) / (1 + 12 * h**2), max(mpf(1), mpf("1.65") / h)
    print(f"  h = tR/r_m^2 = {mp.nstr(h, 10)}; von Karman k = {mp.nstr(karman, 12)}, ASME B31.3 1.65/h = {mp.nstr(mpf('1.65') / h, 12)}")
    rows = [("k = 1", mpf(1), True), ("von Karman, in plane and out of plane", karman, True), ("von Karman, in plane only", karman, False), ("ASME B31.3, in plane and out of plane", asme, True), ("ASME B31.3, in plane only", asme, False)]
    for name, k, both in rows:
        c = []
        for axis, scaled in ((1, both), (2, True)):
            rod = Rod(text, "timoshenko")
            rod.sections[1].bending *= k if scaled else 1
            c.append(rod.tip_compliance()[0][axis][axis])
        print(f"  {name:40s} k {mp.nstr(k, 8):>11s}   C22 {mp.nstr(c[0], 12):>14s}   C33 {mp.nstr(c[1], 12):>14s}")
    print("  C3D20R solid model (issue 2)                                C22         270.63   C33         212.80")


if __name__ == "__main__":
    macneal_harder()
    vpcs()
    vpcs_as_rods()
    shear_coefficients()
    laminates()
    bend_flexibility()
