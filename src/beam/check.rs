//! Every solution checks itself before anybody sees it.
//!
//! 1. *Finite*: no displacement or rotation is infinite or not a number.
//! 2. *Equilibrium*: weight carried at each node, found from the tip, must equal the root's
//!    reaction less all the weight between root and node, summed from the root.
//! 3. *Reciprocity* (Maxwell–Betti): the work of load a on the displacement by load b equals that
//!    of b on a. It joins the two sweeps, every element and every read-out, and holds to rounding
//!    only if all are right.

use nalgebra::{Matrix3, Vector3};

use super::chain::Chain;
use super::response::{Carried, Load, Motion, Response};
use crate::error::{Error, Result};
use crate::parallel::checkpoint;
use crate::spatial::cross;
use crate::units::MM;

/// Rounding grows like n·ε; 20 000 elements reach 1e-12 in the worst case.
const TOLERANCE: f64 = 1e-9;

pub(super) fn check(chain: &Chain, loads: &[Load], weight: &[Carried], response: &Response) -> Result<()> {
    finite(chain, loads, response)?;
    if loads.contains(&Load::SelfWeight) {
        equilibrium(chain, weight)?;
    }
    reciprocity(chain, loads, weight, response)
}

fn finite(chain: &Chain, loads: &[Load], response: &Response) -> Result<()> {
    let is_finite = |m: &Motion| m.translation.iter().chain(m.rotation.iter()).all(|x| x.is_finite());
    // what is not finite stays so up to the tip
    for (i, &load) in loads.iter().enumerate() {
        if is_finite(response.motion(chain.end(), i)) {
            continue;
        }
        let node = (0..=chain.end()).find(|&n| !is_finite(response.motion(n, i))).unwrap_or(chain.end());
        let motion = response.motion(node, i);
        let (what, matrix) = match motion.translation.iter().all(|x| x.is_finite()) {
            true => ("rotation about", &motion.rotation),
            false => ("displacement along", &motion.translation),
        };
        let entry = matrix.iter().position(|x| !x.is_finite()).unwrap_or(0);
        return Err(failure(chain, node, what, entry, load, "a finite value", f64::INFINITY));
    }
    Ok(())
}

fn equilibrium(chain: &Chain, weight: &[Carried]) -> Result<()> {
    let root = chain.nodes[0].position;
    let reaction = &weight[0];
    let (mut mass, mut first_moment) = (0.0, Vector3::zeros());
    // per unit acceleration: mass is a force, first moment about the root a moment
    let moment_scale =
        weight.iter().fold(f64::MIN_POSITIVE, |scale, carried| scale.max(carried.first_moment.amax()));
    for (k, (node, carried)) in chain.nodes.iter().zip(weight).enumerate() {
        checkpoint();
        let lever = node.position - root;
        let beyond = carried.first_moment + lever * carried.mass;
        let mass_error = (reaction.mass - mass - carried.mass).abs() / reaction.mass.max(f64::MIN_POSITIVE);
        let errors = (reaction.first_moment - first_moment - beyond).abs() / moment_scale;
        if exceeds(mass_error) {
            return Err(failure(chain, k, "force along", 0, Load::SelfWeight, "equilibrium", mass_error));
        }
        if exceeds(errors.max()) {
            return Err(failure(
                chain,
                k,
                "moment about",
                errors.imax(),
                Load::SelfWeight,
                "equilibrium",
                errors.max(),
            ));
        }
        mass += node.mass;
        first_moment += lever * node.mass;
        if let Some(element) = chain.elements.get(k) {
            let shape = chain.shape(element);
            mass += shape.mass;
            first_moment += (element.reference + shape.mass_centre - root) * shape.mass;
        }
    }
    Ok(())
}

/// What a unit load works on: the displacement or the rotation of its node.
type WorksOn = fn(&Motion) -> &Matrix3<f64>;

fn reciprocity(chain: &Chain, loads: &[Load], weight: &[Carried], response: &Response) -> Result<()> {
    for (a, &load_a) in loads.iter().enumerate() {
        // the displacement at a point load, and through it every element, is compared with all
        // other loads
        let (node, work_on, what): (usize, WorksOn, &str) = match load_a {
            Load::Force { node } => (node, |motion| &motion.translation, "displacement along"),
            Load::Couple { node } => (node, |motion| &motion.rotation, "rotation about"),
            Load::SelfWeight => continue,
        };
        for (b, &load_b) in loads.iter().enumerate() {
            let by_b = work_on(response.motion(node, b));
            let by_a = match load_b {
                Load::Force { node } => response.motion(node, a).translation,
                Load::Couple { node } => response.motion(node, a).rotation,
                Load::SelfWeight => weight_work(chain, load_a, a, weight, response),
            };
            let error = (by_b - by_a.transpose()).abs();
            let relative = error.max() / by_a.amax().max(f64::MIN_POSITIVE);
            if exceeds(relative) {
                let largest = error.iter().position(|&e| e == error.max()).unwrap_or(0);
                return Err(failure(chain, node, what, largest, load_b, "reciprocity", relative));
            }
        }
    }
    Ok(())
}

/// Work of the weight along each axis (rows) on the motions under the point load `load` (columns),
/// J.
fn weight_work(
    chain: &Chain,
    load: Load,
    index: usize,
    weight: &[Carried],
    response: &Response,
) -> Matrix3<f64> {
    let mut work = Matrix3::zeros();
    for (k, element) in chain.elements.iter().enumerate() {
        checkpoint();
        let (shape, near, far) = (chain.shape(element), &chain.nodes[k], &chain.nodes[k + 1]);
        work += response.motion(k + 1, index).translation * far.mass;
        // the element as a rigid body on its near node: m (u + θ×d) …
        let motion = response.motion(k, index);
        let lever = element.reference + shape.mass_centre - near.position;
        work += (motion.translation - cross(&lever, &motion.rotation)) * shape.mass;
        // … and as it deforms, by the element's own reciprocity: Uᵀ·F + Vᵀ·M
        let carried = chain.carried(load, k, weight);
        work += shape.weight_translation.transpose() * carried.mass
            + shape.weight_rotation.transpose() * carried.moment();
    }
    work
}

/// True also for NaN.
fn exceeds(relative: f64) -> bool {
    !matches!(relative.partial_cmp(&TOLERANCE), Some(std::cmp::Ordering::Less | std::cmp::Ordering::Equal))
}

fn failure(
    chain: &Chain,
    node: usize,
    what: &str,
    entry: usize,
    load: Load,
    check: &'static str,
    relative: f64,
) -> Error {
    // column-major 3×3: entry = row + 3·column
    let (row, column) = (["x", "y", "z"][entry % 3], ["x", "y", "z"][(entry / 3) % 3]);
    let load = match load {
        Load::Force { node } => format!("a force along {column} at node {node}"),
        Load::Couple { node } => format!("a moment about {column} at node {node}"),
        Load::SelfWeight => format!("self-weight along {column}"),
    };
    Error::SelfCheck {
        node,
        station_mm: chain.nodes[node].station / MM,
        freedom: format!("{what} {row} under {load}"),
        check,
        relative,
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Rotation3;

    use super::super::element::Profile;
    use super::*;

    /// A bent chain of nine elements with a mass on the way, its weight and its response to all
    /// kinds of load.
    fn solved() -> (Chain, [Load; 3], Vec<Carried>, Response) {
        let profile = Profile {
            axial: 2e-7,
            shear: [5e-7; 2],
            bending: [2e-3; 2],
            torsion: 4e-3,
            mass_per_length: 0.7,
            rotary_inertia: [0.0; 2],
        };
        let mut chain = Chain::clamped_at(Vector3::zeros(), Rotation3::identity());
        chain.straight(&profile, 0.3, 3);
        chain.mass(0.2);
        chain.arc(&profile, 0.1, 1.2, 3);
        chain.straight(&profile, 0.4, 3);
        let node = chain.end();
        let loads = [Load::Force { node }, Load::Couple { node: 4 }, Load::SelfWeight];
        let weight = chain.weight_beyond();
        let response = chain.deform(&loads, &weight);
        (chain, loads, weight, response)
    }

    #[test]
    fn a_sound_solution_passes() {
        let (chain, loads, weight, response) = solved();
        check(&chain, &loads, &weight, &response).unwrap();
    }

    #[test]
    fn what_is_not_finite_is_named_with_its_first_node() {
        let (chain, loads, weight, mut response) = solved();
        for node in 5..=chain.end() {
            response.motion_mut(node, 2).rotation[(1, 0)] = f64::NAN;
        }
        let error = check(&chain, &loads, &weight, &response).unwrap_err().to_string();
        assert!(
            error.contains("node 5") && error.contains("rotation about y under self-weight along x"),
            "{error}"
        );
    }

    #[test]
    fn a_weight_that_was_lost_breaks_equilibrium_at_its_node() {
        let (chain, loads, mut weight, response) = solved();
        weight[4].mass -= 1e-6;
        let error = check(&chain, &loads, &weight, &response).unwrap_err().to_string();
        assert!(error.contains("node 4") && error.contains("equilibrium"), "{error}");
        // a first moment alone is found too
        let (chain, loads, mut weight, response) = solved();
        weight[7].first_moment.x += 1e-6;
        let error = check(&chain, &loads, &weight, &response).unwrap_err().to_string();
        assert!(error.contains("node 7") && error.contains("moment about"), "{error}");
    }

    #[test]
    fn a_load_beyond_the_tip_is_refused() {
        let (chain, ..) = solved();
        let error = chain.solve(&[Load::Force { node: chain.end() + 1 }]).unwrap_err().to_string();
        assert_eq!(error, "`node` is 10, expected a node of the chain, 0 to 9");
    }

    #[test]
    fn a_displacement_that_is_off_breaks_reciprocity() {
        for load in 0..3 {
            let (chain, loads, weight, mut response) = solved();
            let translation = &mut response.motion_mut(chain.end(), load).translation;
            translation[(2, 0)] += 1e-6 * translation.amax();
            let error = check(&chain, &loads, &weight, &response).unwrap_err().to_string();
            assert!(error.contains("reciprocity"), "load {load}: {error}");
        }
    }
}
