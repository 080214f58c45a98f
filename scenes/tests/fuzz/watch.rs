//! Measures time and memory of one input.

use std::{any::Any, fs, sync::mpsc, thread, time::Duration};

/// Runs `work` in its own thread. Returns an error if it panics or takes longer.
pub(crate) fn within<T: Send + 'static>(
    most: Duration,
    work: impl FnOnce() -> T + Send + 'static,
) -> Result<T, String> {
    let (send, receive) = mpsc::channel();
    let thread = thread::spawn(move || {
        // After a time-out, nobody receives the result.
        let _ = send.send(work());
    });
    match receive.recv_timeout(most) {
        Ok(result) => Ok(result),
        Err(mpsc::RecvTimeoutError::Timeout) => Err(format!("takes more than {most:?}")),
        Err(mpsc::RecvTimeoutError::Disconnected) => {
            let fault = thread.join().err().map(words).unwrap_or_default();
            Err(format!("panics: {fault}"))
        }
    }
}

fn words(fault: Box<dyn Any + Send>) -> String {
    let text = fault.downcast_ref::<String>().cloned();
    text.or_else(|| fault.downcast_ref::<&str>().map(|&s| s.to_owned())).unwrap_or_default()
}

/// Resets the peak, if the system supports it.
pub(crate) fn forget_peak() {
    // Linux: "5" resets the peak of resident memory (proc(5)).
    let _ = fs::write("/proc/self/clear_refs", "5");
}

/// The most memory that the process has used since, bytes; 0 if the system does not tell it.
pub(crate) fn peak_bytes() -> u64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kib: Option<u64> = line.and_then(|rest| rest.split_whitespace().next()?.parse().ok());
    kib.unwrap_or(0) * 1024
}
