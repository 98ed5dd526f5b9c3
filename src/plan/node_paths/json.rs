//! Node paths as they stand in a plan file.

use super::limits::{Surroundings, TrussLimits};
use super::motion::{Keyframe, NodePaths};
use crate::plan::stated::Stated;
use crate::robot::Library;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// A truss whose nodes move between keyframes, on straight lines or as one rigid body.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(rename = "NodePaths", deny_unknown_fields)]
pub(in crate::plan) struct NodePathsJson<'a> {
    /// Index in the library's `struts`.
    strut: usize,
    /// The name of that strut type.
    strut_name: String,
    node_names: Cow<'a, [String]>,
    /// Pairs of nodes.
    struts: Cow<'a, [(usize, usize)]>,
    /// The names of the nodes at the ends of each strut.
    strut_ends: Vec<(String, String)>,
    /// The keyframes, in order of time; the first at 0.
    keyframes: Cow<'a, [Keyframe]>,
    /// The limits beside those of its struts.
    #[serde(default, skip_serializing_if = "is_no_limit")]
    limits: Cow<'a, TrussLimits>,
    #[serde(default, skip_serializing_if = "is_nothing_around")]
    surroundings: Cow<'a, Surroundings>,
}

fn is_no_limit(limits: &TrussLimits) -> bool {
    limits.is_none()
}

fn is_nothing_around(surroundings: &Surroundings) -> bool {
    surroundings.is_none()
}

impl<'a> NodePathsJson<'a> {
    /// Returns node paths as they stand in a plan file, with names out of `library`; long lists are borrowed.
    pub(in crate::plan) fn of(paths: &'a NodePaths, library: &Library) -> NodePathsJson<'a> {
        let strut = library.struts.get(paths.strut);
        let node = |index: usize| paths.node_names.get(index).cloned().unwrap_or_default();
        NodePathsJson {
            strut: paths.strut,
            strut_name: strut.map_or_else(String::new, |strut| strut.name.clone()),
            node_names: Cow::Borrowed(&paths.node_names),
            struts: Cow::Borrowed(&paths.struts),
            strut_ends: paths.struts.iter().map(|&(a, b)| (node(a), node(b))).collect(),
            keyframes: Cow::Borrowed(&paths.keyframes),
            limits: Cow::Borrowed(&paths.limits),
            surroundings: Cow::Borrowed(&paths.surroundings),
        }
    }

    /// Adds the names that the file states beside indices to `stated`, in the order of the file.
    pub(in crate::plan) fn names(&self, stated: &mut Stated) {
        stated.add("strut type", &self.strut_name);
        for (a, b) in &self.strut_ends {
            stated.add("the first node of strut", a);
            stated.add("the second node of strut", b);
        }
    }

    /// Returns the node paths that stand in a file; nothing is checked.
    pub(in crate::plan) fn into_node_paths(self) -> NodePaths {
        NodePaths {
            strut: self.strut,
            node_names: self.node_names.into_owned(),
            struts: self.struts.into_owned(),
            keyframes: self.keyframes.into_owned(),
            limits: self.limits.into_owned(),
            surroundings: self.surroundings.into_owned(),
        }
    }
}
