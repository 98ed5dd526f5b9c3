--- a value is left out only where it may be
let a = _
//      ^ E0101 `_` has no value here
print(_)
//    ^ E0101
let b: Length? = _
let c = b else 3mm

--- a behaviour of the library that was renamed
use std.smores.Puma4
print(Puma4().reach().duration)
//            ^^^^^ E0107 no part, port or behavior `reach` in Puma4 | `reach` is now called `posture`
