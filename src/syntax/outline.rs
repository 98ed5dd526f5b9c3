//! The outline of a text for the formatter: tokens with their roles in the grammar. No tree is built and no
//! diagnostics are made.

use super::lex::{Lexer, Token, TokenKind};
use super::parse::{Node, Rule, TEXT_MAX, nodes};
use super::scan::scan;
use crate::source::FileId;
use std::collections::{HashMap, HashSet};
use std::ops::Range;

/// The role of a token in the grammar.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// A sign or `not` before its operand.
    Prefix,
    /// An opening bracket attached to the token before it: a call, an index, parameters.
    Tight,
    /// The braces around the names of an import, `use a.{b, c}`.
    Names,
    /// `<` or `>` around the arguments of a type.
    Angle,
    /// The `for` or `if` of a comprehension, which does not continue the expression in front.
    Each,
    /// The `:` after the name of a joint or port, which is spaced on both sides.
    Spaced,
}

/// A chunk of a text: a run of items that is parsed on its own.
#[derive(Clone, Debug)]
pub struct Chunk {
    /// The range of bytes that the chunk takes in the text.
    pub range: Range<usize>,
    /// True if the grammar can parse the chunk.
    pub sound: bool,
}

/// The outline of a text: its tokens, and what the grammar makes of them; the formatter works on it.
#[derive(Debug)]
pub struct Outline {
    /// The tokens, in order, comments and line breaks included; a number and its unit are one token.
    pub tokens: Vec<Token>,
    /// The offsets in bytes at which items, clauses and statements begin.
    pub begins: HashSet<usize>,
    /// The roles of tokens, by offset in bytes. Most tokens have none, nor have those in unreadable chunks.
    pub roles: HashMap<usize, Role>,
    /// The chunks, in order, without gaps up to the end of the text. The first may hold nothing but
    /// comments.
    pub chunks: Vec<Chunk>,
}

impl Outline {
    /// Returns the outline of a text; `None` if the text is longer than [`TEXT_MAX`] or nests too deeply.
    pub fn of(text: &str) -> Option<Outline> {
        if text.len() > TEXT_MAX {
            return None;
        }
        // Only offsets are used, so any file identity will do.
        let scan = scan(FileId(0), text);
        if scan.too_deep {
            return None;
        }
        let mut found = Found::default();
        let mut chunks = Vec::new();
        for range in scan.ranges() {
            let start = range.start;
            let faulty = scan.faults.iter().any(|fault| range.contains(&fault.at));
            let root = if faulty { None } else { nodes(Rule::chunk, &scan.text[range.clone()]) };
            chunks.push(Chunk { range, sound: root.is_some() });
            if let Some(root) = root {
                found.visit(root, start, Rule::EOI);
            }
        }
        let start = scan.chunks.first().copied().unwrap_or(0);
        let tokens = joined(Lexer::new(text, start), text, &found);
        Some(Outline { tokens, begins: found.begins, roles: found.roles, chunks })
    }

    /// Returns the tokens of a text alone, without reading what they make, which takes most of the time; a unit such as `m/s` is
    /// several tokens. `None` as for [`of`](Self::of).
    pub fn tokens_of(text: &str) -> Option<Vec<Token>> {
        if text.len() > TEXT_MAX {
            return None;
        }
        let scan = scan(FileId(0), text);
        let start = scan.chunks.first().copied().unwrap_or(0);
        (!scan.too_deep).then(|| Lexer::new(text, start).collect())
    }
}

/// The tree of a text without positions: the rule and depth of each node, and the text of leaves. Texts that differ
/// only in white space without meaning have equal skeletons.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Skeleton {
    /// The rule of each node, its depth, and the length of its text, bytes; 0 unless it is a leaf.
    nodes: Vec<(Rule, u32, u32)>,
    /// The texts of the leaves, one after the other.
    leaves: String,
}

/// Returns the skeleton of a text; `None` if the text has a syntax error.
pub fn skeleton(text: &str) -> Option<Skeleton> {
    let scan = scan(FileId(0), text);
    let mut out = Skeleton::default();
    for range in scan.ranges() {
        // The borders of chunks have no meaning.
        for node in nodes(Rule::chunk, &scan.text[range])?.into_inner() {
            if node.as_rule() != Rule::EOI {
                out.add(node, 0);
            }
        }
    }
    scan.faults.is_empty().then_some(out)
}

impl Skeleton {
    /// Adds a node with its children.
    fn add(&mut self, node: Node, depth: u32) {
        let (rule, text) = (node.as_rule(), node.as_str());
        let inner = node.into_inner();
        let before = self.leaves.len();
        match (inner.len(), rule) {
            (0, Rule::text_chars | Rule::escape | Rule::raw_text | Rule::plain_text) => {
                self.leaves.push_str(text)
            }
            // White space in a leaf, such as between a label and its colon, has no meaning.
            (0, _) => self.leaves.extend(text.split_whitespace()),
            _ => {}
        }
        // No text is as long as 4 GiB.
        self.nodes.push((rule, depth, (self.leaves.len() - before) as u32));
        for child in inner {
            self.add(child, depth + 1);
        }
    }
}

/// The roles and beginnings found so far, by offset in bytes.
#[derive(Default)]
struct Found {
    begins: HashSet<usize>,
    roles: HashMap<usize, Role>,
    /// Numbers with their units, and units in types, from begin to end.
    atoms: HashMap<usize, usize>,
    /// The ends of the `>` that close the arguments of a type.
    angle_ends: HashSet<usize>,
}

impl Found {
    /// Records the roles of a node and its children.
    fn visit(&mut self, node: Node, base: usize, parent: Rule) {
        let rule = node.as_rule();
        let span = node.as_span();
        let (start, end) = (base + span.start(), base + span.end());
        let text = node.as_str();
        if begins(rule, parent) {
            // The word `extern` is not part of the node.
            let before = node.get_input()[..span.start()].trim_end();
            let of_extern = matches!(rule, Rule::extern_fn | Rule::extern_type) && before.ends_with("extern");
            self.begins.insert(if of_extern { base + before.len() - "extern".len() } else { start });
        }
        match rule {
            Rule::prefix => {
                self.roles.insert(start, Role::Prefix);
            }
            // The parentheses of a motor are not attached to the sum before them.
            Rule::args if parent == Rule::motor => {}
            Rule::study => self.study_axes(&node, start),
            Rule::args | Rule::params | Rule::index | Rule::part_count => {
                self.roles.insert(start, Role::Tight);
            }
            Rule::exemption | Rule::fn_type => {
                if let Some(at) = text.find('(') {
                    self.roles.insert(start + at, Role::Tight);
                }
            }
            Rule::use_names => {
                self.roles.insert(start, Role::Names);
                self.roles.insert(end - 1, Role::Names);
            }
            Rule::type_params | Rule::named_type | Rule::quantity_type if text.ends_with('>') => {
                let open = text.find('<').expect("what `>` ends `<` began");
                self.roles.insert(start + open, Role::Angle);
                self.roles.insert(end - 1, Role::Angle);
                self.angle_ends.insert(end);
            }
            Rule::number | Rule::quantity_unit => {
                self.atoms.insert(start, end);
            }
            Rule::each | Rule::filter => {
                self.roles.insert(start, Role::Each);
            }
            Rule::joint | Rule::port => self.colon(&node, base),
            // The contents of a text stay as they are.
            Rule::text => return,
            _ => {}
        }
        for child in node.into_inner() {
            self.visit(child, base, rule);
        }
    }

    /// Records the parenthesis before the axes of a study, which is attached to its name.
    fn study_axes(&mut self, node: &Node, start: usize) {
        if let Some(at) = node.as_str().find('(') {
            self.roles.insert(start + at, Role::Tight);
        }
    }

    /// Records the colon after the name or the index of a port.
    fn colon(&mut self, node: &Node, base: usize) {
        let (start, text) = (node.as_span().start(), node.as_str());
        let name_end =
            node.clone().into_inner().take_while(|n| matches!(n.as_rule(), Rule::name | Rule::index));
        let end = match node.as_rule() {
            Rule::joint => node.clone().into_inner().next().map(|name| name.as_span().end()),
            _ => name_end.last().map(|n| n.as_span().end()),
        };
        let Some(end) = end else { return };
        let rest = &text[end - start..];
        let blanks = rest.len() - rest.trim_start().len();
        if rest[blanks..].starts_with(':') {
            self.roles.insert(base + end + blanks, Role::Spaced);
        }
    }
}

/// Returns true if a node of this rule is an item, clause or statement below its parent.
fn begins(rule: Rule, parent: Rule) -> bool {
    use Rule as R;
    match parent {
        R::chunk | R::statements | R::block => rule != R::EOI,
        R::module_body | R::config_body | R::truss_body | R::extern_body => true,
        R::cell | R::strut => rule == R::fact,
        R::record => rule == R::record_field,
        R::with => rule == R::label,
        R::connector => rule != R::name,
        _ => false,
    }
}

/// Returns the tokens, a number and its unit joined.
fn joined(lexer: Lexer, text: &str, found: &Found) -> Vec<Token> {
    let mut tokens = Vec::new();
    let mut atom = 0;
    for token in lexer {
        if token.start < atom {
            continue;
        }
        // `List<Int>= [1]`: the two characters belong to two rules.
        if &text[token.start..token.end] == ">=" && found.angle_ends.contains(&(token.start + 1)) {
            tokens.push(Token { end: token.start + 1, ..token });
            tokens.push(Token { start: token.start + 1, ..token });
            continue;
        }
        match found.atoms.get(&token.start) {
            Some(&end) => {
                atom = end;
                tokens.push(Token { kind: TokenKind::Number, end, ..token });
            }
            None => tokens.push(token),
        }
    }
    tokens
}
