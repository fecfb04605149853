/* What `rodcal design rod` does for each rod of two round pipes with a sharp corner, as a plain loop: C^F and C^g by
 * virtual forces (Timoshenko), c_rod, mass, reach; the best c_rod below a limit of mass. One thread, nothing kept.
 *
 *     cc -O3 -march=native -o rods benches/reference/rods.c -lm && ./rods
 *
 * Prints c_rod of rod 5# (by which it is checked against ours) and the time of a rod. */
#include <math.h>
#include <stdio.h>
#include <time.h>

static const double PI = 3.14159265358979323846, G0 = 9.80665;

typedef double Mat[9]; /* row by row */

/* out += x . y */
static void add_product(Mat out, Mat x, Mat y, double by)
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++)
                out[3 * i + j] += by * x[3 * i + k] * y[3 * k + j];
}

static void skew(Mat out, double x, double y, double z)
{
    Mat s = {0, -z, y, z, 0, -x, -y, x, 0};
    for (int i = 0; i < 9; i++)
        out[i] = s[i];
}

/* R(turn about y) diag(d) R^T */
static void turned(Mat out, const double d[3], double sin_turn, double cos_turn)
{
    double across = cos_turn * sin_turn * (d[2] - d[0]);
    Mat t = {cos_turn * cos_turn * d[0] + sin_turn * sin_turn * d[2], 0, across, 0, d[1], 0,
             across, 0, sin_turn * sin_turn * d[0] + cos_turn * cos_turn * d[2]};
    for (int i = 0; i < 9; i++)
        out[i] = t[i];
}

struct result { double c_rod, mass, reach; };

/* l1, l2, gamma; outer and inner diameter; E, G, nu, density; mass at the tip; size of the contact force. SI. */
static struct result rod(double l1, double l2, double gamma, double outer, double inner, double e, double g, double nu,
                         double density, double tip_mass, double force)
{
    double area = PI / 4 * (outer - inner) * (outer + inner);
    double i = area * (outer * outer + inner * inner) / 16, j = 2 * i;
    double m2 = inner * inner / (outer * outer), ring = (1 + m2) * (1 + m2), s = nu * g / e;
    double kappa = 3 * ring / ((3.5 - s) * ring + (10 - 8 * s) * m2);
    double ei = 1 / (e * i), gj = 1 / (g * j), ea = 1 / (e * area), kga = 1 / (kappa * g * area);
    double per_m = density * area;
    double turn = PI - gamma, st = sin(turn), ct = cos(turn);
    double tip[3] = {l2 * st, 0, l1 + l2 * ct};
    double length[2] = {l1, l2}, middle[2][3] = {{0, 0, l1 / 2}, {l2 / 2 * st, 0, l1 + l2 / 2 * ct}};
    double far[2][3] = {{0, 0, l1}, {tip[0], 0, tip[2]}}, along[2][3] = {{0, 0, 1}, {st, 0, ct}};
    Mat cf = {0}, cg = {0};
    double beyond = tip_mass, first[3] = {0, 0, 0}; /* about the far end */
    for (int k = 1; k >= 0; k--) {
        double l = length[k], m = per_m * l, a = k ? st : 0, c = k ? ct : 1;
        double force_flex[3] = {l * kga + l * l * l / 12 * ei, l * kga + l * l * l / 12 * ei, l * ea};
        double moment_flex[3] = {l * ei, l * ei, l * gj};
        Mat fa, fb, lever, weight, ahead, minus_lever, twist = {0};
        turned(fa, force_flex, a, c);
        turned(fb, moment_flex, a, c);
        double r[3] = {tip[0] - middle[k][0], 0, tip[2] - middle[k][2]};
        skew(lever, r[0], r[1], r[2]);
        for (int q = 0; q < 9; q++)
            minus_lever[q] = -lever[q];
        double h[3] = {far[k][0] - middle[k][0], 0, far[k][2] - middle[k][2]};
        skew(weight, first[0] + h[0] * beyond, 0, first[2] + h[2] * beyond);
        skew(ahead, along[k][0], 0, along[k][2]);
        Mat turn_f = {0}, turn_w = {0};
        add_product(turn_f, fb, lever, 1);
        add_product(turn_w, fb, weight, 1);
        add_product(twist, fb, ahead, m * l / 6);
        for (int q = 0; q < 9; q++) {
            turn_w[q] += twist[q];
            cf[q] += fa[q];
            cg[q] += fa[q] * (beyond + m / 2);
        }
        add_product(cf, minus_lever, turn_f, 1);
        add_product(cg, minus_lever, turn_w, 1);
        for (int q = 0; q < 3; q++)
            first[q] += 2 * h[q] * beyond + h[q] * m;
        beyond += m;
    }
    struct result result = {0, beyond, sqrt(tip[0] * tip[0] + tip[2] * tip[2])};
    for (int q = 0; q < 9; q++)
        result.c_rod += force * fabs(cf[q]) + G0 * fabs(cg[q]);
    return result;
}

int main(void)
{
    double e = 193e9, nu = 0.29, g = e / (2 * (1 + nu)), force = sqrt(1.10 * 1.10 + 1.25 * 1.25 + 1.05 * 1.05);
    struct result five = rod(0.150, 0.525, PI / 2, 0.032, 0.030, e, g, nu, 7930, 0.060, force);
    printf("rod 5#: c_rod %.6f um, %.4f g\n", five.c_rod * 1e6, five.mass * 1e3);
    struct timespec from, to;
    clock_gettime(CLOCK_MONOTONIC, &from);
    double best = INFINITY;
    long count = 0;
    for (int tube = 0; tube < 20; tube++)
        for (int k = 0; k < 2; k++)
            for (int p = 0; p < 250; p++)
                for (int q = 0; q < 500; q++, count++) {
                    double outer = 0.020 + 0.001 * tube, gamma = k ? 2 * PI / 3 : PI / 2;
                    struct result r = rod(0.100 + 0.001 * p, 0.300 + 0.001 * q, gamma, outer, outer - 0.002, e, g, nu,
                                          7930, 0.060, force);
                    if (r.mass < 0.9 && r.reach > 0.5 && r.c_rod < best)
                        best = r.c_rod;
                }
    clock_gettime(CLOCK_MONOTONIC, &to);
    double seconds = (to.tv_sec - from.tv_sec) + 1e-9 * (to.tv_nsec - from.tv_nsec);
    printf("%ld rods in %.3f s, %.3f us each; best c_rod %.3f um\n", count, seconds, 1e6 * seconds / count, best * 1e6);
    return 0;
}
