//! What is structured and no effect explains: where, how much, its shape.

use serde_json::{Value, json};

use crate::inference::Variable;
use crate::report::table::{Column, Table};
use crate::units::{UM, significant};

/// The remainder as it is reported.
#[derive(Debug, Clone)]
pub struct Remainder {
    /// Where: the place of its curve, or the condition that is worst.
    pub location: String,
    /// Said as a sentence.
    pub sentence: String,
    /// Root mean square, m.
    pub rms: f64,
    /// What it follows.
    pub along: Variable,
    /// What a sample is of, in JSON and as the head of a column: `readings`, `row`.
    pub sample_of: &'static str,
    /// Heads of the columns of what is left: `left`, or x, y, z.
    pub coordinates: &'static [&'static str],
    /// Samples of the shape.
    pub samples: Vec<Sample>,
}

/// The shape at one place.
#[derive(Debug, Clone)]
pub struct Sample {
    /// Of which line, or of which pose.
    pub name: String,
    /// The same in JSON.
    pub json: Value,
    /// Value of the variable.
    pub value: f64,
    /// What is left, m.
    pub left: Vec<f64>,
}

impl Remainder {
    /// For JSON: words and samples.
    pub fn json(&self) -> Value {
        let sample = |sample: &Sample| {
            let um: Vec<f64> = sample.left.iter().map(|left| left / UM).collect();
            let um = if let [um] = um[..] { json!(um) } else { json!(um) };
            json!({ self.sample_of: sample.json, "value": sample.value, "um": um })
        };
        json!({
            "location": self.location,
            "rms_um": self.rms / UM,
            "shape": {
                "words": self.sentence,
                "along": self.along.to_string(),
                "unit": self.along.unit(),
                "samples": self.samples.iter().map(sample).collect::<Vec<_>>(),
            },
        })
    }

    /// As a table; `noun` is what was recorded.
    pub fn table(&self, noun: &str) -> Table {
        let head = if self.sample_of == "row" { "pose" } else { self.sample_of };
        let mut columns = vec![Column::text(head), Column::number(self.along.title(noun), self.along.unit())];
        columns.extend(self.coordinates.iter().map(|name| Column::number(*name, "µm")));
        let mut table = Table::new("remainder", "The shape of the unexplained error.", columns);
        for sample in &self.samples {
            let mut cells = vec![sample.name.clone(), significant(sample.value, 4)];
            cells.extend(sample.left.iter().map(|left| format!("{:.1}", left / UM)));
            table.row(cells);
        }
        table
    }
}
