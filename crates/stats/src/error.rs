//! What can go wrong in a statistic.

use thiserror::Error;

/// Why a statistic could not be formed.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum StatsError {
    /// An epoch beyond those the accumulator was made for.
    #[error("epoch {epoch} is outside the ensemble, which has {epochs} epochs (0 to {})", epochs.saturating_sub(1))]
    EpochOutOfRange {
        /// Index asked for.
        epoch: usize,
        /// Number of epochs of the accumulator.
        epochs: usize,
    },
    /// A NaN or an infinity, which would spoil the sums of every other run.
    #[error("{what} at epoch {epoch} is {value}; only finite values can enter an ensemble")]
    NotFinite {
        /// Which quantity.
        what: &'static str,
        /// Epoch index.
        epoch: usize,
        /// The value given.
        value: f64,
    },
    /// NEES of no states, or of more states than the covariance has.
    #[error("a NEES over {dimension} states was asked for; the covariance has 9, so give 1 to 9")]
    Dimension {
        /// Number of states asked for.
        dimension: usize,
    },
    /// A covariance whose leading block is not symmetric.
    #[error(
        "covariance element ({row},{column}) differs from its mirror image by {difference:e}; give a symmetric matrix"
    )]
    NotSymmetric {
        /// Row, from 1.
        row: usize,
        /// Column, from 1.
        column: usize,
        /// The element minus its mirror image.
        difference: f64,
    },
    /// A covariance whose leading block has no Cholesky factor.
    #[error("the leading {dimension} x {dimension} block of the covariance is not positive definite")]
    NotPositiveDefinite {
        /// Number of leading rows.
        dimension: usize,
    },
    /// Degrees of freedom or a probability for which no chi-square bound exists.
    #[error(
        "no chi-square bounds for {runs} runs of {dimension} degrees of freedom at confidence {confidence}; runs and degrees must be positive, the confidence between 0 and 1"
    )]
    Bounds {
        /// Runs averaged over.
        runs: usize,
        /// Degrees of freedom of one run.
        dimension: usize,
        /// Two-sided probability asked for.
        confidence: f64,
    },
    /// Two series that should hold one value for each shared run.
    #[error("paired series have {left} and {right} runs; compare the same runs of both")]
    Unpaired {
        /// Length of the first series.
        left: usize,
        /// Length of the second series.
        right: usize,
    },
}
