//! The 27 nonlinear regression problems of the NIST Statistical Reference Datasets, and the fit of
//! each.
//!
//! Data, starts and certified values are read from NIST's own files; only the models are written
//! here, generic in the number type, so that dual numbers give the exact Jacobian.

use std::f64::consts::PI;
use std::path::{Path, PathBuf};

use nalgebra::{DMatrix, DVector};
use rodcal::least_squares::{Fit, Options, Problem, fit};

use rodcal::dual::{Dual, Number};

/// A problem as NIST states it.
pub struct Nist {
    pub name: &'static str,
    model: Model,
    /// Two starts.
    pub starts: [Vec<f64>; 2],
    /// Certified parameters, standard deviations and residual sum of squares, 11 digits each.
    pub parameters: Vec<f64>,
    pub standard_deviations: Vec<f64>,
    pub sum_of_squares: f64,
    x: Vec<Vec<f64>>,
    y: Vec<f64>,
}

/// Digits in which a run agrees with the certified values; 11 is all of them.
pub struct Digits {
    pub parameters: f64,
    pub standard_deviations: f64,
    pub sum_of_squares: f64,
}

impl Nist {
    /// All problems from the folder of NIST's files; `None` where there is no such folder.
    pub fn all(folder: &Path) -> Option<Vec<Nist>> {
        folder.is_dir().then(|| MODELS.iter().map(|model| Nist::read(folder, model)).collect())
    }

    /// The folder beside the project where the files are looked for.
    pub fn folder() -> PathBuf {
        PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/real/nist"))
    }

    /// Fits from the given start, with the default options.
    pub fn fit(&self, start: usize) -> Fit {
        fit(self, &DVector::from_vec(self.starts[start].clone()), &Options::default())
            .unwrap_or_else(|e| panic!("{}: {e}", self.name))
    }

    /// Smallest number of matching digits over the parameters, over their standard deviations and
    /// in the sum.
    pub fn digits(&self, fit: &Fit) -> Digits {
        let errors: Vec<f64> = fit.standard_errors().iter().map(|e| e.unwrap_or(f64::NAN)).collect();
        let worst = |computed: &[f64], certified: &[f64]| {
            computed.iter().zip(certified).map(|(&x, &c)| matching_digits(x, c)).fold(11.0, f64::min)
        };
        Digits {
            parameters: worst(fit.parameters.as_slice(), &self.parameters),
            standard_deviations: worst(&errors, &self.standard_deviations),
            sum_of_squares: matching_digits(fit.sum_of_squares, self.sum_of_squares),
        }
    }

    fn read(folder: &Path, model: &Model) -> Nist {
        let path = folder.join(format!("{}.dat", model.name));
        let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        let numbers = |line: &str| -> Vec<f64> {
            line.split_whitespace().filter_map(|word| word.parse().ok()).collect()
        };
        let mut nist = Nist {
            name: model.name,
            model: *model,
            starts: [Vec::new(), Vec::new()],
            parameters: Vec::new(),
            standard_deviations: Vec::new(),
            sum_of_squares: f64::NAN,
            x: Vec::new(),
            y: Vec::new(),
        };
        // NIST's layout: values from line 41, data from line 61
        for (i, line) in text.lines().enumerate().skip(40) {
            if i >= 60 {
                let row = numbers(line);
                if row.len() >= 2 {
                    nist.y.push((model.response)(row[0]));
                    nist.x.push(row[1..].to_vec());
                }
            } else if let Some(sum) = line.strip_prefix("Residual Sum of Squares:") {
                nist.sum_of_squares = numbers(sum)[0];
            } else if let Some((name, values)) = line.split_once('=')
                && name.trim().starts_with('b')
            {
                let values = numbers(values);
                nist.starts[0].push(values[0]);
                nist.starts[1].push(values[1]);
                nist.parameters.push(values[2]);
                nist.standard_deviations.push(values[3]);
            }
        }
        assert!(nist.parameters.len() >= 2 && nist.y.len() > nist.parameters.len(), "{}", path.display());
        nist
    }
}

impl Problem for Nist {
    fn parameter_count(&self) -> usize {
        self.parameters.len()
    }

    fn residual_count(&self) -> usize {
        self.y.len()
    }

    fn residuals(&self, b: &DVector<f64>) -> DVector<f64> {
        DVector::from_fn(self.y.len(), |i, _| (self.model.value)(b.as_slice(), &self.x[i]) - self.y[i])
    }

    fn jacobian(&self, b: &DVector<f64>) -> DMatrix<f64> {
        let mut dual: Vec<Dual> = b.iter().map(|&b| Dual::from(b)).collect();
        let mut j = DMatrix::zeros(self.y.len(), b.len());
        for column in 0..b.len() {
            dual[column].eps = 1.0;
            for row in 0..self.y.len() {
                j[(row, column)] = (self.model.dual)(&dual, &self.x[row]).eps;
            }
            dual[column].eps = 0.0;
        }
        j
    }
}

/// −log₁₀ of the relative error, at most 11: the certified values have no more digits. Negative or
/// NaN counts as 0.
fn matching_digits(computed: f64, certified: f64) -> f64 {
    let digits = -((computed - certified) / certified).abs().log10();
    if digits.is_nan() { 0.0 } else { digits.clamp(0.0, 11.0) }
}

#[derive(Clone, Copy)]
struct Model {
    name: &'static str,
    value: fn(&[f64], &[f64]) -> f64,
    dual: fn(&[Dual], &[f64]) -> Dual,
    /// What of the first column of the data is modelled.
    response: fn(f64) -> f64,
}

const fn model(
    name: &'static str,
    value: fn(&[f64], &[f64]) -> f64,
    dual: fn(&[Dual], &[f64]) -> Dual,
) -> Model {
    Model { name, value, dual, response: |y| y }
}

const MODELS: [Model; 27] = [
    model("Misra1a", rise, rise),
    model("Chwirut2", ultrasound, ultrasound),
    model("Chwirut1", ultrasound, ultrasound),
    model("Lanczos3", three_exponentials, three_exponentials),
    model("Gauss1", two_peaks, two_peaks),
    model("Gauss2", two_peaks, two_peaks),
    model("DanWood", power, power),
    model("Misra1b", misra1b, misra1b),
    model("Kirby2", quadratic_over_quadratic, quadratic_over_quadratic),
    model("Hahn1", cubic_over_cubic, cubic_over_cubic),
    Model { response: f64::ln, ..model("Nelson", nelson, nelson) },
    model("MGH17", two_exponentials, two_exponentials),
    model("Lanczos1", three_exponentials, three_exponentials),
    model("Lanczos2", three_exponentials, three_exponentials),
    model("Gauss3", two_peaks, two_peaks),
    model("Misra1c", misra1c, misra1c),
    model("Misra1d", misra1d, misra1d),
    model("Roszman1", roszman, roszman),
    model("ENSO", cycles, cycles),
    model("MGH09", mgh09, mgh09),
    model("Thurber", cubic_over_cubic, cubic_over_cubic),
    model("BoxBOD", rise, rise),
    model("Rat42", rat42, rat42),
    model("MGH10", mgh10, mgh10),
    model("Eckerle4", eckerle, eckerle),
    model("Rat43", rat43, rat43),
    model("Bennett5", bennett, bennett),
];

fn rise<D: Number>(b: &[D], x: &[f64]) -> D {
    b[0] * (D::one() - (-b[1] * x[0]).exp())
}

fn ultrasound<D: Number>(b: &[D], x: &[f64]) -> D {
    (-b[0] * x[0]).exp() / (b[1] + b[2] * x[0])
}

fn three_exponentials<D: Number>(b: &[D], x: &[f64]) -> D {
    b[0] * (-b[1] * x[0]).exp() + b[2] * (-b[3] * x[0]).exp() + b[4] * (-b[5] * x[0]).exp()
}

fn two_peaks<D: Number>(b: &[D], x: &[f64]) -> D {
    let peak = |height: D, centre: D, width: D| height * (-((-centre + x[0]) / width).powi(2)).exp();
    b[0] * (-b[1] * x[0]).exp() + peak(b[2], b[3], b[4]) + peak(b[5], b[6], b[7])
}

fn power<D: Number>(b: &[D], x: &[f64]) -> D {
    b[0] * (b[1] * x[0].ln()).exp()
}

fn misra1b<D: Number>(b: &[D], x: &[f64]) -> D {
    b[0] * (D::one() - (b[1] * x[0] / 2.0 + 1.0).powi(-2))
}

fn misra1c<D: Number>(b: &[D], x: &[f64]) -> D {
    b[0] * (D::one() - (b[1] * 2.0 * x[0] + 1.0).powf(-0.5))
}

fn misra1d<D: Number>(b: &[D], x: &[f64]) -> D {
    b[0] * b[1] * x[0] / (b[1] * x[0] + 1.0)
}

fn quadratic_over_quadratic<D: Number>(b: &[D], x: &[f64]) -> D {
    let x = x[0];
    (b[0] + b[1] * x + b[2] * (x * x)) / (b[3] * x + b[4] * (x * x) + 1.0)
}

fn cubic_over_cubic<D: Number>(b: &[D], x: &[f64]) -> D {
    let x = x[0];
    let (x2, x3) = (x * x, x * x * x);
    (b[0] + b[1] * x + b[2] * x2 + b[3] * x3) / (b[4] * x + b[5] * x2 + b[6] * x3 + 1.0)
}

fn nelson<D: Number>(b: &[D], x: &[f64]) -> D {
    b[0] - b[1] * x[0] * (-b[2] * x[1]).exp()
}

fn two_exponentials<D: Number>(b: &[D], x: &[f64]) -> D {
    b[0] + b[1] * (-b[3] * x[0]).exp() + b[2] * (-b[4] * x[0]).exp()
}

fn roszman<D: Number>(b: &[D], x: &[f64]) -> D {
    b[0] - b[1] * x[0] - (b[2] / (-b[3] + x[0])).atan() / PI
}

fn cycles<D: Number>(b: &[D], x: &[f64]) -> D {
    let wave = |period: D, cosine: D, sine: D| {
        let phase = period.recip() * (2.0 * PI * x[0]);
        cosine * phase.cos() + sine * phase.sin()
    };
    b[0] + wave(D::from(12.0), b[1], b[2]) + wave(b[3], b[4], b[5]) + wave(b[6], b[7], b[8])
}

fn mgh09<D: Number>(b: &[D], x: &[f64]) -> D {
    let x = x[0];
    b[0] * (b[1] * x + x * x) / (b[2] * x + b[3] + x * x)
}

fn rat42<D: Number>(b: &[D], x: &[f64]) -> D {
    b[0] / ((b[1] - b[2] * x[0]).exp() + 1.0)
}

fn rat43<D: Number>(b: &[D], x: &[f64]) -> D {
    b[0] / (((b[1] - b[2] * x[0]).exp() + 1.0).ln() / b[3]).exp()
}

fn mgh10<D: Number>(b: &[D], x: &[f64]) -> D {
    b[0] * (b[1] / (b[2] + x[0])).exp()
}

fn eckerle<D: Number>(b: &[D], x: &[f64]) -> D {
    b[0] / b[1] * (((-b[2] + x[0]) / b[1]).powi(2) * -0.5).exp()
}

fn bennett<D: Number>(b: &[D], x: &[f64]) -> D {
    b[0] * (-(b[1] + x[0]).ln() / b[2]).exp()
}
