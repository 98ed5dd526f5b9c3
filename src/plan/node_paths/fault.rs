//! The faults of the plans of trusses.

use crate::geometry::Unsound;
use crate::units::{Dimension, quantity};
use std::fmt;

/// A fault of the plan of a truss.
#[derive(Clone, Debug, PartialEq)]
pub enum NodePathsFault {
    /// A first keyframe at another time than 0.
    FirstKeyframe,
    /// A keyframe without one position for each node.
    KeyframeNodes {
        /// The time of the keyframe, s.
        time: f64,
        /// The number of nodes, which is the number of positions that the keyframe must have.
        nodes: usize,
    },
    /// A step that lasts less than a tick: cutting and reversing could leave nothing of it.
    ShortStep {
        /// The time of the keyframe at which the step ends, s.
        time: f64,
    },
    /// A roll about two nodes that are one.
    RollEdge {
        /// The time of the keyframe at which the roll ends, s.
        time: f64,
    },
    /// A roll about two nodes at one position.
    RollLength {
        /// The time of the keyframe at which the roll ends, s.
        time: f64,
    },
    /// A velocity profile that no step from rest to rest has a piece of, or one of a roll.
    Ramps {
        /// The time of the keyframe at which the step ends, s.
        time: f64,
    },
    /// A strut between a node and itself.
    StrutEnds,
    /// More events than a plan may have.
    EventCount {
        /// The number of events.
        count: usize,
        /// The greatest number.
        most: usize,
    },
    /// Nodes that ride along at the start and are not in ascending order, each once.
    MergedOrder,
    /// A node that rides along at the start with itself, by way of others or not.
    RidesOnItself {
        /// The name of the node.
        node: String,
    },
    /// A node that rides along at the start and has struts.
    RiderWithStruts {
        /// The name of the node.
        node: String,
    },
    /// An event before the one in front of it, or at no keyframe.
    EventTime {
        /// The time of the event, s.
        time: f64,
    },
    /// A node that merges, and is merged into another already.
    MergesTwice {
        /// The time of the event, s.
        time: f64,
        /// The name of the node.
        node: String,
    },
    /// A node that merges into itself, or into one that rides along with it.
    MergesIntoItself {
        /// The time of the event, s.
        time: f64,
        /// The name of the node.
        node: String,
    },
    /// A node that merges or splits off, and has no struts then.
    WithoutStruts {
        /// The time of the event, s.
        time: f64,
        /// The name of the node.
        node: String,
    },
    /// Two nodes that merge, and are joined by a strut.
    MergesStrut {
        /// The time of the event, s.
        time: f64,
        /// The name of the strut.
        strut: String,
    },
    /// Two struts that have the same ends, at the start of a plan whose topology changes, or after an event.
    DoubleStrut {
        /// The time from which they have them, s.
        time: f64,
        /// The name of the strut.
        strut: String,
    },
    /// A node that splits off, and is merged into no other.
    SplitsNothing {
        /// The time of the event, s.
        time: f64,
        /// The name of the node.
        node: String,
    },
    /// The struts of a split that are not in ascending order, each once.
    SplitOrder {
        /// The time of the event, s.
        time: f64,
        /// The name of the node.
        node: String,
    },
    /// A strut that a node takes along as it splits off, and that does not end there.
    SplitsElsewhere {
        /// The time of the event, s.
        time: f64,
        /// The name of the strut.
        strut: String,
        /// The name of the node at which it would have to end.
        node: String,
    },
    /// Nodes that merge or are merged and are not in one place.
    Apart {
        /// The time of the keyframe, s.
        time: f64,
        /// The name of the node that is merged.
        node: String,
        /// The name of the node that it is merged into.
        into: String,
        /// The distance of the two, m.
        distance: f64,
    },
    /// An obstacle that is not a solid, with the fault of its shape.
    Obstacle(Unsound),
    /// A height field that is no ground; the fault is given in words.
    Terrain(&'static str),
}

impl fmt::Display for NodePathsFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            NodePathsFault::FirstKeyframe => write!(f, "the first keyframe must be at 0"),
            NodePathsFault::KeyframeNodes { time, nodes } => {
                write!(f, "at {time} s there are not {nodes} nodes")
            }
            NodePathsFault::ShortStep { time } => write!(f, "the step to {time} s lasts less than 15 ps"),
            NodePathsFault::RollEdge { time } => write!(f, "the roll to {time} s is about no edge"),
            NodePathsFault::RollLength { time } => {
                write!(f, "the roll to {time} s is about an edge without length")
            }
            NodePathsFault::Ramps { time } => {
                write!(f, "the ramps to {time} s fit no step from rest to rest")
            }
            NodePathsFault::StrutEnds => write!(f, "a strut begins and ends at one node"),
            NodePathsFault::EventCount { count, most } => {
                write!(f, "nodes merge and split {count} times; a plan has up to {most} such events")
            }
            NodePathsFault::MergedOrder => {
                write!(f, "the nodes that ride along at the start are not in ascending order, each once")
            }
            NodePathsFault::RidesOnItself { node } => write!(f, "the node {node} rides along with itself"),
            NodePathsFault::RiderWithStruts { node } => {
                write!(f, "the node {node} rides along with another, and has struts of its own")
            }
            NodePathsFault::EventTime { time } => {
                write!(
                    f,
                    "nodes merge or split at {time} s, which is no keyframe, or before the event in front of it"
                )
            }
            NodePathsFault::MergesTwice { time, node } => {
                write!(f, "the node {node} merges at {time} s, and is merged already")
            }
            NodePathsFault::MergesIntoItself { time, node } => {
                write!(f, "the node {node} merges into itself at {time} s")
            }
            NodePathsFault::WithoutStruts { time, node } => {
                write!(f, "the node {node} merges or splits off at {time} s without any strut")
            }
            NodePathsFault::MergesStrut { time, strut } => {
                write!(f, "the nodes of the strut {strut} merge at {time} s, which leaves it no length")
            }
            NodePathsFault::DoubleStrut { time, strut } => {
                write!(f, "from {time} s on the strut {strut} is there twice")
            }
            NodePathsFault::SplitsNothing { time, node } => {
                write!(f, "the node {node} splits off at {time} s, and is merged into no other")
            }
            NodePathsFault::SplitOrder { time, node } => {
                write!(
                    f,
                    "the struts that {node} takes along at {time} s are not in ascending order, each once"
                )
            }
            NodePathsFault::SplitsElsewhere { time, strut, node } => {
                write!(f, "the strut {strut}, which is to be taken along at {time} s, does not end at {node}")
            }
            NodePathsFault::Apart { time, node, into, distance } => {
                let distance = quantity(*distance, Dimension::LENGTH);
                write!(f, "at {time} s the node {node} is {distance} from {into}, with which it is merged")
            }
            NodePathsFault::Obstacle(fault) => write!(f, "an obstacle: {fault}"),
            NodePathsFault::Terrain(fault) => f.write_str(fault),
        }
    }
}
