"""The Python package in one small program: rod, rig, calibration, diagnosis, and what to do with it.

From the project's folder, after ``pip install ./python``: ``python examples/library.py``
"""

from __future__ import annotations

import numpy as np

import rodcal


def main() -> None:
    # 1. How much a rod bends, from its drawing
    rod = rodcal.Rod.read("rods/5.toml")
    model = rodcal.compliance(rod)
    print(f"rod {rod.name}: c22 = {model.cf_um_per_n[1, 1]:.2f} µm/N, c_rod = {model.c_rod_um:.1f} µm")

    # 2. How much it really bends, from readings under known loads
    readings = rodcal.Readings.read("stiffness_data/5.csv")
    fit = rodcal.rig_fit(rod, readings)
    if fit.r_rod is not None and fit.r_rod_half_width_95 is not None:
        print(f"r_rod = {fit.r_rod:.3f} ± {fit.r_rod_half_width_95:.3f}")

    # 3. Calibrate the robot that the rod was mounted on, with the measured compliance
    campaign = rodcal.Campaign.read("campaigns/tx90-5/campaign.toml")
    calibration = rodcal.calibrate(campaign)
    print(f"calibrated with mode {calibration.mode}: {len(calibration.parameters)} parameters")
    worst = int(np.argmax(np.linalg.norm(calibration.deviations_um, axis=1)))
    print(f"noise of a coordinate: {calibration.noise_um:.1f} µm; farthest off: pose {campaign.pose_names[worst]}")
    if calibration.validation is not None:
        print(f"validation: mean {calibration.validation.mean_um:.1f} µm, max {calibration.validation.max_um:.1f} µm")

    # 4. What rod and robot do that their models leave out
    for finding in rodcal.diagnose_rig(rod, readings).findings:
        print(f"{finding.effect} ({finding.location}): {finding.words}")
    print(f"calibration: {rodcal.diagnose_calibration(campaign).verdict}")

    # 5. Use it: where the tip is at any joint values
    tips = rodcal.predict(calibration.calibrated(), [[10.0, -20.0, 95.0, 5.0, 30.0, 0.0]])
    print(f"tip: {tips.tips_mm[0].round(3)} mm in {{0}}")


if __name__ == "__main__":
    main()
