//! The classical fixed-step Runge-Kutta scheme of order four.

use nalgebra::SVector;

/// Where in a step the derivative is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// At its begin.
    Begin,
    /// Half way.
    Middle,
    /// At its end.
    End,
}

/// One Runge-Kutta step of dx/dt = f(t, x).
///
/// * `t`: time at the start of the step.
/// * `x`: state at `t`, any units.
/// * `h`: step, in the unit of `t`; negative integrates backwards.
/// * returns: state at `t + h`, with a local error of order h^5.
pub fn step<const N: usize>(
    t: f64,
    x: &SVector<f64, N>,
    h: f64,
    f: impl Fn(f64, &SVector<f64, N>) -> SVector<f64, N>,
) -> SVector<f64, N> {
    let time = |stage| match stage {
        Stage::Begin => t,
        Stage::Middle => t + 0.5 * h,
        Stage::End => t + h,
    };
    step_in_stages(x, h, |stage, x| f(time(stage), x))
}

/// [`step`] for a derivative that knows the times of its three stages: what costs much and depends on time alone is then
/// computed once for each.
pub fn step_in_stages<const N: usize>(
    x: &SVector<f64, N>,
    h: f64,
    f: impl Fn(Stage, &SVector<f64, N>) -> SVector<f64, N>,
) -> SVector<f64, N> {
    let k1 = f(Stage::Begin, x);
    let k2 = f(Stage::Middle, &(x + k1 * (0.5 * h)));
    let k3 = f(Stage::Middle, &(x + k2 * (0.5 * h)));
    let k4 = f(Stage::End, &(x + k3 * h));
    x + (k1 + (k2 + k3) * 2.0 + k4) * (h / 6.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector2;

    #[test]
    fn global_error_falls_with_the_fourth_power() {
        // Harmonic oscillator, exact solution (cos t, -sin t).
        let error = |steps: u32| {
            let h = 2.0 / f64::from(steps);
            let mut x = Vector2::new(1.0, 0.0);
            for k in 0..steps {
                x = step(f64::from(k) * h, &x, h, |_, x| Vector2::new(x[1], -x[0]));
            }
            (x - Vector2::new(2.0_f64.cos(), -2.0_f64.sin())).norm()
        };
        let order = (error(40) / error(80)).log2();
        assert!((order - 4.0).abs() < 0.1, "observed order {order}");
    }

    #[test]
    fn time_reaches_the_right_hand_side() {
        // dx/dt = 4 t^3 is integrated exactly by an order-four rule.
        let x = step(1.0, &nalgebra::Vector1::new(1.0), 0.5, |t, _| {
            nalgebra::Vector1::new(4.0 * t.powi(3))
        });
        assert!((x[0] - 1.5_f64.powi(4)).abs() < 1e-14);
    }
}
