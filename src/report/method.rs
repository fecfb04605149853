//! How each number of a report was found, in a few sentences with their sources: the last section
//! of its page. The documents say it in full.

/// Paragraphs of a method.
type Method = &'static [&'static str];

/// For a report.
pub(super) fn paragraphs(method: Method) -> Vec<String> {
    method.iter().map(|paragraph| (*paragraph).to_owned()).collect()
}

/// The paper.
macro_rules! paper {
    () => {
        "Improved MultiCal, Sensors 2023, 23(12), 5717"
    };
}

pub(super) const COMPLIANCE: Method = &[
    "The rod is a chain of beam elements, clamped at the flange and free at the ball. Extension, shear (Timoshenko, with \
     the section's shear coefficient), bending and torsion are integrated exactly along each element, its own weight \
     included, and added up from the flange to the tip: docs/beam.md.",
    concat!(
        "C^F: displacement of the tip per newton at the ball. C^g: under the rod's own weight, per gram-force of \
         gravity's 1 g. Calc is the closed form of ",
        paper!(),
        "."
    ),
    "Standard uncertainties of the rod's numbers are propagated to first order, u² = Σ (∂y/∂x · u(x))² (GUM 5.1.2), with \
     exact derivatives.",
];

pub(super) const RIG_FIT: Method = &[
    "One line for each channel under the loads of one direction, offset = c·F + b, by least squares through the averages \
     of repeats; standard errors from the scatter of repeats and of the averages about the line together, of whole trials \
     where those differ: docs/rig.md.",
    concat!(
        "r_mn = c_mn/c'_mn and r_rod = (c22 + c33)/(c'22 + c'33), c' from the model at the stations of the line (",
        paper!(),
        ", Eqs 20 and 21). Intervals are Student's t with the degrees of freedom of Welch and Satterthwaite."
    ),
];

pub(super) const CALIBRATION: Method = &[
    concat!(
        "x = f(ρ, q, τ) + R·Δx: the tip of the rigid robot, its joints turned by cⱼ·τⱼ, plus the rod's deflection \
         Δx = C^g·g_T + C^F·F_T (",
        paper!(),
        ", Eqs 11 to 19). Levenberg–Marquardt over all parameters ρ that the geometry allows, deflections and torques \
         computed again until they converge: docs/calibration.md."
    ),
    "Parameters of the drawing are normal about their nominal values with the robot file's standard uncertainties times \
     one scale, chosen by marginal likelihood; what the poses do not identify stays nominal and is named. Standard errors \
     come from the Jacobian and the stated noise, else from the scatter of the residuals.",
];

pub(super) const COMPARISON: Method = &[
    "Each mode is calibrated on the same poses and judged on the same others; differences are tested by a paired \
     bootstrap, in which poses are drawn again within each clamp and all modes calibrated on each draw. p is corrected for \
     the number of pairs (Bonferroni): docs/calibration.md.",
];

pub(super) const FORECAST: Method = &[
    "Campaigns are drawn from the stated noise, clamp places, repeatability and the rod's uncertainty, calibrated as a \
     recording would be (linearised about the nominal robot) and judged at the unseen poses: docs/design.md, What to \
     expect. The interval is that of the mean of one campaign.",
];

pub(super) const DIAGNOSIS: Method = &[
    "Mistakes of units, signs, names and files are tried first and undone. Then each effect of the library at each place \
     is a block of columns with a prior on its size; its Bayes factor against the model as it is, nominal numbers within \
     their standard uncertainties in both, is computed in closed form, the best are refitted nonlinearly, and smooth \
     curves compete with them: docs/diagnosis.md.",
    "An effect is named where its odds are beyond the line in the picture of odds and held-out data, with the whole search \
     repeated without them, are predicted better; rivals that explain as much are named beside it.",
];

pub(super) const ROD_DESIGN: Method = &[
    "Every combination of the design file is a beam model (compliance: docs/beam.md), its limits are checked and the \
     Pareto front kept exactly, ties included. Intervals come from the standard uncertainties of each rod's numbers to \
     first order (GUM 5.1.2); refining is a sequence of linear programs with exact derivatives: docs/design.md.",
];

pub(super) const POSE_DESIGN: Method = &[
    "Poses are exchanged one by one between plan and candidates as long as that improves the criterion, each pose once, \
     with rank-one updates of the information matrix of all parameters: docs/design.md, From a rod to poses. O1 to O5 are \
     the observability indices of Sun and Hollerbach (ICRA 2008).",
];

pub(super) const RIG_DESIGN: Method = &[
    "Of all loads, directions and stations that the rig allows those are chosen whose expected log odds between the \
     effects grow most for the effort, or which narrow the interval of r_rod in the fewest minutes: docs/design.md, What to \
     measure on a rig.",
];

pub(super) const PREDICTION: Method = &[
    "Forward kinematics of the robot file with its joint compliances, effects and laws. Standard deviations from the \
     covariance of the calibration, √diag(J·Σ·Jᵀ), and the error of poses that it had not seen: docs/calibration.md, How \
     well is it known?",
];
