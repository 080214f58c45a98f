//! Reads one source file: the paths that it names inside its crate.

use std::collections::{BTreeMap, BTreeSet};

use crate::tokens::{Token, tokens};

/// A path inside a crate, from its root: `["report", "rank"]`.
pub(crate) type Path = Vec<String>;

/// What one file imports and defines. Code under `#[cfg(test)]` is left out.
#[derive(Clone, Debug, Default)]
pub(crate) struct Module {
    /// Absolute paths that the file names, those of its imports included.
    pub(crate) named: Vec<Path>,
    /// Imported names and what they stand for.
    pub(crate) imports: BTreeMap<String, Path>,
    /// Modules of which every name is imported.
    pub(crate) globs: Vec<Path>,
    /// Names of the items that the file defines.
    pub(crate) items: BTreeSet<String>,
    /// Names that stand alone or begin a path, outside of imports.
    pub(crate) words: BTreeSet<String>,
    /// Child modules that only tests have.
    pub(crate) test_modules: Vec<String>,
}

/// Reads the file of the module at `path`, whose children are named `children`.
pub(crate) fn read_module(path: &[String], children: &[String], source: &str) -> Module {
    let tokens = tokens(source);
    let mut reader = Reader {
        tokens: &tokens,
        ix: 0,
        inside: path.to_vec(),
        children,
        module: Module::default(),
    };
    reader.read();
    reader.module
}

/// Keywords that an item's name follows.
const ITEM_KEYWORDS: [&str; 9] =
    ["fn", "struct", "enum", "trait", "const", "static", "type", "union", "macro_rules"];

struct Reader<'a> {
    tokens: &'a [Token],
    ix: usize,
    /// The module that the current token stands in; longer than the file's within `mod name { … }`.
    inside: Path,
    children: &'a [String],
    module: Module,
}

impl Reader<'_> {
    fn read(&mut self) {
        let mut depth = 0;
        // Braces around each `mod name { … }` that is open.
        let mut inline_depths = Vec::new();
        while let Some(token) = self.tokens.get(self.ix) {
            match token {
                Token::Mark('#') => {
                    if self.skip_attribute_of_tests() {
                        self.skip_item();
                    }
                    continue;
                }
                Token::Mark('{') => depth += 1,
                Token::Mark('}') => {
                    if inline_depths.last() == Some(&depth) {
                        inline_depths.pop();
                        self.inside.pop();
                    }
                    depth -= 1;
                }
                Token::Word(word) => match word.as_str() {
                    "use" => {
                        self.ix += 1;
                        self.read_use(&[]);
                        continue;
                    }
                    "mod" if self.mark(2) == Some('{') => {
                        self.inside.extend(self.word(1));
                        self.ix += 3;
                        depth += 1;
                        inline_depths.push(depth);
                        continue;
                    }
                    "crate" | "super" | "self" if self.is_separator(1) => {
                        let is_visibility = self.ix > 1
                            && self.tokens[self.ix - 1].is_word("in")
                            && self.tokens[self.ix - 2] == Token::Mark('(');
                        let path = self.read_path();
                        if let Some(path) = self.absolute(&path).filter(|_| !is_visibility) {
                            self.module.named.push(path);
                        }
                        continue;
                    }
                    keyword if ITEM_KEYWORDS.contains(&keyword) => {
                        let is_macro = self.mark(1) == Some('!');
                        self.module.items.extend(self.word(if is_macro { 2 } else { 1 }));
                    }
                    // A name after a path or a dot belongs to what stands before it.
                    name if !self.is_after_path_or_dot() => {
                        self.module.words.insert(name.to_owned());
                        let is_child = self.children.iter().any(|child| child == name);
                        if is_child && self.is_separator(1) {
                            let path = self.read_path();
                            self.module.named.extend(self.absolute(&path));
                            continue;
                        }
                    }
                    _ => {}
                },
                _ => {}
            }
            self.ix += 1;
        }
    }

    fn word(&self, ahead: usize) -> Option<String> {
        match self.tokens.get(self.ix + ahead) {
            Some(Token::Word(word)) => Some(word.clone()),
            _ => None,
        }
    }

    fn mark(&self, ahead: usize) -> Option<char> {
        match self.tokens.get(self.ix + ahead) {
            Some(Token::Mark(mark)) => Some(*mark),
            _ => None,
        }
    }

    fn is_after_path_or_dot(&self) -> bool {
        let before = self.ix.checked_sub(1).and_then(|ix| self.tokens.get(ix));
        matches!(before, Some(Token::PathSeparator | Token::Mark('.')))
    }

    fn is_separator(&self, ahead: usize) -> bool {
        self.tokens.get(self.ix + ahead) == Some(&Token::PathSeparator)
    }

    /// Skips an attribute, or a lone `#`; says whether it is `#[cfg(test)]`.
    fn skip_attribute_of_tests(&mut self) -> bool {
        self.ix += 1;
        if self.mark(0) == Some('!') {
            self.ix += 1;
        }
        if self.mark(0) != Some('[') {
            return false;
        }
        let start = self.ix;
        self.skip_brackets('[', ']');
        let words: Vec<&Token> = self.tokens[start..self.ix.min(self.tokens.len())]
            .iter()
            .filter(|token| matches!(token, Token::Word(_)))
            .collect();
        words.len() == 2 && words[0].is_word("cfg") && words[1].is_word("test")
    }

    /// Skips from an opening bracket to behind its closing one.
    fn skip_brackets(&mut self, open: char, close: char) {
        let mut depth = 0;
        while let Some(token) = self.tokens.get(self.ix) {
            self.ix += 1;
            if *token == Token::Mark(open) {
                depth += 1;
            } else if *token == Token::Mark(close) {
                depth -= 1;
                if depth == 0 {
                    return;
                }
            }
        }
    }

    /// Skips an item of tests: to its `;`, or over its braces.
    fn skip_item(&mut self) {
        while let Some(token) = self.tokens.get(self.ix) {
            match token {
                Token::Mark('#') => {
                    self.skip_attribute_of_tests();
                    continue;
                }
                Token::Mark('{') => return self.skip_brackets('{', '}'),
                Token::Mark(';') => {
                    self.ix += 1;
                    return;
                }
                token if token.is_word("mod") => self.module.test_modules.extend(self.word(1)),
                _ => {}
            }
            self.ix += 1;
        }
    }

    /// Words joined by `::`, from the current token on.
    fn read_path(&mut self) -> Path {
        let mut path = Vec::new();
        while let Some(word) = self.word(0) {
            path.push(word);
            self.ix += 1;
            if !self.is_separator(0) || self.tokens.get(self.ix + 1).is_none() {
                break;
            }
            self.ix += 1;
        }
        path
    }

    /// Reads a use tree under `prefix`, up to its comma, semicolon or closing brace.
    fn read_use(&mut self, prefix: &[String]) {
        if self.is_separator(0) {
            self.ix += 1;
        }
        let path = [prefix, &self.read_path()].concat();
        match self.mark(0) {
            Some('*') => {
                self.ix += 1;
                if let Some(path) = self.absolute(&path) {
                    self.module.globs.push(path.clone());
                    self.module.named.push(path);
                }
            }
            Some('{') => {
                self.ix += 1;
                while self.ix < self.tokens.len() && self.mark(0) != Some('}') {
                    self.read_use(&path);
                    if self.mark(0) == Some(',') {
                        self.ix += 1;
                    }
                }
                self.ix += 1;
            }
            _ => {
                let alias = self.word(0).filter(|word| word == "as").and_then(|_| self.word(1));
                if alias.is_some() {
                    self.ix += 2;
                }
                self.add_import(path, alias);
            }
        }
    }

    fn add_import(&mut self, mut path: Path, alias: Option<String>) {
        // `use a::b::{self}` imports `b`.
        if path.len() > 1 && path.last().is_some_and(|last| last == "self") {
            path.pop();
        }
        let Some(name) = alias.or_else(|| path.last().cloned()) else { return };
        if let Some(path) = self.absolute(&path) {
            self.module.imports.insert(name, path.clone());
            self.module.named.push(path);
        }
    }

    /// The path from the crate's root; `None` for a path into another crate.
    fn absolute(&self, path: &[String]) -> Option<Path> {
        let (first, rest) = path.split_first()?;
        let mut base = self.inside.clone();
        match first.as_str() {
            "crate" => return Some(rest.to_vec()),
            "self" => {}
            "super" => {
                base.pop();
                let more = rest.iter().take_while(|word| *word == "super").count();
                base.truncate(base.len().saturating_sub(more));
                return Some([&base, &rest[more..]].concat());
            }
            child if self.children.iter().any(|known| known == child) => {
                return Some([&base, path].concat());
            }
            _ => return None,
        }
        Some([&base, rest].concat())
    }
}
