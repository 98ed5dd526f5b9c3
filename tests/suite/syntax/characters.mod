--- letters that look like others
    let größe = 3 + größe
//        ^ E0003 `ö` (U+00F6) has no place in a program | A-Z
    let ok = 3

--- signs that look like others
    let a = 3 − 2
//            ^ E0003 `−` (U+2212) | `-`
    let b = 3 × 2
//            ^ E0003 `×` (U+00D7) | `*`
    let c = 90°
//            ^ E0003 `°` (U+00B0) | `90deg`
    let d = “text”
//          ^ E0003 `“` (U+201C) | double quotes
//               ^ E0003 `”` (U+201D) | double quotes

--- spaces that are none
    let a = 3
//         ^ E0003 a no-break space (U+00A0)

--- letters of every kind in comments and texts
// größe, длина, 長さ, 🤖
let a = "größe, длина, 長さ, 🤖"
//> (let a "größe, длина, 長さ, 🤖")
