//! Decides which methods pay for a pass, and computes the cost of a method in each kind of frame.
//!
//! The bill depends only on the name of a pass, the mode and the method, so stored results get the same bill
//! as new ones. Making the lights is on no bill ([`makes_lights`]): every method needs them.
//!
//! A renderer draws one of these frames:
//!
//! | frame | a method that reads depth | other methods |
//! |---|---|---|
//! | forward, no pre-pass | pays for a depth pre-pass | also light hidden surfaces that are drawn first |
//! | forward | the frame has a depth pre-pass | the same |
//! | deferred | the frame has depth and G-buffer; one that needs models pays for `model-ids` | the same |
//! | deferred, ids in the G-buffer | the frame has everything | the same |

use assign_clustered::Scatter;
use shading::Mode;

use super::{PassKind, Record};
use crate::strategy::StrategyId;

/// Whether a pass makes the lights of a frame: the reflective shadow map, deep images, virtual point lights.
/// Methods that read no hierarchy need no order of the lights: `vpl-order` and `vpl-boxes`.
pub fn makes_lights(name: &str) -> bool {
    ["rsm-", "cdi-", "vpl-"].iter().any(|start| name.starts_with(start)) || name == "random-ranges"
}

/// The kind of a pass, which decides its bill. A pass that the pipeline does not know belongs to the strategy.
/// In forward shading, the G-buffer is drawn only for a strategy that reads normals. Without a pre-pass, depth
/// is drawn only for a strategy that reads it.
pub fn pass_kind(name: &str, mode: Mode) -> PassKind {
    match (name, mode) {
        (name, _) if makes_lights(name) => PassKind::Other,
        ("gbuffer", mode) if mode.is_forward() => PassKind::Assign,
        ("depth", Mode::ForwardNoPrepass) => PassKind::Assign,
        ("depth" | "gbuffer" | "resolve" | "fog-sum" | "fog-apply", _) => PassKind::Scene,
        ("shadow-plan" | "shadow-maps", _) => PassKind::Scene,
        ("shade" | "clay" | "fog-light" | "blend", _) => PassKind::Shade,
        _ => PassKind::Assign,
    }
}

/// Whether a pass of a method in a mode rasterises triangles and runs fragment shaders.
pub fn is_raster_pass(name: &str, mode: Mode, strategy: &StrategyId) -> bool {
    match name {
        "depth" | "gbuffer" | "model-ids" | "clay" | "rsm-depth" | "rsm-gbuffer" => true,
        "blend" | "fog-apply" | "shadow-maps" => true,
        "shade" => mode.is_forward() || strategy.shade_rasterises(),
        "count" | "fill" => strategy.options().scatter == Scatter::Raster,
        _ => false,
    }
}

/// A kind of frame that a renderer may draw.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrameKind {
    /// Forward shading without a depth pre-pass.
    NoPrepass,
    /// Forward shading after a depth pre-pass.
    Prepass,
    /// Deferred shading whose G-buffer has no models.
    Deferred,
    /// Deferred shading with the model of each pixel in the G-buffer.
    DeferredIds,
}

impl FrameKind {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::NoPrepass, Self::Prepass, Self::Deferred, Self::DeferredIds];

    /// The mode that measures it.
    pub fn mode(self) -> Mode {
        match self {
            Self::NoPrepass => Mode::ForwardNoPrepass,
            Self::Prepass => Mode::Forward,
            Self::Deferred => Mode::Deferred,
            Self::DeferredIds => Mode::DeferredIds,
        }
    }
}

/// The cost of a method in a kind of frame, ms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bill {
    /// Assigning lights, with all passes that the frame draws only for this method.
    pub assign_ms: f64,
    /// Lighting pixels.
    pub shade_ms: f64,
    /// All passes.
    pub frame_ms: f64,
    /// Assigning and lighting, including gaps; `None` if unknown.
    pub span_ms: Option<f64>,
    /// Whether it was computed from another kind of frame.
    pub is_derived: bool,
}

impl Bill {
    /// Assigning and lighting, ms.
    pub fn both_ms(&self) -> f64 {
        self.assign_ms + self.shade_ms
    }

    /// The cost of a method in a kind of frame, from its records in any mode under the same lights: measured
    /// if such a record exists, else derived.
    ///
    /// Without a pre-pass, a method that reads depth draws the same passes as with one, and pays for one more.
    /// With ids in the G-buffer, a method needs no `model-ids`; the cost of the ids in the G-buffer is then
    /// unknown. Nothing else can be derived.
    pub fn in_frame(kind: FrameKind, records: &[&Record]) -> Option<Self> {
        let in_mode = |mode: Mode| records.iter().find(|record| record.setting.mode == mode);
        if let Some(record) = in_mode(kind.mode()) {
            return Some(Self {
                assign_ms: record.times.assign_ms,
                shade_ms: record.times.shade_ms,
                frame_ms: record.times.frame_ms,
                span_ms: record.times.span_ms,
                is_derived: false,
            });
        }
        let derived = |record: &Record, assign_ms: f64, frame_ms: f64| Self {
            assign_ms,
            shade_ms: record.times.shade_ms,
            frame_ms,
            span_ms: None,
            is_derived: true,
        };
        match kind {
            FrameKind::NoPrepass => {
                in_mode(Mode::Forward).filter(|record| record.reads_depth()).map(|record| {
                    derived(record, record.assign_with_depth_ms(), record.times.frame_ms)
                })
            }
            FrameKind::DeferredIds => in_mode(Mode::Deferred).map(|record| {
                let without_ids = |name: &str| name != "model-ids";
                let assign =
                    record.time_of(|name, kind| kind == PassKind::Assign && without_ids(name));
                derived(record, assign, record.time_of(|name, _| without_ids(name)))
            }),
            FrameKind::Prepass | FrameKind::Deferred => None,
        }
    }
}

impl Record {
    /// The passes of its bill that rasterise triangles: `shade` in forward shading and for light volumes,
    /// `model-ids`, and passes that are drawn only for this method.
    pub fn raster_passes(&self) -> Vec<&str> {
        let is_billed = |kind| matches!(kind, PassKind::Assign | PassKind::Shade);
        self.times
            .passes
            .iter()
            .filter(|(name, times)| {
                is_billed(times.kind) && is_raster_pass(name, self.setting.mode, &self.strategy)
            })
            .map(|(name, _)| name)
            .collect()
    }

    /// Whether the method reads the depth of surfaces before it assigns lights.
    pub fn reads_depth(&self) -> bool {
        self.strategy.reads_depth()
    }

    /// Assigning lights, with the depth pre-pass where the method reads depth, ms.
    pub fn assign_with_depth_ms(&self) -> f64 {
        let reads_depth = self.reads_depth();
        self.time_of(|name, kind| kind == PassKind::Assign || (reads_depth && name == "depth"))
    }

    /// Assigning and lighting, with the depth pre-pass on the bill of methods that read depth, ms.
    pub fn with_depth_ms(&self) -> f64 {
        self.assign_with_depth_ms() + self.times.shade_ms
    }

    /// Bills the passes by today's rules. Older versions billed no method for the G-buffer that forward shading
    /// draws for normals.
    pub(super) fn bill_again(&mut self) {
        let mode = self.setting.mode;
        let changed = |name: &str| name == "gbuffer" && mode.is_forward();
        if self
            .times
            .passes
            .iter()
            .any(|(name, pass)| changed(name) && pass.kind == PassKind::Scene)
        {
            self.times.passes.bill_again(|name, kind| match changed(name) {
                true => pass_kind(name, mode),
                false => kind,
            });
            self.set_times();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::{PassTimes, Results};

    fn record(strategy: &str, mode: Mode, passes: &[(&str, f64)]) -> Record {
        let example: Results =
            serde_json::from_str(include_str!("example.json")).expect("the example");
        let mut record = example.records[0].clone();
        (record.strategy, record.setting.mode) = (strategy.into(), mode);
        let times = |ms: f64| vec![ms; 3];
        record.times.passes = passes
            .iter()
            .map(|(name, ms)| (*name, PassTimes::new(pass_kind(name, mode), times(*ms))))
            .collect();
        record.set_times();
        record
    }

    #[test]
    fn records_list_their_raster_passes() {
        let passes_of = |strategy: &str, mode, passes: &[(&str, f64)]| {
            record(strategy, mode, passes).raster_passes().join(",")
        };
        let deferred = [("depth", 1.0), ("gbuffer", 1.0), ("cull", 1.0), ("shade", 1.0)];
        assert_eq!(passes_of("T-E/28x28", Mode::Deferred, &deferred), "");
        assert_eq!(passes_of("RasterSphere", Mode::Deferred, &deferred), "shade");
        let ids = [("depth", 1.0), ("model-ids", 1.0), ("cull", 1.0), ("shade", 1.0)];
        assert_eq!(passes_of("M/2/bvh", Mode::Deferred, &ids), "model-ids");
        let hybrid = [("depth", 1.0), ("count", 1.0), ("sort", 1.0), ("fill", 1.0), ("shade", 1.0)];
        assert_eq!(passes_of("HG/48x48x40", Mode::Deferred, &hybrid), "");
        assert_eq!(passes_of("HG/48x48x40/raster", Mode::Deferred, &hybrid), "count,fill");
        assert_eq!(passes_of("T-E/28x28", Mode::Forward, &deferred), "gbuffer,shade");
        assert_eq!(passes_of("T-E/28x28", Mode::ForwardNoPrepass, &ids[..1]), "depth");
        // All methods draw the maps of lights that move; those with `/occ` pay for what they ask of them.
        let moving =
            [("shadow-plan", 1.0), ("shadow-maps", 3.0), ("occluders", 1.0), ("shade", 1.0)];
        let moving = record("T-E/28x28/occ", Mode::Deferred, &moving);
        assert_eq!((moving.times.assign_ms, moving.times.frame_ms), (1.0, 6.0));
    }

    #[test]
    fn a_frame_bills_only_passes_that_it_does_not_draw_for_all() {
        let explicit = [("depth", 0.5), ("bounds", 0.1), ("cull", 0.2), ("shade", 1.0)];
        let forward = record("SC-E/48x48x40/bvh", Mode::Forward, &explicit);
        assert!((forward.with_depth_ms() - 1.8).abs() < 1e-12);
        let none = Bill::in_frame(FrameKind::NoPrepass, &[&forward]).expect("derived");
        assert!(none.is_derived && (none.assign_ms - 0.8).abs() < 1e-12, "{none:?}");
        assert!((none.frame_ms - 1.8).abs() < 1e-12, "{none:?}");
        let measured = record("SC-E/48x48x40/bvh", Mode::ForwardNoPrepass, &explicit);
        let bill = Bill::in_frame(FrameKind::NoPrepass, &[&forward, &measured]).expect("measured");
        assert!(!bill.is_derived && (bill.assign_ms - 0.8).abs() < 1e-12, "{bill:?}");
        // The cost of lighting hidden surfaces cannot be derived.
        let implicit = record("T-I/28x28", Mode::Forward, &explicit);
        assert_eq!(Bill::in_frame(FrameKind::NoPrepass, &[&implicit]), None);
        assert!((implicit.with_depth_ms() - 1.3).abs() < 1e-12);
        let ids =
            [("depth", 0.5), ("gbuffer", 1.0), ("model-ids", 0.5), ("cull", 0.1), ("shade", 0.3)];
        let models = record("M/2", Mode::Deferred, &ids);
        let deferred = Bill::in_frame(FrameKind::Deferred, &[&models]).expect("measured");
        let with_ids = Bill::in_frame(FrameKind::DeferredIds, &[&models]).expect("derived");
        assert!((deferred.both_ms() - 0.9).abs() < 1e-12 && !deferred.is_derived);
        assert!((with_ids.both_ms() - 0.4).abs() < 1e-12 && with_ids.is_derived);
        assert!((with_ids.frame_ms - 1.9).abs() < 1e-12);
    }

    #[test]
    fn a_stored_forward_record_pays_for_its_g_buffer() {
        let passes = [("depth", 1.0), ("gbuffer", 2.0), ("cull", 1.0), ("shade", 1.0)];
        let mut stored = record("SC-E/48x48x40/n6", Mode::Forward, &passes);
        stored.times.passes.bill_again(|name, kind| match name {
            "gbuffer" => PassKind::Scene,
            _ => kind,
        });
        stored.set_times();
        assert_eq!(stored.times.assign_ms, 1.0);
        stored.bill_again();
        assert_eq!((stored.times.assign_ms, stored.times.frame_ms), (3.0, 5.0));
    }
}
