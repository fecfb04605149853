//! A rod as it is drawn: its tubes, and what is mounted on them.

use super::pictures::{RodShape, Station, StationKind, Tube};
use crate::rod::{Joint, LumpedMass, Pipe, Rod};
use crate::section::Section;
use crate::units::{GRAM, MM, significant};

/// The drawing of a rod, still without a centreline and without load cases.
pub(super) fn drawing(rod: &Rod) -> RodShape {
    RodShape {
        title: format!("Rod {}", rod.name),
        tubes: tubes(rod),
        stations: stations(rod),
        ..RodShape::default()
    }
}

/// Where masses and joints sit.
pub(super) fn stations(rod: &Rod) -> Vec<Station> {
    let at = |station: f64| (rod.point(station) / MM).into();
    let mass = |m: &LumpedMass| Station {
        label: format!("{}, {} g", m.name, significant(m.mass / GRAM, 3)),
        at_mm: at(m.station),
        kind: StationKind::Mass,
    };
    let joint = |j: &Joint| Station { label: j.name.clone(), at_mm: at(j.station), kind: StationKind::Joint };
    let tip = (rod.tip_mass > 0.0).then(|| Station {
        label: format!("tip, {} g", significant(rod.tip_mass / GRAM, 3)),
        at_mm: (rod.tip() / MM).into(),
        kind: StationKind::Mass,
    });
    rod.masses.iter().map(mass).chain(rod.joints.iter().map(joint)).chain(tip).collect()
}

/// Pipe I, bend, pipe II and sleeves; none where a section is known by its constants alone, for
/// that has no sizes to draw.
fn tubes(rod: &Rod) -> Vec<Tube> {
    let (start, end, length) = (rod.bend_start(), rod.bend_end(), rod.length());
    let parts = [
        ("pipe I", &rod.pipe1, 0.0, start),
        ("bend", &rod.bend, start, end),
        ("pipe II", &rod.pipe2, end, length),
    ];
    let sleeves = rod.sleeves.iter().map(|own| (own.name.as_str(), &own.pipe, own.from, own.to));
    let tube = |(name, pipe, from, to): (&str, &Pipe, f64, f64), is_sleeve: bool| {
        let (outer_mm, inner_mm, size) = sizes(&pipe.section)?;
        // the bend's is mostly that of pipe I, and there is little room
        let label = match !is_sleeve && name == "bend" && pipe.section == rod.pipe1.section {
            true => String::new(),
            false => format!("{name}, {size}, {}", pipe.material.name),
        };
        Some(Tube { label, from_mm: from / MM, to_mm: to / MM, outer_mm, inner_mm, is_sleeve })
    };
    let there = parts.into_iter().filter(|(_, _, from, to)| to > from);
    let pipes = there.map(|part| tube(part, false));
    pipes.chain(sleeves.map(|sleeve| tube(sleeve, true))).collect::<Option<Vec<Tube>>>().unwrap_or_default()
}

/// Outer and inner sizes in the rod's plane and across it (mm), and both in words.
fn sizes(section: &Section) -> Option<([f64; 2], [f64; 2], String)> {
    // as a drawing has it: 50, not 50.00
    let mm = |size: f64| ((size / MM * 1e3).round() / 1e3).to_string();
    match section {
        Section::Round(round) => {
            let (outer, inner) = (round.outer_diameter / MM, round.inner_diameter / MM);
            let words = match inner > 0.0 {
                true => format!(
                    "Ø\u{a0}{} × {}\u{a0}mm",
                    mm(round.outer_diameter),
                    mm(0.5 * (round.outer_diameter - round.inner_diameter))
                ),
                false => format!("Ø\u{a0}{}\u{a0}mm, solid", mm(round.outer_diameter)),
            };
            Some(([outer; 2], [inner; 2], words))
        }
        Section::Rectangle(rectangle) => {
            let outer = [rectangle.height / MM, rectangle.width / MM];
            let (inner, wall) = match rectangle.wall {
                Some(wall) => (outer.map(|size| size - 2.0 * wall / MM), format!(" × {}", mm(wall))),
                None => ([0.0; 2], String::new()),
            };
            Some((outer, inner, format!("{} × {}{wall}\u{a0}mm", mm(rectangle.height), mm(rectangle.width))))
        }
        Section::General(_) => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rod::BendFlexibility;
    use crate::section::{General, Rectangle, Round};

    #[test]
    fn tubes_are_those_of_the_rod_file() {
        let rod = Rod::read("rods/2.toml".as_ref()).unwrap();
        let drawn = drawing(&rod.clone().with_bend(0.05, BendFlexibility::Beam)).tubes;
        let labels: Vec<&str> = drawn.iter().map(|tube| tube.label.as_str()).collect();
        assert_eq!(
            labels,
            ["pipe I, Ø\u{a0}50 × 4\u{a0}mm, carbon", "", "pipe II, Ø\u{a0}50 × 1.9\u{a0}mm, carbon"]
        );
        assert_eq!(drawn[2].inner_mm, [46.2; 2]);
        // a sharp corner has no bend, a section without sizes no drawing
        assert_eq!(drawing(&rod).tubes.len(), 2);
        let mut general = rod.clone();
        general.pipe2.section =
            General { area: 1e-4, iy: 3e-9, iz: 2e-9, torsion_constant: 4e-9, shear_coefficient: 0.5 }.into();
        assert!(drawing(&general).tubes.is_empty());
        let collar = Pipe::new(Round::tube(0.06, 0.05), rod.pipe1.material.clone());
        let sleeved = drawing(&rod.clone().with_sleeve("collar", 0.2, 0.25, collar));
        let last = &sleeved.tubes[2];
        assert_eq!((last.label.as_str(), last.is_sleeve), ("collar, Ø\u{a0}60 × 5\u{a0}mm, carbon", true));
        assert!((last.from_mm - 200.0).abs() < 1e-9 && (last.to_mm - 250.0).abs() < 1e-9);
        let mut flat = rod;
        flat.pipe2.section = Rectangle::hollow(0.03, 0.02, 0.002).into();
        let tube = &drawing(&flat).tubes[1];
        assert_eq!((tube.outer_mm, tube.inner_mm[0].round()), ([20.0, 30.0], 16.0));
    }
}
