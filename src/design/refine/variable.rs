//! What may vary between the values of a design file's grid.

use crate::design::space::DesignSpace;
use crate::rod::{NominalNumber, Part, Rod};
use crate::section::{Round, Section};

/// What may vary.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Variable {
    /// The numbers of the rod that it moves, each by how much.
    pub(super) moves: Vec<(NominalNumber, f64)>,
    pub(super) low: f64,
    pub(super) high: f64,
}

impl Variable {
    /// Its value on `rod`: that of its first number, or of the wall.
    pub(super) fn value(&self, rod: &Rod) -> f64 {
        let number = match &self.moves[0] {
            (NominalNumber::InnerDiameter(part), by) if *by < 0.0 => NominalNumber::Wall(*part),
            (number, _) => number.clone(),
        };
        rod.value_of(&number).unwrap_or(f64::NAN)
    }
}

/// `rod` after a step in the logarithms of the variables.
pub(super) fn moved(rod: &Rod, variables: &[Variable], step: &[f64]) -> Rod {
    let mut moved = rod.clone();
    for (variable, step) in variables.iter().zip(step) {
        let now = variable.value(rod);
        let change = (now * step.exp()).clamp(variable.low, variable.high) - now;
        for (number, by) in &variable.moves {
            let value = moved.value_of(number).unwrap_or(f64::NAN) + by * change;
            moved = moved.with(number, value);
        }
    }
    // what sits along the rod stays where the design file has it
    moved.masses.clone_from(&rod.masses);
    moved.joints.clone_from(&rod.joints);
    moved.sleeves.clone_from(&rod.sleeves);
    moved
}

/// Lengths, angle, bend and tip, where they are ranges.
pub(super) fn lengths(space: &DesignSpace, rod: &Rod) -> Vec<Variable> {
    let all = [
        (NominalNumber::LengthL1, &space.l1, rod.l1),
        (NominalNumber::LengthL2, &space.l2, rod.l2),
        (NominalNumber::Angle, &space.gamma, rod.gamma),
        (NominalNumber::BendRadius, &space.bend_radius, rod.bend_radius),
        (NominalNumber::TipMass, &space.tip_mass, rod.tip_mass),
    ];
    let varies = |(k, (number, values, now)): (usize, (NominalNumber, &Vec<f64>, f64))| {
        let positive = || values.iter().copied().filter(|value| *value > 0.0);
        let least = positive().fold(f64::INFINITY, f64::min);
        let [from, high] = space.ranges[k]?;
        // of what may be nothing, the least that is something
        let low = if from > 0.0 { from } else { least.min(high) };
        (low < high && now > 0.0).then(|| Variable { moves: vec![(number, 1.0)], low, high })
    };
    all.into_iter().enumerate().filter_map(varies).collect()
}

/// Outer diameter (at its wall) and wall (at its outer diameter) of the tubes.
pub(super) fn diameters(space: &DesignSpace, rod: &Rod) -> Vec<Variable> {
    let of_parts = |parts: &[Part], material: &str| -> Vec<Variable> {
        let rounds: Vec<&Round> = (space.tubes.iter())
            .filter(|tube| tube.pipe.material.name == material)
            .filter_map(|tube| tube.pipe.section.as_round())
            .filter(|round| round.inner_diameter > 0.0)
            .collect();
        let between = |value: fn(&Round) -> f64| {
            let all = || rounds.iter().map(|round| value(round));
            (all().fold(f64::INFINITY, f64::min), all().fold(0.0, f64::max))
        };
        let outer = parts
            .iter()
            .flat_map(|part| {
                [(NominalNumber::OuterDiameter(*part), 1.0), (NominalNumber::InnerDiameter(*part), 1.0)]
            })
            .collect();
        let wall = parts.iter().map(|part| (NominalNumber::InnerDiameter(*part), -2.0)).collect();
        let all = [(outer, between(|round| round.outer_diameter)), (wall, between(Round::wall))];
        let varies = |(moves, (low, high))| (low < high).then_some(Variable { moves, low, high });
        all.into_iter().filter_map(varies).collect()
    };
    let is_tube = |section: &Section| section.as_round().is_some_and(|round| round.inner_diameter > 0.0);
    if !is_tube(&rod.pipe1.section) || !is_tube(&rod.pipe2.section) {
        return Vec::new();
    }
    match space.is_one_tube {
        true => of_parts(&[Part::Pipe1, Part::Pipe2], &rod.pipe1.material.name),
        false => [(Part::Pipe1, &rod.pipe1), (Part::Pipe2, &rod.pipe2)]
            .iter()
            .flat_map(|(part, pipe)| of_parts(&[*part], &pipe.material.name))
            .collect(),
    }
}
