//! Says how to go on where a run is interrupted (Ctrl-C, or a request to end).

use std::sync::{Mutex, PoisonError};

/// What is said.
static WORDS: Mutex<Option<String>> = Mutex::new(None);

/// Sets what is said where the run is interrupted from here on.
pub fn when_interrupted(words: String) {
    *WORDS.lock().unwrap_or_else(PoisonError::into_inner) = Some(words);
}

/// Watches for signals that end the program. It still ends by the signal, so that a shell sees why, but
/// first it says how to go on and leaves the folder that it held.
#[cfg(unix)]
pub fn watch() {
    use signal_hook::consts::{SIGINT, SIGTERM};

    // Without a watcher the signal ends the program as it always did.
    let Ok(mut signals) = signal_hook::iterator::Signals::new([SIGINT, SIGTERM]) else { return };
    std::thread::spawn(move || {
        for signal in signals.forever() {
            let words = WORDS.lock().unwrap_or_else(PoisonError::into_inner).take();
            crate::messages::say(format!(
                "lightbench: interrupted{}",
                words.map_or_else(String::new, |words| format!(": {words}"))
            ));
            crate::out_folder::leave_all();
            let _ = signal_hook::low_level::emulate_default_handler(signal);
        }
    });
}

/// Where there are no such signals nothing is watched.
#[cfg(not(unix))]
pub fn watch() {}
