//! The machine of a run.

use serde::{Deserialize, Serialize};

/// The machine and the program of a run.
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
    /// The commit of this workspace, with `-dirty` after it if files were changed; empty if unknown.
    pub commit: String,
    /// When the run began, UTC, RFC 3339: `2026-11-22T04:00:00Z`.
    pub date: String,
    /// The compiler that built the program.
    #[serde(default)]
    pub rustc: Option<String>,
}

impl Machine {
    /// The GPU's short name if it runs fragment shaders on only a few of its processors, as NVIDIA's
    /// data-centre GPUs of the Hopper generation do. Times of raster passes are then not valid for other GPUs.
    pub fn weak_raster(&self) -> Option<&str> {
        const CHIPS: [&str; 5] = ["H100", "H200", "GH200", "H800", "H20"];
        self.adapter.split_whitespace().find(|word| CHIPS.contains(word))
    }

    /// The fields, with their values, that must agree before times are compared.
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
    /// A software adapter; its times are not those of a GPU.
    Cpu,
    /// Anything else.
    Other,
}
