//! What could be measured: all that a rig can do ([`feasible`]), the next measurement beside a
//! finding ([`next`]), and what to measure before anything was ([`planned`]).

pub mod feasible;
pub mod next;
pub mod planned;
