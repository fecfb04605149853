//! Which rods there can be.

use crate::rod::{Pipe, Rod};
use crate::section::Section;
use crate::units::{GPA, MM};

/// Nobody drills a bore that is less than this share of the outside through a rod.
const BORE: f64 = 0.02;

/// What a rod file would allow, and a workshop could make: a file that is corrected holds a real
/// rod.
pub(super) fn is_possible(rod: &Rod) -> bool {
    let is_section = |section: &Section| match section {
        Section::Round(round) => {
            (1.0 * MM..300.0 * MM).contains(&round.outer_diameter)
                && (round.inner_diameter == 0.0 || round.inner_diameter > BORE * round.outer_diameter)
                && round.wall() > 0.05 * MM
        }
        _ => true,
    };
    let is_pipe = |pipe: &Pipe| {
        let material = &pipe.material;
        is_section(&pipe.section)
            && (1.0 * GPA..1000.0 * GPA).contains(&material.youngs_modulus)
            && (0.3 * GPA..500.0 * GPA).contains(&material.shear_modulus)
    };
    let is_length = |length: f64| (5.0 * MM..5000.0 * MM).contains(&length);
    is_pipe(&rod.pipe1)
        && is_pipe(&rod.pipe2)
        && is_pipe(&rod.bend)
        && is_length(rod.l1)
        && is_length(rod.l2)
        && rod.bend_start() > 0.0
        && rod.l2 > rod.tangent_length()
        && rod.gamma > 0.0
        && rod.gamma <= std::f64::consts::PI + 1e-9
        && rod.joints.iter().all(|joint| joint.station <= rod.length())
        && rod.sleeves.iter().all(|sleeve| is_pipe(&sleeve.pipe) && sleeve.to <= rod.length())
}
