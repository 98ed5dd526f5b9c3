//! What is around a truss: solids that its struts keep away from, and ground that is not flat.

use crate::geometry::closest_points::segment_part;
use crate::geometry::{HeightField, Part, SignedDistance, Solid, Vec3};

/// The ground that the middle of a truss goes up and down with is evened out over so many places around.
const AROUND: [[f64; 2]; 9] = [
    [0.0, 0.0],
    [1.0, 0.0],
    [-1.0, 0.0],
    [0.0, 1.0],
    [0.0, -1.0],
    [0.7, 0.7],
    [0.7, -0.7],
    [-0.7, 0.7],
    [-0.7, -0.7],
];

/// In the world's frame.
#[derive(Clone, Debug, Default)]
pub struct Surroundings {
    /// Convex parts, with the obstacle that each belongs to.
    pub parts: Vec<(usize, Part)>,
    /// At height 0 where there is none.
    pub terrain: Option<HeightField>,
    /// Struts may be so far below the ground that nodes stand on, m: nodes are thicker. Planners leave a
    /// little of it.
    pub sink: f64,
    /// The greatest slope and height of the terrain.
    pub steepest: f64,
    pub highest: f64,
}

impl Surroundings {
    pub fn new(obstacles: &[Solid], terrain: Option<HeightField>, sink: f64) -> Surroundings {
        let parts = obstacles.iter().enumerate();
        let steepest = terrain.as_ref().map_or(0.0, HeightField::steepest);
        let heights = terrain.iter().flat_map(|terrain| &terrain.heights).copied();
        Surroundings {
            parts: parts
                .flat_map(|(i, solid)| solid.parts.iter().map(move |part| (i, part.clone())))
                .collect(),
            sink,
            steepest,
            highest: heights.reduce(f64::max).unwrap_or(0.0),
            terrain,
        }
    }

    /// How far a point is above the ground, m.
    pub fn above(&self, p: Vec3) -> f64 {
        self.terrain.as_ref().map_or(p.z, |terrain| terrain.above(p))
    }

    /// How that changes with the point.
    pub fn upward(&self, p: Vec3) -> Vec3 {
        let slope = self.terrain.as_ref().map_or([0.0; 2], |terrain| terrain.slope(p.x, p.y));
        Vec3::new(-slope[0], -slope[1], 1.0)
    }

    /// How much higher the ground is from one place to another, evened out over a radius, m.
    pub fn rise(&self, from: [f64; 2], to: [f64; 2], radius: f64) -> f64 {
        let Some(terrain) = &self.terrain else { return 0.0 };
        let at = |place: [f64; 2]| {
            let heights =
                AROUND.iter().map(|d| terrain.height(place[0] + radius * d[0], place[1] + radius * d[1]));
            heights.sum::<f64>() / AROUND.len() as f64
        };
        at(to) - at(from)
    }

    /// How near a strut is to a part, and the direction from the strut to it; more than `enough` need not
    /// be told exactly.
    pub fn nearness(&self, strut: (Vec3, Vec3), part: usize, enough: f64) -> SignedDistance {
        segment_part(strut, &self.parts[part].1, enough)
    }

    /// Whether a strut of which no point is farther than `reach` from where it is here may meet a part.
    pub fn may_meet(&self, (a, b): (Vec3, Vec3), part: usize, reach: f64) -> bool {
        let part = &self.parts[part].1;
        ((a + b) / 2.0 - part.centre).norm() - (b - a).norm() / 2.0 - part.radius <= reach
    }
}
