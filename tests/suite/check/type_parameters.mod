--- a function of any type gives what its arguments say
record Leg { length: Length }
fn second<A>(list: List<A>) -> A = list[1]
fn both<A, B, C>(a: A, b: B, f: fn(A, B) -> C) -> C = f(a, b)
fn mean<D: Dimension>(list: List<Quantity<D>>) -> Quantity<D> = sum(list) / len(list)
fn spread<D: Dimension>(list: List<Quantity<D>>) -> Quantity<D> = sqrt(sum([(x - mean(list))^2 for x in list]) / 2)
fn area<D: Dimension>(x: Quantity<D>, times: Number = 2) -> Quantity<D^2> = times * x * x
let a: Length = mean([1m, 2m])
let b: Angle = mean([1m, 2m])
//             ^^^^^^^^^^^^^^ E0201 `b` wants an angle (deg)
let c: Area = area(mean([1m, 2m])) + area(spread([1m, 2m]), times: 3)
let d: Leg = second([Leg(length: 1m), Leg(length: 2m)])
let e: Speed = both(1m, 2s, (x, y) => x / y)
fn rate<D: Dimension>(x: Quantity<D>, t: Time) -> Quantity<D/s> = x / t
fn gain<D: Dimension>(rate: Quantity<D/s>) -> Quantity<D> = rate * 1s
let turning: AngularSpeed = rate(90deg, 2s)
let way: Length = gain(rate(3m, 2s))
let slow: Length = rate(3m, 2s)
//                 ^^^^^^^^^^^^ E0201 `slow` wants a length
fn lost<D: Dimension>(x: Quantity<D>) -> Quantity<D/s> = x
//                                                       ^ E0201 `x` is a quantity in D
let f: Time = both(1m, 2s, (x, y) => x / y)
//            ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ E0201 `f` wants a time
let g: List<Length> = second([[1m], [2m]])
let h = both(1m, 2s, (x, y) => x + y)
//                             ~ this is a length
//                               ^ E0201
let i: Number = mean([1, 2])
let j: Int = mean([1, 2])
//           ^^^^^^^^^^^^ E0202 `j` wants a whole number
let k = mean(["a"])
//           ^^^^^ E0202 `list` wants
let l = second(3)
//             ^ E0202 `list` wants

--- nothing is known of a type parameter in the body
fn f<A>(x: A, y: A) -> A = x + y
//                           ^ E0207 `+` does not take a `A` and a `A`
fn g<A>(x: A) -> Int = x
//                     ^ E0202 the result wants a whole number; `x` is a `A`
fn h<A, B>(x: A, y: B) -> A = y
//                            ^ E0202 the result wants a `A`; `y` is a `B`
fn i<A>(x: A, y: A) -> Bool = x == y
//                              ^^ E0207
fn j<A>(x: A) -> Length = x.length
//                          ^^^^^^ E0107 a `A` has no `length`
fn k<D: Dimension>(x: Quantity<D>) -> Quantity<D> = x * x
//                                                  ^^^^^ E0201 `x * x` is a quantity in D^2
fn l<D: Dimension>(x: Quantity<D>) -> Length = x
//                                             ^ E0201
fn m<D: Dimension>(x: Quantity<D>) -> Quantity<D> = x + 1
//                                                    ^ E0201
fn n<A>(x: A) -> List<A> = [x, 3]
//                             ^ E0202 an element of the list wants a `A`
fn o<A>(x: A) -> A? = if true { x } else { _ }
fn p<A>(x: A, f: fn(A) -> Bool) -> Text = { let y: A = x
  if f(y) { "{y}" } else { "" } }

--- what type parameters may be
fn f<A>(x: A) = x
// ^ E0210 a function with type parameters says what it gives | `-> Type`
fn g<A>() -> List<A> = []
//   ^ E0210 nothing says what `A` is
fn h<A: Quantity>(x: A) -> A = x
//      ^^^^^^^^ E0209 bounds the type parameters of built-ins only | `<D: Dimension>(x: Quantity<D>)`
fn i<D: Dimension, E: Dimension>(x: Quantity<D>, y: Quantity<E>) -> Quantity<D> = x
//                 ^ E0209 one dimension parameter at most
fn j<A: Nope>(x: A) -> A = x
//      ^^^^ E0209 bounds no type parameter
fn k<A, A>(x: A) -> A = x
//      ^ E0102 `A` is declared twice
fn l<A>(x: A = 3) -> A = x
//             ^ E0202 `x` wants a `A`
fn id<A>(x: A) -> A = x
fn apply(f: fn(Int) -> Int) -> Int = f(1)
let m = apply(id)
//            ^^ E0202 `id` must be called here | `x => id(x)`
let n = apply(x => id(x))

--- one function of any type calls another
fn first_of<A>(list: List<A>, default: A) -> A = first(list) else default
fn twice<A>(x: A, f: fn(A) -> A) -> A = f(f(x))
fn ends<A>(list: List<A>, default: A) -> List<A> = [first_of(list, default), first_of(reversed(list), default)]
fn counted<A>(list: List<A>) -> Int = reduce(list, (n, x) => n + 1, from: 0)
fn mapped<A, B>(list: List<A>, f: fn(A) -> B) -> List<B> = reduce(list, (all, x) => all ++ [f(x)], from: [])
let a: List<Angle> = ends([1deg, 2deg], 0deg)
let b: Length = twice(1m, x => 2 * x)
let c: List<Text> = mapped([1, 2], x => "{x}")

--- a lambda is checked after the other arguments, and may widen what they bind
let a: Number = reduce([1.5, 2], (a, x) => a + x, from: 0)
let b: Int = reduce([1, 2], (a, x) => a + x, from: 0)
let c: Int = reduce([1.5, 2], (a, x) => a + x, from: 0)
//           ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ E0202 `c` wants a whole number
let d = reduce([1m, 2m], (a, x) => a + x, from: 0)
//                                   ^ E0201
let e = reduce([1, 2], (a, x) => div(a, 2) / x, from: 7)
//                               ^^^^^^^^^^^^^ E0202 a whole number
let f = reduce([1, 2], (a, x) => a.size, from: 7)
//                                 ^^^^ E0107
let g = iterate(x => x / 2, from: 8, until: x => x < 1)
let h: Number = g
let i = iterate(x => "{x}", from: 8, until: x => true)
//                   ^^^^^ E0202
let j = iterate(x => x + 1, from: 8, until: x => x)
//                                               ^ E0202
let k: Number = reduce([[1, 2.5], [3]], (a, row) => a + reduce(row, (b, x) => b + x, from: 0), from: 0)
fn chosen<A>(a: A?, b: A) -> A = a else b
let l: Int = chosen(_, 3)
let m: Length = chosen(1m, 2m)
