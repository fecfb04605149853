//! Small linear programs: the best point of a polytope, by the simplex method in dictionary form
//! with Bland's rule (R. G. Bland, *Math. Oper. Res.* 2 (1977) 103–107), which does not cycle.

use nalgebra::DMatrix;

/// What counts as 0 of coefficients and right sides of the size of 1.
const NOTHING: f64 = 1e-11;
/// Many more pivots than any program of a hundred rows takes.
const MOST_PIVOTS: usize = 10_000;

/// The x within `low` and `high` (both finite) with the smallest c·x among those with A·x ≤ b;
/// `None` where there is none. Meant for coefficients of the size of 1.
///
/// ```
/// use nalgebra::dmatrix;
/// use rodcal_base::linear_program::minimise;
///
/// // the most of x + y where x + 2y ≤ 4 and 3x + y ≤ 6
/// let best = minimise(&[-1.0, -1.0], &dmatrix![1.0, 2.0; 3.0, 1.0], &[4.0, 6.0], &[0.0; 2], &[9.0; 2]);
/// let best = best.expect("0, 0 is one of them");
/// assert!((best[0] - 1.6).abs() < 1e-12 && (best[1] - 1.2).abs() < 1e-12);
/// ```
pub fn minimise(c: &[f64], a: &DMatrix<f64>, b: &[f64], low: &[f64], high: &[f64]) -> Option<Vec<f64>> {
    let n = c.len();
    // y = x − low, 0 ≤ y, and a row for each y ≤ high − low
    let mut rows: Vec<Vec<f64>> = Vec::new();
    let mut right: Vec<f64> = Vec::new();
    for (i, b) in b.iter().enumerate() {
        let row: Vec<f64> = (0..n).map(|j| a[(i, j)]).collect();
        right.push(b - row.iter().zip(low).map(|(a, low)| a * low).sum::<f64>());
        rows.push(row);
    }
    for j in 0..n {
        rows.push((0..n).map(|k| f64::from(k == j)).collect());
        right.push(high[j] - low[j]);
    }
    let gains: Vec<f64> = c.iter().map(|c| -c).collect();
    let mut program = Dictionary::feasible(rows, right, n)?;
    program.aim(&gains);
    program.climb()?;
    Some((0..n).map(|j| low[j] + program.value(j)).collect())
}

/// Basic variables by the others: `basic[i] = right[i] − Σ rows[i][j]·free[j]`; what is maximised
/// is Σ gains[j]·free[j] and a constant. Variables 0 to n − 1 are y, those after them the slacks of
/// the rows.
struct Dictionary {
    rows: Vec<Vec<f64>>,
    right: Vec<f64>,
    gains: Vec<f64>,
    basic: Vec<usize>,
    free: Vec<usize>,
}

impl Dictionary {
    /// With a right side of 0 or more throughout; `None` where no y keeps all rows.
    fn feasible(rows: Vec<Vec<f64>>, right: Vec<f64>, n: usize) -> Option<Dictionary> {
        let m = rows.len();
        let mut all = Dictionary {
            rows,
            right,
            gains: vec![0.0; n],
            basic: (n..n + m).collect(),
            free: (0..n).collect(),
        };
        let worst = (0..m).min_by(|&i, &j| all.right[i].total_cmp(&all.right[j]))?;
        if all.right[worst] >= 0.0 {
            return Some(all);
        }
        // every row may be missed by one and the same amount, which is made as small as it can be
        let missed = n + m;
        all.rows.iter_mut().for_each(|row| row.push(-1.0));
        all.free.push(missed);
        all.gains.push(-1.0);
        all.pivot(worst, n);
        all.climb()?;
        if all.value(missed) > NOTHING.sqrt() {
            return None;
        }
        if let Some(row) = all.basic.iter().position(|&k| k == missed) {
            let column = (0..all.free.len())
                .max_by(|&i, &j| all.rows[row][i].abs().total_cmp(&all.rows[row][j].abs()))?;
            all.pivot(row, column);
        }
        let column = all.free.iter().position(|&k| k == missed)?;
        all.free.remove(column);
        all.rows.iter_mut().for_each(|row| _ = row.remove(column));
        all.right.iter_mut().for_each(|right| *right = right.max(0.0));
        Some(all)
    }

    /// Maximises Σ gains[k]·y[k] from here on.
    fn aim(&mut self, gains: &[f64]) {
        self.gains = vec![0.0; self.free.len()];
        for (k, gain) in gains.iter().enumerate() {
            if let Some(column) = self.free.iter().position(|&free| free == k) {
                self.gains[column] += gain;
            } else if let Some(row) = self.basic.iter().position(|&basic| basic == k) {
                self.gains.iter_mut().zip(&self.rows[row]).for_each(|(own, a)| *own -= gain * a);
            }
        }
    }

    /// From vertex to vertex as long as that gains something; `None` where the gain has no end.
    fn climb(&mut self) -> Option<()> {
        for _ in 0..MOST_PIVOTS {
            let gaining = (0..self.free.len()).filter(|&j| self.gains[j] > NOTHING);
            let Some(column) = gaining.min_by_key(|&j| self.free[j]) else { return Some(()) };
            let ratio = |i: usize| self.right[i] / self.rows[i][column];
            let stops = (0..self.rows.len()).filter(|&i| self.rows[i][column] > NOTHING);
            let row = stops
                .min_by(|&i, &j| ratio(i).total_cmp(&ratio(j)).then(self.basic[i].cmp(&self.basic[j])))?;
            self.pivot(row, column);
        }
        None
    }

    /// The variable of `column` enters for that of `row`.
    fn pivot(&mut self, row: usize, column: usize) {
        let by = self.rows[row][column];
        self.right[row] /= by;
        self.rows[row].iter_mut().for_each(|a| *a /= by);
        self.rows[row][column] = 1.0 / by;
        let (own, right) = (self.rows[row].clone(), self.right[row]);
        for i in (0..self.rows.len()).filter(|&i| i != row) {
            let times = std::mem::take(&mut self.rows[i][column]);
            self.right[i] -= times * right;
            self.rows[i].iter_mut().zip(&own).for_each(|(a, own)| *a -= times * own);
        }
        let times = std::mem::take(&mut self.gains[column]);
        self.gains.iter_mut().zip(&own).for_each(|(gain, own)| *gain -= times * own);
        std::mem::swap(&mut self.basic[row], &mut self.free[column]);
    }

    fn value(&self, variable: usize) -> f64 {
        self.basic.iter().position(|&basic| basic == variable).map_or(0.0, |row| self.right[row])
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::dmatrix;

    use super::*;
    use crate::statistics::Random;

    /// In the plane the best vertex is one of the crossings of two lines.
    #[test]
    fn the_best_vertex_of_many_is_found() {
        let mut random = Random::seeded(7, 1);
        let mut solved = 0;
        for _ in 0..200 {
            let mut draw = || random.uniform(-1.0, 1.0);
            let (c, a) = ([draw(), draw()], DMatrix::from_fn(5, 2, |_, _| draw()));
            let b: Vec<f64> = (0..5).map(|_| draw() * 0.4 + 0.2).collect();
            let mut lines: Vec<[f64; 3]> = (0..5).map(|i| [a[(i, 0)], a[(i, 1)], b[i]]).collect();
            lines.extend([[1.0, 0.0, 1.0], [-1.0, 0.0, 1.0], [0.0, 1.0, 1.0], [0.0, -1.0, 1.0]]);
            let mut best = f64::INFINITY;
            for (i, p) in lines.iter().enumerate() {
                for q in &lines[..i] {
                    let det = p[0] * q[1] - p[1] * q[0];
                    let x = [(p[2] * q[1] - p[1] * q[2]) / det, (p[0] * q[2] - p[2] * q[0]) / det];
                    if lines.iter().all(|l| l[0] * x[0] + l[1] * x[1] <= l[2] + 1e-9) {
                        best = best.min(c[0] * x[0] + c[1] * x[1]);
                    }
                }
            }
            match minimise(&c, &a, &b, &[-1.0; 2], &[1.0; 2]) {
                Some(x) => {
                    solved += 1;
                    assert!((c[0] * x[0] + c[1] * x[1] - best).abs() < 1e-8, "{x:?} {best}");
                }
                None => assert_eq!(best, f64::INFINITY),
            }
        }
        assert!((100..200).contains(&solved), "{solved}");
    }

    #[test]
    fn what_contradicts_itself_has_no_best() {
        assert_eq!(minimise(&[1.0], &dmatrix![1.0; -1.0], &[1.0, -2.0], &[-9.0], &[9.0]), None);
    }
}
