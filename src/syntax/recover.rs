//! Error recovery: faulty runs are split into pieces, sound pieces are parsed, and each faulty one becomes
//! an `Error` node with one diagnostic.

use super::ast::*;
use super::build::{Builder, whole_characters};
use super::failure::{BodyKind, Misspelt, explain};
use super::lex::{Lexer, Token, TokenKind};
use super::parse::{DIAGNOSTICS_MAX, Node, Rule, failure, nodes};
use super::scan::{Fault, Scan};
use super::split::{bodies, split, tokens};
use super::words;
use crate::source::Span;
use std::ops::Range;

/// The deepest level of bodies that are searched for faulty pieces; each level costs a parse of its text.
const BODIES_MAX: usize = 12;

/// A clause of a body, which is parsed piece by piece if the whole cannot be parsed.
trait Clause: Sized {
    /// The rule for a text of several clauses.
    const RULE: Rule;
    /// The kind of body, for messages.
    const BODY_KIND: BodyKind;
    /// Builds the clauses of a parsed run.
    fn build(builder: &mut Builder, run: Node) -> Vec<Self>;
    /// Returns the clause that marks an error.
    fn error(span: Span) -> Self;
    /// Returns the bodies inside this clause, in order of the text.
    fn bodies(&mut self) -> Vec<&mut Vec<Self>>;
}

macro_rules! clause {
    ($name:ident, $kind:ident, $rule:ident, $build:ident, $place:ident $(, $doc:ident)?) => {
        impl Clause for $name {
            const RULE: Rule = Rule::$rule;
            const BODY_KIND: BodyKind = BodyKind::$place;
            fn build(builder: &mut Builder, run: Node) -> Vec<$name> {
                builder.$build(run)
            }
            fn error(span: Span) -> $name {
                $name { span, $($doc: None,)? kind: $kind::Error }
            }
            fn bodies(&mut self) -> Vec<&mut Vec<$name>> {
                match &mut self.kind {
                    $kind::For { body, .. } => vec![body],
                    $kind::If { then, otherwise, .. } => {
                        let chained = matches!(otherwise.as_slice(), [one] if matches!(one.kind, $kind::If { .. }));
                        let mut bodies = vec![then];
                        match chained {
                            true => bodies.extend(otherwise[0].bodies()),
                            false => bodies.push(otherwise),
                        }
                        bodies
                    }
                    _ => Vec::new(),
                }
            }
        }
    };
}

clause!(ModuleClause, ModuleClauseKind, module_clauses, module_clauses, Module, doc);
clause!(ConfigClause, ConfigClauseKind, config_clauses, config_clauses, Config, doc);
clause!(TrussClause, TrussClauseKind, truss_clauses, truss_clauses, Truss);
clause!(Stmt, StmtKind, statements, statements, Statements);

/// The parser of the chunks of a file, which recovers from syntax errors piece by piece.
pub(super) struct Parser<'t> {
    /// The builder of the tree.
    pub(super) builder: Builder<'t>,
    /// The scan of the text.
    pub(super) scan: &'t Scan<'t>,
    /// The depth of the body being recovered.
    depth: usize,
}

impl<'t> Parser<'t> {
    /// Returns a parser of a scanned text, with `builder` at its start.
    pub(super) fn new(builder: Builder<'t>, scan: &'t Scan<'t>) -> Parser<'t> {
        Parser { builder, scan, depth: 0 }
    }

    /// Parses the chunk at this range of bytes, and appends its items to `items`; what can't be parsed is reported, and
    /// becomes `Error` nodes.
    pub(super) fn chunk(&mut self, range: Range<usize>, items: &mut Vec<Item>) {
        if self.faults(&range).iter().any(|fault| fault.fatal && self.nests_too_deep(*fault)) {
            items.push(self.error_item(range));
        } else if !self.sound_items(range.clone(), items) {
            self.faulty_chunk(range, items);
        }
    }

    /// Parses a faulty chunk piece by piece.
    fn faulty_chunk(&mut self, range: Range<usize>, items: &mut Vec<Item>) {
        let told = self.builder.diagnostics.len();
        for piece in split(&self.scan.text, range.clone(), BodyKind::Items.keywords(), &self.scan.unclosed) {
            if !self.sound_items(piece.clone(), items) {
                let item = self.faulty_item(piece);
                items.push(item);
            }
        }
        if self.builder.diagnostics.len() == told {
            // Each piece is sound, but not next to the others.
            let text = self.scan.text[range.clone()].to_string();
            self.explain(Rule::chunk, &text, &range, BodyKind::Items);
        }
    }

    /// Returns true if a fault is deep nesting, so that nothing around it can be parsed.
    fn nests_too_deep(&self, fault: Fault) -> bool {
        matches!(self.scan.text.as_bytes()[fault.at], b'(' | b'[' | b'{' | b'"')
    }

    /// Parses the items of a range; returns false if it cannot be parsed.
    fn sound_items(&mut self, range: Range<usize>, items: &mut Vec<Item>) -> bool {
        if self.faults(&range).iter().any(|fault| fault.fatal) {
            return false;
        }
        self.builder.base = range.start;
        match nodes(Rule::chunk, &self.scan.text[range]) {
            Some(node) => self.builder.chunk(node, items),
            None => return false,
        }
        true
    }

    /// Parses a faulty item: its head, and its body piece by piece.
    fn faulty_item(&mut self, range: Range<usize>) -> Item {
        if self.begins_with(&range, &["if", "for"]) {
            let statement: Stmt = self.faulty_clauses(range).pop().expect("a piece gives a clause");
            return Item { span: statement.span, doc: None, kind: ItemKind::Statement(statement) };
        }
        let bodies = bodies(&self.scan.text, range.clone(), &self.scan.unclosed);
        if let [body] = bodies.as_slice()
            && !self.has_value_body(&range, body)
        {
            let header = self.emptied(&range, &bodies);
            let item = self.limited(range.end, |this| this.parsed_item(&header, range.start));
            if let Some(mut item) = item {
                self.fill_item(&mut item, body.clone());
                return item;
            }
            let head = range.start..body.start - 1;
            let misspelt = self.explain(Rule::chunk, &header, &head, BodyKind::Items);
            let mended = misspelt.and_then(|word| {
                self.with_keyword(word, &header, &range, |this, text, start| this.parsed_item(text, start))
            });
            return match mended {
                Some(mut item) => {
                    self.fill_item(&mut item, body.clone());
                    item
                }
                None => self.error_item(range),
            };
        }
        let misspelt = self.explain_item(&range);
        let text = self.scan.text[range.clone()].to_string();
        let mended = misspelt.and_then(|word| {
            self.with_keyword(word, &text, &range, |this, text, start| this.parsed_item(text, start))
        });
        if let Some(item) = mended {
            return item;
        }
        self.with_faulty_value(&range, |this, text, start| this.parsed_item(text, start))
            .unwrap_or_else(|| self.error_item(range))
    }

    /// Returns true if a range begins with one of the words.
    fn begins_with(&self, range: &Range<usize>, words: &[&str]) -> bool {
        let first = tokens(&self.scan.text, range.clone()).first().copied();
        first.is_some_and(|token| words.contains(&&self.scan.text[token.start..token.end]))
    }

    /// Returns true if a `{ }` is a block after `=` and not the body of the item.
    fn has_value_body(&self, range: &Range<usize>, body: &Range<usize>) -> bool {
        let before = tokens(&self.scan.text, range.start..body.start - 1);
        before.last().is_some_and(|token| matches!(&self.scan.text[token.start..token.end], "=" | "=>"))
            || self.value_start(range).is_some_and(|value| value < body.start)
    }

    /// Returns the single item of a text, if it can be parsed.
    fn parsed_item(&mut self, text: &str, base: usize) -> Option<Item> {
        self.builder.base = base;
        let node = nodes(Rule::chunk, text)?;
        let mut items = Vec::new();
        self.builder.chunk(node, &mut items);
        if items.len() == 1 { items.pop() } else { None }
    }

    /// Parses the body of an item whose head was parsed with an empty body.
    fn fill_item(&mut self, item: &mut Item, body: Range<usize>) {
        match &mut item.kind {
            ItemKind::Module(module) => module.clauses = self.body(body),
            ItemKind::Config(config) => config.clauses = self.body(body),
            ItemKind::Truss(truss) => truss.body = TrussBody::Clauses(self.body(body)),
            ItemKind::Test(test) => test.body = self.body(body),
            ItemKind::Connector(connector) => {
                connector.clauses = vec![ConnectorClause::Error];
                self.explain_item(&self.item_range(item.span));
            }
            _ => {
                self.explain_item(&self.item_range(item.span));
                self.note_unread(&self.item_range(item.span));
                item.kind = ItemKind::Error;
            }
        }
    }

    fn item_range(&self, span: Span) -> Range<usize> {
        span.start as usize..(span.end as usize).min(self.scan.text.len())
    }

    /// Explains a faulty item at the innermost faulty piece.
    fn explain_item(&mut self, range: &Range<usize>) -> Option<Misspelt> {
        if let Some(value) = self.block_value(range) {
            drop(self.body::<Stmt>(value));
            return None;
        }
        let text = self.scan.text[range.clone()].to_string();
        self.explain(Rule::chunk, &text, range, BodyKind::Items)
    }

    /// Parses a piece `text` that begins at the start of `range`, with its misspelt first word replaced by the
    /// keyword that was meant: so what it declares is known, and its own mistakes are found.
    fn with_keyword<T>(
        &mut self,
        word: Misspelt,
        text: &str,
        range: &Range<usize>,
        parsed: impl std::ops::FnOnce(&mut Self, &str, usize) -> Option<T>,
    ) -> Option<T> {
        let rest = text.get(word.end.checked_sub(range.start)?..).filter(|_| word.start == range.start)?;
        let length = word.end - word.start;
        let longer = word.meant.len().saturating_sub(length);
        let text = format!("{:length$}{rest}", word.meant);
        let before = (self.builder.longer, self.builder.least);
        (self.builder.longer, self.builder.least) = (longer, range.start);
        let node = self.limited(range.end, |this| parsed(this, &text, range.start));
        (self.builder.longer, self.builder.least) = before;
        node
    }

    /// Returns the inside of the block after `=` that ends a piece; `None` if none does.
    fn block_value(&self, range: &Range<usize>) -> Option<Range<usize>> {
        let start = self.value_start(range)?;
        let first = *tokens(&self.scan.text, start..range.end).first()?;
        let whole = bodies(&self.scan.text, start..range.end, &self.scan.unclosed);
        match whole.as_slice() {
            [body] if body.start == first.start + 1 && body.end + 1 == range.end => Some(body.clone()),
            _ => None,
        }
    }

    /// Parses the clauses of a body, piece by piece.
    fn body<C: Clause>(&mut self, range: Range<usize>) -> Vec<C> {
        if self.depth >= BODIES_MAX {
            return self.piece(range);
        }
        self.depth += 1;
        let pieces = split(&self.scan.text, range, C::BODY_KIND.keywords(), &self.scan.unclosed);
        let clauses = pieces.into_iter().flat_map(|piece| self.piece(piece)).collect();
        self.depth -= 1;
        clauses
    }

    /// Parses one piece of a body.
    fn piece<C: Clause>(&mut self, range: Range<usize>) -> Vec<C> {
        if !self.faults(&range).iter().any(|fault| fault.fatal) {
            let text = &self.scan.text[range.clone()];
            if let Some(clauses) = self.parsed::<C>(text, range.start) {
                return clauses;
            }
        }
        self.faulty_clauses(range)
    }

    /// Returns the clauses of a text, if it can be parsed.
    fn parsed<C: Clause>(&mut self, text: &str, base: usize) -> Option<Vec<C>> {
        self.builder.base = base;
        Some(C::build(&mut self.builder, nodes(C::RULE, text)?))
    }

    /// Parses a faulty piece: its head, and its bodies piece by piece. Returns at least one clause.
    fn faulty_clauses<C: Clause>(&mut self, range: Range<usize>) -> Vec<C> {
        let bodies = bodies(&self.scan.text, range.clone(), &self.scan.unclosed);
        if self.begins_with(&range, &["if", "for"]) && self.depth < BODIES_MAX {
            let header = self.emptied(&range, &bodies);
            let clauses = self.limited(range.end, |this| this.parsed::<C>(&header, range.start));
            let clause = clauses.and_then(|mut clauses| clauses.pop());
            if let Some(mut clause) = clause.filter(|_| !bodies.is_empty())
                && self.fill(&mut clause, bodies)
            {
                return vec![clause];
            }
        }
        let misspelt = match self.block_value(&range) {
            Some(value) => {
                drop(self.body::<Stmt>(value));
                None
            }
            None => {
                let text = self.scan.text[range.clone()].to_string();
                self.explain(C::RULE, &text, &range, C::BODY_KIND)
            }
        };
        if let Some(clauses) = misspelt.and_then(|word| self.with_keywords(word, &range)) {
            return clauses;
        }
        let clause = self.with_faulty_value(&range, |this, text, start| this.parsed::<C>(text, start)?.pop());
        vec![clause.unwrap_or_else(|| {
            self.note_unread(&range);
            C::error(self.span(&range))
        })]
    }

    /// Parses the clauses of a piece up to a misspelt keyword, and those from it on as if it were not.
    fn with_keywords<C: Clause>(&mut self, word: Misspelt, range: &Range<usize>) -> Option<Vec<C>> {
        let before = self.scan.text[range.start..word.start].trim_end().to_string();
        let rest = word.start..range.end;
        let bodies = match word.meant {
            "if" | "for" if self.depth < BODIES_MAX => {
                bodies(&self.scan.text, rest.clone(), &self.scan.unclosed)
            }
            _ => Vec::new(),
        };
        let text = self.emptied(&rest, &bodies);
        let mut mended =
            self.with_keyword(word, &text, &rest, |this, text, start| this.parsed::<C>(text, start))?;
        if let Some(last) = mended.last_mut().filter(|_| !bodies.is_empty()) {
            self.fill(last, bodies);
        }
        let mut clauses = self.parsed::<C>(&before, range.start)?;
        clauses.append(&mut mended);
        (!clauses.is_empty()).then_some(clauses)
    }

    /// Parses clauses into the emptied bodies of a clause; returns false if their number differs.
    fn fill<C: Clause>(&mut self, clause: &mut C, ranges: Vec<Range<usize>>) -> bool {
        let mut bodies = clause.bodies();
        // Without a last `else` its body stays empty.
        let fits = ranges.len() == bodies.len() || ranges.len() + 1 == bodies.len();
        if fits {
            for (body, range) in bodies.iter_mut().zip(ranges) {
                **body = self.body(range);
            }
        }
        fits
    }

    /// Returns the text of a piece with its bodies emptied, closed if the end is missing.
    fn emptied(&self, range: &Range<usize>, bodies: &[Range<usize>]) -> String {
        let mut text = String::new();
        let mut at = range.start;
        for body in bodies {
            text.push_str(&self.scan.text[at..body.start]);
            text.extend(std::iter::repeat_n(' ', body.len()));
            if body.end == range.end {
                text.push('}');
            }
            at = body.end;
        }
        text.push_str(&self.scan.text[at..range.end]);
        text
    }

    /// Parses a piece with the value after `=` replaced by a hole, so that its name is declared; `None` if that
    /// fails, too.
    fn with_faulty_value<T>(
        &mut self,
        range: &Range<usize>,
        parsed: impl std::ops::FnOnce(&mut Self, &str, usize) -> Option<T>,
    ) -> Option<T> {
        let value = self.value_start(range)?;
        let text = format!("{}_", &self.scan.text[range.start..value]);
        self.builder.faulty_value = Some(value);
        let told = self.builder.diagnostics.len();
        let node = self.limited(value, |this| parsed(this, &text, range.start));
        self.builder.diagnostics.truncate(told);
        self.builder.faulty_value = None;
        node
    }

    /// Builds with all spans cut at the offset `limit`.
    fn limited<T>(&mut self, limit: usize, build: impl std::ops::FnOnce(&mut Self) -> T) -> T {
        let before = std::mem::replace(&mut self.builder.limit, limit);
        let built = build(self);
        self.builder.limit = before;
        built
    }

    /// Returns the offset after the first `=` outside all brackets; `None` if there is none.
    fn value_start(&self, range: &Range<usize>) -> Option<usize> {
        let mut depth = 0usize;
        for token in tokens(&self.scan.text, range.clone()) {
            match &self.scan.text[token.start..token.end] {
                "(" | "[" | "{" => depth += 1,
                ")" | "]" | "}" => depth = depth.saturating_sub(1),
                "=" if depth == 0 => return Some(token.end),
                _ => {}
            }
        }
        None
    }

    /// Returns the faults of a range that have been reported.
    fn faults(&self, range: &Range<usize>) -> &'t [Fault] {
        let faults = &self.scan.faults;
        let start = faults.partition_point(|fault| fault.at < range.start);
        let end = faults.partition_point(|fault| fault.at < range.end);
        &faults[start..end.max(start)]
    }

    /// Returns the span of a range.
    fn span(&self, range: &Range<usize>) -> Span {
        whole_characters(self.builder.text, Span::new(self.builder.file, range.start, range.end))
    }

    /// Records the names that a piece would have declared: those after a declaring word that begins a line, or all
    /// names of an import.
    fn note_unread(&mut self, range: &Range<usize>) {
        let text = &self.scan.text;
        let within = Lexer::new(&text[..range.end], range.start);
        let words: Vec<Token> = within.filter(|token| token.kind == TokenKind::Word).collect();
        let is = |token: &Token, list: &[&str]| list.contains(&&text[token.start..token.end]);
        let begins_line = |token: &Token| text[..token.start].trim_end_matches([' ', '\t']).ends_with('\n');
        let import = words.first().is_some_and(|first| is(first, &["use"]));
        let declared = words.windows(2).filter(|pair| {
            import
                || is(&pair[0], words::DECLARING)
                    && (begins_line(&pair[0]) || pair[0].start == words[0].start)
        });
        let names: Vec<Span> = declared.map(|pair| self.span(&(pair[1].start..pair[1].end))).collect();
        for name in names {
            let name = self.builder.symbol(name);
            self.builder.unread.push(name);
        }
    }

    /// Returns the item that marks an error.
    fn error_item(&mut self, range: Range<usize>) -> Item {
        self.note_unread(&range);
        Item { span: self.span(&range), doc: None, kind: ItemKind::Error }
    }

    /// Reports why a piece cannot be parsed, unless a fault in it was reported. Returns the misspelt keyword if
    /// that is the reason.
    fn explain(&mut self, rule: Rule, text: &str, range: &Range<usize>, place: BodyKind) -> Option<Misspelt> {
        let rest = self.scan.text[range.end..].bytes();
        let blank = rest.take_while(|byte| matches!(byte, b' ' | b'\t')).count();
        // A character replaced by a blank after the piece belongs to it.
        let told = !self.faults(&(range.start..range.end + blank)).is_empty();
        if told || self.builder.diagnostics.len() >= DIAGNOSTICS_MAX {
            return None;
        }
        let failure = failure(rule, text)?;
        let whole = &self.scan.text;
        let (mut diagnostic, misspelt) =
            explain(&failure, text, range.start, place, whole, self.builder.file);
        for label in &mut diagnostic.labels {
            label.span = whole_characters(self.builder.text, label.span);
        }
        self.builder.diagnostics.push(diagnostic);
        misspelt
    }
}
