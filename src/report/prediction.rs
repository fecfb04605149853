//! What `rodcal predict` says: tips in the base frame, with their uncertainty.

use nalgebra::Vector3;
use serde_json::{Value, json};

use super::table::{Column, Table};
use super::{Block, Report, Section};
use crate::robot::{PredictionQuery, Robot};
use crate::units::MM;

/// Tips of poses.
#[derive(Debug, Clone)]
pub struct Prediction {
    /// The tool, m in {T}.
    pub tool: Vector3<f64>,
    /// Poses with their tips in {0}, m, and the standard deviations of their coordinates where the
    /// model knows them.
    pub tips: Vec<(PredictionQuery, Vector3<f64>, Option<Vector3<f64>>)>,
}

impl Prediction {
    /// Of poses.
    pub fn new(robot: &Robot, tool: Vector3<f64>, poses: Vec<PredictionQuery>) -> Self {
        let predicted = |query: PredictionQuery| {
            let (tip, sd) = robot.tip_at(tool, &query.joints);
            (query, tip, sd)
        };
        Prediction { tool, tips: poses.into_iter().map(predicted).collect() }
    }
}

/// The JSON of `rodcal predict --json`.
pub fn json(robot: &Robot, prediction: &Prediction) -> Value {
    let poses = prediction.tips.iter().map(|(query, tip, sd)| {
        json!({
            "pose": query.pose,
            "x_mm": tip.x / MM,
            "y_mm": tip.y / MM,
            "z_mm": tip.z / MM,
            "sd_mm": sd.map(|sd| <[f64; 3]>::from(sd / MM)),
        })
    });
    json!({
        "robot": robot.name,
        "tool_mm": (prediction.tool / MM).as_slice(),
        "poses": poses.collect::<Vec<_>>(),
    })
}

/// The report of `rodcal predict`.
pub fn report(robot: &Robot, prediction: &Prediction) -> Report {
    let mut columns = vec![Column::text("pose")];
    columns.extend(["x", "y", "z", "sd x", "sd y", "sd z"].map(|name| Column::number(name, "mm")));
    let caption = "The tip in the base frame {0}. sd: standard deviation, from the error of held-out \
                   poses in the diagnosis and from the uncertainty of the calibration.";
    let mut table = Table::new("prediction", caption, columns);
    for (query, tip, sd) in &prediction.tips {
        let mut cells = vec![query.pose.clone()];
        cells.extend(tip.iter().map(|x| format!("{:.4}", x / MM)));
        cells.extend((0..3).map(|axis| sd.map_or("–".into(), |sd| format!("{:.4}", sd[axis] / MM))));
        table.row(cells);
    }
    let most = prediction.tips.iter().filter_map(|(_, _, sd)| Some(sd.as_ref()?.amax())).reduce(f64::max);
    let known = match most {
        Some(sd) => format!(", each coordinate to {:.3} mm or better (1 σ)", sd / MM),
        None => "; the model states no uncertainty".into(),
    };
    let tips = match prediction.tips.len() {
        1 => "1 tip".to_owned(),
        many => format!("{many} tips"),
    };
    Report {
        title: format!("Predicted tips of {}", robot.name),
        headline: format!("{}: {tips} predicted{known}.", robot.name),
        warnings: Vec::new(),
        sections: vec![Section::new("Predicted tips", vec![Block::Table(table)])],
        provenance: Vec::new(),
    }
}
