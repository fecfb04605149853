//! What may be wrong with a rig, with its names and numbers as a diagnosis states them.

use super::protocol::AXES;
use rodcal_base::units::{DEG, MM, UM, URAD_PER_NM};

/// Something that is wrong, SI.
#[derive(Debug, Clone, PartialEq)]
#[allow(missing_docs)] // fields are in the words of their effects
pub enum Effect {
    /// Factor on E and G.
    StiffnessScale(f64),
    /// Factor on G.
    ShearModulus(f64),
    /// A joint that gives way, rad/(N·m).
    Joint { name: Option<String>, station: f64, bending: f64, torsion: f64 },
    /// The flange gives way, rad/(N·m).
    Root { bending: f64, torsion: f64 },
    /// The bend's flexibility factor, where the file says that of a beam.
    Bend(f64),
    /// Coulomb friction of the slide under loads along `axis` (`None`: all), N. It takes `presliding` (m) of travel to
    /// turn round, and at every reading the slide sticks with up to the share `scatter` less than the full value.
    Friction { axis: Option<usize>, force: f64, presliding: f64, scatter: f64 },
    /// Added to every load, N.
    LoadOffset { axis: Option<usize>, force: f64 },
    /// Play that the ball goes through before the load is carried, m.
    Backlash { axis: Option<usize>, play: f64 },
    /// Viscoelastic creep by `per_decade` of the displacement, beginning at the time `shortest`, s.
    Creep { per_decade: f64, shortest: f64 },
    /// Hysteresis with a loop as wide, at half load, as this share of full scale; exercised before, or virgin.
    Hysteresis { fraction: f64, is_exercised: bool },
    /// Displacement × (1 + k·F²), 1/N².
    Cubic(f64),
    /// Displacement × (1 + k·F), 1/N.
    Quadratic(f64),
    /// Factor on a channel.
    SensorScale { channel: usize, factor: f64 },
    /// A channel turned towards another axis, rad.
    SensorMisalignment { channel: usize, towards: usize, angle: f64 },
    /// Loads along `axis` turned towards another one, rad; with `frame` loads along both turn together.
    LoadMisalignment { axis: usize, towards: usize, angle: f64, frame: bool },
    /// A channel drifts by so much, m/K; without a thermometer m/s of its own clock.
    Drift { channel: usize, rate: f64, by_time: bool },
    /// From this loading on, to the end of its run, a channel is displaced, m.
    Slip { loading: usize, channel: usize, by: f64 },
    /// Single readings that are wrong: index of the cell, by how much, m.
    Outlier(Vec<(usize, f64)>),
    // ---- physics that no library has ----
    /// A gap closes at this load, N: beyond it the rod gives way by this share only.
    GapCloses { load: f64, share: f64 },
    /// Interpolation error of a sensor: amplitude m, period m, phase rad.
    Ripple { channel: usize, amplitude: f64, period: f64, phase: f64 },
    /// A Hertzian seat gives way by this, m, at the largest load, and with F^(2/3) below.
    Seat(f64),
    /// A rod that runs in: the first loading gives this share more, less by e with every so many loadings.
    RunningIn { share: f64, loadings: f64 },
    /// A channel that does not go beyond this, m.
    Saturation { channel: usize, limit: f64 },
    /// A clamp that is loose for loads against the axes: so much more displacement there.
    LooseClamp(f64),
}

impl Effect {
    /// The name of the effect; of those outside the library a name of the generator's own.
    pub fn name(&self) -> &'static str {
        match self {
            Effect::StiffnessScale(_) => "stiffness_scale",
            Effect::ShearModulus(_) => "shear_modulus",
            Effect::Joint { .. } => "joint_compliance",
            Effect::Root { .. } => "root_compliance",
            Effect::Bend(_) => "bend_flexibility",
            Effect::Friction { .. } => "friction",
            Effect::LoadOffset { .. } => "load_offset",
            Effect::Backlash { .. } => "backlash",
            Effect::Creep { .. } => "creep",
            Effect::Hysteresis { .. } => "hysteresis",
            Effect::Cubic(_) | Effect::Quadratic(_) => "nonlinear_stiffness",
            Effect::SensorScale { .. } => "sensor_scale",
            Effect::SensorMisalignment { .. } => "sensor_misalignment",
            Effect::LoadMisalignment { .. } => "load_misalignment",
            Effect::Drift { .. } => "thermal_drift",
            Effect::Slip { .. } => "slip",
            Effect::Outlier(_) => "outlier",
            Effect::GapCloses { .. } => "a gap that closes",
            Effect::Ripple { .. } => "sensor ripple",
            Effect::Seat(_) => "Hertzian seat",
            Effect::RunningIn { .. } => "running in",
            Effect::Saturation { .. } => "sensor saturation",
            Effect::LooseClamp(_) => "clamp loose one way",
        }
    }

    /// Where, in the words of a diagnosis; `run` names a loading's run, `cell` a reading.
    pub fn location(&self, run: impl Fn(usize) -> String, cell: impl Fn(usize) -> String) -> String {
        let of_axis = |place: &str, axis: &Option<usize>| match axis {
            Some(axis) => format!("{place}, loads along {}", AXES[*axis]),
            None => place.to_owned(),
        };
        match self {
            Effect::Joint { name: Some(name), .. } => name.clone(),
            Effect::Joint { station, .. } => format!("station {:.1} mm", station / MM),
            Effect::Root { .. } => "root".into(),
            Effect::Bend(_) => "bend".into(),
            Effect::Friction { axis, .. } => of_axis("slide", axis),
            Effect::LoadOffset { axis, .. } => of_axis("hanger", axis),
            Effect::Backlash { axis, .. } => of_axis("clamp", axis),
            Effect::SensorScale { channel, .. }
            | Effect::Drift { channel, .. }
            | Effect::Ripple { channel, .. }
            | Effect::Saturation { channel, .. } => format!("d{}", AXES[*channel]),
            Effect::SensorMisalignment { channel, towards, .. } => {
                format!("d{} towards d{}", AXES[*channel], AXES[*towards])
            }
            Effect::LoadMisalignment { axis, towards, frame: true, .. } => {
                let (a, b) = (axis.min(towards), axis.max(towards));
                format!("{} and {} about {}", AXES[*a], AXES[*b], AXES[3 - a - b])
            }
            Effect::LoadMisalignment { axis, towards, .. } => {
                format!("{} towards {}", AXES[*axis], AXES[*towards])
            }
            Effect::Slip { loading, .. } => format!("{}, after row {loading}", run(*loading)),
            Effect::Outlier(cells) => {
                cells.iter().map(|(index, _)| cell(*index)).collect::<Vec<_>>().join("; ")
            }
            _ => "rod".into(),
        }
    }

    /// Its numbers, by their names at the boundary.
    pub fn parameters(&self) -> Vec<(&'static str, f64)> {
        match self {
            Effect::StiffnessScale(factor) | Effect::ShearModulus(factor) | Effect::Bend(factor) => {
                vec![("factor", *factor)]
            }
            Effect::Joint { bending, torsion, .. } | Effect::Root { bending, torsion } => vec![
                ("bending_urad_per_nm", bending / URAD_PER_NM),
                ("torsion_urad_per_nm", torsion / URAD_PER_NM),
            ],
            Effect::Friction { force, .. } | Effect::LoadOffset { force, .. } => vec![("force_n", *force)],
            Effect::Backlash { play, .. } => vec![("play_um", play / UM)],
            Effect::Creep { per_decade, .. } => vec![("per_decade", *per_decade)],
            Effect::Hysteresis { fraction, .. } => vec![("fraction", *fraction)],
            Effect::Cubic(k) => vec![("per_n2", *k)],
            Effect::Quadratic(k) => vec![("per_n", *k)],
            Effect::SensorScale { factor, .. } => vec![("factor", *factor)],
            Effect::SensorMisalignment { angle, .. } | Effect::LoadMisalignment { angle, .. } => {
                vec![("angle_deg", angle / DEG)]
            }
            Effect::Drift { rate, by_time: true, .. } => vec![("um_per_h", rate / UM * 3600.0)],
            Effect::Drift { rate, .. } => vec![("um_per_k", rate / UM)],
            Effect::Slip { by, .. } => vec![("um", by / UM)],
            Effect::Outlier(cells) => cells.iter().map(|(_, by)| ("um", by / UM)).collect(),
            Effect::GapCloses { load, share } => vec![("load_n", *load), ("share", *share)],
            Effect::Ripple { amplitude, period, .. } => {
                vec![("amplitude_um", amplitude / UM), ("period_um", period / UM)]
            }
            Effect::Seat(depth) => vec![("um", depth / UM)],
            Effect::RunningIn { share, loadings } => vec![("share", *share), ("loadings", *loadings)],
            Effect::Saturation { limit, .. } => vec![("limit_um", limit / UM)],
            Effect::LooseClamp(share) => vec![("share", *share)],
        }
    }

    /// What may not be below zero: its opposite is no rival explanation.
    pub fn is_one_sided(&self) -> bool {
        matches!(
            self,
            Effect::Joint { .. }
                | Effect::Root { .. }
                | Effect::Bend(_)
                | Effect::Friction { .. }
                | Effect::Backlash { .. }
                | Effect::Creep { .. }
                | Effect::Hysteresis { .. }
        )
    }
}
