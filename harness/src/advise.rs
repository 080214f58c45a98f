//! `lightbench advise`: a short search for the strategy and parameters to use on one scene and GPU.
//!
//! Three rounds, each a comparison of its own, so that every figure can be taken again:
//!
//! 1. `families`: every strategy at its default parameters, from both sources of lights.
//! 2. `parameters`: the three best families at other group sizes, from the better source.
//! 3. `final`: the best of both rounds, in turns and with more frames; where the budget allows an
//!    error, with capped lists too.
//!
//! The answer is the fastest of the last round whose error lies within the budget.

use std::fmt::Write;

use crate::{
    checks::check_writable,
    cli::{self, AdviseArgs, CliError, CompareArgs, Invocation},
    compare::Bench,
    error::HarnessError,
    report,
    results::{DeviceType, Record, Results},
};

/// The strategies of the first round.
const FAMILIES: &str = "T-I,T-E,DC-I,DC-E,SC-I,SC-E,G,HG,M,M/2";

/// Families that go on to the second round.
const FINALISTS: usize = 3;

/// Strategies that go on to the last.
const LAST: usize = 5;

/// Frames of a strategy in the first two rounds, and in the last: on a GPU, and on a software
/// adapter.
const FRAMES: [[u32; 2]; 2] = [[16, 48], [2, 6]];

/// The metric that the budget is a bound of.
const METRIC: &str = "rel_mse";

/// Searches, writes what was measured, and says what to use.
pub fn advise(args: &AdviseArgs, command: Vec<String>) -> Result<String, HarnessError> {
    if args.mode.modes().len() != 1 {
        return Err(CliError::out_of_range("--mode", "both", "deferred or forward").into());
    }
    let is_file = [".gltf", ".glb"].iter().any(|end| args.lights.to_lowercase().ends_with(end));
    if !is_file && args.lights.parse::<u32>().is_err() {
        let accepted = "a whole number from 0 to 16,777,216, or a .gltf or .glb file";
        return Err(CliError::out_of_range("--lights", &args.lights, accepted).into());
    }
    check_writable(&args.out)?;
    let mut bench = Bench::open(args.adapter.as_deref())?;
    let frames = FRAMES[usize::from(bench.gpu().is_software())];
    let mut search = Search { args, bench: &mut bench };

    let families = search.round("families", FAMILIES, &["--source", "both"], frames[0])?;
    let best = fastest_by_family(&families);
    let finalists: Vec<String> =
        best.iter().take(FINALISTS).flat_map(|record| variants(&record.strategy)).collect();
    if finalists.is_empty() {
        return Err(CliError::new("advise: no strategy showed the image of no culling").into());
    }
    let parameters = search.round("parameters", &finalists.join(","), &[], frames[0])?;

    let mut candidates: Vec<&Record> = families.records.iter().chain(&parameters.records).collect();
    candidates.retain(|record| record.is_exact());
    candidates.sort_by(|a, b| a.assign_and_shade_ms().total_cmp(&b.assign_and_shade_ms()));
    let mut last: Vec<String> = Vec::new();
    for record in candidates {
        if last.len() < LAST && !last.contains(&record.strategy) {
            last.push(record.strategy.clone());
        }
    }
    if args.error_budget > 0.0 {
        let lossy = last.iter().take(2).flat_map(|id| CAPS.map(|cap| format!("{id}/cap{cap}")));
        last.extend(lossy.collect::<Vec<_>>());
    }
    let ids = format!("None,Sphere,{}", last.join(","));
    let mut finals = search.round("final", &ids, &["--truth", "full"], frames[1])?;
    finals.command = command;
    let text = answer(&finals, args.error_budget);
    let table = report::render_table(&finals);
    let first_line = text.lines().next().unwrap_or_default().to_owned();
    finals.warnings.insert(0, first_line);
    finals.write(&args.out.join("results.json"))?;
    let pictures = crate::again::pictures(&finals, &args.out.join("final"));
    let page = report::write_html(&finals, &pictures, &args.out)?;
    Ok(format!("{table}\n{text}\nreport   {}\nrounds   {}\n", page.display(), args.out.display()))
}

/// Lights that a list keeps, where the budget allows an error.
const CAPS: [u32; 4] = [8, 16, 32, 64];

/// A search on its way.
struct Search<'a> {
    args: &'a AdviseArgs,
    bench: &'a mut Bench,
}

impl Search<'_> {
    /// One comparison, kept in a folder of its own.
    fn round(
        &mut self,
        name: &str,
        strategies: &str,
        more: &[&str],
        frames: u32,
    ) -> Result<Results, HarnessError> {
        let args = self.args;
        eprintln!("round    {name}: {} strategies", strategies.split(',').count());
        let (size, frames) =
            (format!("{}x{}", args.size.width, args.size.height), frames.max(1).to_string());
        let (scale, seed) = (args.scene_scale.to_string(), args.seed.to_string());
        let mode = args.mode.modes().first().map_or("deferred", |mode| mode.name());
        let mut words = vec!["lightbench", "compare", "--scene", &args.scene, "--scene-scale"];
        words.extend([scale.as_str(), "--size", &size, "--seed", &seed, "--frames", &frames]);
        words.extend(["--mode", mode, "--strategies", strategies]);
        match args.lights.parse::<u32>() {
            Ok(_) => words.extend(["--lights", &args.lights]),
            Err(_) => words.extend(["--lights", "0", "--lights-from", &args.lights]),
        }
        if !more.contains(&"full") {
            words.extend(["--truth", "none", "--pictures", "none"]);
        }
        words.extend(more);
        let command: Vec<String> = words.into_iter().map(str::to_owned).collect();
        let Invocation::Compare(compare) = cli::parse(&command)? else {
            return Err(CliError::new("advise: a round compares nothing").into());
        };
        let out = args.out.join(name);
        let (results, _) =
            self.bench.compare(&CompareArgs { out: out.clone(), ..compare }, command)?;
        results.write(&out.join("results.json"))?;
        Ok(results)
    }
}

/// The fastest record of each family, fastest first; those that lost something are left out.
fn fastest_by_family(results: &Results) -> Vec<&Record> {
    let mut best: Vec<&Record> = Vec::new();
    let mut records: Vec<&Record> =
        results.records.iter().filter(|record| record.is_lossless()).collect();
    records.sort_by(|a, b| a.assign_and_shade_ms().total_cmp(&b.assign_and_shade_ms()));
    for record in records {
        if best.iter().all(|known| family(&known.strategy) != family(&record.strategy)) {
            best.push(record);
        }
    }
    best
}

fn family(id: &str) -> &str {
    id.split('/').next().unwrap_or(id)
}

/// The same strategy at other group sizes, from the same source.
fn variants(id: &str) -> Vec<String> {
    let source = if id.split('/').any(|segment| segment == "bvh") { "/bvh" } else { "" };
    let sizes: &[&str] = match family(id) {
        "T-I" | "T-E" => &["16x16", "20x20", "24x24", "32x32", "48x48"],
        "DC-I" | "DC-E" | "SC-I" | "SC-E" | "HG" => {
            &["32x32x40", "32x32x64", "40x40x64", "48x48x64", "64x64x64", "96x96x64", "128x128x32"]
        }
        "G" => &["12x12x12", "16x16x16", "28x28x28", "40x40x40"],
        _ => &["1", "3", "4", "8"],
    };
    sizes.iter().map(|size| format!("{}/{size}{source}", family(id))).collect()
}

/// What to use, what it costs, what comes next, and why.
pub fn answer(results: &Results, error_budget: f64) -> String {
    let error = |record: &Record| match record.is_lossless() {
        true => Some(0.0),
        false => record.errors.get(METRIC).copied().flatten(),
    };
    let mut within: Vec<&Record> = results
        .records
        .iter()
        .filter(|record| !record.is_control() && record.assign_and_shade_ms().is_finite())
        .filter(|record| error(record).is_some_and(|error| error <= error_budget))
        .collect();
    within.sort_by(|a, b| a.assign_and_shade_ms().total_cmp(&b.assign_and_shade_ms()));
    let (Some(best), next) = (within.first(), within.get(1)) else {
        return "Nothing stayed within the error budget.\n".to_owned();
    };
    let ms = |value: f64| report::significant(value);
    let mut text = format!(
        "Use {}: {} ms to assign and shade {} lights ({} + {})",
        best.strategy,
        ms(best.assign_and_shade_ms()),
        best.lights,
        ms(best.assign_ms),
        ms(best.shade_ms),
    );
    if let Some(interval) = best.interval_ms() {
        let _ = write!(text, ", median within {} to {}", ms(interval.low), ms(interval.high));
    }
    let _ = match error(best) {
        Some(0.0) if best.is_lossy => {
            writeln!(
                text,
                ", the image of no culling in this view: elsewhere its lists may lose lights."
            )
        }
        Some(0.0) => writeln!(text, ", the image of no culling bit for bit."),
        error => writeln!(text, ", relMSE {:.1e} in this view.", error.unwrap_or(f64::NAN)),
    };
    if let Some(next) = next {
        let ratio = next.assign_and_shade_ms() / best.assign_and_shade_ms();
        let told = if report::indistinguishable(best, next) == Some(true) {
            "which cannot be told apart from it".to_owned()
        } else {
            format!("{:.1} % slower", (ratio - 1.0) * 100.0)
        };
        let _ = writeln!(
            text,
            "Runner-up: {}, {} ms, {told}.",
            next.strategy,
            ms(next.assign_and_shade_ms())
        );
    }
    let _ = writeln!(text, "Why: {}.", why(best, next.copied(), results));
    if results.machine.device_type == DeviceType::Cpu {
        let _ = writeln!(text, "These are figures of a software adapter, not a GPU's.");
    }
    text
}

/// What makes the difference.
fn why(best: &Record, next: Option<&Record>, results: &Results) -> String {
    if !best.culls() {
        return format!("with {} lights no list pays for the passes that make it", best.lights);
    }
    let mut reasons = Vec::new();
    if let (Some(listed), Some(reach)) = (best.listed_per_sample, best.contributing_per_sample) {
        reasons.push(format!(
            "its lists hold {} lights a sample where {} reach it",
            report::significant(listed),
            report::significant(reach)
        ));
    }
    if let Some(next) = next.filter(|next| next.culls()) {
        let part = |name: &str, ms: f64| {
            let gain = if ms < 0.0 { "costs" } else { "saves" };
            format!("{name} {gain} {} ms", report::significant(ms.abs()))
        };
        reasons.push(format!(
            "against the runner-up {} and {}",
            part("assigning", next.assign_ms - best.assign_ms),
            part("shading", next.shade_ms - best.shade_ms)
        ));
    }
    let none = results.records.iter().find(|record| record.is_baseline());
    if let Some(none) = none {
        let ratio = none.assign_and_shade_ms() / best.assign_and_shade_ms();
        reasons.push(format!("no culling takes {} times as long", report::significant(ratio)));
    }
    reasons.join("; ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn variants_keep_family_and_source() {
        for id in ["T-E/28x28/bvh", "SC-E/48x48x40", "G/20x20x20/bvh", "M/2", "HG/48x48x40"] {
            let all = variants(id);
            assert!(all.len() >= 4);
            for variant in all {
                assert_eq!(family(&variant), family(id));
                assert_eq!(variant.ends_with("/bvh"), id.ends_with("/bvh"), "{variant}");
            }
        }
    }
}
