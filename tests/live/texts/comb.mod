use std.smores.{Smores, Chain3}

config Comb(n: Int = 3, every: Int = 2) {
  part spine[n]: Smores
  part tooth[k in 0..2]: Smores
  for i in 0..n - 1 { connect spine[i].bottom -- spine[i + 1].top }
  connect spine[0].left -- tooth[0].bottom
  connect spine[0].right -- tooth[1].bottom
  if every > 2 { set tooth[0].pan = 5deg }

  /* the end */
}
