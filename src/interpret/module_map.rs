//! The modules of a robot that an instance within it consists of.

use std::rc::Rc;

/// The map from the modules of an instance, in the order of its own design, to those of its robot. Those of a part
/// follow each other; those of an embedding lie where the match has them.
#[derive(Clone, Debug)]
pub struct ModuleMap {
    /// The index in the robot of each module of the embedding that the instance belongs to; `None` where modules
    /// follow each other.
    images: Option<Rc<[usize]>>,
    /// The index of the instance's first module: in `images`, else in the robot.
    first: usize,
}

impl ModuleMap {
    /// Returns the map of a whole robot, each of whose modules is itself.
    pub fn whole() -> ModuleMap {
        ModuleMap { images: None, first: 0 }
    }

    /// Returns the map of an embedding, given the index in the robot of each of its modules.
    pub fn embedding(images: Vec<usize>) -> ModuleMap {
        ModuleMap { images: Some(images.into()), first: 0 }
    }

    /// Returns the map of a part, given the index of the part's first module among those of the instance.
    pub fn part(&self, offset: usize) -> ModuleMap {
        ModuleMap { images: self.images.clone(), first: self.first + offset }
    }

    /// Returns the index in the robot of a module of the instance, both from 0. Panics if the instance is of an
    /// embedding that has no such module.
    pub fn index(&self, module: usize) -> usize {
        let at = self.first + module;
        self.images.as_ref().map_or(at, |images| images[at])
    }

    /// Returns the indices in the robot of the first `count` modules of the instance, in their order. Panics as
    /// [`index`](Self::index) does.
    pub fn indices(&self, count: usize) -> impl Iterator<Item = usize> {
        (0..count).map(|module| self.index(module))
    }

    /// Returns true if the first `count` modules of two instances of a robot are the same, in their order.
    pub fn is_same(&self, other: &ModuleMap, count: usize) -> bool {
        self.indices(count).eq(other.indices(count))
    }

    /// Returns true if the instance is an embedding, or a part of one.
    pub fn is_embedding(&self) -> bool {
        self.images.is_some()
    }
}
