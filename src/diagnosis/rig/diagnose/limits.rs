//! What makes every claim about these readings weaker.

use crate::diagnosis::Limitation;
use crate::diagnosis::rig::model::{Body, RigModel};
use crate::diagnosis::rig::recording::datum::Datum;
use crate::inference::Evidence;
use crate::rig::readings::Driven;
use crate::spatial::Axis;

/// Fewer than these are few.
const FEW: usize = 12;

/// A load that jumps does so by so many of its usual steps, and by so much of its range; a
/// displacement that goes in even steps makes none of so many of its own.
const JUMP: (f64, f64) = (5.0, 0.1);
const EVEN: f64 = 3.0;

/// Does the displacement along some axis go in even steps while the load jumps, three times at
/// least?
fn jumps_at_turns(data: &[Datum]) -> bool {
    const TIMES: usize = 3;
    Axis::ALL.into_iter().any(|axis| {
        let line: Vec<&Datum> =
            data.iter().filter(|d| d.direction.axis == axis && d.channel == axis).collect();
        let steps = |value: &dyn Fn(&Datum) -> f64| {
            let mut steps: Vec<f64> =
                line.windows(2).map(|pair| (value(pair[1]) - value(pair[0])).abs()).collect();
            steps.retain(|step| *step > 0.0);
            steps.sort_by(f64::total_cmp);
            steps
        };
        let (loads, displacements) = (steps(&Datum::signed_load), steps(&|d| d.measured));
        let Some(at) = loads.len().checked_sub(TIMES) else { return false };
        let Some(largest) = displacements.last() else { return false };
        let range = line.iter().fold(0.0, |most: f64, d| most.max(d.load));
        let (load, displacement) = (loads[loads.len() / 2], displacements[displacements.len() / 2]);
        loads[at] > (JUMP.0 * load).max(JUMP.1 * range) && *largest < EVEN * displacement
    })
}

pub fn limits(model: &RigModel, evidence: &Evidence) -> Vec<Limitation> {
    let data = model.data();
    let mut limits = Vec::new();
    let groups = evidence.replicate_group.iter().max().map_or(0, |last| last + 1);
    if groups == data.len() {
        limits.push(Limitation::NoRepeats);
    }
    let axes: Vec<Axis> =
        Axis::ALL.into_iter().filter(|axis| data.iter().any(|d| d.direction.axis == *axis)).collect();
    if let ([axis], Body::Rod(_)) = (&axes[..], &model.body) {
        limits.push(Limitation::OneAxis(*axis));
    }
    let mut loads: Vec<f64> = data.iter().map(|d| d.load).filter(|load| *load > 0.0).collect();
    loads.sort_by(f64::total_cmp);
    loads.dedup();
    if loads.len() < 2 {
        limits.push(Limitation::OneLoad);
    }
    if model.readings().header.driven == Driven::Load && jumps_at_turns(data) {
        limits.push(Limitation::JumpsAtTurns);
    }
    if data.len() < FEW {
        limits.push(Limitation::FewReadings(data.len()));
    }
    if evidence.fold.iter().max().is_none_or(|last| *last == 0) {
        limits.push(Limitation::NoFoldsOfReadings);
    }
    limits
}
