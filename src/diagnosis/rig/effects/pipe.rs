//! One pipe of the rod that is not as stiff as its file says.

use super::entry::{RigEffect, Usual, along_the_load, entry, number, parameter};
use crate::diagnosis::rig::mechanics::action::Action;
use crate::diagnosis::rig::mechanics::structure::{WhichPipe, with_stiffer};
use crate::inference::{Candidate, Effect, Kind, Location, Part, Quantity, Reported, WrittenTo};
use crate::units::capital;

/// Walls of tubes are within 12.5 % (EN ISO 1127, class T2), moduli of laminates within 10 %.
const SHARE: f64 = 0.15;
/// A pipe is at most as far off as steel is from aluminium: beyond that it imitates what connects
/// it.
const SCALES: (f64, f64) = (1.0 / 3.0, 3.0);
/// A pipe has two places and a connection forty, each as rare: where both explain alike, neither is
/// to crowd the other out.
const RARE: f64 = 2.0 / 40.0;

/// The pipes as places.
const PIPES: [(Part, WhichPipe); 2] = [(Part::Pipe1, WhichPipe::First), (Part::Pipe2, WhichPipe::Second)];

/// Moduli, or walls, of one pipe.
pub static PIPE_STIFFNESS: RigEffect = RigEffect {
    effect: Effect {
        name: "pipe_stiffness",
        kind: Kind::Physics,
        summary: "one pipe of the rod is softer or stiffer than stated",
        formula: "E → f·E, G → f·G in one pipe and its sleeves",
        prior: "15 %: walls of tubes are within 12.5 % (EN ISO 1127, class T2); each pipe as rare as one of forty places of a joint",
        parameters: &[(&["factor"], "actual over nominal stiffness")],
        needs: "a rod file",
        cause: "its moduli, walls or length differ from the rod file",
        cause_at: |place| format!("moduli, walls or lengths of {place} that differ from the rod file"),
        written_to: WrittenTo::Model,
        reported: Reported::Alone,
        seen_along: along_the_load,
        direct_check: None,
    },
    usual: &[Usual::Share(SHARE)],
    needs_rod: true,
    candidates: |context| {
        let size = SHARE * context.stiffness.max(1.0);
        let of_pipe = |(part, pipe)| {
            let factor = parameter("factor", 1.0, size, SCALES);
            let (candidate, actions) =
                entry(&PIPE_STIFFNESS, Location::Part(part), factor, Action::StiffnessOf(pipe));
            (Candidate { weight: RARE / PIPES.len() as f64, ..candidate }, actions)
        };
        PIPES.map(of_pipe).into()
    },
    missing: |_| "these loads do not deform it",
    observed: |finding, _| {
        let (pipe, factor) = (capital(finding.location.to_string()), number(finding, "factor"));
        let softer: Quantity = factor.map(|factor| 1.0 / factor);
        format!("{pipe} is {} than in the model", softer.compared("softer", "stiffer"))
    },
    write: |term, model, rod| {
        let place = &model.candidates[term.candidate].location;
        let own = PIPES.iter().find(|(part, _)| *place == Location::Part(*part));
        let Some((_, pipe)) = own else { return WrittenTo::Nowhere };
        *rod = with_stiffer(rod, *pipe, term.values[0]);
        WrittenTo::Model
    },
};
