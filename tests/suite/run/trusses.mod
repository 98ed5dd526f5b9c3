--- what is in the way of a truss where it begins
use std.truss.PneumaticReel
truss P of PneumaticReel = octet(edge: 2m, divisions: 2, interior: false)
let inside = locomote(P, path: [[3m, 0m, 0m]], obstacles: [box(1m, 1m, 1m)])
//                                                        ^^^^^^^^^^^^^^^^^ E0506 too near to obstacle 1 where the truss begins
let hill = terrain([[0m, 0m, 0m], [0m, 1m, 0m], [0m, 0m, 0m]], spacing: 500mm, centre: [500mm, 0m, 0m])
let under = locomote(P, path: [[3m, 0m, 0m]], terrain: hill)
//                                                     ^^^^ E0506 in the ground where the truss begins

--- ground that is none
print(terrain([[0m, 1m]], spacing: 1m))
//            ^^^^^^^^^^ E0506 less than two rows
print(terrain([[0m, 1m], [0m]], spacing: 1m))
//            ^^^^^^^^^^^^^^^^ E0506 row 1 has 1 heights, the rows before have 2
print(terrain([[0m, 1m], [0m, 1m]], spacing: 0m))
//                                           ^^ E0506
print(terrain([[0m, 1m], [0m, 1m]], spacing: 1m))
//> a terrain of 2 by 2 heights
print(terrain([], spacing: 1m))
//            ^^ E0506 less than two rows

--- a truss with several faults tells them all, and nothing that follows from one
use std.truss.PneumaticReel
truss T of PneumaticReel {
  node a = [0m, 0m, 0m]
  node b = [1m, 0m, 0m]
  node c = [0m, 1m, 0m]
  node d = [0m, 0m, 50m]
  node twin = [1m, 0m, 0m]
//     ^^^^ E0312 the nodes b and twin are at one place
  node alone = [5m, 5m, 5m]
//     ^^^^^ E0312 no strut holds the node alone
  strut a -- b
  strut b -- c
  strut b -- a
//^^^^^^^^^^^^ E0312 the strut b -- a is there twice
  strut c -- d
//^^^^^^^^^^^^ E0312 50.01m long
  strut c -- c
//^^^^^^^^^^^^ E0312 begins and ends at one node
  strut a -- twin
}
print(nodes(T))

--- targets and paths that are farther away than 1 km
use std.truss.PneumaticReel
truss P of PneumaticReel = octet(edge: 2m, divisions: 2, interior: false)
let far = cloud([[0m, 0m, 0m], [1m, 0m, 0m], [0m, 1m, 0m], [0m, 0m, 1e300m]])
print(morph(P, far).rms)
//             ^^^ E0506 a target reaches to at most 1000 m
print(locomote(P, path: [[1e6m, 0m, 0m]]).distance)
//                      ^^^^^^^^^^^^^^^^ E0506 at most 1000 m away

--- struts too weak for what they carry: half of each of three struts is at the top, and three legs hold it
strut Weak { length 300mm..3m  max_speed 50mm/s  max_force 5N  mass 1kg  clearance 100mm }
truss Tetra of Weak {
  node a = [0m, 0m, 0m]  node b = [1m, 0m, 0m]  node c = [0.5m, 0.8660254m, 0m]  node d = [0.5m, 0.2886751m, 0.8164966m]
  strut a -- b  strut a -- c  strut a -- d  strut b -- c  strut b -- d  strut c -- d
}
let w = locomote(Tetra, path: [[500mm, 600mm, 0m]])
//               ^^^^^ E0603 would bear 6.00532N where the truss rests at first; it can bear 5N

--- which may be allowed
strut Weak { length 300mm..3m  max_speed 50mm/s  max_force 5N  mass 1kg  clearance 100mm }
truss Tetra of Weak {
  node a = [0m, 0m, 0m]  node b = [1m, 0m, 0m]  node c = [0.5m, 0.8660254m, 0m]  node d = [0.5m, 0.2886751m, 0.8164966m]
  strut a -- b  strut a -- c  strut a -- d  strut b -- c  strut b -- d  strut c -- d
}
let w = locomote(Tetra, path: [[500mm, 600mm, 0m]], forces: false)
print(w.ended, verify(w).ok)
//> arrived true

--- a strut that buckles bears as much less as the square of its length: half a newton at 3 m is 4.5 at 1 m
strut Thin { length 300mm..3m  max_speed 50mm/s  max_force 100N  mass 1kg  clearance 100mm  buckling 500mN }
truss Tetra of Thin {
  node a = [0m, 0m, 0m]  node b = [1m, 0m, 0m]  node c = [0.5m, 0.8660254m, 0m]  node d = [0.5m, 0.2886751m, 0.8164966m]
  strut a -- b  strut a -- c  strut a -- d  strut b -- c  strut b -- d  strut c -- d
}
let w = locomote(Tetra, path: [[500mm, 600mm, 0m]])
//               ^^^^^ E0603 would bear 6.00532N where the truss rests at first; it can bear 4.5N

--- nodes weigh something: here 1 kg more on the legs
strut Heavy { length 300mm..3m  max_speed 50mm/s  max_force 8N  mass 1kg  clearance 100mm  node_mass 1kg }
truss Tetra of Heavy {
  node a = [0m, 0m, 0m]  node b = [1m, 0m, 0m]  node c = [0.5m, 0.8660254m, 0m]  node d = [0.5m, 0.2886751m, 0.8164966m]
  strut a -- b  strut a -- c  strut a -- d  strut b -- c  strut b -- d  strut c -- d
}
let w = locomote(Tetra, path: [[500mm, 600mm, 0m]])
//               ^^^^^ E0603 would bear 10.0089N where the truss rests at first; it can bear 8N

--- a slope of 19.3 degrees takes a friction of 0.35
strut Strong { length 300mm..3m  max_speed 50mm/s  max_force 500N  mass 1kg  clearance 100mm }
truss Tetra of Strong {
  node a = [0m, 0m, 0m]  node b = [1m, 0m, 0m]  node c = [0.5m, 0.8660254m, 0m]  node d = [0.5m, 0.2886751m, 0.8164966m]
  strut a -- b  strut a -- c  strut a -- d  strut b -- c  strut b -- d  strut c -- d
}
let hill = terrain([[-700mm, 0m, 700mm], [-700mm, 0m, 700mm], [-700mm, 0m, 700mm]], spacing: 2m)
let held = locomote(Tetra, path: [[500mm, 300mm, 0m]], terrain: hill, friction: 0.5)
print(held.ended)
//> arrived
let slides = locomote(Tetra, path: [[500mm, 300mm, 0m]], terrain: hill, friction: 0.4)
//                    ^^^^^ E0602 slides where the truss rests at first, with a friction of 0.32; it takes 0.35

--- a node that three struts in nearly one plane hold
strut Strong { length 300mm..3m  max_speed 50mm/s  max_force 90N  mass 1kg  clearance 10mm }
truss Mast of Strong {
  node a = [0m, 0m, 0m]  node b = [1m, 0m, 0m]  node c = [0.5m, 0.8660254m, 0m]  node d = [0.5m, 0.2886751m, 0.8164966m]
  node e = [0.5m, -200mm, 0.05m]
  strut a -- b  strut a -- c  strut a -- d  strut b -- c  strut b -- d  strut c -- d
  strut e -- a  strut e -- b  strut e -- c
}
let w = locomote(Mast, path: [[500mm, 600mm, 0m]])
//               ^^^^ E0603 the strut e -- 
