//! The figures of a rod with what is known of them.

use nalgebra::Matrix3;

use crate::compliance::{Mode, Sensitivity, Study};
use crate::statistics::HALF_95;
use crate::units::{UM, significant, with_uncertainty};

/// Digits of a figure whose uncertainty is not known.
const DIGITS: usize = 4;

/// `402 ± 14`: ± is half of the 95 % interval from the standard uncertainties of the rod's numbers
/// (GUM, JCGM 100:2008, 5.1.2). The closed form leaves out more than that, and laws of the file
/// have constants of their own: their figures stand without.
pub(super) struct Known {
    /// c_rod, µm.
    pub index: String,
    /// The largest deflection under 1 N, µm.
    pub force: String,
    /// The same under 1 g.
    pub gravity: String,
    /// Hz; `None` of a rod without mass.
    pub frequency: Option<String>,
}

impl Known {
    pub fn of(study: &Study) -> Known {
        let c = study.compliance();
        let is_known = study.mode == Mode::Fea && study.laws.is_empty();
        let known = study.rod.nominal_numbers();
        let half = |slope: &dyn Fn(&Sensitivity) -> f64| {
            let shift = |one: &Sensitivity| {
                let nominal = known.iter().find(|nominal| nominal.number == one.number)?;
                Some(slope(one) * nominal.standard_uncertainty)
            };
            let shifts = study.sensitivities.iter().filter(|_| is_known).filter_map(shift);
            HALF_95 * shifts.map(|shift| shift * shift).sum::<f64>().sqrt()
        };
        let column = |matrix: &Matrix3<f64>, slope: &dyn Fn(&Sensitivity) -> Matrix3<f64>| {
            let (at, norm) = largest_column(matrix);
            let half =
                half(&|one| matrix.column(at).dot(&slope(one).column(at)) / norm.max(f64::MIN_POSITIVE));
            with_uncertainty(norm / UM, half / UM, DIGITS)
        };
        Known {
            index: with_uncertainty(study.index() / UM, half(&|one| one.index) / UM, DIGITS),
            force: column(&c.force, &|one| one.compliance.force),
            gravity: column(&c.gravity, &|one| one.compliance.gravity),
            frequency: study.shape.modes.first().map(|mode| match half(&|one| one.frequency) {
                half if half > 0.0 => with_uncertainty(mode.frequency, half, DIGITS),
                _ => significant(mode.frequency, 3),
            }),
        }
    }
}

/// The axis along which a load deflects the tip most, and by how much.
fn largest_column(matrix: &Matrix3<f64>) -> (usize, f64) {
    let norms = matrix.column_iter().map(|column| column.norm()).enumerate();
    norms.fold((0, 0.0), |most, one| if one.1 > most.1 { one } else { most })
}
