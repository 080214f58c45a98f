//! What the program tells a person: lines on standard error, and its product on standard output.
//!
//! `eprintln!` and `println!` panic where the reader has gone (`2>&1 | head -1`) or the disk behind a
//! redirection is full. A line for a person must not end hours of measuring, so [`say`] ignores both.
//! Standard output is the product, so [`print()`] reports a full disk, and takes a closed pipe for a reader
//! that has read enough.

use std::io::{self, ErrorKind, Write};

use crate::{
    error::HarnessError,
    visible::{visible, visible_lines},
};

/// Says one line on standard error, or nothing where that is closed or full.
pub fn say(line: impl AsRef<str>) {
    // One write per line: lines of several threads do not mix.
    let line = format!("{}\n", visible(line.as_ref()));
    let _ = io::stderr().lock().write_all(line.as_bytes());
}

/// Says what ended the run: one line, whatever a file's text put into the message.
pub fn say_error(error: impl std::fmt::Display) {
    say(format!("lightbench: {error}"));
}

/// Prints text on standard output.
///
/// # Errors
///
/// [`HarnessError::Output`] where standard output refuses the text for any reason but a closed pipe.
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
    fn a_closed_pipe_is_enough_and_a_full_disk_is_an_error() {
        assert!(write_whole(&mut Refuses(ErrorKind::BrokenPipe), "text").is_ok());
        let error = write_whole(&mut Refuses(ErrorKind::StorageFull), "text").expect_err("full");
        assert_eq!(error.exit_code(), 1);
        assert!(error.to_string().starts_with("standard output: "), "{error}");
    }
}
