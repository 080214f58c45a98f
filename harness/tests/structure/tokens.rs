//! Cuts Rust source into the tokens that paths are made of.

/// One token.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Token {
    /// A name or a keyword.
    Word(String),
    /// `::`
    PathSeparator,
    /// Any other character that is neither space, nor part of a comment or a literal.
    Mark(char),
}

impl Token {
    /// Whether it is this name or keyword.
    pub(crate) fn is_word(&self, word: &str) -> bool {
        matches!(self, Self::Word(name) if name == word)
    }
}

/// The tokens of `source`, without comments, strings and characters.
pub(crate) fn tokens(source: &str) -> Vec<Token> {
    let chars: Vec<char> = source.chars().collect();
    let at = |ix: usize| chars.get(ix).copied().unwrap_or('\0');
    let mut found = Vec::new();
    let mut ix = 0;
    while ix < chars.len() {
        let c = chars[ix];
        if c == '/' && at(ix + 1) == '/' {
            ix = end_of_line(&chars, ix);
        } else if c == '/' && at(ix + 1) == '*' {
            ix = end_of_block(&chars, ix);
        } else if c == '"' {
            ix = end_of_string(&chars, ix);
        } else if c == '\'' {
            ix = end_of_quote(&chars, ix);
        } else if c.is_alphanumeric() || c == '_' {
            let end = (ix..chars.len()).find(|&i| !(chars[i].is_alphanumeric() || chars[i] == '_'));
            let end = end.unwrap_or(chars.len());
            let word: String = chars[ix..end].iter().collect();
            let is_raw = matches!(word.as_str(), "r" | "br" | "cr") && matches!(at(end), '"' | '#');
            if let Some(after) = is_raw.then(|| end_of_raw_string(&chars, end)).flatten() {
                ix = after;
            } else {
                found.push(Token::Word(word));
                ix = end;
            }
        } else if c == ':' && at(ix + 1) == ':' {
            found.push(Token::PathSeparator);
            ix += 2;
        } else {
            if !c.is_whitespace() {
                found.push(Token::Mark(c));
            }
            ix += 1;
        }
    }
    found
}

fn end_of_line(chars: &[char], start: usize) -> usize {
    (start..chars.len()).find(|&i| chars[i] == '\n').unwrap_or(chars.len())
}

/// The place after a block comment, which may hold others.
fn end_of_block(chars: &[char], start: usize) -> usize {
    let mut depth = 0;
    let mut ix = start;
    while ix + 1 < chars.len() {
        match (chars[ix], chars[ix + 1]) {
            ('/', '*') => (depth, ix) = (depth + 1, ix + 2),
            ('*', '/') => (depth, ix) = (depth - 1, ix + 2),
            _ => ix += 1,
        }
        if depth == 0 {
            return ix;
        }
    }
    chars.len()
}

fn end_of_string(chars: &[char], start: usize) -> usize {
    let mut ix = start + 1;
    while ix < chars.len() && chars[ix] != '"' {
        ix += if chars[ix] == '\\' { 2 } else { 1 };
    }
    ix + 1
}

/// The place after a character, or after the quote of a lifetime.
fn end_of_quote(chars: &[char], start: usize) -> usize {
    let at = |ix: usize| chars.get(ix).copied().unwrap_or('\0');
    if at(start + 1) == '\\' {
        let end = (start + 3..chars.len()).find(|&i| chars[i] == '\'');
        return end.map_or(chars.len(), |end| end + 1);
    }
    if at(start + 2) == '\'' { start + 3 } else { start + 1 }
}

/// The place after a raw string whose `#` or quote stands at `start`; `None` for a raw name.
fn end_of_raw_string(chars: &[char], start: usize) -> Option<usize> {
    let hashes = chars[start..].iter().take_while(|&&c| c == '#').count();
    if chars.get(start + hashes) != Some(&'"') {
        return None;
    }
    let closes = |&i: &usize| {
        chars[i] == '"' && chars[i + 1..].iter().take_while(|&&c| c == '#').count() >= hashes
    };
    let end = (start + hashes + 1..chars.len()).find(closes);
    Some(end.map_or(chars.len(), |end| end + 1 + hashes))
}
