//! How the lights of a job move: four cases, in the order in which pages show them.

use assign::LightOrder;

use crate::results::Record;

/// Frames between two sorts, where lights are not sorted in every frame.
pub(crate) const SORTED_EVERY: u32 = 8;

/// How lights move, and who orders them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Movement {
    /// They stand still. The CPU builds the hierarchy beforehand, off the clock.
    Still,
    /// The GPU moves them, and sorts them in every eighth frame.
    Gpu,
    /// The same, sorted in every frame.
    Sorted,
    /// The CPU moves and uploads them, and the GPU sorts them in every eighth frame.
    Cpu,
}

impl Movement {
    pub(crate) const ALL: [Self; 4] = [Self::Still, Self::Gpu, Self::Sorted, Self::Cpu];

    /// That of a record.
    pub(crate) fn of(record: &Record) -> Self {
        match &record.setting.motion {
            None => Self::Still,
            Some(motion) if motion.moved_by == "cpu" => Self::Cpu,
            Some(_) if record.setting.order() == Some(LightOrder::Gpu { every: 1 }) => Self::Sorted,
            Some(_) => Self::Gpu,
        }
    }

    /// Its name in those of jobs.
    pub(crate) fn slug(self) -> &'static str {
        match self {
            Self::Still => "still",
            Self::Gpu => "gpu8",
            Self::Sorted => "gpu",
            Self::Cpu => "cpu",
        }
    }

    /// Its name in charts and tables.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Still => "still",
            Self::Gpu => "moved by GPU",
            Self::Sorted => "moved by GPU, sorted in every frame",
            Self::Cpu => "moved by CPU",
        }
    }

    /// The class that colours it.
    pub(crate) fn class(self) -> &'static str {
        match self {
            Self::Still => "series-8",
            Self::Gpu => "series-0",
            Self::Sorted => "series-4",
            Self::Cpu => "series-3",
        }
    }

    /// The options of a job whose lights move so by a law at a speed.
    pub(crate) fn options(self, law: &str, speed: f64) -> Vec<String> {
        let (mover, order) = match self {
            Self::Still => return Vec::new(),
            Self::Gpu => ("gpu", format!("gpu{SORTED_EVERY}")),
            Self::Sorted => ("gpu", "gpu".to_owned()),
            Self::Cpu => ("cpu", format!("gpu{SORTED_EVERY}")),
        };
        let speed = speed.to_string();
        let words =
            ["--motion", law, "--speed", &speed, "--moved-by", mover, "--light-order", &order];
        words.map(str::to_owned).to_vec()
    }
}
