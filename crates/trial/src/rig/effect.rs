//! What may be wrong with a rig, with its names and numbers as a diagnosis states them.

use super::protocol::{AXES, End, Protocol};
use crate::effect_name::EffectName;
use crate::place::{Axes, Place};
use rodcal_base::units::{DEG, MM, UM, URAD_PER_NM};

/// A number of the rod's shape.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dimension {
    /// Flange to corner, and corner to tip.
    Leg(usize),
    /// Between the pipes.
    Angle,
}

/// Something that is wrong, SI.
#[derive(Debug, Clone, PartialEq)]
#[allow(missing_docs, reason = "fields are in the words of their effects")]
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
    /// Factor on E and G of one pipe: 0 is that at the flange.
    PipeStiffness { pipe: usize, factor: f64 },
    /// A length or the angle of the rod is another one than stated: by so much, m or rad.
    Dimension { which: Dimension, stated: f64, by: f64 },
    /// What is stated at this station, m, is so much farther along the rod.
    Point { end: End, station: f64, by: f64 },
    /// Coulomb friction of the slide under loads along `axis` (`None`: all), N. It takes
    /// `presliding` (m) of travel to turn round, and at every reading the slide sticks with up to
    /// the share `scatter` less than the full value.
    Friction { axis: Option<usize>, force: f64, presliding: f64, scatter: f64 },
    /// Added to every load, N.
    LoadOffset { axis: Option<usize>, force: f64 },
    /// Play that the ball goes through before the load is carried, m.
    Backlash { axis: Option<usize>, play: f64 },
    /// Viscoelastic creep by `per_decade` of the displacement, beginning at the time `shortest`, s.
    Creep { per_decade: f64, shortest: f64 },
    /// Hysteresis with a loop as wide, at half load, as this share of full scale; exercised before,
    /// or virgin.
    Hysteresis { fraction: f64, is_exercised: bool },
    /// Displacement × (1 + k·F²), 1/N².
    Cubic(f64),
    /// Displacement × (1 + k·F), 1/N.
    Quadratic(f64),
    /// Factor on a channel.
    SensorScale { channel: usize, factor: f64 },
    /// A channel turned towards another axis, rad.
    SensorMisalignment { channel: usize, towards: usize, angle: f64 },
    /// Loads along `axis` turned towards another one, rad; with `frame` loads along both turn
    /// together.
    LoadMisalignment { axis: usize, towards: usize, angle: f64, frame: bool },
    /// The block that holds all sensors, turned by this vector, rad.
    SensorBlock([f64; 3]),
    /// The frame of the loads, turned by this vector, rad.
    LoadFrame([f64; 3]),
    /// A channel drifts by so much, m/K; without a thermometer m/s of its own clock.
    Drift { channel: usize, rate: f64, by_time: bool },
    /// All channels drift, each by its own rate, as [`Effect::Drift`].
    DriftOfAll { rates: [f64; 3], by_time: bool },
    /// From this loading on, to the end of its run, a channel is displaced, m.
    Slip { loading: usize, channel: usize, by: f64 },
    /// From this loading on, the first of a run, a channel is displaced for good, m: no later zero
    /// is read.
    Shift { loading: usize, channel: usize, by: f64 },
    /// Single readings that are wrong: index of the cell, by how much, m.
    Outlier(Vec<(usize, f64)>),
    // ---- physics that no library has ----
    /// A gap closes at this load, N: beyond it the rod gives way by this share only.
    GapCloses { load: f64, share: f64 },
    /// Interpolation error of a sensor: amplitude m, period m, phase rad.
    Ripple { channel: usize, amplitude: f64, period: f64, phase: f64 },
    /// A Hertzian seat gives way by this, m, at the largest load, and with F^(2/3) below.
    Seat(f64),
    /// A rod that runs in: the first loading gives this share more, less by e with every so many
    /// loadings.
    RunningIn { share: f64, loadings: f64 },
    /// A channel that does not go beyond this, m.
    Saturation { channel: usize, limit: f64 },
    /// A clamp that is loose for loads against the axes: so much more displacement there.
    LooseClamp(f64),
    /// Floor or clamp swing: amplitude m in {T}, period s, phase rad.
    Oscillation { amplitude: [f64; 3], period: f64, phase: f64 },
    /// A wall that is thicker and thinner along the rod: bending × (1 + a·sin(2πs/period + phase)),
    /// period m.
    Waviness { amplitude: f64, period: f64, phase: f64 },
    /// What the load before leaves behind: displacement × (1 + k·F_before/F_largest), a product of
    /// two loads.
    LoadBefore(f64),
    /// A damped slide: this share of a change of the load comes late, with this time constant, s.
    Damping { share: f64, time: f64 },
    /// Friction of a slide that wears: N in the first run, N in the last, growing evenly between.
    WearingFriction { first: f64, last: f64 },
    /// A rod whose stiffness depends on the speed of loading: displacement ×
    /// (1 + k·log₁₀(1 + |v|/v₀)), v the change of the load over the time between two readings, v₀ a
    /// thousandth of the largest load per second.
    SpeedOfLoading(f64),
    /// A clamp that slips little by little: `per_newton`·z, m, along the load, z (N) by the
    /// equation of Bouc and Wen. SimulatedCase to order only.
    SlippingClamp { per_newton: f64, yield_load: f64, sharpness: f64, balance: f64 },
}

impl Effect {
    /// The name of the effect; of those outside the library a name of the generator's own.
    pub fn name(&self) -> EffectName {
        match self {
            Effect::StiffnessScale(_) => EffectName::StiffnessScale,
            Effect::ShearModulus(_) => EffectName::ShearModulus,
            Effect::Joint { .. } => EffectName::JointCompliance,
            Effect::Root { .. } => EffectName::RootCompliance,
            Effect::Bend(_) => EffectName::BendFlexibility,
            Effect::PipeStiffness { .. } => EffectName::PipeStiffness,
            Effect::Dimension { .. } => EffectName::RodDimension,
            Effect::Point { end: End::Load, .. } => EffectName::LoadPoint,
            Effect::Point { end: End::Reading, .. } => EffectName::SensorPoint,
            Effect::Friction { .. } => EffectName::Friction,
            Effect::LoadOffset { .. } => EffectName::LoadOffset,
            Effect::Backlash { .. } => EffectName::Backlash,
            Effect::Creep { .. } => EffectName::Creep,
            Effect::Hysteresis { .. } => EffectName::Hysteresis,
            Effect::Cubic(_) | Effect::Quadratic(_) => EffectName::NonlinearStiffness,
            Effect::SensorScale { .. } => EffectName::SensorScale,
            Effect::SensorMisalignment { .. } | Effect::SensorBlock(_) => EffectName::SensorMisalignment,
            Effect::LoadMisalignment { .. } | Effect::LoadFrame(_) => EffectName::LoadMisalignment,
            Effect::Drift { .. } | Effect::DriftOfAll { .. } => EffectName::ThermalDrift,
            Effect::Slip { .. } | Effect::Shift { .. } => EffectName::Slip,
            Effect::Outlier(_) => EffectName::Outlier,
            Effect::GapCloses { .. } => EffectName::GapThatCloses,
            Effect::Ripple { .. } => EffectName::SensorRipple,
            Effect::Seat(_) => EffectName::HertzianSeat,
            Effect::RunningIn { .. } => EffectName::RunningIn,
            Effect::Saturation { .. } => EffectName::SensorSaturation,
            Effect::LooseClamp(_) => EffectName::ClampLooseOneWay,
            Effect::Oscillation { .. } => EffectName::OscillationInTime,
            Effect::Waviness { .. } => EffectName::VaryingWall,
            Effect::LoadBefore(_) => EffectName::LoadHistory,
            Effect::Damping { .. } => EffectName::DampedSlide,
            Effect::WearingFriction { .. } => EffectName::WearingFriction,
            Effect::SpeedOfLoading(_) => EffectName::SpeedOfLoading,
            Effect::SlippingClamp { .. } => EffectName::SlippingClamp,
        }
    }

    /// Where it is.
    pub fn place(&self, protocol: &Protocol) -> Place {
        let of_axis = |part: &str, axis: &Option<usize>| match axis {
            Some(axis) => Place::part(part).loads_along(AXES[*axis]),
            None => Place::part(part),
        };
        let channel = |channel: usize| Some(format!("d{}", AXES[channel]));
        let of_channel = |index: usize| Place { channel: channel(index), ..Place::default() };
        match self {
            Effect::Joint { name: Some(name), .. } => Place::named(name),
            Effect::Joint { station, .. } => Place { station_mm: Some(station / MM), ..Place::default() },
            Effect::Root { .. } => Place::part("root"),
            Effect::Bend(_) => Place::part("bend"),
            Effect::PipeStiffness { pipe, .. } => Place::part(if *pipe == 0 { "pipe 1" } else { "pipe 2" }),
            Effect::Dimension { which, .. } => Place::part(match which {
                Dimension::Leg(0) => "length l1",
                Dimension::Leg(_) => "length l2",
                Dimension::Angle => "angle γ",
            }),
            Effect::Point { end, station, .. } => match (protocol.stations_of(*end).len() > 1, end) {
                (true, _) => Place { station_mm: Some(station / MM), ..Place::default() },
                (false, End::Load) => Place::part("load point"),
                (false, End::Reading) => Place::part("read point"),
            },
            Effect::Friction { axis, .. } => of_axis("slide", axis),
            Effect::LoadOffset { axis, .. } => of_axis("hanger", axis),
            Effect::Backlash { axis, .. } => of_axis("clamp", axis),
            Effect::SensorScale { channel, .. }
            | Effect::Drift { channel, .. }
            | Effect::Ripple { channel, .. }
            | Effect::Saturation { channel, .. } => of_channel(*channel),
            Effect::SensorBlock(_) | Effect::DriftOfAll { .. } => Place::part("sensors"),
            Effect::LoadFrame(_) => Place::part("load frame"),
            Effect::SensorMisalignment { channel, towards, .. } => {
                Place { towards: Some(format!("d{}", AXES[*towards])), ..of_channel(*channel) }
            }
            Effect::LoadMisalignment { axis, towards, frame: true, .. } => {
                let (a, b) = (axis.min(towards), axis.max(towards));
                let axes = Axes::Two([AXES[*a].into(), AXES[*b].into()]);
                Place { loads_along: Some(axes), about: Some(AXES[3 - a - b].into()), ..Place::default() }
            }
            Effect::LoadMisalignment { axis, towards, .. } => {
                let place = Place::default().loads_along(AXES[*axis]);
                Place { towards: Some(AXES[*towards].into()), ..place }
            }
            Effect::Slip { loading, channel: own, .. } => {
                let is_along = protocol.loadings.get(*loading).is_none_or(|l| l.axis == *own);
                Place {
                    after_row: Some(*loading),
                    channel: channel(*own).filter(|_| !is_along),
                    ..protocol.run_place(*loading)
                }
            }
            Effect::Shift { loading, channel: own, .. } => {
                // the last row before in which the channel was read
                let was_read = |row: &usize| protocol.channels.get(*row).is_some_and(|read| read[*own]);
                let last = (0..*loading).rev().find(was_read).unwrap_or(0);
                Place { after_row: Some(last + 1), channel: channel(*own), ..protocol.run_place(last) }
            }
            Effect::Outlier(cells) => match cells.as_slice() {
                [(cell, _)] => protocol.cell_place(*cell),
                cells => {
                    let all = cells.iter().map(|(cell, _)| protocol.cell_place(*cell)).collect();
                    Place { all, ..Place::default() }
                }
            },
            _ => Place::part("rod"),
        }
    }

    /// Its numbers, by their names at the boundary.
    pub fn parameters(&self) -> Vec<(&'static str, f64)> {
        match self {
            Effect::StiffnessScale(factor) | Effect::ShearModulus(factor) | Effect::Bend(factor) => {
                vec![("factor", *factor)]
            }
            Effect::PipeStiffness { factor, .. } => vec![("factor", *factor)],
            Effect::Dimension { which: Dimension::Leg(_), stated, by } => {
                vec![("length_mm", (stated + by) / MM)]
            }
            Effect::Dimension { which: Dimension::Angle, stated, by } => {
                vec![("gamma_deg", (stated + by) / DEG)]
            }
            Effect::Point { by, .. } => vec![("along_mm", by / MM)],
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
            Effect::SensorBlock(turn) | Effect::LoadFrame(turn) => {
                ["about_x_deg", "about_y_deg", "about_z_deg"].into_iter().zip(turn.map(|t| t / DEG)).collect()
            }
            Effect::DriftOfAll { rates, by_time: true } => ["dx_um_per_h", "dy_um_per_h", "dz_um_per_h"]
                .into_iter()
                .zip(rates.map(|rate| rate / UM * 3600.0))
                .collect(),
            Effect::DriftOfAll { rates, .. } => {
                ["dx_um_per_k", "dy_um_per_k", "dz_um_per_k"].into_iter().zip(rates.map(|r| r / UM)).collect()
            }
            Effect::Slip { by, .. } | Effect::Shift { by, .. } => vec![("um", by / UM)],
            Effect::Outlier(cells) => cells.iter().map(|(_, by)| ("um", by / UM)).collect(),
            Effect::GapCloses { load, share } => vec![("load_n", *load), ("share", *share)],
            Effect::Ripple { amplitude, period, .. } => {
                vec![("amplitude_um", amplitude / UM), ("period_um", period / UM)]
            }
            Effect::Seat(depth) => vec![("um", depth / UM)],
            Effect::RunningIn { share, loadings } => vec![("share", *share), ("loadings", *loadings)],
            Effect::Saturation { limit, .. } => vec![("limit_um", limit / UM)],
            Effect::LooseClamp(share) | Effect::LoadBefore(share) | Effect::SpeedOfLoading(share) => {
                vec![("share", *share)]
            }
            Effect::Oscillation { amplitude, period, .. } => {
                vec![("um", amplitude.iter().map(|a| a * a).sum::<f64>().sqrt() / UM), ("period_s", *period)]
            }
            Effect::Waviness { amplitude, period, .. } => {
                vec![("share", *amplitude), ("period_mm", period / MM)]
            }
            Effect::Damping { share, time } => vec![("share", *share), ("time_s", *time)],
            Effect::WearingFriction { first, last } => vec![("first_n", *first), ("last_n", *last)],
            Effect::SlippingClamp { per_newton, yield_load, .. } => {
                vec![("um_per_n", per_newton / UM), ("yield_n", *yield_load)]
            }
        }
    }

    /// What belongs to one run or to one reading: no other run shows it.
    pub fn is_of_one_run(&self) -> bool {
        matches!(self, Effect::Slip { .. } | Effect::Shift { .. } | Effect::Outlier(_))
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
