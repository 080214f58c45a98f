//! Panels of which one is shown, and the buttons that choose.

use super::markup::{Html, html};

/// A panel with its button.
pub(crate) struct Panel {
    /// What the button says.
    pub(crate) name: String,
    /// The class of the dot on the button; empty draws none.
    pub(crate) class: String,
    pub(crate) body: Html,
}

/// Panels under a heading, the first of them shown. A single panel needs no button.
pub(crate) fn panels(label: &str, heading: &Html, panels: &[Panel]) -> Html {
    let (mut buttons, mut bodies) = (Html::default(), Html::default());
    for (ix, panel) in panels.iter().enumerate() {
        let is_first = ix == 0;
        let dot = match panel.class.is_empty() {
            true => Html::default(),
            false => html!("<i class=\"dot {}\"></i>", panel.class),
        };
        buttons += html!(
            "<button type=\"button\" data-choose=\"{}\" aria-pressed=\"{}\">{}{}</button>",
            ix,
            is_first,
            dot,
            panel.name
        );
        let hidden = if is_first { "" } else { " hidden" };
        bodies += html!("<div data-panel=\"{}\"{}>\n{}</div>\n", ix, hidden, panel.body);
    }
    if panels.len() == 1 {
        buttons = Html::default();
    } else {
        buttons = html!(
            "<div class=\"choice\" role=\"group\" aria-label=\"{}\">{}</div>",
            label,
            buttons
        );
    }
    html!(
        "<div class=\"panels\"><div class=\"figcaption\">{}{}</div>\n{}</div>\n",
        heading,
        buttons,
        bodies
    )
}
