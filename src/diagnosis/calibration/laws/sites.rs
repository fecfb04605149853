//! Where on a robot a law may act that nobody has listed, and what it may be a function of.
//!
//! | place | what the law changes | functions of |
//! |---|---|---|
//! | joint | its angle | own angle, that of another joint, sum or difference of neighbours, torque, time, temperature, order |
//! | joint | its angle, per radian of one joint | angle of another: a product |
//! | joint | displacement of its axis in the link before | own angle |
//! | link | its turn about its axes, per radian of one joint | angle of another: a product |
//! | tool | displacement in {T} | weight along each axis of {T}, time, temperature, order |
//! | base | displacement in {W} | position along each axis of {W}, time, temperature, order |

use nalgebra::Vector3;

use super::super::model::{Configuration, Context};
use super::measures::{changes, location, variable};
use crate::inference::Location;
use crate::inference::Part;
use crate::inference::law::{Course, Form, Instant, Measure, Site};
use crate::robot::{JointLawVariable, LawPlace, Motion};
use crate::units::{MM, STANDARD_GRAVITY, UM};

/// Of what gives way under a load.
const OF_A_LOAD: &[Form] = Form::GIVING_WAY;
/// From the first pose on: time, order.
const OF_TIME: &[Form] = Form::SINCE_A_START;
/// From anywhere on: temperature, positions, angles, whose zero is where the encoder has it. Waves
/// over an angle are the library's (`transmission_error`, `wrist_coupling`).
const OF_A_LEVEL: &[Form] = Form::FROM_ANYWHERE;
/// A magnet or a spring beside the base may pull at it by its distance.
const OF_A_POSITION: &[Form] = Form::OF_A_POSITION;
/// Where an axis goes as its joint turns.
const OF_A_BEARING: &[Form] = &[Form::Harmonic];
/// One factor of a product: the other one's place says it.
const OF_A_PRODUCT: &[Form] = &[Form::Polynomial(1), Form::Polynomial(2)];
/// Torques below which a joint is not loaded, N·m.
const LEAST_TORQUE: f64 = 0.1;
const AXES: [&str; 3] = ["x", "y", "z"];

/// All places; `data` is how many data there are, rows × (x, y, z) first.
pub fn sites(context: &Context, data: usize) -> Vec<Site> {
    let robot = Robot { context, data };
    let count = context.joint_count();
    let clocks = robot.clocks();
    let mut sites = Vec::new();
    for joint in 0..count {
        sites.extend(robot.of_itself(joint));
        sites.extend(robot.of_others(joint));
        sites.extend(robot.of_products(joint));
        let turn = robot.of_joint(joint, robot.angle(joint), &|there| there.joints[joint], OF_TIME);
        sites.extend(clocks.iter().map(|clock| clock.over(&turn)));
    }
    sites.extend(robot.of_tool(&clocks));
    sites.extend(robot.of_base(&clocks));
    // what is not known is no variable
    sites.retain(|site| site.concerned().next().is_some());
    sites
}

fn measure(symbol: &'static str, name: impl Into<String>, unit: &'static str, si: f64) -> Measure {
    Measure { symbol, name: name.into(), unit, si }
}

/// What all poses have in common.
struct Clock {
    variable: Measure,
    values: Vec<f64>,
    forms: &'static [Form],
    courses: Vec<Course>,
}

impl Clock {
    /// A place's law over it.
    fn over(&self, site: &Site) -> Site {
        Site {
            variable: self.variable.clone(),
            values: self.values.clone(),
            courses: self.courses.clone(),
            forms: self.forms,
            ..site.clone()
        }
    }
}

struct Robot<'a> {
    context: &'a Context<'a>,
    data: usize,
}

impl Robot<'_> {
    /// A number of each row as one of its data; NaN for what is known besides.
    fn values(&self, value: &dyn Fn(&Configuration) -> f64) -> Vec<f64> {
        self.by_row(&|row| value(&self.context.configurations[row]))
    }

    fn by_row(&self, value: &dyn Fn(usize) -> f64) -> Vec<f64> {
        let of_rows = (0..self.context.configurations.len()).flat_map(|row| [value(row); 3]);
        let mut values: Vec<f64> = of_rows.collect();
        values.resize(self.data, f64::NAN);
        values
    }

    /// A displacement of the tip in {W} at each row, as the data count it.
    fn weights(&self, displacement: &dyn Fn(&Configuration) -> Vector3<f64>) -> Vec<f64> {
        let rows = self.context.configurations.iter().enumerate();
        let of_row = |(row, there): (usize, &Configuration)| -> [f64; 3] {
            self.context.counted(row, &displacement(there)).into()
        };
        let mut weights: Vec<f64> = rows.flat_map(of_row).collect();
        weights.resize(self.data, 0.0);
        weights
    }

    /// Of its own angle and torque.
    fn of_itself(&self, joint: usize) -> Vec<Site> {
        let context = self.context;
        let own = |there: &Configuration| there.joints[joint];
        let turn = self.of_joint(joint, self.angle(joint), &own, OF_A_LEVEL);
        // a bearing moves the axis in the frame that carries it
        let carried = |there: &Configuration, k: usize| {
            let carrier = if joint == 0 { there.base } else { there.link[joint - 1] };
            carrier.rotation.column(k).into_owned()
        };
        let wobble = Site {
            result: changes(LawPlace::Axis(joint), None, &context.motions),
            directions: self.directions(&carried),
            forms: OF_A_BEARING,
            ..turn.clone()
        };
        let mut sites = vec![Site { moves: self.moves(joint), ..turn }, wobble];
        if context.has_masses && context.largest(|there| there.torque[joint]) > LEAST_TORQUE {
            let torque = variable(JointLawVariable::Torque(joint));
            let site = self.of_joint(joint, torque, &|there| there.torque[joint], OF_A_LOAD);
            sites.push(Site { moves: self.moves(joint), ..site });
        }
        sites
    }

    /// Of the angle of another joint, of the sum and the difference of two neighbours.
    fn of_others(&self, joint: usize) -> Vec<Site> {
        let count = self.context.joint_count();
        let mut sites = Vec::new();
        for other in (0..count).filter(|&other| other != joint) {
            let angle = self.angle(other);
            sites.push(self.of_joint(joint, angle, &|there| there.joints[other], OF_A_LEVEL));
        }
        for first in 0..count.saturating_sub(1) {
            for (sign, own) in
                [(1.0, JointLawVariable::Sum(first)), (-1.0, JointLawVariable::Difference(first))]
            {
                let both = |there: &Configuration| there.joints[first] + sign * there.joints[first + 1];
                sites.push(self.of_joint(joint, variable(own), &both, OF_A_LEVEL));
            }
        }
        sites
    }

    /// Of products of two angles: of the joint itself, and of the link that it moves.
    fn of_products(&self, joint: usize) -> Vec<Site> {
        let count = self.context.joint_count();
        let mut sites = Vec::new();
        for first in 0..count {
            for second in first + 1..count {
                let times = |there: &Configuration| there.joints[first];
                let of_second = self.angle(second);
                let turn = self.of_joint(joint, of_second, &|there| there.joints[second], OF_A_PRODUCT);
                let weights = self.weights(&|there| there.tip_jacobian[joint] * times(there));
                sites.push(Site {
                    result: changes(LawPlace::Joint(joint), Some(first), &self.context.motions),
                    directions: vec![(String::new(), weights)],
                    ..turn.clone()
                });
                // what is beyond a link moves with its twist
                if second > joint && joint + 1 < count {
                    let twist = |there: &Configuration, k: usize| {
                        let about = there.link[joint].rotation.column(k).into_owned();
                        about.cross(&(there.tip - there.link[joint].origin)) * times(there)
                    };
                    sites.push(Site {
                        location: location(LawPlace::Link(joint)),
                        result: changes(LawPlace::Link(joint), Some(first), &self.context.motions),
                        directions: self.directions(&twist),
                        ..turn
                    });
                }
            }
        }
        sites
    }

    /// Displacements in {T}.
    fn of_tool(&self, clocks: &[Clock]) -> Vec<Site> {
        let axis = |there: &Configuration, k: usize| there.flange.rotation.column(k).into_owned();
        let changed = changes(LawPlace::Tool, None, &self.context.motions);
        let site = self.of_frame(Part::Tool, changed, &axis);
        let weight = |k: usize| {
            let along = move |there: &Configuration| {
                there.flange.rotation.column(k).dot(&there.gravity) / STANDARD_GRAVITY
            };
            let variable = variable(JointLawVariable::Weight(k));
            Site { variable, values: self.values(&along), forms: OF_A_LOAD, ..site.clone() }
        };
        (0..3).map(weight).chain(clocks.iter().map(|clock| clock.over(&site))).collect()
    }

    /// Displacements in {W}.
    fn of_base(&self, clocks: &[Clock]) -> Vec<Site> {
        let changed = measure("Δx", "displacement of the base", "µm", UM);
        let site = self.of_frame(Part::Base, changed, &|_, k| Vector3::ith(k, 1.0));
        let position = |k: usize| {
            let variable = measure("x", format!("position along {}", AXES[k]), "mm", MM);
            Site {
                variable,
                values: self.values(&|there| there.tip[k]),
                forms: OF_A_POSITION,
                ..site.clone()
            }
        };
        // where a ball is beside the middle of its socket is the scatter itself
        let axes = 0..if self.context.has_sockets() { 0 } else { 3 };
        axes.map(position).chain(clocks.iter().map(|clock| clock.over(&site))).collect()
    }

    /// A displacement along three axes, its variable yet to be named.
    fn of_frame(
        &self,
        part: Part,
        result: Measure,
        axis: &dyn Fn(&Configuration, usize) -> Vector3<f64>,
    ) -> Site {
        Site {
            location: Location::Part(part),
            result,
            variable: measure("", "", "", 1.0),
            directions: self.directions(axis),
            values: Vec::new(),
            recorded: None,
            moves: Vec::new(),
            courses: Vec::new(),
            forms: OF_A_LEVEL,
            rare: &[],
        }
    }

    fn directions(&self, axis: &dyn Fn(&Configuration, usize) -> Vector3<f64>) -> Vec<(String, Vec<f64>)> {
        let along = |k: usize| self.weights(&|there: &Configuration| axis(there, k));
        (0..3).map(|k| (AXES[k].to_owned(), along(k))).collect()
    }

    fn angle(&self, joint: usize) -> Measure {
        variable(match self.context.motions[joint] {
            Motion::Revolute => JointLawVariable::Angle(joint),
            Motion::Prismatic => JointLawVariable::Position(joint),
        })
    }

    fn of_joint(
        &self,
        joint: usize,
        variable: Measure,
        value: &dyn Fn(&Configuration) -> f64,
        forms: &'static [Form],
    ) -> Site {
        Site {
            location: location(LawPlace::Joint(joint)),
            result: changes(LawPlace::Joint(joint), None, &self.context.motions),
            variable,
            directions: vec![(String::new(), self.weights(&|there| there.tip_jacobian[joint]))],
            values: self.values(value),
            recorded: None,
            moves: Vec::new(),
            courses: Vec::new(),
            forms,
            rare: &[],
        }
    }

    /// The way that a joint came from.
    fn moves(&self, joint: usize) -> Vec<f64> {
        let mut moves = self.values(&|there| there.approach[joint]);
        moves.iter_mut().filter(|way| way.is_nan()).for_each(|way| *way = 0.0);
        moves
    }

    /// Order, time and temperature, as far as the recording has them, from their least values on.
    fn clocks(&self) -> Vec<Clock> {
        let rows = &self.context.recording.rows;
        let all = |number: &dyn Fn(usize) -> Option<f64>| -> Option<Vec<f64>> {
            let values: Vec<f64> = (0..rows.len()).map(number).collect::<Option<_>>()?;
            let least = values.iter().copied().fold(f64::INFINITY, f64::min);
            Some(values.into_iter().map(|value| value - least).collect())
        };
        let clock = |variable, values: &[f64], forms| Clock {
            variable,
            values: self.by_row(&|row| values[row]),
            forms,
            courses: Vec::new(),
        };
        let time = all(&|row| rows[row].time);
        let order = all(&|row| Some(row as f64));
        let temperatures = self.context.recording.temperatures();
        let temperature = all(&|row| Some(temperatures.as_ref()?[row]));
        let of_order = order.map(|n| clock(measure("n", "number of poses before", "", 1.0), &n, OF_TIME));
        let of_time = time.as_ref().map(|t| clock(measure("t", "time", "s", 1.0), t, OF_TIME));
        let of_temperature = temperature.map(|values| {
            let lagged = time.as_ref().map(|times| Course {
                instants: (0..rows.len())
                    .map(|row| {
                        let elapsed = if row == 0 { 0.0 } else { times[row] - times[row - 1] };
                        Instant { data: vec![3 * row, 3 * row + 1, 3 * row + 2], elapsed, sense: 1.0 }
                    })
                    .collect(),
                start: values.first().copied().unwrap_or_default(),
            });
            let name = "temperature above the lowest";
            Clock {
                courses: lagged.into_iter().collect(),
                ..clock(measure("T", name, "K", 1.0), &values, OF_A_LEVEL)
            }
        });
        of_order.into_iter().chain(of_time).chain(of_temperature).collect()
    }
}
