//! Opens pages in a headless browser, where one is installed.
#![allow(dead_code, reason = "each test uses its share")]

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

const BROWSERS: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "chrome"];
const PATIENCE: Duration = Duration::from_secs(90);

/// Does what a reader can do: clicks every button twice, moves every slider, focuses every element.
pub(crate) const USE_EVERYTHING: &str = "<script>
for (let round = 0; round < 2; round += 1) {
  document.querySelectorAll('button').forEach((button) => button.click());
  document.querySelectorAll('input').forEach((input) => { input.value = '20'; input.dispatchEvent(new Event('input')); });
  document.querySelectorAll('[tabindex]').forEach((element) => {
    element.focus?.();
    element.dispatchEvent(new KeyboardEvent('keydown', { key: 'Enter' }));
  });
}
document.documentElement.dataset.used = '1';
</script></body>";

fn browser() -> Option<&'static str> {
    let runs = |name: &&str| {
        let mut version = Command::new(name);
        version.arg("--version").stdout(Stdio::null()).stderr(Stdio::null());
        version.status().is_ok_and(|status| status.success())
    };
    BROWSERS.iter().copied().find(runs)
}

/// The document after all scripts have run; `None` where no browser is installed.
pub(crate) fn dump(page: &str, width_px: u32) -> Option<String> {
    let Some(browser) = browser() else {
        eprintln!("skipped: none of {} is installed", BROWSERS.join(", "));
        return None;
    };
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("index.html");
    std::fs::write(&path, page).expect("writes");
    let out = folder.path().join("dom");
    let mut child = Command::new(browser)
        .args("--headless --no-sandbox --disable-gpu --disable-quic --no-first-run".split(' '))
        .args(
            "--disable-background-networking --disable-component-update --disable-sync".split(' '),
        )
        .arg(format!("--user-data-dir={}", folder.path().join("profile").display()))
        .arg(format!("--window-size={width_px},900"))
        .args(["--virtual-time-budget=5000", "--dump-dom"])
        .arg(format!("file://{}", path.display()))
        .stdout(std::fs::File::create(&out).expect("a file"))
        .stderr(Stdio::null())
        .spawn()
        .expect("the browser starts");
    let start = Instant::now();
    while child.try_wait().expect("a status").is_none() {
        if start.elapsed() > PATIENCE {
            child.kill().expect("kills");
            child.wait().expect("waits");
            panic!("{browser} did not end within {PATIENCE:?}");
        }
        std::thread::sleep(Duration::from_millis(50));
    }
    Some(std::fs::read_to_string(Path::new(&out)).expect("reads"))
}

pub(crate) fn html_tag(dom: &str) -> &str {
    let start = dom.find("<html").expect("a document");
    &dom[start..start + dom[start..].find('>').expect("a tag")]
}

/// The document without its style sheet.
pub(crate) fn body(dom: &str) -> &str {
    dom.split_once("<body").expect("a body").1
}
