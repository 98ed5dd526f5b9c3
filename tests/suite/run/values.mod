--- whole numbers are exact, quotients are numbers
print(7 / 2, div(-7, 2), -7 % 2, 7 % -2, 2^10)
//> 3.5 -4 1 1 1024
print(2^100 + 1)
//> 1267650600228229401496703205377
print((2^100) % 1000, 9223372036854775807 + 1)
//> 376 9223372036854775808
print(-2^2, 2^-1)
//> -4 0.5

--- quantities keep their dimension
print(76mm, 3m * 2m, 90deg, 2rad/s * 45mm, 9.81m/s^2)
//> 76mm 6m^2 90deg 90mm/s 9.81m/s^2
print(sqrt(3m * 12m), 30deg + 1turn, 1kg * 9.81m/s^2 * 2m)
//> 6m 390deg 19.62N*m
print(sin(30deg), atan2(1mm, -1mm), round(2.5), floor(-1.5))
//> 0.5 135deg 3 -2

--- what is declared an energy is shown in joules, through lets, parameters, fields and results
record Lift { name: Text, work: Energy, load: Torque }
fn lifting(m: Mass, by: Length) -> Energy = m * 9.81m/s^2 * by
fn moment(m: Mass, arm: Length) = m * 9.81m/s^2 * arm
fn as_energy(x: Energy) = x
let e: Energy = 2kg * 9.81m/s^2 * 1m
let t: Torque = e
let lift = Lift(name: "a", work: 3N*m, load: 4J)
print(e, t, lifting(2kg, by: 1m), moment(2kg, arm: 1m), as_energy(3N*m), 5J, 3mJ, 2N*m)
//> 19.62J 19.62N*m 19.62J 19.62N*m 3J 5J 0.003J 2N*m
print("{e} {t} {lift}", lift with { work: 7N*m }, lift.work, lift.load)
//> 19.62J 19.62N*m Lift(name: "a", work: 3J, load: 4N*m) Lift(name: "a", work: 7J, load: 4N*m) 3J 4N*m
print([lift, lift with { work: 30N*m }])
//> name  work [J]  load [N*m]
//> a            3           4
//> a           30           4
let maybe: Energy? = 3N*m
print(maybe, maybe else 1N*m, e == t, e < t + 1J, "{e in mJ:.1} {t in J}")
//> 3J 3J true true 19620.0mJ 19.62J

--- lists of energies are energies, and a list with a torque is one of torques
let e: Energy = 20J
let t = 10N*m
let torques = [1N*m, 2N*m]
let energies: List<Energy> = torques
fn mean<D: Dimension>(list: List<Quantity<D>>) -> Quantity<D> = sum(list) / len(list)
print(torques, energies, energies[0], [x for x in energies], first(energies), mean(energies), mean(torques))
//> [1N*m, 2N*m] [1J, 2J] 1J [1J, 2J] 1J 1.5J 1.5N*m
print([e, t], [e, e], [e] ++ [t], max(e, t), max(t, e), max(e, 2 * e), if true { e } else { t }, 1J..2J)
//> [20N*m, 10N*m] [20J, 20J] [20N*m, 10N*m] 20N*m 20N*m 40J 20N*m 1J..2J

--- a function value gives what its type says
fn moment(arm: Length) -> Torque = 2N * arm
fn moments(arm: Length) -> List<Torque> = [2N * arm]
fn energy_by(f: fn(Length) -> Energy) = f(3m)
fn energies_by(f: fn(Length) -> List<Energy>) = f(3m)
fn torque_by(f: fn(Length) -> Torque) = f(3m)
print(energy_by(moment), energies_by(moments), energy_by(x => 1N * x), torque_by(moment), torque_by(x => x / 1m * 1J))
//> 6J [6J] 3J 6N*m 3N*m

--- sums of energies and their multiples are energies, other results are known by their dimension alone
let e: Energy = 20J
let t = 10N*m
print(e + e, e - 5J, 2 * e, e / 4, -e, e^1, abs(-e), 2.5 * e, e % 15J)
//> 40J 15J 40J 5J -20J 20J 20J 50J 5J
print(e + t, t - e, e / 2s, e * 2s, e / 4m, e / t, 2N * 3m, e^2 / 1J)
//> 30N*m -10N*m 10W 40kg*m^2/s 5N 2 6N*m 400N*m

--- a plain number has powers of any exponent
print(2.0^200, 1.0^-3_000_000_000)
//> 1.60694e60 1

--- the least exponent that a unit can have is shown
print((1/1s)^127 / 1s, (1/1s)^127 * 1kg / 1s)
//> 1s^-128 1kg/s^128

--- a missing value has another
print(first([1mm, 2mm]) else 0mm, last([]) else 3)
//> 1mm 3

--- lists and comprehensions
print([i * j for i in 0..3 for j in 0..3 if i < j], [1, 2] ++ [3])
//> [0, 0, 2] [1, 2, 3]
print(sum([100g, 0.4kg]), sorted([3mm, 1mm, 2mm]), slice([1, 2, 3, 4], 1..3))
//> 500g [1mm, 2mm, 3mm] [2, 3]
print(min(3, 1, 2), max([40mm, 3cm]), contains([1, 2], 2), any([]), all([]))
//> 1 40mm true false true

--- texts
let n = 3
print("n = {n}, {n + 0.5}", join(["a", "b"], with: ", "), len(characters("modl")))
//> n = 3, 3.5 a, b 4

--- functions, defaults that depend on parameters, function values
fn area(a: Length, b: Length = a * 2) -> Area = a * b
fn apply(f: fn(Int) -> Int, x: Int) -> Int = f(x)
print(area(2m), area(2m, b: 1m), apply(x => x + n, 4))
let n = 10
//> 8m^2 2m^2 14

--- recursion with an end
fn factorial(n: Int) -> Int = if n < 2 { 1 } else { n * factorial(n - 1) }
print(factorial(25))
//> 15511210043330985984000000

--- lets are evaluated when first needed
let a = b + 1
let b = 2
print(a)
//> 3

--- equality
print(1 == 1.0, "a" == "a", [1, 2] == [1, 2], 1mm < 2mm, true and not false)
//> true true true true true

--- coordinates have numbers, too
let v: Vec3<Length> = [1m, 2m, 3m]
print(v[0], v[2] == v.z, [v[i] for i in 0..3])
//> 1m true [1m, 2m, 3m]
print(v[3])
//    ^^^^ E0501 which has 3 elements

--- what takes many values takes one or a list by its name
print(min(values: 3m), max(values: [1, 3, 2]))
//> 3m 3
print(values: 1)
//> 1
let b = Sc(behaviors: wait(1s))
print(layers(texts: "#") == layers("#"))
//> true

--- a value is carried along a list, and to where a condition holds
print(reduce([3, 1, 2], (total, x) => 10 * total + x, from: 0), reduce([], (a, x) => a + x, from: 7))
//> 312 7
print(reduce([1m, 2m], (a, x) => a + x, from: 0m), reduce(["a", "b"], (t, x) => t ++ x, from: ""))
//> 3m ab
print(reduce([3, 1, 2], from: 0, (total, x) => 10 * total + x))
//> 312
print(reduce([1.5, 2], (a, x) => a + x, from: 0), reduce([1, 2], (a, x) => a ++ [2 * x], from: []))
//> 3.5 [2, 4]
record Search { low: Number, high: Number }
let root2 = iterate(
  s => {
    let middle = (s.low + s.high) / 2
    if middle^2 < 2 { s with { low: middle } } else { s with { high: middle } }
  },
  from: Search(low: 0, high: 2),
  until: s => s.high - s.low < 1e-9,
)
print(abs(root2.low - sqrt(2)) < 1e-9, iterate(n => n + 1, from: 3, until: n => true))
//> true 3
print(iterate(f => f + 1deg, from: 0deg, until: f => f >= 90deg, max: 90))
//> 90deg

--- recursion is as deep as it needs to be
fn sum_to(n: Int) -> Int = if n == 0 { 0 } else { n + sum_to(n - 1) }
print(sum_to(10_000))
//> 50005000

--- deep values are compared and printed
record N { next: N?, n: Int = 0 }
let steps = [i for i in 0..8192]
let a = reduce(steps, (n, i) => N(next: n, n: i), from: N())
let b = reduce(steps, (n, i) => N(next: n, n: i), from: N())
let c = reduce(steps, (n, i) => N(next: n, n: i), from: N(n: 1))
print(a == b, a == c, len(characters("{a}")) < 2000)
//> true false true
