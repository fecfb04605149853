//! What may be wrong with the measured positions: units, axes, and the rows that they stand in.

use nalgebra::Matrix3;

use super::super::super::effects::mistakes::{ROW_MISTAKE, SIGN_MISTAKE, SWAP_MISTAKE, UNIT_MISTAKE};
use super::super::draft::DraftChange;
use super::super::names::AXES;
use super::{List, RARE, UNUSUAL, exact};
use crate::inference::Key;
use crate::statistics::median;
use crate::units::MM;

/// Farthest displacement of rows that is tried.
const FARTHEST_ROW: isize = 3;
/// A ball in a clamp is displaced by less, m: by larger numbers it may be that they are in a
/// smaller unit.
const DISPLACEMENT: f64 = 10.0 * MM;
/// A thousandth of an inch, mm.
const MIL: f64 = 0.0254;

impl List<'_> {
    pub(super) fn positions(&mut self) {
        if self.draft.has_sockets() {
            return;
        }
        const ALL: &str = "x_mm, y_mm, z_mm";
        // in clamps smaller numbers are nearer to any robot that was sent there
        let is_clamped = self.campaign.measurements.groups.iter().any(|group| !group.name.is_tracked());
        let sizes: Vec<f64> = self.draft.seen.iter().map(|seen| seen.norm()).collect();
        let is_far = !is_clamped || median(&sizes).is_some_and(|size| size > DISPLACEMENT);
        for (factor, unit, log_prior) in [
            (1e3, "metres", 0.0),
            (25.4, "inches", 0.0),
            (10.0, "centimetres", UNUSUAL),
            (1e-3, "micrometres", UNUSUAL),
            (0.1, "tenths of a millimetre", RARE),
            (MIL, "thousandths of an inch (mil)", UNUSUAL),
        ] {
            if factor < 1.0 && !is_far && !self.is_of_rows {
                continue;
            }
            let by = times(ALL, factor);
            let change = DraftChange::Seen(Matrix3::identity() * factor);
            let unit = self.add(
                &UNIT_MISTAKE,
                Key::new(ALL),
                change,
                &by,
                &format!("they are in {unit}, not in millimetres"),
            );
            (unit.estimates, unit.log_prior) = (exact("factor", factor), log_prior);
        }
        self.single_units(is_clamped);
        let names = AXES;
        for order in [[0, 1, 2], [1, 0, 2], [0, 2, 1], [2, 1, 0], [1, 2, 0], [2, 0, 1]] {
            for signs in 0..8u8 {
                let sign = [0, 1, 2].map(|axis| if signs >> axis & 1 == 1 { -1.0 } else { 1.0 });
                let flipped: Vec<&str> =
                    (0..3).filter(|&axis| sign[axis] < 0.0).map(|axis| names[axis]).collect();
                let mut matrix = Matrix3::zeros();
                (0..3).for_each(|axis| matrix[(axis, order[axis])] = sign[axis]);
                if matrix == Matrix3::identity() {
                    continue;
                }
                let moved: Vec<usize> = (0..3).filter(|&axis| order[axis] != axis).collect();
                let is_swap = moved.len() == 2;
                let (effect, place, cure, why, log_prior) = match (moved.len(), flipped.len()) {
                    (0, 1) => {
                        let name = flipped[0].to_owned();
                        let cure = format!("Multiply {name} by −1");
                        (&SIGN_MISTAKE, name, cure, "the axis of the device points the other way", 0.0)
                    }
                    (0, _) => {
                        let place = flipped.join(", ");
                        let cure = format!("Multiply {place} by −1");
                        (&SIGN_MISTAKE, place, cure, "axes of the device point the other way", UNUSUAL)
                    }
                    (_, 0) if is_swap => {
                        let place = format!("{} and {}", names[moved[0]], names[moved[1]]);
                        let cure = format!("Exchange {place}");
                        (&SWAP_MISTAKE, place, cure, "axes of the device are exchanged", 0.0)
                    }
                    _ => {
                        let term = |axis: usize| {
                            format!("{}{}", if sign[axis] < 0.0 { "−" } else { "" }, names[order[axis]])
                        };
                        let cure = format!("Replace {ALL} by {}, {}, {}", term(0), term(1), term(2));
                        (
                            &SWAP_MISTAKE,
                            ALL.to_owned(),
                            cure,
                            "the device is turned",
                            UNUSUAL + if is_swap { 0.0 } else { -0.5 },
                        )
                    }
                };
                self.add(effect, Key::new(place), DraftChange::Seen(matrix), &cure, why).log_prior =
                    log_prior;
            }
        }
    }

    /// A single column of a measured point in another unit.
    fn single_units(&mut self, is_clamped: bool) {
        for (axis, name) in AXES.into_iter().enumerate() {
            let sizes: Vec<f64> = self.draft.seen.iter().map(|seen| seen[axis].abs()).collect();
            for (factor, unit) in [
                (1e3, "metres"),
                (25.4, "inches"),
                (10.0, "centimetres"),
                (1e-3, "micrometres"),
                (MIL, "thousandths of an inch (mil)"),
            ] {
                let is_far = || median(&sizes).is_some_and(|size| size > DISPLACEMENT);
                if factor < 1.0 && is_clamped && !self.is_of_rows && !is_far() {
                    continue;
                }
                let mut matrix = Matrix3::identity();
                matrix[(axis, axis)] = factor;
                let by = times(name, factor);
                let why = format!("it is in {unit}, not in millimetres");
                let unit = self.add(&UNIT_MISTAKE, Key::new(name), DraftChange::Seen(matrix), &by, &why);
                (unit.estimates, unit.log_prior) = (exact("factor", factor), UNUSUAL);
            }
        }
    }

    pub(super) fn rows(&mut self) {
        if self.draft.has_sockets() {
            return;
        }
        let has_clamps = self.draft.devices.len() > 1;
        for by in (-FARTHEST_ROW..=FARTHEST_ROW).filter(|by| *by != 0) {
            for with_clamps in [false, true].into_iter().filter(|with| has_clamps || !with) {
                let (count, way) = (by.unsigned_abs(), if by > 0 { "up" } else { "down" });
                let rows = if count == 1 { "row" } else { "rows" };
                let what = if with_clamps { "clamp, x_mm, y_mm and z_mm" } else { "x_mm, y_mm and z_mm" };
                let cure = format!("Move {what} {count} {rows} {way}");
                let why = format!(
                    "each position belongs to the angles {count} {rows} {}",
                    if by > 0 { "above" } else { "below" }
                );
                let change = DraftChange::Rows { by, with_clamps };
                let place = if with_clamps { "clamp, x_mm, y_mm, z_mm" } else { "x_mm, y_mm, z_mm" };
                let shift = self.add(&ROW_MISTAKE, Key::new(place), change, &cure, &why);
                shift.estimates = exact("rows", by as f64);
                shift.log_prior =
                    if count == 1 { 0.0 } else { UNUSUAL } + if with_clamps { UNUSUAL } else { 0.0 };
            }
        }
        // a few rows say nothing of the order of all
        let whole = if self.is_of_rows { 0..0 } else { 0..1 + usize::from(has_clamps) };
        for with_clamps in whole.map(|with| with == 1) {
            let what = if with_clamps { "clamp, x_mm, y_mm and z_mm" } else { "x_mm, y_mm and z_mm" };
            let place = if with_clamps { "clamp, x_mm, y_mm, z_mm" } else { "x_mm, y_mm, z_mm" };
            let cure = format!("Turn the order of the rows of {what} round");
            let why = "the first position belongs to the last angles";
            let change = DraftChange::Reversed { with_clamps };
            self.add(&ROW_MISTAKE, Key::new(place), change, &cure, why).log_prior = UNUSUAL;
        }
    }
}

/// What to do with columns that are to be multiplied.
fn times(columns: &str, factor: f64) -> String {
    let inverse = 1.0 / factor;
    match factor < 1.0 && inverse.fract() == 0.0 {
        true => format!("Divide {columns} by {inverse}"),
        false => format!("Multiply {columns} by {factor}"),
    }
}
