//! What makes every claim about these readings weaker.

use super::{Body, RigModel};
use crate::inference::{Evidence, Limit};
use crate::spatial::Axis;

/// Fewer than these are few.
const FEW: usize = 12;

pub(super) fn limits(model: &RigModel, evidence: &Evidence) -> Vec<Limit> {
    let data = model.data();
    let mut limits = Vec::new();
    let groups = evidence.replicate_group.iter().max().map_or(0, |last| last + 1);
    if groups == data.len() {
        limits.push(Limit::NoRepeats);
    }
    let axes: Vec<Axis> =
        Axis::ALL.into_iter().filter(|axis| data.iter().any(|d| d.direction.axis == *axis)).collect();
    if let ([axis], Body::Rod(_)) = (&axes[..], &model.body) {
        limits.push(Limit::OneAxis(*axis));
    }
    let mut loads: Vec<f64> = data.iter().map(|d| d.load).filter(|load| *load > 0.0).collect();
    loads.sort_by(f64::total_cmp);
    loads.dedup();
    if loads.len() < 2 {
        limits.push(Limit::OneLoad);
    }
    if data.len() < FEW {
        limits.push(Limit::FewReadings(data.len()));
    }
    if evidence.fold.iter().max().is_none_or(|last| *last == 0) {
        limits.push(Limit::NoFoldsOfReadings);
    }
    limits
}
