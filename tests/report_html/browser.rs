//! The page in headless Chromium: nothing is cut off, covered, too pale or fetched from elsewhere.
//!
//! Screenshots and a print are left in `target/tmp/report-html` for whoever wants to look.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use serde::Deserialize;
use supel::report::{Report, html};

use super::{report_of_all_checks, sample};

/// Starting a browser takes seconds on a busy machine; this is where it hangs.
const PATIENCE: Duration = Duration::from_secs(120);

/// What `probe.js` measured.
#[derive(Debug, Deserialize)]
struct Probe {
    width: u32,
    overflow: Vec<String>,
    hidden: Vec<String>,
    contrast: Vec<String>,
    covered: Vec<String>,
    outside: Vec<String>,
    resources: Vec<String>,
    n_texts: usize,
}

/// The browser: `SUPEL_BROWSER`, or what Debian and others call it; absent where it does not start.
fn browser() -> Option<String> {
    let named = std::env::var("SUPEL_BROWSER").into_iter();
    let usual = ["chromium", "chromium-browser", "google-chrome"].map(str::to_owned);
    let starts = |program: &String| {
        let asked = Command::new(program).arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status();
        asked.is_ok_and(|status| status.success())
    };
    let found = named.chain(usual).find(starts);
    if found.is_none() {
        // Past the capture of the test harness: a page that no browser has shown must not go unnoticed.
        let _ =
            writeln!(std::io::stderr(), "SKIPPED: no Chromium found; the page was not opened (apt install chromium)");
    }
    found
}

fn folder() -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("report-html");
    std::fs::create_dir_all(&folder).expect("folder");
    folder
}

/// Opens `page` and gives what the browser wrote to stdout.
fn open(browser: &str, page: &Path, how: &[String]) -> String {
    let profile = tempfile::tempdir().expect("folder");
    let output = profile.path().join("stdout");
    let mut child = Command::new(browser)
        .args(["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-sync"])
        .args(["--disable-background-networking", "--disable-component-update", "--hide-scrollbars"])
        .arg(format!("--user-data-dir={}", profile.path().join("profile").display()))
        .args(how)
        .arg(format!("file://{}", page.display()))
        .stdout(std::fs::File::create(&output).expect("file"))
        .stderr(Stdio::null())
        .spawn()
        .expect("the browser starts");
    let begin = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait().expect("a child process") {
            break status;
        }
        if begin.elapsed() > PATIENCE {
            let _ = child.kill();
            let _ = child.wait();
            panic!("the browser did not come back with {how:?}");
        }
        std::thread::sleep(Duration::from_millis(50));
    };
    assert!(status.success(), "the browser failed with {how:?}");
    std::fs::read_to_string(output).expect("text")
}

/// The page with the probe in it, seen through a window of this size.
fn probe(browser: &str, name: &str, page: &str, width: u32) -> Probe {
    let path = folder().join(format!("{name}-{width}-probe.html"));
    let script = format!("<script>//<![CDATA[\n{}\n//]]></script></head>", include_str!("probe.js"));
    std::fs::write(&path, page.replacen("</head>", &script, 1)).expect("written");
    let dom = open(browser, &path, &["--dump-dom".to_owned(), format!("--window-size={width},1000")]);
    std::fs::remove_file(&path).expect("removed");
    let (_, found) = dom.split_once("<pre id=\"probe\">").expect("the probe has run");
    let (found, _) = found.split_once("</pre>").expect("an end");
    let found = found.replace("&lt;", "<").replace("&gt;", ">").replace("&nbsp;", "\u{a0}").replace("&amp;", "&");
    serde_json::from_str(&found).unwrap_or_else(|error| panic!("{error}: {found}"))
}

fn assert_shows_well(browser: &str, name: &str, report: &Report) {
    let page = html(report);
    // A screen, and a window as narrow as the browser makes it.
    for width in [1280, 400] {
        let Probe { width: shown, overflow, hidden, contrast, covered, outside, resources, n_texts } =
            probe(browser, name, &page, width);
        assert!(shown <= 1280 && (width == 1280) == (shown == 1280), "asked for {width}, shown at {shown}");
        assert!(n_texts > 200, "{n_texts} pieces of text in {name}");
        for (what, found) in [
            ("beyond the right edge", overflow),
            ("without size", hidden),
            ("too pale", contrast),
            ("one text upon another", covered),
            ("outside of its drawing", outside),
            ("fetched", resources),
        ] {
            assert!(found.is_empty(), "{name} at {shown}: {what}: {found:#?}");
        }
    }
}

#[test]
fn page_shows_whole_on_wide_and_narrow_windows() {
    let Some(browser) = browser() else { return };
    assert_shows_well(&browser, "passing", &sample::passing_report());
    assert_shows_well(&browser, "failing", &report_of_all_checks());
}

#[test]
fn page_with_long_names_stays_within_its_width() {
    let Some(browser) = browser() else { return };
    let long = "A_GROUP_NAME_WITHOUT_A_BLANK_".repeat(12);
    let mut report = sample::passing_report();
    let body = &mut report.body;
    body.reduction.interfaces[0].name = long.clone();
    body.model.units = Some(long.clone());
    body.checks[0].worst = Some(long.clone());
    body.preservation.boundaries[1].boundary = long.clone();
    body.preservation.statics[0].interface = long.clone();
    body.preservation.response.as_mut().expect("response").worst_pair = [long.clone(), long.clone()];
    report.run.superelement = Some(format!("/a/{long}.supel").into());
    assert_shows_well(&browser, "long", &report);
}

#[test]
fn screenshots_and_a_print_are_taken() {
    let Some(browser) = browser() else { return };
    for (name, report) in [("passing", sample::passing_report()), ("failing", report_of_all_checks())] {
        let page = folder().join(format!("{name}.html"));
        std::fs::write(&page, html(&report)).expect("written");
        for (width, height) in [(1000_u32, 9000_u32), (500, 9000)] {
            let picture = folder().join(format!("{name}-{width}.png"));
            let how = [format!("--screenshot={}", picture.display()), format!("--window-size={width},{height}")];
            open(&browser, &page, &how);
            let bytes = std::fs::read(&picture).expect("a picture");
            // The size stands in the header of every PNG.
            let number = |at: usize| bytes[at..at + 4].iter().fold(0, |number, byte| number << 8 | u32::from(*byte));
            assert_eq!((&bytes[1..4], number(16), number(20)), (b"PNG".as_slice(), width, height));
            assert!(bytes.len() > 100_000, "{} bytes: the page is blank", bytes.len());
        }
        let print = folder().join(format!("{name}.pdf"));
        open(&browser, &page, &["--no-pdf-header-footer".to_owned(), format!("--print-to-pdf={}", print.display())]);
        let bytes = std::fs::read(&print).expect("a print");
        assert!(bytes.starts_with(b"%PDF-") && bytes.len() > 50_000, "{} bytes", bytes.len());
    }
}
