//! The surroundings of a truss: solids that its struts keep clear of, and ground that is not flat.

use crate::geometry::closest_points::segment_part;
use crate::geometry::{HeightField, Part, SignedDistance, Solid, Vec3};

/// Sample points of a disc of radius 1 over which the height of the ground is averaged.
const DISC: [[f64; 2]; 9] = [
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

/// The obstacles and the terrain around a truss in the world's frame, prepared for distance queries. The default is
/// flat ground at height 0 without obstacles.
#[derive(Clone, Debug, Default)]
pub struct Surroundings {
    /// The convex parts of all obstacles, in the world's frame, each with the index of its obstacle, from 0.
    pub parts: Vec<(usize, Part)>,
    /// The ground as a height field in the world's frame; `None` for a plane at height 0.
    pub terrain: Option<HeightField>,
    /// The depth to which the axes of struts may be below the ground that nodes stand on, m, since nodes are thicker
    /// than struts. Planners leave the tolerance `ground_margin` of it unused.
    pub sink_depth: f64,
    /// The greatest slope of the terrain, height over distance, without unit; 0 without terrain.
    pub slope_max: f64,
    /// The greatest height of the terrain, m; 0 without terrain.
    pub height_max: f64,
}

impl Surroundings {
    /// Returns obstacles and terrain, both in the world's frame, prepared for distance queries; `sink_depth`: the
    /// depth to which struts may be below the ground, m. The terrain must be sound ([`HeightField::fault`]).
    pub fn new(obstacles: &[Solid], terrain: Option<HeightField>, sink_depth: f64) -> Surroundings {
        let parts = obstacles.iter().enumerate();
        let slope_max = terrain.as_ref().map_or(0.0, HeightField::steepest);
        let heights = terrain.iter().flat_map(|terrain| &terrain.heights).copied();
        Surroundings {
            parts: parts
                .flat_map(|(i, solid)| solid.parts.iter().map(move |part| (i, part.clone())))
                .collect(),
            sink_depth,
            slope_max,
            height_max: heights.reduce(f64::max).unwrap_or(0.0),
            terrain,
        }
    }

    /// Returns the height of a point (m, in the world's frame) above the ground, measured along z, m; negative below.
    pub fn height(&self, p: Vec3) -> f64 {
        self.terrain.as_ref().map_or(p.z, |terrain| terrain.above(p))
    }

    /// Returns the gradient of [`height`](Surroundings::height) over the point, without unit; its z component is 1.
    pub fn height_gradient(&self, p: Vec3) -> Vec3 {
        let slope = self.terrain.as_ref().map_or([0.0; 2], |terrain| terrain.slope(p.x, p.y));
        Vec3::new(-slope[0], -slope[1], 1.0)
    }

    /// Returns the normal of the ground below a point, a unit vector in the world's frame.
    pub fn normal(&self, p: Vec3) -> Vec3 {
        self.height_gradient(p).normalize()
    }

    /// Returns the rise of the ground from one point (x, y) to another, m, each height averaged over a disc of the
    /// given radius, m; 0 without terrain.
    pub fn ground_rise(&self, from: [f64; 2], to: [f64; 2], radius: f64) -> f64 {
        let Some(terrain) = &self.terrain else { return 0.0 };
        let at = |place: [f64; 2]| {
            let heights =
                DISC.iter().map(|d| terrain.height(place[0] + radius * d[0], place[1] + radius * d[1]));
            heights.sum::<f64>() / DISC.len() as f64
        };
        at(to) - at(from)
    }

    /// Returns the signed distance between a strut, given by its ends (m), and the part at index `part` of
    /// [`Surroundings::parts`], with its direction, as [`segment_part`] does; distances beyond `enough` (m) may be
    /// returned too small, but not below `enough`. Panics if there is no such part.
    pub fn signed_distance(&self, strut: (Vec3, Vec3), part: usize, enough: f64) -> SignedDistance {
        segment_part(strut, &self.parts[part].1, enough)
    }

    /// Returns false if the bounding spheres of a strut, given by its ends (m), and of the part at index `part` of
    /// [`Surroundings::parts`] are farther apart than `reach`, m. Panics if there is no such part.
    pub fn may_collide(&self, (a, b): (Vec3, Vec3), part: usize, reach: f64) -> bool {
        let part = &self.parts[part].1;
        ((a + b) / 2.0 - part.centre).norm() - (b - a).norm() / 2.0 - part.radius <= reach
    }
}
