//! Sensors that scatter otherwise than the others do.

use serde_json::{Value, json};

use crate::diagnosis::rig::{Datum, RigDiagnosis};
use crate::report::diagnosis::headline::um;
use crate::report::diagnosis::subject::Uneven;
use crate::units::{MM, UM, significant};

/// What is said of them; nothing where all scatter alike.
pub fn uneven(found: &RigDiagnosis) -> Option<Uneven> {
    let evidence = &found.diagnosis.settled.0;
    let noise = found.diagnosis.noise;
    let data = || found.model.data().iter().zip(&evidence.spread);
    let mut of_loads = data().filter(|(datum, _)| datum.imposed.is_some()).map(|(_, spread)| *spread);
    let first = of_loads.next();
    let is_one = of_loads.all(|spread| Some(spread) == first);
    let mut seen = Vec::new();
    let (mut words, mut sensors) = (Vec::new(), Vec::new());
    for (datum, &spread) in data() {
        let sensor = name(datum, is_one);
        if spread == 1.0 || seen.contains(&sensor) {
            continue;
        }
        let own = spread * noise;
        let (size, key, value) = match datum.imposed {
            None => (um(own) + " µm", "noise_um", own / UM),
            Some(imposed) => {
                let newtons = own / imposed.per_newton;
                (significant(newtons, 2) + " N", "noise_n", newtons)
            }
        };
        words.push(format!("{sensor} by {size}"));
        sensors.push(json!({ "sensor": sensor, "times": spread, key: value }));
        seen.push(sensor);
    }
    (!words.is_empty()).then(|| Uneven {
        words: format!(
            "Not all sensors scatter alike, and each counts as it does: {}, the others by {} µm.",
            words.join(", "),
            um(noise)
        ),
        key: "sensors",
        all: Value::Array(sensors),
        table: None,
    })
}

/// `dz`, `dz at 300.0 mm`, `the measured loads`; by axis where these are not one sensor.
fn name(datum: &Datum, are_loads_one: bool) -> String {
    let at = datum.read_station.map_or_else(String::new, |s| format!(" at {:.1} mm", s / MM));
    match datum.imposed {
        None => format!("d{}{at}", datum.channel),
        Some(_) if are_loads_one => "the measured loads".to_owned(),
        Some(_) => format!("the measured loads along {}", datum.direction.axis),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::rig::diagnose;
    use crate::rig::readings::Readings;
    use crate::statistics::Random;

    /// A load cell of 0.05 N beside sensors of 0.3 µm, of a rod of 50 µm/N; without its file.
    #[test]
    fn a_load_cell_is_told_in_newtons_and_the_others_in_micrometres() {
        let mut random = Random::seeded(4, 0);
        let mut text = "# driven = \"displacement\"\naxis,load_n,dx_um,dy_um,dz_um\n".to_owned();
        for load in [2, 4, 6, 8, 6, 4, 2, 1].repeat(4) {
            let [x, y, z] = [0.0, 50.0, 0.0].map(|c| c * f64::from(load) + 0.3 * random.normal());
            let measured = f64::from(load) + 0.05 * random.normal();
            text += &format!("y,{measured:.4},{x:.2},{y:.2},{z:.2}\n");
        }
        let found = diagnose(&Readings::from_text("f", &text).unwrap(), None).unwrap();
        let Uneven { words, all: sensors, .. } = uneven(&found).unwrap();
        let start = "Not all sensors scatter alike, and each counts as it does: the measured loads by 0.0";
        assert!(words.starts_with(start) && words.contains(" N, the others by 0."), "{words}");
        let noise = sensors[0]["noise_n"].as_f64().unwrap();
        assert!((0.03..0.08).contains(&noise) && sensors[0]["sensor"] == "the measured loads", "{sensors}");
    }
}
