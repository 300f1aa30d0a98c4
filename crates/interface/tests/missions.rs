//! Mission files: what comes with the project reads, and what is wrong is named with its place.

use interface::Sensor;
use interface::mission::{Document, EMBEDDED, First, Gravity, Mission, MissionError, embedded, schema};

const LEO: &str = include_str!("../../../missions/leo_venting.toml");

/// The embedded LEO mission with `from` replaced by `to`.
fn changed(from: &str, to: &str) -> Result<Mission, MissionError> {
    assert!(LEO.contains(from), "{from}");
    Mission::parse("leo.toml", &LEO.replacen(from, to, 1))
}

/// Line of the first appearance of `text`, from 1.
fn line(of: &str, text: &str) -> usize {
    of.lines().position(|l| l.contains(text)).map_or(0, |place| place + 1)
}

#[test]
fn every_embedded_mission_reads_and_bears_its_name() {
    for entry in EMBEDDED {
        let mission = entry.mission().unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(mission.name, entry.name);
        assert!(mission.sensors.see_the_target());
    }
    let error = embedded("leo_vent").unwrap_err().to_string();
    assert!(error.contains("leo_vent") && error.contains("leo_venting"), "{error}");
}

#[test]
fn a_mission_written_out_reads_back_as_the_same() {
    for entry in EMBEDDED {
        let mission = entry.mission().unwrap();
        let text = mission.to_toml().unwrap();
        assert_eq!(
            Mission::parse("again", &text).unwrap_or_else(|e| panic!("{e}\n{text}")),
            mission
        );
    }
}

#[test]
fn every_problem_is_named_with_its_place_and_what_is_allowed() {
    // (what stands there, what takes its place, what the message must hold)
    let cases = [
        (
            "grid_s = 1.0",
            "grid = 1.0",
            vec!["unknown key `grid`", "did you mean `grid_s`"],
        ),
        (
            "period_s = 600.0",
            "periot_s = 600.0",
            vec!["unknown key `periot_s`", "did you mean `period_s`"],
        ),
        (
            "duration_s = 5680.0",
            "duration_s = \"long\"",
            vec!["invalid type: string \"long\"", "expected f64"],
        ),
        (
            "sigma_range_m = 0.08",
            "sigma_range_m = -0.08",
            vec!["sensors.lidar.sigma_range_m = -0.08", "at least 0 m"],
        ),
        (
            "sigma_range_m = 0.08",
            "sigma_range_m = nan",
            vec!["sensors.lidar.sigma_range_m = NaN", "finite"],
        ),
        (
            "a_m = 6.878e6",
            "a_m = 6.0e6",
            vec!["below the surface at 6.378", "periapsis"],
        ),
        (
            "start_s = 5560.0",
            "start_s = 5660.0",
            vec!["burn \"capture\" ends at 5690 s", "after the run"],
        ),
        (
            "period_s = 600.0",
            "period_s = 900.0",
            vec!["vent \"co2\"", "after the run"],
        ),
        ("mission = 1", "mission = 2", vec!["newer format", "at most 1"]),
        (
            "after = \"co2\"",
            "after = \"oxygen\"",
            vec!["comes after \"oxygen\"", "stands above"],
        ),
        (
            "{ half_normal = 1.7094e-5 }",
            "{ half_norm = 1.7e-5 }",
            vec!["unknown value `half_norm`", "`half_normal`"],
        ),
        (
            "{ half_normal = 1.7094e-5 }",
            "\"large\"",
            vec!["half_normal", "a number in m/s2"],
        ),
        (
            "model = \"zonal\"",
            "model = \"zonals\"",
            vec!["unknown value `zonals`", "`zonal`"],
        ),
        (
            "direction = [-1.0, -1.0, 0.0]",
            "direction = [0, 0, 0]",
            vec!["burn.capture.direction is zero"],
        ),
        (
            "at = \"end\"",
            "at = \"sometime\"",
            vec!["unknown value `sometime`", "start"],
        ),
    ];
    for (from, to, expected) in cases {
        let error = changed(from, to).unwrap_err().to_string();
        for part in expected {
            assert!(error.contains(part), "{part:?} is missing in: {error}");
        }
        let at = format!("leo.toml:{}:", line(LEO, from));
        assert!(error.contains(&at), "{at} is missing in: {error}");
    }
}

#[test]
fn sensors_that_observe_nothing_are_refused() {
    let begin = LEO.find("[sensors.lidar]").unwrap();
    let end = LEO.find("[sensors.accelerometer]").unwrap();
    let blind = format!("{}{}", &LEO[..begin], &LEO[end..]);
    let error = Mission::parse("blind.toml", &blind).unwrap_err().to_string();
    assert!(
        error.contains("no sensor sees the target") && error.contains("[sensors.lidar]"),
        "{error}"
    );
}

#[test]
fn all_problems_are_told_at_once() {
    let text = LEO.replace("sigma_range_m = 0.08", "sigma_range_m = -1.0").replace(
        "acceleration_m_s2 = 1.0e-2\ndirection = [-1.0, -1.0, 0.0]",
        "acceleration_m_s2 = 1.0e-2\ndirection = [0, 0, 0]",
    );
    let MissionError::Invalid(problems) = Mission::parse("two.toml", &text).unwrap_err() else {
        panic!()
    };
    assert_eq!(problems.len(), 2, "{problems:?}");
    assert!(problems.iter().all(|p| p.place.is_some()));
}

#[test]
fn any_key_can_be_set_and_comments_stay() {
    let mut document = Document::parse("leo", LEO).unwrap();
    for (key, value) in [
        ("vent.co2.period_s", "300"),
        ("vent.waste_water.first_s", "900.0"),
        ("burn.1.duration_s", "20"),
        ("time.epoch_utc", "2030-01-01T00:00:00"),
        ("environment.gravity.mu_m3_s2", "3.9e14"),
        ("sensors.radio.sigma_range_m", "2.0"),
        ("navigation.law.snc.q", "1e-5"),
    ] {
        document.set(key, value).unwrap_or_else(|e| panic!("{e}"));
    }
    let mission = document.mission().unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(mission.vents[0].period_s, Some(300.0));
    assert_eq!(mission.vents[1].first_s, First::At(900.0));
    assert!((mission.burns[0].duration_s - 20.0).abs() < 1e-15);
    assert_eq!(mission.time.epoch_utc.as_deref(), Some("2030-01-01T00:00:00"));
    let Gravity::Zonal(gravity) = &mission.environment.gravity else {
        panic!()
    };
    assert!((gravity.mu_m3_s2 - 3.9e14).abs() < 1.0);
    assert!(mission.sensors.radio.is_some());
    assert_eq!(mission.navigation.law.get("snc.q"), Some(&1e-5));
    assert!(
        document
            .text()
            .contains("# the run ends with the rendezvous (Sec. IV.A)")
    );

    let error = document.set("vent.oxygen.count", "2").unwrap_err().to_string();
    assert!(
        error.contains("mission.vent.oxygen.count") && error.contains("co2, waste_water"),
        "{error}"
    );
    document.set("time.duratoin_s", "1").unwrap();
    let error = document.mission().unwrap_err().to_string();
    assert!(error.contains("did you mean `duration_s`"), "{error}");
}

#[test]
fn files_are_read_from_their_folder() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("m.toml");
    std::fs::write(&path, LEO).unwrap();
    let mission = Mission::read(&path).unwrap();
    assert_eq!(mission.locate("field.csv".as_ref()), folder.path().join("field.csv"));
    let error = Mission::read(&folder.path().join("none.toml")).unwrap_err().to_string();
    assert!(error.contains("none.toml"), "{error}");
}

#[test]
fn the_filter_is_told_its_own_gravity_and_the_sensors_noise() {
    let mission = embedded("formation").unwrap().mission().unwrap();
    let told = mission.navigation();
    assert!(matches!(told.gravity, Gravity::Zonal(_)));
    assert!((told.p0.position - 1e-2).abs() < 1e-18 && (told.p0.acceleration - 1.5e-6).abs() < 1e-20);
    let own = embedded("leo_venting").unwrap().mission().unwrap().navigation();
    let lidar = own.sensor(Sensor::Lidar).unwrap();
    let expected = [0.08, 0.04_f64.to_radians(), 0.04_f64.to_radians()];
    assert!(lidar.deviations().eq(expected) && (lidar.period_s - 1.0).abs() < 1e-15);
    assert!(own.told.is_empty());
}

#[test]
fn schema_knows_every_section() {
    let schema = schema();
    for key in [
        "grid_s",
        "half_normal",
        "field_of_view_deg",
        "disturbance_m_s2",
        "back_propagated",
    ] {
        assert!(schema.contains(key), "{key}");
    }
}

#[test]
fn every_mission_in_the_folder_reads() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../missions");
    let mut seen = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|e| e == "toml") {
            let mission = Mission::read(&path).unwrap_or_else(|e| panic!("{e}"));
            assert_eq!(Some(mission.name.as_str()), path.file_stem().and_then(|s| s.to_str()));
            assert_eq!(mission.notes(), Vec::<String>::new(), "{}", path.display());
            seen += 1;
        }
    }
    assert!(seen >= EMBEDDED.len());
}

const FORMATION: &str = include_str!("../../../missions/formation.toml");
const NRHO: &str = include_str!("../../../missions/nrho_venting.toml");

#[test]
fn surroundings_that_make_no_sense_are_refused_in_words() {
    let layer = "drag = { density_kg_m3 = 1e-12, reference_altitude_m = 1e5, scale_height_m = 2e4 }";
    let epoch = "epoch_utc = \"2020-01-01T00:00:00\" # the paper prints none\n";
    // (file, what stands there, what takes its place, what the message must hold)
    type Changes<'a> = &'a [(&'a str, &'a str)];
    let cases: [(&str, Changes<'_>, &str); 16] = [
        (FORMATION, &[(epoch, "")], "the places of Sun and Moon needs a date"),
        (
            FORMATION,
            &[
                (epoch, ""),
                ("third_bodies = [\"sun\", \"moon\"]", ""),
                ("radiation = { shadow = \"cylindrical\" }", ""),
            ],
            "the turn of the body's axes needs a date",
        ),
        (
            FORMATION,
            &[(
                "third_bodies = [\"sun\", \"moon\"]",
                "third_bodies = [\"sun\", \"sun\"]",
            )],
            "\"sun\" is named twice",
        ),
        (
            FORMATION,
            &[("[\"sun\", \"moon\"]", "[\"sun\", \"earth\"]")],
            "\"earth\" is not known about",
        ),
        (
            FORMATION,
            &[("[environment]", "[environment]\nbody = \"moon\"")],
            "\"moon\" is not known about body = Moon",
        ),
        (
            FORMATION,
            &[("2020-01-01T00:00:00", "2021-02-29T00:00:00")],
            "is no date",
        ),
        (
            FORMATION,
            &[("2020-01-01T00:00:00", "2020-01-01")],
            "lacks the day or the time of day",
        ),
        (
            FORMATION,
            &[("2020-01-01T00:00:00", "2020-01-01T00:00:00+01:00")],
            "has an offset",
        ),
        (
            FORMATION,
            &[("2020-01-01T00:00:00", "1820-01-01T00:00:00")],
            "is not in the years 1900 to 2100",
        ),
        (
            FORMATION,
            &[("2020-01-01T00:00:00", "2016-12-31T23:59:60")],
            "has a leap second",
        ),
        (
            LEO,
            &[(
                "[environment]",
                "[environment]\nbody = \"moon\"\ndrag = { density_kg_m3 = 1e-12, reference_altitude_m = 1e5, scale_height_m = 2e4 }",
            )],
            "the turn of the air needs a date",
        ),
        (
            FORMATION,
            &[(
                "drag = { atmosphere = \"exponential\" }",
                "drag = {}\nrotation = { rate_deg_s = 0.004 }",
            )],
            "the Earth's air turns with the Earth",
        ),
        (LEO, &[("grid_s = 1.0", "grid_s = 0.7")], "must be a multiple of it"),
        (
            LEO,
            &[(
                "[navigation]\ngravity = { model = \"zonal\", mu_m3_s2 = 3.986e14, radius_m = 6.378e6, j = [1.083e-3, -2.532e-6, -1.620e-6] }",
                "[navigation]\ngravity = { model = \"harmonics\", field = \"egm96_3x3\" }",
            )],
            "the turn of the body's axes needs a date",
        ),
        (
            NRHO,
            &[(
                "[navigation]",
                "[navigation]\ngravity = { model = \"cr3bp\", mass_ratio = 1.215e-2, length_m = 3.8e8, time_s = 3.752e5, inertial_angle_at_end_rad = 0.7 }",
            )],
            "it must be environment.gravity.length_m = 384400000",
        ),
        (
            FORMATION,
            &[(
                "[navigation]",
                "[[burn]]\nname = \"turn\"\nvehicle = \"chaser\"\ntold = true\nstart_s = 10.0\nduration_s = 5.0\nacceleration_m_s2 = 0.01\naxes = \"n\"\ndirection = [1.0, 0.0, 0.0]\n\n[navigation]",
            )],
            "axes of a told burn must be rtn",
        ),
    ];
    for (file, changes, expected) in cases {
        let mut text = file.to_owned();
        for (from, to) in changes {
            assert!(text.contains(from), "{from}");
            text = text.replacen(from, to, 1);
        }
        let error = Mission::parse("m.toml", &text).unwrap_err().to_string();
        assert!(
            error.contains(expected) && error.contains("m.toml:"),
            "{expected:?} is missing in: {error}"
        );
    }
    let other = FORMATION
        .replace("[environment]", "[environment]\nbody = \"other\"")
        .replace("third_bodies = [\"sun\", \"moon\"]", "")
        .replace("radiation = { shadow = \"cylindrical\" }", "")
        .replace("drag = { atmosphere = \"exponential\" }", layer);
    let error = Mission::parse("m.toml", &other).unwrap_err().to_string();
    assert!(error.contains("environment.rotation is missing"), "{error}");
    let turning = other.replace(
        "body = \"other\"",
        "body = \"other\"\nrotation = { rate_deg_s = 0.004 }",
    );
    Mission::parse("m.toml", &turning).unwrap();
    let measured = NRHO.replace("[sensors.lidar]", "[sensors.metrology]\n[sensors.lidar]");
    let error = Mission::parse("m.toml", &measured).unwrap_err().to_string();
    assert!(error.contains("the three-body problem has not"), "{error}");
}

#[test]
fn dates_are_taken_as_toml_or_as_text() {
    let date = |text: &str| {
        let file = FORMATION.replace("\"2020-01-01T00:00:00\"", text);
        Mission::parse("m.toml", &file).unwrap().time.epoch_utc.unwrap()
    };
    for text in [
        "2020-01-01T00:00:00",
        "2020-01-01 00:00:00",
        "\"2020-01-01 00:00:00\"",
        "\"2020-01-01T00:00:00\"",
    ] {
        assert_eq!(date(text), "2020-01-01T00:00:00", "{text}");
    }
    assert_eq!(date("1999-12-31T23:59:59.5Z"), "1999-12-31T23:59:59.5Z");
}
