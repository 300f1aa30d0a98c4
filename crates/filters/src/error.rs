//! What can go wrong in a filter.

/// One variant per cause; messages name the FMI variable or the epoch concerned.
#[derive(Debug, thiserror::Error)]
pub enum FilterError {
    /// A filter number or name that is not registered.
    #[error("filter '{name}' is not known here; known: {known}")]
    UnknownFilter {
        /// As given.
        name: String,
        /// Registered names.
        known: String,
    },
    /// A filter in a world where it has no meaning.
    #[error("filter {filter} has no meaning in mission {mission}: {why}")]
    NoMeaning {
        /// Filter.
        filter: &'static str,
        /// Mission.
        mission: String,
        /// Reason.
        why: &'static str,
    },
    /// A mission that tells a filter of something which it cannot use.
    #[error("mission {mission}: {what}")]
    Unusable {
        /// Mission.
        mission: String,
        /// What, and what is allowed.
        what: String,
    },
    /// A start value that no law takes from a mission.
    #[error("mission {mission}: no law takes \"{name}\" from [navigation.law]; known: {known}")]
    UnknownStart {
        /// As the mission has it.
        name: String,
        /// Mission.
        mission: String,
        /// Every start value that a mission may state.
        known: String,
    },
    /// A gravity field that cannot be read.
    #[error(transparent)]
    Field(#[from] astro::harmonics::FieldError),
    /// A body or an epoch that is not known.
    #[error(transparent)]
    Astro(#[from] astro::AstroError),
    /// The target's orbit, which the filter's dynamics need, is missing.
    #[error(
        "at t = {t_s} s target_orbit.r = {r} m and target_orbit.h = {h} m2/s: connect target_orbit.*, both must be positive"
    )]
    NoTargetOrbit {
        /// Epoch of the sample, s.
        t_s: f64,
        /// Distance as given, m.
        r: f64,
        /// Angular momentum as given, m2/s.
        h: f64,
    },
    /// A bound that nobody tells the truth.
    #[error(
        "at t = {t_s} s: this filter is a bound and has to be told the truth: connect truth.dv_t_n and truth.event_time"
    )]
    NothingUntold {
        /// Epoch of the sample, s.
        t_s: f64,
    },
    /// A value outside its range.
    #[error("{name} = {value}{}{unit}: must be {permitted}", if unit.is_empty() { "" } else { " " })]
    OutOfRange {
        /// FMI variable.
        name: String,
        /// As given.
        value: f64,
        /// Unit of the value.
        unit: &'static str,
        /// The range in words.
        permitted: String,
    },
    /// A law asked for a tunable that it does not declare with this type: a mistake in the law.
    #[error("{name} is not declared with the type that the law reads it with")]
    Undeclared {
        /// FMI variable.
        name: String,
    },
    /// The first sample arrived and no initial estimate had been given.
    #[error("nav_init.x is all zero when sample {count} at t = {t_s} s arrives: connect or set nav_init.x[1..18]")]
    NoInitialEstimate {
        /// Ordinal of the sample.
        count: i32,
        /// Epoch of the sample, s.
        t_s: f64,
    },
    /// The initial estimate has no chaser in it.
    #[error(
        "nav_init.x[10..12], the chaser's position, is zero when the first sample arrives at t = {t_s} s: is the world flying the same mission as the filter?"
    )]
    NoChaserPosition {
        /// Epoch of the sample, s.
        t_s: f64,
    },
    /// A sample whose epoch does not follow the last one.
    #[error("sample {count} has sample_time = {t_s} s, not after the last epoch {last_s} s")]
    TimeNotAdvancing {
        /// Ordinal of the sample.
        count: i32,
        /// Its epoch, s.
        t_s: f64,
        /// Epoch of the last sample used, or the start time, s.
        last_s: f64,
    },
    /// A sample too far ahead to be bridged.
    #[error("sample {count} at t = {t_s} s leaves a gap of {gap_s} s; at most {limit_s} s can be bridged")]
    GapTooLong {
        /// Ordinal of the sample.
        count: i32,
        /// Its epoch, s.
        t_s: f64,
        /// Time since the last epoch, s.
        gap_s: f64,
        /// Longest gap that is bridged, s.
        limit_s: f64,
    },
    /// An attitude matrix that is not a rotation.
    #[error(
        "dcm_bc_n of the sample at t = {t_s} s is not a rotation, |D D^T - I| reaches {defect:.3e}: connect dcm_bc_n, all nine elements, row by row"
    )]
    NotARotation {
        /// Epoch, s.
        t_s: f64,
        /// Largest entry of D D^T - I.
        defect: f64,
    },
    /// The predicted line of sight has no direction.
    #[error(
        "at t = {t_s} s the predicted target lies {range_m:.3e} m from the chaser: range and angles have no partials"
    )]
    LineOfSightUndefined {
        /// Epoch, s.
        t_s: f64,
        /// Predicted range, m.
        range_m: f64,
    },
    /// The innovation covariance has no Cholesky factor.
    #[error(
        "at t = {t_s} s the innovation covariance is not positive definite (smallest diagonal entry {min_diagonal:.3e})"
    )]
    InnovationNotSpd {
        /// Epoch, s.
        t_s: f64,
        /// Smallest diagonal entry, internal units.
        min_diagonal: f64,
    },
    /// The state or its covariance is no longer finite.
    #[error("at t = {t_s} s the estimate is no longer finite")]
    NotFinite {
        /// Epoch, s.
        t_s: f64,
    },
    /// Rounding has made a variance negative.
    #[error("at t = {t_s} s the variance of state {state} (in the order of cov.sigma) has become negative")]
    NegativeVariance {
        /// Epoch, s.
        t_s: f64,
        /// Which state, from 1, in the order of `cov.sigma`.
        state: usize,
    },
    /// The information matrix of an adaptation could not be inverted.
    #[error("{law}: the information matrix of the adaptation is not positive definite at update {update}")]
    InformationNotSpd {
        /// The law.
        law: &'static str,
        /// Ordinal of the update.
        update: i32,
    },
}

impl From<interface::OutOfRange> for FilterError {
    fn from(error: interface::OutOfRange) -> Self {
        Self::OutOfRange {
            permitted: error.bound.words(error.unit),
            name: error.name,
            value: error.value,
            unit: error.unit,
        }
    }
}
