//! The venting scenarios: what the MILTON paper claims of Figs. 1-6 and 8-13.

use super::chapter::{Chapter, MILTON_PAPER};
use super::line::Line;
use super::notebook::{Laboratory, Notebook};
use super::request::Request;
use crate::HarnessError;
use crate::bound::Bound;
use crate::claims;

/// The filter of the paper.
const FILTER: &str = "milton";

pub(super) const CHAPTER: Chapter = Chapter {
    title: "MILTON: venting target",
    requests,
    write,
};

fn low_orbit() -> Request {
    Request::of("milton_figures_1_to_6")
}

fn halo_orbit() -> Request {
    Request::of("milton_figures_7_to_13")
}

fn requests() -> Vec<Request> {
    vec![low_orbit(), halo_orbit()]
}

fn write(laboratory: &mut dyn Laboratory, notebook: &mut Notebook) -> Result<(), HarnessError> {
    for request in &requests() {
        notebook.run(laboratory, request)?;
        for claim in claims::of(request.world()).iter().filter(|c| c.filter == FILTER) {
            let quantity = format!("{} {FILTER} {}", request.world(), claim.column);
            let line = Line::new(MILTON_PAPER, claim.text, &quantity, "1")
                .value(notebook.number(request, FILTER, claim.column))
                .bound(claim.bound)
                .required(true);
            notebook.push(line);
        }
        let world = request.world();
        for (claim, column, low, high) in [
            (
                "the accelerometer bias is estimated to its 3 sigma (Figs. 4 and 11)",
                "ratio_bias",
                0.9,
                1.1,
            ),
            (
                "the accelerometer bias is estimated to its 3 sigma (Figs. 4 and 11)",
                "coverage_3s_bias",
                0.99,
                1.0,
            ),
            (
                "residuals match their predicted sigma (Figs. 5, 6, 12 and 13): 1 on average",
                "nis",
                0.9,
                1.1,
            ),
        ] {
            let line = Line::new(MILTON_PAPER, claim, &format!("{world} {FILTER} {column}"), "1")
                .value(notebook.number(request, FILTER, column))
                .bound(Bound::between(low, high));
            notebook.push(line);
        }
    }
    let (low, halo) = (low_orbit(), halo_orbit());
    for column in ["ratio_vel", "ratio_acc"] {
        let quantity = format!("{FILTER} {column}, {} over {}", halo.world(), low.world());
        let of = |world| notebook.number(world, FILTER, column);
        let line = Line::new(
            MILTON_PAPER,
            "over-estimated less near the Moon than in low Earth orbit (Figs. 9 and 10)",
            &quantity,
            "1",
        )
        .value(Option::zip(of(&halo), of(&low)).map(|(halo, low)| halo / low))
        .bound(Bound::between(0.0, 1.0));
        notebook.push(line);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use study::worlds;

    #[test]
    fn no_claim_of_the_paper_is_left_out() {
        let has_claims = |world: &String| claims::of(world).iter().any(|c| c.filter == FILTER);
        let names = worlds::all().unwrap().into_iter().map(|w| w.name);
        let with_claims: Vec<String> = names.filter(has_claims).collect();
        let run: Vec<String> = requests().iter().map(|r| r.world().to_owned()).collect();
        assert_eq!(run, with_claims);
    }
}
