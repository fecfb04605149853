//! What is said of a clamp that stands elsewhere, or is turned.

use super::super::Mended;
use super::super::draft::DraftChange;
use super::super::motion::{motion_estimates, moved};
use super::super::moves::exact;
use super::super::search::fixtures::Meaning;
use super::super::search::{FittedDraft, MistakeSearch};
use super::super::typed::tidy;
use crate::diagnosis::calibration::effects::mistakes::{FRAME_MISTAKE, TYPING_MISTAKE};
use crate::inference::Location;
use crate::spatial::Pose;
use crate::units::{DEG, MM, significant};

impl Mended {
    /// A clamp that stands elsewhere, or is turned.
    pub(in super::super) fn add_fixture(
        &mut self,
        search: &MistakeSearch,
        best: &FittedDraft,
        change: &DraftChange,
        log_odds: f64,
    ) {
        let Some(Meaning { clamp, frame, typed }) = search.meaning(best, change) else { return };
        let stated = search.draft.devices[clamp];
        let name = &self.campaign.measurements.groups[clamp].name;
        let is_place = matches!(change, DraftChange::Placed(_));
        // each number as people call it, and with its unit
        let (key, labels) = match is_place {
            true => ("xyz_mm", [("x", "x_mm"), ("y", "y_mm"), ("z", "z_mm")]),
            false => ("rpy_deg", [("roll", "roll_deg"), ("pitch", "pitch_deg"), ("yaw", "yaw_deg")]),
        };
        let numbers = |pose: &Pose| match is_place {
            true => [0, 1, 2].map(|axis| pose.origin[axis] / MM),
            false => pose.roll_pitch_yaw().map(|angle| angle / DEG),
        };
        let location = Location::key(format!("{name} {key}"));
        if let Some((axis, meant)) = typed {
            let (old, new, why) = (tidy(numbers(&stated)[axis]), tidy(meant.value()), meant.why);
            let (label, with_unit) = labels[axis];
            let cure = format!("Write {new} for {old} as {label} in {key} of {name}");
            let estimates = exact(with_unit, numbers(&frame)[axis]);
            self.add(&TYPING_MISTAKE, location, estimates, (&cure, why), log_odds);
            return;
        }
        let [first, second, third] = numbers(&frame).map(|number| significant(number, 5));
        let cure = format!("Write {key} = [{first}, {second}, {third}] for {name}");
        let (way, angle) = moved(&stated, &frame);
        let why = match is_place {
            true => format!("it stands {} mm from where the campaign says", significant(way / MM, 3)),
            false => {
                format!("it is turned by {}° against what the campaign says", significant(angle / DEG, 3))
            }
        };
        self.add(&FRAME_MISTAKE, location, motion_estimates(&stated, &frame), (&cure, &why), log_odds);
    }
}
