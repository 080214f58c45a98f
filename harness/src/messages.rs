//! Writes messages to standard error and results to standard output.
//!
//! `eprintln!` and `println!` panic when the reader has gone (`2>&1 | head -1`) or the disk behind a
//! redirection is full. A message must not end hours of measuring, so [`say`] ignores both errors.
//! Standard output holds the result, so [`print()`] reports a full disk; a closed pipe means that the reader
//! has read enough.

use std::io::{self, ErrorKind, Write};

use crate::{
    error::HarnessError,
    visible::{visible, visible_lines},
};

/// Writes one line to standard error, or nothing if it is closed or full.
pub fn say(line: impl AsRef<str>) {
    // One write per line, so that lines of several threads do not mix.
    let line = format!("{}\n", visible(line.as_ref()));
    let _ = io::stderr().lock().write_all(line.as_bytes());
}

/// Writes the error that ended the run as one line, even if text from a file is part of it.
pub fn say_error(error: impl std::fmt::Display) {
    say(format!("lightbench: {error}"));
}

/// Prints text on standard output.
///
/// # Errors
///
/// [`HarnessError::Output`] if the text cannot be written, unless the pipe is closed.
pub fn print(text: &str) -> Result<(), HarnessError> {
    write_whole(&mut io::stdout().lock(), &visible_lines(text))
}

fn write_whole(output: &mut impl Write, text: &str) -> Result<(), HarnessError> {
    match output.write_all(text.as_bytes()).and_then(|()| output.flush()) {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        other => other.map_err(HarnessError::Output),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Refuses(ErrorKind);

    impl Write for Refuses {
        fn write(&mut self, _: &[u8]) -> io::Result<usize> {
            Err(self.0.into())
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn print_ignores_a_closed_pipe_and_reports_a_full_disk() {
        assert!(write_whole(&mut Refuses(ErrorKind::BrokenPipe), "text").is_ok());
        let error = write_whole(&mut Refuses(ErrorKind::StorageFull), "text")
            .expect_err("the disk is full");
        assert_eq!(error.exit_code(), 1);
        assert!(error.to_string().starts_with("cannot write to standard output: "), "{error}");
    }
}
