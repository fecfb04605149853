//! Lengths and the angle of the rod that are not those of its file.

use std::f64::consts::PI;

use super::entry::{RigEffect, Usual, along_the_load, entry, number, parameter};
use crate::diagnosis::rig::mechanics::action::Action;
use crate::diagnosis::rig::mechanics::structure::Varied;
use crate::diagnosis::rig::model::Body;
use crate::inference::{Candidate, Effect, Kind, Location, Part, Quantity, Reported, WrittenTo};
use crate::rod::NominalNumber;
use crate::units::{DEG, MM};

/// A length that was measured to another point of the rod, as a share of itself.
const LENGTH: f64 = 0.03;
/// An angle that was taken from the drawing and not from the rod, rad.
const ANGLE: f64 = 2.0 * DEG;
/// Beyond that share it is another rod; beyond that angle too.
const MOST: f64 = 0.25;
const MOST_ANGLE: f64 = 15.0 * DEG;
/// There are three of them and forty places of a connection, each as rare: where both explain
/// alike, neither is to crowd the other out.
const RARE: f64 = 3.0 / 40.0;
/// A number that can be another one by less than this share of its usual error is not tried: a pipe
/// that its bend takes up has no other length.
const LEAST: f64 = 0.5;

/// A length or the angle of the rod.
pub static ROD_DIMENSION: RigEffect = RigEffect {
    effect: Effect {
        name: "rod_dimension",
        kind: Kind::Physics,
        summary: "a length or the angle of the rod is another one than stated",
        formula: "C of the rod with that l1, l2 or γ",
        prior: "3 % of the length, 2° of the angle; each as rare as one of forty places of a joint",
        parameters: &[(&["length_mm"], "actual length"), (&["gamma_deg"], "actual angle")],
        needs: "a rod file",
        cause: "a dimension that differs from the rod file",
        cause_at: |place| format!("another {place} than that of the rod file"),
        written_to: WrittenTo::Model,
        reported: Reported::Alone,
        seen_along: along_the_load,
        direct_check: None,
    },
    usual: &[Usual::Share(LENGTH), Usual::Angle(ANGLE)],
    needs_rod: true,
    candidates: |context| {
        let Body::Rod(structure) = &mut *context.body else { return Vec::new() };
        let rod = structure.rod().clone();
        let lengths = [
            (Part::Length1, NominalNumber::LengthL1, rod.l1),
            (Part::Length2, NominalNumber::LengthL2, rod.l2),
        ];
        let lengths = lengths.map(|(part, number, value)| {
            // what is left of a pipe beside its bend
            let most = (MOST * value).min(0.9 * (value - rod.tangent_length()));
            (part, number, "length_mm", value, LENGTH * value, most)
        });
        // pipes in one line are as straight as they can be
        let most = MOST_ANGLE.min(PI - rod.gamma);
        let angle = (Part::Angle, NominalNumber::Angle, "gamma_deg", rod.gamma, ANGLE, most);
        let mut entries = Vec::new();
        for (part, number, name, value, size, most) in lengths.into_iter().chain([angle]) {
            if most < LEAST * size {
                continue;
            }
            let Some(own) = structure.add_variation(Varied::Number(number, value), most) else { continue };
            let own_parameter = parameter(name, value, size, (value - most, value + most));
            let (candidate, actions) =
                entry(&ROD_DIMENSION, Location::Part(part), own_parameter, Action::Varied(own, [true; 3]));
            entries.push((Candidate { weight: RARE / 3.0, ..candidate }, actions));
        }
        entries
    },
    missing: |_| "these loads do not show it",
    observed: |finding, model| {
        let is_angle = finding.location == Location::Part(Part::Angle);
        let (name, unit, si) = if is_angle { ("gamma_deg", "°", DEG) } else { ("length_mm", "mm", MM) };
        let space = if is_angle { "" } else { " " };
        let own: Quantity = number(finding, name);
        let candidate = finding.parts.first().map(|part| &model.candidates[part.term.candidate]);
        let stated = candidate.map_or(f64::NAN, |own| own.parameters[0].neutral / si);
        let stated = (100.0 * stated).round() / 100.0;
        format!("The {} is {}, not {stated}{space}{unit}", finding.location, own.with_unit(unit))
    },
    write: |term, model, rod| {
        let number = match model.candidates[term.candidate].location {
            Location::Part(Part::Length1) => NominalNumber::LengthL1,
            Location::Part(Part::Length2) => NominalNumber::LengthL2,
            Location::Part(Part::Angle) => NominalNumber::Angle,
            _ => return WrittenTo::Nowhere,
        };
        *rod = rod.with(&number, term.values[0]);
        WrittenTo::Model
    },
};
