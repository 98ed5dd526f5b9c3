--- what a behaviour knows of states, and where
use std.smores.Chain3
config Worm {
  part c: Chain3
  behavior a = {
    let before = start.com
//               ^^^^^ E0411 `start` is the state in which a behavior begins | `require` looks at `start`
    require end.com.x > 0mm
//          ^^^ E0411 `end` is the state in which a behavior ends, which `ensure` knows
    require report.ok
//          ^^^^^^ E0411 `report` is what the judge says
    move(c.m[0].tilt, to: 1deg * start.time / 1s)
//                               ^^^^^ E0411
  }
  behavior b = move(c.m[0].tilt, to: if end.com.x > 0mm { 1deg } else { 2deg })
//                                      ^^^ E0411
}
print(start)
//    ^^^^^ E0101

--- `ensure` stands in a behaviour's own block
use std.smores.Chain3
ensure true
//<1-11 E0411 nothing begins or ends here
fn f(x: Int) -> Int = {
  ensure x > 0
//^^^^^^^^^^^^ E0411
  x
}
config Worm {
  part c: Chain3
  behavior a(n: Int) = {
    if n > 3 { ensure end.com.x > 0mm }
//             ^^^^^^^^^^^^^^^^^^^^^^ E0411
    for i in 0..n { ensure i > 0 }
//                  ^^^^^^^^^^^^ E0411
    move(c.m[0].tilt, to: 1deg)
  }
  behavior b = {
    move(c.m[0].tilt, to: 1deg)
    ensure end.com.x > 0mm
//  ^^^^^^^^^^^^^^^^^^^^^^ E0411 ends with its behavior | before the behavior
  }
}

--- conditions and messages are typed as everywhere
use std.smores.Chain3
config Worm {
  part c: Chain3
  behavior a = {
    ensure end.com.x
//         ^^^^^^^^^ E0202 `ensure` wants
    ensure end.margin > 3mm
//                    ^ E0207
    ensure end.nothing > 3mm
//             ^^^^^^^ E0107
    ensure true, 3
//               ^ E0202
    require start.angle(3) > 3deg
//                      ^ E0202
    move(c.m[0].tilt, to: 1deg)
  }
}

--- the program's own names keep their meaning
use std.smores.Chain3
fn ensure(x: Int) -> Int = x
let start = 3
config Worm(end: Angle = 3deg) {
  part c: Chain3
  behavior a(report: Int = 1) = {
    require start > 2 and report < 5
    let ensured = ensure(3)
    let twice = ensure (4) + ensure (5)
    ensure end.angle(c.m[0].tilt) < 4deg and report.ok
    move(c.m[0].tilt, to: end * ensured / twice)
  }
}
let ensure_more = [ensure(1), ensure (2)]
print(ensure(3), start, ensure_more)
