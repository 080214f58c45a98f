//! The figures of one scene with one number of lights, engine by engine.

use super::jobs::{PATH, VIEW};
use crate::grouping::distinct;
use crate::report::rank::{Ratio, SURE, first, ranks};
use crate::results::Record;
use crate::strategy::{
    StrategyId,
    engines::{Engine, engines_of},
};
use crate::study::data::{Entry, counts, entries};
use crate::study::manifest::Done;

/// A scene with a number of lights.
pub(crate) struct Case<'a> {
    pub(crate) lights: u64,
    /// Records along the path.
    pub(crate) path: Vec<Entry<'a>>,
    /// Records from the still camera.
    view: Vec<Entry<'a>>,
}

/// A method of a case.
pub(crate) struct Method<'a> {
    pub(crate) id: &'a StrategyId,
    /// The engine whose default it is.
    pub(crate) engine: Option<&'static Engine>,
    /// What was timed along the path.
    pub(crate) timed: Option<&'a Record>,
    /// What the still camera saw.
    pub(crate) seen: Option<Entry<'a>>,
    /// Its nearest lossless setting, if a limit loses light, and that one's record along the path.
    pub(crate) lossless: Option<(StrategyId, Option<&'a Record>)>,
    /// Whether it shares the first rank among the methods that are shown, and some method is slower.
    pub(crate) leads: bool,
}

/// What a lossless setting takes, as a multiple of the time of the default.
#[derive(Clone, Copy)]
pub(crate) struct Cost {
    pub(crate) ratio: f64,
    /// Whether the two tie. Too few laps cannot tell.
    pub(crate) ties: bool,
}

/// The cases of a scene that have records, by their number of lights.
pub(crate) fn cases<'a>(done: &'a Done, scene: &'a str) -> Vec<Case<'a>> {
    let [path, view] = [PATH, VIEW].map(|section| entries(done, scene, section));
    let all: Vec<Entry<'_>> = path.iter().chain(&view).copied().collect();
    let at = |entries: &[Entry<'a>], count: u64| -> Vec<Entry<'a>> {
        let here = |entry: &&Entry<'_>| entry.record.setting.lights == count;
        entries.iter().filter(here).copied().collect()
    };
    let case = |lights| Case { lights, path: at(&path, lights), view: at(&view, lights) };
    counts(&all).into_iter().map(case).collect()
}

fn of_id<'a>(entries: &[Entry<'a>], id: &StrategyId) -> Option<Entry<'a>> {
    entries.iter().find(|entry| entry.record.strategy == *id).copied()
}

/// The width and the height of a record's image, pixels.
pub(crate) fn size_px(record: &Record) -> [u32; 2] {
    [record.setting.width, record.setting.height]
}

impl<'a> Case<'a> {
    /// The records along the path.
    pub(crate) fn records(&self) -> Vec<&'a Record> {
        self.path.iter().map(|entry| entry.record).collect()
    }

    /// The methods that a table shows: engines' defaults, then the others. Lossless settings of defaults stand
    /// beside them and not among them.
    pub(crate) fn methods(&self) -> Vec<Method<'a>> {
        let all = || self.path.iter().chain(&self.view).map(|entry| entry.record);
        let Some(size) = all().next().map(size_px) else { return Vec::new() };
        let ids = distinct(all().map(|record| &record.strategy));
        let lossless: Vec<StrategyId> = ids.iter().filter_map(|id| id.nearest_lossless()).collect();
        let mut methods: Vec<Method<'a>> = Vec::new();
        for id in ids {
            let mut engines: Vec<Option<&Engine>> = engines_of(id, size).map(Some).collect();
            if engines.is_empty() && !lossless.contains(id) {
                engines.push(None);
            }
            methods.extend(engines.into_iter().map(|engine| self.method(id, engine)));
        }
        methods.sort_by_key(|method| method.engine.is_none());
        let ranked = ranks(methods.iter().filter_map(|method| method.timed));
        let leaders: Vec<&StrategyId> = match ranked.iter().any(|ranked| ranked.rank > 1) {
            true => first(&ranked).iter().map(|record| &record.strategy).collect(),
            false => Vec::new(),
        };
        for method in &mut methods {
            method.leads = leaders.contains(&method.id);
        }
        methods
    }

    fn method(&self, id: &'a StrategyId, engine: Option<&'static Engine>) -> Method<'a> {
        let timed = |id: &StrategyId| of_id(&self.path, id).map(|entry| entry.record);
        let lossless = id.nearest_lossless().filter(|_| engine.is_some());
        Method {
            id,
            engine,
            timed: timed(id),
            seen: of_id(&self.view, id),
            lossless: lossless.map(|id| (id.clone(), timed(&id))),
            leads: false,
        }
    }

    /// The defaults of engines.
    pub(crate) fn defaults(&self) -> Vec<Method<'a>> {
        let mut methods = self.methods();
        methods.retain(|method| method.engine.is_some());
        methods
    }
}

impl Method<'_> {
    /// Its name in a sentence: `Filament froxels`, or the id of what is no engine's default.
    pub(crate) fn name(&self) -> String {
        match self.engine {
            Some(engine) => engine.title.replacen(", ", " ", 1),
            None => self.id.to_string(),
        }
    }

    /// Whether a measurement shows that it loses light.
    pub(crate) fn loses_light(&self) -> bool {
        let seen = self.seen.map(|entry| entry.record);
        [self.timed, seen].into_iter().flatten().any(|record| !record.is_lossless())
    }

    /// Its error against no culling, mean over the compared poses of the path.
    pub(crate) fn error(&self, metric: &str) -> Option<f64> {
        self.timed?.image.errors.get(metric).copied().flatten()
    }

    /// The share of (light, sample) pairs within range that its lists lack, from the still camera.
    pub(crate) fn lost_pairs(&self) -> Option<f64> {
        let lists = &self.seen?.record.lists;
        let checked = lists.checked_pairs.filter(|checked| *checked > 0)?;
        Some(lists.missed_pairs? as f64 / checked as f64)
    }

    /// What its nearest lossless setting takes.
    pub(crate) fn cost(&self) -> Option<Cost> {
        let (lossless, own) = (self.lossless.as_ref()?.1?, self.timed?);
        if let Some(ratio) = Ratio::between(lossless, own).filter(|ratio| ratio.coverage >= SURE) {
            return Some(Cost { ratio: ratio.median, ties: ratio.is_tie() });
        }
        let ratio = lossless.assign_and_shade_ms() / own.assign_and_shade_ms();
        ratio.is_finite().then_some(Cost { ratio, ties: false })
    }
}
