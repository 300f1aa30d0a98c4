//! Named parts of a run: which epochs belong to which.

use std::borrow::Cow;

use cosim::Value;
use interface::mission::Phase;

use crate::error::StudyError;
use crate::participant::Participant;
use crate::samples::{SAME_TIME, TruthSample};
use crate::world::{Frame, World};

/// How long a push counts after its end, s.
const A_MINUTE: f64 = 60.0;

/// Most phases of a world: a bit each in a record.
const MOST: usize = 32;

/// The phases of one world; the first is the scored time.
#[derive(Debug, Clone, PartialEq)]
pub struct Phases {
    rules: Vec<Phase>,
    scored_from_s: f64,
    burn_ends: Vec<f64>,
    /// How many of these are the mission's own.
    planned: usize,
}

/// Parameters of the target's extra burn.
const BURN_START: &str = "target_burn.start";
const BURN_DURATION: &str = "target_burn.duration";

/// When the target's extra burn ends, s; `None` without one.
///
/// * `value`: of a parameter.
fn extra_burn_end(value: impl Fn(&str) -> f64) -> Option<f64> {
    let duration = value(BURN_DURATION);
    (duration > 0.0).then(|| value(BURN_START) + duration)
}

impl Phases {
    /// The scored time, vents and quiet where the mission has vents, then the mission's and the plan's own.
    ///
    /// * `truth`: whose extra burn of the target counts among the burns.
    ///
    /// # Errors
    /// [`StudyError::Plan`] for a name that stands twice, too many, or vents where nobody knows of them.
    pub fn new(world: &World, truth: &Participant, own: &[Phase]) -> Result<Self, StudyError> {
        let wrong = |problem: String| StudyError::Plan {
            field: "phase",
            problem,
        };
        let [scored, vents, quiet, after_push, calm] = Phase::OWN.map(|name| Phase {
            name: name.to_owned(),
            ..Phase::default()
        });
        let told_of_vents = world.frame == Frame::Inertial;
        let mut rules = vec![scored];
        if told_of_vents && !world.mission.vents.is_empty() {
            rules.extend([(vents, true), (quiet, false)].map(|(phase, acts)| Phase {
                vents: Some(acts),
                ..phase
            }));
            rules.push(Phase {
                pushed_within_s: Some(A_MINUTE),
                ..after_push
            });
            rules.push(Phase {
                calm_for_s: Some(A_MINUTE),
                ..calm
            });
        }
        rules.extend(world.mission.study.phases.iter().chain(own).cloned());
        for (place, phase) in rules.iter().enumerate() {
            if rules[..place].iter().any(|other| other.name == phase.name) {
                let text = format!("'{}' stands twice in {} and the study", phase.name, world.name);
                return Err(wrong(text));
            }
            if phase.vents.is_some() && !told_of_vents {
                let text = format!(
                    "'{}' asks for vents, which are not known in {}, whose frame is lvlh; give times with from_s and to_s",
                    phase.name, world.name
                );
                return Err(wrong(text));
            }
        }
        if rules.len() > MOST {
            return Err(wrong(format!(
                "there are {} in {}; {MOST} are the most",
                rules.len(),
                world.name
            )));
        }
        let set = |name: &str| match truth.start(name) {
            Some(Value::Real(x)) => *x,
            _ => 0.0,
        };
        let mut burn_ends: Vec<f64> = world.mission.burns.iter().map(|b| b.start_s + b.duration_s).collect();
        let planned = burn_ends.len();
        burn_ends.extend(extra_burn_end(set));
        Ok(Self {
            rules,
            scored_from_s: world.scored_from_s,
            burn_ends,
            planned,
        })
    }

    /// The same in one run, where the target's extra burn may be one that each run draws anew.
    ///
    /// * `truth`: as for [`Phases::new`].
    pub fn in_run(&self, truth: &Participant, seed: i32, run: u32) -> Cow<'_, Self> {
        if ![BURN_START, BURN_DURATION].iter().any(|name| truth.varies(name)) {
            return Cow::Borrowed(self);
        }
        let mut own = self.clone();
        own.burn_ends.truncate(self.planned);
        own.burn_ends.extend(extra_burn_end(|name| {
            truth.value_in_run(name, seed, run).unwrap_or(0.0)
        }));
        Cow::Owned(own)
    }

    /// Their conditions, in order.
    pub fn rules(&self) -> &[Phase] {
        &self.rules
    }

    /// Which of them an epoch belongs to: bit k for the k-th.
    pub fn of(&self, truth: &TruthSample) -> u32 {
        let bits = self.rules.iter().enumerate();
        bits.fold(0, |mask, (bit, rule)| mask | u32::from(self.holds(rule, truth)) << bit)
    }

    fn holds(&self, rule: &Phase, truth: &TruthSample) -> bool {
        let time = truth.time;
        let range = truth.position.norm();
        let acts = |wanted: bool| truth.pushed == wanted;
        let pushed = |within: f64| truth.since_push.is_some_and(|since| since <= within + SAME_TIME);
        let after = |length: f64| {
            let since = |end: &f64| (-SAME_TIME..=length + SAME_TIME).contains(&(time - end));
            self.burn_ends.iter().any(since)
        };
        time >= rule.from_s.unwrap_or(self.scored_from_s) - SAME_TIME
            && rule.to_s.is_none_or(|to| time <= to + SAME_TIME)
            && rule.range_from_m.is_none_or(|from| range >= from)
            && rule.range_to_m.is_none_or(|to| range <= to)
            && rule.vents.is_none_or(acts)
            && rule.after_burn_s.is_none_or(after)
            && rule.pushed_within_s.is_none_or(pushed)
            && rule.calm_for_s.is_none_or(|length| !pushed(length))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::StatusItems;
    use crate::variation::Varied;
    use crate::worlds;
    use nalgebra::Vector3;
    use std::sync::Arc;

    fn participant(starts: &[(&str, f64)]) -> Participant {
        #[derive(Debug)]
        struct Nobody;
        impl crate::participant::SlaveSource for Nobody {
            fn create(&self, _: &str) -> Result<Box<dyn cosim::Slave>, StudyError> {
                Err(StudyError::NoWorld)
            }
        }
        Participant {
            label: "fmu-truth".to_owned(),
            model: "fmu-truth".to_owned(),
            source: Arc::new(Nobody),
            aliases: Vec::new(),
            starts: starts.iter().map(|(n, v)| ((*n).to_owned(), Value::Real(*v))).collect(),
            varied: Vec::new(),
            bound: false,
            beside_bounds: false,
            calculated: Vec::new(),
            statuses: StatusItems::default(),
            record: Vec::new(),
        }
    }

    fn phase(text: &str) -> Phase {
        toml::from_str(text).unwrap()
    }

    /// Which epochs of 1 s the phase holds, of a target that vents from 500 to 509 s and goes away by 1 m/s.
    fn epochs(phases: &Phases, name: &str) -> Vec<u32> {
        let bit = phases.rules().iter().position(|r| r.name == name).unwrap();
        let sample = |t: u32| TruthSample {
            time: f64::from(t),
            position: Vector3::new(0.0, f64::from(t), 0.0),
            pushed: (500..510).contains(&t),
            since_push: (t >= 500).then(|| f64::from(t.saturating_sub(510))),
            ..TruthSample::default()
        };
        (1..=1000)
            .filter(|t| phases.of(&sample(*t)) & (1 << bit) != 0)
            .collect()
    }

    #[test]
    fn epochs_are_those_at_which_every_condition_holds() {
        let world = worlds::find("leo_venting").unwrap();
        let own = [
            phase("name = \"begin\"\nfrom_s = 0.0\nto_s = 20.0"),
            phase("name = \"near\"\nrange_to_m = 400.0"),
            phase("name = \"far_vents\"\nrange_from_m = 505.0\nvents = true"),
            phase("name = \"after\"\nafter_burn_s = 5.0"),
        ];
        let burn = participant(&[("target_burn.start", 600.0), ("target_burn.duration", 10.0)]);
        let phases = Phases::new(&world, &burn, &own).unwrap();
        assert_eq!(epochs(&phases, "scored"), (300..=1000).collect::<Vec<_>>());
        assert_eq!(epochs(&phases, "vents"), (500..510).collect::<Vec<_>>());
        assert_eq!(epochs(&phases, "quiet").len(), 691);
        assert_eq!(epochs(&phases, "after_push"), (500..=570).collect::<Vec<_>>());
        assert_eq!(epochs(&phases, "calm").len(), 701 - 71);
        assert_eq!(epochs(&phases, "begin"), (1..=20).collect::<Vec<_>>());
        assert_eq!(epochs(&phases, "near"), (300..=400).collect::<Vec<_>>());
        assert_eq!(epochs(&phases, "far_vents"), (505..510).collect::<Vec<_>>());
        let after = epochs(&phases, "after");
        assert!((610..=615).all(|t| after.contains(&t)) && !after.contains(&609) && !after.contains(&616));
    }

    #[test]
    fn a_burn_that_each_run_draws_anew_ends_when_that_run_has_it() {
        let world = worlds::find("leo_venting").unwrap();
        let mut truth = participant(&[("target_burn.start", 600.0), ("target_burn.duration", 10.0)]);
        truth.varied.push(Varied {
            name: "target_burn.start".to_owned(),
            distribution: "uniform:310:800".parse().unwrap(),
            draw: 0,
        });
        let phases = Phases::new(&world, &truth, &[phase("name = \"after\"\nafter_burn_s = 5.0")]).unwrap();
        let mut firsts = Vec::new();
        for run in 0..4 {
            let (name, start) = truth.drawn(7, run).remove(0);
            assert_eq!(name, "fmu-truth.target_burn.start");
            let after = epochs(&phases.in_run(&truth, 7, run), "after");
            let first = *after.iter().find(|t| **t > 300).unwrap();
            assert!((f64::from(first) - (start + 10.0).ceil()).abs() < 0.5, "run {run}");
            firsts.push(first);
        }
        firsts.dedup();
        assert!(firsts.len() > 1, "{firsts:?}");
    }

    #[test]
    fn what_cannot_be_is_refused() {
        let leo = worlds::find("leo_venting").unwrap();
        let formation = worlds::find("formation").unwrap();
        let truth = participant(&[]);
        let late = phase("name = \"late\"\nfrom_s = 900.0");
        for (world, own, says) in [
            (&leo, vec![late.clone(), late.clone()], "twice"),
            (&formation, vec![phase("name = \"v\"\nvents = true")], "lvlh"),
            (
                &leo,
                (0..40)
                    .map(|i| Phase {
                        name: format!("p{i}"),
                        ..late.clone()
                    })
                    .collect(),
                "32",
            ),
        ] {
            let error = Phases::new(world, &truth, &own).unwrap_err().to_string();
            assert!(error.contains(says), "{error}");
        }
        assert!(Phases::new(&formation, &truth, &[late]).unwrap().rules().len() == 2);
    }
}
