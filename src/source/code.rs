//! The stable codes of all diagnostics, each with its title and its page in `docs/errors/`.

/// A stable code of a diagnostic, such as `E0201`. Codes of errors begin with `E`, those of lints (warnings) with `W`,
/// those of notes with `N`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Code(pub &'static str);

impl std::fmt::Display for Code {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(self.0)
    }
}

macro_rules! codes {
    ($($name:ident = $code:literal, $title:literal;)*) => {
        $(#[doc = $title] pub const $name: Code = Code($code);)*
        /// Every code of a diagnostic with its title, in the order of the lists in `source/code.rs`: errors, then
        /// lints, then notes.
        pub const ALL: &[(Code, &str)] = &[$((Code($code), $title)),*];
    };
}

codes! {
    // E00xx: text and syntax.
    SYNTAX = "E0001", "syntax error";
    NOT_UTF8 = "E0002", "the file is not UTF-8 text";
    BAD_CHARACTER = "E0003", "a character that has no place in a program";
    UNCLOSED = "E0004", "a bracket, text or comment that is never closed";
    TOO_DEEP = "E0005", "nested too deeply";
    TOO_LARGE = "E0006", "the text is too large";
    BAD_ESCAPE = "E0007", "an escape that text does not know";
    BAD_NUMBER = "E0008", "a number that cannot be read";
    LINE_BREAK = "E0009", "an expression that a line break cuts in two";
    LATER = "E0010", "a part of the language that is not built yet";
    // E01xx: names, files and imports.
    UNKNOWN_NAME = "E0101", "no such name";
    DECLARED_TWICE = "E0102", "a name declared twice in one scope";
    UNKNOWN_IMPORT = "E0103", "the imported file or item does not exist";
    IMPORT_CYCLE = "E0104", "files that import each other in a circle";
    OUTSIDE_PROJECT = "E0105", "a path that leads out of the project";
    PRIVATE_NAME = "E0106", "a name that is private to its file";
    UNKNOWN_MEMBER = "E0107", "no such joint, port, part or field";
    DECLARATION_CYCLE = "E0108", "declarations that need each other";
    // E02xx: types and units.
    DIMENSION_MISMATCH = "E0201", "a quantity of another dimension is wanted";
    TYPE_MISMATCH = "E0202", "a value of another type is wanted";
    UNKNOWN_UNIT = "E0203", "no such unit";
    NOT_CALLABLE = "E0204", "a call of something that cannot be called";
    ARGUMENTS = "E0205", "arguments that do not fit the parameters";
    UNKNOWN_CHOICE = "E0206", "a word that is none of the choices";
    OPERANDS = "E0207", "an operator that does not apply to its operands";
    AMBIGUOUS_MEMBER = "E0208", "a name that is both a joint and a port";
    NOT_A_TYPE = "E0209", "a name that is no type";
    CANNOT_INFER = "E0210", "a type that must be written";
    BAD_STUDY = "E0211", "a study that is not sound";
    // E03xx: modules, configurations, lattices, trusses.
    PORT_TAKEN = "E0301", "a port that is taken already";
    NO_MATE = "E0302", "connectors that do not mate";
    BAD_TURN = "E0303", "a turn that the connector does not allow";
    LOOP = "E0304", "connections that close a loop";
    NOT_CONNECTED = "E0305", "parts that nothing connects";
    LOOP_RESIDUAL = "E0306", "a closed loop that does not meet";
    BAD_MODULE = "E0307", "a module declaration that is not sound";
    REQUIREMENT = "E0308", "a requirement that does not hold";
    OUT_OF_RANGE = "E0309", "a joint position outside the joint's range";
    BAD_CONNECTOR = "E0310", "a connector declaration that is not sound";
    NOT_RIGID = "E0311", "a truss that is not rigid";
    BAD_TRUSS = "E0312", "a truss declaration that is not sound";
    BAD_LATTICE = "E0313", "a lattice that is empty, disconnected or malformed";
    BAD_SHAPE = "E0314", "a shape that is not sound";
    NO_HINGE = "E0315", "a connection that has no joint";
    NO_MODULES = "E0316", "a configuration without modules";
    SCENE_ONLY = "E0317", "what only a scene has";
    SCENE_PART = "E0318", "a scene as a part";
    ONE_PLACE = "E0319", "robots at one place";
    PLACED_TWICE = "E0320", "a robot that is placed twice";
    // E04xx: behaviours.
    CONFLICT = "E0401", "two commands to one joint at one time";
    TOO_FAST = "E0402", "a speed that the joint cannot reach";
    PASSIVE_JOINT = "E0403", "a command to a joint that has no motor";
    FOLLOW_JUMP = "E0404", "a motion that does not begin where the joint is";
    BAD_ACTION = "E0405", "an action that cannot be carried out";
    OTHER_ROBOT = "E0406", "a behaviour of another robot";
    NOT_AT_REST = "E0407", "a plan that does not end at rest";
    ABORTED = "E0408", "a behaviour that aborted";
    BAD_DOCK = "E0409", "a docking that cannot happen";
    NO_MATCH = "E0410", "plans that do not fit together";
    CONTRACT_PLACE = "E0411", "a contract where no behaviour begins or ends";
    // E05xx: evaluation and its limits.
    INDEX = "E0501", "an index outside the list";
    DIVISION_BY_ZERO = "E0502", "a division by zero";
    RECURSION_LIMIT = "E0503", "recursion deeper than the limit";
    STEP_LIMIT = "E0504", "more evaluation steps than the limit";
    SIZE_LIMIT = "E0505", "a value larger than the limit";
    BAD_VALUE = "E0506", "a value that the function cannot take";
    EXPECTATION = "E0507", "an expectation that does not hold";
    LOST_VALUE = "E0508", "a value that was lost: a defect of modl";
    NO_MEMORY = "E0509", "too little memory to evaluate";
    NO_ROW = "E0510", "a row of a study that was not computed";
    MEMORY_LIMIT = "E0511", "more memory than the limit";
    // E06xx: verification.
    COLLISION = "E0601", "two modules meet";
    FALL = "E0602", "the robot falls";
    OVERLOAD = "E0603", "a joint that would have to hold more than it can";
    LIMIT_EXCEEDED = "E0604", "a joint driven past its limits";
    BOND_OVERLOAD = "E0605", "a connection loaded beyond what it holds";
    DOCK_MISS = "E0606", "a docking outside the connector's capture";
    PENETRATION = "E0607", "a link below the ground";
    FALLS_APART = "E0608", "a robot that falls apart";
    UNSTABLE = "E0609", "a robot that is not stable";
    CLOSURE = "E0610", "a closed loop that is torn";
    NOT_VERIFIED = "E0611", "a plan that could not be verified";
    TRAVEL_UNDETERMINED = "E0612", "a travel that friction does not determine";
    REQUIRED_START = "E0613", "a behaviour that begins where it may not";
    ENSURED_END = "E0614", "a behaviour that does not bring about what it ensures";
    OFF_PATH = "E0615", "a port that leaves its stated path";
    // E07xx: plan files and output.
    OUTSIDE_OUTPUT = "E0701", "an output path that leads out of the output folder";
    CANNOT_WRITE = "E0702", "a file that cannot be written";
    CANNOT_READ = "E0703", "a file that cannot be read";
    BAD_PLAN_FILE = "E0704", "a plan file that is not sound";
    NOT_EXPORTED = "E0705", "a plan that a format cannot hold";
    BAD_ROBOT_MAP = "E0706", "a robot map that does not fit the plan";
    NOT_IMPORTED = "E0707", "a robot of another program that cannot be taken in";
    // E08xx: planners.
    NO_WAY = "E0801", "shapes that no plan leads between";
    NOT_COVERED = "E0802", "a problem that the planner does not cover";
    UNFOLDABLE = "E0803", "a shape that panels do not fold into";
    TOO_HEAVY = "E0804", "a load that no slowness makes lighter";
    UNREACHABLE = "E0805", "a place that a port cannot reach";
    NOT_FREE = "E0806", "a way that begins or ends where bodies meet";
    NO_FREE_WAY = "E0807", "no free way found";
    // W0xxx: lints and notes.
    NAME_STYLE = "W0001", "a name in another style";
    UNIT_SHADOWED = "W0002", "a unit that has the name of a variable";
    EQUAL_SETPOINTS = "W0003", "the same command twice at one time";
    UNNEEDED_EXEMPTION = "W0004", "an exemption that was not needed";
    JOINT_OVERLAP = "W0005", "links that overlap within the range of their joint";
    OPEN_LOOP = "W0006", "a connection in a file whose docks do not meet";
    SHORT_OF_GOAL = "W0007", "a plan that ends short of its goal";
    COMMENT_DIVIDES = "W0008", "a comment where a quotient may be meant";
    THIN_LINK = "W0009", "a link thinner than what counts as a touch";
    NOTHING_SHOWN = "W0010", "a program with nothing to show";
    START_SETTLES = "N0001", "the robot settles at the start";
}
