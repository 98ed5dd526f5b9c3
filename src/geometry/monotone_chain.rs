//! Convex hulls in a plane by Andrew's monotone chain.

/// Returns the corners of the convex hull of points of a plane, counter-clockwise, of points in order along an axis, and along
/// the other where they are level (Andrew 1979): two of points on a line, none of fewer than two. `turns_left`: true if the
/// way over three points, in order, turns left; what is within rounding of straight ahead is the caller's to say.
pub fn monotone_chain<P: Copy>(sorted: &[P], turns_left: impl Fn(P, P, P) -> bool) -> Vec<P> {
    let side = |points: &mut dyn Iterator<Item = P>| {
        let mut side: Vec<P> = Vec::new();
        for point in points {
            while let [.., a, b] = side[..]
                && !turns_left(a, b, point)
            {
                side.pop();
            }
            side.push(point);
        }
        side.pop();
        side
    };
    let mut corners = side(&mut sorted.iter().copied());
    corners.extend(side(&mut sorted.iter().rev().copied()));
    corners
}
