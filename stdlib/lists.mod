//! Lists: pairs and places, the best element, order by a quantity, mean and deviation, even spacing, and shuffling.
//!
//! All of it is written in the language. There are no tuples: what would give pairs takes a function that says what
//! becomes of two values, or `record`s are made of them.

/// What `f` makes of the first elements of two lists, of the second ones, and so on.
///
/// Lists of different lengths are refused.
///
/// Example:
/// ```modl
/// use std.lists.zip
/// print(zip([1m, 2m], [3s, 4s], (way, time) => way / time))
/// ```
fn zip<A, B, C>(a: List<A>, b: List<B>, f: fn(A, B) -> C) -> List<C> = {
  require len(a) == len(b), "the lists have {len(a)} and {len(b)} elements: `zip` wants as many of each"
  [f(a[i], b[i]) for i in 0..len(a)]
}

/// What `f` makes of each place of a list, counted from 0, and the element there.
///
/// Example:
/// ```modl
/// use std.lists.enumerate
/// print(enumerate(["hip", "knee"], (i, name) => "{i}: {name}"))
/// ```
fn enumerate<A, B>(list: List<A>, f: fn(Int, A) -> B) -> List<B> = [f(i, list[i]) for i in 0..len(list)]

/// The elements of a list in the order of a quantity that `by` says of each, the least first; elements of which it says
/// the same stay in their order.
///
/// Of plain quantities, `sorted(list)` of the prelude does without `by`.
///
/// Example:
/// ```modl
/// use std.lists.sorted
/// record Leg { name: Text, length: Length }
/// let legs = [Leg(name: "a", length: 3cm), Leg(name: "b", length: 2cm)]
/// print([leg.name for leg in sorted(legs, by: leg => leg.length)])
/// ```
fn sorted<A, D: Dimension>(list: List<A>, by: fn(A) -> Quantity<D>) -> List<A> =
  [list[i] for i in ranking([by(x) for x in list])]

/// The element of which `by` says the least; of several the first. An empty list is refused.
///
/// Example:
/// ```modl
/// use std.lists.argmin
/// print(argmin(["three", "one", "eleven"], by: word => len(characters(word))))
/// ```
fn argmin<A, D: Dimension>(list: List<A>, by: fn(A) -> Quantity<D>) -> A = {
  require len(list) > 0, "an empty list has no element to be found"
  list[ranking([by(x) for x in list])[0]]
}

/// The element of which `by` says the most; of several the first. An empty list is refused.
///
/// Example:
/// ```modl
/// use std.lists.argmax
/// print(argmax([1m, -3m, 2m], by: x => abs(x)))
/// ```
fn argmax<A, D: Dimension>(list: List<A>, by: fn(A) -> Quantity<D>) -> A = {
  require len(list) > 0, "an empty list has no element to be found"
  list[ranking([-by(x) for x in list])[0]]
}

/// The mean of one or more quantities.
///
/// Example:
/// ```modl
/// use std.lists.mean
/// print(mean([1cm, 2cm, 6cm]))
/// ```
fn mean<D: Dimension>(list: List<Quantity<D>>) -> Quantity<D> = {
  require len(list) > 0, "no values have no mean"
  sum(list) / len(list)
}

/// The standard deviation of a population of which the two or more quantities are a sample: the squares of their
/// differences from the mean are divided by one less than their number.
///
/// Example:
/// ```modl
/// use std.lists.deviation
/// print(deviation([2mm, 4mm, 4mm, 4mm, 5mm, 5mm, 7mm, 9mm]))
/// ```
fn deviation<D: Dimension>(list: List<Quantity<D>>) -> Quantity<D> = {
  require len(list) > 1, "the deviation of a sample wants two values or more; these are {len(list)}"
  let centre = mean(list)
  sqrt(sum([(x - centre)^2 for x in list]) / (len(list) - 1))
}

/// As many values as `count` says from the first quantity to the second, evenly spaced, both among them.
///
/// Example:
/// ```modl
/// use std.lists.linspace
/// print(linspace(0deg, 90deg, count: 4))
/// ```
fn linspace<D: Dimension>(from: Quantity<D>, to: Quantity<D>, count: Int) -> List<Quantity<D>> = {
  require count > 1, "both ends are among the values, so `count` is 2 or more"
  [from * (1 - i / (count - 1)) + to * (i / (count - 1)) for i in 0..count]
}

/// The elements of a list in a pseudorandom order, all orders equally likely: the same order for the same `seed`.
///
/// Example:
/// ```modl
/// use std.lists.shuffle
/// print(shuffle([1, 2, 3, 4, 5], seed: 1))
/// ```
fn shuffle<A>(list: List<A>, seed: Int) -> List<A> = [list[i] for i in ranking(random(seed, len(list)))]
