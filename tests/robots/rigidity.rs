//! Rigidity of trusses of many nodes, held against a singular value decomposition.

use modl::geometry::Vec3;
use modl::robot::truss::rigidity;
use nalgebra::DMatrix;

type Truss = (Vec<Vec3>, Vec<(usize, usize)>);

/// Nodes of a grid, each moved a little, with a strut between any two that are near: more than enough.
fn grid(across: usize) -> Truss {
    let moved = |k: usize| (k.wrapping_mul(2_654_435_761) % 1000) as f64 / 1000.0 * 0.2;
    let mut nodes = Vec::new();
    for x in 0..across {
        for y in 0..across {
            for z in 0..across {
                let k = nodes.len() * 3;
                nodes.push(Vec3::new(x as f64 + moved(k), y as f64 + moved(k + 1), z as f64 + moved(k + 2)));
            }
        }
    }
    let near = |a: usize, b: usize| (nodes[a] - nodes[b]).norm() < 1.75;
    let struts = (0..nodes.len()).flat_map(|b| (0..b).map(move |a| (a, b))).filter(|&(a, b)| near(a, b));
    let struts = struts.collect();
    (nodes, struts)
}

/// Each node held by the three before it: as many struts as are needed.
fn helix(count: usize) -> Truss {
    let turn = libm::acos(-2.0 / 3.0);
    let radius = 3.0 * libm::sqrt(3.0) / 10.0;
    let place = |i: usize| {
        let angle = i as f64 * turn;
        Vec3::new(radius * libm::cos(angle), radius * libm::sin(angle), i as f64 / libm::sqrt(10.0))
    };
    let nodes: Vec<Vec3> = (0..count).map(place).collect();
    let struts = (0..count).flat_map(|b| (b.saturating_sub(3)..b).map(move |a| (a, b))).collect();
    (nodes, struts)
}

/// Rank, least singular value that is not zero, and struts that others can stand in for.
fn decomposed((nodes, struts): &Truss) -> (usize, f64, Vec<usize>) {
    let mean = struts.iter().map(|&(a, b)| (nodes[a] - nodes[b]).norm()).sum::<f64>() / struts.len() as f64;
    let mut matrix = DMatrix::zeros(struts.len(), 3 * nodes.len());
    for (row, &(a, b)) in struts.iter().enumerate() {
        for k in 0..3 {
            let d = (nodes[a] - nodes[b])[k] / mean;
            (matrix[(row, 3 * a + k)], matrix[(row, 3 * b + k)]) = (d, -d);
        }
    }
    let svd = matrix.svd(true, false);
    let u = svd.u.expect("asked for");
    let kept: Vec<usize> =
        (0..svd.singular_values.len()).filter(|&i| svd.singular_values[i] > 1e-9).collect();
    let weakest = kept.iter().map(|&i| svd.singular_values[i]).fold(f64::INFINITY, f64::min);
    let share = |strut: usize| kept.iter().map(|&i| u[(strut, i)] * u[(strut, i)]).sum::<f64>();
    let redundant = (0..struts.len()).filter(|&s| share(s) < 1.0 - 1e-9).collect();
    (kept.len(), weakest, redundant)
}

#[track_caller]
fn agrees(truss: &Truss) {
    let (rank, weakest, redundant) = decomposed(truss);
    let found = rigidity(&truss.0, &truss.1);
    assert!(found.rigid() && found.rank == rank && found.rank_rigid == 3 * truss.0.len() - 6, "{found:?}");
    assert!((found.weakest / weakest - 1.0).abs() < 1e-6, "{} or {weakest}", found.weakest);
    assert_eq!(found.redundant, redundant);
    assert_eq!(found.self_stresses, truss.1.len() - rank);
}

#[test]
fn many_nodes_hold_each_other_as_a_decomposition_says() {
    let (mut nodes, mut struts) = grid(5);
    // A tip that three struts hold: none can stand in for another.
    nodes.push(Vec3::new(2.0, 2.0, 5.5));
    let tip = nodes.len() - 1;
    let mut near: Vec<usize> = (0..tip).collect();
    near.sort_by(|&a, &b| (nodes[a] - nodes[tip]).norm().total_cmp(&(nodes[b] - nodes[tip]).norm()));
    // The nearest three lie on a line.
    struts.extend([near[0], near[1], near[3]].map(|a| (a, tip)));
    let braced = (nodes, struts);
    let spare = rigidity(&braced.0, &braced.1).redundant;
    assert!((braced.1.len() - 3..braced.1.len()).all(|strut| !spare.contains(&strut)) && !spare.is_empty());
    agrees(&braced);
    agrees(&helix(100));
}

#[test]
fn a_long_truss_that_lacks_a_strut_is_not_rigid() {
    let (nodes, mut struts) = helix(90);
    struts.remove(140);
    let found = rigidity(&nodes, &struts);
    assert_eq!((found.rank, found.free.len()), (3 * 90 - 7, 1));
}

/// What took more than a minute by a decomposition: it would be noticed.
#[test]
fn four_hundred_nodes_take_no_time_to_speak_of() {
    let (nodes, struts) = helix(400);
    let found = rigidity(&nodes, &struts);
    assert!(found.rigid() && found.redundant.is_empty() && found.rank == 3 * 400 - 6);
    // The weakest motion of a rod that is free at both ends bends it: as the square of its length.
    let (nodes, struts) = helix(200);
    let ratio = rigidity(&nodes, &struts).weakest / found.weakest;
    assert!((3.7..4.1).contains(&ratio), "{ratio}");
}
