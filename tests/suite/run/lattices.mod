--- fixed cells stay where they are drawn, and the others push off from them
use std.crystal.ExpandingCube
lattice Left of ExpandingCube = cells("""
  ##.....
  #######
  #######
""")
lattice Right of ExpandingCube = cells("""
  .....##
  #######
  #######
""")
let base = row(7)
let p = squeeze(Left, Right, fixed: base)
print(p.method, p.balanced, verify(p).ok, p.why)
//> push false true push: the way on which the fixed cells stay
let wall = cells("""
  ...#...
  .......
  .......
""")
let q = squeeze(Left, Right, fixed: base, obstacles: wall)
print(verify(q).ok, verify(reverse(q)).ok, verify(q ++ reverse(q)).ok)
//> true true true

--- cells shrink at the end, and grow again: the squeeze problem of the paper
use std.crystal.ExpandingCube
lattice Bar of ExpandingCube = row(65)
lattice Pole of ExpandingCube = column(65)
let p = squeeze(Bar, Bar, sides: [0.5, 1, 1])
print(p.duration, p.gap, p.balanced, p.stages, verify(p).ok)
//> 800ms 0 true [squeeze: 800ms] true
print(verify(reverse(p) ++ squeeze(Bar, Pole)).ok)
//> true
print(squeeze(Bar, Bar, sides: [0.4, 1, 1]).duration)
//                             ^^^^^^^^^^^ E0801 along x the sides of cells are from 0.5 to 1 of their size
print(squeeze(Bar, Bar, fixed: row(1), sides: [1, 1, 0.5]).duration)
//                                            ^^^^^^^^^^^ E0801 fixed cells keep their size

--- fixed cells and obstacles that do not fit the shapes are refused
use std.crystal.ExpandingCube
lattice Square of ExpandingCube = block(2, 2)
lattice Bar of ExpandingCube = row(4)
print(squeeze(Square, Bar, obstacles: row(9)).duration)
//                                    ^^^^^^ E0801 among obstacles some cells must be fixed | around a robot that floats
print(squeeze(Square, Bar, fixed: column(2)).duration)
//                                ^^^^^^^^^ E0801 the fixed cell (0, 1, 0) is no cell of the second shape
print(squeeze(Square, Bar, fixed: row(3)).duration)
//                                ^^^^^^ E0801 the fixed cell (2, 0, 0) is no cell of the first shape
print(squeeze(Square, Bar, fixed: row(1), obstacles: column(2)).duration)
//                                                   ^^^^^^^^^ E0801 the obstacle (0, 0, 0) is where the first shape has a cell
print(squeeze(Square, Bar, fixed: row(1), method: accordion).duration)
//                                                ^^^^^^^^^ E0802 `accordion` moves all cells: none stays fixed
print(squeeze(Square, Bar, fixed: row(1), model: balanced).duration)
//                                               ^^^^^^^^ E0801 it is not balanced by itself

--- cells that do not slide change places as blocks of eight, which tunnel
use std.crystal.{DockedCube, ExpandingCube}
lattice Bar of DockedCube = enlarged(row(3))
lattice Corner of DockedCube = enlarged(cells("""
  #.
  ##
"""))
print(count(Bar))
//> 24
let p = squeeze(Bar, Corner)
print(p.method, p.balanced, verify(p).ok, verify(reverse(p)).ok, p.why)
//> tunnel false true true tunnel: the way of cells that do not slide
lattice Long of DockedCube = enlarged(row(4))
lattice Up of DockedCube = enlarged(cells("""
  ..#
  ###
"""))
let q = squeeze(Long, Up, fixed: block(2, 2, 2))
print(q.why, verify(q).ok)
//> tunnel: the way of cells that do not slide true
print(squeeze(Bar, Corner, fixed: block(2, 2, 2)).duration)
//            ^^^ E0802 no way was found on which the fixed cells stay
lattice Row of DockedCube = row(8)
lattice Column of DockedCube = column(8)
print(squeeze(Row, Column).duration)
//            ^^^ E0801 the cell (0, 0, 0) is in no whole block of 2 × 2 × 2 cells | of cells with `slides false`, which move as whole blocks only
print(squeeze(Bar, Corner, method: push).duration)
//                                 ^^^^ E0801 the cells do not slide along each other | a method for cells that slide
print(squeeze(Bar, Corner, fixed: block(2, 2, 2), method: accordion).duration)
//                                                        ^^^^^^^^^ E0802 `accordion` moves all cells
lattice Sliding of ExpandingCube = row(3)
lattice Bent of ExpandingCube = cells("""
  #.
  ##
""")
print(squeeze(Sliding, Bent, method: tunnel).duration)
//            ^^^^^^^ E0801 the cell (0, 0, 0) is in no whole block of 2 × 2 × 2 cells | `tunnel` moves whole blocks

--- a cell says by a truth value if it slides
cell Sure { size 100mm  shrinks_to 50mm  mass 1kg  max_force 10N  max_speed 1m/s  slides true }
lattice Pair of Sure = row(2)
lattice Pile of Sure = column(2)
print(squeeze(Pair, Pile).method)
//> accordion

--- shapes in a plane become each other without a turn: pairs of cells spin
use std.crystal.ExpandingCube
lattice Ring of ExpandingCube = cells("""
  ####
  #..#
  #..#
  ####
""")
lattice Stairs of ExpandingCube = cells("""
  ##.....
  .##....
  ..##...
  ...##..
  ....##.
  .....##
""")
let p = squeeze(Ring, Stairs, model: balanced)
print(p.method, p.balanced, p.angular_momentum == 0kg*m^2/s, verify(p).ok, p.why)
//> spin true true true spin: the fastest way that nothing outside has to turn
print(verify(reverse(p)).ok, verify(p ++ squeeze(Stairs, Ring, model: balanced)).ok)
//> true true
lattice Ell of ExpandingCube = cells("""
  #.
  ##
""")
lattice Bar of ExpandingCube = row(3)
print(squeeze(Ell, Bar, model: balanced).duration)
//                             ^^^^^^^^ E0802 no way is known on which the angular momentum stays zero
print(squeeze(Ell, Bar, method: spin).duration)
//                              ^^^^ E0802 `spin` takes shapes of up to 400 cells in one plane to each other
