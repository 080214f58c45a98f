//! The machine and the program of a run, as the results record them.

use std::time::SystemTime;

use assign::Gpu;

use crate::{
    results::{DeviceType, Machine},
    visible::visible,
};

/// Describes the adapter, the host and the program.
pub fn machine(gpu: &Gpu) -> Machine {
    let info = &gpu.info;
    Machine {
        adapter: visible(&info.name).into_owned(),
        driver: visible([info.driver.as_str(), info.driver_info.as_str()].join(" ").trim())
            .into_owned(),
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
        date: now(),
        rustc: Some(env!("LIGHTBENCH_RUSTC").to_owned()),
    }
}

/// The current date and time, UTC.
pub(crate) fn now() -> String {
    humantime::format_rfc3339_seconds(SystemTime::now()).to_string()
}

/// The host's name, from Linux or from the environment.
pub(crate) fn host_name() -> String {
    let known = std::fs::read_to_string("/proc/sys/kernel/hostname").ok();
    let known = known.or_else(|| std::env::var("COMPUTERNAME").ok());
    let known = known.or_else(|| std::env::var("HOSTNAME").ok()).unwrap_or_default();
    if known.trim().is_empty() { "an unnamed host".to_owned() } else { known.trim().to_owned() }
}

/// The host processor's model, as Linux names it.
fn cpu_name() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    text.lines()
        .find_map(|line| line.strip_prefix("model name")?.split_once(':'))
        .map_or_else(|| "unknown".to_owned(), |(_, name)| name.trim().to_owned())
}
