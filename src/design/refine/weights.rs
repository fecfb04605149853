//! What is bettered: one goal, or several by their weights.

use crate::design::space::DesignSpace;
use crate::error::{Error, Result};

/// What each goal of `space` weighs, 1 in all, as somebody wrote it: "mass_g", or
/// "c_rod_um=2,mass_g=1"; without a word the first goal alone.
///
/// ```
/// use rodcal::design::{DesignSpace, weights};
///
/// let space = DesignSpace::from_toml("design.toml", "
///     [geometry]
///     l1_mm = 150
///     l2_mm = 525
///     [catalogue]
///     file = \"builtin\"
///     [objectives]
///     minimise = [\"c_rod_um\", \"mass_g\"]
/// ", &|_| unreachable!())?;
/// assert_eq!(weights(&space, Some("c_rod_um=3,mass_g=1"))?, [0.75, 0.25]);
/// assert_eq!(weights(&space, None)?, [1.0, 0.0]);
/// # Ok::<(), rodcal::Error>(())
/// ```
///
/// # Errors
/// [`Error::Argument`] for what is no goal of the design file, and for what is no weight.
pub fn weights(space: &DesignSpace, asked: Option<&str>) -> Result<Vec<f64>> {
    let mut weights = vec![0.0; space.goals.len()];
    let Some(asked) = asked else {
        weights.iter_mut().take(1).for_each(|weight| *weight = 1.0);
        return Ok(weights);
    };
    for one in asked.split(',') {
        let (key, weight) = one.split_once('=').unwrap_or((one, "1"));
        let refused = |expected: String| Error::Argument { name: "refine-goal", found: one.into(), expected };
        let Some(at) = space.goals.iter().position(|goal| goal.figure.key() == key.trim()) else {
            let keys: Vec<&str> = space.goals.iter().map(|goal| goal.figure.key()).collect();
            return Err(refused(format!("an objective of the design file: {}", keys.join(", "))));
        };
        weights[at] = match weight.trim().parse::<f64>() {
            Ok(weight) if weight > 0.0 && weight < 1e6 && weights[at] == 0.0 => weight,
            Ok(_) if weights[at] > 0.0 => return Err(refused("each objective once".into())),
            _ => return Err(refused("a weight above 0, as in c_rod_um=2,mass_g=1".into())),
        };
    }
    let sum: f64 = weights.iter().sum();
    Ok(weights.into_iter().map(|weight| weight / sum).collect())
}
