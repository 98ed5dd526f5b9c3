--- imports
use std.smores.{Smores, Chain3 as Chain,}
//> (use std.smores (Smores Chain3:Chain))
use "parts/claw.mod".{Claw}
//> (use "parts/claw.mod" (Claw))
use std.gaits
//> (use std.gaits)
use std.in.{}
//> (use std.in ())

--- functions and types
fn f(a: Length = 3mm, b: List<Vec3<Length>>, c: T?,) -> Range<Quantity<kg*m^2>> = a
//> (fn f (a:Length=3'mm b:List<Vec3<Length>> c:T?) ->Range<<kg*m^2>> a)
fn g(m: exact | heuristic = exact, r: auto | Int = auto) = m
//> (fn g (m:exact|heuristic=exact r:auto|Int=auto) m)
fn k<A, D: Dimension>(a: List<A>, d: Quantity<D>) -> A = a
//> (fn k <A D:Dimension> (a:List<A> d:<D>) ->A a)
let h: fn(A, B) -> (C | D)? = x
//> (let h :fn(A B)->C|D? x)
let i: std.smores.Smores = x
//> (let i :std.smores.Smores x)
let j: Quantity<1/s^2> = x
//> (let j :<s^-2> x)

--- what built-ins are declared with
extern fn clamp<D: Dimension>(x: Quantity<D>, to: Range<Quantity<D>>) -> Quantity<D>
//> (extern-fn clamp <D:Dimension> (x:<D> to:Range<<D>>) -><D>)
/// Runs in series.
extern fn Sc(b: Behavior..., for: Time? = none) -> Behavior
//> (doc "Runs in series." (extern-fn Sc (b:Behavior... for:Time?=none) ->Behavior))
extern type Folding is Plan {
  /// The best.
  layout: Layout
  fn at(t: Time) -> State
}
//> (extern-type Folding is:Plan (doc "The best." (layout Layout)) (extern-fn at (t:Time) ->State))
extern type Signal
//> (extern-type Signal)

--- connectors
connector Plug { mates Socket, turns 1, holds 88N, holds 1.9N*m, capture 4mm 5deg }
//> (connector Plug (mates Socket) (turns 1) (holds 88'N) (holds 1.9'N*m) (capture 4'mm 5'deg))
connector Both {
  mates Both, Plug, turns 4
  capture 4mm
  hinge(axis: Z, range: -180deg..180deg)
}
//> (connector Both (mates Both Plug) (turns 4) (capture 4'mm) (hinge axis:Z range:(.. (- 180'deg) 180'deg)))
connector Empty {}
//> (connector Empty)

--- a module with everything
module M(n: Int = 4) {
  mass 150g  touch 0.2mm  contact 4mm
  link base = box(1mm, 2mm) collides sphere(1mm) at [0mm, 0mm, 1mm] turned(Z, 90deg) turned(X, 1deg)
  joint bend : base -> tip = revolute(axis: Y) at [0mm, 0mm, 0mm]
  joint b = -bend
  motor p = tilt + 0.5 * pan (max_speed: 1rad/s)
  touching base tip
  alias pan = front
  let a = 3
  require a > 2, "too few"
  for i in 0..n { port side[i] : Face on base at [0mm, 0mm, 0mm] facing [a, b, c] up +Z }
  if n > 2 { port x: std.a.Face on tip facing -X } else if n > 1 { mass 1g } else { mass 2g }
}
//> (module M (n:Int=4) (mass 150'g) (touch 0.2'mm) (contact 4'mm) (link base (call box 1'mm 2'mm) collides:(call sphere 1'mm) at:[0'mm 0'mm 1'mm] (turned Z 90'deg) (turned X 1'deg)) (joint bend base->tip (call revolute axis:Y) at:[0'mm 0'mm 0'mm]) (mimic b (- bend)) (motor p (Add tilt (Mul 0.5 pan)) max_speed:1'rad*s^-1) (touching base tip) (alias pan front) (let a 3) (require (Gt a 2) "too few") (for i (.. 0 n) (port side i Face on:base at:[0'mm 0'mm 0'mm] facing:[a b c] up:(+ Z))) (if (Gt n 2) (port x std.a.Face on:tip facing:(- X)) (else (if (Gt n 1) (mass 1'g) (else (mass 2'g))))))

--- cells and struts
cell Cube(a: Length = 1mm) { size a  shrinks_to 50mm, mass 1kg }
//> (cell Cube (a:Length=1'mm) (size a) (shrinks_to 50'mm) (mass 1'kg))
strut Reel { length 300mm..3m  max_speed 50mm/s }
//> (strut Reel (length (.. 300'mm 3'm)) (max_speed 50'mm*s^-1))

--- a configuration with everything
config C(n: Int = 2) closed {
  part body  : std.a.Body
  part leg[4]: Leg(bend: 3deg)
  part arm[i in 0..n]: Arm(left: i < 2)
  port head = body.head
  port side[4] = [a, b]
  base body.core
  connect body.side[0] -- leg[1].hip turn if a { 90deg } else { 0deg }
  set body.core.tilt = 0deg
  require n > 1
  /// Rolls.
  behavior roll(v: Speed) allows unstable, collision(a, b[1]) = spin(m.left, v)
  behavior stand = { let a = 1
    wait(1s) }
  for i in 0..4 { connect a -- b  let c = 3  if i > 2 { set x.y = 1 } else { } }
}
//> (config C (n:Int=2) closed (part body std.a.Body) (part leg count:4 Leg (args bend:3'deg)) (part arm (for i (.. 0 n)) Arm (args left:(Lt i 2))) (port head body.head) (port side count:4 [a b]) (base body.core) (connect body.side[0] leg[1].hip turn:(if a {90'deg} {0'deg})) (set body.core.tilt 0'deg) (require (Gt n 1)) (doc "Rolls." (behavior roll (v:Speed) allows:[unstable (collision a (at b 1))] (call spin m.left v))) (behavior stand {(let a 1) (call wait 1's)}) (for i (.. 0 4) (connect a b) (let c 3) (if (Gt i 2) (set x.y 1))))

--- lattices and trusses
lattice Row(n: Int) of std.a.Cube = row(n)
//> (lattice Row (n:Int) of std.a.Cube (call row n))
truss P of Reel = octet(edge: 4m)
//> (truss P of Reel (call octet edge:4'm))
truss T of Reel {
  node a = [0m, 0m, 0m]
  for i in 0..3 { node ring[i] = [i, 0m, 0m]  strut a -- ring[i] }
  if x { strut a -- b } else { strut b -- a }
}
//> (truss T of Reel (node a [0'm 0'm 0'm]) (for i (.. 0 3) (node ring i [i 0'm 0'm]) (strut a ring[i])) (if x (strut a b) (else (strut b a))))

--- statements and tests
for n in [1, 6] {
  let s = Snake(n)
  emit(s)
}
//> (for n [1 6] (let s (call Snake n)) (call emit s))
if a { print(1) } else if b { print(2) } else { print(3) }
//> (if a (call print 1) (else (if b (call print 2) (else (call print 3)))))
test "it {walks} \"well\"" {
  expect a == b, "why"
  require c
}
//> (test "it {walks} \"well\"" (expect (Eq a b) "why") (require c))
require 1 < 2, "sound"
//> (require (Lt 1 2) "sound")

--- documentation
//! The file.
/// One
///  two
// a note between
/// three
let a = 1
//> (doc "One\n two\nthree" (let a 1))
//// no documentation
let b = 2
//> (let b 2)

--- nothing at all

--- only a comment
// here
