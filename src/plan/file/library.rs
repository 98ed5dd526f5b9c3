//! The names that stand in a plan file for the indices inside its library.

use crate::plan::stated::Stated;
use crate::robot::{Library, ModuleType};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The names of what the indices inside the library stand for, in the order of the library.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(rename = "LibraryNames", deny_unknown_fields)]
pub(super) struct LibraryNamesJson {
    connectors: Vec<ConnectorNames>,
    modules: Vec<ModuleNames>,
}

#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(rename = "ConnectorNames", deny_unknown_fields)]
struct ConnectorNames {
    name: String,
    /// The connectors it mates with.
    mates: Vec<String>,
}

#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(rename = "ModuleNames", deny_unknown_fields)]
struct ModuleNames {
    name: String,
    links: Vec<String>,
    joints: Vec<JointNames>,
    ports: Vec<PortNames>,
}

#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(rename = "JointNames", deny_unknown_fields)]
struct JointNames {
    name: String,
    /// The proximal link of the joint.
    parent: String,
    /// The link that the joint carries.
    child: String,
}

#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(rename = "PortNames", deny_unknown_fields)]
struct PortNames {
    name: String,
    link: String,
    connector: String,
}

impl LibraryNamesJson {
    /// Returns the names of what the indices inside a library stand for; that of an index that points nowhere is
    /// empty.
    pub(super) fn of(library: &Library) -> LibraryNamesJson {
        let connector = |index: usize| {
            library.connectors.get(index).map_or_else(String::new, |connector| connector.name.clone())
        };
        let connectors = library.connectors.iter().map(|c| ConnectorNames {
            name: c.name.clone(),
            mates: c.mates.iter().map(|&mate| connector(mate)).collect(),
        });
        LibraryNamesJson {
            connectors: connectors.collect(),
            modules: library.modules.iter().map(|module| ModuleNames::of(module, connector)).collect(),
        }
    }

    /// Adds the names to `stated`, in the order of the library.
    pub(super) fn names(&self, stated: &mut Stated) {
        for connector in &self.connectors {
            stated.add("connector", &connector.name);
            stated.add_all("mate", &connector.mates);
        }
        for module in &self.modules {
            stated.add("module type", &module.name);
            stated.add_all("declared link", &module.links);
            for joint in &module.joints {
                stated.add("declared joint", &joint.name);
                stated.add("the parent of declared joint", &joint.parent);
                stated.add("the child of declared joint", &joint.child);
            }
            for port in &module.ports {
                stated.add("declared port", &port.name);
                stated.add("the link of declared port", &port.link);
                stated.add("the connector of declared port", &port.connector);
            }
        }
    }
}

impl ModuleNames {
    fn of(module: &ModuleType, connector: impl Fn(usize) -> String) -> ModuleNames {
        let link = |index: usize| module.links.get(index).map_or_else(String::new, |link| link.name.clone());
        let joints = module.joints.iter().map(|joint| JointNames {
            name: joint.name.clone(),
            parent: link(joint.parent),
            child: link(joint.child),
        });
        let ports = module.ports.iter().map(|port| PortNames {
            name: port.name.clone(),
            link: link(port.link),
            connector: connector(port.connector),
        });
        ModuleNames {
            name: module.name.clone(),
            links: module.links.iter().map(|link| link.name.clone()).collect(),
            joints: joints.collect(),
            ports: ports.collect(),
        }
    }
}
