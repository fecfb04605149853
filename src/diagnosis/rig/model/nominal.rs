//! The numbers of rod and rig that are known to a standard uncertainty, and what each does to the
//! readings.
//!
//! ```text
//! column   u·∂(C·F)/∂x     by the beam model of the rod with x + u and x − u
//! load     u·C·F           all loads by one scale
//! sensor   u·C·F           of one channel
//! station  u·∂(C·F)/∂s     every stated station of a load or of a sensor
//! point    u·∂(C·F)/∂s     of loads whose station no row states: they may not hang at the tip itself
//! root     θ = β·M at the root, in each session in which the rod was mounted anew
//! clamp    as l1: a clamp that is farther out leaves a shorter rod
//! ```

use std::collections::BTreeMap;

use nalgebra::{DMatrix, Matrix3};

use crate::diagnosis::rig::mechanics::structure::responses;
use crate::diagnosis::rig::numbering::numbered;
use crate::diagnosis::rig::recording::datum::Datum;
use crate::error::Result;
use crate::inference::NominalParameter;
use crate::rig::readings::RigHeader;
use crate::rod::{Joint, NominalNumber, Rod};
use crate::spatial::Axis;
use crate::statistics::{mad, standard_deviation};
use crate::units::{MM, PERCENT};

/// One µrad/(N·m).
const MICRORADIAN: f64 = 1e-6;
/// Standard uncertainty of a scale that the readings themselves gave.
const UNKNOWN_SCALE: f64 = 0.1;

/// What a rod that is mounted anew deflects otherwise along its loads, as a share, 1 σ, at least
/// and at most: flange and screws give way to another degree each time.
const MOUNTED_ANEW: (f64, f64) = (0.0005, 0.005);
/// Of what sessions differ by as a whole a single one may be the cause.
const OF_ALL: f64 = 0.5;
/// Sessions that have roots of their own, at most: each is a column.
const MOST_SESSIONS: usize = 50;

/// What a number that is known to a standard uncertainty is.
#[derive(Debug, Clone, PartialEq)]
pub enum KnownNumber {
    /// A number of the rod's file.
    OfRod(NominalNumber),
    /// The scale of all loads.
    LoadScale,
    /// The scale of the sensor of a channel.
    SensorScale(Axis),
    /// A station that the readings state, m.
    Station(f64),
    /// Where loads act whose station the readings do not state.
    LoadPoint,
    /// What the root of the session of this number gives way by, in bending or in torsion.
    Root(usize),
    /// A constant of a law of the rod's file: numbers of both.
    LawConstant(usize, usize),
}

/// All such numbers, with what each does.
pub struct KnownNumbers {
    pub known: Vec<KnownNumber>,
    pub parameters: Vec<NominalParameter>,
    /// For each of them its column.
    pub columns: DMatrix<f64>,
    /// What the rod as it bends would show, m.
    pub deflections: Vec<f64>,
}

/// The numbers of `rod`, their columns by the rod as it bends (`bent`), and what that one would
/// show, m; `stations` are the load and read stations of a datum on a rod.
pub fn all(
    data: &[Datum],
    rod: &Rod,
    bent: &Rod,
    header: &RigHeader,
    stations: &dyn Fn(&Rod, &Datum) -> (f64, f64),
) -> Result<KnownNumbers> {
    let (mut known, mut parameters) = (Vec::new(), Vec::new());
    let mut columns: Vec<Vec<f64>> = Vec::new();
    let mut add = |number: KnownNumber, parameter: NominalParameter, column: Vec<f64>| {
        if column.iter().any(|value| *value != 0.0) && column.iter().all(|value| value.is_finite()) {
            known.push(number);
            parameters.push(parameter);
            columns.push(column);
        }
    };
    let pairs = Pairs::new(data, bent, stations);
    let deflections = match bent == rod {
        true => data.iter().map(|d| d.predicted).collect(),
        false => pairs.read(data, &responses(bent, &pairs.on(bent))?),
    };
    let as_bent = bent.nominal_numbers();
    for nominal in rod.nominal_numbers() {
        let u = nominal.standard_uncertainty;
        let of_bent = as_bent.iter().find(|own| own.number == nominal.number).unwrap_or(&nominal);
        let by = of_bent.standard_uncertainty;
        let Some(changed) = [1.0, -1.0]
            .map(|sign| pairs.predicted(data, &bent.with(&nominal.number, of_bent.value + sign * by)))
            .into_iter()
            .collect::<Option<Vec<_>>>()
        else {
            continue;
        };
        let column = changed[0].iter().zip(&changed[1]).map(|(more, less)| 0.5 * (more - less));
        let (unit, si, value) = nominal.for_people();
        let name = nominal.number.to_string();
        let parameter = NominalParameter { name, unit, si, value, standard_uncertainty: u };
        add(KnownNumber::OfRod(nominal.number), parameter, column.collect());
    }
    let scale = |name: String, standard_uncertainty: f64| NominalParameter {
        name,
        unit: "%",
        si: PERCENT,
        value: 1.0,
        standard_uncertainty,
    };
    let loads = header.load_scale;
    let column = deflections.iter().map(|bent| loads * bent).collect();
    add(KnownNumber::LoadScale, scale("scale of the loads".into(), loads), column);
    for channel in Axis::ALL {
        let sensors = match header.has_unknown_scale[channel.index()] {
            true => UNKNOWN_SCALE,
            false => header.sensor_scale,
        };
        let of_channel = |(d, bent): (&Datum, &f64)| if d.channel == channel { sensors * bent } else { 0.0 };
        let parameter = scale(format!("scale of sensor d{channel}"), sensors);
        let column = data.iter().zip(&deflections).map(of_channel).collect();
        add(KnownNumber::SensorScale(channel), parameter, column);
    }
    let length = rod.standard_uncertainty.length;
    let along = |name: String, value: f64| NominalParameter {
        name,
        unit: "mm",
        si: MM,
        value,
        standard_uncertainty: length,
    };
    for station in pairs.stated(data) {
        let Some(column) = pairs.moved(data, bent, [station; 2], length) else { continue };
        let parameter = along(format!("station {:.1} mm", station / MM), station);
        add(KnownNumber::Station(station), parameter, column);
    }
    if data.iter().any(|d| d.load_station.is_none())
        && let Some(column) = pairs.moved(data, bent, [bent.length(), f64::NAN], length)
    {
        add(KnownNumber::LoadPoint, along("load point".into(), bent.length()), column);
    }
    for (session, parameter, column) in roots(data, bent, &pairs, &deflections) {
        add(KnownNumber::Root(session), parameter, column);
    }
    let columns = DMatrix::from_fn(data.len(), columns.len(), |i, k| columns[k][i]);
    Ok(KnownNumbers { known, parameters, columns, deflections })
}

/// Number, root and column of each session, where there are several: in bending and in torsion.
fn roots(
    data: &[Datum],
    rod: &Rod,
    pairs: &Pairs<'_>,
    deflections: &[f64],
) -> Vec<(usize, NominalParameter, Vec<f64>)> {
    let count = data.iter().map(|d| d.session_number).max().map_or(0, |last| last + 1);
    if !(2..=MOST_SESSIONS).contains(&count) {
        return Vec::new();
    }
    let mounted = session_scatter(data, count).clamp(MOUNTED_ANEW.0, MOUNTED_ANEW.1);
    let mut all = Vec::new();
    for (way, [bending, torsion]) in [("bending", [1.0, 0.0]), ("torsion", [0.0, 1.0])] {
        let mut softer = rod.clone();
        softer.joints.push(Joint::new("root", 0.0, bending * MICRORADIAN, torsion * MICRORADIAN));
        let Some(softer) = pairs.predicted(data, &softer) else { continue };
        let more: Vec<f64> = softer.iter().zip(deflections).map(|(softer, bent)| softer - bent).collect();
        // the share that the most sensitive line changes by
        let share = |(d, (more, bent)): (&Datum, (&f64, &f64))| {
            let is_along = d.channel == d.direction.axis && *bent != 0.0;
            if is_along { (more / bent).abs() } else { 0.0 }
        };
        let most = data.iter().zip(more.iter().zip(deflections)).map(share).fold(0.0, f64::max);
        let times = if most > 0.0 { mounted / most } else { 0.0 };
        for session in 0..count {
            let own = data.iter().find(|d| d.session_number == session);
            let name = own.and_then(|d| d.session.as_deref()).unwrap_or("without a name");
            let parameter = NominalParameter {
                name: format!("the root's {way} in session {name}"),
                unit: "µrad/(N·m)",
                si: MICRORADIAN,
                value: 0.0,
                standard_uncertainty: times * MICRORADIAN,
            };
            let of_datum = |(d, more): (&Datum, &f64)| match d.session_number == session {
                true => times * more,
                false => 0.0,
            };
            all.push((session, parameter, data.iter().zip(&more).map(of_datum).collect()));
        }
    }
    all
}

/// How far apart the slopes Σ y·ŷ/Σ ŷ² of a line along its loads are from session to session, ŷ by
/// the base model, as a share, 1 σ: the largest of all lines. One session may be far off; of two
/// nobody knows which.
fn session_scatter(data: &[Datum], count: usize) -> f64 {
    let line = numbered(data.iter().map(Datum::line_key));
    // y·ŷ and ŷ² by line and session
    let mut sums: BTreeMap<usize, Vec<[f64; 2]>> = BTreeMap::new();
    for (d, line) in data.iter().zip(line).filter(|(d, _)| d.channel == d.direction.axis) {
        let sum = &mut sums.entry(line).or_insert_with(|| vec![[0.0; 2]; count])[d.session_number];
        sum[0] += d.measured * d.predicted;
        sum[1] += d.predicted * d.predicted;
    }
    let of_line = |own: &Vec<[f64; 2]>| {
        let slopes: Vec<f64> =
            own.iter().filter(|sum| sum[1] > 0.0).map(|[product, square]| product / square).collect();
        let whole = standard_deviation(&slopes).filter(|_| slopes.len() > 2)?;
        Some((mad(&slopes)?).max(OF_ALL * whole))
    };
    sums.values().filter_map(of_line).fold(0.0, f64::max)
}

/// Which pair of load and read station each datum has.
struct Pairs<'a> {
    of_datum: Vec<usize>,
    first: Vec<usize>,
    data: &'a [Datum],
    stations: &'a dyn Fn(&Rod, &Datum) -> (f64, f64),
}

impl<'a> Pairs<'a> {
    fn new(data: &'a [Datum], rod: &Rod, stations: &'a dyn Fn(&Rod, &Datum) -> (f64, f64)) -> Pairs<'a> {
        let bits = |d: &Datum| {
            let (load, read) = stations(rod, d);
            (load.to_bits(), read.to_bits())
        };
        let of_datum = numbered(data.iter().map(bits));
        let mut first = Vec::new();
        for (i, &number) in of_datum.iter().enumerate() {
            if number == first.len() {
                first.push(i);
            }
        }
        Pairs { of_datum, first, data, stations }
    }

    /// Load and read station of each pair on another rod, m.
    fn on(&self, rod: &Rod) -> Vec<(f64, f64)> {
        self.first.iter().map(|&i| (self.stations)(rod, &self.data[i])).collect()
    }

    /// What another rod would show; `None` where the beam model refuses it.
    fn predicted(&self, data: &[Datum], rod: &Rod) -> Option<Vec<f64>> {
        let parts = responses(rod, &self.on(rod)).ok()?;
        Some(self.read(data, &parts))
    }

    fn read(&self, data: &[Datum], parts: &[Matrix3<f64>]) -> Vec<f64> {
        let entry = |(d, &pair): (&Datum, &usize)| {
            d.elastic(parts[pair][(d.channel.index(), d.direction.axis.index())])
        };
        data.iter().zip(&self.of_datum).map(entry).collect()
    }

    /// Stations that the readings state, m.
    fn stated(&self, data: &[Datum]) -> Vec<f64> {
        let mut stations: Vec<f64> =
            data.iter().flat_map(|d| [d.load_station, d.read_station]).flatten().collect();
        stations.sort_by(f64::total_cmp);
        stations.dedup();
        stations
    }

    /// The column of loads at the first of these stations and of sensors at the second that are
    /// `by` (m) farther from the flange. Beyond the tip there is no rod: there its other side
    /// counts twice.
    fn moved(&self, data: &[Datum], rod: &Rod, stations: [f64; 2], by: f64) -> Option<Vec<f64>> {
        let tip = rod.length();
        let move_by = |station: f64, own: f64, shift: f64| match station == own {
            true => (station + shift).clamp(0.0, tip),
            false => station,
        };
        let at = |shift: f64| {
            let pairs: Vec<(f64, f64)> = self
                .on(rod)
                .into_iter()
                .map(|(load, read)| (move_by(load, stations[0], shift), move_by(read, stations[1], shift)))
                .collect();
            Some(self.read(data, &responses(rod, &pairs).ok()?))
        };
        let own = stations[0];
        let span = move_by(own, own, by) - move_by(own, own, -by);
        let (more, less) = (at(by)?, at(-by)?);
        Some(more.iter().zip(&less).map(|(more, less)| by / span * (more - less)).collect())
    }
}

/// A rod whose numbers are all exact has none of its own.
#[cfg(test)]
mod tests {
    use crate::diagnosis::rig::RigModel;
    use crate::rig::readings::Readings;
    use crate::rod::{NominalNumber, Rod};

    #[test]
    fn a_column_is_the_difference_to_the_rod_with_another_number() {
        let rod = Rod::from_toml("rod", include_str!("../../../../rods/5.toml")).unwrap();
        let text = "axis,load_n,dy_um,dz_um\ny,10,400,\ny,20,800,\nz,20,,800\n";
        let readings = Readings::from_text("f", text).unwrap();
        let (model, evidence) = RigModel::new(&readings, Some(&rod)).unwrap();
        let k = evidence.nominal_numbers.iter().position(|n| n.name == "E of steel").unwrap();
        let number = NominalNumber::YoungsModulus("steel".into());
        let nominal = rod.nominal_numbers().into_iter().find(|n| n.number == number).unwrap();
        let softer = rod.with(&number, nominal.value + nominal.standard_uncertainty);
        let (changed, _) = RigModel::new(&readings, Some(&softer)).unwrap();
        for (i, datum) in changed.data().iter().enumerate() {
            let difference = datum.predicted - model.data()[i].predicted;
            let column = evidence.nominal[(i, k)];
            assert!((column / difference - 1.0).abs() < 0.03, "{column} for {difference}");
        }
    }
}
