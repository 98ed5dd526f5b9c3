//! The instrumented text of a file: all its drawn mutants in one, of which an environment variable chooses one at run time.

use crate::mutant::{Form, Mutant, Piece};
use std::ops::Range;

/// The place of a mutant in the instrumented text, in bytes. A mutant within others stands there several times.
pub struct Placed {
    /// The number of the mutant.
    pub id: usize,
    /// What stands in place of the original.
    pub mutated: Range<usize>,
    /// That and the original.
    pub whole: Range<usize>,
}

/// Returns the text of a file with mutants in it, and where they stand. `mutants`: those of the file, each with its number.
pub fn file(text: &str, mutants: &[(usize, &Mutant)]) -> (String, Vec<Placed>) {
    let mut sorted = mutants.to_vec();
    sorted.sort_by_key(|(id, mutant)| (mutant.range.start, usize::MAX - mutant.range.end, *id));
    let mut writer = Writer { text, out: String::new(), placed: Vec::new() };
    writer.source(0..text.len(), &sorted);
    (writer.out, writer.placed)
}

struct Writer<'a> {
    text: &'a str,
    out: String,
    placed: Vec<Placed>,
}

impl Writer<'_> {
    /// Writes a range of the file with the mutants within it.
    fn source(&mut self, range: Range<usize>, mutants: &[(usize, &Mutant)]) {
        let Some(((id, mutant), rest)) = mutants.split_first() else {
            self.out.push_str(&self.text[range]);
            return;
        };
        let own = mutant.range.clone();
        self.out.push_str(&self.text[range.start..own.start]);
        // Of the mutants after it, those within it come first.
        let inner =
            rest.iter().take_while(|(_, other)| other.range.end <= own.end && !own.is_empty()).count();
        let (within, after) = rest.split_at(inner);
        self.mutant(*id, mutant, within);
        self.source(own.end..range.end, after);
    }

    fn mutant(&mut self, id: usize, mutant: &Mutant, within: &[(usize, &Mutant)]) {
        let begin = self.out.len();
        let mutated;
        match mutant.form {
            Form::Expression => {
                self.out.push_str(&format!("(if crate::modl_mutant::on({id}) {{ "));
                mutated = self.pieces(mutant, within);
                self.out.push_str(" } else { ");
                self.source(mutant.range.clone(), within);
                self.out.push_str(" })");
            }
            Form::Omission => {
                self.out.push_str(&format!("if !crate::modl_mutant::on({id}) {{ "));
                self.source(mutant.range.clone(), within);
                mutated = begin..self.out.len();
                self.out.push_str(" }");
            }
            Form::Head => {
                self.out.push_str(&format!(" if crate::modl_mutant::on({id}) {{ "));
                mutated = self.pieces(mutant, within);
                self.out.push_str(" } ");
            }
        }
        self.placed.push(Placed { id, mutated, whole: begin..self.out.len() });
    }

    fn pieces(&mut self, mutant: &Mutant, within: &[(usize, &Mutant)]) -> Range<usize> {
        let begin = self.out.len();
        for piece in &mutant.pieces {
            match piece {
                Piece::Text(text) => self.out.push_str(text),
                Piece::Source(range) => {
                    let fits = |(_, other): &&(usize, &Mutant)| {
                        range.start <= other.range.start && other.range.end <= range.end
                    };
                    let inner: Vec<_> = within.iter().filter(fits).copied().collect();
                    self.source(range.clone(), &inner);
                }
            }
        }
        begin..self.out.len()
    }
}

/// Returns the module that the instrumented library gets: which of `count` mutants is chosen. Its environment variables:
/// `MODL_MUTANT`, a number; `MODL_MUTANTS_REACHED`, a file that gets the number of each mutant which is reached.
pub fn chooser(count: usize) -> String {
    format!(
        r#"
#[doc(hidden)]
#[allow(warnings)]
pub mod modl_mutant {{
    use std::sync::atomic::{{AtomicBool, AtomicU32, Ordering::Relaxed}};

    const UNREAD: u32 = u32::MAX;
    const RECORDS: u32 = u32::MAX - 1;
    static CHOSEN: AtomicU32 = AtomicU32::new(UNREAD);
    static REACHED: [AtomicBool; {len}] = [const {{ AtomicBool::new(false) }}; {len}];

    #[inline(always)]
    pub fn on(id: u32) -> bool {{
        let chosen = CHOSEN.load(Relaxed);
        if chosen < RECORDS {{ chosen == id }} else {{ unusual(chosen, id) }}
    }}

    #[cold]
    #[inline(never)]
    fn unusual(chosen: u32, id: u32) -> bool {{
        if chosen == UNREAD {{
            let number = std::env::var("MODL_MUTANT").ok().and_then(|text| text.parse().ok());
            let records = std::env::var_os("MODL_MUTANTS_REACHED").is_some();
            CHOSEN.store(if records {{ RECORDS }} else {{ number.unwrap_or(0) }}, Relaxed);
            return on(id);
        }}
        if !REACHED[id as usize].swap(true, Relaxed) {{
            use std::io::Write as _;
            let path = std::env::var_os("MODL_MUTANTS_REACHED").expect("it was there");
            let file = std::fs::OpenOptions::new().append(true).create(true).open(path);
            file.expect("the file can be opened").write_all(format!("{{id}}\n").as_bytes()).expect("it can be written");
        }}
        false
    }}
}}
"#,
        len = count + 1
    )
}
