//! A running filter: takes samples, bridges gaps, and holds the estimate.

use crate::beliefs::Beliefs;
use crate::commands::{Command, Commands};
use crate::dynamics::AccelerationModel;
use crate::editing::Editing;
use crate::error::FilterError;
use crate::estimators::{Gap, Kind, Reported};
use crate::innovation::Innovation;
use crate::laws::{Adaptation, FILTERS, FilterEntry, Hindsight, Law, Replacement, Setup, Step, Update, registry};
use crate::layout::Layout;
use crate::prediction::{self, Prediction};
use crate::sample::{Reading, Sample, Untold};
use crate::source::{Arrival, Source};
use crate::state::{RowVector, State, Target, TargetMatrix};
use crate::tunable::{Tunables, Value};
use crate::units::Units;
use astro::LvlhAxes;
use interface::Bound::Positive;
use interface::mission::Frame;
use interface::{Navigation, Sensor, Status};
use nalgebra::Vector3;
use numerics::spd;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// Longest gap between samples, s. A tag further ahead is a mistake of the caller, not a gap.
const LONGEST_GAP: f64 = 1e5;

/// Most steps of a prediction.
const MOST_PREDICTED: f64 = 600.0;

/// Everything that chooses a filter, but for the mission.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// Index into [`FILTERS`].
    pub filter: usize,
    /// Seed of the study.
    pub study_seed: u64,
    /// Run within the study.
    pub run: u64,
    /// What the filter believes of the world where it is not what the mission says.
    pub beliefs: Beliefs,
    /// Values of every tunable of every filter, in the order of [`FILTERS`] and of their declarations.
    pub tunables: Vec<Vec<Value>>,
}

impl Default for Settings {
    /// The first filter, everything at its start value.
    fn default() -> Self {
        let tunables = FILTERS
            .iter()
            .map(|f| f.tunables.iter().map(|t| t.kind.start()).collect())
            .collect();
        Self {
            filter: 0,
            study_seed: 1,
            run: 0,
            beliefs: Beliefs::default(),
            tunables,
        }
    }
}

impl Settings {
    /// The filter chosen.
    ///
    /// # Errors
    /// When the index is not registered.
    pub fn filter(&self) -> Result<&'static FilterEntry, FilterError> {
        registry::entry(self.filter)
    }

    /// Every real tunable that the mission may state, of every filter in their order, as it acts: what is set here, else
    /// what the mission states, else what follows from its scales; -1 where that is nothing the tunable can take.
    ///
    /// # Errors
    /// When a belief is out of range.
    pub fn resolved(&self, navigation: &Navigation) -> Result<Vec<f64>, FilterError> {
        let told = self.beliefs.over(navigation)?;
        let of_filter = |(filter, values): (&FilterEntry, &Vec<Value>)| {
            let tunables = Tunables {
                law: filter.name,
                declared: filter.tunables,
                values,
                told: &told,
            };
            let derived = filter.tunables.iter().filter(|tunable| tunable.kind.derived());
            derived
                .map(|tunable| tunables.real(tunable.name).unwrap_or(Beliefs::OWN))
                .collect::<Vec<_>>()
        };
        Ok(FILTERS.iter().zip(&self.tunables).flat_map(of_filter).collect())
    }

    /// The value of one tunable, to be changed.
    pub fn tunable_mut(&mut self, filter: &str, tunable: &str) -> Option<&mut Value> {
        let f = FILTERS.iter().position(|entry| entry.name == filter)?;
        let t = FILTERS[f].tunables.iter().position(|entry| entry.name == tunable)?;
        self.tunables.get_mut(f)?.get_mut(t)
    }
}

/// The estimate after the newest sample, SI.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// Epoch of the sample last used, s.
    pub time: f64,
    /// Its ordinal; 0 before the first.
    pub count: i32,
    /// The 18 states; in the LVLH frame: rho, rho_dot and d, then nothing.
    pub x: State,
    /// Covariance of the first nine.
    pub p_target: TargetMatrix,
    /// Standard deviations of the 18 states.
    pub sigma: State,
}

/// A filter at work; all of its state is here and can be saved.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Navigator {
    units: Units,
    frame: Frame,
    layout: Layout,
    start_s: f64,
    estimator: Kind,
    law: Law,
    divergence: Divergence,
    editing: Editing,
    source: Source,
    /// Noise variances of the rows, internal units.
    r: RowVector,
    estimate: Estimate,
    innovation: Innovation,
    status: Status,
    /// Whether rounding has left no covariance; nothing brings it back.
    unsound: bool,
    /// Epochs at which no sensor of the target was due, since the last at which one was: the law has not heard of them.
    between: Option<Between>,
    /// What a bound has been told so far; `None` for a filter, which is told nothing.
    untold: Option<Untold>,
    /// What the chaser has been commanded since the sample last used, where the filter is told.
    commands: Commands,
    /// What of the sample last used holds until the next one, attitude and orbit; before the first, what is known at the start.
    last: Sample,
    /// The initial estimate, while no sample has been used and as far as it is known.
    expected: Option<State>,
    /// End of the present communication step, s.
    now_s: f64,
    /// Whether a command was left out since nobody says how the axes of the estimate stand against those of the command.
    left_out: bool,
}

/// Epochs of the accelerometer alone, as one: their length, transition and correction of the target's nine states.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Between {
    dt: f64,
    f: TargetMatrix,
    correction: Target,
}

impl Between {
    /// What precedes a step, if anything does, and the step, as one.
    fn with(before: Option<Self>, step: &Step) -> Self {
        match before {
            None => Self {
                dt: step.dt,
                f: step.f,
                correction: step.correction,
            },
            Some(before) => Self {
                dt: before.dt + step.dt,
                f: step.f * before.f,
                correction: step.f * before.correction + step.correction,
            },
        }
    }
}

/// Exponential mean of the normalised innovations.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Divergence {
    limit: f64,
    samples: f64,
    mean: f64,
}

impl Navigator {
    /// A filter that waits for its first sample.
    ///
    /// * `navigation`: what the mission tells it.
    /// * `start_time`: epoch at which the initial estimate will hold, s.
    ///
    /// # Errors
    /// When the filter is unknown or has no meaning in the mission, the mission tells of something that it cannot use, or a
    /// parameter is out of range.
    pub fn new(navigation: &Navigation, settings: &Settings, start_time: f64) -> Result<Self, FilterError> {
        let (filter, b) = (settings.filter()?, &settings.beliefs);
        if let Some(why) = filter.no_meaning_in(navigation) {
            return Err(FilterError::NoMeaning {
                filter: filter.name,
                mission: navigation.mission.clone(),
                why,
            });
        }
        registry::check_names(navigation)?;
        let told = b.over(navigation)?;
        let (units, layout) = (Units::of(&told.units), Layout::of(&told));
        let setup = Setup {
            tunables: Tunables {
                law: filter.name,
                declared: filter.tunables,
                values: settings.tunables.get(settings.filter).map_or(&[], Vec::as_slice),
                told: &told,
            },
            layout,
            r: Kind::noise(&told),
            state_measured: told.frame == Frame::Lvlh,
            units,
            off_nominal: Positive.check("off_nominal", b.off_nominal, "")?,
            study_seed: settings.study_seed,
            run: settings.run,
        };
        let law = Law::new(settings.filter, &setup)?;
        let ours = filter.ours && !law.reproduces();
        let gain = match filter.update {
            Update::Kalman => None,
            Update::ConstantGain(gain) => Some(gain(&setup)?),
        };
        Ok(Self {
            units,
            frame: told.frame,
            layout,
            start_s: start_time,
            estimator: Kind::new(&told, b, filter.motion, ours, gain, law.acceleration())?,
            editing: editing(filter, ours, b, &told)?,
            law,
            divergence: Divergence {
                limit: Positive.check("divergence.nis", b.divergence_nis, "")?,
                samples: Positive.check("divergence.samples", f64::from(b.divergence_samples), "")?,
                mean: 1.0,
            },
            source: Source::new(&told),
            r: setup.r,
            estimate: Estimate {
                time: start_time,
                count: 0,
                x: State::zeros(),
                p_target: TargetMatrix::zeros(),
                sigma: State::zeros(),
            },
            innovation: Innovation::default(),
            status: Status::Initialising,
            unsound: false,
            between: None,
            untold: filter.bound.then(Untold::default),
            commands: Commands::default(),
            last: Sample::blank(0, start_time),
            expected: None,
            now_s: start_time,
            left_out: false,
        })
    }

    /// What holds at the start, before any step: where impulses begin to count, and the initial estimate.
    pub fn begin(&mut self, sample: &Sample, nav_init: &State, command: &Command) {
        self.commands = Commands::begin(command.impulse_count);
        self.expect(sample, nav_init);
    }

    /// A communication step begins at `t_s` and is `length_s` long, with this command over it; call before [`Navigator::process`].
    pub fn step(&mut self, t_s: f64, length_s: f64, command: &Command) {
        self.commands.take(t_s, command);
        self.now_s = t_s + length_s;
    }

    /// Shows the initial estimate as long as no sample has been used: all zero is unknown.
    ///
    /// * `sample`: for the attitude and the target's orbit at the start.
    pub fn expect(&mut self, sample: &Sample, nav_init: &State) {
        if self.estimator.get().started() {
            return;
        }
        let known_already = self.expected.is_some_and(|expected| expected == *nav_init);
        let held = |sample: &Sample| (sample.target_axes, sample.dcm_bc_n, sample.target_orbit);
        if known_already && held(&self.last) == held(sample) {
            return;
        }
        let known = nav_init.iter().any(|v| *v != 0.0) && nav_init.iter().all(|v| v.is_finite());
        let mut start = self.estimator.clone();
        self.expected = (known && start.get_mut().start(nav_init, self.start_s).is_ok()).then_some(*nav_init);
        self.last = sample.without_readings(self.start_s);
        if self.expected.is_some() {
            let Reported { x, p_target, sigma } = start.get().report(&self.last, &self.law, None);
            self.estimate = Estimate {
                x,
                p_target,
                sigma,
                ..self.estimate
            };
        }
    }

    /// The estimate propagated to the end of the present communication step; the estimate itself, at its own time, where it cannot be
    /// propagated.
    ///
    /// A prediction is made anew each time from the last sample, so it depends on nothing but that and the commands.
    pub fn predict(&self) -> Prediction {
        let length_s = self.now_s - self.estimate.time;
        let axes = self.last.target_axes.map(|axes| axes.after(length_s));
        if length_s > 0.0
            && let Some(ahead) = self.predicted(length_s, axes)
        {
            return Prediction::new(self.now_s, self.frame, &ahead.x, &ahead.sigma, axes.as_ref());
        }
        let Estimate { time, x, sigma, .. } = &self.estimate;
        Prediction::new(*time, self.frame, x, sigma, self.last.target_axes.as_ref())
    }

    /// The same as its estimator has it; `None` where the way cannot be gone.
    ///
    /// * `axes`: of the target's orbit at its end.
    fn predicted(&self, length_s: f64, axes: Option<LvlhAxes>) -> Option<Reported> {
        self.estimator.with_copy(|estimator| {
            if !estimator.started() {
                estimator.start(&self.expected?, self.start_s).ok()?;
            }
            let mut ahead = self.last.without_readings(self.now_s);
            ahead.target_axes = axes;
            let gap = Gap {
                from_s: self.estimate.time,
                length_s,
                start_s: self.start_s,
                // A source that has stalled for long must not make every step a long one.
                step_s: Gap::LONGEST_STEP.max(length_s / MOST_PREDICTED),
            };
            let f = estimator.propagate(&gap, &ahead, &self.law, &self.commands).ok()?;
            let since = self.between.as_ref().map_or(f, |between| f * between.f);
            estimator.defect(self.now_s).is_none().then_some(())?;
            Some(estimator.report(&ahead, &self.law, Some(&since)))
        })
    }

    /// Position and velocity of the target relative to the chaser as estimated, axes N, m and m/s; zero in the LVLH frame where nobody
    /// says how that stands.
    pub fn relative_n(&self) -> (Vector3<f64>, Vector3<f64>) {
        prediction::relative_n(self.frame, &self.estimate.x, self.last.target_axes.as_ref())
    }

    /// Refuses a sample that cannot be used, before anything changes: one from too far ahead, one that makes no sense, or the first one
    /// without an initial estimate. One that is no new sample is none of these.
    ///
    /// # Errors
    /// [`FilterError::TimeNotAdvancing`], [`FilterError::GapTooLong`], [`FilterError::NoInitialEstimate`],
    /// [`FilterError::NoChaserPosition`], [`FilterError::NothingUntold`] or what the estimator finds in the sample.
    pub fn check(&self, sample: &Sample, nav_init: &State) -> Result<(), FilterError> {
        if self.source.arrival(sample) != Arrival::New {
            return Ok(());
        }
        let (t_s, last_s) = (sample.time, self.estimate.time);
        let gap_s = t_s - last_s;
        if gap_s.is_nan() || gap_s <= 0.0 {
            return Err(FilterError::TimeNotAdvancing {
                count: sample.count,
                t_s,
                last_s,
            });
        }
        if gap_s > LONGEST_GAP {
            return Err(FilterError::GapTooLong {
                count: sample.count,
                t_s,
                gap_s,
                limit_s: LONGEST_GAP,
            });
        }
        let estimator = self.estimator.get();
        estimator.check(sample)?;
        if self.untold.is_some() && sample.untold.is_none() {
            return Err(FilterError::NothingUntold { t_s });
        }
        if estimator.started() {
            return Ok(());
        }
        if nav_init.iter().all(|v| *v == 0.0) {
            return Err(FilterError::NoInitialEstimate {
                count: sample.count,
                t_s,
            });
        }
        estimator.check_start(nav_init, t_s)
    }

    /// Processes a sample. One that was here before is passed by: the ordinal of the last, or a lower one with an epoch that is not
    /// beyond the last; a new ordinal with such an epoch is counted, too. A lower ordinal with an epoch beyond the last begins a new
    /// sequence.
    ///
    /// * returns: whether the sample was a new one.
    ///
    /// * `nav_init`: the initial estimate at the start time, 18 states, SI; read with the first sample only.
    ///
    /// # Errors
    /// When the sample makes no sense, as [`Navigator::check`] finds, and nothing has changed; or when the filter breaks down: its
    /// status is then [`Status::Diverged`], its last estimate stays, and it should not be used further.
    pub fn process(&mut self, sample: &Sample, nav_init: &State) -> Result<bool, FilterError> {
        self.check(sample, nav_init)?;
        match self.source.arrival(sample) {
            Arrival::Known => return Ok(false),
            Arrival::Duplicate => {
                self.source.pass_by(sample);
                return Ok(false);
            }
            Arrival::New => (),
        }
        let taken = self.take(sample, nav_init);
        if taken.is_err() {
            self.status = Status::Diverged;
        }
        taken.map(|()| true)
    }

    /// Takes a new sample that has been checked.
    ///
    /// # Errors
    /// When the filter breaks down.
    fn take(&mut self, sample: &Sample, nav_init: &State) -> Result<(), FilterError> {
        let mut sample = Cow::Borrowed(sample);
        let (t_s, last_s) = (sample.time, self.estimate.time);
        let gap_s = t_s - last_s;
        let estimator = self.estimator.get_mut();
        if let Some(before) = &mut self.untold {
            let untold = sample.untold.ok_or(FilterError::NothingUntold { t_s })?;
            self.law.hear(&hindsight(&untold, before, gap_s, &self.units));
            *before = untold;
        }
        self.editing.remove_impossible(&mut sample, self.layout);
        if !estimator.started() {
            estimator.start(nav_init, t_s)?;
            self.law.look_ahead(&estimator.relative());
        }

        self.source.take(&sample);
        let gap = Gap {
            from_s: last_s,
            length_s: gap_s,
            start_s: self.start_s,
            step_s: Gap::LONGEST_STEP,
        };
        let f = estimator.propagate(&gap, &sample, &self.law, &self.commands)?;
        let mut step = Step::blank(gap_s / self.units.time, f);
        let mut seen = estimator.update(&sample, &mut step)?;
        if let Some(all) = seen {
            // Asked for only where there is something to doubt.
            let excess = || {
                let since = self.between.as_ref().map_or(f, |before| f * before.f);
                self.law.excess(&since.fixed_view::<6, 6>(0, 0).into_owned())
            };
            let outliers = self.editing.find(&sample, &step, all.nis, excess, self.layout, &self.r);
            if outliers.contains(&true) {
                for sensor in Sensor::ALL.into_iter().filter(|sensor| outliers[*sensor as usize]) {
                    sample.to_mut()[sensor] = Reading::Lost;
                }
                estimator.undo();
                step = Step::blank(gap_s / self.units.time, f);
                seen = estimator.update(&sample, &mut step)?;
            }
        }
        if let Some(defect) = estimator.defect(t_s) {
            return Err(defect);
        }
        // A law learns from what is measured of the target and of how long it took: a fast accelerometer must not cut that up.
        let whole = Between::with(self.between.take(), &step);
        let due = self.layout.any_due(&sample);
        let mut moved = step.correction;
        if due {
            (step.dt, step.f) = (whole.dt, whole.f);
            step.correction = whole.correction;
            self.law.observe(&step)?;
            if let Some(own) = self.law.replacement() {
                estimator.shift(&own.shift);
                let mut relative = moved.fixed_rows_mut::<6>(0);
                relative += own.shift;
                if let Some(defect) = estimator.defect(t_s).or_else(|| own.defect(t_s)) {
                    return Err(defect);
                }
                seen = seen.map(|seen| restated(&seen, own, &step, self.layout));
            }
        } else {
            self.between = Some(whole);
        }
        self.editing.remember(&sample, &step, &moved, self.layout);
        self.law.look_ahead(&estimator.relative());
        let since = self.between.as_ref().map(|between| &between.f);
        let Reported { x, p_target, sigma } = estimator.report(&sample, &self.law, since);
        self.estimate = Estimate {
            time: sample.time,
            count: sample.count,
            x,
            p_target,
            sigma,
        };
        self.left_out |= self.frame == Frame::Lvlh && sample.target_axes.is_none() && !self.commands.is_silent();
        let reads_since = self.estimator.get().reads_since(self.start_s);
        self.commands
            .forget_before(reads_since.map_or(t_s, |since_s| since_s.min(t_s)));
        self.last = sample.without_readings(sample.time);
        self.expected = None;
        self.judge(due, seen);
        self.unsound |= self.law.learns_without_bound() && !self.has_covariance();
        Ok(())
    }

    /// Lets communication time pass that has brought no new sample, s; after three periods of it the estimate is stale.
    pub fn wait(&mut self, length_s: f64) {
        self.source.waits(length_s);
    }

    /// Keeps the innovation and says what the filter is doing. An epoch at which no sensor of the target samples says nothing.
    fn judge(&mut self, due: bool, seen: Option<Innovation>) {
        let Some(seen) = seen else {
            if due {
                self.status = Status::Coasting;
            }
            return;
        };
        self.innovation = seen;
        let judged = self.dimension() > 0;
        if judged {
            let normalised = seen.nis / seen.rows as f64;
            self.divergence.mean += (normalised - self.divergence.mean) / self.divergence.samples;
        }
        self.status = if judged && self.divergence.mean > self.divergence.limit {
            Status::Diverged
        } else {
            Status::Tracking
        };
    }

    /// Whether what stands as the covariance of the target's states is one.
    fn has_covariance(&self) -> bool {
        let p = &self.estimate.p_target;
        match self.dimension() {
            0 => true,
            6 => spd::is_covariance(&p.fixed_view::<6, 6>(0, 0).into_owned()),
            _ => spd::is_covariance(p),
        }
    }

    /// The estimate after the newest sample.
    pub fn estimate(&self) -> &Estimate {
        &self.estimate
    }

    /// The newest innovation.
    pub fn innovation(&self) -> &Innovation {
        &self.innovation
    }

    /// What the filter is doing. Once rounding has left it no covariance it has diverged for good.
    pub fn status(&self) -> Status {
        match self.status {
            _ if self.source.is_stale() => Status::Stale,
            _ if self.unsound => Status::Diverged,
            status => status,
        }
    }

    /// The frame of the first nine states.
    pub fn frame(&self) -> Frame {
        self.frame
    }

    /// Whether it uses what this sensor of the target measures.
    pub fn uses(&self, sensor: Sensor) -> bool {
        self.layout.of_sensor(sensor).is_some()
    }

    /// Number of the first nine states that have a covariance: nine, six without an acceleration state, none under a
    /// constant gain.
    pub fn dimension(&self) -> usize {
        self.estimator.get().dimension()
    }

    /// Whether the unmodelled acceleration is estimated, as a state, by a network or by a better model.
    pub fn estimates_acceleration(&self) -> bool {
        self.law.acceleration() != AccelerationModel::Absent
            || self.law.disturbance().is_some()
            || self.estimator.get().knows_acceleration()
    }

    /// Square root of the jerk density in use, axes of the estimate, m/s^2.5; zero for a law without one.
    pub fn s(&self) -> Vector3<f64> {
        self.law.s().map(|s| s.abs() * self.units.root_jerk_density())
    }

    /// How often the law has changed its process noise.
    pub fn updates(&self) -> i32 {
        self.law.updates()
    }

    /// Whether a command was left out since nobody says how the LVLH axes stand against axes N.
    pub fn leaves_commands_out(&self) -> bool {
        self.left_out
    }

    /// Samples of a sensor that were passed by as outliers.
    pub fn outliers(&self) -> i32 {
        self.editing.outliers()
    }

    /// Samples of a sensor, the accelerometer included, that were passed by since they cannot be: a range that is not positive, a
    /// number that is none.
    pub fn impossible(&self) -> i32 {
        self.editing.impossible()
    }

    /// Samples that were passed by since their epoch was not beyond the last, though their ordinal was new.
    pub fn duplicates(&self) -> i32 {
        self.source.duplicates()
    }

    /// How often the source began to count again.
    pub fn restarts(&self) -> i32 {
        self.source.restarts()
    }

    /// How often the law's solver found no solution.
    pub fn unsolved(&self) -> i32 {
        self.law.unsolved()
    }

    /// How often the law passed an update by because its window was singular.
    pub fn skipped(&self) -> i32 {
        self.law.skipped()
    }
}

/// What a bound is told of the interval between two samples.
fn hindsight(now: &Untold, before: &Untold, gap_s: f64, units: &Units) -> Hindsight {
    Hindsight {
        a_t_n: (now.dv_t_n - before.dv_t_n) / (gap_s * units.acceleration()),
        active: ((now.event_time - before.event_time) / gap_s).clamp(0.0, 1.0),
    }
}

/// How a filter edits its measurements.
///
/// * `ours`: whether it reproduces no paper, and so edits unless told otherwise.
///
/// # Errors
/// When a parameter is out of range.
fn editing(filter: &FilterEntry, ours: bool, b: &Beliefs, told: &Navigation) -> Result<Editing, FilterError> {
    let refused = |name: &str, value: f64, permitted: &str| FilterError::OutOfRange {
        name: name.into(),
        value,
        unit: "",
        permitted: permitted.into(),
    };
    let on = Beliefs::switched("editing.mode", b.editing_mode, ours)?;
    let share = Positive.check("editing.outlier_share", b.editing_outlier_share, "")?;
    if share >= 0.5 {
        return Err(refused("editing.outlier_share", share, "between 0 and 0.5"));
    }
    if b.editing_most_in_a_row < 0 {
        let most = f64::from(b.editing_most_in_a_row);
        return Err(refused("editing.most_in_a_row", most, "0 or more"));
    }
    // Without a covariance there is no likelihood.
    let looks = on && matches!(filter.update, Update::Kalman);
    Ok(Editing::new(looks.then_some(share), b.editing_most_in_a_row, told))
}

/// An innovation as a law sees it that keeps filters of its own: the residual is of the mean, which is the law's already.
fn restated(seen: &Innovation, own: &Replacement, step: &Step, layout: Layout) -> Innovation {
    let ratio = RowVector::from_fn(|i, _| {
        if step.measured.has(i) {
            own.variance[i] / step.s[(i, i)]
        } else {
            0.0
        }
    });
    Innovation {
        variance: seen.variance.component_mul(&layout.to_channels(&ratio)),
        nis: own.nis,
        ..*seen
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample::Reading;
    use nalgebra::Matrix3;

    /// Two steps as one move a state, and add to it, as the two do.
    #[test]
    fn steps_between_make_one() {
        let (mut first, mut second) = (
            Step::blank(0.2, TargetMatrix::identity()),
            Step::blank(0.3, TargetMatrix::identity()),
        );
        for (step, seed) in [(&mut first, 1.0), (&mut second, 5.0)] {
            for i in 0..9 {
                step.correction[i] = seed + i as f64;
                step.f[(i, (i + 3) % 9)] = 0.1 * seed;
                step.f[(i, (i + 5) % 9)] = -0.3 * seed;
            }
        }
        let both = Between::with(Some(Between::with(None, &first)), &second);
        let x = Target::from_fn(|i, _| 1.0 - 0.2 * i as f64);
        let one_by_one = second.f * (first.f * x + first.correction) + second.correction;
        assert!((both.f * x + both.correction - one_by_one).norm() < 1e-12 * one_by_one.norm());
        assert!((both.dt - 0.5).abs() < 1e-15);
    }

    /// What a law is handed against the formulas of the update, the inverse formed.
    #[test]
    fn a_law_sees_the_update_that_was_made() {
        let mission = interface::mission::embedded("leo_venting").unwrap();
        let told = mission.mission().unwrap().navigation();
        let mut nav = Navigator::new(&told, &Settings::default(), 0.0).unwrap();
        let mut start = State::zeros();
        start
            .fixed_rows_mut::<6>(0)
            .copy_from_slice(&[20.0, 500.0, -30.0, 0.1, -0.5, 0.2]);
        start
            .fixed_rows_mut::<6>(9)
            .copy_from_slice(&[6.878e6, 0.0, 0.0, 0.0, 7.3e3, 2.0e3]);
        let mut sample = Sample::blank(1, 1.0);
        sample[Sensor::Lidar] = Reading::of(&[503.0, 0.06, 0.04]);
        let gap = Gap {
            from_s: 0.0,
            length_s: 1.0,
            start_s: 0.0,
            step_s: Gap::LONGEST_STEP,
        };
        let estimator = nav.estimator.get_mut();
        estimator.start(&start, 1.0).unwrap();
        // Body axes along N: the boresight is y.
        let f = estimator.propagate(&gap, &sample, &nav.law, &nav.commands).unwrap();
        let mut step = Step::blank(1.0, f);
        let seen = estimator.update(&sample, &mut step).unwrap().unwrap();
        assert!(step.measured.count() == 3 && step.measured.has(2) && !step.measured.has(3));
        let (h, p) = (step.h.fixed_rows::<3>(0).into_owned(), step.p_prior);
        let r = Matrix3::from_diagonal(&Kind::noise(&told).fixed_rows::<3>(0).into_owned());
        let s = h * p * h.transpose() + r;
        assert!((step.s.fixed_view::<3, 3>(0, 0) - s).amax() < 1e-9 * s.amax());
        let inverse = s.try_inverse().unwrap();
        // The gain on the target's states is the optimal one, consider states or not.
        let gain = p * h.transpose() * inverse;
        let post = p - gain * s * gain.transpose();
        assert!((step.p_post - post).amax() < 1e-9 * p.amax());
        let v = step.innovation.fixed_rows::<3>(0).into_owned();
        assert!((step.correction - gain * v).amax() < 1e-8);
        let nis = (v.transpose() * inverse * v)[0];
        let log_likelihood = -0.5 * (nis + s.determinant().ln() + 3.0 * (2.0 * std::f64::consts::PI).ln());
        assert!((seen.nis / nis - 1.0).abs() < 1e-8, "{} {nis}", seen.nis);
        assert!((step.log_likelihood - log_likelihood).abs() < 1e-8 * log_likelihood.abs().max(1.0));
    }
}
