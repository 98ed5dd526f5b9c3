//! Shapes of fewer panels than there are: the others hang on in a flat strip.
//!
//! The strip goes on at one side of a face, away from the shape. At a boundary it lies in the plane of that face. A closed
//! surface is slit at two edges about a corner first, and the strip stands there half-way around the outside of the edge, so
//! that it is as far from the faces on either side.

use crate::geometry::Vec3;
use crate::planners::fold::{Target, Unfoldable};

/// Returns two shapes of equally many faces: that with fewer faces has as many more, in a flat strip, behind its own. The
/// faces of both must be equilateral triangles of one size, which is not checked.
///
/// # Errors
/// [`Unfoldable`] if the shape with its strip can't be folded, as none of too many faces can.
pub fn with_equal_counts(from: &Target, to: &Target) -> Result<[Target; 2], Unfoldable> {
    let count = from.faces.len().max(to.faces.len());
    Ok([with_flat_panels(from, count)?, with_flat_panels(to, count)?])
}

/// Returns a shape with a strip that makes it one of `count` faces.
fn with_flat_panels(shape: &Target, count: usize) -> Result<Target, Unfoldable> {
    let more = count.saturating_sub(shape.faces.len());
    if more == 0 || shape.faces.is_empty() {
        return Ok(shape.clone());
    }
    // The side at which the end of the strip is farthest from the middle of the shape.
    let middle = shape.vertices.iter().sum::<Vec3>() / shape.vertices.len() as f64;
    let boundary = shape.sides.iter().flatten().any(Option::is_none);
    let mut farthest: Option<(f64, (usize, usize))> = None;
    for face in 0..shape.faces.len() {
        for side in (0..shape.side_count(face)).filter(|&side| shape.sides[face][side].is_none() == boundary)
        {
            let end = strip(shape, (face, side), more).last().map_or(0.0, |end| (end - middle).norm());
            if farthest.is_none_or(|(most, _)| end > most) {
                farthest = Some((end, (face, side)));
            }
        }
    }
    let place = farthest.expect("every face has sides, and all of them if there is no boundary").1;
    let points = strip(shape, place, more);
    let mut vertices = shape.vertices.clone();
    let mut faces = shape.faces.clone();
    if !boundary {
        slit(shape, place, (&mut vertices, &mut faces));
    }
    let (face, side) = place;
    let corners = &faces[face];
    let (start, end) = (corners[side], corners[(side + 1) % corners.len()]);
    let first = vertices.len();
    vertices.extend(points);
    // Across the side, and then from triangle to triangle: each has the last two points before its own.
    let before = [end, start];
    let point = |index: usize| if index < 2 { before[index] } else { first + index - 2 };
    for index in 0..more {
        let [a, b, c] = [point(index), point(index + 1), point(index + 2)];
        faces.push(if index % 2 == 0 { vec![a, b, c] } else { vec![b, a, c] });
    }
    Target::new(vertices, &faces)
}

/// Returns the points of a strip of `count` triangles on a side of a face, one for each, m.
fn strip(shape: &Target, (face, side): (usize, usize), count: usize) -> Vec<Vec3> {
    let corners = shape.corners(face);
    let (start, end) = (corners[side], corners[(side + 1) % corners.len()]);
    let (normal, along) = (shape.normal(face), end - start);
    let outwards = along.cross(&normal).normalize();
    // Half-way around the outside of an edge with the fold angle a, whose inside is π - a.
    let rise =
        shape.sides[face][side].map_or(0.0, |hinge| 0.5 * (std::f64::consts::PI - shape.hinges[hinge].angle));
    let (sine, cosine) = libm::sincos(rise);
    let height = 0.5 * libm::sqrt(3.0) * along.norm();
    let tip = 0.5 * (start + end) + (outwards * cosine + normal * sine) * height;
    let mut points = vec![end, start, tip];
    while points.len() < count + 2 {
        let [a, b, c] = [3, 2, 1].map(|back| points[points.len() - back]);
        points.push(b + c - a);
    }
    points.split_off(2)
}

/// Slits a closed surface along a side of a face and along the edge across the corner at the end of that side: the faces
/// between the two, half of those about the corner, keep it, and the others get a corner of their own in the same place.
fn slit(
    shape: &Target,
    (face, side): (usize, usize),
    (vertices, faces): (&mut Vec<Vec3>, &mut [Vec<usize>]),
) {
    let corner = shape.faces[face][(side + 1) % shape.side_count(face)];
    // The faces about the corner, beginning with this one and going away from the side.
    let mut around = vec![face];
    let mut leaving = (side + 1) % shape.side_count(face);
    while let Some(hinge) = shape.sides[around[around.len() - 1]][leaving] {
        let next = shape.hinges[hinge].other(around[around.len() - 1]);
        if next == face {
            break;
        }
        let place = shape.faces[next].iter().position(|&other| other == corner);
        leaving = place.expect("the edge across the corner ends there");
        around.push(next);
    }
    let kept = around.len().div_ceil(2);
    for &other in &around[kept..] {
        faces[other].iter_mut().filter(|place| **place == corner).for_each(|place| *place = vertices.len());
    }
    vertices.push(shape.vertices[corner]);
}
