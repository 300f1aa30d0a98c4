//! Filters, presets, assignments and mappings resolved against FMUs that consist of a description alone.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use std::collections::BTreeMap;
use std::io::Write;
use std::path::{Path, PathBuf};

use cosim::Value;
use study::{
    Assignment, FilterChoice, ForeignFilter, Mapping, Models, OwnFmus, Participant, Plan, Status, StudyError, TunedSet,
    Variation, worlds,
};

const TRUTH: &str = r#"
    <ScalarVariable name="scenario" valueReference="0" causality="parameter" variability="fixed"><Enumeration declaredType="Scenario" start="1"/></ScalarVariable>
    <ScalarVariable name="study_seed" valueReference="1" causality="parameter" variability="fixed"><Integer start="1"/></ScalarVariable>
    <ScalarVariable name="run" valueReference="2" causality="parameter" variability="fixed"><Integer start="0"/></ScalarVariable>
    <ScalarVariable name="sample_period" valueReference="3" causality="parameter" variability="fixed"><Real start="2"/></ScalarVariable>
    <ScalarVariable name="sample_count" valueReference="4" causality="output" variability="discrete"><Integer/></ScalarVariable>"#;

const NAV: &str = r#"
    <ScalarVariable name="scenario" valueReference="0" causality="parameter" variability="fixed"><Enumeration declaredType="Scenario" start="1"/></ScalarVariable>
    <ScalarVariable name="filter" valueReference="1" causality="parameter" variability="fixed"><Enumeration declaredType="Filter" start="1"/></ScalarVariable>
    <ScalarVariable name="milton.m_b" valueReference="2" causality="parameter" variability="fixed"><Integer start="30"/></ScalarVariable>
    <ScalarVariable name="milton.whiten" valueReference="3" causality="parameter" variability="fixed"><Boolean start="false"/></ScalarVariable>
    <ScalarVariable name="fixed_q.s" valueReference="4" causality="parameter" variability="fixed"><Real start="1" min="0"/></ScalarVariable>
    <ScalarVariable name="status" valueReference="5" causality="output" variability="discrete"><Integer/></ScalarVariable>"#;

const FOREIGN: &str = r#"
    <ScalarVariable name="gain" valueReference="0" causality="parameter" variability="fixed"><Real start="1" min="0"/></ScalarVariable>
    <ScalarVariable name="x_hat[1]" valueReference="1" causality="output"><Real/></ScalarVariable>
    <ScalarVariable name="x_hat[2]" valueReference="2" causality="output"><Real/></ScalarVariable>
    <ScalarVariable name="x_hatch" valueReference="3" causality="output"><Real/></ScalarVariable>"#;

fn write_fmu(folder: &Path, name: &str, variables: &str) -> PathBuf {
    let xml = format!(
        r#"<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="2.0" modelName="{name}" guid="x">
  <CoSimulation modelIdentifier="m"/>
  <TypeDefinitions>
    <SimpleType name="Scenario"><Enumeration><Item name="leo_venting" value="1"/></Enumeration></SimpleType>
    <SimpleType name="Filter"><Enumeration><Item name="fixed_q" value="1"/><Item name="milton" value="2"/><Item name="observer" value="3"/><Item name="oracle" value="4"/></Enumeration></SimpleType>
    <SimpleType name="Mode"><Enumeration><Item name="diverged" value="1"/><Item name="asleep" value="2"/><Item name="tracking" value="3"/></Enumeration></SimpleType>
  </TypeDefinitions>
  <VendorAnnotations><Tool name="trade-harness"><Filters><Presets>
    <Preset filter="milton" name="short" about="a short buffer"><Set variable="milton.m_b" value="5"/><Set variable="milton.whiten" value="true"/></Preset>
  </Presets><Meaning><Only filter="observer" scenarios="formation" why="it needs the state measured in full"/></Meaning><Bounds><Bound filter="oracle"/></Bounds></Filters></Tool></VendorAnnotations>
  <ModelVariables>{variables}</ModelVariables>
  <ModelStructure/>
</fmiModelDescription>"#
    );
    let path = folder.join(format!("{name}.fmu"));
    let mut zip = zip::ZipWriter::new(std::fs::File::create(&path).unwrap());
    zip.start_file("modelDescription.xml", zip::write::SimpleFileOptions::default())
        .unwrap();
    zip.write_all(xml.as_bytes()).unwrap();
    zip.finish().unwrap();
    path
}

/// Resolves a study of a truth, our filters and a foreign one called `other`.
fn cast(filters: &[&str], sets: &[&str], maps: &[&str]) -> Result<(Models, Participant, Vec<Participant>), StudyError> {
    let folder = tempfile::tempdir().unwrap();
    let truth = write_fmu(folder.path(), "truth", TRUTH);
    let nav = write_fmu(folder.path(), "nav", NAV);
    let other = write_fmu(folder.path(), "their", FOREIGN);
    let other: ForeignFilter = format!("other={}", other.display()).parse().unwrap();
    let maps: Vec<Mapping> = maps.iter().map(|m| m.parse().unwrap()).collect();
    let choices: Vec<FilterChoice> = filters.iter().map(|f| f.parse().unwrap()).collect();
    let sets: Vec<Assignment> = sets.iter().map(|s| s.parse().unwrap()).collect();
    let models = Models::open(&truth, Some(&nav), &[other], &[], &maps)?;
    let (truth, filters) = models.cast(&worlds::find("leo_venting").unwrap(), &choices, &[], &sets)?;
    Ok((models, truth, filters))
}

fn refused(filters: &[&str], sets: &[&str], maps: &[&str]) -> StudyError {
    cast(filters, sets, maps).err().unwrap()
}

fn value<'a>(participant: &'a Participant, name: &str) -> Option<&'a Value> {
    participant.starts.iter().find(|(n, _)| n == name).map(|(_, v)| v)
}

#[test]
fn presets_come_before_what_the_user_sets() {
    let sets = ["fmu-nav.milton.m_b=60", "other.gain=0.5", "fmu-truth.sample_period=0.5"];
    let (models, truth, filters) = cast(&["fixed_q", "milton@short"], &sets, &[]).unwrap();
    let labels: Vec<&str> = filters.iter().map(|f| f.label.as_str()).collect();
    assert_eq!(labels, ["fixed_q", "milton@short", "other"]);
    let short = &filters[1];
    assert_eq!(value(short, "filter"), Some(&Value::Integer(2)));
    assert_eq!(value(short, "milton.m_b"), Some(&Value::Integer(60)));
    assert_eq!(value(short, "milton.whiten"), Some(&Value::Boolean(true)));
    assert_eq!(value(&filters[0], "milton.whiten"), None);
    assert_eq!(value(&filters[2], "gain"), Some(&Value::Real(0.5)));
    // A foreign filter that knows one world only is not told which.
    assert_eq!(value(&filters[2], "scenario"), None);
    assert!(short.record.contains(&("filter".to_owned(), "milton".to_owned())));
    let world = worlds::find("leo_venting").unwrap();
    assert_eq!(models.sample_period(&truth, &world), Some(0.5));
    let (models, truth, _) = cast(&[], &[], &[]).unwrap();
    assert_eq!(models.sample_period(&truth, &world), Some(2.0));
    // Not positive: the world's own.
    let (models, truth, _) = cast(&[], &["fmu-truth.sample_period=-1"], &[]).unwrap();
    assert_eq!(models.sample_period(&truth, &world), Some(1.0));
}

#[test]
fn mappings_reach_every_element_of_a_vector() {
    let (_, _, filters) = cast(&[], &[], &["other.x_hat=est.r_tc_n"]).unwrap();
    let expected = [("x_hat[1]", "est.r_tc_n[1]"), ("x_hat[2]", "est.r_tc_n[2]")];
    assert_eq!(
        filters[0].aliases,
        expected.map(|(own, ours)| (own.to_owned(), ours.to_owned()))
    );
}

#[test]
fn what_does_not_exist_or_fit_is_told() {
    let known = |error: StudyError, parts: &[&str]| {
        let text = error.to_string();
        assert!(parts.iter().all(|p| text.contains(p)), "{text}");
        error
    };
    let e = known(refused(&["milto"], &[], &[]), &["milto", "fixed_q, milton, observer"]);
    assert!(matches!(e, StudyError::UnknownFilter { .. }));
    let e = known(refused(&["milton@long"], &[], &[]), &["long", "paper, short"]);
    assert!(matches!(e, StudyError::UnknownPreset { .. }));
    let e = known(
        refused(&[], &["milton.m_b=3"], &[]),
        &["milton", "fmu-truth, fmu-nav, other"],
    );
    assert!(matches!(e, StudyError::UnknownModel { .. }));
    let e = known(refused(&[], &[], &["nobody.x=est.r_tc_n"]), &["nobody"]);
    assert!(matches!(e, StudyError::UnknownModel { .. }));
    let e = known(
        refused(&["milton"], &["fmu-nav.milton.m_c=3"], &[]),
        &["milton.m_c", "milton.m_b"],
    );
    assert!(matches!(e, StudyError::Import(_)));
    let e = known(
        refused(&["milton"], &["fmu-nav.milton.m_b=three"], &[]),
        &["fmu-nav", "milton.m_b", "three"],
    );
    assert!(matches!(e, StudyError::Value { .. }));
    let e = known(refused(&[], &[], &["other.y_hat=est.r_tc_n"]), &["y_hat"]);
    assert!(matches!(e, StudyError::Import(_)));
    for (set, option) in [
        ("fmu-truth.study_seed=3", "--seed"),
        ("fmu-truth.run=3", "--run"),
        ("fmu-nav.filter=milton", "--filters"),
        ("fmu-nav.scenario=leo_venting", "--scenario"),
    ] {
        let e = known(refused(&["milton"], &[set], &[]), &[option]);
        assert!(matches!(e, StudyError::Reserved { .. }));
    }
    let e = known(
        refused(&[], &["fmu-truth.sample_count=3"], &[]),
        &["sample_count", "output"],
    );
    assert!(matches!(e, StudyError::NotAParameter { .. }));
    let e = known(
        refused(&["observer"], &[], &[]),
        &["observer", "leo_venting", "measured in full"],
    );
    assert!(matches!(e, StudyError::NoMeaning { .. }));
    let e = known(refused(&["milton", "milton"], &[], &[]), &["milton", "twice"]);
    assert!(matches!(e, StudyError::LabelTwice { .. }));
}

/// Resolves a study of `fixed_q`, `milton@short` and `other` with these variations.
fn vary(sets: &[&str], variations: &[&str]) -> Result<(Participant, Vec<Participant>), StudyError> {
    let (models, mut truth, mut filters) = cast(&["fixed_q", "milton@short"], sets, &["other.gain=our.gain"]).unwrap();
    let sets: Vec<Assignment> = sets.iter().map(|s| s.parse().unwrap()).collect();
    let variations: Vec<Variation> = variations.iter().map(|v| v.parse().unwrap()).collect();
    models.vary(std::iter::once(&mut truth).chain(&mut filters), &variations, &sets)?;
    Ok((truth, filters))
}

#[test]
fn variations_reach_every_part_of_their_model() {
    let given = ["fmu-truth.sample_period=uniform:1:2", "other.gain=loguniform:0.1:10"];
    let (truth, filters) = vary(&[], &given).unwrap();
    assert_eq!(
        (truth.varied[0].name.as_str(), truth.varied[0].draw),
        ("sample_period", 0)
    );
    assert!(filters[0].varied.is_empty() && filters[1].varied.is_empty());
    // Under the name it is mapped to, and as it stands in the FMU in the record.
    assert_eq!(
        (filters[2].varied[0].name.as_str(), filters[2].varied[0].draw),
        ("our.gain", 1)
    );
    let record = ("gain".to_owned(), "loguniform:0.1:10".to_owned());
    assert!(filters[2].record.contains(&record));
}

/// A label tells nothing about the FMU: a stranger may be called like a filter of ours.
#[test]
fn variations_miss_a_namesake() {
    let folder = tempfile::tempdir().unwrap();
    let truth = write_fmu(folder.path(), "truth", TRUTH);
    let nav = write_fmu(folder.path(), "nav", NAV);
    let theirs = write_fmu(folder.path(), "their", FOREIGN);
    let theirs: ForeignFilter = format!("fixed_q={}", theirs.display()).parse().unwrap();
    let models = Models::open(&truth, Some(&nav), &[theirs], &[], &[]).unwrap();
    let ours = ["fixed_q@paper".parse::<FilterChoice>().unwrap()];
    let (mut truth, mut filters) = models
        .cast(&worlds::find("leo_venting").unwrap(), &ours, &[], &[])
        .unwrap();
    let variations = ["fmu-nav.fixed_q.s=uniform:1:2", "fixed_q.gain=uniform:3:4"].map(|v| v.parse().unwrap());
    models
        .vary(std::iter::once(&mut truth).chain(&mut filters), &variations, &[])
        .unwrap();
    let varied = |p: &Participant| p.varied.iter().map(|v| v.name.clone()).collect::<Vec<_>>();
    assert_eq!(
        filters.iter().map(|f| f.label.as_str()).collect::<Vec<_>>(),
        ["fixed_q@paper", "fixed_q"]
    );
    assert_eq!([varied(&filters[0]), varied(&filters[1])], [["fixed_q.s"], ["gain"]]);
    assert!(truth.varied.is_empty());
}

/// What a tuned set says is checked as an assignment is, and told with the file and the set.
#[test]
fn tuned_sets_set_parameters_only() {
    let folder = tempfile::tempdir().unwrap();
    let truth = write_fmu(folder.path(), "truth", TRUTH);
    let nav = write_fmu(folder.path(), "nav", NAV);
    let models = Models::open(&truth, Some(&nav), &[], &[], &[]).unwrap();
    let cast = |variable: &str, value| {
        let set = TunedSet {
            file: Some(folder.path().join("tuned.json")),
            scenario: "leo_venting".to_owned(),
            filter: "fixed_q".to_owned(),
            preset: "paper".to_owned(),
            name: "tuned".to_owned(),
            values: BTreeMap::from([(variable.to_owned(), value)]),
            conditions: Vec::new(),
            search_objective: None,
            search_nees: None,
            feasible: true,
        };
        let tuned = ["fixed_q@tuned".parse().unwrap()];
        let cast = models.cast(&worlds::find("leo_venting").unwrap(), &tuned, &[set], &[]);
        cast.map(|(_, filters)| filters)
    };
    let filters = cast("fixed_q.s", 0.25).unwrap();
    assert_eq!(value(&filters[0], "fixed_q.s"), Some(&Value::Real(0.25)));
    for (variable, number, says) in [
        ("status", 1.0, "output"),
        ("run", 1.0, "--runs"),
        ("fixed_q.S", 1.0, "did you mean \"fixed_q.s\""),
        ("fixed_q.s", -1.0, "-1"),
    ] {
        let error = cast(variable, number).unwrap_err();
        assert!(matches!(error, StudyError::BadTunedSet { .. }), "{error}");
        let text = error.to_string();
        for part in ["tuned.json", "fixed_q@tuned", "leo_venting", variable, says] {
            assert!(text.contains(part), "'{part}' is missing in: {text}");
        }
    }
}

#[test]
fn what_cannot_be_varied_is_told() {
    for (sets, variations, says) in [
        (&[][..], &["nobody.k=uniform:0:1"][..], "nobody"),
        (&[], &["other.gian=uniform:0:1"], "gain"),
        (&[], &["fmu-nav.milton.m_b=uniform:1:9"], "Integer"),
        (&[], &["fmu-truth.run=uniform:0:1"], "--run"),
        (&[], &["other.x_hat[1]=uniform:0:1"], "output"),
        (&[], &["other.gain=uniform:-1:1"], "-1"),
        (&["other.gain=2"], &["other.gain=uniform:0:1"], "set as well"),
        (
            &[],
            &["other.gain=uniform:0:1", "other.gain=uniform:0:2"],
            "varied twice",
        ),
    ] {
        let error = vary(sets, variations).err().unwrap().to_string();
        assert!(error.contains(says), "{variations:?}: {error}");
    }
}

#[test]
fn a_study_needs_a_filter_and_its_fmu() {
    let folder = tempfile::tempdir().unwrap();
    let truth = write_fmu(folder.path(), "truth", TRUTH);
    let models = Models::open(&truth, None, &[], &[], &[]).unwrap();
    assert!(matches!(
        models.cast(&worlds::find("leo_venting").unwrap(), &[], &[], &[]),
        Err(StudyError::NoFilter)
    ));
    let milton = ["milton".parse::<FilterChoice>().unwrap()];
    assert!(matches!(
        models.cast(&worlds::find("leo_venting").unwrap(), &milton, &[], &[]),
        Err(StudyError::NoNav { .. })
    ));
    assert!(matches!(
        Models::open(Path::new("/no/such.fmu"), None, &[], &[], &[]),
        Err(StudyError::Import(_))
    ));
}

/// A plan is resolved against its FMUs, and a resolved plan resolves to itself.
#[test]
fn a_plan_becomes_a_study() {
    let folder = tempfile::tempdir().unwrap();
    let own = OwnFmus {
        truth: Some(write_fmu(folder.path(), "truth", TRUTH)),
        nav: Some(write_fmu(folder.path(), "nav", NAV)),
    };
    let plan = Plan {
        filters: Some(vec!["milton@short".parse().unwrap()]),
        runs: 3,
        seed: 9,
        duration_s: Some(100.0),
        assignments: vec!["fmu-truth.sample_period=0.5".parse().unwrap()],
        variations: vec!["fmu-nav.fixed_q.s=uniform:1:2".parse().unwrap()],
        ..Plan::default()
    };
    let models = Models::of(&plan, &own).unwrap();
    let world = &plan.worlds(std::path::Path::new("unused")).unwrap()[0];
    let study = models.study(&plan, world).unwrap();
    let spec = &study.spec;
    assert_eq!((study.runs, spec.seed), (3, 9));
    assert_eq!(study.case, "sample_period-0.5_fixed_q.s-uniform-1-2_duration-100");
    assert_eq!(
        (spec.sample_period.to_bits(), spec.step.to_bits()),
        (0.5_f64.to_bits(), 0.5_f64.to_bits())
    );
    assert_eq!((spec.epochs(), spec.filters[0].varied.len()), (200, 1));
    let resolved = plan.resolved(spec);
    assert_eq!((resolved.step_s, resolved.duration_s), (Some(0.5), Some(100.0)));
    let text = serde_json::to_string(&resolved).unwrap();
    let again: Plan = serde_json::from_str(&text).unwrap();
    let repeated = models
        .spec(&again, &again.worlds(std::path::Path::new("unused")).unwrap()[0])
        .unwrap();
    assert_eq!(again.resolved(&repeated), resolved);
    assert_eq!(format!("{repeated:?}"), format!("{spec:?}"));
}

/// `all` stands for every filter that has a meaning in the world and is not named beside it.
#[test]
fn all_filters_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let own = OwnFmus {
        truth: Some(write_fmu(folder.path(), "truth", TRUTH)),
        nav: Some(write_fmu(folder.path(), "nav", NAV)),
    };
    let labels = |filters: &[&str]| {
        let plan = Plan {
            filters: Some(filters.iter().map(|f| f.parse().unwrap()).collect()),
            ..Plan::default()
        };
        let models = Models::of(&plan, &own).unwrap();
        let spec = models.spec(&plan, &worlds::find("leo_venting").unwrap()).unwrap();
        spec.filters.into_iter().map(|f| f.label).collect::<Vec<_>>()
    };
    assert_eq!(
        labels(&["all"]),
        ["fixed_q", "milton"],
        "the observer means nothing here"
    );
    assert_eq!(labels(&["all", "milton@short"]), ["fixed_q", "milton", "milton@short"]);
    assert_eq!(labels(&["milton", "all"]), ["milton", "fixed_q"]);
    // A bound is asked for by its name.
    assert_eq!(labels(&["all", "oracle"]), ["fixed_q", "milton", "oracle"]);
}

/// What is set in vain everywhere is refused, in one world of several a note; so is a tuned set under other conditions.
#[test]
fn nothing_is_set_in_silence_for_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let own = OwnFmus {
        truth: Some(write_fmu(folder.path(), "truth", TRUTH)),
        nav: Some(write_fmu(folder.path(), "nav", NAV)),
    };
    let set = TunedSet {
        file: None,
        scenario: "leo_venting".to_owned(),
        filter: "milton".to_owned(),
        preset: "paper".to_owned(),
        name: "tuned".to_owned(),
        values: BTreeMap::new(),
        conditions: vec!["sample_period-2".to_owned()],
        search_objective: None,
        search_nees: None,
        feasible: true,
    };
    let plan = |sample_period: &str, vary: &[&str]| Plan {
        filters: Some(vec!["milton@tuned".parse().unwrap()]),
        assignments: vec![format!("fmu-truth.sample_period={sample_period}").parse().unwrap()],
        variations: vary.iter().map(|v| v.parse().unwrap()).collect(),
        tuned: vec![set.clone()],
        ..Plan::default()
    };
    let models = Models::of(&plan("1", &[]), &own).unwrap();
    let notes = |plan: &Plan| {
        let worlds = plan.worlds(folder.path()).unwrap();
        let notes = models.spec(plan, &worlds[0]).unwrap().world.notes;
        let own = notes
            .into_iter()
            .filter(|n| !worlds[0].notes.contains(n))
            .collect::<Vec<_>>();
        (own, models.check_effects(plan, &worlds))
    };
    let (told, checked) = notes(&plan("2", &[]));
    assert!(told.is_empty() && checked.is_ok(), "{told:?}");
    let (told, _) = notes(&plan("1", &[]));
    assert_eq!(
        told,
        ["milton@tuned was found in sample_period-2, not in sample_period-1"]
    );
    let (told, checked) = notes(&plan("2", &["fmu-nav.fixed_q.s=uniform:1:2"]));
    assert!(
        told[0].contains("fmu-nav.fixed_q.s does nothing here: filter 'fixed_q' takes no part"),
        "{told:?}"
    );
    assert!(matches!(checked, Err(StudyError::NoEffect { .. })));
}

/// The status is an enumeration in other words and another order, or a plain Integer.
#[test]
fn status_is_matched_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let truth = write_fmu(folder.path(), "truth", TRUTH);
    let named = FOREIGN.to_owned()
        + r#"<ScalarVariable name="mode" valueReference="4" causality="output" variability="discrete"><Enumeration declaredType="Mode"/></ScalarVariable>"#;
    let theirs = write_fmu(folder.path(), "their", &named);
    let nav = write_fmu(folder.path(), "nav", NAV);
    let theirs: ForeignFilter = format!("theirs={}", theirs.display()).parse().unwrap();
    let mapping: Mapping = "theirs.mode=status".parse().unwrap();
    let models = Models::open(&truth, Some(&nav), &[theirs], &[], &[mapping]).unwrap();
    let ours = ["milton".parse::<FilterChoice>().unwrap()];
    let (_, filters) = models
        .cast(&worlds::find("leo_venting").unwrap(), &ours, &[], &[])
        .unwrap();
    let found = |index: usize| [1, 2, 3, 4, 5].map(|n| filters[index].statuses.status(n));
    assert_eq!(found(0), Status::ALL.map(|(status, ..)| Some(status)));
    assert_eq!(
        found(1),
        [Some(Status::Diverged), None, Some(Status::Tracking), None, None]
    );
}
