//! One of several sensors along the rod.

use super::*;
use crate::beam::{Physics, RodModel};

/// Along the second pipe, from the bend to the tip, m.
const STATIONS: [f64; 4] = [0.25, 0.35, 0.45, 0.6];

/// Three trials under loads along y and z, read in both channels at all stations, noise 1 µm;
/// `shown` of what a channel shows at a station (m), and `named` is the station that is written.
fn read(
    shown: impl Fn(f64, Axis, f64) -> f64,
    named: impl Fn(f64) -> f64,
) -> (Vec<(&'static str, String)>, Readings) {
    let (rod, mut random) = (rod(ROD_5), Random::seeded(3, 0));
    let model = RodModel::new(&rod, &Physics::default(), 1, &STATIONS).unwrap();
    let at: Vec<_> =
        STATIONS.map(|s| model.force_response(rod.length(), s).unwrap().translation).into_iter().collect();
    let mut text = "trial,axis,load_n,read_station_mm,dy_um,dz_um\n".to_owned();
    for (trial, axis) in (1..=3).flat_map(|trial| [Axis::Y, Axis::Z].map(|axis| (trial, axis))) {
        for load in [4.0, 8.0, 12.0, 16.0, 20.0] {
            for (c, station) in at.iter().zip(STATIONS) {
                let [y, z] = [Axis::Y, Axis::Z].map(|channel| {
                    let bent = c[(channel.index(), axis.index())] * load + UM * random.normal();
                    shown(station, channel, bent) / UM
                });
                let station = named(station) * 1e3;
                text += &format!("{trial},{axis},{load},{station},{y:.5},{z:.5}\n");
            }
        }
    }
    let readings = Readings::from_text("f", &text).unwrap();
    let mended = mended(&readings, Some(&rod), &[]).unwrap();
    (
        mended.found.iter().map(|found| (found.effect.name, found.location.to_string())).collect(),
        mended.readings,
    )
}

fn as_it_is(_: f64, _: Axis, bent: f64) -> f64 {
    bent
}

fn as_it_stands(station: f64) -> f64 {
    station
}

#[test]
fn one_sensor_that_is_right_is_no_mistake() {
    assert_eq!(read(as_it_is, as_it_stands).0, []);
    // 12 mm beside its station, and 20 % off: physics
    let beside = |station: f64, _: Axis, bent: f64| if station == 0.35 { 1.2 * bent } else { bent };
    assert_eq!(read(beside, as_it_stands).0, []);
}

#[test]
fn one_sensor_may_be_turned_round_or_in_another_unit() {
    let right = read(as_it_is, as_it_stands).1;
    let turned = |station: f64, _: Axis, bent: f64| if station == 0.45 { -bent } else { bent };
    let (found, mended) = read(turned, as_it_stands);
    assert_eq!(found, [("sign_mistake", "dy_um, dz_um, read_station_mm 450".to_owned())]);
    let in_mm = |station: f64, channel: Axis, bent: f64| {
        if station == 0.25 && channel == Axis::Z { bent / 1e3 } else { bent }
    };
    let (found, in_um) = read(in_mm, as_it_stands);
    assert_eq!(found, [("unit_mistake", "dz_um, read_station_mm 250".to_owned())]);
    for ((row, own), other) in right.rows.iter().zip(&mended.rows).zip(&in_um.rows) {
        for k in [1, 2] {
            let [row, own, other] = [row, own, other].map(|row| row.offset[k].unwrap());
            assert!((own - row).abs() < 1e-11 && (other - row).abs() < 1e-8, "{row} {own} {other}");
        }
    }
}

#[test]
fn two_stations_may_be_exchanged() {
    let exchanged = |station: f64| match station {
        0.35 => 0.45,
        0.45 => 0.35,
        other => other,
    };
    let (found, mended) = read(as_it_is, exchanged);
    assert_eq!(found, [("swap_mistake", "read_station_mm, 350 and 450".to_owned())]);
    let right = read(as_it_is, as_it_stands).1;
    assert!(right.rows.iter().zip(&mended.rows).all(|(a, b)| a.read_station == b.read_station));
}
