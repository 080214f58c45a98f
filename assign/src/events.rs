//! What a renderer may want in its log, with the feature `log`: overflow, growth and rejected lights.
//!
//! An event is logged when it begins, not in every frame that it lasts.

#[cfg(feature = "log")]
macro_rules! warning {
    ($($words:tt)*) => { log::warn!(target: "assign", $($words)*) };
}
/// Without the feature, the words are checked and not used.
#[cfg(not(feature = "log"))]
macro_rules! warning {
    ($($words:tt)*) => { if false { let _ = format_args!($($words)*); } };
}

use crate::{Counters, RejectedLight};

/// Lights were rejected. `before` are those of the update before.
pub(crate) fn rejected(before: &[RejectedLight], now: &[RejectedLight]) {
    if now.len() > before.len()
        && let Some(first) = now.first()
    {
        warning!("{} lights are left out; light {}: {}", now.len(), first.index, first.fault);
    }
}

/// Counters arrived. `before` are the newest ones before them.
pub(crate) fn counted(before: Option<Counters>, now: Counters) {
    if now.overflowed_groups > 0 && before.is_none_or(|before| before.overflowed_groups == 0) {
        warning!(
            "{} groups read all lights: the lists need {} entries, more than fit",
            now.overflowed_groups,
            now.requested()
        );
    }
}

/// A buffer was replaced by a larger one.
pub(crate) fn grew(what: &str, bytes: u64) {
    warning!("{what} grow to {bytes} bytes");
}
