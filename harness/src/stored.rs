//! Linear images that earlier runs stored beside their results.

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
    /// Those of a folder, none read yet.
    pub fn new(folder: &'a Path) -> Self {
        Self { folder, images: HashMap::new() }
    }

    /// The image of a name; `None` where none is named or there.
    ///
    /// # Errors
    ///
    /// Where a file is no image.
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

    /// The image of a name, which must be as large as another, of the name `other`.
    ///
    /// # Errors
    ///
    /// Names the file and both sizes where they differ.
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

/// Whether a name is that of a file in the folder itself: results may come from anywhere.
pub fn is_plain(name: &str) -> bool {
    Path::new(name).file_name().is_some_and(|file| file == name)
}

#[cfg(test)]
mod tests {
    use super::is_plain;

    #[test]
    fn names_that_lead_elsewhere_are_not_read() {
        assert!(is_plain("deferred-None.exr"));
        for name in ["../x.exr", "/etc/passwd", "a/b.png", "", ".."] {
            assert!(!is_plain(name), "{name}");
        }
    }
}
