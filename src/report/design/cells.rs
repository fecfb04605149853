//! What all tables and the JSON of designs share: figures, shapes, limits, digits.

use serde_json::{Map, Value, json};

use crate::design::{Design, Figure, KnownDesign, Limit, Study};
use crate::report::table::Column;
use crate::rod::Rod;
use crate::units::{DEG, GRAM, MM, significant};

/// Digits of a figure in a table.
pub const DIGITS: usize = 4;

/// The figures that are known, by key.
pub fn figures_json(design: &Design) -> Map<String, Value> {
    let known = |figure: Figure| Some((figure.key().to_owned(), json!(design.figures.get(figure)?)));
    Figure::ALL.into_iter().filter_map(known).collect()
}

/// The figures of a table: the goals first, then the others that every design has.
pub fn columns(study: &Study) -> Vec<Figure> {
    let mut figures: Vec<Figure> = study.space.goals.iter().map(|goal| goal.figure).collect();
    let more = [Figure::CRod, Figure::Mass, Figure::FirstFrequency, Figure::Reach];
    figures.extend(
        more.into_iter().filter(|figure| study.space.goals.iter().all(|goal| goal.figure != *figure)),
    );
    figures
}

/// Lengths, angle, bend and tip; the sleeves, where rods may differ in them.
pub fn shape_columns(study: &Study) -> Vec<Column> {
    let mut columns = vec![
        Column::number("L1", "mm"),
        Column::number("L2", "mm"),
        Column::number("γ", "°"),
        Column::number("R", "mm"),
        Column::number("tip", "g"),
    ];
    if are_sleeves_optional(study) {
        columns.push(Column::text("sleeves"));
    }
    columns
}

/// Whether rods may differ in their sleeves.
pub fn are_sleeves_optional(study: &Study) -> bool {
    !study.space.optional_sleeves.is_empty()
}

/// What stands below [`shape_columns`].
pub fn shape_cells(study: &Study, rod: &Rod) -> Vec<String> {
    // as a drawing has them: no zeros behind, and none of the rounding of units
    let mut cells = [rod.l1 / MM, rod.l2 / MM, rod.gamma / DEG, rod.bend_radius / MM, rod.tip_mass / GRAM]
        .map(|value| ((value * 1e3).round() / 1e3).to_string())
        .to_vec();
    if are_sleeves_optional(study) {
        cells.push(sleeves_of(rod));
    }
    cells
}

/// `collar + stub`, or `none`.
pub fn sleeves_of(rod: &Rod) -> String {
    let names: Vec<&str> = rod.sleeves.iter().map(|sleeve| sleeve.name.as_str()).collect();
    if names.is_empty() { "none".to_owned() } else { names.join(" + ") }
}

/// What is known of the design at a place of the front; they stand in its order.
pub fn known_at(study: &Study, place: usize) -> Option<&KnownDesign> {
    let at = study.known.binary_search_by(|known| known.place.cmp(&place)).ok()?;
    study.known.get(at)
}

/// Half of a figure's 95 % interval; a price has none.
pub fn half_of(known: &KnownDesign, figure: Figure) -> Option<f64> {
    known.intervals.half.get(figure).filter(|_| figure != Figure::Price)
}

/// The names of a design's tubes.
pub fn tube_of(study: &Study, design: &Design) -> String {
    study.space.tubes_of(design.index).join(" + ")
}

/// `mass, at most`.
pub fn limit_name(limit: &Limit) -> String {
    let name = limit.figure.name_and_unit().0;
    format!("{name}, at {}", if limit.is_least { "least" } else { "most" })
}

/// `mass, at most 900.0 g`.
pub fn limit_words(limit: &Limit) -> String {
    let (value, unit) = (significant(limit.value, DIGITS), limit.figure.name_and_unit().1);
    format!("{} {value} {unit}", limit_name(limit))
}

/// `1 rod`, `3 rods`.
pub fn count(number: u64, noun: &str) -> String {
    format!("{number} {noun}{}", if number == 1 { "" } else { "s" })
}
