//! The table at the end of a study.

use study::Summary;

use super::column::{Column, find};
use super::summary::COLUMNS;
use super::timing::TimingRow;
use crate::format::{number, plain_table};

/// How to read the columns, below each table.
pub const LEGEND: &str = "\
NEES: 1 on average when consistent, above when the filter claims too little
error; NEES6: of position and velocity alone, which all filters share; runs that
failed or diverged. More columns: --wide, and summary.csv";

/// The same, below the wide table.
pub const WIDE_LEGEND: &str = "\
ratio: sigma the filter claims / sigma of its errors (1 honest, above 1 too modest, below 1 overconfident)
mean err: mean error over its sampling noise (about 1 when unbiased); NEES, NIS: 1 on average when consistent
nav: time in the filter's fmi2DoStep; FMI: share of the time of truth and filter spent on the interface, not the models";

/// Headings and the columns of `summary.csv` below them; they fit 80 columns.
const SHOWN: [(&str, &str); 8] = [
    ("filter", "filter"),
    ("pos RMSE\n[m]", "pos_rmse_m"),
    ("vel RMSE\n[m/s]", "vel_rmse_m_s"),
    ("acc RMSE\n[m/s2]", "acc_rmse_m_s2"),
    ("NEES", "nees"),
    ("NEES6", "nees6"),
    ("failed", "failed"),
    ("diver-\nged", "diverged"),
];

/// The same of the wide table.
const WIDE: [(&str, &str); 14] = [
    ("filter", "filter"),
    ("pos RMSE\n[m]", "pos_rmse_m"),
    ("vel RMSE\n[m/s]", "vel_rmse_m_s"),
    ("acc RMSE\n[m/s2]", "acc_rmse_m_s2"),
    ("ratio\npos", "ratio_pos"),
    ("ratio\nvel", "ratio_vel"),
    ("ratio\nacc", "ratio_acc"),
    ("mean err\n[sigma]", "mean_err_sigma"),
    ("NEES\nmean", "nees"),
    ("NEES6", "nees6"),
    ("NEES\nmedian", "nees_median"),
    ("NIS", "nis"),
    ("failed", "failed"),
    ("diverged", "diverged"),
];

/// What is said below a table of each filter that did not answer every sample, or not with a covariance.
pub fn missing(rows: &[Summary]) -> impl Iterator<Item = String> {
    rows.iter().flat_map(|row| {
        let (filter, epochs, broken) = (&row.filter, row.missing_epochs, row.covariances_broken);
        let silent = (epochs > 0)
            .then(|| format!("! {filter} did not answer {epochs} samples of its runs: stale, or passed by"));
        let broken = (broken > 0).then(|| {
            format!(
                "! {filter} has no covariance at {broken} samples: not symmetric, not positive definite or not finite; its NEES is of the others"
            )
        });
        [silent, broken].into_iter().flatten()
    })
}

/// A cell as tables show it: a NEES that leaves samples out is marked.
fn shown(column: &Column<Summary>, row: &Summary) -> String {
    let text = column.cell(row).short();
    let of_covariance = ["nees", "nees6", "nees_median"].contains(&column.name);
    if of_covariance && row.covariances_broken > 0 {
        text + " !"
    } else {
        text
    }
}

/// Headings of what a filter cost.
const COST: [&str; 2] = ["nav\n[us/step]", "FMI\n[%]"];

/// Longest name of a filter in a table that fits 80 columns.
const LONGEST: usize = 19;

/// The table of one world, without a final newline; it fits 80 columns.
pub fn render(rows: &[Summary]) -> String {
    let cells = bounds_last(rows).map(|row| {
        let shown = SHOWN.iter().filter_map(|(_, name)| find(COLUMNS, name));
        let mut cells: Vec<String> = shown.map(|c| self::shown(c, row)).collect();
        if let Some(label) = cells.first_mut() {
            *label = marked(shortened(label, LONGEST - BOUND.len()), row);
        }
        cells
    });
    plain_table(SHOWN.iter().map(|(heading, _)| *heading), 1, cells) + legend_of_bounds(rows)
}

/// Filters, then what is none.
fn bounds_last(rows: &[Summary]) -> impl Iterator<Item = &Summary> {
    let (bounds, filters): (Vec<&Summary>, Vec<&Summary>) = rows.iter().partition(|row| row.bound);
    filters.into_iter().chain(bounds)
}

/// After the label of a bound.
const BOUND: &str = " *";

/// What it means, below a table that has one.
const BOUND_LEGEND: &str = "\n* bound, told by the truth what no filter knows: it has no place among them";

/// The label of a row as tables show it.
fn marked(label: String, row: &Summary) -> String {
    if row.bound { label + BOUND } else { label }
}

fn legend_of_bounds(rows: &[Summary]) -> &'static str {
    if rows.iter().any(|row| row.bound) {
        BOUND_LEGEND
    } else {
        ""
    }
}

/// A label without its middle, where it has more letters than this.
pub(super) fn shortened(label: &str, longest: usize) -> String {
    let letters: Vec<char> = label.chars().collect();
    if letters.len() <= longest {
        return label.to_owned();
    }
    let (begin, end) = (longest / 2, letters.len() - (longest - longest / 2 - 1));
    letters[..begin].iter().chain(&['…']).chain(&letters[end..]).collect()
}

/// The table with all columns.
pub fn render_wide(rows: &[Summary], timings: &[TimingRow]) -> String {
    let cells = bounds_last(rows).map(|row| {
        let same = |t: &&TimingRow| t.scenario == row.scenario && t.filter == row.filter && t.case == row.case;
        let timing = timings.iter().find(same);
        let shown = WIDE.iter().filter_map(|(_, name)| find(COLUMNS, name));
        let mut cells: Vec<String> = shown.map(|c| self::shown(c, row)).collect();
        if let Some(label) = cells.first_mut() {
            *label = marked(std::mem::take(label), row);
        }
        cells.push(number(timing.map(|t| t.nav_us_per_step)));
        cells.push(timing.map_or_else(|| number(None), |t| format!("{:.1}", 100.0 * t.fmi_share)));
        cells
    });
    plain_table(WIDE.iter().map(|(heading, _)| *heading).chain(COST), 1, cells) + legend_of_bounds(rows)
}

/// RMSE, ratio of sigmas on each axis, and coverage of each quantity of one world, without a final newline.
///
/// * `axes`: names of the axes of the results.
pub fn render_axes(rows: &[Summary], axes: [&str; 3]) -> String {
    let mut table = Vec::new();
    let mut header = vec!["filter".to_owned(), "RMSE of".to_owned()];
    header.extend(axes.map(|axis| format!("{axis}\n")));
    header.push("standard error\nof the norm".to_owned());
    header.extend(axes.map(|axis| format!("ratio\n{axis}")));
    header.push("inside\n3 sigma [%]".to_owned());
    for row in bounds_last(rows) {
        for (name, errors) in [
            ("pos [m]", &row.position),
            ("vel [m/s]", &row.velocity),
            ("acc [m/s2]", &row.acceleration),
        ] {
            let mut cells = vec![marked(row.filter.clone(), row), name.to_owned()];
            cells.extend(errors.rmse_axes.map(number));
            cells.push(number(errors.rmse_error));
            cells.extend(errors.ratio_axes.map(number));
            let inside = errors.coverage.map(|share| format!("{:.2}", 100.0 * share));
            cells.push(inside.unwrap_or_else(|| number(None)));
            table.push(cells);
        }
    }
    plain_table(header, 2, table) + legend_of_bounds(rows)
}

#[cfg(test)]
mod tests {
    use super::*;
    use study::{QuantitySummary, ScalarSummary};

    fn errors(rmse: Option<f64>, ratio: Option<f64>) -> QuantitySummary {
        QuantitySummary {
            rmse,
            ratio,
            ..QuantitySummary::default()
        }
    }

    fn row(filter: &str, acceleration: Option<f64>) -> Summary {
        Summary {
            scenario: "leo_venting".to_owned(),
            filter: filter.to_owned(),
            case: "nominal".to_owned(),
            runs: 100,
            failed: 0,
            diverged: 2,
            position: errors(Some(1.23456), Some(1.05)),
            velocity: errors(Some(0.0123456), Some(17.5)),
            acceleration: errors(acceleration, acceleration.map(|_| 123.4)),
            mean_error_sigma: Some(0.98),
            nees: ScalarSummary {
                mean: Some(0.0),
                median: Some(123_456.0),
                ..ScalarSummary::default()
            },
            ..Summary::default()
        }
    }

    #[test]
    fn every_column_shown_exists() {
        assert!(SHOWN.iter().chain(&WIDE).all(|(_, name)| find(COLUMNS, name).is_some()));
    }

    #[test]
    fn the_table_fits_a_terminal_of_80_columns_whatever_the_filter_is_called() {
        let mut wide = row("constrained_q@full-tuned-once-more", Some(1.234e-5));
        (wide.failed, wide.diverged) = (10_000, 10_000);
        (wide.nees.mean, wide.nis.mean) = (Some(1234.0), Some(0.9876));
        let text = render(&[row("milton", Some(4.2e-5)), wide]);
        assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
        assert!(text.contains('…'), "{text}");
        assert!(LEGEND.lines().all(|line| line.chars().count() <= 80));
    }

    #[test]
    fn bounds_stand_below_the_filters_and_are_marked() {
        let told = Summary {
            bound: true,
            ..row("clairvoyant", None)
        };
        for text in [
            render(&[told.clone(), row("snc", None)]),
            render_wide(&[told.clone(), row("snc", None)], &[]),
            render_axes(&[told.clone(), row("snc", None)], ["x", "y", "z"]),
        ] {
            let [snc, bound] = ["snc", "clairvoyant *"].map(|label| text.find(label));
            assert!(snc.is_some() && snc < bound, "{text}");
            assert!(text.ends_with(BOUND_LEGEND) && BOUND_LEGEND.len() <= 81);
        }
        assert!(!render(&[row("snc", None)]).contains('*'));
    }

    #[test]
    fn samples_that_went_unanswered_are_said_and_nothing_where_none_did() {
        let mut silent = row("snc", None);
        silent.missing_epochs = 12;
        silent.covariances_broken = 3;
        let said: Vec<String> = missing(&[row("milton", None), silent]).collect();
        assert_eq!(
            said,
            [
                "! snc did not answer 12 samples of its runs: stale, or passed by",
                "! snc has no covariance at 3 samples: not symmetric, not positive definite or not finite; its NEES is of the others",
            ]
        );
        let mut broken = row("snc", None);
        broken.nees.mean = Some(0.9);
        assert!(!render(&[broken.clone()]).contains('!'));
        broken.covariances_broken = 1;
        assert!(render(&[broken.clone()]).contains("0.9000 !") && render_wide(&[broken], &[]).contains("0.9000 !"));
    }

    #[test]
    fn snapshot_of_the_table() {
        let timing = TimingRow {
            scenario: "leo_venting".to_owned(),
            filter: "milton".to_owned(),
            case: "nominal".to_owned(),
            nav_us_per_step: 12.345,
            truth_us_per_step: 0.0,
            fmi_exchange_us_per_step: 0.0,
            fmi_call_us: 0.0,
            fmi_share: 0.1234,
            steps: 1,
        };
        let text = render_wide(&[row("milton", Some(4.2e-5)), row("snc", None)], &[timing]);
        let expected = include_str!("table_snapshot.txt");
        assert_eq!(text, expected.trim_end_matches('\n'), "\n{text}");
    }

    /// Cells of the last columns stand under the right heads.
    #[test]
    fn axes_of_a_filter_with_and_without_a_covariance() {
        let mut full = row("milton", None);
        full.position.rmse_axes[1] = Some(0.25);
        full.position.ratio_axes[2] = Some(1.06);
        full.position.coverage = Some(0.99829);
        full.velocity.rmse_error = Some(0.0125);
        let text = render_axes(&[full], ["x", "y", "z"]);
        let cells = |line: usize| text.lines().nth(line).unwrap().split_whitespace().collect::<Vec<_>>();
        let [position, velocity] = [4, 5].map(|line| cells(line)[3..].to_vec());
        assert_eq!(
            position,
            ["-", "0.2500", "-", "-", "-", "-", "1.060", "99.83"],
            "{text}"
        );
        assert_eq!(velocity, ["-", "-", "-", "0.01250", "-", "-", "-", "-"], "{text}");
    }
}
