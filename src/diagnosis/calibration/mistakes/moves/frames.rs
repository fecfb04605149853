//! What may be wrong with the frames of the campaign: clamps, base and tip.

use nalgebra::{Matrix3, Vector3};

use super::super::super::effects::mistakes::{FRAME_MISTAKE, SWAP_MISTAKE, UNIT_MISTAKE};
use super::super::draft::DraftChange;
use super::conventions::{Convention, SAME, is_same, readings};
use super::{List, UNUSUAL, exact};
use crate::calibration::campaign::GroupName;
use crate::inference::{Effect, Estimate, Key};
use crate::spatial::Pose;
use crate::units::significant;

/// Clamps are exchanged one by one where there are no more; with more there are too many pairs.
const MOST_CLAMPS: usize = 12;

impl List<'_> {
    /// Clamps or sockets that were named the other way round.
    pub(super) fn exchanged(&mut self) {
        let names: Vec<&GroupName> =
            self.campaign.measurements.groups.iter().map(|group| &group.name).collect();
        let count = names.len();
        if count > 1 && count <= MOST_CLAMPS {
            for (a, b) in (0..count).flat_map(|a| (a + 1..count).map(move |b| (a, b))) {
                // in the order of the campaign, whichever is met first
                let (a, b) = if names[a] > names[b] { (b, a) } else { (a, b) };
                let place = match (names[a], names[b]) {
                    (GroupName::Clamp(a), GroupName::Clamp(b)) => format!("clamps {a} and {b}"),
                    (a, b) => format!("sockets {a} and {b}"),
                };
                let cure = format!("Exchange {place}");
                let why = "each holds the poses of the other";
                self.add(&SWAP_MISTAKE, Key::new(place), DraftChange::Groups(a, b), &cure, why);
            }
        }
    }

    pub(super) fn clamps(&mut self) {
        self.exchanged();
        let names: Vec<&GroupName> =
            self.campaign.measurements.groups.iter().map(|group| &group.name).collect();
        let count = names.len();
        if self.draft.has_sockets() || names.iter().any(|name| name.is_tracked()) {
            return;
        }
        let devices = self.draft.devices.clone();
        let readings: Vec<Vec<(Matrix3<f64>, Convention)>> =
            devices.iter().map(|device| readings(device.roll_pitch_yaw(), &device.rotation)).collect();
        let of_clamp = |k: usize, rotation: Matrix3<f64>| (k, Pose { rotation, ..devices[k] });
        for k in 0..count {
            for (rotation, convention) in &readings[k] {
                let change = DraftChange::Devices(vec![of_clamp(k, *rotation)]);
                let place = format!("{} rpy_deg", names[k]);
                self.add(
                    &FRAME_MISTAKE,
                    Key::new(&place),
                    change,
                    &convention.cure(&place),
                    convention.why,
                )
                .log_prior = UNUSUAL;
            }
        }
        if count > 1 {
            let kinds: Vec<Convention> =
                readings.iter().flatten().map(|(_, convention)| *convention).collect();
            for (_, convention) in
                kinds.iter().enumerate().filter(|(k, convention)| !kinds[..*k].contains(convention))
            {
                let entry = |k: usize| {
                    let rotation =
                        readings[k].iter().find(|(_, own)| own == convention).map(|(rotation, _)| *rotation);
                    rotation.map(|rotation| of_clamp(k, rotation))
                };
                let change = DraftChange::Devices((0..count).filter_map(entry).collect());
                let place = Key::new("clamp rpy_deg (all)");
                self.add(
                    &FRAME_MISTAKE,
                    place,
                    change,
                    &convention.cure("rpy_deg of all clamps"),
                    convention.why,
                )
                .log_prior = UNUSUAL;
            }
        }
        for (factor, unit) in
            [(1e3, "metres"), (25.4, "inches"), (10.0, "centimetres"), (1e-3, "micrometres")]
        {
            let scaled =
                |(k, device): (usize, &Pose)| (k, Pose { origin: device.origin * factor, ..*device });
            let change = DraftChange::Devices(devices.iter().enumerate().map(scaled).collect());
            let cure = format!("Multiply xyz_mm of all clamps by {factor}");
            let why = format!("they are in {unit}, not in millimetres");
            let unit = self.add(&UNIT_MISTAKE, Key::new("clamp xyz_mm (all)"), change, &cure, &why);
            (unit.estimates, unit.log_prior) = (exact("factor", factor), UNUSUAL);
        }
    }

    pub(super) fn base(&mut self) {
        let Some(base) = self.draft.base else { return };
        let [_, _, _, roll, pitch, yaw] = self.campaign.base;
        let is_other = |pose: &Pose| !is_same(pose, &base);
        let inverse = base.inverse();
        if is_other(&inverse) {
            let cure = "Replace [base] by its inverse";
            let why = "it is {W} in {0}, not {0} in {W}";
            self.add(&FRAME_MISTAKE, Key::new("base"), DraftChange::Base(inverse), cure, why);
        }
        for (rotation, convention) in readings([roll, pitch, yaw], &base.rotation) {
            let turned = Pose { rotation, ..base };
            if is_other(&turned) {
                let cure = convention.cure("base.rpy_deg");
                self.add(
                    &FRAME_MISTAKE,
                    Key::new("base.rpy_deg"),
                    DraftChange::Base(turned),
                    &cure,
                    convention.why,
                );
            }
        }
        for (factor, unit) in [(1e3, "metres"), (25.4, "inches"), (1e-3, "micrometres")] {
            let scaled = Pose { origin: base.origin * factor, ..base };
            if is_other(&scaled) {
                let cure = format!("Multiply base.xyz_mm by {}", significant(factor, 4));
                let why = format!("it is in {unit}, not in millimetres");
                let place = Key::new("base.xyz_mm");
                self.add(&UNIT_MISTAKE, place, DraftChange::Base(scaled), &cure, &why).estimates =
                    exact("factor", factor);
            }
        }
    }

    pub(super) fn tool(&mut self) {
        let Some(tool) = self.draft.tool.filter(|tool| tool.norm() > SAME.1) else { return };
        let is_given = self.campaign.tool_is_given;
        let key = if is_given { "tool.xyz_mm" } else { "rod" };
        let mut known: Vec<Vector3<f64>> = vec![tool];
        let mut add = |tip: Vector3<f64>,
                       effect: &'static Effect,
                       cure: String,
                       why: &str,
                       estimates: Vec<Estimate>| {
            if known.iter().any(|known| (known - tip).norm() < SAME.1) {
                return;
            }
            known.push(tip);
            self.add(effect, Key::new(key), DraftChange::Tool(tip), &cure, why).estimates = estimates;
        };
        let letters = ["x", "y", "z"];
        for order in [[0, 1, 2], [1, 0, 2], [0, 2, 1], [2, 1, 0], [1, 2, 0], [2, 0, 1]] {
            for signs in 0..8u8 {
                let sign = [0, 1, 2].map(|axis| if signs >> axis & 1 == 1 { -1.0 } else { 1.0 });
                let tip = Vector3::from_fn(|axis, _| sign[axis] * tool[order[axis]]);
                let term = |axis: usize| {
                    format!("{}{}", if sign[axis] < 0.0 { "−" } else { "" }, letters[order[axis]])
                };
                let axes = [0, 1, 2].map(term).join(", ");
                let cure = match is_given {
                    true => format!("Replace tool.xyz_mm = [x, y, z] by [{axes}]"),
                    false => format!(
                        "Give the tip as [{axes}] of the rod's, with a [tool]: the rod is turned on the flange"
                    ),
                };
                add(tip, &FRAME_MISTAKE, cure, "it is given in another frame than {T}", Vec::new());
            }
        }
        for (factor, unit) in
            [(1e3, "it is in metres, not in millimetres"), (25.4, "it is in inches, not in millimetres")]
        {
            if is_given {
                let cure = format!("Multiply tool.xyz_mm by {factor}");
                add(tool * factor, &UNIT_MISTAKE, cure, unit, exact("factor", factor));
            }
        }
    }
}
