//! How an acceleration of size one goes over the length of an event: one file for each shape and one line in the registry.

mod decay;
mod on_off;
mod ramp;

use interface::mission;
use serde::{Deserialize, Serialize};

pub use decay::Decay;
pub use on_off::OnOff;
pub use ramp::Ramp;

/// A shape.
pub(crate) trait Shape {
    /// Integral of the shape from the begin of the event to `t`, s, with 0 <= `t` <= `duration`.
    fn impulse(&self, t: f64, duration: f64) -> f64;
}

macro_rules! registry {
    ($($name:ident => $from:pat, $made:expr;)*) => {
        /// The shape of an event.
        #[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
        #[allow(missing_docs)]
        pub enum Profile { $($name($name)),* }

        impl Profile {
            /// The shape that a mission asks for.
            pub(crate) fn of(profile: mission::Profile) -> Self {
                match profile { $($from => Self::$name($made)),* }
            }

            fn shape(&self) -> &dyn Shape {
                match self { $(Self::$name(shape) => shape),* }
            }
        }
    };
}

registry! {
    OnOff => mission::Profile::OnOff, OnOff;
    Decay => mission::Profile::DecayS(time), Decay { time };
    Ramp => mission::Profile::RampS(time), Ramp { time };
}

impl Profile {
    /// Mean of the shape over an interval that begins `from` seconds after the event and lasts `length` seconds.
    pub(crate) fn mean(&self, from: f64, length: f64, duration: f64) -> f64 {
        let at = |t: f64| self.shape().impulse(t.clamp(0.0, duration), duration);
        let mean = (at(from + length) - at(from)) / length;
        // An interval within a constant push has all of it, not all but a rounding.
        if (mean - 1.0).abs() < 1e-9 { 1.0 } else { mean }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The impulse is the integral of what the shape is said to be.
    #[test]
    fn impulses_are_integrals() {
        let (duration, n) = (12.0, 240_000);
        let time = 2.5;
        type Form = fn(f64) -> f64;
        let cases: [(Profile, Form); 3] = [
            (Profile::OnOff(OnOff), |_| 1.0),
            (Profile::Decay(Decay { time }), |t| (-t / 2.5).exp()),
            (Profile::Ramp(Ramp { time }), |t| {
                (t / 2.5).min(1.0).min((12.0 - t) / 2.5)
            }),
        ];
        for (profile, form) in cases {
            let h = duration / f64::from(n);
            let mut sum = 0.0;
            for i in 0..n {
                sum += form((f64::from(i) + 0.5) * h) * h;
                let end = f64::from(i + 1) * h;
                let got = profile.shape().impulse(end, duration);
                assert!((got - sum).abs() < 1e-8, "{profile:?} to {end}: {got} and {sum}");
            }
        }
    }

    #[test]
    fn intervals_share_an_impulse_and_outside_there_is_none() {
        let profile = Profile::Decay(Decay { time: 3.0 });
        let mean = |k: i32| profile.mean(f64::from(k) - 0.7, 1.0, 4.0);
        let total: f64 = (-2..8).map(mean).sum();
        assert!((total - 3.0 * (1.0 - (-4.0_f64 / 3.0).exp())).abs() < 1e-14);
        assert!(mean(-2).abs() < 1e-18 && mean(6).abs() < 1e-18);
    }
}
