//! Where a run takes place, for its provenance.

use std::time::SystemTime;

use assign::Gpu;

use crate::results::{DeviceType, Machine};

/// What is known of the adapter, the host and the program.
pub fn machine(gpu: &Gpu) -> Machine {
    let info = &gpu.info;
    Machine {
        adapter: info.name.clone(),
        driver: [info.driver.as_str(), info.driver_info.as_str()].join(" ").trim().to_owned(),
        backend: info.backend.to_string(),
        device_type: match info.device_type {
            wgpu::DeviceType::DiscreteGpu => DeviceType::DiscreteGpu,
            wgpu::DeviceType::IntegratedGpu => DeviceType::IntegratedGpu,
            wgpu::DeviceType::VirtualGpu => DeviceType::VirtualGpu,
            wgpu::DeviceType::Cpu => DeviceType::Cpu,
            wgpu::DeviceType::Other => DeviceType::Other,
        },
        cpu: cpu_name(),
        os: format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
        commit: env!("LIGHTBENCH_COMMIT").to_owned(),
        date: humantime::format_rfc3339_seconds(SystemTime::now()).to_string(),
        rustc: Some(env!("LIGHTBENCH_RUSTC").to_owned()),
    }
}

/// The host processor's model, as Linux names it.
fn cpu_name() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    text.lines()
        .find_map(|line| line.strip_prefix("model name")?.split_once(':'))
        .map_or_else(|| "unknown".to_owned(), |(_, name)| name.trim().to_owned())
}
