//! What truth and filter call the quantities that are compared.

/// Names of the variables that are compared; elements of vectors are `name[1]`..`name[3]`.
#[derive(Debug, PartialEq, Eq)]
pub struct Signals {
    /// Relative position of truth and filter, m. Required of both.
    pub position: [&'static str; 2],
    /// Relative velocity, m/s. Required of both.
    pub velocity: [&'static str; 2],
    /// Unmodelled acceleration, m/s2.
    pub acceleration: [&'static str; 2],
    /// Accelerometer bias, m/s2, chaser body axes.
    pub bias: Option<[&'static str; 2]>,
    /// Elements of the filter's vector of standard deviations that belong to the bias.
    pub bias_sigma: Option<[&'static str; 3]>,
    /// Position and velocity of the chaser in the truth, where the axes of the results depend on them; required then.
    pub chaser: Option<[&'static str; 2]>,
    /// Innovation of the filter, three rows at a time.
    pub innovations: [Option<Innovation>; 2],
}

/// Three rows of an innovation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Innovation {
    /// Names of the filter's variables.
    pub names: [&'static str; 3],
    /// Unit suffixes for column names.
    pub units: [&'static str; 3],
    /// Name of the vector of their predicted variances.
    pub variance: &'static str,
}

/// Of a mission in inertial or rotating axes N.
pub(crate) const INERTIAL: Signals = Signals {
    position: ["truth.r_tc_n", "est.r_tc_n"],
    velocity: ["truth.v_tc_n", "est.v_tc_n"],
    acceleration: ["truth.a_t_n", "est.a_t_n"],
    bias: Some(["truth.b_c_bc", "est.b_c_bc"]),
    bias_sigma: Some(["cov.sigma[16]", "cov.sigma[17]", "cov.sigma[18]"]),
    chaser: Some(["truth.r_c_n", "truth.v_c_n"]),
    innovations: [
        Some(Innovation {
            names: ["innov.range", "innov.azimuth", "innov.elevation"],
            units: ["m", "rad", "rad"],
            variance: "innov.s",
        }),
        None,
    ],
};

/// Of one in the target's LVLH axes.
pub(crate) const LVLH: Signals = Signals {
    position: ["truth.rho_lvlh", "est.rho_lvlh"],
    velocity: ["truth.rho_dot_lvlh", "est.rho_dot_lvlh"],
    acceleration: ["truth.d_lvlh", "est.d_lvlh"],
    bias: None,
    bias_sigma: None,
    chaser: None,
    innovations: [
        Some(Innovation {
            names: ["innov.rho[1]", "innov.rho[2]", "innov.rho[3]"],
            units: ["m"; 3],
            variance: "innov.rho_s",
        }),
        Some(Innovation {
            names: ["innov.rho_dot[1]", "innov.rho_dot[2]", "innov.rho_dot[3]"],
            units: ["m_s"; 3],
            variance: "innov.rho_dot_s",
        }),
    ],
};

impl Innovation {
    /// Names for columns, without unit.
    pub fn columns(&self) -> [String; 3] {
        self.names.map(|name| name.replace(['.', '['], "_").replace(']', ""))
    }
}
