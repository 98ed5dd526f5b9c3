// check E0302
connector Plug   { mates Socket, turns 1 }
connector Socket { mates Plug, turns 1 }
module Block {
  mass 100g
  link body = box(40mm, 40mm, 40mm)
  port a: Plug   on body at [20mm, 0mm, 0mm]  facing +X up +Z
  port b: Socket on body at [-20mm, 0mm, 0mm] facing -X up +Z
}
config Two { part x: Block  part y: Block
  connect x.a -- y.a
//        ^^^    ^^^ a Plug does not mate with a Plug; free ports of y that have one: b
}
