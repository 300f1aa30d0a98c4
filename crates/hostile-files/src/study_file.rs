//! Study files, and files of names.

use study::{Plan, StudyError, read_mappings};

use crate::cage::cage;
use crate::{Kind, told};

pub(crate) const KIND: Kind = Kind {
    name: "study",
    feed,
    seeds,
};

fn feed(bytes: &[u8]) {
    let cage = cage();
    let path = cage.put("given.toml", bytes);
    match Plan::read(&path) {
        Ok(plan) => {
            // What it asks for may be wrong, which names the key.
            if plan.check().is_ok() {
                let text = plan.to_toml().expect("a plan that was read can be written");
                let again = Plan::parse("again", &text).expect("what is written can be read");
                assert_eq!(again.case_text(), plan.case_text());
            }
        }
        Err(error) => told(&error, "given.toml"),
    }
    match read_mappings(&path) {
        Ok(_) => (),
        Err(error @ (StudyError::File { .. } | StudyError::FileProblem(_) | StudyError::Mappings { .. })) => {
            told(&error, "given.toml");
        }
        Err(error) => panic!("{error}"),
    }
    cage.check(&[&path]);
}

fn seeds() -> Vec<(String, Vec<u8>)> {
    let grids = "scenario = [\"leo_venting\"]\nruns = 3\nfilters = [\"snc\", \"milton@consistent\"]\n\
        set = [\"fmu-truth.vent.scale=10\"]\nvary = [\"fmu-truth.lidar.sigma_range=loguniform:0.01:1\"]\n\
        [[grid]]\nset = { \"fmu-truth.a\" = [1, 2.5, true, \"x\"] }\n[[grid]]\nlhs = 3\nrange = { \"fmu-nav.b\" = \"uniform:0:1\" }\n\
        [[grid]]\ncases = [{ case = \"one\", \"fmu-nav.c\" = 1 }]\n[[phase]]\nname = \"last\"\nfrom_s = 10\n\
        [[require]]\nmetric = \"nees\"\nat_most = 2\n";
    let mut seeds = vec![
        ("grids".to_owned(), grids.as_bytes().to_vec()),
        (
            "names".to_owned(),
            b"# theirs\n[a]\nx_hat = \"est.r_tc_n\"\n\"P[1,2]\" = \"cov.p[1,2]\"\n".to_vec(),
        ),
    ];
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies");
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|e| e == "toml") {
            let name = path.file_stem().unwrap().to_string_lossy().into_owned();
            seeds.push((name, std::fs::read(&path).unwrap()));
        }
    }
    seeds.sort();
    seeds
}
