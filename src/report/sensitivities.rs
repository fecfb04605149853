//! "1 % more wall gives …": what the numbers of a rod do to its figures, as rows, a table, bars and
//! JSON.

use serde_json::{Map, Value, json};

use super::chart::{Bar, Chart, Colour, Dash, Direction, Mark, Range, Style};
use super::table::{Column, Table};
use crate::rod::{NominalNumber, Part, Rod};
use crate::section::Section;
use crate::units::significant;

/// What 1 % more of one number does.
#[derive(Debug, Clone, PartialEq)]
pub struct OnePercent {
    /// The number in words.
    pub number: String,
    /// Its value in the unit of the rod file, with the unit.
    pub now: String,
    /// Change of each figure, %, in their order.
    pub percent: Vec<f64>,
}

/// What 1 % more of each number of `rod` does to `figures`, whose derivatives by it (per SI unit)
/// are `slopes`. Numbers of 0 are left out. Of a tube these are its wall and its outer diameter at
/// that wall; where both pipes are one tube, of both.
pub fn one_percent_more(rod: &Rod, slopes: &[(NominalNumber, Vec<f64>)], figures: &[f64]) -> Vec<OnePercent> {
    let of_number = |number: &NominalNumber| {
        let known = slopes.iter().find(|(known, _)| known == number);
        known.map_or(vec![0.0; figures.len()], |(_, slopes)| slopes.clone())
    };
    let sum = |a: Vec<f64>, b: Vec<f64>, times: f64| {
        a.into_iter().zip(b).map(|(a, b)| a + times * b).collect::<Vec<f64>>()
    };
    let row = |number: String, now: String, value: f64, slopes: Vec<f64>| OnePercent {
        number,
        now,
        percent: slopes.iter().zip(figures).map(|(slope, figure)| slope * value / figure).collect(),
    };
    let mut rows = Vec::new();
    let is_one_tube = rod.pipe1.section == rod.pipe2.section;
    for (number, slopes) in slopes {
        let value = match number {
            NominalNumber::Ply(material, ply) => {
                rod.plies().find(|(own, _)| own == material).and_then(|(_, plies)| ply.value_in(plies))
            }
            _ => rod.value_of(number),
        };
        let Some(value) = value.filter(|value| *value != 0.0) else { continue };
        let in_file = |value: f64| {
            let (key, si) = number.in_file();
            let sign = if value < 0.0 { "−" } else { "" };
            format!("{sign}{} {}", significant(value.abs() / si, 4), unit(key)).trim_end().to_owned()
        };
        match number {
            NominalNumber::InnerDiameter(_) => {}
            NominalNumber::OuterDiameter(part) => {
                let Some(Section::Round(round)) = rod.part(*part).map(|pipe| &pipe.section) else { continue };
                if is_one_tube && *part == Part::Pipe2 {
                    continue;
                }
                let both = is_one_tube && *part == Part::Pipe1;
                let other = Part::Pipe2;
                let with_other = |of_part: Vec<f64>, number: fn(Part) -> NominalNumber| match both {
                    true => sum(of_part, of_number(&number(other)), 1.0),
                    false => of_part,
                };
                let outer = with_other(slopes.clone(), NominalNumber::OuterDiameter);
                let inner =
                    with_other(of_number(&NominalNumber::InnerDiameter(*part)), NominalNumber::InnerDiameter);
                let place = if both { "both pipes".to_owned() } else { part.to_string() };
                if round.inner_diameter == 0.0 {
                    rows.push(row(format!("diameter of {place}"), in_file(value), value, outer));
                    continue;
                }
                let wall = round.wall();
                let of_wall = inner.iter().map(|slope| -2.0 * slope).collect();
                rows.push(row(
                    format!("outer diameter of {place}, wall kept"),
                    in_file(value),
                    value,
                    sum(outer, inner, 1.0),
                ));
                rows.push(row(format!("wall of {place}"), in_file(wall), wall, of_wall));
            }
            // a small l is a one
            NominalNumber::LengthL1 => rows.push(row("L1".into(), in_file(value), value, slopes.clone())),
            NominalNumber::LengthL2 => rows.push(row("L2".into(), in_file(value), value, slopes.clone())),
            _ => rows.push(row(number.to_string(), in_file(value), value, slopes.clone())),
        }
    }
    rows
}

/// The unit of a key of the rod file.
fn unit(key: &str) -> &'static str {
    let units = [
        ("_gpa", "GPa"),
        ("_kg_m3", "kg/m³"),
        ("_urad_per_nm", "µrad/(N·m)"),
        ("_deg", "°"),
        ("_mm", "mm"),
        ("_mm2", "mm²"),
        ("_mm4", "mm⁴"),
        ("_g", "g"),
    ];
    units.into_iter().find(|(end, _)| key.ends_with(end)).map_or("", |(_, unit)| unit)
}

/// The rows as a table; `heads` names the figures.
pub fn table(name: &str, caption: impl Into<String>, heads: &[&str], rows: &[OnePercent]) -> Table {
    let mut columns = vec![Column::text("1 % more of"), Column::text("now")];
    columns.extend(heads.iter().map(|head| Column::number(*head, "%")));
    let mut table = Table::new(name, caption, columns);
    for row in rows {
        let mut cells = vec![row.number.clone(), row.now.clone()];
        cells.extend(row.percent.iter().map(|percent| signed(*percent)));
        table.row(cells);
    }
    table
}

/// Two decimals with a sign: `+2.81`, `0` for what rounds to it.
fn signed(percent: f64) -> String {
    let rounded = (percent * 100.0).round() / 100.0;
    if rounded == 0.0 { "0".into() } else { format!("{rounded:+.2}").replace('-', "−") }
}

/// What counts most of the rows as bars, one for each figure: `picked` has their places and names.
pub fn bars(title: impl Into<String>, rows: &[OnePercent], picked: &[(usize, &str)]) -> Chart {
    /// Numbers that are drawn, and changes (%) below which nothing is seen.
    const DRAWN: usize = 9;
    const SEEN: f64 = 0.02;
    let most = |row: &OnePercent| picked.iter().map(|(k, _)| row.percent[*k].abs()).fold(0.0, f64::max);
    let mut rows: Vec<&OnePercent> = rows.iter().filter(|row| most(row) >= SEEN).collect();
    rows.sort_by(|a, b| most(b).total_cmp(&most(a)));
    rows.truncate(DRAWN);
    let mut chart = Chart::new(title, "change by 1 % more / %", "");
    chart.y.names = rows.iter().enumerate().map(|(k, row)| (-(k as f64), row.number.clone())).collect();
    chart.y.range = Range::Fixed(-(rows.len() as f64) + 0.4, 0.6);
    chart.height_px = Some(30.0 + 14.0 * (picked.len() * rows.len()) as f64);
    let looks =
        [(Colour::Vermilion, Dash::Solid), (Colour::Blue, Dash::Dashed), (Colour::Green, Dash::Dotted)];
    let thick = 0.84 / picked.len().max(1) as f64;
    for (place, ((k, label), (colour, dash))) in picked.iter().zip(looks).enumerate() {
        let top = |row: usize| 0.42 - row as f64 - place as f64 * thick;
        let bar = |(row, change): (usize, &&OnePercent)| Bar {
            from: top(row) - thick,
            to: top(row),
            value: change.percent[*k],
            text: signed(change.percent[*k]),
            ..Bar::default()
        };
        chart = chart.with(Mark::Bars {
            label: (*label).to_owned(),
            bars: rows.iter().enumerate().map(bar).collect(),
            direction: Direction::Right,
            style: Style::nth(0).colour(colour).dash(dash),
        });
    }
    chart
}

/// The rows by figure, `c_rod_um_percent` and so on: `keys` names the figures.
pub fn json(rows: &[OnePercent], keys: &[&str]) -> Value {
    let of_row = |row: &OnePercent| {
        let mut object = Map::new();
        object.insert("number".into(), row.number.clone().into());
        let percents =
            keys.iter().zip(&row.percent).map(|(key, percent)| ((*key).to_owned(), json!(percent)));
        object.extend(percents);
        Value::Object(object)
    };
    rows.iter().map(of_row).collect()
}

/// Which number: its words, table, key and value in the rod file.
pub fn number_json(number: &NominalNumber, value: f64) -> Map<String, Value> {
    let (key, si) = number.in_file();
    let mut object = Map::new();
    object.insert("number".into(), number.to_string().into());
    object.insert("place".into(), number.place().into());
    object.insert("key".into(), key.into());
    object.insert("value".into(), (value / si).into());
    object
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::{Figure, Figures};
    use crate::units::MM;

    #[test]
    fn a_wall_of_one_tube_is_that_of_both_pipes_at_its_outer_diameter() {
        let rod = Rod::read("rods/5.toml".as_ref()).unwrap();
        let of_rod = |rod: &Rod| {
            let figures = Figures::of(rod, &mut Default::default());
            figures.get(Figure::CRod).unwrap()
        };
        let slopes: Vec<(NominalNumber, Vec<f64>)> = Figures::slopes(&rod)
            .unwrap()
            .into_iter()
            .map(|(number, figures)| (number, vec![figures.get(Figure::CRod).unwrap()]))
            .collect();
        let rows = one_percent_more(&rod, &slopes, &[of_rod(&rod)]);
        let row = rows.iter().find(|row| row.number == "wall of both pipes").unwrap();
        let wall = rod.pipe1.section.wall().unwrap();
        let with = |wall: f64| {
            let first = rod.with(&NominalNumber::Wall(Part::Pipe1), wall);
            of_rod(&first.with(&NominalNumber::Wall(Part::Pipe2), wall))
        };
        let expected = (with(1.001 * wall) / with(0.999 * wall) - 1.0) / 0.002;
        assert!((row.percent[0] - expected).abs() < 2e-3 * expected.abs(), "{row:?} {expected}");
        assert_eq!(row.now, format!("{} mm", significant(wall / MM, 4)));
        assert!(rows.iter().all(|row| !row.number.contains("inner")));
    }
}
