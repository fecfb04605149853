//! What pulls and what bends: rod, masses and contact force.
//!
//! ```text
//! rod_stiffness             (s − s₀)·R·Δx                   s: factor on the model's deflection, s₀ what was compensated
//! tip_mass                  R·C^F·Rᵀ·(m·g) + yield(tip, m·g)
//! payload_mass              yield(flange, m·g)
//! contact_force_variation   R·C^F·Rᵀ·F + yield(tip, F)      F in the device frame of the clamp
//! yield(p, f) = Σ_j leverⱼ·cⱼ·zⱼ·((p − oⱼ) × f)             the calibrated joints give way
//! gravity_tilt              φ × (tip − base)                φ = k·(moment at the base, its horizontal part)
//! ```

use nalgebra::Vector3;

use super::{CONTACT, FLANGE_MASS, NotTestable, SOFTNESS, TIP_MASS, YIELDING, lack};
use crate::diagnosis::calibration::posture::Posture;
use crate::diagnosis::calibration::scene::{Entry, Scene, entry, linear};
use crate::units::URAD_PER_NM;

const GRAM: f64 = 1e-3;

pub(super) fn all(scene: &Scene, lacks: &mut Vec<NotTestable>) -> Vec<Entry> {
    let mut entries = rod(scene, lacks);
    entries.extend(masses(scene, lacks));
    entries.extend(contact(scene, lacks));
    entries.extend(tilt(scene));
    entries
}

fn rod(scene: &Scene, lacks: &mut Vec<NotTestable>) -> Vec<Entry> {
    if scene.bent.is_empty() {
        lacks.push(lack("rod_stiffness", "the campaign names no rod"));
        return Vec::new();
    }
    type Of = fn(&[Vector3<f64>; 2]) -> Vector3<f64>;
    let places: [(&str, Of); 3] = [
        ("rod", |bent| bent[0] + bent[1]),
        ("rod, under the contact force", |bent| bent[0]),
        ("rod, under its weight", |bent| bent[1]),
    ];
    let of_place = |(location, of): (&str, Of)| {
        let mut factor = linear("factor", 1.0, SOFTNESS);
        factor.neutral = scene.accounted;
        // a rod that was taken for rigid bends by all of its model
        factor.size = factor.size.max(1.0 - scene.accounted);
        factor.bounds = (0.0, 10.0);
        entry("rod_stiffness", location, vec![(factor, scene.column(|row, _| of(&scene.bent[row])))])
    };
    places.into_iter().map(of_place).collect()
}

/// Displacement of the tip by one more force on it, m: the rod bends and the joints give way.
fn pulled(scene: &Scene, posture: &Posture, force: &Vector3<f64>) -> Vector3<f64> {
    posture.in_world(&scene.force_compliance) * force + posture.yielding(&posture.tip, force)
}

/// True where something is known to give way to a force on the tip.
fn gives_way(scene: &Scene) -> bool {
    scene.force_compliance.amax() > 0.0 || joints_give_way(scene)
}

fn joints_give_way(scene: &Scene) -> bool {
    scene.postures.first().is_some_and(|posture| posture.compliance.iter().any(|&c| c != 0.0))
}

fn masses(scene: &Scene, lacks: &mut Vec<NotTestable>) -> Vec<Entry> {
    let mut entries = Vec::new();
    match gives_way(scene) {
        true => {
            let column = scene.column(|_, posture| pulled(scene, posture, &posture.gravity));
            entries.push(entry("tip_mass", "tip", vec![(linear("mass_g", GRAM, TIP_MASS), column)]));
        }
        false => lacks.push(lack("tip_mass", "neither a rod nor joints are known to give way")),
    }
    match joints_give_way(scene) {
        true => {
            let column =
                scene.column(|_, posture| posture.yielding(&posture.flange.origin, &posture.gravity));
            let mass = linear("mass_kg", 1.0, FLANGE_MASS);
            entries.push(entry("payload_mass", "flange", vec![(mass, column)]));
        }
        false => lacks.push(lack("payload_mass", "no joint is known to give way")),
    }
    entries
}

fn contact(scene: &Scene, lacks: &mut Vec<NotTestable>) -> Vec<Entry> {
    const EFFECT: &str = "contact_force_variation";
    let groups = &scene.recording.groups;
    let is_of_clamps = !scene.has_sockets() && groups.iter().any(|group| !group.name.is_empty());
    if !is_of_clamps || !gives_way(scene) {
        lacks.push(lack(EFFECT, "there are no clamps, or neither a rod nor joints are known to give way"));
        return Vec::new();
    }
    let of_place = |location: &str, is_of: &dyn Fn(usize) -> bool| {
        let along = |(axis, name): (usize, &str)| {
            let column = scene.column(|row, posture| {
                let group = scene.recording.rows[row].group;
                match is_of(group) {
                    true => pulled(scene, posture, &groups[group].device.rotation.column(axis).into()),
                    false => Vector3::zeros(),
                }
            });
            (linear(name, 1.0, CONTACT), column)
        };
        entry(EFFECT, location, ["x_n", "y_n", "z_n"].into_iter().enumerate().map(along).collect())
    };
    let mut entries = vec![of_place("all clamps", &|_| true)];
    if groups.len() > 1 {
        entries.extend((0..groups.len()).map(|k| of_place(&groups[k].name, &|group| group == k)));
    }
    entries
}

fn tilt(scene: &Scene) -> Option<Entry> {
    let upright = scene.postures.first()?.gravity.try_normalize(0.0)?;
    let moment = |posture: &Posture| {
        let moment = posture.moment[0];
        moment - upright * upright.dot(&moment)
    };
    let largest = scene.largest(|posture| moment(posture).norm());
    let column = scene.column(|_, posture| moment(posture).cross(&(posture.tip - posture.origin[0])));
    let tilting = linear("tilt_urad_per_nm", URAD_PER_NM, YIELDING / largest.max(f64::MIN_POSITIVE));
    (largest > 0.0).then(|| entry("gravity_tilt", "base", vec![(tilting, column)]))
}
