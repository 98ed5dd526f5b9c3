//! The arguments of a call before defaults are filled in.

use super::value::Value;
use crate::source::Span;

/// Arguments in the order of the parameters; `None`: the default is wanted.
pub struct Args {
    /// The arguments.
    pub values: Vec<Option<Value>>,
    /// The span of each argument; of the whole call for those left out.
    pub spans: Vec<Span>,
}

impl Args {
    /// Returns arguments that all stand at one span.
    pub fn plain(values: Vec<Value>, span: Span) -> Args {
        let spans = vec![span; values.len()];
        Args { values: values.into_iter().map(Some).collect(), spans }
    }
}
