//! The front as a table for other programs, and the shown rods as rod files.

use super::cells::{are_sleeves_optional, half_of, known_at, sleeves_of, tube_of};
use super::refined;
use crate::design::{Figure, Shown, Study};
use crate::error::Result;
use crate::report::table::{Column, Table};
use crate::units::{DEG, GRAM, MM, significant};

/// `designs.csv`: every design of the front, and the shown rods as rod files.
///
/// # Errors
/// What the writer of tables refuses.
pub fn files(study: &Study) -> Result<Vec<(String, Vec<u8>)>> {
    let mut heads = vec![Column::number("design", ""), Column::text("tube")];
    heads.extend(
        ["l1_mm", "l2_mm", "gamma_deg", "bend_radius_mm", "tip_mass_g"].map(|key| Column::number(key, "")),
    );
    let figures: Vec<Figure> = Figure::ALL
        .into_iter()
        .filter(|figure| study.found.front.iter().any(|design| design.figures.get(*figure).is_some()))
        .collect();
    heads.extend(figures.iter().map(|figure| Column::number(figure.key(), "")));
    // ± of each figure, where all of the front is known
    let halves: Vec<Figure> = figures
        .iter()
        .copied()
        .filter(|figure| *figure != Figure::Price && !study.known.is_empty())
        .collect();
    heads.extend(halves.iter().map(|figure| Column::number(format!("{}_half_95", figure.key()), "")));
    let are_sleeves_optional = are_sleeves_optional(study);
    heads.extend(are_sleeves_optional.then(|| Column::text("sleeves")));
    let mut table = Table::new("front", "", heads);
    for (place, design) in study.found.front.iter().enumerate() {
        let Ok(rod) = study.space.rod(design.index) else { continue };
        let mut cells = vec![(place + 1).to_string(), tube_of(study, design)];
        let shape = [rod.l1 / MM, rod.l2 / MM, rod.gamma / DEG, rod.bend_radius / MM, rod.tip_mass / GRAM];
        cells.extend(shape.map(|value| significant(value, 9)));
        cells.extend(
            figures.iter().map(|figure| {
                design.figures.get(*figure).map_or(String::new(), |value| significant(value, 9))
            }),
        );
        let half = |figure: &Figure| half_of(known_at(study, place)?, *figure);
        cells.extend(
            halves.iter().map(|figure| half(figure).map_or(String::new(), |half| significant(half, 3))),
        );
        cells.extend(are_sleeves_optional.then(|| sleeves_of(&rod)));
        table.row(cells);
    }
    let mut files = vec![("designs.csv".to_owned(), table.csv()?.into_bytes())];
    let above = [format!(
        "A design for {}; its numbers are those of the design file and its catalogue.",
        study.space.file
    )];
    let of_rod = |shown: &Shown| {
        (format!("design-{:03}.toml", shown.place + 1), shown.rod.to_toml(&above).into_bytes())
    };
    files.extend(study.shown.iter().map(of_rod));
    files.extend(study.refined.iter().flat_map(|found| refined::files(found, &above)));
    Ok(files)
}
