//! What every page is set in: its title, styles and scripts, and the data that the script draws.

use serde::Serialize;

use crate::ReportError;

/// Fields of `templates/base.html`.
pub(crate) struct Frame {
    pub title: String,
    pub style: &'static str,
    pub plot_style: &'static str,
    pub plot_script: &'static str,
    pub script: &'static str,
    pub data: String,
}

impl Frame {
    /// * `data`: for `assets/report.js`, a list with an object for each `article` of the page.
    ///
    /// # Errors
    /// [`ReportError::Data`].
    pub fn new(title: impl Into<String>, data: &impl Serialize) -> Result<Self, ReportError> {
        Ok(Self {
            title: title.into(),
            style: include_str!("../assets/report.css"),
            plot_style: include_str!("../assets/uplot/uPlot.min.css"),
            plot_script: include_str!("../assets/uplot/uPlot.iife.min.js"),
            script: include_str!("../assets/report.js"),
            // A label may hold anything: nothing in it must end the script element.
            data: serde_json::to_string(data)?.replace('<', "\\u003c"),
        })
    }
}
