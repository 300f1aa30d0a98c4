//! Points that fill a box evenly, however many are taken: the Halton sequence, shifted at random.

use numerics::streams::{Source, stream};
use rand::RngExt;

/// The points of one search, in the order they are tried.
#[derive(Debug, Clone)]
pub(super) struct Design {
    /// One base and one shift for each coordinate.
    axes: Vec<(u64, f64)>,
    taken: u64,
}

impl Design {
    /// * `seed`: selects the shift; designs of one seed share the shift of each coordinate.
    pub(super) fn new(dimension: usize, seed: u64) -> Self {
        let mut generator = stream(seed, 0, Source::Search);
        Self {
            axes: primes()
                .take(dimension)
                .map(|base| (base, generator.random()))
                .collect(),
            taken: 0,
        }
    }

    /// The next point of the unit cube.
    pub(super) fn next(&mut self) -> Vec<f64> {
        self.taken += 1;
        let coordinate = |&(base, shift): &(u64, f64)| (radical_inverse(self.taken, base) + shift).fract();
        self.axes.iter().map(coordinate).collect()
    }
}

/// The digits of `index` in this base, mirrored at the point.
fn radical_inverse(mut index: u64, base: u64) -> f64 {
    let (mut value, mut weight) = (0.0, 1.0);
    while index > 0 {
        weight /= base as f64;
        value += weight * (index % base) as f64;
        index /= base;
    }
    value
}

fn primes() -> impl Iterator<Item = u64> {
    (2..).filter(|n| (2..).take_while(|d| d * d <= *n).all(|d| n % d != 0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_mirrored() {
        // 6 = 110 in base 2, 5 = 12 in base 3.
        assert!((radical_inverse(6, 2) - 0.375).abs() < 1e-15);
        assert!((radical_inverse(5, 3) - (2.0 / 3.0 + 1.0 / 9.0)).abs() < 1e-15);
        assert_eq!(primes().take(6).collect::<Vec<_>>(), [2, 3, 5, 7, 11, 13]);
    }

    /// 24 points miss no interval of length 1/8 on either axis and each quadrant gets 3 to 9 of them, whatever the shift.
    #[test]
    fn the_box_is_filled_evenly() {
        for seed in 0..50 {
            let mut design = Design::new(2, seed);
            let points: Vec<_> = (0..24).map(|_| design.next()).collect();
            for axis in 0..2 {
                let mut along: Vec<f64> = points.iter().map(|p| p[axis]).collect();
                along.sort_by(f64::total_cmp);
                assert!(along[0] < 0.125 && along[23] > 0.875, "seed {seed}");
                assert!(along.windows(2).all(|w| w[1] - w[0] < 0.125), "seed {seed}");
            }
            let mut quadrants = [0; 4];
            for p in &points {
                quadrants[usize::from(p[0] < 0.5) + 2 * usize::from(p[1] < 0.5)] += 1;
            }
            assert!(
                quadrants.iter().all(|n| (3..=9).contains(n)),
                "seed {seed}: {quadrants:?}"
            );
        }
    }
}
