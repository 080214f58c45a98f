//! HTML as a type of its own.
//!
//! Results may come from anywhere, and so may every name in them. There are three ways to make [`Html`]:
//!
//! - from text, which is escaped;
//! - by [`html!`], whose template is written in this program; values are escaped unless they are [`Html`];
//! - from what this program draws or embeds ([`trusted`](Html::trusted)).
//!
//! Tables and pages take nothing else, so a forgotten escape does not compile.

use std::fmt::{self, Display, Write};
use std::ops::{Add, AddAssign};

use crate::visible::visible_lines;

/// Markup that is safe to hand to a browser.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Html(String);

impl Html {
    /// Text, between tags or in a quoted attribute.
    pub(crate) fn text(text: &str) -> Self {
        Self(Escaped(text).to_string())
    }

    /// Markup that this program draws or embeds: never text of a file.
    pub(crate) fn trusted(markup: impl Into<String>) -> Self {
        Self(markup.into())
    }

    /// A filled template; for [`html!`].
    pub(crate) fn filled(template: fmt::Arguments<'_>) -> Self {
        Self(template.to_string())
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    pub(crate) fn as_str(&self) -> &str {
        &self.0
    }
}

/// HTML from a template: `html!("<b>{}</b>", name)`. Values are escaped unless they are HTML. A template takes
/// values by position only, so no value gets in unescaped.
macro_rules! html {
    ($template:literal $(, $value:expr)* $(,)?) => {{
        const _: () = $crate::report::markup::check_positions($template);
        $crate::report::markup::Html::filled(format_args!(
            $template $(, $crate::report::markup::Escaped(&$value))*
        ))
    }};
}
pub(crate) use html;

/// Fails to compile if a template takes a value by name, because `{name}` would not be escaped.
pub(crate) const fn check_positions(template: &str) {
    let bytes = template.as_bytes();
    let mut ix = 0;
    while ix < bytes.len() {
        if bytes[ix] != b'{' {
            ix += 1;
        } else if bytes[ix + 1] == b'{' {
            ix += 2;
        } else {
            ix += 1;
            while bytes[ix] != b'}' {
                assert!(bytes[ix].is_ascii_digit(), "templates of HTML take values by position");
                ix += 1;
            }
        }
    }
}

/// Shows a value as HTML.
pub(crate) struct Escaped<'a, T: ?Sized>(pub(crate) &'a T);

impl<T: Markup + ?Sized> Display for Escaped<'_, T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.write(f)
    }
}

/// What a template takes.
pub(crate) trait Markup {
    fn write(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result;
}

impl Markup for str {
    fn write(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for c in visible_lines(self).chars() {
            match c {
                '&' => f.write_str("&amp;")?,
                '<' => f.write_str("&lt;")?,
                '>' => f.write_str("&gt;")?,
                '"' => f.write_str("&quot;")?,
                '\'' => f.write_str("&#39;")?,
                c => f.write_char(c)?,
            }
        }
        Ok(())
    }
}

impl Markup for String {
    fn write(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.as_str().write(f)
    }
}

impl Markup for Html {
    fn write(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl<T: Markup + ?Sized> Markup for &T {
    fn write(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        (**self).write(f)
    }
}

/// Numbers have nothing to escape.
macro_rules! plain {
    ($($number:ty),*) => {$(
        impl Markup for $number {
            fn write(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "{self}")
            }
        }
    )*};
}
plain!(bool, u32, u64, usize, f64);

impl From<&str> for Html {
    fn from(text: &str) -> Self {
        Self::text(text)
    }
}

impl From<&String> for Html {
    fn from(text: &String) -> Self {
        Self::text(text)
    }
}

impl From<String> for Html {
    fn from(text: String) -> Self {
        Self::text(&text)
    }
}

impl From<&Self> for Html {
    fn from(html: &Self) -> Self {
        html.clone()
    }
}

impl Add for Html {
    type Output = Self;

    fn add(mut self, other: Self) -> Self {
        self += other;
        self
    }
}

impl AddAssign for Html {
    fn add_assign(&mut self, other: Self) {
        self.0 += &other.0;
    }
}

impl FromIterator<Html> for Html {
    fn from_iter<I: IntoIterator<Item = Self>>(parts: I) -> Self {
        parts.into_iter().fold(Self::default(), Add::add)
    }
}

/// Names up to this long, in characters, are not broken over lines.
const UNBROKEN: usize = 24;

/// Text as HTML in which no name such as `DC-I/64x64x24` is broken at its hyphen.
pub(crate) fn with_names_whole(text: &str) -> Html {
    let word = |(ix, word): (usize, &str)| {
        let space = if ix == 0 { "" } else { " " };
        let is_name = word.contains('-') && word.chars().count() <= UNBROKEN;
        match is_name {
            true => html!("{}<span class=\"whole\">{}</span>", space, word),
            false => html!("{}{}", space, word),
        }
    };
    text.split(' ').enumerate().map(word).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_escaped_and_html_is_not() {
        let odd = "<b a='\"&\">\u{1b}[31m\u{202e}";
        let shown = "&lt;b a=&#39;&quot;&amp;&quot;&gt;\\u{1b}[31m\\u{202e}";
        assert_eq!(Html::text(odd).as_str(), shown);
        let bold = html!("<b>{}</b>", odd);
        assert_eq!(bold.as_str(), format!("<b>{shown}</b>"));
        let both = html!("<i title=\"{1}\">{0}</i>{{{2}}}", bold, odd.to_owned(), 3_u32);
        assert_eq!(both.as_str(), format!("<i title=\"{shown}\"><b>{shown}</b></i>{{3}}"));
        assert_eq!(Html::from(odd.to_owned()).as_str(), shown);
        let all: Html = [bold.clone(), bold.clone()].into_iter().collect();
        assert_eq!(all, bold.clone() + bold);
    }

    #[test]
    #[should_panic(expected = "by position")]
    fn a_template_takes_no_value_by_name() {
        check_positions("<b>{{}}{0}{}{name}</b>");
    }
}
