//! What the laws of a robot's file do to it.

use nalgebra::{Matrix3, Vector3};

use super::{LawPlace, Robot, RobotLaw};
use crate::spatial::exponential;

impl Robot {
    /// What the laws of a joint add to its value at the joint values `q` under the torques
    /// `torque`, rad or m; those that follow the move before are in the values already.
    pub(super) fn law_turn(&self, joint: usize, q: &[f64], torque: &[f64]) -> f64 {
        let own = self.laws_at(LawPlace::Joint(joint)).filter(|law| !law.is_sided());
        own.map(|law| law.turn(q, torque, 1.0)).sum()
    }

    /// How far the axis of a joint is off, in the frame that carries it, m; `None` where no law
    /// says so.
    pub(super) fn axis_shift(&self, joint: usize, q: &[f64]) -> Option<Vector3<f64>> {
        self.shift(LawPlace::Axis(joint), q, &[])
    }

    /// How the link that a joint moves is turned, about its own axes; `None` where no law says so.
    pub(super) fn link_turn(&self, joint: usize, q: &[f64]) -> Option<Matrix3<f64>> {
        let turn = self.shift(LawPlace::Link(joint), q, &[])?;
        (turn != Vector3::zeros()).then(|| exponential(&turn))
    }

    /// How far the tip is off in {T}, where `weight` (in g) is along its axes, m; `None` where no
    /// law says so.
    pub(super) fn tool_shift(&self, q: &[f64], weight: &Vector3<f64>) -> Option<Vector3<f64>> {
        self.shift(LawPlace::Tool, q, weight.as_slice())
    }

    #[inline]
    fn shift(&self, place: LawPlace, q: &[f64], weight: &[f64]) -> Option<Vector3<f64>> {
        // most robots have none, and kinematics do little else
        if self.laws.is_empty() {
            return None;
        }
        let own = self.laws_at(place).map(|law| Vector3::from(law.along(q, &[], weight, 1.0)));
        own.reduce(|sum, more| sum + more)
    }

    fn laws_at(&self, place: LawPlace) -> impl Iterator<Item = &RobotLaw> {
        self.laws.iter().filter(move |law| law.place == place)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robot::{Effect, Hayati, Joint, JointLawVariable, Motion, Tip};
    use crate::rod::LawConstant;

    fn arm(gravity: [f64; 3]) -> Robot {
        let link = |a: f64, alpha: f64| Hayati { a, alpha, ..Hayati::default() };
        let joints = [("one", link(0.4, 0.7)), ("two", link(0.3, 0.0))];
        let mut arm =
            Robot::new("arm", joints.map(|(name, link)| Joint::new(name, Motion::Revolute, link)).to_vec());
        arm.gravity = gravity.into();
        arm
    }

    fn with(law: (LawPlace, Option<usize>, JointLawVariable), formulas: &[&str]) -> Robot {
        let mut arm = arm([0.0, 0.0, -9.80665]);
        let formulas = formulas.iter().map(|&formula| formula.to_owned()).collect();
        arm.laws = vec![RobotLaw::new(law.0, law.1, law.2, formulas, Vec::new(), (-180.0, 180.0)).unwrap()];
        arm
    }

    const TOOL: Vector3<f64> = Vector3::new(0.05, 0.1, 0.2);
    const Q: [f64; 2] = [0.3, -0.8];

    fn tip(arm: &Robot) -> Vector3<f64> {
        arm.tip_at(TOOL, &Q).0
    }

    /// What another key of the file does too, a formula does as well.
    #[test]
    fn a_law_of_a_joint_is_what_a_coupling_is() {
        let law = with((LawPlace::Joint(0), None, JointLawVariable::Angle(1)), &["300*q*pi/180"]);
        let mut coupled = arm([0.0, 0.0, -9.80665]);
        coupled.effects = vec![Effect::Coupling { from: 1, joint: 0, fraction: 300e-6 }];
        assert!((tip(&law) - tip(&coupled)).norm() < 1e-15);
        assert!((law.flange_at(&Q).point(&TOOL) - tip(&coupled)).norm() < 1e-15);
        // a product of two angles
        let product = with((LawPlace::Joint(0), Some(0), JointLawVariable::Angle(1)), &["300*q*pi/180"]);
        let mut turned = Q;
        turned[0] += 300e-6 * Q[0] * Q[1];
        assert!((tip(&product) - arm([0.0; 3]).tip_at(TOOL, &turned).0).norm() < 1e-15);
    }

    /// What a law of two constants adds is known as well as their covariance says.
    #[test]
    fn the_uncertainty_of_a_law_is_that_of_its_constants() {
        let constant = |name: &str, u: f64, correlation: Vec<f64>| LawConstant {
            name: name.into(),
            value: 3.0,
            standard_uncertainty: u,
            correlation,
            unit: String::new(),
        };
        let constants = vec![constant("a", 2.0, vec![]), constant("b", 30.0, vec![-0.8])];
        let formulas = vec!["a*q + b".to_owned()];
        let variable = JointLawVariable::Angle(1);
        let law = RobotLaw::new(LawPlace::Joint(0), None, variable, formulas, constants, (-90.0, 90.0));
        let mut known = arm([0.0; 3]);
        known.laws = vec![law.unwrap()];
        let moved = |turn: f64| {
            let q = [Q[0] + turn, Q[1]];
            arm([0.0; 3]).tip_at(TOOL, &q).0
        };
        let per_urad = (moved(1e-6) - moved(-1e-6)) / 2.0;
        let q = Q[1].to_degrees();
        let variance = 4.0 * q * q + 900.0 - 2.0 * 0.8 * 2.0 * 30.0 * q;
        let predicted = known.predicted_at(TOOL, &Q);
        let found = &predicted.law_slopes * known.law_covariance() * predicted.law_slopes.transpose();
        let expected = per_urad.component_mul(&per_urad) * variance;
        assert!((found.diagonal() - expected).amax() < 1e-4 * expected.amax(), "{found} {expected}");
        // beside the error of poses that were held out
        known.tip = Some(Tip { at: TOOL, sd: Some(1e-5) });
        let sd = known.tip_at(TOOL, &Q).1.unwrap();
        assert!((sd.y.powi(2) - 1e-10 - expected.y).abs() < 1e-4 * expected.amax(), "{sd} {expected}");
    }

    /// A link that turns about its x is one with another twist α.
    #[test]
    fn a_law_of_a_link_is_its_twist() {
        let law = with((LawPlace::Link(0), None, JointLawVariable::Angle(1)), &["500*q*pi/180", "0", "0"]);
        let mut twisted = arm([0.0; 3]);
        twisted.joints[0].link.alpha += 500e-6 * Q[1];
        assert!((tip(&law) - tip(&twisted)).norm() < 1e-15);
        assert!((law.flange_at(&Q).point(&TOOL) - tip(&twisted)).norm() < 1e-15);
    }

    /// An axis that goes along the x of the link before is one of a longer link.
    #[test]
    fn a_law_of_an_axis_moves_all_beyond_it() {
        let law = with((LawPlace::Axis(1), None, JointLawVariable::Angle(1)), &["100", "0", "0"]);
        let mut longer = arm([0.0; 3]);
        longer.joints[0].link.a += 100e-6;
        assert!((tip(&law) - tip(&longer)).norm() < 1e-15);
        assert!((law.flange_at(&Q).point(&TOOL) - tip(&longer)).norm() < 1e-15);
    }

    /// Gravity along the −y of {0}; the second axis is tilted by α about the first link's x.
    #[test]
    fn a_law_of_the_tool_follows_the_weight() {
        let mut law = with((LawPlace::Tool, None, JointLawVariable::Weight(2)), &["0", "0", "200*sign(g)"]);
        law.gravity = [0.0, -9.80665, 0.0].into();
        let flange = law.flange_at(&Q);
        let along = -flange.rotation.column(2).y;
        let expected = flange.point(&(TOOL + Vector3::z() * (200e-6 * along.signum())));
        assert!(along.abs() > 0.1 && (tip(&law) - expected).norm() < 1e-15);
    }

    #[test]
    fn a_law_of_the_way_a_joint_came_is_in_its_values() {
        let arm = with((LawPlace::Joint(1), None, JointLawVariable::Angle(1)), &["side*(50 + q)"]);
        assert!(arm.has_moves());
        let turned = arm.after_moves(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.5]);
        let expected = [1.0, 0.5].map(|q: f64| 1e-6 * (50.0 + q.to_degrees()));
        assert!((turned[3] - 1.0 - expected[0]).abs() < 1e-15 && turned[1] == 0.0, "{turned:?}");
        assert!((turned[5] - 0.5 + expected[1]).abs() < 1e-15, "{turned:?}");
        // and nowhere else
        assert_eq!(arm.correction(1, &Q, &[]), 0.0);
    }
}
