//! An image beside the one it should be, with their difference: the viewer of pictures.
//!
//! The page stores each picture once. An `<img>` names it in `data-picture`, and the page's script gives it
//! its source.

use super::format::{difference, factor, number};
use super::markup::{Html, html};
use crate::results::Record;

/// What a viewer shows. Pictures are names that the page knows; `None` where none was kept.
pub(crate) struct PicturePair<'a> {
    pub(crate) scene: &'a str,
    /// The strategy, or the model, that drew the image.
    pub(crate) name: &'a str,
    /// Width and height, pixels.
    pub(crate) size: [u32; 2],
    pub(crate) image: Option<&'a str>,
    pub(crate) reference: Option<&'a str>,
    /// What the reference is: `no culling`.
    pub(crate) reference_name: &'a str,
    pub(crate) difference: Option<&'a str>,
    /// By how much the picture of the difference is brightened.
    pub(crate) gain: Option<f64>,
    /// What is known of the difference, in words.
    pub(crate) verdict: String,
    /// The command line that explains a pixel, up to `--pixel`; `None` where there is none.
    pub(crate) explain: Option<String>,
}

impl PicturePair<'_> {
    /// The image and its reference, with a line between them that the reader drags; the image alone where
    /// there is no reference.
    pub(crate) fn main(&self) -> Html {
        let (Some(image), Some(reference)) = (self.image, self.reference) else {
            let caption = html!("Drawn with <b>{}</b>.", self.name);
            return self.still(&caption);
        };
        html!(
            "<figure class=\"main\"><div class=\"compare\" style=\"aspect-ratio:{0}/{1};--at:50%\"{7}>\
             <img data-picture=\"{2}\" alt=\"{3}: {4}\" draggable=\"false\">\
             <img data-picture=\"{5}\" alt=\"{3} with {6}\" draggable=\"false\" class=\"over\">\
             <span class=\"tag left\">{4}</span><span class=\"tag right\">{6}</span><span class=\"line\"></span>\
             <input type=\"range\" min=\"0\" max=\"100\" step=\"0.5\" value=\"50\" \
             oninput=\"this.parentNode.style.setProperty('--at', this.value + '%')\" \
             aria-label=\"Share of the picture that shows {4}; the rest shows {6}\"></div>\
             <figcaption>Drag the line, or use the arrow keys: {4} on its left, <b>{6}</b> on its right.\
             </figcaption>{8}</figure>\n",
            self.size[0],
            self.size[1],
            reference,
            self.scene,
            self.reference_name,
            image,
            self.name,
            self.explainable(),
            self.pixel_line()
        )
    }

    /// The attributes of a picture whose pixels can be explained: the page's script reads them.
    pub(crate) fn explainable(&self) -> Html {
        let [width, height] = self.size;
        let attributes = |command: &String| {
            html!(" data-explain=\"{}\" data-size=\"{}x{}\"", command, width, height)
        };
        self.explain.as_ref().map(attributes).unwrap_or_default()
    }

    /// Where the script shows the command for the pixel under the pointer.
    fn pixel_line(&self) -> Html {
        let line = "<p class=\"pixel\" aria-live=\"off\">Point at a pixel of a picture: the command that explains it \
                    appears here.</p>";
        self.explain.as_ref().map(|_| Html::trusted(line)).unwrap_or_default()
    }

    /// The image alone.
    pub(crate) fn still(&self, caption: &Html) -> Html {
        let alternative = format!("{} with {}", self.scene, self.name);
        html!(
            "<figure class=\"main\"><div class=\"compare\" style=\"aspect-ratio:{}/{}\"{}>{}</div>\
             <figcaption>{}</figcaption>{}</figure>\n",
            self.size[0],
            self.size[1],
            self.explainable(),
            picture(self.image, &alternative),
            caption,
            self.pixel_line()
        )
    }

    /// The picture of the difference with what is known of it; words alone where the images are the same.
    pub(crate) fn difference(&self, is_same: bool) -> Html {
        if self.difference.is_none() && is_same {
            return html!(
                "<figure class=\"difference\"><figcaption><b>Difference.</b> {}</figcaption></figure>\n",
                self.verdict
            );
        }
        let gain = self.gain.filter(|gain| gain.is_finite() && *gain != 1.0);
        let times = gain.map_or_else(String::new, |gain| format!(" \u{d7}\u{a0}{}", factor(gain)));
        let black = if self.difference.is_some() { "Black is no difference. " } else { "" };
        let alternative =
            format!("Difference of {} to {}: {}", self.name, self.reference_name, self.verdict);
        html!(
            "<figure class=\"difference\"><div style=\"aspect-ratio:{}/{}\"{}>{}</div>\
             <figcaption><b>Difference{}.</b> {}{}</figcaption></figure>\n",
            self.size[0],
            self.size[1],
            self.explainable(),
            picture(self.difference, &alternative),
            times,
            black,
            self.verdict
        )
    }
}

/// A picture that the page knows, or words that none was kept.
pub(crate) fn picture(name: Option<&str>, alternative: &str) -> Html {
    name.map_or_else(
        || html!("<div class=\"missing\">No picture was kept</div>"),
        |name| html!("<img data-picture=\"{}\" alt=\"{}\" draggable=\"false\">", name, alternative),
    )
}

/// What is known of the difference of a record's image to that of no culling.
pub(crate) fn verdict(record: &Record) -> String {
    let channels = number(f64::from(record.setting.width) * f64::from(record.setting.height) * 3.0);
    let most = record.image.max_abs_diff.filter(|most| most.is_finite());
    match (record.image.differing_channels, most) {
        (Some(0), _) => format!("The same in every bit: none of {channels} channels differs."),
        (Some(differing), most) => {
            let most = most.map_or_else(
                || "by an amount that is not finite".to_owned(),
                |most| format!("by at most {}", difference(most)),
            );
            let differing = number(differing as f64);
            format!("{differing} of {channels} channels differ, {most} (linear).")
        }
        (None, Some(most)) => format!("Differs by at most {} (linear).", difference(most)),
        (None, None) => "Not compared with no culling.".to_owned(),
    }
}
