//! The Sobol sequence, with the direction numbers of Joe and Kuo, "Constructing Sobol sequences with better
//! two-dimensional projections", SIAM Journal on Scientific Computing 30 (2008), 2635-2654 (`new-joe-kuo-6`).

/// The bits of a coordinate.
const BITS: u32 = 32;

/// For each coordinate from the second: the degree of its primitive polynomial, the polynomial's inner coefficients as
/// bits, and its initial direction numbers.
const DIRECTIONS: &[(u32, u32, &[u32])] = &[
    (1, 0, &[1]),
    (2, 1, &[1, 3]),
    (3, 1, &[1, 3, 1]),
    (3, 2, &[1, 1, 1]),
    (4, 1, &[1, 1, 3, 3]),
    (4, 4, &[1, 3, 5, 13]),
    (5, 2, &[1, 1, 5, 5, 17]),
    (5, 4, &[1, 1, 5, 5, 5]),
    (5, 7, &[1, 1, 7, 11, 19]),
    (5, 11, &[1, 1, 5, 1, 1]),
    (5, 13, &[1, 1, 1, 3, 11]),
    (5, 14, &[1, 3, 5, 5, 31]),
    (6, 1, &[1, 3, 3, 9, 7, 49]),
    (6, 13, &[1, 1, 1, 15, 21, 21]),
    (6, 16, &[1, 3, 1, 13, 27, 49]),
    (6, 19, &[1, 1, 1, 15, 7, 5]),
    (6, 22, &[1, 3, 1, 15, 13, 25]),
    (6, 25, &[1, 1, 5, 5, 19, 61]),
    (7, 1, &[1, 3, 7, 11, 23, 15, 103]),
    (7, 4, &[1, 3, 7, 13, 13, 15, 69]),
];

/// The greatest number of coordinates of a point.
pub const COORDINATES_MAX: usize = DIRECTIONS.len() + 1;
/// The number of points of the sequence.
pub const POINTS_MAX: u64 = 1 << BITS;

/// Returns a coordinate of a point of the Sobol sequence, in [0, 1): the first point is 0 in all of them. Points come in
/// the order of their Gray codes (Antonov and Saleev 1979), as is usual. `index`: the number of the point, from 0, below
/// [`POINTS_MAX`]; `coordinate`: below [`COORDINATES_MAX`]. Panics beyond that.
pub fn sobol(index: u64, coordinate: usize) -> f64 {
    assert!(index < POINTS_MAX, "the sequence has 2^32 points");
    let gray = index ^ (index >> 1);
    let mut bits = 0;
    for bit in (0..BITS).filter(|bit| gray >> bit & 1 == 1) {
        bits ^= direction(coordinate, bit);
    }
    f64::from(bits) / POINTS_MAX as f64
}

/// Returns a direction number of a coordinate, by its index from 0, as a fraction of 2^32.
fn direction(coordinate: usize, index: u32) -> u32 {
    let Some(before) = coordinate.checked_sub(1) else { return 1 << (BITS - 1 - index) };
    let (degree, coefficients, initial) = DIRECTIONS[before];
    let mut numbers: Vec<u32> = initial.iter().zip(1..).map(|(m, k)| m << (BITS - k)).collect();
    // The recurrence of Bratley and Fox (1988), eq. 2.
    while numbers.len() <= index as usize {
        let at = numbers.len();
        let last = numbers[at - degree as usize];
        let mut next = last ^ (last >> degree);
        for k in 1..degree {
            if coefficients >> (degree - 1 - k) & 1 == 1 {
                next ^= numbers[at - k as usize];
            }
        }
        numbers.push(next);
    }
    numbers[index as usize]
}
