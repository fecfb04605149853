//! What most programs need, for `use rodcal::prelude::*;`.
//!
//! Four steps, each of which can be taken alone:
//!
//! | step | from | to |
//! |---|---|---|
//! | model | [`Rod`] | [`Compliance`] |
//! | rig | [`Readings`] | [`rig::fit`]: lines, r, the measured compliance |
//! | calibration | [`Campaign`] | [`calibrate`], [`cross_validate`], [`compare`], [`write_back`] |
//! | diagnosis | readings | [`diagnosis::rig::diagnose`]: what the model left out |
//! | | campaign | [`mend`], then [`Mended::diagnose`] |
//!
//! Types that only describe a detail of a result stay in their modules.

pub use crate::beam::Physics;
pub use crate::calibration::campaign::{ParameterConstraints, Recording, Refit, Targets};
pub use crate::calibration::{
    Calibration, Campaign, CompareOptions, Compensation, Mode, Options, calibrate, compare, cross_validate,
    default_mode, write_back,
};
pub use crate::compliance::{Compliance, DEFAULT_ELEMENTS, paper_contact_force};
pub use crate::diagnosis::calibration::{Mended, Neighbours, mend};
pub use crate::error::{Error, Result};
pub use crate::material::Material;
pub use crate::rig::readings::{Axis, Direction, Reading, Readings};
pub use crate::robot::{Hayati, Joint, Kinematics, Motion, Parameter, Robot, Setup};
pub use crate::rod::{Pipe, Rod};
pub use crate::section::Round;
pub use crate::spatial::Pose;
pub use crate::{diagnosis, rig};
