//! Quantiles of a long stream of positive numbers in fixed memory.

/// Bits of the mantissa that tell bins apart: bins are 2^-12 = 0.024 % wide.
const MANTISSA_BITS: u32 = 12;
/// Bins of a factor of two.
const OCTAVE: usize = 1 << MANTISSA_BITS;
/// Smallest and largest magnitude told apart: 2^-40 and 2^60.
const EXPONENTS: std::ops::Range<i32> = -40..60;

/// Counts of positive numbers in bins of equal relative width.
///
/// Its memory (16 KiB for each factor of two that values lie in, at most 1.6 MB) does not depend on how many values come, and
/// its contents not on their order. Values are placed to 0.024 %; smaller than 2^-40 (zero included) falls into the first bin,
/// larger than 2^60 into the last.
#[derive(Debug, Clone, Default)]
pub struct LogHistogram {
    /// By factor of two from the smallest; empty where no value lies.
    octaves: Vec<Vec<u32>>,
    total: u64,
}

impl LogHistogram {
    /// Counts one value; a negative value or NaN goes into the first bin.
    pub fn add(&mut self, value: f64) {
        let bin = bin(value);
        let (octave, place) = (bin >> MANTISSA_BITS, bin & (OCTAVE - 1));
        if self.octaves.len() <= octave {
            self.octaves.resize_with(octave + 1, Vec::new);
        }
        let counts = &mut self.octaves[octave];
        if counts.is_empty() {
            counts.resize(OCTAVE, 0);
        }
        counts[place] += 1;
        self.total += 1;
    }

    /// Number of values counted.
    pub fn total(&self) -> u64 {
        self.total
    }

    /// Value below which half of the counted values lie, to 0.024 %; `None` when there are none.
    pub fn median(&self) -> Option<f64> {
        self.quantile(0.5)
    }

    /// Value below which this share of the counted values lies, to 0.024 %; `None` when there are none.
    ///
    /// * `share`: 0 to 1.
    pub fn quantile(&self, share: f64) -> Option<f64> {
        let wanted = share * self.total as f64;
        let mut below = 0.0;
        let octaves = self.octaves.iter().enumerate();
        let bins = octaves.flat_map(|(octave, counts)| (octave << MANTISSA_BITS..).zip(counts));
        for (bin, &count) in bins.filter(|(_, count)| **count > 0) {
            let count = f64::from(count);
            if below + count >= wanted {
                let (low, high) = (edge(bin), edge(bin + 1));
                return Some(low + (high - low) * (wanted - below) / count);
            }
            below += count;
        }
        None
    }
}

fn bins() -> usize {
    EXPONENTS.len() << MANTISSA_BITS
}

/// The leading bits of a positive double, taken as an integer, are a piecewise linear logarithm.
fn bin(value: f64) -> usize {
    let first = edge(0).to_bits() >> (52 - MANTISSA_BITS);
    let bits = value.max(edge(0)).to_bits() >> (52 - MANTISSA_BITS);
    usize::try_from(bits.saturating_sub(first))
        .unwrap_or(usize::MAX)
        .min(bins() - 1)
}

/// Lower edge of a bin.
fn edge(bin: usize) -> f64 {
    let first = 2.0_f64.powi(EXPONENTS.start).to_bits() >> (52 - MANTISSA_BITS);
    f64::from_bits((first + bin as u64) << (52 - MANTISSA_BITS))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn median_agrees_with_sorting() {
        let mut h = LogHistogram::default();
        // A multiplicative generator spreads the values over eight decades.
        let mut values: Vec<f64> = (0..5001_u64)
            .map(|i| 10_f64.powf((i * 7919 % 5001) as f64 * 8.0 / 5001.0 - 4.0))
            .collect();
        for &v in &values {
            h.add(v);
        }
        values.sort_by(f64::total_cmp);
        assert!((h.median().unwrap() / values[2500] - 1.0).abs() < 2.0_f64.powi(-12) + 8.0 * 2.303 / 5001.0);
        assert_eq!(h.total(), 5001);
        for share in [0.05, 0.95, 0.997] {
            let sorted = values[(5001.0 * share) as usize];
            assert!((h.quantile(share).unwrap() / sorted - 1.0).abs() < 2.0_f64.powi(-12) + 8.0 * 2.303 / 5001.0);
        }
    }

    #[test]
    fn a_single_value_comes_back_within_a_bin() {
        for v in [1e-9, 0.3, 1.0, 7.77, 1e6, 1e17] {
            let mut h = LogHistogram::default();
            h.add(v);
            assert!((h.median().unwrap() / v - 1.0).abs() <= 2.0_f64.powi(-12));
        }
    }

    #[test]
    fn values_off_the_scale_are_counted_at_its_ends() {
        let mut h = LogHistogram::default();
        for v in [0.0, -1.0, f64::NAN] {
            h.add(v);
        }
        assert!(h.median().unwrap() < 1e-11);
        let mut h = LogHistogram::default();
        for v in [f64::INFINITY, 1e300] {
            h.add(v);
        }
        assert!(h.median().unwrap() > 1e18);
        assert!(LogHistogram::default().median().is_none());
    }
}
