//! The sensor: noise that need not be normal nor independent, a zero of each run that is a little
//! off, a display with steps.

use super::bench::Bench;
use super::protocol::Cell;
use rodcal_base::spatial::Axis;
use rodcal_base::statistics::Random;

/// Shape of the noise of one reading.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// Gauss.
    Normal,
    /// Student's t with so many degrees of freedom, scaled to the standard deviation.
    StudentT(u32),
    /// Drawn from the residuals of a real recording, in stretches of neighbours; mean 0, standard
    /// deviation 1 (D. N. Politis, J. P. Romano, *JASA* 89 (1994) 1303: the stationary bootstrap).
    Bootstrap(Vec<f64>),
}

/// Mean length of a stretch of neighbouring residuals.
const STRETCH: f64 = 4.0;

/// The noise of a recording.
#[derive(Debug, Clone, PartialEq)]
pub struct Noise {
    /// Standard deviation of a reading, m.
    pub sd: f64,
    /// Its shape.
    pub shape: Shape,
    /// Correlation of neighbouring readings of a channel in a run, AR(1).
    pub correlation: f64,
    /// Standard deviation of the zero of a run and channel over that of a reading.
    pub zero: f64,
    /// How many times as much the sensor of each channel scatters.
    pub times: [f64; 3],
}

/// Draws the noise of one reading after another, in standard deviations.
pub struct Source<'a> {
    shape: &'a Shape,
    /// The residual that comes next.
    next: usize,
}

impl<'a> Source<'a> {
    /// Of a shape.
    pub fn new(shape: &'a Shape) -> Self {
        Source { shape, next: 0 }
    }

    /// The next one.
    pub fn draw(&mut self, random: &mut Random) -> f64 {
        match self.shape {
            Shape::Normal => random.normal(),
            Shape::StudentT(dof) => {
                let normal = random.normal();
                let squares: f64 = (0..*dof).map(|_| random.normal().powi(2)).sum();
                (f64::from(dof.saturating_sub(2)) / squares).sqrt() * normal
            }
            Shape::Bootstrap(residuals) => {
                let is_new = random.uniform(0.0, 1.0) * STRETCH < 1.0;
                let at = if is_new { random.index(residuals.len()) } else { self.next };
                self.next = (at + 1) % residuals.len().max(1);
                residuals.get(at).copied().unwrap_or_default()
            }
        }
    }
}

impl Noise {
    /// Independent and normal, with zeros that are read like any other reading.
    pub fn normal(sd: f64) -> Noise {
        Noise { sd, shape: Shape::Normal, correlation: 0.0, zero: 1.0, times: [1.0; 3] }
    }

    /// Variance of one reading of most sensors with the display's steps, q²/12, m².
    pub fn variance(&self, quantum: f64) -> f64 {
        self.sd * self.sd + quantum * quantum / 12.0
    }

    /// The same of a channel.
    pub fn channel_variance(&self, channel: usize, quantum: f64) -> f64 {
        (self.times[channel] * self.sd).powi(2) + quantum * quantum / 12.0
    }

    /// Variance of a zero of a channel, m².
    pub fn zero_variance(&self, channel: usize, quantum: f64) -> f64 {
        (self.zero * self.times[channel] * self.sd).powi(2) + quantum * quantum / 12.0
    }

    /// For people: `student-t (5), correlated 0.4`.
    pub fn description(&self) -> String {
        let shape = match &self.shape {
            Shape::Normal => "normal".into(),
            Shape::StudentT(dof) => format!("student-t ({dof})"),
            Shape::Bootstrap(residuals) => format!("{} residuals of a recording", residuals.len()),
        };
        let correlated = match self.correlation > 0.0 {
            true => format!(", correlated {:.2}", self.correlation),
            false => String::new(),
        };
        let worse: Vec<String> = Axis::ALL
            .into_iter()
            .zip(self.times)
            .filter(|(_, times)| *times != 1.0)
            .map(|(channel, times)| format!(", d{channel} {times:.1} times as much"))
            .collect();
        format!("{shape}{correlated}{}", worse.concat())
    }

    /// What the display shows: each run's zero of each channel was read once and taken off.
    pub fn shown(&self, bench: &Bench, readings: &[f64], random: &mut Random) -> Vec<f64> {
        let protocol = &bench.protocol;
        let quantum = protocol.quantum;
        let step = |value: f64| if quantum > 0.0 { (value / quantum).round() * quantum } else { value };
        let mut source = Source::new(&self.shape);
        let runs = protocol.loadings.iter().map(|l| l.run + 1).max().unwrap_or(0);
        let zeros: Vec<[f64; 3]> = (0..runs)
            .map(|_| {
                self.times.map(|times| {
                    times * self.zero * self.sd * source.draw(random) + random.uniform(-0.5, 0.5) * quantum
                })
            })
            .collect();
        // noise of the last reading of each channel, and its run
        let mut last = [(usize::MAX, 0.0); 3];
        let fresh = (1.0 - self.correlation * self.correlation).sqrt();
        let shown = |(cell, reading): (&Cell, &f64)| {
            let run = protocol.loadings[cell.loading].run;
            let zero = zeros[if protocol.zeroed_once { 0 } else { run }][cell.channel];
            let drawn = source.draw(random);
            let (of_run, before) = last[cell.channel];
            let noise = if of_run == run { self.correlation * before + fresh * drawn } else { drawn };
            last[cell.channel] = (run, noise);
            step(reading + self.times[cell.channel] * self.sd * noise - zero)
        };
        protocol.cells().iter().zip(readings).map(shown).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawn(shape: &Shape) -> Vec<f64> {
        let (mut source, mut random) = (Source::new(shape), Random::seeded(1, 0));
        (0..40_000).map(|_| source.draw(&mut random)).collect()
    }

    #[test]
    fn every_shape_has_the_variance_it_says() {
        let residuals = vec![1.0, -1.0, 1.4, -1.4, 0.2, -0.2];
        for (shape, expected) in [
            (Shape::Normal, 1.0),
            (Shape::StudentT(5), 1.0),
            (Shape::Bootstrap(residuals), (2.0 + 2.0 * 1.96 + 0.08) / 6.0),
        ] {
            let squares: f64 = drawn(&shape).iter().map(|e| e * e).sum();
            let ratio = squares / 40_000.0 / expected;
            assert!((ratio - 1.0).abs() < 0.06, "{shape:?} {ratio}");
        }
    }

    #[test]
    fn residuals_come_in_stretches_of_neighbours() {
        let residuals: Vec<f64> = (0..50).map(f64::from).collect();
        let drawn = drawn(&Shape::Bootstrap(residuals));
        let follows = drawn.windows(2).filter(|pair| (pair[1] - pair[0] - 1.0).abs() < 1e-9).count();
        // three of four, and of the others one of fifty by chance; less the ends
        assert!((follows as f64 / 40_000.0 - 0.74).abs() < 0.02, "{follows}");
    }

    #[test]
    fn neighbours_of_a_run_are_correlated_and_runs_share_their_zero() {
        let bench = crate::rig::bench::tests::bench();
        let noise = Noise { correlation: 0.6, zero: 2.0, ..Noise::normal(1e-6) };
        let nothing = vec![0.0; bench.protocol.cells().len()];
        let (mut neighbours, mut means) = (0.0, 0.0);
        for seed in 0..400 {
            let shown = noise.shown(&bench, &nothing, &mut Random::seeded(seed, 0));
            // the first run's dx: six readings
            let of_run: Vec<f64> = (0..6).map(|k| shown[3 * k] / 1e-6).collect();
            neighbours += of_run.windows(2).map(|pair| (pair[1] - pair[0]).powi(2)).sum::<f64>() / 5.0;
            means += (of_run.iter().sum::<f64>() / 6.0).powi(2);
        }
        // E(e₂ − e₁)² = 2(1 − φ); the mean has the zero's 4 and what AR(1) leaves of the noise
        let ar: f64 = (0..6).flat_map(|i: i32| (0..6).map(move |j: i32| 0.6f64.powi((i - j).abs()))).sum();
        assert!((neighbours / 400.0 / 0.8 - 1.0).abs() < 0.1, "{neighbours}");
        assert!((means / 400.0 / (4.0 + ar / 36.0) - 1.0).abs() < 0.25, "{means}");
    }
}
