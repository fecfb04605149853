//! The numbers of the files as they really are: each is off by about its standard uncertainty.
//!
//! A rod file states how well its numbers are known, or says nothing and means the defaults of
//! `[standard_uncertainty]`: E 1 %, G 2 %, κ 3 % (5, 10 and 15 % of an anisotropic wall), 0.03 mm
//! on each diameter, 0.3 mm on every length and station; loads and sensors are off by 0.1 %.

use super::drawing::Drawing;
use rodcal_base::statistics::Random;

/// Scale of the loads and of each sensor, 1 σ.
const SCALE: f64 = 1e-3;

/// A number that is known to a standard uncertainty. Tubes by their index; of one material both
/// have the same moduli.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Number {
    Youngs(usize),
    Shear(usize),
    Coefficient(usize),
    Outer(usize),
    Inner(usize),
    Leg(usize),
    BendRadius,
    Joint(usize),
    Loads,
    Sensor(usize),
    /// A station that the readings state, m.
    Station(f64),
}

/// How far every number of a rig is from what the files state.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Actual {
    /// Each number with its standard uncertainty, relative or m, and its error in multiples of
    /// that.
    numbers: Vec<(Number, f64, f64)>,
}

impl Actual {
    /// Every number of `drawing` and of readings at `stations` (m), off by normal errors `times` as
    /// large as stated.
    pub fn drawn(drawing: &Drawing, stations: &[f64], times: f64, random: &mut Random) -> Actual {
        let stated = drawing.tubes.each_ref().map(|tube| drawing.uncertainty_of(tube));
        let length = stated[0].length;
        let is_one_material = drawing.tubes[0].material == drawing.tubes[1].material;
        let mut numbers = Vec::new();
        for (k, tube) in stated.iter().enumerate() {
            if k == 0 || !is_one_material {
                numbers.push((Number::Youngs(k), tube.youngs_modulus));
                numbers.push((Number::Shear(k), tube.shear_modulus));
                numbers.push((Number::Coefficient(k), tube.shear_coefficient));
            }
            numbers.push((Number::Outer(k), tube.diameter));
            numbers.push((Number::Inner(k), tube.diameter));
            numbers.push((Number::Leg(k), length));
            numbers.push((Number::Sensor(k), SCALE));
        }
        numbers.push((Number::Sensor(2), SCALE));
        numbers.push((Number::Loads, SCALE));
        if drawing.arc() > 0.0 {
            numbers.push((Number::BendRadius, length));
        }
        numbers.extend((0..drawing.joints.len()).map(|k| (Number::Joint(k), length)));
        numbers.extend(stations.iter().map(|station| (Number::Station(*station), length)));
        let off = |(number, u): (Number, f64)| (number, u, times * random.normal());
        Actual { numbers: numbers.into_iter().map(off).collect() }
    }

    /// How many numbers there are.
    pub fn len(&self) -> usize {
        self.numbers.len()
    }

    /// The error of a number in its standard uncertainties.
    pub fn error(&self, which: usize) -> f64 {
        self.numbers.get(which).map_or(0.0, |(_, _, error)| *error)
    }

    /// With one error changed by so many standard uncertainties.
    pub fn moved(&self, which: usize, by: f64) -> Actual {
        let mut moved = self.clone();
        if let Some((_, _, error)) = moved.numbers.get_mut(which) {
            *error += by;
        }
        moved
    }

    /// The rod as it really is.
    pub fn rod(&self, drawing: &Drawing) -> Drawing {
        let mut rod = drawing.clone();
        let is_one_material = rod.tubes[0].material == rod.tubes[1].material;
        for &(number, u, error) in &self.numbers {
            let by = u * error;
            let of_material = |k: usize| if is_one_material { vec![0, 1] } else { vec![k] };
            match number {
                Number::Youngs(k) => {
                    of_material(k).into_iter().for_each(|k| rod.tubes[k].youngs_modulus *= 1.0 + by);
                }
                Number::Shear(k) => {
                    of_material(k).into_iter().for_each(|k| rod.tubes[k].shear_modulus *= 1.0 + by);
                }
                Number::Coefficient(k) => {
                    of_material(k).into_iter().for_each(|k| rod.tubes[k].coefficient *= 1.0 + by);
                }
                Number::Outer(k) => rod.tubes[k].outer += by / 2.0,
                Number::Inner(k) => rod.tubes[k].inner = (rod.tubes[k].inner + by / 2.0).max(0.0),
                Number::Leg(k) => rod.legs[k] += by,
                Number::BendRadius => rod.bend_radius += by,
                Number::Joint(k) => rod.joints[k].1 += by,
                Number::Loads | Number::Sensor(_) | Number::Station(_) => {}
            }
        }
        rod
    }

    /// True over nominal load.
    pub fn load_scale(&self) -> f64 {
        1.0 + self.sum(|number| *number == Number::Loads)
    }

    /// Shown over true displacement of a channel.
    pub fn sensor_scale(&self, channel: usize) -> f64 {
        1.0 + self.sum(|number| *number == Number::Sensor(channel))
    }

    /// Where a station of the readings really is, m; what they do not state is exact.
    pub fn station(&self, station: f64) -> f64 {
        station + self.sum(|number| *number == Number::Station(station))
    }

    fn sum(&self, is_it: impl Fn(&Number) -> bool) -> f64 {
        self.numbers.iter().filter(|(number, ..)| is_it(number)).map(|(_, u, error)| u * error).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rig::drawing::tests::l_shape;
    use crate::rig::tube::Tube;
    use crate::rig::uncertainty::Uncertainty;

    #[test]
    fn numbers_are_off_by_what_the_file_states_and_both_pipes_by_one_modulus() {
        let drawing = l_shape(0.04);
        let (mut squares, mut diameters) = (0.0, 0.0);
        for seed in 0..400 {
            let actual = Actual::drawn(&drawing, &[0.3], 1.0, &mut Random::seeded(seed, 0));
            let rod = actual.rod(&drawing);
            let [first, second] = &rod.tubes;
            assert_eq!(first.youngs_modulus, second.youngs_modulus);
            squares += (first.youngs_modulus / drawing.tubes[0].youngs_modulus - 1.0).powi(2);
            diameters += (2.0 * (first.outer - drawing.tubes[0].outer)).powi(2);
            assert_eq!(actual.station(0.2), 0.2);
            assert!(actual.station(0.3) != 0.3 && rod.legs[0] != rod.legs[1]);
        }
        let rms = |sum: f64| (sum / 400.0).sqrt();
        assert!((rms(squares) / 0.01 - 1.0).abs() < 0.1, "{}", rms(squares));
        assert!((rms(diameters) / 0.03e-3 - 1.0).abs() < 0.1, "{}", rms(diameters));
        assert_eq!(Actual::default().rod(&drawing), drawing);
    }

    #[test]
    fn a_laminate_is_less_well_known() {
        let steel = l_shape(0.0).tubes[0].clone();
        assert_eq!(Uncertainty::default_of(&steel).youngs_modulus, 0.01);
        let carbon = Tube { youngs_modulus: 118e9, shear_modulus: 9.5e9, ..steel };
        assert_eq!(Uncertainty::default_of(&carbon).shear_modulus, 0.1);
    }
}
