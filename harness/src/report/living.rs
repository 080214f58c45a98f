//! Lights that move, in words: how they move, and what that costs in each frame.

use assign::LightOrder;

use super::format::{mebibytes, significant};
use super::rank::listed;
use crate::digits::rounded;
use crate::results::{Record, Setting};

/// The passes that lights which move add to a frame, in the order in which they run.
pub(crate) const PASSES: [&str; 3] = ["upload", "order", "boxes"];

/// `drift at speed 1, moved by the GPU, sorted every 8 frames`; `None` if the lights stand still.
pub(crate) fn motion_words(setting: &Setting) -> Option<String> {
    let motion = setting.motion.as_ref()?;
    let mover = if motion.moved_by == "gpu" { "GPU" } else { "CPU" };
    let order = match setting.order() {
        Some(LightOrder::Gpu { every: 1 }) => "sorted in every frame".to_owned(),
        Some(LightOrder::Gpu { every }) => format!("sorted every {every} frames"),
        Some(LightOrder::GpuGrown { percent }) => {
            format!("sorted when boxes may have grown by {percent} %")
        }
        Some(LightOrder::Given) => "in the order of the scene".to_owned(),
        Some(order) => format!("ordered by the CPU ({order})"),
        None => "in an unknown order".to_owned(),
    };
    let speed = rounded(motion.speed_m_s);
    Some(format!("{} at speed {speed}, moved by the {mover}, {order}", motion.law))
}

/// What moving lights cost a method in each frame, one sentence: `Of its time, order takes 0.0031 ms and boxes
/// 0.0084 ms.`
pub(crate) fn cost_words(record: &Record) -> String {
    let part = |name: &str| {
        record.times.passes.get(name)?;
        let ms = significant(record.time_of(|pass, _| pass == name));
        let size = match record.times.upload_bytes.filter(|_| name == PASSES[0]) {
            Some(bytes) => format!(" ({} MiB)", mebibytes(bytes as f64)),
            None => String::new(),
        };
        Some(format!("{name} {ms} ms{size}"))
    };
    let parts: Vec<String> = PASSES.into_iter().filter_map(part).collect();
    match parts.is_empty() {
        true => "It reads the plain list, so moving lights cost it nothing.".to_owned(),
        false => format!("That costs it in each frame: {}.", listed(&parts)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::{MotionSetting, PassKind, PassTimes, Results};

    #[test]
    fn a_moving_record_says_how_it_moves_and_what_that_costs() {
        let example: Results =
            serde_json::from_str(include_str!("../results/example.json")).expect("the example");
        let mut record = example.records[0].clone();
        assert_eq!(motion_words(&record.setting), None);
        record.setting.motion =
            Some(MotionSetting { law: "drift".into(), speed_m_s: 1.0, moved_by: "cpu".into() });
        for (order, words) in [
            ("gpu8", "drift at speed 1, moved by the CPU, sorted every 8 frames"),
            ("gpu", "drift at speed 1, moved by the CPU, sorted in every frame"),
            (
                "gpu25%",
                "drift at speed 1, moved by the CPU, sorted when boxes may have grown by 25 %",
            ),
            ("given", "drift at speed 1, moved by the CPU, in the order of the scene"),
            ("bvh", "drift at speed 1, moved by the CPU, ordered by the CPU (bvh)"),
        ] {
            record.setting.light_order = Some(order.to_owned());
            assert_eq!(motion_words(&record.setting).as_deref(), Some(words));
        }
        assert!(cost_words(&record).contains("cost it nothing"));
        for (name, ms) in [("upload", 1.05), ("order", 0.0031)] {
            record.times.passes.insert(name, PassTimes::new(PassKind::Assign, vec![ms; 3]));
        }
        record.times.upload_bytes = Some(1 << 20);
        let words = "That costs it in each frame: upload 1.05 ms (1.00 MiB) and order 0.00310 ms.";
        assert_eq!(cost_words(&record), words);
    }
}
