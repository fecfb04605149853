//! Labels of events: names on vertical lines where something happened along x. No label covers
//! another one, nor another event's line where there is room elsewhere.

use super::chart::{Dash, Mark};
use super::frame::{Frame, NOTE};
use super::labels::{Area, LabelPlacer, text_width_px};
use super::plot::{Canvas, Rgb};

/// Height of a label, px.
const LANE_PX: f64 = 15.0;
/// Part of the plot that labels may fill.
const MOST: f64 = 0.6;
/// On both sides of the words of a label, px.
const AIR_PX: f64 = 4.0;
/// Half the width that an event's line keeps clear, px.
const CLEAR_PX: f64 = 1.0;

/// Draws all events, since their names make way for one another.
pub(super) fn draw(canvas: &mut Canvas, frame: &Frame, marks: &[Mark], labels: &mut LabelPlacer) {
    let area = frame.area;
    let event = |mark: &'_ Mark| match mark {
        Mark::Event { at, text } if frame.x.places(*at) => {
            let x = frame.px([*at, f64::NAN])[0];
            (area.left..=area.right).contains(&x).then(|| (x, text.clone()))
        }
        _ => None,
    };
    let events: Vec<(f64, String)> = marks.iter().filter_map(event).collect();
    let width =
        |text: &str| if text.is_empty() { 0.0 } else { text_width_px(text, NOTE.size_px) + 2.0 * AIR_PX };
    let wanted: Vec<(f64, f64)> = events.iter().map(|(x, text)| (*x, width(text))).collect();
    let placed = places(&area, &wanted);
    for ((x, _), label) in events.iter().zip(&placed) {
        let top = label.map_or(area.top, |label| label.bottom);
        canvas.line(&[[*x, top], [*x, area.bottom]], Rgb::INK, 1.0, Dash::Dashed);
        labels.add_line([*x, top], [*x, area.bottom]);
    }
    for ((_, text), label) in events.iter().zip(placed) {
        let Some(label) = label else { continue };
        canvas.fill(&text_area(&label).corners(), Rgb::WHITE);
        canvas.text(label.centre(), text, NOTE, Rgb::INK);
        labels.add_text(label);
    }
}

/// Where the labels of lines at x (px) stand, each of the width that is wanted: at the top or in a
/// lane below, inwards from the line if that is free. `None` where there is no room, or nothing to
/// write.
fn places(within: &Area, wanted: &[(f64, f64)]) -> Vec<Option<Area>> {
    let middle = within.centre()[0];
    // the outermost first: their labels stand above the lines of those further in
    let mut order: Vec<usize> = (0..wanted.len()).filter(|&k| wanted[k].1 > 0.0).collect();
    order.sort_by(|&a, &b| f64::abs(wanted[b].0 - middle).total_cmp(&f64::abs(wanted[a].0 - middle)));
    let lanes = (MOST * within.height() / LANE_PX) as usize;
    let mut placed: Vec<Option<Area>> = vec![None; wanted.len()];
    for k in order {
        let (x, width) = wanted[k];
        let in_lane = |lane: usize| {
            let top = within.top + lane as f64 * LANE_PX;
            let sides = if x < middle { [x, x - width] } else { [x - width, x] };
            sides.map(|left| {
                let left = left.min(within.right - width).max(within.left);
                Area { left, right: left + width, top, bottom: top + LANE_PX }
            })
        };
        let others: Vec<(&Area, f64)> =
            placed.iter().zip(wanted).filter_map(|(other, at)| Some((other.as_ref()?, at.0))).collect();
        let is_free = |label: &Area| !others.iter().any(|(other, _)| label.touches(other));
        let is_clear = |label: &Area| {
            others.iter().all(|(other, other_x)| {
                !line_area(within, x, label.bottom).touches(&text_area(other))
                    && !line_area(within, *other_x, other.bottom).touches(&text_area(label))
            })
        };
        let free: Vec<Area> = (0..lanes).flat_map(in_lane).filter(is_free).collect();
        // rather across another line than nowhere
        placed[k] = free.iter().find(|label| is_clear(label)).or(free.first()).copied();
    }
    placed
}

/// The part of a label that is written on.
fn text_area(label: &Area) -> Area {
    Area { left: label.left + AIR_PX, right: label.right - AIR_PX, ..*label }
}

/// What an event's line keeps clear below its label.
fn line_area(within: &Area, x: f64, top: f64) -> Area {
    Area { left: x - CLEAR_PX, right: x + CLEAR_PX, top, bottom: within.bottom }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLOT: Area = Area { left: 0.0, top: 0.0, right: 300.0, bottom: 300.0 };

    fn assert_apart(wanted: &[(f64, f64)], is_clear: bool) {
        let placed: Vec<Area> = places(&PLOT, wanted).into_iter().flatten().collect();
        assert_eq!(placed.len(), wanted.len(), "all have names");
        for (k, label) in placed.iter().enumerate() {
            assert!(
                label.left >= PLOT.left && label.right <= PLOT.right && label.top >= PLOT.top,
                "{label:?}"
            );
            for (other, at) in
                placed.iter().zip(wanted).enumerate().filter(|(i, _)| *i != k).map(|pair| pair.1)
            {
                let crosses = line_area(&PLOT, at.0, other.bottom).touches(&text_area(label));
                assert!(!(label.touches(other) || is_clear && crosses), "{label:?} over {other:?} at {at:?}");
            }
        }
    }

    #[test]
    fn names_lie_over_nothing_wherever_things_happen() {
        assert_apart(&[(150.0, 100.0), (151.0, 100.0), (152.0, 100.0)], true);
        assert_apart(&[(210.0, 110.0), (250.0, 110.0), (290.0, 110.0), (295.0, 110.0)], true);
        assert_apart(&[(0.0, 110.0), (5.0, 40.0), (140.0, 110.0), (299.0, 110.0), (300.0, 110.0)], true);
    }

    #[test]
    fn a_long_name_among_many_lies_over_a_pole_but_over_no_name() {
        assert_apart(&[(20.0, 110.0), (100.0, 30.0), (60.0, 150.0), (180.0, 150.0), (260.0, 120.0)], false);
    }

    #[test]
    fn what_has_no_room_or_no_name_has_no_flag() {
        let many = places(&PLOT, &[(150.0, 200.0); 40]);
        assert!(many.iter().any(Option::is_some) && many.iter().any(Option::is_none));
        assert_eq!(places(&PLOT, &[(10.0, 0.0)]), [None]);
    }
}
