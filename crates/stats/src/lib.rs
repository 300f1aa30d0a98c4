//! Statistics of a Monte Carlo study of estimators: errors over the ensemble of runs, filter consistency, paired comparison.
//!
//! Everything here is a pure function or an accumulator that is fed run by run; sums are taken in the order of the
//! calls, so equal calls give equal bytes. Nothing here knows about frames, files, FMI or threads.
//!
//! Start reading at [`Ensemble`] (Eqs. (31)-(33) of Mamich and Zanetti), then [`nees`] and [`ScalarEnsemble`].

mod bootstrap;
mod chi_square;
mod consistency;
mod ensemble;
mod error;
mod histogram;
mod median;
mod paired;
mod scalar;
mod sign_flip;
mod spread;

pub use bootstrap::{RESAMPLES, Resamples, Sum, pooled_mean};
pub use chi_square::ChiSquareEnsemble;
pub use consistency::{Bounds, mean_chi_square_bounds, nees};
pub use ensemble::{Ensemble, EpochMoments, LEAST_RUNS, mean_error_in_sigmas, mean_error_in_sigmas_about_zero};
pub use error::StatsError;
pub use histogram::LogHistogram;
pub use median::median;
pub use paired::{PairedDifference, paired_difference};
pub use scalar::ScalarEnsemble;
pub use sign_flip::{FLIPS, SignFlips};
pub use spread::{rmse_standard_error, standard_error};
