//! How the data scatter.

pub(in crate::inference) mod correlated_noise;
pub(in crate::inference) mod correlation;
pub(in crate::inference) mod in_common;
pub(in crate::inference) mod lack_of_fit;
pub(in crate::inference) mod own_noise;
pub(in crate::inference) mod scatter;
pub(in crate::inference) mod shared_ratio;
pub(in crate::inference) mod suspects;
pub(in crate::inference) mod whitening;
