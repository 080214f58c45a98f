//! Lists that know occlusion: what leaving out hidden lights saves, what it costs, and which of them exact rays see.
//!
//! One comparison per scene draws 1,000 lights with shadow maps. Each strategy is there without and with `/occ`.

use super::cells::on_software;
use super::jobs::Extent;
use crate::{
    cli::StudyArgs,
    report::{
        column::{Better, Column},
        format::{number, significant},
        markup::Html,
        table::{Look, Row, Table},
    },
    results::Record,
    strategy::StrategyId,
    study::{
        data::{Entry, entries},
        job::Job,
        manifest::Done,
        page::part::Part,
        scene::StudyScene,
    },
};

/// The section of its only job.
pub(crate) const OCCLUSION: &str = "occlusion";

/// The strategies, each without and with `/occ`: tiles, clusters, and cells of the world.
const STRATEGIES: [&str; 4] =
    ["T-E/28x28", "DC-E/64x64x40", "SC-E/48x48x40/bvh", "G/20x20x20/visible"];

/// Shares of spots and of rectangles among the lights.
const SHARES: [&str; 6] = ["--spots", "0.2", "--areas", "0.1", "--outlines", "rectangles"];

/// Lights and the model of their maps, in full and quick.
const LIT: [(&str, &str); 2] = [("1000", "maps:4,128"), ("40", "maps:4,64")];

/// The job of a scene.
pub(crate) fn job(args: &StudyArgs, scene: &StudyScene, extent: &Extent) -> Job {
    let drawn = scene.options(args.size.unwrap_or(extent.size), args.seed);
    let drawn: Vec<&str> = drawn.iter().map(String::as_str).collect();
    let (lights, model) = LIT[usize::from(args.quick)];
    let ids = STRATEGIES.map(|id| format!("{id},{id}/occ")).join(",");
    let lit = ["--lights", lights, "--shadows", model];
    let timed = ["--frames", extent.frames, "--warmup", extent.warmup, "--truth", "full"];
    let compared = ["--strategies", &ids];
    let words = [&["compare"], &drawn[..], &SHARES, &lit, &timed, &compared].concat();
    Job::new(scene, OCCLUSION, "", &words)
}

const NOTE: &str = "Lights are points, spots and rectangles. \u{201c}/occ\u{201d} leaves out a light where its shadow maps hide \
     all of a group. All images have the bits of no culling. \u{201c}Left out\u{201d} counts the pairs of a light and a sample \
     in its range that lists lack. Rays from these samples see some of the lights: through gaps narrower than a texel, or \
     parts of an emitter between the points of its maps. The maps show shadow there, whatever the lists are. Times of a \
     software adapter say nothing of a GPU.";

/// The part of a scene's page; empty without records.
pub(crate) fn part(done: &Done, scene: &str) -> Part {
    let all = entries(done, scene, OCCLUSION);
    let body = if all.is_empty() { Html::default() } else { table(&all) };
    Part::new(OCCLUSION, "Lists that know occlusion", NOTE, body)
}

fn table(all: &[Entry<'_>]) -> Html {
    let row = |entry: &Entry<'_>| {
        Row::new(format!("{}{}", entry.record.strategy, entry.mark()), entry.record.clone())
    };
    let hidden = |record: &Record| record.lists.hidden;
    let columns = vec![
        Column::figure(
            "lights per sample",
            "",
            Better::Less,
            |record: &Record| record.lists.listed_per_sample,
            significant,
        ),
        Column::ms("assign", |record: &Record| Some(record.times.assign_ms)).id("assign_ms"),
        Column::ms("shade", |record: &Record| Some(record.times.shade_ms)).id("shade_ms"),
        Column::ms("assign + shade", |record: &Record| Some(total_ms(record))).id("total_ms"),
        Column::figure(
            "left out",
            "pairs",
            Better::Neither,
            move |record: &Record| Some(hidden(record)?.removed_pairs as f64),
            number,
        ),
        Column::figure(
            "seen by rays",
            "pairs",
            Better::Less,
            move |record: &Record| Some(hidden(record)?.seen_pairs as f64),
            number,
        ),
        Column::figure(
            "rectangles seen in part",
            "pairs",
            Better::Less,
            move |record: &Record| Some(hidden(record)?.seen_area_pairs as f64),
            number,
        ),
    ];
    Table::new("strategy", columns, all.iter().map(row).collect())
        .competing(|_| false)
        .html("Lists without and with occlusion", Look::Plain)
}

fn total_ms(record: &Record) -> f64 {
    record.times.assign_ms + record.times.shade_ms
}

/// The records of a strategy without and with `/occ`.
fn pairs<'a>(all: &[Entry<'a>]) -> Vec<[&'a Record; 2]> {
    let with = all.iter().map(|entry| entry.record);
    let with = with.filter(|record| record.strategy.options().leaves_out_hidden);
    let without = |record: &Record| {
        let id: StrategyId =
            record.strategy.with(|options| options.leaves_out_hidden = false).ok()?;
        all.iter().map(|entry| entry.record).find(|other| other.strategy == id)
    };
    with.filter_map(|record| Some([without(record)?, record])).collect()
}

/// What lists save, for each strategy: `In atrium, /occ takes SC-E/48x48x40/bvh from 12.1 to 8.3 lights per sample, and
/// from 1.20 to 0.98 ms.` Times only where a GPU took them.
pub(crate) fn finding(done: &Done, scene: &str) -> Option<String> {
    let all = entries(done, scene, OCCLUSION);
    let told: Vec<String> = pairs(&all)
        .into_iter()
        .filter_map(|[without, with]| {
            let [from, to] = [without, with].map(|record| record.lists.listed_per_sample);
            let lights = format!(
                "{} from {} to {} lights per sample",
                without.strategy,
                significant(from?),
                significant(to?)
            );
            let [before, after] = [without, with].map(|record| significant(total_ms(record)));
            let times = format!(" ({before} to {after} ms to assign and shade)");
            Some(if on_software(done) { lights } else { lights + &times })
        })
        .collect();
    (!told.is_empty())
        .then(|| format!("In {scene}, leaving out hidden lights takes {}.", told.join(", ")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::{Invocation, parse};
    use crate::study::shadows::jobs::{FULL, QUICK};

    #[test]
    fn the_job_is_a_command_with_each_strategy_twice() {
        for (line, extent) in [("", FULL), ("--quick", QUICK)] {
            let words =
                ["lightbench", "study", "shadows"].into_iter().chain(line.split_whitespace());
            let Ok(Invocation::Study(args)) = parse(words) else { panic!("{line}: a study") };
            let args = args.with_scenes(|_| vec!["atrium".to_owned()]);
            let scenes = StudyScene::all(&args).expect("scenes");
            let job = job(&args, &scenes[0], &extent);
            let Ok(Invocation::Compare(compare)) = parse(&job.command) else {
                panic!("{:?}", job.command)
            };
            let choices = compare.choices().expect("strategies");
            let hides = choices.iter().filter(|choice| choice.leaves_out_hidden()).count();
            assert_eq!((choices.len(), hides), (8, 4));
            crate::checks::check_options(&compare, &choices).expect("shadow maps");
        }
    }
}
