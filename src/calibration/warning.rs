//! What the user of a calibration should know, as data; its `Display` is the advice.

use std::fmt;

use nalgebra::Vector3;

use super::identifiability::MOST_SCATTER;
use crate::robot::Parameter;
use crate::units::{MM, UM, significant};

/// What the user of a calibration should know.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Warning {
    /// The fit or the compensation loop did not converge: why the last fit stopped, and after
    /// how many passes.
    NotConverged {
        /// In the words of the fit.
        reason: String,
        /// Passes of the compensation loop.
        passes: usize,
    },
    /// The fit leaves more than a robot's error can be.
    NotPlausible {
        /// Root mean square of what is left, m.
        rms: f64,
        /// The arm's reach, m.
        reach: f64,
    },
    /// The rod's file has laws, which are part of its deflection.
    RodLaws {
        /// What they add at most, m.
        most: f64,
        /// Those beyond what they were recorded with, in words.
        beyond: Vec<String>,
    },
    /// The robot's file has no masses, so that the torques on its joints are unknown.
    NoMasses {
        /// Whether effects of the file follow these torques.
        has_effects: bool,
    },
    /// A combination of parameters that the data do not identify.
    NotIdentified {
        /// The parameters that take part, the largest share first, with their coefficients.
        combination: Vec<(Parameter, f64)>,
        /// Its standard error by the data alone, relative to the plausible range; ∞ for none.
        relative_error: f64,
    },
    /// More combinations than anybody wants to read one by one.
    ManyNotIdentified {
        /// Number of combinations of parameters that the data do not identify.
        combinations: usize,
        /// The parameters that do not stand on data.
        parameters: Vec<Parameter>,
    },
    /// Poses that no noise explains.
    Outliers {
        /// Names, with their distances in m, the farthest first.
        poses: Vec<(String, f64)>,
        /// True where they still count in full.
        count_in_full: bool,
    },
    /// Groups scatter unequally; each was given a noise of its own.
    UnequalNoise {
        /// Name and standard deviation of a coordinate, m, of the quietest group.
        quietest: (String, f64),
        /// And of the noisiest.
        noisiest: (String, f64),
        /// Probability that chance does this.
        p_value: f64,
    },
    /// A parameter went farther than a robot as built can be from its drawing.
    Implausible {
        /// The parameter of robot, base or tool.
        parameter: Parameter,
        /// Its correction, SI.
        correction: f64,
    },
    /// A parameter is many standard uncertainties from the robot file.
    FarFromDrawing {
        /// The parameter of robot, base or tool.
        parameter: Parameter,
        /// Its correction, SI.
        correction: f64,
        /// Its standard uncertainty by the file, SI.
        standard_uncertainty: f64,
    },
    /// The tip was found far from where the rod's file has it.
    TipElsewhere {
        /// As calibrated, in {T}, m.
        calibrated: Vector3<f64>,
        /// By the rod's file, in {T}, m.
        of_rod: Vector3<f64>,
    },
    /// A rigid motion of all validation points cures most of their errors.
    ValidationMoved {
        /// Root mean square of the errors, m.
        before: f64,
        /// And after that motion.
        after: f64,
    },
    /// The validation asks for poses that the calibration has not seen.
    Extrapolation {
        /// How many times more uncertain the robot's own numbers make it there.
        ratio: f64,
        /// Joints that go beyond the calibration's range: number from 0, and both ranges in words.
        joints: Vec<(usize, String)>,
    },
    /// The calibrated robot predicts the validation worse than the nominal one does.
    WorseThanNominal {
        /// Mean error of the nominal robot, base and tool fitted, m.
        before: f64,
        /// Mean error of the calibrated one, m.
        after: f64,
    },
    /// The validation is far worse than the poses that the robot was calibrated on.
    ValidationFar {
        /// Mean error there, m.
        there: f64,
        /// Mean residual of the calibration, m.
        here: f64,
    },
    /// The fit of base and tool to the validation did not converge.
    ValidationNotConverged,
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Warning::NotConverged { reason, passes } => write!(
                f,
                "the calibration did not converge in {passes} passes ({reason}): do not use \
                 its numbers"
            ),
            Warning::NotPlausible { rms, reach } => not_plausible(f, *rms, *reach),
            Warning::RodLaws { most, beyond } => rod_laws(f, *most, beyond),
            Warning::NoMasses { has_effects } => no_masses(f, *has_effects),
            Warning::NotIdentified { combination, relative_error } => {
                not_identified(f, combination, *relative_error)
            }
            Warning::ManyNotIdentified { combinations, parameters } => {
                many_not_identified(f, *combinations, parameters)
            }
            Warning::Outliers { poses, count_in_full } => outliers(f, poses, *count_in_full),
            Warning::UnequalNoise { quietest, noisiest, p_value } => {
                unequal_noise(f, [quietest, noisiest], *p_value)
            }
            Warning::Implausible { parameter, correction } => implausible(f, *parameter, *correction),
            Warning::FarFromDrawing { parameter, correction, standard_uncertainty } => {
                far_from_drawing(f, *parameter, *correction, *standard_uncertainty)
            }
            Warning::TipElsewhere { calibrated, of_rod } => tip_elsewhere(f, calibrated, of_rod),
            Warning::ValidationMoved { before, after } => validation_moved(f, *before, *after),
            Warning::Extrapolation { ratio, joints } => extrapolation(f, *ratio, joints),
            Warning::WorseThanNominal { before, after } => worse_than_nominal(f, *before, *after),
            Warning::ValidationFar { there, here } => validation_far(f, *there, *here),
            Warning::ValidationNotConverged => {
                f.write_str("the fit of base and tool to the validation poses did not converge")
            }
        }
    }
}

fn not_plausible(f: &mut fmt::Formatter<'_>, rms: f64, reach: f64) -> fmt::Result {
    write!(
        f,
        "THE FIT IS NOT PLAUSIBLE: {} mm rms are left, {} % of the arm's reach, and no robot's error \
         is more than {} %: do not use these numbers; check the signs, order and zeros of the joints, \
         the units, the frames, and whether angles and positions of a row belong together",
        significant(rms / MM, 3),
        significant(100.0 * rms / reach, 2),
        100.0 * MOST_SCATTER
    )
}

fn rod_laws(f: &mut fmt::Formatter<'_>, most: f64, beyond: &[String]) -> fmt::Result {
    write!(
        f,
        "the laws of the rod's file are part of its deflection here, up to {} µm, under contact force and weight",
        significant(most / UM, 2)
    )?;
    match beyond {
        [] => Ok(()),
        beyond => write!(f, "; beyond what was recorded: {}", beyond.join("; ")),
    }
}

fn no_masses(f: &mut fmt::Formatter<'_>, has_effects: bool) -> fmt::Result {
    f.write_str(
        "the robot's file has no masses, so the torques on its joints are unknown: joint compliances are off",
    )?;
    match has_effects {
        true => f.write_str(", and its effects that follow a load know rod and contact force only"),
        false => Ok(()),
    }
}

fn not_identified(
    f: &mut fmt::Formatter<'_>,
    combination: &[(Parameter, f64)],
    relative_error: f64,
) -> fmt::Result {
    let names: Vec<String> =
        combination.iter().map(|(parameter, c)| format!("{c:+.2}·{parameter}")).collect();
    write!(f, "these poses do not identify the combination {} ", names.join(" "))?;
    match relative_error.is_finite() && relative_error < 1e6 {
        true => write!(
            f,
            "(each in its plausible range; the data determine it to {} ranges only)",
            significant(relative_error, 2)
        )?,
        false => write!(f, "(each in its plausible range; the data do not determine it)")?,
    }
    f.write_str(": it is held at its nominal value; more varied poses would identify it")
}

fn many_not_identified(
    f: &mut fmt::Formatter<'_>,
    combinations: usize,
    parameters: &[Parameter],
) -> fmt::Result {
    let names: Vec<String> = parameters.iter().map(ToString::to_string).collect();
    write!(
        f,
        "these poses do not identify {combinations} combinations of the parameters {}: \
         they are held at their nominal values; more varied poses would identify them",
        names.join(", ")
    )
}

fn outliers(f: &mut fmt::Formatter<'_>, poses: &[(String, f64)], count_in_full: bool) -> fmt::Result {
    let (shown, more) = (poses.iter().take(5), poses.len().saturating_sub(5));
    let length = |d: f64| match d < MM {
        true => format!("{} µm", significant(d / UM, 2)),
        false => format!("{} mm", significant(d / MM, 2)),
    };
    let names: Vec<String> = shown.map(|(name, d)| format!("{name} ({})", length(*d))).collect();
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    let (noun, verb) = if poses.len() == 1 { ("pose", "lies") } else { ("poses", "lie") };
    write!(f, "{noun} {}{more} {verb} farther out than noise explains", names.join(", "))?;
    match count_in_full {
        true => f.write_str(": check them, or reduce their weight with --robust huber"),
        false => f.write_str(" and were given less weight"),
    }
}

fn unequal_noise(
    f: &mut fmt::Formatter<'_>,
    [quietest, noisiest]: [&(String, f64); 2],
    p_value: f64,
) -> fmt::Result {
    write!(
        f,
        "the groups scatter unequally, from {} µm ({}) to {} µm ({}) per coordinate (Bartlett \
         p = {}): each is weighted by its own scatter",
        significant(quietest.1 / UM, 3),
        quietest.0,
        significant(noisiest.1 / UM, 3),
        noisiest.0,
        significant(p_value, 1)
    )
}

fn implausible(f: &mut fmt::Formatter<'_>, parameter: Parameter, correction: f64) -> fmt::Result {
    write!(
        f,
        "{parameter} is corrected by {} {}, more than manufacturing errors explain: are the \
         angles' signs and zeros those of the robot's file?",
        significant(correction / parameter.unit().si, 3),
        parameter.unit().symbol
    )
}

fn far_from_drawing(
    f: &mut fmt::Formatter<'_>,
    parameter: Parameter,
    correction: f64,
    standard_uncertainty: f64,
) -> fmt::Result {
    let unit = parameter.unit();
    write!(
        f,
        "{parameter} is {} {} from the robot file, {} times the standard uncertainty that the file has for it: \
         is a zero, a length or the file itself another one?",
        significant(correction / unit.si, 3),
        unit.symbol,
        significant((correction / standard_uncertainty).abs(), 2)
    )
}

fn tip_elsewhere(
    f: &mut fmt::Formatter<'_>,
    calibrated: &Vector3<f64>,
    of_rod: &Vector3<f64>,
) -> fmt::Result {
    let in_words = |tip: &Vector3<f64>| {
        let [x, y, z] = [0, 1, 2].map(|k| format!("{:.1}", tip[k] / MM));
        format!("[{x}, {y}, {z}] mm")
    };
    write!(
        f,
        "the tip is at {} of {{T}}, {} mm from where the rod's file has it ({}): is that the file of \
         this rod, and is the rod mounted as the file has it? Deflections are those of the file",
        in_words(calibrated),
        significant((calibrated - of_rod).norm() / MM, 3),
        in_words(of_rod)
    )
}

fn validation_moved(f: &mut fmt::Formatter<'_>, before: f64, after: f64) -> fmt::Result {
    write!(
        f,
        "the validation poses are {} µm rms off, but {} µm after one rigid motion of all of them: \
         tracker or base stood elsewhere, the robot is not that wrong; name the places in a column \
         station, or leave out validation_refit = \"none\"",
        significant(before / UM, 3),
        significant(after / UM, 3)
    )
}

fn validation_far(f: &mut fmt::Formatter<'_>, there: f64, here: f64) -> fmt::Result {
    write!(
        f,
        "the validation poses are {} mm off on average, those of the calibration {} mm: something is wrong \
         in their file, or happened while they were recorded, or the robot is known at the others only; \
         rodcal diagnose calibration looks into it",
        significant(there / MM, 3),
        significant(here / MM, 3)
    )
}

fn extrapolation(f: &mut fmt::Formatter<'_>, ratio: f64, joints: &[(usize, String)]) -> fmt::Result {
    f.write_str("the validation asks for poses that the calibration has not seen")?;
    let named: Vec<String> =
        joints.iter().map(|(joint, ranges)| format!("joint {} {ranges}", joint + 1)).collect();
    if !named.is_empty() {
        write!(f, " ({})", named.join(", "))?;
    }
    write!(
        f,
        ": there the robot's own numbers make a tip {} times as uncertain as at the calibrated poses",
        significant(ratio, 2)
    )
}

fn worse_than_nominal(f: &mut fmt::Formatter<'_>, before: f64, after: f64) -> fmt::Result {
    write!(
        f,
        "the calibrated robot predicts the validation worse than the nominal one: {} mm on average \
         after, {} mm before: do not use it before it is known why; were the joints' zeros the same in \
         both recordings?",
        significant(after / MM, 3),
        significant(before / MM, 3)
    )
}
