//! A row of the list of scenarios.

use super::{
    kit::Kit,
    moves::{self, Move},
};
use crate::{Scene, SceneError};

/// What the ids of all scenarios start with.
pub const PREFIX: &str = "stability:";

/// A scene in which some ways of assigning lights fail.
#[derive(Clone, Copy, Debug)]
pub struct Scenario {
    /// Its number in the list of 34 situations; `None` for those that reports add.
    pub number: Option<u32>,
    /// Its name, in kebab case. The scene's id is `stability:NAME`.
    pub name: &'static str,
    /// What it has in common with its neighbours.
    pub group: Group,
    /// What breaks here, in one sentence.
    pub breaks: &'static str,
    /// The figure that says more than "exact".
    pub figure: Figure,
    /// How time runs here. Without moves, one still frame says all.
    pub moves: &'static [Move],
    /// Options of the program without which the situation is not drawn, such as `--fog`.
    pub options: &'static [&'static str],
    /// Whether it takes too long for quick runs on a software adapter.
    pub heavy: bool,
    pub(super) make: fn(&mut Kit),
}

/// What scenarios have in common.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Group {
    /// The shape of tiles, slices and cells against that of lights.
    Geometry,
    /// Odd lights, and odd numbers of them.
    LightData,
    /// Spots, rectangles and transforms.
    Shapes,
    /// Projections, viewports and coordinates.
    Views,
    /// Moving cameras and lights.
    Time,
    /// Polished and bumpy surfaces.
    Gloss,
    /// Virtual point lights, and walls between rooms.
    Indirect,
    /// What engine users report.
    Reported,
}

impl Group {
    /// Every group, in the order of the list.
    pub const LIST: [Self; 8] = [
        Self::Geometry,
        Self::LightData,
        Self::Shapes,
        Self::Views,
        Self::Time,
        Self::Gloss,
        Self::Indirect,
        Self::Reported,
    ];

    /// Its name, as lists show it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Geometry => "geometry of groups",
            Self::LightData => "light data",
            Self::Shapes => "shapes",
            Self::Views => "views",
            Self::Time => "time",
            Self::Gloss => "gloss",
            Self::Indirect => "indirect light",
            Self::Reported => "reported",
        }
    }

    /// The row of one of its scenarios, which is drawn still. Others change some fields.
    pub(super) const fn row(
        self,
        number: u32,
        name: &'static str,
        breaks: &'static str,
        make: fn(&mut Kit),
    ) -> Scenario {
        Scenario {
            number: Some(number),
            name,
            group: self,
            breaks,
            figure: Figure::None,
            moves: &[],
            options: &[],
            heavy: false,
            make,
        }
    }
}

/// The figure that says more about a method than whether it is exact.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Figure {
    /// Exactness says all.
    None,
    /// Lights in lists that reach no sample of their group.
    FalsePositives,
    /// Listed lights per light that reaches the sample.
    ListedOverContributing,
    /// The change of the error from frame to frame.
    TemporalError,
    /// The spread of frame times.
    FrameTime,
}

impl Figure {
    /// Its name, as pages show it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::FalsePositives => "false positives",
            Self::ListedOverContributing => "listed / contributing",
            Self::TemporalError => "temporal error",
            Self::FrameTime => "frame time",
        }
    }
}

impl Scenario {
    /// The id of its scene, for [`open`](crate::open).
    pub fn id(&self) -> String {
        format!("{PREFIX}{}", self.name)
    }

    /// The id of its scene with the path of one of its moves. Moves of lights leave the path as it is.
    pub fn id_with(&self, way: Move) -> String {
        match way {
            Move::Lights(_) => self.id(),
            Move::Dolly | Move::Rotation | Move::Teleport => {
                format!("{}:{}", self.id(), way.name())
            }
        }
    }

    /// The moves of the camera, without those of lights.
    pub fn camera_moves(&self) -> impl Iterator<Item = Move> + use<> {
        self.moves.iter().copied().filter(|way| !matches!(way, Move::Lights(_)))
    }

    /// Opens the scene with the path of the move of that name, or of the camera's first one.
    pub(super) fn open(&self, way: Option<&str>, seed: u64) -> Result<Scene, SceneError> {
        let Some(wanted) = way else {
            return Ok(self.scene(seed, self.camera_moves().next()));
        };
        match self.camera_moves().find(|way| way.name() == wanted) {
            Some(way) => Ok(self.scene(seed, Some(way))),
            None => Err(SceneError::Move {
                id: self.id(),
                asked: wanted.to_owned(),
                accepted: moves::accepted(self.camera_moves()),
            }),
        }
    }

    /// Makes the scene from a seed, with the path of a move of the camera.
    fn scene(&self, seed: u64, way: Option<Move>) -> Scene {
        let mut kit = Kit::new(seed);
        (self.make)(&mut kit);
        kit.scene(self.id(), way)
    }
}
