//! What stands where in a text, for a room that lays texts out anew: tokens, and what the grammar
//! makes of them. Nothing is built, and no diagnostics are made.

use super::lex::{Lexer, Token, TokenKind};
use super::parse::{Node, Rule, TEXT_MAX, nodes};
use super::scan::scan;
use crate::source::FileId;
use std::collections::{HashMap, HashSet};
use std::ops::Range;

/// What the grammar makes of the token that begins at a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// A sign or `not` in front of its operand.
    Prefix,
    /// An opening bracket that belongs to what stands before it: a call, an index, parameters.
    Tight,
    /// The braces of `use a.{b, c}`.
    Names,
    /// `<` or `>` around the arguments of a type.
    Angle,
    /// `for` or `if` of a list that is made: it does not go on with what stands before it.
    Each,
    /// The `:` behind the name of a joint or port, which introduces more than a type.
    Spaced,
}

/// A run of items that is parsed on its own.
#[derive(Clone, Debug)]
pub struct Chunk {
    pub range: Range<usize>,
    /// Whether the grammar can read it.
    pub sound: bool,
}

/// A text as the grammar sees it.
#[derive(Debug)]
pub struct Outline {
    /// In order; comments and line breaks are tokens, and a number is one with its unit.
    pub tokens: Vec<Token>,
    /// Where items, clauses and statements begin.
    pub begins: HashSet<usize>,
    /// By the token's first byte. Of what can't be read nothing is known.
    pub roles: HashMap<usize, Role>,
    /// Without gaps, in order. The first may hold nothing but comments.
    pub chunks: Vec<Chunk>,
}

impl Outline {
    /// `None` for a text that is longer than what is parsed at all.
    pub fn of(text: &str) -> Option<Outline> {
        if text.len() > TEXT_MAX {
            return None;
        }
        // Places are all that is asked, so any file's name will do.
        let scan = scan(FileId(0), text);
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
}

/// The tree of a text without its places: each node's rule and depth, and the text of leaves.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Skeleton(Vec<(Rule, usize, String)>);

/// Texts that mean the same have the same skeleton; `None` where something can't be read.
pub fn skeleton(text: &str) -> Option<Skeleton> {
    let scan = scan(FileId(0), text);
    let mut out = Skeleton::default();
    for range in scan.ranges() {
        // Where chunks begin means nothing.
        for node in nodes(Rule::chunk, &scan.text[range])?.into_inner() {
            if node.as_rule() != Rule::EOI {
                out.add(node, 0);
            }
        }
    }
    scan.faults.is_empty().then_some(out)
}

impl Skeleton {
    fn add(&mut self, node: Node, depth: usize) {
        let (rule, text) = (node.as_rule(), node.as_str());
        let inner = node.into_inner();
        let leaf = match (inner.len(), rule) {
            (0, Rule::text_chars | Rule::escape | Rule::raw_text | Rule::plain_text) => text.to_owned(),
            // White space in a leaf, such as between a label and its colon, means nothing.
            (0, _) => text.split_whitespace().collect(),
            _ => String::new(),
        };
        self.0.push((rule, depth, leaf));
        for child in inner {
            self.add(child, depth + 1);
        }
    }
}

#[derive(Default)]
struct Found {
    begins: HashSet<usize>,
    roles: HashMap<usize, Role>,
    /// Numbers with their units, and units in types: begin and end.
    atoms: HashMap<usize, usize>,
    /// Ends of the `>` that close the arguments of a type.
    angle_ends: HashSet<usize>,
}

impl Found {
    fn visit(&mut self, node: Node, base: usize, parent: Rule) {
        let rule = node.as_rule();
        let span = node.as_span();
        let (start, end) = (base + span.start(), base + span.end());
        let text = node.as_str();
        if begins(rule, parent) {
            // `extern` itself is no node.
            let before = node.get_input()[..span.start()].trim_end();
            let of_extern = matches!(rule, Rule::extern_fn | Rule::extern_type) && before.ends_with("extern");
            self.begins.insert(if of_extern { base + before.len() - "extern".len() } else { start });
        }
        match rule {
            Rule::prefix => {
                self.roles.insert(start, Role::Prefix);
            }
            // The limits of a motor stand behind a sum that they do not call.
            Rule::args if parent == Rule::motor => {}
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
            // What stands in a text is kept as it is.
            Rule::text => return,
            _ => {}
        }
        for child in node.into_inner() {
            self.visit(child, base, rule);
        }
    }

    /// The colon behind the name, and behind the index of a port.
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

/// Whether a node of this rule is an item, clause or statement where it stands.
fn begins(rule: Rule, parent: Rule) -> bool {
    use Rule as R;
    match parent {
        R::chunk | R::statements | R::block => rule != R::EOI,
        R::module_body | R::config_body | R::truss_body | R::extern_body => true,
        R::cell | R::strut => rule == R::fact,
        R::connector => rule != R::name,
        _ => false,
    }
}

/// The tokens, those of a number and its unit as one.
fn joined(lexer: Lexer, text: &str, found: &Found) -> Vec<Token> {
    let mut tokens = Vec::new();
    let mut atom = 0;
    for token in lexer {
        if token.start < atom {
            continue;
        }
        // `List<Int>= [1]`: the sign is of two rules.
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
