//! What the engine gets: weights, further knowledge, and which data belong together.

use super::happened::sockets;
use super::*;
use crate::calibration::campaign::Distance;
use crate::diagnosis::Limitation;
use crate::inference::{CorrelatedNoise, Linearised, Pairs, infer};
use crate::robot::Parameter;
use nalgebra::DMatrix;

/// Cosine of the angle between a direction in which the calibration is free and what it left, at
/// its optimum.
const RIGHT_ANGLE: f64 = 1e-3;

/// Noise of a coordinate of every row, m, in 1 … 5 by its group.
pub(super) fn noisy(campaign: &Campaign, of_group: impl Fn(usize) -> f64, seed: u64) -> Campaign {
    let mut random = Random::seeded(seed, 0);
    let rows = &campaign.measurements.rows;
    let off: Vec<Vector3<f64>> =
        rows.iter().map(|row| Vector3::from_fn(|_, _| of_group(row.group) * random.normal())).collect();
    recorded(campaign, &|row| off[row], 0.0, seed)
}

/// What the calibration leaves: the residual at what is known beforehand, moved to what was found.
fn left(calibration: &Calibration, evidence: &Evidence) -> DVector<f64> {
    &evidence.residual - &evidence.background * found(calibration)
}

/// What was found of the parameters with a prior, in its standard deviations.
fn found(calibration: &Calibration) -> DVector<f64> {
    let found = |prior: &crate::least_squares::Prior| {
        (calibration.parameters[prior.parameter].value - prior.value) / prior.sd
    };
    DVector::from_iterator(calibration.priors.len(), calibration.priors.iter().map(found))
}

/// At the optimum nothing that the calibration can do takes more out of what is left: Jᵀr = 0, and
/// what the data pull at a parameter with a prior that prior holds, once rows and what is known
/// besides count as they did in the calibration, which has other noises than the evidence
/// (`Context::noise`).
fn assert_nothing_more_is_absorbed(
    campaign: &Campaign,
    calibration: &Calibration,
    evidence: &Evidence,
    scale: &dyn Fn(usize) -> f64,
) {
    let context = Context::new(campaign, calibration).unwrap();
    let (rows, noise) = (&campaign.measurements.rows, &calibration.noise);
    let counted = |datum: usize| match rows.get(datum / 3) {
        Some(row) => noise.pooled / noise.of_group[row.group] / scale(datum / 3),
        None => noise.pooled / context.noise,
    };
    let weighted = |v: DVector<f64>| DVector::from_fn(v.len(), |datum, _| v[datum] * counted(datum));
    let left = weighted(left(calibration, evidence));
    let off = found(calibration);
    for (k, column) in evidence.background.column_iter().enumerate() {
        let column = weighted(column.into_owned());
        let pull = column.dot(&left) / noise.pooled.powi(2);
        let scale = column.norm() * left.norm() / noise.pooled.powi(2);
        // no drive turns against its load, however the data pull
        let estimated = &calibration.parameters[calibration.priors[k].parameter];
        let is_compliance = matches!(estimated.parameter, Parameter::Compliance(_));
        if is_compliance && estimated.value == 0.0 && pull < 0.0 {
            continue;
        }
        assert!((pull - off[k]).abs() < RIGHT_ANGLE * scale, "prior {k}: {pull} {}", off[k]);
    }
    for (k, column) in evidence.nuisance.column_iter().enumerate() {
        let column = weighted(column.into_owned());
        let cosine = column.dot(&left) / (column.norm() * left.norm());
        assert!(cosine.abs() < RIGHT_ANGLE, "column {k}: {cosine}");
    }
}

#[test]
fn a_clamp_of_five_times_the_noise_counts_a_twenty_fifth() {
    let campaign = noisy(&clamps(30), |group| if group == 1 { 50.0 * UM } else { 10.0 * UM }, 3);
    let calibration = calibrate(&campaign, Mode::Fea, &Options::default()).unwrap();
    let found = diagnose_calibrated(&campaign, calibration.clone()).unwrap();
    assert!(found.diagnosis.findings.is_empty());
    assert!(
        found
            .limits
            .iter()
            .any(|limit| matches!(limit, Limitation::NoisyGroup(name, ..) if name == "clamp 2"))
    );
    let (model, evidence) = (found.model, found.evidence);
    let rows = &campaign.measurements.rows;
    let rows_where = |is_noisy: bool| (0..rows.len()).filter(move |&row| (rows[row].group == 1) == is_noisy);
    let (loud, quiet) = (rows_where(true).next().unwrap(), rows_where(false).next().unwrap());
    // 90 and 360 coordinates tell the ratio of the two variances within a sixth or so
    let mean = |is_noisy: bool| {
        rows_where(is_noisy).map(|row| model.weight(row)[(0, 0)].powi(-2)).sum::<f64>()
            / rows_where(is_noisy).count() as f64
    };
    let ratio = mean(true) / mean(false);
    assert!((15.0..40.0).contains(&ratio), "{ratio}");
    // one noise holds for all data
    let residual = left(&calibration, &evidence);
    let rms = |is_noisy: bool| {
        let (mut square, mut count) = (0.0, 0.0);
        for row in rows_where(is_noisy) {
            square += residual.fixed_rows::<3>(3 * row).norm_squared();
            count += 3.0;
        }
        (square / count).sqrt()
    };
    assert!((rms(true) / rms(false) - 1.0).abs() < 0.2, "{} {}", rms(true), rms(false));
    for row in [loud, quiet] {
        let own: Vector3<f64> = residual.fixed_rows::<3>(3 * row).into();
        assert!((own + model.weight(row) * calibration.deviations[row]).norm() < 1e-12);
    }
    // effects are felt with the same weight
    let index = find(&model, "thermal_drift", "base, with order");
    let mut drift = model.candidates()[index].neutral(index);
    drift.values[0] = 1.0;
    let change = model.response(&[drift]);
    for row in [loud, quiet] {
        let share = row as f64 / (rows.len() - 1) as f64 - 0.5;
        assert!((change[3 * row] - share * model.weight(row)[(0, 0)]).abs() < 1e-12);
    }
    assert_nothing_more_is_absorbed(&campaign, &calibration, &evidence, &|row| model.weight(row)[(0, 0)]);
}

#[test]
fn what_is_known_beforehand_is_a_background() {
    let mut campaign = noisy(&clamps(12), |_| 20.0 * UM, 5);
    let free = calibrate(&campaign, Mode::Fea, &Options::default()).unwrap();
    let parameter = Parameter::A(1);
    let own = free.parameters.iter().find(|p| p.parameter == parameter).unwrap();
    // five standard errors off, and as firm as the data
    let sd = own.std_error.unwrap();
    let mean = own.value + 5.0 * sd;
    campaign.constraints.priors.push((parameter, mean, sd));
    let calibration = calibrate(&campaign, Mode::Fea, &Options::default()).unwrap();
    let (_, evidence) = CalibrationModel::new(&campaign, calibration.clone()).unwrap();
    assert_eq!(evidence.residual.len(), 3 * campaign.measurements.len());
    // the user's stands after those of the drawing, which says nothing of that parameter then
    let last = calibration.priors.len() - 1;
    let of_it = calibration
        .priors
        .iter()
        .filter(|prior| calibration.parameters[prior.parameter].parameter == parameter);
    assert_eq!((of_it.count(), calibration.priors[last].sd), (1, sd));
    assert_eq!(evidence.background.ncols(), last + 1);
    assert!(found(&calibration)[last] < -1.0, "the data pull");
    assert_nothing_more_is_absorbed(&campaign, &calibration, &evidence, &|_| 1.0);
    assert!(evidence.fold.iter().all(|&fold| fold != Evidence::NONE));
}

#[test]
fn distances_between_sockets_are_known_and_their_places_are_not() {
    let mut campaign = sockets();
    let distances = [([0, 1], 0.2), ([1, 2], 0.25), ([3, 4], 0.3)];
    let known = |(between, value): ([usize; 2], f64)| Distance { between, value, sd: 100.0 * UM };
    campaign.measurements.targets = Targets::Sockets(distances.map(known).to_vec());
    let calibration = calibrate(&campaign, Mode::Fea, &Options::default()).unwrap();
    let (_, evidence) = CalibrationModel::new(&campaign, calibration.clone()).unwrap();
    let rows = campaign.measurements.len();
    let sigma = Context::new(&campaign, &calibration).unwrap().noise;
    assert_eq!(evidence.residual.len(), 3 * rows + distances.len());
    let place = |socket: usize| Vector3::from(calibration.sockets[socket].map(|(value, _)| value));
    for (k, ([a, b], value)) in distances.into_iter().enumerate() {
        let expected = (value - (place(a) - place(b)).norm()) / (100.0 * UM) * sigma;
        assert!((evidence.residual[3 * rows + k] - expected).abs() < 1e-9 * sigma, "{k}");
        assert_eq!(evidence.intercept[3 * rows + k], Evidence::NONE);
        // by how much the distance changes where a socket moves
        let first = evidence.nuisance.ncols() - 3 * calibration.sockets.len();
        for (socket, axis) in
            (0..calibration.sockets.len()).flat_map(|socket| [0, 1, 2].map(|axis| (socket, axis)))
        {
            let moved = |own: usize| place(own) + Vector3::ith(axis, if own == socket { 1e-6 } else { 0.0 });
            let change = (moved(a) - moved(b)).norm() - (place(a) - place(b)).norm();
            let slope = evidence.nuisance[(3 * rows + k, first + 3 * socket + axis)];
            assert!((slope - change / 1e-6 / (100.0 * UM) * sigma).abs() < 1e-4 * sigma / (100.0 * UM));
        }
    }
    assert_nothing_more_is_absorbed(&campaign, &calibration, &evidence, &|_| 1.0);
    // every coordinate of a socket has its own level, every plate its session
    for (row, entry) in campaign.measurements.rows.iter().enumerate() {
        for axis in 0..3 {
            assert_eq!(evidence.intercept[3 * row + axis], 3 * entry.group + axis);
        }
        assert_eq!(evidence.session[3 * row], usize::from(entry.group >= 3));
    }
}

#[test]
fn what_the_calibration_holds_it_does_not_absorb() {
    // no distance: nothing tells a robot from one twice as large
    let campaign = sockets();
    let calibration = calibrate(&campaign, Mode::Fea, &Options::default()).unwrap();
    let context = Context::new(&campaign, &calibration).unwrap();
    let evidence = super::super::evidence::evidence_of(&campaign, &calibration, &context);
    let (free, held) = (calibration.parameters.len(), calibration.held.len());
    assert!(held > 0 && free > held);
    let known = calibration.priors.len();
    assert_eq!(evidence.nuisance.ncols(), free - known + 3 * calibration.sockets.len());
    // all that the drawing draws is taken out as well
    let columns: Vec<_> = evidence.nuisance.column_iter().chain(evidence.background.column_iter()).collect();
    let evidence = Evidence { nuisance: DMatrix::from_columns(&columns), ..evidence };
    let whitening = Whitening::new(&evidence, &evidence.residual);
    let left = |direction: &[f64]| {
        let mut kinematics = crate::robot::Kinematics::new(&calibration.setup);
        let mut moved = DVector::zeros(evidence.residual.len());
        for (row, configuration) in context.configurations.iter().enumerate() {
            kinematics.update(&configuration.joints, &configuration.torque);
            kinematics.tip = configuration.tip;
            for ((estimated, factor), range) in
                calibration.parameters.iter().zip(direction).zip(&calibration.held[0].ranges)
            {
                let column = kinematics.column(estimated.parameter, &configuration.torque) * (factor * range);
                let mut tip = moved.fixed_rows_mut::<3>(3 * row);
                tip += column;
            }
        }
        whitening.apply(&moved).norm() / moved.norm()
    };
    // a direction at right angles to all that are held is free
    let mut across = DVector::from_fn(free, |k, _| 1.0 + k as f64 / free as f64);
    for held in &calibration.held {
        let held = DVector::from_column_slice(&held.direction);
        across -= &held * held.dot(&across);
    }
    assert!(left(across.as_slice()) < 1e-6, "{}", left(across.as_slice()));
    let of_held: Vec<f64> = calibration.held.iter().map(|held| left(&held.direction)).collect();
    assert!(of_held.iter().all(|&left| left > 1e-6), "{of_held:?}");
}

#[test]
fn repeats_are_one_group_and_are_held_out_together() {
    let mut campaign = clamps(30);
    let recording = &mut campaign.measurements;
    // row 40 is taken again later in the same clamp, and its joint values once more in another one
    let same = (41..).find(|&row| recording.rows[row].group == recording.rows[40].group).unwrap();
    let other = (41..).find(|&row| recording.rows[row].group != recording.rows[40].group).unwrap();
    let count = recording.joint_count;
    let again = recording.joints(40).to_vec();
    for row in [same, other] {
        recording.joint_values[row * count..][..count].copy_from_slice(&again);
    }
    let calibration = calibrate(&campaign, Mode::Fea, &Options::default()).unwrap();
    let (_, evidence) = CalibrationModel::new(&campaign, calibration.clone()).unwrap();
    for axis in 0..3 {
        assert_eq!(evidence.replicate_group[3 * same + axis], evidence.replicate_group[120 + axis]);
        assert_ne!(evidence.replicate_group[3 * other + axis], evidence.replicate_group[120 + axis]);
        assert_ne!(evidence.replicate_group[120 + axis], evidence.replicate_group[120 + (axis + 1) % 3]);
    }
    assert_eq!(evidence.fold[3 * same], evidence.fold[120]);
    // every fold has rows of every clamp, and no two are of unlike size
    let rows = &campaign.measurements.rows;
    for fold in 0..5 {
        let of_fold: Vec<usize> = (0..rows.len()).filter(|&row| evidence.fold[3 * row] == fold).collect();
        assert!((25..=35).contains(&of_fold.len()), "{fold}: {}", of_fold.len());
        assert!((0..5).all(|group| of_fold.iter().any(|&row| rows[row].group == group)), "{fold}");
    }
}

#[test]
fn the_last_digit_of_a_displacement_is_seen() {
    let resolution = |step: Option<f64>| {
        let mut campaign = noisy(&clamps(8), |_| 30.0 * UM, 2);
        let recording = &mut campaign.measurements;
        let Targets::Points(points) = &mut recording.targets else { panic!("no points") };
        for (point, row) in points.iter_mut().zip(&recording.rows) {
            let device = &recording.groups[row.group].device;
            let read = device.inverse().point(point);
            *point = step.map_or(*point, |step| device.point(&read.map(|x| (x / step).round() * step)));
        }
        modelled(&campaign, Mode::Fea).1.resolution
    };
    for step in [1.0 * UM, 2.0 * UM, 5.0 * UM, 20.0 * UM] {
        let found = resolution(Some(step));
        assert!((found / step - 1.0).abs() < 1e-9, "{found} instead of {step}");
    }
    assert_eq!(resolution(None), 0.0);
}

#[test]
fn a_clamp_that_moved_does_not_count_less_and_so_stays_visible() {
    let mut campaign = noisy(&clamps(30), |_| 20.0 * UM, 8);
    let Targets::Points(points) = &mut campaign.measurements.targets else { panic!("measured points") };
    let rows = &campaign.measurements.rows;
    for row in (0..rows.len()).filter(|&row| rows[row].group == 1).skip(15) {
        points[row] += Vector3::new(0.0, 800.0, 0.0) * UM;
    }
    let calibration = calibrate(&campaign, Mode::Fea, &Options::default()).unwrap();
    let noise = &calibration.noise;
    assert!(noise.of_group[1] > 5.0 * noise.of_group[0], "the calibration takes the clamp for a noisy one");
    let (model, _) = CalibrationModel::new(&campaign, calibration).unwrap();
    let scale = |group: usize| model.weight(rows.iter().position(|row| row.group == group).unwrap())[(0, 0)];
    assert!(scale(1) > 0.5 * scale(0), "{} {}", scale(1), scale(0));
}

/// The probability of a recording is compared about two robots: how clamps scatter must not make
/// one that leaves little the likelier or the less likely.
#[test]
fn rows_of_unequal_scatter_are_the_same_density_about_every_robot() {
    let campaign = noisy(&clamps(5), |_| 20.0 * UM, 3);
    let mut calibration = calibrate(&campaign, Mode::Fea, &Options::default()).unwrap();
    for _ in 0..2 {
        let of_group = [1.0, 2.0, 3.0, 4.0, 5.0].map(|scatter| scatter * 10.0 * UM);
        let context = Context::new(&campaign, &calibration).unwrap().scattered(&of_group);
        let density: f64 = context.weights().iter().map(|weight| weight[(0, 0)].ln()).sum();
        assert!(density.abs() < 1e-9, "{density}");
        calibration.deviations.iter_mut().for_each(|deviation| *deviation *= 3.0);
    }
}

#[test]
fn the_weight_of_a_rod_tells_no_torque_of_an_arm_of_unknown_masses() {
    let mut campaign = noisy(&clamps(12), |_| 20.0 * UM, 9);
    campaign.robot.joints.iter_mut().for_each(|joint| joint.body = None);
    let calibration = calibrate(&campaign, Mode::Fea, &Options::default()).unwrap();
    let Prepared { model, not_testable, .. } = Prepared::new(&campaign, calibration).unwrap();
    let compliances = model.candidates().iter().filter(|c| c.effect.name == "joint_compliance");
    let places: Vec<String> = compliances.map(|c| c.location.to_string()).collect();
    assert!(!places.is_empty() && places.iter().all(|place| place.ends_with("masses unknown")), "{places:?}");
    assert!(not_testable.iter().any(|not| not.effect.name == "joint_nonlinear_stiffness"));
}

/// What a search needs of columns whose errors hang together is the same by products with stored
/// columns and by whitened ones.
#[test]
fn errors_in_common_whiten_stored_columns_as_whole_ones() {
    let campaign = clamps(5);
    let campaign = noisy(&campaign, |_| 20.0 * UM, 3);
    let (model, evidence) = modelled(&campaign, Mode::Fea);
    let noise = CorrelatedNoise { share: 0.6, length: 3.0 };
    let evidence = Evidence { correlated_noise: Some(noise), ..evidence };
    let whole = Linearised::new(&model);
    let stored = whole.in_parts(&evidence, &evidence.fold);
    let kept: Vec<usize> = (0..evidence.residual.len()).filter(|&row| evidence.fold[row] != 1).collect();
    let part = evidence.part(&kept);
    for (whole, stored, evidence) in
        [(whole.part(&kept, 1), stored.part(&kept, 1), &part), (whole, stored, &evidence)]
    {
        let additions = |model: &Linearised<'_>| {
            let (search, _, _) = infer(model, evidence, Pairs::LeftOut, None);
            search.additions(&search.with(&search.fit(&[]), 3)).to_vec()
        };
        for (a, b) in additions(&whole).into_iter().zip(additions(&stored)) {
            assert!(a == b || (a - b).abs() < 1e-4 * (1.0 + a.abs()), "{a} {b}");
        }
    }
}
