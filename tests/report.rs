//! The HTML page of a study: what it says, that it needs nothing from outside, and that it works in a browser.

#![allow(clippy::unwrap_used, clippy::panic, reason = "what fails here is a failed test")]

mod common;

use common::{harness, harness_ok, read_csv, results, skipped};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::OnceLock;

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// A study of four runs of two filters with something set and varied, made once.
fn study() -> &'static Path {
    static FOLDER: OnceLock<tempfile::TempDir> = OnceLock::new();
    let folder = FOLDER.get_or_init(|| {
        let folder = tempfile::tempdir().unwrap();
        harness_ok(&[
            "compare",
            "--filters",
            "fixed_q,snc,milton",
            "--runs",
            "4",
            "--seed",
            "7",
            "--set",
            "fmu-truth.vent.scale=3",
            "--vary",
            "fmu-truth.lidar.sigma_range=loguniform:0.05:0.2",
            "--out",
            text(folder.path()),
        ]);
        folder
    });
    folder.path()
}

fn page(folder: &Path) -> String {
    std::fs::read_to_string(folder.join("report.html")).unwrap()
}

/// What stands between two texts.
fn between<'a>(text: &'a str, before: &str, after: &str) -> &'a str {
    let begin = text
        .find(before)
        .unwrap_or_else(|| panic!("{before:?} is missing in {text:.300}"))
        + before.len();
    let rest = &text[begin..];
    &rest[..rest.find(after).unwrap()]
}

/// A value with its standard error as it is printed, each to two digits of the error.
fn value_and_error(printed: &str) -> (f64, f64) {
    let (value, error) = printed.split_once("\u{a0}±\u{a0}").unwrap();
    (value.trim().parse().unwrap(), error.trim().parse().unwrap())
}

fn holds(printed: (f64, f64), expected: (f64, f64)) {
    // Half a unit of the second digit is at most a twentieth.
    let near = |a: f64, b: f64| (a - b).abs() <= 0.051 * expected.1;
    assert!(
        near(printed.0, expected.0) && near(printed.1, expected.1),
        "{printed:?} instead of {expected:?}"
    );
}

#[test]
fn the_verdict_is_that_of_the_tables() {
    let folder = study();
    let number = |row: &HashMap<String, String>, name: &str| row[name].parse::<f64>().unwrap();
    let mut summary = read_csv(&folder.join("summary.csv"));
    summary.sort_by(|a, b| number(a, "pos_rmse_m").total_cmp(&number(b, "pos_rmse_m")));
    let runs = read_csv(&folder.join("runs.csv"));
    let of = |filter: &str| -> Vec<f64> {
        let rows = runs.iter().filter(|r| r["filter"] == filter);
        rows.map(|r| number(r, "pos_rmse_m")).collect()
    };
    let (best, next) = (&summary[0], &summary[1]);
    let (ours, theirs) = (of(&best["filter"]), of(&next["filter"]));
    let differences: Vec<f64> = theirs.iter().zip(&ours).map(|(a, b)| a - b).collect();
    let n = differences.len() as f64;
    assert_eq!(differences.len(), 4);
    let mean = differences.iter().sum::<f64>() / n;
    let error = (differences.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / (n - 1.0) / n).sqrt();

    let page = page(folder);
    let verdict = between(&page, "<section class=\"verdict\">", "</section>");
    let headline = between(verdict, "<p class=\"headline\">", "</p>");
    assert!(headline.starts_with(&best["filter"]), "{headline}");
    holds(
        value_and_error(between(headline, "RMSE, ", "\u{a0}m")),
        (number(best, "pos_rmse_m"), number(best, "pos_rmse_se_m")),
    );
    let told = if mean > 2.0 * error {
        format!("The next, {}, is worse by ", next["filter"])
    } else {
        format!(
            "It cannot be told apart from the next, {}, at two standard errors: the difference is ",
            next["filter"]
        )
    };
    holds(value_and_error(between(verdict, &told, "\u{a0}m")), (mean, error));
}

#[test]
fn deviations_badges_digests_and_replays_are_named() {
    let folder = study();
    let page = page(folder);
    let setting = between(&page, "<p class=\"setting deviates\">", "</p>");
    for part in [
        "set fmu-truth.vent.scale=3",
        "varied fmu-truth.lidar.sigma_range=loguniform:0.05:0.2",
        "<b>runs</b> 4",
        "<b>seed</b> 7",
        "<b>duration</b> 5680 s",
    ] {
        assert!(setting.contains(part), "{part}: {setting}");
    }
    let manifest: serde_json::Value =
        serde_json::from_slice(&std::fs::read(folder.join("manifest.json")).unwrap()).unwrap();
    for digest in [&manifest["identity"], &manifest["models"]["fmu-nav"]["guid"]] {
        assert!(page.contains(digest.as_str().unwrap()), "{digest}");
    }
    // The filters whose mean NEES is within the bounds are marked as such, and no others.
    let inside = |row: &&HashMap<String, String>| {
        let number = |name: &str| row[name].parse::<f64>().unwrap();
        (number("nees_low")..=number("nees_high")).contains(&number("nees"))
    };
    let summary = read_csv(&folder.join("summary.csv"));
    let badges = between(&page, "<table class=\"badges\">", "</table>");
    let marked = badges.matches("<td class=\"good\">NEES").count();
    assert_eq!(marked, summary.iter().filter(inside).count(), "{badges}");
    assert_eq!(badges.matches("NEES").count(), summary.len());
    let runs = read_csv(&folder.join("runs.csv"));
    let worst = runs
        .iter()
        .filter(|r| r["filter"] == "snc")
        .max_by(|a, b| {
            let rmse = |r: &HashMap<String, String>| r["pos_rmse_m"].parse::<f64>().unwrap();
            rmse(a).total_cmp(&rmse(b))
        })
        .unwrap();
    let command = format!(
        "trade-harness replay DIR --scenario leo_venting --case {} --run {} --filter snc",
        worst["case"], worst["run"]
    );
    let section = between(&page, "<summary>snc</summary>", "</details>");
    assert_eq!(between(section, "<code>", "</code>"), command);
    // And it does what it says: the run has the error that the study found.
    let out = folder.join("../replayed.csv");
    let folder = folder.to_str().unwrap();
    let line: Vec<&str> = command
        .split(' ')
        .skip(1)
        .map(|word| if word == "DIR" { folder } else { word })
        .collect();
    harness_ok(&[&line[..], &["--out", out.to_str().unwrap()]].concat());
    let rows = read_csv(&out);
    let scored = rows.iter().filter(|row| row["t_s"].parse::<f64>().unwrap() >= 300.0);
    let squares = scored.map(|row| {
        let error = |axis: &str| row[&format!("err_pos_{axis}_m")].parse::<f64>().unwrap();
        ["r", "t", "n"].map(|axis| error(axis).powi(2)).iter().sum::<f64>()
    });
    let squares: Vec<f64> = squares.collect();
    let rmse = (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
    assert!(
        (rmse / worst["pos_rmse_m"].parse::<f64>().unwrap() - 1.0).abs() < 1e-9,
        "{rmse}"
    );
}

#[test]
fn the_page_asks_no_host_and_is_small() {
    let page = page(study());
    assert!(page.len() < 5_000_000, "{} bytes", page.len());
    // Names of XML are no addresses; one comment names the home of the plots' library.
    let outside: Vec<&str> = page
        .match_indices("://")
        .map(|(at, _)| {
            let end = page[at..].find([' ', '"', '\'', '`', ')', '\n']).unwrap_or(0) + at;
            let begin = page[..at]
                .rfind(|c: char| !c.is_ascii_alphabetic())
                .map_or(0, |b| b + 1);
            &page[begin..end]
        })
        .filter(|address| *address != "http://www.w3.org/2000/svg" && *address != "https://github.com/leeoniya/uPlot")
        .collect();
    assert!(outside.is_empty(), "{outside:?}");
    assert!(page.contains("default-src 'none'"));
}

/// Made again, from a folder in another place, it is the same; without the files over time it still is a page.
#[test]
fn a_folder_that_was_sent_gives_the_same_page() {
    let sent = tempfile::tempdir().unwrap();
    for (name, bytes) in results(study()) {
        let path = sent.path().join(&name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        if name != "report.html" {
            std::fs::write(path, bytes).unwrap();
        }
    }
    harness_ok(&["report", text(sent.path())]);
    assert!(page(sent.path()) == page(study()), "another page");
    std::fs::remove_dir_all(sent.path().join("epochs")).unwrap();
    harness_ok(&["report", text(sent.path())]);
    assert!(page(sent.path()).contains("there are no figures over time"));
}

/// Figures of the page by class, and the beginning of the name of the files that hold them; tables are CSV files already.
const FILES: [(&str, Option<&str>); 13] = [
    ("search", Some("search_")),
    ("cases", Some("cases")),
    ("phases", Some("phases")),
    ("errors", Some("error_")),
    ("consistency", Some("consistency")),
    ("noise", Some("process_noise")),
    ("path", Some("path")),
    ("forest", Some("paired_")),
    ("cdf", Some("runs_")),
    ("learning", Some("learning_curve")),
    ("window", None),
    ("summary", None),
    ("summary lines", None),
];

/// Draws all figures of a folder; each that its page has must be there as SVG and as PNG of twice the size, and no other.
///
/// * returns: the kinds of figures; `None` on a system without a font.
fn drawn(folder: &Path, prefix: &str) -> Option<Vec<&'static str>> {
    let output = harness(&["report", text(folder), "--svg", "--png"]);
    let said = String::from_utf8_lossy(&output.stderr);
    if said.contains("no font was found") {
        skipped("figures as files", "fonts-dejavu-core");
        return None;
    }
    assert!(output.status.success(), "{said}");
    let mut names: Vec<String> = std::fs::read_dir(folder.join("figures"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    let mut found = Vec::new();
    let page = page(folder);
    for class in page.split("<figure class=\"").skip(1) {
        let class = class.split('"').next().unwrap();
        let (class, file) = FILES
            .iter()
            .find(|(known, _)| *known == class)
            .unwrap_or_else(|| panic!("nobody says where the figure {class:?} is written"));
        let Some(file) = file else { continue };
        found.push(*class);
        let begin = format!("{prefix}{file}");
        let (of_class, others) = names.into_iter().partition(|name: &String| name.starts_with(&begin));
        names = others;
        let of_class: Vec<String> = of_class;
        assert!(!of_class.is_empty(), "{class}: no file {begin}*");
        for name in &of_class {
            let (stem, extension) = name.rsplit_once('.').unwrap();
            let [svg, png] = ["svg", "png"].map(|e| std::fs::read(folder.join(format!("figures/{stem}.{e}"))).unwrap());
            let svg = String::from_utf8(svg).unwrap();
            assert!(["svg", "png"].contains(&extension) && svg.contains("<text"), "{name}");
            assert_eq!(&png[..8], b"\x89PNG\r\n\x1a\n", "{name}");
            let side = |at: usize| u32::from_be_bytes(png[at..at + 4].try_into().unwrap());
            let units = |side: &str| between(&svg, &format!(" {side}=\""), "\"").parse::<u32>().unwrap();
            assert_eq!(
                [side(16), side(20)],
                ["width", "height"].map(|side| 2 * units(side)),
                "{name}"
            );
        }
    }
    assert!(names.is_empty(), "of no figure: {names:?}");
    Some(found)
}

#[test]
fn every_figure_of_the_page_is_written_as_svg_and_png() {
    let sent = copy_of_the_study();
    // Another case beside the one of the study, and a search of two filters.
    let summary = std::fs::read_to_string(study().join("summary.csv")).unwrap();
    let case = read_csv(&study().join("summary.csv"))[0]["case"].clone();
    let more: Vec<String> = summary
        .lines()
        .skip(1)
        .map(|line| line.replace(&case, "another") + "\n")
        .collect();
    std::fs::write(sent.path().join("summary.csv"), summary + &more.concat()).unwrap();
    std::fs::write(sent.path().join("search.csv"), SEARCH).unwrap();
    let prefix = format!("leo_venting_{case}_");
    let Some(found) = drawn(sent.path(), &prefix) else {
        return;
    };
    assert_eq!(
        found,
        [
            "search",
            "cases",
            "phases",
            "errors",
            "consistency",
            "noise",
            "path",
            "forest",
            "cdf"
        ]
    );
    // What each must show beside its curves: names, quantities with units.
    for (name, shows) in [
        (
            "error_snc",
            &[
                "position, r [m]",
                "velocity, n [10⁻³ m/s]",
                "time [s]",
                "mean error",
                "single runs",
                "vents",
                "stroke=\"#C8C8C8\"",
            ][..],
        ),
        (
            "consistency",
            &["NEES / states [1]", "NIS / rows [1]", "snc", "95 % bounds"],
        ),
        (
            "paired_position",
            &[
                "difference of position RMSE",
                "[m]",
                "milton − fixed_q",
                "snc − fixed_q",
            ],
        ),
        ("process_noise", &["√q, x [m/s²·⁵]", "time [s]", "milton"]),
        ("path", &["true path of run 0", "t [m]", "r [m]", "burns"]),
        (
            "runs_velocity",
            &["velocity RMSE of a run [m/s]", "share of runs", "fixed_q"],
        ),
        ("search_snc", &["snc.q", "position RMSE [m]", "as given", "10⁻⁶"]),
        ("phases", &["position RMSE [m] by phase", "scored", "vents", "milton"]),
        ("cases", &["position RMSE [m] by case", "another", &case, "milton"]),
    ] {
        let svg = std::fs::read_to_string(sent.path().join(format!("figures/{prefix}{name}.svg"))).unwrap();
        for part in shows {
            assert!(svg.contains(part), "{name}: {part}");
        }
    }
    // A heat map prints what the table says: each value twice, once for each case.
    let svg = std::fs::read_to_string(sent.path().join(format!("figures/{prefix}cases.svg"))).unwrap();
    for row in read_csv(&study().join("summary.csv")) {
        let value: f64 = row["pos_rmse_m"].parse().unwrap();
        // Of three digits: half a unit of the last is at most a two hundredth.
        let same = |shown: &f64| (shown / value - 1.0).abs() <= 0.005;
        let shown = svg.lines().filter_map(|line| line.trim().parse().ok()).filter(same);
        assert_eq!(shown.count(), 2, "{value}");
    }
}

#[test]
fn a_folder_that_is_no_study_is_refused_and_left_alone() {
    let folder = tempfile::tempdir().unwrap();
    let refused = |says: &[&str]| {
        let output = harness(&["report", text(folder.path())]);
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{said}");
        for part in says {
            assert!(said.contains(part), "'{part}' is missing in: {said}");
        }
        assert!(!folder.path().join("report.html").exists());
    };
    refused(&[text(folder.path()), "no manifest.json", "compare --out"]);
    std::fs::write(folder.path().join("manifest.json"), "[1, 2]").unwrap();
    refused(&["manifest.json", "no manifest"]);
    std::fs::copy(study().join("manifest.json"), folder.path().join("manifest.json")).unwrap();
    refused(&["no summary.csv"]);
    std::fs::write(folder.path().join("summary.csv"), "a,b\n1,2\n").unwrap();
    refused(&["summary.csv", "no column 'scenario'"]);
}

/// Works the page and writes what it finds into an element of its own.
const PROBE: &str = r#"<script>
addEventListener("load", () => setTimeout(async () => {
  const figure = (name) => document.querySelector(`figure.${name}`);
  const shown = {};
  const note = (name, value) => { shown[name] = value; };
  note("plots", document.querySelectorAll("canvas").length);
  const tabs = [...figure("errors").querySelectorAll("[role=tab]")];
  note("tabs", tabs.map((t) => t.textContent).join(","));
  tabs[1].click();
  note("chosen", figure("errors").querySelector(".chosen").textContent);
  const quantity = [...figure("forest").querySelectorAll("[role=tab]")];
  quantity[1].click();
  note("forest", figure("forest").querySelector("svg").textContent.includes("velocity RMSE [") && figure("forest").querySelectorAll("circle").length);
  const head = [...figure("summary").querySelectorAll("thead button")].find((b) => b.textContent.startsWith("position RMSE"));
  const order = () => [...figure("summary").querySelectorAll("tbody th")].map((c) => c.textContent).join(",");
  head.click();
  note("ascending", order());
  head.click();
  note("descending", order());
  const curves = () => figure("cdf").querySelectorAll("svg path[data-last]").length;
  const before = curves();
  figure("cdf").querySelector("[aria-pressed]").click();
  note("hidden", before - curves());
  // A drag over the first plot zooms all of its figure; a double click resets them.
  const spans = () => [...figure("errors").querySelectorAll(".plots > div")].map((d) => Math.round(d.dataset.to - d.dataset.from));
  const wait = () => new Promise((done) => setTimeout(done, 200));
  // A plot finds its place only after the script that made it.
  await wait();
  const over = figure("errors").querySelector(".u-over"), box = over.getBoundingClientRect();
  const mouse = (kind, part, target) => target.dispatchEvent(new MouseEvent(kind, { bubbles: true, button: 0, clientX: box.left + part * box.width, clientY: box.top + 0.5 * box.height, movementX: 5, movementY: 5 }));
  const whole = spans();
  mouse("mouseenter", 0.25, over);
  mouse("mousemove", 0.25, over);
  mouse("mousedown", 0.25, over);
  await wait();
  mouse("mousemove", 0.5, over);
  await wait();
  mouse("mouseup", 0.5, document);
  await wait();
  note("zoomed", spans().every((s, i) => Math.abs(s / whole[i] - 0.25) < 0.05));
  const others = [...document.querySelectorAll("figure.consistency .plots > div, figure.noise .plots > div")].map((d) => Math.round(d.dataset.to - d.dataset.from));
  note("shared", others.length === 5 && others.every((s) => s === spans()[0]));
  const time = () => [figure("window").querySelector(".span").textContent, ...[...figure("window").querySelectorAll("tbody tr")].map((r) => [...r.cells].map((c) => c.dataset.value ?? c.textContent))];
  note("part", time());
  mouse("mousemove", 0.4, over);
  await wait();
  note("readout", figure("errors").querySelector(".readout").textContent);
  mouse("dblclick", 0.5, over);
  await wait();
  note("reset", String(spans()) === String(whole));
  note("scored", time());
  [...figure("window").querySelectorAll("thead button")].find((b) => b.textContent.startsWith("position RMSE")).click();
  note("window", [...figure("window").querySelectorAll("tbody th")].map((c) => c.textContent).join(","));
  // Pixels of the first plot change with the single runs.
  const pixels = () => {
    const canvas = figure("errors").querySelector("canvas");
    return canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
  };
  const runs = [...figure("errors").querySelectorAll("[aria-pressed]")].find((b) => b.textContent === "single runs");
  const before_click = pixels();
  runs.click();
  await wait();
  const after_click = pixels();
  note("runs", before_click.filter((v, i) => v !== after_click[i]).length > 4000);
  runs.click();
  note("paths", figure("path").querySelectorAll("svg path[data-last]").length);
  // Every figure hands over its numbers, and all but the tables a picture.
  const saved = [];
  const make = URL.createObjectURL;
  URL.createObjectURL = (blob) => { saved.push(blob); return make.call(URL, blob); };
  HTMLAnchorElement.prototype.click = () => {};
  document.querySelectorAll("figure .export").forEach((b) => b.click());
  const texts = await Promise.all(saved.map((blob) => blob.text()));
  const parser = new DOMParser();
  note("svgs", texts.filter((t, i) => saved[i].type === "image/svg+xml" && parser.parseFromString(t, "image/svg+xml").querySelector("parsererror") === null && t.includes("<path")).length);
  note("csvs", texts.filter((t, i) => saved[i].type === "text/csv" && t.split("\n").length > 3).length);
  note("error_csv", texts.find((t) => t.startsWith("filter,time [s]")).split("\n").slice(0, 1)[0]);
  const theme = document.documentElement.dataset.theme;
  document.getElementById("theme").click();
  note("theme", theme !== document.documentElement.dataset.theme);
  note("wide", document.documentElement.scrollWidth > innerWidth);
  note("resources", performance.getEntriesByType("resource").length);
  const made = document.createElement("pre");
  made.id = "probe";
  made.textContent = JSON.stringify(shown);
  document.body.append(made);
}, 200));
</script>"#;

/// A page in headless Chromium: what the probe found, and what stood on the console. `None` without Chromium.
fn browsed(page: &str, probe: &str, size: &str) -> Option<(serde_json::Value, Vec<String>)> {
    let folder = tempfile::tempdir().unwrap();
    let file: PathBuf = folder.path().join("probed.html");
    std::fs::write(&file, page.replace("</body>", &format!("{probe}</body>"))).unwrap();
    let output = Command::new("chromium")
        .args([
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--disable-background-networking",
        ])
        .args(["--virtual-time-budget=10000", "--enable-logging=stderr", "--dump-dom"])
        .arg(format!("--window-size={size}"))
        .arg(format!("--user-data-dir={}", folder.path().join("profile").display()))
        .arg(format!("file://{}", file.display()))
        .stdin(Stdio::null())
        .output()
        .ok()?;
    let console = String::from_utf8_lossy(&output.stderr);
    let console = console.lines().filter(|l| l.contains("CONSOLE")).map(str::to_owned);
    let dom = String::from_utf8(output.stdout).unwrap();
    let found = serde_json::from_str(between(&dom, "<pre id=\"probe\">", "</pre>")).unwrap();
    Some((found, console.collect()))
}

/// Counts what is drawn in the figures that not every folder has.
const COUNTS: &str = r#"<script>
addEventListener("load", () => setTimeout(() => {
  const all = (selector) => [...document.querySelectorAll(selector)];
  const pairs = [...all("figure.forest [role=tab]")].find((b) => b.textContent === "milton");
  const every = all("figure.forest circle").length;
  pairs?.click();
  const made = document.createElement("pre");
  made.id = "probe";
  made.textContent = JSON.stringify({
    cells: all("figure.phases rect").length,
    bold: all("figure.phases text[font-weight='700']").map((t) => t.textContent).join(","),
    pairs: [every, all("figure.forest circle").length],
    mirrored: document.querySelector("figure.forest svg")?.textContent.includes("fixed_q − milton"),
    tries: all("figure.search circle").length,
    edges: all("figure.search rect[fill^=rgba]").length,
    learning: all("figure.learning path[data-last]").length,
    rows: all("figure.lines tbody tr").length,
    good: all("figure.lines td.good").length,
    wide: document.documentElement.scrollWidth > innerWidth,
    resources: performance.getEntriesByType("resource").length,
  });
  document.body.append(made);
}, 200));
</script>"#;

fn copy_of_the_study() -> tempfile::TempDir {
    let sent = tempfile::tempdir().unwrap();
    for (name, bytes) in results(study()) {
        let path = sent.path().join(&name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, bytes).unwrap();
    }
    sent
}

/// A search of one filter and one parameter.
const SEARCH: &str = "\
scenario,filter,evaluation,round,values,ranges,objective,value,nees,failed,diverged,bad_runs,feasible
leo_venting,snc,1,0,,snc.q=1e-6:1e-2,position,3,1,0,0,0,1
leo_venting,snc,2,0,snc.q=1e-4,snc.q=1e-6:1e-2,position,2,1,0,0,0,1
leo_venting,snc,3,0,snc.q=2e-3,snc.q=1e-6:1e-2,position,1,9,0,0,0,0
";

/// A copy of the study with more tables beside it, and its page.
fn with_tables(tables: &[(&str, &str)]) -> String {
    let sent = copy_of_the_study();
    for (name, text) in tables {
        std::fs::write(sent.path().join(name), text).unwrap();
    }
    harness_ok(&["report", text(sent.path())]);
    page(sent.path())
}

#[test]
fn phases_requirements_pairs_and_searches_are_shown_where_they_are() {
    let case = read_csv(&study().join("summary.csv"))[0]["case"].clone();
    let phases: String = ["scored,1.5,2.5,3.5", "vents,8,7,6"]
        .iter()
        .flat_map(|line| {
            let (phase, values) = line.split_once(',').unwrap();
            let of = ["fixed_q", "snc", "milton"].into_iter().zip(values.split(','));
            of.map(|(filter, v)| format!("leo_venting,{filter},{case},{phase},{v}\n"))
                .collect::<Vec<_>>()
        })
        .collect();
    let pair = |filter: &str, reference: &str, low: f64| {
        format!(
            "leo_venting,{filter},{reference},{case},pos_rmse_m,4,9,1,{},{low},{}\n",
            low + 1.0,
            low + 2.0
        )
    };
    let pairs = [
        pair("snc", "fixed_q", -3.0),
        pair("milton", "fixed_q", 1.0),
        pair("milton", "snc", 4.0),
    ]
    .concat();
    let page = with_tables(&[
        (
            "phases.csv",
            &format!("scenario,filter,case,phase,pos_rmse_m\n{phases}"),
        ),
        (
            "requirements.csv",
            &format!(
                "scenario,filter,case,metric,phase,at_least,at_most,value,unit,margin,verdict\n\
                 leo_venting,snc,{case},pos_p95_m,vents,,0.5,0.25,m,0.25,met\n\
                 leo_venting,milton,{case},pos_p95_m,,,0.5,2,m,-1.5,MISSED\n"
            ),
        ),
        (
            "paired.csv",
            &format!(
                "scenario,filter,reference,case,quantity,runs,mean_difference,standard_error,difference,low,high\n{pairs}"
            ),
        ),
        ("search.csv", SEARCH),
    ]);
    let list = between(&page, "Every requirement is met by snc, not by milton.", "</details>");
    assert!(
        list.contains("1 of 2 requirements are met")
            && list.contains("<li class=\"good\"><b>met</b> snc: pos_p95_m in vents 0.250 m, required ≤ 0.500")
            && list.contains("<li class=\"bad\"><b>missed</b> milton: pos_p95_m 2.00 m, required ≤ 0.500")
            && list.contains("margin −1.50 m"),
        "{list}"
    );
    let Some((found, console)) = browsed(&page, COUNTS, "1200,1600") else {
        skipped(
            "phases_requirements_pairs_and_searches_are_shown_where_they_are",
            "chromium",
        );
        return;
    };
    assert!(console.is_empty(), "{console:#?}");
    let expected = serde_json::json!({
        "cells": 6, "bold": "1.50,6.00", "pairs": [3, 2], "mirrored": true, "tries": 2, "edges": 2, "wide": false, "resources": 0,
    });
    for (name, value) in expected.as_object().unwrap() {
        assert_eq!(&found[name], value, "{name}: {found}");
    }
    let (narrow, _) = browsed(&page, COUNTS, "500,900").unwrap();
    assert_eq!(narrow["wide"], false, "{narrow}");
}

#[test]
fn a_folder_of_reproduce_has_a_page_of_its_own() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write(
        "reproduce.csv",
        "chapter,paper,item,quantity,unit,paper_value,value,standard_error,bound_low,bound_high,required,verdict,note\n\
         a,Pesce,\"Table <1>\",x,m,1.5,1.25,0.1,1,2,1,holds,why\n\
         a,Pesce,Table 2,y,m,1.5,9,,,2,1,fails,\n\
         a,Pesce,Fig. 4,z,s,350,,,,,0,printed only,\n",
    );
    write(
        "learning_curve.csv",
        "t_s,d_x_m_s2,d_y_m_s2,d_z_m_s2,rms_error_x_m_s2,rms_error_y_m_s2,rms_error_z_m_s2\n\
         1,1e-6,-2e-6,3e-6,1e-6,1e-6,1e-6\n2,1e-6,-2e-6,3e-6,1e-7,1e-7,1e-7\n",
    );
    harness_ok(&["report", text(folder.path())]);
    let page = page(folder.path());
    assert_eq!(
        between(&page, "<p class=\"headline\">", "</p>"),
        "1 of 2 required bounds missed."
    );
    assert!(page.contains("Table &#60;1&#62;") && page.contains("1.00 to 2.00") && page.contains("≤ 2.00"));
    let Some((found, console)) = browsed(&page, COUNTS, "1200,900") else {
        skipped("a_folder_of_reproduce_has_a_page_of_its_own", "chromium");
        return;
    };
    assert!(console.is_empty(), "{console:#?}");
    let expected = serde_json::json!({"learning": 6, "rows": 3, "good": 1, "resources": 0});
    for (name, value) in expected.as_object().unwrap() {
        assert_eq!(&found[name], value, "{name}: {found}");
    }
    let Some(files) = drawn(folder.path(), "") else { return };
    assert_eq!(files, ["learning"]);
    let svg = std::fs::read_to_string(folder.path().join("figures/learning_curve.svg")).unwrap();
    for part in ["true acceleration", "acceleration, z [m/s²]", "time [s]", "10⁻⁷"] {
        assert!(svg.contains(part), "{part}");
    }
}

/// One law, one constant and a bound at two levels of a mission, and one level of another.
#[test]
fn a_folder_of_regret_has_a_page_of_its_own() {
    let folder = tempfile::tempdir().unwrap();
    let header = "mission,level,filter,family,kind,runs,failed,diverged,pos_rmse_m,vel_rmse_m_s,nees6,\
                  pos_best,pos_ratio,pos_ratio_low,pos_ratio_high,vel_best,vel_ratio,vel_ratio_low,vel_ratio_high";
    let rows = [
        "leo,vents <1>,law<,law<,law,100,0,0,0.15,5e-4,0.8,snc(q=1e-5),1.02,0.99,1.05,snc(q=1e-5),1.5,1.4,1.6",
        "leo,vents <1>,snc(q=1e-5),snc,fixed,100,0,0,0.147,3e-4,0.9,snc(q=1e-5),1,1,1,snc(q=1e-5),1,1,1",
        "leo,vents <1>,told(q=1),told,bound,100,0,0,0.1,2e-4,0.9,snc(q=1e-5),0.68,0.6,0.7,snc(q=1e-5),0.66,0.6,0.7",
        "leo,vents_10,law<,law<,law,100,1,2,0.25,5e-3,0.9,snc(q=1e-4),0.755,0.7,0.8,snc(q=1e-4),0.8,0.75,0.85",
        "nrho,vents_10,law<,law<,law,4,0,0,0.25,5e-3,0.9,snc(q=1e-4),0.5,,,snc(q=1e-4),0.6,,",
    ];
    std::fs::write(
        folder.path().join("regret.csv"),
        format!("{header}\n{}\n", rows.join("\n")),
    )
    .unwrap();
    harness_ok(&["report", text(folder.path())]);
    let page = page(folder.path());
    assert_eq!(
        between(&page, "<p class=\"headline\">", "</p>"),
        "Position RMSE over that of the best constant: law&#60; 0.755 to 1.02."
    );
    for part in [
        "1.02 (0.990 to 1.05)",
        "100, 3 bad",
        "vents &#60;1&#62;",
        "told (bound)",
        "<td data-value=\"0.5\">0.500</td>",
    ] {
        assert!(page.contains(part), "{part}");
    }
    assert_eq!(page.matches("<svg").count(), 2, "a figure for each mission");
    let Some((found, console)) = browsed(&page, COUNTS, "1200,900") else {
        skipped("a_folder_of_regret_has_a_page_of_its_own", "chromium");
        return;
    };
    assert!(console.is_empty(), "{console:#?}");
    let expected = serde_json::json!({"rows": 5, "wide": false, "resources": 0});
    for (name, value) in expected.as_object().unwrap() {
        assert_eq!(&found[name], value, "{name}: {found}");
    }
}

#[test]
fn the_page_works_in_a_browser() {
    let page = page(study());
    let Some((found, console)) = browsed(&page, PROBE, "1200,1600") else {
        skipped("the_page_works_in_a_browser", "chromium");
        return;
    };
    assert!(console.is_empty(), "{console:#?}");
    let mut summary = read_csv(&study().join("summary.csv"));
    summary.sort_by_key(|r| (r["pos_rmse_m"].parse::<f64>().unwrap() * 1e9) as u64);
    let mut names: Vec<&str> = summary.iter().map(|r| r["filter"].as_str()).collect();
    let ascending = names.join(",");
    names.reverse();
    let expected = serde_json::json!({
        "plots": 14,
        "shared": true,
        "runs": true,
        "svgs": 6,
        "csvs": 9,
        "window": ascending.clone(),
        "tabs": "fixed_q,snc,milton",
        "chosen": "snc",
        "forest": 3,
        "ascending": ascending,
        "descending": names.join(","),
        "hidden": 1,
        "zoomed": true,
        "reset": true,
        "theme": true,
        "wide": false,
        "resources": 0,
    });
    for (name, value) in expected.as_object().unwrap() {
        assert_eq!(&found[name], value, "{name}: {found}");
    }
    // The errors of the scored time are those of the summary, those of another time are not.
    let column = |rows: &serde_json::Value, filter: &str, at: usize| -> Option<f64> {
        let row = rows.as_array().unwrap().iter().find(|r| r[0] == filter).unwrap();
        row[at].as_str().unwrap().parse().ok()
    };
    for row in &summary {
        for (at, name) in [
            (1, "pos_rmse_m"),
            (2, "vel_rmse_m_s"),
            (3, "acc_rmse_m_s2"),
            (4, "nees"),
            (5, "nis"),
        ] {
            let expected: Option<f64> = row[name].parse().ok();
            let [shown, part] = ["scored", "part"].map(|time| column(&found[time], &row["filter"], at));
            let Some((shown, expected)) = shown.zip(expected) else {
                assert_eq!((shown, part), (expected, None), "{name}");
                continue;
            };
            assert!(
                (shown / expected - 1.0).abs() < 2e-4,
                "{name}: {shown} instead of {expected}"
            );
            assert!((part.unwrap() / expected - 1.0).abs() > 1e-3, "{name}: {part:?}");
        }
    }
    assert_eq!(found["scored"][0], "300 to 5680 s, the scored time");
    let header = found["error_csv"].as_str().unwrap();
    assert!(header.contains("3 sigma estimated velocity, t [m/s]"), "{header}");
    // The path in two planes, each with nine CO2 vents and one of waste water.
    assert!(found["paths"].as_u64().unwrap() >= 2 * 10, "{}", found["paths"]);
    let readout = found["readout"].as_str().unwrap();
    assert!(
        readout.contains("mean error") && readout.contains(" m, 3σ sample"),
        "{readout}"
    );

    // Narrow, nothing sticks out; and the probe does see a page that asks a host.
    let (narrow, console) = browsed(&page, PROBE, "500,900").unwrap();
    assert!(narrow["wide"] == false && console.is_empty(), "{narrow} {console:?}");
    let asking = page.replace("<header>", "<img src=\"https://example.invalid/x.png\"><header>");
    let (_, console) = browsed(&asking, PROBE, "1200,900").unwrap();
    assert!(console.iter().any(|l| l.contains("example.invalid")), "{console:?}");
}
