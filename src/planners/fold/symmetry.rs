//! Orbits of faces under the isometries of a target: what holds for one root holds for all of its orbit.

use super::polygon;
use super::target::Target;
use super::tolerances::TOLERANCES;
use super::weights::Weights;
use crate::geometry::Vec3;

/// Returns for each face of the target, in their order, the least index of a face of its orbit under the isometries
/// of the target, mirrors included, that keep every weight up to `TOLERANCES.symmetry`; two faces with the same one
/// are equal as roots. `weights`: the costs of the target's hinges for the faces that they carry.
pub fn orbits(target: &Target, weights: &Weights) -> Vec<usize> {
    let n = target.faces.len();
    let outlines: Vec<Outline> = (0..n).map(|face| Outline::of(target.corners(face))).collect();
    let mut first: Vec<usize> = (0..n).collect();
    let scale = weights.greatest();
    // The isometries that map face 0 to itself, and one for each face to which another carries it, generate
    // all.
    for face in 0..n {
        crate::interrupt::checkpoint();
        let sides = target.side_count(face);
        if sides != target.side_count(0) {
            continue;
        }
        for (turn, mirrored) in (0..2 * sides).map(|i| (i % sides, i >= sides)) {
            if face > 0 && find(&mut first, face) == find(&mut first, 0) {
                break;
            }
            let image = (face, turn, mirrored);
            let Some((faces, hinges)) = isometry(target, &outlines, image) else { continue };
            if keeps(weights, &faces, &hinges, scale) {
                for (from, &to) in faces.iter().enumerate() {
                    let (a, b) = (find(&mut first, from), find(&mut first, to));
                    let least = a.min(b);
                    (first[a], first[b]) = (least, least);
                }
            }
        }
    }
    (0..n).map(|face| find(&mut first, face)).collect()
}

/// Returns the representative of a face's orbit (union-find), and shortens the path to it.
fn find(first: &mut [usize], face: usize) -> usize {
    let mut at = face;
    while first[at] != at {
        at = first[at];
    }
    first[face] = at;
    at
}

/// The lengths that tell a face from others, m.
struct Outline {
    sides: Vec<f64>,
    /// The diagonal across side k and the next; of a triangle, its third side.
    diagonals: Vec<f64>,
}

impl Outline {
    fn of(corners: &[Vec3]) -> Outline {
        Outline { sides: polygon::sides(corners), diagonals: polygon::diagonals(corners) }
    }
}

fn equal(a: f64, b: f64) -> bool {
    (a - b).abs() <= TOLERANCES.symmetry * (a.abs() + b.abs() + f64::MIN_POSITIVE)
}

/// A face with the number of its side that is the image of side 0, and true if sides are counted backwards
/// from there.
type Image = (usize, usize, bool);

/// Returns the side that is the image of side `k` of a face with so many sides.
fn side(image: Image, k: usize, sides: usize) -> usize {
    let (_, turn, mirrored) = image;
    if mirrored { (turn + sides - k) % sides } else { (turn + k) % sides }
}

/// Returns the images of faces and hinges when face 0 goes to the given image; `None` where that is no isometry.
fn isometry(target: &Target, outlines: &[Outline], image: Image) -> Option<(Vec<usize>, Vec<usize>)> {
    let n = target.faces.len();
    let mut images: Vec<Option<Image>> = vec![None; n];
    images[0] = Some(image);
    let mut hinges = vec![0; target.hinges.len()];
    let mut waiting = vec![0];
    while let Some(face) = waiting.pop() {
        let to = images[face].expect("it was given one");
        let (from, goal) = (&outlines[face], &outlines[to.0]);
        let sides = from.sides.len();
        if sides != goal.sides.len() {
            return None;
        }
        for k in 0..sides {
            let there = side(to, k, sides);
            // Seen in a mirror, the diagonal across a side and the next is that across it and the one before.
            let across_two = side(to, if to.2 { k + 1 } else { k }, sides);
            if !(equal(from.sides[k], goal.sides[there])
                && equal(from.diagonals[k], goal.diagonals[across_two]))
            {
                return None;
            }
            let (from, goal) = match (target.sides[face][k], target.sides[to.0][there]) {
                (None, None) => continue,
                (Some(from), Some(goal)) => (from, goal),
                _ => return None,
            };
            let turned = target.hinges[from].angle - target.hinges[goal].angle;
            if turned.abs() > TOLERANCES.symmetry {
                return None;
            }
            hinges[from] = goal;
            let (next, m) = across(target, from, face, k);
            let (other, there) = across(target, goal, to.0, there);
            // Side `m` of the next face is to become side `there` of the other.
            let sides = target.side_count(other);
            let turn = if to.2 { (there + m) % sides } else { (there + sides - m % sides) % sides };
            let wanted = (other, turn, to.2);
            match images[next] {
                Some(known) if known != wanted => return None,
                Some(_) => {}
                None => {
                    images[next] = Some(wanted);
                    waiting.push(next);
                }
            }
        }
    }
    Some((images.into_iter().map(|i| i.expect("the target is connected").0).collect(), hinges))
}

/// Returns the face across a side, with the number that the side has there.
fn across(target: &Target, hinge: usize, face: usize, side: usize) -> (usize, usize) {
    let hinge = &target.hinges[hinge];
    let own = usize::from(!(hinge.faces[0] == face && hinge.sides[0] == side));
    (hinge.faces[1 - own], hinge.sides[1 - own])
}

/// Returns true if an isometry, given by the images of faces and hinges, keeps every weight.
fn keeps(weights: &Weights, faces: &[usize], hinges: &[usize], scale: f64) -> bool {
    hinges.iter().enumerate().all(|(hinge, &to)| {
        faces.iter().enumerate().all(|(face, &goal)| {
            (weights.at(hinge, face) - weights.at(to, goal)).abs() <= TOLERANCES.symmetry * scale
        })
    })
}
