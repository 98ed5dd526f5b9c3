//! Colours, the same as those of the page, that people with colour blindness can distinguish.

use crate::robot::Assembly;

/// A colour as red, green and blue in 0..1, sRGB encoded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rgb(pub [f64; 3]);

/// The colours of groups of modules, sRGB: group `i`, from 0, has the colour at `i` modulo the length of the list.
pub(super) const PALETTE: [Rgb; 8] = [
    hex(0x4c75ae),
    hex(0xdaa43d),
    hex(0x519277),
    hex(0xa06182),
    hex(0xa3c8de),
    hex(0xcabe87),
    hex(0x6b6c95),
    hex(0x9cb6a1),
];

/// The colour of modules that a failure names.
pub(super) const FAILED: Rgb = hex(0xcf4520);

/// The colour of the surroundings: obstacles, and ground that is not flat.
pub(super) const AROUND: Rgb = hex(0xb9bbb5);

/// The colour of bare metal: docks, hinges, rods.
pub(super) const METAL: Rgb = hex(0x6b737a);

/// The colour of the nodes of a truss.
pub(super) const NODE: Rgb = hex(0x59626c);

/// A colour scale from cold to warm (after cividis).
const RAMP: [Rgb; 5] = [hex(0x234f85), hex(0x537298), hex(0x828d8c), hex(0xb8a65c), hex(0xecd262)];

/// The brightness offset of each link of a module, by which its links are distinguished.
const SHADES: [f64; 8] = [0.0, 0.22, -0.42, -0.3, -0.3, 0.34, -0.2, 0.12];

/// Returns the colour of `0xrrggbb`.
const fn hex(rgb: u32) -> Rgb {
    Rgb([
        ((rgb >> 16) & 0xff) as f64 / 255.0,
        ((rgb >> 8) & 0xff) as f64 / 255.0,
        (rgb & 0xff) as f64 / 255.0,
    ])
}

impl Rgb {
    /// Returns the linear mixture of two colours in their sRGB values: this one for `part` 0, `other` for 1.
    pub(super) fn mixed(self, other: Rgb, part: f64) -> Rgb {
        Rgb(std::array::from_fn(|i| self.0[i] + (other.0[i] - self.0[i]) * part))
    }

    /// Returns the shade of this module colour for the link of index `link` (from 0) in the module; shades repeat after
    /// eight.
    pub(super) fn shaded(self, link: usize) -> Rgb {
        let shade = SHADES[link % SHADES.len()];
        if shade == 0.0 {
            return self;
        }
        let grey = 0.3 * self.0[0] + 0.6 * self.0[1] + 0.1 * self.0[2];
        let dulled = self.mixed(Rgb([grey; 3]), 0.45);
        Rgb(dulled.0.map(|c| (c * (1.0 + 0.55 * shade)).min(1.0)))
    }

    /// Returns the colour of a number in 0..1 on a scale from cold (blue) to warm (yellow); numbers outside are
    /// clamped.
    pub(super) fn ramp(x: f64) -> Rgb {
        let x = x.clamp(0.0, 1.0) * (RAMP.len() - 1) as f64;
        let i = (x as usize).min(RAMP.len() - 2);
        RAMP[i].mixed(RAMP[i + 1], x - i as f64)
    }

    /// Returns the colour as `#rrggbb`, in hexadecimal digits.
    pub(super) fn code(self) -> String {
        let [r, g, b] = self.0.map(|c| libm::round(c * 255.0) as u8);
        format!("#{r:02x}{g:02x}{b:02x}")
    }
}

/// Returns the group of each module, in the order of the robot's modules; groups are numbered from 0 in order of
/// appearance. Modules are grouped by the first component of their path that is not common to all.
pub(super) fn groups(robot: &Assembly) -> Vec<usize> {
    let paths: Vec<Vec<&str>> = robot.modules.iter().map(|m| m.name.split('.').collect()).collect();
    let same = |step: usize| paths.iter().all(|path| path.len() > step + 1 && path[step] == paths[0][step]);
    let step = if paths.is_empty() { 0 } else { (0..).find(|step| !same(*step)).unwrap_or(0) };
    let mut known: Vec<&str> = Vec::new();
    let mut numbers = Vec::with_capacity(paths.len());
    for name in paths.iter().map(|path| path[step]) {
        let at = known.iter().position(|k| *k == name).unwrap_or_else(|| {
            known.push(name);
            known.len() - 1
        });
        numbers.push(at);
    }
    numbers
}
