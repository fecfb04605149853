//! What a fit left at every pose, in the order the poses were recorded: drift, a bad clamp and
//! single outliers look different here.

use serde::Serialize;

use super::super::super::chart::{Chart, Figure, Mark, Marker, Point, Range, Style};
use super::super::super::scale::{drawable, extent};
use super::{MOST_POINTS, amount};

/// More panels than these would be too low to read.
const MOST_MODES: usize = 4;
/// More stretches than these would be nothing but lines.
const MOST_GROUPS: usize = 60;
/// More names in one panel than these would cover the points.
const MOST_NAMES: usize = 12;
const HEIGHT_PX: f64 = 165.0;

/// What one mode of calibration left.
#[derive(Debug, Clone, Default, Serialize)]
pub struct ModeResiduals {
    /// Name of the mode.
    pub title: String,
    /// The poses in recording order, cut where something was changed.
    pub groups: Vec<ResidualGroup>,
    /// Root mean square to draw as a line, µm; not finite or 0 draws none.
    pub rms_um: f64,
}

/// Poses that were recorded in one go.
#[derive(Debug, Clone, Default, Serialize)]
pub struct ResidualGroup {
    /// Which clamp or placement; may be empty.
    pub name: String,
    /// The poses in recording order.
    pub poses: Vec<PoseResidual>,
}

/// What is left at one pose.
#[derive(Debug, Clone, Default, Serialize)]
pub struct PoseResidual {
    /// Which pose; written where it is an outlier.
    pub name: String,
    /// Length of the residual, µm.
    pub length_um: f64,
    /// To be ringed.
    pub outlier: bool,
}

/// One panel per mode, at most four, on one scale: the length of every residual in recording order,
/// groups between thin lines, outliers ringed. An outlier far beyond everything else stands as a
/// triangle at the edge with its value, so that the others are still seen.
pub fn residuals_by_group(modes: &[ModeResiduals]) -> Figure {
    let shown = &modes[..modes.len().min(MOST_MODES)];
    let scale = Shared::new(shown);
    let mut caption = String::from("Length of the residual at every pose, in the order of recording.");
    if modes.len() > shown.len() {
        caption += &format!(" Only the first {MOST_MODES} of {} modes are shown.", modes.len());
    }
    let most = |count: fn(&ModeResiduals) -> usize| shown.iter().map(count).max().unwrap_or(0);
    if most(|m| m.groups.len()) > MOST_GROUPS {
        caption += " There are too many groups to separate them here.";
    }
    let bundle = most(pose_count).div_ceil(MOST_POINTS / 2);
    if most(pose_count) > MOST_POINTS {
        caption += &format!(" Each point is the largest of {bundle} consecutive poses.");
    }
    if most(|m| outliers(m).count()) > MOST_NAMES {
        caption += &format!(" Only the {MOST_NAMES} largest outliers are named.");
    }
    if shown.iter().flat_map(outliers).any(|(_, pose)| pose.length_um > scale.reach_um) {
        caption += " A triangle at the upper edge stands for an outlier beyond it.";
    }
    Figure {
        name: "residuals-by-group".into(),
        caption,
        panels: shown.iter().enumerate().map(|(i, m)| panel(m, &scale, i + 1 == shown.len())).collect(),
        columns: 1,
        shared_legend: true,
        ..Figure::default()
    }
}

/// What all panels have in common along y.
struct Shared {
    /// Outliers beyond this are drawn here.
    reach_um: f64,
    /// Upper end of the axis: leaves room for the names of the groups.
    top_um: f64,
}

impl Shared {
    fn new(modes: &[ModeResiduals]) -> Self {
        let largest = |outlier: bool| {
            let poses = modes.iter().flat_map(numbered).map(|(_, pose)| pose);
            let lengths = poses.filter(|pose| pose.outlier == outlier).map(|pose| pose.length_um);
            extent(lengths).map_or(0.0, |(_, high)| high)
        };
        let rms_um = extent(modes.iter().map(|mode| mode.rms_um)).map_or(0.0, |(_, high)| high);
        let usual_um = largest(false).max(rms_um);
        let reach_um = if usual_um > 0.0 { 1.5 * usual_um } else { f64::INFINITY };
        let highest_um = usual_um.max(largest(true).min(reach_um));
        Shared { reach_um, top_um: if highest_um > 0.0 { 1.2 * highest_um } else { 1.0 } }
    }
}

fn pose_count(mode: &ModeResiduals) -> usize {
    mode.groups.iter().map(|group| group.poses.len()).sum()
}

/// All poses that can be drawn with their number in recording order, from 1.
fn numbered(mode: &ModeResiduals) -> impl Iterator<Item = (f64, &PoseResidual)> {
    let poses = mode.groups.iter().flat_map(|group| &group.poses).enumerate();
    poses.map(|(i, pose)| ((i + 1) as f64, pose)).filter(|(_, pose)| drawable(pose.length_um))
}

fn outliers(mode: &ModeResiduals) -> impl Iterator<Item = (f64, &PoseResidual)> {
    numbered(mode).filter(|(_, pose)| pose.outlier)
}

fn panel(mode: &ModeResiduals, scale: &Shared, last: bool) -> Chart {
    let count = pose_count(mode);
    let x_label = if last { "pose, in recording order" } else { "" };
    let mut chart = Chart::new(&mode.title, x_label, "residual / µm");
    chart.height_px = Some(HEIGHT_PX);
    chart.x.range = Range::Fixed(0.5, count as f64 + 0.5);
    chart.x.step = (count <= 12).then_some(1.0);
    chart.y.range = Range::Fixed(0.0, scale.top_um);
    if numbered(mode).next().is_none() {
        return chart;
    }
    if mode.groups.len() <= MOST_GROUPS {
        let mut from = 0.5;
        for group in mode.groups.iter().filter(|group| !group.poses.is_empty()) {
            let to = from + group.poses.len() as f64;
            chart.marks.push(Mark::Stretch { from, to, text: group.name.clone() });
            from = to;
        }
    }
    let (inside, beyond): (Vec<_>, Vec<_>) =
        numbered(mode).partition(|(_, pose)| pose.length_um <= scale.reach_um);
    let ringed: Vec<_> = inside.iter().copied().filter(|(_, pose)| pose.outlier).collect();
    // In a bundle an outlier would stand for all the others.
    let bundled = count > MOST_POINTS;
    let dots = inside.into_iter().filter(|(_, pose)| !(bundled && pose.outlier)).collect();
    let ring_px = if ringed.len() > 40 { 1.2 } else { 3.0 };
    let series = [
        ("pose", dots, Style::nth(2).marker(Marker::Circle)),
        ("outlier", ringed, Style::nth(1).marker(Marker::Ring).size(ring_px)),
        ("outlier beyond the axis", beyond, Style::nth(1).marker(Marker::Triangle).size(4.2)),
    ];
    for (label, poses, style) in series {
        let point = |(x, pose): &(f64, &PoseResidual)| Point {
            x: *x,
            y: pose.length_um.min(scale.reach_um),
            error: 0.0,
        };
        let points: Vec<Point> = largest_of_bundles(poses, count).iter().map(point).collect();
        if !points.is_empty() {
            chart.marks.push(Mark::Points { label: label.into(), points, style });
        }
    }
    if mode.rms_um > 0.0 {
        let text = format!("rms {}", amount(mode.rms_um, "µm"));
        chart.marks.push(Mark::Horizontal { at: mode.rms_um, text });
    }
    chart.marks.extend(names(mode, scale));
    chart
}

/// All poses, or beyond a few thousand the one with the longest residual of each run of consecutive
/// ones.
fn largest_of_bundles(poses: Vec<(f64, &PoseResidual)>, count: usize) -> Vec<(f64, &PoseResidual)> {
    if count <= MOST_POINTS {
        return poses;
    }
    let bundle = count.div_ceil(MOST_POINTS / 2) as f64;
    let runs = poses.chunk_by(|(a, _), (b, _)| ((a - 1.0) / bundle).floor() == ((b - 1.0) / bundle).floor());
    runs.filter_map(|run| run.iter().copied().max_by(|a, b| a.1.length_um.total_cmp(&b.1.length_um)))
        .collect()
}

/// The names of the largest outliers, with the value where the point does not show it.
fn names(mode: &ModeResiduals, scale: &Shared) -> Vec<Mark> {
    let mut largest: Vec<_> = outliers(mode).collect();
    largest.sort_by(|a, b| b.1.length_um.total_cmp(&a.1.length_um));
    let note = |(x, pose): &(f64, &PoseResidual)| {
        let beyond = pose.length_um > scale.reach_um;
        let text = match beyond {
            true => format!("{}: {}", pose.name, amount(pose.length_um, "µm")),
            false => pose.name.clone(),
        };
        Mark::Note { at: [*x, pose.length_um.min(scale.reach_um)], text }
    };
    largest.iter().take(MOST_NAMES).map(note).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mode(lengths: &[f64]) -> ModeResiduals {
        let pose = |(i, length_um): (usize, &f64)| PoseResidual {
            name: format!("P{}", i + 1),
            length_um: *length_um,
            outlier: *length_um > 50.0,
        };
        let group = |name: &str, from: usize, lengths: &[f64]| ResidualGroup {
            name: name.into(),
            poses: lengths.iter().enumerate().map(|(i, l)| pose((from + i, l))).collect(),
        };
        let (a, b) = lengths.split_at(lengths.len() / 2);
        ModeResiduals {
            title: "rigid rod".into(),
            groups: vec![group("clamp A", 0, a), group("clamp B", a.len(), b)],
            rms_um: 20.0,
        }
    }

    fn points(chart: &Chart) -> Vec<(&str, usize)> {
        let count = |mark: &'_ Mark| match mark {
            Mark::Points { points, .. } => Some(points.len()),
            _ => None,
        };
        let label = |mark| super::super::super::super::marks::label(mark);
        chart.marks.iter().filter_map(|mark| Some((label(mark), count(mark)?))).collect()
    }

    #[test]
    fn every_pose_is_a_point_and_an_outlier_is_ringed_and_named() {
        let figure = residuals_by_group(&[mode(&[10.0, 20.0, 40.0, 55.0, f64::NAN, 25.0])]);
        assert_eq!(points(&figure.panels[0]), [("pose", 5), ("outlier", 1)]);
        let svg = figure.svg();
        for text in ["clamp A", "clamp B", ">\nP4\n", "rms 20\u{a0}µm", "residual / µm"] {
            assert!(svg.contains(text), "{text}\n{svg}");
        }
    }

    #[test]
    fn an_outlier_far_beyond_does_not_flatten_the_others() {
        let figure = residuals_by_group(&[mode(&[10.0, 20.0, 30.0, 5.2e6])]);
        assert_eq!(figure.panels[0].y.range, Range::Fixed(0.0, 54.0));
        assert_eq!(points(&figure.panels[0]), [("pose", 3), ("outlier beyond the axis", 1)]);
        assert!(
            figure.svg().contains("P4: 5\u{2009}200\u{2009}000\u{a0}µm")
                && figure.caption.contains("triangle")
        );
    }

    #[test]
    fn many_poses_are_bundled_and_the_caption_says_so() {
        let lengths: Vec<f64> = (0..100_000).map(|i| f64::from(i % 97)).collect();
        let figure = residuals_by_group(&vec![mode(&lengths); 5]);
        assert_eq!((figure.panels.len(), points(&figure.panels[0])[0]), (4, ("pose", 1000)));
        assert!(
            figure.caption.contains("largest of 100 consecutive") && figure.caption.contains("4 of 5 modes")
        );
    }

    #[test]
    fn degenerate_residuals_draw() {
        for lengths in [vec![], vec![7.0], vec![0.0; 9], vec![f64::NAN; 3], vec![1e-12, 1e12], vec![60.0; 30]]
        {
            residuals_by_group(&[mode(&lengths), ModeResiduals { rms_um: f64::NAN, ..mode(&lengths) }]).svg();
        }
        residuals_by_group(&[]).svg();
    }
}
