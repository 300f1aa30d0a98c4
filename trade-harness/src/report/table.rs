//! The table at the end of a study.

use std::fmt::Write;

use comfy_table::{CellAlignment, LineStyle, Table, TableStyle};

use super::claims::Verdict;
use super::summary::SummaryRow;
use super::timing::TimingRow;

/// How to read the columns, below each table.
pub const LEGEND: &str = "\
ratio: sigma the filter claims / sigma of its errors (1 honest, above 1 too modest, below 1 overconfident)
mean err: mean error over its sampling noise (about 1 when unbiased); NEES, NIS: 1 on average when consistent
nav: time in the filter's fmi2DoStep; FMI: share of the time of truth and filter spent on the interface, not the models";

const HEADERS: [&str; 15] = [
    "filter",
    "pos RMSE\n[m]",
    "vel RMSE\n[m/s]",
    "acc RMSE\n[m/s2]",
    "ratio\npos",
    "ratio\nvel",
    "ratio\nacc",
    "mean err\n[sigma]",
    "NEES\nmean",
    "NEES\nmedian",
    "NIS",
    "failed",
    "diverged",
    "nav\n[us/step]",
    "FMI\n[%]",
];

/// Four significant digits; a dash for what is absent.
pub fn number(value: Option<f64>) -> String {
    let Some(v) = value else { return "-".to_owned() };
    let magnitude = v.abs();
    if magnitude == 0.0 {
        "0".to_owned()
    } else if (1e-2..1e5).contains(&magnitude) {
        let digits = (3.0 - magnitude.log10().floor()).max(0.0) as usize;
        format!("{v:.digits$}")
    } else {
        format!("{v:.3e}")
    }
}

/// The table of one scenario, without a final newline.
pub fn render(rows: &[SummaryRow], timings: &[TimingRow]) -> String {
    let cells = rows.iter().map(|row| {
        let same = |t: &&TimingRow| t.scenario == row.scenario && t.filter == row.filter && t.case == row.case;
        let timing = timings.iter().find(same);
        vec![
            row.filter.clone(),
            number(row.pos_rmse_m),
            number(row.vel_rmse_m_s),
            number(row.acc_rmse_m_s2),
            number(row.ratio_pos),
            number(row.ratio_vel),
            number(row.ratio_acc),
            number(row.mean_err_sigma),
            number(row.nees),
            number(row.nees_median),
            number(row.nis),
            row.failed.to_string(),
            row.diverged.to_string(),
            number(timing.map(|t| t.nav_us_per_step)),
            timing.map_or_else(|| number(None), |t| format!("{:.1}", 100.0 * t.fmi_share)),
        ]
    });
    plain_table(HEADERS, 1, cells)
}

/// A table with rules above, below and under the header; columns after the first `left` are aligned to the right. Without a
/// final newline.
pub(super) fn plain_table<H: Into<comfy_table::Cell>>(
    headers: impl IntoIterator<Item = H>,
    left: usize,
    rows: impl IntoIterator<Item = Vec<String>>,
) -> String {
    let rule = LineStyle::none().fill('─').junction('─');
    let mut table = Table::new();
    table.load_style(
        TableStyle::new()
            .top_border(rule)
            .header_separator(rule)
            .bottom_border(rule),
    );
    table.set_header(headers.into_iter().collect::<Vec<_>>());
    table.add_rows(rows);
    for (index, column) in table.column_iter_mut().enumerate() {
        column.set_padding((0, 1));
        if index >= left {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    table
        .lines()
        .map(|line| line.trim_end().to_owned())
        .collect::<Vec<_>>()
        .join("\n")
}

/// RMSE, ratio of sigmas on each axis, and coverage of each quantity of one scenario, without a final newline.
///
/// * `axes`: names of the axes of the results.
pub fn render_axes(rows: &[SummaryRow], axes: [&str; 3]) -> String {
    let mut table = Vec::new();
    let mut header = vec!["filter".to_owned(), "RMSE of".to_owned()];
    header.extend(axes.map(|axis| format!("{axis}\n")));
    header.push("standard error\nof the norm".to_owned());
    header.extend(axes.map(|axis| format!("ratio\n{axis}")));
    header.push("inside\n3 sigma [%]".to_owned());
    for row in rows {
        for (name, prefix, unit) in [
            ("pos [m]", "pos", "m"),
            ("vel [m/s]", "vel", "m_s"),
            ("acc [m/s2]", "acc", "m_s2"),
        ] {
            let column = |name: String| number(row.number(&name));
            let axis = |kind: &str, suffix: &str| ["r", "t", "n"].map(|axis| column(format!("{kind}_{axis}{suffix}")));
            let mut cells = vec![row.filter.clone(), name.to_owned()];
            cells.extend(axis(&format!("{prefix}_rmse"), &format!("_{unit}")));
            cells.push(column(format!("{prefix}_rmse_se_{unit}")));
            cells.extend(axis(&format!("ratio_{prefix}"), ""));
            let inside = row.number(&format!("coverage_3s_{prefix}"));
            cells.push(inside.map_or_else(|| number(None), |share| format!("{:.2}", 100.0 * share)));
            table.push(cells);
        }
    }
    plain_table(header, 2, table)
}

/// One line for each claim, without a final newline.
pub fn render_claims(verdicts: &[Verdict<'_>]) -> String {
    let mut text = String::new();
    for verdict in verdicts {
        let claim = verdict.claim;
        let word = if verdict.holds() { "holds " } else { "MISSED" };
        let value = number(verdict.value);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bound::Bound;
    use crate::scenarios::Claim;

    fn row(filter: &str, acceleration: Option<f64>) -> SummaryRow {
        SummaryRow {
            scenario: "leo_venting".to_owned(),
            filter: filter.to_owned(),
            case: "nominal".to_owned(),
            runs: 100,
            failed: 0,
            diverged: 2,
            pos_rmse_m: Some(1.23456),
            vel_rmse_m_s: Some(0.0123456),
            acc_rmse_m_s2: acceleration,
            ratio_pos: Some(1.05),
            ratio_vel: Some(17.5),
            ratio_acc: acceleration.map(|_| 123.4),
            mean_err_sigma: Some(0.98),
            nees: Some(0.0),
            nees_median: Some(123_456.0),
            nis: None,
            ..SummaryRow::default()
        }
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
        let text = render(&[row("milton", Some(4.2e-5)), row("snc", None)], &[timing]);
        let expected = include_str!("table_snapshot.txt");
        assert_eq!(text, expected.trim_end_matches('\n'), "\n{text}");
    }

    /// Cells of the last columns stand under the right heads.
    #[test]
    fn axes_of_a_filter_with_and_without_a_covariance() {
        let mut full = row("milton", None);
        full.pos_rmse_t_m = Some(0.25);
        full.ratio_pos_n = Some(1.06);
        full.coverage_3s_pos = Some(0.99829);
        full.vel_rmse_se_m_s = Some(0.0125);
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

    #[test]
    fn four_digits_at_any_magnitude() {
        for (value, text) in [
            (None, "-"),
            (Some(0.0), "0"),
            (Some(-1.0), "-1.000"),
            (Some(0.0123456), "0.01235"),
            (Some(12345.6), "12346"),
            (Some(1.5e-7), "1.500e-7"),
            (Some(1e5), "1.000e5"),
        ] {
            assert_eq!(number(value), text);
        }
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
        let text = render_claims(&[
            Verdict {
                claim: &near,
                value: Some(1.05),
            },
            Verdict {
                claim: &above,
                value: Some(1.1),
            },
            Verdict {
                claim: &none,
                value: None,
            },
        ]);
        assert_eq!(
            text,
            "holds   milton ratio_pos = 1.050 (bound: 0.95 to 1.2): overlay\n\
             MISSED  milton ratio_vel = 1.100 (bound: at least 1.2): modest\n\
             MISSED  milton diverged = - (bound: exactly 0): stays"
        );
    }
}
