//! A world and filters in plain Rust whose errors are known in closed form.
#![allow(dead_code, reason = "each test binary uses its own part")]

use std::sync::Arc;

use cosim::{BaseType, Causality, Port, Scheme, Slave, SlaveError};
use study::{Axes, Frame, Participant, Phases, SlaveSource, Spec, StatusItems, StudyError, World};

/// 40 samples of 1 s, scored from the eleventh.
pub fn world() -> World {
    World {
        name: "mock".to_owned(),
        about: "a target that stands still".to_owned(),
        reference: "none".to_owned(),
        duration_s: 40.0,
        scored_from_s: 11.0,
        sample_period_s: 1.0,
        frame: Frame::Inertial,
        axes: Axes::Rtn,
        nis_rows: 3,
        filters: Vec::new(),
        // What a mission says of it beyond this is nobody's business here.
        ..study::worlds::find("leo_venting").unwrap()
    }
}

/// Error of the estimate of a sample, the same on position and velocity; R, T, N are the axes x, y, z of this world.
pub fn noise(run: i32, count: i32, axis: usize) -> f64 {
    (f64::from(run * 31 + count * 17) * 12.9898 + axis as f64 * 78.233).sin()
}

/// Seconds up to `until` at which a truth of two rates has sampled.
pub fn two_rates(until: i32) -> Vec<i32> {
    (1..=until).filter(|t| t % 2 == 0 || t % 3 == 0).collect()
}

/// True acceleration of this world, m/s2.
pub fn acceleration(axis: usize) -> f64 {
    1e-5 * (axis + 1) as f64
}

/// Position sigma that the mock filter claims, m.
pub const SIGMA: f64 = 0.5;

/// Where a tunable filter is at its best.
pub const BEST_GAIN: f64 = 2e-3;

/// What a mock does apart from its work.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Quirk {
    None,
    /// A step fails at this time of this run.
    Fails {
        run: i32,
        time: f64,
    },
    /// The estimate of a run is 200 m off, and a step of it fails at this time.
    LostThenFails {
        run: i32,
        time: f64,
    },
    /// Refuses to initialise.
    Refuses,
    /// The estimate of a run turns NaN.
    NotFinite {
        run: i32,
    },
    /// The status of a run says diverged, at sample 5 only.
    SaysDiverged {
        run: i32,
    },
    /// The estimate of a run is 200 m off.
    Lost {
        run: i32,
    },
    /// Offers position and velocity alone, untagged.
    Bare,
    /// Has another name for the velocity.
    NoVelocity,
    /// Tags each estimate with the sample before.
    WrongTag,
    /// The covariance of a run has a NaN above its diagonal, at samples 20 and 21 only.
    BrokenAbove {
        run: i32,
    },
    /// A truth of which an output is NaN in a run, from sample 9 on.
    NotFiniteTruth {
        run: i32,
        name: &'static str,
    },
    /// A truth that takes no further sample in a run.
    Stalls {
        run: i32,
        after: i32,
    },
    /// A truth without an initial estimate.
    NoInitialEstimate,
    /// A truth that samples half a second late.
    OffGrid,
    /// Estimates an acceleration beside six states with a covariance, and says so for odd samples only.
    EstimatesAcceleration,
    /// Its errors grow by the factor of the parameter `factor`.
    Scaled,
    /// The estimate of a run claims a covariance with a negative variance, at sample 20 only.
    BrokenCovariance {
        run: i32,
    },
    /// Has a parameter `gain`; its errors are least where that is `BEST_GAIN`, and `Participant::set_real` sets it.
    Tunable,
    /// A truth whose LiDAR samples every 2 s and whose radio every 3 s, so that some seconds have no sample.
    TwoRates,
    /// Samples of multiples of five hold no measurement; the NIS output keeps a wild value then.
    Drops,
    /// Hears nothing of samples 20 to 24.
    Naps,
    /// A filter whose first position is what its input `truth.r_tc_n[1]` says.
    AsksForTruth,
    /// A truth that moves by its input `a_cmd_c_n[1]`, or a filter with an output of that name.
    Pushes,
    /// A driver that pushes with 50 until a time at which it fails.
    Drives {
        until: f64,
    },
    /// A driver that pushes as far as a filter's first position says.
    Guides,
    /// Offers a covariance of six states and does not say of how many.
    SixBySix,
    /// Offers a covariance without its last element.
    PartialCovariance,
    /// Offers two elements of an acceleration.
    PartialAcceleration,
}

struct Source {
    truth: bool,
    quirk: Quirk,
}

impl SlaveSource for Source {
    fn create(&self, name: &str) -> Result<Box<dyn Slave>, StudyError> {
        Ok(Box::new(Mock::new(name, self.truth, self.quirk)))
    }
}

/// A driver.
pub fn driver(label: &str, quirk: Quirk) -> Participant {
    Participant {
        model: label.to_owned(),
        ..participant(label, false, quirk)
    }
}

/// A participant; its starts are those given to it by the run alone.
fn participant(label: &str, truth: bool, quirk: Quirk) -> Participant {
    Participant {
        label: label.to_owned(),
        model: if truth { "fmu-truth" } else { "fmu-nav" }.to_owned(),
        source: Arc::new(Source { truth, quirk }),
        aliases: Vec::new(),
        starts: Vec::new(),
        varied: Vec::new(),
        bound: false,
        beside_bounds: false,
        calculated: Vec::new(),
        statuses: StatusItems::default(),
        record: Vec::new(),
    }
}

/// A study of these filters in the mock world.
pub fn spec(truth: Quirk, filters: &[(&str, Quirk)]) -> Spec {
    let truth = participant("fmu-truth", true, truth);
    Spec {
        phases: Phases::new(&world(), &truth, &[]).unwrap(),
        world: world(),
        truth,
        filters: filters
            .iter()
            .map(|(label, quirk)| participant(label, false, *quirk))
            .collect(),
        seed: 1,
        step: 1.0,
        sample_period: 1.0,
        scheme: Scheme::GaussSeidel,
        drivers: Vec::new(),
        closed_loop: false,
        allow_truth: false,
    }
}

struct Mock {
    name: String,
    truth: bool,
    quirk: Quirk,
    ports: Vec<Port>,
    reals: Vec<f64>,
    integers: Vec<i32>,
    booleans: Vec<bool>,
    last: i32,
}

impl Mock {
    fn new(name: &str, truth: bool, quirk: Quirk) -> Self {
        let mut mock = Self {
            name: name.to_owned(),
            truth,
            quirk,
            ports: Vec::new(),
            reals: Vec::new(),
            integers: Vec::new(),
            booleans: Vec::new(),
            last: 0,
        };
        if matches!(quirk, Quirk::Drives { .. } | Quirk::Guides) {
            mock.port("a_cmd_c_n[1]", BaseType::Real, Causality::Output);
            if quirk == Quirk::Guides {
                mock.port("est.r_tc_n[1]", BaseType::Real, Causality::Input);
            }
            return mock;
        }
        mock.port("study_seed", BaseType::Integer, Causality::Parameter);
        mock.port("run", BaseType::Integer, Causality::Parameter);
        let sensor = if truth { Causality::Output } else { Causality::Input };
        mock.port("sample_time", BaseType::Real, sensor);
        mock.port("sample_count", BaseType::Integer, sensor);
        mock.port("lidar.valid", BaseType::Boolean, sensor);
        if quirk == Quirk::TwoRates {
            mock.port("radio.valid", BaseType::Boolean, sensor);
        }
        if quirk != Quirk::NoInitialEstimate {
            mock.port("nav_init.x[1]", BaseType::Real, sensor);
        }
        if quirk == Quirk::Pushes {
            let role = if truth { Causality::Input } else { Causality::Output };
            mock.port("a_cmd_c_n[1]", BaseType::Real, role);
        }
        if truth {
            for name in [
                "truth.r_tc_n",
                "truth.v_tc_n",
                "truth.a_t_n",
                "truth.r_c_n",
                "truth.v_c_n",
            ] {
                mock.vector(name);
            }
            return mock;
        }
        if quirk == Quirk::Tunable {
            mock.port("gain", BaseType::Real, Causality::Parameter);
        }
        mock.vector("est.r_tc_n");
        mock.vector(if quirk == Quirk::NoVelocity {
            "their_v"
        } else {
            "est.v_tc_n"
        });
        if quirk == Quirk::EstimatesAcceleration {
            mock.port("est.acceleration_valid", BaseType::Boolean, Causality::Output);
            mock.vector("est.a_t_n");
        }
        if quirk == Quirk::AsksForTruth {
            mock.port("truth.r_tc_n[1]", BaseType::Real, Causality::Input);
        }
        if quirk == Quirk::PartialAcceleration {
            mock.port("est.a_t_n[1]", BaseType::Real, Causality::Output);
            mock.port("est.a_t_n[2]", BaseType::Real, Causality::Output);
        }
        if quirk == Quirk::Scaled {
            mock.port("factor", BaseType::Real, Causality::Parameter);
        }
        if quirk != Quirk::Bare {
            mock.port("est.count", BaseType::Integer, Causality::Output);
            mock.port("est.time", BaseType::Real, Causality::Output);
            if quirk != Quirk::SixBySix {
                mock.port("est.dimension", BaseType::Integer, Causality::Output);
            }
            mock.port("status", BaseType::Integer, Causality::Output);
            mock.port("nis", BaseType::Real, Causality::Output);
            if quirk == Quirk::TwoRates {
                mock.port("nis.rows", BaseType::Integer, Causality::Output);
            }
            let states = if quirk == Quirk::SixBySix { 6 } else { 9 };
            for i in 1..=states {
                for j in 1..=states {
                    if quirk == Quirk::PartialCovariance && (i, j) == (9, 9) {
                        continue;
                    }
                    mock.port(&format!("cov.p[{i},{j}]"), BaseType::Real, Causality::Local);
                }
            }
        }
        mock
    }

    fn port(&mut self, name: &str, kind: BaseType, causality: Causality) {
        let reference = match kind {
            BaseType::Integer => {
                self.integers.push(0);
                self.integers.len() - 1
            }
            BaseType::Boolean => {
                self.booleans.push(false);
                self.booleans.len() - 1
            }
            _ => {
                self.reals.push(0.0);
                self.reals.len() - 1
            }
        };
        self.ports.push(Port::new(name, reference as u32, kind, causality));
    }

    fn vector(&mut self, name: &str) {
        for i in 1..=3 {
            self.port(&format!("{name}[{i}]"), BaseType::Real, Causality::Output);
        }
    }

    fn at(&self, name: &str) -> Option<usize> {
        self.ports.iter().find(|p| p.name == name).map(|p| p.reference as usize)
    }

    fn put(&mut self, name: &str, value: f64) {
        if let Some(at) = self.at(name) {
            self.reals[at] = value;
        }
    }

    fn put_integer(&mut self, name: &str, value: i32) {
        if let Some(at) = self.at(name) {
            self.integers[at] = value;
        }
    }

    fn integer(&self, name: &str) -> i32 {
        self.integers[self.at(name).unwrap()]
    }

    fn step_truth(&mut self, now: f64) {
        let late = if self.quirk == Quirk::OffGrid { 0.5 } else { 0.0 };
        let seconds = (now - late + 1e-9).floor() as i32;
        let count = if self.quirk == Quirk::TwoRates {
            two_rates(seconds).len() as i32
        } else {
            seconds
        };
        let stalled = matches!(self.quirk, Quirk::Stalls { run, after } if run == self.integer("run") && count > after);
        if count > self.integer("sample_count") && !stalled {
            self.put_integer("sample_count", count);
            self.put("sample_time", f64::from(seconds) + late);
            let valid = self.at("lidar.valid").unwrap();
            self.booleans[valid] = self.quirk != Quirk::Drops || count % 5 != 0;
            if let Some(radio) = self.at("radio.valid") {
                self.booleans[valid] = seconds % 2 == 0;
                self.booleans[radio] = seconds % 3 == 0;
            }
        }
        let pushed = self.at("a_cmd_c_n[1]").map_or(0.0, |at| self.reals[at]);
        self.put("truth.r_tc_n[1]", 100.0 + pushed);
        for axis in 0..3 {
            self.put(&format!("truth.a_t_n[{}]", axis + 1), acceleration(axis));
        }
        self.put("truth.r_c_n[1]", 7e6);
        self.put("truth.v_c_n[2]", 7e3);
        if let Quirk::NotFiniteTruth { run, name } = self.quirk
            && run == self.integer("run")
            && count >= 9
        {
            self.put(name, f64::NAN);
        }
    }

    fn step_filter(&mut self) {
        let (run, count) = (self.integer("run"), self.integer("sample_count"));
        if count <= self.last || (self.quirk == Quirk::Naps && (20..=24).contains(&count)) {
            return;
        }
        self.last = count;
        // Twice as large a decade away from the best gain; unset, a gain is zero.
        let of_gain = match self.at("gain").map(|at| self.reals[at]) {
            Some(gain) if gain > 0.0 => 1.0 + (gain / BEST_GAIN).log10().powi(2),
            Some(_) => 3.0,
            None => 1.0,
        };
        let factor = of_gain * self.at("factor").map_or(1.0, |at| self.reals[at]);
        if let Some(at) = self.at("est.acceleration_valid") {
            self.booleans[at] = count % 2 == 1;
        }
        for axis in 0..3 {
            let estimate = acceleration(axis) + 1e-6 * noise(run, count, axis);
            self.put(&format!("est.a_t_n[{}]", axis + 1), estimate);
        }
        for axis in 0..3 {
            let distance = self.at("truth.r_tc_n[1]").map_or(100.0, |at| self.reals[at]);
            let mut position = factor * noise(run, count, axis) + if axis == 0 { distance } else { 0.0 };
            match self.quirk {
                Quirk::NotFinite { run: r } if r == run && count > 7 => position = f64::NAN,
                Quirk::Lost { run: r } | Quirk::LostThenFails { run: r, .. } if r == run => position += 200.0,
                _ => {}
            }
            self.put(&format!("est.r_tc_n[{}]", axis + 1), position);
            for name in ["est.v_tc_n", "their_v"] {
                self.put(&format!("{name}[{}]", axis + 1), factor * noise(run, count, axis));
            }
        }
        let tag = count - i32::from(self.quirk == Quirk::WrongTag);
        self.put_integer("est.count", tag);
        let time = self.reals[self.at("sample_time").unwrap()];
        self.put("est.time", time);
        self.put_integer("est.dimension", 6);
        self.put("a_cmd_c_n[1]", 50.0);
        let diverged = self.quirk == Quirk::SaysDiverged { run } && count == 5;
        self.put_integer("status", if diverged { 4 } else { 2 });
        let measured = self.booleans[self.at("lidar.valid").unwrap()];
        // A filter that knows its radio: one row for each of it and the LiDAR's three, and a NIS of two for each.
        if let (Some(radio), Some(rows)) = (self.at("radio.valid"), self.at("nis.rows")) {
            self.integers[rows] = 3 * i32::from(measured) + i32::from(self.booleans[radio]);
            let nis = 2.0 * f64::from(self.integers[rows]);
            self.put("nis", nis);
        } else {
            self.put("nis", if measured { 6.0 } else { 1e6 });
        }
        for i in 1..=6 {
            self.put(&format!("cov.p[{i},{i}]"), SIGMA * SIGMA);
        }
        if self.quirk == (Quirk::BrokenCovariance { run }) && count == 20 {
            self.put("cov.p[2,2]", -1.0);
        }
        if self.quirk == (Quirk::BrokenAbove { run }) {
            let above = if (20..=21).contains(&count) { f64::NAN } else { 0.0 };
            self.put("cov.p[1,4]", above);
        }
    }
}

impl Slave for Mock {
    fn name(&self) -> &str {
        &self.name
    }

    fn ports(&self) -> Vec<Port> {
        self.ports.clone()
    }

    fn enter_initialization(&mut self) -> Result<(), SlaveError> {
        if self.quirk == Quirk::Refuses {
            Err(SlaveError::new("enter_initialization", "no such world"))
        } else {
            Ok(())
        }
    }

    fn do_step(&mut self, t: f64, h: f64) -> Result<(), SlaveError> {
        if let Quirk::Fails { run, time } | Quirk::LostThenFails { run, time } = self.quirk
            && run == self.integer("run")
            && t + h >= time - 1e-9
        {
            return Err(SlaveError::new("do_step", "out of cheese"));
        }
        if let Quirk::Drives { until } = self.quirk {
            self.put("a_cmd_c_n[1]", 50.0);
            if t + h > until {
                return Err(SlaveError::new("do_step", "out of fuel"));
            }
        } else if self.quirk == Quirk::Guides {
            let seen = self.at("est.r_tc_n[1]").map_or(0.0, |at| self.reals[at]);
            self.put("a_cmd_c_n[1]", seen);
        } else if self.truth {
            self.step_truth(t + h);
        } else {
            self.step_filter();
        }
        Ok(())
    }

    fn get_real(&mut self, references: &[u32], values: &mut [f64]) -> Result<(), SlaveError> {
        references
            .iter()
            .zip(values)
            .for_each(|(r, v)| *v = self.reals[*r as usize]);
        Ok(())
    }

    fn set_real(&mut self, references: &[u32], values: &[f64]) -> Result<(), SlaveError> {
        references
            .iter()
            .zip(values)
            .for_each(|(r, v)| self.reals[*r as usize] = *v);
        Ok(())
    }

    fn get_integer(&mut self, references: &[u32], values: &mut [i32]) -> Result<(), SlaveError> {
        references
            .iter()
            .zip(values)
            .for_each(|(r, v)| *v = self.integers[*r as usize]);
        Ok(())
    }

    fn set_integer(&mut self, references: &[u32], values: &[i32]) -> Result<(), SlaveError> {
        references
            .iter()
            .zip(values)
            .for_each(|(r, v)| self.integers[*r as usize] = *v);
        Ok(())
    }

    fn get_boolean(&mut self, references: &[u32], values: &mut [bool]) -> Result<(), SlaveError> {
        references
            .iter()
            .zip(values)
            .for_each(|(r, v)| *v = self.booleans[*r as usize]);
        Ok(())
    }

    fn set_boolean(&mut self, references: &[u32], values: &[bool]) -> Result<(), SlaveError> {
        references
            .iter()
            .zip(values)
            .for_each(|(r, v)| self.booleans[*r as usize] = *v);
        Ok(())
    }
}
