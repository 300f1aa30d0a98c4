//! `regret`: laws against the best constant, level by level.

use std::fs;

use html_report::Format;
use serde::{Deserialize, Serialize};
use study::{Models, NAV, Plan, Study, World, chain, check_real_range, rehearse};

use super::out::Out;
use super::progress::Progress;
use super::report::write_page;
use super::shared::{Verdict, closing, models, note, plan_of};
use crate::HarnessError;
use crate::cli::RegretArgs;
use crate::format::{json_bytes, wrapped};
use crate::output::OutputFolder;
use crate::regret::levels::{Level, Levels, OWN};
use crate::regret::{Kind, LEGEND, Options, Row, Trial, Tried, markdown, render, table, told};
use crate::store::identity;

/// Laws that are tried unless others are asked for.
const LAWS: [&str; 7] = [
    "hybrid",
    "change_point",
    "imm",
    "mmae",
    "milton@consistent",
    "constrained_q",
    "rbfnn_ekf",
];
/// Folder of what is kept of each trial.
const TRIALS: &str = "trials";

/// A trial that is through, with all that it hangs on.
#[derive(Serialize, Deserialize)]
struct Kept {
    request: Request,
    tried: Tried,
}

/// All that decides what a trial finds.
#[derive(PartialEq, Serialize, Deserialize)]
struct Request {
    /// Of the study of all its filters, as that of any other command.
    identity: String,
    scouts: u32,
}

pub(super) fn regret(args: &RegretArgs, out: &mut Out<'_>) -> Result<Verdict, HarnessError> {
    if args.print_levels {
        out.say(OWN.trim_end())?;
        return Ok(Verdict::Done);
    }
    let levels = Levels::read(args.levels.as_deref())?;
    let plan = plan_of(Plan::default(), &args.study, &args.worlds, &args.work)?;
    let plan = Plan {
        filters: plan
            .filters
            .or_else(|| Some(LAWS.iter().filter_map(|law| law.parse().ok()).collect())),
        ..plan
    };
    let folder = OutputFolder::prepare(&args.out)?;
    let models = models(&plan, &args.study.build)?;
    let options = Options {
        runs: plan.runs,
        scouts: args.scouts.min(plan.runs),
        jobs: plan.threads(),
    };
    let mut cases = Vec::new();
    for level in levels.levels.iter().filter(|level| asked(level, args)) {
        let at = Plan {
            assignments: plan.assignments.iter().chain(&level.set).cloned().collect(),
            ..plan.clone()
        };
        for world in at.worlds(folder.path())?.into_iter().filter(|w| level.is_for(&w.name)) {
            cases.push(Case::new(&models, &at, level, world, &levels)?);
        }
    }
    if cases.is_empty() {
        return Err(HarnessError::NoLevel {
            known: levels
                .levels
                .iter()
                .map(|l| l.name.as_str())
                .collect::<Vec<_>>()
                .join(", "),
        });
    }
    // Mission by mission, each with its levels in the order of the file.
    let missions: Vec<String> = plan.worlds(folder.path())?.into_iter().map(|w| w.name).collect();
    let place = |case: &Case| missions.iter().position(|name| *name == case.world);
    cases.sort_by_key(place);
    let kept: Vec<Option<Tried>> = cases
        .iter()
        .map(|case| case.kept(&folder, &options, args.force))
        .collect::<Result<_, _>>()?;

    let open = cases.iter().zip(&kept).filter(|(_, kept)| kept.is_none());
    let work = open.map(|(case, _)| case.trial.work(&options)).sum();
    let progress = Progress::new(work, "filter runs", args.study.build.quiet);
    let mut rows: Vec<Row> = Vec::new();
    for (case, kept) in cases.iter().zip(kept) {
        progress.doing(format!("{}, {}", case.world, case.level));
        let tried = match kept {
            Some(tried) => tried,
            None => {
                let tried = case.trial.run(&options, |n| progress.advance(n));
                let kept = Kept {
                    request: case.request(&options),
                    tried,
                };
                folder.write(&case.file(), &json_bytes(&kept)?)?;
                kept.tried
            }
        };
        rows.extend(tried.rows(&case.world, &case.level, plan.seed));
        // After every level, so that what is through can be read.
        folder.write("regret.csv", &render(&rows)?)?;
    }
    progress.end();
    let mut files = vec!["regret.csv".to_owned()];
    files.extend(folder.write_all(vec![("regret.md".to_owned(), markdown(&rows, &missions).into_bytes())])?);
    match shown(&folder) {
        Ok(names) => files.extend(names),
        // What was found does not hang on a font.
        Err(error) => note(&format!(
            "note: there is no report.html, nor a figure: {}",
            chain(&error)
        )),
    }
    for mission in &missions {
        let own: Vec<&Row> = rows.iter().filter(|row| row.mission == *mission).collect();
        if !own.is_empty() {
            let heading = format!(
                "{mission}: RMSE over that of the best constant in hindsight, {} runs from seed {}",
                plan.runs, plan.seed
            );
            out.say(&format!("{}\n{}\n{LEGEND}\n", wrapped(&heading), table(&own)))?;
        }
    }
    out.tell("regret", rows.iter().map(told).collect::<Vec<_>>())?;
    closing(&folder, &files, out)?;
    Ok(Verdict::Done)
}

/// Writes the page and the figures; returns their names.
fn shown(folder: &OutputFolder) -> Result<Vec<String>, HarnessError> {
    let mut names = vec![write_page(folder)?];
    for format in [Format::Svg, Format::Png] {
        names.extend(folder.write_all(html_report::drawn(folder.path(), format)?)?);
    }
    Ok(names)
}

fn asked(level: &Level, args: &RegretArgs) -> bool {
    args.at.is_empty() || args.at.contains(&level.name)
}

/// A mission at a level.
struct Case {
    world: String,
    level: String,
    trial: Trial,
    /// As [`Request`] has it.
    identity: String,
}

impl Case {
    fn new(models: &Models, plan: &Plan, level: &Level, world: World, levels: &Levels) -> Result<Self, HarnessError> {
        models.check_effects(plan, std::slice::from_ref(&world))?;
        let spec = models.spec(plan, &world)?;
        for text in rehearse(&spec)? {
            note(&format!("note: {}, {}: {text}", world.name, level.name));
        }
        let fixed = levels.families.iter().map(|family| (Kind::Fixed, family));
        let bounds = levels.bounds.iter().map(|family| (Kind::Bound, family));
        let mut families = Vec::new();
        for (kind, family) in fixed.chain(bounds) {
            let nav = models.require(NAV, &family.filter)?;
            let meant = |name| {
                nav.filters
                    .without_meaning(name, &world.name, world.frame.name())
                    .is_none()
            };
            if kind == Kind::Bound && !meant(&family.filter) {
                continue;
            }
            let alone = Plan {
                filters: Some(family.filter.parse().ok().into_iter().collect()),
                ..plan.clone()
            };
            let base = models.spec(&alone, &world)?.filters.into_iter().next();
            for (tunable, values) in &family.values {
                check_real_range(nav, &format!("{}.{tunable}", family.filter), values)?;
            }
            let members = family.members().into_iter().filter_map(|values| {
                let mut member = base.clone()?;
                let told: Vec<String> = values
                    .iter()
                    .map(|(name, value)| format!("{}={value:e}", name.rsplit('.').next().unwrap_or(name)))
                    .collect();
                member.label = format!("{}({})", family.filter, told.join(","));
                for (name, value) in &values {
                    member.set_real(name, *value);
                }
                Some(member)
            });
            families.push((kind, members.collect::<Vec<_>>()));
        }
        let mut whole = spec.subset(&(0..spec.filters.len()).collect::<Vec<_>>());
        whole
            .filters
            .extend(families.iter().flat_map(|(_, members)| members).cloned());
        let study = Study {
            spec: whole,
            runs: plan.runs,
            jobs: plan.threads(),
            case: level.name.clone(),
        };
        Ok(Self {
            identity: identity(&[study], models)?,
            world: world.name,
            level: level.name.clone(),
            trial: Trial { spec, families },
        })
    }

    fn file(&self) -> String {
        format!("{TRIALS}/{}_{}.json", self.world, self.level)
    }

    fn request(&self, options: &Options) -> Request {
        Request {
            identity: self.identity.clone(),
            scouts: options.scouts,
        }
    }

    /// What an earlier command has found of the same.
    ///
    /// * `force`: whether anything else may be replaced.
    fn kept(&self, folder: &OutputFolder, options: &Options, force: bool) -> Result<Option<Tried>, HarnessError> {
        let path = folder.path().join(self.file());
        if !path.is_file() {
            return Ok(None);
        }
        let text = fs::read_to_string(&path).map_err(|source| HarnessError::Read {
            path: path.clone(),
            source,
        })?;
        match serde_json::from_str::<Kept>(&text) {
            Ok(kept) if kept.request == self.request(options) => Ok(Some(kept.tried)),
            _ if force => Ok(None),
            _ => Err(HarnessError::OtherRegret { path }),
        }
    }
}
