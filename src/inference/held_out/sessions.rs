//! Does what is found in some sessions predict the others?
//!
//! A recording may hold several sessions: clamps, placements of a fixture. Each is left out as a
//! whole, the search included, and predicted from the others: an effect of the robot must be there
//! too, one that only describes a fixture is not.

use std::collections::BTreeMap;

use nalgebra::DVector;

use crate::inference::Evidence;
use crate::inference::columns::linearised::Linearised;
use crate::inference::held_out::trained_on;
use crate::parallel::in_parallel;

/// A session that was predicted from the others.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct LeftOutSession {
    /// Its number in [`Evidence::session`].
    pub session: usize,
    /// Root mean square of what the base model leaves of it.
    pub before: f64,
    /// And of what the hypothesis found without it leaves.
    pub after: f64,
}

/// Predicts each session from the others; nothing where there is one only.
pub fn leave_one_session_out(model: &Linearised<'_>, evidence: &Evidence) -> Vec<LeftOutSession> {
    let mut sessions: Vec<usize> = evidence.session.clone();
    sessions.sort_unstable();
    sessions.dedup();
    sessions.retain(|&session| session != Evidence::NONE);
    if sessions.len() < 2 {
        return Vec::new();
    }
    let model = &model.in_parts(evidence, &evidence.session);
    let n = evidence.residual.len();
    in_parallel(sessions.len(), |k| {
        let session = sessions[k];
        let (out, kept): (Vec<usize>, Vec<usize>) = (0..n).partition(|&row| evidence.session[row] == session);
        let trained = trained_on(model, evidence, &kept, session, &[]);
        let left_of = |errors: &DVector<f64>| left(evidence, errors, &out);
        LeftOutSession { session, before: left_of(&trained.before), after: left_of(&trained.after) }
    })
}

/// Root mean square of `errors` in `rows`, about the level of each group whose level nobody knows.
fn left(evidence: &Evidence, errors: &DVector<f64>, rows: &[usize]) -> f64 {
    let mut levels: BTreeMap<usize, (f64, f64)> = BTreeMap::new();
    for &row in rows {
        let (sum, count) = levels.entry(evidence.intercept[row]).or_default();
        *sum += errors[row];
        *count += 1.0;
    }
    let square = |&row: &usize| {
        let level = match evidence.intercept[row] {
            Evidence::NONE => 0.0,
            level => levels[&level].0 / levels[&level].1,
        };
        (errors[row] - level).powi(2)
    };
    (rows.iter().map(square).sum::<f64>() / rows.len().max(1) as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::*;
    use crate::inference::tests::{Columns, independent};
    use crate::statistics::Random;

    /// 4 sessions of 30 data over x = 0 … 1.
    const SESSIONS: usize = 4;
    const POINTS: usize = 30;
    const COUNT: usize = SESSIONS * POINTS;

    fn x(row: usize) -> f64 {
        (row % POINTS) as f64 / (POINTS - 1) as f64
    }

    /// A slope that is everywhere, and what happens to one fixture.
    fn model() -> Columns {
        let mut model = Columns::new(COUNT);
        model.add("slope", "robot", DMatrix::from_fn(COUNT, 1, |row, _| x(row)), false);
        for session in 0..SESSIONS {
            let of_session = |row: usize, _| if row / POINTS == session { (9.0 * x(row)).sin() } else { 0.0 };
            model.add("fixture", &format!("{session}"), DMatrix::from_fn(COUNT, 1, of_session), false);
        }
        model
    }

    fn evidence(truth: impl Fn(usize) -> f64) -> Evidence {
        let mut random = Random::seeded(1, 0);
        let residual = (0..COUNT).map(|row| truth(row) + random.normal()).collect();
        Evidence { session: (0..COUNT).map(|row| row / POINTS).collect(), ..independent(residual) }
    }

    fn replicas(evidence: &Evidence) -> Vec<LeftOutSession> {
        let model = model();
        leave_one_session_out(&Linearised::new(&model), evidence)
    }

    #[test]
    fn what_the_robot_does_is_there_in_a_session_that_was_left_out() {
        let found = replicas(&evidence(|row| 8.0 * x(row)));
        assert_eq!(found.iter().map(|replica| replica.session).collect::<Vec<_>>(), [0, 1, 2, 3]);
        for replica in found {
            // 8·x is 4.6 rms, the noise 1
            assert!((4.0..5.5).contains(&replica.before), "{replica:?}");
            assert!((0.7..1.4).contains(&replica.after), "{replica:?}");
        }
    }

    #[test]
    fn what_one_fixture_did_says_nothing_of_the_others() {
        let of_one = |row: usize| if row / POINTS == 2 { 8.0 * (9.0 * x(row)).sin() } else { 0.0 };
        for replica in replicas(&evidence(of_one)) {
            assert_eq!(replica.before, replica.after, "{replica:?}");
            assert_eq!(replica.before > 4.0, replica.session == 2, "{replica:?}");
        }
        // a slope of one session only is not found without it, and makes the others worse
        for replica in replicas(&evidence(|row| if row / POINTS == 2 { 20.0 * x(row) } else { 0.0 })) {
            match replica.session {
                2 => assert!(replica.before > 10.0 && replica.after == replica.before, "{replica:?}"),
                _ => assert!(replica.after > 1.5 * replica.before, "{replica:?}"),
            }
        }
    }

    #[test]
    fn a_level_that_nobody_knows_is_no_error() {
        let level = |row: usize| row / (POINTS / 2);
        let known = evidence(|row| 8.0 * x(row) + 50.0 * (level(row) as f64 + 1.0));
        let levels = 2 * SESSIONS;
        let nuisance = DMatrix::from_fn(COUNT, levels, |row, k| f64::from(u8::from(level(row) == k)));
        let unknown = Evidence { intercept: (0..COUNT).map(level).collect(), nuisance, ..known };
        for replica in replicas(&unknown) {
            // 8·x in two halves, each about its mean, is 1.2 rms
            assert!((1.2..2.0).contains(&replica.before), "{replica:?}");
            assert!(replica.after < 1.3 && replica.after < 0.85 * replica.before, "{replica:?}");
        }
        let known = Evidence { intercept: vec![Evidence::NONE; COUNT], ..unknown };
        assert!(replicas(&known).iter().all(|replica| replica.after > 40.0));
    }

    #[test]
    fn what_belongs_to_no_session_is_learned_from_and_never_held_out() {
        // two sessions of four data each are not enough to find a slope by
        let of_row = |row: usize| match row {
            26..30 => 0,
            56..60 => 1,
            _ => Evidence::NONE,
        };
        let session: Vec<usize> = (0..COUNT).map(of_row).collect();
        let found = |truth: &dyn Fn(usize) -> f64| {
            replicas(&Evidence { session: session.clone(), ..evidence(truth) })
        };
        let with_others = found(&|row| 4.0 * x(row));
        assert_eq!(with_others.iter().map(|replica| replica.session).collect::<Vec<_>>(), [0, 1]);
        assert!(with_others.iter().all(|replica| replica.after < 0.6 * replica.before), "{with_others:?}");
        let alone = found(&|row| if session[row] == Evidence::NONE { 0.0 } else { 4.0 * x(row) });
        for (alone, with) in alone.iter().zip(&with_others) {
            assert_eq!((alone.session, alone.before), (with.session, with.before));
            assert_eq!(alone.after, alone.before);
        }
        // one session has no others
        let session = (0..COUNT).map(|row| if row < 30 { 7 } else { Evidence::NONE }).collect();
        assert_eq!(replicas(&Evidence { session, ..evidence(|row| 4.0 * x(row)) }), []);
    }
}
