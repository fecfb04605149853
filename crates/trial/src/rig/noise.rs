//! The sensor: noise that need not be normal, a zero that is read once, a display with steps.

use super::bench::Bench;
use rodcal_base::statistics::Random;

/// Shape of the noise of one reading.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Shape {
    /// Gauss.
    Normal,
    /// Student's t with so many degrees of freedom, scaled to the standard deviation.
    StudentT(u32),
    /// Gauss, but every fiftieth reading scatters four times as much.
    Contaminated,
}

/// Share of the readings that are contaminated, and how much more they scatter.
const CONTAMINATED: (f64, f64) = (0.02, 4.0);

/// The noise of a recording.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Noise {
    /// Standard deviation of a reading that is not contaminated, m.
    pub sd: f64,
    /// Its shape.
    pub shape: Shape,
}

impl Noise {
    /// Variance of one reading with the display's steps, q²/12, m².
    pub fn variance(&self, quantum: f64) -> f64 {
        let (share, factor) = CONTAMINATED;
        let own = match self.shape {
            Shape::Contaminated => 1.0 + share * (factor * factor - 1.0),
            _ => 1.0,
        };
        self.sd * self.sd * own + quantum * quantum / 12.0
    }

    fn draw(&self, random: &mut Random) -> f64 {
        let normal = random.normal();
        let factor = match self.shape {
            Shape::Normal => 1.0,
            Shape::StudentT(dof) => {
                let squares: f64 = (0..dof).map(|_| random.normal().powi(2)).sum();
                (f64::from(dof.saturating_sub(2)) / squares).sqrt()
            }
            Shape::Contaminated if random.uniform(0.0, 1.0) < CONTAMINATED.0 => CONTAMINATED.1,
            Shape::Contaminated => 1.0,
        };
        self.sd * factor * normal
    }

    /// What the display shows: each run's zero of each channel was read once, with the same noise, and taken off.
    pub fn shown(&self, bench: &Bench, readings: &[f64], random: &mut Random) -> Vec<f64> {
        let protocol = &bench.protocol;
        let quantum = protocol.quantum;
        let step = |value: f64| if quantum > 0.0 { (value / quantum).round() * quantum } else { value };
        let runs = protocol.loadings.iter().map(|l| l.run + 1).max().unwrap_or(0);
        let zeros: Vec<[f64; 3]> = (0..runs)
            .map(|_| [0; 3].map(|_| self.draw(random) + random.uniform(-0.5, 0.5) * quantum))
            .collect();
        let cells = protocol.cells();
        let shown = |(cell, reading): (&super::protocol::Cell, &f64)| {
            let zero = zeros[protocol.loadings[cell.loading].run][cell.channel];
            step(reading + self.draw(random) - zero)
        };
        cells.iter().zip(readings).map(shown).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_shape_has_the_variance_it_says() {
        for shape in [Shape::Normal, Shape::StudentT(5), Shape::Contaminated] {
            let noise = Noise { sd: 2e-6, shape };
            let mut random = Random::seeded(1, 0);
            let n = 40_000;
            let sum: f64 = (0..n).map(|_| noise.draw(&mut random).powi(2)).sum();
            let ratio = sum / f64::from(n) / noise.variance(0.0);
            assert!((ratio - 1.0).abs() < 0.06, "{shape:?} {ratio}");
        }
    }
}
