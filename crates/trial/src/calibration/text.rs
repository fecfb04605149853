//! The files of a campaign: a robot as its maker has it, guesses of base and tool, and the
//! recording.

use std::fmt::Write;

use nalgebra::{Matrix4, Vector3};

use super::arm::Known;
use super::nuisance::DISTANCE_SD;
use super::site::{Devices, Site};
use crate::rig::drawing::{Drawing, rounded};
use rodcal_base::statistics::Random;
use rodcal_base::units::{DEG, MM, UM};

const FIRST: &str = "# SIMULATED for a concealed-effect trial, not a recording.\n";

/// A guess of where the base is: xyz, and roll, pitch, yaw.
pub fn guess(site: &Site, random: &mut Random) -> [Vector3<f64>; 2] {
    let [xyz, rpy] = place(&site.base);
    let mut about = |size: f64| Vector3::from_fn(|_, _| size * random.normal());
    [xyz + about(2.0 * MM), rpy + about(0.1 * DEG)]
}

/// A recording as it is written down.
#[derive(Debug, Clone, PartialEq)]
pub struct Written {
    /// Robot, rod, fixtures and angles as the files have them.
    pub site: Site,
    /// Where the file has the base.
    pub guess: [Vector3<f64>; 2],
    /// What was read, m.
    pub read: Vec<Vector3<f64>>,
    /// Rods whose files stand beside that of the campaign.
    pub others: Vec<(String, Drawing)>,
}

/// Name and text of each.
pub fn files(Written { site, guess, read, others }: &Written) -> Vec<(String, String)> {
    let mut files = vec![
        ("campaign.toml".to_owned(), campaign(site, guess)),
        ("robot.toml".to_owned(), robot(site)),
        ("measurements.csv".to_owned(), measurements(site, read)),
    ];
    files.extend(site.rod.as_ref().map(|rod| ("rod.toml".to_owned(), rod.drawing.toml("case"))));
    let other = |(k, (name, drawing)): (usize, &(String, Drawing))| {
        (name.clone(), drawing.toml(&format!("case, rod {}", k + 2)))
    };
    files.extend(others.iter().enumerate().map(other));
    files
}

/// The files of poses that are asked for, the first row left out; `force` is on the ball, N.
pub fn query(site: &Site, force: &Vector3<f64>) -> Vec<(String, String)> {
    let mut text = FIRST.to_owned()
        + "# It asks: where would the ball be in these poses, with this force on it and with this rod? A 0 stands for each \
           coordinate.\nrobot = \"robot.toml\"\nmeasurements = \"asked.csv\"\n";
    let rod = site.rod.as_ref().map(|rod| ("asked_rod.toml".to_owned(), rod.drawing.toml("case")));
    if let Some((name, _)) = &rod {
        let _ = writeln!(text, "rod = \"{name}\"");
    }
    let _ = writeln!(text, "contact_force_n = {}", three(force, 1.0));
    let asked = Site { rows: site.rows[1..].to_vec(), ..site.clone() };
    let table = measurements(&asked, &vec![Vector3::zeros(); asked.rows.len()]);
    let mut files = vec![("asked.toml".to_owned(), text), ("asked.csv".to_owned(), table)];
    files.extend(rod);
    files
}

fn three(v: &Vector3<f64>, unit: f64) -> String {
    let [x, y, z] = [v.x, v.y, v.z].map(|v| (v / unit * 1e6).round() / 1e6);
    format!("[{x:?}, {y:?}, {z:?}]")
}

/// xyz and roll, pitch, yaw.
pub fn place(frame: &Matrix4<f64>) -> [Vector3<f64>; 2] {
    let pitch = (-frame[(2, 0)]).asin();
    let rpy = Vector3::new(frame[(2, 1)].atan2(frame[(2, 2)]), pitch, frame[(1, 0)].atan2(frame[(0, 0)]));
    [frame.column(3).xyz(), rpy]
}

fn campaign(site: &Site, [xyz, rpy]: &[Vector3<f64>; 2]) -> String {
    let mut text = FIRST.to_owned() + "robot = \"robot.toml\"\nmeasurements = \"measurements.csv\"\n";
    if site.rod.is_some() {
        text += "rod = \"rod.toml\"\n";
    }
    if site.contact.norm() > 0.0 {
        let _ = writeln!(text, "contact_force_n = {}", three(&site.contact, 1.0));
    }
    if site.rod.is_none() {
        let _ = writeln!(text, "[tool]\nxyz_mm = {}", three(&site.drawn_tool, MM));
    }
    let _ = write!(text, "[base]\nxyz_mm = {}\nrpy_deg = {}\n", three(xyz, MM), three(rpy, DEG));
    let stated = site.scatter.stated().map(|sd| format!("position_um = {:.3}\n", sd / UM));
    let places = site.clamp_sd.map(|sd| format!("clamp_um = {:.1}\n", sd / UM));
    if stated.is_some() || places.is_some() {
        text += "[noise]\n";
        text.extend(stated.into_iter().chain(places));
    }
    match &site.devices {
        Devices::Clamps(clamps) => {
            for (k, clamp) in clamps.iter().enumerate() {
                let [xyz, rpy] = place(clamp);
                let (xyz, rpy) = (three(&xyz, MM), rpy / DEG);
                let _ = write!(
                    text,
                    "[[clamp]]\nid = \"{}\"\nxyz_mm = {xyz}\nrpy_deg = [{:.10}, {:.10}, {:.10}]\n",
                    k + 1,
                    rpy.x,
                    rpy.y,
                    rpy.z
                );
            }
        }
        Devices::Tracker(_) => {}
        Devices::Sockets(_, distance) => {
            let sd = DISTANCE_SD / MM;
            let _ = writeln!(text, "[sockets]\ndistance_mm = {:.4}\ndistance_sd_mm = {sd}", distance / MM);
        }
    }
    text
}

fn robot(site: &Site) -> String {
    let mut text = FIRST.to_owned() + "name = \"arm\"\nconvention = \"hayati\"\n";
    if site.known.is_stated {
        let Known { length, angle, zero, mass, .. } = site.known;
        let [length, angle, zero, mass] =
            [length / MM, angle / DEG, zero / DEG, 100.0 * mass].map(|value| rounded(value, 6));
        let _ = write!(
            text,
            "[standard_uncertainty]\nlength_mm = {length}\nangle_deg = {angle}\njoint_zero_deg = {zero}\nmass_percent = {mass}\n"
        );
    }
    for link in &site.nominal {
        let [theta, d, a, alpha, beta] = link.numbers;
        let rounded = |value: f64| rounded(value, 9);
        let _ = write!(
            text,
            "[[joint]]\ntheta_offset_deg = {:?}\nd_mm = {:?}\na_mm = {:?}\nalpha_deg = {:?}\nbeta_deg = {:?}\n",
            rounded(theta / DEG),
            rounded(d / MM),
            rounded(a / MM),
            rounded(alpha / DEG),
            rounded(beta / DEG)
        );
        if site.has_masses {
            let _ = writeln!(text, "mass_kg = {:?}\ncom_mm = {}", link.mass, three(&link.centre, MM));
        }
    }
    text
}

fn measurements(site: &Site, read: &[Vector3<f64>]) -> String {
    let mut names: Vec<String> = vec!["pose".into()];
    names.extend(match &site.devices {
        Devices::Clamps(_) => vec!["clamp".to_owned()],
        Devices::Tracker(_) => Vec::new(),
        Devices::Sockets(..) => vec!["placement".into(), "socket".into()],
    });
    names.extend((1..=site.nominal.len()).map(|joint| format!("q{joint}_deg")));
    if !site.has_sockets() {
        names.extend(["x_mm", "y_mm", "z_mm"].map(str::to_owned));
    }
    names.extend(site.has_time.then(|| "time_s".to_owned()));
    names.extend(site.has_temperature.then(|| "temperature_c".to_owned()));
    let mut text = FIRST.to_owned() + &names.join(",") + "\n";
    for (k, (row, read)) in site.rows.iter().zip(read).enumerate() {
        let mut cells = vec![(k + 1).to_string()];
        cells.extend(match &site.devices {
            Devices::Clamps(_) => vec![(row.group + 1).to_string()],
            Devices::Tracker(_) => Vec::new(),
            Devices::Sockets(sockets, _) => {
                let (placement, socket, _) = sockets[row.group];
                vec![format!("p{}", placement + 1), socket.to_string()]
            }
        });
        cells.extend(row.q.iter().map(|q| format!("{:.7}", q / DEG)));
        if !site.has_sockets() {
            cells.extend(read.iter().map(|v| format!("{:.4}", (v / UM * 10.0).round() / 10.0 * UM / MM)));
        }
        cells.extend(site.has_time.then(|| format!("{:.1}", row.time)));
        cells.extend(site.has_temperature.then(|| format!("{:.2}", row.temperature)));
        text += &(cells.join(",") + "\n");
    }
    text
}
