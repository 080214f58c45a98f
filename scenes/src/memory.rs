//! How much memory the machine has for this process.

/// The memory assumed where the system does not tell it, bytes.
const ASSUMED: u64 = 8 << 30;

/// The bytes of memory that this process may use: the smallest of the machine's memory, the limit
/// of its control group, and the limit on its address space.
pub(crate) fn machine_bytes() -> u64 {
    let read = |path: &str| std::fs::read_to_string(path).ok();
    let total = read("/proc/meminfo").and_then(|text| number_after(&text, "MemTotal:"));
    let group = ["/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"]
        .iter()
        .find_map(|path| read(path)?.trim().parse().ok());
    let limits = read("/proc/self/limits");
    let space = limits.and_then(|text| number_after(&text, "Max address space"));
    let known = [total.map(|kib| kib.saturating_mul(1024)), group, space];
    known.into_iter().flatten().min().unwrap_or(ASSUMED)
}

/// The first number of the line that starts with `label`; `None` if it is "unlimited".
fn number_after(text: &str, label: &str) -> Option<u64> {
    let rest = text.lines().find_map(|line| line.strip_prefix(label))?;
    rest.split_whitespace().next()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_from_the_systems_tables() {
        let table = "Max cpu time   unlimited   unlimited\nMax address space   4096   unlimited\n";
        assert_eq!(number_after(table, "Max address space"), Some(4096));
        assert_eq!(number_after(table, "Max cpu time"), None);
        assert_eq!(number_after(table, "MemTotal:"), None);
        assert!(machine_bytes() > 1 << 26, "{}", machine_bytes());
    }
}
