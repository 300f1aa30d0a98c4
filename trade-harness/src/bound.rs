//! The range that a number must lie in to bear out a paper.

/// A range; both ends belong to it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bound {
    /// Smallest value.
    pub low: f64,
    /// Largest value; may be infinite.
    pub high: f64,
}

impl Bound {
    /// Between two values.
    pub const fn between(low: f64, high: f64) -> Self {
        Self { low, high }
    }

    /// One value.
    pub const fn exactly(value: f64) -> Self {
        Self::between(value, value)
    }

    /// Within a share of a positive number.
    pub fn within(share: f64, of: f64) -> Self {
        Self::between(of * (1.0 - share), of * (1.0 + share))
    }

    /// Whether a number is in the range; none at all is not.
    pub fn holds(&self, value: Option<f64>) -> bool {
        value.is_some_and(|v| (self.low..=self.high).contains(&v))
    }

    /// The range in words.
    ///
    /// * `number`: how its ends are written.
    pub fn words(&self, number: impl Fn(f64) -> String) -> String {
        let low = number(self.low);
        if self.high.is_infinite() {
            format!("at least {low}")
        } else if self.low.total_cmp(&self.high).is_eq() {
            format!("exactly {low}")
        } else {
            format!("{low} to {}", number(self.high))
        }
    }
}
