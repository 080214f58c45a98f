//! Reads the files that a scene's file names: only regular files, and only as many bytes as are
//! needed.

use std::{
    fs,
    io::{Error, Read},
    path::{Component, Path, PathBuf},
};

/// The bytes of a part, and its place if that is outside the scene's folder.
pub(super) struct Part {
    pub(super) bytes: Vec<u8>,
    pub(super) outside: Option<PathBuf>,
}

/// Reads at most `most` bytes of the file `name` beside the scene.
pub(super) fn read_part(folder: &Path, name: &Path, most: u64) -> Result<Part, Error> {
    let path = folder.join(name);
    let bytes = read_regular(&path, most)?;
    let folder = if folder == Path::new("") { Path::new(".") } else { folder };
    let (inside, real) = (folder.canonicalize()?, path.canonicalize()?);
    Ok(Part { bytes, outside: (!real.starts_with(inside)).then_some(real) })
}

/// Whether a name is absolute on any system: `/etc/x`, `\\server\x`, `C:\x`, `C:x`.
pub(super) fn is_absolute(name: &Path) -> bool {
    let text = name.to_string_lossy();
    let drive = text.len() >= 2 && text.as_bytes()[0].is_ascii_alphabetic();
    let has_root =
        matches!(name.components().next(), Some(Component::Prefix(_) | Component::RootDir));
    has_root || text.starts_with('\\') || drive && text.as_bytes()[1] == b':'
}

/// At most `most` bytes of a regular file. Devices and pipes may have no end, and opening a pipe
/// may wait forever. So the type is checked before the file is opened.
pub(super) fn read_regular(path: &Path, most: u64) -> Result<Vec<u8>, Error> {
    let about = fs::metadata(path)?;
    if !about.is_file() {
        return Err(Error::other("it is not a regular file"));
    }
    let most = most.min(about.len());
    let mut bytes = Vec::new();
    let wanted = usize::try_from(most).map_err(Error::other)?;
    bytes.try_reserve_exact(wanted).map_err(Error::other)?;
    fs::File::open(path)?.take(most).read_to_end(&mut bytes)?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn absolute_names_of_every_system_are_recognised() {
        for name in ["/etc/passwd", "\\\\server\\x", "\\x", "C:\\x.bin", "c:x.bin"] {
            assert!(is_absolute(Path::new(name)), "{name}");
        }
        for name in ["x.bin", "a/../x.bin", "../x.bin", "ä:x", "", "."] {
            assert!(!is_absolute(Path::new(name)), "{name}");
        }
    }

    #[test]
    fn only_regular_files_are_read_and_only_as_many_bytes_as_asked() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        fs::write(folder.path().join("x.bin"), [7; 100]).expect("writes");
        let part = read_part(folder.path(), Path::new("x.bin"), 10).expect("there");
        assert_eq!((part.bytes, part.outside), (vec![7; 10], None));
        assert!(read_part(folder.path(), Path::new("."), 10).is_err());
        if cfg!(unix) {
            let error = read_regular(Path::new("/dev/zero"), 10).expect_err("a device");
            assert_eq!(error.to_string(), "it is not a regular file");
        }
    }
}
