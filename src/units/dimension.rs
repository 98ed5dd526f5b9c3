//! Dimensions of quantities: exponents of length, mass, time and angle.

/// A physical dimension: a product of powers of metre, kilogram, second and radian. Angle is a dimension of its own,
/// so that degrees never meet plain numbers silently.
///
/// Dimensions are equal if their exponents are: an energy and a torque are one dimension, and only shown in other
/// units.
#[derive(Clone, Copy, Debug, Default)]
pub struct Dimension {
    /// The exponent of the metre.
    pub length: i8,
    /// The exponent of the kilogram.
    pub mass: i8,
    /// The exponent of the second.
    pub time: i8,
    /// The exponent of the radian.
    pub angle: i8,
    /// The exponent of the dimension parameter of the function whose body is being checked, a dimension of which
    /// nothing else is known; 0 everywhere else, and in every value.
    pub param: i8,
    /// True for what was declared an energy, or written in joules: it has the dimension of a torque, and is shown in
    /// joules. Sums of energies and their products with plain numbers are energies; any other result is shown by its
    /// exponents alone.
    pub energy: bool,
}

impl PartialEq for Dimension {
    fn eq(&self, other: &Dimension) -> bool {
        self.exponents() == other.exponents()
    }
}

impl Eq for Dimension {}

const fn dim(length: i8, mass: i8, time: i8, angle: i8) -> Dimension {
    Dimension { length, mass, time, angle, param: 0, energy: false }
}

/// The dimensions that programs can write by name, each as (name, dimension). Torque and energy are one dimension
/// under two names.
pub const NAMED: &[(&str, Dimension)] = &[
    ("Number", Dimension::NUMBER),
    ("Length", Dimension::LENGTH),
    ("Angle", Dimension::ANGLE),
    ("Time", Dimension::TIME),
    ("Mass", Dimension::MASS),
    ("Speed", dim(1, 0, -1, 0)),
    ("AngularSpeed", dim(0, 0, -1, 1)),
    ("Acceleration", dim(1, 0, -2, 0)),
    ("AngularAcceleration", dim(0, 0, -2, 1)),
    ("Force", dim(1, 1, -2, 0)),
    ("Torque", Dimension::TORQUE),
    ("Energy", Dimension::ENERGY),
    ("Power", dim(2, 1, -3, 0)),
    ("Area", dim(2, 0, 0, 0)),
    ("Volume", dim(3, 0, 0, 0)),
    ("Frequency", dim(0, 0, -1, 0)),
];

impl Dimension {
    /// The dimension parameter of a function, as it stands in the function's body: a dimension of which nothing is
    /// known.
    pub const PARAM: Dimension = Dimension { param: 1, ..Dimension::NUMBER };
    /// The dimension of a plain number: all exponents are 0.
    pub const NUMBER: Dimension = dim(0, 0, 0, 0);
    /// The dimension of a length, m.
    pub const LENGTH: Dimension = dim(1, 0, 0, 0);
    /// The dimension of a mass, kg.
    pub const MASS: Dimension = dim(0, 1, 0, 0);
    /// The dimension of a time, s.
    pub const TIME: Dimension = dim(0, 0, 1, 0);
    /// The dimension of an angle, rad.
    pub const ANGLE: Dimension = dim(0, 0, 0, 1);
    /// The dimension of a speed, m/s.
    pub const SPEED: Dimension = dim(1, 0, -1, 0);
    /// The dimension of an angular speed, rad/s.
    pub const ANGULAR_SPEED: Dimension = dim(0, 0, -1, 1);
    /// The dimension of an acceleration, m/s².
    pub const ACCELERATION: Dimension = dim(1, 0, -2, 0);
    /// The dimension of an angular acceleration, rad/s².
    pub const ANGULAR_ACCELERATION: Dimension = dim(0, 0, -2, 1);
    /// The dimension of a force, N.
    pub const FORCE: Dimension = dim(1, 1, -2, 0);
    /// The dimension of a torque, N·m; an energy has the same exponents, and is shown in N·m unless it is declared as
    /// one.
    pub const TORQUE: Dimension = dim(2, 1, -2, 0);
    /// The dimension of an energy, J: that of a torque, shown in joules.
    pub const ENERGY: Dimension = Dimension { energy: true, ..Dimension::TORQUE };
    /// The dimension of an angular momentum, N·m·s.
    pub const ANGULAR_MOMENTUM: Dimension = dim(2, 1, -1, 0);
    /// The dimension of a frequency, Hz.
    pub const FREQUENCY: Dimension = dim(0, 0, -1, 0);

    /// Returns the dimension of this name in [`NAMED`], such as `AngularSpeed`; `None` if none has it.
    pub fn named(name: &str) -> Option<Dimension> {
        NAMED.iter().find(|(n, _)| *n == name).map(|(_, d)| *d)
    }

    /// Returns the name of this dimension that programs can write, such as `AngularSpeed`; `Energy` only for one that
    /// is shown in joules; `None` if it has none.
    pub fn name(self) -> Option<&'static str> {
        NAMED.iter().find(|(_, d)| d.is_shown_as(self)).map(|(n, _)| *n)
    }

    /// Returns true if both are the same dimension and shown in the same units: an energy is shown in joules, a
    /// torque in N·m.
    pub fn is_shown_as(self, other: Dimension) -> bool {
        self == other && self.energy == other.energy
    }

    /// Returns the dimension of a product, an energy if one factor is and the other is a plain number; `None` when an
    /// exponent leaves -128..=127.
    pub fn times(self, other: Dimension) -> Option<Dimension> {
        let energy =
            (self.energy && other == Dimension::NUMBER) || (other.energy && self == Dimension::NUMBER);
        Some(Dimension { energy, ..self.combine(other, i8::checked_add)? })
    }

    /// Returns the dimension of a quotient, an energy if that is divided by a plain number; `None` when an exponent
    /// leaves -128..=127.
    pub fn over(self, other: Dimension) -> Option<Dimension> {
        let energy = self.energy && other == Dimension::NUMBER;
        Some(Dimension { energy, ..self.combine(other, i8::checked_sub)? })
    }

    /// Returns the dimension of the `n`th power of a quantity: every exponent times `n`; `None` when an exponent
    /// leaves -128..=127.
    pub fn power(self, n: i64) -> Option<Dimension> {
        let scaled = |exponent: i8| i8::try_from(i64::from(exponent).checked_mul(n)?).ok();
        Some(Dimension { energy: self.energy && n == 1, ..self.map(scaled)? })
    }

    /// Returns the dimension whose `n`th power this is: every exponent divided by `n`; `None` where one is not a
    /// multiple of it, or `n` is 0.
    pub fn root(self, n: i8) -> Option<Dimension> {
        let part = |exponent: i8| (exponent.checked_rem(n)? == 0).then(|| exponent.checked_div(n))?;
        Some(Dimension { energy: self.energy && n == 1, ..self.map(part)? })
    }

    /// Returns the exponents, which say what dimension it is.
    fn exponents(self) -> [i8; 5] {
        [self.length, self.mass, self.time, self.angle, self.param]
    }

    /// Returns the dimension with `op` of each exponent, no energy; `None` where `op` has no answer.
    fn map(self, op: impl Fn(i8) -> Option<i8>) -> Option<Dimension> {
        Some(Dimension {
            length: op(self.length)?,
            mass: op(self.mass)?,
            time: op(self.time)?,
            angle: op(self.angle)?,
            param: op(self.param)?,
            energy: false,
        })
    }

    fn combine(self, o: Dimension, op: fn(i8, i8) -> Option<i8>) -> Option<Dimension> {
        Some(Dimension {
            length: op(self.length, o.length)?,
            mass: op(self.mass, o.mass)?,
            time: op(self.time, o.time)?,
            angle: op(self.angle, o.angle)?,
            param: op(self.param, o.param)?,
            energy: false,
        })
    }

    /// Returns true if a quantity of this dimension may stand where `wanted` is: the same dimension, or one that
    /// positive powers of the radian were dropped from. Radians are dropped, never invented, and only if a length or a
    /// mass remains: `2rad/s * 45mm` is a speed, but an angle is not a number and an angular speed not a frequency.
    /// Nothing is dropped in a dimension with a dimension parameter, of which too little is known.
    pub fn fits(self, wanted: Dimension) -> bool {
        self == wanted
            || (self.angle > 0
                && wanted.angle == 0
                && self.param == 0
                && (self.length != 0 || self.mass != 0)
                && Dimension { angle: 0, ..self } == wanted)
    }

    /// Returns the dimension that quantities of both fit, the one without radians, an energy only if both are; `None`
    /// if there is none.
    pub fn common(self, other: Dimension) -> Option<Dimension> {
        let energy = self.energy && other.energy;
        if self.fits(other) {
            Some(Dimension { energy, ..other })
        } else if other.fits(self) {
            Some(Dimension { energy, ..self })
        } else {
            None
        }
    }
}
