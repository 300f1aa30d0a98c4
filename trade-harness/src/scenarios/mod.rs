//! The worlds a study can run in, seen from the harness: how long, which variables are compared in which axes, and what
//! counts as reproducing the source.
//!
//! A scenario is one file here and one line in [`SCENARIOS`]; the FMUs' `scenario` enumeration has the item of its name.

mod formation;
mod leo_venting;
mod nrho_venting;

use nalgebra::{Matrix3, Vector3};

pub(crate) use formation::SCENARIO as FORMATION;
pub(crate) use leo_venting::SCENARIO as LEO_VENTING;
pub(crate) use nrho_venting::SCENARIO as NRHO_VENTING;

use crate::HarnessError;
use crate::bound::Bound;
use crate::signals::TruthSample;

/// Every scenario, in the order lists show them.
pub const SCENARIOS: &[Scenario] = &[LEO_VENTING, NRHO_VENTING, FORMATION];

/// One world.
#[derive(Debug, Clone)]
pub struct Scenario {
    /// Name, as in the FMUs' `scenario` enumeration.
    pub name: &'static str,
    /// What happens in it, in one sentence.
    pub about: &'static str,
    /// What it reproduces.
    pub reference: &'static str,
    /// Length of a run, s.
    pub duration: f64,
    /// Start of the time that statistics are taken over, s.
    pub scored_from: f64,
    /// Which variables are compared, in which axes.
    pub signals: Signals,
    /// Filters of fmu-nav that are compared unless others are asked for, as `--filters` takes them.
    pub filters: &'static [&'static str],
    /// What the reproduction is held to.
    pub claims: &'static [Claim],
}

/// Names of the variables that are compared, and the axes results are given in.
#[derive(Debug, Clone)]
pub struct Signals {
    /// Relative position, m. Required of truth and filter.
    pub position: Signal,
    /// Relative velocity, m/s. Required of truth and filter.
    pub velocity: Signal,
    /// Unmodelled acceleration, m/s2.
    pub acceleration: Signal,
    /// Accelerometer bias, m/s2, in chaser body axes.
    pub bias: Option<Signal>,
    /// Position and velocity of the chaser, where the axes of the results depend on them. Required of the truth.
    pub chaser: Option<[&'static str; 2]>,
    /// Boolean of the truth that is false for a dropped sample.
    pub measurement_valid: &'static str,
    /// Innovation of the filter, three rows at a time.
    pub residual: [Option<Residual>; 2],
    /// Rows of the measurement that `nis` is taken over.
    pub nis_rows: u32,
    /// Names of the axes results are given in.
    pub axes: [&'static str; 3],
    /// Matrix that turns the truth's axes into those of the results; `None` where they are undefined.
    pub report_axes: fn(&TruthSample) -> Option<Matrix3<f64>>,
}

/// Three rows of an innovation.
#[derive(Debug, Clone, Copy)]
pub struct Residual {
    /// Names of the filter's variables.
    pub names: [&'static str; 3],
    /// Unit suffixes for column names.
    pub units: [&'static str; 3],
    /// Name of the vector of their predicted variances.
    pub variance: &'static str,
}

impl Residual {
    /// Names for columns, without unit.
    pub fn columns(&self) -> [String; 3] {
        self.names.map(|name| name.replace(['.', '['], "_").replace(']', ""))
    }
}

/// A 3-vector that both the truth and the filter offer; elements are `name[1]`..`name[3]`.
#[derive(Debug, Clone)]
pub struct Signal {
    /// Name in the truth.
    pub truth: &'static str,
    /// Name in the filter.
    pub estimate: &'static str,
}

/// What a source says of one column of `summary.csv`.
#[derive(Debug)]
pub struct Claim {
    /// Filter label, as given to `--filters`.
    pub filter: &'static str,
    /// Column of `summary.csv`.
    pub column: &'static str,
    /// What the number is held to.
    pub bound: Bound,
    /// The claim in words.
    pub text: &'static str,
}

/// What the venting worlds have in common: range and angles to a target, results in RTN.
const VENTING_SIGNALS: Signals = Signals {
    position: Signal {
        truth: "truth.r_tc_n",
        estimate: "est.r_tc_n",
    },
    velocity: Signal {
        truth: "truth.v_tc_n",
        estimate: "est.v_tc_n",
    },
    acceleration: Signal {
        truth: "truth.a_t_n",
        estimate: "est.a_t_n",
    },
    bias: Some(Signal {
        truth: "truth.b_c_bc",
        estimate: "est.b_c_bc",
    }),
    chaser: Some(["truth.r_c_n", "truth.v_c_n"]),
    measurement_valid: "lidar.valid",
    residual: [
        Some(Residual {
            names: ["innov.range", "innov.azimuth", "innov.elevation"],
            units: ["m", "rad", "rad"],
            variance: "innov.s",
        }),
        None,
    ],
    nis_rows: 3,
    axes: ["r", "t", "n"],
    report_axes: target_rtn,
};

/// Filters compared in the venting worlds.
const VENTING_FILTERS: &[&str] = &[
    "fixed_q",
    "fixed_q@small",
    "milton",
    "milton@consistent",
    "constrained_q",
];

/// What the MILTON paper claims of each of its scenarios, as bounds.
///
/// * `overlay`, `over_estimated`, `inside`, `unbiased`: the claims in words, with the figures of that scenario.
const fn milton_claims(
    overlay: &'static str,
    over_estimated: &'static str,
    inside: &'static str,
    unbiased: &'static str,
) -> [Claim; 15] {
    const fn milton(column: &'static str, low: f64, high: f64, text: &'static str) -> Claim {
        Claim {
            filter: "milton",
            column,
            bound: Bound::between(low, high),
            text,
        }
    }
    const ANY: f64 = f64::INFINITY;
    [
        milton("ratio_pos_r", 0.95, 1.2, overlay),
        milton("ratio_pos_t", 0.95, 1.2, overlay),
        milton("ratio_pos_n", 0.95, 1.2, overlay),
        milton("ratio_vel_r", 1.2, ANY, over_estimated),
        milton("ratio_vel_t", 1.2, ANY, over_estimated),
        milton("ratio_vel_n", 1.2, ANY, over_estimated),
        milton("ratio_acc_r", 1.2, ANY, over_estimated),
        milton("ratio_acc_t", 1.2, ANY, over_estimated),
        milton("ratio_acc_n", 1.2, ANY, over_estimated),
        milton("coverage_3s_pos", 0.99, 1.0, inside),
        milton("coverage_3s_vel", 0.99, 1.0, inside),
        milton("coverage_3s_acc", 0.99, 1.0, inside),
        milton("mean_err_sigma", 0.0, 1.2, unbiased),
        milton("diverged", 0.0, 0.0, "no run diverges"),
        milton("failed", 0.0, 0.0, "no run fails"),
    ]
}

/// The scenario of this name.
///
/// # Errors
/// [`HarnessError::UnknownScenario`], with the names that exist.
pub fn find(name: &str) -> Result<&'static Scenario, HarnessError> {
    SCENARIOS
        .iter()
        .find(|s| s.name == name)
        .ok_or_else(|| HarnessError::UnknownScenario {
            name: name.to_owned(),
            known: SCENARIOS.iter().map(|s| s.name).collect::<Vec<_>>().join(", "),
        })
}

/// The scenarios of these names, in the order given.
///
/// # Errors
/// [`HarnessError::UnknownScenario`], [`HarnessError::ScenarioTwice`].
pub fn find_all(names: &[String]) -> Result<Vec<&'static Scenario>, HarnessError> {
    let mut found: Vec<&Scenario> = Vec::with_capacity(names.len());
    for name in names {
        if found.iter().any(|s| s.name == *name) {
            return Err(HarnessError::ScenarioTwice { name: name.clone() });
        }
        found.push(find(name)?);
    }
    Ok(found)
}

/// Rows R, T, N of the target's orbit: R along its position, N along its angular momentum, T completes.
///
/// Position and velocity of the target are those of the chaser plus the relative ones, in inertial axes about the
/// central body. `None` without the chaser's state or where position and velocity are parallel.
pub fn target_rtn(truth: &TruthSample) -> Option<Matrix3<f64>> {
    let (r_t, v_t) = target(truth)?;
    rtn(&r_t, &v_t)
}

/// Position and velocity of the target; `None` without the chaser's.
fn target(truth: &TruthSample) -> Option<(Vector3<f64>, Vector3<f64>)> {
    let (r_c, v_c) = truth.chaser?;
    Some((r_c + truth.position, v_c + truth.velocity))
}

fn rtn(r: &Vector3<f64>, v: &Vector3<f64>) -> Option<Matrix3<f64>> {
    let radial = r.try_normalize(0.0)?;
    let normal = r.cross(v).try_normalize(0.0)?;
    let transverse = normal.cross(&radial);
    Some(Matrix3::from_rows(&[
        radial.transpose(),
        transverse.transpose(),
        normal.transpose(),
    ]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_scenario_is_found_by_its_name_and_scores_something() {
        for scenario in SCENARIOS {
            assert_eq!(find(scenario.name).unwrap().name, scenario.name);
            assert!(scenario.scored_from < scenario.duration, "{}", scenario.name);
            assert!(!scenario.filters.is_empty(), "{}", scenario.name);
            for filter in scenario.filters {
                assert!(filter.parse::<crate::models::FilterChoice>().is_ok(), "{filter}");
            }
            for claim in scenario.claims {
                let Claim { bound, column, .. } = claim;
                assert!(bound.low <= bound.high, "{}: {column}", scenario.name);
                assert!(crate::report::summary::COLUMNS.contains(column), "{column}");
            }
        }
        let error = find("leo_vent").unwrap_err().to_string();
        assert!(error.contains("leo_vent") && error.contains("leo_venting"), "{error}");
    }

    /// A target on the x axis that moves along y and a bit outwards: R = x, T = y, N = z.
    #[test]
    fn rtn_of_a_case_worked_by_hand() {
        let mut truth = TruthSample {
            position: Vector3::new(1.0, 0.0, 0.0),
            velocity: Vector3::new(0.0, 1.0, 0.0),
            chaser: Some((Vector3::new(6.0, 0.0, 0.0), Vector3::new(0.5, 2.0, 0.0))),
            ..TruthSample::default()
        };
        assert!((target_rtn(&truth).unwrap() - Matrix3::identity()).amax() < 1e-15);
        truth.velocity = Vector3::new(0.0, -2.0, 0.0);
        assert!(target_rtn(&truth).is_none());
        truth.chaser = None;
        assert!(target_rtn(&truth).is_none());
    }
}
