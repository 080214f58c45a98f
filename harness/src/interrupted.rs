//! Prints how to continue when a run is interrupted (Ctrl-C or SIGTERM).

use std::sync::{Mutex, PoisonError};

/// The message to print.
static WORDS: Mutex<Option<String>> = Mutex::new(None);

/// Sets the message for interruptions from now on.
pub fn when_interrupted(words: String) {
    *WORDS.lock().unwrap_or_else(PoisonError::into_inner) = Some(words);
}

/// Watches for signals that end the program. On a signal, it prints how to continue and releases the
/// output folder. Then the signal ends the program as usual, so that the shell sees the reason.
#[cfg(unix)]
pub fn watch() {
    use signal_hook::consts::{SIGINT, SIGTERM};

    // Without the watcher, a signal ends the program as usual.
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

/// Systems without these signals need no watcher.
#[cfg(not(unix))]
pub fn watch() {}
