//! Pictures of a job's linear images, with captions.

use std::rc::Rc;

use shading::HdrImage;

use crate::report::markup::{Html, html};
use crate::stored::Store;
use crate::study::manifest::Done;

/// A linear image of a job.
pub(crate) fn linear(done: &Done, job: &str, name: Option<&str>) -> Option<Rc<HdrImage>> {
    Store::new(done.folders.get(job)?).image(name).ok().flatten()
}

/// A picture with its caption; nothing without a picture.
pub(crate) fn figure(key: Option<String>, title: &str, text: &str) -> Html {
    let Some(key) = key else { return Html::default() };
    let separator = if text.is_empty() { "." } else { ": " };
    html!(
        "<figure><img data-picture=\"{0}\" alt=\"{1}\"><figcaption><b>{1}</b>{2}{3}</figcaption></figure>\n",
        key,
        title,
        separator,
        text
    )
}
