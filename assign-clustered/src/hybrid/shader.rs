//! The shaders of HG.

use assign::{
    AssignError, Gpu, LightKinds, LightReader, LiveGroups, Shader, Storage, StrategyWesl,
};

use crate::cluster_wesl::FROXELS;

/// Bind group of the cells and of the lists.
pub(super) const LISTS_GROUP: u32 = 1;

/// The WESL of the cells: `group_of`.
pub const HYBRID_WESL: StrategyWesl<'static> = StrategyWesl {
    main: include_str!("../shaders/hybrid_cells.wesl"),
    imports: &[FROXELS],
    flags: &[],
    reader: LightReader::Stored(Storage::Lists),
};

/// A shader of HG. Those that read lights are linked for the kinds of lights in a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HybridShader {
    /// Finds the cells that hold samples.
    Occupancy {
        /// Whether the depth buffer has several samples per pixel.
        multisampled: bool,
    },
    /// Adds lights to cells by compute lanes: first counts, then places.
    Scatter,
    /// The same by the rasteriser.
    Raster,
    /// Clears the cells, and reserves the places of lists.
    Reserve,
    /// Sorts the lists.
    Sort,
}

impl HybridShader {
    /// All of them.
    pub const ALL: [Self; 6] = [
        Self::Occupancy { multisampled: false },
        Self::Occupancy { multisampled: true },
        Self::Scatter,
        Self::Raster,
        Self::Reserve,
        Self::Sort,
    ];

    /// Its linked WGSL, for tests of layout and validity.
    pub fn source(self, kinds: LightKinds) -> Result<String, AssignError> {
        self.shader(kinds).link(self.root())
    }

    fn root(self) -> &'static str {
        match self {
            Self::Occupancy { .. } => "package::hybrid_occupancy",
            Self::Scatter => "package::hybrid_scatter",
            Self::Raster => "package::hybrid_raster",
            Self::Reserve => "package::hybrid_reserve",
            Self::Sort => "package::hybrid_sort",
        }
    }

    fn shader(self, kinds: LightKinds) -> Shader<'static> {
        let shader = Shader::new(LISTS_GROUP)
            .strategy(HYBRID_WESL)
            .module("package::hybrid_parts", include_str!("../shaders/hybrid_parts.wesl"))
            .light_kinds(kinds);
        match self {
            Self::Occupancy { multisampled } => shader
                .module(self.root(), include_str!("../shaders/hybrid_occupancy.wesl"))
                .flag("multisampled", multisampled),
            Self::Scatter | Self::Raster => {
                let root = match self {
                    Self::Raster => include_str!("../shaders/hybrid_raster.wesl"),
                    _ => include_str!("../shaders/hybrid_scatter.wesl"),
                };
                let outline = include_str!("../shaders/hybrid_outline.wesl");
                shader
                    .module(self.root(), root)
                    .module("package::hybrid_add", include_str!("../shaders/hybrid_add.wesl"))
                    .module("package::hybrid_outline", outline)
            }
            Self::Reserve => shader
                .module(self.root(), include_str!("../shaders/hybrid_reserve.wesl"))
                .module("package::live", LiveGroups::WESL)
                // Each lane reserves one list.
                .flag("lanes_reserve", true),
            Self::Sort => shader.module(self.root(), include_str!("../shaders/hybrid_sort.wesl")),
        }
    }

    pub(super) fn create(
        self,
        gpu: &Gpu,
        kinds: LightKinds,
    ) -> Result<wgpu::ShaderModule, AssignError> {
        // SAFETY: most loops count up, without wrapping, to a constant, to the length of a buffer, or to a
        // number of lights, tiles, slices or entries that is no greater than the length of a buffer. Others
        // clear one bit of a word per round. The loop that moves the cursor ends once the cursor, which only
        // grows, leaves no room, or once no other lane moved it between the read and the exchange.
        #[allow(unsafe_code, reason = "its loops end")]
        unsafe {
            self.shader(kinds).create_uncounted(gpu, self.root())
        }
    }
}
