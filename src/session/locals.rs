//! The local names that an unfinished text declares: parameters, parts, lets, binders and other names in a
//! body. The text need not be valid.

use crate::syntax::DECLARING;

/// A local name that an unfinished text declares, with its origin.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct LocalName {
    /// The name of the local variable.
    pub name: String,
    /// The origin of the local variable, from which its type may be inferred.
    pub origin: Origin,
}

/// The clause that declares a local name, with the text from which its type follows.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Origin {
    /// A name of this type.
    Typed(String),
    /// A list of this type.
    Listed(String),
    /// The value of this expression.
    Value(String),
    /// An element of this list or range.
    Each(String),
    /// A name declared by this keyword.
    Word(String),
}

/// The words that begin a clause and declare nothing.
const CLAUSES: &[&str] = &["connect", "set", "base", "require", "expect", "touching", "alias"];

/// Returns true if a name is declared after this word; a loop declares its binder.
fn declares(word: &str) -> bool {
    word == "for" || DECLARING.contains(&word)
}

/// Returns the names that a text declares, in the order of the text, so that the latest is the last; a name may come
/// twice.
pub(super) fn locals(text: &str) -> Vec<LocalName> {
    let mut found = Vec::new();
    let mut rest = text;
    while let Some((word, after)) = next_word(rest) {
        rest = after;
        if !declares(word) {
            continue;
        }
        let Some((name, behind)) = next_word(after).filter(|_| after.starts_with([' ', '\t', '\n'])) else {
            continue;
        };
        if declares(name) || after.len() - behind.len() > name.len() + blanks(after) {
            continue;
        }
        found.extend(
            parameters(behind).into_iter().map(|(name, ty)| LocalName { name, origin: Origin::Typed(ty) }),
        );
        found.push(LocalName { name: name.to_owned(), origin: origin_of(word, behind) });
    }
    found.extend(of_contract(text));
    found
}

/// Returns the states and the report that the contract of a behaviour knows, if a text ends within one.
fn of_contract(text: &str) -> Vec<LocalName> {
    let line = text.rsplit('\n').next().unwrap_or("").trim_start();
    // Each with an expression of its type.
    let known: &[(&str, &str)] = match next_word(line).map(|(word, _)| word) {
        Some("require") => &[("start", "plan(wait(1s)).start")],
        Some("ensure") => &[
            ("start", "plan(wait(1s)).start"),
            ("end", "plan(wait(1s)).end"),
            ("report", "verify(wait(1s))"),
        ],
        _ => &[],
    };
    let named = |(name, value): &(&str, &str)| LocalName {
        name: (*name).to_owned(),
        origin: Origin::Value((*value).to_owned()),
    };
    // Outside of behaviours neither stands.
    known.iter().filter(|_| text.contains("behavior ")).map(named).collect()
}

/// Returns the number of blanks at the beginning of a text.
fn blanks(text: &str) -> usize {
    text.len() - text.trim_start().len()
}

/// Returns the next word of a text, and the text after it; `None` where no word follows.
fn next_word(text: &str) -> Option<(&str, &str)> {
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    let start = text.find(is_word)?;
    let end = text[start..].find(|c| !is_word(c)).map_or(text.len(), |at| start + at);
    Some((&text[start..end], &text[end..]))
}

/// Returns the origin of a name, from the word before it and the text after it.
fn origin_of(word: &str, behind: &str) -> Origin {
    let after = |text: &str, mark: char| text.trim_start().strip_prefix(mark).map(str::to_owned);
    match word {
        "let" => {
            let value = after(behind, '=').map(|value| up_to_clause(&up_to(&value, &['\n'])));
            value.filter(|value| !value.is_empty()).map_or_else(|| Origin::Word(word.into()), Origin::Value)
        }
        "for" => {
            let list = behind.trim_start().strip_prefix("in ").map(|list| up_to(list, &['{', ']', '\n']));
            list.filter(|list| !list.is_empty()).map_or_else(|| Origin::Word(word.into()), Origin::Each)
        }
        "part" => {
            let many = behind.trim_start().starts_with('[');
            let behind = if many { behind.split_once(']').map_or("", |(_, rest)| rest) } else { behind };
            let ty = after(behind, ':').map(|ty| type_name(&ty));
            match ty.filter(|ty| !ty.is_empty()) {
                Some(ty) if many => Origin::Listed(ty),
                Some(ty) => Origin::Typed(ty),
                None => Origin::Word(word.into()),
            }
        }
        _ => Origin::Word(word.into()),
    }
}

/// Returns the parameters `name: Type` in the parentheses with which a text begins.
fn parameters(text: &str) -> Vec<(String, String)> {
    let Some(inside) = text.strip_prefix('(') else { return Vec::new() };
    let inside = up_to(inside, &[')']);
    let mut found = Vec::new();
    let mut rest = inside.as_str();
    while !rest.is_empty() {
        let one = up_to(rest, &[',']);
        rest = rest[one.len()..].trim_start_matches(|c: char| c != ',').strip_prefix(',').unwrap_or("");
        if let Some((name, ty)) = one.split_once(':') {
            let ty = up_to(ty, &['=']);
            found.push((name.trim().to_owned(), ty));
        }
    }
    found
}

/// Returns the beginning of a text up to one of these marks outside of brackets.
fn up_to(text: &str, marks: &[char]) -> String {
    let mut depth = 0usize;
    for (at, c) in text.char_indices() {
        match c {
            c if depth == 0 && marks.contains(&c) => return text[..at].trim().to_owned(),
            '(' | '[' | '{' => depth += 1,
            ')' | ']' | '}' if depth == 0 => return text[..at].trim().to_owned(),
            ')' | ']' | '}' => depth -= 1,
            _ => {}
        }
    }
    text.trim().to_owned()
}

/// Returns the beginning of a line up to the next clause on it.
fn up_to_clause(line: &str) -> String {
    let begins = |at: &usize| {
        let closed =
            line[..*at].matches(['(', '[', '{']).count() == line[..*at].matches([')', ']', '}']).count();
        let word = next_word(&line[*at..]).map_or("", |(word, _)| word);
        closed && line[..*at].ends_with([' ', '\t']) && (CLAUSES.contains(&word) || declares(word))
    };
    let end = line.char_indices().map(|(at, _)| at).find(begins).unwrap_or(line.len());
    line[..end].trim().to_owned()
}

/// Returns the type name with which a text begins.
fn type_name(text: &str) -> String {
    let text = text.trim_start();
    let end = text.find(|c: char| !c.is_alphanumeric() && c != '_' && c != '.').unwrap_or(text.len());
    text[..end].to_owned()
}
