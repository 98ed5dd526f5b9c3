//! The answer of `modl study`, as JSON.

use serde::Serialize;
use serde_json::{Map, Value};
use std::collections::BTreeMap;

/// The answer of the command about a study, as JSON.
#[derive(Debug, Serialize)]
pub(in crate::cli) struct JsonStudy {
    /// The name of the study.
    pub name: String,
    /// The digest of all that its rows depend on.
    pub hash: String,
    /// The number of rows.
    pub rows: u64,
    /// The number of rows that are computed.
    pub computed: u64,
    /// The folder of the shards.
    pub folder: String,
    /// The table; `None` if it is not complete.
    pub table: Option<String>,
    /// The number of rows without values, by the code of their errors; `None` if the table is not complete.
    pub failed: Option<BTreeMap<String, u64>>,
    /// The first row that is best; `None` for other samplers than a search.
    pub best: Option<u64>,
    /// The files in the folder that are no shards of the study, each with the reason.
    pub strangers: Vec<(String, String)>,
    /// The row that was computed alone.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub row: Option<JsonRow>,
}

/// A row, as JSON.
#[derive(Debug, Serialize)]
pub(in crate::cli) struct JsonRow {
    /// The number of the row.
    pub row: u64,
    /// The axes and the fields, each with its value: quantities in SI units, `null` for what is missing.
    pub cells: Map<String, Value>,
    /// The code of the error for which the row has no values; empty if it has.
    pub code: String,
    /// The message of that error.
    pub message: String,
    /// The pages that were written.
    pub pages: Vec<String>,
}
