//! Numbers in four letters each: the page would be twice as large with digits.

use serde::Serializer;

const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// For `serialize_with`: `{"f24": text}`, see [`packed`].
pub(crate) fn pack<S: Serializer>(values: &[Option<f64>], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map([("f24", packed(values))])
}

/// The leading 24 bits of each number as an IEEE 754 single, rounded to nearest, in base 64; NaN for what is absent.
///
/// They hold four and a half digits, whatever the size of the number.
pub(crate) fn packed(values: &[Option<f64>]) -> String {
    let mut text = String::with_capacity(4 * values.len());
    for value in values {
        let single = value.map_or(f32::NAN, |v| v as f32);
        // Half of the last bit kept, so that what is cut off rounds.
        let bits = if single.is_finite() {
            single.to_bits().saturating_add(0x80)
        } else {
            f32::NAN.to_bits()
        };
        let letters = [26, 20, 14, 8].map(|shift| LETTERS[(bits >> shift & 63) as usize]);
        text.extend(letters.map(char::from));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 1 is 0x3f8000, -2.5 is 0xc02000, NaN is 0x7fc000; 1 + 2^-16 rounds up to 1 + 2^-15, 0x3f8001.
    #[test]
    fn bits_by_hand() {
        assert_eq!(packed(&[Some(1.0), Some(-2.5), None]), "P4AAwCAAf8AA");
        assert_eq!(packed(&[Some(1.0 + 2.0_f64.powi(-16)), Some(0.0)]), "P4ABAAAA");
    }
}
