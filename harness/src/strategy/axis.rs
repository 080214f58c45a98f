//! The axes that a family can vary on besides its parameters, and the segments that set them.

use assign::{
    AreaBounds, FrustumTests, Kept, LightSource, Storage, check_specular_reach, check_threshold,
};
use assign_clustered::{Normals, Scatter, Slices, SpecularCut};
use assign_grid::GridBox;
use serde_json::Value;

use super::segments::{
    CAP, CASCADES, EVEN, HALF, KEEP, NEAR, NO_EXIT, NORMALS, OCCLUSION, PLAIN_DEPTH, RASTER, REACH,
    RECTANGLE, REUSE, STOCHASTIC, TOUCHED, UNORDERED,
};
use super::{Options, specular};

/// An axis besides the parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// How depth is cut into slices: `even`, `near5`, or `cascades3`.
    Slices,
    /// What adds lights to cells: `raster`.
    Scatter,
    /// The box that is cut into cells: `positions`, `supports`, `surfaces`, `frustum` or `visible`.
    Box,
    /// Bins of normals that split clusters: `n6`.
    Normals,
    /// Which specular light of area lights is left out: `s0.001`, `cone45` or `dif`. Lossy.
    Specular,
    /// Out to how many of its ranges a light is listed for its specular term, at most: `reach8`.
    Reach,
    /// The union of frustum tests: `hs+sat-n`.
    Tests,
    /// Where lights come from: `linear` or `bvh`.
    Source,
    /// What bounds the reach of an area light: `ball` instead of its outline.
    AreaBounds,
    /// Where a group's lights are kept: `mask`, a bit per light, in place of a list; `scalar`, masks whose words
    /// subgroups read together; `prune`, a list that subgroups prune while they read it; `tree`, a list with a tree of
    /// the depths that its lights reach.
    Storage,
    /// Whether lists leave out lights that shadow maps hide from all samples of a group: `occ`.
    Occlusion,
    /// Whether lights must also touch a rectangle on the screen that is too small: `rect`. A flaw.
    Rectangle,
    /// Whether lists are made for positions and ranges in half precision: `half`. A flaw.
    Half,
    /// Whether lists are made for view depths that ignore an oblique near plane: `plain-depth`. A flaw.
    PlainDepth,
    /// The most lights of a frame: `first256` or `nearest256`, the others dropped. Lossy.
    Fewer,
    /// The irradiance below which lights stay at random: `stochastic0.01`. Lossy.
    Stochastic,
    /// For how many frames lists are used: `reuse4`. Lossy where groups or lights move.
    Reuse,
    /// For how many frames lists are kept that hold all lights wherever they may move: `keep4`.
    Keep,
    /// Whether only those lists are made again that a changed light touches: `touched`.
    Touched,
    /// Whether lists have a random order in each frame: `unordered`. A flaw.
    Order,
    /// The most lights of a list, the others dropped: `cap32`. Lossy.
    Cap,
    /// Whether shading evaluates every listed light, also where it adds nothing: `no-exit`.
    Exit,
}

impl Axis {
    /// All axes, in the order of their segments in an id.
    pub const ALL: [Self; 22] = [
        Self::Slices,
        Self::Scatter,
        Self::Box,
        Self::Normals,
        Self::Specular,
        Self::Reach,
        Self::Tests,
        Self::Source,
        Self::AreaBounds,
        Self::Storage,
        Self::Occlusion,
        Self::Rectangle,
        Self::Half,
        Self::PlainDepth,
        Self::Stochastic,
        Self::Fewer,
        Self::Reuse,
        Self::Keep,
        Self::Touched,
        Self::Order,
        Self::Cap,
        Self::Exit,
    ];

    /// Whether its segment is a flaw: a method with it fails on purpose.
    pub(super) fn is_flaw(self) -> bool {
        matches!(self, Self::Rectangle | Self::Half | Self::PlainDepth | Self::Order)
    }

    /// Its name, as lists of strategies show it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Slices => "slices",
            Self::Scatter => "scatter",
            Self::Box => "box",
            Self::Normals => "normals",
            Self::Specular => "specular",
            Self::Reach => REACH,
            Self::Tests => "tests",
            Self::Source => "source",
            Self::AreaBounds => "area-bounds",
            Self::Storage => "storage",
            Self::Occlusion => "occlusion",
            Self::Rectangle => RECTANGLE,
            Self::Half => HALF,
            Self::PlainDepth => PLAIN_DEPTH,
            Self::Fewer => "fewer",
            Self::Stochastic => STOCHASTIC,
            Self::Reuse => REUSE,
            Self::Keep => KEEP,
            Self::Touched => TOUCHED,
            Self::Order => UNORDERED,
            Self::Cap => CAP,
            Self::Exit => "exit",
        }
    }

    /// What its segment may be.
    pub fn accepted(self) -> &'static str {
        match self {
            Self::Slices => {
                "even for slices that are equally deep; near and where the first slice ends, in metres, such as \
                 near5; or cascades and a number from 2 to 4, such as cascades3, which makes near tiles larger"
            }
            Self::Tests => "a union of hs, sat-e, sat-n, sat-p and sat-v",
            Self::Source => "linear or bvh",
            Self::AreaBounds => "ball or outline",
            Self::Storage => {
                "mask, which keeps a bit per light in place of a list, scalar, which lets the lanes of a subgroup \
                 read masks together, prune, which lets them leave out lights of the list that miss their samples, \
                 or tree, which leaves out lights of the list that lie before or behind a sample"
            }
            Self::Occlusion => {
                "occ, which leaves out lights that shadow maps hide from all of a group; with --shadows maps"
            }
            Self::Scatter => "raster, which lets the rasteriser find the tiles of each light",
            Self::Box => "positions, supports, surfaces, frustum or visible",
            Self::Normals => "n and the number of normal bins: n1, n6, n24 or n54",
            Self::Specular => {
                "the specular light to leave out: s and a radiance, such as s0.001; cone and the half \
                 angle of a lobe in degrees, such as cone45 (Swarbrick 2025); or dif, which leaves out \
                 all beyond the reach of diffuse light"
            }
            Self::Reach => {
                "reach and the ranges out to which polished surfaces have lights for their specular term, such as \
                 reach8"
            }
            Self::Cap => "cap and the most lights of a list, such as cap32",
            Self::Fewer => {
                "first or nearest and the most lights of a frame, such as nearest256, which drops lights that are \
                 farther away"
            }
            Self::Stochastic => {
                "stochastic and the irradiance below which lights stay at random, such as stochastic0.01"
            }
            Self::Reuse => {
                "reuse and the number of frames for which lists are used, such as reuse4"
            }
            Self::Keep => {
                "keep and the most frames for which lists of larger lights are kept, such as keep4"
            }
            Self::Touched => {
                "touched, which makes only those lists again that a changed light touches"
            }
            Self::Exit => "no-exit, which evaluates every listed light",
            Self::Rectangle => {
                "rect, a flaw: lights must touch a rectangle on the screen that is too small"
            }
            Self::Half => "half, a flaw: lists are made for positions and ranges in half precision",
            Self::PlainDepth => {
                "plain-depth, a flaw: lists are made for view depths that ignore an oblique near plane"
            }
            Self::Order => "unordered, a flaw: lists have another order in each frame",
        }
    }

    /// The axis that a segment in lower case sets; `None` where it can only be parameters.
    pub(super) fn of_segment(segment: &str) -> Option<Self> {
        match segment {
            "linear" | "bvh" => Some(Self::Source),
            _ if segment.parse::<GridBox>().is_ok() => Some(Self::Box),
            "ball" | "outline" => Some(Self::AreaBounds),
            _ if segment.starts_with(CAP) => Some(Self::Cap),
            _ if number_after(segment, NORMALS).is_some() => Some(Self::Normals),
            NO_EXIT => Some(Self::Exit),
            RECTANGLE => Some(Self::Rectangle),
            HALF => Some(Self::Half),
            PLAIN_DEPTH => Some(Self::PlainDepth),
            UNORDERED => Some(Self::Order),
            EVEN => Some(Self::Slices),
            RASTER => Some(Self::Scatter),
            OCCLUSION => Some(Self::Occlusion),
            _ if fewer_of(segment).is_some() => Some(Self::Fewer),
            _ if segment.starts_with(NEAR) => Some(Self::Slices),
            _ if segment.starts_with(CASCADES) => Some(Self::Slices),
            _ if storage_of(segment).is_some() => Some(Self::Storage),
            TOUCHED => Some(Self::Touched),
            _ if specular::parse(segment).is_some() => Some(Self::Specular),
            _ if segment.starts_with(STOCHASTIC) => Some(Self::Stochastic),
            _ if segment.starts_with(REACH) => Some(Self::Reach),
            _ if segment.starts_with(REUSE) => Some(Self::Reuse),
            _ if segment.starts_with(KEEP) => Some(Self::Keep),
            _ => segment.parse::<FrustumTests>().ok().map(|_| Self::Tests),
        }
    }

    /// Sets the axis from its segment in lower case; `None` where the segment says nothing valid.
    pub(super) fn set(self, options: &mut Options, segment: &str) -> Option<()> {
        match self {
            Self::Tests => options.tests = Some(segment.parse().ok()?),
            Self::Source => {
                options.source = Some(match segment {
                    "bvh" => LightSource::Hierarchy,
                    _ => LightSource::Linear,
                });
            }
            Self::AreaBounds => {
                options.area_bounds = match segment {
                    "ball" => AreaBounds::Ball,
                    _ => AreaBounds::Outline,
                };
            }
            Self::Box => options.grid_box = segment.parse().ok()?,
            Self::Normals => {
                let normals = Normals::Bins(number_after(segment, NORMALS)?);
                normals.check().ok()?;
                options.normals = normals;
            }
            Self::Specular => options.specular = specular::parse(segment)?,
            Self::Reach => {
                let most = segment.strip_prefix(REACH)?.parse().ok()?;
                check_specular_reach(most).ok()?;
                options.reach = Some(most);
            }
            Self::Cap => options.cap = Some(number_after(segment, CAP)?),
            Self::Fewer => options.fewer = Some(fewer_of(segment)?),
            Self::Stochastic => {
                let threshold = segment.strip_prefix(STOCHASTIC)?.parse().ok()?;
                check_threshold(threshold).ok()?;
                options.stochastic = Some(threshold);
            }
            Self::Reuse => options.reuse = Some(number_after(segment, REUSE)?),
            Self::Keep => options.keep = Some(number_after(segment, KEEP)?),
            Self::Slices => {
                let slices = match (segment.strip_prefix(NEAR), segment.strip_prefix(CASCADES)) {
                    (Some(end_m), _) => Slices::Near(end_m.parse().ok()?),
                    (_, Some(count)) => Slices::Cascaded(count.parse().ok()?),
                    (None, None) => Slices::Even,
                };
                slices.check(Slices::MAX_CASCADES).ok()?;
                options.slices = slices;
            }
            Self::Scatter => options.scatter = Scatter::Raster,
            Self::Storage => options.storage = storage_of(segment)?,
            Self::Touched => options.is_touched = true,
            Self::Occlusion => options.leaves_out_hidden = true,
            Self::Exit => options.evaluates_all = true,
            Self::Rectangle => options.is_rectangle = true,
            Self::Half => options.is_half = true,
            Self::PlainDepth => options.is_plain_depth = true,
            Self::Order => options.is_unordered = true,
        }
        Some(())
    }

    /// The segment that an id has for the axis; `None` at its default.
    pub(super) fn segment(self, options: &Options) -> Option<String> {
        let settings = options.settings();
        match self {
            Self::Tests => {
                (settings.tests != FrustumTests::default()).then(|| settings.tests.to_string())
            }
            Self::Source => (settings.source == LightSource::Hierarchy).then(|| "bvh".to_owned()),
            Self::AreaBounds => {
                (settings.area_bounds == AreaBounds::Ball).then(|| "ball".to_owned())
            }
            Self::Box => {
                (options.grid_box != GridBox::default()).then(|| options.grid_box.name().to_owned())
            }
            Self::Normals => match options.normals {
                Normals::None => None,
                Normals::Bins(count) => Some(format!("{NORMALS}{count}")),
            },
            Self::Specular => specular::segment(options.specular),
            Self::Reach => options.reach.map(|most| format!("{REACH}{most}")),
            Self::Cap => options.cap.map(|most| format!("{CAP}{most}")),
            Self::Fewer => options.fewer.map(|(kept, most)| format!("{}{most}", kept.name())),
            Self::Stochastic => {
                options.stochastic.map(|threshold| format!("{STOCHASTIC}{threshold}"))
            }
            Self::Reuse => options.reuse.map(|frames| format!("{REUSE}{frames}")),
            Self::Keep => options.keep.map(|frames| format!("{KEEP}{frames}")),
            Self::Slices => options.slices.segment().strip_prefix('/').map(str::to_owned),
            Self::Scatter => options.scatter.segment().strip_prefix('/').map(str::to_owned),
            Self::Storage => options.storage.name().map(str::to_owned),
            Self::Occlusion => options.leaves_out_hidden.then(|| OCCLUSION.to_owned()),
            Self::Touched => options.is_touched.then(|| TOUCHED.to_owned()),
            Self::Exit => options.evaluates_all.then(|| NO_EXIT.to_owned()),
            Self::Rectangle => options.is_rectangle.then(|| RECTANGLE.to_owned()),
            Self::Half => options.is_half.then(|| HALF.to_owned()),
            Self::PlainDepth => options.is_plain_depth.then(|| PLAIN_DEPTH.to_owned()),
            Self::Order => options.is_unordered.then(|| UNORDERED.to_owned()),
        }
    }

    /// The name and the value of the axis among the parameters of stored results; `None` where results
    /// leave it out.
    pub(super) fn parameter(self, options: &Options) -> Option<(&'static str, Value)> {
        let settings = options.settings();
        Some(match self {
            Self::Tests => ("tests", settings.tests.to_string().into()),
            Self::Source => match settings.source {
                LightSource::Hierarchy => ("source", "bvh".into()),
                LightSource::Linear => ("source", "linear".into()),
            },
            Self::Box => ("box", options.grid_box.name().into()),
            Self::AreaBounds => match settings.area_bounds {
                AreaBounds::Ball => ("area_bounds", "ball".into()),
                AreaBounds::Outline => return None,
            },
            Self::Normals => match options.normals {
                Normals::None => return None,
                Normals::Bins(count) => ("normal_bins", count.into()),
            },
            Self::Specular => match options.specular {
                SpecularCut::None => return None,
                SpecularCut::Below(radiance) => ("specular_threshold", shortest(radiance)),
                SpecularCut::ReflectedCone(degrees) => ("lobe_degrees", shortest(degrees)),
                SpecularCut::WhereDiffuse => ("specular_where_diffuse", true.into()),
            },
            Self::Reach => ("specular_reach", shortest(options.reach?)),
            Self::Cap => ("list_cap", options.cap?.into()),
            Self::Fewer => ("frame_cap", self.segment(options)?.into()),
            Self::Stochastic => ("stochastic_threshold", shortest(options.stochastic?)),
            Self::Reuse => ("reuse_frames", options.reuse?.into()),
            Self::Keep => ("keep_frames", options.keep?.into()),
            Self::Slices => match options.slices {
                Slices::Exponential => return None,
                Slices::Even => ("slicing", EVEN.into()),
                Slices::Near(end_m) => ("first_slice_end_m", shortest(end_m)),
                Slices::Cascaded(count) => ("cascades", count.into()),
            },
            Self::Scatter => ("scatter", self.segment(options)?.into()),
            Self::Storage => ("storage", options.storage.name()?.into()),
            Self::Touched if options.is_touched => ("touched", true.into()),
            Self::Touched => return None,
            Self::Occlusion if options.leaves_out_hidden => ("occlusion", true.into()),
            Self::Exit if options.evaluates_all => ("early_exit", false.into()),
            Self::Rectangle if options.is_rectangle => ("screen_rectangle", true.into()),
            Self::Half if options.is_half => ("half_precision", true.into()),
            Self::PlainDepth if options.is_plain_depth => ("plain_depth", true.into()),
            Self::Order if options.is_unordered => ("random_order", true.into()),
            Self::Exit
            | Self::Occlusion
            | Self::Rectangle
            | Self::Half
            | Self::PlainDepth
            | Self::Order => return None,
        })
    }
}

/// The shortest decimal of a number of 32 bits: 0.001, not 0.0010000000474974513.
fn shortest(number: f32) -> Value {
    number.to_string().parse::<f64>().map_or(Value::Null, Value::from)
}

/// The number after a prefix, from 1.
fn number_after(segment: &str, prefix: &str) -> Option<u32> {
    segment.strip_prefix(prefix)?.parse().ok().filter(|number| *number > 0)
}

/// The storage that a segment names.
fn storage_of(segment: &str) -> Option<Storage> {
    Storage::NAMED.into_iter().find(|storage| storage.name() == Some(segment))
}

/// What a segment such as `nearest256` says.
fn fewer_of(segment: &str) -> Option<(Kept, u32)> {
    [Kept::First, Kept::Nearest]
        .into_iter()
        .find_map(|kept| Some((kept, number_after(segment, kept.name())?)))
}
