//! Campaigns without files.

use nalgebra::Vector3;

use super::{Campaign, Group, GroupName, ParameterConstraints, Recording, Refit, Row, Station, Targets};
use crate::error::{Error, Result};
use crate::rig::readings::Readings;
use crate::robot::Robot;
use crate::rod::Rod;
use crate::spatial::Pose;

impl Campaign {
    /// A campaign of a nominal robot and what was measured with it: no rod, no contact force, the
    /// tip at the flange's centre, a base that the rough start finds.
    ///
    /// The methods named `with_…` add to that, and every field may be set. Nothing is checked for
    /// plausibility here, as the reader of files does: `warnings` stays empty.
    ///
    /// A planar arm of two links of 0.4 m and 0.3 m, the first of which is 1 mm longer than its
    /// drawing says, seen by a tracker:
    ///
    /// ```
    /// use rodcal::prelude::*;
    ///
    /// let link = |a| Hayati { a, ..Hayati::default() };
    /// let arm = |a| Robot::new("arm", vec![
    ///     Joint::new("shoulder", Motion::Revolute, link(a)),
    ///     Joint::new("elbow", Motion::Revolute, link(0.3)),
    /// ]);
    /// let built = arm(0.401);
    /// let mut measured = Recording::new(2);
    /// for k in 0..30 {
    ///     let q = [0.2 * f64::from(k), 1.5 - 0.3 * f64::from(k)];
    ///     measured.add(&q, built.flange_at(&q).origin)?;
    /// }
    /// let campaign = Campaign::new(arm(0.400), measured)?;
    /// let calibration = calibrate(&campaign, Mode::None, &Options::default())?;
    /// let length = calibration.setup.get(Parameter::A(0));
    /// assert!((length - 0.401).abs() < 1e-6, "{length}");
    /// # Ok::<(), rodcal::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Argument`] where the recording is empty or has another number of joints than the
    /// robot.
    pub fn new(robot: Robot, measurements: Recording) -> Result<Campaign> {
        fits(&robot, &measurements)?;
        Ok(Campaign {
            file: "campaign".into(),
            robot_file: robot.name.clone(),
            robot_text: String::new(),
            effects_file: None,
            robot,
            base_link: None,
            tip_link: None,
            rod: None,
            rod_file: None,
            readings: None,
            contact_force: None,
            tool: Vector3::zeros(),
            tool_is_given: false,
            base: [0.0; 6],
            base_is_given: false,
            clamps: match &measurements.targets {
                Targets::Points(_) => {
                    measurements.groups.iter().filter(|group| !group.name.is_tracked()).cloned().collect()
                }
                Targets::Sockets(_) => Vec::new(),
            },
            measurements,
            validation: None,
            refit: Refit::BaseTool,
            noise: None,
            clamp_uncertainty: None,
            accuracy: None,
            constraints: ParameterConstraints::default(),
            warnings: Vec::new(),
        })
    }

    /// With a measuring rod on the flange: its tip is the first guess of the tool.
    pub fn with_rod(self, rod: Rod) -> Campaign {
        Campaign { tool: rod.tip(), rod: Some(rod), ..self }
    }

    /// With readings of the rod on a rig, which make [`Mode::Meas`](crate::calibration::Mode::Meas)
    /// available.
    pub fn with_readings(self, readings: Readings) -> Campaign {
        Campaign { readings: Some(readings), ..self }
    }

    /// With a force on the ball, N, in the device frame of each clamp (of {W} without clamps).
    pub fn with_contact_force(self, force: Vector3<f64>) -> Campaign {
        Campaign { contact_force: Some(force), ..self }
    }

    /// With a first guess of the undeflected tip in {T}, m.
    pub fn with_tool(self, tool: Vector3<f64>) -> Campaign {
        Campaign { tool, tool_is_given: true, ..self }
    }

    /// With a first guess of {0} in {W}: position (m) and roll, pitch, yaw (rad).
    pub fn with_base(self, xyz: [f64; 3], rpy: [f64; 3]) -> Campaign {
        let [x, y, z] = xyz;
        let [roll, pitch, yaw] = rpy;
        Campaign { base: [x, y, z, roll, pitch, yaw], base_is_given: true, ..self }
    }

    /// With poses that the calibrated robot is judged by, measured in {W} without deflection, and
    /// what is fitted again on them.
    ///
    /// ```
    /// use rodcal::prelude::*;
    ///
    /// let arm = || Robot::new("arm", vec![Joint::new("one", Motion::Revolute, Hayati::default())]);
    /// let mut measured = Recording::new(1);
    /// measured.add(&[0.5], [0.1, 0.2, 0.3].into())?;
    /// let campaign = Campaign::new(arm(), measured.clone())?;
    /// let judged = campaign.clone().with_validation(measured, Refit::Nothing)?;
    /// assert_eq!(judged.validation.map(|poses| poses.len()), Some(1));
    /// // poses of another robot are refused
    /// assert!(campaign.with_validation(Recording::new(2), Refit::Nothing).is_err());
    /// # Ok::<(), rodcal::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`Campaign::new`].
    pub fn with_validation(self, validation: Recording, refit: Refit) -> Result<Campaign> {
        fits(&self.robot, &validation)?;
        Ok(Campaign { validation: Some(validation), refit, ..self })
    }

    /// With the standard deviation of one measured coordinate, m.
    pub fn with_noise(self, sd: f64) -> Campaign {
        Campaign { noise: Some(sd), ..self }
    }

    /// With parameters that are fixed, free, or known beforehand.
    pub fn with_constraints(self, constraints: ParameterConstraints) -> Campaign {
        Campaign { constraints, ..self }
    }
}

fn fits(robot: &Robot, recording: &Recording) -> Result<()> {
    let wrong = |name, found: String, expected: String| Err(Error::Argument { name, found, expected });
    if recording.joint_count != robot.joints.len() {
        let expected = format!("{}, as the robot has", robot.joints.len());
        return wrong("joint_count", recording.joint_count.to_string(), expected);
    }
    match recording.is_empty() {
        true => wrong("recording", "empty".into(), "at least one pose".into()),
        false => Ok(()),
    }
}

impl Recording {
    /// A recording without a row, for a robot with so many joints.
    ///
    /// ```
    /// use rodcal::prelude::*;
    ///
    /// let clamp = Pose::from_xyz_rpy([0.5, 0.0, 0.1], [0.0, 0.0, std::f64::consts::FRAC_PI_2]);
    /// let mut recording = Recording::new(1);
    /// // 2 mm along x of a clamp whose x is y of {W}
    /// recording.add_in_clamp("1", &clamp, &[0.3], [0.002, 0.0, 0.0].into())?;
    /// let Targets::Points(points) = &recording.targets else { unreachable!() };
    /// assert!((points[0].y - 0.002).abs() < 1e-15 && (points[0].x - 0.5).abs() < 1e-15);
    /// assert_eq!(recording.pose_name(0), "1 of clamp 1");
    /// # Ok::<(), rodcal::Error>(())
    /// ```
    pub fn new(joint_count: usize) -> Recording {
        Recording {
            file: "recording".into(),
            source: None,
            joint_count,
            joint_values: Vec::new(),
            joints_read: None,
            rows: Vec::new(),
            groups: Vec::new(),
            stations: vec![Station::first("")],
            targets: Targets::Points(Vec::new()),
        }
    }

    /// Adds a pose: joint values (rad, or m of a prismatic joint) and where the ball was, in {W},
    /// m. Poses are named by their number.
    ///
    /// # Errors
    /// [`Error::Argument`] for another number of joint values than the recording has, for a value
    /// that is not finite, and for a recording of sockets, whose points are unknown.
    pub fn add(&mut self, joints: &[f64], point: Vector3<f64>) -> Result<()> {
        self.push(GroupName::Tracked, &Pose::IDENTITY, joints, point)
    }

    /// Adds a pose that was measured in a clamp: `device` is the clamp's frame in {W}, `position`
    /// that of the ball in it, m.
    ///
    /// # Errors
    /// As [`Recording::add`]; also for a clamp whose frame was another one before.
    pub fn add_in_clamp(
        &mut self,
        id: &str,
        device: &Pose,
        joints: &[f64],
        position: Vector3<f64>,
    ) -> Result<()> {
        self.push(GroupName::Clamp(id.to_owned()), device, joints, position)
    }

    fn push(&mut self, name: GroupName, device: &Pose, joints: &[f64], position: Vector3<f64>) -> Result<()> {
        let wrong = |argument, found: String, expected: &str| {
            Err(Error::Argument { name: argument, found, expected: expected.to_owned() })
        };
        if joints.len() != self.joint_count {
            let expected = format!("{} joint values", self.joint_count);
            return wrong("joints", format!("{} joint values", joints.len()), &expected);
        }
        let numbers = joints.iter().chain(position.iter()).chain(device.origin.iter());
        if let Some(number) = numbers.chain(device.rotation.iter()).find(|number| !number.is_finite()) {
            return wrong("pose", number.to_string(), "finite numbers");
        }
        let known = self.groups.iter().position(|known| known.name == name);
        if known.is_some_and(|index| self.groups[index].device != *device) {
            return wrong("device", format!("another frame of {name}"), "one frame for each clamp");
        }
        let Targets::Points(points) = &mut self.targets else {
            return wrong("recording", "one of sockets".into(), "one of measured points");
        };
        points.push(device.point(&position));
        let index = known.unwrap_or_else(|| {
            self.groups.push(Group::new(name, *device));
            self.groups.len() - 1
        });
        self.joint_values.extend_from_slice(joints);
        let number = self.rows.len() + 1;
        self.rows.push(Row {
            pose: number.to_string(),
            line: number,
            group: index,
            station: 0,
            time: None,
            temperature: None,
        });
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robot::{Hayati, Joint, Motion};

    #[test]
    fn what_does_not_fit_is_refused_and_leaves_no_row() {
        let mut recording = Recording::new(2);
        let (here, there) = (Pose::IDENTITY, Pose::from_xyz_rpy([1.0, 0.0, 0.0], [0.0; 3]));
        let origin = Vector3::zeros();
        assert!(recording.add(&[0.0], origin).is_err());
        assert!(recording.add(&[0.0, f64::NAN], origin).is_err());
        assert!(recording.add(&[0.0, 0.0], Vector3::new(0.0, f64::INFINITY, 0.0)).is_err());
        recording.add_in_clamp("a", &here, &[0.0, 0.0], origin).unwrap();
        assert!(recording.add_in_clamp("a", &there, &[0.0, 0.0], origin).is_err());
        assert_eq!((recording.len(), recording.groups.len(), recording.joint_values.len()), (1, 1, 2));
        recording.targets = Targets::Sockets(Vec::new());
        assert!(recording.add(&[0.0, 0.0], origin).is_err());
    }

    #[test]
    fn a_campaign_needs_poses_of_its_own_robot() {
        let joint = Joint::new("one", Motion::Revolute, Hayati::default());
        let robot = Robot::new("arm", vec![joint]);
        assert!(Campaign::new(robot.clone(), Recording::new(1)).is_err());
        let mut recording = Recording::new(2);
        recording.add(&[0.0, 0.0], Vector3::zeros()).unwrap();
        assert!(Campaign::new(robot, recording).is_err());
    }
}
