//! Reads the linear images that earlier runs stored beside their results.

use std::collections::HashMap;
use std::path::Path;
use std::rc::Rc;

use shading::HdrImage;

use crate::{error::HarnessError, results::ResultsError};

/// Linear images of a folder, each read once.
pub struct Store<'a> {
    folder: &'a Path,
    images: HashMap<String, Option<Rc<HdrImage>>>,
}

impl<'a> Store<'a> {
    /// The images of a folder, none read yet.
    pub fn new(folder: &'a Path) -> Self {
        Self { folder, images: HashMap::new() }
    }

    /// The image with this name; `None` without a name or a file.
    ///
    /// # Errors
    ///
    /// The file is not an image.
    pub fn image(&mut self, name: Option<&str>) -> Result<Option<Rc<HdrImage>>, HarnessError> {
        let Some(name) = name.filter(|name| is_plain(name)) else { return Ok(None) };
        if let Some(known) = self.images.get(name) {
            return Ok(known.clone());
        }
        let path = self.folder.join(name);
        let image = match path.is_file() {
            true => Some(Rc::new(HdrImage::read_exr(&path)?)),
            false => None,
        };
        self.images.insert(name.to_owned(), image.clone());
        Ok(image)
    }

    /// The image with this name. It must have the size of `like`, which errors call `other`.
    ///
    /// # Errors
    ///
    /// The sizes differ; the error names the file and both sizes.
    pub fn image_like(
        &mut self,
        name: Option<&str>,
        like: &HdrImage,
        other: &str,
    ) -> Result<Option<Rc<HdrImage>>, HarnessError> {
        let Some(image) = self.image(name)? else { return Ok(None) };
        if (image.width, image.height) == (like.width, like.height) {
            return Ok(Some(image));
        }
        let path = self.folder.join(name.unwrap_or_default());
        let reason = format!(
            "{}x{} pixels: it must be as large as {other}, {}x{}",
            image.width, image.height, like.width, like.height
        );
        Err(ResultsError::Parse { path, reason }.into())
    }
}

/// Whether a name is a plain file name. Results may come from anywhere, so it must not lead to another folder.
pub fn is_plain(name: &str) -> bool {
    Path::new(name).file_name().is_some_and(|file| file == name)
}

#[cfg(test)]
mod tests {
    use super::is_plain;

    #[test]
    fn names_that_lead_to_other_folders_are_not_read() {
        assert!(is_plain("deferred-None.exr"));
        for name in ["../x.exr", "/etc/passwd", "a/b.png", "", ".."] {
            assert!(!is_plain(name), "{name}");
        }
    }
}
