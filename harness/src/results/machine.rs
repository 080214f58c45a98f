//! Where a run took place.

use serde::{Deserialize, Serialize};

/// Where a run took place.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Machine {
    /// The adapter's name, as the driver gives it.
    pub adapter: String,
    /// The driver's name and version.
    pub driver: String,
    /// The wgpu back end: `vulkan`, `metal`, `dx12` or `gl`.
    pub backend: String,
    /// What kind of processor the adapter is.
    pub device_type: DeviceType,
    /// The host processor's model name.
    pub cpu: String,
    /// The operating system and its version.
    pub os: String,
    /// The commit of this workspace, with `-dirty` where files had been changed; empty if unknown.
    pub commit: String,
    /// When the run began, UTC, RFC 3339: `2026-11-22T04:00:00Z`.
    pub date: String,
    /// The compiler that built the program.
    #[serde(default)]
    pub rustc: Option<String>,
}

impl Machine {
    /// The GPU's short name where it runs fragment shaders on a few of its processors, as NVIDIA's
    /// data-centre GPUs of the Hopper generation do: figures of raster passes are then not those of
    /// another chip.
    pub fn weak_raster(&self) -> Option<&str> {
        const CHIPS: [&str; 5] = ["H100", "H200", "GH200", "H800", "H20"];
        self.adapter.split_whitespace().find(|word| CHIPS.contains(word))
    }

    /// What must be the same where times are put side by side: fields and their values.
    pub fn identity(&self) -> [(&'static str, &str); 4] {
        [
            ("adapter", &self.adapter),
            ("driver", &self.driver),
            ("backend", &self.backend),
            ("commit", &self.commit),
        ]
    }
}

/// What kind of processor an adapter is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum DeviceType {
    /// A GPU with its own memory.
    DiscreteGpu,
    /// A GPU that shares the host's memory.
    IntegratedGpu,
    /// A GPU handed to a virtual machine.
    VirtualGpu,
    /// A software adapter: its figures are not a GPU's.
    Cpu,
    /// Anything else.
    Other,
}
