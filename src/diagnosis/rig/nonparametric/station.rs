//! A rod that is softer here than there: walls, laminates or glue that vary along it.
//!
//! ```text
//! EI(s), GJ(s) → EI, GJ/(1 + Σ_j a_j·cos(π j s/L))      s the station, L the rod's length
//! ```
//!
//! By the loads at the tip such a rod is one that is softer, a joint and a root at once; none of
//! these is then what it is.

use std::f64::consts::PI;

use super::along::{MOST_COLUMNS, rival};
use crate::diagnosis::rig::effects::entry::{Entry, UNBOUNDED, parameter};
use crate::diagnosis::rig::mechanics::action::Action;
use crate::diagnosis::rig::mechanics::structure::Structure;
use crate::diagnosis::rig::recording::datum::Datum;
use crate::inference::{Candidate, Location, Variable};

/// By what share the flexibility varies: walls of drawn tubes vary by 10 %.
const VARIES: f64 = 0.1;
/// How often it is met for any other curve: a joint that may be anywhere shares its prior among as
/// many stations, and draws much the same.
const WEIGHT: f64 = 0.2;

/// The curve; nothing where the displacement was imposed.
pub(super) fn along_the_rod(data: &[Datum], structure: &Structure, place: &[usize]) -> Option<Entry> {
    if data.iter().any(|d| d.imposed.is_some()) {
        return None;
    }
    let length = structure.rod().length();
    let of_wave = |j: usize| {
        let parts = structure.varying(&|station| (PI * j as f64 * station / length).cos());
        let weight = |(i, datum): (usize, &Datum)| {
            let along = (datum.channel.index(), datum.direction.axis.index());
            (i, parts[place[i]][along] * datum.signed_load())
        };
        let weights = data.iter().enumerate().map(weight).collect();
        (parameter(&format!("cosine_{j}_percent"), 0.0, VARIES, UNBOUNDED), Action::Shift(weights))
    };
    let (parameters, actions) = (0..MOST_COLUMNS).map(of_wave).unzip();
    let location = Location::Curve {
        label: "station, all deflections".into(),
        follows: "is that of a rod whose walls or moduli vary along it (all readings alike)".into(),
        along: Some(Variable::Load),
    };
    Some((Candidate { weight: WEIGHT, ..rival(location, parameters) }, actions))
}
