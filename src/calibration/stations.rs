//! Recordings from several stations: the frames of tracker or base, as the nominal robot shows
//! them.
//!
//! Of each station the base alone is fitted to its own points, with the tool that the largest of
//! them shows; the two bases give the motion from one frame to the other. That is as good as the
//! nominal robot, and a calibration corrects the rest (`problem.rs`).

use nalgebra::Vector3;

use super::campaign::{Recording, Targets};
use super::result::Calibration;
use super::start::rough_start;
use crate::error::Result;
use crate::robot::Robot;
use crate::spatial::{Pose, best_motion};

impl Recording {
    /// Brings the points of all stations, each given in its own frame, into that of the first, by
    /// the nominal robot; `base` and `tool` (m) are first guesses. Nothing with one station, nor
    /// with sockets.
    ///
    /// # Errors
    /// As [`crate::linalg::thin_svd`]; none in practice.
    pub fn align_stations(&mut self, robot: &Robot, base: Pose, tool: Vector3<f64>) -> Result<()> {
        let count = self.stations.len();
        let Targets::Points(points) = &self.targets else { return Ok(()) };
        if count < 2 {
            return Ok(());
        }
        let of_station = |station: usize| -> Vec<usize> {
            (0..self.len()).filter(|&row| self.rows[row].station == station).collect()
        };
        let rows: Vec<Vec<usize>> = (0..count).map(of_station).collect();
        let largest = rows.iter().max_by_key(|rows| rows.len()).map_or(&[][..], Vec::as_slice);
        let (_, tool) = rough_start(robot, &self.subset(largest), base, tool)?;
        let mut bases = Vec::with_capacity(count);
        for rows in &rows {
            let tips: Vec<Vector3<f64>> =
                rows.iter().map(|&row| robot.flange_at(self.joints(row)).point(&tool)).collect();
            let seen: Vec<Vector3<f64>> = rows.iter().map(|&row| points[row]).collect();
            bases.push(best_motion(&tips, &seen)?);
        }
        let frames: Vec<Pose> = bases.iter().map(|own| bases[0].then(&own.inverse())).collect();
        if let Targets::Points(points) = &mut self.targets {
            for (point, row) in points.iter_mut().zip(&self.rows).filter(|(_, row)| row.station > 0) {
                *point = frames[row.station].point(point);
            }
        }
        for (station, frame) in self.stations.iter_mut().zip(frames).skip(1) {
            station.frame = frame;
        }
        Ok(())
    }

    /// The points of a validation in the {W} of a calibration on `calibrated`: a station of the
    /// same name stands where it was found; any other is placed by the calibrated robot, so that
    /// only what no rigid motion explains is left there. As it is where no station is named.
    ///
    /// # Errors
    /// As [`crate::linalg::thin_svd`]; none in practice.
    pub(super) fn seen_from(&self, calibrated: &Recording, calibration: &Calibration) -> Result<Recording> {
        let mut brought = self.clone();
        let is_named = self.stations.iter().any(|station| !station.name.is_empty());
        let Targets::Points(points) = &mut brought.targets else { return Ok(brought) };
        if !is_named {
            return Ok(brought);
        }
        let robot = calibration.setup.calibrated();
        let base = calibration.setup.base();
        for (index, station) in self.stations.iter().enumerate() {
            let rows: Vec<usize> = (0..self.len()).filter(|&row| self.rows[row].station == index).collect();
            let known = calibrated.stations.iter().position(|known| known.name == station.name);
            let motion = match known.and_then(|known| Some((known, calibration.stations.get(known)?))) {
                Some((known, found)) => {
                    found.then(&calibrated.stations[known].frame).then(&station.frame.inverse())
                }
                None => {
                    let tip = |&row: &usize| {
                        base.then(&robot.flange_at(self.joints(row))).point(&calibration.setup.tool)
                    };
                    let seen: Vec<Vector3<f64>> = rows.iter().map(|&row| points[row]).collect();
                    best_motion(&seen, &rows.iter().map(tip).collect::<Vec<_>>())?
                }
            };
            rows.iter().for_each(|&row| points[row] = motion.point(&points[row]));
        }
        Ok(brought)
    }
}
