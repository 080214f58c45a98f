//! One job of a study, with its settings.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::scene::StudyScene;

/// What a job varies, by name: `lights`, `view`, `ranges`. Pages and claims read these; they never read a
/// job's name for its meaning.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Settings(BTreeMap<String, Value>);

impl Settings {
    /// A setting that is text.
    pub fn text(&self, name: &str) -> Option<&str> {
        self.0.get(name)?.as_str()
    }

    /// A setting that is a number.
    pub fn number(&self, name: &str) -> Option<f64> {
        self.0.get(name)?.as_f64()
    }

    /// Sets one: a number where the text is one.
    pub(crate) fn set(&mut self, name: &str, text: &str) {
        let integer = text.parse::<u64>().ok().map(Value::from);
        let number = || text.parse::<f64>().ok().filter(|number| number.is_finite());
        let value = integer.or_else(|| number().map(Value::from));
        self.0.insert(name.to_owned(), value.unwrap_or_else(|| Value::from(text)));
    }
}

/// Settings from names and texts; a text that is a number becomes one.
impl<const N: usize> From<[(&str, &str); N]> for Settings {
    fn from(all: [(&str, &str); N]) -> Self {
        let mut settings = Self::default();
        all.into_iter().for_each(|(name, text)| settings.set(name, text));
        settings
    }
}

/// One comparison, truth image or set of deep images of a study.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Job {
    /// Its name, and that of its folder: `sponza-main-10000`.
    pub name: String,
    /// The scene that it draws, as the report calls it.
    pub scene: String,
    /// The part of the report that it belongs to.
    pub section: String,
    /// What it varies.
    #[serde(default)]
    pub settings: Settings,
    /// Its command, program name first, without `--out`.
    pub command: Vec<String>,
}

impl Job {
    /// A job of a scene: its section, what tells its name from others of the section, what it varies, and
    /// its command without the program's name.
    pub(crate) fn new(
        scene: &StudyScene,
        section: &str,
        variant: &str,
        settings: Settings,
        words: &[&str],
    ) -> Self {
        let parts = [scene.name.as_str(), section, variant];
        let parts: Vec<&str> = parts.into_iter().filter(|part| !part.is_empty()).collect();
        let command = std::iter::once("lightbench").chain(words.iter().copied());
        Self {
            name: parts.join("-"),
            scene: scene.name.clone(),
            section: section.to_owned(),
            settings,
            command: command.map(str::to_owned).collect(),
        }
    }

    /// The job's folder in that of its study.
    pub fn folder(&self, out: &Path) -> PathBuf {
        out.join("jobs").join(&self.name)
    }

    /// What follows an option of its command.
    pub(crate) fn option(&self, name: &str) -> Option<&str> {
        let at = self.command.iter().position(|word| word == name)?;
        self.command.get(at + 1).map(String::as_str)
    }

    /// How large its command makes the scene, and how many copies of it stand side by side.
    pub(crate) fn scene_extent(&self) -> [Option<&str>; 2] {
        ["--scene-scale", "--replicate"].map(|option| self.option(option))
    }

    /// Sets the settings that pages and claims read, for files of version 1, which have none. There the
    /// name of a job tells a view and a rule of ranges; this is the only place that reads it so.
    pub(crate) fn derive_settings(&mut self) {
        let prefix = format!("{}-{}-", self.scene, self.section);
        let variant = self.name.strip_prefix(&prefix).unwrap_or_default().to_owned();
        let mut settings = Settings::default();
        for (option, name) in [("--lights", "lights"), ("--ranges", "ranges"), ("--vpls", "rsm_px")]
        {
            if let Some(value) = self.option(option) {
                settings.set(name, value);
            }
        }
        if ["low", "high"].contains(&variant.as_str()) {
            settings.set("view", &variant);
        }
        // `average-x2`, `random-discard-0.5`: of a sweep. Jobs with another map start with `rsm`.
        for rule in ["average", "maximum", "random-discard", "constant-discard", "random"] {
            let Some(rest) = variant.strip_prefix(rule).and_then(|rest| rest.strip_prefix('-'))
            else {
                continue;
            };
            settings.set("sweep", rule);
            match rest.strip_prefix('x') {
                Some(scale) => settings.set("scale", scale),
                None => settings.set("share", rest),
            }
            break;
        }
        self.settings = settings;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn old(section: &str, variant: &str, words: &[&str]) -> Settings {
        let scene = StudyScene { scene: "a.glb".into(), name: "a".into(), scale: 1.0 };
        let mut job = Job::new(&scene, section, variant, Settings::default(), words);
        job.derive_settings();
        job.settings
    }

    #[test]
    fn settings_of_old_jobs_come_from_their_names_and_commands() {
        let view = old("views", "low", &["compare", "--lights", "500"]);
        assert_eq!((view.text("view"), view.number("lights")), (Some("low"), Some(500.0)));
        let sweep = old("models", "average-x2", &["--ranges", "average"]);
        assert_eq!((sweep.text("sweep"), sweep.number("scale")), (Some("average"), Some(2.0)));
        let random = old("models", "random-discard-0.5", &["--ranges", "random-discard"]);
        assert_eq!(random.number("share"), Some(0.5));
        assert_eq!(random.text("sweep"), Some("random-discard"));
        let other = old("models", "rsm64-random-0.5", &["--ranges", "random"]);
        assert_eq!((other.text("sweep"), other.text("ranges")), (None, Some("random")));
        assert_eq!(old("models", "infinite", &[]).text("sweep"), None);
    }

    #[test]
    fn settings_are_plain_fields_of_the_file() {
        let settings = Settings::from([("lights", "500"), ("view", "low"), ("share", "0.15")]);
        let text = serde_json::to_string(&settings).unwrap();
        assert_eq!(text, r#"{"lights":500,"share":0.15,"view":"low"}"#);
        assert_eq!(serde_json::from_str::<Settings>(&text).unwrap(), settings);
    }
}
