--- a value is left out only where it may be
let a = _
//      ^ E0101 `_` has no value here
print(_)
//    ^ E0101
let b: Length? = _
let c = b else 3mm
