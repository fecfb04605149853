//! Why a search stopped, in words that do not promise more than was found.

/// Why a search stopped. Only the first three mean that a stationary point was reached.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum TerminationReason {
    /// The residual vector is orthogonal to the tangent plane within the gradient tolerance, and
    /// the next Gauss–Newton step is below the step tolerance.
    GradientAndStep,
    /// The residual vector is orthogonal to the tangent plane within the gradient tolerance; the
    /// next Gauss–Newton step is not below the step tolerance, as happens where the problem is
    /// badly conditioned.
    Gradient,
    /// What the parameters could still take from the residuals is no more than the rounding of the
    /// parameters and of the residuals makes of them: nothing better can be distinguished in double
    /// precision.
    Rounding,
    /// No step made the sum of squares smaller, though the gradient is not zero: the Jacobian does
    /// not belong to the residuals, or they are not smooth.
    NoProgress,
    /// No free parameter changes any residual here.
    NoInfluence,
    /// A parameter that changed the residuals at the start ran to where it no longer does: the sum
    /// of squares has no minimum there, it only levels out.
    InfluenceLost,
    /// The limit of iterations was reached first.
    MaxIterations,
    /// The robust weights were still changing after their last pass.
    WeightsUnsettled,
    /// A residual at the start is NaN or infinite.
    NonFiniteStart,
    /// A residual is finite, but one of its derivatives is not.
    NonFiniteJacobian,
}

impl TerminationReason {
    /// True where a stationary point of the sum of squares was reached.
    pub fn is_converged(self) -> bool {
        matches!(self, Self::GradientAndStep | Self::Gradient | Self::Rounding)
    }
}

impl std::fmt::Display for TerminationReason {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::GradientAndStep => "converged: the gradient is zero and the parameters no longer change",
            Self::Gradient => "converged: the gradient is zero",
            Self::Rounding => "converged: the gradient is zero within the rounding of the numbers",
            Self::NoProgress => {
                "not converged: no step makes the residuals smaller, yet the gradient is not zero"
            }
            Self::NoInfluence => "not converged: no free parameter changes the residuals here",
            Self::InfluenceLost => {
                "not converged: a parameter ran to where it no longer changes the residuals"
            }
            Self::MaxIterations => "not converged: the limit of iterations was reached",
            Self::WeightsUnsettled => "not converged: the robust weights did not settle",
            Self::NonFiniteStart => "not converged: the residuals at the start are not finite",
            Self::NonFiniteJacobian => "not converged: a derivative of the residuals is not finite",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_words_agree_with_the_verdict() {
        for reason in [
            TerminationReason::GradientAndStep,
            TerminationReason::Gradient,
            TerminationReason::Rounding,
            TerminationReason::NoProgress,
            TerminationReason::NoInfluence,
            TerminationReason::InfluenceLost,
            TerminationReason::MaxIterations,
            TerminationReason::WeightsUnsettled,
            TerminationReason::NonFiniteStart,
            TerminationReason::NonFiniteJacobian,
        ] {
            assert_eq!(reason.to_string().starts_with("converged:"), reason.is_converged());
        }
    }
}
