//! One job of a study, with its settings.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::scene::StudyScene;

/// What pages and claims need to know of a job beyond its section and its records. They never read a job's
/// name for its meaning. A job has only the settings that its study reads:
///
/// - `depth_discontinuity`: `low` or `high`, of the views of `comparison`.
/// - `sweep`: the rule of ranges that the jobs of a sweep of `cdi` share, such as `random-discard`.
/// - `range_scale`: the factor on ranges, within a sweep of rules that find them by rays.
/// - `range_share`: the longest range as a share of the scene's diagonal, within the other sweeps. One range
///   for all lights is half as long.
/// - `atlas_px`: the side of the atlas that the maps of `shadows` fill, texels.
/// - `roughness`: that of all surfaces, of truth images of `shadows`.
/// - `distance_m`: from the camera to the light that it approaches in `shadows`, metres.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Settings(BTreeMap<String, Value>);

impl Settings {
    /// A setting that is text; `None` where there is none of that name, or where it is a number.
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
    /// What its study reads of it. Files of version 1 have none.
    #[serde(default)]
    pub settings: Settings,
    /// Its command, program name first, without `--out`.
    pub command: Vec<String>,
}

impl Job {
    /// A job of a scene without settings: its section, what tells its name from others of the section, and
    /// its command without the program's name.
    pub(crate) fn new(scene: &StudyScene, section: &str, variant: &str, words: &[&str]) -> Self {
        let parts = [scene.name.as_str(), section, variant];
        let parts: Vec<&str> = parts.into_iter().filter(|part| !part.is_empty()).collect();
        let command = std::iter::once("lightbench").chain(words.iter().copied());
        Self {
            name: parts.join("-"),
            scene: scene.name.clone(),
            section: section.to_owned(),
            settings: Settings::default(),
            command: command.map(str::to_owned).collect(),
        }
    }

    /// The job with a setting: a number where the text is one.
    pub(crate) fn with(mut self, name: &str, text: &str) -> Self {
        self.settings.set(name, text);
        self
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

    /// What its command makes of the scene: its scale, its copies, and the roughness of its surfaces.
    pub(crate) fn scene_changes(&self) -> [Option<&str>; 3] {
        ["--scene-scale", "--replicate", "--roughness"].map(|option| self.option(option))
    }

    /// Sets the settings that pages and claims read, for files of version 1, which have none. There the
    /// name of a job tells a view and a rule of ranges; this is the only place that reads it so.
    pub(crate) fn derive_settings(&mut self) {
        let prefix = format!("{}-{}-", self.scene, self.section);
        let variant = self.name.strip_prefix(&prefix).unwrap_or_default().to_owned();
        let mut settings = Settings::default();
        if ["low", "high"].contains(&variant.as_str()) {
            settings.set("depth_discontinuity", &variant);
        }
        // `average-x2`, `random-discard-0.5`: of a sweep. Jobs with another map start with `rsm`.
        for rule in ["average", "maximum", "random-discard", "constant-discard", "random"] {
            let Some(rest) = variant.strip_prefix(rule).and_then(|rest| rest.strip_prefix('-'))
            else {
                continue;
            };
            settings.set("sweep", rule);
            match rest.strip_prefix('x') {
                Some(scale) => settings.set("range_scale", scale),
                None => settings.set("range_share", rest),
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
        let mut job = Job::new(&scene, section, variant, words);
        job.derive_settings();
        job.settings
    }

    #[test]
    fn settings_of_old_jobs_come_from_their_names_and_commands() {
        let view = old("views", "low", &["compare", "--lights", "500"]);
        assert_eq!(view.text("depth_discontinuity"), Some("low"));
        let sweep = old("models", "average-x2", &["--ranges", "average"]);
        assert_eq!(
            (sweep.text("sweep"), sweep.number("range_scale")),
            (Some("average"), Some(2.0))
        );
        let random = old("models", "random-discard-0.5", &["--ranges", "random-discard"]);
        assert_eq!(random.number("range_share"), Some(0.5));
        assert_eq!(random.text("sweep"), Some("random-discard"));
        let other = old("models", "rsm64-random-0.5", &["--ranges", "random"]);
        assert_eq!(other, Settings::default());
        assert_eq!(old("models", "infinite", &[]).text("sweep"), None);
    }

    #[test]
    fn settings_are_plain_fields_of_the_file() {
        let settings =
            Settings::from([("sweep", "random"), ("range_scale", "2"), ("range_share", "0.15")]);
        let text = serde_json::to_string(&settings).unwrap();
        assert_eq!(text, r#"{"range_scale":2,"range_share":0.15,"sweep":"random"}"#);
        assert_eq!(serde_json::from_str::<Settings>(&text).unwrap(), settings);
    }
}
