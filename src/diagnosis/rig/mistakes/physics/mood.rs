//! How far off rod, rig and sensors may be, beside any mistake.

/// Standard deviations of the columns: how far off rod, rig and sensors are.
pub(super) struct Mood {
    pub log_weight: f64,
    /// Of the common factor about its best value, and of that value about 1.
    pub scale: (f64, f64),
    pub shear: f64,
    pub joint: f64,
    pub axis: f64,
    pub channel: f64,
    pub turn: f64,
    pub own: f64,
}

/// As files are: moduli 2 %, alignment 1°.
const FILE: Mood = Mood {
    log_weight: -0.7,
    scale: (0.02, 0.02),
    shear: 0.03,
    joint: 0.02,
    axis: 0.01,
    channel: 0.01,
    turn: 0.02,
    own: 0.01,
};
/// Four times that.
const SOME: Mood = Mood {
    log_weight: -1.2,
    scale: (0.02, 0.08),
    shear: 0.12,
    joint: 0.08,
    axis: 0.04,
    channel: 0.04,
    turn: 0.08,
    own: 0.03,
};
/// Everything far off.
const MUCH: Mood = Mood {
    log_weight: -3.0,
    scale: (0.05, 0.4),
    shear: 0.3,
    joint: 0.2,
    axis: 0.15,
    channel: 0.12,
    turn: 0.15,
    own: 0.15,
};
/// One common factor: moduli or walls are not those of the file; a rod that is three times softer
/// is within three times this.
const STIFFNESS: Mood = Mood { log_weight: -5.0, scale: (0.02, 0.45), ..FILE };
pub(super) const MOODS: [Mood; 4] = [FILE, SOME, MUCH, STIFFNESS];
