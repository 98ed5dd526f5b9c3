//! Meshes that are hollow: a cube around a closed hollow, and a tub.

use modl::geometry::{Placed, Pose, Shape, Vec3};

fn mesh(name: &str, vertices: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Placed {
    Placed { pose: Pose::identity(), shape: Shape::Mesh { name: name.into(), vertices, triangles } }
}

/// Returns a cube of these half edges, m, around a hollow of those, as a mesh of two surfaces.
pub fn hollow_cube(half: f64, hollow: f64) -> Placed {
    let corner = |i: u8, half: f64| Vec3::from_fn(|axis, _| if i >> axis & 1 == 0 { -half } else { half });
    let vertices = (0..8).map(|i| corner(i, half)).chain((0..8).map(|i| corner(i, hollow))).collect();
    // For each axis the two faces across it, each of two triangles, seen from outside.
    let faces = (0..3).flat_map(|axis| {
        let (u, v) = (1u32 << ((axis + 1) % 3), 1u32 << ((axis + 2) % 3));
        let far = 1u32 << axis;
        [[0, v, u + v], [0, u + v, u], [far, far + u, far + u + v], [far, far + u + v, far + v]]
    });
    let outside: Vec<[u32; 3]> = faces.collect();
    let inside = outside.iter().map(|[a, b, c]| [8 + a, 8 + c, 8 + b]);
    let triangles = outside.iter().copied().chain(inside).collect();
    mesh("hollow.stl", vertices, triangles)
}

/// Returns a box without a lid, open upwards, of 0.2 m by 0.2 m and 0.1 m high on the ground. `inner`: half of the edge of its
/// hollow, `floor`: the height of that above the ground, m; `scale`: a factor on all.
pub fn tub(inner: f64, floor: f64, scale: f64) -> Placed {
    let ring = |half: f64, z: f64| {
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
            .map(|(x, y)| Vec3::new(x * half, y * half, z) * scale)
    };
    let vertices = [ring(0.1, 0.0), ring(0.1, 0.1), ring(inner, 0.1), ring(inner, floor)].concat();
    let mut triangles = vec![[0, 2, 1], [0, 3, 2], [12, 13, 14], [12, 14, 15]];
    for level in 0..3u32 {
        for side in 0..4u32 {
            let (a, b) = (4 * level + side, 4 * level + (side + 1) % 4);
            triangles.extend([[a, b, b + 4], [a, b + 4, a + 4]]);
        }
    }
    mesh("tub.stl", vertices, triangles)
}
