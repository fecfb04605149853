//! `--out DIR` and the demo: which files there are, whole, alone and the same every time.

use super::{REPORTS, Ran, Sandbox, ran};

#[test]
fn a_report_is_a_page_with_its_pictures_tables_and_result() {
    for line in REPORTS {
        let ran = ran(&format!("{line} --out a/report --json"));
        let out = ran.answer.clone().succeeded().stdout;
        let read = |name: &str| std::str::from_utf8(&ran.after[&format!("a/report/{name}")]).unwrap();
        assert_eq!(read("result.json"), out, "{line}");
        let names: Vec<&str> = ran.after.keys().filter_map(|name| name.strip_prefix("a/report/")).collect();
        let names: Vec<&str> = names.into_iter().filter(|name| !name.is_empty()).collect();
        // a report of several pages names theirs before the rest
        let pages: Vec<&str> = names.iter().filter_map(|name| name.strip_suffix(".html")).collect();
        let own = |name: &'static str| pages.iter().filter(move |page| **page == name);
        assert_eq!((own("index").count(), pages.len() > 1), (1, *line == *"demo"), "{line}");
        let plain = |name: &str| -> String {
            let inner = pages.iter().find_map(|page| name.strip_prefix(page)?.strip_prefix('-'));
            inner.unwrap_or(name).to_owned()
        };
        let known = |name: &&&str| {
            let name = &plain(name);
            let is = |start: &str, ends: &[&str]| {
                name.starts_with(start) && ends.iter().any(|e| name.ends_with(e))
            };
            ["result.json", "rodcal.sha256"].contains(&&name[..])
                || name.strip_suffix(".html").is_some_and(|page| pages.contains(&page))
                || is("figure-", &[".svg"])
                || is("table-", &[".csv", ".md"])
        };
        assert_eq!(names.iter().find(|name| !known(name)), None, "{line}");
        for page in &pages {
            let page = read(&format!("{page}.html"));
            for said in ["href=\"result.json\"", "<dt>command</dt>", "<dt>SHA-256 of "] {
                assert!(page.contains(said), "{line}: {said}");
            }
            assert!(!page.contains("<title></title>"), "{line}: a picture without a title");
        }
        let page: String = pages.iter().map(|page| read(&format!("{page}.html"))).collect();
        for (kind, tag, ending) in
            [("figure", "<figure>", ".svg"), ("table", "<table>", ".csv"), ("table", "<table>", ".md")]
        {
            let files = names.iter().filter(|n| plain(n).starts_with(kind) && n.ends_with(ending)).count();
            assert!(files > 0, "{line}: no {kind} as {ending}");
            assert_eq!(files, page.matches(tag).count(), "{line}: {kind}s as {ending} and on the page");
        }
        for name in &names {
            let text = read(name);
            let starts = match name.rsplit('.').next() {
                Some("html") => "<!DOCTYPE html>",
                Some("svg") => "<svg ",
                Some("json") => "{",
                _ => "",
            };
            assert!(text.len() > 20 && text.starts_with(starts), "{line}: {name}");
            let text = text.split("<script>").next().unwrap();
            let nothing = ["NaN", "nan", "inf"]
                .iter()
                .find(|word| text.split(|c: char| !c.is_alphabetic()).any(|w| w == **word));
            assert_eq!(nothing, None, "{line}: {name}");
        }
    }
}

#[cfg(not(feature = "png"))]
#[test]
fn a_build_without_png_says_how_to_get_it() {
    let sandbox = Sandbox::new();
    let before = sandbox.listing();
    for line in ["compliance rods/5.toml --out pictures --png", "compliance rods/5.toml --png --json"] {
        let answer = sandbox.run(line);
        assert_eq!((answer.status, answer.stdout.as_str()), (Some(2), ""), "{line}");
        assert_eq!(
            answer.stderr,
            "error: --png is not possible: this build of rodcal writes SVG only\n\
             hint: build one that can: cargo install --path . --features png\n"
        );
    }
    assert!(sandbox.listing() == before, "something was written");
}

#[cfg(feature = "png")]
#[test]
fn png_on_request() {
    let sandbox = Sandbox::new();
    sandbox.run("compliance rods/5.toml --out plain").succeeded();
    sandbox.run("compliance rods/5.toml --out pictures --png").succeeded();
    let files = sandbox.listing();
    let pictures: Vec<&String> = files.keys().filter(|name| name.ends_with(".png")).collect();
    assert!(
        !pictures.is_empty() && pictures.iter().all(|name| name.starts_with("pictures/")),
        "{pictures:?}"
    );
    for name in pictures {
        assert!(files[name].starts_with(b"\x89PNG\r\n\x1a\n") && files[name].len() > 1000, "{name}");
        assert!(files.contains_key(&name.replace(".png", ".svg")), "{name}");
    }
    let lone = sandbox.run("compliance rods/5.toml --png").succeeded();
    assert_eq!(lone.warnings(), ["--png has no effect without --out"]);
}

#[test]
fn a_second_report_has_the_same_bytes_and_leaves_other_files_alone() {
    for line in ["rig fit rods/5.toml stiffness_data/5.csv", "compliance rods/2.toml"] {
        let sandbox = Sandbox::new();
        let command = format!("{line}{} --out report", super::PNG);
        let first = sandbox.run(&command).succeeded();
        sandbox.write("report/notes.txt", "mine");
        std::fs::create_dir(sandbox.path().join("report/more")).unwrap();
        sandbox.write("report/more/index.html", "mine too");
        let before = sandbox.listing();
        // what a report wrote it also replaces
        assert_eq!(sandbox.run(&command), first);
        assert!(sandbox.listing() == before, "{line}: the bytes differ");
    }
}

#[test]
fn nothing_is_written_unasked() {
    for line in REPORTS.into_iter().filter(|line| *line != "demo") {
        for line in [line, &format!("{line} --json")] {
            let ran = ran(line);
            ran.answer.clone().succeeded();
            assert!(ran.after == ran.before, "{line}");
        }
    }
}

#[test]
fn the_demo_needs_nothing_and_says_where_its_report_is() {
    let sandbox = Sandbox::empty();
    let answer = sandbox.run("").succeeded();
    let path = answer.stdout.lines().find_map(|line| line.strip_prefix("report: ")).unwrap();
    assert_eq!(path, "reports/demo/index.html");
    assert!(sandbox.read(path).starts_with("<!DOCTYPE html>"));
    let files = sandbox.listing();
    let outside = files.keys().find(|name| !name.starts_with("reports/demo/") && *name != "reports/");
    assert_eq!(outside, None);
    // `rodcal demo` is the same, also among the project's files
    let Ran { answer: demo, before, after } = ran("demo");
    assert_eq!((&answer.stdout, &answer.stderr), (&demo.stdout, &demo.stderr));
    assert!(files.iter().all(|(name, bytes)| after.get(name) == Some(bytes)), "the files differ");
    assert_eq!(after.len(), before.len() + files.len());
}

#[test]
fn the_demo_answers_on_its_first_page_and_says_what_compensation_is_worth() {
    let Ran { answer, after, .. } = ran("demo");
    assert_eq!(answer.stderr.matches("warning:").count(), 1, "{}", answer.stderr);
    // no line of a page ends between a number and its unit
    let page = |name: &str| {
        let page = std::str::from_utf8(&after[&format!("reports/demo/{name}.html")]).unwrap();
        page.replace('\u{a0}', " ")
    };
    for said in [
        "Rod 5# is 1.5 % softer",
        "748 µm → 46.1 µm",
        "Without compensation 47.0 µm: no significant difference",
    ] {
        assert!(page("index").contains(said), "{said}");
    }
    assert!(page("robot").contains("Without compensation") && page("robot").contains("<h2>Diagnosis</h2>"));
    assert!(page("why").contains("lack of fit"), "a page has the warnings of what it shows");
}

#[test]
fn the_demo_also_goes_where_it_is_told() {
    let sandbox = Sandbox::empty();
    let answer = sandbox.run("--out elsewhere").succeeded();
    assert!(answer.stdout.ends_with("report: elsewhere/index.html\n"), "{}", answer.stdout);
    assert!(sandbox.listing().keys().all(|name| name.starts_with("elsewhere/")));
}

/// The files inside the program are those of the project.
#[test]
fn the_demo_is_made_of_the_other_commands() {
    let sandbox = Sandbox::new();
    let demo = ran("demo --json").answer.clone().json();
    for (i, rod) in ["2", "5"].into_iter().enumerate() {
        let compliance = sandbox.run(&format!("compliance rods/{rod}.toml --json")).json();
        let fit = sandbox.run(&format!("rig fit rods/{rod}.toml stiffness_data/{rod}.csv --json")).json();
        assert_eq!(demo["rods"][i]["compliance"], compliance);
        assert_eq!(demo["rods"][i]["rig"], fit);
    }
    let cell = sandbox.run("rig fit linear stiffness_data/nist-load-cell.csv --json").json();
    assert_eq!(demo["load_cell"], cell);
    let campaign = "campaigns/tx90-5/campaign.toml";
    let calibration = sandbox.run(&format!("calibrate {campaign} --json")).json();
    for (key, value) in demo["calibration"].as_object().unwrap() {
        assert_eq!(value, &calibration[key], "{key}");
    }
    let comparison = sandbox.run(&format!("compare {campaign} --draws 50 --json")).json();
    for mode in 0..4 {
        let [demo, comparison] = [&demo["comparison"], &comparison].map(|json| &json["modes"][mode]);
        assert!(comparison["validation"]["mean_um"].is_number());
        assert_eq!(demo["validation"], comparison["validation"]);
    }
}

/// Excel's "Unicode Text": UTF-16, tabs and decimal commas.
#[test]
fn unicode_text_of_a_spreadsheet_is_read_as_utf_8_would_be() {
    let sandbox = Sandbox::new();
    let plain = sandbox.read("stiffness_data/5.csv");
    let tabs = plain.replace(',', "\t").replace('.', ",");
    let mut bytes = vec![0xFF, 0xFE];
    bytes.extend(tabs.encode_utf16().flat_map(u16::to_le_bytes));
    std::fs::write(sandbox.path().join("stiffness_data/unicode.csv"), bytes).unwrap();
    let fit = |file: &str| sandbox.run(&format!("rig fit rods/5.toml stiffness_data/{file} --json")).json();
    assert_eq!(fit("unicode.csv")["slopes"], fit("5.csv")["slopes"]);
}
