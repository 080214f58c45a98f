//! The list of terms at the foot of every page, from `docs/terms.md`.
//!
//! Of that file this reads headings (`## Groups`) and terms (`**tile**: a rectangle of pixels.`), with
//! `` `code` ``, `*emphasis*` and `[links](to.md)` in definitions. Of a link it shows the text only, because a
//! page may lie anywhere.

use super::markup::{Html, html};

const TERMS: &str = include_str!("../../../docs/terms.md");

/// All terms, folded.
pub(crate) fn terms() -> Html {
    let (body, count) = list(TERMS);
    html!(
        "<details class=\"terms\" id=\"terms\"><summary>What the words mean: {} terms</summary>\n{}</details>\n",
        count,
        body
    )
}

/// The headings and terms of a document, and how many terms there are.
fn list(document: &str) -> (Html, usize) {
    let (mut body, mut entries, mut count) = (Html::default(), Html::default(), 0);
    let close = |body: &mut Html, entries: &mut Html| {
        if !entries.is_empty() {
            *body += html!("<dl class=\"columns\">\n{}</dl>\n", std::mem::take(entries));
        }
    };
    for line in document.lines() {
        if let Some(heading) = line.strip_prefix("## ") {
            close(&mut body, &mut entries);
            body += html!("<h3>{}</h3>\n", heading);
        } else if let Some((term, definition)) =
            line.strip_prefix("**").and_then(|line| line.split_once("**: "))
        {
            count += 1;
            entries += html!("<dt>{}</dt><dd>{}</dd>\n", inline(term), inline(definition));
        }
    }
    close(&mut body, &mut entries);
    (body, count)
}

/// A line with its code, its emphasis and the texts of its links. A mark without its end is text.
pub(crate) fn inline(line: &str) -> Html {
    let mut shown = Html::default();
    let mut rest = line;
    while let Some(start) = rest.find(['`', '*', '[']) {
        let (before, marked) = rest.split_at(start);
        let (mark, behind) = marked.split_at(1);
        let parts = match mark {
            "[" => behind
                .split_once("](")
                .and_then(|(text, link)| Some((text, link.split_once(')')?.1))),
            _ => behind.split_once(mark),
        };
        let Some((inside, after)) = parts else { break };
        shown += Html::from(before);
        shown += match mark {
            "`" => html!("<code>{}</code>", inside),
            "*" => html!("<em>{}</em>", inside),
            _ => Html::from(inside),
        };
        rest = after;
    }
    shown + Html::from(rest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headings_terms_code_emphasis_and_links_are_read() {
        let document = "# Terms\n\nWords.\n\n## Lists\n\n**list**: <lights> of a *group*, `a * b`, see [the rule](a.md#b).\n\n\
                        **`/bvh`**: a half * mark\n";
        let (body, count) = list(document);
        let expected = "<h3>Lists</h3>\n<dl class=\"columns\">\n\
             <dt>list</dt><dd>&lt;lights&gt; of a <em>group</em>, <code>a * b</code>, see the rule.</dd>\n\
             <dt><code>/bvh</code></dt><dd>a half * mark</dd>\n</dl>\n";
        assert_eq!((body.as_str(), count), (expected, 2));
    }

    #[test]
    fn the_words_that_reports_use_are_terms() {
        let (body, count) = list(TERMS);
        let known = [
            "view sample",
            "group",
            "list",
            "support",
            "range",
            "window",
            "lossless",
            "contributing",
            "listed",
            "efficiency",
            "early exit",
            "tie",
            "path",
            "pose",
            "assign",
            "shade",
            "missed pair",
        ];
        for term in known {
            assert!(
                body.as_str().contains(&format!("<dt>{term}</dt>")),
                "docs/terms.md lacks {term}"
            );
        }
        assert_eq!(count, body.as_str().matches("<dt>").count());
        assert!(!body.as_str().contains("]("), "a link shows its text only");
        let bold_lines = TERMS.lines().filter(|line| line.starts_with("**")).count();
        assert_eq!(
            count, bold_lines,
            "a term of docs/terms.md is not written `**term**: definition`"
        );
    }
}
