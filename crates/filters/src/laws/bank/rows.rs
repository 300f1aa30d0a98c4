//! The measured rows of a sample, one behind the other.

use crate::laws::Step;
use crate::state::{MAX_ROWS, RowVector};
use nalgebra::RowVector6;

/// One measured row, internal units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::laws) struct Row {
    /// Its place in the layout.
    pub place: usize,
    /// Partials by relative position and velocity.
    pub h: RowVector6<f64>,
    /// Measured minus predicted at the centre.
    pub innovation: f64,
    /// Noise variance, with what errors of the chaser add to it where the row hangs on those, too.
    pub r: f64,
}

/// Every measured row of a sample. R is diagonal, so they can be taken one after the other: the innovation covariance of each is
/// a number, and the product of their likelihoods is that of all.
#[derive(Clone, Copy, Debug)]
pub(in crate::laws) struct Seen {
    rows: [Row; MAX_ROWS],
    count: usize,
}

impl Seen {
    /// * `r`: noise variances in the places of the layout, internal units.
    pub(in crate::laws) fn new(step: &Step, r: &RowVector) -> Self {
        let nothing = Row {
            place: 0,
            h: RowVector6::zeros(),
            innovation: 0.0,
            r: 1.0,
        };
        let mut seen = Self {
            rows: [nothing; MAX_ROWS],
            count: 0,
        };
        for place in (0..MAX_ROWS).filter(|place| step.measured.has(*place)) {
            let h: RowVector6<f64> = step.h.fixed_view::<1, 6>(place, 0).into_owned();
            let of_target = (h * step.p_prior.fixed_view::<6, 6>(0, 0) * h.transpose())[0];
            seen.rows[seen.count] = Row {
                place,
                h,
                innovation: step.innovation[place],
                r: (step.s[(place, place)] - of_target).max(r[place]),
            };
            seen.count += 1;
        }
        seen
    }

    /// These rows.
    #[cfg(test)]
    pub(super) fn of(rows: &[Row]) -> Self {
        let mut seen = Self::new(
            &Step::blank(1.0, crate::state::TargetMatrix::zeros()),
            &RowVector::zeros(),
        );
        seen.rows[..rows.len()].copy_from_slice(rows);
        seen.count = rows.len();
        seen
    }

    /// The rows in their order.
    pub(in crate::laws) fn iter(&self) -> impl Iterator<Item = &Row> {
        self.rows[..self.count].iter()
    }
}
