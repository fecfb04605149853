//! What makes every claim about a recording weaker.

use std::fmt;

use crate::spatial::Axis;
use crate::units::{MM, UM, significant};

/// A weakness of the recording or of its base model; its `Display` is the advice.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Limitation {
    /// Nothing was read twice under the same conditions.
    NoRepeats,
    /// Loads along one axis only.
    OneAxis(Axis),
    /// One size of load only.
    OneLoad,
    /// So few readings that a part held out leaves too little to learn from.
    FewReadings(usize),
    /// The loads jump where the displacement turns, as where it is the displacement that is set.
    JumpsAtTurns,
    /// Names, by their causes, that would be needed instead of a law, with so many numbers.
    NamesForLaw(String, usize),
    /// A law, described, that is as likely as the names.
    LawForNames(String),
    /// The readings have no folds that could be held out.
    NoFoldsOfReadings,
    /// The calibration did not come to rest.
    NotConverged,
    /// So many rows for so many parameters.
    FewPoses(usize, usize),
    /// A joint, from 0, that moved over so small a range, rad.
    NarrowJoint(usize, f64),
    /// A joint, from 0, whose axis the target lies on: so far beside it at most, m.
    OnAxis(usize, f64),
    /// Joint angles that are written to this many degrees, whose rounding alone scatters the tip by
    /// so much per coordinate, m.
    CoarseAngles(f64, f64),
    /// A clamp or placement that scatters far more than the others: its name, its scatter of a
    /// coordinate and that of the others in the middle, m.
    NoisyGroup(String, f64, f64),
    /// Poses that follow one another have errors in common: so much of the variance, over so many
    /// poses.
    CorrelatedPoses(f64, f64),
    /// The first pose, by its name, is so far off (m) as the way on which joints come moves others.
    UnknownArrival(String, f64),
    /// Poses, by their names, that may have been misread or be tails of the scatter of all.
    FarOut(Vec<String>),
    /// A joint, from 0, with play, and poses, by their names, whose load is too small to say to
    /// which side it pulls.
    UnknownSide(usize, Vec<String>),
    /// Another rod of the same folder, by its file, that these poses cannot distinguish from the
    /// stated one: they are so many times as probable with it.
    AnotherRod(String, f64),
    /// The poses are too few to hold any out.
    NoFoldsOfPoses,
}

impl fmt::Display for Limitation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Limitation::NoRepeats => f.write_str(
                "No reading was repeated: the scatter is estimated from the residuals of the best \
                 hypothesis, which weakens every conclusion. Read every load at least twice, each time \
                 from a new zero.",
            ),
            Limitation::OneAxis(axis) => write!(
                f,
                "Loads along {axis} only: many parts of the rod deflect alike under them. A second \
                 load axis shows more than repeats do.",
            ),
            Limitation::OneLoad => f.write_str(
                "One size of load only: friction, offsets and play cannot be distinguished from \
                 stiffness. Use three loads or more.",
            ),
            Limitation::FewReadings(count) => write!(
                f,
                "Only {count} readings: few are left to fit when some are held out, and small effects \
                 cannot be detected.",
            ),
            Limitation::JumpsAtTurns => f.write_str(
                "The displacement goes in even steps and the load jumps: was the displacement imposed and \
                 the load measured? Then write # driven = \"displacement\" above the table: the loads \
                 are compared with the model instead.",
            ),
            Limitation::NamesForLaw(causes, numbers) => write!(
                f,
                "Without the proposed law something would have to be named that explains no more, with {numbers} numbers \
                 or more: {causes}. The law needs fewer and predicts as well.",
            ),
            Limitation::LawForNames(law) => write!(
                f,
                "One law explains these readings as well as what is named, or better by less than the odds that it \
                 takes to replace it: {law}.",
            ),
            Limitation::NoFoldsOfReadings => f.write_str(
                "The readings are too few to hold any out: no finding is confirmed by \
                    prediction.",
            ),
            Limitation::NotConverged => f.write_str(
                "The calibration did not converge: its residuals do not describe the robot. Run rodcal \
                 calibrate first.",
            ),
            Limitation::FewPoses(rows, parameters) => write!(
                f,
                "Only {rows} poses for {parameters} calibrated parameters: these absorb most other \
                 errors, and small effects cannot be detected.",
            ),
            Limitation::NarrowJoint(joint, range) => write!(
                f,
                "Joint {} moved over {:.0}° only: effects that follow its angle cannot be detected.",
                joint + 1,
                range.to_degrees()
            ),
            Limitation::OnAxis(joint, lever) => write!(
                f,
                "Joint {} cannot be observed: the target lies on its axis (at most {:.2} mm away). \
                 Offset the tool.",
                joint + 1,
                lever / MM
            ),
            Limitation::CoarseAngles(step, tip) => write!(
                f,
                "Joint angles are written in steps of up to {}°: that alone scatters the tip by {} µm per coordinate. Write more \
                 digits.",
                significant(*step, 1),
                significant(tip / UM, 2)
            ),
            Limitation::NoisyGroup(name, own, others) => write!(
                f,
                "The poses of {name} scatter by {} µm per coordinate, {} times as much as the others ({} µm): look for what \
                 is loose, dirty or worn there. They count less.",
                significant(own / UM, 3),
                significant(own / others, 2),
                significant(others / UM, 3)
            ),
            Limitation::CorrelatedPoses(share, length) => write!(
                f,
                "Poses that follow one another have errors in common: {} % of the variance of what is left, over about {} \
                 poses. No effect of the library explains them. The uncertainties take them into account; an effect \
                 that changes as slowly is found only where it is larger. Measure the first poses again at the end, or in \
                 another order.",
                significant(100.0 * share, 2),
                significant(*length, 2),
            ),
            Limitation::UnknownArrival(pose, off) => write!(
                f,
                "{} is {} µm off. What was found may be the cause: where the arm came from before it was not recorded.",
                pose.replacen("pose", "Pose", 1),
                significant(off / UM, 3)
            ),
            Limitation::FarOut(poses) => write!(
                f,
                "Far out: {}. These poses cannot distinguish a misread one from a scatter that now and then throws one so far, \
                 so it counts less and is no finding. Measure it again.",
                poses.join(", ")
            ),
            Limitation::UnknownSide(joint, poses) => write!(
                f,
                "In {} the load of joint {} is too small to say to which side of its play it pulls: the poses \
                 say that it is the other one than the masses of the robot file do.",
                poses.join(", "),
                joint + 1
            ),
            Limitation::AnotherRod(file, odds) => {
                let times = significant(odds.max(1.0 / odds), 2);
                let which = if *odds < 1.0 { "less" } else { "more" };
                write!(
                    f,
                    "These poses cannot distinguish the rod from that of {file}: with that one they are {times} times \
                     {which} probable. Look which of the two was on the robot."
                )
            }
            Limitation::NoFoldsOfPoses => f.write_str(
                "The poses are too few to hold any out: no finding is confirmed by \
                    prediction.",
            ),
        }
    }
}
