//! Scheduled pushes: what acts when, beside the surroundings.

use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

use crate::disturbances::profiles::Profile;

/// Acceleration of one vehicle over an interval of the time grid.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Thrust {
    /// Axes N, m/s2.
    pub n: Vector3<f64>,
    /// What turns with the vehicle beside that; attitudes cost as much as gravity and are asked for only where they matter.
    pub turning: Option<Turning>,
}

/// Accelerations in axes that turn with a vehicle, m/s2.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Turning {
    /// Body axes.
    pub body: Vector3<f64>,
    /// Radial, transverse, normal of the vehicle's orbit.
    pub rtn: Vector3<f64>,
}

impl Turning {
    /// The sum in axes N.
    ///
    /// * `dcm_b_n`, `dcm_rtn_n`: map N to body axes and to those of the orbit.
    pub(crate) fn resolved(
        &self,
        dcm_b_n: impl FnOnce() -> Matrix3<f64>,
        dcm_rtn_n: impl FnOnce() -> Matrix3<f64>,
    ) -> Vector3<f64> {
        let mut a = Vector3::zeros();
        if self.body != Vector3::zeros() {
            a += dcm_b_n().tr_mul(&self.body);
        }
        if self.rtn != Vector3::zeros() {
            a += dcm_rtn_n().tr_mul(&self.rtn);
        }
        a
    }
}

/// What acts over one interval of the time grid, beside the surroundings.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Push {
    /// On the target.
    pub target: Thrust,
    /// Of that, what filters are told of.
    pub announced: Thrust,
    /// On the chaser.
    pub chaser: Thrust,
    /// Whether something that no filter is told of pushes the target: a vent, a burn, an input.
    pub unannounced: bool,
    /// Attitude that the chaser is commanded to hold, N to its body axes; `None`: the mission's own.
    pub dcm_cmd_bc_n: Option<Matrix3<f64>>,
}

/// Which vehicle an event pushes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Side {
    /// The target.
    Target,
    /// The chaser.
    Chaser,
}

/// An acceleration in its axes, m/s2.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Vector {
    /// Axes N.
    N(Vector3<f64>),
    /// Inertial axes.
    Inertial(Vector3<f64>),
    /// Body axes of the vehicle.
    Body(Vector3<f64>),
    /// Radial, transverse, normal of the vehicle's orbit.
    Rtn(Vector3<f64>),
}

impl Vector {
    fn is_zero(&self) -> bool {
        let (Self::N(a) | Self::Inertial(a) | Self::Body(a) | Self::Rtn(a)) = self;
        *a == Vector3::zeros()
    }
}

/// One push with its time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Event {
    /// Begin, s since the start of the run.
    pub start: f64,
    /// Length, s.
    pub duration: f64,
    /// How it goes over its length.
    pub profile: Profile,
    /// Whom it pushes.
    pub side: Side,
    /// Acceleration where the profile is one.
    pub acceleration: Vector,
    /// Whether it takes part in finding the start from the end.
    pub back_propagated: bool,
    /// Whether filters are told of it.
    pub told: bool,
}

impl Event {
    /// Adds what the event does over an interval, in the mean, so that no momentum is lost at its edges.
    ///
    /// * `n_from_inertial`: turns inertial axes into N at the middle of the interval.
    fn add_to(
        &self,
        push: &mut Push,
        begin: f64,
        length: f64,
        n_from_inertial: impl Fn(&Vector3<f64>) -> Vector3<f64>,
    ) {
        let share = self.profile.mean(begin - self.start, length, self.duration);
        let of_target = self.side == Side::Target;
        push.unannounced |= of_target && !self.told && share != 0.0 && !self.acceleration.is_zero();
        let add = |thrust: &mut Thrust| match &self.acceleration {
            Vector::N(a) => thrust.n += a * share,
            Vector::Inertial(a) => thrust.n += n_from_inertial(a) * share,
            Vector::Body(a) => thrust.turning.get_or_insert_default().body += a * share,
            Vector::Rtn(a) => thrust.turning.get_or_insert_default().rtn += a * share,
        };
        add(match self.side {
            Side::Target => &mut push.target,
            Side::Chaser => &mut push.chaser,
        });
        if of_target && self.told {
            add(&mut push.announced);
        }
    }
}

/// All events of a run; they add where they overlap.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Timeline {
    /// By begin.
    events: Vec<Event>,
    /// The longest of them, s.
    longest: f64,
}

impl Timeline {
    /// These events, in any order.
    pub fn new(mut events: Vec<Event>) -> Self {
        events.sort_by(|a, b| a.start.total_cmp(&b.start));
        let longest = events.iter().map(|e| e.duration).fold(0.0, f64::max);
        Self { events, longest }
    }

    /// The events, by begin.
    pub fn events(&self) -> &[Event] {
        &self.events
    }

    /// The events that take part in finding the start from the end.
    pub(crate) fn back_propagated(&self) -> Self {
        Self::new(self.events.iter().filter(|e| e.back_propagated).copied().collect())
    }

    /// What acts over an interval, in the mean.
    ///
    /// * `begin`, `length`: of the interval, s since the start of the run.
    /// * `n_from_inertial`: turns inertial axes into N at the middle of the interval.
    #[inline]
    pub fn push_over(&self, begin: f64, length: f64, n_from_inertial: impl Fn(&Vector3<f64>) -> Vector3<f64>) -> Push {
        let mut push = Push::default();
        let first = self.events.partition_point(|e| e.start + self.longest <= begin);
        for event in &self.events[first..] {
            if event.start >= begin + length {
                break;
            }
            if event.start + event.duration > begin {
                event.add_to(&mut push, begin, length, &n_from_inertial);
            }
        }
        push
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::disturbances::profiles::OnOff;

    fn event(start: f64, duration: f64, x: f64) -> Event {
        Event {
            start,
            duration,
            profile: Profile::OnOff(OnOff),
            side: Side::Target,
            acceleration: Vector::N(Vector3::new(x, 0.0, 0.0)),
            back_propagated: true,
            told: false,
        }
    }

    #[test]
    fn what_filters_are_not_told_of_is_said_while_it_pushes_the_target() {
        let at = |event: Event, begin: f64| Timeline::new(vec![event]).push_over(begin, 1.0, |v| *v).unannounced;
        let vent = event(2.5, 3.0, 1e-5);
        assert_eq!(
            [0.0, 1.0, 2.0, 5.0, 6.0].map(|t| at(vent, t)),
            [false, false, true, true, false]
        );
        assert!(!at(Event { told: true, ..vent }, 3.0));
        assert!(!at(
            Event {
                side: Side::Chaser,
                ..vent
            },
            3.0
        ));
        assert!(!at(event(2.5, 3.0, 0.0), 3.0), "a vent of no size is none");
    }

    #[test]
    fn events_keep_their_momentum_on_any_grid_and_add() {
        let timeline = Timeline::new(vec![
            event(7.6, 0.3, 100.0),
            event(2.0, 2.0, 1.0),
            event(2.6, 2.0, 10.0),
        ]);
        let acting: Vec<f64> = (0..9)
            .map(|k| timeline.push_over(f64::from(k), 1.0, |v| *v).target.n.x)
            .collect();
        // The second covers 0.4 of the interval from 2 s and 0.6 of that from 4 s; the third 0.3 of one.
        let expected = [0.0, 0.0, 5.0, 11.0, 6.0, 0.0, 0.0, 30.0, 0.0];
        for (acting, expected) in acting.iter().zip(expected) {
            assert!((acting - expected).abs() < 1e-12, "{acting} and {expected}");
        }
    }

    #[test]
    fn whole_intervals_have_exactly_the_stated_acceleration() {
        let timeline = Timeline::new(vec![event(0.3, 0.6, 0.1)]);
        for k in 15..45 {
            let x = timeline.push_over(f64::from(k) * 0.02, 0.02, |v| *v).target.n.x;
            assert_eq!(x.to_bits(), 0.1_f64.to_bits(), "{k}");
        }
    }

    #[test]
    fn only_events_of_the_chasers_side_push_the_chaser() {
        let mut burn = event(0.0, 1.0, 1.0);
        burn.side = Side::Chaser;
        burn.acceleration = Vector::Inertial(Vector3::x());
        let push = Timeline::new(vec![burn]).push_over(0.0, 1.0, |v| Vector3::new(v.y, v.x, v.z));
        assert!((push.chaser.n - Vector3::y()).amax() < 1e-15 && push.target == Thrust::default());
    }
}
