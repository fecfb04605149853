//! What Poisson's ratio does to a shear coefficient.

use crate::dual::Number;

/// ν/e for a shear coefficient. Of an isotropic material it is at most ⅙; beyond ½, which no known
/// wall reaches, the formulas lose their meaning.
pub(super) fn contraction<T: Number>(ratio: T, poisson_ratio: T) -> T {
    (poisson_ratio / ratio).smaller(T::from(0.5))
}
