//! Sensors that scatter otherwise than the others do.

use serde_json::{Value, json};

use crate::diagnosis::rig::{Datum, RigDiagnosis};
use crate::report::diagnosis::headline::um;
use crate::report::diagnosis::subject::Uneven;
use crate::units::{MM, UM, significant};

/// What is said of them; nothing where all scatter alike.
pub fn uneven(found: &RigDiagnosis) -> Option<Uneven> {
    let evidence = &found.evidence;
    let noise = found.diagnosis.noise;
    let mut seen = Vec::new();
    let (mut words, mut sensors) = (Vec::new(), Vec::new());
    for (datum, &spread) in found.model.data().iter().zip(&evidence.spread) {
        let sensor = name(datum);
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
        sensors: Value::Array(sensors),
    })
}

/// `dz`, `dz at 300.0 mm`, `the measured loads`.
fn name(datum: &Datum) -> String {
    let at = datum.read_station.map_or_else(String::new, |s| format!(" at {:.1} mm", s / MM));
    match datum.imposed {
        None => format!("d{}{at}", datum.channel),
        Some(_) => "the measured loads".to_owned(),
    }
}
