//! The venting scenarios: what the MILTON paper claims of Figs. 1-3 and 8-10.

use super::{Bound, Chapter, Laboratory, Line, MILTON_PAPER, Notebook, Request};
use crate::HarnessError;
use crate::scenarios;

/// The filter of the paper.
const FILTER: &str = "milton";

pub(super) const CHAPTER: Chapter = Chapter {
    title: "MILTON: venting target",
    requests,
    write,
};

fn requests() -> Vec<Request> {
    let worlds = scenarios::SCENARIOS.iter();
    worlds
        .filter(|world| world.bounds.iter().any(|b| b.filter == FILTER))
        .map(|world| Request::new(world, "nominal", &[FILTER]))
        .collect()
}

fn write(laboratory: &mut dyn Laboratory, notebook: &mut Notebook) -> Result<(), HarnessError> {
    let requests = requests();
    for request in &requests {
        notebook.run(laboratory, request)?;
        for claim in request.scenario.bounds.iter().filter(|b| b.filter == FILTER) {
            let quantity = format!("{} {FILTER} {}", request.scenario.name, claim.column);
            let line = Line::new(MILTON_PAPER, claim.claim, &quantity, "1")
                .value(notebook.number(request, FILTER, claim.column))
                .bound(Bound::between(claim.low, claim.high))
                .required(true);
            notebook.push(line);
        }
    }
    // In the order of the scenarios: low Earth orbit, then the halo orbit.
    if let [low, halo] = &requests[..] {
        for column in ["ratio_vel", "ratio_acc"] {
            let quantity = format!("{FILTER} {column}, {} over {}", halo.scenario.name, low.scenario.name);
            let of = |request| notebook.number(request, FILTER, column);
            let line = Line::new(
                MILTON_PAPER,
                "over-estimated less near the Moon than in low Earth orbit (Figs. 9 and 10)",
                &quantity,
                "1",
            )
            .value(Option::zip(of(halo), of(low)).map(|(h, l)| h / l))
            .bound(Bound::between(0.0, 1.0));
            notebook.push(line);
        }
    }
    Ok(())
}
