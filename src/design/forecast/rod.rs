//! What a mode of compensation gets wrong of the rod's deflection.
//!
//! The best that is known of the rod is its readings on the rig, else the beam model. A mode is
//! wrong by what it differs from that, and by what is not known of that: the standard error of
//! r_rod, or the standard uncertainties of the rod file.

use nalgebra::Vector3;

use crate::beam::Physics;
use crate::calibration::{Campaign, Compensation, Mode, Planned};
use crate::compliance::Compliance;
use crate::error::Result;
use crate::rig;

/// Standard uncertainty of r_rod where a rod is still to be measured.
const RIG: f64 = 0.01;
/// Exact enough for differences.
const ELEMENTS: usize = 20;

/// Compliances of a rod: by the mode, the best that is known, and what may be wrong with that.
pub(super) struct Loads {
    mode: Compensation,
    pub truth: Compensation,
    /// One standard deviation of each thing that is not known.
    unknown: Vec<Compliance>,
}

/// Deflection less what the mode takes it for, of every pose in {W}, m.
pub(super) struct Errors {
    pub bias: Vec<Vector3<f64>>,
    /// One standard deviation of each thing that is not known.
    pub unknown: Vec<Vec<Vector3<f64>>>,
}

impl Loads {
    pub fn new(campaign: &Campaign, mode: Mode) -> Result<Loads> {
        let Some(rod) = &campaign.rod else {
            let mode = Compensation::new(campaign, mode)?;
            return Ok(Loads { truth: mode.clone(), mode, unknown: Vec::new() });
        };
        let scaled =
            |c: &Compliance, factor: f64| Compliance { force: c.force * factor, gravity: c.gravity * factor };
        if let Some(readings) = &campaign.readings {
            let truth = Compensation::new(campaign, Mode::Meas)?;
            let measured = rig::fit(readings, Some(rod), &rig::Options::default())?.measured;
            let share = measured.and_then(|m| Some(m.rod_ratio.std_error? / m.rod_ratio.value));
            let unknown = truth.compliance.iter().map(|c| scaled(c, share.unwrap_or(RIG))).collect();
            return Ok(Loads { mode: Compensation::new(campaign, mode)?, truth, unknown });
        }
        let truth = Compensation::new(campaign, Mode::Fea)?;
        if mode == Mode::Meas {
            // what the rig will say is not known yet, but that it will
            let unknown = truth.compliance.iter().map(|c| scaled(c, RIG)).collect();
            return Ok(Loads { mode: Compensation { mode, ..truth.clone() }, truth, unknown });
        }
        let mut unknown = Vec::new();
        for nominal in rod.nominal_numbers() {
            let u = nominal.standard_uncertainty;
            let value_at = |by: f64| {
                let rod = rod.with(&nominal.number, nominal.value + by);
                Compliance::of_model(&rod, &Physics::default(), ELEMENTS)
            };
            let (more, less) = (value_at(u)?, value_at(-u)?);
            unknown.push(Compliance {
                force: (more.force - less.force) * 0.5,
                gravity: (more.gravity - less.gravity) * 0.5,
            });
        }
        Ok(Loads { mode: Compensation::new(campaign, mode)?, truth, unknown })
    }

    pub fn errors(&self, planned: &Planned) -> Result<Errors> {
        let actual = planned.deflections(&self.truth);
        let taken = planned.deflections(&self.mode);
        let bias = actual.iter().zip(&taken).map(|(actual, taken)| actual - taken).collect();
        let of_compliance = |compliance: &Compliance| {
            planned.deflections(&Compensation { compliance: Some(*compliance), ..self.truth.clone() })
        };
        Ok(Errors { bias, unknown: self.unknown.iter().map(of_compliance).collect() })
    }
}
