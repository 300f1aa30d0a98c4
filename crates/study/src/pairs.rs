//! Filter against filter in the same runs, by the error that is pooled over them.

use stats::{PairedDifference, Sum, paired_difference, pooled_mean};

use crate::error::StudyError;
use crate::fold::FilterResult;
use crate::phase_result::resamples;
use crate::record::Quantity;

/// A filter against another one, in the runs that both have a result of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair {
    /// Place of the filter in the study.
    pub filter: usize,
    /// Place of the one it is held against.
    pub reference: usize,
    /// Position, velocity or acceleration.
    pub quantity: Quantity,
    /// RMSE of the norm, pooled over those runs, of the filter less that of the reference, in the unit of the quantity.
    pub difference: f64,
    /// 95 % interval of it, from the same runs drawn again for both.
    pub interval: Option<[f64; 2]>,
    /// Mean over the runs of the difference of each run's RMSE.
    pub by_run: PairedDifference,
}

const MOTION: [Quantity; 3] = [Quantity::Position, Quantity::Velocity, Quantity::Acceleration];

/// Every pair of filters of a study, each once: the later against the earlier.
///
/// # Errors
/// None for the results of one study, whose filters have the same runs.
pub fn pairs(filters: &[FilterResult]) -> Result<Vec<Pair>, StudyError> {
    let mut found = Vec::new();
    for reference in 0..filters.len() {
        for filter in reference + 1..filters.len() {
            for quantity in MOTION {
                found.extend(pair(filters, filter, reference, quantity)?);
            }
        }
    }
    Ok(found)
}

fn pair(
    filters: &[FilterResult],
    filter: usize,
    reference: usize,
    quantity: Quantity,
) -> Result<Option<Pair>, StudyError> {
    let (own, other) = (sums(&filters[filter], quantity), sums(&filters[reference], quantity));
    let both = own.into_iter().zip(other).filter(|(a, b)| a.values > 0 && b.values > 0);
    let (own, other): (Vec<Sum>, Vec<Sum>) = both.unzip();
    let by_run = |sums: &[Sum]| sums.iter().filter_map(|s| s.mean().map(f64::sqrt)).collect::<Vec<_>>();
    let Some(by_run) = paired_difference(&by_run(&own), &by_run(&other))? else {
        return Ok(None);
    };
    let difference = |runs: &[u32]| Some(pooled_mean(&own, runs)?.sqrt() - pooled_mean(&other, runs)?.sqrt());
    let all: Vec<u32> = (0..).take(own.len()).collect();
    Ok(difference(&all).map(|pooled| Pair {
        filter,
        reference,
        quantity,
        difference: pooled,
        interval: resamples(own.len(), filters[filter].seed).interval(difference),
        by_run,
    }))
}

/// Squared errors of each run over the scored time; none of a failed one.
fn sums(filter: &FilterResult, quantity: Quantity) -> Vec<Sum> {
    let scored = filter.phases.first().into_iter().flat_map(|phase| &phase.runs);
    scored
        .map(|run| run.squares.get(quantity as usize).copied().unwrap_or_default())
        .collect()
}

/// Groups of filters whose RMSE cannot be told apart, from 1 for the best.
///
/// The best filter makes the first group with all those whose difference to it has a 95 % interval that holds 0; the best of the
/// others makes the next, and so on. Where runs are too few for an interval nothing can be told apart, and all share a group.
///
/// * returns: by filter; `None` without a result, and for a bound, which takes no part.
///
/// # Errors
/// As for [`pairs`].
pub fn ranks(filters: &[FilterResult], quantity: Quantity) -> Result<Vec<Option<u32>>, StudyError> {
    let rmse = |filter: &FilterResult| {
        let sums = sums(filter, quantity);
        pooled_mean(&sums, &(0..).take(sums.len()).collect::<Vec<u32>>())
    };
    let mut left: Vec<(usize, f64)> = filters
        .iter()
        .enumerate()
        .filter(|(_, f)| !f.bound)
        .filter_map(|(i, f)| Some((i, rmse(f)?)))
        .collect();
    left.sort_by(|a, b| a.1.total_cmp(&b.1));
    let mut ranks = vec![None; filters.len()];
    let mut group = 0;
    while let Some((best, _)) = left.first().copied() {
        group += 1;
        let mut rest = Vec::new();
        for (filter, value) in left {
            let apart = match pair(filters, filter, best, quantity)? {
                Some(Pair {
                    interval: Some([low, high]),
                    ..
                }) => low > 0.0 || high < 0.0,
                _ => false,
            };
            if filter != best && apart {
                rest.push((filter, value));
            } else {
                ranks[filter] = Some(group);
            }
        }
        left = rest;
    }
    Ok(ranks)
}
