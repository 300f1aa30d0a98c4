//! The scores of one run, kept small until it is the run's turn in the statistics.

use nalgebra::Vector3;

use crate::score::{QUANTITIES, Score};

/// Scores of one filter in one run, in order, without room for what they lack: no filter has every quantity, and no
/// scenario either. A study holds some twenty thousand for each of its filters and threads.
#[derive(Debug, Default)]
pub(crate) struct PackedScores {
    heads: Vec<Head>,
    /// What is present of each score, one after the other, in the order of [`Field`].
    numbers: Vec<f64>,
    /// Scores expected.
    epochs: usize,
}

#[derive(Debug)]
struct Head {
    epoch: usize,
    /// One bit for each field.
    present: u16,
    dimension: u8,
    covariance_broken: bool,
    lost: bool,
}

/// Bits of [`Head::present`]; of several fields alike, that of the first.
enum Field {
    Errors = 0,
    Variances = QUANTITIES as isize,
    TrueAcceleration = 2 * QUANTITIES as isize,
    Nees,
    Nis,
}

impl PackedScores {
    /// Empty; takes room for `epochs` scores when the first one shows what they hold.
    pub(crate) fn new(epochs: usize) -> Self {
        Self {
            epochs,
            ..Self::default()
        }
    }

    /// Adds a score.
    pub(crate) fn push(&mut self, score: &Score) {
        let vectors = || {
            score
                .errors
                .iter()
                .chain(&score.variances)
                .chain([&score.true_acceleration])
        };
        let scalars = [score.nees, score.nis];
        let needed = 3 * vectors().flatten().count() + scalars.iter().flatten().count();
        let left = self.epochs.saturating_sub(self.heads.len()).max(1);
        if self.heads.is_empty() {
            self.heads.reserve_exact(left);
        }
        if self.numbers.capacity() - self.numbers.len() < needed {
            self.numbers.reserve_exact(needed * left);
        }
        let mut present = 0;
        for (field, vector) in vectors().enumerate() {
            if let Some(vector) = vector {
                present |= 1 << field;
                self.numbers.extend_from_slice(vector.as_slice());
            }
        }
        for (field, scalar) in (Field::Nees as usize..).zip(scalars) {
            if let Some(scalar) = scalar {
                present |= 1 << field;
                self.numbers.push(scalar);
            }
        }
        self.heads.push(Head {
            epoch: score.epoch,
            present,
            // At most nine, as the rows of the covariance.
            dimension: score.dimension as u8,
            covariance_broken: score.covariance_broken,
            lost: score.lost,
        });
    }

    /// The scores as they were, in order.
    pub(crate) fn iter(&self) -> impl Iterator<Item = Score> + '_ {
        let mut numbers = self.numbers.iter().copied();
        self.heads.iter().map(move |head| {
            let has = |field: usize| head.present & 1 << field != 0;
            let mut next = |field: usize| if has(field) { numbers.next() } else { None };
            let mut vector = |field: usize| Some(Vector3::new(next(field)?, next(field)?, next(field)?));
            Score {
                epoch: head.epoch,
                errors: std::array::from_fn(|i| vector(Field::Errors as usize + i)),
                variances: std::array::from_fn(|i| vector(Field::Variances as usize + i)),
                true_acceleration: vector(Field::TrueAcceleration as usize),
                nees: next(Field::Nees as usize),
                nis: next(Field::Nis as usize),
                dimension: head.dimension.into(),
                covariance_broken: head.covariance_broken,
                lost: head.lost,
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Thousands of combinations of fields, each number a different one.
    #[test]
    fn scores_come_out_as_they_went_in() {
        let mut numbers = (1..).map(|n| f64::from(n) / 7.0);
        let mut vector = |there: bool| {
            let v = Vector3::from_fn(|_, _| numbers.next().unwrap());
            there.then_some(v)
        };
        let scores: Vec<Score> = (0..1_usize << 15)
            .step_by(11)
            .map(|fields| {
                let has = |bit: usize| fields >> bit & 1 == 1;
                Score {
                    epoch: 3 * fields,
                    errors: std::array::from_fn(|i| vector(has(i))),
                    variances: std::array::from_fn(|i| vector(has(6 + i))),
                    true_acceleration: vector(has(12)),
                    nees: vector(has(13)).map(|v| v.x),
                    nis: vector(has(14)).map(|v| v.y),
                    dimension: fields % 10,
                    covariance_broken: fields % 3 == 0,
                    lost: fields % 5 == 0,
                }
            })
            .collect();
        // Fewer are expected than come.
        let mut packed = PackedScores::new(100);
        scores.iter().for_each(|score| packed.push(score));
        assert!(packed.iter().eq(scores));
    }

    #[test]
    fn room_is_taken_for_what_is_there() {
        let score = Score {
            epoch: 0,
            errors: [Some(Vector3::zeros()), None, None, None, None, None],
            variances: [None; QUANTITIES],
            true_acceleration: None,
            nees: Some(1.0),
            dimension: 6,
            covariance_broken: false,
            nis: None,
            lost: false,
        };
        let mut packed = PackedScores::new(1000);
        (0..1000).for_each(|_| packed.push(&score));
        assert_eq!((packed.numbers.capacity(), packed.heads.capacity()), (4000, 1000));
    }
}
