//! What every file sees without a `use`: the built-in functions and the records that they give.
//!
//! Rust supplies the bodies. This file is the only place where a built-in is declared: the type
//! checker, completion, the reference pages and the tests read it.
//!
//! Three things are particular here. `T: Quantity` stands for `Int` or any quantity (an `Int` among
//! numbers becomes a `Number`). `Any` takes a value of any type. A variadic parameter (`...`) takes
//! its values one by one, or as one list.

// Numbers.

/// The distance of a number from zero.
///
/// Example:
/// ```modl
/// print(abs(-3), abs(-2.5mm))
/// ```
extern fn abs<T: Quantity>(x: T) -> T

/// -1, 0 or 1: the sign of a number.
///
/// Example:
/// ```modl
/// print(sign(-30deg))
/// ```
extern fn sign<D: Dimension>(x: Quantity<D>) -> Int

/// The least of one or more numbers.
///
/// An empty list is refused.
///
/// Example:
/// ```modl
/// print(min(3, 1, 2), min([40mm, 3cm]))
/// ```
extern fn min<T: Quantity>(values: T...) -> T

/// The greatest of one or more numbers.
///
/// An empty list is refused.
///
/// Example:
/// ```modl
/// print(max(3, 1, 2), max([40mm, 3cm]))
/// ```
extern fn max<T: Quantity>(values: T...) -> T

/// The number of a range that is nearest to `x`.
///
/// Example:
/// ```modl
/// print(clamp(120deg, to: -90deg..90deg))
/// ```
extern fn clamp<D: Dimension>(x: Quantity<D>, to: Range<Quantity<D>>) -> Quantity<D>

/// The square root; of an area it is a length.
///
/// A negative number is refused.
///
/// Example:
/// ```modl
/// print(sqrt(2), sqrt(3m * 12m))
/// ```
extern fn sqrt<D: Dimension>(x: Quantity<D^2>) -> Quantity<D>

/// The sine of an angle.
///
/// Example:
/// ```modl
/// print(sin(30deg))
/// ```
extern fn sin(x: Angle) -> Number

/// The cosine of an angle.
///
/// Example:
/// ```modl
/// print(cos(60deg))
/// ```
extern fn cos(x: Angle) -> Number

/// The tangent of an angle.
///
/// Example:
/// ```modl
/// print(tan(45deg))
/// ```
extern fn tan(x: Angle) -> Number

/// The angle in -90deg..90deg whose sine is `x`.
///
/// A number outside -1..1 is refused.
///
/// Example:
/// ```modl
/// print(asin(0.5))
/// ```
extern fn asin(x: Number) -> Angle

/// The angle in 0deg..180deg whose cosine is `x`.
///
/// A number outside -1..1 is refused.
///
/// Example:
/// ```modl
/// print(acos(0.5))
/// ```
extern fn acos(x: Number) -> Angle

/// The angle in -90deg..90deg whose tangent is `x`.
///
/// Example:
/// ```modl
/// print(atan(1))
/// ```
extern fn atan(x: Number) -> Angle

/// The angle in -180deg..180deg from the x axis to the point (x, y).
///
/// Example:
/// ```modl
/// print(atan2(1mm, -1mm))
/// ```
extern fn atan2<D: Dimension>(y: Quantity<D>, x: Quantity<D>) -> Angle

/// e to the power of `x`.
///
/// Example:
/// ```modl
/// print(exp(1))
/// ```
extern fn exp(x: Number) -> Number

/// The natural logarithm.
///
/// A number that is not positive is refused.
///
/// Example:
/// ```modl
/// print(ln(exp(2)))
/// ```
extern fn ln(x: Number) -> Number

/// The greatest whole number that is not above `x`.
///
/// Example:
/// ```modl
/// print(floor(-1.5))
/// ```
extern fn floor(x: Number) -> Int

/// The least whole number that is not below `x`.
///
/// Example:
/// ```modl
/// print(ceil(1.2))
/// ```
extern fn ceil(x: Number) -> Int

/// The whole number nearest to `x`; halves go away from zero.
///
/// Example:
/// ```modl
/// print(round(2.5), round(90deg / 7deg))
/// ```
extern fn round(x: Number) -> Int

/// The Euclidean quotient of whole numbers: `a` is `div(a, b) * b + a % b`, and `a % b` is not negative.
///
/// A division by zero is refused.
///
/// Example:
/// ```modl
/// print(div(-7, 2), -7 % 2)
/// ```
extern fn div(a: Int, b: Int) -> Int

/// The sum of a list; of an empty one it is zero.
///
/// Example:
/// ```modl
/// print(sum([100g, 0.4kg]))
/// ```
extern fn sum<T: Quantity>(list: List<T>) -> T

// Vectors and poses.

/// The length of a vector.
///
/// Example:
/// ```modl
/// print(norm([3m, 4m, 0m]))
/// ```
extern fn norm<D: Dimension>(v: Vec3<Quantity<D>>) -> Quantity<D>

/// The scalar product of two vectors.
///
/// Example:
/// ```modl
/// print(dot([1m, 2m, 3m], [3m, 2m, 1m]))
/// ```
extern fn dot<D: Dimension>(a: Vec3<Quantity<D>>, b: Vec3<Quantity<D>>) -> Quantity<D^2>

/// The vector product of two vectors.
///
/// Example:
/// ```modl
/// print(cross([1m, 0m, 0m], [0m, 1m, 0m]))
/// ```
extern fn cross<D: Dimension>(a: Vec3<Quantity<D>>, b: Vec3<Quantity<D>>) -> Vec3<Quantity<D^2>>

/// Where the origin of a pose is; of a signal of poses, for `series`, over time.
///
/// Example:
/// ```modl
/// use std.smores.{Chain3, Smores}
/// print(position(pose(Smores().top)))
/// let c = Chain3()
/// let p = plan(move(c.m[1].tilt, to: 30deg))
/// print(max([at.z for at in p.series(position(pose(c.m[2])), step: 100ms)]))
/// ```
extern fn position(pose: Pose | Signal<Pose>) -> Vec3<Length> | Signal<Vec3<Length>>

/// Where an axis points after it was turned by a pose: in the frame in which the pose is given.
///
/// Example:
/// ```modl
/// use std.smores.Smores
/// print(direction(pose(Smores().left), X))
/// ```
extern fn direction(pose: Pose, axis: Vec3<Number>) -> Vec3<Number>

// Lists and text.

/// How many elements a list has.
///
/// Example:
/// ```modl
/// print(len([1, 2, 3]))
/// ```
extern fn len<T>(list: List<T>) -> Int

/// The first element, missing if there is none.
///
/// Example:
/// ```modl
/// print(first([1mm, 2mm]) else 0mm)
/// ```
extern fn first<T>(list: List<T>) -> T?

/// The last element, missing if there is none.
///
/// Example:
/// ```modl
/// print(last([1mm, 2mm]) else 0mm)
/// ```
extern fn last<T>(list: List<T>) -> T?

/// The elements whose places lie in a range.
///
/// A range that leads out of the list is refused.
///
/// Example:
/// ```modl
/// print(slice([1, 2, 3, 4], 1..3))
/// ```
extern fn slice<T>(list: List<T>, places: Range<Int>) -> List<T>

/// The list from its end to its beginning. (`reverse` is for plans.)
///
/// Example:
/// ```modl
/// print(reversed([1, 2, 3]))
/// ```
extern fn reversed<T>(list: List<T>) -> List<T>

/// The numbers of a list in rising order.
///
/// Example:
/// ```modl
/// print(sorted([3mm, 1mm, 2mm]))
/// ```
extern fn sorted<T: Quantity>(list: List<T>) -> List<T>

/// The places of the elements of a list from the least to the greatest; of equal ones the first comes first.
///
/// Example:
/// ```modl
/// let speeds = [30mm/s, 10mm/s, 20mm/s]
/// print(ranking(speeds), [speeds[i] for i in ranking(speeds)])
/// ```
extern fn ranking<T: Quantity>(list: List<T>) -> List<Int>

/// The values from the beginning of a range to its end, by steps of one size.
///
/// As always, the end of a range of whole numbers is not among them; that of other quantities is, where a step comes to
/// it. A step of zero, or one that leads away from the end, is refused.
///
/// Example:
/// ```modl
/// print(steps(0..10, by: 2), steps(10..0, by: -5), steps(0deg..90deg, by: 30deg))
/// ```
extern fn steps<T: Quantity>(range: Range<T>, by: T) -> List<T>

/// Pseudorandom numbers from 0 up to, but without, 1, all equally likely: the same for the same `seed`, on every
/// machine and in every version.
///
/// They are those of SplitMix64 (Steele, Lea, Flood: "Fast Splittable Pseudorandom Number Generators", OOPSLA 2014), begun
/// with `seed`; of the 64 bits of each the first 53 are taken. The first numbers of a longer list are those of a shorter
/// one.
///
/// Example:
/// ```modl
/// print(random(1, 3), [10mm + 5mm * r for r in random(2, 3)])
/// ```
extern fn random(seed: Int, count: Int) -> List<Number>

/// The elements of the lists of a list, in order.
///
/// Example:
/// ```modl
/// print(flatten([[1, 2], [3]]))
/// ```
extern fn flatten<T>(lists: List<List<T>>) -> List<T>

/// Whether an element of the list equals `item`.
///
/// Example:
/// ```modl
/// print(contains([1, 2, 3], 2))
/// ```
extern fn contains<T>(list: List<T>, item: T) -> Bool

/// Whether any of the statements is true; of none, no.
///
/// Example:
/// ```modl
/// print(any([x > 2 for x in [1, 2, 3]]))
/// ```
extern fn any(list: List<Bool>) -> Bool

/// Whether all of the statements are true; of none, yes.
///
/// Example:
/// ```modl
/// print(all([x > 2 for x in [1, 2, 3]]))
/// ```
extern fn all(list: List<Bool>) -> Bool

/// What is left of a list when each element in turn is put to what came of those before it: `f` takes what came so
/// far, at first `from`, and an element.
///
/// Of an empty list it is `from`.
///
/// Example:
/// ```modl
/// print(reduce([3, 1, 2], (total, x) => 10 * total + x, from: 0))
/// ```
extern fn reduce<T, A>(list: List<T>, f: fn(A, T) -> A, from: A) -> A

/// What came of the elements of a list after each of them: `reduce` with all values on the way.
///
/// The list is as long as `list`; its last element is what `reduce` gives.
///
/// Example:
/// ```modl
/// print(scan([100g, 50g, 20g], (total, x) => total + x, from: 0g))
/// ```
extern fn scan<T, A>(list: List<T>, f: fn(A, T) -> A, from: A) -> List<A>

/// What comes of `from` when `f` is applied again and again, until `until` holds of it.
///
/// It is the first value of which `until` holds, `from` itself included. One of which it does not hold after `max`
/// steps is refused.
///
/// Example:
/// ```modl
/// // Newton's method for the square root of 2.
/// print(iterate(x => (x + 2 / x) / 2, from: 1, until: x => abs(x^2 - 2) < 1e-12))
/// ```
extern fn iterate<A>(f: fn(A) -> A, from: A, until: fn(A) -> Bool, max: Int = 100_000) -> A

/// The texts of a list, one after another, with `with` between them.
///
/// Example:
/// ```modl
/// print(join(["{i}" for i in 0..4], with: ", "))
/// ```
extern fn join(list: List<Text>, with: Text = "") -> Text

/// A text filled up with blanks to a width, in characters; one that is wider stays as it is.
///
/// Example:
/// ```modl
/// for n in [7, 42] { print(pad("{n} modules", 12), "|", pad("{n * 0.5573kg in kg:.1}", 8, align: right)) }
/// ```
extern fn pad(text: Text, width: Int, align: left | right | centre = left) -> Text

/// The pieces of a text between the places where `on` stands.
///
/// An empty `on` is refused.
///
/// Example:
/// ```modl
/// print(split("a,b,c", on: ","))
/// ```
extern fn split(text: Text, on: Text) -> List<Text>

/// The characters of a text, one by one.
///
/// Example:
/// ```modl
/// print(len(characters("modl")))
/// ```
extern fn characters(text: Text) -> List<Text>

// Output.

/// Prints values on one line, with a blank between them, as `{...}` in a text shows them.
///
/// Quantities are shown with a unit that suits their size: whole numbers and numbers of at most ten digits exactly,
/// others with six digits. `{x in mm:.2}` in a text says the unit and the number of decimals. A list is one value; a list
/// of records alone is a table, with one unit for each column.
///
/// Example:
/// ```modl
/// use std.smores.Car
/// print("the car has", count(Car), "modules")
/// ```
extern fn print(values: Any...)

/// Verifies a plan and writes it as a plan file into the output folder.
///
/// A behaviour is planned first. Nothing is written unless the verifier accepts the plan; the
/// options are those of `verify`, and one that is looser than its default is recorded in the file.
/// A path that leads out of the output folder is refused.
///
/// Example:
/// ```modl
/// use std.smores.Driver1
/// emit(Driver1().drive(t: 1s), "drive.plan.json")
/// ```
extern fn emit(
  what: Plan | Behavior,
  file: Text,
  sample: Time = 10ms,
  unstable_for: Time = 0s,
  stability: footprint | centres = footprint,
  reserve: Number = 0,
  slip_max: Length?,
  slip: Number = 0.05,
)

/// Draws a plan, a robot, a lattice or a truss, with the verdict stamped on it; a simulation; or a plot.
///
/// The end of the file's name says how. `.html` is a page that plays the plan in any browser, from
/// one file that loads nothing else. `.png` is a picture at the time `at` from a `side`; +x is ahead;
/// the `look` of a `figure` is for print: on white, without a grid, edges drawn out.
/// `.svg` is a drawing: a behaviour as its series-parallel graph, a robot as the graph of its
/// modules, flat panels on hinges as the pattern to cut and fold, true to scale, a lattice or truss
/// stage by stage.
///
/// A behaviour is planned first. Unlike `emit`, it draws what the verifier does not accept, too:
/// played up to the failure, with what is to blame marked, and still reported as an error.
///
/// A simulation is a page, too: it plays what the robot did, with the plan as a ghost beside it, contact forces as
/// arrows, joints and torques as curves, and the ways of all `runs`. It reports nothing.
///
/// Example:
/// ```modl
/// use std.smores.Driver1
/// show(Driver1().drive(t: 1s), "drive.html")
/// show(Driver1(), "driver.png", side: front)
/// ```
extern fn show(
  what: Plan | Behavior | Config | Lattice | Truss | Layout | Plot | Simulation,
  file: Text,
  sample: Time = 10ms,
  unstable_for: Time = 0s,
  stability: footprint | centres = footprint,
  at: Time = 0s,
  side: corner | front | back | left | right | top = corner,
  reserve: Number = 0,
  slip_max: Length?,
  slip: Number = 0.05,
  look: room | figure = room,
)

/// Writes something in a format of other programs into the output folder, by the end of the file's name.
///
/// A plan of a robot with joints, a behaviour, or a robot at rest is written for other programs, see docs/exchange.md:
/// - `.mjcf.xml`: a model for the simulator MuJoCo with masses, shapes, joints, servos, bonds and friction, and the
///   keyframe `start` in which the plan begins, see docs/mujoco.md; beside it the commands of its actuators and the
///   docking events as tables
/// - `.urdf`: a robot description for ROS, one for each topology, with its meshes beside it; closed loops are an error
/// - `.trajectory.yaml` and `.trajectory.json`: `trajectory_msgs/JointTrajectory`, one for each topology
/// - `.csv`: the positions of all joints, 100 times a second
/// - `.glb`: an animated scene in glTF, for Blender; also of lattices and trusses
/// - `.mcap`: a recording of ROS messages, for Foxglove and Rerun
/// - `.gif` and `.frames`: moving pictures
///
/// What a robot could execute (trajectories, tables, recordings) is verified first, as `emit` does.
///
/// A robot of RoFI modules is a `.rofi` file, or a `.json` file in RoFI's newer format. A folding is a `.fold` file (FOLD 1.2): the flat net in
/// millimetres with its mountains, valleys and fold angles, the step in which each hinge folds, the
/// edges that meet in the end, and the folded form after every step as further frames. A plot is a `.svg` or `.png`
/// file. Another ending is an error that says what fits.
///
/// A list of records is a `.csv` file (RFC 4180, UTF-8): a head with units, a record a line. Each number is the shortest
/// that gives its value back exactly when it is read in the unit of its column, which is the one that suits it where
/// that is possible, and else the base units. A missing value is an empty field. In a `.json` file each column has its
/// `name`, the `unit` and `dimension` of its quantities, and its `values` in that unit, SI; a missing one is `null`.
///
/// Example:
/// ```modl
/// use std.mori.Mori
/// use std.rofi.Snake
/// use std.shapes.octahedron
/// use std.smores.Driver1
/// save(plan(Driver1().drive(t: 1s)), "drive.mjcf.xml")
/// save(Driver1(), "driver.urdf")
/// save(plan(Driver1().drive(t: 1s)), "drive.trajectory.yaml")
/// save(Snake(n: 4), "snake.rofi")
/// save(Snake(n: 4), "snake.json")
/// save(fold(octahedron(edge: 80mm), module: Mori), "octahedron.fold")
/// record Design { name: Text, bend: Angle, mass: Mass }
/// save([Design(name: "flat", bend: 0deg, mass: 4kg), Design(name: "bent", bend: 30deg, mass: 4kg)], "designs.csv")
/// ```
extern fn save<T>(what: Plan | Behavior | Config | Layout | Plot | List<T>, file: Text)

/// A plot, to be shown or saved.
extern type Plot {
  /// How many lists of values it shows.
  series: Int
  /// How many values it can't show: missing ones and infinite ones.
  gaps: Int
}

/// Draws quantities over others as curves or points, or how often they occur, with units on the axes.
///
/// `y` is one list or several, one for each curve. `x` is one list for all, or one for each; without it, values are
/// numbered. A missing or infinite value leaves a gap. A `histogram` counts the values of `y` in `bins`. Axes are
/// labelled with the names of fields, signals and values as they are written, and several curves with theirs;
/// `x_label`, `y_label` and `names` say otherwise.
///
/// `show` and `save` write it as `.svg` or `.png`; a session shows it in the terminal.
///
/// Example:
/// ```modl
/// use std.smores.Chain3
/// let c = Chain3()
/// let p = plan(move(c.m[1].tilt, to: 60deg))
/// let step = 20ms
/// save(plot(p.series(torque(c.m[1].tilt), step: step), x: p.times(step: step)), "torque.svg")
/// let angles = [p.series(angle(m.tilt), step: step) for m in c.m]
/// show(plot(angles, x: p.times(step: step), names: ["front", "middle", "back"], y_label: "tilt"), "tilts.png")
/// print(plot(p.series(speed(c.m[1].tilt), step: step), kind: histogram, bins: 12))
/// ```
extern fn plot<D: Dimension, E: Dimension>(
  y: List<Quantity<D>?> | List<List<Quantity<D>?>>,
  x: (List<Quantity<E>?> | List<List<Quantity<E>?>>)?,
  kind: curve | scatter | histogram = curve,
  names: List<Text> = [],
  title: Text = "",
  x_label: Text?,
  y_label: Text?,
  bins: auto | Int = auto,
) -> Plot

/// Reads a robot from a `.rofi` file of this project, or from a `.json` file in RoFI's newer format; its
/// modules are `modules(c, Rofi)`.
///
/// In the newer format the docks +X and -X have each other's names; what is read is the same robot.
///
/// Example:
/// ```modl check
/// use std.rofi.Rofi
/// print(len(modules(load("tangled.rofi"), Rofi)))
/// ```
/// ```modl tangled.rofi
/// C
/// M 0 0 0 0
/// M 1 90 0 0
/// E 0 B -Z N -Z A 1
/// ```
extern fn load(file: Text) -> Config

// Questions about robots.

/// How many compositions deep a robot is: 0 for a module, else one more than the largest order of its parts.
///
/// Example:
/// ```modl
/// use std.smores.{Smores, Chain3, Walk4}
/// print(order(Smores), order(Chain3), order(Walk4))
/// ```
extern fn order(of: Config) -> Int

/// How many modules (or cells) a robot has.
///
/// Example:
/// ```modl
/// use std.smores.Walk4
/// print(count(Walk4))
/// ```
extern fn count(of: Config | Lattice) -> Int

/// The mass of a robot: the sum of its modules' (cells', struts') masses.
///
/// Example:
/// ```modl
/// use std.smores.Walk4
/// print(mass(Walk4))
/// ```
extern fn mass(of: Config | Lattice | Truss) -> Mass

/// The centre of mass of a robot in its start pose, in the frame of its base module.
///
/// Example:
/// ```modl
/// use std.smores.Chain3
/// print(com(Chain3))
/// ```
extern fn com(of: Config) -> Vec3<Length>

/// The corners of the area that a robot stands on in its start pose, counterclockwise.
///
/// They lie on the ground, in the frame of the base module as it rests.
///
/// Example:
/// ```modl
/// use std.smores.Car
/// print(footprint(Car))
/// ```
extern fn footprint(of: Config) -> List<Vec3<Length>>

/// The ports of a robot that are still free, in the order of its modules.
///
/// Example:
/// ```modl
/// use std.smores.Chain3
/// print(len(ports(Chain3)))
/// ```
extern fn ports(of: Config) -> List<Port>

/// The modules of one kind in a robot, in the order of its parts.
///
/// Example:
/// ```modl
/// use std.smores.{Smores, Car}
/// print(len(modules(Car, Smores)))
/// ```
extern fn modules<M: Module>(of: Config, kind: M) -> List<M>

/// Two ports of a robot that are docked to each other.
record Connection {
  /// The first port, as the connection is written.
  a: Port
  /// The second port.
  b: Port
  /// The turn of the second connector about their common normal.
  turn: Angle
}

/// The connections of a robot, in the order in which they are made; those of a part are between its own modules.
///
/// A module alone has none.
///
/// Example:
/// ```modl
/// use std.smores.Chain3
/// for c in connections(Chain3) { print(c.a, c.b, c.turn) }
/// ```
extern fn connections(of: Config) -> List<Connection>

/// Whether two robots are the same but for the names of their modules: as many modules of the same types, docked at the
/// same ports with the same turns, and with their joints in the same positions.
///
/// Joints agree within a millionth of a radian or of a metre, endless ones up to whole turns; a module may lie turned
/// round where it is the same then. Which module is the base makes no difference.
///
/// Example:
/// ```modl
/// use std.smores.{Smores, Chain3}
/// config Row {
///   part head: Smores
///   part tail[2]: Smores
///   connect tail[0].bottom -- head.top
///   connect tail[1].bottom -- tail[0].top
/// }
/// print(same(Row, Chain3), same(Row, Smores))
/// ```
extern fn same(a: Config, b: Config) -> Bool

/// The ways in which a configuration is contained in a robot: each element is a robot of the type of `pattern` whose
/// modules are modules of the robot `in`, so that its behaviours are behaviours of that robot.
///
/// An embedding maps each module of the pattern to another module of the robot. It keeps the type of the module with its
/// arguments, and each connection with its two ports and its turn; of a connection with a joint also which port is first,
/// where the joint would turn the other way round. The modules may have other connections to the rest of the robot, but
/// none among themselves that the pattern lacks. Embeddings that differ by a symmetry are all listed, in the order of the
/// robot's modules to which the first module of the pattern is mapped. The list is empty if the robot does not contain
/// the pattern.
///
/// Joint positions make no difference, and what the pattern sets does not apply: behaviours begin in the posture of the
/// robot. A module counts as a robot of one module. Comparing two modules counts as an evaluation step; at worst every
/// module of the pattern is compared with every module of the robot. Embeddings of more than a million modules together
/// are refused.
///
/// Example:
/// ```modl
/// use std.smores.{Grasper7, Walker14}
/// let w = Walker14()
/// let graspers = embed(Grasper7, in: w)
/// print(graspers)
/// print(plan(Sc(w.stand(), graspers[0].open())).duration)
/// ```
extern fn embed<C: Config>(pattern: C, in: Config) -> List<C>

/// Where a port or a module's body is in the start pose, in the frame of the base module.
///
/// Where a signal is wanted, as in `series`, it is the pose over time, in the world.
///
/// Example:
/// ```modl
/// use std.smores.Chain3
/// let c = Chain3()
/// print(pose(c.head))
/// let p = plan(move(c.m[1].tilt, to: 30deg))
/// print(last(p.series(pose(c.head), step: 100ms)))
/// ```
extern fn pose(of: Port | Module) -> Pose | Signal<Pose>

/// The shortest way over the ground among the obstacles of a scene: the points at which it turns, from `from` to `to`,
/// both included, at the height of `from`. A part of a scene, or one of its ports, stands for its scene; a robot alone
/// has no obstacles.
///
/// Obstacles are seen from above, each convex part by its outline (a mesh by that of its convex hull), whatever its
/// height. No point of the way is closer to one than `clearance`. It is the shortest way among the outlines grown by
/// that distance, with corners that are rounded by an edge for each 22.5 degrees. Refused are ends that are too close to
/// an obstacle, ends between which no way leads, and obstacles whose grown outlines have more than 4000 corners.
///
/// Example:
/// ```modl
/// use std.smores.Driver1
/// scene Yard {
///   part d: Driver1
///   obstacle wall = box(20mm, 1m, 200mm) at [500mm, 200mm, 100mm]
/// }
/// print(waypoints(Yard(), from: [0m, 0m, 0m], to: [1m, 0m, 0m], clearance: 100mm))
/// ```
extern fn waypoints(
  scene: Config | Port,
  from: Vec3<Length>,
  to: Vec3<Length>,
  clearance: Length,
) -> List<Vec3<Length>>

/// How far two ports or modules are apart in the start pose, from origin to origin.
///
/// Example:
/// ```modl
/// use std.smores.Body3
/// let b = Body3()
/// print(distance(b.side[0], b.side[1]))
/// ```
extern fn distance(a: Port | Module, b: Port | Module) -> Length

/// How many nodes a truss has.
///
/// Example:
/// ```modl
/// use std.truss.PneumaticReel
/// truss Pyramid of PneumaticReel = octet(edge: 2m, divisions: 2)
/// print(nodes(Pyramid), struts(Pyramid))
/// ```
extern fn nodes(of: Truss) -> Int

/// How many struts a truss has.
///
/// Example:
/// ```modl
/// use std.truss.PneumaticReel
/// truss Tetra of PneumaticReel = octet(edge: 1m, divisions: 1)
/// print(struts(Tetra))
/// ```
extern fn struts(of: Truss) -> Int

/// How rigid a truss is in its start pose.
///
/// Example:
/// ```modl
/// use std.truss.PneumaticReel
/// truss Tetra of PneumaticReel = octet(edge: 1m, divisions: 1)
/// print(rigidity(Tetra).rank)
/// ```
extern fn rigidity(of: Truss) -> Rigidity

/// The infinitesimal rigidity of a truss: its matrix of struts by node coordinates.
extern type Rigidity {
  /// Whether every infinitesimal motion is one of the whole: rank 3n - 6.
  rigid: Bool
  /// Rank of the rigidity matrix.
  rank: Int
  /// Independent states of stress without load: struts - rank.
  self_stresses: Int
  /// The least singular value that is not zero, for a truss of mean strut length 1.
  weakest: Number
  /// Struts without any of which the truss stays rigid.
  redundant: List<Text>
  /// Free motions beside those of the whole, each with the nodes that move.
  free_motions: List<Text>
}

// Shapes of links.

/// A box, centred at the origin of its link, with edges along its axes.
///
/// The options are the same for all shapes. `mass` is the link's (without it the module's mass is
/// split by volume), `com` its centre of mass and `inertia` its moments xx, yy, zz about that, both
/// in the link's frame (without them those of the solid), `friction` Coulomb's coefficient on the
/// ground.
///
/// Example:
/// ```modl
/// module Brick {
///   mass 1kg
///   link body = box(200mm, 100mm, 50mm, friction: 0.6)
/// }
/// print(mass(Brick))
/// ```
extern fn box(
  x: Length,
  y: Length,
  z: Length,
  mass: Mass?,
  com: Vec3<Length>?,
  inertia: Vec3<Quantity<kg*m^2>>?,
  friction: Number = 0.5,
  static_friction: Number?,
  contact_stiffness: Quantity<N/m>?,
) -> Shape

/// A cylinder, centred at the origin of its link. Options as for `box`.
///
/// It is round: it rolls without bumps.
///
/// Example:
/// ```modl
/// module Can {
///   mass 300g
///   link body = cylinder(radius: 33mm, length: 115mm, axis: Y)
/// }
/// print(com(Can))
/// ```
extern fn cylinder(
  radius: Length,
  length: Length,
  axis: Vec3<Number> = Z,
  mass: Mass?,
  com: Vec3<Length>?,
  inertia: Vec3<Quantity<kg*m^2>>?,
  friction: Number = 0.5,
  static_friction: Number?,
  contact_stiffness: Quantity<N/m>?,
) -> Shape

/// A ball, centred at the origin of its link. Options as for `box`.
///
/// Example:
/// ```modl
/// module Ball {
///   mass 100g
///   link body = sphere(radius: 40mm)
/// }
/// print(mass(Ball))
/// ```
extern fn sphere(
  radius: Length,
  mass: Mass?,
  com: Vec3<Length>?,
  inertia: Vec3<Quantity<kg*m^2>>?,
  friction: Number = 0.5,
  static_friction: Number?,
  contact_stiffness: Quantity<N/m>?,
) -> Shape

/// A cylinder with round caps; `length` lies between the centres of the caps. Options as for `box`.
///
/// Example:
/// ```modl
/// module Pill {
///   mass 100g
///   link body = capsule(radius: 20mm, length: 60mm, axis: X)
/// }
/// print(mass(Pill))
/// ```
extern fn capsule(
  radius: Length,
  length: Length,
  axis: Vec3<Number> = Z,
  mass: Mass?,
  com: Vec3<Length>?,
  inertia: Vec3<Quantity<kg*m^2>>?,
  friction: Number = 0.5,
  static_friction: Number?,
  contact_stiffness: Quantity<N/m>?,
) -> Shape

/// A prism over a convex outline in the xy plane, from z = -height/2 to height/2. Options as for `box`.
///
/// The corners' z is not used. Fewer than three corners, or corners on one line, are refused.
///
/// Example:
/// ```modl
/// module Wedge {
///   mass 100g
///   link body = prism([[0mm, 0mm, 0mm], [60mm, 0mm, 0mm], [0mm, 30mm, 0mm]], height: 20mm)
/// }
/// print(com(Wedge))
/// ```
extern fn prism(
  outline: List<Vec3<Length>>,
  height: Length,
  mass: Mass?,
  com: Vec3<Length>?,
  inertia: Vec3<Quantity<kg*m^2>>?,
  friction: Number = 0.5,
  static_friction: Number?,
  contact_stiffness: Quantity<N/m>?,
) -> Shape

/// The convex hull of points in the link's frame. Options as for `box`.
///
/// Fewer than four points, or points in one plane, are refused.
///
/// Example:
/// ```modl
/// module Tip {
///   mass 50g
///   link body = hull([[0mm, 0mm, 0mm], [40mm, 0mm, 0mm], [0mm, 40mm, 0mm], [0mm, 0mm, 40mm]])
/// }
/// print(com(Tip))
/// ```
extern fn hull(
  points: List<Vec3<Length>>,
  mass: Mass?,
  com: Vec3<Length>?,
  inertia: Vec3<Quantity<kg*m^2>>?,
  friction: Number = 0.5,
  static_friction: Number?,
  contact_stiffness: Quantity<N/m>?,
) -> Shape

/// A closed mesh from a file of this project: STL, OBJ, OFF or PLY. Options as for `box`.
///
/// `scale` is the length of one unit of the file.
///
/// Example:
/// ```text
/// module Claw {
///   mass 50g
///   link body = mesh("claw.stl", scale: 1mm) collides box(40mm, 20mm, 20mm)
/// }
/// ```
extern fn mesh(
  file: Text,
  scale: Length = 1mm,
  mass: Mass?,
  com: Vec3<Length>?,
  inertia: Vec3<Quantity<kg*m^2>>?,
  friction: Number = 0.5,
  static_friction: Number?,
  contact_stiffness: Quantity<N/m>?,
) -> Shape

/// Several shapes as one. Options as for `box`; those of the parts count for nothing.
///
/// Without `mass` and the rest the solid is taken as the sum of its parts.
///
/// Example:
/// ```modl
/// module Tee {
///   mass 200g
///   link body = union(box(20mm, 20mm, 80mm), placed(box(60mm, 20mm, 20mm), at: [0mm, 0mm, 50mm]))
/// }
/// print(com(Tee))
/// ```
extern fn union(
  shapes: Shape...,
  mass: Mass?,
  com: Vec3<Length>?,
  inertia: Vec3<Quantity<kg*m^2>>?,
  friction: Number = 0.5,
  static_friction: Number?,
  contact_stiffness: Quantity<N/m>?,
) -> Shape

/// A shape turned about an axis through its origin, then moved: for the parts of a `union`.
///
/// Example:
/// ```modl
/// module Cross {
///   mass 100g
///   link body = union(box(90mm, 10mm, 10mm), placed(box(90mm, 10mm, 10mm), axis: Z, turn: 90deg))
/// }
/// print(com(Cross))
/// ```
extern fn placed(
  shape: Shape,
  at: Vec3<Length> = [0mm, 0mm, 0mm],
  axis: Vec3<Number> = Z,
  turn: Angle = 0deg,
) -> Shape

// Kinds of joints.

/// A joint that turns about an axis; without a `range` it turns for ever.
///
/// A `passive` joint has no motor: it takes no commands.
///
/// `stiffness` is that with which its servo holds a position against a load; where it is not stated, a servo yields by 1°
/// under `max_torque`, and is 150 N*m/rad where that is not stated either. `armature` is the inertia of rotor and gears as the
/// joint feels it. Full dynamics use both (see `world`), with no armature unless it is stated; simulations assume 2e-3 kg*m^2 for
/// 150 N*m/rad then.
///
/// Two facts are known to simulations alone. `damping` is that of the servo, 1/25 s of its stiffness unless stated; of a
/// passive joint that of its bearing, none unless stated. At `no_load_speed` the motor has no torque left: what it can do
/// falls from `max_torque` in proportion to the speed at which it drives; unless stated it does not. `std.servos` names what is
/// assumed.
///
/// Example:
/// ```modl
/// module Wheel {
///   mass 100g
///   link fork = box(20mm, 20mm, 20mm)
///   link rim  = cylinder(radius: 30mm, length: 10mm, axis: Y) at [0mm, 20mm, 0mm]
///   joint roll : fork -> rim = revolute(axis: Y, max_speed: 1turn/s)
/// }
/// print(count(Wheel))
/// ```
extern fn revolute(
  axis: Vec3<Number>,
  range: Range<Angle>?,
  max_speed: AngularSpeed?,
  max_accel: AngularAcceleration?,
  max_torque: Torque?,
  stiffness: Quantity<N*m/rad>?,
  armature: Quantity<kg*m^2>?,
  damping: Quantity<N*m*s/rad>?,
  no_load_speed: AngularSpeed?,
  passive: Bool = false,
) -> JointKind

/// A joint that slides along an axis.
///
/// `stiffness`, `armature`, `damping` and `no_load_speed` are as for `revolute`: a servo yields by 1.75 mm under `max_force` where no stiffness is stated.
///
/// Example:
/// ```modl
/// module Slider {
///   mass 200g
///   link rail = box(200mm, 20mm, 20mm)
///   link cart = box(30mm, 30mm, 10mm) at [0mm, 0mm, 20mm]
///   joint slide : rail -> cart = prismatic(axis: X, range: -80mm..80mm, max_speed: 50mm/s)
/// }
/// print(count(Slider))
/// ```
extern fn prismatic(
  axis: Vec3<Number>,
  range: Range<Length>?,
  max_speed: Speed?,
  max_accel: Acceleration?,
  max_force: Force?,
  stiffness: Quantity<N/m>?,
  armature: Mass?,
  damping: Quantity<N*s/m>?,
  no_load_speed: Speed?,
  passive: Bool = false,
) -> JointKind

/// A joint that does not move: two links, each with its own shape and friction, as one body.
///
/// Example:
/// ```modl
/// module Shoe {
///   mass 100g
///   link leg  = box(20mm, 20mm, 80mm)
///   link sole = box(40mm, 30mm, 5mm, friction: 1.0) at [0mm, 0mm, -42.5mm]
///   joint glue : leg -> sole = fixed()
/// }
/// print(mass(Shoe))
/// ```
extern fn fixed() -> JointKind

// Lattices and trusses, meshes and clouds.

/// `n` cells along x.
///
/// Example:
/// ```modl
/// use std.crystal.ExpandingCube
/// lattice Bar of ExpandingCube = row(8)
/// print(count(Bar))
/// ```
extern fn row(n: Int) -> Cells

/// `n` cells along y.
///
/// Example:
/// ```modl
/// use std.crystal.ExpandingCube
/// lattice Pole of ExpandingCube = column(8)
/// print(count(Pole))
/// ```
extern fn column(n: Int) -> Cells

/// A block of cells along x, y and z. (`box` is the shape of a link.)
///
/// Example:
/// ```modl
/// use std.crystal.ExpandingCube
/// lattice Slab of ExpandingCube = block(4, 4)
/// print(count(Slab))
/// ```
extern fn block(x: Int, y: Int, z: Int = 1) -> Cells

/// Cells drawn as text: `#` is a cell, `.` and a blank are not.
///
/// The first line is the top, x runs to the right, cells are numbered in reading order. Another
/// character, or no cell at all, is refused.
///
/// Example:
/// ```modl
/// use std.crystal.ExpandingCube
/// lattice Ell of ExpandingCube = cells("""
///   #..
///   ###
/// """)
/// print(count(Ell))
/// ```
extern fn cells(text: Text) -> Cells

/// Layers of cells drawn as texts, the lowest first.
///
/// Example:
/// ```modl
/// use std.crystal.ExpandingCube
/// lattice Stool of ExpandingCube = layers("#.#", "###")
/// print(count(Stool))
/// ```
extern fn layers(texts: Text...) -> Cells

/// The same arrangement with `by` × `by` × `by` cells in place of each cell, as far as `by` times as many cells go.
///
/// Cells that do not slide change places as blocks of 2 × 2 × 2, so their shapes are enlarged ones.
///
/// Example:
/// ```modl
/// use std.crystal.DockedCube
/// lattice Ell of DockedCube = enlarged(cells("""
///   #..
///   ###
/// """))
/// print(count(Ell))
/// ```
extern fn enlarged(of: Cells, by: Int = 2) -> Cells

/// The nodes and struts of a truss.
extern type Frame {
  /// Where the nodes are, in the frame of the truss.
  nodes: List<Vec3<Length>>
  /// Which nodes each strut joins: pairs of places in `nodes`.
  struts: List<List<Int>>
}

/// A tetrahedron of the octet lattice, resting on a face: `divisions` struts along an edge.
///
/// Without the `interior` only what lies on the surface is kept, and every node that has all of its
/// twelve neighbours goes.
///
/// Example:
/// ```modl
/// use std.truss.PneumaticReel
/// truss Pyramid of PneumaticReel = octet(edge: 4m, divisions: 4, interior: false)
/// print(nodes(Pyramid), struts(Pyramid))
/// ```
extern fn octet(edge: Length, divisions: Int, interior: Bool = true) -> Frame

/// `n` regular tetrahedra, face on face along a helix.
///
/// Example:
/// ```modl
/// use std.truss.PneumaticReel
/// truss Mast of PneumaticReel = tetrahelix(5, edge: 1m)
/// print(nodes(Mast))
/// ```
extern fn tetrahelix(n: Int, edge: Length) -> Frame

/// The vertices and edges of a mesh as nodes and struts.
///
/// Example:
/// ```modl
/// use std.shapes.octahedron
/// use std.truss.PneumaticReel
/// truss Octa of PneumaticReel = from_mesh(octahedron(edge: 1m))
/// print(rigidity(Octa).rigid)
/// ```
extern fn from_mesh(mesh: Mesh) -> Frame

/// A mesh from its vertices, in a frame of its own, and its faces; a face is a list of places in
/// `vertices`, counterclockwise from outside.
///
/// A place that does not exist, or a face of fewer than three, is refused.
///
/// Example:
/// ```modl
/// let wedge = polyhedron(
///   [[0m, 0m, 0m], [1m, 0m, 0m], [0m, 1m, 0m], [0m, 0m, 1m]],
///   [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]],
/// )
/// print(faces(wedge))
/// ```
extern fn polyhedron(vertices: List<Vec3<Length>>, faces: List<List<Int>>) -> Mesh

/// How many faces a mesh has.
///
/// Example:
/// ```modl
/// use std.shapes.cube
/// print(faces(cube(edge: 1m)))
/// ```
extern fn faces(of: Mesh) -> Int

/// A mesh from a file of this project, by the end of its name: STL, OBJ, OFF, PLY, or FOLD in its last state. `scale` is the
/// length of one of the file's units. The path is relative to the program's.
///
/// Faces keep the file's order, and may be any polygons; the surface may be open. A file that can't be
/// read is refused with the line where the format has lines.
///
/// Example:
/// ```modl
/// print(faces(load_mesh("wedge.off", scale: 80mm)))
/// ```
/// ```modl wedge.off
/// OFF
/// 4 4 6
/// 0 0 0
/// 1 0 0
/// 0 1 0
/// 0 0 1
/// 3 0 2 1
/// 3 0 1 3
/// 3 1 2 3
/// 3 2 0 3
/// ```
extern fn load_mesh(file: Text, scale: Length = 1mm) -> Mesh

/// The folded form of a crease pattern in a file of this project: FOLD (`.fold`), whose edges fold by its `edges_foldAngle`,
/// negative at mountains, or a drawing (`.svg`). There black lines are the border, red ones mountains, blue ones valleys,
/// yellow ones stay flat, seen from the front, and the opacity of a stroke is the fold angle by 180 degrees. `scale` is the
/// length of one of the file's units. The path is relative to the program's.
///
/// Faces that the file does not state are those that its edges enclose; lines of a drawing are split where they cross or
/// touch. Round each vertex inside, the angles have to close; those that do not by what is rounded are mended, by a degree at
/// most. With `fold`, the file's angles are proportions: the angles are sought that close, have its mountains and valleys, and
/// of which the widest is `fold`. So patterns are read that say no more than which crease is a mountain.
///
/// Example:
/// ```modl
/// use std.mori.Polygon
/// let vertex = load_creases("vertex.fold", scale: 80mm)
/// print(faces(vertex), fold_sheet(vertex, module: Polygon).loops)
/// ```
/// ```modl vertex.fold
/// {
///   "file_spec": 1.2,
///   "vertices_coords": [[0, 0], [1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1]],
///   "edges_vertices": [[0, 1], [0, 3], [0, 5], [0, 7], [1, 2], [2, 3], [3, 4], [4, 5], [5, 6], [6, 7], [7, 8], [8, 1]],
///   "edges_assignment": ["V", "F", "V", "F", "B", "B", "B", "B", "B", "B", "B", "B"],
///   "edges_foldAngle": [60, 0, 60, 0, null, null, null, null, null, null, null, null]
/// }
/// ```
/// ```modl
/// use std.mori.Polygon
/// let waterbomb = load_creases("waterbomb.svg", fold: 60deg)
/// print(faces(waterbomb), fold_sheet(waterbomb, module: Polygon(thickness: 3mm)).freedom)
/// ```
/// ```modl waterbomb.svg
/// <svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 200 200" fill="none">
///   <rect width="200" height="200" stroke="black"/>
///   <path d="M0 0L200 200M0 200L200 0" stroke="red"/>
///   <path d="M0 100H200" stroke="blue"/>
/// </svg>
/// ```
extern fn load_creases(file: Text, scale: Length = 1mm, fold: auto | Angle = auto) -> Mesh

/// Every triangle of a mesh as `parts` times `parts` triangles of the same shape, which follow each other
/// in the place of the one.
///
/// Example:
/// ```modl
/// use std.shapes.icosahedron
/// print(faces(subdivided(icosahedron(edge: 160mm), parts: 2)))
/// ```
extern fn subdivided(mesh: Mesh, parts: Int) -> Mesh

/// A mesh with every vertex moved straight from or to the origin onto a sphere about it.
///
/// Example:
/// ```modl
/// use std.shapes.{geodesic, octahedron}
/// print(faces(on_sphere(octahedron(edge: 1m), radius: 1m)), faces(geodesic(radius: 1m, parts: 2)))
/// ```
extern fn on_sphere(mesh: Mesh, radius: Length) -> Mesh

/// Ground that rises evenly along a horizontal direction, through the origin: a terrain for `world`, `simulate` and `locomote`.
///
/// It reaches 500 m from the origin along x and y; a negative angle falls along `along`. At most 50 degrees.
///
/// Example:
/// ```modl
/// use std.smores.Driver1
/// let uphill = simulate(Driver1().drive(t: 1s), terrain: slope(5deg))
/// print(uphill.displacement.z > 5mm)
/// ```
extern fn slope(angle: Angle, along: Vec3<Number> = X) -> Terrain

/// Uneven ground for `locomote` and `simulate`: heights over the corners of squares with sides of `spacing`, in rows along
/// x, the first row at the least y.
///
/// The middle of the grid is at `centre`, whose height is added to all. Each square is two flat triangles
/// with a side from its corner of the least x and y; beyond the rim heights are those of the rim.
///
/// Example:
/// ```modl
/// let waves = terrain([[50mm * sin(x * 60deg) for x in 0..24] for y in 0..24], spacing: 500mm)
/// ```
extern fn terrain(
  heights: List<List<Length>>,
  spacing: Length,
  centre: Vec3<Length> = [0mm, 0mm, 0mm],
) -> Terrain

/// A cloud of points in a frame of its own, a target for `morph`.
///
/// Example:
/// ```modl
/// let points = cloud([[0m, 0m, 0m], [1m, 0m, 0m]])
/// ```
extern fn cloud(points: List<Vec3<Length>>) -> Cloud

/// A cloud of points from a file of this project, by the end of its name: PLY (its vertices), or XYZ,
/// which has a point a line. `scale` is the length of one of the file's units. The path is relative to the
/// program's.
///
/// Example:
/// ```modl
/// let points = load_cloud("corner.xyz", scale: 1m)
/// ```
/// ```modl corner.xyz
/// # x y z
/// 0 0 0
/// 1 0 0
/// 0 1 0
/// 0 0 1
/// ```
extern fn load_cloud(file: Text, scale: Length = 1mm) -> Cloud

// Actions: the paper's (J, X, xi, T).

/// Moves a joint to a position, or by an amount.
///
/// Give `to` or `by`. `in` is how long it takes; without it, as long as the limits of the joint and
/// of the motors behind it need. `profile` is the law of time: `smooth` (a quintic at rest at both
/// ends), `trapezoid` or `linear`. When `until` holds the action is over and the next one begins; the
/// joint keeps its setpoint, so it goes on unless that commands it. After `timeout` the next action
/// begins, too, or what stands after `else`. A position outside the joint's range, a time that its
/// speed does not allow and a `passive` joint are refused.
///
/// Example:
/// ```modl
/// use std.smores.Smores
/// config Nod {
///   part m: Smores
///   behavior nod = Sc(move(m.tilt, to: 30deg), move(m.tilt, by: -30deg, in: 1s))
/// }
/// print(plan(Nod().nod()).duration)
/// ```
extern fn move<D: Dimension>(
  joint: Joint<D>,
  to: Quantity<D>?,
  by: Quantity<D>?,
  in: Time?,
  profile: smooth | trapezoid | linear = smooth,
  until: Condition?,
  timeout: Time?,
) -> Behavior

/// Turns a joint at a steady speed.
///
/// With `for` it ends by holding; without, it lasts until the next command to the joint (a plan that
/// ends before is refused). `until` and `timeout` as for `move`. A speed above the joint's is
/// refused.
///
/// Example:
/// ```modl
/// use std.smores.Smores
/// config Roll {
///   part m: Smores
///   behavior roll = Pc(spin(m.left, 2rad/s, for: 1s), spin(m.right, 2rad/s, for: 1s))
/// }
/// print(verify(Roll().roll()).travel)
/// ```
extern fn spin(
  joint: Joint<Angle>,
  speed: AngularSpeed,
  for: Time?,
  until: Condition?,
  timeout: Time?,
) -> Behavior

/// Moves a joint along a function of the time since the action began.
///
/// The function must begin where the joint is; it may end in motion only where another follows.
///
/// Example:
/// ```modl
/// use std.smores.Smores
/// config Wave {
///   part m: Smores
///   behavior wave = follow(m.tilt, t => 20deg * (1 - cos(360deg * (t / 2s))), for: 2s)
/// }
/// print(plan(Wave().wave()).duration)
/// ```
extern fn follow<D: Dimension>(joint: Joint<D>, path: fn(Time) -> Quantity<D>, for: Time) -> Behavior

/// Waits for some time, or until a condition holds, whichever comes first.
///
/// Example:
/// ```modl
/// use std.smores.Smores
/// config Nod {
///   part m: Smores
///   behavior nod = Sc(move(m.tilt, to: 30deg), wait(1s), move(m.tilt, to: 0deg))
/// }
/// print(plan(Nod().nod()).duration)
/// ```
extern fn wait(time: Time, until: Condition?) -> Behavior

/// Docks port `b` to port `a`, where the motion has brought them together.
///
/// Ports that are taken, do not mate, or are farther apart than their connectors' `capture` are
/// refused. What is off stays as it is, unless a connector states `snap`.
///
/// Example:
/// ```modl
/// use std.smores.{Smores, Ring12}
/// let ring = Ring12()
/// print(plan(Sc(undock(ring.m[0].top), dock(ring.m[0].top, ring.m[11].bottom))).actions)
/// ```
extern fn dock(a: Port, b: Port) -> Behavior

/// Lets go of the bond at a port.
///
/// A port that is free is refused.
///
/// Example:
/// ```modl
/// use std.smores.Ring12
/// print(plan(undock(Ring12().m[0].top)).actions)
/// ```
extern fn undock(port: Port) -> Behavior

/// Stops with a message: for after `else`.
///
/// Example:
/// ```modl
/// use std.smores.Smores
/// config Bump {
///   part m: Smores
///   behavior bump = move(m.tilt, by: 40deg, until: angle(m.tilt) > 20deg, timeout: 9s) else abort("blocked")
/// }
/// print(plan(Bump().bump()).duration)
/// ```
extern fn abort(message: Text) -> Behavior

// Motions by goals.

/// A pose: a position, the direction in which the x axis points, and one towards which the z axis does.
///
/// Without `up`, z points upwards, or ahead (+X) where x points up or down: as for the ports of a module, whose x axis
/// points outwards. A port that docks from above at `p` is at `pose_at(p, facing: -Z)`.
///
/// Example:
/// ```modl
/// let above = pose_at([300mm, 0mm, 150mm], facing: -Z)
/// print(above.position, direction(above, Z))
/// ```
extern fn pose_at(position: Vec3<Length>, facing: Vec3<Number> = X, up: Vec3<Number>?) -> Pose

/// Brings a port to a place: the joints between the robot's base and the port move together, from rest to rest.
///
/// Give `to`, a pose of the port, or its `position` alone, or a `position` and with `along` the direction in which its x
/// axis points outwards. Places are in the world, as `State.pose` gives them; with `seen_from`, a module, they are in the
/// frame of its body, which then stays where it is, and only the joints from there to the port move. `in` is how long it
/// takes; without it, as long as the limits of joints and motors need.
///
/// The posture is found when the behaviour is planned, from the state in which it then begins: damped least squares within
/// the joints' ranges, from there and from random postures, `starts` in all, the same for the same `seed`. Of several
/// postures one is taken in which nothing meets, and of these the nearest. What freedom is left keeps bodies 5 mm
/// apart, and the centre of mass of a robot on the ground above where it was. A place that is not reached to 1e-6 mm and
/// 1e-6 degrees is refused, with the nearest that was. What joints do on the way is not looked at: see `avoid`.
///
/// What moves beside it is taken to stand where it is when the motion begins; that holds for `line`, `arc` and `avoid`, too.
/// None of them may stand after `else`, in a cycle, or in a repetition with a condition, where a plan does not know the
/// state in which they begin.
///
/// Example:
/// ```modl
/// use std.smores.Puma4
/// let p = Puma4()
/// let b = reach(p.tool, position: [150mm, 0mm, 250mm])
/// print(plan(b, world: world(ground: held)).end.pose(p.tool).position)
/// ```
extern fn reach(
  port: Port,
  to: Pose?,
  position: Vec3<Length>?,
  along: Vec3<Number>?,
  seen_from: Module?,
  in: Time?,
  profile: smooth | trapezoid | linear = smooth,
  starts: Int = 20,
  seed: auto | Int = auto,
) -> Behavior

/// Moves a port straight in space, from where it is: `to` a pose, or `by` a vector, with its orientation kept.
///
/// Joints follow piecewise cubics on which the port deviates from the line by no more than `within`, and by
/// `turned_within` from the turn about one axis that brings it to its orientation. The plan states both, and the judge proves
/// the distance and measures the turn at 64 places or more: `path` in a verdict. With a `free` orientation only the position is looked at, for feet and arms of fewer than six joints. `for` is how
/// long it takes; without it, as long as the limits of joints and motors need. Where a place on the line
/// is out of reach, or a joint would have to leap, it is refused with the part of the line that is within reach. `seen_from`
/// is as for `reach`. What bodies meet on the way is found by the judge.
///
/// Example:
/// ```modl
/// use std.smores.Smores
/// config Reacher {
///   part m[7]: Smores
///   for i in 0..6 { connect m[i].top -- m[i + 1].bottom turn if i % 2 == 0 { 90deg } else { 0deg } }
///   for i in 1..6 { set m[i].tilt = 25deg }
///   base m[0]
/// }
/// let r = Reacher()
/// let p = plan(line(r.m[6].top, by: [0mm, 0mm, 20mm], for: 2s), world: world(ground: held))
/// print(p.end.pose(r.m[6].top).position - p.start.pose(r.m[6].top).position)
/// ```
extern fn line(
  port: Port,
  to: Pose?,
  by: Vec3<Length>?,
  seen_from: Module?,
  for: Time?,
  within: Length = 0.1mm,
  turned_within: Angle = 0.1deg,
  orientation: kept | free = kept,
) -> Behavior

/// Moves a port along the arc of a circle from where it is, through `via`, to a pose. All else is as for `line`.
///
/// Example:
/// ```modl
/// use std.smores.Smores
/// config Reacher {
///   part m[7]: Smores
///   for i in 0..6 { connect m[i].top -- m[i + 1].bottom turn if i % 2 == 0 { 90deg } else { 0deg } }
///   for i in 1..6 { set m[i].tilt = 25deg }
///   base m[0]
/// }
/// let r = Reacher()
/// let hand = r.m[6].top
/// let at = pose(hand)
/// let there = pose_at(at.position + [0mm, 30mm, 0mm], facing: direction(at, X), up: direction(at, Z))
/// let p = plan(arc(hand, to: there, via: at.position + [0mm, 15mm, 15mm]), world: world(ground: held))
/// print(norm(p.end.pose(hand).position - there.position) < 1um)
/// ```
extern fn arc(
  port: Port,
  to: Pose,
  via: Vec3<Length>,
  seen_from: Module?,
  for: Time?,
  within: Length = 0.1mm,
  turned_within: Angle = 0.1deg,
  orientation: kept | free = kept,
) -> Behavior

/// Brings joints to where a behaviour would bring them, on a way on which nothing meets: the robot itself, other robots of
/// its scene, its obstacles, and the ground.
///
/// Only the posture at the end of `behavior` counts, and only the joints move that it commands: `avoid(reach(hand, to:
/// there))`, `avoid(arm.stow())`, `avoid(Pc(move(a, to: 30deg), move(b, to: 0deg)))`. Joints go straight from posture to
/// posture and rest at each; bodies keep `clearance`, or half of what they have at the beginning or the end if that is less. The
/// way is found by RRT-Connect with shortcuts, the same for the same `seed`; `budget` is the greatest number of postures
/// that are examined. Refused are ways that begin or end where bodies meet, with their names, and those that are not found,
/// with what is in the way.
///
/// Example:
/// ```modl
/// use std.smores.Arm
/// let a = Arm(n: 5)
/// let p = plan(avoid(Pc(move(a.m[1].tilt, to: 60deg), move(a.m[2].tilt, to: 30deg))), world: world(ground: held))
/// print(p.end.angle(a.m[1].tilt))
/// ```
extern fn avoid(
  behavior: Behavior,
  clearance: Length = 2mm,
  budget: Int = 200_000,
  seed: auto | Int = auto,
) -> Behavior

// Signals and conditions.

/// The position of a joint that turns, as the robot senses it.
///
/// Example:
/// ```modl
/// use std.smores.Smores
/// config Bump {
///   part m: Smores
///   behavior bump = move(m.tilt, by: 40deg, until: angle(m.tilt) > 20deg)
/// }
/// print(plan(Bump().bump()).duration)
/// ```
extern fn angle(joint: Joint<Angle>) -> Signal<Angle>

/// The position of a joint that slides, as the robot senses it.
///
/// Example:
/// ```modl
/// module Slider {
///   mass 2kg
///   link rail = box(300mm, 40mm, 40mm)
///   link cart = box(60mm, 60mm, 20mm) at [0mm, 0mm, 30mm]
///   joint slide : rail -> cart = prismatic(axis: X, range: -80mm..80mm, max_speed: 50mm/s, max_force: 100N)
/// }
/// let slider = Slider()
/// let p = plan(move(slider.slide, to: 50mm, until: displacement(slider.slide) > 30mm))
/// print(p.series(displacement(slider.slide), step: 500ms))
/// ```
extern fn displacement(joint: Joint<Length>) -> Signal<Length>

/// The speed of a joint as the robot senses it: an angular speed where the joint turns, a speed where it slides.
///
/// Example:
/// ```modl
/// use std.smores.Smores
/// config Bump {
///   part m: Smores
///   behavior bump = move(m.tilt, by: 40deg, until: speed(m.tilt) > 30deg/s)
/// }
/// print(plan(Bump().bump()).duration)
/// ```
extern fn speed<D: Dimension>(joint: Joint<D>) -> Signal<Quantity<D/s>>

/// The time since the action began.
///
/// Example:
/// ```modl
/// use std.smores.Smores
/// config Bump {
///   part m: Smores
///   behavior bump = move(m.tilt, by: 40deg, until: elapsed() > 500ms)
/// }
/// print(plan(Bump().bump()).duration)
/// ```
extern fn elapsed() -> Signal<Time>

/// The torque that a joint's motor supplies in the joint's positive direction, as the judge works it out.
///
/// It holds the robot at rest at every instant. The ground's forces are spread evenly and without friction, or,
/// where those would overload a joint, they are the best that friction allows. That is what `series` gives; in
/// conditions it is the torque of the motor as the robot measures it, which a plan does not know before it runs.
///
/// Example:
/// ```modl
/// use std.smores.Chain3
/// let c = Chain3()
/// let lift = plan(move(c.m[2].tilt, to: 30deg))
/// print("at most", max(lift.series(torque(c.m[2].tilt), step: 100ms)))
/// ```
extern fn torque(joint: Joint<Angle>) -> Signal<Torque>

/// The force that the motor of a joint that slides supplies in the joint's positive direction, as the judge works it
/// out; with what `torque` says of the forces of the ground, and of conditions.
///
/// Example:
/// ```modl
/// module Lift {
///   mass 3kg
///   link base = box(300mm, 300mm, 40mm, mass: 2kg)
///   link table = box(100mm, 100mm, 20mm, mass: 1kg) at [0mm, 0mm, 60mm]
///   joint up : base -> table = prismatic(axis: Z, range: 0mm..80mm, max_speed: 50mm/s, max_force: 20N)
/// }
/// let l = Lift()
/// let p = plan(move(l.up, to: 50mm))
/// print(max(p.series(force(l.up), step: 100ms)))
/// ```
extern fn force(joint: Joint<Length>) -> Signal<Force>

/// How far the centre of mass is inside the area that the robot stands on, negative outside, as the judge works
/// it out; for `series`.
///
/// Example:
/// ```modl
/// use std.smores.Car
/// let p = plan(Car().drive(t: 1s))
/// print(min(p.series(margin(), step: 100ms)))
/// ```
extern fn margin() -> Signal<Length>

/// The least distance between links that may not touch, as the judge works it out; for `series`.
///
/// Example:
/// ```modl
/// use std.smores.Car
/// let p = plan(Car().drive(t: 1s))
/// print(min(p.series(clearance(), step: 100ms)))
/// ```
extern fn clearance() -> Signal<Length>

/// The normal force of the ground on a module, or on all modules of a part: the load of a foot. For `series`, with
/// the forces that the judge weighs torques with.
///
/// Example:
/// ```modl
/// use std.smores.{Car, Smores}
/// let car = Car()
/// let p = plan(car.drive(t: 1s))
/// for m in modules(car, Smores) { print(max(p.series(ground_force(m), step: 500ms))) }
/// ```
extern fn ground_force(on: Config) -> Signal<Force>

/// The distance of two ports' origins. In conditions it is measured, so that a plan does not know it before it runs.
///
/// Example:
/// ```modl
/// use std.smores.Chain3
/// let c = Chain3()
/// let p = plan(move(c.m[1].tilt, to: 30deg))
/// print(last(p.series(separation(c.tail, c.head), step: 100ms)))
/// ```
extern fn separation(a: Port, b: Port) -> Signal<Length>

/// The angle by which the body of a module, or of the first module of a part, leans from its attitude at the start.
///
/// In conditions it is measured, so that a plan does not know it before it runs.
///
/// Example:
/// ```modl
/// use std.smores.Chain3
/// let c = Chain3()
/// let p = plan(move(c.m[1].tilt, to: 30deg))
/// print(last(p.series(tilt(c.m[2]), step: 100ms)))
/// ```
extern fn tilt(on: Config) -> Signal<Angle>

/// That a module, or a part, touches the ground or another module that is not docked to it; with `other`, that it touches that
/// module or part, perhaps of another robot of a scene.
///
/// It is measured, so that a plan does not know it before it runs: the undisturbed run goes on when the time is out, as if
/// it held by then.
///
/// Example:
/// ```modl
/// use std.smores.Chain3
/// let c = Chain3()
/// let reach = move(c.m[2].tilt, to: -60deg, in: 3s, until: touching(c.m[2]), timeout: 4s)
/// print(plan(reach).nominal)
/// ```
extern fn touching(on: Config, other: Config?) -> Condition

/// That something is docked at a port.
///
/// Example:
/// ```modl
/// use std.smores.Chain3
/// let c = Chain3()
/// print(plan(wait(1s, until: docked(c.m[0].bottom))).duration)
/// ```
extern fn docked(port: Port) -> Condition

// Composing behaviours.

/// Series: each behaviour begins when the one before it has ended.
///
/// Example:
/// ```modl
/// use std.smores.Driver1
/// let d = Driver1()
/// print(plan(Sc(d.drive(t: 1s), d.turn())).duration)
/// ```
extern fn Sc(behaviors: Behavior...) -> Behavior

/// Parallel: all begin together; what follows waits for the last to end.
///
/// Two that command one joint to different things are refused, wherever they are nested.
///
/// Example:
/// ```modl
/// use std.smores.Chain3
/// let c = Chain3()
/// print(plan(Pc([move(x.tilt, to: 10deg) for x in c.m])).actions)
/// ```
extern fn Pc(behaviors: Behavior...) -> Behavior

/// Does nothing; after `else` it lets the next action begin, which is also what happens without.
let proceed = Sc()

/// A behaviour several times in series: `times`, or until a condition holds after one of at most `max` times.
///
/// Example:
/// ```modl
/// use std.smores.Driver1
/// let d = Driver1()
/// print(plan(repeat(d.drive(t: 1s), 3)).duration)
/// print(plan(repeat(d.drive(t: 1s), until: elapsed() > 4s, max: 9)).duration)
/// ```
extern fn repeat(behavior: Behavior, times: Int?, until: Condition?, max: Int?) -> Behavior

/// A cyclic behaviour begun in the middle: at `shift`, 0 to 1, of its cycle.
///
/// It must end where it began; the robot is brought to the place where the shifted cycle starts
/// first.
///
/// Example:
/// ```modl
/// use std.smores.Chain3
/// let c = Chain3()
/// print(plan(phase(c.sine(), 0.5)).duration)
/// ```
extern fn phase(behavior: Behavior, shift: Number) -> Behavior

/// A behaviour slowed down or sped up so that it lasts as long as given.
///
/// Example:
/// ```modl
/// use std.smores.Driver1
/// print(plan(stretch(Driver1().drive(t: 1s), to: 3s)).duration)
/// ```
extern fn stretch(behavior: Behavior, to: Time) -> Behavior

/// Cyclic behaviours in parallel, each at its own phase, stretched to one period, several times.
///
/// Example:
/// ```modl
/// use std.smores.Chain3
/// config Two {
///   part a: Chain3  part b: Chain3
///   connect a.tail -- b.head
///   behavior ripple allows unstable = cycle([a.sine(), b.sine()], phases: [0, 0.5], period: 4s, times: 2)
/// }
/// print(plan(Two().ripple()).duration)
/// ```
extern fn cycle(behaviors: List<Behavior>, phases: List<Number>, period: Time, times: Int = 1) -> Behavior

/// A behaviour as seen in a mirror: what the left did, the right does.
///
/// The plane goes through the middle of the robot, along two axes of its base module's frame. A
/// behaviour of a joint that has no mirror image is refused.
///
/// Example:
/// ```modl check
/// use std.smores.Walk4
/// let w = Walk4()
/// print(plan(mirror(w.stride(0, 3), across: XZ)).duration)
/// ```
extern fn mirror(behavior: Behavior, across: XY | XZ | YZ) -> Behavior

/// A gait table: every `step` the joints go to the positions of the next row.
///
/// `_` in a row leaves the joint where it is. Every row has one number for every joint, in `unit`.
///
/// Example:
/// ```modl
/// use std.smores.Chain3
/// let c = Chain3()
/// let gait = table(joints: [x.tilt for x in c.m], step: 1s, unit: deg, rows: [[10, -10, _], [0, 0, _]])
/// print(plan(gait).duration)
/// ```
extern fn table(
  joints: List<Joint<Angle>>,
  step: Time,
  unit: deg | rad | turn = deg,
  rows: List<List<Number?>>,
) -> Behavior

// Plans and their verification.

/// What a plan assumes of its surroundings.
extern type World {
  /// Downwards; zero where gravity is off.
  gravity: Acceleration
  /// `settle`, `fixed`, `held` or `off`.
  ground: Text
  /// A factor on the friction of every link.
  friction: Number
  /// `statics` or `full`.
  dynamics: Text
  /// The angle by which the ground slopes; zero where it is level.
  slope: Angle
}

/// Surroundings for `plan` and `verify`.
///
/// On ground that is `settle`, the robot rests on what it touches, rolls, travels and tips. `fixed`
/// keeps the base where it is, on the ground, which carries what stands on it. With `held` the base
/// module's body is held fast where it is drawn, as if bolted down: that alone carries the robot, and
/// there is nothing else around it. `off` lets the robot float.
///
/// `dynamics` is the assumption under which forces and travel of robots with joints are judged. Under `full`, servos and
/// contacts yield, links have inertia, what slides is dragged, links must stay apart as servos yield, and no joint may
/// change its speed at once. Under `statics`, the assumption of the papers, every instant is judged at rest: there is no
/// inertia, and the ground's forces are the best that friction allows. Lattices, folded sheets and trusses have assumptions
/// of their own.
///
/// A `slope` is `terrain` for a robot of modules that is `settle`: it is put down as it was drawn, leaning with the ground or
/// not, as it then falls less, and tips where the line of gravity through its centre of mass leaves what supports it. It must
/// not slide: the friction of what bears it, at least the tangent of the angle, holds its weight along the slope. `simulate`
/// plays such a plan on the same slope. Uneven ground is no terrain of a verdict.
///
/// Example:
/// ```modl
/// use std.smores.{Chain3, Tank7}
/// print(verify(Chain3(), world: world(ground: off, gravity: off)).ok)
/// let uphill = world(terrain: slope(5deg), friction: 0.8)
/// print(verify(Tank7().drive(t: 1s), world: uphill).displacement.z > 5mm)
/// ```
extern fn world(
  ground: settle | fixed | held | off = settle,
  gravity: off | Acceleration = 9.80665m/s^2,
  friction: Number = 1,
  dynamics: statics | full = full,
  terrain: Terrain?,
) -> World

/// The positions of all joints, the bonds, and where the robot is.
extern type State {
  /// When, in the plan that it was taken from.
  time: Time
  /// The pose of the base module's body in the world.
  base: Pose
  /// The centre of mass in the world.
  com: Vec3<Length>
  /// How far the centre of mass is inside the area that the robot stands on, negative outside; missing where
  /// nothing stands, or the plan's `unstable_for` lets support be missing.
  margin: Length?
  /// The least distance between links that may not touch; missing where no two such links are.
  clearance: Length?
  /// The position of a joint that turns.
  fn angle(joint: Joint<Angle>) -> Angle
  /// The position of a joint that slides.
  fn displacement(joint: Joint<Length>) -> Length
  /// The speed of a joint.
  fn speed<D: Dimension>(joint: Joint<D>) -> Quantity<D/s>
  /// The torque that a joint's motor supplies, as `torque` says; missing where the judge knows none.
  fn torque(joint: Joint<Angle>) -> Torque?
  /// The force that the motor of a joint that slides supplies, as `force` says; missing where the judge knows none.
  fn force(joint: Joint<Length>) -> Force?
  /// The normal force of the ground on a module or a part, as `ground_force` says; missing where the judge knows
  /// none.
  fn ground_force(on: Config) -> Force?
  /// The forces of the ground with which the judge weighs the robot; missing where it knows none.
  fn contacts() -> List<Contact>?
  /// The pose of a module's body or of a port in the world.
  fn pose(of: Module | Port) -> Pose

  /// The state of one of the robots of a scene: of its joints and modules alone.
  ///
  /// Its `base` and `com` are the robot's own; `margin` and `clearance` are its own with what is docked with it, and
  /// `clearance` counts what is near it. `plan(behaviour, from: p.end.of(s.a))` begins a behaviour of that robot alone there.
  fn of(robot: Config) -> State
}

/// A force of the ground on a robot.
extern type Contact {
  /// The path name of the module that it acts on.
  module: Text
  /// The point of application in the world.
  point: Vec3<Length>
  /// The force in the world. Evenly spread forces are vertical; the best ones use friction.
  force: Vec3<Force>
}

/// A motion of a robot from beginning to end, whatever made it.
extern type Plan {
  /// From beginning to end.
  duration: Time
  /// How many actions it carries out, repetitions counted.
  actions: Int
  /// Whether it depends on sensors or timeouts, so that it is only what happens if nothing disturbs it.
  nominal: Bool
  /// How many stretches there are between one change of commands and the next.
  steps: Int
  /// The state at the beginning.
  start: State
  /// The state at the end.
  end: State
  /// The surroundings that it is judged under (of its first part).
  assumes: World
  /// The state at a time.
  fn at(time: Time) -> State
  /// The part of the plan within a range of times.
  fn slice(times: Range<Time>) -> Plan
  /// Evenly spaced times from 0 to `duration`, both included, no further apart than `step`.
  fn times(step: Time = 10ms) -> List<Time>
  /// The values of a signal at `times(step)`: `p.series(angle(j))`, `p.series(pose(port))`.
  ///
  /// A value that the judge does not know at one of these times is refused; `states` tells what is known.
  fn series<T>(of: Signal<T>, step: Time = 10ms) -> List<T>
  /// The states at `times(step)`: `[s.com for s in p.states()]`.
  fn states(step: Time = 10ms) -> List<State>
}

/// What the verifier found.
///
/// A margin or clearance is the worst one found; it is infinite where nothing limits it.
extern type Report {
  /// Whether nothing failed.
  ok: Bool
  /// The least distance between links that may not touch; negative where they overlap.
  clearance: Length
  /// How far the centre of mass stays inside the area that the robot stands on; negative outside.
  margin: Length
  /// What the joints' torque limits leave: 1 - load / limit.
  torque_margin: Number
  /// What the connections leave of the load that they hold: 1 - load / limit.
  bond_margin: Number
  /// What the speed limits leave: 1 - speed / limit.
  speed_margin: Number
  /// Of a truss that carries its weight: what its struts leave of the force that they bear, where forces are distributed
  /// as well as can be.
  force_margin: Number
  /// Of a truss that carries its weight: the same where nobody adjusts them; negative where they would bear too much.
  elastic_margin: Number
  /// The greatest speed with which a link comes down on the ground, under full dynamics: what that costs is not in
  /// `torque_margin`.
  impact: Speed
  /// Of a truss that keeps one: the least angle between struts that share a node.
  angle: Angle
  /// Of a truss that keeps one: the least singular value of its rigidity matrix (rows of unit vectors) that
  /// belongs to no rigid motion, at the keyframes.
  rigidity: Number
  /// How far the base is from where it began, along the ground.
  travel: Length
  /// From where the base began to where it ends.
  displacement: Vec3<Length>
  /// How far the base has turned about the vertical; whole turns count.
  heading: Angle
  /// The distance from where the base is said to end within which it ends, under full dynamics on the ground: more where
  /// contacts scrub, and infinite where nothing is said of it.
  travel_within: Length
  /// The angle within which `heading` is known; infinite as `travel_within` is.
  heading_within: Angle
  /// The most that a loaded link has slipped over the ground in all.
  slip: Length
  /// From beginning to end.
  duration: Time
  /// The least mechanical work that the motors do.
  energy: Energy
  /// How many states were judged.
  samples: Int
  /// What failed, in words, in order of time.
  failures: List<Text>
  /// Every check with its status: proved, within tolerance, sampled, not checked (why), no limit stated, failed.
  checks: List<Text>
  /// The worst values with their times and modules.
  worst: List<Text>
  /// What is worth saying although nothing failed.
  notes: List<Text>

  /// What the verifier found of one of the robots of a scene, alone and docked with others.
  ///
  /// Travel and heading are those of the robot's base; what happens between robots is that in which it takes part.
  fn of(robot: Config) -> Report
}

/// Turns a behaviour into a plan: when each joint is where.
///
/// `from` is the state that it begins in; without it, the start pose of the robot. One robot is put down with its base as drawn,
/// but for one that has tipped on the ground where it goes on, which begins as it lies. Two commands to
/// one joint at one time, a limit that is not kept and a robot that would still move at the end are
/// refused.
///
/// Example:
/// ```modl
/// use std.smores.Driver1
/// let d = Driver1()
/// let there = plan(d.drive(t: 1s))
/// let back = plan(d.drive(-2rad/s, t: 1s), from: there.end)
/// print((there ++ back).duration)
/// ```
extern fn plan(behavior: Behavior, from: State?, world: World?) -> Plan

/// A plan that `emit` wrote before, from a file of this project, as a plan of `robot`: one that starts as the
/// plan's own robot did, with the same modules connected in the same way in the same posture.
///
/// Modules take the names that they have in `robot`. Nothing of the file is believed: `emit` has the judge
/// look at the plan again. So ways that took long to find are kept: of n shapes n plans to the snake make
/// all reconfigurations.
///
/// Example:
/// ```modl check
/// use std.rofi.{Chair, Spider}
/// let chair = load_plan("plans/chair.plan.json", Chair())
/// let spider = load_plan("plans/spider.plan.json", Spider())
/// emit(chair ++ reverse(spider), "chair-to-spider.plan.json")
/// ```
extern fn load_plan(file: Text, robot: Config) -> Plan

/// The plan run backwards, from its end to its beginning.
///
/// Example:
/// ```modl
/// use std.smores.Chain3
/// print(reverse(plan(Chain3().half_wave())).duration)
/// ```
extern fn reverse(plan: Plan) -> Plan

/// The plan along the same path in least time: time-optimal path parameterisation (TOPP-RA, Pham and Pham 2018).
///
/// All joints go the same way together, as fast as the limits of speed and acceleration of each joint and motor allow;
/// every joint that moves needs a `max_accel`. Robots that are moved under `dynamics: full` leave `reserve` of the limits
/// of torque, too, inertia included, as `verify` asks for. Where nothing moves, the time stays as it is: pauses are
/// meant. Where a joint would change its speed at once, and where something docks or undocks, the robot comes to rest.
///
/// Example:
/// ```modl
/// module Hinge {
///   link stand = box(40mm, 40mm, 40mm, mass: 1kg)
///   link arm = box(10mm, 10mm, 100mm, mass: 100g) at [0mm, 0mm, 80mm]
///   joint turn : stand -> arm = revolute(axis: Z, max_speed: 2rad/s, max_accel: 4rad/s^2)
/// }
/// config Turner { part hinge: Hinge }
/// let t = Turner()
/// let slow = plan(move(t.hinge.turn, to: 3rad, in: 10s), world: world(ground: held))
/// print(slow.duration, "{fastest(slow).duration:.3}")
/// ```
extern fn fastest(plan: Plan, reserve: Number = 0.15) -> Plan

/// Judges a plan, or the start pose of a robot, and reports.
///
/// A behaviour is planned first. `sample` is the longest time between two states that are looked at;
/// what happens between them is bounded, and looked at more closely where the bound does not
/// suffice. `unstable_for` is how long support may be missing at a stretch. `stability` is the rule:
/// the `footprint` of the ground contacts, or the paper's, the `centres` of the lowest modules.
/// `reserve` is the part of each limit of torque, force and bond load that must be left under `dynamics: full`, from 0 to 1.
/// `slip_max` is the most that any loaded link may slip over the ground in all; without it, slip is only reported.
/// `slip` is the part of their own speed by which wheels and feet may slip: for each docking between robots `notes` says how far
/// apart the ports may then be, and by which angle.
/// `world` judges under other surroundings than the plan's own.
///
/// The first line of the report says under which dynamics the plan was judged: for robots with joints `full dynamics`, unless
/// the world says `statics` (see `world`).
///
/// Example:
/// ```modl
/// use std.smores.Car
/// let r = verify(Car().drive(t: 1s))
/// print(r.ok, r.travel, r.clearance)
/// ```
extern fn verify(
  what: Plan | Behavior | Config,
  sample: Time = 10ms,
  unstable_for: Time = 0s,
  stability: footprint | centres = footprint,
  world: World?,
  reserve: Number = 0,
  slip_max: Length?,
  slip: Number = 0.05,
) -> Report

/// Computes the rows of a study and lists them, in the order of its table.
///
/// Rows that end with an error are left out; a study all of whose rows do is refused. `modl study FILE --out DIR` computes
/// the same rows on all processors, and keeps them in a table.
///
/// Example:
/// ```modl
/// record Area { area: Area }
/// study rectangles(a in [1m, 2m], b in 1m..3m) by grid(b: 3) = Area(area: a * b)
/// print(max([row.area for row in rows(rectangles)]))
/// ```
extern fn rows<R>(study: Study<R>) -> List<R>

/// Computes a study by `cmaes` and gives its best row; of equal ones the first.
///
/// Rows that end with an error count as the worst.
///
/// Example:
/// ```modl
/// record Cost { x: Number, cost: Number }
/// study valley(x in -4..4.0) by cmaes(minimise: cost, budget: 60) = Cost(x: x, cost: (x - 1) ^ 2)
/// print(abs(best(valley).x - 1) < 0.01)
/// ```
extern fn best<R>(study: Study<R>) -> R

/// Plays a plan on the robot as rigid bodies: what it really does, also where motors are too weak, feet slip or it falls.
///
/// Servos hold their joints as the modules state (`stiffness`, `armature`, `max_torque`; see `revolute`), links touch the
/// ground and each other with friction, bonds break at what their connectors hold, ports dock where they are within
/// `capture`. The robot stands for 0.3 s before the plan begins, and for 0.3 s after it has ended. A verdict and a
/// simulation are independent of each other: `emit` asks the judge alone, and `notes` says where the two disagree.
///
/// `step` is the time step; the plan is played at half of it, too, and `notes` says what that changes. `friction` is a
/// factor on the friction of all links besides that of the world; `stiffness` the stiffness of all servos that turn, with
/// that of servos that slide at a lever of 0.1 m, instead of what the modules state.
///
/// On a `terrain` the robot stands at the start as it does on level ground, but leaning with the plane that lies best through
/// the ground under its feet. The points of links touch the terrain: a peak that is thinner than a link, so that it comes
/// between them, is not felt. A plan whose world is a `slope` is played on that, without another terrain.
/// `obstacles` are shapes in the world that stand fast, `placed` where they are; their friction is
/// 0.5, or that of a rougher link on them. No verdict is about such ground, or knows of obstacles.
///
/// With `runs` above 0, the plan is played so many times more, with friction, masses, the greatest torques and forces of
/// motors, and the stiffness of servos drawn by `seed`: a spread of 0.2 is a factor that is uniform from 0.8 to 1.2, one
/// for the whole robot. `joint_spread` is the most by which the zero of each joint that turns is off, drawn for each joint.
///
/// Example:
/// ```modl
/// use std.smores.Driver1
/// let s = simulate(Driver1().drive(t: 1s), runs: 4, friction_spread: 0.3, mass_spread: 0.1)
/// print(s.fell, s.falls, s.travel > 60mm)
/// ```
extern fn simulate(
  what: Plan | Behavior | Config,
  step: Time = 0.5ms,
  friction: Number = 1,
  stiffness: Quantity<N*m/rad>?,
  runs: Int = 0,
  seed: Int = 0,
  friction_spread: Number = 0,
  mass_spread: Number = 0,
  torque_spread: Number = 0,
  stiffness_spread: Number = 0,
  joint_spread: Angle = 0deg,
  terrain: Terrain?,
  obstacles: List<Shape> = [],
) -> Simulation

/// What happens when a plan is played.
extern type Simulation {
  /// How long the motion took: as planned, or as the program went that was executed.
  duration: Time
  /// How far the base is from where it stood, seen from above, 0.3 s after the end.
  travel: Length
  /// From where the base stood to where it is then.
  displacement: Vec3<Length>
  /// How far the base has turned about the vertical: whole turns count, as in a `Report`.
  heading: Angle
  /// How far the base leans from how it stood, at the end.
  lean: Angle
  /// Whether a robot dropped, toppled or collapsed; one that a fixture holds does not fall.
  fell: Bool
  /// When one was first found to.
  fell_at: Time?
  /// The farthest that a joint that turns was behind the plan.
  lag: Angle
  /// The farthest that a joint that slides was behind the plan.
  slide_lag: Length
  /// The greatest torque or force of a motor as the mean over 50 ms, in parts of its limit.
  torque: Number
  /// The longest time that one motor was at its limit in all.
  saturated: Time
  /// The greatest load of a bond, in parts of what it holds.
  bond_load: Number
  /// The greatest distance of two ports from each other when they docked, or were to dock and missed each other.
  dock_error: Length
  /// The greatest angle between two such ports and a perfect mate.
  dock_angle: Angle
  /// The farthest that a link slid over the ground in all while it pressed on it.
  slip: Length
  /// The greatest speed at which a link came down on the ground.
  impact: Speed
  /// The mechanical work that the motors did; what drives them gives nothing back.
  energy: Energy
  /// When the motion was kept: every 20 ms from the beginning of the plan on; of motions longer than 80 s every 40 ms, and so
  /// on.
  times: List<Time>
  /// Where the base was at these times.
  path: List<Vec3<Length>>
  /// In how many of the further runs a robot fell.
  falls: Int
  /// In how many of the further runs a bond broke.
  breaks: Int
  /// In how many of the further runs ports that were to dock missed each other.
  misses: Int
  /// In how many of the further runs the program was stopped before its end, as by `abort`.
  stops: Int
  /// In how many of the further runs any of that happened.
  fails: Int
  /// How far the base got, seen from above, in each of the further runs.
  travels: List<Length>
  /// Falls, bonds that broke, ports that did not dock, and why a program was stopped, in words, in order of time.
  failures: List<Text>
  /// What half the step changes, where the verdict on the plan says otherwise, and the mildest of the further runs in
  /// which something failed.
  notes: List<Text>

  /// The values of a signal at `times`, as they were measured: `s.series(angle(j))`, `s.series(pose(m))`. Torques and forces are
  /// means over 50 ms.
  fn series<T>(of: Signal<T>) -> List<T>
}

// Planners. Where there is a search, `seed` makes another choice among equals (`auto`: that of the command line, 0
// unless it is given), `budget` bounds the work in steps, `timeout` can only turn a result into a refusal.

/// A flat pattern: panels side by side, joined along the hinges that will fold.
extern type Layout {
  /// How many panels.
  panels: Int
  /// The hinges that fold: pairs of faces of the target.
  hinges: List<List<Int>>
  /// Pairs of panels that lie on each other in the plane.
  overlaps: List<List<Int>>
}

/// A hinge that stops on its way while others fold, and goes on later.
extern type HingeStop {
  /// The face whose hinge to the face that carries it it is.
  face: Int
  /// The step at whose end it stops: a place in the `order` of the folding, from 0.
  step: Int
  /// The angle at which it stops, from flat.
  angle: Angle
}

/// What `fold` found: the layout, the order of folding, and the motion.
extern type Folding is Plan {
  /// The motion from flat to folded.
  plan: Plan
  /// The flat pattern that was chosen.
  layout: Layout
  /// How many flat patterns there are: spanning trees of the target's faces.
  layouts: Int
  /// What the motors spend, in the measure of the origami-folding paper: the sum of mean torques.
  energy: Energy
  /// The greatest torque of a hinge that counts.
  peak_torque: Torque
  /// No folding that this one was chosen from has a lower peak torque, where that was minimised; else, none
  /// spends less energy, or none in as few steps, where these were minimised. Chosen from are all layouts that
  /// lie flat and pass the verifier, with the roots that the call allows: leaves first or root first, if `sequence`
  /// asks for that, or stands for it, and a layout passed so; else in any order, and where hinges stop on their way, in any
  /// order with such stops. Never above the value of this one; 0 where no bound is known.
  bound: Energy
  /// What the proof leaves open: the part of the energy, or of the peak torque, by which the bound is
  /// below it; 0 where that is less than 4e-9.
  gap: Number
  /// What is proved, or how much less another folding may take, and what its order gains or costs, in words.
  why: Text
  /// No layout folds in fewer steps.
  fewest_steps: Int
  /// Whether it is proved that none of the foldings that `bound` is about is better: the gap is 0, and where
  /// steps were minimised, none takes fewer.
  optimal: Bool
  /// What was minimised, by the least that was found with the leaves first where patterns may overlap and
  /// panels may meet; below 1 where another order is better than that.
  price: Number
  /// The faces that could stay on the ground for an equally good layout, as far as they were looked for.
  ties: List<Int>
  /// How many pairs of a layout and a root are known to be equally good; where every layout was looked
  /// at, all.
  tied: Int
  /// The face that stays on the ground.
  root: Int
  /// The faces that fold in each step. One whose hinge stops on its way is in several.
  order: List<List<Int>>
  /// The hinges that stop on their way, in the order of the steps; none where each folds in one step.
  stops: List<HingeStop>
  /// The work of lifting and lowering panels under gravity in this order (Eq. 17 of the paper), the
  /// root on the ground with its outside down.
  lifting: Energy
  /// No order of this layout lifts and lowers less.
  lifting_bound: Energy
  /// The faces whose hinges are too thick to close, where `hinge_radius` was given.
  too_thick: List<Int>
  /// The folded robot.
  robot: Config
  /// The joints of the folded robot, in the order of the layout's hinges.
  hinges: List<Joint<Angle>>
}

/// Finds the flat pattern of panels for a shape that folds for the least energy, the order in which to
/// fold it without collisions, and the motion.
///
/// The target is a mesh whose faces are flat and convex, each edge of which joins two of them at most; panel `i`
/// becomes face `i`. It may come from a file: `load_mesh`, or `mesh` where it is closed.
///
/// The module is a panel with a hinge at each of its edges. A regular one is for faces that are as it is; of a list of
/// modules each face takes the first that is as the face. One with a parameter `sides`, as the triangle `Panel` of
/// `std.mori`, or `corners`, as its `Polygon`, is made to measure for each face. `root` is the face that stays where it is;
/// without it, the best is found.
///
/// `exact` proves its answer without looking at every layout, where it can; `enumerate` looks at every
/// one; `heuristic` takes the one that the paper's own measure prefers. Where panels meet on the way, the
/// next best layout is sought, then other orders are tried: `order` and `price` tell. Where no order is free of collisions,
/// hinges may stop on their way while others fold: `stops` names them.
///
/// `minimise` says what is to be small: the `energy`, over layouts and orders of folding together; or, with the
/// leaves folded first, the greatest torque, or the steps, and then the energy. It is measured under stated conventions. `inertia`: panels are
/// even polygons without thickness, with the module's thickness (`prism`), or points. `gravity`: none,
/// or the root lies on the ground with its outside down, which is then the plan's world. `count`: the
/// torques of the joints that move, while the others are locked, or of `all`. Only with what stands
/// first is there a closed form and a proof for large shapes; else every layout is simulated where they
/// are few, and good ones are improved by exchanges where they are many.
///
/// `sequence` is the order of folding: sought together with the layout for the least energy (`auto`; where gravity,
/// locked joints, torques or steps count, it is leaves first), `leaves_first`, `root_first`, the one that lifts
/// and lowers the least (`least_work`), or that of the least energy for the layout that is best with the leaves first. The faces in `passive` have no
/// motors and are made of `passive_module`; two of them share no hinge. With the radius of the hinges
/// it is said which can't close as far as they should. `hinges` gives the layout, as pairs of faces;
/// then it is folded so or not at all. `step` is how long each step takes; by default
/// as long as the fastest hinge needs. `budget` bounds the search: layouts that are looked at, faces that
/// paths pass; where it ends the search, the best so far is the answer, and `gap` tells how far the proof came. `seed` makes another choice
/// among equals. Without gravity there is no ground either.
///
/// Example:
/// ```modl
/// use std.mori.Mori
/// use std.shapes.octahedron
/// let octa = fold(octahedron(edge: 80mm), module: Mori)
/// print(octa.layouts, octa.optimal, octa.steps)
/// print(verify(octa).ok)
/// ```
extern fn fold(
  target: Mesh | Shape,
  module: Module | List<Module>,
  root: auto | Int = auto,
  method: exact | heuristic | enumerate = exact,
  step: auto | Time = auto,
  seed: auto | Int = auto,
  budget: Int = 100_000_000,
  minimise: energy | peak_torque | steps = energy,
  inertia: lamina | prism | point = lamina,
  gravity: off | on = off,
  count: moving | all = moving,
  sequence: auto | leaves_first | root_first | least_work | least_energy = auto,
  passive: List<Int> = [],
  passive_module: Module?,
  hinge_radius: Length?,
  hinges: List<List<Int>>?,
) -> Folding

/// What orders of folding taken at random spend.
extern type OrderSample {
  /// How many were looked at.
  orders: Int
  /// Which part of them spends more than the order that they are compared with.
  worse: Number
  /// The least energy.
  least: Energy
  /// The mean energy.
  mean: Energy
  /// The greatest energy.
  greatest: Energy
}

/// Compares the order of a folding with others of the same layout, taken at random: the Monte-Carlo
/// comparison of the origami-folding paper. Each is laid into as few steps as keep its cost, and
/// measured under the conventions of the folding. The same `seed` takes the same orders.
///
/// Example:
/// ```modl
/// use std.mori.Mori
/// use std.shapes.octahedron
/// print(random_orders(fold(octahedron(edge: 80mm), module: Mori), orders: 100).worse > 0.5)
/// ```
extern fn random_orders(of: Folding, orders: Int = 1000, seed: Int = 0) -> OrderSample

/// How the flat patterns of a shape compare.
extern type LayoutComparison {
  /// How many were looked at.
  layouts: Int
  /// Whether these are all that there are; else they are taken at random, each as likely as any other.
  complete: Bool
  /// What each takes with the leaves folded first, as the folding was measured.
  energies: List<Energy>
  /// Which takes the least, counted from 0.
  best: Int
  /// The least energy.
  least: Energy
  /// The energy in the middle: half of them take more.
  median: Energy
  /// The greatest energy.
  greatest: Energy
  /// The place of the folding's own pattern among them, with the leaves folded first: 1 if none takes less.
  rank: Int
  /// Which one the measure of the origami-folding paper prefers (its Method II), counted from 0.
  preferred: Int
  /// The place of that one.
  preferred_rank: Int
  /// The hinges of one, counted from 0, as pairs of faces: what `fold` takes as `hinges`.
  fn hinges(layout: Int) -> List<List<Int>>
}

/// Compares the flat patterns of the shape of a folding, with its root, as it was measured: all if there are at most
/// `most`, else as many at random. Patterns that overlap, or whose panels meet on the way, are among them. The same
/// `seed` takes the same ones.
///
/// Example:
/// ```modl
/// use std.mori.Mori
/// use std.shapes.octahedron
/// let all = compare_layouts(fold(octahedron(edge: 80mm), module: Mori))
/// print(all.layouts, all.rank, all.median > all.least, len(all.hinges(all.best)))
/// ```
extern fn compare_layouts(of: Folding, most: Int = 10_000, seed: Int = 0) -> LayoutComparison

/// What `fold_sheet` found: the motion of a sheet whose creases fold together.
extern type SheetFolding is Plan {
  /// How many panels.
  panels: Int
  /// How many creases, which all are hinges.
  creases: Int
  /// How many vertices are inside, each with a loop of creases.
  loops: Int
  /// How many angles could be chosen freely at the folded form: 1 where one hinge moves all others.
  freedom: Int
  /// The greatest rotation that is left over round a vertex on the planned way.
  opening: Angle
  /// Why the sheet folds so: what its loops leave free, and how closely they stay closed, in words.
  why: Text
  /// How far each crease folds: positive where it is convex as seen from outside.
  angles: List<Angle>
  /// The sum over all hinges of the mean of their torque, as of `fold`. Loops leave open how hinges share it: of all
  /// torques that cause the motion, those with the least sum of squares are taken. Nothing where the sheet lies on the
  /// ground, whose forces are not planned.
  energy: Energy?
  /// The greatest of these torques.
  peak_torque: Torque?
  /// The folded robot.
  robot: Config
}

/// Folds a flat sheet of panels along all its creases at once, without a cut.
///
/// The target is the folded form: an open mesh of flat convex faces that come to a full turn round each vertex inside, as
/// `load_creases` gives it, or `miura` of `std.shapes`. Every edge between two faces is a hinge. The creases round a
/// vertex close a loop, so their angles go together; the way from flat to the folded form on which all loops stay closed
/// is found by continuation, backwards, and the verifier judges the motion with the loops. The face `root` stays where it
/// is. `time` is how long the motion takes, by default as long as the fastest hinge needs.
///
/// `ground` is the world, as that of `world`: nothing weighs (`off`), the root is `held` fast with its front up and carries
/// all others, or the sheet lies on the ground with its front up and rests on what touches it as it folds (`settle`). With
/// weight, the verifier asks of every instant at rest if forces of the ground and of the loops exist with which no hinge
/// is overloaded.
///
/// The module is a panel as for `fold`.
///
/// Example:
/// ```modl
/// use std.mori.Polygon
/// use std.shapes.miura
/// let sheet = fold_sheet(miura(rows: 2, columns: 2, along: 80mm, across: 80mm, sector: 60deg, fold: 40deg), module: Polygon)
/// print(sheet.panels, sheet.creases, sheet.loops, sheet.freedom, verify(sheet).ok)
/// ```
extern fn fold_sheet(
  target: Mesh | Shape,
  module: Module | List<Module>,
  root: Int = 0,
  time: auto | Time = auto,
  ground: off | settle | held = off,
) -> SheetFolding

/// What `refold` found: the motion from shape to shape, and what it takes.
extern type Refolding is Plan {
  /// How many connections are undone in the plane, and as many made.
  changes: Int
  /// No way between the two needs fewer changes.
  bound: Int
  /// What the proof leaves open: the part of the changes by which the bound is below them; 0 where it proves them.
  gap: Number
  /// What is proved of the number of changes, in words.
  why: Text
  /// How many panels hang on the shape with fewer faces in a flat strip.
  flat: Int
  /// By panel, which is a face of the first shape: the face of the second shape that it becomes. Numbers after those of a
  /// shape's faces are of panels that are left flat.
  becomes: List<Int>
  /// What unfolding and folding spend with the leaves folded first and unfolded last, in the measure
  /// of the origami-folding paper: the sum of mean torques.
  energy: Energy
}

/// Unfolds one shape into a flat sheet, changes connections there, and folds the sheet into another.
///
/// Both are meshes of triangles with the panels' sides. Where one has fewer, the other panels hang on it in a flat strip: at
/// its boundary, or at an edge of a closed surface that is slit there, where its end is farthest away. Sheets of the two are looked for that
/// have much in common, and a way from the one to the other with few changes. A connection is made at the
/// instant at which an old one goes, so the robot stays in one piece. Either both are between panels that
/// lie side by side; or three to five panels about a point close like a corner of the tetrahedron, the
/// octahedron or the icosahedron, two of them let go, and the others open again: so panels walk in the
/// plane. Of ways with equally many changes those are tried first whose shapes take the least energy to
/// fold, until the judge lets one through. `budget` bounds the search: cells of sheets that are weighed.
/// `seed` leads to other sheets.
///
/// Example:
/// ```modl
/// use std.mori.Mori
/// use std.shapes.{octahedron, boat}
/// let there = refold(octahedron(edge: 80mm), boat(edge: 80mm), module: Mori)
/// print(there.changes, there.bound, verify(there).ok)
/// ```
extern fn refold(
  from: Mesh | Shape,
  to: Mesh | Shape,
  module: Module,
  step: auto | Time = auto,
  seed: auto | Int = auto,
  budget: Int = 20_000_000,
) -> Refolding

/// What `squeeze` found. What cells go through is what the verifier finds.
extern type Squeezing is Plan {
  /// No motion under the same limits takes less.
  lower_bound: Time
  /// The duration by the lower bound; 1 where both are zero.
  ratio: Number
  /// The part of the duration by which the lower bound is below it; 0 where the bound proves that nothing takes less.
  gap: Number
  /// The greatest force over a contact of two cells.
  peak_force: Force
  /// The greatest speed of a cell.
  peak_speed: Speed
  /// The most kinetic energy of all cells together.
  peak_energy: Energy
  /// The greatest angular momentum about the centre of mass.
  angular_momentum: Quantity<kg*m^2/s>
  /// Whether the angular momentum stays zero, so that a free robot is not turned.
  balanced: Bool
  /// `accordion`, `fold`, `shear`, `arms`, `merge`, `push`, `melt`, `spin` or `tunnel`.
  method: Text
  /// Why this method was taken.
  why: Text
  /// The stages with their durations, in words.
  stages: List<Text>
}

/// Moves expanding cubes from one shape to another, in a time that grows with the square root of their
/// number.
///
/// Rows, columns, boxes and all connected shapes in a plane are taken to each other. `accordion` keeps
/// the size of the cells; `fold` is the way of the kinodynamic-reconfiguration paper; `shear` takes a
/// row to a column in the least time that there is, and turns the robot by a quarter, so that something
/// outside has to hold it; `arms` takes a row to a column in little more, and is balanced where the number
/// of cells is a multiple of four, or one more; `merge` is for shapes in a plane. `push` lays the one shape
/// over the other and moves whole lines of cells on by one cell, in a plane and in space, so that little
/// has to move where the two are alike. `melt` takes any shapes of up to 400 cells to each other, cell after
/// cell, in a time that grows with their number. `spin` takes most shapes in a plane, of up to 400 cells, to each other without a
/// turn, as pairs of cells spin against all that moves; that takes many times as long. `auto` takes the fastest that the
/// model allows.
///
/// Cells that state `slides false` hold each other only where the middles of their faces meet. They change places by
/// `tunnel`, which `auto` takes of them: both shapes consist of blocks of 2 × 2 × 2 cells, which `enlarged` makes, and
/// blocks go through others to where one is missing, in a time that grows with the number of these.
///
/// `model` says whether a free robot has to be able to do it: `balanced` keeps the angular momentum at
/// zero, `paper` does not ask for it; `auto` takes a balanced way where a quick one is known, and else one that
/// turns little. `spin` is taken where `balanced` is asked for and no quick way is. `max_force` bounds the force over a contact of two cells: plans slow down to keep it.
/// With the `profile` `trapezoid`, stages whose cells get to their greatest speed keep it for a while. A
/// cell's force bounds its acceleration along each axis, as in the paper; with the `norm` `euclidean`, its
/// length.
///
/// There is neither gravity nor ground, as in the paper. The result ends as asked up to a translation.
///
/// `fixed` are cells of both shapes that stay where they are, as those of a base that is bolted down: the others push
/// off from them, and neither centre of mass nor angular momentum is kept. `obstacles` are whole cells of the lattice
/// that the robot keeps clear of; they need fixed cells, for a robot that floats recoils. Then both shapes stand
/// where they are drawn, and `push` is the method, or `tunnel`.
///
/// `sides` are those of every cell at the end, along x, y and z in parts of its size: the second shape is
/// squeezed then, in one more stage, about its centre of mass. `squeeze(Bar, Bar, sides: [0.5, 1, 1])` is the squeeze
/// problem of the paper, and its `reverse` the expansion of a row of half cells.
///
/// Example:
/// ```modl
/// use std.crystal.ExpandingCube
/// lattice Bar of ExpandingCube = row(8)
/// lattice Pole of ExpandingCube = column(8)
/// let p = squeeze(Bar, Pole)
/// print(p.duration, p.lower_bound, p.method, p.peak_force)
/// ```
extern fn squeeze(
  from: Lattice,
  to: Lattice,
  method: auto | accordion | fold | shear | arms | merge | push | melt | spin | tunnel = auto,
  model: auto | balanced | paper = auto,
  max_force: Force?,
  profile: bang_bang | trapezoid = bang_bang,
  norm: each_axis | euclidean = each_axis,
  fixed: Cells?,
  obstacles: Cells?,
  sides: Vec3<Number> = [1, 1, 1],
) -> Squeezing

/// What `tosnake` found.
extern type Unwinding is Plan {
  /// How many connections are made on the way.
  docks: Int
  /// How many connections are let go on the way.
  undocks: Int
  /// No plan to a snake of these modules makes and lets go of fewer connections together.
  fewest_changes: Int
  /// What the changes of connections are for, and whether fewer would do, in words.
  why: Text
  /// How far all joints turn, together.
  joint_travel: Angle
  /// How many pairs of ends were tried.
  tried: Int
  /// How many poses of the robot the search worked out; `budget` bounds it.
  work: Int
}

/// Unwinds a robot to a snake: one straight chain of all its modules; of RoFI modules, dock -Z on dock -Z.
///
/// Connections that close loops are let go. Then two chains at a time become one: the joints between
/// their ends bend until the ends meet and dock, and a connection of the loop that this closes is let
/// go. All joints of a step turn at once; the robot never falls apart, and its modules never meet, at
/// any instant.
///
/// The same robot and `seed` give the same plan. `budget` bounds the poses that the search works out; a
/// search that takes longer than `timeout` is refused, too. Both refusals say how far it got; another
/// seed may get farther.
///
/// Without gravity the robot floats. With `gravity: on`, or with an acceleration, its base module is held
/// fast where it is drawn, as if bolted down, and no joint ever has to hold more than its `max_torque`: ways
/// that are too heavy are not taken. What can't be done so is refused, with the joint, the torque, its limit
/// and what was to be done. Another `base` is held elsewhere.
///
/// `collisions` other than `motion` choose the paper's own method, to compare with: FABRIK over two
/// tentacles, and going back over pairs. Collisions are then looked for nowhere (`none`), in the states in
/// which tips meet (`detection`), or there and in the inverse kinematics (`avoidance`), and never on the
/// way. Such a plan comes back unjudged; `verify` says what is wrong with it, and `emit` does not write it.
///
/// Robots of other modules unwind, too, floating and by `motion`, if each module has two ports that mate with each other and
/// with their like, and joints between ports: its ends are of such ports the two that face opposite ways, with the most
/// joints that bend between them, the farthest apart. Robots of some ten modules take seconds, and the time grows with the cube of their number.
///
/// Example:
/// ```modl
/// use std.rofi.Ring
/// let p = tosnake(Ring(n: 8))
/// print(p.why, verify(p).ok)
/// ```
extern fn tosnake(
  robot: Config,
  gravity: off | on | Acceleration = off,
  seed: auto | Int = auto,
  budget: Int = 5_000_000,
  timeout: Time?,
  collisions: motion | none | detection | avoidance = motion,
) -> Unwinding

/// What `reconfigure` found.
extern type Reconfiguration is Plan {
  /// How many connections are made on the way.
  docks: Int
  /// How many connections are let go on the way.
  undocks: Int
  /// No plan makes and lets go of fewer connections together, whichever module becomes which.
  fewest_changes: Int
  /// How far all joints turn, together.
  joint_travel: Angle
  /// `direct`, `snake`, or `turning` where the connections are the same.
  way: Text
  /// Why this way was taken.
  why: Text
  /// How many pairs of docks were tried.
  tried: Int
  /// How many poses of the robot the searches worked out.
  work: Int
}

/// Turns one robot into another of as many modules. Options are those of `tosnake`.
///
/// There are two ways, and the one that takes less time is taken. Directly, connections that both have stay, and the
/// others are exchanged one after the other: two docks are brought together, and another connection of the loop that this
/// closes is let go. Through the snake, both unwind as by `tosnake`, and the second way is taken backwards. Held under gravity,
/// or with the paper's own method, it is always the snake, and so it is with other modules than RoFI's.
///
/// With `gravity: on, ground: settle` the robot is held by nothing: it rests on a level floor, and stands at every instant on
/// what touches it, with its centre of mass a hundredth of a pitch at least inside what supports it. Then it is always the direct
/// way. It begins and ends as the robots are drawn, if they stand so; a robot that falls over as it is drawn may begin or
/// end on any side on which it rests. Not every pair has a way that is found so.
///
/// The result ends as the second robot, with the first one's modules in its places. A way to the snake is
/// looked for once in a run.
///
/// Example:
/// ```modl
/// use std.rofi.{Spider, Crab, Fan, Dumbbell}
/// let p = reconfigure(Spider(), Crab())
/// print(p.docks, p.undocks, p.why, verify(p).ok)
/// let standing = reconfigure(Fan(), Dumbbell(), gravity: on, ground: settle)
/// print(standing.why, verify(standing).ok)
/// ```
extern fn reconfigure(
  from: Config,
  to: Config,
  gravity: off | on | Acceleration = off,
  ground: held | settle = held,
  seed: auto | Int = auto,
  budget: Int = 5_000_000,
  timeout: Time?,
  collisions: motion | none | detection | avoidance = motion,
) -> Reconfiguration

/// What `morph` found.
extern type Morphing is Plan {
  /// Root mean square distance of the target from the truss's outer surface, as in the linear-actuator-robots
  /// paper, over the whole target; of a cloud, over its points.
  rms: Length
  /// Root mean square distance of the outer surface from the target, over the whole surface.
  rms_back: Length
  /// The farthest that a point of either is from the other.
  worst: Length
  /// What `rms` was at the start.
  start_rms: Length
  /// The least distance between struts that share no node.
  clearance: Length
  /// `done`, or what it came to and which limits were in the way.
  ended: Text
}

/// Morphs a truss into a shape: its outer surface comes near the target, and the target near it.
///
/// The target is moved so that its middle is the middle of the nodes; it is not scaled. The outer surface
/// is that of the truss's hull, if triangles of struts make it up, else that of its tetrahedra of struts.
/// Each step is a quadratic program (Gauss and Newton's step for the distances both ways, with springs
/// in all struts that vanish) under the limits of the struts: length, and clearance between struts that
/// share no node, which hold between the steps, too. It is done when both distances, as root mean squares,
/// are within `tolerance`; after `budget` steps the best so far is given, with a warning.
///
/// Where the target is not reached in its own orientation, as many others as `orientations` says are tried, spread evenly
/// over all: each for some steps, the better ones for more, and the best two to their end. With 0 it keeps its own;
/// `seed` turns all others. Limits beside those of the struts are kept, too, and the verdict says how
/// nearly: `angle` between struts that share a node; `rigidity`, below which no singular value of the
/// rigidity matrix (rows of unit vectors) falls that belongs to no rigid motion, as the judge asks: `auto` is
/// 0.05, or an eighth of the value at the start if that is less; `failed` struts, by their names, that keep their length to 0.2 percent of a strut; `perimeters`, lists
/// of struts whose lengths keep their sum, as those of one tube do. After `timeout` there is no plan.
/// There is neither gravity nor ground, as in the paper; struts move as fast as their speed and `max_accel` allow.
/// `obstacles` are solids in the world, in which the truss begins where its nodes were declared: struts keep
/// their clearance from them.
///
/// Example:
/// ```modl
/// use std.shapes.cube
/// use std.truss.PneumaticReel
/// truss Pyramid of PneumaticReel = octet(edge: 4m, divisions: 4, interior: false)
/// let c = morph(Pyramid, cube(edge: 2m), tolerance: 50mm)
/// print(c.rms, c.rms_back, c.steps, c.ended)
/// ```
extern fn morph(
  truss: Truss,
  target: Mesh | Cloud,
  tolerance: Length = 20mm,
  budget: Int = 300,
  orientations: Int = 15,
  seed: auto | Int = auto,
  angle: Angle = 0deg,
  rigidity: auto | Number = auto,
  failed: List<Text> = [],
  perimeters: List<List<Text>> = [],
  timeout: Time?,
  obstacles: List<Shape> = [],
) -> Morphing

/// What `locomote` found.
extern type Travel is Plan {
  /// The length of the way that the centre of mass took over the ground.
  distance: Length
  /// How often the truss has rolled on.
  rolls: Int
  /// How often a node was put down beyond the edge of the support before the truss went there.
  footholds: Int
  /// How many places of the path were reached.
  reached: Int
  /// How far nodes slid over the ground, all together.
  slip: Length
  /// Steps that were made slower, or otherwise easier, because no ordinary step kept all limits.
  relaxed_steps: Int
  /// `arrived`, or what stopped it.
  ended: Text
}

/// Moves a truss so that its centre of mass goes along a path over the ground, and rolls it over the edge
/// of its support where the centre of mass gets there.
///
/// The places of the path are in the world, in which the truss begins where its nodes were declared, put
/// down on the ground at height 0 and fallen to where it rests; heights of the path mean nothing. A place
/// is reached within a quarter of a strut. Each step is a quadratic program under the limits of the
/// struts, with the `objective` of the linear-actuator-robots paper: `springs` keeps all struts near their
/// first length (17), `lengths` changes lengths as little as possible (14, with the motion of nodes beside
/// it, without which it gets stuck), `restoring` is `lengths` towards the first lengths, `fewest` moves
/// few struts (the sum of the rates' sizes; slower to plan); `auto` is `restoring`, which gets stuck the least, but `springs` for
/// 200 nodes and more, where it takes less time. `hold` says which nodes on the ground stay
/// where they are: `all`, or `three` around the centre of mass, while others slide; `auto` is `all`, but
/// `three` without `impact`. All nodes together slide no farther than `slip`: `auto` is 1 m with `all`, and no
/// limit with `three`. Forces that are in equilibrium at every node, with half the weight of each of its struts and
/// with friction of 0.8, stay within `max_force`; where no motion goes on, the plan ends, and says which strut bears
/// most. With `forces: false` they are not looked at: the plan then allows overload, which its verdict names first,
/// and tells the least force that the path needs. Where no step is found, easier ones are
/// tried, unless `fallbacks` is false: slower, with the centre free to sink, with the other hold, with the
/// other objective. Without `impact` it does not fall over an edge where it can put a node down beyond it
/// first, and takes about twice as many steps. `budget` is in steps. `angle`, `rigidity`, `failed`,
/// `perimeters`, `timeout` and `obstacles` are those of `morph`.
///
/// With a `terrain` the ground is not flat: nodes stand on it, and between its nodes a strut may be half
/// its clearance below, because nodes are thicker. Where it would fall into an obstacle, or with a strut on
/// uneven ground, it puts a node down first. With `lookahead`, a number of steps, the objectives and putting
/// nodes down are each tried for so many steps, the one that comes farthest in its time is taken, and where
/// all get stuck it goes back to an earlier choice: plans of two thirds of the time, for five times the work.
///
/// Gravity is taken to be slow: nothing swings, and a roll is a rigid turn. Where it ends short of its
/// path, the plan so far is given, with a warning.
///
/// Example:
/// ```modl
/// use std.truss.PneumaticReel
/// truss Pyramid of PneumaticReel = octet(edge: 2m, divisions: 2, interior: false)
/// let there = locomote(Pyramid, path: [[3m, 0m, 0m]])
/// print(there.distance, there.rolls, there.ended)
/// ```
extern fn locomote(
  truss: Truss,
  path: List<Vec3<Length>>,
  objective: auto | springs | lengths | restoring | fewest = auto,
  hold: auto | three | all = auto,
  fallbacks: Bool = true,
  budget: Int = 100_000,
  angle: Angle = 0deg,
  rigidity: auto | Number = auto,
  failed: List<Text> = [],
  perimeters: List<List<Text>> = [],
  timeout: Time?,
  impact: Bool = true,
  obstacles: List<Shape> = [],
  terrain: Terrain?,
  lookahead: Int = 0,
  slip: auto | Length = auto,
  forces: Bool = true,
  friction: Number = 1,
) -> Travel

/// A truss at rest as it is declared: a plan that lasts no time, for `move_nodes`, `merge_nodes` and `split_node` to go on
/// from.
///
/// With `weight` it stands on the ground at height 0, where its nodes have to be, with `friction` times the usual; without it
/// is weightless, and there is no ground. The judge looks at it as at the end of any motion: what bears its weight, and with
/// which forces.
///
/// Example:
/// ```modl
/// use std.truss.PneumaticReel
/// truss Pyramid of PneumaticReel = octet(edge: 2m, divisions: 2, interior: false)
/// print(verify(at_rest(Pyramid, weight: false)).ok)
/// ```
extern fn at_rest(truss: Truss, weight: Bool = true, friction: Number = 1) -> Plan

/// A truss's plan, and after it a motion of some nodes straight to other places, while all others stay.
///
/// `to` has a place in the world for each of `nodes`. The motion has so many `steps` of one length, each from rest to rest as
/// fast as the struts can change their lengths, and bear the truss while it accelerates. Nodes that are merged into one of
/// these go with it. Nothing is searched: that struts stay within their limits is for the judge to say.
///
/// Example:
/// ```modl
/// use std.truss.PneumaticReel
/// truss Tetra of PneumaticReel {
///   node a = [0m, 0m, 0m]  node b = [1m, 0m, 0m]  node c = [0.5m, 0.9m, 0m]  node top = [0.5m, 0.3m, 0.8m]
///   strut a -- b  strut b -- c  strut c -- a  strut top -- a  strut top -- b  strut top -- c
/// }
/// let up = move_nodes(at_rest(Tetra), nodes: ["top"], to: [[0.5m, 0.3m, 1m]])
/// print(up.duration, verify(up).ok)
/// ```
extern fn move_nodes(plan: Plan, nodes: List<Text>, to: List<Vec3<Length>>, steps: Int = 1) -> Plan

/// A truss's plan, at whose end a node merges into another that is in the same place: all its struts end there from then on.
///
/// The node rides along until `split_node` splits it off again. No strut may join the two, and no two struts may have the
/// same ends then. The judge asks that the truss is at rest, and that it keeps all limits with the struts as they were and
/// as they are: lengths, distances, rigidity, support and forces. That the passive joint of the node closes by itself is
/// assumed.
///
/// Example:
/// ```modl
/// use std.truss.PneumaticReel
/// // An octahedron, with a node on its lower corners and one on its upper ones.
/// truss Star of PneumaticReel {
///   node a = [1.15m, 0m, 0m]  node b = [-0.58m, 1m, 0m]  node c = [-0.58m, -1m, 0m]
///   node d = [-1.15m, 0m, 1.6m]  node e = [0.58m, 1m, 1.6m]  node f = [0.58m, -1m, 1.6m]
///   node g = [0m, 0m, 0.5m]  node h = [0m, 0m, 1.1m]
///   strut a -- b  strut b -- c  strut c -- a  strut d -- e  strut e -- f  strut f -- d
///   strut a -- e  strut a -- f  strut b -- d  strut b -- e  strut c -- d  strut c -- f
///   strut g -- a  strut g -- b  strut g -- c  strut h -- d  strut h -- e  strut h -- f
/// }
/// let met = move_nodes(at_rest(Star), nodes: ["h"], to: [[0m, 0m, 0.5m]])
/// let one = merge_nodes(met, node: "h", into: "g")
/// print(verify(one).ok)
/// ```
extern fn merge_nodes(plan: Plan, node: Text, into: Text) -> Plan

/// A truss's plan, at whose end a node that was merged into another takes along some of the struts there, named by their
/// nodes as in `a -- b`, and moves on its own from then on.
///
/// They need not be those that it had before it merged: that is how a truss changes which nodes its struts join. What the judge
/// asks is the same as where nodes merge.
///
/// Example:
/// ```modl
/// use std.truss.PneumaticReel
/// // An octahedron, with a node on its lower corners and one on its upper ones.
/// truss Star of PneumaticReel {
///   node a = [1.15m, 0m, 0m]  node b = [-0.58m, 1m, 0m]  node c = [-0.58m, -1m, 0m]
///   node d = [-1.15m, 0m, 1.6m]  node e = [0.58m, 1m, 1.6m]  node f = [0.58m, -1m, 1.6m]
///   node g = [0m, 0m, 0.5m]  node h = [0m, 0m, 1.1m]
///   strut a -- b  strut b -- c  strut c -- a  strut d -- e  strut e -- f  strut f -- d
///   strut a -- e  strut a -- f  strut b -- d  strut b -- e  strut c -- d  strut c -- f
///   strut g -- a  strut g -- b  strut g -- c  strut h -- d  strut h -- e  strut h -- f
/// }
/// let met = move_nodes(at_rest(Star), nodes: ["h"], to: [[0m, 0m, 0.5m]])
/// let one = merge_nodes(met, node: "h", into: "g")
/// let two = split_node(one, node: "h", struts: ["g -- a", "g -- e", "g -- f"])
/// let apart = move_nodes(two, nodes: ["g", "h"], to: [[-0.3m, 0m, 0.5m], [0.2m, 0m, 0.5m]])
/// print(verify(apart).ok)
/// ```
extern fn split_node(plan: Plan, node: Text, struts: List<Text>) -> Plan
