//! What `rodcal predict` says: tips in the base frame, with their uncertainty, and where the model
//! extrapolates.
//!
//! ```text
//! variance of a tip         sd² + diag J·Σ·Jᵀ             sd: error of held-out poses, Σ: covariance of the parameters
//!                           and, where a joint is beyond its calibrated range, (∂tip/∂q·rms of its effects)²
//! after an alignment        J′ = (1 − B·B⁺)·J             B: base and tool over all poses asked for, fitted anew
//! ratio                     √tr(J·Σ·Jᵀ) here over its root mean square at the calibration's poses, J of the robot's own
//!                           parameters
//! ```

#[cfg(test)]
mod tests;

use nalgebra::{DMatrix, Matrix3xX, Vector3};
use serde_json::{Value, json};

use super::chart::Figure;
use super::length::length;
use super::method;
use super::pictures::calibration::{PoseError, uncertainty_over_workspace};
use super::table::{Column, Table};
use super::{Block, Card, Report, Section, Tone};
use crate::error::Error;
use crate::linalg::{thin_svd, transposed_product};
use crate::parallel::in_parallel;
use crate::robot::{Motion, PredictionQuery, Robot};
use crate::units::{DEG, MM, UM, significant};

/// A pose whose own parameters make it so many times more uncertain than the calibration's poses
/// extrapolates.
const FAR: f64 = 2.0;
/// Fewer poses are fitted by nine numbers alone.
const FEWEST: usize = 6;
/// A joint beyond its calibrated range by this share of it extrapolates.
const BEYOND: f64 = 0.1;

/// A joint beyond its calibrated range: number from 0, range asked for, range calibrated, rad or m.
pub type JointBeyond = (usize, (f64, f64), (f64, f64));

/// Tips of poses.
#[derive(Debug, Clone)]
pub struct Prediction {
    /// The tool, m in {T}.
    pub tool: Vector3<f64>,
    /// Whether base and tool are aligned anew to these poses.
    pub is_aligned: bool,
    /// Poses with their tips in {0}, m, and the standard deviations of their coordinates where the
    /// model knows them.
    pub tips: Vec<(PredictionQuery, Vector3<f64>, Option<Vector3<f64>>)>,
    /// How many times more uncertain than at the calibration's poses each one is by the robot's own
    /// parameters; `None` where the model does not say.
    pub ratios: Option<Vec<f64>>,
    /// Joints beyond their calibrated ranges: number from 0, range asked for, range calibrated (rad
    /// or m).
    pub beyond: Vec<JointBeyond>,
    /// Laws of the model beyond what was recorded: number, and from where to where their variable
    /// goes there, in its unit.
    pub laws_beyond: Vec<(usize, (f64, f64))>,
}

impl Prediction {
    /// Of poses.
    ///
    /// # Errors
    /// [`Error::NotApplicable`] for an alignment to fewer than six poses.
    pub fn new(
        robot: &Robot,
        tool: Vector3<f64>,
        poses: Vec<PredictionQuery>,
        is_aligned: bool,
    ) -> crate::Result<Self> {
        if is_aligned && poses.len() < FEWEST {
            return Err(Error::NotApplicable {
                what: "an alignment".into(),
                why: format!("there are {} poses for the nine numbers of base and tool", poses.len()),
                hint: format!(
                    "give the poses that are aligned to, {FEWEST} at least, or leave out --aligned"
                ),
            });
        }
        // an alignment is of all poses together; else each stands for itself
        let size = if is_aligned { poses.len() } else { BLOCK };
        let blocks: Vec<&[PredictionQuery]> = poses.chunks(size.max(1)).collect();
        let each = in_parallel(blocks.len(), |k| tips_of(robot, tool, blocks[k], is_aligned));
        let (mut tips, mut ratios) = (Vec::with_capacity(poses.len()), Some(Vec::new()));
        let mut of_laws = Vec::new();
        for block in each {
            let (of_block, ratios_of_block, laws_of_block) = block?;
            tips.extend(of_block);
            of_laws.extend(laws_of_block);
            ratios = ratios.zip(ratios_of_block).map(|(mut all, own): (Vec<f64>, Vec<f64>)| {
                all.extend(own);
                all
            });
        }
        let beyond = beyond(robot, &poses);
        let tips = poses.into_iter().zip(tips).map(|(query, (tip, sd))| (query, tip, sd)).collect();
        let laws_beyond = (0..robot.laws.len()).filter_map(|law| Some((law, ends(&of_laws, law)?))).collect();
        Ok(Prediction { tool, is_aligned, tips, ratios, beyond, laws_beyond })
    }

    /// The root mean square of the ratios.
    pub fn ratio(&self) -> Option<f64> {
        let ratios = self.ratios.as_ref()?;
        Some((ratios.iter().map(|ratio| ratio * ratio).sum::<f64>() / ratios.len().max(1) as f64).sqrt())
    }

    /// How many poses extrapolate.
    pub fn far(&self) -> usize {
        self.ratios.iter().flatten().filter(|ratio| **ratio > FAR).count()
    }
}

/// So many poses are looked at together: some megabytes.
const BLOCK: usize = 4096;

/// Tips with their standard deviations, how many times more uncertain they are than where the
/// robot was calibrated, and laws that are beyond what was recorded.
type Tips = (Vec<(Vector3<f64>, Option<Vector3<f64>>)>, Option<Vec<f64>>, Vec<(usize, f64)>);

/// From where to where a law's variable goes.
fn ends(of_laws: &[(usize, f64)], law: usize) -> Option<(f64, f64)> {
    let own = of_laws.iter().filter(|(own, _)| *own == law).map(|&(_, x)| (x, x));
    own.reduce(|(low, high), (x, _)| (low.min(x), high.max(x)))
}

fn tips_of(
    robot: &Robot,
    tool: Vector3<f64>,
    poses: &[PredictionQuery],
    is_aligned: bool,
) -> crate::Result<Tips> {
    let predicted: Vec<_> = poses.iter().map(|query| robot.predicted_at(tool, &query.joints)).collect();
    let slopes: Option<Vec<&Matrix3xX<f64>>> =
        predicted.iter().map(|predicted| predicted.slopes.as_ref()).collect();
    let own = slopes.zip(robot.uncertainty.as_ref());
    let rows = 3 * predicted.len();
    let mut ratios = None;
    let of_laws = robot.law_covariance();
    let mut jacobian = DMatrix::zeros(rows, of_laws.nrows());
    for (row, predicted) in predicted.iter().enumerate() {
        jacobian.rows_mut(3 * row, 3).copy_from(&predicted.law_slopes);
    }
    // of nothing to align there is nothing to take out
    let mut taken_up = DMatrix::zeros(rows, 0);
    if is_aligned {
        let mut placement = DMatrix::zeros(rows, 9);
        for (row, predicted) in predicted.iter().enumerate() {
            placement.rows_mut(3 * row, 3).copy_from(&predicted.placement);
        }
        let svd = thin_svd(&placement)?;
        taken_up = svd.u.columns(0, svd.rank(1e-9)).into_owned();
    }
    let aligned = |jacobian: DMatrix<f64>| &jacobian - &taken_up * transposed_product(&taken_up, &jacobian);
    let mut variance = variances(&aligned(jacobian), &of_laws);
    if let Some((slopes, known)) = own {
        let mut jacobian = DMatrix::zeros(rows, known.parameters.len());
        for (row, slopes) in slopes.iter().enumerate() {
            jacobian.rows_mut(3 * row, 3).copy_from(*slopes);
        }
        let of_robot: Vec<usize> =
            (0..known.parameters.len()).filter(|&k| !known.parameters[k].is_placement()).collect();
        let covariance = known.covariance.select_rows(&of_robot).select_columns(&of_robot);
        let by_row = variances(&jacobian.select_columns(&of_robot), &covariance);
        let at_ease = robot.calibrated.as_ref().map(|range| range.sd).filter(|sd| *sd > 0.0);
        ratios = at_ease.map(|sd| by_row.iter().map(|own| own.sum().sqrt() / sd).collect());
        let of_parameters = variances(&aligned(jacobian), &known.covariance);
        variance.iter_mut().zip(of_parameters).for_each(|(sum, own)| *sum += own);
    }
    // a gear is known where it was seen turn
    let sizes = robot.effect_sizes();
    for ((query, predicted), variance) in poses.iter().zip(&predicted).zip(&mut variance) {
        for (joint, range) in robot.calibrated.iter().flat_map(|known| known.joints.iter().enumerate()) {
            if !(range.0..=range.1).contains(&query.joints[joint]) {
                *variance += predicted.joints.column(joint).map(|lever| (lever * sizes[joint]).powi(2));
            }
        }
    }
    let sd = robot.tip.and_then(|tip| tip.sd);
    let with_noise = |own: &Vector3<f64>| sd.map(|sd| own.map(|own| (sd * sd + own).sqrt()));
    let tips =
        predicted.iter().zip(&variance).map(|(predicted, own)| (predicted.tip, with_noise(own))).collect();
    let laws = predicted.iter().flat_map(|predicted| predicted.laws_beyond.iter().copied()).collect();
    Ok((tips, ratios, laws))
}

/// diag J·Σ·Jᵀ, three by three.
fn variances(jacobian: &DMatrix<f64>, covariance: &DMatrix<f64>) -> Vec<Vector3<f64>> {
    let spread = jacobian * covariance;
    let of_row = |row: usize| spread.row(row).dot(&jacobian.row(row)).max(0.0);
    (0..jacobian.nrows() / 3)
        .map(|k| Vector3::new(of_row(3 * k), of_row(3 * k + 1), of_row(3 * k + 2)))
        .collect()
}

fn beyond(robot: &Robot, poses: &[PredictionQuery]) -> Vec<JointBeyond> {
    let Some(calibrated) = &robot.calibrated else { return Vec::new() };
    let asked = |joint: usize| {
        let values = poses.iter().map(|pose| pose.joints[joint]);
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), q| (a.min(q), b.max(q)))
    };
    let all = calibrated.joints.iter().enumerate().map(|(joint, own)| (joint, asked(joint), *own));
    all.filter(|(_, asked, own)| {
        let margin = BEYOND * (own.1 - own.0);
        asked.0 < own.0 - margin || asked.1 > own.1 + margin
    })
    .collect()
}

/// A pose in the JSON of `rodcal predict --json`.
pub fn pose_json(prediction: &Prediction, row: usize) -> Value {
    let (query, tip, sd) = &prediction.tips[row];
    json!({
        "pose": query.pose,
        "x_mm": tip.x / MM,
        "y_mm": tip.y / MM,
        "z_mm": tip.z / MM,
        "sd_mm": sd.map(|sd| <[f64; 3]>::from(sd / MM)),
        "ratio": prediction.ratios.as_ref().map(|ratios| ratios[row]),
    })
}

/// The JSON of `rodcal predict --json`, all but the poses ([`pose_json`]).
pub fn json(robot: &Robot, prediction: &Prediction) -> Value {
    let beyond = prediction.beyond.iter().map(|&(joint, asked, own)| {
        let unit = unit(robot, joint).1;
        json!({
            "joint": joint + 1,
            "asked": [asked.0 / unit, asked.1 / unit],
            "calibrated": [own.0 / unit, own.1 / unit],
        })
    });
    let laws = prediction.laws_beyond.iter().map(|&(law, asked)| {
        let law = &robot.laws[law];
        json!({
            "place": law.place.to_string(),
            "variable": law.variable.to_string(),
            "unit": law.variable.unit().0,
            "asked_beyond": [asked.0, asked.1],
            "recorded": [law.range.0, law.range.1],
        })
    });
    json!({
        "robot": robot.name,
        "tool_mm": (prediction.tool / MM).as_slice(),
        "aligned": prediction.is_aligned,
        "extrapolation": {
            "ratio": prediction.ratio(),
            "poses": prediction.far(),
            "joints_beyond": beyond.collect::<Vec<_>>(),
            "laws_beyond": laws.collect::<Vec<_>>(),
        },
        "poses": Value::Null,
    })
}

/// Sign and size of a joint's unit.
fn unit(robot: &Robot, joint: usize) -> (&'static str, f64) {
    match robot.joints[joint].motion {
        Motion::Revolute => ("°", DEG),
        Motion::Prismatic => (" mm", MM),
    }
}

/// Where the model says nothing from experience.
fn warnings(robot: &Robot, prediction: &Prediction) -> Vec<String> {
    let mut warnings = Vec::new();
    for &(joint, asked, own) in &prediction.beyond {
        let (sign, unit) = unit(robot, joint);
        let at = |value: f64| format!("{}{sign}", significant(value / unit, 3));
        warnings.push(format!(
            "Extrapolation: joint {} goes from {} to {}; it was calibrated from {} to {}.",
            joint + 1,
            at(asked.0),
            at(asked.1),
            at(own.0),
            at(own.1)
        ));
    }
    for &(law, asked) in &prediction.laws_beyond {
        let law = &robot.laws[law];
        let at = |value: f64| significant(value, 3);
        warnings.push(format!(
            "Extrapolation: the law of the {} was recorded with the {} from {} to {} {unit}; some poses are beyond, from {} to {} {unit}.",
            law.place.changes(law.per_joint),
            law.variable,
            at(law.range.0),
            at(law.range.1),
            at(asked.0),
            at(asked.1),
            unit = law.variable.unit().0
        ));
    }
    let far = prediction.far();
    if let (true, Some(ratio)) = (far > 0, prediction.ratio()) {
        warnings.push(format!(
            "Extrapolation: at {far} of {} poses the parameters of the robot are more than {FAR} times as uncertain as \
             where it was calibrated ({} times over all poses).",
            prediction.tips.len(),
            significant(ratio, 2)
        ));
    }
    warnings
}

/// How many poses, how well they are known at worst, and how far the model is asked beyond what it
/// has seen.
fn cards(robot: &Robot, prediction: &Prediction, most: Option<f64>) -> Vec<Card> {
    let count = prediction.tips.len();
    let mut cards = vec![Card::new("Poses", count.to_string(), format!("of {}", robot.name))];
    cards.push(match most {
        Some(sd) => Card::new("Largest standard deviation", length(sd), "of one coordinate of the tip"),
        None => Card::new("Uncertainty", "not stated", "the model holds none").toned(Tone::Attention),
    });
    if prediction.ratios.is_some() {
        let far = prediction.far();
        let tone = if far == 0 && prediction.beyond.is_empty() { Tone::Good } else { Tone::Attention };
        let detail = match prediction.beyond.len() {
            0 => "all joints within their calibrated ranges".to_owned(),
            1 => "1 joint beyond its calibrated range".to_owned(),
            joints => format!("{joints} joints beyond their calibrated ranges"),
        };
        cards.push(Card::new("Poses that extrapolate", format!("{far} of {count}"), detail).toned(tone));
    }
    cards
}

/// Where in the workspace the tip is known how well; nothing where the model does not say.
fn picture(prediction: &Prediction) -> Option<Figure> {
    let known = prediction.tips.iter().filter_map(|(_, tip, sd)| {
        Some(PoseError { at_mm: (tip / MM).into(), error_mm: sd.as_ref()?.norm() / MM })
    });
    let poses: Vec<PoseError> = known.collect();
    (!poses.is_empty()).then(|| {
        let figure = uncertainty_over_workspace(&poses);
        let caption =
            format!("{} Root of the sum of the three variances, in the base frame.", figure.caption);
        figure.captioned(caption)
    })
}

/// The report of `rodcal predict`.
pub fn report(robot: &Robot, prediction: &Prediction) -> Report {
    let mut columns = vec![Column::text("pose")];
    columns.extend(["x", "y", "z"].map(|name| Column::number(name, "mm")));
    columns.extend(["sd x", "sd y", "sd z"].map(|name| Column::number(name, "µm")));
    if prediction.ratios.is_some() {
        columns.push(Column::number("ratio", ""));
    }
    let aligned = match prediction.is_aligned {
        true => " Base and tool are aligned anew to these poses.",
        false => "",
    };
    let caption = format!(
        "The tip in the base frame {{0}}. sd: standard deviation, from the error of held-out poses in the diagnosis (else \
         the scatter that the calibration left) and from the uncertainty of the calibration.{aligned} Ratio: how many times \
         as uncertain as at the poses of the calibration, by the robot's own parameters."
    );
    let mut table = Table::new("prediction", &caption, columns);
    for (row, (query, tip, sd)) in prediction.tips.iter().enumerate() {
        let mut cells = vec![query.pose.clone()];
        cells.extend(tip.iter().map(|x| format!("{:.4}", x / MM)));
        cells.extend((0..3).map(|axis| sd.map_or("–".into(), |sd| format!("{:.1}", sd[axis] / UM))));
        cells.extend(prediction.ratios.as_ref().map(|ratios| format!("{:.2}", ratios[row])));
        table.row(cells);
    }
    let most = prediction.tips.iter().filter_map(|(_, _, sd)| Some(sd.as_ref()?.amax())).reduce(f64::max);
    let known = match most {
        Some(sd) => format!(", each coordinate to {} or better (1 σ)", length(sd)),
        None => "; the model states no uncertainty".into(),
    };
    let tips = match prediction.tips.len() {
        1 => "1 tip".to_owned(),
        many => format!("{many} tips"),
    };
    Report {
        title: format!("Predicted tips of {}", robot.name),
        headline: format!("{}: {tips} predicted{known}.", robot.name),
        warnings: warnings(robot, prediction),
        cards: cards(robot, prediction, most),
        method: method::paragraphs(method::PREDICTION),
        sections: vec![Section::new(
            "Predicted tips",
            picture(prediction).into_iter().map(Block::Figure).chain([Block::Table(table)]).collect(),
        )],
        ..Report::default()
    }
}
