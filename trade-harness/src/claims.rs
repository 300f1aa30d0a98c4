//! What the papers claim of the columns of `summary.csv` in their own worlds, and whether a study bears it out.

use std::fmt::Write;

use study::Summary;

use crate::bound::Bound;
use crate::format::number;
use crate::report::summary::value;

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

/// A claim, and the number that was held to its bound.
#[derive(Debug, Clone, Copy)]
pub struct Verdict<'a> {
    /// The claim.
    pub claim: &'a Claim,
    /// The number; `None` where the study has none.
    pub value: Option<f64>,
    /// Runs with a result.
    pub runs: usize,
}

impl Verdict<'_> {
    /// Whether the number is within the bound; open where the runs are too few for such a number. With no run at all the
    /// claim is missed.
    pub fn holds(&self) -> Option<bool> {
        let open = self.value.is_none() && self.runs > 0;
        (!open).then(|| self.claim.bound.holds(self.value))
    }
}

/// What is claimed of the world of this name, as its FMUs publish it; nothing of most.
pub fn of(world: &str) -> &'static [Claim] {
    match world {
        "leo_venting" => &LOW_ORBIT,
        "nrho_venting" => &HALO_ORBIT,
        // What its source prints of the formation is compared by `reproduce`, which runs that world in several ways.
        _ => &[],
    }
}

/// Every claim of a world whose filter is part of the study.
pub fn verdicts(world: &str, rows: &[Summary]) -> Vec<Verdict<'static>> {
    let judge = |claim: &'static Claim| {
        let row = rows.iter().find(|r| r.scenario == world && r.filter == claim.filter)?;
        Some(Verdict {
            claim,
            value: value(row, claim.column),
            runs: usize::try_from(row.runs).unwrap_or_default().saturating_sub(row.failed),
        })
    };
    of(world).iter().filter_map(judge).collect()
}

/// One line for each claim, without a final newline.
pub fn render(verdicts: &[Verdict<'_>]) -> String {
    let mut text = String::new();
    for verdict in verdicts {
        let claim = verdict.claim;
        let word = match verdict.holds() {
            Some(true) => "holds ",
            Some(false) => "MISSED",
            None => "open  ",
        };
        let value = if verdict.holds().is_none() {
            let plural = if verdict.runs == 1 { "" } else { "s" };
            format!("not known from {} run{plural}", verdict.runs)
        } else {
            number(verdict.value)
        };
        if !text.is_empty() {
            text.push('\n');
        }
        // Writing to a String cannot fail.
        let _ = write!(
            text,
            "{word}  {} {} = {value} (bound: {}): {}",
            claim.filter,
            claim.column,
            claim.bound.words(|end| end.to_string()),
            claim.text
        );
    }
    text
}

static LOW_ORBIT: [Claim; 15] = milton_claims(
    "estimated and sample 3 sigma of relative position nearly overlay (Fig. 1)",
    "velocity and acceleration are over-estimated (Figs. 2 and 3)",
    "the runs stay inside the estimated 3 sigma (Figs. 1-3)",
    "the mean error is zero within its sampling noise (Figs. 1-3)",
);

static HALO_ORBIT: [Claim; 15] = milton_claims(
    "estimated and sample 3 sigma of relative position nearly overlay (Fig. 8)",
    "velocity and acceleration are over-estimated, though less than in low Earth orbit (Figs. 9 and 10)",
    "the runs stay inside the estimated 3 sigma (Figs. 8-10)",
    "the mean error is zero within its sampling noise (Figs. 8-10)",
);

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
        milton("mean_err_sigma_about_zero", 0.0, 1.2, unbiased),
        milton("diverged", 0.0, 0.0, "no run diverges"),
        milton("failed", 0.0, 0.0, "no run fails"),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::summary::COLUMNS;
    use study::worlds;

    #[test]
    fn every_claim_is_about_a_column_and_a_world_that_exist() {
        for world in ["leo_venting", "nrho_venting"] {
            assert!(worlds::find(world).is_ok());
            assert_eq!(of(world).len(), 15);
            for Claim { bound, column, .. } in of(world) {
                assert!(bound.low <= bound.high, "{world}: {column}");
                assert!(COLUMNS.iter().any(|c| c.name == *column), "{column}");
            }
        }
        assert!(of("formation").is_empty());
    }

    #[test]
    fn claims_say_what_was_held_to_what() {
        let near = Claim {
            filter: "milton",
            column: "ratio_pos",
            bound: Bound::between(0.95, 1.2),
            text: "overlay",
        };
        let above = Claim {
            filter: "milton",
            column: "ratio_vel",
            bound: Bound::between(1.2, f64::INFINITY),
            text: "modest",
        };
        let none = Claim {
            filter: "milton",
            column: "diverged",
            bound: Bound::between(0.0, 0.0),
            text: "stays",
        };
        let verdict = |claim, value, runs| Verdict { claim, value, runs };
        let text = render(&[
            verdict(&near, Some(1.05), 9),
            verdict(&above, Some(1.1), 9),
            verdict(&near, None, 2),
            verdict(&none, None, 0),
        ]);
        assert_eq!(
            text,
            "holds   milton ratio_pos = 1.050 (bound: 0.95 to 1.2): overlay\n\
             MISSED  milton ratio_vel = 1.100 (bound: at least 1.2): modest\n\
             open    milton ratio_pos = not known from 2 runs (bound: 0.95 to 1.2): overlay\n\
             MISSED  milton diverged = - (bound: exactly 0): stays"
        );
    }
}
