//! The columns of the files that hold histories. Which there are depends on the world: `<...>` stands for any of some words.

use super::column::FileColumns;

/// Of each such file.
pub fn all() -> Vec<FileColumns> {
    vec![
        FileColumns::described("replay.csv", "a sample of a filter in one run, by replay", REPLAY),
        FileColumns::described(
            "epochs/*.csv",
            "an epoch of a filter, over the runs that did not fail",
            EPOCHS,
        ),
        FileColumns::described(
            "run_errors/*.csv",
            "the least or the greatest errors, axis by axis, of a hundredth of a run; of the first 50 runs",
            RUN_ERRORS,
        ),
        FileColumns::described("paths/*.csv", "an epoch of run 0 of a world", PATHS),
    ]
}

const REPLAY: &[[&str; 3]] = &[
    ["filter", "", "filter with its preset"],
    ["sample", "", "ordinal of the sample, from 1"],
    ["t_s", "s", "epoch of the sample"],
    [
        "measured",
        "",
        "1 where a sensor that sees the target measured it, else 0",
    ],
    ["status", "", "what the filter says of itself"],
    [
        "truth_<quantity>_<axis>_<unit>",
        "",
        "true pos, vel, acc (unmodelled) and bias (of the accelerometer), in the axes of the FMU's variables",
    ],
    ["est_<quantity>_<axis>_<unit>", "", "the same as estimated"],
    [
        "err_<quantity>_<axis>_<unit>",
        "",
        "estimated less true, in the axes of the results; of the bias in those of the chaser's body",
    ],
    [
        "sigma_<quantity>_<axis>_<unit>",
        "",
        "standard deviation that the filter claims of it",
    ],
    ["innov_<row>_<unit>", "", "innovation: measured less predicted"],
    [
        "innov_<row>_sigma_<unit>",
        "",
        "standard deviation that the filter claims of it",
    ],
    ["nees", "1", "NEES over the states that the covariance has"],
    ["nis", "1", "NIS over the rows of the measurement"],
    ["q_s_<axis>", "m/s^2.5", "square root of the jerk density in use"],
    [
        "p_<row>_<column>",
        "",
        "covariance of position, velocity and acceleration, SI, on and above its diagonal, in the axes of the FMU's variables",
    ],
    [
        "meas_<variable>_<unit>",
        "",
        "what the filter was fed by a sensor; empty where it saw nothing (its meas_<sensor>_valid is 0)",
    ],
];

const EPOCHS: &[[&str; 3]] = &[
    ["t_s", "s", "epoch"],
    ["runs", "", "runs with an estimate of it"],
    [
        "mean_<quantity>_<unit>",
        "",
        "mean over runs of the error, in the axes of the results, of the innovation, or of q",
    ],
    ["sample_sigma_<quantity>_<unit>", "", "standard deviation over runs"],
    [
        "est_sigma_<quantity>_<unit>",
        "",
        "standard deviation that the filter claims: root of the mean variance",
    ],
    ["nees", "1", "mean NEES over its states"],
    ["nis", "1", "mean NIS over its rows"],
    [
        "nis_runs",
        "",
        "runs that it is the mean of: those in which a sensor measured the target and was not passed by",
    ],
    [
        "spread_q_s_<axis>_m_s2_5",
        "m/s^2.5",
        "standard deviation over runs of q",
    ],
];

const RUN_ERRORS: &[[&str; 3]] = &[
    ["run", "", "number of the run"],
    ["t_s", "s", "epoch"],
    ["<quantity>_<axis>_<unit>", "", "error in the axes of the results"],
];

const PATHS: &[[&str; 3]] = &[
    ["t_s", "s", "epoch"],
    [
        "relative_<axis>_m",
        "m",
        "true chaser relative to the target, in the axes of the results",
    ],
    ["chaser_<axis>_m", "m", "true chaser, axes N"],
];

/// Whether a column's name is that of a documented one, `<...>` standing for anything.
pub fn is_named(documented: &str, column: &str) -> bool {
    let Some((before, rest)) = documented.split_once('<') else {
        return documented == column;
    };
    let Some(column) = column.strip_prefix(before) else {
        return false;
    };
    let rest = rest.split_once('>').map_or("", |(_, rest)| rest);
    (1..=column.len()).any(|taken| column.is_char_boundary(taken) && is_named(rest, &column[taken..]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_placeholder_stands_for_any_word_but_not_for_none() {
        assert!(is_named("p_<row>_<column>", "p_1_9"));
        assert!(is_named("innov_<row>_sigma_<unit>", "innov_rho_x_sigma_m_s"));
        assert!(!is_named("innov_<row>_sigma_<unit>", "innov_rho_x_m"));
        assert!(!is_named("meas_<variable>", "meas_"));
        assert!(!is_named("nees", "nees6"));
    }
}
