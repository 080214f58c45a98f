//! Parts of a scene's section, as data: the frame of the page lays them out and links to them.

use crate::report::markup::{Html, html};

/// A part of a scene's section.
pub(crate) struct Part {
    /// What links call it: unique among the parts of a scene.
    pub(crate) id: &'static str,
    /// Its heading.
    pub(crate) title: String,
    /// How to read it.
    pub(crate) note: String,
    /// Its charts and tables; a part without any is not shown.
    pub(crate) body: Html,
}

impl Part {
    pub(crate) fn new(
        id: &'static str,
        title: impl Into<String>,
        note: impl Into<String>,
        body: Html,
    ) -> Self {
        Self { id, title: title.into(), note: note.into(), body }
    }

    /// The link to it from the top of its scene's section.
    pub(crate) fn link(&self, scene: &str) -> Html {
        html!("<a href=\"#{0}-{1}\">{2}</a>", scene, self.id, self.title)
    }

    /// The part itself.
    pub(crate) fn html(&self, scene: &str) -> Html {
        html!(
            "<div class=\"part\" id=\"{0}-{1}\" data-part=\"{1}\"><h3>{2}</h3>\n<p class=\"note\">{3}</p>\n\
             {4}</div>\n",
            scene,
            self.id,
            self.title,
            self.note,
            self.body
        )
    }
}
