//! Beam finite elements on an open chain, solved by flexibilities.
//!
//! A measuring rod is a chain: clamped at one end, free at the other, every node between two
//! elements. Its internal forces follow from equilibrium alone, so nothing needs to be factorised
//! but the chain itself: one sweep from the tip to the root collects what each element carries, one
//! sweep from the root to the tip adds up the elements' deformations. Both are linear in the number
//! of elements, serve any number of load cases at once, and lose no digits as elements get short; a
//! stiffness matrix of the same elements has a condition number that grows with the fourth power of
//! their number.
//!
//! - [`Profile`]: flexibilities of a cross-section, per length.
//! - [`Chain`]: nodes and elements, built piece by piece in any direction in space.
//! - [`Response`]: displacement and rotation of every node, from [`Chain::solve`], which checks
//!   itself.
//! - [`TipSolver`]: the tip of very many rods, and about how fast they swing, without a mesh.
//! - [`NaturalMode`]: how fast a rod swings, and in which shape.
//! - [`RodModel`]: a [`crate::rod::Rod`] as a chain, with nodes wherever something sits or is read.

mod chain;
mod check;
mod element;
mod estimate;
mod frequency_slopes;
mod large;
mod model;
mod natural;
mod response;
mod solve;
mod tip;

pub use chain::Chain;
pub use element::Profile;
pub use model::{Physics, RodModel};
pub use natural::{NaturalMode, settling_time};
pub use response::{Load, Motion, Response, Resultant};
pub use tip::TipSolver;
