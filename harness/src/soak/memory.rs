//! Watches memory between rounds: what the device allocated, and what the process holds.

use assign::Gpu;

use crate::report::format::mebibytes;

/// Bytes that the device may hold more after a round than after the first ones. Everything of a round is freed, so
/// only the blocks of the allocator and the largest scratch buffers may differ.
const DEVICE_SLACK: u64 = 8 << 20;

/// Bytes by which the process may grow in a round that was drawn before.
const PROCESS_SLACK: u64 = 64 << 20;

/// Rounds before the device's memory has settled.
const SETTLING: u32 = 2;

/// Memory in use.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Memory {
    /// Bytes that the device's allocator has given out; `None` if the back end does not say.
    pub(super) device: Option<u64>,
    /// Resident bytes of the process; `None` if the system does not say.
    pub(super) process: Option<u64>,
}

impl Memory {
    /// The memory in use now.
    pub(super) fn now(gpu: &Gpu) -> Self {
        let report = gpu.device.generate_allocator_report();
        Self {
            device: report.map(|report| report.total_allocated_bytes),
            process: resident_bytes(),
        }
    }
}

/// The resident bytes of this process.
#[cfg(target_os = "linux")]
fn resident_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    let kibibytes: u64 = line.split_whitespace().next()?.parse().ok()?;
    Some(kibibytes * 1024)
}

/// Other systems say it in other ways.
#[cfg(not(target_os = "linux"))]
fn resident_bytes() -> Option<u64> {
    None
}

/// Compares the memory after rounds.
#[derive(Debug, Default)]
pub(super) struct MemoryWatch {
    rounds: u32,
    /// After the rounds in which the device's memory settles.
    settled: Option<Memory>,
    last: Memory,
    most_process: u64,
}

impl MemoryWatch {
    /// Looks at the memory before and after a round; words for a finding. `is_known` says that the round was drawn
    /// before, so that it compiles nothing.
    pub(super) fn look(&mut self, before: Memory, after: Memory, is_known: bool) -> Option<String> {
        self.rounds += 1;
        self.last = after;
        self.most_process = self.most_process.max(after.process.unwrap_or(0));
        if self.rounds >= SETTLING && self.settled.is_none() {
            self.settled = Some(after);
        }
        if let (Some(settled), Some(now)) =
            (self.settled.and_then(|memory| memory.device), after.device)
            && now > settled + DEVICE_SLACK
        {
            return Some(format!(
                "memory grows on the device: {} MiB are in use between rounds, {} MiB were after round {SETTLING}",
                mebibytes(now as f64),
                mebibytes(settled as f64)
            ));
        }
        match (before.process, after.process) {
            (Some(before), Some(after)) if is_known && after > before + PROCESS_SLACK => {
                Some(format!(
                    "memory of the process grows from {} to {} MiB in a round that was drawn before",
                    mebibytes(before as f64),
                    mebibytes(after as f64)
                ))
            }
            _ => None,
        }
    }

    /// Starts again with another device.
    pub(super) fn forget_device(&mut self) {
        (self.rounds, self.settled) = (0, None);
    }

    /// What was seen, in a line.
    pub(super) fn summary(&self) -> String {
        let device = match self.last.device {
            Some(bytes) => format!("{} MiB on the device between rounds", mebibytes(bytes as f64)),
            None => "memory of the device is unknown".to_owned(),
        };
        let process = match self.most_process {
            0 => "memory of the process is unknown".to_owned(),
            most => format!("at most {} MiB in the process", mebibytes(most as f64)),
        };
        format!("memory   {device}, {process}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn memory(device_mib: u64, process_mib: u64) -> Memory {
        Memory { device: Some(device_mib << 20), process: Some(process_mib << 20) }
    }

    #[test]
    fn growth_is_found_on_the_device_and_in_the_process() {
        let mut watch = MemoryWatch::default();
        let start = memory(10, 100);
        assert_eq!(
            watch.look(start, memory(90, 900), false),
            None,
            "the first rounds may allocate"
        );
        assert_eq!(watch.look(start, memory(20, 900), false), None);
        assert_eq!(watch.look(start, memory(27, 900), false), None);
        let found = watch.look(start, memory(29, 900), false).expect("a finding");
        assert!(
            found.contains("29.0 MiB are in use") && found.contains("20.0 MiB were"),
            "{found}"
        );
        assert_eq!(watch.look(memory(20, 900), memory(20, 950), true), None);
        let found = watch.look(memory(20, 900), memory(20, 970), true).expect("a finding");
        assert!(found.contains("from 900 to 970 MiB"), "{found}");
        assert_eq!(watch.look(Memory::default(), Memory::default(), true), None);
        watch.forget_device();
        assert_eq!(watch.look(start, memory(90, 900), false), None, "another device");
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn the_memory_of_this_process_is_known() {
        assert!(resident_bytes() > Some(1 << 20));
    }
}
