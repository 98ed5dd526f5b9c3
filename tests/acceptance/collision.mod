// run E0601
use std.smores.{Smores, Chain3}
config Curl { part s[2]: Chain3
  connect s[0].head -- s[1].tail
  behavior curl allows unstable = Pc([move(m.tilt, to: 90deg) for m in s[0].m ++ s[1].m])
//                                    ^^^^^^^^^^^^^^^^^^^^^^^ two modules meet at this time: which, when, and the commands that moved them
}
emit(Curl().curl(), "curl.plan.json")
